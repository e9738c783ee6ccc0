//! One machine: what its TOML file says, checked and in the core's own units (mm, radians, minutes).

mod build;
mod file;
mod layers;

use nalgebra::Vector3;

pub use build::load;
pub use file::{FeedLength, FeedMode, Insert, OutputUnits, Placement, Tcp, ToolLength};
pub use layers::Source;

use crate::diagnostic::Place;
use crate::kinematics::{Chain, Joint, Joints, NoClosedForm, Solver};

/// A machine.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Its name, as the file gives it.
    pub name: String,
    /// Its axes in chain order, from the workpiece to the tool.
    pub axes: Vec<Axis>,
    /// Where the part origin sits with all axes at zero, mm, machine frame.
    pub mount: Vector3<f64>,
    /// Gauge point of the tool holder with all axes at zero, mm, machine frame.
    pub gauge: Vector3<f64>,
    /// Tool axis with all axes at zero, unit vector from the tip to the holder, machine frame.
    pub tool_axis: Vector3<f64>,
    /// Tool lengths by tool number, mm, from the gauge point to the tip.
    pub tools: Vec<(u32, f64)>,
    /// Its control.
    pub control: Control,
    /// What it must keep.
    pub accuracy: Accuracy,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Its address, `X`, `C`.
    pub name: String,
    /// It carries the workpiece (primed in the chain), else the tool.
    pub carries_part: bool,
    /// Kind, direction and line.
    pub joint: Joint,
    /// Least and largest value, mm or radians; none for a cyclic axis.
    pub travel: Option<[f64; 2]>,
    /// It does not move in a cut: it stands at this value, radians.
    pub indexed: Option<f64>,
    /// Largest feed, mm/min or rad/min; infinite if the file does not say.
    pub max_feed: f64,
}

/// The control of a machine.
#[derive(Clone, Debug)]
pub struct Control {
    /// Name of the dialect.
    pub dialect: String,
    /// Where the file names it.
    pub dialect_place: Option<Place>,
    /// Options for the dialect, as the file gives them, each with its place.
    pub options: Vec<GivenOption>,
    /// Who keeps the tip on its path.
    pub tcp: Tcp,
    /// Units of the NC program.
    pub units: OutputUnits,
    /// How feeds are written.
    pub feed: FeedMode,
    /// What a feed a minute is meant along.
    pub feed_length: FeedLength,
    /// Which tool length counts.
    pub tool_length: ToolLength,
    /// What becomes of `INSERT`.
    pub insert: Insert,
}

/// An option for a plugin.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenOption {
    /// Its key.
    pub key: String,
    /// Its value.
    pub value: OptionValue,
    /// Where it stands.
    pub place: Option<Place>,
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
    /// Text.
    Text(String),
}

/// Tolerances and how they are kept.
#[derive(Clone, Debug)]
pub struct Accuracy {
    /// Name of the error model.
    pub model: String,
    /// Where the file names it.
    pub model_place: Option<Place>,
    /// Options for the model.
    pub options: Vec<GivenOption>,
    /// Where points are put in.
    pub placement: Placement,
    /// Largest deviation of the tip in a cut, mm.
    pub tolerance: f64,
    /// Largest deviation of the tool axis in a cut, radians.
    pub axis_tolerance: f64,
    /// Largest deviation of the tip in a rapid, mm.
    pub rapid_tolerance: f64,
}

impl Machine {
    /// The machine with a tool of `length` mm in it, ready to be solved.
    ///
    /// # Errors
    /// What its chain lacks.
    pub fn solver(&self, length: f64) -> Result<Solver, NoClosedForm> {
        let joints = self.axes.iter().map(|axis| axis.joint).collect();
        let tip = self.gauge - self.tool_axis * length;
        let chain = Chain::new(joints, self.mount, tip, self.tool_axis);
        let mut held: Joints = Default::default();
        let mut free = Vec::new();
        for (index, axis) in self.axes.iter().enumerate() {
            match axis.indexed {
                Some(value) => held[index] = value,
                None if axis.joint.rotary => free.push(index),
                None => {}
            }
        }
        Solver::new(chain, &free, held)
    }

    /// Some rotary axis turns in a cut.
    pub fn turns(&self) -> bool {
        self.axes
            .iter()
            .any(|axis| axis.joint.rotary && axis.indexed.is_none())
    }
}
