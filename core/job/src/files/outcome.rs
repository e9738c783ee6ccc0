//! What a run did to the user's files, for the last line of its messages.

use std::io;

/// What became of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextOutcome {
    /// Nothing, and the file that was there before is as it was.
    Kept,
    /// A part of it has gone to a pipe or a device and cannot be taken back.
    Begun,
    /// It stands in its place.
    Written,
}

/// Texts of a run, and what was printed for people.
#[derive(Default)]
pub struct TextOutcomes {
    /// By their names.
    became: Vec<(String, TextOutcome)>,
    printed: bool,
    /// Why a result could not be printed: the first fault of the run.
    pub unprinted: Option<io::Error>,
}

impl TextOutcomes {
    /// Notes what became of the text that is called `name`.
    pub fn note(&mut self, name: &str, became: TextOutcome) {
        match self.became.iter_mut().find(|(known, _)| known == name) {
            Some((_, old)) => *old = became,
            None => self.became.push((name.to_owned(), became)),
        }
    }

    /// Notes that something was printed for people, which is no text of its own.
    pub fn note_printed(&mut self) {
        self.printed = true;
    }

    /// What was written and what was not, as a sentence without its stop; none of a run that has printed what it is for.
    pub fn sentence(&self) -> Option<String> {
        (!self.became.is_empty() || !self.printed).then(|| say(&self.became))
    }
}

fn say(texts: &[(String, TextOutcome)]) -> String {
    let named = |wanted: TextOutcome| -> Option<(String, usize)> {
        let names = texts.iter().filter(|(_, became)| *became == wanted);
        let names: Vec<&str> = names.map(|(name, _)| name.as_str()).collect();
        let (last, others) = names.split_last()?;
        let list = match others {
            [] => (*last).to_owned(),
            others => format!("{} and {last}", others.join(", ")),
        };
        Some((list, names.len()))
    };
    let mut parts = Vec::new();
    if let Some((names, count)) = named(TextOutcome::Written) {
        parts.push(format!("{names} {} written", plural(count, "is", "are")));
    }
    if let Some((names, _)) = named(TextOutcome::Begun) {
        parts.push(format!("a part went to {names}"));
    }
    if parts.is_empty() {
        parts.push("nothing was written".to_owned());
    }
    if let Some((names, count)) = named(TextOutcome::Kept) {
        let was = plural(count, "is as it was", "are as they were");
        parts.push(format!("{names} {was}"));
    }
    parts.join("; ")
}

fn plural<'a>(count: usize, one: &'a str, several: &'a str) -> &'a str {
    if count == 1 { one } else { several }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sentence_is_true() {
        let text = |name: &str, became| (name.to_owned(), became);
        assert_eq!(say(&[]), "nothing was written");
        let kept = [text("a.nc", TextOutcome::Kept)];
        assert_eq!(say(&kept), "nothing was written; a.nc is as it was");
        let all = [
            text("a.nc", TextOutcome::Kept),
            text("b.json", TextOutcome::Kept),
            text("pipe", TextOutcome::Begun),
            text("c.nc", TextOutcome::Written),
        ];
        assert_eq!(
            say(&all),
            "c.nc is written; a part went to pipe; a.nc and b.json are as they were"
        );
    }
}
