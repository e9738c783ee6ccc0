//! What stands in the control and not in the program: work offsets and tool lengths.

mod file;

use post_machine::kinematics::Joints;

/// What stands in the control's tables.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Offsets {
    /// Work offsets by name.
    pub work: Vec<WorkOffset>,
    /// Length, mm, by register: H, or the D of a tool where the control counts so.
    pub lengths: Vec<(u32, f64)>,
    /// Radius, mm, by register.
    pub radii: Vec<(u32, f64)>,
    /// Length, mm, by tool number: for controls whose tool call takes it from the tool's own table.
    pub tools: Vec<(u32, f64)>,
    /// Length of any tool that is named nowhere, mm.
    pub length: Option<f64>,
    /// Reference positions.
    pub references: Vec<Reference>,
}

/// A work offset.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorkOffset {
    /// As the program writes it: `G54`, `G54.1 P3`.
    pub name: String,
    /// Where the program's zero is against the part origin of the machine file, mm, in the directions of the linear axes,
    /// and what a rotary axis shows there, radians; by place in the chain.
    pub shift: Joints,
}

/// Where an axis has its reference position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// 1: that of G28; 2: that of G30.
    pub which: u8,
    /// The axis.
    pub axis: String,
    /// What the control shows there, mm or radians.
    pub value: f64,
}
