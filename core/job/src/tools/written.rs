//! Tools as a text of a format.

use post_machine::description::ToolData;
use post_machine::diagnostic::Diagnostic;

use super::format::{ToolFormat, by_ending, format_named};
use crate::files::PathArg;

/// Units of the lengths of a text that is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableUnits {
    /// They are inches.
    pub inch: bool,
}

impl TableUnits {
    /// A length of so many mm in these units, to a millionth, without needless zeros; it has a decimal point.
    pub fn length(self, mm: f64) -> String {
        let value = if self.inch { mm / 25.4 } else { mm };
        let text = format!("{value:.6}");
        let text = text.trim_end_matches('0');
        let text = if text.ends_with('.') { format!("{text}0") } else { text.to_owned() };
        if text == "-0.0" { "0.0".to_owned() } else { text }
    }

    /// The same with its sign.
    pub fn signed(self, mm: f64) -> String {
        let length = self.length(mm);
        if length.starts_with('-') { length } else { format!("+{length}") }
    }
}

/// A name as a table can have it: letters and digits of old controls, none of `without`.
pub(super) fn plain_name(name: &str, without: &str) -> String {
    let plain = |letter: char| match letter {
        ' '..='~' if !without.contains(letter) => letter,
        _ => '_',
    };
    name.chars().map(plain).collect()
}

/// The text of tools in the format `named`, else in the one that `target` ends as.
///
/// # Errors
/// There is no such format, or none that is written; or something of the tools does not go into it.
pub fn write(
    tools: &[ToolData],
    target: &PathArg,
    named: Option<&str>,
    units: TableUnits,
) -> Result<(String, &'static ToolFormat), Box<Diagnostic>> {
    let format = match named {
        Some(name) => format_named(name)?,
        None => {
            let ending = target.path().and_then(|path| path.extension()).unwrap_or_default();
            by_ending(&ending.to_string_lossy()).ok_or_else(|| {
                let message = "in what format the tools are written is not said";
                Diagnostic::error("tools", message)
                    .help("--to NAME; `post tools --formats` has the names")
                    .boxed()
            })?
        }
    };
    let Some(write) = format.write else {
        let message = format!("{} is read, not written: {}", format.name, format.about);
        let help = "its own program makes more of a tool than a table of offsets has";
        return Err(Diagnostic::error("tools", message).help(help).boxed());
    };
    Ok((write(tools, units), format))
}
