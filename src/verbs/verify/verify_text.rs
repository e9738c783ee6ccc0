//! What verifying has found, for people.

use post_machine::description::Machine;
use post_machine::diagnostic::{Severity, SourceFiles};
use post_readback::verify::WorstDeviation;

use post_job::read_back::VerifiedProgram;
use post_job::text::{clock, number};
use post_job::text_table::NamedValues;

/// The table of a verification of the program called `name`.
pub fn text(
    held: &VerifiedProgram,
    machine: &Machine,
    name: &str,
    tolerances: [Option<f64>; 2],
) -> String {
    let found = &held.found;
    let errors = held.findings.iter().filter(|finding| finding.severity == Severity::Error).count();
    let mut rows = NamedValues::default();
    rows.row("program", format_args!("{name}, {} blocks", held.blocks));
    rows.row("machine", &machine.name);
    rows.row(
        "motions",
        format_args!(
            "{}: {} cuts, {} rapids, {} holes",
            found.motions, found.cuts, found.rapids, found.holes
        ),
    );
    let tolerance = tolerances[0].unwrap_or(machine.accuracy.tolerance);
    let axis_tolerance = tolerances[1].unwrap_or(machine.accuracy.axis_tolerance);
    rows.row(
        "tip deviation",
        format_args!("{}, tolerance {tolerance} mm", worst(&held.files, &found.tip, "mm", 6)),
    );
    rows.row(
        "axis deviation",
        format_args!(
            "{}, tolerance {:.4}°",
            worst(&held.files, &found.axis, "°", 5),
            axis_tolerance.to_degrees()
        ),
    );
    if found.rapid.nc_line > 0 {
        rows.row(
            "rapid points",
            format_args!("passed within {}", worst(&held.files, &found.rapid, "mm", 3)),
        );
    }
    if !found.axis_rapids.is_none() {
        let off = worst(&held.files, &found.axis_rapids, "mm", 3);
        rows.row("rapids", format_args!("straight in the axes, off the way of the tip by {off}"));
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
        rows.row("besides", more.join(", "));
    }
    rows.row("time", clock(found.time_s));
    rows.row(
        "faults",
        match (errors, found.gave_up) {
            (0, _) => "none".to_owned(),
            (count, false) => count.to_string(),
            (count, true) => format!("{count} and more: given up"),
        },
    );
    rows.lines(16)
}

fn worst(files: &SourceFiles, worst: &WorstDeviation, unit: &str, decimals: u8) -> String {
    let value = number(worst.value, decimals);
    match worst.nc_line {
        0 => format!("{value} {unit}"),
        line => format!(
            "{value} {unit}, in line {line} of the program, CL line {}",
            files.line(worst.cl_line)
        ),
    }
}
