//! What verifying has found, for people.

use std::fmt::Write as _;

use post_machine::description::Machine;
use post_readback::verify::WorstDeviation;

use post_job::read_back::Held;
use post_job::text::{clock, number};

/// The table of a verification of the program called `name`.
pub fn text(held: &Held, machine: &Machine, name: &str, tolerances: [Option<f64>; 2]) -> String {
    let found = &held.found;
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16} {value}");
    };
    row("program", format!("{name}, {} blocks", held.blocks));
    row("machine", machine.name.clone());
    row(
        "motions",
        format!(
            "{}: {} cuts, {} rapids, {} holes",
            found.motions, found.cuts, found.rapids, found.holes
        ),
    );
    let tolerance = tolerances[0].unwrap_or(machine.accuracy.tolerance);
    let axis_tolerance = tolerances[1].unwrap_or(machine.accuracy.axis_tolerance);
    row("tip deviation", format!("{}, tolerance {tolerance} mm", worst(&found.tip, "mm", 6)));
    row(
        "axis deviation",
        format!("{}, tolerance {:.4}°", worst(&found.axis, "°", 5), axis_tolerance.to_degrees()),
    );
    if found.rapid.nc_line > 0 {
        row("rapid points", format!("passed within {}", worst(&found.rapid, "mm", 3)));
    }
    let mut more = Vec::new();
    for (count, what) in [
        (found.excursions, "times a cut is left and gone on with"),
        (found.rapids_at_feed, "rapids made at feed"),
        (
            found.limited,
            "cuts slower than the CL file asks, by an axis, the largest F by time or the plan",
        ),
    ] {
        if count > 0 {
            more.push(format!("{count} {what}"));
        }
    }
    if !more.is_empty() {
        row("besides", more.join(", "));
    }
    row("time", clock(found.time_s));
    row(
        "faults",
        match (found.faults.len(), found.gave_up) {
            (0, _) => "none".to_owned(),
            (count, false) => count.to_string(),
            (count, true) => format!("{count} and more: given up"),
        },
    );
    text
}

fn worst(worst: &WorstDeviation, unit: &str, decimals: u8) -> String {
    let value = number(worst.value, decimals);
    match worst.nc_line {
        0 => format!("{value} {unit}"),
        line => format!("{value} {unit}, in line {line} of the program, CL line {}", worst.cl_line),
    }
}
