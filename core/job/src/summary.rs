//! The summary of a program, for people and for programs.

use std::fmt::Write as _;

use post_grammar::text::excerpt;
use post_posting::plan::PlanReport;
use post_posting::report::{
    AxisRange, DriveRange, FastRapids, LengthSource, PluginUse, PostingReport, ReportedDeviation,
    ReportedTool, WaysAcross,
};
use post_readback::verify::Verification;
use serde::Serialize;

use crate::clearance::ClearanceSummary;
use crate::files::PathArg;
use crate::operations::LONGEST_LIST;
use crate::predict::Prediction;
use crate::program_digest::ProgramDigest;
use crate::text::{at_most, clock, number};
use crate::text_table::NamedValues;
use crate::verify::VerifySummary;
use crate::{compensate, plan_rounds};

/// What the summary tells as JSON.
#[derive(Serialize)]
pub struct SummaryJson<'a> {
    #[serde(flatten)]
    /// What making the program came to.
    pub report: &'a PostingReport,
    /// By what the program is known again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<&'a ProgramDigest>,
    /// What reading the program back has found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verification: Option<VerifySummary<'a>>,
    /// What was proven of it: nothing hits anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceSummary>,
    /// What is predicted of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prediction: Option<&'a Prediction>,
    /// What moving points for the servos has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub servo_compensation: Option<&'a compensate::CompensationSummary>,
    /// What planning the feed in rounds has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan_rounds: Option<&'a plan_rounds::PlanRoundsSummary>,
}

/// The summary of a program at `target` that was made from the CL file named `input`.
pub fn text(found: &SummaryJson<'_>, input: &str, target: &PathArg) -> String {
    let target = match target.path() {
        Some(path) => path.display().to_string(),
        None => "standard output".to_owned(),
    };
    let mut told = NamedValues::default();
    told.row("program", format_args!("{target}, from {input}"));
    rows(&mut told, found, origin);
    told.lines(16)
}

/// The same for the report: without folders, which are others elsewhere.
pub fn facts(found: &SummaryJson<'_>) -> Vec<[String; 2]> {
    let mut told = NamedValues::default();
    let digest = found.program.map(|program| {
        format!("{}, BLAKE3 {}", counted(program.bytes, "byte", "bytes"), program.hash)
    });
    told.row_if("program", digest);
    rows(&mut told, found, |plugin| match &plugin.hash {
        Some(hash) => hash.clone(),
        None => "built in".to_owned(),
    });
    told.into_rows()
}

/// Where a plugin comes from.
fn origin(plugin: &PluginUse) -> String {
    match (&plugin.path, &plugin.hash) {
        (Some(path), Some(hash)) => format!("{path}, {hash}"),
        (Some(path), None) => path.clone(),
        _ => "built in".to_owned(),
    }
}

/// What the summary tells of a program.
fn rows(rows: &mut NamedValues, found: &SummaryJson<'_>, origin: impl Fn(&PluginUse) -> String) {
    let SummaryJson { report, verification, clearance, .. } = found;
    rows.row("machine", format_args!("{}, the {} keeps the tip", report.machine, report.tcp));
    for (plugin, kind) in report.plugins.iter().zip(["dialect", "error model"]) {
        let PluginUse { name, version, .. } = plugin;
        let asked = match (kind, report.model_asked) {
            ("error model", 0) => ", never asked".to_owned(),
            ("error model", count) => format!(", asked {}", counted(count, "time", "times")),
            _ => String::new(),
        };
        rows.row(kind, format_args!("{name} {version} ({}){asked}", origin(plugin)));
    }
    let left_out = report.left_out.join(", ");
    rows.row_if(
        "left out",
        (!left_out.is_empty()).then(|| excerpt(&left_out, LONGEST_LIST).into_owned()),
    );
    rows.row("records read", report.records);
    rows.row("moves", report.moves);
    rows.row("blocks", blocks(report));
    let point = report.control_point;
    if point != Default::default() {
        rows.row(
            "control point",
            format_args!(
                "{} mm above the point of the CL file, cutting edge at a radius of {} mm",
                point.along, point.radius
            ),
        );
    }
    let tip = certified(report, report.tip_deviation_mm, "mm", 6);
    rows.row("tip deviation", format_args!("{tip}, tolerance {} mm", report.tolerance_mm));
    let axis = certified(report, report.axis_deviation_deg, "°", 5);
    let tolerance = report.axis_tolerance_deg;
    rows.row("axis deviation", format_args!("{axis}, tolerance {tolerance:.4}°"));
    rows.row_if(
        "rapids",
        report.rapids_along_axes.then(|| along_axes(report, report.rapid_deviation_mm)),
    );
    rows.row_if("read back", verification.as_ref().map(|held| as_asked(held.found)));
    rows.row_if("clearance", clearance.as_ref().map(ClearanceSummary::fact));
    for [name, value] in clearance.iter().flat_map(ClearanceSummary::stock_rows) {
        rows.row(name, value);
    }
    for used in report.axes.iter().filter(|axis| axis.min <= axis.max) {
        rows.row(format_args!("axis {}", used.name), used_of(used));
    }
    for drive in &report.drives {
        rows.row(format_args!("drive {}", drive.name), driven(drive));
    }
    for tool in &report.tools {
        match tool.number {
            Some(number) => rows.row(format_args!("tool {number}"), length(tool)),
            None => rows.row("tool", length(tool)),
        }
    }
    rows.row_if("solutions", solutions(report));
    rows.row_if("ways across", report.ways_across.as_ref().and_then(ways_across));
    rows.row("time", time(report));
    if let Some(plan) = &report.plan {
        rows.row("planned feed", planned(plan));
        rows.row("held by", held_by(plan));
    }
    let fast = &report.fast_rapids;
    rows.row_if("fast rapids", (fast.count > 0).then(|| beyond_max_feed(report, fast)));
    let ignored = report.ignored_words.iter().map(|(word, count)| format!("{word} {count}"));
    let ignored: Vec<String> = ignored.collect();
    rows.row_if("words ignored", (!ignored.is_empty()).then(|| ignored.join(", ")));
    rows.row("warnings", warnings(report.warnings.len()));
}

/// Blocks of the program, and what was done to come to them.
fn blocks(report: &PostingReport) -> String {
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
    )
}

/// What reading the program back has found.
fn as_asked(found: &Verification) -> String {
    format!(
        "{} and {} as the CL file asks; tip at most {} mm off, axis {}°",
        counted(found.cuts, "cut", "cuts"),
        counted(found.holes, "hole", "holes"),
        number(found.tip.value, 6),
        number(found.axis.value, 5)
    )
}

/// What of an axis' travel is used.
fn used_of(axis: &AxisRange) -> String {
    let travel = match axis.travel {
        Some([min, max]) => format!("of {} to {}", number(min, 3), number(max, 3)),
        None => "endless".to_owned(),
    };
    let [min, max] = [axis.min, axis.max].map(|end| number(end, 3));
    format!("{min} to {max} {travel}, {} in all", number(axis.way, 1))
}

/// What of the travel of a drive is used.
fn driven(drive: &DriveRange) -> String {
    let [min, max] = [drive.min, drive.max].map(|end| number(end, 3));
    let travel = drive.travel.map_or(String::new(), |[least, most]| {
        format!(" of {} to {}", number(least, 3), number(most, 3))
    });
    format!("{min} to {max}{travel} {}", drive.unit)
}

/// How long a tool is, and who says so.
fn length(tool: &ReportedTool) -> String {
    let source = match tool.source {
        LengthSource::Option => "by --tool-length",
        LengthSource::MachineFile => "by the machine file",
        LengthSource::ToolTable => "by the file of tools",
        LengthSource::ClFile => "by the CL file",
        LengthSource::Unknown => "nobody gave it",
    };
    format!("{} mm long, {source}", tool.length_mm)
}

/// Changes of solution and what stands for them; none where there are none.
fn solutions(report: &PostingReport) -> Option<String> {
    let (change, changes) = ("change of solution off the part", "changes of solution off the part");
    let (eased, all_eased) = ("point eased close to a pole", "points eased close to a pole");
    let choices = [
        (report.branch_changes, change, changes),
        (report.rewinds, "rewind", "rewinds"),
        (report.points_eased, eased, all_eased),
    ];
    let choices = choices.into_iter().filter(|(count, ..)| *count > 0);
    let choices = choices.map(|(count, one, several)| counted(count, one, several));
    let choices: Vec<String> = choices.collect();
    (!choices.is_empty()).then(|| choices.join(", "))
}

/// Ways between passes that go as bodies leave them; none where there are none.
fn ways_across(ways: &WaysAcross) -> Option<String> {
    let kinds = [
        (ways.low, "over a lower retract"),
        (ways.past, "past bodies"),
        (ways.rapids, "lower between cuts"),
        (ways.as_ever, "as ever"),
    ];
    let kinds = kinds.into_iter().filter(|(count, _)| *count > 0);
    let kinds: Vec<String> = kinds.map(|(count, how)| format!("{count} {how}")).collect();
    let saved = number(ways.saved_s, 1);
    let why: Vec<String> =
        ways.why.counts().map(|(_, meaning, count)| format!("{count}: {meaning}")).collect();
    let why = if why.is_empty() { String::new() } else { format!(" ({})", why.join("; ")) };
    (!kinds.is_empty()).then(|| format!("{}{why}; {saved} s less than as ever", kinds.join(", ")))
}

/// How long the program takes, and blocks that are slower than asked for.
fn time(report: &PostingReport) -> String {
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
    )
}

fn beyond_max_feed(report: &PostingReport, fast: &FastRapids) -> String {
    format!(
        "{}, {} up to {:.2} times its max_feed (CL line {}) if the control limits the axes of the program alone; [control] rapid = \"linear\" writes them as feed moves",
        fast.count,
        fast.axis,
        fast.factor,
        report.cl_files.line(fast.line)
    )
}

/// How many warnings there were.
pub fn warnings(count: usize) -> String {
    match count {
        0 => "none".to_owned(),
        count => format!("{count}, see above"),
    }
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
fn along_axes(report: &PostingReport, off: ReportedDeviation) -> String {
    let off = certified(report, off, "mm", 3);
    format!("straight in the axes, off the straight way of the tip: {off}")
}

fn certified(
    report: &PostingReport,
    deviation: ReportedDeviation,
    unit: &str,
    decimals: u8,
) -> String {
    let value = at_most(deviation.value, decimals);
    if deviation.line == 0 {
        return format!("{value} {unit}");
    }
    format!(
        "certified at most {value} {unit}, in line {} of the program, CL line {}",
        deviation.block,
        report.cl_files.line(deviation.line)
    )
}
