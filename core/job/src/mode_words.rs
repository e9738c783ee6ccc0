//! The words of `[mode.face]` and `[mode.wrap]`, held against what the dialect says that they mean.

use post_host::OpenedDialect;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Meaning, VocabularyWord};

/// A mode of a machine file: its key, the lines that begin it, and what a word of them must mean.
struct ModeBegin<'m> {
    key: &'static str,
    on: &'m [String],
    /// The letter of the word of the mode, that of the turning axis outside, and whether the word is a length.
    letter: &'m str,
    own: &'m str,
    is_length: bool,
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
        letter: &face.letter,
        own: &machine.axes[face.turning].name,
        is_length: true,
        meaning: Meaning::FaceTransformation,
        what: "polar interpolation",
    });
    let wrap = wrap.map(|wrap| ModeBegin {
        key: "mode.wrap",
        on: &wrap.on,
        letter: &wrap.letter,
        own: &machine.axes[wrap.turning].name,
        is_length: wrap.lengths,
        meaning: Meaning::CylinderTransformation,
        what: "cylinder interpolation",
    });
    let mut modes = face.into_iter().chain(wrap).peekable();
    modes.peek()?;
    let words = dialect.vocabulary().unwrap_or_default();
    if words.is_empty() {
        return None;
    }
    let name = &machine.control.dialect;
    let wrong = modes.find_map(|mode| mode.wrong(name, &words))?;
    Some(wrong.at(machine.control.dialect_place.clone()))
}

impl ModeBegin<'_> {
    /// What is wrong with it at the dialect of that name.
    fn wrong(&self, name: &str, words: &[VocabularyWord]) -> Option<Diagnostic> {
        let ModeBegin { key, on, meaning, what, .. } = self;
        let said = format!("[{key}] on = \"{}\"", on.join(" "));
        let Some((line, code)) = self.begun_by(words) else {
            let message = format!("{said}: dialect {name} knows no word of it that begins {what}");
            let alone = |word: &&VocabularyWord| !word.word.contains(' ');
            let known = words.iter().filter(|word| word.meaning == *meaning).filter(alone);
            let known = known.map(|word| word.word.as_ref()).collect::<Vec<_>>().join(", ");
            let help = match known.is_empty() {
                true => format!("{name} has none that is known here: leave [{key}] out"),
                false => format!("{name} has {known}"),
            };
            return Some(Diagnostic::error("machine-mode", message).help(help));
        };
        // Letters that the dialect has beside the code: of a radius or diameter in its block, and of the mode's own word.
        let beside = |word: &VocabularyWord| {
            let letter = word.word.strip_prefix(code.as_str())?.strip_prefix(' ')?.chars().next();
            letter.filter(|_| word.meaning == *meaning)
        };
        let (sizes, letters): (Vec<char>, Vec<char>) =
            words.iter().filter_map(beside).partition(|letter| SIZES.contains(letter));
        let has = |letter: &char| tokens(&line).any(|token| token.starts_with(*letter));
        if !sizes.is_empty() && !sizes.iter().any(has) {
            let listed = listed(&sizes);
            let message =
                format!("{said}: dialect {name} reads {listed} beside {code}, and there is none");
            let help = format!(
                "on = \"{code} Y0 {}0 R{{r}}\": the letter whose words are laid along the cylinder (letter = \"Y\", lengths = true), that of the turning axis, the radius",
                self.own
            );
            return Some(Diagnostic::error("machine-mode", message).help(help));
        }
        let behind = format!("{said}: behind {code} the word of dialect {name}");
        self.wrong_word(&behind, &letters)
    }

    /// What is wrong with its word, where the dialect has it behind one of these `letters`; `behind` begins the message. Without
    /// letters the word of the turning axis is it: a length on a face, degrees on a cylinder.
    fn wrong_word(&self, behind: &str, letters: &[char]) -> Option<Diagnostic> {
        let ModeBegin { key, letter, own, is_length, meaning, .. } = *self;
        let is_own = letters.is_empty();
        let right = match is_own {
            true => letter == own,
            false => letters.iter().any(|known| letter.chars().eq([*known])),
        };
        let length = meaning == Meaning::FaceTransformation || !is_own;
        if right && is_length == length {
            return None;
        }
        let wants = if is_own { own.to_owned() } else { listed(letters) };
        let kind = |length| if length { "a length" } else { "an angle" };
        let message = format!(
            "{behind} is {wants}, {}, and [{key}] makes it {letter}, {}",
            kind(length),
            kind(is_length)
        );
        let first = letters.first().map_or_else(|| own.to_owned(), char::to_string);
        let help = match meaning {
            Meaning::FaceTransformation => format!("letter = \"{first}\""),
            _ => format!("letter = \"{first}\", lengths = {length}"),
        };
        Some(Diagnostic::error("machine-mode", message).help(help))
    }

    /// The line, in capitals, and the code of it that begins the mode.
    fn begun_by(&self, words: &[VocabularyWord]) -> Option<(String, String)> {
        let begins = |token: &str| {
            let same = |word: &&VocabularyWord| word.word == token;
            words.iter().find(same).is_some_and(|word| word.meaning == self.meaning)
        };
        self.on.iter().map(|line| line.to_uppercase()).find_map(|line| {
            let code = tokens(&line).map(without_zeros).find(|token| begins(token))?;
            Some((line, code))
        })
    }
}

/// Letters of a radius and a diameter.
const SIZES: [char; 2] = ['R', 'Q'];

/// Letters, as messages have them.
fn listed(letters: &[char]) -> String {
    letters.iter().map(char::to_string).collect::<Vec<_>>().join(" or ")
}

/// The words of a line of the program.
fn tokens(line: &str) -> impl Iterator<Item = &str> {
    line.split(|letter: char| !letter.is_alphanumeric() && letter != '.')
}

/// A code without the zeros in front of its number: G07.1 is G7.1.
fn without_zeros(token: &str) -> String {
    let digits = token.trim_start_matches(|letter: char| letter.is_alphabetic());
    let letters = &token[..token.len() - digits.len()];
    format!("{letters}{}", digits.trim_start_matches('0'))
}
