//! Variables that a block sets or declares.

use post_grammar::nc::{NcBlock, NcExpression, NcItem, NcValue};
use post_plugin::Language;

use super::astray::{FlowResult, fault};
use super::variables::{VariableValue, Variables};

/// Names of a Siemens whose index says which spindle or axis is meant: no variables.
pub(super) const SETTINGS: [&str; 4] = ["S", "M", "LIMS", "ATOL"];

/// Takes what a block sets out of it, with its value as it is in front of the block; `DEF` declares at once.
pub(super) fn take(
    block: &mut NcBlock,
    language: Language,
    variables: &mut Variables,
    set: &mut Vec<(String, VariableValue)>,
) -> FlowResult<()> {
    if let Some(NcItem::Name(kind)) = block.items.first()
        && let Some(kind) = kind.strip_prefix("DEF ")
    {
        let kind = kind.to_owned();
        let items = std::mem::take(&mut block.items);
        return declare(&kind, &items[1..], variables);
    }
    // A cycle's parameters are variables too, and stay for the cycle.
    if language == Language::Conversational
        && matches!(block.items.first(), Some(NcItem::Name(name)) if name.starts_with("CYCL DEF"))
    {
        return Ok(());
    }
    let mut failed = None;
    block.items.retain(|item| {
        let found = match item {
            // The speed of a spindle, and its like.
            NcItem::Assign { variable, .. }
                if language == Language::Names
                    && matches!(&**variable, NcExpression::Indexed { name, .. }
                        if SETTINGS.contains(&name.as_str())) =>
            {
                return true;
            }
            NcItem::Assign { variable, .. }
                if language == Language::Names
                    && let NcExpression::Indexed { name, .. } = &**variable
                    && !variables.has_field(name) =>
            {
                Err(fault(&format!(
                    "`{name}[..]=` is no field that the program declares (DEF): what the control does by it is not followed"
                )))
            }
            NcItem::Assign { variable, value } => {
                let name = variables.named(variable);
                name.and_then(|name| Ok((name, variables.value(value)?)))
            }
            NcItem::Named { name, value } if variables.knows(name) => match value {
                NcValue::Expression(value) => {
                    variables.value(value).map(|value| (name.to_string(), value))
                }
                NcValue::Text(text) => Ok((name.to_string(), VariableValue::Text(text.clone()))),
                other => variables
                    .worth(other)
                    .map(|number| (name.to_string(), VariableValue::Number(number))),
            },
            _ => return true,
        };
        match found {
            Ok(found) => set.push(found),
            Err(fault) => failed = failed.take().or(Some(fault)),
        }
        false
    });
    failed.map_or(Ok(()), Err)
}

/// `DEF REAL _X, _Y=5`.
fn declare(kind: &str, items: &[NcItem], variables: &mut Variables) -> FlowResult<()> {
    for item in items {
        match item {
            NcItem::Name(name) => variables.define(kind, name, None)?,
            NcItem::Assign { variable, value } => match &**variable {
                NcExpression::Variable(name) => {
                    let value = variables.value(value)?;
                    variables.define(kind, name, Some(value))?;
                }
                _ => return Err(fault("what is declared is no name")),
            },
            // A field, or a text of so many characters: its elements are set one by one.
            NcItem::Named { name, .. } if kind == "STRING" => variables.define(kind, name, None)?,
            NcItem::Named { name, .. } => variables.define_field(name)?,
            _ => return Err(fault("what is declared is no name")),
        }
    }
    Ok(())
}
