//! Sessions beside one another, handed from thread to thread, and used on after a refusal: what a dialect keeps is its
//! session's alone.

use std::thread;
use std::time::{Duration, Instant};

use post_plugin::{Batch, DialectSession, Event, Feed, WriteFault, quantise};

use super::Case;
use super::pen::{RETRACT, TURNING};
use post_host::{OpenedDialect, Plugin, PluginFault, ProgramSetup};

/// Events of a batch, as many as the command sends at once.
const BATCH: usize = 128;

/// What is written before a refusal is good, and is what it would be without.
pub(super) fn after_a_refusal(
    plugin: &Plugin,
    setup: &ProgramSetup,
    unknown: u32,
) -> Result<Case, PluginFault> {
    let mut case = Case::named("after a refusal");
    let write = |last: Option<Event<'_>>| {
        let mut session = plugin.dialect(setup)?;
        let mut batch = Batch::default();
        for event in beginning().into_iter().chain(last) {
            batch.push(1, event);
        }
        let (mut out, mut ends) = (String::new(), Vec::new());
        let written = session.write_batch(&batch, &mut out, &mut ends);
        Ok((written.err(), out, ends.len()))
    };
    let (fault, good, ends) = write(None)?;
    if fault.is_some() {
        // Other cases say so.
        return Ok(case);
    }
    let (_, out, kept) = write(Some(Event::Unknown { kind: unknown }))?;
    if (out.as_str(), kept) != (good.as_str(), ends) {
        case.wrong(format!(
            "before an event that it refuses it leaves {kept} events of {} bytes, without that event {ends} of {}",
            out.len(),
            good.len()
        ));
    }
    Ok(case)
}

/// Two programs written in turn are the programs that they are by themselves.
pub(super) fn two_at_once(plugin: &Plugin, setup: &ProgramSetup) -> Result<Case, PluginFault> {
    let mut case = Case::named("two at once");
    let alone = [0.0, 7.0].map(|start| {
        let mut writer = Writer::open(plugin, setup, start)?;
        for _ in 0..20 {
            writer.write(10);
        }
        Ok(writer.out)
    });
    let mut both = [Writer::open(plugin, setup, 0.0)?, Writer::open(plugin, setup, 7.0)?];
    for _ in 0..20 {
        for writer in &mut both {
            writer.write(10);
        }
    }
    for (alone, writer) in alone.into_iter().zip(&both) {
        if alone? != writer.out {
            case.wrong(
                "a program is another one while a second is written: it keeps something outside of its session"
                    .to_owned(),
            );
            break;
        }
    }
    Ok(case)
}

/// So many events from two threads in turn, beside the same from one, and how long an event takes.
pub(super) fn two_threads(
    plugin: &Plugin,
    setup: &ProgramSetup,
    events: usize,
) -> Result<Case, PluginFault> {
    let mut case = Case::named("two threads");
    let mut one = Writer::open(plugin, setup, 0.0)?;
    let mut wandering = Writer::open(plugin, setup, 0.0)?;
    let (mut bytes, mut written) = (0, 0);
    let mut time = Duration::ZERO;
    while written < events {
        let start = Instant::now();
        // Many batches between two changes of the thread, which take longer than they do.
        for _ in 0..64 {
            one.write(BATCH);
        }
        time += start.elapsed();
        for _ in 0..2 {
            thread::scope(|scope| {
                scope
                    .spawn(|| {
                        for _ in 0..32 {
                            wandering.write(BATCH);
                        }
                    })
                    .join()
            })
            .unwrap_or(());
        }
        if let Some(fault) = one.fault.as_ref().or(wandering.fault.as_ref()) {
            case.wrong(format!("after {written} events: {}", fault.message));
            return Ok(case);
        }
        if one.out != wandering.out {
            case.wrong(format!(
                "within {} events from two threads in turn the program is another one than from a single thread",
                written + 64 * BATCH
            ));
            return Ok(case);
        }
        written += 64 * BATCH;
        bytes += one.out.len();
        one.out.clear();
        wandering.out.clear();
    }
    case.facts.push(format!(
        "{written} events, {} ns and {} bytes each",
        time.as_nanos() / written as u128,
        bytes / written
    ));
    Ok(case)
}

fn beginning() -> Vec<Event<'static>> {
    vec![
        Event::Start,
        RETRACT,
        Event::tool_change(1, 1, "ball 6"),
        TURNING,
        Event::position(&[1.0, 2.0, 90.0, 3.0, 4.0], None),
    ]
}

/// A session that cuts on and on.
struct Writer {
    session: OpenedDialect,
    decimals: Vec<u8>,
    begun: bool,
    start: f64,
    step: f64,
    out: String,
    ends: Vec<usize>,
    fault: Option<WriteFault>,
}

impl Writer {
    fn open(plugin: &Plugin, setup: &ProgramSetup, start: f64) -> Result<Self, PluginFault> {
        let session = plugin.dialect(setup)?;
        let decimals = session.format().words.clone();
        Ok(Writer {
            session,
            decimals,
            begun: false,
            start,
            step: 0.0,
            out: String::new(),
            ends: Vec::new(),
            fault: None,
        })
    }

    /// A batch of so many cuts.
    fn write(&mut self, count: usize) {
        if self.fault.is_some() {
            return;
        }
        let mut batch = Batch::default();
        if !self.begun {
            for event in beginning() {
                batch.push(1, event);
            }
            self.begun = true;
        }
        for _ in 0..count {
            self.step += 1.0;
            let along = self.start + self.step / 16.0 % 500.0;
            let mut words = [along, -along / 3.0, 50.0, along / 7.0, 0.25 * along - 90.0];
            for (word, decimals) in words.iter_mut().zip(&self.decimals) {
                *word = quantise(*word, *decimals);
            }
            let feed = if self.step % 37.0 < 20.0 { 900.0 } else { 400.0 };
            batch.push(1, Event::linear(&words, Feed::PerMinute(feed)));
        }
        self.ends.clear();
        let written = self.session.write_batch(&batch, &mut self.out, &mut self.ends);
        self.fault = written.err();
    }
}
