//! Values of expressions, shown behind them.

use std::ops::Range;

use gen_lsp_types::{InlayHint, Label};
use post_machine::diagnostic::Short;

use super::library::Library;
use crate::document::Snapshot;

/// The hints for a part of the text.
pub fn hints(of: &Snapshot, part: &Range<usize>, library: &Library) -> Vec<InlayHint> {
    let Ok(reading) = super::examine(of, library) else {
        return Vec::new();
    };
    let values = reading.values.into_iter();
    let mut values: Vec<_> =
        values.filter(|value| value.file == of.name && part.contains(&value.span.start)).collect();
    values.sort_by_key(|value| value.span.start);
    // The machine and its heads read the same text.
    values.dedup_by(|one, other| one.span == other.span && one.value == other.value);
    let values = values.into_iter();
    values
        .map(|value| InlayHint {
            position: of.lines.position(&of.text, value.span.end),
            label: Label::String(format!("= {}", Short(value.value))),
            kind: None,
            text_edits: None,
            tooltip: None,
            padding_left: Some(true),
            padding_right: None,
            data: None,
        })
        .collect()
}
