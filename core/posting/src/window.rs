//! A part of a CL file as a program of its own: what stands before it sets the state that it begins in.

use std::ops::Range;

use crate::program::{Command, Step};

/// Lets through what lies in a range of lines, behind the last that the lines before it said of tool, spindle, coolant
/// and the like. What the lines before it move is not made; what is modal in them the interpreter has read.
#[derive(Debug)]
pub(crate) struct Window {
    lines: Range<u64>,
    /// What was said last before the range, of each kind.
    state: Vec<Command>,
    entered: bool,
}

impl Window {
    pub(crate) fn new(lines: Range<u64>) -> Self {
        Self {
            lines,
            state: Vec::new(),
            entered: false,
        }
    }

    /// Takes a step and gives what of it, and of the state before it, is part of the program.
    pub(crate) fn step(&mut self, line: u64, step: Step, to: &mut Vec<(u64, Step)>) {
        if line < self.lines.start {
            if let Step::Command(command) = step {
                self.keep(command);
            }
            return;
        }
        if line >= self.lines.end {
            return;
        }
        if !self.entered {
            match step {
                // What is said anew before the first move takes the place of what held before.
                Step::Command(command) if kind(&command).is_some() => return self.keep(command),
                Step::Command(
                    Command::Operation(_) | Command::Comment(_) | Command::Message(_),
                ) => {}
                _ => {
                    self.entered = true;
                    let state = std::mem::take(&mut self.state).into_iter();
                    to.extend(state.map(|command| (line, Step::Command(command))));
                }
            }
        }
        to.push((line, step));
    }

    /// Keeps a command that holds until another of its kind, the tool first: a change of it says nothing of what is
    /// switched behind it.
    fn keep(&mut self, command: Command) {
        let Some(kind) = kind(&command) else { return };
        self.state.retain(|kept| self::kind(kept) != Some(kind));
        self.state.push(command);
        self.state.sort_by_key(self::kind);
    }
}

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
        Command::Spindle(_) | Command::SurfaceSpeed { .. } => 7,
        Command::Coolant(_) => 8,
        Command::Compensate(_) => 9,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use post_plugin::{Coolant, Spindle};

    use super::*;
    use crate::program::Tool;

    #[test]
    fn a_part_begins_in_the_state_that_the_lines_before_it_set() {
        let mut window = Window::new(10..20);
        let mut steps = Vec::new();
        let tool = |number| {
            Command::Tool(Tool {
                number,
                ..Tool::default()
            })
        };
        for (line, command) in [
            (1, Command::Coolant(Coolant::Mist)),
            (2, tool(1)),
            (3, Command::Spindle(Spindle::Off)),
            (4, tool(2)),
            (5, Command::Stop),
            (10, Command::Comment("A".to_owned())),
            (11, Command::Coolant(Coolant::Flood)),
            (12, Command::OptionalStop),
            (19, Command::Home),
            (20, Command::Stop),
        ] {
            window.step(line, Step::Command(command), &mut steps);
        }
        let command = |line, command| (line, Step::Command(command));
        assert_eq!(
            steps,
            [
                command(10, Command::Comment("A".to_owned())),
                command(12, tool(2)),
                command(12, Command::Spindle(Spindle::Off)),
                command(12, Command::Coolant(Coolant::Flood)),
                command(12, Command::OptionalStop),
                command(19, Command::Home),
            ]
        );
    }
}
