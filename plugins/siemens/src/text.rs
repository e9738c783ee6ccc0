//! Calls, names and numbers as the control has them.

use post_plugin::{NumberStyle, ascii};

/// A tool by its name.
///
/// # Errors
/// If it is longer than the control's names.
pub(crate) fn called(name: &str) -> Result<String, String> {
    let plain = ascii(name).replace('"', "");
    match plain.len() {
        0..=32 => Ok(format!("T=\"{plain}\"")),
        length => Err(format!(
            "the tool's name `{name}` has {length} characters, and this control takes 32: shorten it, or leave out \
             tool_names"
        )),
    }
}

/// A message on the screen; an empty one clears it.
pub(crate) fn message(text: &str) -> String {
    match ascii(text).replace('"', "'").trim() {
        "" => "MSG()".to_owned(),
        text => format!("MSG(\"{text}\")"),
    }
}

/// A call with its arguments; those left out at the end are not written.
pub(crate) fn call(name: &str, arguments: &[String]) -> String {
    format!("{name}({})", arguments.join(",").trim_end_matches(','))
}

/// A number as an argument: at most five decimals, none that is zero at the end.
pub(crate) fn trimmed(value: f64) -> String {
    let mut text = String::new();
    let trim = NumberStyle { trim: true, ..NumberStyle::default() };
    trim.write(&mut text, value, 5);
    text
}

/// The first line of a program that is transferred by cable.
pub(crate) fn transfer_header(program: &str) -> String {
    let known = |letter: char| match letter.is_ascii_alphanumeric() {
        true => letter.to_ascii_uppercase(),
        false => '_',
    };
    let name: String = program.chars().take(24).map(known).collect();
    format!("%_N_{name}_MPF")
}

/// A subprogram that the control can call by its name.
///
/// # Errors
/// If it cannot.
pub(crate) fn callable(name: &str) -> Result<(), String> {
    let known = |letter: u8| letter.is_ascii_alphanumeric() || letter == b'_';
    let first = name.bytes().take(2).filter(|letter| !letter.is_ascii_digit());
    match name.len() <= 24 && name.bytes().all(known) && first.count() == 2 {
        true => Ok(()),
        false => Err(format!(
            "the subprogram's name `{name}` must be up to 24 letters, digits and _, two letters first"
        )),
    }
}
