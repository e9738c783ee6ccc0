//! The blocks of a program, as columns.

use post_machine::description::Machine;
use post_posting::program::{Command, HoleMark, Pace};
use post_posting::{Block, Flow, MotionKind, Observer, Reason};

/// What [`Blocks::kind`] counts.
pub const KINDS: [&str; 7] = ["position", "reference", "rapid", "linear", "arc", "spline", "hole"];

/// What [`Blocks::reason`] counts.
pub const REASONS: [&str; 9] =
    ["point", "eased", "put_in", "leave", "stage", "rewind", "feed", "above", "at_once"];

/// A row of each block; mm, degrees, s, part frame.
#[derive(Clone, Debug, Default)]
pub struct Blocks {
    /// Names of the axes of all heads: the columns of `q`.
    pub axes: Vec<String>,
    /// Line of the program; 0 of a block that prints nothing.
    pub nc_line: Vec<i64>,
    /// Line of the CL file.
    pub cl_line: Vec<i64>,
    /// How the tool comes to its end: a place in [`KINDS`].
    pub kind: Vec<u8>,
    /// Why it is there: a place in [`REASONS`].
    pub reason: Vec<u8>,
    /// When it ends, s; dwells counted in.
    pub time: Vec<f64>,
    /// Axis values at its end, as printed; no number for an axis that the head in use has not.
    pub q: Vec<f64>,
    /// Where the tip comes to stand.
    pub tip: Vec<f64>,
    /// The tool axis there.
    pub axis: Vec<f64>,
    /// Way of the tip.
    pub way: Vec<f64>,
    /// Certified: how far the tip strays at most.
    pub tip_deviation: Vec<f64>,
    /// Certified: how far the tool axis strays at most.
    pub axis_deviation: Vec<f64>,
    /// The tolerance of a rapid was enough for it.
    pub off_part: Vec<bool>,
    /// Feed of the tip, mm/min; no number where the block has none.
    pub feed: Vec<f64>,
    /// The feed that the CL file asks for, mm/min; no number in a rapid.
    pub asked_feed: Vec<f64>,
    /// What made it slower than asked: a place in `limits`, or -1.
    pub limit: Vec<i64>,
    /// Names of limits.
    pub limits: Vec<&'static str>,
}

impl Blocks {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.kind.len()
    }

    /// There is none.
    pub fn is_empty(&self) -> bool {
        self.kind.is_empty()
    }
}

/// Takes the blocks of a program that is made.
pub(super) struct BlockColumns<'m> {
    base: &'m Machine,
    /// With the head in use.
    machine: &'m Machine,
    /// Of each column the place of its axis in the machine; none that it has not.
    places: Vec<Option<usize>>,
    time: f64,
    hole: bool,
    blocks: Blocks,
}

impl<'m> BlockColumns<'m> {
    pub(super) fn new(machine: &'m Machine) -> Self {
        let heads = machine.heads.iter().map(|head| &head.machine);
        let mut axes: Vec<String> = Vec::new();
        for axis in std::iter::once(machine).chain(heads).flat_map(|one| &one.axes) {
            if !axes.contains(&axis.name) {
                axes.push(axis.name.clone());
            }
        }
        let mut columns = Self {
            base: machine,
            machine,
            places: Vec::new(),
            time: 0.0,
            hole: false,
            blocks: Blocks { axes, ..Blocks::default() },
        };
        columns.equip(machine);
        columns
    }

    pub(super) fn finish(mut self) -> Blocks {
        let count = self.blocks.len();
        self.blocks.nc_line.resize(count, 0);
        self.blocks
    }

    fn equip(&mut self, machine: &'m Machine) {
        self.machine = machine;
        let place = |name: &String| machine.axes.iter().position(|axis| axis.name == *name);
        self.places = self.blocks.axes.iter().map(place).collect();
    }

    fn block(&mut self, block: &Block) {
        let minutes = block.time.minutes;
        self.time += minutes * 60.0;
        let blocks = &mut self.blocks;
        blocks.cl_line.push(block.line as i64);
        blocks.kind.push(match (self.hole, block.kind) {
            (true, _) => 6,
            (_, MotionKind::Position) => 0,
            (_, MotionKind::Reference) => 1,
            (_, MotionKind::Rapid) => 2,
            (_, MotionKind::Linear) => 3,
            (_, MotionKind::Arc) => 4,
            (_, MotionKind::Spline) => 5,
        });
        blocks.reason.push(match block.reason {
            Reason::Point => 0,
            Reason::Eased => 1,
            Reason::PutIn => 2,
            Reason::Leave => 3,
            Reason::Stage => 4,
            Reason::Rewind => 5,
            Reason::Feed => 6,
            Reason::Above => 7,
            Reason::AtOnce => 8,
        });
        blocks.time.push(self.time);
        for place in &self.places {
            let value = place.map(|place| self.machine.axes[place].reading(block.joints[place]));
            blocks.q.push(value.unwrap_or(f64::NAN));
        }
        blocks.tip.extend_from_slice(block.tip.as_slice());
        blocks.axis.extend_from_slice(block.axis.as_slice());
        blocks.way.push(block.way);
        blocks.tip_deviation.push(block.deviation.tip);
        blocks.axis_deviation.push(block.deviation.axis.to_degrees());
        blocks.off_part.push(block.loose);
        let moves = block.time.feed.is_some() && minutes > 0.0;
        blocks.feed.push(match moves {
            true => block.way / minutes,
            false => f64::NAN,
        });
        blocks.asked_feed.push(match block.pace {
            Pace::PerMinute(feed) => feed,
            Pace::InverseTime(rate) => block.way * rate,
            Pace::Rapid => f64::NAN,
        });
        let limit = block.time.limit.or(block.planned.limit);
        blocks.limit.push(limit.map_or(-1, |name| {
            let known = blocks.limits.iter().position(|limit| *limit == name);
            known.unwrap_or_else(|| {
                blocks.limits.push(name);
                blocks.limits.len() - 1
            }) as i64
        }));
    }

    fn command(&mut self, command: &Command) {
        match command {
            Command::Hole(HoleMark::Into { .. }) => self.hole = true,
            Command::Hole(HoleMark::Done) => self.hole = false,
            Command::Dwell(seconds) => self.time += seconds,
            Command::Head(name) => {
                let base = self.base;
                self.equip(base.head(name).map_or(base, |head| &head.machine));
            }
            _ => {}
        }
    }
}

impl Observer for BlockColumns<'_> {
    fn blocks(&mut self, blocks: &[Flow<Block>]) {
        for next in blocks {
            match next {
                Flow::Point(block) => self.block(block),
                Flow::Command { command, .. } => self.command(command),
            }
        }
    }

    fn lines(&mut self, lines: &[u64]) {
        let lines = lines.iter().map(|line| *line as i64);
        self.blocks.nc_line.extend(lines);
    }
}
