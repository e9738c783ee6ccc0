//! Words of the CL file that a machine has lines for: `[cl.words]`.

use std::ops::Range;

use post_grammar::{Argument, MajorWord, Template, WordUsage};

use super::build::Builder;
use super::file::{ClFile, OutputUnits};

/// The lines that stand in the program for one word of the CL file.
#[derive(Clone, Debug, PartialEq)]
pub struct WordRule {
    /// The major word, and the words behind its slash that the rule is for, in capitals: `SET`, `OFSETL`.
    words: Vec<String>,
    lines: Vec<Template>,
    /// One unit of the program, mm.
    program_unit: f64,
}

/// The lines of `[cl] functions`: a number of a CL file stands for a function, and is no length.
const FUNCTIONS: [(&str, &str); 2] = [("AUXFUN", "M{n}"), ("PREFUN", "G{n+0*unit:1}")];

impl WordRule {
    /// The words of a record that the rule speaks of; none if it is for another record.
    pub fn fits(&self, word: &str, arguments: &[Argument]) -> Option<usize> {
        let (major, minors) = self.words.split_first()?;
        let mut arguments = arguments.iter();
        let fits = major == word
            && minors.iter().all(|minor| {
                arguments.next().is_some_and(
                    |argument| matches!(argument, Argument::Word(word) if word.eq_ignore_ascii_case(minor)),
                )
            });
        fits.then_some(self.words.len())
    }

    /// The lines for a record that it [fits](Self::fits), of a CL file whose unit is `cl_unit` mm.
    ///
    /// # Errors
    /// Why the record has no lines, as a sentence: a number is missing or no code, or the record says more than the
    /// rule knows of.
    pub fn lines(&self, arguments: &[Argument], cl_unit: f64) -> Result<Vec<String>, String> {
        let mut numbers = Vec::new();
        for argument in &arguments[self.words.len() - 1..] {
            match argument {
                Argument::Number(number) => numbers.push(*number),
                Argument::Word(word) if word.is_empty() => {}
                Argument::Word(word) => {
                    return Err(format!("the rule for {} knows nothing of {word}", self.name()));
                }
            }
        }
        let known = self.lines.iter().map(Template::numbers).max().unwrap_or(0);
        if numbers.len() > known {
            return Err(format!(
                "the rule for {} uses {known} of its {} numbers",
                self.name(),
                numbers.len()
            ));
        }
        let unit = cl_unit / self.program_unit;
        if unit != 1.0
            && let Some(place) = self.lines.iter().find_map(Template::without_unit)
        {
            return Err(format!(
                "the CL file counts in units of {cl_unit} mm, the program in units of {} mm, and {{{place}}} in the rule for {} does not say which: {{n*unit:.3}} is a length in the program's units, {{n+0*unit:.3}} is none",
                self.program_unit,
                self.name()
            ));
        }
        let fill = |line: &Template| line.fill(&numbers, unit).map_err(|fault| fault.to_string());
        self.lines.iter().map(fill).collect()
    }

    /// Its lines, the texts of each in their order; none stands for a number of the record.
    pub(crate) fn texts(&self) -> impl Iterator<Item = Vec<Option<&str>>> {
        self.lines.iter().map(|line| line.texts().collect())
    }

    /// The rule's name as the machine file has it.
    fn name(&self) -> String {
        self.words.join("/")
    }
}

impl Builder<'_> {
    pub(super) fn word_rules(&mut self, file: &ClFile, units: OutputUnits) -> Vec<WordRule> {
        let program_unit = match units {
            OutputUnits::Mm => 1.0,
            OutputUnits::Inch => 25.4,
        };
        let mut rules: Vec<WordRule> = Vec::new();
        for (key, lines) in &file.words {
            let words: Vec<String> =
                key.get_ref().split('/').map(|word| word.trim().to_ascii_uppercase()).collect();
            let help = "OFSETL = \"G{n+53}\", \"SET/OFSETL\" = \"G{n+53}\"";
            if words.iter().any(String::is_empty) {
                self.rule_fault(
                    key.span(),
                    format!("[cl.words] has {:?}, which is no word", key.get_ref()),
                    help,
                );
            } else if rules.iter().any(|rule| rule.words == words) {
                self.rule_fault(
                    key.span(),
                    format!("[cl.words] has {} twice", words.join("/")),
                    "",
                );
            } else if let Some(instead) = known(&words) {
                self.rule_fault(
                    key.span(),
                    format!("{} has a meaning to post", words.join("/")),
                    &instead,
                );
            }
            let mut templates = Vec::new();
            for line in lines.get_ref().as_slice() {
                match Template::parse(line) {
                    Ok(template) => templates.push(template),
                    Err(message) => self.rule_fault(lines.span(), message, help),
                }
            }
            if lines.get_ref().as_slice().is_empty() {
                self.rule_fault(
                    lines.span(),
                    "a rule without a line".to_owned(),
                    "--allow WORD leaves a word out",
                );
            }
            rules.push(WordRule { words, lines: templates, program_unit });
        }
        for (word, line) in FUNCTIONS.into_iter().filter(|_| file.functions) {
            let words = vec![word.to_owned()];
            let lines = Template::parse(line).into_iter().collect();
            if rules.iter().all(|rule| rule.words != words) {
                rules.push(WordRule { words, lines, program_unit });
            }
        }
        rules
    }

    fn rule_fault(&mut self, span: Range<usize>, message: String, help: &str) {
        self.fault("machine-word", span, message, help);
    }
}

/// What to say instead of a rule for a word whose every record post carries out or passes on.
fn known(words: &[String]) -> Option<String> {
    let [word] = words else { return None };
    let row = MajorWord::find(word)?;
    match row.usage {
        _ if row.by_rule => None,
        WordUsage::Passed => {
            Some("[control] insert says what becomes of INSERT; texts are remarks".to_owned())
        }
        WordUsage::Used => Some(format!("\"{word}/WORD\" is a form of it that post does not know")),
        _ => None,
    }
}
