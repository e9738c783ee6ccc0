//! What each tool takes of the stock.

use post_removal::chip::Chip;
use post_removal::field::Volume;

/// A length of a cut and the line of the program that makes it.
#[derive(Clone, Copy, Debug, Default)]
pub struct LongestAt {
    /// No cut is longer, mm.
    pub at_most: f64,
    /// Where it is longest.
    pub line: u64,
}

/// What a tool takes of the stock, and how far its straight cuts go into what may be left.
#[derive(Clone, Copy, Debug)]
pub struct ToolCut {
    /// Its number.
    pub tool: u32,
    /// How much it takes.
    pub volume: Volume,
    /// Up from the tip along the tool axis; zero where no cut is straight.
    pub depth: LongestAt,
    /// Across the tool axis and the way.
    pub width: LongestAt,
}

impl ToolCut {
    /// A tool that has taken nothing.
    pub(super) fn new(tool: u32) -> Self {
        let (depth, width) = (LongestAt::default(), LongestAt::default());
        Self { tool, volume: Volume::default(), depth, width }
    }

    /// Takes what all its cuts in a row came to: each by itself, and what was left before the first and behind the last.
    pub(super) fn add(&mut self, chips: Volume, [before, after]: [Volume; 2]) {
        self.volume += Volume {
            at_least: chips.at_least.max(before.at_least - after.at_most),
            at_most: chips.at_most.min(before.at_most - after.at_least),
        };
    }

    /// Takes how far a cut in a line goes.
    pub(super) fn take(&mut self, chip: &Chip, line: u64) {
        let Some(engagement) = chip.engagement else { return };
        let longest = |known: &mut LongestAt, at_most: f64| {
            if at_most > known.at_most {
                *known = LongestAt { at_most, line };
            }
        };
        longest(&mut self.depth, engagement.depth);
        longest(&mut self.width, engagement.width.unwrap_or(0.0));
    }
}
