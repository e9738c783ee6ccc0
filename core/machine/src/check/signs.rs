//! A table to stand beside the machine with: what is seen when an axis goes plus, and when it goes minus.
//!
//! Taken from the forward product with the axis moved, so what the file says of `reversed`, primes and the
//! order of the chain is in it. "Seen from the part" is what the CL file knows; what the eye sees is told
//! after it: a table moves against the tool.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector3;
use serde::Serialize;

use super::number;
use super::probe::{Probe, named, principal};
use crate::kinematics::orientation::angle;
use crate::kinematics::{Chain, Joint, MAX_AXES};

/// One axis moved in one direction, from where all axes stand at rest.
#[derive(Clone, Debug, Serialize)]
pub struct Sign {
    /// Address of the axis.
    pub axis: String,
    /// Change of the axis' reading, mm or degrees.
    pub by: f64,
    /// What the tool does, seen from the part.
    pub tool: String,
    /// What the eye sees: the table or the head.
    pub seen: String,
}

/// Moves of a linear axis in the table, mm.
const WAY: f64 = 100.0;

/// A rotary axis with less room than this is not told, radians.
const LEAST: f64 = 0.008;

/// The table in chain order, plus before minus.
pub(super) fn table(probe: &Probe<'_>) -> Vec<Sign> {
    let mut signs = Vec::new();
    for (place, axis) in probe.machine().axes.iter().enumerate() {
        for sense in [1.0, -1.0] {
            let room = if axis.joint.rotary {
                // An axis askew shows what it does after half a turn, the others after a quarter.
                let askew = principal(axis.joint.direction).is_none();
                room(probe, place, sense).min(if askew { PI } else { FRAC_PI_2 })
            } else {
                axis.travel.map_or(WAY, |[least, most]| (most - least).min(WAY))
            };
            if !axis.joint.rotary || room >= LEAST {
                signs.push(sign(probe, place, sense * room));
            }
        }
    }
    signs
}

/// How far an axis can go from rest, mm or radians; half a turn if it turns without end.
pub(super) fn room(probe: &Probe<'_>, place: usize, sense: f64) -> f64 {
    let home = probe.home()[place];
    match (probe.machine().axes[place].travel, sense > 0.0) {
        (None, _) => PI,
        (Some([_, most]), true) => most - home,
        (Some([least, _]), false) => home - least,
    }
}

/// What is seen when one axis moves by `by` (mm or radians, not 0) from rest.
pub(super) fn sign(probe: &Probe<'_>, place: usize, by: f64) -> Sign {
    if probe.machine().axes[place].joint.rotary {
        rotary(probe, place, by)
    } else {
        linear(probe, place, by)
    }
}

fn linear(probe: &Probe<'_>, place: usize, by: f64) -> Sign {
    let axis = &probe.machine().axes[place];
    let mut there = *probe.home();
    there[place] += by;
    let moved = probe.chain().forward(&there).tip - probe.chain().forward(probe.home()).tip;
    let tool = format!("moves {} mm to {}", number(moved.norm(), 3), named(moved.normalize()));
    let (body, way) = if axis.carries_part { ("table", -1.0) } else { ("head", 1.0) };
    let direction = in_bed(probe, place) * by.signum() * way;
    Sign {
        axis: axis.name.clone(),
        by,
        tool,
        seen: format!("the {body} moves to {}", named(direction)),
    }
}

fn rotary(probe: &Probe<'_>, place: usize, by: f64) -> Sign {
    let axis = &probe.machine().axes[place];
    let home = probe.home();
    // In the part frame: turned by what stands between the part and the axis.
    let direction = probe.turned(0..place, home, axis.joint.direction);
    let mut there = *home;
    there[place] += by;
    let [from, to] = [home, &there].map(|joints| probe.chain().forward(joints).axis);
    let tilts = angle(from, to) > 0.02;
    let tool = if tilts {
        format!("its axis goes {}", goes(from, to, direction, by))
    } else {
        let side = beside(direction);
        format!("goes round {}", goes(side, about(direction, by, side), direction, by))
    };
    let bed = in_bed(probe, place);
    let (body, turn) = if axis.carries_part { ("table", -by) } else { ("head", by) };
    // Seen from the plus side of the frame; an axis askew from its own upper end.
    let view = match principal(bed) {
        Some((index, _)) => Vector3::ith(index, 1.0),
        None if bed.z < 0.0 => -bed,
        None => bed,
    };
    let sense = if turn * bed.dot(&view) > 0.0 { "counter-clockwise" } else { "clockwise" };
    let mut seen = format!("the {body} turns {sense} seen from {}", named(view));
    if axis.carries_part {
        let side = beside(bed);
        seen.push_str(&format!(
            ", its {} side {}",
            named(side),
            where_to(side, about(bed, turn, side), bed, turn)
        ));
    } else if tilts {
        let count = probe.chain().joints().len();
        let carried = probe.machine().axes.iter().take_while(|axis| axis.carries_part).count();
        let tip = -probe.turned(carried..count, home, probe.chain().axis());
        seen.push_str(&format!(
            ", the tip swings {}",
            where_to(tip, about(bed, turn, tip), bed, turn)
        ));
    }
    Sign { axis: axis.name.clone(), by: by.to_degrees(), tool, seen }
}

/// The direction of an axis at rest, in the frame of the bed.
fn in_bed(probe: &Probe<'_>, place: usize) -> Vector3<f64> {
    let axes = &probe.machine().axes;
    let carried = axes.iter().take_while(|axis| axis.carries_part).count();
    let home = probe.home();
    let direction = axes[place].joint.direction;
    if place >= carried {
        return probe.turned(carried..place, home, direction);
    }
    // The axes between it and the bed turn the part, that is the other way; the nearest to the axis comes first.
    let mut direction = direction;
    for between in place + 1..carried {
        let mut back = *home;
        back[between] = -back[between];
        direction = probe.turned(between..between + 1, &back, direction);
    }
    direction
}

/// `vector` turned about `direction` by `by`, by the chain's own forward product.
fn about(direction: Vector3<f64>, by: f64, vector: Vector3<f64>) -> Vector3<f64> {
    let joint = Joint { rotary: true, direction, point: Vector3::zeros() };
    let mut angles = [0.0; MAX_AXES];
    angles[0] = by;
    Chain::new(vec![joint], Vector3::zeros(), Vector3::zeros(), vector).forward(&angles).axis
}

/// The first of +X, +Y, +Z that stands most nearly across `direction`.
fn beside(direction: Vector3<f64>) -> Vector3<f64> {
    let mut best = Vector3::x();
    for side in [Vector3::y(), Vector3::z()] {
        if direction.dot(&side).abs() < direction.dot(&best).abs() - 0.01 {
            best = side;
        }
    }
    best
}

fn goes(from: Vector3<f64>, to: Vector3<f64>, direction: Vector3<f64>, by: f64) -> String {
    format!("from {} {}", named(from), where_to(from, to, direction, by))
}

/// `to -Y` for a whole quarter or half turn, else `30° towards -Y`.
fn where_to(from: Vector3<f64>, to: Vector3<f64>, direction: Vector3<f64>, by: f64) -> String {
    let whole = [FRAC_PI_2, PI].iter().any(|turn| (by.abs() - turn).abs() < 1e-6);
    if whole {
        return format!("to {}", named(to));
    }
    let towards = direction.cross(&from) * by;
    match towards.try_normalize(1e-9) {
        Some(towards) => {
            format!("{}° towards {}", number(angle(from, to).to_degrees(), 3), named(towards))
        }
        None => format!("to {}", named(to)),
    }
}
