//! What a prediction has found, for people.

use std::fmt::Write as _;

use super::measured;
use super::prediction::{AxisFound, Extreme, LimitTime, Prediction, Spread};
use crate::text::{clock, number};
use crate::text_table::{NamedValues, TextTable, or_dash};

/// So many limits and operations are listed; the JSON has all of them.
const MOST_ROWS: usize = 12;

/// The tables of a prediction.
pub fn text(found: &Prediction) -> String {
    let mut rows = NamedValues::default();
    head(&mut rows, found);
    contour(&mut rows, found);
    let mut text = rows.lines(16);
    axes(&mut text, &found.axes);
    jumps(&mut text, found.corners_with_jump);
    limits(&mut text, found);
    operations(&mut text, found);
    if let Some(measured) = &found.measured {
        text.push('\n');
        text.push_str(&measured::text(measured));
        text.push_str(&measured::fitted_text(&found.fitted));
    }
    if !found.assumed.is_empty() {
        text.push_str("\nassumed\n");
        for assumed in &found.assumed {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {assumed}");
        }
    }
    text
}

fn head(rows: &mut NamedValues, found: &Prediction) {
    rows.row("program", format_args!("{}, {} blocks", found.program, found.blocks));
    rows.row("machine", format_args!("{} ({})", found.machine, found.dialect));
    rows.row(
        "set-points",
        format_args!("{}, one every {} ms", found.set_points, short(1e3 * found.period_s)),
    );
    let time = &found.time;
    let mut parts = vec![format!("{} cutting", clock(time.cutting_s))];
    for (seconds, what) in [(time.rapid_s, "at rapid"), (time.waiting_s, "waiting")] {
        if seconds > 0.0 {
            parts.push(format!("{} {what}", clock(seconds)));
        }
    }
    rows.row("cycle time", format_args!("{}: {}", clock(time.cycle_s), parts.join(", ")));
    let feed = &found.feed;
    if feed.way_mm > 0.0 {
        rows.row(
            "feed",
            format_args!(
                "{} mm/min on average over {} mm of cuts, programmed {}; at most {}, in line {}",
                number(feed.true_mean, 0),
                number(feed.way_mm, 1),
                number(feed.programmed_mean, 0),
                number(feed.true_largest, 0),
                feed.largest_nc_line,
            ),
        );
        rows.row(
            "",
            format_args!(
                "{:.1} % of what is programmed: {} instead of {}; below 95 % of it for {}",
                100.0 * feed.true_mean / feed.programmed_mean,
                clock(time.cutting_s),
                clock(time.cutting_at_feed_s),
                clock(feed.below_95_percent_s)
            ),
        );
    }
}

/// How far the tool is off its path.
fn contour(rows: &mut NamedValues, found: &Prediction) {
    let against = match &found.against {
        Some(file) => format!(", against {file}"),
        None => {
            ", against the path that is commanded; how far that is off the program: interpolation"
                .to_owned()
        }
    };
    let contour = &found.contour;
    let tip = ErrorUnit { unit: "µm", scale: 1e3, decimals: 2 };
    let axis = ErrorUnit { unit: "°", scale: 1.0, decimals: 5 };
    let most = tip.largest(&contour.tip_mm);
    rows.row("contour error", format_args!("{most}{against}"));
    tip.spread(rows, &contour.tip_mm);
    for part in &contour.parts {
        rows.row(format_args!("  {}", part.part), tip.largest(&part.tip_mm));
    }
    let out = &contour.left_out_mm;
    if out.value > contour.tip_mm.largest {
        let (beside, line) = (tip.number(out.value), out.nc_line);
        rows.row(
            "",
            format_args!(
                "a corner of the path is passed {beside} µm beside it, in line {line} of the program"
            ),
        );
    }
    rows.row("tool axis", axis.largest(&contour.axis_deg));
    axis.spread(rows, &contour.axis_deg);
}

/// How errors are shown.
struct ErrorUnit {
    unit: &'static str,
    /// From the unit of the JSON.
    scale: f64,
    decimals: u8,
}

impl ErrorUnit {
    fn number(&self, value: f64) -> String {
        number(value * self.scale, self.decimals)
    }

    /// `at most 12.30 µm, in line 812 of the program, CL line 40`.
    fn largest(&self, spread: &Spread) -> String {
        let mut text = format!("at most {} {}", self.number(spread.largest), self.unit);
        if self.is_seen(spread) {
            let _ = write!(text, ", in line {} of the program", spread.nc_line);
            if let Some(line) = spread.cl_line {
                let _ = write!(text, ", CL line {line}");
            }
        }
        text
    }

    /// `RMS 3.10; half within 1.00, 95 % within 3.00, 99 % within 4.00`.
    fn spread(&self, rows: &mut NamedValues, spread: &Spread) {
        if self.is_seen(spread) {
            let [rms, p50, p95, p99] =
                [spread.rms, spread.p50, spread.p95, spread.p99].map(|value| self.number(value));
            rows.row(
                "",
                format_args!("RMS {rms}; half within {p50}, 95 % within {p95}, 99 % within {p99}"),
            );
        }
    }

    /// The largest is no zero when it is printed.
    fn is_seen(&self, spread: &Spread) -> bool {
        self.number(spread.largest) != self.number(0.0)
    }
}

fn axes(text: &mut String, axes: &[AxisFound]) {
    let mut heads = vec!["axis", "following", "line"];
    for head in ["velocity /min", "accel /s²", "jerk /s³", "jump /min"] {
        heads.extend([head, "of", "line"]);
    }
    let mut table = TextTable::new(1);
    table.row(heads.into_iter().map(str::to_owned).collect::<Vec<_>>());
    for axis in axes {
        let line = |extreme: &Extreme| or_dash((extreme.nc_line > 0).then_some(extreme.nc_line));
        let following = axis.servo.then_some(&axis.following);
        let mut row = vec![
            format!("{} {}", axis.name, axis.unit),
            or_dash(following.map(|following| number(following.value, 5))),
            or_dash(following.map(line)),
        ];
        for extreme in [&axis.velocity, &axis.acceleration, &axis.jerk, &axis.jump] {
            let limit = or_dash(extreme.limit.map(|limit| number(limit, 0)));
            row.extend([number(extreme.value, 0), limit, line(extreme)]);
        }
        table.row(row);
    }
    table.below(text);
}

fn jumps(text: &mut String, corners: u64) {
    if corners > 0 {
        let times = match corners {
            1 => "once".to_owned(),
            _ => format!("{corners} times"),
        };
        let _ = writeln!(
            text,
            "A block passes into the next with a jump of velocity {times}; accelerations and jerks are without these."
        );
    }
}

fn limits(text: &mut String, found: &Prediction) {
    let limits = &found.time.limits;
    if limits.is_empty() {
        return;
    }
    let heads = ["limited by", "moves", "time", "share", "beyond the feed"];
    let mut table = TextTable::headed(1, heads);
    for row in limits.iter().take(MOST_ROWS) {
        table.row([
            name(row),
            row.moves.to_string(),
            clock(row.seconds),
            format!("{:.1} %", 100.0 * row.share),
            or_dash((row.beyond_feed_s > 0.0).then(|| clock(row.beyond_feed_s))),
        ]);
    }
    table.below(text);
    more(text, limits.len());
}

/// `cuts: acceleration of C`.
fn name(row: &LimitTime) -> String {
    let of = |what: &str| match &row.axis {
        Some(axis) => format!("{what} of {axis}"),
        None => what.to_owned(),
    };
    let limit = match row.limit {
        "feed" => "feed of the program".to_owned(),
        "axis velocity" => of("velocity"),
        "axis acceleration" => of("acceleration"),
        "axis jerk" => of("jerk"),
        "tip acceleration" => "acceleration of the tip".to_owned(),
        "tip jerk" => "jerk of the tip".to_owned(),
        "corner" => "corners and stops".to_owned(),
        "block time" => "block time of the control".to_owned(),
        other => other.to_owned(),
    };
    match row.kind {
        "wait" => format!("waiting: {limit}"),
        kind => format!("{kind}s: {limit}"),
    }
}

fn operations(text: &mut String, found: &Prediction) {
    let operations = &found.time.operations;
    if operations.len() < 2 {
        return;
    }
    let mut table = TextTable::headed(2, ["tool", "operation", "time", "cutting"]);
    for row in operations.iter().take(MOST_ROWS) {
        table.row([
            or_dash(row.tool.map(|tool| format!("T{tool}"))),
            or_dash(row.operation.as_ref()),
            clock(row.seconds),
            clock(row.cutting_s),
        ]);
    }
    table.below(text);
    more(text, operations.len());
}

/// How many rows are not shown.
fn more(text: &mut String, rows: usize) {
    if rows > MOST_ROWS {
        let _ = writeln!(text, "and {} more (--summary has them)", rows - MOST_ROWS);
    }
}

/// A number with as many decimals as it needs.
fn short(value: f64) -> String {
    let text = number(value, 6);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}
