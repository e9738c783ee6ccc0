//! One template: read once, checked, and filled as often as its place comes.

use std::fmt;
use std::io::{self, Write};
use std::ops::Range;
use std::sync::{Arc, LazyLock};

use minijinja::value::{Serde, Value, ValueKind};
use minijinja::{Environment, Error, ErrorKind, UndefinedBehavior};
use post_grammar::text::is_unprintable;

use super::Facts;

/// Instructions of one filling. A line for each of a hundred tools takes some thousand.
const FUEL: u64 = 200_000;

/// Bytes that one filling writes at most.
const MOST_BYTES: usize = 1 << 16;

/// Bytes of a template.
const MOST_TEXT: usize = 1 << 14;

/// Bytes of a text of the facts that are printed.
const MOST_FACT: usize = 200;

/// Letters that end a remark, begin one, or mean something else in a line of a program: in a text of the CL file they
/// are printed as blanks, so that the name of an operation cannot become a line of the program.
const MEANT: &[char] = &['(', ')', '[', ']', '{', '}', ';', '"', '%', '#', '=', '~', '*', '/'];

/// A template that was read and checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextTemplate {
    source: Arc<str>,
}

/// What is wrong with a template.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TemplateFault {
    /// A sentence.
    pub message: String,
    /// Which bytes of the template; none if nobody knows.
    pub span: Option<Range<usize>>,
}

impl TextTemplate {
    /// Reads lines that are one template.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(source: &str) -> Result<Self, TemplateFault> {
        if source.len() > MOST_TEXT {
            return Err(TemplateFault {
                message: format!(
                    "a template of {} bytes: at most {MOST_TEXT} are possible",
                    source.len()
                ),
                span: None,
            });
        }
        check_tags(source)?;
        ENVIRONMENT
            .template_from_str(source)
            .map(|_| Self { source: source.into() })
            .map_err(|error| fault(&error))
    }

    /// The text that it was read from.
    pub(super) fn source(&self) -> &str {
        &self.source
    }

    /// Its lines with these facts; those without a letter are left out.
    ///
    /// # Errors
    /// A fact that is not known, work or text without end, a letter that no line of a program holds.
    pub fn lines(&self, facts: &Facts) -> Result<Vec<String>, TemplateFault> {
        let mut text = Bounded(Vec::new());
        let template =
            ENVIRONMENT.template_from_str(&self.source).map_err(|error| fault(&error))?;
        let facts = Value::from(Serde(facts));
        let filled = template.render_captured_to(facts, &mut text);
        if let Err(error) = filled {
            return Err(match text.0.len() > MOST_BYTES {
                true => TemplateFault {
                    message: format!("it writes more than {MOST_BYTES} bytes"),
                    span: None,
                },
                false => fault(&error),
            });
        }
        let text = String::from_utf8_lossy(&text.0);
        let lines = text.split('\n').map(str::trim_end);
        let lines: Vec<String> =
            lines.filter(|line| !line.trim().is_empty()).map(str::to_owned).collect();
        if let Some(odd) =
            lines.iter().flat_map(|line| line.chars()).find(|letter| is_unprintable(*letter))
        {
            return Err(TemplateFault {
                message: format!(
                    "it writes U+{:04X}, which ends a line or hides text",
                    u32::from(odd)
                ),
                span: None,
            });
        }
        Ok(lines)
    }
}

/// Text that ends.
struct Bounded(Vec<u8>);

impl Write for Bounded {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.extend_from_slice(bytes);
        if self.0.len() > MOST_BYTES {
            return Err(io::Error::other("too much text"));
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

static ENVIRONMENT: LazyLock<Environment<'static>> = LazyLock::new(|| {
    let mut environment = Environment::empty();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_fuel(Some(FUEL));
    environment.set_formatter(|out, _, value| match value.kind() {
        ValueKind::Number => write!(out, "{value}").map_err(Error::from),
        ValueKind::String => {
            let text = value.as_str().unwrap_or_default();
            let text = post_grammar::text::excerpt(text, MOST_FACT);
            let plain: String =
                text.chars()
                    .map(|letter| {
                        if MEANT.contains(&letter) || is_unprintable(letter) { ' ' } else { letter }
                    })
                    .collect();
            write!(out, "{plain}").map_err(Error::from)
        }
        ValueKind::None | ValueKind::Undefined => Err(Error::new(
            ErrorKind::UndefinedError,
            "it is not known here: `{% if … is not none %}` asks",
        )),
        kind => Err(Error::new(
            ErrorKind::InvalidOperation,
            format!("a {kind} cannot be printed, only numbers and texts"),
        )),
    });
    environment.add_filter("fixed", fixed);
    environment.add_filter("upper", |text: &str| text.to_uppercase());
    environment.add_filter("lower", |text: &str| text.to_lowercase());
    environment.add_filter("clock", clock);
    environment.add_test("none", |value: &Value| value.is_none());
    environment
});

/// `{{ 12.5 | fixed(3) }}`: 12.500.
fn fixed(value: f64, decimals: u8) -> Result<String, Error> {
    if !value.is_finite() || decimals > 9 {
        return Err(Error::new(
            ErrorKind::InvalidOperation,
            "fixed takes a number and 0 to 9 decimals",
        ));
    }
    let text = format!("{value:.*}", usize::from(decimals));
    let zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    Ok(if zero { text.trim_start_matches('-').to_owned() } else { text })
}

/// Seconds as hours, minutes and seconds: `1:02:03`.
fn clock(seconds: f64) -> Result<String, Error> {
    if !(0.0..1e9).contains(&seconds) {
        return Err(Error::new(ErrorKind::InvalidOperation, "clock takes seconds"));
    }
    let seconds = libm::rint(seconds) as u64;
    Ok(format!("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60))
}

/// An error of the engine in a sentence.
fn fault(error: &Error) -> TemplateFault {
    let message = match (error.kind(), error.detail()) {
        (ErrorKind::OutOfFuel, _) => "it does not come to an end".to_owned(),
        (ErrorKind::UndefinedError, None) => "there is no such fact here".to_owned(),
        (ErrorKind::UndefinedError, Some(detail)) => detail.to_owned(),
        (kind, None) => kind.to_string(),
        (kind, Some(detail)) => format!("{kind}: {detail}"),
    };
    TemplateFault { message, span: error.range() }
}

/// What stands in a tag.
const STATEMENTS: &[&str] = &["if", "elif", "else", "endif", "for", "endfor"];

/// Refuses what could carry a text from one turn of a loop to the next, or double it: the engine bounds instructions, and
/// a few dozen of them would do. A text is then never longer than the template times a fact.
fn check_tags(source: &str) -> Result<(), TemplateFault> {
    let mut at = 0;
    while let Some(start) = source[at..].find('{').map(|found| at + found) {
        let inside = start + 2;
        let end = match source.as_bytes().get(start + 1) {
            Some(b'#') => source[inside..].find("#}").map_or(source.len(), |end| inside + end),
            Some(b'{') => check_tag(source, inside, "}}")?,
            Some(b'%') => {
                let end = check_tag(source, inside, "%}")?;
                check_statement(source, inside..end)?;
                end
            }
            _ => {
                at = start + 1;
                continue;
            }
        };
        at = (end + 2).min(source.len());
    }
    Ok(())
}

/// The end of a tag that begins at `from`, behind its texts in quotes.
fn check_tag(source: &str, from: usize, close: &str) -> Result<usize, TemplateFault> {
    let mut quote = None;
    let mut letters = source[from..].char_indices();
    while let Some((place, letter)) = letters.next() {
        let place = from + place;
        match (quote, letter) {
            (Some(_), '\\') => {
                letters.next();
            }
            (Some(open), _) if open == letter => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '*') => {
                return Err(TemplateFault {
                    message: "a template cannot multiply".to_owned(),
                    span: Some(place..place + 1),
                });
            }
            (None, _) if source[place..].starts_with(close) => return Ok(place),
            (None, _) => {}
        }
    }
    Ok(source.len())
}

/// A statement is one of a few, and a loop goes over a list of the facts.
fn check_statement(source: &str, tag: Range<usize>) -> Result<(), TemplateFault> {
    let text = source[tag.clone()].trim_matches(['-', '+']).trim();
    let word = text.split_whitespace().next().unwrap_or_default();
    let fault = |message: String| Err(TemplateFault { message, span: Some(tag.clone()) });
    if !STATEMENTS.contains(&word) {
        return fault(format!("there is no `{word}` here; there are {}", STATEMENTS.join(", ")));
    }
    let name =
        |piece: &str| piece.chars().all(|letter| letter.is_alphanumeric() || "_.".contains(letter));
    let pieces: Vec<&str> = text.split_whitespace().collect();
    match pieces.as_slice() {
        ["for", one, "in", list] if name(one) && name(list) => Ok(()),
        ["for", ..] => {
            fault("a loop goes over a list of the facts: `for tool in program.tools`".to_owned())
        }
        _ => Ok(()),
    }
}

impl fmt::Display for TemplateFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.message.fmt(formatter)
    }
}

impl std::error::Error for TemplateFault {}
