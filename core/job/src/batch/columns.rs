//! The columns of the results: they follow from the jobs and from what is asked of them, never from what came of them, so
//! that the parts of a study that is shared out have the same.

use std::collections::BTreeMap;

use post_posting::report::PostingReport;
use post_readback::verify::Verification;

use super::inputs::Inputs;
use super::job_line::JobLine;
use super::travel::{self, TravelLeft};
use crate::axes::{self, AxisColumn};
use crate::clearance::ClearanceSummary;
use crate::columns::{Column, ColumnKind};
use crate::predict::Prediction;
use crate::settings::StudySettings;

/// A column: its name, what its values are, and where they come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnSource {
    /// Its name in the table.
    pub name: String,
    /// What its values are.
    pub kind: ColumnKind,
    /// The parameter of the job that it shows; none: what came of the job.
    pub parameter: Option<String>,
}

/// Of the job itself.
pub const OF_JOB: [(&str, ColumnKind); 3] =
    [("job", ColumnKind::Count), ("file", ColumnKind::Text), ("machine", ColumnKind::Text)];

const STATE: &[(&str, ColumnKind)] = &[
    ("state", ColumnKind::Text),
    ("codes", ColumnKind::Text),
    ("message", ColumnKind::Text),
    ("line", ColumnKind::Count),
    ("warnings", ColumnKind::Text),
];

/// A program that was written.
pub struct WrittenProgram<'a> {
    pub report: &'a PostingReport,
    /// Its text: how many bytes, and their hash.
    pub bytes: u64,
    pub hash: String,
    /// Where the least is left of the travel of a slide, and of a table.
    pub left: [Option<TravelLeft<'a>>; 2],
}

/// Of a program that is written.
pub fn program<'a>() -> Vec<Column<WrittenProgram<'a>>> {
    type C<'a> = Column<WrittenProgram<'a>>;
    let left =
        |row: &WrittenProgram<'a>, kind: usize| row.left[kind].as_ref().map(|left| left.least);
    let axis = |row: &WrittenProgram<'a>, kind: usize| {
        row.left[kind].as_ref().map(|left| left.axis.to_owned())
    };
    vec![
        C::new("cycle_time_s", "s", 0, |row| row.report.time_s),
        C::new("cutting_time_s", "s", 0, |row| row.report.cutting_time_s),
        C::new("moves", "", 0, |row| row.report.moves),
        C::new("blocks", "", 0, |row| row.report.blocks),
        C::new("points_added", "", 0, |row| row.report.points_added),
        C::new("points_dropped", "", 0, |row| row.report.points_dropped),
        C::new("tip_deviation_mm", "mm", 0, |row| row.report.tip_deviation_mm.value),
        C::new("axis_deviation_deg", "deg", 0, |row| row.report.axis_deviation_deg.value),
        C::new("rapid_deviation_mm", "mm", 0, |row| row.report.rapid_deviation_mm.value),
        C::new("feed_limited_share", "", 0, |row| {
            row.report.blocks_limited as f64 / row.report.blocks.max(1) as f64
        }),
        C::new("rewinds", "", 0, |row| row.report.rewinds),
        C::new("branch_changes", "", 0, |row| row.report.branch_changes),
        C::new("points_eased", "", 0, |row| row.report.points_eased),
        C::new("travel_left_mm", "mm", 0, move |row| left(row, 0)),
        C::new("travel_left_mm_axis", "", 0, move |row| axis(row, 0)),
        C::new("travel_left_deg", "deg", 0, move |row| left(row, 1)),
        C::new("travel_left_deg_axis", "", 0, move |row| axis(row, 1)),
    ]
}

/// Of its text.
pub fn text<'a>() -> Vec<Column<WrittenProgram<'a>>> {
    type C<'a> = Column<WrittenProgram<'a>>;
    vec![
        C::new("nc_lines", "", 0, |row| row.report.nc_lines),
        C::new("nc_bytes", "", 0, |row| row.bytes),
        C::new("nc_hash", "", 0, |row| row.hash.clone()),
    ]
}

/// Of a program that was read back.
pub fn verified() -> Vec<Column<Verification>> {
    type C = Column<Verification>;
    vec![
        C::new("verified_tip_deviation_mm", "mm", 0, |found| found.tip.value),
        C::new("verified_axis_deviation_deg", "deg", 0, |found| found.axis.value),
    ]
}

/// Of a program that is proven to hit nothing.
pub fn proven() -> Vec<Column<ClearanceSummary>> {
    type C = Column<ClearanceSummary>;
    let nearest = |found: &ClearanceSummary| found.nearest().map(|pair| pair.bodies.join(" / "));
    vec![
        C::new("clear_by_mm", "mm", 0, |found| found.clear_by_mm()),
        C::new("nearest_approach_mm", "mm", 0, |found| found.nearest()?.nearest_mm),
        C::new("nearest_approach_bodies", "", 0, nearest),
        C::new("nearest_approach_line", "", 0, |found| found.nearest()?.nearest_line),
    ]
}

/// Of a program that was predicted.
pub fn predicted() -> Vec<Column<Prediction>> {
    type C = Column<Prediction>;
    vec![
        C::new("predicted_cycle_time_s", "s", 0, |found| found.time.cycle_s),
        C::new("predicted_cutting_time_s", "s", 0, |found| found.time.cutting_s),
        C::new("contour_error_mm", "mm", 0, |found| found.contour.tip_mm.largest),
        C::new("contour_error_p99_mm", "mm", 0, |found| found.contour.tip_mm.p99),
        C::new("contour_axis_error_deg", "deg", 0, |found| found.contour.axis_deg.largest),
    ]
}

fn heads<R>(columns: Vec<Column<R>>) -> impl Iterator<Item = ColumnSource> {
    columns.into_iter().map(|column| ColumnSource {
        name: column.name.into_owned(),
        kind: column.kind,
        parameter: None,
    })
}

/// The columns of a study.
pub fn columns(jobs: &[JobLine], options: &StudySettings, inputs: &Inputs) -> Vec<ColumnSource> {
    let head = |(name, kind): &(&str, ColumnKind)| ColumnSource {
        name: (*name).to_owned(),
        kind: *kind,
        parameter: None,
    };
    let mut after: Vec<ColumnSource> = STATE.iter().map(head).chain(heads(program())).collect();
    after.extend(of_axes(jobs, inputs));
    if options.verify {
        after.extend(heads(verified()));
    }
    if options.clearance {
        after.extend(heads(proven()));
    }
    if options.predict {
        after.extend(heads(predicted()));
    }
    after.extend(heads(text()));
    after.push(head(&("key", ColumnKind::Text)));
    if options.timings {
        after.push(head(&("compute_time_s", ColumnKind::Number)));
    }
    let mut columns: Vec<ColumnSource> = OF_JOB.iter().map(head).collect();
    for (parameter, kind) in parameters(jobs) {
        let mut name = parameter.clone();
        // A parameter of the machine may be called as a column is.
        while columns.iter().chain(&after).any(|other| other.name == name) {
            name = format!("parameters.{name}");
        }
        columns.push(ColumnSource { name, kind, parameter: Some(parameter) });
    }
    columns.extend(after);
    columns
}

/// What the jobs say, in the order in which they do: numbers where every value is one.
fn parameters(jobs: &[JobLine]) -> Vec<(String, ColumnKind)> {
    let mut kinds: BTreeMap<String, ColumnKind> = BTreeMap::new();
    let mut order = Vec::new();
    for job in jobs {
        for (name, value) in job.parameters() {
            let kind = match value.0.parse::<f64>() {
                Ok(number) if number.is_finite() => ColumnKind::Number,
                _ => ColumnKind::Text,
            };
            match kinds.get_mut(&name) {
                Some(ColumnKind::Text) => {}
                Some(known) => *known = kind,
                None => {
                    order.push(name.clone());
                    kinds.insert(name, kind);
                }
            }
        }
    }
    let kind = |name: &String| kinds.get(name).copied().unwrap_or(ColumnKind::Text);
    order.into_iter().map(|name| (name.clone(), kind(&name))).collect()
}

/// Of every axis that a machine of the study has: with the settings of the first job that it can be loaded with.
fn of_axes(jobs: &[JobLine], inputs: &Inputs) -> Vec<ColumnSource> {
    let mut loaded: Vec<&str> = Vec::new();
    let mut known: Vec<AxisColumn> = Vec::new();
    for job in jobs {
        let name = job.machine.as_deref().unwrap_or_default();
        if loaded.contains(&name) {
            continue;
        }
        let settings = job.settings(&Default::default());
        let settings = settings.map_or_else(|_| Vec::new(), |job| job.over.settings());
        let texts = inputs.machine(name);
        let machine = texts.load(&settings).or_else(|_| texts.load(&[]));
        loaded.push(name);
        for axis in machine.iter().flat_map(axes::by_words) {
            if !known.contains(&axis) {
                known.push(axis);
            }
        }
    }
    let mut heads: Vec<ColumnSource> = Vec::new();
    for name in known.iter().flat_map(|axis| travel::columns(&axis.name, axis.rotary)) {
        // A slide and a table may have one name on two machines: their shares are in one column.
        if heads.iter().all(|head| head.name != name) {
            heads.push(ColumnSource { name, kind: ColumnKind::Number, parameter: None });
        }
    }
    heads
}
