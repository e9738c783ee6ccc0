//! Travel of a mill whose part sits where nobody says: any place within the travel will do, so that the way of a whole
//! program is held against it, not each point.

use crate::description::Machine;
use crate::diagnostic::Diagnostic;
use crate::kinematics::{Joints, MAX_AXES};

/// Ways that are longer than the travel by less are none, mm.
const ROUNDED: f64 = 1e-6;

/// What would help.
pub const HELP: &str = "--mount says where the part sits, --tool-length or a file of tools (--tools) how long tools are: travel is checked by that";

/// Least and largest position of each axis over a program, mm or radians, and the lines that lead to them.
#[derive(Clone, Debug)]
pub struct AxisEnds {
    least: Joints,
    most: Joints,
    lines: [[u64; 2]; MAX_AXES],
}

impl AxisEnds {
    /// Before any motion.
    pub const NONE: Self = Self {
        least: [f64::INFINITY; MAX_AXES],
        most: [f64::NEG_INFINITY; MAX_AXES],
        lines: [[0; 2]; MAX_AXES],
    };

    /// An axis goes from `least` to `most`; `line` tells which line leads it to one of them.
    #[inline]
    pub fn take(&mut self, joint: usize, [least, most]: [f64; 2], line: impl Fn(f64) -> u64) {
        if least < self.least[joint] {
            (self.least[joint], self.lines[joint][0]) = (least, line(least));
        }
        if most > self.most[joint] {
            (self.most[joint], self.lines[joint][1]) = (most, line(most));
        }
    }

    /// Takes the ways of one axis of others.
    pub fn join(&mut self, joint: usize, other: &Self) {
        if let Some([least, most]) = other.of(joint) {
            let [first, last] = other.lines(joint);
            self.take(joint, [least, least], |_| first);
            self.take(joint, [most, most], |_| last);
        }
    }

    /// Least and largest position of an axis; none if it was led nowhere.
    pub fn of(&self, joint: usize) -> Option<[f64; 2]> {
        let ends = [self.least[joint], self.most[joint]];
        (ends[0] <= ends[1]).then_some(ends)
    }

    /// The lines that lead to them.
    pub fn lines(&self, joint: usize) -> [u64; 2] {
        self.lines[joint]
    }
}

/// Says how much travel a program needs where nobody says where the part sits, nor what `besides` adds.
pub fn needed(outside: &[String], besides: &str) -> Diagnostic {
    let message = format!(
        "nobody says where the part sits{besides}; this much travel the program needs: {}",
        outside.join("; ")
    );
    Diagnostic::warning("part-place", message).help(HELP)
}

/// The way of an axis over a program, the part where the machine file has it.
#[derive(Clone, Copy, Debug)]
pub struct AxisWay<'a> {
    /// The axis.
    pub name: &'a str,
    /// Least and largest position, mm.
    pub ends: [f64; 2],
    /// Its travel, mm; none if it has no ends.
    pub travel: Option<[f64; 2]>,
}

impl AxisWay<'_> {
    /// The program goes farther than the axis, wherever the part sits.
    pub fn is_too_long(&self) -> bool {
        let [min, max] = self.ends;
        self.travel.is_some_and(|[least, most]| max - min > most - least + ROUNDED)
    }

    /// Says so, with the lines that lead to the two ends.
    pub fn too_long(&self, lines: [&str; 2]) -> Diagnostic {
        let ([min, max], [least, most]) = (self.ends, self.travel.unwrap_or_default());
        let [first, last] = lines;
        let message = format!(
            "{} goes {:.3} mm, from {min:.3} (line {first}) to {max:.3} mm (line {last}), and its travel is {:.3} mm: the part fits nowhere on this machine",
            self.name,
            max - min,
            most - least
        );
        Diagnostic::error("over-travel", message)
            .help("another machine, two set-ups, or other units of the file, if these are wrong")
    }

    /// How far an axis goes past its travel, and where the part origin must sit instead; none if it stays inside.
    pub fn outside(&self, machine: &Machine) -> Option<String> {
        let ([min, max], [least, most]) = (self.ends, self.travel?);
        if min >= least && max <= most {
            return None;
        }
        let joint = machine.axes.iter().find(|other| other.name == self.name)?.joint;
        // The way of the axis along which the part origin moves with it.
        let along = (0..3).find(|part| libm::fabs(joint.direction[*part]) > 1.0 - 1e-9)?;
        let [mount, sense] = [machine.mount[along], joint.direction[along]];
        let ends = [least - min, most - max].map(|by| mount + sense * by);
        let [first, last] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        Some(format!(
            "{} {min:.3} to {max:.3} mm of {least:.3} to {most:.3} with the part origin at {mount:.3}, inside with it from {first:.3} to {last:.3}",
            self.name
        ))
    }
}
