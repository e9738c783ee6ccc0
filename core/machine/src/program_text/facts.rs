//! What a template can speak of.

use std::collections::BTreeMap;

use serde::Serialize;

/// All facts of a place in the program. What is not known is none: to print it is an error, `if` asks for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Facts {
    /// The program and the job.
    pub program: ProgramFacts,
    /// The tool that comes or is in the spindle; none before the first.
    pub tool: Option<ToolFacts>,
    /// The tool before it.
    pub last_tool: Option<ToolFacts>,
    /// Number of the tool behind it; none if it is the last, or nothing is known ahead.
    pub next_tool: Option<u32>,
    /// The operation that begins or ends; none outside of one.
    pub operation: Option<OperationFacts>,
    /// The spindle as the CL file last said; none where it stands still, or nothing was said.
    pub spindle: Option<SpindleFacts>,
    /// The coolant likewise: `flood`, `mist`, `through` or `air`; none where it is off.
    pub coolant: Option<String>,
    /// The work offset, from 1 (G54); none before the CL file names one.
    pub work_offset: Option<u32>,
    /// Cutter compensation; none where it is off.
    pub compensation: Option<CompensationFacts>,
    /// The tilted plane that comes or is in force; none without one.
    pub plane: Option<PlaneFacts>,
    /// Where the rotary axes turn to, by their names, degrees, as printed; none elsewhere.
    pub rotary: Option<BTreeMap<String, f64>>,
    /// By how much the control may leave the path from here on, mm; none if it may not.
    pub tolerance: Option<f64>,
    /// Of the tool axis, degrees.
    pub axis_tolerance: Option<f64>,
    /// Line of the CL file.
    pub line: u64,
}

/// The program and the job.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ProgramFacts {
    /// Its name: that of its file without the ending.
    pub name: String,
    /// The CL file, without its folder; empty if it has no name.
    pub cl_file: String,
    /// The machine.
    pub machine: String,
    /// The dialect.
    pub dialect: String,
    /// `mm` or `inch`.
    pub units: String,
    /// Certified deviation of the tip in a cut, at most, mm.
    pub tolerance: f64,
    /// Certified deviation of the tool axis, at most, degrees.
    pub axis_tolerance: f64,
    /// The tools in the order in which they are first used; none if nothing is known ahead.
    pub tools: Option<Vec<ToolFacts>>,
    /// Least and largest tip, mm, part frame, likewise.
    pub extents: Option<Extents>,
    /// Without tool changes, s, likewise.
    pub time: Option<f64>,
    /// The raw part, mm, part frame; none if neither machine file nor job says.
    pub stock: Option<Extents>,
}

/// A box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Extents {
    /// Least X, Y, Z.
    pub min: [f64; 3],
    /// Largest X, Y, Z.
    pub max: [f64; 3],
}

/// A tool.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ToolFacts {
    /// Its number.
    pub number: u32,
    /// Register of its length.
    pub register: u32,
    /// Its name, empty if not known.
    pub name: String,
    /// From the gauge point to the tip, mm.
    pub length: Option<f64>,
    /// Of the cutter, mm.
    pub diameter: Option<f64>,
    /// Of the cutter's corner, mm.
    pub corner_radius: Option<f64>,
    /// Revolutions a minute that the CL file first gives it; none if nothing is known ahead.
    pub speed: Option<f64>,
}

/// The spindle that turns.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SpindleFacts {
    /// Revolutions a minute; none at a constant cutting speed.
    pub speed: Option<f64>,
    /// Constant cutting speed, m/min, feet a minute in an inch program.
    pub surface_speed: Option<f64>,
    /// `cw` (M3) or `ccw` (M4).
    pub direction: String,
}

/// Cutter compensation.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CompensationFacts {
    /// `left` (G41) or `right` (G42).
    pub side: String,
    /// Register of the radius (D).
    pub register: u32,
}

/// A tilted plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PlaneFacts {
    /// Its angles as the control is told them, degrees; none where it takes the plane from the rotary axes.
    pub angles: Option<[f64; 3]>,
    /// Its origin, mm, part frame.
    pub origin: [f64; 3],
    /// Its normal, unit vector, part frame.
    pub normal: [f64; 3],
}

/// An operation.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OperationFacts {
    /// Its name in the CAM system.
    pub name: String,
    /// Counted from 1.
    pub number: u32,
    /// Largest feed a minute of its cuts, in units of the program; none if nothing is known ahead, or it has none.
    pub feed: Option<f64>,
}
