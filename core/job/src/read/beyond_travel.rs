//! Axes that a program takes beyond their travel or their largest feed, and limits between axes that it passes.

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_readback::BlockEffect;
use post_readback::verify::{AxisFault, AxisLimitCheck, LimitCheck, PassedLimit};

/// What messages call an axis beyond its travel.
const OVER_TRAVEL: &str = "over-travel";

/// Of each end of each axis, and of each limit that depends on other axes, the farthest.
#[derive(Debug)]
pub struct BeyondTravel {
    found: Vec<Beyond>,
    axes: AxisLimitCheck,
    /// What must hold between the axes.
    limits: LimitCheck,
}

/// An axis beyond one end, or a limit that depends on other axes.
#[derive(Debug)]
struct Beyond {
    code: &'static str,
    axis: String,
    message: String,
    by: f64,
    line: u64,
    count: u64,
}

impl BeyondTravel {
    /// Of a program on `machine`.
    pub fn new(machine: &Machine) -> Self {
        let axes = AxisLimitCheck::new(machine);
        Self { found: Vec::new(), axes, limits: LimitCheck::default() }
    }

    /// Takes what a program did.
    pub fn take(&mut self, machine: &Machine, done: &BlockEffect) {
        let BlockEffect::Motion(motion) = done else {
            return;
        };
        let line = motion.line;
        if let Some(PassedLimit { message, by, limit }) = self.limits.passed(machine, motion) {
            let axis = format!("[[limit]] {limit}");
            self.keep(Beyond { code: OVER_TRAVEL, axis, message, by, line, count: 1 });
        }
        for AxisFault { code, message, by } in
            self.axes.passed(machine, motion).into_iter().flatten()
        {
            let axis = message.split(' ').next().unwrap_or_default().to_owned();
            self.keep(Beyond { code, axis, message, by, line, count: 1 });
        }
    }

    fn keep(&mut self, beyond: Beyond) {
        let same = |found: &&mut Beyond| found.axis == beyond.axis && found.code == beyond.code;
        match self.found.iter_mut().find(same) {
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

    /// What is wrong with the program `name`: errors, of feeds warnings, as the control goes no faster than it can.
    pub fn findings(&self, name: &str) -> impl Iterator<Item = Diagnostic> {
        self.found.iter().map(move |found| {
            let mut message = found.message.clone();
            if found.count > 1 {
                message.push_str(&format!("; so in {} motions", found.count));
            }
            let place = SourcePlace::new(name, found.line, "", 0..0);
            let finding = match found.code == OVER_TRAVEL {
                true => Diagnostic::error(found.code, message),
                false => Diagnostic::warning(found.code, message),
            };
            finding.at(Some(place))
        })
    }

    /// What is to be said of travel where the part may sit anywhere.
    pub fn part_place(&self, machine: &Machine, name: &str) -> Option<Diagnostic> {
        let (line, finding) = self.axes.part_place(machine)?;
        Some(finding.at((line > 0).then(|| SourcePlace::new(name, line, "", 0..0))))
    }
}
