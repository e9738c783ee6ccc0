//! What is known of a job before its first record: names, and what a first pass over the CL file found.

use std::ops::Range;

use crate::blocks::Block;
use crate::observer::Observer;
use crate::program::{Command, Tool};
use crate::stream::Flow;

/// What texts of the program can speak of beside the program itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JobFacts {
    /// The program: its file's name without the ending.
    pub program: String,
    /// The CL file, without its folder; empty if it has no name.
    pub cl_file: String,
    /// What a first pass found; none if there was none.
    pub ahead: Option<LookedAhead>,
}

/// What a first pass over a CL file found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LookedAhead {
    /// Every tool change, in order.
    pub changes: Vec<Tool>,
    /// Least and largest tip at the end of a block, mm, part frame; none without a move.
    pub extents: Option<[[f64; 3]; 2]>,
    /// Without tool changes, s; none if nobody filled it in.
    pub time_s: Option<f64>,
    /// Operations, and where each lies in the CL file.
    pub operations: Vec<OperationAhead>,
}

/// An operation of the CL file.
#[derive(Clone, Debug, PartialEq)]
pub struct OperationAhead {
    /// Its name.
    pub name: String,
    /// Its lines: from that of its start to that before its end.
    pub lines: Range<u64>,
}

impl LookedAhead {
    /// The tools in the order in which they are first used.
    pub fn tools(&self) -> Vec<&Tool> {
        let mut tools: Vec<&Tool> = Vec::new();
        for tool in &self.changes {
            if !tools.iter().any(|known| known.number == tool.number) {
                tools.push(tool);
            }
        }
        tools
    }
}

impl Observer for LookedAhead {
    fn blocks(&mut self, blocks: &[Flow<Block>]) {
        for next in blocks {
            match next {
                Flow::Point(block) => {
                    let tip: [f64; 3] = block.tip.into();
                    let [least, most] = self.extents.get_or_insert([tip, tip]);
                    for axis in 0..3 {
                        least[axis] = least[axis].min(tip[axis]);
                        most[axis] = most[axis].max(tip[axis]);
                    }
                }
                Flow::Command { line, command } => self.command(*line, command),
            }
        }
    }
}

impl LookedAhead {
    fn command(&mut self, line: u64, command: &Command) {
        match command {
            Command::Tool(tool) => self.changes.push(tool.clone()),
            Command::Operation(name) => self.operations.push(OperationAhead {
                name: name.clone(),
                lines: line..u64::MAX,
            }),
            Command::OperationEnd => {
                if let Some(open) = self.operations.last_mut() {
                    open.lines.end = line;
                }
            }
            _ => {}
        }
    }
}
