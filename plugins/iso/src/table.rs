//! What differs from control to control.

use post_plugin::{AxisNames, Cycle, Language, Meaning, OptionSpec, PlaneAngles, remark};

/// How a control of the family differs from the others. Begin with [`Table::ISO`] and say what is different.
///
/// Where a table names an option, the machine file's value holds if the dialect declares that option among its
/// `options`, else the table's own.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// The options of `[control.<name>]`; [`crate::options`] has those that the engine knows.
    pub options: &'static [OptionSpec],
    /// Names of axes that the control reads; a machine with others is refused.
    pub axes: AxisNames,
    /// The language of its programs: how expressions, loops and calls are written.
    pub language: Language,
    /// Usual ending of a program's file name.
    pub extension: &'static str,
    /// `%` before and after the program. Option `percent`.
    pub percent: bool,
    /// Letter and digits of the program's number, in front of its name: `O` and 4. Option `program_number`.
    pub title: Option<(&'static str, usize)>,
    /// A text as a remark of this control.
    pub remark: fn(&str) -> String,
    /// Most characters of a remark: a longer one becomes several, the program's name is cut.
    pub remark_length: usize,
    /// Most characters that the control reads in a line, where that is known: a longer one of the user's own is
    /// refused.
    pub line_length: Option<usize>,
    /// Words of motion, feed and compensation.
    pub codes: MotionCodes,
    /// The block behind that of the units: plane, compensation, cycles, way of counting and feed mode in a known state.
    /// It moves nothing, whatever was in force.
    pub safe: &'static str,
    /// What the program relies on among the control's parameters, one sentence each. Option `parameters` has them
    /// written as remarks.
    pub relies: &'static [&'static str],
    /// A block behind it that cancels what shifts, turns, scales or mirrors, and moves nothing; may be empty. Option
    /// `cancel`.
    pub cancel: &'static str,
    /// It stands behind the end of the length compensation, which comes with the first retract: ahead of that the
    /// control would refuse it.
    pub cancel_behind_length: bool,
    /// A feed a minute without tool centre point control counts along all axes together, degrees as millimetres; else
    /// along the linear ones.
    pub feed_all_axes: bool,
    /// G0 goes at F: each rapid has that of the option `travel_feed`, and the next cut its own again.
    pub rapids_at_feed: bool,
    /// A line is one command and its parameters: the word of motion stands in each that moves, and S behind that of the
    /// spindle.
    pub command_a_line: bool,
    /// The sign of the word of an endless rotary axis can be its way.
    pub sign_is_way: bool,
    /// Largest block number; past it they begin anew.
    pub largest_number: u32,
    /// Zeros at the end of axis words are left out. Option `trailing_zeros`.
    pub trim: bool,
    /// Decimals of a feed a revolution.
    pub per_revolution: u8,
    /// Work offsets.
    pub offset: Offset,
    /// Length compensation.
    pub length: Length,
    /// Tool centre point control.
    pub tcp: Tcp,
    /// Tool centre point control is switched on at rapid: ahead of a first move at feed its word stands behind one of
    /// rapid, in a block of its own.
    pub tcp_at_rapid: bool,
    /// In front of positions in machine coordinates, at rapid: `G53 G0`. A block of its own ahead of them where
    /// `machine_off` ends them: `#MCS ON`. Empty where the control has none: the user says how the tool leaves.
    pub machine: &'static str,
    /// A block behind positions in machine coordinates that ends them; empty where they hold for their block alone.
    pub machine_off: &'static str,
    /// The order in which the tool retracts and what is in force is cancelled.
    pub leave: &'static [Leave],
    /// What a stop of the program switches off, or may.
    pub stops: Stops,
    /// A wait.
    pub dwell: Dwell,
    /// Behind `T1`: the change of the tool. Option `change`.
    pub change: &'static str,
    /// Cycles that the control has.
    pub cycles: &'static [CycleCode],
    /// Addresses of the words of a cycle.
    pub cycle_addresses: CycleAddresses,
    /// Where a cycle returns to.
    pub cycle_return: CycleReturn,
    /// Cycles, and arcs, inside a tilted plane. Option `cycles_in_plane`.
    pub cycles_in_plane: bool,
    /// What makes tapping rigid. Option `tapping`.
    pub rigid: Rigid,
    /// Tilted planes.
    pub plane: Plane,
    /// Words in the place of the length's that have tool vectors (I J K) follow the tool centre point control in the
    /// place of rotary words; empty where the control has none. Option `tool_vector` asks for them.
    pub vector: &'static str,
    /// Splines. Option `splines` asks for them.
    pub splines: SplineForm,
    /// Levels of smoothing and its end. Options `smoothing`, `smoothing_off`.
    pub smoothing: [&'static str; 2],
    /// Smoothing may change while the length is in force.
    pub smoothing_anywhere: bool,
    /// Its tolerance is in mm in an inch program too.
    pub smoothing_in_mm: bool,
    /// Constant cutting speed.
    pub surface: Option<SurfaceSpeed>,
    /// Opens a remark that the control shows to the operator: `MSG, `; empty where it has none.
    pub message: &'static str,
    /// Units may change inside a program.
    pub units_inside: bool,
    /// A move until the probe touches; empty where the control has none.
    pub probe: &'static str,
    /// Calls of subprograms.
    pub subprogram: Subprogram,
    /// Spindle clockwise, counter-clockwise, off, oriented; empty where the control has none: a spindle that is to turn is
    /// refused.
    pub spindle: [&'static str; 4],
    /// M codes of coolant off, flood, mist, through the tool, air; empty where they are the machine builder's.
    /// Options `coolant_off`, `coolant_flood`, `coolant_mist`, `coolant_through`, `coolant_air`; `coolant_mist_off`,
    /// `coolant_through_off`, `coolant_air_off` where a kind has an end of its own.
    pub coolant: [&'static str; 5],
    /// Ends the program; empty where it ends with the file.
    pub end: &'static str,
    /// It has coordinates of its own on faces or mantles (polar or cylinder interpolation), which a machine file may name.
    pub interpolates: bool,
    /// Words of the control that programs of others hold, or that mean something else than the engine would say, in
    /// groups: [`crate::words`] has those that several controls share. A program is read back by them.
    pub words: &'static [&'static [(&'static str, Meaning)]],
}

/// Words of motion, feed and compensation.
#[derive(Clone, Copy, Debug)]
pub struct MotionCodes {
    /// mm, inch.
    pub units: [&'static str; 2],
    /// Rapid, cut.
    pub motion: [&'static str; 2],
    /// Arcs clockwise and counter-clockwise; empty where the control has none.
    pub arc: [&'static str; 2],
    /// Planes of X and Y, Z and X, Y and Z.
    pub planes: [&'static str; 3],
    /// Feed a minute, inverse time, feed a revolution; empty where the control has none. Without a word the feed a minute is
    /// the only one.
    pub feed: [&'static str; 3],
    /// Compensation off, left, right; the last two empty where the control has none.
    pub compensation: [&'static str; 3],
    /// Address of the compensation's register; empty where the control knows the radius by itself.
    pub radius: &'static str,
    /// Unconditional and optional stop; empty where the control has none.
    pub stop: [&'static str; 2],
}

/// Work offsets. Option `work_offset`.
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Is it one of the control's?
    pub known: fn(&str) -> bool,
    /// Offsets that the control has, for a message.
    pub range: &'static str,
    /// The words of the n-th, from 1; none if the control has no such offset.
    pub word: fn(u32) -> Option<String>,
    /// Whether the offset stands in the first block; else in one of its own before the first position after a tool
    /// change.
    pub at_start: bool,
}

/// Length compensation.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// Puts it in force; empty where the control does that by itself.
    pub on: &'static str,
    /// Address of its register; empty where the number stands behind the word that puts it in force: `D1`.
    pub register: &'static str,
    /// The control knows the length without a register. Option `length_register` gives one to a program that loads
    /// no tool.
    pub by_itself: bool,
    /// It goes along the axis across the plane in force, along Y behind G18: arcs stand in G17 alone, unless the option
    /// `arcs_off_xy` says that it stays where it is.
    pub across_plane: bool,
    /// Cancels it.
    pub off: &'static str,
}

/// Tool centre point control.
#[derive(Clone, Copy, Debug)]
pub enum Tcp {
    /// The control has none.
    None,
    /// A word in the place of [`Length::on`], cancelled as that is: `G43.4`.
    Length(&'static str),
    /// Blocks of its own, which move nothing. Options `tcp_on`, `tcp_off`.
    Blocks {
        /// Switches it on.
        on: &'static str,
        /// Switches it off.
        off: &'static str,
        /// The length comes in a block of its own before it; else with the last block of a first position.
        length_first: bool,
    },
}

/// A step of the way out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leave {
    /// The depth goes to its end in machine coordinates. Option `retract` is the whole block.
    Retract,
    /// The length compensation is cancelled.
    Length,
    /// The depth goes to its end again, where the length was cancelled before: a parameter decides whether that moves
    /// it.
    Again,
    /// The tool centre point control is switched off, where blocks of its own do that.
    Tcp,
}

/// What a stop of the program (M0, M1) switches off. It is switched on again before the next cut: where the control or
/// its builder has left it on, that does nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stops {
    /// The spindle.
    pub spindle: bool,
    /// The coolant.
    pub coolant: bool,
}

/// A wait: its address, and the unit of its number.
#[derive(Clone, Copy, Debug)]
pub enum Dwell {
    /// Whole milliseconds, at least one.
    Milliseconds(&'static str),
    /// Seconds with decimals.
    Seconds(&'static str, u8),
}

/// A cycle's code.
#[derive(Clone, Copy, Debug)]
pub struct CycleCode {
    /// Kind of the cycle.
    pub kind: Cycle,
    /// Code without a dwell at the bottom; empty where the control has none.
    pub plain: &'static str,
    /// Code with a dwell; empty where the control has none.
    pub waits: &'static str,
}

/// Addresses of the words of a cycle, which all have values of their own but where X and Y of the holes are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleAddresses {
    /// The level where the feed begins, absolute.
    pub clearance: &'static str,
    /// The bottom, absolute. The word of Z stands ahead of the other level.
    pub bottom: &'static str,
    /// A peck.
    pub step: &'static str,
    /// Words beside a peck: `J1`, out of the hole after each; empty where there are none.
    pub beside_step: &'static str,
    /// A wait at the bottom.
    pub dwell: &'static str,
}

/// Where a cycle returns to between its holes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleReturn {
    /// Where it began (G98), or where the feed begins (G99); G80 ends it.
    Codes,
    /// A level of its own. A rapid to it ends the cycle, since G80 stops the spindle.
    Level {
        /// In front of the level, in a block ahead of the cycle: `G71`.
        block: &'static str,
        /// Last word of the cycle's block: `M53`.
        word: &'static str,
    },
}

/// What makes tapping rigid: the spindle turns with the feed axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rigid {
    /// The cycle is, or the control's parameters say so.
    Always,
    /// A block with the speed ahead of the cycle: `M29 S500`.
    Ahead(&'static str),
    /// A block of its own ahead of the cycle, `M29`, and a wait in the cycle even where it is none.
    Alone(&'static str),
    /// A word in the block of the cycle: `,R1`.
    Beside(&'static str),
    /// Other codes than those of the cycle.
    Codes {
        /// Right-hand, left-hand.
        codes: [&'static str; 2],
        /// Address of the pitch in mm, in the place of F: `G77 I1.25`; empty: F says it.
        pitch: &'static str,
    },
    /// A move of its own down and up, with the pitch as K: `G33.1`.
    Move(&'static str),
}

/// Tilted planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// The control has none.
    None,
    /// Told by origin and Euler angles: X Y Z I J K.
    Euler {
        /// Word in front of the angles: `G68.2`.
        on: &'static str,
        /// The block after it that has the machine turn to it: `G53.1`.
        turn: &'static str,
        /// Block that ends the plane.
        off: &'static str,
    },
    /// Told by lines with origin and turns, while the control keeps the tip of a tool whose axes have been turned.
    Turns {
        /// Lines that begin the plane: `{x}` `{y}` `{z}` are its origin, `{first}` `{second}` `{third}` the turns in
        /// the order of `angles`, `{tcp_on}` what switches tool centre point control on.
        on: &'static str,
        /// Lines that end the plane; `{tcp_off}` is what switches tool centre point control off.
        off: &'static str,
        /// The axes of the turns.
        angles: PlaneAngles,
    },
    /// Where the rotary words have turned the part: the work offset turns with it. There is none where a head turns.
    Turned {
        /// Block that begins the plane: `G254`.
        on: &'static str,
        /// Block that ends the plane.
        off: &'static str,
    },
}

/// Splines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplineForm {
    /// The control has none.
    None,
    /// Control points with knots (K) and weights (R) up to degree 3, between two blocks of the control's own.
    Knots {
        /// The code: `G6.2`.
        code: &'static str,
        /// The block ahead.
        begin: &'static str,
        /// The block after.
        end: &'static str,
    },
    /// Control points in X and Y with weights (P); their knots are even.
    Even {
        /// The code: `G5.2`.
        code: &'static str,
        /// The block after.
        end: &'static str,
    },
}

/// Constant cutting speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceSpeed {
    /// Codes of a constant cutting speed, and of a fixed speed again: `G96`, `G97`.
    pub codes: [&'static str; 2],
    /// Where the codes are kinds of the feed too, of which one alone is in force: those above go with the feed a
    /// revolution, these with the feed a minute: `G961`, `G971`.
    pub per_minute: Option<[&'static str; 2]>,
    /// The largest speed: `G92 S` in a block ahead, or `D` in the same.
    pub most: &'static str,
}

/// Calls of subprograms: `{}` stands for number or name; empty where the control has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subprogram {
    /// Call by number: `M98 P{}`.
    pub number: &'static str,
    /// Call by name.
    pub name: &'static str,
    /// Address of how often, after the call: ` L`; empty: the call is written so often.
    pub times: &'static str,
}

/// G54 to G59 for 1 to 6.
pub fn offset_of_six(number: u32) -> Option<String> {
    (1..=6).contains(&number).then(|| format!("G{}", 53 + number))
}

/// G54 to G59, then `word` with 1 up to `most`: `G54.1 P1`.
pub fn offset_beyond_six(number: u32, word: &str, most: u32) -> Option<String> {
    let beyond = number.checked_sub(6).filter(|beyond| *beyond != 0);
    match beyond {
        None => offset_of_six(number),
        Some(beyond) => (beyond <= most).then(|| format!("{word}{beyond}")),
    }
}

/// Is it G54 to G59, or `word` with 1 to `most`?
pub fn is_offset_beyond_six(text: &str, word: &str, most: u32) -> bool {
    let beyond = text.strip_prefix(word).and_then(|digits| digits.parse().ok());
    match beyond {
        Some(beyond) => (1..=most).contains(&beyond),
        None => (Table::ISO.offset.known)(text),
    }
}

impl Length {
    /// The word that puts it in force names the register: `D1`.
    pub(crate) const fn is_register(&self) -> bool {
        !self.on.is_empty() && self.register.is_empty()
    }
}

impl Offset {
    /// G54 to G59, and G54.1 P1 to P300 behind them: Fanuc's additional work offsets.
    pub const ADDITIONAL: Offset = Offset {
        known: |text| is_offset_beyond_six(text, "G54.1 P", 300),
        range: "G54 to G59 or G54.1 P1 to P300",
        word: |number| offset_beyond_six(number, "G54.1 P", 300),
        ..Table::ISO.offset
    };
}

impl Subprogram {
    /// By number alone, how often behind it: `M98 P1000 L2`.
    pub const M98: Subprogram = Subprogram { number: "M98 P{}", name: "", times: " L" };
}

impl CycleCode {
    /// A cycle without and with a dwell.
    pub const fn new(kind: Cycle, plain: &'static str, waits: &'static str) -> Self {
        CycleCode { kind, plain, waits }
    }
}

/// Codes that most controls have. Fine boring and boring from below are written where the machine file gives their
/// shift.
pub const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", "G82"),
    CycleCode::new(Cycle::Deep, "G83", ""),
    CycleCode::new(Cycle::BreakChip, "G73", ""),
    CycleCode::new(Cycle::Tap, "G84", "G84"),
    CycleCode::new(Cycle::TapLeft, "G74", "G74"),
    CycleCode::new(Cycle::Ream, "G85", "G89"),
    CycleCode::new(Cycle::Bore, "G86", ""),
    CycleCode::new(Cycle::BoreFine, "G76", "G76"),
    CycleCode::new(Cycle::BoreBack, "G87", "G87"),
];

impl MotionCodes {
    /// Words that most controls have.
    pub const ISO: MotionCodes = MotionCodes {
        units: ["G21", "G20"],
        motion: ["G0", "G1"],
        arc: ["G2", "G3"],
        planes: ["G17", "G18", "G19"],
        feed: ["G94", "G93", "G95"],
        compensation: ["G40", "G41", "G42"],
        radius: "D",
        stop: ["M0", "M1"],
    };
}

impl Table {
    /// What most controls have in common: a beginning for a table of one's own.
    pub const ISO: Table = Table {
        options: &[],
        axes: AxisNames::ISO,
        language: Language::Macro,
        extension: "nc",
        percent: true,
        title: None,
        remark,
        // No manual gives a limit; a line of any control's screen is as long.
        remark_length: 80,
        line_length: None,
        codes: MotionCodes::ISO,
        safe: "G17 G40 G80 G90 G94",
        relies: &[],
        cancel: "",
        cancel_behind_length: false,
        feed_all_axes: false,
        rapids_at_feed: false,
        command_a_line: false,
        sign_is_way: false,
        largest_number: 99_999,
        trim: false,
        per_revolution: 4,
        offset: Offset {
            known: |text| matches!(text, "G54" | "G55" | "G56" | "G57" | "G58" | "G59"),
            range: "G54 to G59",
            word: |number| offset_of_six(number),
            at_start: false,
        },
        length: Length {
            on: "G43",
            register: "H",
            by_itself: false,
            across_plane: false,
            off: "G49",
        },
        tcp: Tcp::None,
        tcp_at_rapid: false,
        machine: "G53 G0",
        machine_off: "",
        leave: &[Leave::Retract, Leave::Length],
        stops: Stops { spindle: true, coolant: true },
        dwell: Dwell::Milliseconds("P"),
        change: "M6",
        cycles: CYCLES,
        cycle_addresses: CycleAddresses {
            clearance: "R",
            bottom: "Z",
            step: "Q",
            beside_step: "",
            dwell: "P",
        },
        cycle_return: CycleReturn::Codes,
        cycles_in_plane: false,
        rigid: Rigid::Always,
        plane: Plane::None,
        vector: "",
        splines: SplineForm::None,
        smoothing: ["", ""],
        smoothing_anywhere: false,
        smoothing_in_mm: false,
        surface: None,
        message: "",
        units_inside: false,
        probe: "",
        subprogram: Subprogram { number: "", name: "", times: "" },
        spindle: ["M3", "M4", "M5", "M19"],
        coolant: ["M9", "M8", "M7", "", ""],
        end: "M30",
        interpolates: true,
        words: &[],
    };
}
