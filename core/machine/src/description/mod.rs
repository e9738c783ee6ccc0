//! One machine: what its TOML file says, checked and in the core's own units (mm, radians, minutes).

mod accuracy;
mod arcs;
mod axes;
mod bodies;
mod bounds;
mod build;
mod choice;
mod cl_words;
mod dependent;
mod drives;
mod echoes;
mod error_rows;
mod error_run;
mod errors;
mod file;
mod formulas;
mod frame;
mod keys;
mod layers;
mod legs;
mod length;
mod limits;
mod mode;
mod motion;
mod nose;
mod numbers;
mod options;
mod outline;
mod plan;
mod profile;
mod program;
mod program_file;
mod quantity;
mod schema;
mod servo;
mod servo_file;
mod servo_models;
mod setting;
pub(crate) mod smoothing;
mod solids;
mod spindle;
mod stock;
pub(crate) mod table;
mod tip_words;
mod tools;
mod turned;
mod wait;
mod word;

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;

pub use accuracy::{AccuracyRules, ControlPoint, SHARE_AT_POLES};
pub use arcs::Arcs;
pub use bodies::{BodyPair, ClearanceRules, GivenBody, GivenShape, KeptPair, RapidAxes};
pub use build::{Evaluated, MachineReading, examine, load};
pub use choice::{Retract, Rewind, SolutionCriterion, SolutionRules};
pub use cl_words::WordRule;
pub use errors::{ErrorTable, ErrorUnits};
pub use file::{
    ArcForm, ArcSplit, CompensationOnCentre, Cycles, EdgeSource, FeedLength, FeedMode, Insert,
    InverseTime, Method, Moves, Orientation, OutputUnits, Placement, Pole, Print, Rapid, Side, Tcp,
    TcpFeedLength, ToolLength,
};
pub use frame::Frame;
pub use layers::{Source, readable};
pub use length::LengthAxis;
pub use limits::MOST_BYTES;
pub use motion::{BlendRule, CornerRule, LimitsActOn, MotionRules, RapidRule};
pub use nose::NoseRule;
pub use outline::ToolOutline;
pub use plan::{PlanRules, PlanSolver};
pub use profile::{NumberOrigin, Profile, StatedNumber, stated_numbers};
pub use program::{ProgramRules, ProgramText, TextPlace};
pub use schema::schema;
pub use setting::Setting;
pub use smoothing::{Smoothing, SmoothingRules};
pub use solids::Solid;
pub use spindle::{SpindleSpeeds, surface_rpm_on_way};
pub use stock::StockCut;
pub use tools::{TOOL_FILE_ENDINGS, ToolData, ToolTable};
pub use turned::{NoArc, TurnedProfile};

use crate::along_word::AlongWord;
use crate::dependent_limit::DependentLimit;
use crate::diagnostic::{Diagnostic, SourcePlace};
use crate::face_mode::FaceMode;
use crate::kinematics::{
    AxisErrors, Chain, Freedom, Joint, Joints, Leg, MAX_AXES, NoClosedForm, Second, Solver,
};
use crate::servo::Servo;
use crate::wait_rule::WaitRule;
use crate::word_map::WordMap;
use crate::wrap_mode::WrapMode;

/// Name of the head that a machine has in polar interpolation by the control: no CL file can say it.
const FACE_MODE: &str = "mode face";

/// Likewise in cylinder interpolation.
const WRAP_MODE: &str = "mode wrap";

/// The cosine between two linear axes that stand square to one another is less: a lean that was measured is more.
const SQUARE: f64 = 1e-6;

/// The linear axes whose words can be those of a tip.
pub(crate) const TIP_WORDS: [&str; 3] = ["X", "Y", "Z"];

/// Words of the linear axes.
fn linear_words(axes: &[Axis]) -> BTreeSet<&str> {
    axes.iter().filter(|axis| !axis.joint.rotary).map(Axis::word).collect()
}

/// A machine.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name, as the file gives it.
    pub name: String,
    /// Axes in chain order, from the workpiece to the tool.
    pub axes: Vec<Axis>,
    /// Errors of axes that depend on where they stand.
    pub errors: Arc<[AxisErrors]>,
    /// Files of such errors, which [`Machine::take_errors`] takes.
    pub error_tables: Vec<ErrorTable>,
    /// What must hold between the axes, beside the travel of each.
    pub limits: Vec<DependentLimit>,
    /// What words make of axis values; none where each word is the value of its axis.
    pub word_map: Option<WordMap>,
    /// How it waits for other channels; none if it has none.
    pub wait: Option<WaitRule>,
    /// A word of no axis, which goes with the way of the tip.
    pub along: Option<AlongWord>,
    /// Where the part origin sits with all axes at zero, mm, machine frame.
    pub mount: Vector3<f64>,
    /// The machine file, or the job, says where the part sits.
    pub mount_said: bool,
    /// The travel of each axis where that of the axes themselves is opened ([`Machine::with_part_anywhere`]), else empty.
    pub given_travel: Vec<Option<[f64; 2]>>,
    /// How the part is turned about its own Z where it sits, radians: right-handed, so counter-clockwise for who looks
    /// down on it, from the machine's X at zero to the part's. Points of the CL file are turned by it as they are read;
    /// what is called the part frame from there on stands as the machine's does.
    pub turn: f64,
    /// Gauge point of the tool holder with all axes at zero, mm, machine frame.
    pub gauge: Vector3<f64>,
    /// Tool axis with all axes at zero, unit vector from the tip to the holder, machine frame.
    pub tool_axis: Vector3<f64>,
    /// The axis along which the control puts the tool's length.
    pub length_axis: LengthAxis,
    /// Leading edge of the tool (knife, disc) with all axes at zero, unit vector across the tool axis,
    /// machine frame; none for a tool that turns.
    pub edge: Option<Vector3<f64>>,
    /// The point of the tool that must stay within tolerance.
    pub control_point: ControlPoint,
    /// Tool lengths by tool number, mm, from the gauge point to the tip.
    pub tools: Vec<(u32, f64)>,
    /// The file that has its tools, if the machine file or the job names one.
    pub tool_table: Option<ToolTable>,
    /// What leads from the points of the CL file to those that its tools' offsets in the control name, if they are others.
    pub nose: Option<NoseRule>,
    /// The control.
    pub control: ControlRules,
    /// How fast its spindle turns.
    pub spindle: SpindleSpeeds,
    /// Lines of the program for words of the CL file.
    pub word_rules: Vec<WordRule>,
    /// Tolerances within which the control may leave the path, by operation.
    pub smoothing: SmoothingRules,
    /// Text of its programs.
    pub program: ProgramRules,
    /// What it must keep.
    pub accuracy: AccuracyRules,
    /// Which of several solutions is taken.
    pub solution: SolutionRules,
    /// How the tool leaves the part when a cut cannot go on; none if it must not.
    pub rewind: Option<Rewind>,
    /// How its control makes motion of a program.
    pub motion: MotionRules,
    /// What its planned feeds keep.
    pub plan: PlanRules,
    /// Of what machine its file is, and where the numbers come from.
    pub profile: Profile,
    /// Where the axes go between the passes.
    pub frame: Frame,
    /// Some axis is clamped and let go by words.
    pub clamps: bool,
    /// Some axis moves off the part alone.
    pub indexes: bool,
    /// Heads that a word of the program (`HEAD/name`) swaps in, and the machine in a mode of its control.
    pub heads: Vec<Head>,
    /// The control interpolates in polar coordinates, and the axes are those of the face; none on the machine itself.
    pub face: Option<FaceMode>,
    /// The control interpolates on a cylinder; none on the machine itself.
    pub wrap: Option<WrapMode>,
    /// Options for plugins that it does not use.
    pub unused_options: Vec<UnusedOptions>,
    /// Shapes of its bodies, for pictures and for what hits what.
    pub solids: Vec<Solid>,
    /// What holds the part, and what is in the way besides.
    pub fixtures: Vec<GivenBody>,
    /// The raw parts; none if the file does not say.
    pub stocks: Vec<GivenBody>,
    /// How far tools reach from their axes.
    pub outlines: Vec<ToolOutline>,
    /// Distances that bodies keep.
    pub clearance: ClearanceRules,
    /// Codes of findings that are not told of its programs.
    pub lint_ignored: Vec<String>,
}

/// A table of options for a plugin that the machine does not use: a machine may carry those of several dialects.
#[derive(Clone, Debug)]
pub struct UnusedOptions {
    /// The table that it stands in: `control` for a dialect, `accuracy` for an error model.
    pub section: &'static str,
    /// The plugin's name.
    pub plugin: String,
    /// The options.
    pub options: Vec<GivenOption>,
}

/// A head that the program can swap in.
#[derive(Clone, Debug)]
pub struct Head {
    /// Name in `HEAD/name`.
    pub name: String,
    /// The line of the program that swaps it in, letter for letter; none if the operator does.
    pub word: Option<String>,
    /// The work offset that was measured with it, from 1: G54 is 1, G55 is 2.
    pub offset: Option<u32>,
    /// The machine with this head.
    pub machine: Machine,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its name in the machine file, `X`, `C`: its word in the program, unless `tip_word` is.
    pub name: String,
    /// Its word where the control keeps the tip and the file calls three slides otherwise: `X`, `Y` or `Z`.
    pub tip_word: Option<&'static str>,
    /// Where the file describes it.
    pub place: Option<SourcePlace>,
    /// It carries the workpiece (primed in the chain), else the tool.
    pub carries_part: bool,
    /// Kind, direction and line.
    pub joint: Joint,
    /// The file has its direction turned round (`reversed`).
    pub reversed: bool,
    /// What the control shows where the drawing has the axis at zero, mm or radians. All other values here
    /// are counted from the drawing's zero.
    pub zero: f64,
    /// Least and largest value, mm or radians; none for a cyclic axis.
    pub travel: Option<[f64; 2]>,
    /// The control shows a cyclic axis within these values, radians, and turns it the shorter way.
    pub range: Option<[f64; 2]>,
    /// Its word is a place within one turn, and the sign of that the way there.
    pub signed: bool,
    /// It moves off the part alone.
    pub indexed: Option<Indexed>,
    /// It moves along with another linear axis.
    pub second: Option<Second>,
    /// Words that clamp it and let it go.
    pub clamp: Option<Clamp>,
    /// Largest feed, mm/min or rad/min; infinite if the file does not say.
    pub max_feed: f64,
    /// A feed a minute counts the way of a rotary axis along a circle of this diameter, mm; none: in degrees.
    pub feed_diameter: Option<f64>,
    /// Largest acceleration, mm/s² or rad/s²; infinite if the file does not say.
    pub max_accel: f64,
    /// Largest jerk, mm/s³ or rad/s³; infinite if the file does not say.
    pub max_jerk: f64,
    /// Largest jump of its velocity where one block passes into the next, mm/min or rad/min; none if the file does not say.
    pub max_jump: Option<f64>,
    /// How far it is from its set-points; none: it follows them exactly.
    pub servo: Option<Box<Servo>>,
}

/// An axis that moves off the part alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Indexed {
    /// Where it stands until something moves it, mm or radians.
    pub start: f64,
    /// Where it can stand.
    pub positions: Positions,
}

/// Where an indexed axis can stand.
#[derive(Clone, Debug, PartialEq)]
pub enum Positions {
    /// Anywhere in its travel.
    Any,
    /// Values, mm or radians.
    List(Vec<f64>),
    /// All whole multiples of `step` from `first`, mm or radians.
    Step {
        /// One of them.
        first: f64,
        /// Distance from one to the next.
        step: f64,
    },
}

impl Axis {
    /// Its word in the program.
    pub fn word(&self) -> &str {
        self.tip_word.unwrap_or(&self.name)
    }

    /// Axis units (mm, radians) in one unit of what the control shows (mm, degrees).
    pub fn unit(&self) -> f64 {
        if self.joint.rotary { 1f64.to_radians() } else { 1.0 }
    }

    /// What its positions are told in: `mm`, or `deg` of a rotary axis.
    pub fn unit_name(&self) -> &'static str {
        if self.joint.rotary { "deg" } else { "mm" }
    }

    /// What the control shows at `value`: mm or degrees.
    pub fn reading(&self, value: f64) -> f64 {
        (value + self.zero) / self.unit()
    }
}

impl Positions {
    /// The axis can stand at `value`; where it turns without end, full turns make no difference.
    pub fn holds(&self, value: f64, cyclic: bool) -> bool {
        libm::fabs(self.nearest(value, cyclic) - value) < 1e-6
    }

    /// The position nearest to `value`.
    pub fn nearest(&self, value: f64, cyclic: bool) -> f64 {
        match self {
            Self::Any => value,
            Self::Step { first, step } => first + libm::rint((value - first) / step) * step,
            Self::List(values) => {
                let turned = |position: f64| {
                    if cyclic {
                        position + libm::rint((value - position) / TAU) * TAU
                    } else {
                        position
                    }
                };
                let mut best = f64::INFINITY;
                for position in values.iter().copied().map(turned) {
                    if libm::fabs(position - value) < libm::fabs(best - value) {
                        best = position;
                    }
                }
                best
            }
        }
    }
}

/// Words of the program, letter for letter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clamp {
    /// Clamps the axis.
    pub on: String,
    /// Lets it go.
    pub off: String,
}

/// The control of a machine.
#[derive(Clone, Debug)]
pub struct ControlRules {
    /// Name of the dialect.
    pub dialect: String,
    /// Where the file names it.
    pub dialect_place: Option<SourcePlace>,
    /// Options for the dialect, as the file gives them, each with its place.
    pub options: Vec<GivenOption>,
    /// Who keeps the tip on its path.
    pub tcp: Tcp,
    /// Units of the NC program.
    pub units: OutputUnits,
    /// How feeds are written.
    pub feed: FeedMode,
    /// What a feed a minute is meant along.
    pub feed_length: Option<FeedLength>,
    /// What a feed a minute is meant along where the control keeps the tip.
    pub tcp_feed_length: TcpFeedLength,
    /// What F means under inverse time.
    pub inverse_time: InverseTime,
    /// How a robot's control leads cuts.
    pub moves: Moves,
    /// What the program tells of where the tool points; none: what its dialect writes by itself.
    pub orientation: Option<Orientation>,
    /// How a rapid is written in which a rotary axis turns, or an axis would pass its largest feed; none: as the control
    /// asks for ([`Machine::rapid`]).
    pub rapid: Option<Rapid>,
    /// Which tool length counts.
    pub tool_length: ToolLength,
    /// How the holes of drilling cycles are written.
    pub cycles: Cycles,
    /// An operation whose tool axis stays is written in a tilted plane of the control's; none: as the chain has it
    /// ([`Machine::wants_planes`]).
    pub planes: Option<bool>,
    /// What becomes of `INSERT`.
    pub insert: Insert,
    /// What becomes of `PPRINT`.
    pub print: Print,
    /// What becomes of `CUTCOM` on points of the tool's centre.
    pub compensation_on_centre: CompensationOnCentre,
    /// Which curves the program has as curves.
    pub arcs: Arcs,
}

/// An option for a plugin.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenOption {
    /// Key of the option.
    pub key: String,
    /// Value of the option.
    pub value: OptionValue,
    /// Where it stands.
    pub place: Option<SourcePlace>,
}

/// The value of an option for a plugin.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// `true`, `false`.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// Text; of an array of lines, with line feeds between.
    Text(String),
}

impl Machine {
    /// How far a tool reaches from its axis, where the file says it.
    pub fn outline(&self, number: u32) -> Option<&ToolOutline> {
        self.outlines.iter().find(|outline| outline.number == number)
    }

    /// Whether rotary axes swing the tool to its places: linear ones, if it has any, do not place the tip by themselves, nor
    /// is it a head of one or two rotary axes, which point the tool, over a table that turns.
    pub fn is_arm(&self) -> bool {
        let swings = self.axes.iter().filter(|axis| axis.joint.rotary && !axis.carries_part);
        swings.count() > 2 && self.solver(0.0).is_ok_and(|solver| !solver.places_tip())
    }

    /// The machine with a tool of `length` mm in it and its indexed axes where they start, ready to be solved.
    ///
    /// # Errors
    /// What its chain lacks.
    pub fn solver(&self, length: f64) -> Result<Solver, NoClosedForm> {
        self.solver_at(length, &self.solution.start)
    }

    /// [`Machine::solver`] with the redundant axes held at the values of `held`.
    ///
    /// # Errors
    /// What the chain lacks.
    pub fn solver_at(&self, length: f64, held: &Joints) -> Result<Solver, NoClosedForm> {
        let joints = self.axes.iter().map(|axis| axis.joint).collect();
        let tip = self.gauge - self.tool_axis * length;
        let chain = Chain::new(joints, self.mount, tip, self.tool_axis).with_edge(self.edge);
        let chain = chain.with_errors(&self.errors);
        let freedom = Freedom {
            rotary: self.pointing(),
            still: (0..self.axes.len())
                .filter(|place| {
                    let axis = &self.axes[*place];
                    !axis.joint.rotary && axis.indexed.is_some()
                })
                .collect(),
            held: *held,
            seconds: self
                .axes
                .iter()
                .enumerate()
                .filter_map(|(place, axis)| {
                    let second = axis.second?;
                    let of = match second {
                        Second::Share { of, .. } | Second::Reserve { of } => of,
                    };
                    let endless = [f64::NEG_INFINITY, f64::INFINITY];
                    Some((place, second, self.axes[of].travel.unwrap_or(endless)))
                })
                .collect(),
        };
        Ok(Solver::with(chain, &freedom)?.within(self.accuracy.tolerance))
    }

    /// The finding that the chain cannot be solved. What its file alone says was refused when it was loaded: this is
    /// for index axes that stand elsewhere since.
    pub fn unsolvable(&self, lack: &NoClosedForm) -> Diagnostic {
        let (message, help) = lack.told(|joint| &self.axes[joint].name);
        Diagnostic::error("machine-chain", format!("{} cannot be solved: {message}", self.name))
            .help(help)
    }

    /// Rotary axes that are solved for from the wanted tool axis: those that move in cuts, and as many of the
    /// indexed ones (from the tool on) as two need. Places in the chain, in its order.
    pub fn pointing(&self) -> Vec<usize> {
        let rotary = |place: &usize| self.axes[*place].joint.rotary;
        let mut pointing: Vec<usize> = (0..self.axes.len())
            .filter(rotary)
            .filter(|place| self.axes[*place].indexed.is_none())
            .collect();
        for place in (0..self.axes.len()).rev().filter(rotary) {
            let joint = &self.axes[place].joint;
            let of_use = match pointing.as_slice() {
                [] => true,
                [other] => {
                    let other = &self.axes[*other].joint;
                    joint.direction.cross(&other.direction).norm() > 1e-3
                }
                _ => false,
            };
            if self.axes[place].indexed.is_some() && of_use {
                pointing.push(place);
            }
        }
        pointing.sort_unstable();
        pointing
    }

    /// The legs that drive a platform of it, in the order of the file.
    pub fn legs(&self) -> impl Iterator<Item = &Leg> {
        self.limits.iter().filter_map(DependentLimit::leg)
    }

    /// What is told of an axis by its place in the chain, or of a leg by [`MAX_AXES`] and its place among the legs.
    pub fn mover(&self, place: usize) -> &str {
        match place.checked_sub(MAX_AXES) {
            None => self.axes.get(place).map_or("", |axis| axis.name.as_str()),
            Some(leg) => self.legs().nth(leg).map_or("", |leg| leg.name.as_str()),
        }
    }

    /// An operation whose tool axis stays (3+2) is to be written in a tilted plane of the control's: as the machine file
    /// says, else where nothing is lost in one (`whole`: the control has its cycles, arcs and cutter compensation there),
    /// both rotary axes point the tool, and the words of the plane are those of three linear axes. A control computes a
    /// plane for the axes that it has been told of, not for an index table or a head besides, and for slides that stand
    /// still square to one another.
    pub fn wants_planes(&self, whole: bool) -> bool {
        self.control.planes.unwrap_or_else(|| {
            let rotary = self.axes.iter().filter(|axis| axis.joint.rotary).count();
            whole
                && rotary == 2
                && self.pointing().len() == 2
                && linear_words(&self.axes) == BTreeSet::from(TIP_WORDS)
                && self.heads.is_empty()
                && self.errors.is_empty()
                && self.slides_are_square()
                && self.turned_slide().is_none()
        })
    }

    /// The linear axes stand square to one another.
    fn slides_are_square(&self) -> bool {
        let slides: Vec<&Axis> = self.axes.iter().filter(|axis| !axis.joint.rotary).collect();
        let cosine = |one: &Axis, other: &Axis| one.joint.direction.dot(&other.joint.direction);
        let mut pairs = slides.iter().enumerate().flat_map(|(place, one)| {
            slides[place + 1..].iter().map(move |other| cosine(one, other))
        });
        pairs.all(|cosine| libm::fabs(cosine) < SQUARE)
    }

    /// X, Y or Z that a rotary axis turns, which is between it and the bed.
    pub fn turned_slide(&self) -> Option<&Axis> {
        let mut slides = self
            .axes
            .iter()
            .enumerate()
            .filter(|(_, axis)| !axis.joint.rotary && TIP_WORDS.contains(&axis.word()));
        let turned = slides.find(|(place, slide)| {
            self.axes.iter().enumerate().any(|(other, axis)| {
                let nearer_bed = if slide.carries_part { other > *place } else { other < *place };
                axis.joint.rotary && axis.carries_part == slide.carries_part && nearer_bed
            })
        });
        turned.map(|(_, slide)| slide)
    }

    /// Minutes that each axis needs for one mm or radian at its largest feed; zero if it has none.
    pub fn slowness(&self) -> Joints {
        let mut slowness = Joints::default();
        for (slowness, axis) in slowness.iter_mut().zip(&self.axes) {
            *slowness = 1.0 / axis.max_feed;
        }
        slowness
    }

    /// How a rapid is written in which a rotary axis turns, or an axis would pass its largest feed, on a control where one
    /// may (`passes`) while it keeps the tip: as a feed move, if every axis has such a feed.
    pub fn rapid(&self, passes: bool) -> Rapid {
        let kept = self.control.tcp == Tcp::Control;
        let known = self.axes.iter().all(|axis| axis.max_feed.is_finite());
        self.control.rapid.unwrap_or(match passes && kept && known {
            true => Rapid::Linear,
            false => Rapid::Rapid,
        })
    }

    /// Nobody says where the part sits, and nothing turns it or the tool: any place inside the travel will do.
    pub fn part_sits_anywhere(&self) -> bool {
        let plain =
            |axis: &Axis| !axis.joint.rotary && axis.second.is_none() && axis.indexed.is_none();
        let alone = self.heads.is_empty() && self.limits.is_empty() && !self.errs();
        !self.mount_said && alone && self.axes.iter().all(plain)
    }

    /// The machine with its travel opened, where the part may sit anywhere: the way of the whole program is held against it
    /// then, not each point.
    pub fn with_part_anywhere(&self) -> Option<Self> {
        let opens = self.part_sits_anywhere() && !self.is_opened();
        opens.then(|| Self {
            given_travel: self.axes.iter().map(|axis| axis.travel).collect(),
            ..crate::place::opened(self)
        })
    }

    /// Its travel is opened.
    pub fn is_opened(&self) -> bool {
        !self.given_travel.is_empty()
    }

    /// The travel of an axis as the machine file has it, by its place in the chain.
    pub fn travel_of(&self, joint: usize) -> Option<[f64; 2]> {
        self.given_travel.get(joint).copied().unwrap_or(self.axes[joint].travel)
    }

    /// Axis values as the control shows them, `X 12.000 A -30.000`; mm and degrees.
    pub fn shown(&self, joints: &Joints) -> String {
        let stands = self.axes.iter().zip(joints);
        let stands = stands.map(|(axis, at)| format!("{} {:.3}", axis.name, axis.reading(*at)));
        stands.collect::<Vec<_>>().join(" ")
    }

    /// Errors that depend on position are taken out of the words.
    pub fn errs(&self) -> bool {
        !self.errors.is_empty() || !self.error_tables.is_empty()
    }

    /// The words of a program hold for a part on `mount` alone: they are axis positions, and a rotary axis carries the
    /// part, or errors of axes are taken out of them; or ways between passes are those that bodies leave there.
    pub fn holds_on_mount_alone(&self) -> bool {
        let turns = |axis: &Axis| axis.joint.rotary && axis.carries_part;
        let by_words = self.errs() || self.axes.iter().any(turns);
        self.control.tcp == Tcp::Post && by_words || self.clearance.shortens_ways()
    }

    /// Why [`Machine::holds_on_mount_alone`].
    pub fn one_mount(&self) -> &'static str {
        if self.clearance.shortens_ways() {
            "ways between passes are those that bodies leave"
        } else if self.errs() {
            "errors that depend on position are taken out of them"
        } else {
            "a rotary axis carries the part"
        }
    }

    /// The words of a program hold for tools of one length alone: they are axis positions, and a head turns the tool, or
    /// errors of axes are taken out of them.
    pub fn words_hold_on_length_alone(&self) -> bool {
        let first_linear = self.axes.iter().position(|axis| !axis.joint.rotary);
        let mut behind = self.axes.iter().skip(first_linear.unwrap_or(0));
        self.control.tcp == Tcp::Post && (self.errs() || behind.any(|axis| axis.joint.rotary))
    }

    /// A program holds for tools of one length alone: its words do, or ways between passes are those that bodies leave.
    pub fn holds_on_length_alone(&self) -> bool {
        self.words_hold_on_length_alone() || self.clearance.shortens_ways()
    }

    /// The tool has a leading edge, and that is headed along the direction of travel.
    pub fn heads_edge(&self) -> bool {
        self.edge.is_some() && self.solution.edge == EdgeSource::Travel
    }

    /// The head that `HEAD/name` swaps in.
    pub fn head(&self, name: &str) -> Option<&Head> {
        self.heads.iter().find(|head| head.name == name)
    }

    /// The machine with the head of that name, or in the mode of that name; with an empty name, by which a mode ends, the
    /// machine itself.
    pub fn changed_to(&self, name: &str) -> Option<&Machine> {
        match name.is_empty() && self.has_modes() {
            true => Some(self),
            false => self.head(name).map(|head| &head.machine),
        }
    }

    /// Name of the head, and the machine, while its control interpolates in polar coordinates; none where it does not.
    pub fn in_face(&self) -> Option<(&str, &Machine)> {
        let face = self.heads.iter().find(|head| head.machine.face.is_some())?;
        Some((&face.name, &face.machine))
    }

    /// Name of the head, and the machine, while its control interpolates on a cylinder; none where it does not.
    pub fn in_wrap(&self) -> Option<(&str, &Machine)> {
        let wrap = self.heads.iter().find(|head| head.machine.wrap.is_some())?;
        Some((&wrap.name, &wrap.machine))
    }

    /// The control has coordinates of its own for some operations.
    pub fn has_modes(&self) -> bool {
        self.heads.iter().any(|head| head.machine.is_in_mode())
    }

    /// It is a machine in such coordinates.
    pub fn is_in_mode(&self) -> bool {
        self.face.is_some() || self.wrap.is_some()
    }

    /// Heads that the CL file can name.
    pub fn named_heads(&self) -> impl Iterator<Item = &Head> {
        self.heads.iter().filter(|head| !head.machine.is_in_mode())
    }

    /// The axis of that name, and the machine that has it: this one, or with one of its heads.
    pub fn with_axis(&self, name: &str) -> Option<(&Machine, &Axis)> {
        let heads = self.heads.iter().map(|head| &head.machine);
        [self].into_iter().chain(heads).find_map(|machine| {
            let axis = machine.axes.iter().find(|axis| axis.name == name)?;
            Some((machine, axis))
        })
    }

    /// Indexed axes that are not solved for: they stand where the program or the choice has put them.
    pub fn redundant(&self) -> Vec<usize> {
        let pointing = self.pointing();
        (0..self.axes.len())
            .filter(|place| self.axes[*place].indexed.is_some() && !pointing.contains(place))
            .collect()
    }

    /// Some rotary axis turns in a cut.
    pub fn turns(&self) -> bool {
        self.axes.iter().any(|axis| axis.joint.rotary && axis.indexed.is_none())
    }
}
