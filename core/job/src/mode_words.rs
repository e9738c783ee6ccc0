//! The words of `[mode.face]` and `[mode.wrap]`, held against what the dialect says that they mean.

use post_host::OpenedDialect;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Meaning, VocabularyWord};

/// A mode of a machine file: its key, the lines that begin it, and what a word of them must mean.
struct ModeBegin<'m> {
    key: &'static str,
    on: &'m [String],
    meaning: Meaning,
    what: &'static str,
}

/// Refuses a mode whose lines begin with no word that begins it at this control: programs would be written that no reader
/// follows. A dialect that tells no vocabulary is believed.
pub(super) fn unknown(machine: &Machine, dialect: &mut OpenedDialect) -> Option<Diagnostic> {
    let face = machine.in_face().and_then(|(_, face)| face.face.as_ref());
    let wrap = machine.in_wrap().and_then(|(_, wrap)| wrap.wrap.as_ref());
    let face = face.map(|face| ModeBegin {
        key: "mode.face",
        on: &face.on,
        meaning: Meaning::FaceTransformation,
        what: "polar interpolation",
    });
    let wrap = wrap.map(|wrap| ModeBegin {
        key: "mode.wrap",
        on: &wrap.on,
        meaning: Meaning::CylinderTransformation,
        what: "cylinder interpolation",
    });
    let mut modes = face.into_iter().chain(wrap).peekable();
    modes.peek()?;
    let words = dialect.vocabulary().unwrap_or_default();
    let wrong = modes.find(|mode| !words.is_empty() && !mode.is_begun_by(&words))?;
    let ModeBegin { key, on, meaning, what } = wrong;
    let (name, on) = (&machine.control.dialect, on.join(" "));
    let message =
        format!("[{key}] on = \"{on}\": dialect {name} knows no word of it that begins {what}");
    let known = words.iter().filter(|word| word.meaning == meaning).map(|word| word.word.as_ref());
    let help = match known.collect::<Vec<_>>().join(", ") {
        known if known.is_empty() => {
            format!("{name} has none that is known here: leave [{key}] out")
        }
        known => format!("{name} has {known}"),
    };
    let place = machine.control.dialect_place.clone();
    Some(Diagnostic::error("machine-mode", message).help(help).at(place))
}

impl ModeBegin<'_> {
    fn is_begun_by(&self, words: &[VocabularyWord]) -> bool {
        let begins = |token: &str| {
            let same = |word: &&VocabularyWord| word.word == token;
            words.iter().find(same).is_some_and(|word| word.meaning == self.meaning)
        };
        self.on.iter().any(|line| {
            let line = line.to_uppercase();
            let mut tokens = line.split(|letter: char| !letter.is_alphanumeric() && letter != '.');
            tokens.any(|token| begins(&without_zeros(token)))
        })
    }
}

/// A code without the zeros in front of its number: G07.1 is G7.1.
fn without_zeros(token: &str) -> String {
    let digits = token.trim_start_matches(|letter: char| letter.is_alphabetic());
    let letters = &token[..token.len() - digits.len()];
    format!("{letters}{}", digits.trim_start_matches('0'))
}
