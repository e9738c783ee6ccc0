//! Options as Python passes them: values by name.

use post_job::library::{OptionTold, Value};
use pyo3::prelude::*;

/// A value of an option.
#[derive(FromPyObject)]
pub enum Given {
    Yes(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<String>),
}

impl From<Given> for Value {
    fn from(given: Given) -> Self {
        match given {
            Given::Yes(yes) => Self::Yes(yes),
            Given::Whole(number) => Self::Whole(number),
            Given::Number(number) => Self::Number(number),
            Given::Text(text) => Self::Text(text),
            Given::List(texts) => Self::List(texts.into_iter().map(Self::Text).collect()),
        }
    }
}

/// Options for a job.
pub fn told(options: Vec<(String, Given)>) -> Vec<OptionTold> {
    options.into_iter().map(|(name, given)| (name, given.into())).collect()
}
