//! The blocks of a program, as arrays.

use post_machine::description::Machine;
use post_posting::program::Command;
use post_posting::{HoleMoves, MotionBlock, Observer};

use crate::columns::{Column, ColumnKind};
use crate::posted::{self, PostedBlock, PostedProgram};

pub use crate::posted::{KINDS, REASONS};

/// A row of each block; mm, degrees, s, part frame.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    /// Names of the axes of all heads: the columns of `q`.
    pub axes: Vec<String>,
    /// What `limit` counts.
    pub limits: Vec<String>,
    /// How many there are.
    pub rows: usize,
    /// What is told of them.
    pub arrays: Vec<Array>,
}

/// A value of each block, or a list of them.
#[derive(Clone, Debug)]
pub struct Array {
    /// Its name, with its unit.
    pub name: String,
    /// What it is.
    pub doc: String,
    /// How many values a block has, where it has a list of them.
    pub width: Option<usize>,
    /// What its values are.
    pub kind: ColumnKind,
    /// Those of all blocks, one behind the other; no number where a block has none.
    pub values: Vec<f64>,
}

/// Names of all arrays of blocks, and what they are.
pub fn block_arrays() -> Vec<(String, String)> {
    let columns = posted::arrays(0).into_iter();
    columns.map(|column| (column.name.into_owned(), column.doc.into_owned())).collect()
}

/// Takes the blocks of a program that is made.
pub(super) struct BlockArrays<'m> {
    program: PostedProgram<'m>,
    columns: Vec<Column<PostedBlock>>,
    blocks: Blocks,
}

impl<'m> BlockArrays<'m> {
    pub(super) fn new(machine: &'m Machine) -> Self {
        let program = PostedProgram::new(machine);
        let axes: Vec<String> = program.axes.iter().map(|axis| axis.name.clone()).collect();
        let columns = posted::arrays(axes.len());
        let arrays = columns.iter().map(|column| Array {
            name: column.name.clone().into_owned(),
            doc: column.doc.clone().into_owned(),
            width: column.width,
            kind: column.kind,
            values: Vec::new(),
        });
        let blocks = Blocks { axes, arrays: arrays.collect(), ..Blocks::default() };
        Self { program, columns, blocks }
    }

    pub(super) fn finish(mut self) -> Blocks {
        self.blocks.limits = self.program.limits;
        self.blocks
    }
}

impl Observer for BlockArrays<'_> {
    fn block(&mut self, block: &MotionBlock) {
        let row = self.program.block(block);
        self.blocks.rows += 1;
        for (array, column) in self.blocks.arrays.iter_mut().zip(&self.columns) {
            let values = (0..column.width.unwrap_or(1)).map(|place| column.of(&row, place));
            let numbers = values.map(|value| value.and_then(|value| value.number()));
            array.values.extend(numbers.map(|number| number.unwrap_or(f64::NAN)));
        }
    }

    fn hole(&mut self, hole: &HoleMoves<MotionBlock>) {
        self.blocks(&hole.above);
        self.program.hole = true;
        self.blocks(&hole.into);
        self.program.hole = false;
    }

    fn command(&mut self, _: u64, command: &Command) {
        self.program.command(command);
    }
}
