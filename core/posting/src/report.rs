//! What was done, for the summary.

use serde::Serialize;

pub use crate::configuration::{LengthSource, ReportedTool};
use crate::plan::PlanReport;

use post_machine::description::ControlPoint;
use post_machine::diagnostic::SourceFiles;

/// The summary of one program. Its keys are those of `--summary FILE.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PostingReport {
    /// Name of the machine.
    pub machine: String,
    /// Name of the dialect.
    pub dialect: String,
    /// What keeps the tip on its path: `control` or `post`.
    pub tcp: String,
    /// Name of the error model.
    pub model: String,
    /// Where the part origin sits, all axes at zero, machine frame, mm; none where nobody says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mount_mm: Option<[f64; 3]>,
    /// How the part is turned about its Z, degrees; none where it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turn_deg: Option<f64>,
    /// The CL files that line numbers count through, where there are several.
    #[serde(skip_serializing_if = "SourceFiles::is_one")]
    pub cl_files: SourceFiles,
    /// Operations of the CL files that are left out because others were chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Records read from the CL file.
    pub records: u64,
    /// Moves that they mean (arcs, splines and cycles count with all their moves).
    pub moves: u64,
    /// Blocks with a motion in the NC program.
    pub blocks: u64,
    /// Blocks among them that are arcs or splines.
    pub curves: u64,
    /// Lines of the NC program.
    pub nc_lines: u64,
    /// Points put in to keep the tolerance.
    pub points_added: u64,
    /// CL points that no block ends on, because the tolerance makes them needless.
    pub points_dropped: u64,
    /// Pieces of moves whose deviation the error model was asked for; the certificate alone settles the others.
    pub model_asked: u64,
    /// Points put in because the certificate found more than the model promised.
    pub model_overruled: u64,
    /// Certified largest deviation of the tip in a cut, mm.
    pub tip_deviation_mm: ReportedDeviation,
    /// Certified largest deviation of the tool axis in a cut, degrees.
    pub axis_deviation_deg: ReportedDeviation,
    /// Certified largest deviation of the tip in a rapid, mm.
    pub rapid_deviation_mm: ReportedDeviation,
    /// Rapids of two linear axes and a rotary one go straight in the axes, off the straight way of the tip.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub rapids_along_axes: bool,
    /// The point of the tool that deviations are those of: how far above the point of the CL file, and the radius of
    /// the cutting edge about it, mm.
    pub control_point: ControlPoint,
    /// Tolerances in force.
    pub tolerance_mm: f64,
    /// Tolerance of the tool axis, degrees.
    pub axis_tolerance_deg: f64,
    /// What of each axis was used.
    pub axes: Vec<AxisRange>,
    /// Where the drives of a parallel machine came to.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub drives: Vec<DriveRange>,
    /// The tools that were used, each with the length that travel was checked with.
    pub tools: Vec<ReportedTool>,
    /// Times that another branch of the solution or another full turn was taken, off the part.
    pub branch_changes: u64,
    /// Times that the tool was drawn back in a cut, or at a corner of a leading edge, turned and brought back.
    pub rewinds: u64,
    /// Points at which a rotary axis was held or turned early close to a pole, within the tolerance of the axis.
    pub points_eased: u64,
    /// Time of cuts, rapids and dwells as the control understands the printed feeds, s; first approaches, retracts and
    /// tool changes not among it.
    pub time_s: f64,
    /// Time in cuts, s.
    pub cutting_time_s: f64,
    /// Blocks slowed down because an axis would have gone faster than its `max_feed`.
    pub blocks_limited: u64,
    /// Blocks of these whose F by time would be larger than `most_inverse_time`.
    pub blocks_capped: u64,
    /// Rapids that the control runs by itself and in which an axis may pass its `max_feed`.
    pub fast_rapids: FastRapids,
    /// Words of the CL file that say nothing to a machine, and how often.
    pub ignored_words: Vec<(String, u64)>,
    /// Plugins that took part.
    pub plugins: Vec<PluginUse>,
    /// What the planned feed came to, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plan: Option<PlanReport>,
    /// Ways between passes that go as bodies leave them, where that is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ways_across: Option<WaysAcross>,
    /// Where it waits for other channels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub waits: Vec<ReportedWait>,
    /// Warnings, as sentences.
    pub warnings: Vec<String>,
}

/// A wait for other channels.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportedWait {
    /// The mark of the CL file.
    pub mark: u32,
    /// The channels that wait, upwards; empty where nothing says which.
    pub channels: Vec<u32>,
    /// Line of the CL file.
    pub line: u64,
    /// Time before it, s, as `time_s` counts, without waits for others.
    pub time_s: f64,
    /// How long it waits for the others, s, likewise; none where the program was not made with theirs.
    pub waits_s: Option<f64>,
}

/// Rapids in which an axis passes its `max_feed` if the control keeps the tip and limits the axes of the program alone.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FastRapids {
    /// How many.
    pub count: u64,
    /// The axis that passes it farthest; empty if there is none.
    pub axis: String,
    /// Speed of that axis over its `max_feed`.
    pub factor: f64,
    /// Line of the CL file.
    pub line: u64,
}

/// Ways between passes of one tool, from where it departs to the next first position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WaysAcross {
    /// Over a lower height than that of the machine file's retract.
    pub low: u64,
    /// Past bodies.
    pub past: u64,
    /// Runs of rapids between two cuts of one orientation that are lower than in the CL file.
    pub rapids: u64,
    /// Over the machine file's retract, or as the CL file has them.
    pub as_ever: u64,
    /// Why those are, and how many of them.
    pub why: UnlinkedWays,
    /// What the others save, s, each of their pieces from rest to rest.
    pub saved_s: f64,
}

impl WaysAcross {
    /// One more is as ever.
    pub(crate) fn stays(&mut self, why: Unlinked) {
        self.as_ever += 1;
        self.why.0[why as usize] += 1;
    }
}

/// Why a way between two cuts is as ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unlinked {
    /// No quicker one is proven clear.
    Slower,
    /// The rapids of the CL file are as low as the cuts let them.
    Low,
    /// The tool turns in the rapids of the CL file, and is not retracted for it.
    Turns,
    /// The program stops there, or does what moves axes.
    Stops,
    /// The length of the tool is not known.
    Length,
    /// The machine retracts otherwise than by one axis alone (`leave`, several axes), or another head is in.
    Machine,
    /// No axis has a largest feed: which way is quicker is not known.
    Feeds,
}

impl Unlinked {
    /// All of them, with their keys in the summary and what they mean.
    pub const ALL: [(Self, &'static str, &'static str); 7] = [
        (Self::Slower, "not_quicker", "no quicker one is proven clear"),
        (Self::Low, "low", "as low as the cuts"),
        (Self::Turns, "turns", "the tool turns without a retract"),
        (Self::Stops, "stops", "the program stops or moves axes there"),
        (Self::Length, "no_length", "the tool's length is not known"),
        (Self::Machine, "machine", "the machine retracts another way"),
        (Self::Feeds, "no_feeds", "axes have no max_feed"),
    ];
}

/// Ways that are as ever, by the reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnlinkedWays([u64; Unlinked::ALL.len()]);

impl UnlinkedWays {
    /// Reasons that there are, each with its key, its meaning and how many ways.
    pub fn counts(&self) -> impl Iterator<Item = (&'static str, &'static str, u64)> {
        let all =
            Unlinked::ALL.iter().map(|(why, key, meaning)| (*key, *meaning, self.0[*why as usize]));
        all.filter(|(.., count)| *count > 0)
    }
}

impl Serialize for UnlinkedWays {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.counts().map(|(key, _, count)| (key, count)))
    }
}

/// A deviation and where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ReportedDeviation {
    /// How large; the unit is in the key.
    pub value: f64,
    /// Line of the NC program.
    pub block: u64,
    /// Line of the CL file.
    pub line: u64,
}

/// Range of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct AxisRange {
    /// Address of the axis.
    pub name: String,
    /// Least axis position, mm or degrees; between the words too where the control keeps the tip.
    pub min: f64,
    /// Largest axis position, mm or degrees, likewise.
    pub max: f64,
    /// Travel of the axis; none for a cyclic axis.
    pub travel: Option<[f64; 2]>,
    /// Way of the axis over all blocks, mm or degrees; between the words too where the control keeps the tip.
    pub way: f64,
}

/// Range of a drive that is no axis: of a leg, or by a formula.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DriveRange {
    /// What it is called.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// Least value at the ends of blocks and of retracts.
    pub min: f64,
    /// Largest value there.
    pub max: f64,
    /// Its travel, if it has one.
    pub travel: Option<[f64; 2]>,
}

/// A plugin that took part.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PluginUse {
    /// Name of the plugin.
    pub name: String,
    /// Version of the plugin.
    pub version: String,
    /// The library it was opened from; none if it is linked in.
    pub path: Option<String>,
    /// Hash of the library's bytes.
    pub hash: Option<String>,
}
