//! What was found, for people: a row for each operation, and below it what is different in those that differ.

use std::fmt::Write as _;

use post_readback::diff::{
    DiffRules, Difference, LoneWay, OperationDifference, ProgramSums, WorstDifference,
};

use post_job::text::{clock, number};
use post_job::text_table::{NamedValues, TextTable, or_dash};

/// Stretches, states and events of an operation that are told one by one.
const MOST_TOLD: usize = 8;

/// Heads of what is told of each operation.
const HEADS: [&str; 9] = [
    "operation",
    "",
    "old lines",
    "new lines",
    "tip, mm",
    "axis, °",
    "feed, %",
    "old time",
    "new time",
];

/// The text.
pub fn text(
    names: [&str; 2],
    machines: [&str; 2],
    rules: &DiffRules,
    found: &Difference,
) -> String {
    let mut text = String::new();
    for (what, side) in ["old", "new"].iter().zip(0..) {
        let ProgramSums { motions, cut_mm, seconds, .. } = found.sides[side];
        let _ = writeln!(
            text,
            "{what:<10} {} on {}: {motions} motions, {} mm at feed, {}",
            names[side],
            machines[side],
            number(cut_mm, 1),
            clock(seconds)
        );
    }
    let _ = writeln!(
        text,
        "the same   to {} mm, {}°, {} % of the feed\n",
        rules.tip,
        number(rules.axis.to_degrees(), 4),
        number(100.0 * rules.feed, 2),
    );
    if !found.operations.is_empty() {
        let mut table = TextTable::headed(4, HEADS);
        for (index, operation) in found.operations.iter().enumerate() {
            table.row(row(index, operation));
        }
        text.push_str(&table.text());
    }
    for (index, operation) in found.operations.iter().enumerate() {
        if !operation.same {
            let _ = writeln!(text, "\n{}", title(index, operation));
            details(&mut text, operation, rules);
        }
    }
    text.push('\n');
    let different = found.operations.iter().filter(|operation| !operation.same);
    match (found.same, different.count()) {
        (true, _) if rules.cuts => text.push_str("Both programs make the same cuts.\n"),
        (true, _) => text.push_str("Both programs make the machine do the same.\n"),
        (false, 0) => text.push_str("The programs have different words that are not known.\n"),
        (false, count) => {
            let _ = writeln!(
                text,
                "{count} of {} operations {} different.",
                found.operations.len(),
                if count == 1 { "is" } else { "are" }
            );
        }
    }
    match (rules.cuts, found.beside_cuts) {
        (true, 1) => text.push_str(
            "1 difference beside the cuts (rapids, waits, stops, tool changes) is left out.\n",
        ),
        (true, count) => {
            let _ = writeln!(
                text,
                "{count} differences beside the cuts (rapids, waits, stops, tool changes) are left out."
            );
        }
        (false, _) => {}
    }
    text
}

fn title(index: usize, operation: &OperationDifference) -> String {
    let name = operation.name.clone();
    let name = name.unwrap_or_else(|| format!("operation {}", index + 1));
    match operation.tool {
        Some(tool) => format!("{name} (T{tool})"),
        None => name,
    }
}

fn row(index: usize, operation: &OperationDifference) -> [String; 9] {
    let [old, new] = operation.sides;
    let lines = |side: Option<ProgramSums>| {
        or_dash(side.map(|side| format!("{}-{}", side.lines[0], side.lines[1])))
    };
    let time = |side: Option<ProgramSums>| or_dash(side.map(|side| clock(side.seconds)));
    let both = old.is_some() && new.is_some();
    let value = |value: f64, decimals: u8| or_dash(both.then(|| number(value, decimals)));
    let result = match (operation.same, old.is_some(), new.is_some()) {
        (true, ..) => "same",
        (_, true, false) => "left out",
        (_, false, true) => "added",
        _ => "different",
    };
    [
        title(index, operation),
        result.to_owned(),
        lines(old),
        lines(new),
        value(operation.tip.value, 4),
        value(operation.axis.value, 4),
        value(100.0 * operation.feed.worst.value, 2),
        time(old),
        time(new),
    ]
}

/// `lines 120 and 121, at X 1.000 Y 2.000 Z 3.000`.
fn place(worst: &WorstDifference) -> String {
    let [x, y, z] = worst.at.map(|part| number(part, 3));
    let [old, new] = worst.lines;
    format!("lines {old} and {new}, at X{x} Y{y} Z{z}")
}

fn details(text: &mut String, operation: &OperationDifference, rules: &DiffRules) {
    let mut told = NamedValues::default();
    strays(&mut told, operation, rules);
    for state in operation.states.iter().take(MOST_TOLD) {
        let ([old, new], [line, other]) = (&state.values, state.lines);
        let way = on(state.on_mm);
        let value = format_args!("{old}, now {new}, from lines {line} and {other} on; {way}");
        told.row(format_args!("  {}", state.what), value);
    }
    for event in operation.events.iter().take(MOST_TOLD) {
        let [line, other] = event.lines;
        let value = match &event.events {
            [Some(old), Some(new)] => format!("{old}, now {new}, lines {line} and {other}"),
            [Some(old), None] => format!("{old} is left out, line {line}"),
            [None, Some(new)] => format!("{new} is added, line {other}"),
            [None, None] => continue,
        };
        told.row("  event", value);
    }
    let ways = operation.other_ways.iter();
    let ways = ways.map(|[old, new]| format!("{}; now {}", way(old), way(new)));
    at_most_told(&mut told, "  other way", ways);
    at_most_told(&mut told, "  left out", operation.left_out.iter().map(way));
    at_most_told(&mut told, "  added", operation.added.iter().map(way));
    if let ([Some(old), Some(new)], false) = (operation.sides, rules.cuts) {
        let later = new.seconds - old.seconds;
        if libm::fabs(later) > 0.05 {
            let word = if later > 0.0 { "longer" } else { "shorter" };
            told.row("  time", format_args!("{} {word}", clock(libm::fabs(later))));
        }
    }
    text.push_str(&told.lines(12));
}

/// How far the paths of an operation lie apart, and its feeds.
fn strays(told: &mut NamedValues, operation: &OperationDifference, rules: &DiffRules) {
    let degrees = rules.axis.to_degrees();
    let mut apart = |name: &str, worst: &WorstDifference, most: f64, unit: &str, decimals: u8| {
        if worst.value > most {
            let (far, on) = (number(worst.value, decimals), on(worst.on_mm));
            told.row(name, format_args!("up to {far}{unit} apart, {}; {on}", place(worst)));
        }
    };
    apart("  position", &operation.tip, rules.tip, " mm", 4);
    apart("  tool axis", &operation.axis, degrees, "°", 4);
    for (name, worst) in &operation.rotary {
        apart(&format!("  axis {name}"), worst, degrees, "°", 3);
    }
    let feed = &operation.feed;
    if feed.worst.value > rules.feed {
        let [old, new] = feed.feeds.map(|feed| number(feed, 1));
        let (place, on) = (place(&feed.worst), on(feed.worst.on_mm));
        told.row("  feed", format_args!("{old} and {new} mm/min, {place}; {on}"));
    }
}

fn on(mm: f64) -> String {
    format!("on {} mm of the way", number(mm, 1))
}

/// The first of these ways, and how many were not told one by one.
fn at_most_told(told: &mut NamedValues, name: &str, ways: impl ExactSizeIterator<Item = String>) {
    let count = ways.len();
    ways.take(MOST_TOLD).for_each(|way| told.row(name, way));
    if count > MOST_TOLD {
        let count = count - MOST_TOLD;
        told.row(name, format_args!("and {count} further ways (--json has them)"));
    }
}

fn way(stretch: &LoneWay) -> String {
    let [first, last] = stretch.lines;
    let [x, y, z] = stretch.at.map(|part| number(part, 3));
    format!(
        "{} mm, {} of them at feed, lines {first} to {last}, from X{x} Y{y} Z{z}",
        number(stretch.mm, 3),
        number(stretch.cut_mm, 3)
    )
}
