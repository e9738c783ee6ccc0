//! The table of what was found.

use post_job::calibrate::CalibrationFound;
use post_job::text::number;
use post_job::text_table::{NamedValues, TextTable};

/// What was found, as lines.
pub fn text(found: &CalibrationFound) -> String {
    let CalibrationFound { readings, calibration, lines, .. } = found;
    let mut rows = NamedValues::default();
    rows.row("readings", readings);
    rows.row("off the ball", format_args!("{} mm before", number(calibration.before, 5)));
    rows.row(
        "",
        format_args!("{} mm now (root mean square of a coordinate)", number(calibration.after, 5)),
    );
    let without = calibration.without.as_deref();
    let mut table = match without {
        Some(_) => {
            TextTable::headed(1, ["", "was", "is", "standard error", "without", "standard error"])
        }
        None => TextTable::headed(1, ["", "was", "is", "standard error"]),
    };
    for (place, each) in calibration.numbers.iter().enumerate() {
        let others = without.map(|without| &without.numbers[place]);
        let others = others.map(|other| [other.value, other.deviation]).into_iter().flatten();
        let cells = [each.before, each.value, each.deviation].into_iter().chain(others);
        let cells = cells.map(|cell| number(cell, 6));
        table.row([each.name.clone()].into_iter().chain(cells).collect::<Vec<String>>());
    }
    if let Some(told) = told_of_outliers(found) {
        rows.row("without", told);
    }
    format!("{}\n{}\n{lines}", rows.table(), table.text())
}

/// What becomes of the numbers without the readings that do not go with the others.
fn told_of_outliers(found: &CalibrationFound) -> Option<String> {
    let lines: Vec<String> = found.outliers.iter().map(u64::to_string).collect();
    if lines.is_empty() {
        return None;
    }
    let lines = format!("{} {}", if lines.len() > 1 { "lines" } else { "line" }, lines.join(", "));
    Some(match &found.calibration.without {
        Some(without) => format!("{lines}: {} mm", number(without.after, 5)),
        None => format!("{lines}: the others do not determine these numbers"),
    })
}
