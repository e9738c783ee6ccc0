//! Options as Python passes them: values by name.

use post_job::library::{NamedOption, SettingValue};
use pyo3::prelude::*;

/// A value of an option.
#[derive(FromPyObject)]
pub enum OptionInput {
    Yes(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<String>),
}

impl From<OptionInput> for SettingValue {
    fn from(given: OptionInput) -> Self {
        match given {
            OptionInput::Yes(yes) => Self::Yes(yes),
            OptionInput::Whole(number) => Self::Whole(number),
            OptionInput::Number(number) => Self::Number(number),
            OptionInput::Text(text) => Self::Text(text),
            OptionInput::List(texts) => Self::List(texts.into_iter().map(Self::Text).collect()),
        }
    }
}

/// Options for a job.
pub fn told(options: Vec<(String, OptionInput)>) -> Vec<NamedOption> {
    options.into_iter().map(|(name, given)| (name, given.into())).collect()
}
