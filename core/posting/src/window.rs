//! Parts of a CL file as a program of its own: what stands before each sets the state that it begins in.

use std::collections::VecDeque;
use std::ops::Range;

use crate::program::{Command, MoveFeed, ProgramStep};

/// Lets through what lies in some ranges of lines, each after the last that the lines before it said of tool, spindle,
/// coolant and the like. What the lines before it move is not made; what is modal in them the interpreter has read. Between
/// two ranges the tool is retracted.
#[derive(Debug)]
pub struct LineWindow {
    /// The range that is read or comes next, and those after it.
    ranges: VecDeque<Range<u64>>,
    /// What was said last before the range, of each kind.
    state: Vec<Command>,
    /// What the program has of each kind.
    made: Vec<Command>,
    /// Commands among them for spindle and coolant before the tool came: another tool's, until this one cuts without a
    /// word of its own.
    before_tool: Vec<Command>,
    /// The plane that points lie in, if the file names one.
    plane: Option<ProgramStep>,
    entered: bool,
    /// The tool is to be retracted before anything else: a range was left, and whether another file began since.
    retract: Option<bool>,
    /// The tool moved last where nothing is made of it.
    stands_outside: bool,
    /// Line of a cut from there.
    cut_from_outside: Option<u64>,
}

impl LineWindow {
    /// Nothing before these lines, between them and behind them.
    pub fn new(ranges: Vec<Range<u64>>) -> Self {
        Self {
            ranges: ranges.into(),
            state: Vec::new(),
            made: Vec::new(),
            before_tool: Vec::new(),
            plane: None,
            entered: false,
            retract: None,
            stands_outside: false,
            cut_from_outside: None,
        }
    }

    /// Line of a cut that begins where a move outside ends: nobody has come there.
    pub(crate) fn take_cut_from_outside(&mut self) -> Option<u64> {
        self.cut_from_outside.take()
    }

    /// Takes a step and gives what of it, and of the state before it, is part of the program.
    pub fn step(&mut self, line: u64, step: ProgramStep, to: &mut Vec<(u64, ProgramStep)>) {
        if self.ranges.pop_front_if(|lines| lines.end <= line).is_some() {
            while self.ranges.pop_front_if(|lines| lines.end <= line).is_some() {}
            (self.entered, self.retract) = (false, Some(false));
        }
        if let ProgramStep::Command(Command::Retract { forgets: true }) = &step {
            self.forget();
        }
        let Some(lines) = self.ranges.front() else {
            return;
        };
        if line < lines.start {
            return self.pass(step);
        }
        if let Some(forgets) = self.retract.take() {
            to.push((line, ProgramStep::Command(Command::Retract { forgets })));
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
                // Nothing of this range is made yet.
                ProgramStep::Command(Command::Retract { .. } | Command::Leave) => return,
                ProgramStep::Command(
                    Command::Operation(_) | Command::Comment(_) | Command::Message(_),
                ) => {}
                _ => self.enter(line, to),
            }
        }
        match &step {
            ProgramStep::Command(command) => {
                self.said_anew(command);
                self.makes(command);
                self.stands_outside &= !command.leaves();
            }
            ProgramStep::Plane(_) | ProgramStep::EndCycle => {}
            ProgramStep::Move(motion) if motion.pace == MoveFeed::Rapid => {
                self.stands_outside = false;
            }
            ProgramStep::Move(_)
            | ProgramStep::Arc(_)
            | ProgramStep::Spline(_)
            | ProgramStep::Cycle(_) => {
                // The way to a hole is a rapid.
                let cuts = !matches!(step, ProgramStep::Cycle(_));
                if std::mem::take(&mut self.stands_outside) && cuts {
                    self.cut_from_outside = Some(line);
                }
                let held = std::mem::take(&mut self.before_tool).into_iter();
                to.extend(held.map(|command| (line, ProgramStep::Command(command))));
            }
        }
        to.push((line, step));
    }

    /// Takes a step before the range.
    fn pass(&mut self, step: ProgramStep) {
        match step {
            ProgramStep::Command(command) => {
                self.stands_outside &= !command.leaves();
                self.keep(command);
            }
            ProgramStep::Plane(_) => self.plane = Some(step),
            ProgramStep::EndCycle => {}
            _ => self.stands_outside = true,
        }
    }

    /// The first move of a range comes: what holds there, as far as the program does not have it.
    fn enter(&mut self, line: u64, to: &mut Vec<(u64, ProgramStep)>) {
        self.entered = true;
        for command in std::mem::take(&mut self.state) {
            if !self.made.contains(&command) {
                self.makes(&command);
                to.push((line, ProgramStep::Command(command)));
            }
        }
        to.extend(self.plane.take().map(|plane| (line, plane)));
    }

    /// The program has a command.
    fn makes(&mut self, command: &Command) {
        if let Some(kind) = kind(command) {
            self.made.retain(|made| self::kind(made) != Some(kind));
            self.made.push(command.clone());
        }
    }

    /// Another file begins: of what was switched in the one before nothing holds, but for the tool that is in.
    fn forget(&mut self) {
        let rests = |kept: &Command| matches!(kind(kept), Some(SPINDLE | COOLANT));
        self.state.retain(|kept| !rests(kept));
        self.made.retain(|made| !rests(made));
        self.before_tool.clear();
        self.plane = None;
        self.stands_outside = false;
        self.retract = self.retract.map(|_| true);
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
