//! What a cutter-location file says, one record a logical line.
//!
//! Nothing is interpreted here: numbers keep the file's units, modal words are not carried on,
//! and a word that this crate does not know by name comes through as [`Statement::Other`].
//! Vocabulary: ISO 3592 and ISO 4343, and the forms that NX, Creo, SolidWorks CAM, CAMWorks and NCL write.

use std::borrow::Cow;
use std::fmt;

/// One logical line (continuations joined) and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Record<'a> {
    /// Line of the file on which the record begins, counted from 1.
    pub line: u64,
    /// The record as written, without line ends; continued lines are joined by one blank.
    pub raw: &'a [u8],
    /// What it says.
    pub statement: Statement,
}

impl Record<'_> {
    /// The record's text; bytes that are not UTF-8 are shown as U+FFFD.
    pub fn text(&self) -> Cow<'_, str> {
        String::from_utf8_lossy(self.raw)
    }
}

/// A position: three numbers, in the file's units.
pub type Point = [f64; 3];

/// A direction as written, of any length.
pub type Direction = [f64; 3];

/// What a record says.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// `GOTO/x,y,z[,i,j,k]`: move to a point, with a tool axis if six numbers are given.
    Goto {
        /// The point.
        point: Point,
        /// The tool axis, from the tip to the holder.
        axis: Option<Direction>,
    },
    /// `GOTO/x,y,z,i,j,k,u,v,w`: move to a point with a tool axis and a second direction across it, where the
    /// leading edge of a knife or disc points.
    GotoEdge {
        /// The point.
        point: Point,
        /// The tool axis, from the tip to the holder.
        axis: Direction,
        /// The leading edge.
        edge: Direction,
    },
    /// `HEAD/name`: the head that the machine works with from here on.
    Head(String),
    /// `GODLTA/dx,dy,dz` or `GODLTA/d`.
    Godlta(Delta),
    /// `FROM/`: where the tool stands at the start; no move.
    From {
        /// The point.
        point: Point,
        /// The tool axis, if given.
        axis: Option<Direction>,
    },
    /// `GOHOME`, `GOHOME/x,y,z[,i,j,k]`.
    Gohome(Option<(Point, Option<Direction>)>),
    /// `RAPID`, `RAPID/`: the next move is at rapid traverse.
    Rapid,
    /// `FEDRAT/`.
    Feed(FeedRate),
    /// `SPINDL/`.
    Spindle(SpindleWord),
    /// `COOLNT/`.
    Coolant(CoolantWord),
    /// `LOADTL/`, `LOAD/TOOL,`, `TURRET/`, `TOOLNO/`.
    LoadTool(LoadTool),
    /// `SELECT/TOOL,n`, `SELCTL/n`: bring the tool to the change position, no change yet.
    SelectTool(u32),
    /// `TLDATA/`: the cutter as NX describes it (kind word(s), then numbers).
    ToolData {
        /// `MILL`, `DRILL`, `TCUTTER` …, in the order written.
        kinds: Vec<String>,
        /// The numbers, in the order written.
        numbers: Vec<f64>,
    },
    /// `CUTTER/`: the seven APT cutter parameters, as many as are given.
    Cutter(Vec<f64>),
    /// `UNITS/`, `UNIT/`.
    Units(Units),
    /// `MULTAX/ON`, `MULTAX/OFF`; plain `MULTAX` is on.
    Multax(bool),
    /// `MODE/MILL`: the tool turns.
    Milling,
    /// `MODE/TURN`: the part turns.
    Turning,
    /// `MCS/`: the frame of an operation (CAMplete).
    Mcs {
        /// Directions of X, Y and Z.
        axes: [Direction; 3],
        /// Origin of the frame.
        origin: Point,
    },
    /// `MSYS/`: the frame of the operation (NX).
    Msys {
        /// Origin of the frame.
        origin: Point,
        /// Direction of X.
        x: Direction,
        /// Direction of Y.
        y: Direction,
    },
    /// `CSYS/` and `$$-> CSYS /`: a frame as a 3 × 4 matrix, row by row.
    Csys([f64; 12]),
    /// `CIRCLE/`: an arc that ends at the next `GOTO`.
    Circle(CircleRecord),
    /// `MOVARC/`: an arc by its angle that ends at the next `GOTO`.
    ArcMove(ArcMove),
    /// `INDIRV/tx,ty,tz`: where the tool sets out along the next curve.
    SetOut(Direction),
    /// `AUTOPS` (none) and `PSIS/(PLANE/…)`: normal of the plane in which the tip stays along the next curve; of
    /// `AUTOPS` it is Z.
    PartSurface(Option<Direction>),
    /// `TLON,GOFWD/…`: the tool goes along an arc to its end.
    AlongArc(AlongArc),
    /// `NURBS/`: a spline begins; its knots and control points follow.
    Nurbs,
    /// `KNOT/`.
    Knot(Vec<f64>),
    /// `CNTRL/x,y,z[,i,j,k]`.
    Control {
        /// The control point.
        point: Point,
        /// Tool axis, if given.
        axis: Option<Direction>,
    },
    /// `SET/OFSETL,n`, `OFSETL/n`: the work offset of that number holds from here on.
    WorkOffset {
        /// Number of the offset, from 1.
        number: u32,
        /// Whether `SET` stands in front.
        set: bool,
    },
    /// `CALSUB/n`: a subprogram of the control runs.
    Subprogram(u32),
    /// `CYCLE/`.
    Cycle(Cycle),
    /// `CUTCOM/`.
    Cutcom(Cutcom),
    /// `CUTCOM_GEOMETRY_TYPE/`: with `OUTPUT_ON_CENTER` the points are the tool's centre, as in every path without
    /// `CUTCOM`; else (false) those of the contour that `CUTCOM` offsets.
    CutcomOnCentre(bool),
    /// `ROTABL/`, `ROTATE/`: an index move of a rotary axis.
    Rotate(Rotate),
    /// `TLAXIS/i,j,k`: the tool axis of the moves that follow, in the part frame.
    ToolAxis(Direction),
    /// `DELAY/t`, `DELAY/n,REV`, `DWELL/`.
    Delay(Delay),
    /// `STOP`.
    Stop,
    /// `OPSTOP`.
    OptionalStop,
    /// `SYNC/mark[,own channel,other channels]`: the channels wait for one another.
    Sync(SyncMark),
    /// `TOOL PATH/name,TOOL,tool`.
    ToolPath {
        /// The operation's name.
        name: String,
        /// The tool's name, if given.
        tool: Option<String>,
    },
    /// `END-OF-PATH`.
    EndOfPath,
    /// `PARTNO text`.
    PartName(String),
    /// `TPRINT/text`: name of the tool that is loaded next (CATIA).
    ToolName(String),
    /// `PPRINT text`: a remark for the operator.
    Print(String),
    /// `INSERT text`: a line for the NC program, letter for letter.
    Insert(String),
    /// `REMARK text`, `$$ text`.
    Remark(String),
    /// `FINI`, `END`.
    Fini,
    /// A word that has no statement of its own: `PAINT`, `CAMERA`, `PPWORD`, `BOX`, …
    /// Directives (`$$-> FEATNO / 32`, `REMARK -> …`) come as their word, with `directive` set.
    Other {
        /// The major word in capitals.
        word: Cow<'static, str>,
        /// What follows the slash.
        arguments: Vec<Argument>,
        /// Whether `$$->` or `REMARK ->` stood in front: meant for a program, but a remark to others.
        directive: bool,
    },
}

impl Statement {
    /// The major word's name: of the spellings that mean the same (`UNIT` and `UNITS`) always the same one.
    pub fn word(&self) -> &str {
        match self {
            Self::Goto { .. } | Self::GotoEdge { .. } => "GOTO",
            Self::Head(_) => "HEAD",
            Self::Godlta(_) => "GODLTA",
            Self::From { .. } => "FROM",
            Self::Gohome(_) => "GOHOME",
            Self::Rapid => "RAPID",
            Self::Feed(_) => "FEDRAT",
            Self::Spindle(_) => "SPINDL",
            Self::Coolant(_) => "COOLNT",
            Self::LoadTool(_) => "LOADTL",
            Self::SelectTool(_) => "SELECT",
            Self::ToolData { .. } => "TLDATA",
            Self::Cutter(_) => "CUTTER",
            Self::Units(_) => "UNITS",
            Self::Multax(_) => "MULTAX",
            Self::Milling | Self::Turning => "MODE",
            Self::Mcs { .. } => "MCS",
            Self::Msys { .. } => "MSYS",
            Self::Csys(_) => "CSYS",
            Self::Circle(_) => "CIRCLE",
            Self::ArcMove(_) => "MOVARC",
            Self::SetOut(_) => "INDIRV",
            Self::PartSurface(None) => "AUTOPS",
            Self::PartSurface(Some(_)) => "PSIS",
            Self::AlongArc(_) => "TLON",
            Self::Nurbs => "NURBS",
            Self::Knot(_) => "KNOT",
            Self::Control { .. } => "CNTRL",
            Self::WorkOffset { set: true, .. } => "SET",
            Self::WorkOffset { .. } => "OFSETL",
            Self::Subprogram(_) => "CALSUB",
            Self::Cycle(_) => "CYCLE",
            Self::Cutcom(_) => "CUTCOM",
            Self::CutcomOnCentre(_) => "CUTCOM_GEOMETRY_TYPE",
            Self::Rotate(_) => "ROTABL",
            Self::ToolAxis(_) => "TLAXIS",
            Self::Delay(_) => "DELAY",
            Self::Stop => "STOP",
            Self::Sync(_) => "SYNC",
            Self::OptionalStop => "OPSTOP",
            Self::ToolPath { .. } => "TOOL PATH",
            Self::EndOfPath => "END-OF-PATH",
            Self::PartName(_) => "PARTNO",
            Self::ToolName(_) => "TPRINT",
            Self::Print(_) => "PPRINT",
            Self::Insert(_) => "INSERT",
            Self::Remark(_) => "REMARK",
            Self::Fini => "FINI",
            Self::Other { word, .. } => word,
        }
    }
}

/// `SYNC/`: a mark at which channels wait for one another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyncMark {
    /// Number of the mark.
    pub number: u32,
    /// The channels that wait at it, counted from 1, the file's own first; empty where the file names none.
    pub channels: Vec<u32>,
}

impl fmt::Display for SyncMark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "mark {}", self.number)?;
        for (index, channel) in self.channels.iter().enumerate() {
            let between = if index == 0 { " of channels " } else { ", " };
            write!(formatter, "{between}{channel}")?;
        }
        Ok(())
    }
}

/// One item after the slash.
#[derive(Clone, Debug, PartialEq)]
pub enum Argument {
    /// A number.
    Number(f64),
    /// A word, or any text that is no number, as written.
    Word(String),
}

/// `GODLTA/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Delta {
    /// A step in the part frame.
    Step([f64; 3]),
    /// A step along the tool axis.
    AlongAxis(f64),
}

/// `FEDRAT/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedRate {
    /// The number; none in `FEDRAT/RAPID`.
    pub value: Option<f64>,
    /// The unit word, before or after it.
    pub unit: Option<FeedUnit>,
}

/// Unit words of a feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedUnit {
    /// `MMPM`.
    MillimetresPerMinute,
    /// `IPM`.
    InchesPerMinute,
    /// `PERMIN`, `FPM`: the file's unit of length a minute.
    PerMinute,
    /// `MMPR`.
    MillimetresPerRevolution,
    /// `IPR`.
    InchesPerRevolution,
    /// `PERREV`, `FPR`.
    PerRevolution,
    /// `INVERS`, `INVERSE`, `FRN`: 1/min.
    InverseTime,
    /// `RAPID` as a feed.
    Rapid,
}

/// `SPINDL/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpindleWord {
    /// The spindle turns; a value that is not given stays as it was.
    On {
        /// The speed.
        speed: Option<f64>,
        /// Unit of the speed, `RPM` if no word is given.
        unit: SpindleUnit,
        /// Sense of turning, seen from the spindle to the part.
        sense: Option<Sense>,
        /// The speed that it must not exceed at a surface speed (`MAXRPM,n`), revolutions a minute.
        most: Option<f64>,
    },
    /// `SPINDL/OFF`.
    Off,
    /// `SPINDL/LOCK`, `SPINDL/ORIENT`.
    Orient,
}

/// Unit words of a spindle speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleUnit {
    /// Revolutions a minute.
    Rpm,
    /// Metres a minute (`SMM`).
    SurfaceMetric,
    /// Feet a minute (`SFM`).
    SurfaceInch,
}

/// `CLW` or `CCLW`, `CLOCKWISE` or `COUNTERCLOCKWISE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Clockwise.
    Clockwise,
    /// Counter-clockwise.
    CounterClockwise,
}

/// `COOLNT/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoolantWord {
    /// `OFF`.
    Off,
    /// `ON`: the last kind again.
    On,
    /// `FLOOD`.
    Flood,
    /// `MIST`.
    Mist,
    /// `THRU`, `THROUGH`: through the tool.
    Through,
    /// `AIR`.
    Air,
}

/// `LOADTL/n[,…]`, `LOAD/TOOL,n[,…]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadTool {
    /// Tool number.
    pub number: u32,
    /// Register of the length compensation (`ADJUST,n`, `OSETNO,n`, `OFSTNO,n`).
    pub register: Option<u32>,
    /// Length from the gauge line (`LENGTH,l`), in the file's units.
    pub length: Option<f64>,
    /// Whether the word is `TOOLNO`, which in CATIA's files describes a tool that `LOADTL` loads.
    pub described: bool,
    /// Any further words, as written.
    pub rest: Vec<Argument>,
}

impl LoadTool {
    /// Offset register (0: none) and length of the tool's body, as `LOADTL/number,0,length,register` has them: the form
    /// of Autodesk's stock APT posts.
    pub fn of_autodesk(&self) -> Option<(u32, f64)> {
        match *self.rest.as_slice() {
            [Argument::Number(0.0), Argument::Number(length), Argument::Number(register)] => {
                Some((whole(register)?, length))
            }
            _ => None,
        }
    }

    /// Registers of radius and length, as `LOADTL/number,radius,length` has them: the form of CATIA.
    pub fn of_catia(&self) -> Option<[u32; 2]> {
        match *self.rest.as_slice() {
            [Argument::Number(radius), Argument::Number(length)] => {
                Some([whole(radius)?, whole(length)?])
            }
            _ => None,
        }
    }
}

/// The number, if it is a whole one from 0 up.
fn whole(value: f64) -> Option<u32> {
    let whole = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
    whole.then_some(value as u32)
}

/// `UNITS/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// `MM`.
    Millimetre,
    /// `INCH`, `INCHES`, `IN`.
    Inch,
    /// `CM`.
    Centimetre,
    /// `M`.
    Metre,
    /// `FEET`, `FT`.
    Foot,
}

impl Units {
    /// mm in one of them.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Inch => 25.4,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Foot => 304.8,
        }
    }
}

/// `CIRCLE/`: centre and axis; it ends at the next `GOTO`.
#[derive(Clone, Debug, PartialEq)]
pub struct CircleRecord {
    /// The centre.
    pub centre: Point,
    /// The axis. Without a sense the arc is counter-clockwise (right-handed) about it.
    pub axis: Direction,
    /// The radius, if given.
    pub radius: Option<f64>,
    /// Sense of turning about the axis: a word (CAMWorks), or clockwise in the form of eleven numbers, since
    /// NX points the axis of its arcs so that they go clockwise about it (its documentation of the CLSF's CIRCLE;
    /// all arcs of the collected files meet their neighbours tangentially that way, and none the other).
    pub sense: Option<Sense>,
    /// `TIMES,n`: whole turns in all.
    pub turns: Option<u32>,
}

/// `MOVARC/cx,cy,cz,i,j,k,r,ANGLE,degrees`: an arc that ends at the next `GOTO`. Whether the axis tells which way it
/// goes depends on who wrote it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcMove {
    /// The centre.
    pub centre: Point,
    /// The axis.
    pub axis: Direction,
    /// The radius.
    pub radius: f64,
    /// Angle from start to end, degrees, above zero.
    pub degrees: f64,
}

/// `TLON,GOFWD/ (CIRCLE/…),ON,(LINE/…)` and `TLON,GOFWD/ (CYLNDR/…),ON,(PLANE/…)`: an arc from where the tool stands,
/// set out on as `INDIRV` says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlongArc {
    /// The centre, or a point of the cylinder's axis.
    pub centre: Point,
    /// The axis of the cylinder; none of a circle, which lies in a plane of X and Y.
    pub axis: Option<Direction>,
    /// The radius.
    pub radius: f64,
    /// End of the arc.
    pub end: Point,
}

/// `CYCLE/`.
#[derive(Clone, Debug, PartialEq)]
pub enum Cycle {
    /// `OFF`, `NOMORE`.
    Off,
    /// `ON`: the last definition again; `INIT`.
    On,
    /// A definition; it acts at every point that follows.
    Define(Box<CycleDefinition>),
}

/// A cycle's definition. Lengths in the file's units, along the tool axis from the programmed point,
/// all as written (NX writes depths below the point negative, others positive).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CycleDefinition {
    /// `DRILL`, `DEEP`, `BRKCHP`, `TAP`, `BORE`, `REAM`, `FACE`, `CSINK`, …, in capitals, in the order written
    /// (`DRILL,DEEP` gives both).
    pub kinds: Vec<String>,
    /// Depth (`FEDTO`, `DEPTH`, CAMWorks' first number).
    pub depth: Option<f64>,
    /// Clearance above the point where the feed begins (`RAPTO`, `CLEAR`).
    pub clearance: Option<f64>,
    /// Return level above the point (`RTRCTO`, `RETURN`, CAMWorks' G98 level).
    pub retract: Option<f64>,
    /// Feed.
    pub feed: Option<FeedRate>,
    /// Dwell at the bottom, s.
    pub dwell: Option<f64>,
    /// Peck (`STEP`, `PECKING`, `1STPECK`, `INCR`).
    pub step: Option<f64>,
    /// The pecks that follow the first, if they are others (`SUBPECK`, a second number).
    pub later_step: Option<f64>,
    /// A thread's way a turn, in the file's units; negative for a left-hand thread (`PITCH`).
    pub pitch: Option<f64>,
    /// A thread's turns an inch (`TPI`).
    pub turns_per_inch: Option<f64>,
    /// Depth to add, out on the other side of the part (a number after the option `THRU`).
    pub break_through: Option<f64>,
    /// Diameter of a countersink at the point's height, in place of a depth (`DIAMET`).
    pub diameter: Option<f64>,
    /// Angle between the cutter's sides, degrees (`ANGLE`, `TLANGL`).
    pub angle: Option<f64>,
    /// A fine boring tool's way off the wall before it goes out (a number after `NODRAG`, `ORIENT`).
    pub shift: Option<f64>,
    /// Numbers without a word before them, in the order written: those of fields too.
    pub bare: Vec<f64>,
    /// How many of them stand before the feed's unit.
    pub bare_before_feed: usize,
    /// What `RAPTO` or `CLEAR` says: `clearance` may be a number without a word.
    pub rapid_to: Option<f64>,
    /// Words and numbers that have no field.
    pub rest: Vec<Argument>,
}

/// `CUTCOM/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutcom {
    /// Side of the contour; `None` with `CUTCOM/ON`, which repeats the last.
    pub side: Option<CutterSide>,
    /// `XYPLAN`, `YZPLAN`, `ZXPLAN`: index of the normal (2, 0, 1).
    pub plane: Option<u8>,
    /// Register, if given.
    pub register: Option<u32>,
}

/// Side of the cutter, looking along the feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CutterSide {
    /// Off.
    Off,
    /// Left of the contour.
    Left,
    /// Right of the contour.
    Right,
}

/// An index move.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotate {
    /// `A`, `B`, `C` from `AAXIS` …, if named.
    pub axis: Option<char>,
    /// The angle as written.
    pub angle: f64,
    /// Whether the angle is in radians: CAMWorks (number first, then `AAXIS,TABLE`) writes those.
    pub radians: bool,
    /// A step from the present angle (`INCR`). CAMWorks' form is no step: it states the angle at the start of every
    /// operation, and turns back only after some.
    pub incremental: bool,
    /// Sense word, if given.
    pub sense: Option<Sense>,
}

/// `DELAY/`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Delay {
    /// Seconds.
    Seconds(f64),
    /// Revolutions of the spindle.
    Revolutions(f64),
}
