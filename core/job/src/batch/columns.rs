//! The columns of the results: they follow from the jobs and from what is asked of them, never from what came of them, so
//! that the parts of a study that is shared out have the same.

use std::collections::BTreeMap;

use super::inputs::Inputs;
use super::job_line::JobLine;
use super::travel;
use crate::settings::StudySettings;

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Number,
    Count,
    Text,
}

/// A column: its name, what its values are, and where they come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// Its name in the table.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// The parameter of the job that it shows; none: what came of the job.
    pub parameter: Option<String>,
}

/// Of the job itself.
pub const OF_JOB: [(&str, Kind); 3] =
    [("job", Kind::Count), ("file", Kind::Text), ("machine", Kind::Text)];

const STATE: &[(&str, Kind)] = &[
    ("state", Kind::Text),
    ("codes", Kind::Text),
    ("message", Kind::Text),
    ("line", Kind::Count),
    ("warnings", Kind::Text),
];

const PROGRAM: &[(&str, Kind)] = &[
    ("cycle_time_s", Kind::Number),
    ("cutting_time_s", Kind::Number),
    ("moves", Kind::Count),
    ("blocks", Kind::Count),
    ("points_added", Kind::Count),
    ("points_dropped", Kind::Count),
    ("tip_deviation_mm", Kind::Number),
    ("axis_deviation_deg", Kind::Number),
    ("rapid_deviation_mm", Kind::Number),
    ("feed_limited_share", Kind::Number),
    ("rewinds", Kind::Count),
    ("branch_changes", Kind::Count),
    ("points_eased", Kind::Count),
    ("travel_left_mm", Kind::Number),
    ("travel_left_mm_axis", Kind::Text),
    ("travel_left_deg", Kind::Number),
    ("travel_left_deg_axis", Kind::Text),
];

const VERIFIED: &[(&str, Kind)] =
    &[("verified_tip_deviation_mm", Kind::Number), ("verified_axis_deviation_deg", Kind::Number)];

const PREDICTED: &[(&str, Kind)] = &[
    ("predicted_cycle_time_s", Kind::Number),
    ("predicted_cutting_time_s", Kind::Number),
    ("contour_error_mm", Kind::Number),
    ("contour_error_p99_mm", Kind::Number),
    ("contour_axis_error_deg", Kind::Number),
];

const BYTES: &[(&str, Kind)] = &[
    ("nc_lines", Kind::Count),
    ("nc_bytes", Kind::Count),
    ("nc_hash", Kind::Text),
    ("key", Kind::Text),
];

/// The columns of a study.
pub fn columns(jobs: &[JobLine], options: &StudySettings, inputs: &Inputs) -> Vec<Head> {
    let head = |(name, kind): &(&str, Kind)| Head {
        name: (*name).to_owned(),
        kind: *kind,
        parameter: None,
    };
    let mut after: Vec<Head> = STATE.iter().chain(PROGRAM).map(head).collect();
    after.extend(of_axes(jobs, inputs));
    if options.verify {
        after.extend(VERIFIED.iter().map(head));
    }
    if options.predict {
        after.extend(PREDICTED.iter().map(head));
    }
    after.extend(BYTES.iter().map(head));
    if options.timings {
        after.push(head(&("compute_time_s", Kind::Number)));
    }
    let mut columns: Vec<Head> = OF_JOB.iter().map(head).collect();
    for (parameter, kind) in parameters(jobs) {
        let mut name = parameter.clone();
        // A parameter of the machine may be called as a column is.
        while columns.iter().chain(&after).any(|other| other.name == name) {
            name = format!("parameters.{name}");
        }
        columns.push(Head { name, kind, parameter: Some(parameter) });
    }
    columns.extend(after);
    columns
}

/// What the jobs say, in the order in which they do: numbers where every value is one.
fn parameters(jobs: &[JobLine]) -> Vec<(String, Kind)> {
    let mut kinds: BTreeMap<String, Kind> = BTreeMap::new();
    let mut order = Vec::new();
    for job in jobs {
        for (name, value) in job.parameters() {
            let kind = match value.0.parse::<f64>() {
                Ok(number) if number.is_finite() => Kind::Number,
                _ => Kind::Text,
            };
            match kinds.get_mut(&name) {
                Some(Kind::Text) => {}
                Some(known) => *known = kind,
                None => {
                    order.push(name.clone());
                    kinds.insert(name, kind);
                }
            }
        }
    }
    let kind = |name: &String| kinds.get(name).copied().unwrap_or(Kind::Text);
    order.into_iter().map(|name| (name.clone(), kind(&name))).collect()
}

/// Of every axis that a machine of the study has: with the settings of the first job that it can be loaded with.
fn of_axes(jobs: &[JobLine], inputs: &Inputs) -> Vec<Head> {
    let mut loaded: Vec<&str> = Vec::new();
    let mut axes: Vec<(String, bool)> = Vec::new();
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
        for axis in machine.iter().flat_map(travel::axes) {
            if !axes.contains(&axis) {
                axes.push(axis);
            }
        }
    }
    let mut heads: Vec<Head> = Vec::new();
    for name in axes.iter().flat_map(|(name, rotary)| travel::columns(name, *rotary)) {
        // A slide and a table may have one name on two machines: their shares are in one column.
        if heads.iter().all(|head| head.name != name) {
            heads.push(Head { name, kind: Kind::Number, parameter: None });
        }
    }
    heads
}
