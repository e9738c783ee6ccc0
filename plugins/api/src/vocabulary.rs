//! The words of a control and what they mean, so that its programs can be read back.

use std::borrow::Cow;

use crate::field::{Codes, codes};

/// A word, or several that stand together, and what it means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VocabularyWord {
    /// The word as the control reads it, without the number that goes with it: `G43.4`, `TRAORI`, `CYCL DEF 32`, `F`. A
    /// name stands without `=` and parentheses, `CYCLE800()` says that nothing stands between them; `G4 P` is P beside
    /// G4, and `G84 ,R` is `,R` beside G84.
    pub word: Cow<'static, str>,
    /// What it means.
    pub meaning: Meaning,
}

impl VocabularyWord {
    /// A word for the table of a dialect: `VocabularyWord::new("G0", Meaning::Rapid)`.
    pub const fn new(word: &'static str, meaning: Meaning) -> Self {
        VocabularyWord { word: Cow::Borrowed(word), meaning }
    }

    /// The names with which `lines` of a robot's program begin, which all mean this.
    pub fn first_of(lines: &str, meaning: Meaning) -> impl Iterator<Item = Self> {
        let of_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let names = lines.lines().map(move |line| {
            line.trim().split(|letter| !of_name(letter)).next().unwrap_or_default().to_owned()
        });
        let names = names.filter(|name| !name.is_empty());
        names.map(move |name| VocabularyWord { word: Cow::Owned(name), meaning })
    }
}

impl Meaning {
    /// Number of the meaning in the contract.
    pub const fn number(self) -> u32 {
        self.code()
    }

    /// The meaning of this number; none if this version does not know it.
    pub const fn from_number(number: u32) -> Option<Self> {
        Meaning::of(number)
    }

    /// Name in C, after `POST_MEANING_`.
    pub fn name(self) -> &'static str {
        let mut codes = Meaning::CODES.codes.iter();
        let own = codes.find(|(_, code)| *code == self.code());
        own.map_or("", |(name, _)| name)
    }
}

/// What the words of axes of a block are to a code that stands in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisWords {
    /// They say where the motion of the block leads, whatever the code does.
    Lead,
    /// They are the code's own.
    Own,
    /// They do not belong there.
    None,
}

impl Meaning {
    /// What words of axes are to a code of this meaning, where its dialect says nothing else of it
    /// ([`Meaning::OwnAxisWords`], [`Meaning::NoAxisWords`]).
    pub const fn axis_words(self) -> AxisWords {
        match self {
            Meaning::OwnAxisWords
            | Meaning::ReferenceReturn
            | Meaning::OtherReferenceReturn
            | Meaning::LocalOffset
            | Meaning::LocalOffsetAdded
            | Meaning::SetPosition
            | Meaning::SetPositionOff
            | Meaning::TableData
            | Meaning::Rotation
            | Meaning::RotationAdded
            | Meaning::Scale
            | Meaning::Mirror
            | Meaning::TiltedPlane
            | Meaning::Macro
            | Meaning::MacroModal => AxisWords::Own,
            Meaning::NoAxisWords
            | Meaning::ScaleOff
            | Meaning::MirrorOff
            | Meaning::FaceTransformationOff
            | Meaning::MacroOff
            | Meaning::TableDataOff => AxisWords::None,
            _ => AxisWords::Lead,
        }
    }
}

codes! {
    /// What a word of a program means.
    Meaning "MEANING" {
        /// Begins a remark that ends with the line: `;`.
        Remark = 1 "REMARK",
        /// Begins a remark that another word ends: `(`.
        RemarkOpen = 2 "REMARK_OPEN",
        /// Ends a remark: `)`.
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
        /// Centre of an arc along Y: J.
        CentreY = 25 "CENTRE_Y",
        /// Centre of an arc along Z: K.
        CentreZ = 26 "CENTRE_Z",
        /// Radius of an arc: R, CR.
        Radius = 27 "RADIUS",
        /// A spline: G6.2, BSPLINE.
        Spline = 28 "SPLINE",
        /// The positions of this block are machine coordinates: G53, SUPA, M91.
        MachineCoordinates = 29 "MACHINE_COORDINATES",
        /// The feed's address: F.
        Feed = 30 "FEED",
        /// Feed a minute: G94.
        FeedPerMinute = 31 "FEED_PER_MINUTE",
        /// Inverse time: G93.
        InverseTime = 32 "INVERSE_TIME",
        /// Feed a revolution: G95.
        FeedPerRevolution = 33 "FEED_PER_REVOLUTION",
        /// This block goes at rapid: FMAX.
        RapidBlock = 34 "RAPID_BLOCK",
        /// Length compensation on: G43.
        LengthOn = 40 "LENGTH_ON",
        /// Length compensation off: G49.
        LengthOff = 41 "LENGTH_OFF",
        /// Register of the length: H. As a letter D it puts the length in force by itself, and D0 takes it off.
        LengthRegister = 42 "LENGTH_REGISTER",
        /// Radius compensation off: G40.
        CompensationOff = 43 "COMPENSATION_OFF",
        /// Compensation to the left: G41.
        CompensationLeft = 44 "COMPENSATION_LEFT",
        /// Compensation to the right: G42.
        CompensationRight = 45 "COMPENSATION_RIGHT",
        /// Register of the radius: D.
        RadiusRegister = 46 "RADIUS_REGISTER",
        /// Tool centre point control on: G43.4, TRAORI, M128.
        TcpOn = 47 "TCP_ON",
        /// Tool centre point control off: TRAFOOF, M129.
        TcpOff = 48 "TCP_OFF",
        /// A tilted plane: G68.2, CYCLE800, PLANE SPATIAL.
        TiltedPlane = 50 "TILTED_PLANE",
        /// The axes turn to the tilted plane: G53.1.
        TiltedPlaneTurn = 51 "TILTED_PLANE_TURN",
        /// End of the tilted plane: G69, PLANE RESET.
        TiltedPlaneOff = 52 "TILTED_PLANE_OFF",
        /// A work offset: G54.
        WorkOffset = 53 "WORK_OFFSET",
        /// The control may leave the path: G64, CYCLE832, G187.
        Smoothing = 54 "SMOOTHING",
        /// End of smoothing: G61.
        SmoothingOff = 55 "SMOOTHING_OFF",
        /// The tool's number: T.
        Tool = 60 "TOOL",
        /// Change of the tool: M6.
        ToolChange = 61 "TOOL_CHANGE",
        /// The spindle's speed: S.
        SpindleSpeed = 62 "SPINDLE_SPEED",
        /// Spindle clockwise: M3.
        SpindleClockwise = 63 "SPINDLE_CLOCKWISE",
        /// Spindle counter-clockwise: M4.
        SpindleCounterClockwise = 64 "SPINDLE_COUNTER_CLOCKWISE",
        /// Spindle off: M5.
        SpindleOff = 65 "SPINDLE_OFF",
        /// Spindle oriented: M19.
        SpindleOrient = 66 "SPINDLE_ORIENT",
        /// Coolant of any kind on: M7, M8.
        CoolantOn = 67 "COOLANT_ON",
        /// Coolant off: M9.
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
        /// Drilling in steps, out of the hole after each: G83.
        CycleDeep = 81 "CYCLE_DEEP",
        /// Drilling in steps, drawn back a little: G73.
        CycleBreakChip = 82 "CYCLE_BREAK_CHIP",
        /// A thread: G84.
        CycleTap = 83 "CYCLE_TAP",
        /// A left-hand thread: G74.
        CycleTapLeft = 84 "CYCLE_TAP_LEFT",
        /// Boring, out at feed: G85, G89.
        CycleReam = 85 "CYCLE_REAM",
        /// Boring, out at rapid, the spindle stopped: G86.
        CycleBore = 86 "CYCLE_BORE",
        /// Boring, out at rapid, drawn off the wall: G76.
        CycleBoreFine = 87 "CYCLE_BORE_FINE",
        /// Boring from below: G87.
        CycleBoreBack = 88 "CYCLE_BORE_BACK",
        /// No cycle any more: G80.
        CycleOff = 89 "CYCLE_OFF",
        /// A cycle returns to the level where it began: G98.
        ReturnStart = 90 "RETURN_START",
        /// No cycle any more, and the spindle stands: G80 of Okuma. There a rapid ends a cycle too.
        CycleOffSpindleOff = 218 "CYCLE_OFF_SPINDLE_OFF",
        /// A cycle returns to where the feed begins: G99.
        ReturnClearance = 91 "RETURN_CLEARANCE",
        /// A way to the reference position, over the point that the block names: G28.
        ReferenceReturn = 100 "REFERENCE_RETURN",
        /// A way to another position that the control keeps: G30, G75.
        OtherReferenceReturn = 101 "OTHER_REFERENCE_RETURN",
        /// A way from the part along the tool axis: M140.
        Retract = 102 "RETRACT",
        /// The positions of this block count from a point that the builder has set: M92.
        BuilderCoordinates = 103 "BUILDER_COORDINATES",
        /// The axes come to rest at the end of this block: G9.
        ExactStop = 104 "EXACT_STOP",
        /// A cut tied to the spindle: G33, G331.
        Thread = 105 "THREAD",
        /// A thread tied to the spindle, in and out again in one block: G33.1.
        ThreadAndBack = 106 "THREAD_AND_BACK",
        /// Out of a thread, the spindle turning back: G332.
        ThreadBack = 107 "THREAD_BACK",
        /// The program's zero is shifted by what the block names, from the work offset: G52, TRANS, CYCL DEF 7.
        LocalOffset = 110 "LOCAL_OFFSET",
        /// The program's zero is shifted from where it is now: ATRANS.
        LocalOffsetAdded = 111 "LOCAL_OFFSET_ADDED",
        /// The program's zero is shifted no more: TRANS DATUM RESET.
        LocalOffsetOff = 112 "LOCAL_OFFSET_OFF",
        /// Where the tool stands is called what the block names: G92.
        SetPosition = 113 "SET_POSITION",
        /// Positions count again as before that: G92.1, G92.2.
        SetPositionOff = 114 "SET_POSITION_OFF",
        /// Positions count once more as `SetPosition` said: G92.3.
        SetPositionAgain = 115 "SET_POSITION_AGAIN",
        /// No work offset: G500.
        WorkOffsetOff = 116 "WORK_OFFSET_OFF",
        /// A work offset for this block: G16 of Okuma.
        WorkOffsetBlock = 117 "WORK_OFFSET_BLOCK",
        /// The words of the block go to a table of the control, nothing moves: G10.
        TableData = 118 "TABLE_DATA",
        /// Words go to the table no more: G11.
        TableDataOff = 119 "TABLE_DATA_OFF",
        /// Coordinates are turned: G68, ROT, CYCL DEF 10.
        Rotation = 120 "ROTATION",
        /// Coordinates are turned from how they are turned now: AROT.
        RotationAdded = 121 "ROTATION_ADDED",
        /// Coordinates are turned no more: G69 where nothing else is meant by it.
        RotationOff = 122 "ROTATION_OFF",
        /// Coordinates are multiplied: G51, SCALE, CYCL DEF 11.
        Scale = 123 "SCALE",
        /// Coordinates are multiplied no more: G50.
        ScaleOff = 124 "SCALE_OFF",
        /// Coordinates are mirrored: G51.1, MIRROR, CYCL DEF 8.
        Mirror = 125 "MIRROR",
        /// Coordinates are mirrored no more: G50.1.
        MirrorOff = 126 "MIRROR_OFF",
        /// Positions are a radius and an angle: G16.
        Polar = 130 "POLAR",
        /// Positions are polar no more: G15.
        PolarOff = 131 "POLAR_OFF",
        /// A rotary axis replaces a linear one on an end face: G12.1, TRANSMIT.
        FaceTransformation = 132 "FACE_TRANSFORMATION",
        /// The rotary axis is itself again: G13.1.
        FaceTransformationOff = 133 "FACE_TRANSFORMATION_OFF",
        /// A rotary axis replaces a linear one on a cylinder: G7.1, TRACYL.
        CylinderTransformation = 134 "CYLINDER_TRANSFORMATION",
        /// Centres of arcs are positions: G90.1.
        CentreAbsolute = 135 "CENTRE_ABSOLUTE",
        /// Centres of arcs count from the start of the arc: G91.1.
        CentreIncremental = 136 "CENTRE_INCREMENTAL",
        /// X is a diameter: G7 of LinuxCNC, DIAMON.
        Diameter = 137 "DIAMETER",
        /// X is a radius: G8 of LinuxCNC, DIAMOF.
        DiameterOff = 138 "DIAMETER_OFF",
        /// Rotary axes go the shorter way: M126.
        RotaryShortest = 139 "ROTARY_SHORTEST",
        /// Rotary axes go to the number that is written: M127.
        RotaryAsWritten = 140 "ROTARY_AS_WRITTEN",
        /// Tool centre point control, the tool axis a vector in the block: G43.5.
        TcpVectorOn = 141 "TCP_VECTOR_ON",
        /// Length compensation along the tool axis however it leans: G43.1 of Fanuc.
        LengthAlongTool = 142 "LENGTH_ALONG_TOOL",
        /// Length compensation by the lengths that the block names: G43.1 of LinuxCNC and GRBL.
        LengthStated = 143 "LENGTH_STATED",
        /// One more length is compensated: G43.2.
        LengthAdded = 144 "LENGTH_ADDED",
        /// Length compensation to the other side: G44.
        LengthNegative = 145 "LENGTH_NEGATIVE",
        /// The tool axis along X, from the tip to the spindle: A3, TX.
        ToolAxisX = 146 "TOOL_AXIS_X",
        /// The tool axis along Y: B3, TY.
        ToolAxisY = 147 "TOOL_AXIS_Y",
        /// The tool axis along Z: C3, TZ.
        ToolAxisZ = 148 "TOOL_AXIS_Z",
        /// The normal of the surface along X: NX.
        NormalX = 149 "NORMAL_X",
        /// The normal of the surface along Y: NY.
        NormalY = 150 "NORMAL_Y",
        /// The normal of the surface along Z: NZ.
        NormalZ = 151 "NORMAL_Z",
        /// The tool axis is interpolated against the part: ORIWKS.
        OrientationPart = 152 "ORIENTATION_PART",
        /// The tool axis is interpolated against the machine: ORIMKS.
        OrientationMachine = 153 "ORIENTATION_MACHINE",
        /// The tool axis goes by the rotary axes, linearly: ORIAXES.
        OrientationAxes = 154 "ORIENTATION_AXES",
        /// The tool axis goes on the great circle: ORIVECT.
        OrientationVector = 155 "ORIENTATION_VECTOR",
        /// How angles of the tool axis are read: ORIEULER, ORIRPY.
        OrientationAngles = 156 "ORIENTATION_ANGLES",
        /// The tool that comes next is made ready: TOOL DEF.
        Preselect = 160 "PRESELECT",
        /// The spindle clockwise and coolant: M13.
        SpindleClockwiseCoolant = 161 "SPINDLE_CLOCKWISE_COOLANT",
        /// The spindle counter-clockwise and coolant: M14.
        SpindleCounterClockwiseCoolant = 162 "SPINDLE_COUNTER_CLOCKWISE_COOLANT",
        /// The spindle's word is a speed of the surface: G96.
        SurfaceSpeed = 163 "SURFACE_SPEED",
        /// The spindle's word is revolutions a minute: G97.
        SurfaceSpeedOff = 164 "SURFACE_SPEED_OFF",
        /// The spindle turns no faster: LIMS.
        SpeedLimit = 165 "SPEED_LIMIT",
        /// A rotary axis is clamped: M10.
        Clamp = 166 "CLAMP",
        /// A rotary axis is loosened: M11.
        Unclamp = 167 "UNCLAMP",
        /// The spindle's word is a speed of the surface, and the feed is one a revolution: G96 of Siemens.
        SurfaceSpeedPerRevolution = 203 "SURFACE_SPEED_PER_REVOLUTION",
        /// The spindle's word is a speed of the surface, and the feed is one a minute: G961.
        SurfaceSpeedPerMinute = 204 "SURFACE_SPEED_PER_MINUTE",
        /// The spindle's word is revolutions a minute, and the feed is one a revolution: G97 of Siemens.
        FixedSpeedPerRevolution = 205 "FIXED_SPEED_PER_REVOLUTION",
        /// The spindle's word is revolutions a minute, and the feed is one a minute: G971.
        FixedSpeedPerMinute = 206 "FIXED_SPEED_PER_MINUTE",
        /// The tool and the number of its offsets, which are the last two digits and come into force, 00 for none: T0101 of
        /// Fanuc's lathes.
        ToolAndOffset = 207 "TOOL_AND_OFFSET",
        /// It is not followed what the control does then: the program is refused there.
        NotFollowed = 208 "NOT_FOLLOWED",
        /// A subprogram ends: M99, M17, RTS.
        SubprogramEnd = 170 "SUBPROGRAM_END",
        /// A subprogram within this program is called by the number of its block: M97.
        LocalSubprogram = 171 "LOCAL_SUBPROGRAM",
        /// A macro is called with arguments: G65.
        Macro = 172 "MACRO",
        /// A macro is called after each motion from here on: G66.
        MacroModal = 173 "MACRO_MODAL",
        /// A macro is called no more: G67.
        MacroOff = 174 "MACRO_OFF",
        /// The cycle that was defined works here: CYCL CALL, M99 of Heidenhain.
        CycleCall = 175 "CYCLE_CALL",
        /// The cycle works at the end of each motion from here on too: M89, MCALL.
        CycleCallModal = 176 "CYCLE_CALL_MODAL",
        /// A cycle that moves in a way of its own: pockets, patterns, G12 of Haas.
        CycleOther = 177 "CYCLE_OTHER",
        /// A cycle returns to a level that the program names: G71 and M53 of Okuma.
        ReturnLevel = 178 "RETURN_LEVEL",
        /// The time of a wait in seconds: G4 F.
        DwellSeconds = 180 "DWELL_SECONDS",
        /// The time of a wait in milliseconds if written without a decimal point, else in seconds: G4 P of Fanuc.
        DwellMilliseconds = 181 "DWELL_MILLISECONDS",
        /// The time of a wait in turns of the spindle: G4 S.
        DwellTurns = 182 "DWELL_TURNS",
        /// An arc through a point: CIP.
        ArcThrough = 183 "ARC_THROUGH",
        /// An arc that goes on as the path before it: CT.
        ArcTangent = 184 "ARC_TANGENT",
        /// Turns of a helix: TURN.
        Turns = 185 "TURNS",
        /// The angle that an arc turns through: AR.
        ArcAngle = 186 "ARC_ANGLE",
        /// Feeds of rotary axes are lengths: M116.
        RotaryFeedLength = 187 "ROTARY_FEED_LENGTH",
        /// Feeds of rotary axes are angles: M117.
        RotaryFeedAngle = 188 "ROTARY_FEED_ANGLE",
        /// Lengths in inches, feeds as before: G70 of Siemens.
        InchLengths = 189 "INCH_LENGTHS",
        /// Lengths in millimetres, feeds as before: G71 of Siemens.
        MillimetreLengths = 190 "MILLIMETRE_LENGTHS",
        /// The centre of the arcs that follow, or the pole of polar positions: CC.
        Centre = 191 "CENTRE",
        /// An arc whose direction another word gives: C, CR, CP.
        Arc = 192 "ARC",
        /// Feed a minute that counts along all axes together where no tip is kept: G94 of Fanuc.
        FeedPerMinuteAllAxes = 193 "FEED_PER_MINUTE_ALL_AXES",
        /// Positions are machine coordinates from here on: `#MCS ON`.
        MachineCoordinatesOn = 194 "MACHINE_COORDINATES_ON",
        /// Positions are machine coordinates no more: `#MCS OFF`.
        MachineCoordinatesOff = 195 "MACHINE_COORDINATES_OFF",
        /// The joints of an arm go evenly to positions: MoveAbsJ, PTP, movej.
        JointMove = 200 "JOINT_MOVE",
        /// The tool of an arm goes to a pose otherwise than straight, which is not followed: MoveJ, MoveC, CIRC, movep.
        PoseMove = 201 "POSE_MOVE",
        /// Where the joints of an arm stand: CJointT().
        JointsNow = 202 "JOINTS_NOW",
        /// The tool of an arm is led straight to a pose, turning evenly about one direction: MoveL, LIN, movel.
        StraightMove = 209 "STRAIGHT_MOVE",
        /// X is a diameter where it is a position, and a radius where it is a way: DIAM90.
        DiameterOfPositions = 210 "DIAMETER_OF_POSITIONS",
        /// The frame of a tool that an arm's straight moves lead from here on: `$TOOL`, set_tcp.
        ToolFrame = 211 "TOOL_FRAME",
        /// The frame of the tool that the machine file stands for: `TOOL_DATA[1]`, a tooldata's name. That of its poses is
        /// [`Meaning::WorkOffsetOff`].
        OwnToolFrame = 212 "OWN_TOOL_FRAME",
        /// Tool and frame of an arm by numbers or from the control's defaults: BAS.
        ToolAndFrame = 213 "TOOL_AND_FRAME",
        /// The words of axes beside the word are its own, and nothing moves: G22, which guards an area, G50.1. It stands
        /// behind what the word means otherwise.
        OwnAxisWords = 214 "OWN_AXIS_WORDS",
        /// The word stands in a block without words of axes: G23. It stands behind what the word means otherwise.
        NoAxisWords = 215 "NO_AXIS_WORDS",
        /// Words of the extruder are positions, not ways: M82 of printers.
        ExtruderPositions = 216 "EXTRUDER_POSITIONS",
        /// An arm goes straight in whatever configuration the way asks for: ConfL \Off.
        AnyConfiguration = 217 "ANY_CONFIGURATION",
    }
}
