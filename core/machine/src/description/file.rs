//! What a machine file may say: its keys and their types. Meaning is settled in [`super::build`].
//!
//! The JSON Schema is made from these tables, and their doc comments are what an editor shows.

use std::collections::BTreeMap;

use serde_json::json;

use super::bodies::{BodyFile, ClearanceFile};
use super::bounds::Bounds;
use super::dependent::LimitFile;
use super::drives::DriveFile;
use super::errors::ErrorFile;
use super::legs::LegFile;
use super::mode::ModeFile;
use super::motion::MotionFile;
use super::plan::PlanFile;
use super::profile::ProfileFile;
use super::program_file::ProgramFile;
use super::quantity::KeyedNumber;
use super::servo_file::ServoFile;
use super::stock::StockFile;
use super::table::{
    Count, DeValue, EntryError, Key, KeyType, Schemas, Slip, Spanned, Value, defined, keys, words,
};
use super::tools::ToolsFile;
use super::wait::WaitFile;
use super::word::WordFile;

/// Names of axes.
const AXES: Bounds = Bounds::names("^[A-CEI-LPQRU-Z][0-9]*$");

/// Names of formulas.
const FORMULAS: Bounds = Bounds::names("^[A-Za-z_][A-Za-z0-9_]*$");

/// Names of bodies.
const BODIES: Bounds =
    Bounds { default: Some("{}"), ..Bounds::names("^([wbt]|[A-CEI-LPQRU-Z][0-9]*)$") };

/// What an axis does in a time, and lengths of its own.
const RATE: Bounds = Bounds::above_zero("machine-axis");

/// Numbers of `[solution]` and `[rewind]`.
const CHOICE: Bounds = Bounds::above_zero("machine-solution");

const REWIND: Bounds = Bounds { called: Some("distance of [rewind]"), ..CHOICE };

const RADIUS: Bounds = Bounds::above_zero("machine-arcs");

const ROOM: Bounds =
    Bounds { says: " mm", help: "0 or more", ..Bounds::from_zero("machine-frame") };

const TOLERANCE: Bounds = Bounds::above_zero("machine-tolerance");

const COMPENSATION: Bounds = Bounds { most: Some(1.0), ..TOLERANCE };

const CORNER: Bounds =
    Bounds::within(0.0, 180.0, "machine-corner", "; it must be 0 to 180 degrees");

const POINTS: Bounds = Bounds::within(1.0, 999.0, "machine-points", "; it must be 1 to 999");

const CUTTING_EDGE: Bounds = Bounds {
    called: Some("the radius of the cutting edge"),
    ..Bounds::from_zero("machine-control-point")
};

/// The least speed of a spindle.
const LEAST: Bounds =
    Bounds { says: " rpm", help: "speeds are above zero", ..Bounds::from_zero("machine-spindle") };

/// The largest speed of a spindle.
const LARGEST: Bounds = Bounds { above: Some(0.0), least: None, ..LEAST };

keys! {
    /// A machine tool as `post` knows it. Positions are in mm in the machine frame with every axis at zero;
    /// directions are those of the tool as seen from the part (ISO 841). Any number may be an expression of the
    /// parameters, in quotes.
    MachineFile {
        /// What the machine is called in programs and messages.
        name: Spanned<String>,
        /// Structural code of ISO 10791 from the workpiece w over the bed b to the tool t, such as
        /// `[w C' A' b Y X Z (S) t]`; a prime marks an axis that carries the workpiece.
        chain: Spanned<String> = Bounds::pattern(r"^\s*\[.*\]\s*$"),
        /// Named numbers for expressions; `--set NAME=VALUE` overrules them.
        parameters: BTreeMap<String, KeyedNumber>,
        /// Where the part sits.
        workpiece: WorkpieceFile,
        /// The gauge point and the tool's directions.
        tool: ToolFile,
        /// Lengths of tools by number, mm from the gauge point to the tip (`1 = 120.5`), or tables of length and outline by
        /// number (`[tools.1]`), and the file of tools.
        tools: ToolsFile,
        /// The axes of the chain by their letters.
        axis: Spanned<BTreeMap<String, Spanned<AxisFile>>> = AXES,
        /// Errors of axes that depend on where they stand, by their letters.
        error: BTreeMap<Spanned<String>, Spanned<ErrorFile>> = AXES,
        /// Words of the program that are no axis values, by their letters.
        word: BTreeMap<Spanned<String>, Spanned<WordFile>> = AXES,
        /// Limits of axes that depend on other axes, each `[[limit]]` one.
        limit: Vec<Spanned<LimitFile>> = Bounds { default: Some("[]"), ..Bounds::ANY },
        /// Legs that drive the platform of a parallel machine, each `[[leg]]` one.
        leg: Vec<Spanned<LegFile>> = Bounds { default: Some("[]"), ..Bounds::ANY },
        /// Drives behind the axes of the program, each `[[drive]]` one, told by formulas.
        drive: Vec<Spanned<DriveFile>> = Bounds { default: Some("[]"), ..Bounds::ANY },
        /// Quantities of axes by names of your own, for drives, limits and one another: `tilt = "acos(cos(A) * cos(B))"`.
        formulas: BTreeMap<Spanned<String>, Spanned<String>> = FORMULAS,
        /// Coordinates of the control's own, in which whole operations are written.
        mode: ModeFile,
        /// How the program of one channel waits for those of the others.
        wait: WaitFile,
        /// STL files of the machine's bodies, for pictures and for `post clearance`; mm, machine frame, every axis at zero. An axis letter
        /// is what that axis moves, `b` the bed: they are drawn in place of what follows from the chain. `w` is what is
        /// clamped with the part, `t` a holder or head besides. A path is that from this file; an empty one takes away
        /// what an extended machine names.
        solids: BTreeMap<Spanned<String>, Spanned<String>> = BODIES,
        /// What holds the part, or is in the way besides, by names of your own: for `post clearance`.
        fixture: BTreeMap<Spanned<String>, Spanned<BodyFile>>,
        /// What is cut, as it is before it is cut: for `post clearance`, for texts of the program, and for dialects that tell the
        /// control of it, which otherwise take where the tool goes. Of several each has a name of your own, `[stock.NAME]`.
        stock: Option<Spanned<StockFile>>,
        /// Distances that bodies keep from one another: for `post clearance`.
        clearance: ClearanceFile,
        /// What `post lint` looks for in NC programs.
        lint: LintFile,
        /// How far the axes are from their set-points, by their letters; those of an axis without are followed exactly.
        servo: BTreeMap<String, Spanned<ServoFile>> = AXES,
        /// The control and its language.
        control: Spanned<ControlFile>,
        /// How fast the spindle turns.
        spindle: SpindleFile,
        /// Words of the CL file that this machine has lines for.
        cl: ClFile,
        /// Text of the program, and what the control does to it.
        program: ProgramFile,
        /// What the program must keep.
        accuracy: AccuracyFile,
        /// Which of several solutions is taken.
        solution: SolutionFile,
        /// How the tool leaves the part when a cut cannot go on; without it such a cut is refused.
        rewind: Option<Spanned<RewindFile>>,
        /// How the control makes motion of a program; for what is predicted, not for what is posted.
        motion: MotionFile,
        /// What planned feeds keep; for `post --plan`.
        plan: PlanFile,
        /// Of what machine the file is, and where its numbers come from.
        profile: ProfileFile,
    }
}

keys! {
    /// Where the part sits.
    WorkpieceFile {
        /// The part origin (the origin of the CL file) with all axes at zero, mm; [0, 0, 0] if not said, and
        /// `--mount X,Y,Z` for one job.
        mount: Option<[KeyedNumber; 3]>,
        /// How the part is turned about its Z, degrees, right-handed: counter-clockwise for who looks down on it, from the
        /// machine's X to the part's with all axes at zero; 0 if not said, and `--turn DEG` for one job.
        turn: Option<KeyedNumber>,
    }
}

keys! {
    /// The gauge point and the tool's directions.
    ToolFile {
        /// The gauge point (spindle nose, gauge line) with all axes at zero, mm.
        gauge: [KeyedNumber; 3],
        /// From the tip to the holder with all axes at zero, a direction of any length; [0, 0, 1] if not said.
        axis: Option<[KeyedNumber; 3]>,
        /// Where the leading edge of a knife or disc points with all axes at zero, across the tool axis, a
        /// direction of any length; leave it out for a tool that turns.
        edge: Option<[KeyedNumber; 3]>,
        /// The linear axis along which the control puts the tool's length: as its dialect does it if not said. Another
        /// axis is a promise about the control (a parameter, the tool's table, or with tcp = "control" its own data of
        /// the machine); "none", where tcp = "post", says that its length of each tool is 0 and that work offsets are
        /// measured with the tool in the spindle.
        length_axis: Option<Spanned<String>>,
        /// The point of the tool that must stay within tolerance; that of the CL file if not said.
        control_point: ControlPointFile,
    }
}

keys! {
    /// How fast the spindle turns.
    SpindleFile {
        /// Least speed, rpm; a slower one is refused.
        min_speed: Option<KeyedNumber> = LEAST,
        /// Largest speed, rpm; a faster one is refused.
        max_speed: Option<KeyedNumber> = LARGEST,
        /// It turns the part, and SFM and SMM are constant cutting speeds that the control keeps (G96); else they are
        /// those of the cutter's diameter, as revolutions a minute.
        surface_speed: bool = Bounds::OFF,
    }
}

keys! {
    /// What `post lint` looks for in NC programs.
    LintFile {
        /// Codes of findings that are not told of programs of this machine, such as `["coolant"]`.
        ignore: Vec<Spanned<String>> = Bounds { default: Some("[]"), ..Bounds::ANY },
    }
}

keys! {
    /// Words of the CL file that this machine has lines for.
    ClFile {
        /// The line of the program, or the lines, for a word that has no meaning to post: `OFSETL = "G{n+53}"`. Between
        /// braces n is the first number behind the slash, n2 the second; `{n:.3}` has decimals. `"SET/OFSETL"` is for one
        /// form of a word alone.
        words: BTreeMap<Spanned<String>, Spanned<OneOrMoreLines>>,
        /// The point of a turning tool's nose that the points of the CL file are, where its offsets in the control name the
        /// other one; both name the same if not said. `nose` and `quadrant` of `[tools.N]` describe each tool; for a machine
        /// of linear axes whose spindle turns the part.
        points: Option<Spanned<NosePoint>>,
        /// `AUXFUN/n` becomes the line M n, `PREFUN/n` the line G n, unless `words` has other lines for them.
        functions: bool = Bounds::OFF,
    }
}

/// A line of the program, or several.
#[derive(Debug)]
pub(crate) enum OneOrMoreLines {
    One(String),
    Several(Vec<String>),
}

impl KeyType for OneOrMoreLines {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let one = String::read(value, key).map(Self::One);
        one.or_else(|_| Vec::read(value, key).map(Self::Several)).map_err(|_| EntryError {
            span: value.span(),
            slip: Slip::Kind("a line of the program or a list of lines is expected".to_owned()),
        })
    }

    fn schema(named: &mut Schemas) -> Value {
        defined(named, "Lines", "A line of the program, or several.", |_| lines_schema())
    }
}

/// The schema of a line or a list of lines.
pub(super) fn lines_schema() -> Value {
    let lines = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1 });
    json!({ "anyOf": [{ "type": "string" }, lines] })
}

impl OneOrMoreLines {
    pub(crate) fn as_slice(&self) -> &[String] {
        match self {
            Self::One(line) => std::slice::from_ref(line),
            Self::Several(lines) => lines,
        }
    }
}

words! {
    /// What a control makes of the word of a rotary axis that turns without end.
    RotaryWay = Counted {
        /// Whole turns are counted: 450 is a quarter turn beyond 360.
        Counted "counted",
        /// A place within one turn, to which it turns the shorter way.
        Shorter "shorter",
        /// A place within one turn, and its sign is the way there: -90 turns to 90, counting down.
        Sign "sign",
    }
}

keys! {
    /// One axis: its kind and line, how far it goes and how fast.
    AxisFile {
        /// A linear axis: the way the tool goes as seen from the part when the axis counts up, of any length.
        linear: Option<[KeyedNumber; 3]>,
        /// A rotary axis: the direction about which the tool, as seen from the part, turns counter-clockwise when
        /// the axis counts up, of any length.
        rotary: Option<[KeyedNumber; 3]>,
        /// Any point on the line of a rotary axis, mm.
        point: Option<[KeyedNumber; 3]>,
        /// Least and largest position, mm or degrees, as the control shows them.
        travel: Option<Spanned<[KeyedNumber; 2]>>,
        /// A rotary axis that turns without end; instead of travel.
        cyclic: bool = Bounds::OFF,
        /// It counts the other way.
        reversed: bool = Bounds::OFF,
        /// What the control shows where the drawing has the axis at zero, mm or degrees; 0 if not said.
        zero: Option<KeyedNumber>,
        /// The one turn over which the control shows a cyclic axis, degrees: [0, 360] or [-180, 180].
        range: Option<Spanned<[KeyedNumber; 2]>>,
        /// What the control makes of the word of a cyclic axis; "shorter" if it has a range, "counted" if not.
        way: Option<Spanned<RotaryWay>>,
        /// It moves off the part alone, and stands here until something moves it, mm or degrees.
        indexed: Option<KeyedNumber>,
        /// The only positions that an indexed axis can stand at, mm or degrees.
        positions: Option<Spanned<Vec<KeyedNumber>>> = Bounds::items(1),
        /// An indexed axis stands at whole multiples of this alone, mm or degrees.
        step: Option<KeyedNumber> = RATE,
        /// The line of the program that clamps the axis where it stands in a cut, such as M10: a rotary one, or an
        /// indexed one.
        clamp: Option<Spanned<String>>,
        /// The line of the program that lets it go, such as M11.
        unclamp: Option<Spanned<String>>,
        /// A quill: it takes this share, 0 to 1, of the way of the axis it runs along.
        share: Option<KeyedNumber> = Bounds::within(0.0, 1.0, "", ""),
        /// A quill: it moves only where the travel of the axis it runs along ends.
        reserve: Option<Spanned<bool>>,
        /// Largest feed, mm/min or degrees a minute; no block asks for more.
        max_feed: Option<KeyedNumber> = RATE,
        /// A feed a minute counts the way of this rotary axis along a circle of this diameter, mm, where the control
        /// does not keep the tip or counts turns all the same (tcp_feed_length = "combined"); in degrees if not said. 2
        /// mm counts radians.
        feed_diameter: Option<KeyedNumber> = RATE,
        /// Largest acceleration, mm/s² or degrees/s².
        max_accel: Option<KeyedNumber> = RATE,
        /// Largest jerk, mm/s³ or degrees/s³.
        max_jerk: Option<KeyedNumber> = RATE,
        /// Largest jump of its velocity where one block passes into the next without a curve between them, mm/min or
        /// degrees a minute; if not said what max_accel makes of it in one period of [motion].
        max_jump: Option<KeyedNumber> = RATE,
    }
}

keys! {
    /// Which of several solutions is taken.
    SolutionFile {
        /// What is to be small over a pass: `time` (each axis' way over its `max_feed`), `cycle-time` (how long the
        /// machine takes about, by the feeds of the program and `max_feed`, `max_accel` and `max_jerk` of the axes;
        /// close to poles also which way to turn early), `travel` (root of the sum of squares of the rotary ways),
        /// `largest-axis` (the largest rotary way), or the way of one axis, `axis:C`. `time` if not said.
        rule: Option<Spanned<String>> = Bounds::pattern("^(time|cycle-time|travel|largest-axis|axis:[A-Z][0-9]*)$"),
        /// Sides of zero on which axes should stand if they can: `{ A = "negative" }`.
        prefer: BTreeMap<Spanned<String>, Side>,
        /// Sides of zero that axes must not leave.
        require: BTreeMap<Spanned<String>, Side>,
        /// Where axes stand before the first position, mm or degrees.
        start: BTreeMap<Spanned<String>, KeyedNumber>,
        /// Groups of axes of which one at most moves in a block: `[["A", "C"]]`.
        exclusive: Vec<Vec<Spanned<String>>> = Bounds { default: Some("[]"), ..Bounds::ANY },
        /// Points that are looked at before the first of them is settled; 2000 if not said, 1 takes the nearest
        /// solution each time.
        look_ahead: Option<Spanned<u32>> = Bounds::within(1.0, 100_000.0, "", ""),
        /// What is done close to a singular direction; blend if not said.
        pole: Pole,
        /// Where the leading edge points; travel if not said.
        edge: EdgeSource,
        /// Where the direction of travel turns by more, a tool with an edge is turned on the spot, degrees; 10 if
        /// not said.
        corner: Option<KeyedNumber> = CHOICE,
    }
}

keys! {
    /// How the tool leaves the part when a cut cannot go on: back along its axis, turn, and return.
    RewindFile {
        /// How far the tool is drawn back along its axis, mm; this or `plane`.
        distance: Option<KeyedNumber> = REWIND,
        /// The tool is drawn back along its axis until its tip stands so high over the part origin, mm along Z of
        /// the part; this or `distance`.
        plane: Option<KeyedNumber>,
        /// Feed of the way out, mm/min; rapid if not said.
        retract_feed: Option<KeyedNumber> = CHOICE,
        /// Feed of the turn, degrees a minute; rapid if not said.
        turn_feed: Option<KeyedNumber> = CHOICE,
        /// Feed of the way back, mm/min; that of the cut if not said.
        plunge_feed: Option<KeyedNumber> = CHOICE,
    }
}

words! {
    /// A side of zero.
    Side {
        /// Zero and above.
        Positive "positive",
        /// Zero and below.
        Negative "negative",
    }
}

words! {
    /// What is done close to a singular direction.
    Pole = Blend {
        /// The axis that turns the tool by nearly nothing is held, turned early or turned evenly, within
        /// `axis_tolerance`.
        Blend "blend",
        /// Every point of the CL file is met exactly, whatever the axes must do for it.
        Exact "exact",
    }
}

words! {
    /// Where a leading edge (knife, disc) points.
    EdgeSource = Travel {
        /// Along the direction of travel.
        Travel "travel",
        /// Along the second vector of the CL points.
        Cl "cl",
    }
}

words! {
    /// Who keeps the tip on its path.
    Tcp = Post {
        /// The control (RTCP, TCP, TCPM, TRAORI): linear words are the tip, rotary words the axes.
        Control "control",
        /// The post: all words are axis positions.
        Post "post",
    }
}

words! {
    /// How a cutting feed is written.
    FeedMode = Auto {
        /// Inverse time where rotary axes move and the control does not keep the tip, if the dialect has it; else per
        /// minute.
        Auto "auto",
        /// Always per minute (G94).
        PerMinute "per-minute",
        /// Always inverse time (G93).
        InverseTime "inverse-time",
    }
}

words! {
    /// What F means under inverse time.
    InverseTime = Minutes {
        /// One over the time of the block in minutes.
        Minutes "minutes",
        /// One over the time of the block in seconds.
        Seconds "seconds",
    }
}

words! {
    /// The length that a control's feed a minute is meant along when it does not keep the tip.
    FeedLength = Linear {
        /// The linear axes alone; the rotary ones, in degrees, where no linear axis moves.
        Linear "linear",
        /// The linear axes alone; the rotary one that turns the most, in degrees, where no linear axis moves.
        LinearOrLongest "linear-or-longest",
        /// Root of the sum of squares over all axes, mm and degrees alike.
        Combined "combined",
        /// The longest axis travel, mm and degrees alike.
        Longest "longest",
    }
}

words! {
    /// The length that a control's feed a minute is meant along where it keeps the tip.
    TcpFeedLength = Tip {
        /// The way of the tip; the rotary axes, in degrees, where the tip stands.
        Tip "tip",
        /// Root of the sum of squares of the way of the tip and those of the rotary axes, each along the circle of its
        /// `feed_diameter` or in degrees: with a diameter of 2 mm in radians (eqs. 4 and 5 of the prediction paper, Zhang,
        /// Chen 2025).
        Combined "combined",
    }
}

words! {
    /// How a rapid is written.
    Rapid {
        /// As a rapid: how its axes go is for the control.
        Rapid "rapid",
        /// As a feed move at the highest feed that holds every `max_feed`, where a rotary axis turns or an axis would go
        /// too fast.
        Linear "linear",
    }
}

words! {
    /// Which of the lengths that the CL file knows is the tool length.
    ToolLength = Assembly {
        /// `--tool-length`, the `[tools]` table, `LOADTL/…,LENGTH`.
        Assembly "assembly",
        /// After those, the length in `TLDATA` or `CUTTER` too.
        Cl "cl",
    }
}

words! {
    /// A point of a turning tool's nose.
    NosePoint {
        /// Its centre; the offsets in the control name its imaginary tip.
        Centre "centre",
        /// Its imaginary tip; the offsets in the control name its centre.
        Tip "tip",
    }
}

words! {
    /// What becomes of `INSERT text`.
    Insert = Comment {
        /// A comment: SolidWorks CAM describes stock and tools with it, and `X85. Y38.` would be a move. A text that is
        /// nothing but words of a program is refused.
        Comment "comment",
        /// A line of the program, letter for letter, as APT has it.
        Literal "literal",
    }
}

words! {
    /// What becomes of `PPRINT text`.
    Print = Comment {
        /// A comment.
        Comment "comment",
        /// A message on the control's screen, where the dialect has any; else a comment.
        Message "message",
        /// A line of the program, letter for letter.
        Literal "literal",
    }
}

words! {
    /// What becomes of `CUTCOM` on points of the tool's centre: those of Creo (`CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_CENTER`)
    /// and of NX (`$$ centerline data`), and presumably those of SolidWorks CAM and CAMWorks, whose files do not say.
    CompensationOnCentre = Refuse {
        /// It is refused: a register that holds the radius would cut the part off by it.
        Refuse "refuse",
        /// It is written, with a warning: the register holds the tool's wear alone.
        Wear "wear",
        /// As `refuse`, but where the file does not say what its points are, they are those of the contour.
        Contour "contour",
    }
}

words! {
    /// How a robot's control leads cuts.
    Moves = Joints {
        /// All joints evenly to their positions.
        Joints "joints",
        /// The tool straight to its pose, turned evenly about one direction; in a dialect that has words for it.
        Straight "straight",
    }
}

words! {
    /// What a program tells of where the tool points.
    Orientation {
        /// The values of the rotary axes.
        Axes "axes",
        /// The direction of the tool as a vector, under tool centre point control: I J K, A3= B3= C3=, TX TY TZ.
        Vector "vector",
        /// How the tool as a whole stands, in straight moves: turned about its Z, then its new Y, then its new X, degrees.
        AbcZyx "abc-zyx",
        /// The same as a quaternion.
        Quaternion "quaternion",
        /// The same as the direction that the tool has been turned about, as long as the turn, radians.
        RotationVector "rotation-vector",
    }
}

impl Orientation {
    /// It tells how the tool as a whole stands, not its axis alone.
    pub fn is_whole(self) -> bool {
        !matches!(self, Self::Axes | Self::Vector)
    }
}

words! {
    /// How the holes of drilling cycles are written.
    Cycles = Native {
        /// As cycles of the control where it has them and they do what the CL file asks for, else as moves.
        Native "native",
        /// As moves.
        Moves "moves",
    }
}

words! {
    /// Units of the NC program.
    OutputUnits = Mm {
        /// mm, mm/min.
        Mm "mm",
        /// inch, inch/min.
        Inch "inch",
    }
}

keys! {
    /// The control and its language; `[control.<dialect>]` holds the dialect's own options.
    ControlFile {
        /// The plugin that writes the program, such as fanuc, heidenhain or linuxcnc.
        dialect: Spanned<String>,
        /// Who keeps the tip on its path while rotary axes turn; must be said if there are any.
        tcp: Option<Tcp>,
        /// Units of the NC program; mm if not said.
        units: OutputUnits,
        /// How a cutting feed is written; auto if not said.
        feed: FeedMode,
        /// What F means under inverse time; minutes if not said.
        inverse_time: InverseTime,
        /// How a robot's control leads cuts; joints if not said, straight where orientation tells how the tool as a whole
        /// stands.
        moves: Moves,
        /// What the program tells of where the tool points, in a dialect that has words for it; axes if not said, in
        /// straight moves what the language has.
        orientation: Option<Orientation>,
        /// The length that the control divides by F when it does not keep the tip; if not said as the dialect has it:
        /// combined for Brother, Fanuc, Hurco, Mazak, Mitsubishi, Okuma and Syntec, linear-or-longest for Klipper, linear for
        /// the others.
        feed_length: Option<FeedLength>,
        /// The length that the control divides by F when it keeps the tip; tip if not said.
        tcp_feed_length: TcpFeedLength,
        /// How a rapid is written in which a rotary axis turns, or an axis would pass its max_feed; if not said linear
        /// where the control keeps the tip without looking at its joints (LinuxCNC) and every axis has its max_feed,
        /// else rapid.
        rapid: Option<Rapid>,
        /// Which of the lengths that the CL file knows is the tool length; assembly if not said.
        tool_length: ToolLength,
        /// How the holes of drilling cycles are written; native if not said.
        cycles: Cycles,
        /// An operation whose tool axis stays (3+2) is written in the control's own tilted plane, where the dialect has
        /// one; if not said where the control has cycles, arcs and cutter compensation in it, and the chain two rotary
        /// axes, which point the tool, and X, Y and Z, which stand square to one another and are not turned by them.
        planes: Option<bool>,
        /// What becomes of `INSERT text`; comment if not said.
        insert: Insert,
        /// What becomes of `PPRINT text`; comment if not said.
        print: Print,
        /// What becomes of CUTCOM on points of the tool's centre; refuse if not said.
        compensation_on_centre: CompensationOnCentre,
        /// Arcs and splines of the CL file that stay what they are, and arcs laid through points.
        arcs: ArcsFile,
        /// Where linear axes stand when the tool is retracted, machine coordinates, mm; the end of travel of the depth
        /// axis away from the part if not said. `{}`: nothing retracts, as of a wire or of a winder.
        retract: Option<AxisPositions>,
        /// How the tool leaves the part, and, the other way round, comes to it; by the depth axis alone (retract) if
        /// not said.
        leave: Option<Spanned<LeaveFile>>,
        /// So far from the ends of their travel linear axes stay over a first position, so that a part which sits
        /// higher than [workpiece] mount says ends in no alarm, mm; half of the way where there is less, and 50 if not
        /// said.
        approach_room: Option<KeyedNumber> = ROOM,
        /// Where axes stand before a tool change, machine coordinates, mm or degrees; if not said the rotary axes of
        /// park there, and those that swivel the tool at 0. `{}` leaves all where they are.
        change: Option<AxisPositions>,
        /// Where axes stand at the end and after GOHOME, machine coordinates, mm or degrees.
        park: AxisPositions,
    }
}

keys! {
    /// How the tool leaves the part: straight back first, then axes go to positions of the machine. It comes back to the
    /// place where it left its line, and in along it.
    LeaveFile {
        /// What it goes back along; tool if not said.
        along: LeaveAlong,
        /// How far, mm; less where the travel of an axis ends.
        distance: KeyedNumber = CHOICE,
        /// Where axes go then, one after the other in the order written: max or min is the end of travel, a number a
        /// position in machine coordinates, mm or degrees.
        then: AxisPositions,
    }
}

words! {
    /// What a tool leaves the part along.
    LeaveAlong = Tool {
        /// Its own axis.
        Tool "tool",
    }
}

keys! {
    /// Which curves the program has as curves.
    ArcsFile {
        /// Arcs and splines of the CL file stay arcs and splines where dialect and machine allow; true if not said.
        keep: Option<bool>,
        /// How an arc is written: its centre (I J K), or its radius (R) where the dialect has that; centre if not said.
        form: ArcForm,
        /// How far one block goes; full if not said.
        split: ArcSplit,
        /// Smallest radius that is written as an arc, mm; 0.01 if not said.
        least_radius: Option<KeyedNumber> = RADIUS,
        /// Largest radius that is written as an arc, mm; 10000 if not said.
        largest_radius: Option<KeyedNumber> = RADIUS,
        /// Runs of points become the fewest arcs and lines that stay within the tolerance; false if not said.
        fit: bool = Bounds::OFF,
    }
}

words! {
    /// How an arc is written.
    ArcForm = Centre {
        /// With its centre.
        Centre "centre",
        /// With its radius; it is cut so that no block turns by more than 160 degrees, since a radius says little of the
        /// centre near half a turn.
        Radius "radius",
    }
}

words! {
    /// How far one block of an arc goes.
    ArcSplit = Full {
        /// Up to a whole turn.
        Full "full",
        /// Up to half a turn, but for the rounding of its ends.
        Half "half",
        /// To the next quadrant of the plane.
        Quadrant "quadrant",
    }
}

/// Positions of axes by their names.
pub(crate) type AxisPositions = BTreeMap<Spanned<String>, KeyedNumber>;

words! {
    /// Where points are put in.
    Placement = Bisect {
        /// In the middle of every piece that is over.
        Bisect "bisect",
        /// As many equal pieces as the model's peak asks for.
        Even "even",
        /// As far apart as the certificate allows, shifted off the path so that the deviation is balanced about it.
        Fewest "fewest",
    }
}

words! {
    /// What is done about a move that strays.
    Method = Linearise {
        /// Points on the exact inverse solution, where the placement puts them.
        Linearise "linearise",
        /// Points on the straight line of the axes, moved by minus the model's curve.
        Compensate "compensate",
    }
}

keys! {
    /// The point of the tool that must stay within tolerance.
    ControlPointFile {
        /// So far from the point that the CL file gives, along the tool towards the holder, mm; 0 if not said.
        along: Option<KeyedNumber>,
        /// The cutting edge runs at this radius about the tool axis, mm; 0, the point itself, if not said.
        radius: Option<KeyedNumber> = CUTTING_EDGE,
    }
}

keys! {
    /// What the program must keep; `[accuracy.<model>]` holds the error model's own options.
    AccuracyFile {
        /// The error model, a plugin (sampled, harmonic, parabolic, or one of your own); sampled if not said.
        model: Option<Spanned<String>>,
        /// Where points are put in; bisect if not said.
        placement: Placement,
        /// Largest deviation of the tip in cuts, mm; 0.005 if not said.
        tolerance: Option<KeyedNumber> = TOLERANCE,
        /// Largest deviation of the tool axis in cuts, degrees; 0.05 if not said.
        axis_tolerance: Option<KeyedNumber> = TOLERANCE,
        /// Largest deviation of the tip in rapids, mm; if not said 0.5, and `tolerance` where a word goes with the way of the tip (`[word.E] is = "0.0333 * s"`): a nozzle travels at the height of its beads. On the line of a tool that has cut, as in a hole, it is that of cuts, unless the axes turn to another solution there.
        rapid_tolerance: Option<KeyedNumber> = TOLERANCE,
        /// What is done about a move that strays; linearise if not said.
        method: Method,
        /// Points put into a move that is compensated, at least; 1 if not said.
        points: Option<Count> = POINTS,
        /// Drop CL points that the tolerance makes needless; false if not said.
        reduce: bool = Bounds::OFF,
        /// Where the path turns by more than this, degrees, a CL point is a corner: it is never dropped; 10 if not said.
        corner: Option<KeyedNumber> = CORNER,
        /// Contour errors that the servos leave may be compensated (`post --compensate-servo`), no point being moved by
        /// more than this, mm, at most 1; if not said, they may not.
        servo_compensation: Option<KeyedNumber> = COMPENSATION,
    }
}
