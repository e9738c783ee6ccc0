//! Between two cuts: rapids that go where neither of them, nor any point of the course, leads.

use nalgebra::Vector3;
use post_machine::axis_words::is_depth;
use post_machine::description::Machine;
use post_machine::kinematics::{Joints, Pose};

use crate::Motion;

/// So many ends of rapids are remembered between two cuts.
const MOST: usize = 64;

/// Where a tool goes between two cuts. It may draw back and come down along its depth or its own axis as far as it likes;
/// across, all that it passes lies between the places that are asked for, in the machine's axes or against the part. Where
/// rotary axes turn between the two cuts nothing is said: how it goes round then is the machine's business.
#[derive(Debug, Default)]
pub(super) struct Detour {
    asked: Option<Reach>,
    open: Vec<End>,
}

/// Least and largest values of what is asked for.
#[derive(Clone, Copy, Debug)]
struct Reach {
    joints: [Joints; 2],
    tips: [Vector3<f64>; 2],
}

/// Where a rapid ends that nothing asks for.
#[derive(Clone, Copy, Debug)]
struct End {
    line: u64,
    number: Option<u64>,
    joints: Joints,
    pose: Pose,
}

/// A rapid that went astray.
#[derive(Debug)]
pub(super) struct Astray {
    pub line: u64,
    pub number: Option<u64>,
    /// The axis and how far it is beyond, mm or degrees.
    pub axis: usize,
    pub by: f64,
}

impl Detour {
    /// A rapid ended; `asked` if the course leads there too.
    pub fn take(&mut self, motion: &Motion, asked: bool) {
        if self.asked.is_none() {
            self.ask(&motion.from.joints, &motion.from.pose);
        }
        if asked {
            self.ask(&motion.to.joints, &motion.to.pose);
        } else if !motion.machine && self.open.len() < MOST {
            self.open.push(End {
                line: motion.line,
                number: motion.number,
                joints: motion.to.joints,
                pose: motion.to.pose,
            });
        }
    }

    /// A cut begins: was there a rapid that went farther than `slack` (mm, radians) beyond what is asked for? The first.
    pub fn cut(&mut self, machine: &Machine, motion: &Motion, slack: [f64; 2]) -> Option<Astray> {
        if self.asked.is_some() {
            self.ask(&motion.from.joints, &motion.from.pose);
        }
        let asked = self.asked.take();
        let mut open = self.open.drain(..);
        let asked = asked?;
        open.find_map(|end| asked.beyond(machine, &end, slack))
    }

    fn ask(&mut self, joints: &Joints, pose: &Pose) {
        let reach = self.asked.get_or_insert(Reach {
            joints: [*joints; 2],
            tips: [pose.tip; 2],
        });
        for (place, value) in joints.iter().enumerate() {
            reach.joints[0][place] = reach.joints[0][place].min(*value);
            reach.joints[1][place] = reach.joints[1][place].max(*value);
        }
        reach.tips = [reach.tips[0].inf(&pose.tip), reach.tips[1].sup(&pose.tip)];
    }
}

impl Reach {
    fn beyond(&self, machine: &Machine, end: &End, slack: [f64; 2]) -> Option<Astray> {
        let tip = end.pose.tip;
        let out = tip - tip.sup(&self.tips[0]).inf(&self.tips[1]);
        let across = out - end.pose.axis * out.dot(&end.pose.axis);
        if across.norm() <= slack[0] {
            return None;
        }
        // While the part turns or the head swings, the linear axes go round with it.
        let turning = |place: usize| {
            let asked = self.joints[1][place] - self.joints[0][place];
            machine.axes[place].joint.rotary && asked > slack[1]
        };
        if (0..machine.axes.len()).any(turning) {
            return None;
        }
        let mut worst: Option<(f64, usize)> = None;
        for (place, axis) in machine.axes.iter().enumerate() {
            if is_depth(machine, place) {
                continue;
            }
            let value = end.joints[place];
            let by = (self.joints[0][place] - value).max(value - self.joints[1][place]);
            let share = by / slack[usize::from(axis.joint.rotary)];
            if share > worst.map_or(1.0, |(most, _)| most) {
                worst = Some((share, place));
            }
        }
        let (share, axis) = worst?;
        let rotary = machine.axes[axis].joint.rotary;
        Some(Astray {
            line: end.line,
            number: end.number,
            axis,
            by: share * slack[usize::from(rotary)] / machine.axes[axis].unit(),
        })
    }
}
