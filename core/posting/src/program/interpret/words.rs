//! Words without a meaning of their own, and `INSERT`: carried out by a rule of the machine file, left out, or refused.

use post_grammar::{Argument, Record, Usage};
use post_machine::description::Insert;

use super::Interpreter;
use crate::program::{Command, Step, Unknown};

impl Interpreter {
    pub(super) fn other_word(
        &mut self,
        record: &Record<'_>,
        word: &str,
        arguments: &[Argument],
        directive: bool,
        emit: &mut impl FnMut(Step),
    ) {
        self.wants_fini |= directive || ends_with_fini(word);
        // A directive is meant for another program.
        if !directive && self.by_rule(record, word, arguments, emit) {
            return;
        }
        let usage = record.statement.usage();
        if matches!(usage, Usage::Refused | Usage::Unknown) && self.reading.allows(word) {
            self.allow(word, "is left out", record);
            return;
        }
        if usage == Usage::Refused {
            self.fault(
                record,
                "refused-word",
                format!("{word} changes where or whether metal is cut, and post does not know how"),
                &format!("let the CAM system write the result instead; [cl.words] in the machine file gives its lines of the program, --allow {word} leaves it out"),
            );
        }
        self.count(word, record, usage);
        if usage == Usage::Unknown && self.reading.unknown == Unknown::Pass {
            emit(Step::Command(Command::Comment(record.text().into_owned())));
        }
    }

    /// Writes the lines that the machine file has for the word; false if it has none.
    fn by_rule(
        &mut self,
        record: &Record<'_>,
        word: &str,
        arguments: &[Argument],
        emit: &mut impl FnMut(Step),
    ) -> bool {
        let fitting = self
            .reading
            .rules
            .iter()
            .filter_map(|rule| Some((rule.fits(word, arguments)?, rule)));
        let Some((_, rule)) = fitting.max_by_key(|(words, _)| *words) else {
            return false;
        };
        match rule.lines(arguments) {
            Ok(lines) => {
                self.load_told(record, emit);
                for line in lines {
                    emit(Step::Command(Command::Literal(line)));
                }
            }
            Err(message) => self.fault(
                record,
                "word-rule",
                format!("{message} ([cl.words] in the machine file)"),
                "a rule of its own for this form, such as \"WORD/FORM\", or more numbers in its line",
            ),
        }
        true
    }

    /// A line of the user's own.
    pub(super) fn insert(&mut self, record: &Record<'_>, text: &str, emit: &mut impl FnMut(Step)) {
        if self.reading.insert == Insert::Literal {
            emit(Step::Command(Command::Literal(text.to_owned())));
            return;
        }
        match Inserted::of(text) {
            Inserted::Remark => {}
            Inserted::Code if self.reading.allows("INSERT") => {
                self.allow("INSERT", "is written as a remark", record);
            }
            Inserted::Code => self.fault(
                record,
                "insert",
                format!("INSERT {text} is a line for the control, and would be written as a remark"),
                "--set control.insert=literal writes what INSERT holds as lines of the program; --allow INSERT as remarks",
            ),
            Inserted::Mixed => self.warn(
                record,
                "insert",
                format!("INSERT {text} is written as a remark, and holds a G or M word"),
            ),
        }
        emit(Step::Command(Command::Comment(text.to_owned())));
    }
}

/// Words that are found only in the files of systems that end every file with `FINI`: CAMWorks and SolidWorks CAM. (Of
/// Creo the directives tell.)
fn ends_with_fini(word: &str) -> bool {
    matches!(
        word,
        "BOX" | "MOVE_ATTRIB" | "OPFEATSTART" | "OPFEATEND" | "TRNTYP"
    ) || word.starts_with("CSI_")
}

/// What an `INSERT` holds. SolidWorks CAM describes tools and stock with it (`14MM CRB 4FL 32 LOC`,
/// `Stock Size X85. Y38. Z48.`), others hand words to the control (`M8`, `G04 X2.`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Inserted {
    /// Something to read.
    Remark,
    /// Nothing but words of a program: letters with numbers, or variables that are set.
    Code,
    /// Something to read that has a G or M word in it: `M8 TAP`, but also `M8 ON`.
    Mixed,
}

impl Inserted {
    fn of(text: &str) -> Self {
        let code = without_remarks(text);
        let (mut whole, mut switches, mut any) = (true, false, false);
        for piece in code.split_whitespace() {
            match words(piece) {
                Some(letters) => {
                    any = true;
                    switches |= letters.contains(['G', 'M']);
                }
                None => whole = false,
            }
        }
        match (whole && any, switches) {
            (true, _) => Self::Code,
            (false, true) => Self::Mixed,
            (false, false) => Self::Remark,
        }
    }
}

/// A text without what a control takes for a remark: what stands in parentheses, and what follows a semicolon.
fn without_remarks(text: &str) -> String {
    let mut code = String::new();
    let mut inside = false;
    for character in text.chars() {
        match character {
            '(' => inside = true,
            ')' => {
                inside = false;
                code.push(' ');
            }
            _ if inside => {}
            ';' => break,
            character => code.push(character),
        }
    }
    code
}

/// The letters of `G0X10.Y-2.5`, in capitals; none of a variable that is set (`#100=5`), and `None` if a piece of text
/// is anything else.
fn words(piece: &str) -> Option<String> {
    if piece.contains('=') && piece.starts_with(['#', 'R', 'r']) {
        return Some(String::new());
    }
    let mut letters = String::new();
    let mut rest = piece;
    while let Some(letter) = rest.chars().next() {
        let number = rest.strip_prefix(|first: char| first.is_ascii_alphabetic())?;
        let end = number
            .find(|character: char| !(character.is_ascii_digit() || "+-.".contains(character)))
            .unwrap_or(number.len());
        if !number[..end].bytes().any(|byte| byte.is_ascii_digit()) {
            return None;
        }
        letters.push(letter.to_ascii_uppercase());
        rest = &number[end..];
    }
    Some(letters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_told_from_a_remark() {
        for (text, held) in [
            ("M8", Inserted::Code),
            ("m08", Inserted::Code),
            ("G04 X2.", Inserted::Code),
            ("G0X10.Y-2.5", Inserted::Code),
            ("N10 G54 (FIXTURE TWO)", Inserted::Code),
            ("(FIRST) G55 ; SECOND", Inserted::Code),
            ("#100=5", Inserted::Code),
            ("R1=2", Inserted::Code),
            // Real ones of SolidWorks CAM.
            ("14MM CRB 4FL 32 LOC", Inserted::Remark),
            ("4.0mm JOBBER DRILL", Inserted::Remark),
            ("Stock Size X85. Y38. Z48.", Inserted::Remark),
            ("STOP  change fixture", Inserted::Remark),
            ("", Inserted::Remark),
            ("(M8)", Inserted::Remark),
            ("M8 TAP", Inserted::Mixed),
            ("M8 on for this", Inserted::Mixed),
            ("NOW G54", Inserted::Mixed),
            ("12 PLACES", Inserted::Remark),
            ("É 3", Inserted::Remark),
        ] {
            assert_eq!(Inserted::of(text), held, "{text}");
        }
    }
}
