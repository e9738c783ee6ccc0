//! Texts written on a thread beside the stages: events, report and findings are those of one thread, whatever dialect
//! and output refuse, and wherever something else is wrong.

use std::thread;

use post_grammar::ClReader;
use post_plugin::{Batch, Capabilities, DialectSession, Format, WriteFault};
use post_posting::TextSink;
use post_posting::program::DefaultSpindle;
use post_testruns::posted::Recorder;

use super::runs::wander;
use super::*;

/// A dialect that refuses an event after so many.
struct Refusing {
    recorder: Recorder,
    left: usize,
}

impl DialectSession for Refusing {
    fn capabilities(&self) -> Capabilities {
        self.recorder.capabilities()
    }

    fn format(&self) -> &Format {
        self.recorder.format()
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        if self.left < batch.len() {
            let message = format!("event {} of this batch is too much", self.left);
            return Err(WriteFault { index: self.left, message });
        }
        self.left -= batch.len();
        // Lines are counted: one an event.
        for _ in 0..batch.len() {
            out.push('\n');
            ends.push(out.len());
        }
        self.recorder.write_batch(batch, &mut String::new(), &mut Vec::new())
    }
}

/// An output that is full after so many lines.
struct Full(usize);

impl TextSink for Full {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        let left = self.0.checked_sub(text.len());
        self.0 = left.ok_or("no place is left")?;
        Ok(())
    }
}

/// Where dialect and output refuse.
#[derive(Clone, Copy, Debug)]
struct Refusals {
    events: usize,
    lines: usize,
}

/// What came of it, as text.
fn told(model: &Model, cl: &str, refusals: Refusals, beside: bool) -> (bool, String) {
    let recorder = Recorder::new(&model.machine, 4);
    let mut dialect = Refusing { recorder, left: refusals.events };
    let (mut samples, mut output) = (Samples, Full(refusals.lines));
    let mut job = PostingRequest { tool_length: Some(model.length), ..PostingRequest::default() };
    job.reading.spindle = DefaultSpindle::Still;
    let (report, findings) = thread::scope(|scope| {
        let mut post =
            Post::new(&model.machine, job, &mut dialect, &mut samples, &mut output).unwrap();
        if beside {
            post.write_beside(scope, &|| false);
        }
        let mut reader = ClReader::new(cl.as_bytes());
        while !post.gave_up() {
            match reader.next_record().unwrap() {
                Some(record) => post.record(&record),
                None => break,
            }
        }
        post.finish()
    });
    let asked = dialect.recorder.asked;
    (report.is_some(), format!("{asked:?}\n{report:#?}\n{findings:#?}\n{}", output.0))
}

#[test]
fn a_thread_for_the_text_changes_nothing() {
    let (rounds, mut rng) = randomised(60, 72);
    let mut counted = [0; 2];
    // As many rounds more as it takes to see good programs and refused ones.
    for round in rounds.into_iter().chain(1000..1200) {
        if round >= 1000 && !counted.contains(&0) {
            break;
        }
        let kind = *rng.choose(&["trunnion", "head", "nutating"]);
        let settings: &[&str] = match round % 4 {
            0 => &["axis.X.travel=[-60, 60]"],
            1 => &["accuracy.reduce=true"],
            _ => &[],
        };
        let model = model(kind, rng.pick(2) == 0, [-120.0, 120.0], settings);
        let mut text = wander(&mut rng, 2, 40);
        for _ in 0..rng.pick(3) {
            // Each of them is a fault of its own, and warnings and faults of other stages stand between them.
            text = text.replace("FINI\n", &format!("{}FINI\n", wander(&mut rng, 2, 40)));
        }
        let plenty = usize::MAX;
        // Half of them are not refused: some of these are good whatever is drawn.
        let refusals = match rng.pick(4) {
            0 | 1 => Refusals { events: plenty, lines: plenty },
            2 => Refusals { events: plenty, lines: rng.pick(800) },
            _ => Refusals { events: rng.pick(800), lines: plenty },
        };
        let (is_good, alone) = told(&model, &text, refusals, false);
        let (_, beside) = told(&model, &text, refusals, true);
        let is_refused = alone.contains("is too much") || alone.contains("no place");
        counted = [counted[0] + u32::from(is_good), counted[1] + u32::from(is_refused)];
        assert!(alone == beside, "{kind}, {refusals:?}:\n{text}\n{alone}\n{beside}");
    }
    assert!(!counted.contains(&0), "good, refused: {counted:?}");
}

/// A dialect that panics takes the run with it, as it does on one thread.
#[test]
#[should_panic(expected = "the dialect is out of its mind")]
fn a_panic_beside_is_a_panic() {
    struct Panicking(Format);
    impl DialectSession for Panicking {
        fn format(&self) -> &Format {
            &self.0
        }
        fn write_batch(
            &mut self,
            _: &Batch,
            _: &mut String,
            _: &mut Vec<usize>,
        ) -> Result<(), WriteFault> {
            panic!("the dialect is out of its mind")
        }
    }
    let model = model("head", false, [-120.0, 120.0], &[]);
    let mut dialect = Panicking(Recorder::new(&model.machine, 3).format().clone());
    let (mut samples, mut output) = (Samples, Full(1000));
    thread::scope(|scope| {
        let job = PostingRequest { tool_length: Some(model.length), ..PostingRequest::default() };
        let mut post =
            Post::new(&model.machine, job, &mut dialect, &mut samples, &mut output).unwrap();
        post.write_beside(scope, &|| false);
        let mut reader = ClReader::new("UNITS/MM\nFEDRAT/100\nGOTO/0,0,0\nFINI\n".as_bytes());
        while let Some(record) = reader.next_record().unwrap() {
            post.record(&record);
        }
        post.finish();
    });
}
