//! What is known of a job before its first record: names, and what a first pass over the CL file found.

use std::ops::Range;

use post_machine::axis_words::unit_length;
use post_machine::description::OutputUnits;
use post_plugin::{Feed, Spindle};

use crate::blocks::MotionBlock;
use crate::observer::Observer;
use crate::operation_work::OperationList;
use crate::program::{Command, ToolChange};

/// What texts of the program can speak of beside the program itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JobFacts {
    /// The program: its file's name without the ending.
    pub program: String,
    /// The CL file, without its folder; empty if it has no name.
    pub cl_file: String,
    /// What a first pass found; none if there was none.
    pub ahead: Option<ProgramPreview>,
    /// What the head of the program says besides, a remark each.
    pub remarks: Vec<String>,
}

/// What a first pass over a CL file found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramPreview {
    /// Every tool change, in order.
    pub changes: Vec<ToolChange>,
    /// Revolutions a minute that each of them first gets; none where the CL file gives none.
    pub speeds: Vec<Option<f64>>,
    /// Largest feed a minute of the cuts of each operation, in units of the program, in the order of their names.
    pub feeds: Vec<Option<f64>>,
    /// Least and largest tip at the end of a block, mm, part frame; none without a move.
    pub extents: Option<[[f64; 3]; 2]>,
    /// Time without tool changes, s; none if it was not filled in.
    pub time_s: Option<f64>,
    /// Lengths of the program are inches.
    pub inch: bool,
    /// Lines of the CL file on which an operation begins.
    pub operations: Vec<u64>,
    /// The tool that each operation begins with, by its place among the changes; none where no tool was changed.
    pub begins_with: Vec<Option<usize>>,
    /// The names of the operations.
    pub names: Vec<String>,
    /// Lines on which the part of the file begins that a further tool works: that of its operation, if one begins
    /// between the last move before it and the change.
    pub parts: Vec<u64>,
    /// What each operation does with each tool.
    pub work: OperationList,
    /// Where an operation began since the last move.
    pub pending: Option<u64>,
    /// Some move was made since the last tool change.
    pub moved: bool,
}

impl ProgramPreview {
    /// The tools in the order in which they are first used.
    pub fn tools(&self) -> Vec<&ToolChange> {
        let mut tools: Vec<&ToolChange> = Vec::new();
        for tool in &self.changes {
            if !tools.iter().any(|known| known.number == tool.number) {
                tools.push(tool);
            }
        }
        tools
    }

    /// The names of the operations that begin on these lines of the CL file.
    pub fn named(&self, lines: Range<u64>) -> Vec<&str> {
        let begin = self.operations.iter().zip(&self.names);
        begin.filter(|(line, _)| lines.contains(line)).map(|(_, name)| name.as_str()).collect()
    }
}

impl ProgramPreview {
    /// The feed of a block a minute, in units of the program: as it is printed, else that of its way in its time.
    fn feed_a_minute(&self, block: &MotionBlock) -> Option<f64> {
        if let Some(Feed::PerMinute(feed)) = block.time.feed {
            return Some(feed);
        }
        let unit = unit_length(if self.inch { OutputUnits::Inch } else { OutputUnits::Mm });
        let feed = block.way / unit / block.time.minutes;
        (feed.is_finite() && feed > 0.0).then_some(feed)
    }
}

impl Observer for ProgramPreview {
    fn block(&mut self, block: &MotionBlock) {
        self.work.block(block);
        self.pending = None;
        self.moved = true;
        if block.kind.cuts()
            && let Some(feed) = self.feed_a_minute(block)
            && let Some(most) = self.feeds.last_mut()
        {
            *most = Some(most.map_or(feed, |most| most.max(feed)));
        }
        let tip: [f64; 3] = block.tip.into();
        let [least, most] = self.extents.get_or_insert([tip, tip]);
        for axis in 0..3 {
            least[axis] = least[axis].min(tip[axis]);
            most[axis] = most[axis].max(tip[axis]);
        }
    }

    fn command(&mut self, line: u64, command: &Command) {
        self.work.command(command);
        match command {
            Command::Tool(tool) => {
                if std::mem::take(&mut self.moved) {
                    self.parts.push(self.pending.unwrap_or(line));
                }
                if self.pending.is_some()
                    && let Some(first) = self.begins_with.last_mut()
                {
                    *first = Some(self.changes.len());
                }
                self.changes.push(tool.clone());
                self.speeds.push(None);
            }
            Command::Spindle(Spindle::On { rpm, .. }) => {
                if let Some(speed) = self.speeds.last_mut() {
                    speed.get_or_insert(*rpm);
                }
            }
            Command::Operation(name) => {
                self.feeds.push(None);
                self.names.push(name.clone());
                self.pending = Some(line);
                self.operations.push(line);
                self.begins_with.push(self.changes.len().checked_sub(1));
            }
            _ => {}
        }
    }
}
