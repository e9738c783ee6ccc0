//! The blocks of a program that is posted as rows, for the report's page and for arrays.

use post_machine::description::Machine;
use post_posting::program::{Command, MoveFeed};
use post_posting::{BlockKind, BlockReason, MotionBlock};

use super::axes::{self, AxisColumn};
use super::columns::Column;

/// What `PostedBlock::kind` counts.
pub const KINDS: [&str; 7] = ["position", "reference", "rapid", "linear", "arc", "spline", "hole"];

/// What `PostedBlock::reason` counts.
pub const REASONS: [&str; 9] =
    ["point", "eased", "put_in", "leave", "stage", "rewind", "feed", "above", "at_once"];

/// A block of a program, as rows tell of it.
#[derive(Clone, Debug)]
pub struct PostedBlock {
    /// The block.
    pub block: MotionBlock,
    /// How the tool comes to its end: a place in [`KINDS`].
    pub kind: u8,
    /// When it ends, s; dwells counted in.
    pub time: f64,
    /// Axis values at its end, as the control shows them, by columns.
    pub readings: Vec<Option<f64>>,
    /// What made it slower than asked: a place in the names of limits, or -1.
    pub limit: i64,
}

impl PostedBlock {
    /// Why it is there: a place in [`REASONS`].
    pub fn reason(&self) -> u8 {
        match self.block.reason {
            BlockReason::Point => 0,
            BlockReason::Eased => 1,
            BlockReason::PutIn => 2,
            BlockReason::Leave => 3,
            BlockReason::Stage => 4,
            BlockReason::Rewind => 5,
            BlockReason::Feed => 6,
            BlockReason::Above => 7,
            BlockReason::AtOnce => 8,
        }
    }

    /// Feed of the tip, mm/min; none where the block has none.
    pub fn feed(&self) -> Option<f64> {
        let minutes = self.block.time.minutes;
        let moves = self.block.time.feed.is_some() && minutes > 0.0;
        moves.then(|| self.block.way / minutes)
    }

    /// The feed that the CL file asks for, mm/min; none in a rapid.
    pub fn asked(&self) -> Option<f64> {
        match self.block.pace {
            MoveFeed::PerMinute(feed) => Some(feed),
            MoveFeed::InverseTime(rate) => Some(self.block.way * rate),
            MoveFeed::Rapid | MoveFeed::PerRevolution(_) => None,
        }
    }
}

/// The columns of arrays, one row a block; `axes` counts the columns of [`axes::of_all_heads`].
pub fn arrays(axes: usize) -> Vec<Column<PostedBlock>> {
    type C = Column<PostedBlock>;
    vec![
        C::new("nc_line", "", 0, |row| row.block.nc_line)
            .doc("line of the program; 0 of a block that prints nothing"),
        C::new("cl_line", "", 0, |row| row.block.line).doc("line of the CL file"),
        C::new("kind", "", 0, |row| row.kind).doc(listed("how the tool comes to its end", &KINDS)),
        C::new("reason", "", 0, PostedBlock::reason).doc(listed("why it is there", &REASONS)),
        C::new("limit", "", 0, |row| row.limit)
            .doc("what made it slower than asked; empty where nothing did"),
        C::new("off_part", "", 0, |row| row.block.loose)
            .doc("the tolerance of a rapid was enough for it"),
        C::wide("q", axes, |row, column| row.readings[column]).doc(
            "axis values at its end, as printed: (n, k), mm and degrees, in the order of :attr:`axes`",
        ),
        C::wide("tip", 3, |row, place| row.block.tip[place])
            .doc("where the tip comes to stand: (n, 3), mm, part frame"),
        C::wide("axis", 3, |row, place| row.block.axis[place]).doc("the tool axis there: (n, 3)"),
        C::new("time_s", "s", 4, |row| row.time).doc("when it ends; dwells counted in"),
        C::new("way_mm", "mm", 4, |row| row.block.way).doc("way of the tip"),
        C::new("tip_deviation_mm", "mm", 6, |row| row.block.deviation.tip)
            .doc("certified: how far the tip strays from the CL path at most"),
        C::new("axis_deviation_deg", "deg", 6, |row| row.block.deviation.axis.to_degrees())
            .doc("certified: how far the tool axis strays at most"),
        C::new("feed_mm_min", "mm/min", 1, PostedBlock::feed)
            .doc("feed of the tip; nan where the block has none"),
        C::new("asked_feed_mm_min", "mm/min", 1, PostedBlock::asked)
            .doc("the feed that the CL file asks for; nan in a rapid"),
    ]
}

/// What something is, and the words that it may be.
fn listed(what: &str, words: &[&str]) -> String {
    let (last, first) = words.split_last().unwrap_or((&"", &[]));
    format!("{what}: {} or {last}", first.join(", "))
}

/// What goes on from block to block of a program that is posted.
pub struct PostedProgram<'m> {
    base: &'m Machine,
    /// The machine with the head in use.
    pub machine: &'m Machine,
    /// Axes of all heads, in the order of their columns.
    pub axes: Vec<AxisColumn>,
    /// When the last block ended, s.
    pub time: f64,
    /// The blocks are those of a hole, from the retract level on.
    pub hole: bool,
    /// Names of limits, in the order in which they came.
    pub limits: Vec<String>,
}

impl<'m> PostedProgram<'m> {
    /// At its beginning.
    pub fn new(machine: &'m Machine) -> Self {
        Self {
            base: machine,
            machine,
            axes: axes::of_all_heads(machine),
            time: 0.0,
            hole: false,
            limits: Vec::new(),
        }
    }

    /// The row of the next block.
    pub fn block(&mut self, block: &MotionBlock) -> PostedBlock {
        self.time += block.time.minutes * 60.0;
        let readings = axes::readings(self.machine, &block.joints);
        let limit = block.time.limit.or(block.planned.limit);
        PostedBlock {
            block: *block,
            kind: match (self.hole, block.kind) {
                (true, _) => 6,
                (_, BlockKind::Position) => 0,
                (_, BlockKind::Reference) => 1,
                (_, BlockKind::Rapid) => 2,
                (_, BlockKind::Linear) => 3,
                (_, BlockKind::Arc) => 4,
                (_, BlockKind::Spline) => 5,
            },
            time: self.time,
            readings: axes::in_columns(&self.axes, self.machine, &readings),
            limit: limit.map_or(-1, |name| numbered(&mut self.limits, name)),
        }
    }

    /// What is commanded between blocks.
    pub fn command(&mut self, command: &Command) {
        match command {
            Command::Dwell(seconds) => self.time += seconds,
            Command::Head(name) => (self.machine, _) = axes::with_head(self.base, name),
            _ => {}
        }
    }
}

/// The place of a name among those that came, where it gets one if it has none.
pub fn numbered(names: &mut Vec<String>, name: &str) -> i64 {
    let known = names.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        names.push(name.to_owned());
        names.len() - 1
    }) as i64
}
