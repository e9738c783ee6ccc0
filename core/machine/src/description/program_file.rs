//! `[program]` as it stands in a machine file.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use super::quantity::{Number, Quantity};

/// Text of the program, and what the control does to it. Texts are templates: `{{ tool.number }}` stands for a fact, and
/// each is a line or a list of lines.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ProgramFile {
    /// By how much the control may leave the path; without it it keeps the path as it does by default.
    pub smoothing: Option<SmoothingFile>,
    /// Lines behind the program's start.
    #[schemars(with = "Option<TextLines>")]
    pub header: Option<Spanned<TextLines>>,
    /// Lines before the program's end.
    #[schemars(with = "Option<TextLines>")]
    pub footer: Option<Spanned<TextLines>>,
    /// Lines in the place of those that the dialect writes for a tool change.
    #[schemars(with = "Option<TextLines>")]
    pub tool_change: Option<Spanned<TextLines>>,
    /// Lines behind a tool change.
    #[schemars(with = "Option<TextLines>")]
    pub after_tool_change: Option<Spanned<TextLines>>,
    /// Lines before a tool change but the first, the tool retracted, such as M1.
    #[schemars(with = "Option<TextLines>")]
    pub between_tools: Option<Spanned<TextLines>>,
    /// Lines at the start of an operation.
    #[schemars(with = "Option<TextLines>")]
    pub before_operation: Option<Spanned<TextLines>>,
    /// Lines at the end of an operation.
    #[schemars(with = "Option<TextLines>")]
    pub after_operation: Option<Spanned<TextLines>>,
    /// Lines in the place of those that the dialect writes to retract the tool.
    #[schemars(with = "Option<TextLines>")]
    pub retract: Option<Spanned<TextLines>>,
    /// Lines that switch smoothing on, in the place of the dialect's.
    #[schemars(with = "Option<TextLines>")]
    pub smoothing_on: Option<Spanned<TextLines>>,
    /// Lines that switch smoothing off, in the place of the dialect's.
    #[schemars(with = "Option<TextLines>")]
    pub smoothing_off: Option<Spanned<TextLines>>,
    /// The next tool is made ready behind each tool change; what the CL file says of it is left out.
    #[serde(default)]
    pub preselect: bool,
    /// Ending of the program's file, without a dot; the dialect's if not said.
    #[schemars(with = "Option<String>", extend("pattern" = "^[A-Za-z0-9_]{1,16}$"))]
    pub extension: Option<Spanned<String>>,
}

/// The lines of one template, each with its place where it is one of a list.
#[derive(Debug)]
pub(crate) struct TextLines(pub Vec<(String, Option<Range<usize>>)>);

impl<'de> Deserialize<'de> for TextLines {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Lines;
        impl<'de> Visitor<'de> for Lines {
            type Value = TextLines;

            fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
                to.write_str("a line of the program or a list of lines")
            }

            fn visit_str<E>(self, line: &str) -> Result<TextLines, E> {
                Ok(TextLines(vec![(line.to_owned(), None)]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<TextLines, A::Error> {
                let mut lines = Vec::new();
                while let Some(line) = items.next_element::<Spanned<String>>()? {
                    let span = line.span();
                    lines.push((line.into_inner(), Some(span)));
                }
                Ok(TextLines(lines))
            }
        }
        from.deserialize_any(Lines)
    }
}

impl JsonSchema for TextLines {
    fn schema_name() -> Cow<'static, str> {
        "TextLines".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A line of the program, or several, as one template.",
            "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" }, "minItems": 1 }]
        })
    }
}

/// By how much the control may leave the path between the points of the program, to go on evenly.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SmoothingFile {
    /// Of the tip, mm; without it only the operations below are smoothed.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub tolerance: Option<Quantity>,
    /// Of the tool axis, degrees, where it turns.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub axis_tolerance: Option<Quantity>,
    /// Of the tip, mm, in operations by their names: `{ "ROUGH*" = 0.05 }`; * stands for any text, capitals or not, and
    /// of two that fit the longer one holds.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub operations: BTreeMap<Spanned<String>, Quantity>,
}
