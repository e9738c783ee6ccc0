//! What the codes of messages mean: `error[over-travel]`, `warning[tool-length]`.
//!
//! All that is said to users has a code. A test holds this list against every code in the sources; `post explain` and the
//! book's page of messages are made from it.

/// Parts of the work: `# title`, then the verbs that say the codes. Below each its codes by their letters: `## code`, what is
/// found, and what helps; a line each.
const TEXT: &str = include_str!("codes.md");

/// Codes that come from one part of the work.
pub struct CodeGroup {
    /// What the part is called.
    pub title: &'static str,
    /// Verbs that say them.
    pub verbs: &'static str,
    /// The codes, by their letters.
    pub codes: Vec<Code>,
}

/// A code of messages.
pub struct Code {
    /// As it stands in brackets: `over-travel`.
    pub name: &'static str,
    /// What is found.
    pub meaning: &'static str,
    /// What helps.
    pub remedy: &'static str,
}

/// All codes. One that two parts say, each in its own sense, is in both groups.
pub fn codes() -> Vec<CodeGroup> {
    let mut groups: Vec<CodeGroup> = Vec::new();
    let mut lines = TEXT.lines().filter(|line| !line.is_empty());
    while let Some(line) = lines.next() {
        let mut next = || lines.next().unwrap_or_default();
        if let Some(title) = line.strip_prefix("# ") {
            groups.push(CodeGroup { title, verbs: next(), codes: Vec::new() });
        } else if let (Some(name), Some(group)) = (line.strip_prefix("## "), groups.last_mut()) {
            group.codes.push(Code { name, meaning: next(), remedy: next() });
        }
    }
    groups
}
