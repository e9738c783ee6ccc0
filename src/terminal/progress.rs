//! A bar on a terminal, nothing in a pipe.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Records between two looks at the clock.
const EVERY: u64 = 4096;

/// How far reading has come.
pub struct Progress {
    bar: ProgressBar,
    records: u64,
}

impl Progress {
    /// A bar over `bytes` of input; of unknown length, a running count.
    pub fn new(bytes: Option<u64>) -> Self {
        let bar = match bytes {
            Some(bytes) => ProgressBar::new(bytes),
            None => ProgressBar::no_length(),
        };
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = "{bar:40} {percent}% of {total_bytes}, {eta} left";
        if let (Some(_), Ok(style)) = (bytes, ProgressStyle::with_template(style)) {
            bar.set_style(style);
        }
        Self { bar, records: 0 }
    }

    /// One more record; `position` bytes of the input are read.
    #[inline]
    pub fn record(&mut self, position: impl FnOnce() -> u64) {
        self.records += 1;
        if self.records.is_multiple_of(EVERY) {
            self.bar.set_position(position());
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
