//! Where two bodies are not clear, and which of such places is the worst.

use nalgebra::Vector3;
use post_machine::kinematics::Joints;

/// What comes nearer by no more than this is no worse, mm.
const MICROMETRE: f64 = 1e-3;

/// What is not clear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The bodies overlap or touch at a pose that is known.
    Hits,
    /// They come nearer than is to be kept, at a pose that is known.
    Near,
    /// Neither is proven.
    Unproven,
    /// Neither is, and nowhere that was looked at are they too near: after [`MOST_PIECES`](super::MOST_PIECES) nothing more was looked at.
    Unfinished,
}

/// Where two bodies are not proven to be clear.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// What it is.
    pub verdict: Verdict,
    /// Line of the program.
    pub line: u64,
    /// Axis values, mm and radians.
    pub joints: Joints,
    /// They are no farther apart there, mm.
    pub at_most: f64,
    /// What is to be kept there, mm.
    pub keep: f64,
    /// The place on the first body, mm, frame of its link: nearest to the other, or in both.
    pub point: Vector3<f64>,
}

impl Fault {
    /// It is worse than another one: a hit than what comes near, by how near that is, what is not proven than where the work
    /// ran out.
    pub fn is_worse(&self, than: &Self) -> bool {
        let rank = |fault: &Self| match fault.verdict {
            Verdict::Hits => 3,
            Verdict::Near => 2,
            Verdict::Unproven => 1,
            Verdict::Unfinished => 0,
        };
        let (own, other) = (rank(self), rank(than));
        own > other || own == other && self.at_most < than.at_most - MICROMETRE
    }

    /// Puts it down in the place of what was known of the first and the worst.
    pub fn note(self, [first, worst]: [&mut Option<Self>; 2]) {
        if worst.as_ref().is_none_or(|known| self.is_worse(known)) {
            *worst = Some(self.clone());
        }
        first.get_or_insert(self);
    }
}
