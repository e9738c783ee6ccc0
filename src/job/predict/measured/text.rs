//! What is left between a prediction and a measurement, for people.

use std::fmt::Write as _;

use super::fitting::AxisFitted;
use super::report::{AxisLaid, Left, MeasuredFound};
use post_machine::diagnostic::Short;

use crate::terminal::{clock, number, table};

/// The tables of a log.
pub fn text(found: &MeasuredFound) -> String {
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16} {value}");
    };
    row(
        "measured",
        format!(
            "{}, {} rows, one every {} ms, {}",
            found.log,
            found.rows,
            number(1e3 * found.period_s, 3),
            clock(found.seconds)
        ),
    );
    let rival = match found.rival_shift_s {
        Some(rival) => format!("; a shift of {} s does hardly worse", number(rival, 3)),
        None => String::new(),
    };
    let [from, to] = found.overlap_s;
    row(
        "laid over",
        format!(
            "its clock is {} s ahead (± {} s), alike by {}{rival}; from {} to {} s",
            number(found.shift_s, 5),
            number(found.shift_deviation_s.min(1e3), 6),
            number(found.correlation, 6),
            number(from, 3),
            number(to, 3)
        ),
    );
    if found.turns > 0 {
        row(
            "full turns",
            format!(
                "{} jumps of a rotary axis are its count starting again",
                found.turns
            ),
        );
    }
    axes(&mut text, &found.axes);
    if let Some(contour) = &found.contour {
        let rows = [
            ("measured", &contour.measured),
            ("predicted from the logged commands", &contour.predicted),
            ("predicted minus measured", &contour.difference),
        ];
        let head = ["contour error in cuts, mm", "most", "at s", "RMS", "mean"];
        let mut lines = vec![head.map(str::to_owned)];
        for (name, left) in rows {
            let [most, at, rms, mean] = cells(Some(left), 4);
            lines.push([name.to_owned(), most, at, rms, mean]);
        }
        text.push('\n');
        text.push_str(&table(&lines, 1));
    }
    text
}

fn axes(text: &mut String, axes: &[AxisLaid]) {
    let head = ["predicted minus measured", "most", "at s", "RMS", "mean"];
    let mut lines = vec![head.map(str::to_owned)];
    for axis in axes {
        let name = |what: &str| format!("{} {} {what}", axis.name, axis.unit);
        let mut line = |what: &str, left: Option<&Left>| {
            if left.is_some() {
                let [most, at, rms, mean] = cells(left, 4);
                lines.push([name(what), most, at, rms, mean]);
            }
        };
        line("commanded", axis.commanded.as_ref());
        line("actual", axis.actual.as_ref());
        line(
            "following error, by the logged commands",
            axis.following.as_ref(),
        );
    }
    text.push('\n');
    text.push_str(&table(&lines, 1));
    let zeros: Vec<String> = axes
        .iter()
        .map(|axis| format!("{} {}", axis.name, number(axis.zero, 4)))
        .collect();
    let _ = writeln!(
        text,
        "taken off first, because the log counts from other zeros: {}",
        zeros.join(", ")
    );
}

/// The tables of servos that were adjusted.
pub fn fitted_text(fitted: &[AxisFitted]) -> String {
    let mut text = String::new();
    for axis in fitted {
        let _ = writeln!(
            text,
            "\nservo of {}: RMS {} {unit} with the numbers as they were, {} {unit} with these{}",
            axis.name,
            number(axis.before, 5),
            number(axis.after, 5),
            match axis.converged {
                true => "",
                false => "; the search was given up",
            },
            unit = axis.unit
        );
        let head = [
            "number",
            "was",
            "is",
            "standard deviation",
            "determined",
            "exchangeable for",
        ];
        let mut rows = vec![head.map(str::to_owned)];
        for one in &axis.numbers {
            rows.push([
                one.name.to_owned(),
                Short(one.before).to_string(),
                Short(one.value).to_string(),
                one.deviation.map_or_else(
                    || "infinite".to_owned(),
                    |deviation| format!("{deviation:.2e}"),
                ),
                if one.determined { "yes" } else { "no" }.to_owned(),
                one.correlated
                    .map_or_else(|| "-".to_owned(), |(name, by)| format!("{name} ({by:.2})")),
            ]);
        }
        text.push_str(&table(&rows, 1));
        for direction in &axis.undetermined {
            let names: Vec<&str> = direction.iter().map(|(name, _)| *name).collect();
            let _ = writeln!(
                text,
                "the log does not determine {} apart",
                names.join(", ")
            );
        }
    }
    text
}

fn cells(left: Option<&Left>, decimals: u8) -> [String; 4] {
    match left {
        Some(left) => [
            number(left.most, decimals),
            number(left.most_at_s, 3),
            number(left.rms, decimals),
            number(left.mean, decimals),
        ],
        None => ["-", "-", "-", "-"].map(str::to_owned),
    }
}
