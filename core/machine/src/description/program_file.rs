//! `[program]` as it stands in a machine file.

use std::collections::BTreeMap;

use super::bounds::Bounds;
use super::file::lines_schema;
use super::quantity::KeyedNumber;
use super::table::{
    DeValue, EntryError, Key, KeyType, Range, Schemas, Spanned, Value, defined, keys,
    of_another_kind,
};

/// Tolerances of `[program.smoothing]`.
const TOLERANCE: Bounds = Bounds {
    table: "[program.smoothing] ",
    says: "",
    help: "a tolerance lies above zero; an operation without smoothing has no rule",
    ..Bounds::above_zero("machine-program")
};

keys! {
    /// Text of the program, and what the control does to it. Texts are templates: `{{ tool.number }}` stands for a
    /// fact, and each is a line or a list of lines.
    ProgramFile {
        /// By how much the control may leave the path; without it it keeps the path as it does by default.
        smoothing: Option<SmoothingFile>,
        /// The very first lines of the file, before all that the dialect writes; they get no block numbers.
        first_lines: Option<Spanned<TextLines>>,
        /// The very last lines of the file, likewise.
        last_lines: Option<Spanned<TextLines>>,
        /// Lines in the place of those by which the dialect ends the program (M30), such as M99 or M17.
        end: Option<Spanned<TextLines>>,
        /// Lines behind the program's start.
        header: Option<Spanned<TextLines>>,
        /// Lines before the program's end.
        footer: Option<Spanned<TextLines>>,
        /// Lines in the place of those that the dialect writes for a tool change.
        tool_change: Option<Spanned<TextLines>>,
        /// Lines behind a tool change.
        after_tool_change: Option<Spanned<TextLines>>,
        /// Lines before a tool change but the first, the tool retracted, such as M1.
        between_tools: Option<Spanned<TextLines>>,
        /// Lines at the start of an operation.
        before_operation: Option<Spanned<TextLines>>,
        /// Lines at the end of an operation.
        after_operation: Option<Spanned<TextLines>>,
        /// Lines before the rotary axes turn to a first position, the tool retracted.
        before_turn: Option<Spanned<TextLines>>,
        /// Lines behind that turn, the axes clamped.
        after_turn: Option<Spanned<TextLines>>,
        /// Lines before a tilted plane begins, the tool retracted.
        before_plane: Option<Spanned<TextLines>>,
        /// Lines behind the end of a tilted plane, the tool retracted.
        after_plane: Option<Spanned<TextLines>>,
        /// Lines before a first position that the control comes to with tool centre point control.
        before_tcp: Option<Spanned<TextLines>>,
        /// Lines behind the retract that ends tool centre point control.
        after_tcp: Option<Spanned<TextLines>>,
        /// Lines in the place of those that the dialect writes to retract the tool.
        retract: Option<Spanned<TextLines>>,
        /// Lines that switch smoothing on, in the place of the dialect's.
        smoothing_on: Option<Spanned<TextLines>>,
        /// Lines that switch smoothing off, in the place of the dialect's.
        smoothing_off: Option<Spanned<TextLines>>,
        /// The next tool is made ready behind each tool change; what the CL file says of it is left out.
        preselect: bool = Bounds::OFF,
        /// Ending of the program's file, without a dot; the dialect's if not said.
        extension: Option<Spanned<String>> = Bounds::pattern("^[A-Za-z0-9_]{1,16}$"),
    }
}

/// The lines of one template, each with its place where it is one of a list.
#[derive(Debug)]
pub(crate) struct TextLines(pub Vec<(String, Option<Range<usize>>)>);

impl KeyType for TextLines {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let lines: Vec<Spanned<String>> = match value.get_ref() {
            DeValue::String(line) => return Ok(Self(vec![(line.to_string(), None)])),
            DeValue::Array(_) => KeyType::read(value, key)?,
            _ => return Err(of_another_kind(value, "a line of the program or a list of lines")),
        };
        let lines = lines.into_iter().map(|line| {
            let span = line.span();
            (line.into_inner(), Some(span))
        });
        Ok(Self(lines.collect()))
    }

    fn schema(named: &mut Schemas) -> Value {
        let about = "A line of the program, or several, as one template.";
        defined(named, "TextLines", about, |_| lines_schema())
    }
}

keys! {
    /// By how much the control may leave the path between the points of the program, to go on evenly.
    SmoothingFile {
        /// Of the tip, mm; without it only the operations below are smoothed.
        tolerance: Option<KeyedNumber> = TOLERANCE,
        /// Of the tool axis, degrees, where it turns.
        axis_tolerance: Option<KeyedNumber> = TOLERANCE,
        /// Of the tip, mm, in operations by their names: `{ "ROUGH*" = 0.05 }`; * stands for any text, capitals or not, and
        /// of two that fit the longer one holds.
        operations: BTreeMap<Spanned<String>, KeyedNumber>,
    }
}
