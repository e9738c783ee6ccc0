//! Travel as a picture: a bar for each axis, what the program uses of it, and what is left on both sides.

use std::fmt::Write as _;

use post_posting::report::AxisRange;

use post_job::files::svg::{self, label};
use post_job::place::{MountSearchResult, mount_text};
use post_job::text::number;

const WIDTH: f64 = 760.0;
const TOP: f64 = 84.0;
/// Of one axis, px.
const ROW: f64 = 74.0;
/// Ends of the bar, px.
const BAR: [f64; 2] = [60.0, 700.0];
const THICK: f64 = 20.0;
/// Least width of what is used, so that it is seen, px.
const SEEN: f64 = 1.5;

/// The picture.
pub fn draw(found: &MountSearchResult) -> String {
    let best = &found.best;
    let axes = best.report.axes.iter().filter(|axis| axis.min <= axis.max);
    let axes: Vec<&AxisRange> = axes.collect();
    let height = TOP + ROW * axes.len() as f64 + 20.0;
    let mut svg = svg::open(WIDTH, height);
    let mut turned = String::new();
    if best.seat.turn != 0.0 {
        let _ = write!(turned, ", turned by {}°", best.seat.turn);
    }
    let name = std::path::Path::new(&found.file).file_name();
    let name = name.unwrap_or_default().to_string_lossy();
    let middle = WIDTH / 2.0;
    let titles = [
        format!("{name} on {}", best.report.machine),
        format!("part origin at {}{turned}", mount_text(&best.seat.mount)),
        "light: travel; dark: what the program uses; numbers above a bar: what is left".to_owned(),
    ];
    for (line, title) in titles.iter().enumerate() {
        label(&mut svg, [middle, 22.0 + 18.0 * line as f64], "middle", title);
    }
    for (row, axis) in axes.iter().enumerate() {
        bar(&mut svg, TOP + ROW * row as f64, axis, unit(found, axis));
    }
    svg.push_str("</svg>\n");
    svg
}

/// mm or degrees.
fn unit(found: &MountSearchResult, axis: &AxisRange) -> &'static str {
    match found.machine.with_axis(&axis.name) {
        Some((_, known)) if known.joint.rotary => "°",
        _ => " mm",
    }
}

/// One axis; `top` is the upper edge of its row.
fn bar(svg: &mut String, top: f64, axis: &AxisRange, unit: &str) {
    let [left, right] = BAR;
    let above = top + 14.0;
    let bar = top + 20.0;
    let below = bar + THICK + 15.0;
    let shown = |value: f64| format!("{}{unit}", number(value, 2));
    // An endless axis has no ends to be drawn to: a full turn is, or what is used if that is more.
    let [least, most] = match axis.travel {
        Some(travel) => travel,
        None if unit == "°" => [axis.min.min(-180.0), axis.max.max(180.0)],
        None => [axis.min, axis.max],
    };
    let range = (most - least).max(1e-9);
    let at = |value: f64| left + (right - left) * ((value - least) / range).clamp(0.0, 1.0);
    let dashes = match axis.travel {
        Some(_) => "",
        None => " stroke-dasharray=\"6 4\"",
    };
    label(svg, [left - 14.0, bar + 15.0], "end", &axis.name);
    rectangle(svg, [left, right], bar, &format!("fill=\"#e4e4e4\" stroke=\"#000000\"{dashes}"));
    let (from, to) = (at(axis.min), at(axis.max));
    let thin = (SEEN - (to - from)).max(0.0) / 2.0;
    rectangle(svg, [from - thin, to + thin], bar, "fill=\"#5a5a5a\"");
    let middle = f64::midpoint(left, right);
    let used = format!("{} to {}", shown(axis.min), shown(axis.max));
    label(svg, [middle, above], "middle", &format!("uses {used}"));
    match axis.travel {
        Some([least, most]) => {
            label(svg, [left, above], "start", &format!("{} left", shown(axis.min - least)));
            label(svg, [right, above], "end", &format!("{} left", shown(most - axis.max)));
            label(svg, [left, below], "start", &shown(least));
            label(svg, [right, below], "end", &shown(most));
        }
        None => label(svg, [middle, below], "middle", "endless"),
    }
}

fn rectangle(svg: &mut String, [from, to]: [f64; 2], top: f64, look: &str) {
    let width = to - from;
    let _ = writeln!(
        svg,
        "<rect x=\"{from:.2}\" y=\"{top:.2}\" width=\"{width:.2}\" height=\"{THICK}\" {look}/>"
    );
}
