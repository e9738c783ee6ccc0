//! Options of a machine file as a plugin is given them.

use post_host::GivenValue;
use post_machine::description::{GivenOption, OptionValue};

/// What is given for each key.
pub(crate) fn given(options: &[GivenOption]) -> Vec<(String, GivenValue)> {
    options
        .iter()
        .map(|option| {
            let value = match &option.value {
                OptionValue::Flag(flag) => GivenValue::Flag(*flag),
                OptionValue::Integer(number) => GivenValue::Integer(*number),
                OptionValue::Number(number) => GivenValue::Number(*number),
                OptionValue::Text(text) => GivenValue::Text(text.clone()),
            };
            (option.key.clone(), value)
        })
        .collect()
}
