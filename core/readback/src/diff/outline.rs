//! The operations of a program, and which of one belongs to which of the other.

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;

use crate::{BlockEffect, BlockRunner, Motion, MotionKind, ProgramEvent, ProgramRun};

/// More operations than this are not aligned but compared one after the other.
const MOST: usize = 1000;

/// An operation as a first reading sees it.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct OperationOutline {
    /// Its number among those of the splitter.
    pub number: usize,
    pub name: Option<String>,
    pub tool: Option<u32>,
    /// It begins with a name alone, no tool is changed before it cuts.
    by_name: bool,
    pub lines: [u64; 2],
    pub motions: u64,
    /// Way of the tip at feed, mm.
    pub cut: f64,
    /// The tip where it first cuts, mm.
    start: Option<Vector3<f64>>,
}

/// Says where operations begin: with a change of the tool, and with a name behind something that was cut.
#[derive(Clone, Debug)]
pub(super) struct Splitter {
    by_name: bool,
    number: usize,
    /// Something moved at feed since the operation began.
    cut: bool,
    at: Vector3<f64>,
}

impl Splitter {
    pub fn new(by_name: bool) -> Self {
        Self { by_name, number: 0, cut: false, at: Vector3::zeros() }
    }

    /// Where the tip is.
    pub fn at(&self) -> Vector3<f64> {
        self.at
    }

    /// The number of the operation that begins with this.
    pub fn take(&mut self, done: &BlockEffect) -> Option<usize> {
        let begins = match done {
            BlockEffect::Motion(motion) => {
                self.at = motion.to.pose.tip;
                self.cut |= cuts(motion);
                return None;
            }
            BlockEffect::Event { event, .. } => match event {
                ProgramEvent::ToolChange { .. } => true,
                ProgramEvent::Operation(_) => self.by_name,
                _ => false,
            },
            BlockEffect::State(_) => false,
        };
        if !begins || !self.cut {
            return None;
        }
        self.cut = false;
        self.number += 1;
        Some(self.number)
    }
}

/// At feed, and no rapid that may stand so.
fn cuts(motion: &Motion) -> bool {
    motion.kind != MotionKind::Rapid && !motion.fast
}

/// The operations of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    parts: Vec<OperationOutline>,
    /// Words that are not understood, by name.
    pub unknown: Vec<String>,
    /// The length of a tool is compensated.
    lengths: bool,
}

impl Outline {
    /// Reads a program to its end; what cannot be read goes to `faults`.
    pub fn of(mut run: ProgramRun<impl BlockRunner>, faults: &mut Vec<Diagnostic>) -> Self {
        let mut outline = Self { parts: vec![OperationOutline::default()], ..Self::default() };
        let mut splitter = Splitter::new(true);
        while let Some(done) = run.block() {
            for done in done {
                outline.take(done, &mut splitter);
            }
        }
        *faults = run.into_faults();
        outline
    }

    fn take(&mut self, done: &BlockEffect, splitter: &mut Splitter) {
        let line = match done {
            BlockEffect::Motion(motion) => motion.line,
            BlockEffect::Event { line, .. } => *line,
            BlockEffect::State(_) => 0,
        };
        if let Some(number) = splitter.take(done) {
            let tool = self.parts.last().and_then(|part| part.tool);
            self.parts.push(OperationOutline {
                number,
                tool,
                by_name: !matches!(
                    done,
                    BlockEffect::Event { event: ProgramEvent::ToolChange { .. }, .. }
                ),
                ..OperationOutline::default()
            });
        }
        let Some(part) = self.parts.last_mut() else {
            return;
        };
        if line > 0 {
            if part.lines[0] == 0 {
                part.lines[0] = line;
            }
            part.lines[1] = part.lines[1].max(line);
        }
        match done {
            BlockEffect::Motion(motion) => {
                self.lengths |= motion.state.length != 0.0;
                part.motions += 1;
                if cuts(motion) {
                    part.start.get_or_insert(motion.from.pose.tip);
                    part.cut += (motion.to.pose.tip - motion.from.pose.tip).norm();
                }
            }
            BlockEffect::Event { event, .. } => match event {
                ProgramEvent::ToolChange { number, .. } => {
                    part.tool = *number;
                    part.by_name &= part.start.is_some();
                }
                ProgramEvent::Operation(name) => {
                    part.name.get_or_insert_with(|| name.clone());
                }
                ProgramEvent::Unknown(word) if !self.unknown.contains(word) => {
                    self.unknown.push(word.clone());
                }
                _ => {}
            },
            BlockEffect::State(_) => {}
        }
    }

    /// Without operations that begin by a name alone.
    fn by_tools(self) -> Self {
        let mut parts: Vec<OperationOutline> = Vec::new();
        for part in self.parts {
            match parts.last_mut() {
                Some(last) if part.by_name => {
                    last.lines[1] = last.lines[1].max(part.lines[1]);
                    last.motions += part.motions;
                    last.cut += part.cut;
                    last.start = last.start.or(part.start);
                }
                _ => {
                    let number = parts.len();
                    parts.push(OperationOutline { number, ..part });
                }
            }
        }
        Self { parts, ..self }
    }

    fn names(&self) -> Vec<&str> {
        let named = self.parts.iter();
        named.filter_map(|part| part.name.as_deref()).collect()
    }
}

/// Which operation of the old program belongs to which of the new one, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairs {
    /// Operations begin with names too, not with tools alone.
    pub by_name: bool,
    pub pairs: Vec<[Option<OperationOutline>; 2]>,
    pub unknown: [Vec<String>; 2],
    /// Both compensate lengths.
    pub lengths: bool,
}

/// Aligns the operations of two programs.
pub(super) fn align(old: Outline, new: Outline) -> Pairs {
    // Names are remarks: programs that call their operations otherwise are compared by their tools.
    let by_name = old.names() == new.names();
    let [old, new] = match by_name {
        true => [old, new],
        false => [old.by_tools(), new.by_tools()],
    };
    Pairs {
        by_name,
        lengths: old.lengths && new.lengths,
        pairs: paired(old.parts, new.parts),
        unknown: [old.unknown, new.unknown],
    }
}

/// What it costs to leave an operation alone.
const ALONE: f64 = 1.0;

/// How unlike two operations are, from 0 to 2.1.
fn unlike(old: &OperationOutline, new: &OperationOutline) -> f64 {
    let unless = |same: bool, cost: f64| if same { 0.0 } else { cost };
    let longer = old.cut.max(new.cut).max(1.0);
    let starts = match (old.start, new.start) {
        (Some(old), Some(new)) => (old - new).norm() <= 5.0,
        (old, new) => old.is_none() == new.is_none(),
    };
    unless(old.name == new.name, 0.4)
        + unless(old.tool == new.tool, 0.6)
        + 0.8 * libm::fabs(old.cut - new.cut) / longer
        + unless(starts, 0.3)
}

/// The alignment that costs least.
fn paired(
    old: Vec<OperationOutline>,
    new: Vec<OperationOutline>,
) -> Vec<[Option<OperationOutline>; 2]> {
    let (rows, columns) = (old.len(), new.len());
    if rows > MOST || columns > MOST {
        let count = rows.max(columns);
        let (mut old, mut new) = (old.into_iter(), new.into_iter());
        return (0..count).map(|_| [old.next(), new.next()]).collect();
    }
    // The cost of the rest from each place on.
    let mut cost = vec![0.0; (rows + 1) * (columns + 1)];
    let at = |row: usize, column: usize| row * (columns + 1) + column;
    for row in (0..=rows).rev() {
        for column in (0..=columns).rev() {
            let mut least = match (row < rows, column < columns) {
                (false, false) => 0.0,
                (true, true) => cost[at(row + 1, column + 1)] + unlike(&old[row], &new[column]),
                _ => f64::INFINITY,
            };
            if row < rows {
                least = least.min(cost[at(row + 1, column)] + ALONE);
            }
            if column < columns {
                least = least.min(cost[at(row, column + 1)] + ALONE);
            }
            cost[at(row, column)] = least;
        }
    }
    let (mut row, mut column) = (0, 0);
    let mut pairs = Vec::new();
    let (mut old, mut new) = (
        old.into_iter().map(Some).collect::<Vec<_>>(),
        new.into_iter().map(Some).collect::<Vec<_>>(),
    );
    while row < rows || column < columns {
        let here = cost[at(row, column)];
        let skips_old = row < rows && here == cost[at(row + 1, column)] + ALONE;
        let skips_new = column < columns && here == cost[at(row, column + 1)] + ALONE;
        let together = match (old.get(row), new.get(column)) {
            (Some(Some(one)), Some(Some(other))) => {
                here == cost[at(row + 1, column + 1)] + unlike(one, other)
            }
            _ => false,
        };
        match (together, skips_old, skips_new) {
            (true, ..) => {
                pairs.push([old[row].take(), new[column].take()]);
                (row, column) = (row + 1, column + 1);
            }
            (_, true, _) => {
                pairs.push([old[row].take(), None]);
                row += 1;
            }
            _ => {
                pairs.push([None, new[column].take()]);
                column += 1;
            }
        }
    }
    pairs
}
