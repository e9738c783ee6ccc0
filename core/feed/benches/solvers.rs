//! Samples a second of each solver on the same problem, in one table. `cargo bench -p post-feed`
//!
//! The path is a random smooth one, a sample every 0.1 mm, from rest to rest. Problems go up to `BENCH_MOST` samples,
//! a million by default, and those of clarabel up to `BENCH_CLARABEL`, 1e5 by default: it takes gigabytes beyond.
//! `toppra_compared.py` beside this file holds TOPPRA against the table.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

#[path = "../tests/it/support/oracle.rs"]
mod oracle;
#[path = "../tests/it/support/random.rs"]
#[expect(dead_code, reason = "the tests ask for more kinds of problems")]
mod random;

use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

use post_feed::jerk;
use post_feed::limits::{AxisJerk, Collocation, Limit};
use post_feed::reach::{ReachPlanner, ReachStream};
use post_feed::{EndSpeeds, Problem, linear_program, profile};
use post_testkit::Rng;
use random::Limits;

/// Samples that a stream looks ahead.
const LOOKAHEAD: usize = 1024;

/// Samples of a batch.
const BATCH: usize = 4096;

fn main() {
    let most = setting("BENCH_MOST", 1_000_000);
    let oracle = setting("BENCH_CLARABEL", 100_000);
    say(
        "samples a second, the time of the plan, and how many times as fast as clarabel on the same problem",
    );
    say(&format!(
        "{:>4} {:<10} {:>8} {:>10} {:>10} {:>10} {:>12} {:>12} {:>12} {:>8} {:>9}",
        "axes",
        "rows kept",
        "samples",
        "limits",
        "reach",
        "stream",
        "seconds",
        "own program",
        "clarabel",
        "reach x",
        "program x"
    ));
    for axes in [3, 5] {
        for collocation in [Collocation::Start, Collocation::Ends, Collocation::Throughout] {
            for count in counts(most) {
                compare(axes, collocation, count, count <= oracle);
            }
        }
    }
    say("what waits in a stream: samples at most, whatever the path is long");
    for lookahead in [256, 1024, 4096] {
        for count in [100_000, 1_000_000].into_iter().filter(|&count| count <= most) {
            waiting(lookahead, count);
        }
    }
    say("with jerk limits: at once, and in windows of four look-aheads of 300 samples");
    say(
        "axes  samples   a second   rounds iterations times as long as without |   a second  longer by    waiting retries",
    );
    for axes in [3, 5] {
        for count in counts(most.min(100_000)) {
            with_jerk(axes, count);
        }
    }
}

/// 1000, and ten times as many as often as they are at most `most`.
fn counts(most: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(1000), |count| Some(count * 10))
        .take_while(move |&count| count <= most)
}

/// How many samples wait at most in a stream of a path of `count` samples.
fn waiting(lookahead: usize, count: usize) {
    let part = random::problem(7, 3, BATCH + 1, Collocation::Throughout);
    let mut stream = ReachStream::new(part.stride(), lookahead);
    let mut most = 0;
    let mut settled = 0;
    while settled < count {
        let pushed = stream.push(&part, &mut |_| settled += 1);
        black_box(pushed.is_ok());
        most = most.max(stream.waiting());
    }
    say(&format!("look-ahead {lookahead:>5}, {count:>8} samples: {most:>6} wait"));
}

/// Plans with jerk limits: time, rounds and how much longer they take than without.
fn with_jerk(axes: usize, count: usize) {
    let mut random = Rng::new(7);
    let samples = random::samples(&mut random, axes, count, 0.1 * count as f64);
    let limits = Limits::new(&mut random, axes, Collocation::Throughout);
    let jerk = AxisJerk { limits: vec![20_000.0; axes] };
    let mut all: Vec<&dyn Limit> = limits.all().to_vec();
    all.push(&jerk);
    let Ok(problem) = Problem::new(&samples, &all, EndSpeeds::default()) else {
        say("no problem");
        return;
    };
    let begin = Instant::now();
    let plan = match jerk::solve(&samples, &all, &problem, jerk::JerkSettings::default()) {
        Ok(plan) => plan,
        Err(fault) => {
            say(&format!("{axes} axes, {count} samples: {fault}"));
            return;
        }
    };
    let at_once = begin.elapsed().as_secs_f64();
    let batches: Vec<_> = (0..count - 1)
        .step_by(BATCH)
        .map(|first| (first, (first + BATCH).min(count - 1)))
        .map(|(first, last)| (random::part(&samples, first, last), problem.part(first, last)))
        .collect();
    let begin = Instant::now();
    let mut stream = jerk::JerkStream::new(300, jerk::JerkSettings::default());
    let (mut seconds, mut waiting) = (0.0, 0);
    let mut take =
        |passed: jerk::SettledInterval<'_>| seconds += passed.piece.duration(passed.step);
    for (samples, problem) in &batches {
        let batch = jerk::PathBatch { samples, limits: &all, problem, corner: false };
        black_box(stream.push(batch, &mut take).is_ok());
        waiting = waiting.max(stream.waiting());
    }
    black_box(stream.finish(0.0, &mut take).is_ok());
    say(&format!(
        "{axes:>4} {count:>8} {:>10.3e} {:>8} {:>10} {:>30.4} | {:>10.3e} {:>+10.1e} {waiting:>10} {:>7}",
        count as f64 / at_once,
        plan.rounds,
        plan.iterations,
        plan.seconds / plan.bound,
        count as f64 / begin.elapsed().as_secs_f64(),
        seconds / plan.seconds - 1.0,
        stream.retries()
    ));
}

fn setting(name: &str, default: usize) -> usize {
    let value = std::env::var(name).ok();
    value.and_then(|value| value.parse().ok()).unwrap_or(default)
}

fn compare(axes: usize, collocation: Collocation, count: usize, ask_oracle: bool) {
    let mut random = Rng::new(7);
    let samples = random::samples(&mut random, axes, count, 0.1 * count as f64);
    let limits = Limits::new(&mut random, axes, collocation);
    let limits = limits.all();
    let ends = EndSpeeds::default();
    let Ok(mut problem) = Problem::new(&samples, &limits, ends) else {
        say("no problem");
        return;
    };
    let filled = seconds(count, || {
        black_box(problem.refill(&samples, &limits, ends).is_ok());
    });
    let mut reach = ReachPlanner::default();
    let mut plan = Vec::new();
    let fast = seconds(count, || {
        black_box(reach.solve_into(&problem, &mut plan).is_ok());
    });
    let batches: Vec<Problem> = (0..count - 1)
        .step_by(BATCH)
        .map(|first| problem.part(first, (first + BATCH).min(count - 1)))
        .collect();
    let mut stream = ReachStream::new(problem.stride(), LOOKAHEAD);
    let mut streamed = Vec::with_capacity(count);
    let flowing = seconds(count, || {
        streamed.clear();
        for batch in &batches {
            black_box(stream.push(batch, &mut |sample| streamed.push(sample.q)).is_ok());
        }
        black_box(stream.finish(0.0, &mut |sample| streamed.push(sample.q)).is_ok());
    });
    assert!(streamed == plan || !stream.all_certain(), "the stream has the plan of the whole");
    let weights = vec![1.0; count];
    let begin = Instant::now();
    let best = linear_program::solve(&problem, &weights);
    let own = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    let oracle = ask_oracle.then(|| oracle::solve(&problem, &weights).ok()).flatten();
    let general = if ask_oracle { begin.elapsed().as_secs_f64() } else { f64::NAN };
    let rate = |seconds: f64| format!("{:.3e}", count as f64 / seconds);
    say(&format!(
        "{axes:>4} {:<10} {count:>8} {:>10} {:>10} {:>10} {:>12.6} {:>12} {:>12} {:>8.0} {:>9.1}",
        format!("{collocation:?}"),
        rate(filled),
        rate(fast),
        rate(flowing),
        profile::duration(&problem.steps, &plan),
        rate(own),
        rate(general),
        general / fast,
        general / own
    ));
    let Ok(best) = best else {
        say("no plan");
        return;
    };
    let sum: f64 = plan.iter().sum();
    let against = oracle.map_or(f64::NAN, |(_, objective)| best.objective / objective - 1.0);
    say(&format!(
        "     objectives: own {against:+.1e} of clarabel, proven gap {:.1e}, {} iterations; reach {:.5} of own; certain {}",
        best.gap(),
        best.iterations,
        sum / best.objective,
        stream.all_certain()
    ));
}

/// Median of a few runs, of small problems many at a time.
fn seconds(count: usize, mut run: impl FnMut()) -> f64 {
    let repeats = (100_000 / count).max(1);
    let mut times: Vec<f64> = (0..5)
        .map(|_| {
            let begin = Instant::now();
            (0..repeats).for_each(|_| run());
            begin.elapsed().as_secs_f64() / repeats as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[2]
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
