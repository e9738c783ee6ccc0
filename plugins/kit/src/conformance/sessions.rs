//! Sessions beside one another, handed from thread to thread, and used on after a refusal: what a dialect keeps is its
//! session's alone.

use std::thread;
use std::time::{Duration, Instant};

use post_plugin::{Batch, DialectSession as _, Event, Feed, Format, WriteFault};

use super::Case;
use super::dialect::UNKNOWN;
use super::pen::{BEGIN, ELSEWHERE, Pen, rounded};
use crate::at;
use post_host::{OpenedDialect, PluginFault};

/// Events of a batch, as many as the command sends at once.
const BATCH: usize = 128;

/// What is written before a refusal is good, and is what it would be without.
pub(super) fn after_a_refusal(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let write = |last: Option<Event<'static>>| {
        let vectors = pen.writes_vectors()?;
        let mut session = pen.open()?;
        let mut batch = Batch::default();
        for event in beginning(pen).chain(last) {
            batch.push(1, pen.told(event, vectors));
        }
        let (mut out, mut ends) = (String::new(), Vec::new());
        let written = session.write_batch(&batch, &mut out, &mut ends);
        Ok((written.err(), out, ends.len()))
    };
    let (fault, good, ends) = write(None)?;
    if fault.is_some() {
        // Other cases say so.
        return Ok(());
    }
    let (_, out, kept) = write(Some(UNKNOWN))?;
    if (out.as_str(), kept) != (good.as_str(), ends) {
        case.wrong(format!(
            "before an event that it refuses it leaves {kept} events of {} bytes, without that event {ends} of {}",
            out.len(),
            good.len()
        ));
    }
    Ok(())
}

/// Two programs written in turn are the programs that they are by themselves.
pub(super) fn two_at_once(pen: &Pen<'_>, case: &mut Case) -> Result<(), PluginFault> {
    let alone = [0.0, 7.0].map(|start| {
        let mut writer = CuttingSession::open(pen, start)?;
        for _ in 0..20 {
            writer.write(10);
        }
        Ok(writer.out)
    });
    let mut both = [CuttingSession::open(pen, 0.0)?, CuttingSession::open(pen, 7.0)?];
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
    Ok(())
}

/// So many events from two threads in turn, beside the same from one, and how long an event takes.
pub(super) fn two_threads(
    pen: &Pen<'_>,
    case: &mut Case,
    events: usize,
) -> Result<(), PluginFault> {
    let mut one = CuttingSession::open(pen, 0.0)?;
    let mut wandering = CuttingSession::open(pen, 0.0)?;
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
            return Ok(());
        }
        if one.out != wandering.out {
            case.wrong(format!(
                "within {} events from two threads in turn the program is another one than from a single thread",
                written + 64 * BATCH
            ));
            return Ok(());
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
    Ok(())
}

fn beginning(pen: &Pen<'_>) -> impl Iterator<Item = Event<'static>> {
    let begin = BEGIN.iter().copied().filter(|event| !pen.leaves_out(event));
    begin.chain([at(&ELSEWHERE)])
}

/// A session that cuts on and on.
struct CuttingSession<'p> {
    session: OpenedDialect,
    pen: &'p Pen<'p>,
    vectors: bool,
    format: Format,
    begun: bool,
    start: f64,
    step: f64,
    out: String,
    ends: Vec<usize>,
    fault: Option<WriteFault>,
}

impl<'p> CuttingSession<'p> {
    fn open(pen: &'p Pen<'p>, start: f64) -> Result<Self, PluginFault> {
        let session = pen.open()?;
        let format = session.format().clone();
        Ok(CuttingSession {
            session,
            pen,
            vectors: pen.writes_vectors()?,
            format,
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
            for event in beginning(self.pen) {
                batch.push(1, self.pen.told(event, self.vectors));
            }
            self.begun = true;
        }
        for _ in 0..count {
            self.step += 1.0;
            let along = self.start + self.step / 16.0 % 500.0;
            let words = [along, -along / 3.0, 50.0, along / 7.0, 0.25 * along - 90.0];
            let words = rounded(words, &self.format);
            let feed = if self.step % 37.0 < 20.0 { 900.0 } else { 400.0 };
            let cut = Event::linear(&words, Feed::PerMinute(feed));
            batch.push(1, self.pen.told(cut, self.vectors));
        }
        self.ends.clear();
        let written = self.session.write_batch(&batch, &mut self.out, &mut self.ends);
        self.fault = written.err();
    }
}
