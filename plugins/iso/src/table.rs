//! What differs from control to control.

use post_plugin::{AxisNames, OptionSpec, remark};

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
    /// Usual ending of a program's file name.
    pub extension: &'static str,
    /// `%` before and after the program. Option `percent`.
    pub percent: bool,
    /// A text as a remark of this control.
    pub remark: fn(&str) -> String,
    /// Most characters of a remark: a longer one becomes several, the program's name is cut.
    pub remark_length: usize,
    /// Most characters that the control reads in a line, where that is known: a longer one of the user's own is
    /// refused.
    pub line_length: Option<usize>,
    /// Words of motion, feed and compensation.
    pub codes: Codes,
    /// The block behind that of the units: plane, compensation, cycles, way of counting and feed mode in a known state.
    /// It moves nothing, whatever was in force.
    pub safe: &'static str,
    /// What the program relies on among the control's parameters, one sentence each. Option `parameters` has them
    /// written as remarks.
    pub relies: &'static [&'static str],
    /// A block behind it that cancels what shifts, turns, scales or mirrors, and moves nothing; may be empty. Option
    /// `cancel`.
    pub cancel: &'static str,
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
    /// In front of positions in machine coordinates, at rapid: `G53 G0`.
    pub machine: &'static str,
    /// The order in which the tool retracts and what is in force is cancelled.
    pub leave: &'static [Leave],
    /// What a stop of the program switches off, or may.
    pub stops: Stops,
    /// A wait.
    pub dwell: Dwell,
    /// Behind `T1`: the change of the tool.
    pub change: &'static str,
    /// Spindle clockwise, counter-clockwise, off, oriented; empty where the control has none.
    pub spindle: [&'static str; 4],
    /// M codes of coolant off, flood, mist, through the tool, air; empty where they are the machine builder's.
    /// Options `coolant_off`, `coolant_flood`, `coolant_mist`, `coolant_through`, `coolant_air`; `coolant_mist_off`,
    /// `coolant_through_off`, `coolant_air_off` where a kind has an end of its own.
    pub coolant: [&'static str; 5],
    /// Ends the program.
    pub end: &'static str,
}

/// Words of motion, feed and compensation.
#[derive(Clone, Copy, Debug)]
pub struct Codes {
    /// mm, inch.
    pub units: [&'static str; 2],
    /// Rapid, cut.
    pub motion: [&'static str; 2],
    /// Feed a minute, inverse time, feed a revolution; empty where the control has none.
    pub feed: [&'static str; 3],
    /// Compensation off, left, right; the last two empty where the control has none.
    pub compensation: [&'static str; 3],
    /// Address of the compensation's register; empty where the control knows the radius by itself.
    pub radius: &'static str,
    /// Unconditional and optional stop.
    pub stop: [&'static str; 2],
}

/// Work offsets. Option `work_offset`.
#[derive(Clone, Copy, Debug)]
pub struct Offset {
    /// Is it one of the control's?
    pub known: fn(&str) -> bool,
    /// Those that are, for a message.
    pub range: &'static str,
    /// It stands in the first block; else in one of its own before the first position behind a tool change.
    pub at_start: bool,
}

/// Length compensation.
#[derive(Clone, Copy, Debug)]
pub struct Length {
    /// Puts it in force; empty where the control does that by itself.
    pub on: &'static str,
    /// Address of its register.
    pub register: &'static str,
    /// The control knows the length without a register. Option `length_register` gives one to a program that loads
    /// no tool.
    pub by_itself: bool,
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
    /// The tool centre point control is switched off, where blocks of its own do that.
    Tcp,
}

/// What a stop of the program (M0, M1) switches off. It is written again behind the stop: where the control or its
/// builder has left it on, that does nothing.
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

impl Codes {
    /// As most controls have them.
    pub const ISO: Codes = Codes {
        units: ["G21", "G20"],
        motion: ["G0", "G1"],
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
        extension: "nc",
        percent: true,
        remark,
        // No manual gives a limit; a line of any control's screen is as long.
        remark_length: 80,
        line_length: None,
        codes: Codes::ISO,
        safe: "G17 G40 G80 G90 G94",
        relies: &[],
        cancel: "",
        largest_number: 99_999,
        trim: false,
        per_revolution: 4,
        offset: Offset {
            known: |text| matches!(text, "G54" | "G55" | "G56" | "G57" | "G58" | "G59"),
            range: "G54 to G59",
            at_start: false,
        },
        length: Length {
            on: "G43",
            register: "H",
            by_itself: false,
            off: "G49",
        },
        tcp: Tcp::None,
        machine: "G53 G0",
        leave: &[Leave::Retract, Leave::Length],
        stops: Stops {
            spindle: true,
            coolant: true,
        },
        dwell: Dwell::Milliseconds("P"),
        change: "M6",
        spindle: ["M3", "M4", "M5", "M19"],
        coolant: ["M9", "M8", "M7", "", ""],
        end: "M30",
    };
}
