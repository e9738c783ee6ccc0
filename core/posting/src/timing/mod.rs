//! How long a block takes, and how its feed is written.
//!
//! The feed of a CL file is that of the tip against the part. It fixes the nominal time of a block; no limit of the
//! machine may be passed in it; the time is then written as the control understands it, and what counts is what the
//! control makes of the printed numbers.

mod columns;
mod feed;
pub mod limits;
mod rapids;
mod turning;

use post_machine::along_word::AlongPrinter;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, LimitExcess};
use post_machine::kinematics::Joints;
use post_plugin::{Capabilities, Feed, Format};

use crate::blocks::{BlockKind, MotionBlock};
use crate::findings::Findings;
use crate::program::limits::MOST_WAITS;
use crate::program::{Command, MoveFeed, SyncWait};
use crate::report::ReportedWait;
use crate::stream::StreamItem;
pub(crate) use columns::TimedRun;
use feed::{FeedWriter, WrittenFeed};
use limits::BlockTimeLimit;
use rapids::Rapids;
use turning::TurningSpeed;

/// The stage that gives every block its time and feed.
#[derive(Debug)]
pub(crate) struct TimingStage<'a> {
    base: &'a Machine,
    format: Format,
    writes: Capabilities,
    feeds: FeedWriter,
    limits: Vec<Box<dyn BlockTimeLimit>>,
    /// Minutes that each axis needs for one mm or radian at its largest feed.
    slowness: Joints,
    rapids: Rapids,
    /// How fast the part turns.
    turning: TurningSpeed,
    /// Where the axes stand.
    last: Joints,
    /// The word that goes with the way of the tip, and that way in cuts so far, mm.
    along: Option<AlongPrinter>,
    way: f64,
    statistics: Durations,
    waits: Vec<ReportedWait>,
    low: LowFeeds,
    findings: Findings,
}

/// Sums of times, minutes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Durations {
    /// Time of cuts.
    pub cutting: f64,
    /// Time of rapids and dwells.
    pub other: f64,
    /// Blocks slowed down by a limit.
    pub limited: u64,
    /// Blocks among them that are slowed down because the control takes no larger F by time.
    pub capped: u64,
}

/// Feeds below the least that is printed.
#[derive(Clone, Copy, Debug, Default)]
struct LowFeeds {
    count: u64,
    /// The lowest, as it would be printed.
    lowest: f64,
    /// Line of the CL file with the lowest.
    line: u64,
    /// What is written instead.
    least: f64,
}

impl<'a> TimingStage<'a> {
    /// # Errors
    /// The machine asks for inverse time, and the dialect has none.
    pub(crate) fn new(
        machine: &'a Machine,
        format: &Format,
        writes: Capabilities,
        findings: &Findings,
    ) -> Result<Self, Box<Diagnostic>> {
        let feeds = FeedWriter::new(machine, format, writes).ok_or_else(|| {
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
            writes,
            feeds,
            limits: limits::of(machine),
            slowness: machine.slowness(),
            rapids: Rapids::new(machine, writes),
            turning: TurningSpeed::default(),
            last: Joints::default(),
            along: AlongPrinter::new(machine, format),
            way: 0.0,
            statistics: Durations::default(),
            waits: Vec::new(),
            low: LowFeeds::default(),
            findings: findings.clone(),
        })
    }

    /// The waits for other channels so far.
    pub(crate) fn waits(&self) -> &[ReportedWait] {
        &self.waits
    }

    /// Sums so far.
    pub(crate) fn statistics(&self) -> Durations {
        self.statistics
    }

    /// Rapids so far in which an axis passes its largest feed.
    pub(crate) fn rapids(&self) -> &Rapids {
        &self.rapids
    }

    /// The warning that feeds are higher than the CL file asks for, because none so low is printed.
    pub(crate) fn low_feeds(&self) -> Option<Diagnostic> {
        let low = &self.low;
        let blocks = match low.count {
            0 => return None,
            1 => "the feed of a block is".to_owned(),
            count => format!("the feeds of {count} blocks are"),
        };
        let message = format!(
            "{blocks} below F{}, the least that the dialect {} prints, and F{} is written: the lowest would be F{}, on CL line {}",
            plain(low.least),
            self.base.control.dialect,
            plain(low.least),
            plain(low.lowest),
            low.line
        );
        Some(
            Diagnostic::warning("low-feed", message)
                .help("a higher FEDRAT, or more decimals for feeds among the dialect's options"),
        )
    }

    /// Fills in the times of a batch.
    pub(crate) fn take(&mut self, batch: &mut [StreamItem<MotionBlock>]) {
        for next in batch {
            let block = match next {
                StreamItem::Point(block) => block,
                StreamItem::Curve { curve, .. } => &mut curve.block,
                StreamItem::Hole(hole) => {
                    self.take(&mut hole.above);
                    self.take(&mut hole.into);
                    continue;
                }
                StreamItem::Command { line, command } => {
                    self.command(*line, command);
                    continue;
                }
                StreamItem::Note { .. } => continue,
            };
            self.block(block);
        }
    }

    fn command(&mut self, line: u64, command: &Command) {
        match command {
            Command::Dwell(seconds) => self.statistics.other += seconds / 60.0,
            Command::Spindle(spindle) => self.turning.turn(*spindle),
            Command::SurfaceSpeed { speed, most, .. } => self.turning.keep(*speed, *most),
            Command::Sync(SyncWait { mark, line: wait }) => {
                if self.waits.len() == MOST_WAITS {
                    let message = format!("more than {MOST_WAITS} waits for other channels");
                    let help = "is this a cutter-location file?";
                    self.findings.at(line, Diagnostic::error("wait", message).help(help));
                    return;
                }
                let time = self.statistics.cutting + self.statistics.other;
                self.waits.push(ReportedWait {
                    mark: *mark,
                    channels: wait.channels.clone(),
                    line,
                    time_s: time * 60.0,
                    waits_s: None,
                });
            }
            Command::Head(name) => {
                let Some(machine) = self.base.changed_to(name) else {
                    return;
                };
                if let Some(feeds) = FeedWriter::new(machine, &self.format, self.writes) {
                    self.feeds = feeds;
                }
                self.limits = limits::of(machine);
                self.slowness = machine.slowness();
                self.rapids.set(machine);
            }
            _ => {}
        }
    }

    #[inline]
    fn block(&mut self, block: &mut MotionBlock) {
        if let Some(along) = &self.along {
            self.way += if block.kind.cuts() { block.way } else { 0.0 };
            along.print(self.way, &mut block.words);
        }
        if block.still {
            return;
        }
        match block.kind {
            BlockKind::Position | BlockKind::Reference => self.approach(block),
            BlockKind::Rapid => self.rapid(block),
            BlockKind::Linear | BlockKind::Arc | BlockKind::Spline => self.cut(block),
        }
        self.last = block.joints;
        self.rapids.stand(block.tip);
        self.turning.stand(block.tip);
    }

    /// A time for a way that is not known has no meaning; without a feed a minute the way is made at rapid.
    fn approach(&mut self, block: &mut MotionBlock) {
        if let MoveFeed::PerMinute(feed) = block.pace {
            let (written, limited) = self.feeds.approach(feed);
            if limited {
                block.time.limit = Some("max_feed");
                self.statistics.limited += 1;
            }
            self.note_raised(block.line, &written);
            block.time.feed = Some(written.feed);
        } else if let MoveFeed::PerRevolution(feed) = block.pace {
            block.time.feed = self.feeds.per_revolution(feed).map(Feed::PerRevolution);
        } else if let Some(feed) = self.rapids.feed_down(block) {
            block.time.feed = Some(self.feeds.approach(feed).0.feed);
        }
    }

    /// A rapid takes what its slowest axis needs, or the control's feed of rapids; where its axes would go too fast, or each for itself, it is written
    /// as a feed move, if the machine file says so.
    fn rapid(&mut self, block: &mut MotionBlock) {
        let (least, ..) = self.least(block);
        block.time.minutes = least;
        if self.rapids.is_fed(&self.last, block, least) {
            let written = self.feeds.write(block, &self.last, least);
            self.put(block, written, least);
        } else {
            block.time.minutes = least.max(self.feeds.rapid_minutes(&self.last, block));
        }
        self.statistics.other += block.time.minutes;
    }

    #[inline]
    fn cut(&mut self, block: &mut MotionBlock) {
        if let MoveFeed::PerRevolution(feed) = block.pace {
            return self.turned(block, feed);
        }
        let (least, limit, needed) = self.least(block);
        block.time.limit =
            limit.filter(|_| least > block.asked() * (1.0 + 1e-9)).map(|limit| limit.name(block));
        let written = self.feeds.write(block, &self.last, least);
        if written.capped {
            block.time.limit = Some("most_inverse_time");
            self.statistics.capped += 1;
        }
        self.put(block, written, needed);
        self.statistics.limited += u64::from(block.time.limit.is_some());
        // Drawn back at a feed, the tool is off the part.
        match block.loose {
            true => self.statistics.other += block.time.minutes,
            false => self.statistics.cutting += block.time.minutes,
        }
    }

    /// Puts a feed into a block that must take `least` minutes.
    #[inline]
    fn put(&mut self, block: &mut MotionBlock, written: WrittenFeed, least: f64) {
        block.time.minutes = written.minutes;
        block.time.feed = Some(written.feed);
        let Some(asked) = written.raised_from else {
            return;
        };
        if written.minutes < least * (1.0 - 1e-9) {
            self.findings.at(block.line, too_fast(asked, &written));
        } else {
            self.note_raised(block.line, &written);
        }
    }

    #[inline]
    fn note_raised(&mut self, line: u64, written: &WrittenFeed) {
        let Some(lowest) = written.raised_from else {
            return;
        };
        if self.low.count == 0 || lowest < self.low.lowest {
            self.low = LowFeeds { lowest, line, least: written.feed.value(), ..self.low };
        }
        self.low.count += 1;
    }

    /// The least time that all limits leave a block, minutes, the limit that asks for it, and the least time that the axes
    /// need.
    #[inline]
    fn least(&self, block: &MotionBlock) -> (f64, Option<&dyn BlockTimeLimit>, f64) {
        let mut least = (0.0, None);
        let mut needed = 0.0;
        for limit in &self.limits {
            let minutes = limit.least_minutes(&self.last, block);
            if minutes > least.0 {
                least = (minutes, Some(&**limit));
            }
            if limit.must_hold() && minutes > needed {
                needed = minutes;
            }
        }
        (least.0, least.1, needed)
    }
}

/// A small number as people write it: no more than three digits after the zeros.
fn plain(value: f64) -> String {
    let zeros = if value > 0.0 { libm::floor(-libm::log10(value)).max(0.0) } else { 0.0 };
    let text = format!("{value:.0$}", zeros.min(12.0) as usize + 3);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The least feed that is printed is too fast for the axes.
fn too_fast(asked: f64, written: &WrittenFeed) -> Diagnostic {
    let least = written.feed.value();
    let factor = least / asked;
    if factor.is_infinite() {
        let message = "no feed is proven to be slow enough on this way: beside it a drive has no largest speed (a rod stands across its way, or a formula jumps or has no rate)";
        return Diagnostic::error("low-feed", message).help(
            "another set-up of the part (--mount), or a travel of the drive that ends before that place",
        );
    }
    Diagnostic::error(
        "low-feed",
        format!(
            "so that no axis passes its max_feed this block needs F{}, and the least that is printed is F{}: an axis would go {factor:.1} times too fast",
            plain(asked),
            plain(least)
        ),
    )
    .extreme(LimitExcess {
        key: u64::MAX,
        by: factor,
        value: format!("{factor:.1} times"),
        remedy: String::new(),
    })
    .help("its linear axes hardly move while others turn: a feed by time ([control] feed = \"inverse-time\") where the dialect has one, feed_length as the control has it, or more decimals for feeds")
}
