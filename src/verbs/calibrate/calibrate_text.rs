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
    let mut table = TextTable::headed(1, ["", "was", "is", "standard error"]);
    for each in &calibration.numbers {
        let [was, is, deviation] =
            [each.before, each.value, each.deviation].map(|it| number(it, 6));
        table.row([each.name.clone(), was, is, deviation]);
    }
    format!("{}\n{}\n{lines}", rows.table(), table.text())
}
