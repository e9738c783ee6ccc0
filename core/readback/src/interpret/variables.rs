//! Variables of a program.

use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;

use crate::lexicon::Language;

/// The variables that a program has set.
#[derive(Clone, Debug, Default)]
pub(super) struct Variables {
    language: Language,
}

impl Variables {
    /// None is set.
    pub fn new(language: Language) -> Self {
        Self { language }
    }

    /// The number that a value stands for; of a position approached in a way of its own the position.
    pub fn worth(&self, value: &NcValue) -> Result<f64, Box<Diagnostic>> {
        match value {
            NcValue::Number(number) => Ok(number.value),
            NcValue::Approached(_, inner) => self.worth(inner),
            NcValue::Expression(_) | NcValue::Text(_) => Err(Diagnostic::error(
                "nc-variable",
                format!("variables of {:?} are not worked out", self.language),
            )
            .boxed()),
        }
    }
}
