//! What a dialect is asked to write, one event a step of the program, in order.
//!
//! The table below is the only description of the events: the Rust enum, the raw form, the flat batch, the C
//! header and the host's checks follow from it.

use crate::command::{Compensation, Coolant, Cycle, Feed, Spindle, SpindleSense};
use crate::cuts::{Columns, CutRun};
use crate::field::{Field, FieldReader, FieldShape, List, NotKnown, Promise, ToolPose};
use crate::flat::Flat;
use crate::setup::Units;

/// A kind of event as the contract has it.
#[derive(Clone, Copy, Debug)]
pub struct EventSpec {
    /// Number of the kind.
    pub kind: u32,
    /// Name in C, without `POST_EVENT_`.
    pub c_name: &'static str,
    /// Name in Rust.
    pub name: &'static str,
    /// What it is, with its article.
    pub what: &'static str,
    /// What a dialect does with it.
    pub doc: &'static str,
    /// Fields, in the order of their numbers and texts.
    pub fields: &'static [FieldSpec],
}

/// A field of an event.
#[derive(Clone, Copy, Debug)]
pub struct FieldSpec {
    /// Name of the field.
    pub name: &'static str,
    /// What it takes up.
    pub shape: FieldShape,
    /// What it means.
    pub doc: &'static str,
}

macro_rules! events {
    (<$a:lifetime> $(#[$about:meta])* Event { $(
        $(#[doc = $doc:literal])*
        $kind:literal $c:ident $what:literal $variant:ident
        $({ $($(#[doc = $field_doc:literal])* $field:ident: $type:ty,)* })?
        $(( $(#[doc = $only_doc:literal])* $only:ident: $only_type:ty ))?;
    )* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Event<$a> {
            $(
                $(#[doc = $doc])*
                $variant $({ $($(#[doc = $field_doc])* $field: $type,)* })?
                $(( $(#[doc = $only_doc])* $only_type ))?,
            )*
            /// Newer than this plugin. Refuse it; never drop it.
            Unknown {
                /// The kind's number in the contract.
                kind: u32,
            },
        }

        impl<$a> Event<$a> {
            /// Number of the kind in the contract.
            #[inline]
            pub const fn kind(&self) -> u32 {
                match self {
                    $(Event::$variant { .. } => $kind,)*
                    Event::Unknown { kind } => *kind,
                }
            }

            /// Name of the kind, for messages.
            pub const fn name(&self) -> &'static str {
                match self {
                    $(Event::$variant { .. } => stringify!($variant),)*
                    Event::Unknown { .. } => "Unknown",
                }
            }

            /// The sentence with which a dialect refuses an event that its control has no words for.
            pub fn refusal(&self) -> String {
                match self {
                    $(Event::$variant { .. } => concat!("this dialect has no words for ", $what).to_owned(),)*
                    Event::Unknown { kind } => format!("this dialect does not know events of kind {kind}"),
                }
            }

            /// One event of each kind, for tests.
            pub fn samples() -> Vec<Self> {
                vec![$(
                    Event::$variant
                        $({ $($field: <$type as Field<$a>>::SAMPLE,)* })?
                        $(( <$only_type as Field<$a>>::SAMPLE ))?,
                )*]
            }

            /// Is it what the host promises to a dialect? A sentence if not.
            #[inline]
            pub(crate) fn promised(&self, promise: &Promise) -> Result<(), String> {
                match *self {
                    $(Event::$variant $({ $($field),* })? $(($only))? => {
                        $($($field.check(promise)?;)*)?
                        $($only.check(promise)?;)?
                    })*
                    Event::Unknown { .. } => {}
                }
                let _ = promise;
                Ok(())
            }

            /// Appends its fields.
            #[inline]
            pub(crate) fn put(&self, to: &mut Flat) {
                match *self {
                    $(Event::$variant $({ $($field),* })? $(($only))? => {
                        $($($field.put(to);)*)?
                        $($only.put(to);)?
                    })*
                    Event::Unknown { .. } => {}
                }
            }

            /// The event of a kind with these fields.
            #[inline]
            pub(crate) fn get(kind: u32, from: &mut FieldReader<$a>) -> Result<Self, NotKnown> {
                Ok(match kind {
                    $($kind => Event::$variant
                        $({ $($field: <$type as Field<$a>>::get(from)?,)* })?
                        $(( <$only_type as Field<$a>>::get(from)? ))?,)*
                    _ => Event::Unknown { kind },
                })
            }

            const TABLE: &'static [EventSpec] = &[$(EventSpec {
                kind: $kind,
                c_name: stringify!($c),
                name: stringify!($variant),
                what: $what,
                doc: concat!($($doc),*),
                fields: &[
                    $($(FieldSpec {
                        name: stringify!($field),
                        shape: <$type as Field<$a>>::SHAPE,
                        doc: concat!($($field_doc),*),
                    },)*)?
                    $(FieldSpec {
                        name: stringify!($only),
                        shape: <$only_type as Field<$a>>::SHAPE,
                        doc: concat!($($only_doc),*),
                    })?
                ],
            }),*];
        }

        /// Every kind of event that this version knows.
        pub const EVENTS: &[EventSpec] = Event::TABLE;
    };
}

events! { <'a>
    /// One step of a program.
    ///
    /// The numbers are final: axis words are rounded to the decimals that the dialect's
    /// [`Format`](crate::Format) declares, in the units of its [`Setup`](crate::Setup), so comparing two
    /// of them with `==` compares what would be printed.
    ///
    /// A dialect must know the kinds up to [`Event::Word`]. The others are sent to a dialect that declares them
    /// ([`Capabilities`](crate::Capabilities)); one that does not know a kind refuses it with [`Event::refusal`].
    Event {
    /// The program begins: header, units, safe state.
    1 START "the program's start" Start;
    /// A remark for the operator (`PPRINT`, the names of operations).
    2 COMMENT "remarks" Comment {
        /// One line, any characters: the dialect makes it safe.
        text: &'a str,
    };
    /// A line to be written letter for letter (`INSERT`).
    3 LITERAL "a line of the user's own" Literal {
        /// The line.
        text: &'a str,
    };
    /// Change to a tool. The tool before it was retracted, the spindle and the coolant stand still.
    4 TOOL_CHANGE "a tool change" ToolChange {
        /// Tool number.
        number: u32,
        /// Register of the length compensation.
        register: u32,
        /// From the gauge point to the tip, mm; none if not known.
        length: Option<f64>,
        /// Of the cutter, mm; none if not known.
        diameter: Option<f64>,
        /// Of the cutter's corner, mm: half the diameter for a ball; none if not known.
        corner_radius: Option<f64>,
        /// Its name, empty if not known.
        name: &'a str,
    };
    /// Bring a tool to the change position without changing.
    5 PRESELECT "the preselection of a tool" Preselect {
        /// Tool number.
        number: u32,
    };
    /// Spindle on, off or oriented.
    6 SPINDLE "a spindle command" Spindle(
        /// POST_SPINDLE_… and revolutions a minute.
        spindle: Spindle
    );
    /// Coolant.
    7 COOLANT "coolant" Coolant(
        /// POST_COOLANT_….
        coolant: Coolant
    );
    /// Cutter radius compensation, in force from the next move on. Under
    /// [`Setup::tcp`](crate::Setup::tcp) it is sent under `COMPENSATE_TCP` alone.
    8 COMPENSATE "cutter radius compensation" Compensate(
        /// POST_COMPENSATE_… and the register of the radius.
        compensation: Compensation
    );
    /// The first position after a [`Event::Retract`] or a tool change. The tool stands clear of the part, the rotary
    /// axes have been turned by [`Event::Turn`] (of an arm on axes that slide all go at once here). The dialect puts
    /// the compensation in force (length compensation, or tool centre point control if
    /// [`Setup::tcp`](crate::Setup::tcp)) in the order that its control needs, and goes to the words at rapid.
    9 POSITION "a first position" Position {
        /// Where the tool stands then; none where nobody knows.
        tool: Option<ToolPose>,
        /// Feed of the last approach; none is rapid.
        feed: Option<Feed>,
        /// The words of the plane move the tool across, that of the depth along the spindle, and nothing else: the
        /// plane comes first, the depth last. Else (in a tilted plane under a head that leans; under tool centre point
        /// control where the tool leans, the part is turned or the control has no block of its own that begins it;
        /// where the machine file says how the tool leaves) all linear words stand in one block, and with them the
        /// rotary ones that were not turned before. It leads to a point clear of the part, from which the next moves
        /// come in along the tool.
        plane_first: bool,
        /// All axis words, in the order of [`Setup::words`](crate::Setup::words).
        words: &'a [f64],
    };
    /// The tool leaves the part: axes go at rapid to where the machine file proves it to be clear, and what
    /// [`Event::Position`] put in force (TCP, length) is cancelled, in the order that the control needs. Sent behind
    /// the start too, when nothing is known of what is in force; never twice without a motion, a tool
    /// change or an [`Event::Word`] between.
    10 RETRACT "a retract" Retract {
        /// Which words: bit n is word n.
        axes: u32,
        /// Positions in machine coordinates (G53, M91, SUPA), in program units; 0 for words that stay.
        words: &'a [f64],
    };
    /// Rapid traverse.
    11 RAPID "a rapid" Rapid {
        /// Where the tool stands at its end; none where nobody knows.
        tool: Option<ToolPose>,
        /// All axis words.
        words: &'a [f64],
    };
    /// A cut: all axes move linearly in time.
    12 LINEAR "a cut" Linear {
        /// Where the tool stands at its end; none where nobody knows.
        tool: Option<ToolPose>,
        /// Its feed.
        feed: Feed,
        /// All axis words.
        words: &'a [f64],
    };
    /// Wait.
    13 DWELL "a dwell" Dwell {
        /// Seconds.
        seconds: f64,
    };
    /// Unconditional stop (M0).
    14 STOP "a stop" Stop;
    /// Optional stop (M1).
    15 OPTIONAL_STOP "an optional stop" OptionalStop;
    /// After a [`Event::Retract`]: axes go at rapid to a position of the machine (for a tool change, at the end).
    16 PARK "a position of the machine" Park {
        /// Which words: bit n is word n.
        axes: u32,
        /// Positions in machine coordinates, in program units; 0 for words that stay.
        words: &'a [f64],
    };
    /// The program ends.
    17 END "the program's end" End;
    /// The rotary axes turn at rapid to their words, the tool retracted; the linear axes stay. Comes ahead of
    /// [`Event::Position`], what clamps them between the two.
    18 TURN "a turn of the rotary axes" Turn {
        /// All axis words: of these the rotary ones count.
        words: &'a [f64],
    };
    /// A line of the machine builder's own (a clamp, another head), to be written letter for letter. It moves
    /// nothing, and what is in force stays in force.
    19 WORD "a line of the machine's own" Word {
        /// The line.
        text: &'a str,
    };

    /// An operation begins. Sent under [`Capabilities::OPERATION`](crate::Capabilities::OPERATION), else its
    /// name is a remark.
    20 OPERATION "the start of an operation" Operation {
        /// Its name in the CAM system, empty if it has none.
        name: &'a str,
    };
    /// The operation ends. Under the same capability.
    21 OPERATION_END "the end of an operation" OperationEnd;
    /// A message on the control's screen (`MSG`), under `MESSAGE`.
    22 MESSAGE "a message to the operator" Message {
        /// One line, any characters; empty clears it.
        text: &'a str,
    };
    /// Units change inside the program, under `UNITS`; no length is in force across it.
    23 UNITS "a change of units" Units(
        /// POST_UNITS_….
        units: Units
    );
    /// Another work offset, under `WORK_OFFSET`. The tool was retracted before.
    24 WORK_OFFSET "a work offset" WorkOffset {
        /// From 1: G54 is 1, G55 is 2.
        number: u32,
        /// As the CL file names it, empty if it does not.
        name: &'a str,
    };
    /// Other registers for the tool in the spindle, under `OFFSETS`.
    25 OFFSETS "other registers of a tool" Offsets {
        /// Register of the length; none stays.
        length: Option<u32>,
        /// Register of the radius; none stays.
        radius: Option<u32>,
    };
    /// Spindle on at a constant cutting speed, under `SURFACE_SPEED`.
    26 SURFACE_SPEED "a constant cutting speed" SurfaceSpeed {
        /// m/min, or feet a minute in an inch program.
        speed: f64,
        /// Revolutions a minute that it must not exceed; none if not said.
        most: Option<f64>,
        /// POST_SENSE_….
        sense: SpindleSense,
    };
    /// Tool centre point control on or off by itself, under `TCP_SWITCH`: on ahead of [`Event::Position`], off ahead of
    /// [`Event::Retract`]; else these two do it, in the order that the control needs.
    27 TCP "a switch of tool centre point control" Tcp {
        /// On, else off.
        on: bool,
    };
    /// A tilted plane begins, under `PLANE`: until [`Event::PlaneOff`] linear words are in its frame, and
    /// [`Event::Position`] puts the length in force, no tool centre point control. The tool was retracted before.
    28 PLANE "a tilted plane" Plane {
        /// Origin of the plane's frame, mm, part frame; a number that the linear words can print.
        origin: [f64; 3],
        /// Its first direction, unit vector, part frame: that of the machine's X as it runs against the part at
        /// `words`, laid across `z`.
        x: [f64; 3],
        /// Its normal, unit vector, part frame: the tool axis.
        z: [f64; 3],
        /// The plane by [`Format::plane_angles`](crate::Format::plane_angles), degrees, rounded to its decimals: `x`
        /// and `z` follow from these; zero where the format has none.
        angles: [f64; 3],
        /// Where the axes stand in it: of these the rotary words count. The axes have been turned there by an
        /// [`Event::Turn`], so that a control which looks for its own solution finds the tool upright already.
        words: &'a [f64],
    };
    /// The tilted plane ends. The tool was retracted before.
    29 PLANE_OFF "the end of a tilted plane" PlaneOff;
    /// The control may leave the path by so much, under `SMOOTHING` (G187, CYCLE832, CYCL DEF 32, G61.1). The tool was
    /// retracted before; so it was before its end.
    30 SMOOTHING "smoothing" Smoothing {
        /// Of the tip, mm.
        tolerance: f64,
        /// Of the tool axis, degrees; none where it does not turn.
        axis_tolerance: Option<f64>,
    };
    /// The control keeps the path exactly, or as it does by default.
    31 SMOOTHING_OFF "the end of smoothing" SmoothingOff;
    /// A rotary axis is clamped or let go, under `CLAMP`; else the machine file's own word comes as
    /// [`Event::Word`].
    32 CLAMP "a clamp" Clamp {
        /// Which word of the setup, from 0.
        word: u32,
        /// Clamped, else let go.
        on: bool,
    };
    /// An arc or a helix about `normal`, at a feed, under `ARC_…`, `HELIX`.
    33 ARC "an arc" Arc {
        /// Where the tool stands at its end; none where nobody knows.
        tool: Option<ToolPose>,
        /// Its feed.
        feed: Feed,
        /// Centre in the frame and the units of the linear words.
        centre: [f64; 3],
        /// Unit vector in that frame about which it turns.
        normal: [f64; 3],
        /// Degrees from start to end, counter-clockwise seen against the normal; negative: clockwise.
        turn: f64,
        /// The radius to be written in the place of the centre, under `ARC_RADIUS`: negative for an arc of more than
        /// half a turn. None: the centre is written.
        radius: Option<f64>,
        /// All axis words at its end; a helix ends off the plane of its start.
        words: &'a [f64],
    };
    /// A spline at a feed, under `SPLINE`.
    34 SPLINE "a spline" Spline {
        /// Its feed.
        feed: Feed,
        /// Degree.
        degree: u32,
        /// Knots.
        knots: List<'a>,
        /// A weight for each control point.
        weights: List<'a>,
        /// All axis words of the first control point, then of the second, and so on.
        points: List<'a>,
    };
    /// A drilling cycle is in force at each [`Event::CyclePoint`] from here on, under `CYCLE_…` of its kind. Lengths
    /// are in program units, along the tool axis.
    35 CYCLE "a cycle" Cycle {
        /// POST_CYCLE_….
        cycle: Cycle,
        /// Its feed.
        feed: Feed,
        /// From the point down to the bottom.
        depth: f64,
        /// From the point up to where the feed begins.
        clearance: f64,
        /// From the point up to where the tool goes on the way to the next one.
        retract: f64,
        /// Into the part in one go; none if it goes in one.
        step: Option<f64>,
        /// At the bottom, seconds; none if it does not wait. Never of `Deep`, `BreakChip` and `Bore`.
        dwell: Option<f64>,
        /// A thread's way a turn; none if the feed says it.
        pitch: Option<f64>,
    };
    /// A point of the cycle in force.
    36 CYCLE_POINT "a point of a cycle" CyclePoint {
        /// Where the tool would stand on it; none where nobody knows.
        tool: Option<ToolPose>,
        /// All axis words with the tip on the point.
        words: &'a [f64],
    };
    /// No cycle is in force any more; the tool stands at the last point's retract level.
    37 CYCLE_OFF "the end of a cycle" CycleOff;
    /// A cut with the surface's normal, under `SURFACE` (`LN`, 3-D compensation).
    38 SURFACE "a cut with a surface normal" Surface {
        /// Where the tool stands at its end; none where nobody knows.
        tool: Option<ToolPose>,
        /// Its feed.
        feed: Feed,
        /// Unit vector out of the part, part frame.
        normal: [f64; 3],
        /// All axis words.
        words: &'a [f64],
    };
    /// Compensation of the tool's size in space, under `COMPENSATE_3D`.
    39 COMPENSATE_3D "compensation in space" Compensate3d {
        /// On, else off.
        on: bool,
        /// Register of the radius.
        register: u32,
    };
    /// A subprogram is called, under `SUBPROGRAM`. Afterwards nothing is known to be in force.
    40 SUBPROGRAM "a subprogram" Subprogram {
        /// Its number; none if it has a name.
        number: Option<u32>,
        /// How often.
        times: u32,
        /// Its name, empty if it has a number.
        name: &'a str,
    };
    /// A move until the probe touches, under `PROBE`.
    41 PROBE "a probing move" Probe {
        /// Where the tool would stand at its end; none where nobody knows.
        tool: Option<ToolPose>,
        /// Its feed.
        feed: Feed,
        /// All axis words of its end.
        words: &'a [f64],
    };
    /// Lines of the user's own in the place of those that the event behind this one would write, under `INSTEAD`. What
    /// that event puts in force is in force all the same. In front of a [`Event::Retract`] they stand for the way
    /// alone: what the control must cancel is cancelled around them; in front of [`Event::End`] for the words that end the
    /// program: what closes its file (`%`) stands behind them.
    42 INSTEAD "lines in the place of an event's" Instead {
        /// One or more lines, each ended by a line feed but the last.
        text: &'a str,
    };
    /// Cuts one behind the other, under `CUTS`: what a `Linear` of each would be, and the same text. Where the tool
    /// stands is not told.
    43 CUTS "a run of cuts" Cuts {
        /// Kind of all their feeds, and the first of them.
        feed: Feed,
        /// The feeds of all cuts, then the first axis word of all of them, then the second, and so on.
        columns: Columns<'a>,
    };
    /// A word of an axis means something else from here on, under `WORD_LETTER`: a coordinate of the control's own, in its
    /// polar interpolation, or the axis itself again. Which axis stands where is not known behind it.
    44 WORD_LETTER "another letter of a word" WordLetter {
        /// Which word of the setup, from 0.
        word: u32,
        /// It is a coordinate, a length; else the axis itself.
        coordinate: bool,
        /// The letter behind which it stands.
        letter: &'a str,
    };
    /// How the tool stands at the end of the cut that comes next, under `POSES`: the control leads it there straight, turned
    /// evenly about one direction. The frame of the tool has its origin in the tip and its Z from the spindle to the tip;
    /// its X is that of the machine frame, laid across, where all axes are at zero.
    45 POSE "the pose of a tool" Pose {
        /// The tip, mm, machine frame.
        origin: [f64; 3],
        /// How the frame is turned against the machine's: a unit quaternion, the scalar first.
        quaternion: [f64; 4],
        /// The same as a turn about its own direction, radians.
        rotation: [f64; 3],
        /// The same as turns about Z, then about the new Y, then about the new X, degrees.
        angles: [f64; 3],
    };
    }
}

impl<'a> Event<'a> {
    /// A first position of which only the words are known.
    pub const fn position(words: &'a [f64], feed: Option<Feed>) -> Self {
        Event::Position { tool: None, feed, plane_first: true, words }
    }

    /// A rapid of which only the words are known.
    pub const fn rapid(words: &'a [f64]) -> Self {
        Event::Rapid { tool: None, words }
    }

    /// A cut of which only the words are known.
    pub const fn linear(words: &'a [f64], feed: Feed) -> Self {
        let tool = None;
        Event::Linear { tool, feed, words }
    }

    /// A change to a tool whose size nobody knows.
    pub const fn tool_change(number: u32, register: u32, name: &'a str) -> Self {
        Event::ToolChange {
            number,
            register,
            length: None,
            diameter: None,
            corner_radius: None,
            name,
        }
    }

    /// Does the host keep its promise to the dialect with it? A sentence if not.
    ///
    /// # Errors
    /// What is wrong with it: too few words, a number that is none, a feed that does not move.
    #[inline]
    pub fn check(&self, promise: &Promise) -> Result<(), String> {
        self.promised(promise)?;
        match *self {
            Event::Dwell { seconds } if seconds < 0.0 => Err(format!("its number is {seconds}")),
            Event::Cuts { feed, columns } => CutRun::new(feed, columns, promise.words)?.check(),
            _ => Ok(()),
        }
    }

    /// Whether the text moves axes: no word of it may be anything but a number.
    pub const fn moves(&self) -> bool {
        matches!(
            self,
            Event::Position { .. }
                | Event::Turn { .. }
                | Event::Retract { .. }
                | Event::Park { .. }
                | Event::Rapid { .. }
                | Event::Linear { .. }
                | Event::Cuts { .. }
                | Event::Arc { .. }
                | Event::Spline { .. }
                | Event::CyclePoint { .. }
                | Event::Surface { .. }
                | Event::Probe { .. }
                | Event::Plane { .. }
        )
    }
}
