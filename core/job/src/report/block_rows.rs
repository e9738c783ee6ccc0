//! The blocks of a program that is posted, row by row.

use std::collections::VecDeque;
use std::io::{self, BufReader, Read, Write as _};

use post_machine::description::Machine;
use post_posting::program::{Command, HoleMark, Pace};
use post_posting::{Block, Flow, MotionKind, Observer, Reason};
use post_report::meta::{Event, Meta};
use post_report::table::{Column, TableWriter};

use nalgebra::Vector3;
use post_machine::description::Tcp;
use post_machine::kinematics::{Chain, Joints};

use super::axes;
use super::branch::{self, Branch};
use super::cl_points::Points;
use super::cl_window::ClWindow;
use super::derived::{Derived, Left};
use super::parts::{Parts, fault};
use super::path_rows::PathRows;
use crate::failure::Failure;
use crate::files::Scratch;

/// Deviations that differ by less are the same, as in the summary: mm or radians.
const EQUAL: f64 = 1e-9;

/// More events than this are counted and not listed.
pub const MOST_EVENTS: usize = 5000;

/// The largest of something and its row.
#[derive(Clone, Copy, Debug, Default)]
pub struct Largest {
    value: f64,
    row: u64,
    nc: u64,
}

/// Takes blocks, and packs a row of each.
pub struct BlockRows<'m> {
    /// The machine with the head in use.
    machine: &'m Machine,
    base: &'m Machine,
    /// Names of the axes of all heads, in the order of their columns.
    axes: Vec<String>,
    table: TableWriter<Scratch>,
    /// Rows whose line of the program is not known yet, one behind the other.
    waiting: VecDeque<f64>,
    width: usize,
    /// Rows that came.
    came: u64,
    /// The time, s.
    time: f64,
    /// End of the last block, s, and its tip, as the page will have them.
    end: f64,
    tip: Vector3<f64>,
    hole: bool,
    reason: Reason,
    /// Decimals of deviations, and ten to that power.
    scale: f64,
    axis_scale: f64,
    limits: Vec<String>,
    events: Vec<Event>,
    left_out: u64,
    /// Tip and axis in cuts, tip in rapids.
    largest: [Largest; 3],
    fault: Option<Failure>,
    path: PathRows,
    cl: ClWindow,
    derived: Derived<'m>,
    branch: Branch,
    /// Rows from which another head is in use, with its number from 1; 0: none.
    heads: Vec<[u64; 2]>,
    /// Where the blocks end, for the path of the CL file.
    ends: Points,
    /// Lines of the program of the rows, for who predicts it: 32 bits each.
    lines: Option<Scratch>,
    /// The chain of the head in use, its tool without a length.
    chain: Option<Chain>,
    /// Where the last block ended: its line, its axis values and its tip.
    last: Option<(u64, Joints, Vector3<f64>)>,
}

/// A number as it is packed with four decimals.
pub fn packed(value: f64) -> f64 {
    (value * 1e4).round_ties_even() / 1e4
}

/// Decimals of which the last is at most a fiftieth of a tolerance.
pub fn decimals(tolerance: f64) -> u8 {
    let mut decimals = 2;
    let mut step = 0.01;
    while step > tolerance / 50.0 && decimals < 9 {
        step /= 10.0;
        decimals += 1;
    }
    decimals
}

/// The chain of a machine, its tool without a length; none if it cannot be solved.
fn chain(machine: &Machine) -> Option<Chain> {
    let solver = machine.solver(0.0).ok()?;
    Some(solver.chain().clone())
}

fn power(decimals: u8) -> f64 {
    (0..decimals).fold(1.0, |power, _| power * 10.0)
}

/// `value` rounded up to a multiple of one over `scale`: what is certified is never told smaller, but for a thousandth of
/// the last decimal.
fn up(value: f64, scale: f64) -> f64 {
    libm::ceil(value * scale - 1e-3) / scale
}

impl<'m> BlockRows<'m> {
    /// For blocks of a machine, of which something is predicted later on or not.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(machine: &'m Machine, cl: ClWindow, predicted: bool) -> Result<Self, Failure> {
        let axes = axes::of_all_heads(machine);
        let accuracy = &machine.accuracy;
        let [tip, turn] =
            [decimals(accuracy.tolerance), decimals(accuracy.axis_tolerance.to_degrees())];
        let mut columns = vec![
            Column::new("nc", "", 0),
            Column::new("cl", "", 0),
            Column::new("t0", "s", 4).from("t1"),
            Column::new("t1", "s", 4).from("way"),
            Column::new("kind", "", 0),
            Column::new("reason", "", 0),
        ];
        let derived = Derived::new(machine);
        columns.extend(derived.columns(&axes));
        columns.extend([
            Column::new("deviation", "mm", tip),
            Column::new("axis_deviation", "deg", turn),
            Column::new("tolerance", "mm", 6),
            Column::new("feed", "mm/min", 1),
            Column::new("asked", "mm/min", 1),
            Column::new("limit", "", 0),
            Column::new("tool_length", "mm", 4),
        ]);
        Ok(Self {
            machine,
            base: machine,
            axes: axes.into_iter().map(|(name, _)| name).collect(),
            width: columns.len(),
            table: TableWriter::new("blocks", columns, Parts::scratch()?),
            waiting: VecDeque::new(),
            came: 0,
            time: 0.0,
            end: 0.0,
            tip: Vector3::zeros(),
            hole: false,
            reason: Reason::Point,
            scale: power(tip),
            axis_scale: power(turn),
            limits: Vec::new(),
            events: Vec::new(),
            left_out: 0,
            largest: [Largest::default(); 3],
            fault: None,
            path: PathRows::new(machine)?,
            derived,
            branch: Branch::new(machine),
            heads: Vec::new(),
            ends: Points::new()?,
            lines: match predicted {
                true => Some(Parts::scratch()?),
                false => None,
            },
            cl,
            chain: chain(machine),
            last: None,
        })
    }

    /// All blocks have come: the lines of the program of all rows, if something is predicted of them.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn lines(&mut self) -> Result<Option<Box<dyn Read>>, Failure> {
        self.settle();
        let Some(lines) = self.lines.take() else {
            return Ok(None);
        };
        let mut lines = lines.reread()?;
        io::Seek::rewind(&mut lines).map_err(fault)?;
        Ok(Some(Box::new(BufReader::new(lines))))
    }

    /// Rows that still wait stand on no line.
    fn settle(&mut self) {
        let waiting = self.waiting.len() / self.width;
        self.written(std::iter::repeat_n(0, waiting));
    }

    /// All blocks have come: their table goes to `parts`, and what was seen to `meta`.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn finish(mut self, parts: &mut Parts, meta: &mut Meta) -> Result<(), Failure> {
        self.settle();
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        for (maximum, largest) in meta.maxima.iter_mut().zip(self.largest) {
            // Of a cycle the control's own way counts, which is that of no row.
            if largest.value > 0.0 && maximum.nc == Some(largest.nc) {
                maximum.row = Some(largest.row);
            }
        }
        self.path.finish(parts)?;
        self.cl.finish(self.base, self.ends, parts)?;
        meta.head_rows = self.heads;
        meta.checks = self.derived.checks();
        meta.limits = self.limits;
        meta.events = self.events;
        meta.events_left_out = self.left_out;
        parts.table(self.table)
    }

    /// The first blocks that wait stand on these lines of the program.
    fn written(&mut self, lines: impl Iterator<Item = u64>) {
        for line in lines {
            let row = self.table.rows();
            let values = self.waiting.make_contiguous();
            let Some(values) = values.get_mut(..self.width) else {
                return;
            };
            values[0] = line as f64;
            for largest in &mut self.largest {
                if largest.row == row {
                    largest.nc = line;
                }
            }
            let mut kept = self.table.row(values);
            if let (Some(lines), true) = (&mut self.lines, kept.is_ok()) {
                kept = lines.write_all(&(line as u32).to_le_bytes());
            }
            if let Err(error) = kept {
                self.fault.get_or_insert(fault(error));
            }
            self.waiting.drain(..self.width);
        }
    }

    fn block(&mut self, block: &Block) {
        let row = self.came;
        self.came += 1;
        // Told against the end of the block before.
        let from = self.time - self.end;
        self.time += block.time.minutes * 60.0;
        let kind = match (self.hole, block.kind) {
            (true, _) => 6,
            (_, MotionKind::Position) => 0,
            (_, MotionKind::Reference) => 1,
            (_, MotionKind::Rapid) => 2,
            (_, MotionKind::Linear) => 3,
            (_, MotionKind::Arc) => 4,
            (_, MotionKind::Spline) => 5,
        };
        if block.reason == Reason::Rewind && self.reason != Reason::Rewind {
            self.event(row, "rewind", "the tool is drawn back to turn".to_owned());
        }
        self.reason = block.reason;
        if self.branch.changes(&block.joints) {
            self.event(row, "branch", branch::CHANGED.to_owned());
        }
        let reason = match block.reason {
            Reason::Point => 0,
            Reason::Eased => 1,
            Reason::PutIn => 2,
            Reason::Leave => 3,
            Reason::Stage => 4,
            Reason::Rewind => 5,
            Reason::Feed => 6,
            Reason::Above => 7,
            Reason::AtOnce => 8,
        };
        let limit = block.time.limit.or(block.planned.limit);
        let limit = limit.map_or(-1.0, |name| self.limit(name));
        let minutes = block.time.minutes;
        let [feed, asked] = match block.pace {
            _ if block.time.feed.is_none() || minutes <= 0.0 => [0.0, 0.0],
            Pace::PerMinute(asked) => [block.way / minutes, asked],
            Pace::InverseTime(asked) => [block.way / minutes, block.way * asked],
            Pace::Rapid => [block.way / minutes, 0.0],
        };
        let accuracy = &self.machine.accuracy;
        let tolerance = match block.loose {
            true => accuracy.rapid_tolerance,
            false => accuracy.tolerance,
        };
        for slot in match block.loose {
            true => 2..3,
            false => 0..2,
        } {
            let value = match slot {
                1 => block.deviation.axis,
                _ => block.deviation.tip,
            };
            let largest = &mut self.largest[slot];
            if value > largest.value + EQUAL {
                *largest = Largest { value, row, nc: 0 };
            }
        }
        let length = self.length(block);
        let Left { axes, pose, tip } =
            self.derived.left(self.machine, &block.joints, [block.tip, block.axis], length);
        self.derived.check(row, &block.joints, length);
        self.path(row, block, length, tip);
        self.ends.push(block.line, tip, 0.0);
        // Told against what a straight way takes at the feed.
        let told = (feed * 10.0).round_ties_even() / 10.0;
        let took = match told > 0.0 {
            true => 60.0 * (tip - self.tip).norm() / told,
            false => 0.0,
        };
        let left = packed(self.time - self.end - took);
        self.end += took + left;
        self.tip = tip;
        let head = [0.0, block.line as f64, from, left, f64::from(kind), f64::from(reason)];
        self.waiting.extend(head);
        for name in &self.axes {
            let mut known = self.machine.axes.iter().zip(axes);
            let value = known.find(|(axis, _)| axis.name == *name);
            self.waiting.push_back(value.map_or(0.0, |(_, value)| value));
        }
        self.waiting.extend(pose.iter().flatten());
        self.waiting.extend([
            up(block.deviation.tip, self.scale),
            up(block.deviation.axis.to_degrees(), self.axis_scale),
            tolerance,
            feed,
            asked,
            limit,
            length,
        ]);
    }

    /// Length of the tool in use, mm: by how much the tip stands before the gauge point.
    fn length(&self, block: &Block) -> f64 {
        self.chain.as_ref().map_or(0.0, |chain| {
            let gauge = chain.forward(&block.joints).tip;
            (gauge - block.tip).dot(&block.axis)
        })
    }

    /// Where the tip goes in a block, for the table of the path.
    fn path(&mut self, row: u64, block: &Block, length: f64, end: Vector3<f64>) {
        let last = self.last.replace((block.line, block.joints, block.tip));
        let mut places = Vec::new();
        self.cl.advance(block.line);
        if let Some((line, joints, tip)) = last {
            self.cl.forget(line.min(block.line));
            match block.kind {
                MotionKind::Position | MotionKind::Reference => {}
                MotionKind::Arc | MotionKind::Spline => {
                    // Certified to be that of the CL file within the tolerance: where on it nobody has held it.
                    for place in self.cl.between(tip, block.tip) {
                        places.push((place, None));
                    }
                }
                MotionKind::Rapid | MotionKind::Linear => {
                    if let Some(middle) = self.middle(&joints, block, tip, length) {
                        let off = self.cl.off(middle);
                        places.push((middle, off));
                    }
                }
            }
        }
        let off = self.cl.off(block.tip);
        places.push((block.tip, off));
        let middle = last.filter(|_| places.len() == 2);
        let middle =
            middle.and_then(|(_, from, _)| self.derived.middle(&from, &block.joints, length));
        self.path.block(row, end, middle, &places);
    }

    /// Where the tip stands in the middle of a block, where that is not the middle of a straight line.
    fn middle(
        &self,
        from: &Joints,
        block: &Block,
        tip: Vector3<f64>,
        length: f64,
    ) -> Option<Vector3<f64>> {
        let chain = self.chain.as_ref()?;
        if self.machine.control.tcp == Tcp::Control {
            return None;
        }
        let mut middle = *from;
        for (value, to) in middle.iter_mut().zip(&block.joints) {
            *value = 0.5 * (*value + to);
        }
        let pose = chain.forward(&middle);
        let middle = pose.tip - pose.axis * length;
        let bow = (middle - 0.5 * (tip + block.tip)).norm();
        (bow > self.machine.accuracy.tolerance / 50.0).then_some(middle)
    }

    /// The number of a limit.
    fn limit(&mut self, name: &str) -> f64 {
        let known = self.limits.iter().position(|limit| limit == name);
        let place = known.unwrap_or_else(|| {
            self.limits.push(name.to_owned());
            self.limits.len() - 1
        });
        place as f64
    }

    fn command(&mut self, command: &Command) {
        let row = self.came;
        match command {
            Command::Hole(HoleMark::Above(_)) => self.event(row, "cycle", "hole".to_owned()),
            Command::Hole(HoleMark::Into { .. }) => self.hole = true,
            Command::Hole(HoleMark::Done) => self.hole = false,
            Command::Dwell(seconds) => {
                self.time += seconds;
                self.event(row, "dwell", format!("{seconds} s"));
            }
            Command::Tool(tool) => {
                let name = match tool.name.is_empty() {
                    true => String::new(),
                    false => format!(", {}", tool.name),
                };
                self.event(row, "tool", format!("tool {}{name}", tool.number));
            }
            Command::Operation(name) => self.event(row, "operation", name.clone()),
            Command::Head(name) => {
                let (machine, number) = axes::with_head(self.base, name);
                self.machine = machine;
                self.chain = chain(machine);
                self.branch = Branch::new(machine);
                self.heads.push([row, number]);
                self.event(row, "head", format!("head {name}"));
            }
            Command::Stop => self.event(row, "stop", "stop".to_owned()),
            Command::OptionalStop => self.event(row, "stop", "optional stop".to_owned()),
            _ => {}
        }
    }

    fn event(&mut self, row: u64, kind: &'static str, text: String) {
        if self.events.len() < MOST_EVENTS {
            self.events.push(Event { row, kind, text });
        } else {
            self.left_out += 1;
        }
    }
}

impl Observer for BlockRows<'_> {
    fn blocks(&mut self, blocks: &[Flow<Block>]) {
        for next in blocks {
            match next {
                Flow::Point(block) => self.block(block),
                Flow::Command { command, .. } => self.command(command),
            }
        }
    }

    fn lines(&mut self, lines: &[u64]) {
        self.written(lines.iter().copied());
    }
}
