//! What is left between a prediction and a measurement, for people.

use std::fmt::Write as _;

use super::fitting::{AxisFitted, rounded, short};
use super::report::{AxisLaid, MeasuredFound, RemainingDifference};
use post_machine::diagnostic::Short;

use crate::text::{clock, number};
use crate::text_table::{NamedValues, TextTable, or_dash};

/// The tables of a log.
pub fn text(found: &MeasuredFound) -> String {
    let mut text = head(found).lines(16);
    positions(&mut text, &found.axes);
    let unit = |axis: &AxisLaid| LogErrorUnit::of_axis(axis.unit);
    let following = found.axes.iter().filter_map(|axis| {
        let errors = [axis.following_measured, axis.following_predicted, axis.following];
        let [measured, predicted, left] = errors;
        Some((axis.name.clone(), unit(axis), [measured?, predicted?, left?]))
    });
    errors(&mut text, "following error", following.collect());
    if let Some(contour) = &found.contour {
        let rows = [contour.measured, contour.predicted, contour.difference];
        let row = ("tip in cuts".to_owned(), LogErrorUnit::of_axis("mm"), rows);
        errors(&mut text, "contour error", vec![row]);
    }
    text
}

/// What was read, and how it lies over the prediction.
fn head(found: &MeasuredFound) -> NamedValues {
    let mut rows = NamedValues::default();
    let ms = |seconds: f64| number(1e3 * seconds, 3);
    let (period, seconds) = (ms(found.period_s), clock(found.seconds));
    rows.row(
        "measured",
        format!("{}, {} rows, one every {period} ms, {seconds}", found.log, found.rows),
    );
    let columns = found.columns.iter();
    let columns = columns.map(|one| format!("{} = {} ({})", one.column, one.holds, one.unit));
    rows.row("  columns", columns.collect::<Vec<String>>().join(", "));
    if !found.unread.is_empty() {
        rows.row("  not read", found.unread.join(", "));
    }
    if found.missing_rows > 0 {
        rows.row("  missing", format!("{} rows, interpolated", found.missing_rows));
    }
    if found.rounded_times {
        rows.row("  times", "rounded; rows are taken to lie at even distances");
    } else if found.jitter_s > SEEN_JITTER * found.period_s {
        let jitter = ms(found.jitter_s);
        rows.row("  times", format!("beside even distances by {jitter} ms (RMS)"));
    }
    if found.turns > 0 {
        let turns = found.turns;
        rows.row(
            "  full turns",
            format!("{turns} jumps of a rotary axis are its count starting again"),
        );
    }
    let [from, to] = found.overlap_s;
    let laid = format!(
        "the program begins at {} s of the log (± {} µs); both are known for {} of its {}",
        number(found.shift_s, 6),
        number(1e6 * found.shift_deviation_s.min(1e3), 1),
        clock(to - from),
        clock(found.predicted_s)
    );
    rows.row("laid over", laid);
    if let Some([logged, predicted]) = found.motion_s {
        let text = format!(
            "{} s from the first motion to the last, predicted {} s ({} %)",
            number(logged, 3),
            number(predicted, 3),
            signed(100.0 * (predicted / logged - 1.0))
        );
        rows.row("  moves for", text);
    }
    let alike = match found.far_off > 0.0 {
        true => format!(
            "{} without {} % of the rows that are far off",
            number(found.correlation, 6),
            number(100.0 * found.far_off, 2)
        ),
        false => number(found.correlation, 6),
    };
    rows.row("  alike by", format!("{alike} (1: nothing is left)"));
    let zeros = found.axes.iter().filter(|axis| axis.zero.abs() >= 5e-5);
    let zeros = zeros.map(|axis| format!("{} {} {}", axis.name, number(axis.zero, 4), axis.unit));
    let zeros: Vec<String> = zeros.collect();
    rows.row(
        "  taken off",
        match zeros.is_empty() {
            true => "nothing: the log counts from the zeros of the prediction".to_owned(),
            false => format!("{}, by which the log counts more (--log-zeros)", zeros.join(", ")),
        },
    );
    rows
}

/// What is left of a servo is no noise if so many rows say no more than one.
const ALIKE: f64 = 5.0;

/// A time is beside even distances if it is so by more than this share of them.
const SEEN_JITTER: f64 = 1e-3;

/// With its sign, two decimals.
fn signed(value: f64) -> String {
    let sign = if value > 0.0 { "+" } else { "" };
    format!("{sign}{}", number(value, 2))
}

/// Where axes are at the same time.
fn positions(text: &mut String, axes: &[AxisLaid]) {
    let heads = ["position, predicted minus measured", "", "most", "at s", "RMS", "mean"];
    let mut table = TextTable::headed(2, heads);
    for axis in axes {
        for (what, left) in [("commanded", axis.commanded), ("actual", axis.actual)] {
            let Some(left) = left else { continue };
            let shown = LogErrorUnit::of_position(axis.unit);
            let [most, at, rms, mean] = shown.cells(&left);
            let name = format!("{} {what}", axis.name);
            table.row([name, shown.unit.to_owned(), most, at, rms, mean]);
        }
    }
    table.below(text);
}

/// What was measured, what is predicted for it, and what is left.
fn errors(
    text: &mut String,
    what: &str,
    rows: Vec<(String, LogErrorUnit, [RemainingDifference; 3])>,
) {
    if rows.is_empty() {
        return;
    }
    let heads = [
        what,
        "",
        "measured",
        "at s",
        "RMS",
        "predicted",
        "at s",
        "RMS",
        "difference",
        "at s",
        "RMS",
    ];
    let mut table = TextTable::headed(2, heads);
    for (name, shown, lefts) in rows {
        let mut line = vec![name, shown.unit.to_owned()];
        for left in &lefts {
            let [most, at, rms, _] = shown.cells(left);
            line.extend([most, at, rms]);
        }
        table.row(line);
    }
    table.below(text);
}

/// How errors are shown.
#[derive(Clone, Copy)]
struct LogErrorUnit {
    unit: &'static str,
    /// From the unit of the JSON.
    scale: f64,
    decimals: u8,
}

impl LogErrorUnit {
    /// An error of an axis whose unit in the JSON is this.
    fn of_axis(unit: &str) -> Self {
        Self { unit: if unit == "deg" { "0.001°" } else { "µm" }, scale: 1e3, decimals: 2 }
    }

    /// A position of it: what is early or late is off by millimetres.
    fn of_position(unit: &'static str) -> Self {
        Self { unit, scale: 1.0, decimals: 4 }
    }

    fn cells(&self, left: &RemainingDifference) -> [String; 4] {
        let size = |value: f64| number(value * self.scale, self.decimals);
        [size(left.most), number(left.most_at_s, 3), size(left.rms), size(left.mean)]
    }
}

/// The tables of servos that were adjusted.
pub fn fitted_text(fitted: &[AxisFitted]) -> String {
    let mut text = String::new();
    for axis in fitted {
        let shown = LogErrorUnit::of_axis(axis.unit);
        let error = |value: f64| format!("{} {}", number(value * shown.scale, 3), shown.unit);
        let _ = writeln!(
            text,
            "\nservo of {}: its position is predicted from the logged commands to {} (RMS), with the numbers as they were to {}{}",
            axis.name,
            error(axis.after),
            error(axis.before),
            match axis.converged {
                true => "",
                false => "; the search was given up, these are the best numbers that were met",
            },
        );
        if axis.rows_alike > ALIKE {
            let _ = writeln!(
                text,
                "what is left is no noise: {} rows on end say no more than one, so the model lacks something (friction, backlash, a delay, another drive); deviations are larger by that",
                number(axis.rows_alike, 0)
            );
        }
        let head = [
            "number",
            "was",
            "is",
            "± (standard error)",
            "determined",
            "exchangeable for (correlation)",
        ];
        let mut table = TextTable::headed(1, head);
        for one in &axis.numbers {
            table.row([
                one.name.to_owned(),
                Short(one.before).to_string(),
                rounded(one.value, one.deviation.unwrap_or(f64::INFINITY)),
                one.deviation.map_or_else(|| "infinite".to_owned(), short),
                if one.determined { "yes" } else { "no" }.to_owned(),
                or_dash(one.correlated.map(|(name, by)| format!("{name} ({by:.2})"))),
            ]);
        }
        text.push_str(&table.text());
        for direction in &axis.undetermined {
            let names: Vec<&str> = direction.iter().map(|(name, _)| *name).collect();
            let _ = match names[..] {
                [name] => writeln!(text, "{name} is not determined by this log"),
                _ => writeln!(
                    text,
                    "{} are not determined by this log one by one: together they can be changed without it showing; leave one of them out",
                    names.join(", ")
                ),
            };
        }
        let _ = write!(text, "for the machine file:\n{}", axis.machine_file);
    }
    text
}
