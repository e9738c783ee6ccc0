//! What is known of a job before its first record: names, and what a first pass over the CL file found.

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
    /// What the head of the program says besides.
    pub remark: Option<String>,
}

/// What a first pass over a CL file found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramPreview {
    /// Every tool change, in order.
    pub changes: Vec<ToolChange>,
    /// Least and largest tip at the end of a block, mm, part frame; none without a move.
    pub extents: Option<[[f64; 3]; 2]>,
    /// Time without tool changes, s; none if it was not filled in.
    pub time_s: Option<f64>,
    /// Lines of the CL file on which an operation begins.
    pub operations: Vec<u64>,
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
}

impl Observer for ProgramPreview {
    fn block(&mut self, block: &MotionBlock) {
        self.work.block(block);
        self.pending = None;
        self.moved = true;
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
                self.changes.push(tool.clone());
            }
            Command::Operation(_) => {
                self.pending = Some(line);
                self.operations.push(line);
            }
            _ => {}
        }
    }
}
