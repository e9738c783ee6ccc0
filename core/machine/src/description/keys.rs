//! Keys and words of a machine file that it does not have: all of them, each with what was likely meant.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::Axis;
use super::file::MachineFile;
use super::layers::Sources;
use crate::diagnostic::{Diagnostic, meant};

/// Unknown keys of one file that are told, each by itself.
const MOST: usize = 20;

/// What the merged table says.
///
/// # Errors
/// All keys that are not known, and the first value that is of another kind than its key asks for.
pub(super) fn typed(
    mut table: Spanned<DeTable<'_>>,
    sources: &Sources,
) -> Result<MachineFile, Vec<Diagnostic>> {
    let mut faults = Vec::new();
    loop {
        // Reading ends at its first fault: an unknown key is taken out, and the rest read again.
        let error = match MachineFile::deserialize(Deserializer::from(table.clone())) {
            Ok(file) if faults.is_empty() => return Ok(file),
            Ok(_) => return Err(faults),
            Err(error) => error,
        };
        let place = error.span().and_then(|span| sources.place(span));
        let (message, help) = explained(error.message());
        let mut fault = Diagnostic::error("machine-key", message).at(place);
        fault.help = help;
        faults.push(fault);
        let known = error
            .span()
            .is_some_and(|span| error.message().starts_with(FIELD) && take(table.get_mut(), &span));
        if !known || faults.len() == MOST {
            return Err(faults);
        }
    }
}

/// How serde begins what it says of a key, and of a word in place of one of a few.
const FIELD: &str = "unknown field `";
const VARIANT: &str = "unknown variant `";

/// serde's words in those of a machine file, and what would help.
fn explained(message: &str) -> (String, Option<String>) {
    let told = [(FIELD, "there is no key"), (VARIANT, "there is no value")];
    for (start, says) in told {
        let Some((word, expected)) = message
            .strip_prefix(start)
            .and_then(|rest| rest.split_once('`'))
        else {
            continue;
        };
        // Of `one of `a`, `b`` every second piece is a name.
        let mut names: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
        if names.contains(&"chain") {
            // These are taken out before the rest is read.
            names.extend(["extends", "head"]);
        }
        return (
            format!("{says} `{word}` here"),
            Some(meant(word, "known are", &names)).filter(|_| !names.is_empty()),
        );
    }
    (message.to_owned(), None)
}

/// `its axes are C, A, Y, X, Z`.
pub(super) fn axes_are(axes: &[Axis]) -> String {
    let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
    format!("its axes are {}", names.join(", "))
}

/// Takes the key that stands at `span` out, however deep; whether there was one.
fn take(table: &mut DeTable<'_>, span: &Range<usize>) -> bool {
    let found = table.keys().find(|key| key.span() == *span);
    if let Some(name) = found.map(|key| key.get_ref().to_string()) {
        return table.remove(name.as_str()).is_some();
    }
    table.iter_mut().any(|(_, value)| match value.get_mut() {
        DeValue::Table(inner) => take(inner, span),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_serde_are_told_as_those_of_a_machine_file() {
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[expect(dead_code, reason = "only its messages are of use")]
        struct One {
            tolerance: Option<Two>,
            corner: Option<f64>,
        }
        #[derive(Debug, Deserialize)]
        #[serde(rename_all = "lowercase")]
        enum Two {
            Bisect,
            Even,
        }
        let said = |text: &str| {
            let error = toml::from_str::<One>(text).unwrap_err();
            explained(error.message())
        };
        assert_eq!(
            said("tolerence = 1"),
            (
                "there is no key `tolerence` here".to_owned(),
                Some("did you mean `tolerance`? known are tolerance, corner".to_owned())
            )
        );
        assert_eq!(
            said("tolerance = \"evn\""),
            (
                "there is no value `evn` here".to_owned(),
                Some("did you mean `even`? known are bisect, even".to_owned())
            )
        );
        let (message, help) = said("corner = \"x\"");
        assert!(message.contains("expected f64"), "{message}");
        assert_eq!(help, None);
    }
}
