//! Words without a meaning of their own, and `INSERT`: carried out by a rule of the machine file, left out, or refused.

use post_grammar::text::{as_remark, escaped, excerpt, is_unprintable};
use post_grammar::{Argument, Record, UnknownPath, WordUsage};
use post_machine::description::{Insert, Print};
use post_machine::diagnostic::{Diagnostic, SourcePlace};

use super::{ClInterpreter, SHOWN_NAME, StepSink, record_place};
use crate::program::{Command, ProgramStep, UnknownWordPolicy};

/// A record that may carry a path.
#[derive(Debug)]
pub(super) struct SuspectRecord {
    word: String,
    place: SourcePlace,
}

/// Largest number of suspects that are reported.
const MOST_SUSPECTS: usize = 100;

impl ClInterpreter {
    pub(super) fn other_word(
        &mut self,
        record: &Record<'_>,
        word: &str,
        arguments: &[Argument],
        directive: bool,
        emit: &mut StepSink<'_>,
    ) {
        self.writer.word(word);
        self.wants_fini |= directive || self.writer.is_camworks();
        // A directive is meant for another program.
        if !directive && self.by_rule(record, word, arguments, emit) {
            return;
        }
        if record.statement.unknown_path().is_some() && self.carries_path(record, word) {
            return;
        }
        let usage = record.statement.usage();
        if matches!(usage, WordUsage::Refused | WordUsage::Unknown) && self.reading.allows(word) {
            self.allow(word, "is left out", record);
            return;
        }
        if usage == WordUsage::Refused {
            self.fault(
                record,
                "refused-word",
                format!("{word} changes where or whether metal is cut, and post does not know how"),
                &format!("let the CAM system write the result instead; [cl.words] in the machine file gives its lines of the program, --allow {word} leaves it out"),
            );
        }
        self.count(word, record, usage);
        if usage == WordUsage::Unknown && self.reading.unknown == UnknownWordPolicy::Pass {
            emit(ProgramStep::Command(Command::Comment(as_remark(record.text().into_owned()))));
        }
    }

    /// A record that may carry a path and is not known here; false if it may be left out all the same, since the
    /// tool has not moved yet.
    fn carries_path(&mut self, record: &Record<'_>, word: &str) -> bool {
        if record.statement.unknown_path() == Some(UnknownPath::Word) {
            self.fault(
                record,
                "refused-word",
                format!("{word} moves the tool, or says which records do, and post does not know this form of it: it cannot be left out"),
                match word {
                    "THREAD" | "PITCH" => "[cl.words] in the machine file gives the control's own words for a thread: a feed move does not hold the angle of the spindle",
                    _ => "let the CAM system write GOTO and CIRCLE instead; [cl.words] in the machine file gives the lines of the program that it stands for",
                },
            );
            return true;
        }
        if self.moved && self.suspects.len() < MOST_SUSPECTS {
            self.due = true;
            self.suspects.push(SuspectRecord {
                word: word.to_owned(),
                place: record_place(&self.reading.file, record),
            });
        }
        self.moved
    }

    /// A move follows: what may carry a path stands between moves.
    pub(super) fn refuse_suspects(&mut self) {
        for SuspectRecord { word, place } in std::mem::take(&mut self.suspects) {
            let message = format!(
                "{word} is not a word that post knows, and stands with its numbers between moves: it may be a move itself, and cannot be left out"
            );
            let help = "let the CAM system write GOTO and CIRCLE instead; [cl.words] in the machine file gives the lines of the program that it stands for";
            let finding = Diagnostic::error("unknown-path", message).help(help);
            self.findings.push(finding.at(Some(place)));
        }
    }

    /// The file ends: no move follows, so that the records are as any other that is not known.
    pub(super) fn clear_suspects(&mut self) {
        for SuspectRecord { word, place } in std::mem::take(&mut self.suspects) {
            match self.reading.allows(&word) {
                true => self.census.allow(&word, "is left out", place),
                false => {
                    // Full, it was said.
                    let _ = self.census.count(&word, WordUsage::Unknown, || place);
                }
            }
        }
    }

    /// Writes the lines that the machine file has for the word; false if it has none.
    pub(super) fn by_rule(
        &mut self,
        record: &Record<'_>,
        word: &str,
        arguments: &[Argument],
        emit: &mut StepSink<'_>,
    ) -> bool {
        let fitting =
            self.reading.rules.iter().filter_map(|rule| Some((rule.fits(word, arguments)?, rule)));
        let Some((_, rule)) = fitting.max_by_key(|(words, _)| *words) else {
            return false;
        };
        match rule.lines(arguments, self.scale) {
            Ok(lines) => {
                self.load_told(record, emit);
                for line in lines {
                    emit(ProgramStep::Command(Command::Literal(line)));
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

    /// A line of the program, letter for letter, from a `word` that `key` of the machine file says it of.
    pub(super) fn literal(
        &mut self,
        record: &Record<'_>,
        word: &str,
        key: &str,
        text: &str,
        emit: &mut StepSink<'_>,
    ) {
        // Tabs are blanks, here as in all of a CL file.
        let text = text.replace('\t', " ");
        match text.chars().find(|letter| is_unprintable(*letter)) {
            None => emit(ProgramStep::Command(Command::Literal(text))),
            Some(odd) => self.fault(
                record,
                "insert",
                format!(
                    "{word} {} would be a line of the program, and U+{:04X} in it ends a line or hides text",
                    escaped(&excerpt(&text, SHOWN_NAME), &[]),
                    u32::from(odd)
                ),
                &format!("take the character out, or let {word} be a remark: --set {key}=comment"),
            ),
        }
    }

    /// A text for the operator, or a line of the program.
    pub(super) fn print(&mut self, record: &Record<'_>, text: &str, emit: &mut StepSink<'_>) {
        let command = match self.reading.print {
            Print::Literal => return self.literal(record, "PPRINT", "control.print", text, emit),
            Print::Message => Command::Message(as_remark(text.to_owned())),
            Print::Comment => Command::Comment(as_remark(text.to_owned())),
        };
        emit(ProgramStep::Command(command));
    }

    /// A line of the user's own.
    pub(super) fn insert(&mut self, record: &Record<'_>, text: &str, emit: &mut StepSink<'_>) {
        if self.reading.insert == Insert::Literal {
            return self.literal(record, "INSERT", "control.insert", text, emit);
        }
        let text = text.replace('\t', " ");
        let shown = escaped(&excerpt(&text, SHOWN_NAME), &[]).into_owned();
        match InsertContent::of(&text) {
            InsertContent::Remark => {}
            InsertContent::Code if self.reading.allows("INSERT") => {
                self.allow("INSERT", "is written as a remark", record);
            }
            InsertContent::Code => self.fault(
                record,
                "insert",
                format!("INSERT {shown} is a line for the control, and would be written as a remark"),
                "--set control.insert=literal writes what INSERT holds as lines of the program; --allow INSERT as remarks",
            ),
            InsertContent::Mixed => self.warn(
                record,
                "insert",
                format!("INSERT {shown} is written as a remark, and holds a G or M word"),
            ),
        }
        emit(ProgramStep::Command(Command::Comment(as_remark(text))));
    }
}

/// What an `INSERT` holds. SolidWorks CAM describes tools and stock with it (`14MM CRB 4FL 32 LOC`,
/// `Stock Size X85. Y38. Z48.`), others hand words to the control (`M8`, `G04 X2.`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InsertContent {
    /// Something to read.
    Remark,
    /// Nothing but words of a program: letters with numbers, or variables that are set.
    Code,
    /// Something to read that has a G or M word in it: `M8 TAP`, but also `M8 ON`.
    Mixed,
}

impl InsertContent {
    /// What the text of an `INSERT` is.
    pub fn of(text: &str) -> Self {
        let code = without_remarks(text);
        if is_statement(&code) {
            return Self::Code;
        }
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

/// What lines of a program begin with that have no words of a letter and a number: those of conversational controls,
/// and what calls, repeats, jumps or moves the frame. `#` stands for a number, `…` for the rest of a line.
const STATEMENTS: &[&str] = &[
    // Conversational
    "CALL LBL …",
    "CALL PGM …",
    "CALL SELECTED …",
    "LBL # …",
    "CYCL DEF …",
    "CYCL CALL …",
    "TOOL CALL …",
    "TOOL DEF …",
    "FN # …",
    "PLANE RESET …",
    "PLANE SPATIAL …",
    "FUNCTION …",
    "L X# …",
    "L Y# …",
    "L Z# …",
    // Names with parentheses and `=`
    "TRAORI …",
    "TRAFOOF …",
    "TRANS X# …",
    "TRANS Y# …",
    "TRANS Z# …",
    "ATRANS …",
    "ROT X# …",
    "ROT Y# …",
    "ROT Z# …",
    "AROT …",
    "SUPA …",
    "GOTOF …",
    "GOTOB …",
    // Macros and RS-274
    "GOTO # …",
    "IF [ …",
    "IF # …",
    "WHILE [ …",
];

/// The text begins as one of [`STATEMENTS`].
fn is_statement(text: &str) -> bool {
    // A variable is a number: `#1`; what opens an expression stands by itself.
    let spaced = text.to_ascii_uppercase().replace('[', " [ ");
    let is_number = |piece: &str| {
        let digits = piece.trim_start_matches(['+', '-', '#', 'Q', 'R']);
        digits.starts_with(|first: char| first.is_ascii_digit() || first == '.')
    };
    STATEMENTS.iter().any(|form| {
        let mut pieces = spaced.split_whitespace();
        form.split(' ').all(|wanted| {
            let piece = pieces.next();
            match (wanted.strip_suffix('#'), piece) {
                _ if wanted == "…" => true,
                (_, None) => false,
                (Some(letter), Some(piece)) => piece.strip_prefix(letter).is_some_and(is_number),
                (None, Some(piece)) => piece == wanted,
            }
        })
    })
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
