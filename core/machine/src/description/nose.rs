//! The nose of turning tools: which of its points the CL file names, and which the offsets in the control.

use nalgebra::Vector3;

use super::Axis;
use super::build::Builder;
use super::file::{ClFile, NosePoint};
use super::spindle::SpindleSpeeds;
use super::tools::ToolsFile;
use crate::word_map::WordMap;

/// Where the imaginary tip lies from the centre of the nose, in radii along the ways in which the words of X and Z count up, by the number of the quadrant
/// from 1: as Haas has it (lathe operator's manual, "Imaginary Tool Tip and Direction"), and Fanuc and Siemens.
const QUADRANTS: [[f64; 2]; 9] = [
    [1.0, 1.0],
    [1.0, -1.0],
    [-1.0, -1.0],
    [-1.0, 1.0],
    [0.0, 1.0],
    [1.0, 0.0],
    [0.0, -1.0],
    [-1.0, 0.0],
    [0.0, 0.0],
];

/// What leads from the point of a turning tool that the CL file names to that which its offsets in the control name.
#[derive(Clone, Debug, PartialEq)]
pub struct NoseRule {
    /// By the number of the tool, mm, part frame.
    shifts: Vec<(u32, Vector3<f64>)>,
}

impl NoseRule {
    /// What is added to the points of a tool, mm, part frame; none where its nose is not described.
    pub fn shift(&self, tool: u32) -> Option<Vector3<f64>> {
        let mut shifts = self.shifts.iter();
        shifts.find(|(number, _)| *number == tool).map(|(_, shift)| *shift)
    }

    /// What is wrong where the nose of a tool is not described: message and help.
    pub fn lack(tool: u32) -> [String; 2] {
        [
            format!(
                "the points of tool {tool} are not those of its offsets in the control ([cl] points), and nothing is said of its nose"
            ),
            format!(
                "[tools.{tool}] nose = 0.8 is its radius in mm, quadrant = 3 where its tip lies; nose = 0 for one without"
            ),
        ]
    }
}

impl Builder<'_> {
    /// What leads to the points that the control counts by, if they are not those of the CL file.
    pub(super) fn nose(
        &mut self,
        cl: &ClFile,
        tools: &ToolsFile,
        axes: &[Axis],
        word_map: Option<&WordMap>,
        spindle: &SpindleSpeeds,
    ) -> Option<NoseRule> {
        // The quadrants count as the words of X and Z do: a turret on the other side has its own.
        let counts = |name: &str, usual: Vector3<f64>| {
            let Some(place) = axes.iter().position(|axis| axis.name == name) else {
                return usual;
            };
            let factor = word_map.map_or(1.0, |map| map.factor(place));
            axes[place].joint.direction * factor.signum()
        };
        let [across, along] = [counts("X", Vector3::x()), counts("Z", Vector3::z())];
        let mut shifts = Vec::new();
        for (number, outline) in &tools.outlines {
            let radius = self.checked(&outline.get_ref().nose);
            let quadrant = outline.get_ref().quadrant.as_ref().map(|quadrant| *quadrant.get_ref());
            let place = match (radius, quadrant) {
                (None, None) => continue,
                (Some(0.0), None) => Some([0.0; 2]),
                (Some(_), Some(quadrant)) => (quadrant as usize)
                    .checked_sub(1)
                    .and_then(|place| QUADRANTS.get(place).copied()),
                _ => None,
            };
            let (Some([x, z]), Ok(number)) = (place, number.parse::<u32>()) else {
                let message = format!(
                    "tool {number} has a nose without its radius and its quadrant, which is a number from 1 to 9"
                );
                let help =
                    "nose = 0.8, quadrant = 3 for a tool that turns outside towards the chuck";
                self.fault("machine-tools", outline.span(), message, help);
                continue;
            };
            if cl.points.is_none() {
                let message = format!("tool {number} has a nose, and nothing is made of it");
                let help = "[cl] points = \"centre\" or \"tip\" says which of its points the CL file names, where the offsets in the control name the other";
                self.fault("machine-tools", outline.span(), message, help);
            }
            shifts.push((number, (across * x + along * z) * radius.unwrap_or(0.0)));
        }
        let points = cl.points.as_ref()?;
        if !spindle.surface_speed || axes.iter().any(|axis| axis.joint.rotary) {
            let message = "the CL file and the offsets in the control name two points of a nose, and this is no machine of linear axes whose spindle turns the part";
            let help = "leave [cl] points out, and let the CAM system write the points that the offsets name";
            self.fault("machine-tools", points.span(), message.to_owned(), help);
            return None;
        }
        if *points.get_ref() == NosePoint::Tip {
            shifts.iter_mut().for_each(|(_, shift)| *shift = -*shift);
        }
        Some(NoseRule { shifts })
    }
}
