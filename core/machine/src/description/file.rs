//! What a machine file may say: its keys and their types. Meaning is settled in [`super::build`].
//!
//! The JSON Schema is made from these types, and their doc comments are what an editor shows.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::motion_file::MotionFile;
use super::plan_file::PlanFile;
use super::program_file::ProgramFile;
use super::quantity::{Number, Quantity};
use super::servo_file::ServoFile;

/// A machine tool as `post` knows it. Positions are in mm in the machine frame with every axis at zero;
/// directions are those of the tool as seen from the part (ISO 841). Any number may be an expression of the
/// parameters, in quotes.
// `[control.<dialect>]` and `[accuracy.<model>]` are taken out before.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MachineFile {
    /// What the machine is called in programs and messages.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Structural code of ISO 10791 from the workpiece w over the bed b to the tool t, such as
    /// `[w C' A' b Y X Z (S) t]`; a prime marks an axis that carries the workpiece.
    #[schemars(with = "String", extend("pattern" = r"^\s*\[.*\]\s*$"))]
    pub chain: Spanned<String>,
    /// Named numbers for expressions; `--set NAME=VALUE` overrules them.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub parameters: BTreeMap<String, Quantity>,
    /// Where the part sits.
    #[serde(default)]
    pub workpiece: WorkpieceFile,
    /// The gauge point and the tool's directions.
    pub tool: ToolFile,
    /// Tool lengths by tool number, mm from the gauge point to the tip.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>", extend("propertyNames" = { "pattern": "^[0-9]+$" }))]
    pub tools: BTreeMap<String, Quantity>,
    /// The axes of the chain by their letters.
    #[schemars(with = "BTreeMap<String, AxisFile>", extend("propertyNames" = { "pattern": "^[A-CEI-LPQRU-Z][0-9]*$" }))]
    pub axis: BTreeMap<String, Spanned<AxisFile>>,
    /// STL files of the machine's bodies, for pictures alone; mm, machine frame, every axis at zero. An axis letter is what
    /// that axis moves, `b` the bed: they are drawn in place of what follows from the chain. `w` is what is clamped with
    /// the part, `t` a holder or head besides. A path is that from this file; an empty one takes away
    /// what an extended machine names.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, String>", extend("propertyNames" = { "pattern": "^([wbt]|[A-CEI-LPQRU-Z][0-9]*)$" }))]
    pub solids: BTreeMap<Spanned<String>, Spanned<String>>,
    /// How far the axes are from their set-points, by their letters; those of an axis without are followed exactly.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, ServoFile>", extend("propertyNames" = { "pattern": "^[A-CEI-LPQRU-Z][0-9]*$" }))]
    pub servo: BTreeMap<String, Spanned<ServoFile>>,
    /// The control and its language.
    #[schemars(with = "ControlFile")]
    pub control: Spanned<ControlFile>,
    /// How fast the spindle turns.
    #[serde(default)]
    pub spindle: SpindleFile,
    /// Words of the CL file that this machine has lines for.
    #[serde(default)]
    pub cl: ClFile,
    /// Text of the program, and what the control does to it.
    #[serde(default)]
    pub program: ProgramFile,
    /// What the program must keep.
    #[serde(default)]
    pub accuracy: AccuracyFile,
    /// Which of several solutions is taken.
    #[serde(default)]
    pub solution: SolutionFile,
    /// How the tool leaves the part when a cut cannot go on; without it such a cut is refused.
    #[schemars(with = "Option<RewindFile>")]
    pub rewind: Option<Spanned<RewindFile>>,
    /// How the control makes motion of a program; for what is predicted, not for what is posted.
    #[serde(default)]
    pub motion: MotionFile,
    /// What planned feeds keep; for `post --plan`.
    #[serde(default)]
    pub plan: PlanFile,
}

/// Where the part sits.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct WorkpieceFile {
    /// The part origin (the origin of the CL file) with all axes at zero, mm; [0, 0, 0] if not said, and
    /// `--mount X,Y,Z` for one job.
    #[schemars(with = "Option<[Number; 3]>")]
    pub mount: Option<[Quantity; 3]>,
    /// How the part is turned about its Z, degrees, right-handed: counter-clockwise for who looks down on it, from the
    /// machine's X to the part's with all axes at zero; 0 if not said, and `--turn DEG` for one job.
    #[schemars(with = "Option<Number>")]
    pub turn: Option<Quantity>,
}

/// The gauge point and the tool's directions.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolFile {
    /// The gauge point (spindle nose, gauge line) with all axes at zero, mm.
    #[schemars(with = "[Number; 3]")]
    pub gauge: [Quantity; 3],
    /// From the tip to the holder with all axes at zero, a direction of any length; [0, 0, 1] if not said.
    #[schemars(with = "Option<[Number; 3]>")]
    pub axis: Option<[Quantity; 3]>,
    /// Where the leading edge of a knife or disc points with all axes at zero, across the tool axis, a
    /// direction of any length; leave it out for a tool that turns.
    #[schemars(with = "Option<[Number; 3]>")]
    pub edge: Option<[Quantity; 3]>,
    /// The linear axis along which the control puts the tool's length: as its dialect does it if not said. Another axis is
    /// a promise about the control (a parameter, the tool's table, or with tcp = "control" its own data of the machine);
    /// "none", where tcp = "post", says that its length of each tool is 0 and that work offsets are measured with the tool
    /// in the spindle.
    #[schemars(with = "Option<String>")]
    pub length_axis: Option<Spanned<String>>,
    /// The point of the tool that must stay within tolerance; that of the CL file if not said.
    #[serde(default)]
    pub control_point: ControlPointFile,
}

/// How fast the spindle turns.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpindleFile {
    /// Least speed, rpm; a slower one is refused.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub min_speed: Option<Quantity>,
    /// Largest speed, rpm; a faster one is refused.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub max_speed: Option<Quantity>,
    /// It turns the part, and SFM and SMM are constant cutting speeds that the control keeps (G96); else they are
    /// those of the cutter's diameter, as revolutions a minute.
    #[serde(default)]
    pub surface_speed: bool,
}

/// Words of the CL file that this machine has lines for.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ClFile {
    /// The line of the program, or the lines, for a word that has no meaning to post: `OFSETL = "G{n+53}"`. Between braces
    /// n is the first number behind the slash, n2 the second. `"SET/OFSETL"` is for one form of a word alone.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Lines>")]
    pub words: BTreeMap<Spanned<String>, Spanned<Lines>>,
}

/// A line of the program, or several.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a line of the program or a list of lines is expected")]
pub(crate) enum Lines {
    One(String),
    #[schemars(extend("minItems" = 1))]
    Several(Vec<String>),
}

impl Lines {
    pub(crate) fn as_slice(&self) -> &[String] {
        match self {
            Self::One(line) => std::slice::from_ref(line),
            Self::Several(lines) => lines,
        }
    }
}

/// One axis: its kind and line, how far it goes and how fast.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AxisFile {
    /// A linear axis: the way the tool goes as seen from the part when the axis counts up, of any length.
    #[schemars(with = "Option<[Number; 3]>")]
    pub linear: Option<[Quantity; 3]>,
    /// A rotary axis: the direction about which the tool, as seen from the part, turns counter-clockwise when
    /// the axis counts up, of any length.
    #[schemars(with = "Option<[Number; 3]>")]
    pub rotary: Option<[Quantity; 3]>,
    /// Any point on the line of a rotary axis, mm.
    #[schemars(with = "Option<[Number; 3]>")]
    pub point: Option<[Quantity; 3]>,
    /// Least and largest position, mm or degrees, as the control shows them.
    #[schemars(with = "Option<[Number; 2]>")]
    pub travel: Option<Spanned<[Quantity; 2]>>,
    /// A rotary axis that turns without end; instead of travel.
    #[serde(default)]
    pub cyclic: bool,
    /// It counts the other way.
    #[serde(default)]
    pub reversed: bool,
    /// What the control shows where the drawing has the axis at zero, mm or degrees; 0 if not said.
    #[schemars(with = "Option<Number>")]
    pub zero: Option<Quantity>,
    /// The one turn over which the control shows a cyclic axis, degrees: [0, 360] or [-180, 180].
    #[schemars(with = "Option<[Number; 2]>")]
    pub range: Option<Spanned<[Quantity; 2]>>,
    /// It moves off the part alone, and stands here until something moves it, mm or degrees.
    #[schemars(with = "Option<Number>")]
    pub indexed: Option<Quantity>,
    /// The only positions that an indexed axis can stand at, mm or degrees.
    #[schemars(with = "Option<Vec<Number>>", extend("minItems" = 1))]
    pub positions: Option<Spanned<Vec<Quantity>>>,
    /// An indexed axis stands at whole multiples of this alone, mm or degrees.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub step: Option<Quantity>,
    /// The line of the program that clamps the axis where it stands in a cut, such as M10: a rotary one, or an indexed one.
    #[schemars(with = "Option<String>")]
    pub clamp: Option<Spanned<String>>,
    /// The line of the program that lets it go, such as M11.
    #[schemars(with = "Option<String>")]
    pub unclamp: Option<Spanned<String>>,
    /// A quill: it takes this share, 0 to 1, of the way of the axis it runs along.
    #[schemars(with = "Option<Number>", extend("minimum" = 0, "maximum" = 1))]
    pub share: Option<Quantity>,
    /// A quill: it moves only where the travel of the axis it runs along ends.
    #[schemars(with = "Option<bool>")]
    pub reserve: Option<Spanned<bool>>,
    /// Largest feed, mm/min or degrees a minute; no block asks for more.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub max_feed: Option<Quantity>,
    /// A feed a minute counts the way of this rotary axis along a circle of this diameter, mm, where the control does not
    /// keep the tip or counts turns all the same (tcp_feed_length = "combined"); in degrees if not said. 2 mm counts
    /// radians.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub feed_diameter: Option<Quantity>,
    /// Largest acceleration, mm/s² or degrees/s².
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub max_accel: Option<Quantity>,
    /// Largest jerk, mm/s³ or degrees/s³.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub max_jerk: Option<Quantity>,
    /// Largest jump of its velocity where one block passes into the next without a curve between them, mm/min or degrees a
    /// minute; if not said what max_accel makes of it in one period of [motion].
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub max_jump: Option<Quantity>,
}

/// Which of several solutions is taken.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SolutionFile {
    /// What is to be small over a pass: `time` (each axis' way over its `max_feed`), `cycle-time` (how long the
    /// machine takes about, by the feeds of the program and `max_feed`, `max_accel` and `max_jerk` of the axes; close to
    /// poles also which way to turn early), `travel` (root of the sum of squares of the rotary ways), `largest-axis` (the largest rotary way), or the way of one axis,
    /// `axis:C`. `time` if not said.
    #[schemars(with = "Option<String>", extend("pattern" = "^(time|cycle-time|travel|largest-axis|axis:[A-Z][0-9]*)$"))]
    pub rule: Option<Spanned<String>>,
    /// Sides of zero on which axes should stand if they can: `{ A = "negative" }`.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Side>")]
    pub prefer: BTreeMap<Spanned<String>, Side>,
    /// Sides of zero that axes must not leave.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Side>")]
    pub require: BTreeMap<Spanned<String>, Side>,
    /// Where axes stand before the first position, mm or degrees.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub start: BTreeMap<Spanned<String>, Quantity>,
    /// Groups of axes of which one at most moves in a block: `[["A", "C"]]`.
    #[serde(default)]
    #[schemars(with = "Vec<Vec<String>>")]
    pub exclusive: Vec<Vec<Spanned<String>>>,
    /// Points that are looked at before the first of them is settled; 2000 if not said, 1 takes the nearest
    /// solution each time.
    #[schemars(with = "Option<u32>", extend("minimum" = 1, "maximum" = 100_000))]
    pub look_ahead: Option<Spanned<u32>>,
    /// What is done close to a singular direction; blend if not said.
    #[serde(default)]
    pub pole: Pole,
    /// Where the leading edge points; travel if not said.
    #[serde(default)]
    pub edge: EdgeSource,
    /// Where the direction of travel turns by more, a tool with an edge is turned on the spot, degrees; 10 if
    /// not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub corner: Option<Quantity>,
}

/// How the tool leaves the part when a cut cannot go on: back along its axis, turn, and return.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RewindFile {
    /// How far the tool is drawn back along its axis, mm; this or `plane`.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub distance: Option<Quantity>,
    /// The tool is drawn back along its axis until its tip stands so high over the part origin, mm along Z of
    /// the part; this or `distance`.
    #[schemars(with = "Option<Number>")]
    pub plane: Option<Quantity>,
    /// Feed of the way out, mm/min; rapid if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub retract_feed: Option<Quantity>,
    /// Feed of the turn, degrees a minute; rapid if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub turn_feed: Option<Quantity>,
    /// Feed of the way back, mm/min; that of the cut if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub plunge_feed: Option<Quantity>,
}

/// A side of zero.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Zero and above.
    Positive,
    /// Zero and below.
    Negative,
}

/// What is done close to a singular direction.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Pole {
    /// The axis that turns the tool by nearly nothing is held, turned early or turned evenly, within
    /// `axis_tolerance`.
    #[default]
    Blend,
    /// Every point of the CL file is met exactly, whatever the axes must do for it.
    Exact,
}

/// Where a leading edge (knife, disc) points.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum EdgeSource {
    /// Along the direction of travel.
    #[default]
    Travel,
    /// Along the second vector of the CL points.
    Cl,
}

/// Who keeps the tip on its path.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Tcp {
    /// The control: linear words are the tip, rotary words the axes.
    Control,
    /// The post: all words are axis positions.
    #[default]
    Post,
}

impl Tcp {
    /// As a machine file writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Control => "control",
            Self::Post => "post",
        }
    }
}

/// How a cutting feed is written.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FeedMode {
    /// Inverse time where rotary axes move and the control does not keep the tip, if the dialect has it; else per minute.
    #[default]
    Auto,
    /// Always per minute (G94).
    PerMinute,
    /// Always inverse time (G93).
    InverseTime,
}

/// What F means under inverse time.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum InverseTime {
    /// One over the time of the block in minutes.
    #[default]
    Minutes,
    /// One over the time of the block in seconds.
    Seconds,
}

/// The length that a control's feed a minute is meant along when it does not keep the tip.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FeedLength {
    /// The linear axes alone; the rotary ones, in degrees, where no linear axis moves.
    #[default]
    Linear,
    /// Root of the sum of squares over all axes, mm and degrees alike.
    Combined,
    /// The longest axis travel, mm and degrees alike.
    Longest,
}

/// The length that a control's feed a minute is meant along where it keeps the tip.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum TcpFeedLength {
    /// The way of the tip; the rotary axes, in degrees, where the tip stands.
    #[default]
    Tip,
    /// Root of the sum of squares of the way of the tip and those of the rotary axes, each along the circle of its
    /// `feed_diameter` or in degrees: with a diameter of 2 mm in radians (eqs. 4 and 5 of the prediction paper, Zhang,
    /// Chen 2025).
    Combined,
}

/// How a rapid is written.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Rapid {
    /// As a rapid: how its axes go is for the control.
    Rapid,
    /// As a feed move at the highest feed that holds every `max_feed`, where a rotary axis turns or an axis would go
    /// too fast.
    Linear,
}

/// Which of the lengths that the CL file knows is the tool length.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ToolLength {
    /// `--tool-length`, the `[tools]` table, `LOADTL/…,LENGTH`.
    #[default]
    Assembly,
    /// After those, the length in `TLDATA` or `CUTTER` too.
    Cl,
}

/// What becomes of `INSERT text`.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Insert {
    /// A comment: SolidWorks CAM describes stock and tools with it, and `X85. Y38.` would be a move. A text that is
    /// nothing but words of a program is refused.
    #[default]
    Comment,
    /// A line of the program, letter for letter, as APT has it.
    Literal,
}

/// What becomes of `PPRINT text`.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Print {
    /// A comment.
    #[default]
    Comment,
    /// A message on the control's screen, where the dialect has any; else a comment.
    Message,
}

/// What becomes of `CUTCOM` on points of the tool's centre: those of Creo (`CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER`) and of
/// NX (`$$ centerline data`), and presumably those of SolidWorks CAM and CAMWorks, whose files do not say.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum CompensationOnCentre {
    /// It is refused: a register that holds the radius would cut the part off by it.
    #[default]
    Refuse,
    /// It is written, with a warning: the register holds the tool's wear alone.
    Wear,
    /// As `refuse`, but where the file does not say what its points are, they are those of the contour.
    Contour,
}

/// How the holes of drilling cycles are written.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Cycles {
    /// As cycles of the control where it has them and they do what the CL file asks for, else as moves.
    #[default]
    Native,
    /// As moves.
    Moves,
}

/// Units of the NC program.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum OutputUnits {
    /// mm, mm/min.
    #[default]
    Mm,
    /// inch, inch/min.
    Inch,
}

/// The control and its language; `[control.<dialect>]` holds the dialect's own options.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ControlFile {
    /// The plugin that writes the program, such as fanuc, heidenhain or linuxcnc.
    #[schemars(with = "String")]
    pub dialect: Spanned<String>,
    /// Who keeps the tip on its path while rotary axes turn; must be said if there are any.
    pub tcp: Option<Tcp>,
    /// Units of the NC program; mm if not said.
    #[serde(default)]
    pub units: OutputUnits,
    /// How a cutting feed is written; auto if not said.
    #[serde(default)]
    pub feed: FeedMode,
    /// What F means under inverse time; minutes if not said.
    #[serde(default)]
    pub inverse_time: InverseTime,
    /// The length that the control divides by F when it does not keep the tip; if not said as the dialect has it: combined
    /// for Fanuc, Mazak, Mitsubishi, Okuma and Hurco, linear for the others.
    pub feed_length: Option<FeedLength>,
    /// The length that the control divides by F when it keeps the tip; tip if not said.
    #[serde(default)]
    pub tcp_feed_length: TcpFeedLength,
    /// How a rapid is written in which a rotary axis turns, or an axis would pass its max_feed; if not said linear where the
    /// control keeps the tip without looking at its joints (LinuxCNC) and every axis has its max_feed, else rapid.
    pub rapid: Option<Rapid>,
    /// Which of the lengths that the CL file knows is the tool length; assembly if not said.
    #[serde(default)]
    pub tool_length: ToolLength,
    /// How the holes of drilling cycles are written; native if not said.
    #[serde(default)]
    pub cycles: Cycles,
    /// An operation whose tool axis stays is written in the control's own tilted plane, where the dialect has one;
    /// false if not said.
    #[serde(default)]
    pub planes: bool,
    /// What becomes of `INSERT text`; comment if not said.
    #[serde(default)]
    pub insert: Insert,
    /// What becomes of `PPRINT text`; comment if not said.
    #[serde(default)]
    pub print: Print,
    /// What becomes of CUTCOM on points of the tool's centre; refuse if not said.
    #[serde(default)]
    pub compensation_on_centre: CompensationOnCentre,
    /// Arcs and splines of the CL file that stay what they are, and arcs laid through points.
    #[serde(default)]
    pub arcs: ArcsFile,
    /// Where linear axes stand when the tool is retracted, machine coordinates, mm; the end of travel of the depth
    /// axis away from the part if not said.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub retract: Positions,
    /// How the tool leaves the part, and, the other way round, comes to it; by the depth axis alone (retract) if not said.
    #[schemars(with = "Option<LeaveFile>")]
    pub leave: Option<Spanned<LeaveFile>>,
    /// So far from the ends of their travel linear axes stay over a first position, so that a part which sits higher than
    /// [workpiece] mount says ends in no alarm, mm; half of the way where there is less, and 50 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub approach_room: Option<Quantity>,
    /// Where axes stand before a tool change, machine coordinates, mm or degrees; if not said the rotary axes of park there,
    /// and those that swivel the tool at 0. `{}` leaves all where they are.
    #[schemars(with = "Option<BTreeMap<String, Number>>")]
    pub change: Option<Positions>,
    /// Where axes stand at the end and after GOHOME, machine coordinates, mm or degrees.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub park: Positions,
}

/// How the tool leaves the part: straight back first, then axes go to positions of the machine. It comes back to the
/// place where it left its line, and in along it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LeaveFile {
    /// What it goes back along; tool if not said.
    #[serde(default)]
    pub along: LeaveAlong,
    /// How far, mm; less where the travel of an axis ends.
    #[schemars(with = "Number", extend("exclusiveMinimum" = 0))]
    pub distance: Quantity,
    /// Where axes go then, one after the other in the order written: max or min is the end of travel, a number a position
    /// in machine coordinates, mm or degrees.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Number>")]
    pub then: Positions,
}

/// What a tool leaves the part along.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum LeaveAlong {
    /// Its own axis.
    #[default]
    Tool,
}

/// Which curves the program has as curves.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ArcsFile {
    /// Arcs and splines of the CL file stay arcs and splines where dialect and machine allow; true if not said.
    pub keep: Option<bool>,
    /// How an arc is written: its centre (I J K), or its radius (R) where the dialect has that; centre if not said.
    #[serde(default)]
    pub form: ArcForm,
    /// How far one block goes; full if not said.
    #[serde(default)]
    pub split: ArcSplit,
    /// Smallest radius that is written as an arc, mm; 0.01 if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub least_radius: Option<Quantity>,
    /// Largest radius that is written as an arc, mm; 10000 if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub largest_radius: Option<Quantity>,
    /// Runs of points become the fewest arcs and lines that stay within the tolerance; false if not said.
    #[serde(default)]
    pub fit: bool,
}

/// How an arc is written.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ArcForm {
    /// With its centre.
    #[default]
    Centre,
    /// With its radius; it is cut so that no block turns by more than 160 degrees, since a radius says little of the
    /// centre near half a turn.
    Radius,
}

/// How far one block of an arc goes.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ArcSplit {
    /// Up to a whole turn.
    #[default]
    Full,
    /// Up to half a turn, but for the rounding of its ends.
    Half,
    /// To the next quadrant of the plane.
    Quadrant,
}

/// Positions of axes by their names.
pub(crate) type Positions = BTreeMap<Spanned<String>, Quantity>;

/// Where points are put in.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Placement {
    /// In the middle of every piece that is over.
    #[default]
    Bisect,
    /// As many equal pieces as the model's peak asks for.
    Even,
    /// As far apart as the certificate allows, shifted off the path so that the deviation is balanced about it.
    Fewest,
}

impl Placement {
    /// As a machine file writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bisect => "bisect",
            Self::Even => "even",
            Self::Fewest => "fewest",
        }
    }
}

/// What is done about a move that strays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Points on the exact inverse solution, where the placement puts them.
    #[default]
    Linearise,
    /// Points on the straight line of the axes, moved by minus the model's curve.
    Compensate,
}

impl Method {
    /// As a machine file writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linearise => "linearise",
            Self::Compensate => "compensate",
        }
    }
}

/// The point of the tool that must stay within tolerance.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ControlPointFile {
    /// So far from the point that the CL file gives, along the tool towards the holder, mm; 0 if not said.
    #[schemars(with = "Option<Number>")]
    pub along: Option<Quantity>,
    /// The cutting edge runs at this radius about the tool axis, mm; 0, the point itself, if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub radius: Option<Quantity>,
}

/// What the program must keep; `[accuracy.<model>]` holds the error model's own options.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct AccuracyFile {
    /// The error model, a plugin (sampled, harmonic, parabolic, or one of your own); sampled if not said.
    #[schemars(with = "Option<String>")]
    pub model: Option<Spanned<String>>,
    /// Where points are put in; bisect if not said.
    #[serde(default)]
    pub placement: Placement,
    /// Largest deviation of the tip in cuts, mm; 0.005 if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub tolerance: Option<Quantity>,
    /// Largest deviation of the tool axis in cuts, degrees; 0.05 if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub axis_tolerance: Option<Quantity>,
    /// Largest deviation of the tip in rapids, mm; 0.5 if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub rapid_tolerance: Option<Quantity>,
    /// What is done about a move that strays; linearise if not said.
    #[serde(default)]
    pub method: Method,
    /// Points put into a move that is compensated, at least; 1 if not said.
    #[schemars(with = "Option<u32>", extend("minimum" = 1, "maximum" = 999))]
    pub points: Option<Spanned<i64>>,
    /// Drop CL points that the tolerance makes needless; false if not said.
    #[serde(default)]
    pub reduce: bool,
    /// Where the path turns by more than this, degrees, a CL point is a corner: it is never dropped; 10 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0, "maximum" = 180))]
    pub corner: Option<Quantity>,
    /// Contour errors that the servos leave may be compensated (`post --compensate-servo`), no point being moved by more
    /// than this, mm, at most 1; if not said, they may not.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0, "maximum" = 1))]
    pub servo_compensation: Option<Quantity>,
}
