//! Plain blocks of words that follow one another, many at once.

/// What the blocks of a run may say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NcRunRule {
    /// Bits of the letters that they may have, G aside: 1 of A, 2 of B.
    pub letters: u32,
    /// Bits of the letters of which each has one at least.
    pub some: u32,
    /// Bits of the letters that each must have.
    pub all: u32,
    /// Bits of the letters whose numbers must have a decimal point.
    pub pointed: u32,
    /// The number of the one G code that they may have; none: they have none.
    pub code: Option<f64>,
}

impl NcRunRule {
    /// Whether a block with words of these letters keeps to it.
    #[inline(always)]
    pub(super) fn takes(&self, letters: u32, pointless: u32, code: Option<f64>) -> bool {
        letters & !self.letters == 0
            && letters & self.some != 0
            && letters & self.all == self.all
            && pointless & self.pointed == 0
            && (code.is_none() || code == self.code)
    }
}

/// Blocks of words that follow one another, one a line: see [`NcReader::next_run`](super::NcReader::next_run).
#[derive(Clone, Debug)]
pub struct NcRun {
    pub(super) count: usize,
    /// Line of the first.
    pub(super) line: u64,
    /// Bits of the letters of each, G aside.
    pub(super) said: [u32; Self::MOST],
    /// Numbers of the words, by letter from A on. Where a block does not say a letter, anything.
    pub(super) columns: [[f64; Self::MOST]; Self::LETTERS],
    /// Numbers of the blocks.
    pub(super) numbers: [Option<u64>; Self::MOST],
    /// Bytes of the program from the beginning of the first block to the end of each.
    pub(super) ends: [usize; Self::MOST],
}

impl Default for NcRun {
    fn default() -> Self {
        Self {
            count: 0,
            line: 0,
            said: [0; Self::MOST],
            columns: [[0.0; Self::MOST]; Self::LETTERS],
            numbers: [None; Self::MOST],
            ends: [0; Self::MOST],
        }
    }
}

impl NcRun {
    /// Most blocks of a run.
    pub const MOST: usize = 64;

    /// Letters of words.
    pub const LETTERS: usize = 26;

    /// Takes all blocks out.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Number of blocks.
    #[inline]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Line of the program of a block, by its place in the run.
    #[inline]
    pub fn line(&self, place: usize) -> u64 {
        self.line + place as u64
    }

    /// The number of a block, by its place in the run.
    #[inline]
    pub fn number(&self, place: usize) -> Option<u64> {
        self.numbers[place]
    }

    /// Bits of the letters that each block says, G aside.
    #[inline]
    pub fn said(&self) -> &[u32] {
        &self.said[..self.count.min(Self::MOST)]
    }

    /// Numbers behind a letter, counted from A, program units. Where a block does not say it, anything.
    #[inline]
    pub fn column(&self, letter: usize) -> &[f64; Self::MOST] {
        &self.columns[letter % Self::LETTERS]
    }
}
