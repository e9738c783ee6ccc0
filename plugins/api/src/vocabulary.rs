//! The words of a control and what they mean, so that its programs can be read back.

use std::borrow::Cow;

use crate::field::{Codes, codes};

/// A word, or several that stand together, and what it means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VocabularyWord {
    /// As the control reads it, without the number that goes with it: `G43.4`, `TRAORI`, `CYCL DEF 32.0`, `F`.
    pub word: Cow<'static, str>,
    /// What it means.
    pub meaning: Meaning,
}

impl VocabularyWord {
    /// One for the table of a dialect: `VocabularyWord::new("G0", Meaning::Rapid)`.
    pub const fn new(word: &'static str, meaning: Meaning) -> Self {
        VocabularyWord {
            word: Cow::Borrowed(word),
            meaning,
        }
    }
}

impl Meaning {
    /// Its number in the contract.
    pub const fn number(self) -> u32 {
        self.code()
    }

    /// The meaning of this number; none if this version does not know it.
    pub const fn from_number(number: u32) -> Option<Self> {
        Meaning::of(number)
    }

    /// Its name in C, behind `POST_MEANING_`.
    pub fn name(self) -> &'static str {
        let mut codes = Meaning::CODES.codes.iter();
        let own = codes.find(|(_, code)| *code == self.code());
        own.map_or("", |(name, _)| name)
    }
}

codes! {
    /// What a word of a program means.
    Meaning "MEANING" {
        /// Begins a remark that ends with the line: `;`.
        Remark = 1 "REMARK",
        /// Begins a remark that another word ends: `(`.
        RemarkOpen = 2 "REMARK_OPEN",
        /// Ends it: `)`.
        RemarkClose = 3 "REMARK_CLOSE",
        /// Stands before the number of a block: `N`.
        BlockNumber = 4 "BLOCK_NUMBER",
        /// Nothing that moves or changes what moves: `%`, `O`, a mode that is always on.
        Nothing = 5 "NOTHING",
        /// Lengths in millimetres: G21.
        Millimetre = 10 "MILLIMETRE",
        /// Lengths in inches: G20.
        Inch = 11 "INCH",
        /// Words are positions: G90.
        Absolute = 12 "ABSOLUTE",
        /// Words are ways: G91.
        Incremental = 13 "INCREMENTAL",
        /// Arcs in X and Y: G17.
        PlaneXy = 14 "PLANE_XY",
        /// Arcs in Z and X: G18.
        PlaneZx = 15 "PLANE_ZX",
        /// Arcs in Y and Z: G19.
        PlaneYz = 16 "PLANE_YZ",
        /// Rapid traverse: G0.
        Rapid = 20 "RAPID",
        /// A straight cut: G1.
        Linear = 21 "LINEAR",
        /// An arc clockwise: G2.
        ArcClockwise = 22 "ARC_CLOCKWISE",
        /// An arc counter-clockwise: G3.
        ArcCounterClockwise = 23 "ARC_COUNTER_CLOCKWISE",
        /// Centre of an arc, from its start, along X, Y, Z: I.
        CentreX = 24 "CENTRE_X",
        /// J.
        CentreY = 25 "CENTRE_Y",
        /// K.
        CentreZ = 26 "CENTRE_Z",
        /// Radius of an arc: R, CR.
        Radius = 27 "RADIUS",
        /// A spline: G6.2, BSPLINE.
        Spline = 28 "SPLINE",
        /// This block in machine coordinates: G53, SUPA, M91.
        MachineCoordinates = 29 "MACHINE_COORDINATES",
        /// The feed's address: F.
        Feed = 30 "FEED",
        /// Feed a minute: G94.
        FeedPerMinute = 31 "FEED_PER_MINUTE",
        /// Inverse time: G93.
        InverseTime = 32 "INVERSE_TIME",
        /// Feed a revolution: G95.
        FeedPerRevolution = 33 "FEED_PER_REVOLUTION",
        /// This block at rapid: FMAX.
        RapidBlock = 34 "RAPID_BLOCK",
        /// Length compensation on: G43.
        LengthOn = 40 "LENGTH_ON",
        /// And off: G49.
        LengthOff = 41 "LENGTH_OFF",
        /// Its register: H.
        LengthRegister = 42 "LENGTH_REGISTER",
        /// Radius compensation off: G40.
        CompensationOff = 43 "COMPENSATION_OFF",
        /// To the left: G41.
        CompensationLeft = 44 "COMPENSATION_LEFT",
        /// To the right: G42.
        CompensationRight = 45 "COMPENSATION_RIGHT",
        /// Its register: D.
        RadiusRegister = 46 "RADIUS_REGISTER",
        /// Tool centre point control on: G43.4, TRAORI, M128.
        TcpOn = 47 "TCP_ON",
        /// And off: TRAFOOF, M129.
        TcpOff = 48 "TCP_OFF",
        /// A tilted plane: G68.2, CYCLE800, PLANE SPATIAL.
        TiltedPlane = 50 "TILTED_PLANE",
        /// The axes turn to it: G53.1.
        TiltedPlaneTurn = 51 "TILTED_PLANE_TURN",
        /// It ends: G69, PLANE RESET.
        TiltedPlaneOff = 52 "TILTED_PLANE_OFF",
        /// A work offset: G54.
        WorkOffset = 53 "WORK_OFFSET",
        /// The control may leave the path: G64, CYCLE832, G187.
        Smoothing = 54 "SMOOTHING",
        /// It keeps it: G61.
        SmoothingOff = 55 "SMOOTHING_OFF",
        /// The tool's number: T.
        Tool = 60 "TOOL",
        /// It is changed: M6.
        ToolChange = 61 "TOOL_CHANGE",
        /// The spindle's speed: S.
        SpindleSpeed = 62 "SPINDLE_SPEED",
        /// Clockwise: M3.
        SpindleClockwise = 63 "SPINDLE_CLOCKWISE",
        /// Counter-clockwise: M4.
        SpindleCounterClockwise = 64 "SPINDLE_COUNTER_CLOCKWISE",
        /// Off: M5.
        SpindleOff = 65 "SPINDLE_OFF",
        /// Oriented: M19.
        SpindleOrient = 66 "SPINDLE_ORIENT",
        /// Coolant of any kind on: M7, M8.
        CoolantOn = 67 "COOLANT_ON",
        /// Off: M9.
        CoolantOff = 68 "COOLANT_OFF",
        /// A wait: G4.
        Dwell = 70 "DWELL",
        /// A stop: M0.
        Stop = 71 "STOP",
        /// An optional stop: M1.
        OptionalStop = 72 "OPTIONAL_STOP",
        /// The program's end: M30.
        End = 73 "END",
        /// A subprogram is called: M98.
        Subprogram = 74 "SUBPROGRAM",
        /// A probing move: G31, G38.2.
        Probe = 75 "PROBE",
        /// A drilling cycle in one go, with or without a dwell: G81, G82.
        CycleDrill = 80 "CYCLE_DRILL",
        /// In steps, out of the hole after each: G83.
        CycleDeep = 81 "CYCLE_DEEP",
        /// In steps, drawn back a little: G73.
        CycleBreakChip = 82 "CYCLE_BREAK_CHIP",
        /// A thread: G84.
        CycleTap = 83 "CYCLE_TAP",
        /// A left-hand thread: G74.
        CycleTapLeft = 84 "CYCLE_TAP_LEFT",
        /// Out at feed: G85, G89.
        CycleReam = 85 "CYCLE_REAM",
        /// Out at rapid, the spindle stopped: G86.
        CycleBore = 86 "CYCLE_BORE",
        /// Out at rapid, drawn off the wall: G76.
        CycleBoreFine = 87 "CYCLE_BORE_FINE",
        /// From below: G87.
        CycleBoreBack = 88 "CYCLE_BORE_BACK",
        /// No cycle any more: G80.
        CycleOff = 89 "CYCLE_OFF",
        /// A cycle returns to the level where it began: G98.
        ReturnStart = 90 "RETURN_START",
        /// A cycle returns to where the feed begins: G99.
        ReturnClearance = 91 "RETURN_CLEARANCE",
    }
}
