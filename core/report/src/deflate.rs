//! Deflate, piece by piece: each piece has a block of its own, since what is usual in one column is not in the next.

use miniz_oxide::deflate::core::{
    CompressorOxide, TDEFLFlush, compress_to_output, create_comp_flags_from_zip_params,
};

/// How hard it looks for repetitions, 0 to 10. Differences hardly repeat: what counts is the code, and more looking
/// costs time and gains nothing.
const NUMBERS: i32 = 4;

/// Level for texts that go as they are.
const TEXTS: i32 = 6;

/// A packer that is used again and again.
pub struct Deflate {
    compressor: Box<CompressorOxide>,
    packed: Vec<u8>,
}

impl Deflate {
    /// Packer for columns of numbers.
    pub fn of_numbers() -> Self {
        Self::new(NUMBERS)
    }

    /// Packer for texts.
    pub fn of_texts() -> Self {
        Self::new(TEXTS)
    }

    fn new(level: i32) -> Self {
        // Raw: no header, no checksum (a negative window).
        let flags = create_comp_flags_from_zip_params(level, -15, 0);
        Self { compressor: Box::new(CompressorOxide::new(flags)), packed: Vec::new() }
    }

    /// Adds a piece, in a block of its own.
    pub fn piece(&mut self, bytes: &[u8]) {
        self.feed(bytes, TDEFLFlush::Sync);
    }

    /// All pieces since it was taken last, packed.
    pub fn take(&mut self, to: &mut Vec<u8>) {
        self.feed(&[], TDEFLFlush::Finish);
        self.compressor.reset();
        to.clear();
        to.append(&mut self.packed);
    }

    fn feed(&mut self, bytes: &[u8], flush: TDEFLFlush) {
        let packed = &mut self.packed;
        compress_to_output(&mut self.compressor, bytes, flush, |some| {
            packed.extend_from_slice(some);
            true
        });
    }
}
