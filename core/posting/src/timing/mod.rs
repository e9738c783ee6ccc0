//! How long a block takes, and how its feed is written.
//!
//! The feed of a CL file is that of the tip against the part. It fixes the nominal time of a block; no limit of the
//! machine may be passed in it; the time is then written as the control understands it.

mod feed;
pub mod limits;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::Format;

use crate::blocks::{Block, MotionKind};
use crate::program::{Command, Pace};
use crate::stream::Flow;
use feed::FeedWriter;
use limits::Limit;

/// The stage that gives every block its time and feed.
#[derive(Debug)]
pub(crate) struct Timing<'a> {
    base: &'a Machine,
    format: Format,
    feeds: FeedWriter,
    limits: Vec<Box<dyn Limit>>,
    /// Where the axes stand.
    last: Joints,
    statistics: Durations,
}

/// Sums of times, minutes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Durations {
    /// Of cuts.
    pub cutting: f64,
    /// Of rapids and dwells.
    pub other: f64,
    /// Blocks slowed down by a limit.
    pub limited: u64,
}

impl<'a> Timing<'a> {
    /// # Errors
    /// The machine asks for inverse time, and the dialect has none.
    pub(crate) fn new(machine: &'a Machine, format: &Format) -> Result<Self, Box<Diagnostic>> {
        let feeds = FeedWriter::new(machine, format).ok_or_else(|| {
            Diagnostic::error(
                "feed-mode",
                format!(
                    "[control] asks for inverse time feeds, and the dialect {} has none",
                    machine.control.dialect
                ),
            )
            .help("feed = \"per-minute\"")
            .boxed()
        })?;
        Ok(Self {
            base: machine,
            format: format.clone(),
            feeds,
            limits: limits::of(machine),
            last: Joints::default(),
            statistics: Durations::default(),
        })
    }

    /// Sums so far.
    pub(crate) fn statistics(&self) -> Durations {
        self.statistics
    }

    /// Fills in the times of a batch.
    pub(crate) fn take(&mut self, batch: &mut [Flow<Block>]) {
        for next in batch {
            match next {
                Flow::Point(block) => self.block(block),
                Flow::Command { command, .. } => self.command(command),
            }
        }
    }

    fn command(&mut self, command: &Command) {
        match command {
            Command::Dwell(seconds) => self.statistics.other += seconds / 60.0,
            Command::Head(name) => {
                let Some(head) = self.base.head(name) else {
                    return;
                };
                if let Some(feeds) = FeedWriter::new(&head.machine, &self.format) {
                    self.feeds = feeds;
                }
                self.limits = limits::of(&head.machine);
            }
            _ => {}
        }
    }

    #[inline]
    fn block(&mut self, block: &mut Block) {
        if block.still {
            return;
        }
        match block.kind {
            MotionKind::Position | MotionKind::Reference => {
                self.last = block.joints;
                // A time for a way that nobody knows has no meaning; the way is made at rapid.
                if matches!(block.pace, Pace::PerMinute(_)) {
                    let minutes = block.nominal.minutes.max(1e-9);
                    block.time.feed = Some(self.feeds.write(block, &self.last, minutes));
                }
            }
            MotionKind::Rapid => {
                block.time.minutes = self.least(block).0;
                self.statistics.other += block.time.minutes;
            }
            MotionKind::Linear => self.cut(block),
        }
        self.last = block.joints;
    }

    #[inline]
    fn cut(&mut self, block: &mut Block) {
        let asked = match block.pace {
            Pace::PerMinute(feed) if block.nominal.moves => {
                block.nominal.minutes.max(block.way[0] / feed)
            }
            _ => block.nominal.minutes,
        };
        let (least, limit) = self.least(block);
        block.time.minutes = asked.max(least).max(1e-9);
        block.time.limit = limit
            .filter(|_| least > asked * (1.0 + 1e-9))
            .map(Limit::name);
        block.time.feed = Some(self.feeds.write(block, &self.last, block.time.minutes));
        self.statistics.limited += u64::from(block.time.limit.is_some());
        self.statistics.cutting += block.time.minutes;
    }

    /// The least time that all limits leave a block, minutes, and the limit that asks for it.
    #[inline]
    fn least(&self, block: &Block) -> (f64, Option<&dyn Limit>) {
        let mut least = (0.0, None);
        for limit in &self.limits {
            let minutes = limit.least_minutes(&self.last, block);
            if minutes > least.0 {
                least = (minutes, Some(&**limit));
            }
        }
        least
    }
}
