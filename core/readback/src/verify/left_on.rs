//! What still runs where a tool is changed, or where the program ends.

use super::Verifier;
use super::report::BlockPlace;
use super::state::{coolant_name, spindle_name};
use super::track::Element;
use crate::course::Course;
use crate::{Coolants, Motion, ProgramEvent, SpindleState};

/// What of the program runs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunningFunctions {
    tool: Option<u32>,
    spindle: SpindleState,
    coolants: Coolants,
    /// Lines at which the spindle and the coolants were told last.
    lines: [u64; 2],
    /// What ran as the tool came; until it is held against the course.
    change: Option<RunningChange>,
}

/// A tool change with something still on.
#[derive(Clone, Copy, Debug)]
struct RunningChange {
    line: u64,
    tool: Option<u32>,
    spindle: SpindleState,
    coolants: Coolants,
}

impl RunningFunctions {
    /// A tool was changed with something on, and that was not held against the course yet.
    pub(super) fn changes(&self) -> bool {
        self.change.is_some()
    }
}

impl RunningChange {
    /// What runs and should not, each with its code.
    fn faults(
        &self,
        spindle: bool,
        coolants: bool,
    ) -> impl Iterator<Item = (&'static str, String)> {
        let turns = (spindle && turns(self.spindle)).then(|| {
            let name = spindle_name(self.spindle);
            ("spindle", format!("the tool is changed while the spindle {name}"))
        });
        let flows = (coolants && self.coolants != Coolants::default()).then(|| {
            let name = coolant_name(self.coolants);
            ("coolant", format!("the tool is changed under {name}"))
        });
        turns.into_iter().chain(flows)
    }
}

/// What the course has off at a tool change, and the line of the CL file that says so.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SwitchedOff {
    spindle: bool,
    coolants: bool,
    line: u64,
}

/// A spindle that turns its tool.
fn turns(spindle: SpindleState) -> bool {
    matches!(spindle, SpindleState::Clockwise(_) | SpindleState::CounterClockwise(_))
}

impl<C: Course> Verifier<'_, C> {
    /// The program tells of its spindle, its coolants or a tool.
    pub(super) fn runs(&mut self, line: u64, event: &ProgramEvent) {
        let running = &mut self.running;
        match event {
            ProgramEvent::Spindle(spindle) => {
                (running.spindle, running.lines[0]) = (*spindle, line)
            }
            ProgramEvent::Coolant(coolants) if self.rules.coolants => {
                (running.coolants, running.lines[1]) = (*coolants, line)
            }
            // The end of a program stops both.
            ProgramEvent::End => (running.spindle, running.coolants) = Default::default(),
            ProgramEvent::ToolChange { number, .. } => {
                let same = number.is_some() && running.tool == *number;
                running.tool = *number;
                if !same {
                    self.look_at_change(line);
                }
                if same && turns(self.running.spindle) {
                    let message = "a tool change that changes nothing while the spindle turns: where the control orients the spindle for it, it stands behind";
                    self.left_on(line, "spindle", message.to_owned());
                }
                // What stands in the block of the change is on after it.
                let running = &self.running;
                if same || running.lines.contains(&line) {
                    return;
                }
                let change = RunningChange {
                    line,
                    tool: *number,
                    spindle: running.spindle,
                    coolants: running.coolants,
                };
                self.tell_change(None);
                self.running.change = Some(change);
            }
            _ => {}
        }
    }

    /// The tool cuts: what ran as it came should have stood still, if the course has it so. Many controls stop it by
    /// themselves, and programs that count on that are only reported.
    pub(super) fn compare_change(&mut self, element: &Element) {
        let Some(change) = self.running.change else {
            return;
        };
        let asked = &element.asked;
        if asked.tool != change.tool {
            return;
        }
        let (spindle, coolants) = asked.at_change;
        self.tell_change(Some(SwitchedOff {
            spindle: !turns(spindle),
            coolants: coolants == Coolants::default(),
            line: element.line,
        }));
    }

    /// Tells what ran as a tool was changed: where the course has it off, as a fault.
    pub(super) fn tell_change(&mut self, off: Option<SwitchedOff>) {
        let Some(change) = self.running.change.take() else {
            return;
        };
        let cl_line = off.map(|off| off.line);
        let SwitchedOff { spindle, coolants, .. } = off.unwrap_or_default();
        for (code, message) in change.faults(spindle, coolants) {
            let message = format!("{message}, and the CL file has it off");
            self.fault_at(code, message, Some(BlockPlace::of_line(change.line)), cl_line, None);
        }
        for (code, message) in change.faults(!spindle, !coolants) {
            self.left_on(change.line, code, message);
        }
    }

    /// The tool cuts behind a stop: what the stop has switched off, where the control's does that, should be on again.
    /// Posting switches it on again in any case.
    pub(super) fn compare_standstill(&mut self, motion: &Motion, element: &Element) {
        let (state, asked) = (&motion.state, &element.asked);
        let spindle = state.standstill.spindle.filter(|_| turns(asked.spindle));
        let coolant = state.standstill.coolant.filter(|_| self.rules.coolants);
        let coolant = coolant.filter(|_| asked.coolants != Coolants::default());
        let off = [("spindle", "the spindle", spindle), ("coolant", "the coolant", coolant)];
        for (code, what, stop) in off {
            let Some(stop) = stop else {
                continue;
            };
            let message = format!(
                "cuts behind the stop on line {stop}, which switches {what} off, and no word switches it on again"
            );
            match self.rules.own {
                true => self.fault(code, message, Some(motion), Some(element.line), None),
                false => self.left_on(motion.line, code, message),
            }
        }
    }

    /// The program is over: nothing stops what still runs.
    pub(super) fn tell_end(&mut self) {
        let running = self.running;
        if !matches!(running.spindle, SpindleState::Off | SpindleState::Oriented) {
            let name = spindle_name(running.spindle);
            let message =
                format!("the spindle {name} when the program is over, and nothing stops it");
            self.fault_at(
                "spindle",
                message,
                Some(BlockPlace::of_line(running.lines[0])),
                None,
                None,
            );
        }
        if running.coolants != Coolants::default() {
            let name = coolant_name(running.coolants);
            let message = format!("{name} flows when the program is over, and nothing stops it");
            self.fault_at(
                "coolant",
                message,
                Some(BlockPlace::of_line(running.lines[1])),
                None,
                None,
            );
        }
    }

    pub(super) fn left_on(&mut self, line: u64, code: &'static str, message: String) {
        let known = &mut self.found.left_on;
        match known.iter_mut().find(|known| known.code == code) {
            Some(known) => known.count += 1,
            None => known.push(super::LeftOn { line, code, message, count: 1 }),
        }
    }
}
