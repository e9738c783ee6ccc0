//! In which ways the tool can be pointed: one direction written out, and the directions without a single way.

use nalgebra::Vector3;
use serde::Serialize;

use super::probe::Probe;
use crate::kinematics::orientation::angle;
use crate::kinematics::{Joints, Unreachable};

/// All solutions for one direction.
#[derive(Clone, Debug, Serialize)]
pub struct DirectionSolutions {
    /// Tool axis, part frame.
    pub axis: [f64; 3],
    /// Tilt from +Z, degrees.
    pub tilt_deg: f64,
    /// Azimuth from +X towards +Y, degrees.
    pub azimuth_deg: f64,
    /// Ways, full turns left aside.
    pub ways: Vec<WayOfPointing>,
    /// Solutions inside travel and at positions of index axes, full turns counted.
    pub inside: usize,
    /// Set where the ways were searched: there may be more.
    pub at_least: bool,
}

/// Ways that are shown where there is no end of them.
const MOST_SHOWN: usize = 8;

/// One way to point the tool along a direction.
#[derive(Clone, Debug, Serialize)]
pub struct WayOfPointing {
    /// What the control shows of the free rotary axes, nearest to rest.
    pub readings: Vec<AxisReadout>,
    /// How many full turns of it lie inside travel; 0: it is out of travel.
    pub turns: usize,
    /// Index axes have positions there.
    pub has_positions: bool,
}

/// What the control shows of an axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisReadout {
    /// Address of the axis.
    pub axis: String,
    /// mm or degrees.
    pub value: f64,
}

/// A direction for a look at the solutions: tilted 20° towards azimuth 30°, or, if the machine does not reach
/// it, one that it makes a third into the travel of its rotary axes.
pub(super) fn typical(probe: &Probe<'_>) -> Option<DirectionSolutions> {
    if probe.freedom() == 0 {
        return None;
    }
    let tilted = direction(20f64.to_radians(), 30f64.to_radians());
    let axis = if probe.makes(tilted) {
        tilted
    } else {
        let mut joints = *probe.home();
        for place in probe.free() {
            let [least, most] = probe.span(place);
            joints[place] = least + (most - least) / 3.0;
        }
        probe.chain().forward(&joints).axis
    };
    let mut found = probe.inverse(Vector3::zeros(), axis).ok()?;
    let at_least = !probe.closed_form();
    if at_least {
        // Of a machine with an axis to spare there is no end of them.
        found.sort_by_key(|joints| probe.turns(joints) == 0);
        found.truncate(MOST_SHOWN);
    }
    let ways: Vec<WayOfPointing> = found
        .iter()
        .map(|joints| WayOfPointing {
            readings: readings(probe, &probe.inside(joints).unwrap_or(*joints)),
            turns: probe.turns(joints),
            has_positions: probe.has_positions(&probe.free(), joints),
        })
        .collect();
    Some(DirectionSolutions {
        axis: axis.into(),
        tilt_deg: angle(axis, Vector3::z()).to_degrees(),
        azimuth_deg: libm::atan2(axis.y, axis.x).to_degrees(),
        inside: ways.iter().filter(|way| way.has_positions).map(|way| way.turns).sum(),
        ways,
        at_least,
    })
}

/// The unit vector with this tilt from +Z and this azimuth from +X towards +Y, radians.
pub(super) fn direction(tilt: f64, azimuth: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(tilt);
    let (across, along) = libm::sincos(azimuth);
    Vector3::new(sine * along, sine * across, cosine)
}

/// What the control shows of the free rotary axes.
fn readings(probe: &Probe<'_>, joints: &Joints) -> Vec<AxisReadout> {
    let reading = |place: usize| {
        let axis = &probe.machine().axes[place];
        AxisReadout { axis: axis.name.clone(), value: axis.reading(joints[place]) }
    };
    probe.free().into_iter().map(reading).collect()
}

/// Directions that can be made in no single way.
#[derive(Clone, Debug, Serialize)]
pub struct Poles {
    /// What holds for this machine, as a sentence.
    pub told: String,
    /// The directions, reachable ones first.
    pub at: Vec<Pole>,
}

/// A direction along the first rotary axis: that axis may stand anywhere there, and close to it it turns far
/// for a small tilt.
#[derive(Clone, Debug, Serialize)]
pub struct Pole {
    /// Tool axis, part frame.
    pub axis: [f64; 3],
    /// The axis that may stand anywhere.
    pub free: String,
    /// Inside the travel of the rotary axes.
    pub inside: bool,
    /// The other index axes have positions there.
    pub has_positions: bool,
    /// The directions that miss it by so much are the nearest that can be made, degrees; 0 if it can be met.
    pub missed_by_deg: f64,
    /// What the control shows of the others there, nearest to rest.
    pub others: Vec<AxisReadout>,
}

impl Poles {
    pub(super) fn of(probe: &Probe<'_>) -> Self {
        let free = probe.free();
        let told = |told: &str| Self { told: told.to_owned(), at: Vec::new() };
        match (probe.freedom(), free.len()) {
            (0, 1) if probe.solver().planar() => {
                let name = &probe.machine().axes[free[0]].name;
                return told(&format!("the tip on the line of {name}: {name} may stand anywhere"));
            }
            (0, _) => return told("none: no rotary axis turns the tool in a cut"),
            (1, _) => {
                return told("none: one rotary axis turns the tool, so each direction fixes it");
            }
            (_, 2) => {}
            (_, 3) if probe.machine().edge.is_some() => {}
            _ if probe.solver().has_arm() => {
                return told(
                    "not listed: the wrist straight, the arm stretched or folded, the wrist over the first axis; they are met as they come, and the point before decides",
                );
            }
            _ if !probe.closed_form() => {
                return told(
                    "not known: without a closed form they are met as they come, and the point before decides",
                );
            }
            _ => {
                return told(
                    "more rotary axes than a direction needs: each direction can be made in many ways, and the rule of the machine file decides",
                );
            }
        }
        let first = free[0];
        let along = probe.turned(0..first, probe.home(), probe.chain().joints()[first].direction);
        let mut at: Vec<Pole> =
            [along, -along].into_iter().map(|axis| pole(probe, axis, &free)).collect();
        at.sort_by_key(|pole| (!pole.inside, pole.missed_by_deg > 0.0));
        Self {
            told: format!(
                "the tool axis along {}: {} may stand anywhere",
                probe.machine().axes[first].name,
                probe.machine().axes[first].name
            ),
            at,
        }
    }
}

fn pole(probe: &Probe<'_>, axis: Vector3<f64>, free: &[usize]) -> Pole {
    let name = probe.machine().axes[free[0]].name.clone();
    let (found, miss) = match probe.inverse(Vector3::zeros(), axis) {
        Ok(found) => (found, 0.0),
        Err(Unreachable::Axis { miss }) => (Vec::new(), miss),
        Err(_) => (Vec::new(), 0.0),
    };
    let inside = found.iter().find_map(|joints| probe.inside(joints));
    let shown = inside.or(found.first().copied());
    let others = shown.map_or_else(Vec::new, |joints| readings(probe, &joints).split_off(1));
    Pole {
        axis: axis.into(),
        free: name,
        inside: inside.is_some(),
        has_positions: shown.is_none_or(|joints| probe.has_positions(&free[1..], &joints)),
        missed_by_deg: miss.to_degrees(),
        others,
    }
}
