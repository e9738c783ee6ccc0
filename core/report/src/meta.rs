//! What the page tells besides tables and texts. Numbers in mm, degrees, s, mm/min; lines from 1; rows from 0.

use serde::Serialize;

/// Version of the format, counted up where an older page could not show what is written now.
pub const FORMAT: u32 = 1;

/// Everything the page is told. The keys are those of the page.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Meta {
    /// [`FORMAT`].
    pub format: u32,
    /// Who wrote it, with its version.
    pub by: String,
    /// What was done: `post`, `verify`, `predict`, `diff`, `convert`, `plan`.
    pub job: &'static str,
    /// The heading.
    pub title: String,
    /// What takes part, without folders.
    pub names: Names,
    /// How it came out.
    pub verdict: VerdictMeta,
    /// The largest of what is limited, and where.
    pub maxima: Vec<Maximum>,
    /// Label and text.
    pub facts: Vec<[String; 2]>,
    /// What of each axis is used.
    pub axes_used: Vec<AxisUsed>,
    /// Warnings and what else was found.
    pub warnings: Vec<Warning>,
    /// What "certified" leaves out, as sentences.
    pub excludes: Vec<String>,
    /// Places worth looking at, in the order of the blocks.
    pub events: Vec<EventMeta>,
    /// Number of events found beyond those that are listed.
    pub events_left_out: u64,
    /// Names for the column `limit`.
    pub limits: Vec<String>,
    /// Tolerances in force.
    pub tolerances: TolerancesMeta,
    /// The chain, to draw and to move.
    pub machine: Option<MachineMeta>,
    /// The chains of the heads that are swapped.
    pub heads: Vec<MachineMeta>,
    /// Row of the table of blocks from which another head is in use, and its number in [`Meta::heads`] from 1; 0: none.
    pub head_rows: Vec<[u64; 2]>,
    /// Length from the gauge point to the tip, mm; of several tools the first.
    pub tool_length: f64,
    /// What is known of pairs of bodies, where it was proven that nothing hits anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceMeta>,
    /// Poses with all their digits.
    pub checks: Vec<PoseCheck>,
    /// What `--report-max` left out.
    pub parts_left_out: Vec<String>,
    /// The tables of the document.
    pub tables: Vec<TableMeta>,
    /// Texts of the document.
    pub texts: Vec<TextMeta>,
}

/// What is known of pairs of bodies along the program; how near any two come on each line stands in the table `clearance`.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ClearanceMeta {
    /// Distance that all bodies keep at feed, mm.
    pub keep: f64,
    /// The pairs, those that come nearest first.
    pub pairs: Vec<ClearancePairMeta>,
}

/// What is known of two bodies.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ClearancePairMeta {
    /// Their names.
    pub bodies: [String; 2],
    /// They are never nearer on motions that are proven to be clear, mm.
    pub clear_by: Option<f64>,
    /// The nearest that was found, mm.
    pub nearest: Option<f64>,
    /// Where: line of the program.
    pub nc: Option<u64>,
    /// Motions on which they are not clear.
    pub not_clear: u64,
}

/// Files without their folders, and the machine.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Names {
    /// The NC program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nc: Option<String>,
    /// The CL file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cl: Option<String>,
    /// The other program, if there are two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nc2: Option<String>,
    /// The machine.
    pub machine: String,
}

/// How it came out.
#[derive(Clone, Debug, Default, Serialize)]
pub struct VerdictMeta {
    /// `good`, `warn` or `bad`.
    pub kind: &'static str,
    /// A word or two.
    pub word: String,
    /// What makes it so.
    pub sentences: Vec<String>,
}

/// The largest of something, and where.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Maximum {
    /// What.
    pub name: String,
    /// How large.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// What it must keep.
    pub limit: Option<f64>,
    /// Row of the table of blocks.
    pub row: Option<u64>,
    /// Line of the program.
    pub nc: Option<u64>,
    /// Line of the CL file.
    pub cl: Option<u64>,
}

/// What of an axis is used.
#[derive(Clone, Debug, Default, Serialize)]
pub struct AxisUsed {
    /// Address of the axis.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// Least position.
    pub min: f64,
    /// Largest position.
    pub max: f64,
    /// Travel; none if it is endless.
    pub travel: Option<[f64; 2]>,
    /// The sum of its moves; none where they were not added up.
    pub way: Option<f64>,
}

/// Something that was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Warning {
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// Code of the message.
    pub code: String,
    /// What.
    pub text: String,
    /// What would help.
    pub help: Option<String>,
    /// Line of the program.
    pub nc: Option<u64>,
    /// Line of the CL file.
    pub cl: Option<u64>,
}

/// A place worth looking at.
#[derive(Clone, Debug, Default, Serialize)]
pub struct EventMeta {
    /// Row of the table of blocks.
    pub row: u64,
    /// `tool`, `operation`, `rewind`, `branch`, `cycle`, `stop`.
    pub kind: &'static str,
    /// What.
    pub text: String,
    /// Size of the tool that comes, as far as it is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cutter: Option<CutterMeta>,
    /// Its outline, where the machine file has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outline: Option<OutlineMeta>,
}

/// How far a tool reaches from its axis: points [z, r], mm.
#[derive(Clone, Debug, Default, Serialize)]
pub struct OutlineMeta {
    /// What cuts, z from the tip towards the gauge point.
    pub cutter: Vec<[f64; 2]>,
    /// What does not cut, z from the gauge point towards the tip.
    pub holder: Vec<[f64; 2]>,
}

/// Size of a tool, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct CutterMeta {
    /// Diameter of the cutter.
    pub diameter: f64,
    /// Radius of its corner: half the diameter for a ball.
    pub corner_radius: f64,
    /// From the holder's face to the tip.
    pub stick_out: Option<f64>,
}

/// Tolerances in force.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct TolerancesMeta {
    /// Tolerance of the tip in cuts, mm.
    pub tip: f64,
    /// Tolerance of the tool axis, degrees.
    pub axis: f64,
    /// Tolerance of the tip in rapids, mm.
    pub rapid: f64,
}

/// The chain, all axes at zero, machine frame, mm.
#[derive(Clone, Debug, Default, Serialize)]
pub struct MachineMeta {
    /// Name of the machine.
    pub name: String,
    /// `mm`.
    pub unit: &'static str,
    /// Axes from the workpiece to the tool; the column of an axis' positions is `q.NAME`.
    pub axes: Vec<AxisMeta>,
    /// The part frame in the machine frame, row by row.
    pub mount: [[f64; 4]; 4],
    /// The gauge point of the holder.
    pub gauge: [f64; 3],
    /// Unit vector from the tip to the holder.
    pub tool_axis: [f64; 3],
    /// Leading edge of a tool that does not turn.
    pub edge: Option<[f64; 3]>,
    /// Bodies that the table `solids` shows in place of what is drawn of the chain: 0 is the part, n what follows the
    /// nth axis.
    pub solid: Vec<usize>,
    /// Number of the shapes that are its own, of those in the table: heads mostly share them.
    pub shapes: usize,
}

/// An axis of the chain.
#[derive(Clone, Debug, Default, Serialize)]
pub struct AxisMeta {
    /// Address of the axis.
    pub name: String,
    /// `rotary` or `linear`.
    pub kind: &'static str,
    /// Unit vector, of the tool as seen from the part.
    pub direction: [f64; 3],
    /// A point of a rotary axis' line.
    pub point: [f64; 3],
    /// `work` or `tool`.
    pub carries: &'static str,
    /// Travel as the control shows it, mm or degrees; none if it is endless.
    pub travel: Option<[f64; 2]>,
    /// Whether the axis turns without end.
    pub cyclic: bool,
    /// What the control shows with the axis at zero, mm or degrees: a position less this is how far it has moved.
    pub zero: f64,
    /// Largest velocity, mm/min or degrees/min, if the file says it.
    pub max_feed: Option<f64>,
    /// Largest acceleration, mm/s² or degrees/s², if the file says it.
    pub max_accel: Option<f64>,
}

/// A pose as it was reckoned here, for the page to hold its chain against.
#[derive(Clone, Debug, Default, Serialize)]
pub struct PoseCheck {
    /// Row of the table of blocks.
    pub row: u64,
    /// Axis values in chain order, as the control shows them.
    pub joints: Vec<f64>,
    /// Length from the gauge point to the tip, mm.
    pub tool_length: f64,
    /// The tip, part frame.
    pub tip: [f64; 3],
    /// The tool axis, part frame.
    pub axis: [f64; 3],
}

/// What the page must know of a table.
#[derive(Clone, Debug, Default, Serialize)]
pub struct TableMeta {
    /// Name of the table.
    pub name: &'static str,
    /// Number of rows.
    pub rows: u64,
    /// Columns, in the order of a chunk.
    pub columns: Vec<ColumnMeta>,
    /// Bytes in the document.
    pub bytes: u64,
}

/// What the page must know of a column.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ColumnMeta {
    /// Name of the column.
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Decimals: a value is an integer over a power of ten.
    pub decimals: u8,
    /// What it is told against: `chain`, where tip and tool axis are by the axis values of the row; `tips`, where the
    /// linear axes are by its tip and its rotary axes; `t1`, that of the row before; `way`, that of the row before and
    /// what a straight way takes at the feed; `tip`, evenly between the tips of the block; `blocks`, the tip of the
    /// block that comes from the same line. None: it is told as it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<&'static str>,
}

/// What the page must know of a text.
#[derive(Clone, Debug, Default, Serialize)]
pub struct TextMeta {
    /// Name of the text.
    pub name: &'static str,
    /// Number of lines.
    pub lines: u64,
    /// Bytes in the document.
    pub bytes: u64,
}
