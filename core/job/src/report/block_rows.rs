//! The blocks of a program that is posted, row by row.

use std::io::{self, BufReader, Read, Write as _};

use nalgebra::Vector3;
use post_machine::description::{Machine, Tcp};
use post_machine::kinematics::{Chain, Joints};
use post_posting::program::Command;
use post_posting::{BlockKind, BlockReason, HoleMoves, MotionBlock, Observer};
use post_report::meta::Meta;

use super::branch::{self, Branch};
use super::cl_points::Points;
use super::cl_window::ClWindow;
use super::derived::{Derived, PackedValues};
use super::marks::{Marks, cutter};
use super::page_table::PageTable;
use super::parts::{Parts, fault};
use super::path_rows::PathRows;
use crate::axes::{self, AxisColumn};
use crate::columns::Column;
use crate::failure::Failure;
use crate::files::Scratch;
use crate::posted::{PostedBlock, PostedProgram};

/// Deviations that differ by less are the same, as in the summary: mm or radians.
const EQUAL: f64 = 1e-9;

/// The largest of something and its row.
#[derive(Clone, Copy, Debug, Default)]
pub struct PeakRow {
    value: f64,
    row: u64,
    nc: u64,
}

/// A row of the page.
struct BlockRow {
    posted: PostedBlock,
    /// When the block begins and ends, as they are packed.
    times: [f64; 2],
    left: PackedValues,
    /// Of the tip, mm.
    tolerance: f64,
    /// By how much the tip stands before the gauge point, mm.
    tool_length: f64,
}

/// The columns of the page.
fn columns(machine: &Machine, axes: &[AxisColumn], derived: &Derived<'_>) -> Vec<Column<BlockRow>> {
    type C = Column<BlockRow>;
    let accuracy = &machine.accuracy;
    let [tip, turn] = [accuracy.tolerance, accuracy.axis_tolerance.to_degrees()].map(decimals);
    let [tips, turns] = [tip, turn].map(power);
    let mut columns = vec![
        C::new("nc", "", 0, |row| row.posted.block.nc_line),
        C::new("cl", "", 0, |row| row.posted.block.line),
        C::new("t0", "s", 4, |row| row.times[0]).from("t1"),
        C::new("t1", "s", 4, |row| row.times[1]).from("way"),
        C::new("kind", "", 0, |row| row.posted.kind),
        C::new("reason", "", 0, |row| row.posted.reason()),
    ];
    columns.extend(derived.columns(axes, |row: &BlockRow| &row.left));
    columns.extend([
        C::new("deviation", "mm", tip, move |row| up(row.posted.block.deviation.tip, tips)),
        C::new("axis_deviation", "deg", turn, move |row| {
            up(row.posted.block.deviation.axis.to_degrees(), turns)
        }),
        C::new("tolerance", "mm", 6, |row| row.tolerance),
        C::new("feed", "mm/min", 1, |row| row.posted.feed()),
        C::new("asked", "mm/min", 1, |row| row.posted.feed().and(row.posted.asked())),
        C::new("limit", "", 0, |row| row.posted.limit),
        C::new("tool_length", "mm", 4, |row| row.tool_length),
    ]);
    columns
}

/// Takes blocks, and packs a row of each.
pub struct BlockRows<'m> {
    base: &'m Machine,
    program: PostedProgram<'m>,
    table: PageTable<BlockRow>,
    /// End of the last block, s, and its tip, as the page will have them.
    end: f64,
    tip: Vector3<f64>,
    reason: BlockReason,
    marks: Marks,
    /// Tip and axis in cuts, tip in rapids.
    largest: [PeakRow; 3],
    fault: Option<Failure>,
    path: PathRows,
    /// Places of the path of a block, and how far each is off the path of the CL file: room that is used again.
    places: Vec<(Vector3<f64>, Option<Vector3<f64>>)>,
    cl: ClWindow,
    derived: Derived<'m>,
    branch: Branch,
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
        let program = PostedProgram::new(machine);
        let derived = Derived::new(machine);
        let columns = columns(machine, &program.axes, &derived);
        Ok(Self {
            base: machine,
            program,
            table: PageTable::new("blocks", columns)?,
            end: 0.0,
            tip: Vector3::zeros(),
            reason: BlockReason::Point,
            marks: Marks::default(),
            largest: [PeakRow::default(); 3],
            fault: None,
            path: PathRows::new(machine)?,
            places: Vec::new(),
            derived,
            branch: Branch::new(machine),
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
        let Some(lines) = self.lines.take() else {
            return Ok(None);
        };
        let mut lines = lines.reread()?;
        io::Seek::rewind(&mut lines).map_err(fault)?;
        Ok(Some(Box::new(BufReader::new(lines))))
    }

    /// All blocks have come: their table goes to `parts`, and what was seen to `meta`.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn finish(self, parts: &mut Parts, meta: &mut Meta) -> Result<(), Failure> {
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
        meta.checks = self.derived.checks();
        meta.limits = self.program.limits;
        self.marks.finish(meta);
        self.table.finish(parts)
    }

    /// Length of the tool in use, mm: by how much the tip stands before the gauge point.
    fn length(&self, block: &MotionBlock) -> f64 {
        self.chain.as_ref().map_or(0.0, |chain| {
            let gauge = chain.forward(&block.joints).tip;
            (gauge - block.tip).dot(&block.axis)
        })
    }

    /// Where the tip goes in a block, for the table of the path.
    fn path(&mut self, row: u64, block: &MotionBlock, length: f64, end: Vector3<f64>) {
        let last = self.last.replace((block.line, block.joints, block.tip));
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        self.cl.advance(block.line);
        if let Some((line, joints, tip)) = last {
            self.cl.forget(line.min(block.line));
            match block.kind {
                BlockKind::Position | BlockKind::Reference => {}
                BlockKind::Arc | BlockKind::Spline => {
                    // Certified to be that of the CL file within the tolerance: where on it nobody has held it.
                    for place in self.cl.between(tip, block.tip) {
                        places.push((place, None));
                    }
                }
                BlockKind::Rapid | BlockKind::Linear => {
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
        self.places = places;
    }

    /// Where the tip stands in the middle of a block, where that is not the middle of a straight line.
    fn middle(
        &self,
        from: &Joints,
        block: &MotionBlock,
        tip: Vector3<f64>,
        length: f64,
    ) -> Option<Vector3<f64>> {
        let chain = self.chain.as_ref()?;
        if self.program.machine.control.tcp == Tcp::Control {
            return None;
        }
        let mut middle = *from;
        for (value, to) in middle.iter_mut().zip(&block.joints) {
            *value = 0.5 * (*value + to);
        }
        let pose = chain.forward(&middle);
        let middle = pose.tip - pose.axis * length;
        let bow = (middle - 0.5 * (tip + block.tip)).norm();
        (bow > self.program.machine.accuracy.tolerance / 50.0).then_some(middle)
    }
}

impl Observer for BlockRows<'_> {
    fn block(&mut self, block: &MotionBlock) {
        let row = self.table.rows();
        // Told against the end of the block before.
        let from = self.program.time - self.end;
        let mut posted = self.program.block(block);
        if block.reason == BlockReason::Rewind && self.reason != BlockReason::Rewind {
            self.marks.event(row, "rewind", "the tool is drawn back to turn");
        }
        self.reason = block.reason;
        if self.branch.changes(&block.joints) {
            self.marks.event(row, "branch", branch::CHANGED);
        }
        let machine = self.program.machine;
        let accuracy = &machine.accuracy;
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
                *largest = PeakRow { value, row, nc: block.nc_line };
            }
        }
        let length = self.length(block);
        let pose = [block.tip, block.axis];
        let shown = std::mem::take(&mut posted.readings);
        let columns = &self.program.axes;
        let left = self.derived.left(machine, columns, shown, &block.joints, pose, length);
        let tip = left.tip;
        self.derived.check(row, &block.joints, length);
        self.path(row, block, length, tip);
        self.ends.push(block.line, tip, 0.0);
        // Told against what a straight way takes at the feed.
        let told = (posted.feed().unwrap_or(0.0) * 10.0).round_ties_even() / 10.0;
        let took = match told > 0.0 {
            true => 60.0 * (tip - self.tip).norm() / told,
            false => 0.0,
        };
        let to = packed(self.program.time - self.end - took);
        self.end += took + to;
        self.tip = tip;
        let times = [from, to];
        let kept =
            self.table.row(&BlockRow { posted, times, left, tolerance, tool_length: length });
        if let (true, Some(lines)) = (kept, &mut self.lines)
            && let Err(error) = lines.write_all(&(block.nc_line as u32).to_le_bytes())
        {
            self.fault.get_or_insert(fault(error));
        }
    }

    fn hole(&mut self, hole: &HoleMoves<MotionBlock>) {
        self.marks.event(self.table.rows(), "cycle", "hole".to_owned());
        self.blocks(&hole.above);
        self.program.hole = true;
        self.blocks(&hole.into);
        self.program.hole = false;
    }

    fn command(&mut self, _: u64, command: &Command) {
        let row = self.table.rows();
        self.program.command(command);
        let mut event = |kind, text: String| self.marks.event(row, kind, text);
        match command {
            Command::Dwell(seconds) => event("dwell", format!("{seconds} s")),
            Command::Tool(tool) => {
                let name = match tool.name.is_empty() {
                    true => String::new(),
                    false => format!(", {}", tool.name),
                };
                let table = self.base.tool_table.as_ref();
                let listed = table.and_then(|table| table.entry(tool.number, tool.register));
                let size = cutter([tool.diameter, tool.corner_radius], listed);
                let outline = self.base.outline(tool.number);
                self.marks.tool(row, format!("tool {}{name}", tool.number), size, outline);
            }
            Command::Operation(name) => event("operation", name.clone()),
            Command::Head(name) => {
                let (machine, number) = axes::with_head(self.base, name);
                self.chain = chain(machine);
                self.branch = Branch::new(machine);
                self.marks.head(row, name, number);
            }
            Command::Stop => event("stop", "stop".to_owned()),
            Command::Sync(wait) => {
                event("stop", format!("waits for channels at mark {}", wait.mark))
            }
            Command::OptionalStop => event("stop", "optional stop".to_owned()),
            _ => {}
        }
    }
}
