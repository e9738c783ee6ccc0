//! A bar on a terminal, nothing in a pipe.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use post_job::session::Bar;

/// A bar over `bytes` of input; of unknown length, a running count.
pub fn bytes(bytes: Option<u64>) -> BytesProgress {
    let bar = match bytes {
        Some(bytes) => ProgressBar::new(bytes),
        None => ProgressBar::no_length(),
    };
    // What cannot be read ends it too.
    let bar = bar.with_finish(ProgressFinish::AndClear);
    let style = "{bar:40} {percent}% of {total_bytes}, {eta} left";
    if let (Some(_), Ok(style)) = (bytes, ProgressStyle::with_template(style)) {
        bar.set_style(style);
    }
    BytesProgress(bar)
}

/// How many bytes are read.
pub struct BytesProgress(ProgressBar);

impl Bar for BytesProgress {
    fn set(&self, position: u64) {
        self.0.set_position(position);
    }
}

/// How many of so many jobs are done.
pub struct JobsProgress {
    bar: ProgressBar,
}

impl JobsProgress {
    /// A bar over so many jobs.
    pub fn new(jobs: u64) -> Self {
        let bar = ProgressBar::new(jobs).with_finish(ProgressFinish::AndClear);
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{bar:40} {pos} of {len} jobs, {eta} left{msg}")
        {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// So many are done, so many of them refused.
    pub fn at(&self, done: u64, refused: u64) {
        self.bar.set_position(done);
        if refused > 0 {
            self.bar.set_message(format!(", {refused} refused"));
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
