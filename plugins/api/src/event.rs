//! What a dialect is asked to write, one event a step of the program, in order.

/// One step of a program.
///
/// The numbers are final: axis words are rounded to the decimals that the dialect's
/// [`Format`](crate::Format) declares, in the units of its [`Setup`](crate::Setup), so comparing two
/// of them with `==` compares what would be printed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Event<'a> {
    /// The program begins: header, units, safe state.
    Start,
    /// A remark for the operator (`PPRINT`, the names of operations).
    Comment {
        /// One line, any characters: the dialect makes it safe.
        text: &'a str,
    },
    /// A line to be written letter for letter (`INSERT`).
    Literal {
        /// The line.
        text: &'a str,
    },
    /// A line of the machine builder's own (a clamp, another head), to be written letter for letter. It moves
    /// nothing, and what is in force stays in force.
    Word {
        /// The line.
        text: &'a str,
    },
    /// Change to a tool. The last tool's compensation was released before.
    ToolChange {
        /// Tool number.
        number: u32,
        /// Register of the length compensation.
        register: u32,
        /// Its name, empty if not known.
        name: &'a str,
    },
    /// Bring a tool to the change position without changing.
    Preselect {
        /// Tool number.
        number: u32,
    },
    /// Spindle on, off or oriented.
    Spindle(Spindle),
    /// Coolant.
    Coolant(Coolant),
    /// Cutter radius compensation, in force from the next move on.
    Compensate(Compensation),
    /// The first position after the start, a tool change or a [`Event::Release`]: the tool comes from
    /// wherever it stands (clear of the part). The dialect puts the compensation in force
    /// (length compensation, or tool centre point control if [`Setup::tcp`](crate::Setup::tcp)),
    /// rotary axes first, then the plane, then the depth.
    Position {
        /// All axis words, in the order of [`Setup::words`](crate::Setup::words).
        words: &'a [f64],
        /// Feed of the last approach; none is rapid.
        feed: Option<Feed>,
    },
    /// Cancel what [`Event::Position`] put in force (TCP, length), before a tool change, home or the end.
    Release,
    /// Rapid traverse.
    Rapid {
        /// All axis words.
        words: &'a [f64],
    },
    /// A cut: all axes move linearly in time.
    Linear {
        /// All axis words.
        words: &'a [f64],
        /// Its feed.
        feed: Feed,
    },
    /// Wait.
    Dwell {
        /// Seconds.
        seconds: f64,
    },
    /// Unconditional stop (M0).
    Stop,
    /// Optional stop (M1).
    OptionalStop,
    /// Retract to the machine's reference (depth axis first). Comes after [`Event::Release`].
    Home,
    /// The program ends.
    End,
    /// Newer than this plugin. Refuse it; never drop it.
    Unknown {
        /// The kind's number in the contract.
        kind: u32,
    },
}

impl Event<'_> {
    /// Name of the kind, for messages.
    pub fn name(&self) -> &'static str {
        match self {
            Event::Start => "Start",
            Event::Comment { .. } => "Comment",
            Event::Literal { .. } => "Literal",
            Event::Word { .. } => "Word",
            Event::ToolChange { .. } => "ToolChange",
            Event::Preselect { .. } => "Preselect",
            Event::Spindle(_) => "Spindle",
            Event::Coolant(_) => "Coolant",
            Event::Compensate(_) => "Compensate",
            Event::Position { .. } => "Position",
            Event::Release => "Release",
            Event::Rapid { .. } => "Rapid",
            Event::Linear { .. } => "Linear",
            Event::Dwell { .. } => "Dwell",
            Event::Stop => "Stop",
            Event::OptionalStop => "OptionalStop",
            Event::Home => "Home",
            Event::End => "End",
            Event::Unknown { .. } => "Unknown",
        }
    }
}

/// Feed of a cut; already rounded down to the decimals of the dialect's format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// Length units a minute (G94).
    PerMinute(f64),
    /// 1/min: the block takes 1/F minutes (G93). Only to dialects whose format allows it.
    InverseTime(f64),
    /// Length units a spindle revolution (G95).
    PerRevolution(f64),
}

/// Spindle commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spindle {
    /// Turn.
    On {
        /// Revolutions a minute.
        rpm: f64,
        /// Sense.
        sense: SpindleSense,
    },
    /// Stop.
    Off,
    /// Oriented stop (M19).
    Orient,
}

/// Sense of the spindle, seen from the spindle to the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleSense {
    /// M3.
    Clockwise,
    /// M4.
    CounterClockwise,
}

/// Coolant commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coolant {
    /// All off.
    Off,
    /// Flood.
    Flood,
    /// Mist.
    Mist,
    /// Through the tool.
    Through,
    /// Air.
    Air,
}

/// Cutter radius compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// G40.
    Off,
    /// G41.
    Left {
        /// Register.
        register: u32,
    },
    /// G42.
    Right {
        /// Register.
        register: u32,
    },
}
