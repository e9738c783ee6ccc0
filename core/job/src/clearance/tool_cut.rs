//! What each tool takes of the stock.

use post_removal::chip::{Chip, Extent};
use post_removal::field::Volume;

/// A length of cuts, and the line of the program that makes the longest.
#[derive(Clone, Copy, Debug, Default)]
pub struct LongestAt {
    /// That of the longest, mm.
    pub extent: Extent,
    /// Where it may be longest; zero where there is none.
    pub line: u64,
}

/// What the line of the program takes that takes most.
#[derive(Clone, Copy, Debug, Default)]
pub struct MostAt {
    /// How much.
    pub volume: Volume,
    /// The line; zero where there is none.
    pub line: u64,
}

/// What a tool takes of the stock, and how far its cuts go into it.
#[derive(Clone, Copy, Debug)]
pub struct ToolCut {
    /// Its number.
    pub tool: u32,
    /// How much it takes.
    pub volume: Volume,
    /// Up from the tip along the tool axis.
    pub depth: LongestAt,
    /// Across the tool axis and the way.
    pub width: LongestAt,
    /// What it takes at most on a line of the program.
    pub most: MostAt,
    /// What the last line of the program has taken so far.
    last: MostAt,
}

impl ToolCut {
    /// A tool that has taken nothing.
    pub(super) fn new(tool: u32) -> Self {
        let (depth, width) = (LongestAt::default(), LongestAt::default());
        let (most, last) = (MostAt::default(), MostAt::default());
        Self { tool, volume: Volume::default(), depth, width, most, last }
    }

    /// Takes what all its cuts in a row came to: each by itself, and what was left before the first and behind the last.
    pub(super) fn add(&mut self, chips: Volume, [before, after]: [Volume; 2]) {
        self.volume += Volume {
            at_least: chips.at_least.max(before.at_least - after.at_most),
            at_most: chips.at_most.min(before.at_most - after.at_least),
        };
        // Of one line what its cuts may have taken twice counts twice.
        let most = &mut self.most.volume;
        most.at_most = most.at_most.min(self.volume.at_most);
    }

    /// Takes a cut of a line.
    pub(super) fn take(&mut self, chip: &Chip, line: u64) {
        let Self { last, most, .. } = self;
        if last.line != line {
            *last = MostAt { line, ..MostAt::default() };
        }
        last.volume += chip.volume;
        if last.volume.at_most > most.volume.at_most {
            *most = *last;
        }
        let Some(engagement) = chip.engagement else { return };
        let longest = |known: &mut LongestAt, extent: Extent| {
            if extent.at_most > known.extent.at_most {
                known.line = line;
            }
            known.extent = known.extent.max(extent);
        };
        longest(&mut self.depth, engagement.depth);
        longest(&mut self.width, engagement.width.unwrap_or_default());
    }
}
