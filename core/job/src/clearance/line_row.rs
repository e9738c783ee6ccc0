//! What was found of each line of the program that moves.

use post_removal::chip::{Chip, Engagement, Extent};
use post_removal::field::Volume;

use super::Heard;
use crate::columns::Column;

/// Decimals of a length, mm, and of a volume, mm³.
const DECIMALS: u8 = 3;

/// A line of the program.
#[derive(Clone, Copy, Debug, Default)]
pub struct LineRow {
    line: u64,
    /// How often it is run.
    passes: u64,
    /// No two bodies are nearer, mm.
    clear_by: Option<f64>,
    chip: Chip,
}

impl LineRow {
    /// A line of which nothing is heard yet.
    fn new(line: u64) -> Self {
        Self { line, passes: 1, ..Self::default() }
    }

    /// Takes what is heard of a motion: of several of a line the nearest counts, and all that they cut. A line that is over
    /// comes back, once another is heard of.
    pub fn hear(&mut self, heard: &Heard) -> Option<Self> {
        let over =
            (self.line != heard.line).then(|| std::mem::replace(self, Self::new(heard.line)));
        self.clear_by = self.clear_by.into_iter().chain(heard.clear_by).reduce(f64::min);
        if let Some(chip) = heard.chip {
            self.chip += chip;
        }
        over.filter(Self::is_told)
    }

    /// Its line.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// With another pass of the line: of both the nearest counts, all that they cut, and the longest.
    pub(super) fn and(mut self, other: &Self) -> Self {
        self.passes += other.passes;
        self.clear_by = self.clear_by.into_iter().chain(other.clear_by).reduce(f64::min);
        self.chip += other.chip;
        self
    }

    /// Numbers of a row.
    pub(super) const NUMBERS: usize = 8;

    /// Its numbers, to be read back by [`LineRow::of`]: no number where nothing is known.
    pub(super) fn numbers(&self) -> [f64; Self::NUMBERS] {
        let Chip { volume, engagement } = self.chip;
        let ends = |extent: Option<Extent>| {
            extent.map_or([f64::NAN; 2], |extent| [extent.at_least, extent.at_most])
        };
        let [deep, deepest] = ends(engagement.map(|engagement| engagement.depth));
        let [wide, widest] = ends(engagement.and_then(|engagement| engagement.width));
        let clear_by = self.clear_by.unwrap_or(f64::NAN);
        let passes = self.passes as f64;
        [passes, clear_by, volume.at_least, volume.at_most, deep, deepest, wide, widest]
    }

    /// The row of these numbers; none of zeros, where nothing was written.
    pub(super) fn of(line: u64, numbers: [f64; Self::NUMBERS]) -> Option<Self> {
        let [passes, clear_by, at_least, at_most, deep, deepest, wide, widest] = numbers;
        let known = |value: f64| (!value.is_nan()).then_some(value);
        let extent = |least, most| Some(Extent { at_least: known(least)?, at_most: known(most)? });
        let width = extent(wide, widest);
        let engagement = extent(deep, deepest).map(|depth| Engagement { depth, width });
        let chip = Chip { volume: Volume { at_least, at_most }, engagement };
        let row = Self { line, passes: passes as u64, clear_by: known(clear_by), chip };
        (passes > 0.0).then_some(row)
    }

    /// Something was heard of it.
    pub fn is_told(&self) -> bool {
        self.line > 0 && (self.clear_by.is_some() || self.chip != Chip::default())
    }

    fn engaged(&self, of: impl Fn(Engagement) -> Option<Extent>) -> Option<Extent> {
        self.chip.engagement.and_then(of).filter(|extent| extent.at_most > 0.0)
    }

    /// The columns of what is told of a line in short: how near bodies come, mm, and of a stock that is cut, how much is taken
    /// of it and how far the cut goes into it, no more than that.
    pub fn short_columns(cuts: bool) -> Vec<Column<Self>> {
        type C = Column<LineRow>;
        let mut columns = vec![
            C::new("nc", "", 0, |row| row.line),
            // The page has no number for none.
            C::new("clearance", "mm", DECIMALS, |row| row.clear_by.map_or(-1.0, rounded)),
        ];
        if cuts {
            columns.extend([
                C::new("chip", "mm³", DECIMALS, |row| row.chip.volume.at_most),
                C::new("cut_depth", "mm", DECIMALS, |row| row.depth().map(|depth| depth.at_most)),
                C::new("cut_width", "mm", DECIMALS, |row| row.width().map(|width| width.at_most)),
            ]);
        }
        columns
    }

    fn depth(&self) -> Option<Extent> {
        self.engaged(|engagement| Some(engagement.depth))
    }

    fn width(&self) -> Option<Extent> {
        self.engaged(|engagement| engagement.width)
    }

    /// The columns of the table: all bounds.
    pub fn columns() -> Vec<Column<Self>> {
        type C = Column<LineRow>;
        let least = |extent: Option<Extent>| extent.map(|extent| extent.at_least);
        let most = |extent: Option<Extent>| extent.map(|extent| extent.at_most);
        vec![
            C::new("line", "", 0, |row| row.line),
            C::new("passes", "", 0, |row| row.passes),
            C::new("clear_by", "mm", DECIMALS, |row| row.clear_by.map(rounded)),
            C::new("cut_at_least", "mm³", DECIMALS, |row| row.chip.volume.at_least),
            C::new("cut_at_most", "mm³", DECIMALS, |row| row.chip.volume.at_most),
            C::new("depth_at_least", "mm", DECIMALS, move |row| least(row.depth())),
            C::new("depth_at_most", "mm", DECIMALS, move |row| most(row.depth())),
            C::new("width_at_least", "mm", DECIMALS, move |row| least(row.width())),
            C::new("width_at_most", "mm", DECIMALS, move |row| most(row.width())),
        ]
    }
}

/// Rounded down as it is packed: no more is told than is proven.
fn rounded(distance: f64) -> f64 {
    libm::floor(distance * 1e3 + 1e-3) / 1e3
}
