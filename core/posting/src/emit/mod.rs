//! Blocks and commands become the events of the dialect: what is in force, tool changes, approach, clamps.

mod extremes;
mod writer;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::{Capabilities, Coolant, DialectSession, Event, Spindle, ToolPose};

use crate::blocks::{Block, MotionKind};
use crate::findings::Findings;
use crate::observer::Output;
use crate::program::{Command, Tool};
use crate::stream::Flow;
pub(crate) use extremes::Extremes;
use writer::Writer;

/// The last stage.
pub(crate) struct Emit<'a> {
    machine: &'a Machine,
    /// The machine with the head that it starts with.
    base: &'a Machine,
    writer: Writer<'a>,
    extremes: Extremes,
    /// Where the axes stand behind the last block.
    last: Joints,
    /// Axes that are known to be clamped, one bit each.
    clamped: u8,
    /// Length compensation or TCP is in force.
    positioned: bool,
    /// The spindle was switched on since the last tool change.
    turning: bool,
    /// What the CL file last said of it.
    commanded: Option<Spindle>,
    /// What the CL file last said of coolant.
    coolant: Option<Coolant>,
    /// Coolant was switched off in between.
    coolant_due: bool,
}

impl<'a> Emit<'a> {
    pub(crate) fn new(
        machine: &'a Machine,
        dialect: &'a mut dyn DialectSession,
        output: &'a mut dyn Output,
    ) -> Self {
        let mut writer = Writer::new(dialect, output);
        writer.push(0, Event::Start);
        Self {
            machine,
            base: machine,
            writer,
            extremes: Extremes::new(),
            last: Joints::default(),
            clamped: 0,
            positioned: false,
            turning: false,
            commanded: None,
            coolant: None,
            coolant_due: false,
        }
    }

    /// Extremes so far.
    pub(crate) fn extremes(&self) -> &Extremes {
        &self.extremes
    }

    /// Lines of text so far.
    pub(crate) fn lines(&self) -> u64 {
        self.writer.lines()
    }

    /// Takes a batch.
    pub(crate) fn take(&mut self, batch: &[Flow<Block>], findings: &Findings) {
        for next in batch {
            match next {
                Flow::Point(block) => self.block(block, findings),
                Flow::Command { line, command } => self.command(*line, command),
            }
            if self.writer.is_full() {
                self.flush(findings);
            }
        }
        self.flush(findings);
    }

    /// The last events; `line` is the last of the CL file.
    pub(crate) fn finish(&mut self, line: u64, findings: &Findings) {
        self.release(line);
        self.writer.push(line, Event::End);
        self.flush(findings);
    }

    fn flush(&mut self, findings: &Findings) {
        self.writer.flush(&mut self.extremes, findings);
    }

    #[inline]
    fn block(&mut self, block: &Block, findings: &Findings) {
        let line = block.line;
        match block.kind {
            MotionKind::Position => self.position(block, findings),
            MotionKind::Reference => {
                self.writer.push(line, Event::Release);
                self.writer.push(line, Event::Home);
                self.extremes.go(&self.last, &block.joints);
                self.position(block, findings);
            }
            MotionKind::Rapid | MotionKind::Linear => {
                // A block without a changed word moves nothing and is not written.
                if block.still {
                    self.extremes.mark(block, self.writer.next());
                    return;
                }
                self.extremes.reach(&block.joints);
                self.extremes.go(&self.last, &block.joints);
                if self.machine.clamps {
                    self.clamp(block);
                }
                self.extremes.mark(block, self.writer.next());
                let (tool, words) = (stands(block), &block.words[..self.writer.words()]);
                self.writer.push(
                    line,
                    match block.time.feed {
                        Some(feed) => Event::Linear { tool, feed, words },
                        None => Event::Rapid { tool, words },
                    },
                );
            }
        }
        self.last = block.joints;
    }

    fn command(&mut self, line: u64, command: &Command) {
        let event = match command {
            // These act on the choice of axis values alone.
            Command::From { .. } | Command::Index { .. } => return,
            Command::Tool(tool) => return self.change(line, tool),
            Command::Head(name) => return self.swap_head(line, name),
            Command::Preselect(number) => Event::Preselect { number: *number },
            Command::Spindle(spindle) => {
                self.turning = matches!(spindle, Spindle::On { .. });
                self.commanded = self.turning.then_some(*spindle);
                Event::Spindle(*spindle)
            }
            Command::Coolant(coolant) => {
                self.coolant = (*coolant != Coolant::Off).then_some(*coolant);
                self.coolant_due = false;
                Event::Coolant(*coolant)
            }
            Command::Compensate(compensation) => Event::Compensate(*compensation),
            // Of a dialect that does not know operations the name is a remark.
            Command::Operation(name) if self.writer.knows(Capabilities::OPERATION) => {
                Event::Operation { name }
            }
            Command::OperationEnd if self.writer.knows(Capabilities::OPERATION) => {
                Event::OperationEnd
            }
            Command::OperationEnd => return,
            Command::Operation(text) | Command::Comment(text) => Event::Comment { text },
            Command::Literal(text) => Event::Literal { text },
            Command::Dwell(seconds) => Event::Dwell { seconds: *seconds },
            Command::Stop => Event::Stop,
            Command::OptionalStop => Event::OptionalStop,
            Command::Home => {
                self.release(line);
                Event::Home
            }
        };
        self.writer.push(line, event);
    }

    /// Cancels compensation, if any is in force.
    fn release(&mut self, line: u64) {
        if std::mem::take(&mut self.positioned) {
            self.writer.push(line, Event::Release);
        }
    }

    fn change(&mut self, line: u64, tool: &Tool) {
        self.release(line);
        self.turning = false;
        self.writer.tool_known();
        self.writer.push(
            line,
            Event::ToolChange {
                number: tool.number,
                register: tool.register,
                length: tool.length,
                diameter: tool.diameter,
                corner_radius: tool.corner_radius,
                name: &tool.name,
            },
        );
    }

    /// Another head: the machine is that of the head from here on.
    fn swap_head(&mut self, line: u64, name: &str) {
        let Some(head) = self.base.head(name) else {
            return;
        };
        self.release(line);
        self.machine = &head.machine;
        // Away first: a spindle that stops in the part tears. Both are switched on again with the first position,
        // as after a tool change.
        self.writer.push(line, Event::Home);
        if std::mem::take(&mut self.turning) {
            self.writer.push(line, Event::Spindle(Spindle::Off));
        }
        if self.coolant.is_some() {
            self.coolant_due = true;
            self.writer.push(line, Event::Coolant(Coolant::Off));
        }
        match &head.word {
            Some(word) => self.writer.push(line, Event::Word { text: word }),
            None => {
                let text = format!("CHANGE TO HEAD {name}");
                self.writer.push(line, Event::Comment { text: &text });
                self.writer.push(line, Event::Stop);
            }
        }
    }

    /// The first position after the start or a tool change.
    fn position(&mut self, block: &Block, findings: &Findings) {
        let line = block.line;
        self.extremes.reach(&block.joints);
        if let (false, Some(spindle)) = (self.turning, self.commanded) {
            // The tool change stopped it, and the CL file takes it to be turning.
            self.turning = true;
            self.writer.push(line, Event::Spindle(spindle));
            findings.at(
                line,
                Diagnostic::warning(
                    "spindle",
                    "no SPINDL since the tool change; the spindle was switched on again as before it",
                )
                .help("check that the speed fits the new tool"),
            );
        }
        if let (true, Some(coolant)) = (std::mem::take(&mut self.coolant_due), self.coolant) {
            self.writer.push(line, Event::Coolant(coolant));
        }
        // Nobody knows whether they are clamped.
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, false, true);
        }
        self.writer.push(
            line,
            Event::Position {
                tool: stands(block),
                feed: block.time.feed,
                words: &block.words[..self.writer.words()],
            },
        );
        self.positioned = true;
        // What was turned on the way is clamped before the tool goes on.
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, true, false);
        }
    }

    /// Lets go the axes that this block moves, and clamps the others before the tool cuts.
    fn clamp(&mut self, block: &Block) {
        for joint in 0..self.machine.axes.len() {
            if self.last[joint] != block.joints[joint] {
                self.set_clamp(block.line, joint, false, false);
            } else if block.kind == MotionKind::Linear {
                self.set_clamp(block.line, joint, true, false);
            }
        }
    }

    /// Writes the word that clamps an axis or lets it go, unless it is so already.
    fn set_clamp(&mut self, line: u64, joint: usize, on: bool, unknown: bool) {
        let Some(clamp) = &self.machine.axes[joint].clamp else {
            return;
        };
        let bit = 1 << joint;
        if unknown || (self.clamped & bit != 0) != on {
            self.clamped = self.clamped & !bit | if on { bit } else { 0 };
            let text = if on { &clamp.on } else { &clamp.off };
            self.writer.push(line, Event::Word { text });
        }
    }
}

/// Where the tool stands at the end of a block.
#[inline]
fn stands(block: &Block) -> Option<ToolPose> {
    Some(ToolPose {
        tip: block.tip.into(),
        axis: block.axis.into(),
    })
}
