//! The summary of a program, for people and for programs.

use std::fmt::Write as _;

use post_posting::plan::PlanReport;
use post_posting::report::{LengthSource, PluginUse, PostingReport, ReportedDeviation};
use post_readback::verify::Verification;
use serde::Serialize;

use crate::files::PathArg;
use crate::predict::Prediction;
use crate::text::{at_most, clock, number};
use crate::{compensate, plan_rounds};

/// What the summary tells as JSON.
#[derive(Serialize)]
pub struct Told<'a> {
    #[serde(flatten)]
    /// What making the program came to.
    pub report: &'a PostingReport,
    /// What reading the program back has found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verification: Option<&'a Verification>,
    /// What is predicted of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prediction: Option<&'a Prediction>,
    /// What moving points for the servos has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub servo_compensation: Option<&'a compensate::Found>,
    /// What planning the feed in rounds has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan_rounds: Option<&'a plan_rounds::Found>,
}

/// The summary of a program at `target` that was made from the CL file named `input`, and what reading it back has found,
/// if it was.
pub fn text(
    report: &PostingReport,
    read_back: Option<&Verification>,
    input: &str,
    target: &PathArg,
) -> String {
    let target = match target.path() {
        Some(path) => path.display().to_string(),
        None => "standard output".to_owned(),
    };
    let mut text = String::new();
    let program = ["program".to_owned(), format!("{target}, from {input}")];
    for [name, value] in std::iter::once(program).chain(rows(report, read_back, origin)) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16} {value}");
    }
    text
}

/// The same for the report: without folders, which are others elsewhere.
pub fn facts(report: &PostingReport, read_back: Option<&Verification>) -> Vec<[String; 2]> {
    rows(report, read_back, |plugin| match &plugin.hash {
        Some(hash) => hash.clone(),
        None => "built in".to_owned(),
    })
}

/// Where a plugin comes from.
fn origin(plugin: &PluginUse) -> String {
    match (&plugin.path, &plugin.hash) {
        (Some(path), Some(hash)) => format!("{path}, {hash}"),
        (Some(path), None) => path.clone(),
        _ => "built in".to_owned(),
    }
}

/// What the summary tells of a program: names and values.
fn rows(
    report: &PostingReport,
    read_back: Option<&Verification>,
    origin: impl Fn(&PluginUse) -> String,
) -> Vec<[String; 2]> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push([name.to_owned(), value]);
    row("machine", format!("{}, the {} keeps the tip", report.machine, report.tcp));
    for (plugin, kind) in report.plugins.iter().zip(["dialect", "error model"]) {
        row(kind, format!("{} {} ({})", plugin.name, plugin.version, origin(plugin)));
    }
    row("records read", report.records.to_string());
    row("moves", report.moves.to_string());
    row(
        "blocks",
        format!(
            "{}{} in {}, {} put in{}{}",
            report.blocks,
            match report.curves {
                0 => String::new(),
                count => format!(" ({})", counted(count, "arc or spline", "arcs and splines")),
            },
            counted(report.nc_lines, "line", "lines"),
            counted(report.points_added, "point", "points"),
            match report.points_dropped {
                0 => String::new(),
                count => format!(", {} left out", counted(count, "CL point", "CL points")),
            },
            match report.model_overruled {
                0 => String::new(),
                1 => " (the certificate overruled the model once)".to_owned(),
                count => format!(" (the certificate overruled the model {count} times)"),
            }
        ),
    );
    let point = report.control_point;
    if point != Default::default() {
        row(
            "control point",
            format!(
                "{} mm above the point of the CL file, cutting edge at a radius of {} mm",
                point.along, point.radius
            ),
        );
    }
    row(
        "tip deviation",
        format!(
            "{}, tolerance {} mm",
            certified(report.tip_deviation_mm, "mm", 6),
            report.tolerance_mm
        ),
    );
    row(
        "axis deviation",
        format!(
            "{}, tolerance {:.4}°",
            certified(report.axis_deviation_deg, "°", 5),
            report.axis_tolerance_deg
        ),
    );
    if let Some(found) = read_back {
        row(
            "read back",
            format!(
                "{} and {} as the CL file asks; tip at most {} mm off, axis {}°",
                counted(found.cuts, "cut", "cuts"),
                counted(found.holes, "hole", "holes"),
                number(found.tip.value, 6),
                number(found.axis.value, 5)
            ),
        );
    }
    for axis in &report.axes {
        if axis.min > axis.max {
            continue;
        }
        let travel = match axis.travel {
            Some([min, max]) => format!("of {} to {}", number(min, 3), number(max, 3)),
            None => "endless".to_owned(),
        };
        row(
            &format!("axis {}", axis.name),
            format!(
                "{} to {} {travel}, {} in all",
                number(axis.min, 3),
                number(axis.max, 3),
                number(axis.way, 1)
            ),
        );
    }
    for tool in &report.tools {
        let name = match tool.number {
            Some(number) => format!("tool {number}"),
            None => "tool".to_owned(),
        };
        let source = match tool.source {
            LengthSource::Option => "by --tool-length",
            LengthSource::MachineFile => "by the machine file",
            LengthSource::ClFile => "by the CL file",
            LengthSource::Unknown => "nobody gave it",
        };
        row(&name, format!("{} mm long, {source}", tool.length_mm));
    }
    let mut choices = Vec::new();
    for (count, one, several) in [
        (
            report.branch_changes,
            "change of solution off the part",
            "changes of solution off the part",
        ),
        (report.rewinds, "rewind", "rewinds"),
        (report.points_eased, "point eased close to a pole", "points eased close to a pole"),
    ] {
        if count > 0 {
            choices.push(counted(count, one, several));
        }
    }
    if !choices.is_empty() {
        row("solutions", choices.join(", "));
    }
    row(
        "time",
        format!(
            "{} of it {} cutting, without tool changes{}",
            clock(report.time_s),
            clock(report.cutting_time_s),
            match report.blocks_limited {
                0 => String::new(),
                count if report.plan.is_some() =>
                    format!("; {} slower than the CL file asks", counted(count, "block", "blocks")),
                count => slowed(count, report.blocks_capped),
            }
        ),
    );
    if let Some(plan) = &report.plan {
        row("planned feed", planned(plan));
        row("held by", held_by(plan));
    }
    let fast = &report.fast_rapids;
    if fast.count > 0 {
        row(
            "fast rapids",
            format!(
                "{}, {} up to {:.2} times its max_feed (CL line {}) if the control limits the axes of the program alone; [control] rapid = \"linear\" writes them as feed moves",
                fast.count, fast.axis, fast.factor, fast.line
            ),
        );
    }
    if !report.ignored_words.is_empty() {
        let words: Vec<String> =
            report.ignored_words.iter().map(|(word, count)| format!("{word} {count}")).collect();
        row("words ignored", words.join(", "));
    }
    row(
        "warnings",
        match report.warnings.len() {
            0 => "none".to_owned(),
            count => format!("{count}, see above"),
        },
    );
    rows
}

/// So many of a thing.
fn counted(count: u64, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// Blocks that are slowed down, `capped` of them because the control takes no larger F by time.
fn slowed(count: u64, capped: u64) -> String {
    let by_axes = count - capped.min(count);
    let mut by = Vec::new();
    if by_axes > 0 {
        let blocks = counted(by_axes, "block", "blocks");
        by.push(format!("{blocks} slowed down by an axis' largest feed"));
    }
    if capped > 0 {
        let blocks = counted(capped, "block", "blocks");
        by.push(format!("{blocks} by the largest F under inverse time"));
    }
    format!("; {}", by.join(", "))
}

/// What a plan came to.
fn planned(plan: &PlanReport) -> String {
    let mut text = format!(
        "{} in {} at the feeds written ({} by the plan, {} at the feeds of the CL file if the tool never slowed down)",
        counted(plan.blocks, "block", "blocks"),
        clock(plan.printed_s),
        clock(plan.planned_s),
        clock(plan.asked_s)
    );
    // Writing to a String cannot fail.
    if plan.blocks_cut > 0 {
        let _ = write!(
            text,
            "; {} cut where the feed changes, {} put in",
            counted(plan.blocks_cut, "block", "blocks"),
            plan.blocks_added
        );
    }
    if plan.blocks_unplanned > 0 {
        let blocks = counted(plan.blocks_unplanned, "block", "blocks");
        let _ = write!(text, "; {blocks} not planned");
    }
    text
}

/// Limits that hold the planned feed, as shares of its time.
fn held_by(plan: &PlanReport) -> String {
    let whole: f64 = plan.limits.iter().map(|limit| limit.time_s).sum();
    let shares = plan.limits.iter().map(|limit| {
        let name = match &limit.axis {
            Some(axis) => format!("{} of {axis}", limit.limit),
            None => limit.limit.clone(),
        };
        (name, 100.0 * limit.time_s / whole)
    });
    let told: Vec<String> = shares
        .filter(|(_, share)| *share >= 0.05)
        .map(|(name, share)| format!("{name} {} %", number(share, 1)))
        .collect();
    match told.is_empty() {
        true => "nothing".to_owned(),
        false => told.join(", "),
    }
}

/// A certified maximum and its place.
fn certified(deviation: ReportedDeviation, unit: &str, decimals: u8) -> String {
    let value = at_most(deviation.value, decimals);
    if deviation.line == 0 {
        return format!("{value} {unit}");
    }
    format!(
        "certified at most {value} {unit}, in line {} of the program, CL line {}",
        deviation.block, deviation.line
    )
}
