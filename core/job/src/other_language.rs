//! A program in the language of another control: said once, and not block by block.

use std::io::{self, Read, Seek, SeekFrom};

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_plugin::Language;

/// So many bytes of a program show its language.
const HEAD: u64 = 1 << 13;

/// Words that no control but SINUMERIK has.
const NAMES: &[&str] = &["SUPA", "TRAFOOF", "TRAORI", "MCALL", "G500", "G710", "CYCLE800"];

/// Refuses the program `name` in `input`, from where it stands, if it is in another language than the control of `machine`
/// `reads`; nothing of it is read then.
///
/// # Errors
/// It is, or it cannot be read.
pub fn refuse(
    machine: &Machine,
    reads: Language,
    name: &str,
    input: &mut (impl Read + Seek),
) -> Result<(), Box<Diagnostic>> {
    let head = head(input).map_err(|error| {
        Diagnostic::error("input", format!("{name} cannot be read: {error}")).boxed()
    })?;
    let Some(written) = other_than(reads, &head) else {
        return Ok(());
    };
    let message = format!(
        "{name} is {}, and {}, whose dialect is {}, reads {}",
        called(written),
        machine.name,
        machine.control.dialect,
        called(reads),
    );
    let help = "name the machine that it was written for, or its control by --dialect; `post convert` makes a program of this machine of it";
    let place = Some(SourcePlace::new(name, 1, "", 0..0));
    Err(Diagnostic::error("nc-language", message).help(help).at(place).boxed())
}

fn head(input: &mut (impl Read + Seek)) -> io::Result<String> {
    let begin = input.stream_position()?;
    let mut bytes = Vec::new();
    input.by_ref().take(HEAD).read_to_end(&mut bytes)?;
    input.seek(SeekFrom::Start(begin))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The language of a text, where it is surely another than `reads`.
fn other_than(reads: Language, head: &str) -> Option<Language> {
    let conversational = head.contains("BEGIN PGM") || head.contains("TOOL CALL");
    let lines = || head.lines().map(first_words);
    // `O1000`, or G codes: neither stands first in a block of conversational words.
    let numbered = |word: &str, letter: char| {
        let number = word.strip_prefix(letter);
        number.is_some_and(|number| number.starts_with(|next: char| next.is_ascii_digit()))
    };
    let of_letters = || lines().any(|[first, _]| numbered(first, 'G') || numbered(first, 'O'));
    let of_joints =
        || lines().any(|[first, _]| matches!(first, "MoveAbsJ" | "MODULE" | "PTP" | "&ACCESS"));
    let of_names = || lines().flatten().any(|word| NAMES.contains(&word));
    match reads {
        Language::Conversational if conversational => None,
        Language::Conversational if of_names() => Some(Language::Names),
        Language::Conversational => of_letters().then_some(Language::Macro),
        _ if head.contains("BEGIN PGM") => Some(Language::Conversational),
        Language::Macro | Language::Names if of_joints() => Some(Language::Joints),
        Language::Names => {
            let titled = lines().any(|[first, _]| numbered(first, 'O'));
            (titled && !of_names()).then_some(Language::Macro)
        }
        Language::Macro => of_names().then_some(Language::Names),
        Language::Rs274 | Language::Instructions => None,
        Language::Joints => of_letters().then_some(Language::Macro),
    }
}

/// The first two words of a block, behind its number.
fn first_words(line: &str) -> [&str; 2] {
    let mut words = line.split_whitespace().filter(|word| {
        let number = word.trim_start_matches('N');
        number.is_empty() || !number.bytes().all(|byte| byte.is_ascii_digit())
    });
    [words.next().unwrap_or_default(), words.next().unwrap_or_default()]
}

/// How messages call programs of a language.
fn called(language: Language) -> &'static str {
    match language {
        Language::Macro => "a program of words and letters, as Fanuc reads it",
        Language::Rs274 => "a program of words and letters, as LinuxCNC reads it",
        Language::Names => "a SINUMERIK program",
        Language::Conversational => "a Heidenhain conversational program",
        Language::Instructions => "a program of words and instructions, as Fagor and ISG read it",
        Language::Joints => "a program of a robot's statements",
    }
}
