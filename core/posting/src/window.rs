//! A part of a CL file as a program of its own: what stands before it sets the state that it begins in.

use std::ops::Range;

use crate::program::{Command, MoveFeed, ProgramStep};

/// Lets through what lies in a range of lines, after the last that the lines before it said of tool, spindle, coolant
/// and the like. What the lines before it move is not made; what is modal in them the interpreter has read.
#[derive(Debug)]
pub struct LineWindow {
    lines: Range<u64>,
    /// What was said last before the range, of each kind.
    state: Vec<Command>,
    /// Commands among them for spindle and coolant before the tool came: another tool's, until this one cuts without a
    /// word of its own.
    before_tool: Vec<Command>,
    /// The plane that points lie in, if the file names one.
    plane: Option<ProgramStep>,
    entered: bool,
}

impl LineWindow {
    /// Nothing before these lines and behind them.
    pub fn new(lines: Range<u64>) -> Self {
        Self { lines, state: Vec::new(), before_tool: Vec::new(), plane: None, entered: false }
    }

    /// Takes a step and gives what of it, and of the state before it, is part of the program.
    pub fn step(&mut self, line: u64, step: ProgramStep, to: &mut Vec<(u64, ProgramStep)>) {
        if line < self.lines.start {
            match step {
                ProgramStep::Command(command) => self.keep(command),
                ProgramStep::Plane(_) => self.plane = Some(step),
                _ => {}
            }
            return;
        }
        if line >= self.lines.end {
            return;
        }
        if !self.entered {
            match step {
                ProgramStep::Plane(_) => {
                    self.plane = Some(step);
                    return;
                }
                // What is said anew before the first move takes the place of what held before.
                ProgramStep::Command(command) if kind(&command).is_some() => {
                    return self.keep(command);
                }
                ProgramStep::Command(
                    Command::Operation(_) | Command::Comment(_) | Command::Message(_),
                ) => {}
                _ => {
                    self.entered = true;
                    let state = std::mem::take(&mut self.state).into_iter();
                    to.extend(state.map(|command| (line, ProgramStep::Command(command))));
                    to.extend(self.plane.take().map(|plane| (line, plane)));
                }
            }
        }
        match &step {
            ProgramStep::Command(command) => self.said_anew(command),
            ProgramStep::Plane(_) | ProgramStep::EndCycle => {}
            ProgramStep::Move(motion) if motion.pace == MoveFeed::Rapid => {}
            ProgramStep::Move(_)
            | ProgramStep::Arc(_)
            | ProgramStep::Spline(_)
            | ProgramStep::Cycle(_) => {
                let held = std::mem::take(&mut self.before_tool).into_iter();
                to.extend(held.map(|command| (line, ProgramStep::Command(command))));
            }
        }
        to.push((line, step));
    }

    /// What the file says now takes the place of what held before the tool came.
    fn said_anew(&mut self, command: &Command) {
        let kind = kind(command);
        self.before_tool.retain(|held| self::kind(held) != kind);
    }

    /// Keeps a command that holds until another of its kind, the tool first: a change of it says nothing of what is
    /// switched after it.
    fn keep(&mut self, command: Command) {
        let Some(kind) = kind(&command) else { return };
        self.said_anew(&command);
        self.state.retain(|kept| self::kind(kept) != Some(kind));
        if let Command::Tool(_) | Command::Head(_) = command {
            // It came with the spindle at rest.
            let rests = |kept: &Command| matches!(self::kind(kept), Some(SPINDLE | COOLANT));
            let (held, state) = self.state.drain(..).partition(rests);
            self.state = state;
            self.before_tool.extend::<Vec<Command>>(held);
        }
        self.state.push(command);
        self.state.sort_by_key(self::kind);
    }
}

/// Places of the commands of spindle and coolant in that order.
const SPINDLE: u8 = 7;
const COOLANT: u8 = 8;

/// What of a program's state a command sets, in the order in which a program sets it; none if it sets nothing.
fn kind(command: &Command) -> Option<u8> {
    Some(match command {
        Command::Head(_) => 0,
        Command::Tool(_) => 1,
        Command::WorkOffset(_) => 2,
        Command::Smoothing(_) => 3,
        Command::Index { axis: 'A', .. } => 4,
        Command::Index { axis: 'B', .. } => 5,
        Command::Index { .. } => 6,
        Command::Spindle(_) | Command::SurfaceSpeed { .. } => SPINDLE,
        Command::Coolant(_) => COOLANT,
        Command::Compensate(_) => 9,
        _ => return None,
    })
}
