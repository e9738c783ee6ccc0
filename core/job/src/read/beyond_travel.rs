//! Axes that a program takes beyond their travel, and limits between axes that it passes.

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_readback::BlockEffect;
use post_readback::verify::{LimitCheck, PassedLimit, over_travel};

/// Of each end of each axis, and of each limit that depends on other axes, the farthest.
#[derive(Debug, Default)]
pub struct BeyondTravel {
    found: Vec<Beyond>,
    /// What must hold between the axes.
    limits: LimitCheck,
}

/// An axis beyond one end, or a limit that depends on other axes.
#[derive(Debug)]
struct Beyond {
    axis: String,
    message: String,
    by: f64,
    line: u64,
    count: u64,
}

impl BeyondTravel {
    /// Takes what a program did.
    pub fn take(&mut self, machine: &Machine, done: &BlockEffect) {
        let BlockEffect::Motion(motion) = done else {
            return;
        };
        if let Some(PassedLimit { message, by, limit }) = self.limits.passed(machine, motion) {
            let axis = format!("[[limit]] {limit}");
            self.keep(Beyond { axis, message, by, line: motion.line, count: 1 });
        }
        if let Some((message, by)) = over_travel(machine, motion) {
            let axis = message.split(' ').next().unwrap_or_default().to_owned();
            self.keep(Beyond { axis, message, by, line: motion.line, count: 1 });
        }
    }

    fn keep(&mut self, beyond: Beyond) {
        match self.found.iter_mut().find(|found| found.axis == beyond.axis) {
            None => self.found.push(beyond),
            Some(found) => {
                let count = found.count + 1;
                if beyond.by > found.by {
                    *found = beyond;
                }
                found.count = count;
            }
        }
    }

    /// What is wrong with the program `name`.
    pub fn findings(&self, name: &str) -> impl Iterator<Item = Diagnostic> {
        self.found.iter().map(move |found| {
            let mut message = found.message.clone();
            if found.count > 1 {
                message.push_str(&format!("; so in {} motions", found.count));
            }
            let place = SourcePlace::new(name, found.line, "", 0..0);
            Diagnostic::error("over-travel", message).at(Some(place))
        })
    }
}
