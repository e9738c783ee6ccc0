//! Between two cuts: rapids that go where neither the course nor the machine file leads.

use std::f64::consts::TAU;

use post_machine::axis_words::is_depth;
use post_machine::description::Machine;
use post_machine::kinematics::{Joints, Pose};

use crate::Motion;

/// So many ends of rapids are remembered between two cuts, and as many places that are asked for.
const MOST: usize = 64;

/// A tool that leans by less than this, radians, is on the same line.
const SAME_LINE: f64 = 1e-3;

/// Where a tool goes between two cuts: to the places that are asked for, and on the line of the tool at one of them as
/// far off as it likes. Anywhere else each axis that it moves stands between where it stands at those places, or where
/// the machine file sends it (`retract`, `change`, `park`); the depth may be drawn back farther than at all of them. A retract in
/// positions of the machine leads as far as the machine file says.
#[derive(Debug, Default)]
pub(super) struct Detour {
    asked: Vec<(Joints, Pose)>,
    /// Places of the course that were passed on the way to others.
    passed: Vec<Pose>,
    open: Vec<End>,
}

/// Where a rapid ends that nothing asks for.
#[derive(Clone, Copy, Debug)]
struct End {
    line: u64,
    number: Option<u64>,
    from: Joints,
    joints: Joints,
    pose: Pose,
    machine: bool,
}

/// A rapid that went astray.
#[derive(Debug)]
pub(super) struct Astray {
    pub line: u64,
    pub number: Option<u64>,
    /// The axis, and how far it is from all where it could stand, mm or degrees.
    pub axis: usize,
    pub by: f64,
    /// It is a retract that is too short.
    pub short: bool,
}

impl Detour {
    /// A rapid ended; `asked` if the course leads there too, `known` if it does where the rapid began.
    pub fn take(&mut self, motion: &Motion, asked: bool, known: bool) {
        if known && self.asked.is_empty() {
            self.ask(&motion.from.joints, &motion.from.pose);
        }
        if asked {
            self.ask(&motion.to.joints, &motion.to.pose);
        } else if self.open.len() < MOST {
            self.open.push(End {
                line: motion.line,
                number: motion.number,
                from: motion.from.joints,
                joints: motion.to.joints,
                pose: motion.to.pose,
                machine: motion.machine,
            });
        }
    }

    /// A rapid passed a place of the course: another may end there.
    pub fn passes(&mut self, pose: Pose) {
        if self.passed.len() < MOST {
            self.passed.push(pose);
        }
    }

    /// A cut begins with `motion`, or the program ends: was there a rapid that went farther than `slack` (mm, radians) from
    /// all that is asked for, the tool leaning otherwise by `lean` at most? The first.
    pub fn end(
        &mut self,
        machine: &Machine,
        motion: Option<&Motion>,
        slack: [f64; 2],
        lean: f64,
    ) -> Option<Astray> {
        if let Some(motion) = motion {
            self.ask(&motion.from.joints, &motion.from.pose);
        }
        let asked = std::mem::take(&mut self.asked);
        let open = std::mem::take(&mut self.open);
        let passed = std::mem::take(&mut self.passed);
        if asked.is_empty() {
            return None;
        }
        let lean = lean + SAME_LINE;
        let mut open = open.iter().filter(|end| {
            let mut passed = passed.iter();
            end.machine || !passed.any(|pose| end.on_the_line(pose, slack[0], lean))
        });
        open.find_map(|end| end.astray(machine, &asked, slack, lean))
    }

    fn ask(&mut self, joints: &Joints, pose: &Pose) {
        if self.asked.len() == MOST {
            self.asked.remove(0);
        }
        self.asked.push((*joints, *pose));
    }
}

impl End {
    /// The axis that is farthest from where it could stand.
    fn astray(
        &self,
        machine: &Machine,
        asked: &[(Joints, Pose)],
        slack: [f64; 2],
        lean: f64,
    ) -> Option<Astray> {
        if !self.machine
            && asked
                .iter()
                .any(|(_, pose)| self.on_the_line(pose, slack[0], lean))
        {
            return None;
        }
        let turns = |place: usize| {
            let turned = libm::fabs(self.joints[place] - self.from[place]);
            machine.axes[place].joint.rotary && turned > slack[1]
        };
        if !self.machine && (0..machine.axes.len()).any(turns) {
            // While the part turns or the head swings, the linear axes go round with it.
            return None;
        }
        let mut worst: Option<(f64, Astray)> = None;
        for (place, axis) in machine.axes.iter().enumerate() {
            let rotary = axis.joint.rotary;
            let slack = slack[usize::from(rotary)];
            let value = self.joints[place];
            // What stands is led nowhere.
            if libm::fabs(value - self.from[place]) <= slack {
                continue;
            }
            let (mut by, mut short) = (f64::INFINITY, false);
            let mut allow = |other: f64| {
                let mut apart = value - other;
                if rotary {
                    apart -= TAU * libm::rint(apart / TAU);
                }
                by = by.min(libm::fabs(apart));
            };
            asked.iter().for_each(|(joints, _)| allow(joints[place]));
            let [least, most] = span(asked, place);
            allow(value.clamp(least, most.max(least)));
            let frame = &machine.frame;
            let named = [&frame.retract, &frame.aside, &frame.change, &frame.park];
            for (other, value) in named.into_iter().flatten() {
                if *other == place {
                    allow(*value);
                }
            }
            if is_depth(machine, place) {
                let away = axis.joint.direction.dot(&machine.tool_axis).signum();
                let retract = frame.retract.iter().find(|(other, _)| *other == place);
                let least = match retract {
                    Some((_, retract)) if self.machine => {
                        short = true;
                        away * retract
                    }
                    _ => {
                        let asked = asked.iter().map(|(joints, _)| away * joints[place]);
                        asked.fold(f64::INFINITY, f64::min)
                    }
                };
                by = by.min((least - away * value).max(0.0));
            }
            if by > slack && worst.as_ref().is_none_or(|(most, _)| by / slack > *most) {
                let astray = Astray {
                    line: self.line,
                    number: self.number,
                    axis: place,
                    by: by / axis.unit(),
                    short,
                };
                worst = Some((by / slack, astray));
            }
        }
        worst.map(|(_, astray)| astray)
    }

    /// The tool stands on its own line through a place, at it or farther off.
    fn on_the_line(&self, asked: &Pose, slack: f64, lean: f64) -> bool {
        let way = self.pose.tip - asked.tip;
        let along = way.dot(&asked.axis);
        (self.pose.axis - asked.axis).norm() <= lean
            && along >= -slack
            && (way - asked.axis * along).norm() <= slack + lean * along
    }
}

/// The least and the largest value of an axis at all places that are asked for.
fn span(asked: &[(Joints, Pose)], place: usize) -> [f64; 2] {
    let values = asked.iter().map(|(joints, _)| joints[place]);
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(ends, |[least, most], value| {
        [least.min(value), most.max(value)]
    })
}
