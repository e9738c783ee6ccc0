//! The options that a machine file has for plugins.

use std::collections::BTreeMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::layers::MachineSources;
use super::limits::MOST_OPTIONS;
use super::{GivenOption, OptionValue};
use crate::diagnostic::Diagnostic;

/// Sub-tables of `[control]` that are the machine's own: no dialect has such a name.
const OWN: [&str; 5] = ["arcs", "leave", "retract", "change", "park"];

/// Takes the sub-tables of `[section]` out: they belong to plugins, and only those know their keys.
pub(super) fn take_options(
    table: &mut Spanned<DeTable<'_>>,
    section: &str,
    sources: &MachineSources,
    faults: &mut Vec<Diagnostic>,
) -> BTreeMap<String, Vec<GivenOption>> {
    let mut taken = BTreeMap::new();
    let Some(DeValue::Table(table)) = table.get_mut().get_mut(section).map(Spanned::get_mut) else {
        return taken;
    };
    let names: Vec<String> = table
        .iter()
        .filter(|(_, value)| value.get_ref().is_table())
        .map(|(key, _)| key.get_ref().to_string())
        .filter(|key| !OWN.contains(&key.as_str()))
        .collect();
    for name in names {
        let Some(DeValue::Table(options)) = table.remove(name.as_str()).map(Spanned::into_inner)
        else {
            continue;
        };
        if options.len() > MOST_OPTIONS {
            let message = format!(
                "[{section}.{name}] has {} options; at most {MOST_OPTIONS} are possible",
                options.len()
            );
            let first = options.keys().next().map_or(0..0, Spanned::span);
            let place = sources.place(first);
            faults.push(Diagnostic::error("machine-option", message).at(place));
            continue;
        }
        let mut given = Vec::new();
        for (key, value) in options {
            let place = sources.place(key.span());
            let text = text_or_lines(value.get_ref());
            let value = match value.get_ref() {
                DeValue::Boolean(flag) => Some(OptionValue::Flag(*flag)),
                DeValue::Integer(number) => {
                    i64::from_str_radix(&number.as_str().replace('_', ""), number.radix())
                        .ok()
                        .map(OptionValue::Integer)
                }
                DeValue::Float(number) => number
                    .as_str()
                    .replace('_', "")
                    .parse()
                    .ok()
                    .filter(|number: &f64| number.is_finite())
                    .map(OptionValue::Number),
                _ => text.map(OptionValue::Text),
            };
            match value {
                Some(value) => given.push(GivenOption {
                    key: key.into_inner().into_owned(),
                    value,
                    place,
                }),
                None => faults.push(
                    Diagnostic::error(
                        "machine-option",
                        format!(
                            "{} of [{section}.{name}] takes a flag, a number, a text or an array of lines",
                            key.get_ref()
                        ),
                    )
                    .at(place),
                ),
            }
        }
        taken.insert(name, given);
    }
    taken
}

/// A text; or lines of one each, as one text with line feeds between.
fn text_or_lines(value: &DeValue<'_>) -> Option<String> {
    let DeValue::Array(lines) = value else {
        return value.as_str().map(str::to_owned);
    };
    let lines: Option<Vec<&str>> = lines.iter().map(|line| line.get_ref().as_str()).collect();
    Some(lines?.join("\n"))
}
