//! Plans with jerk limits in windows: against the whole path at once, closed forms, and their limits at dense points.

use post_feed::jerk::{self, JerkSettings, JerkStream, Law, PathBatch, SettledInterval};
use post_feed::limits::{AxisAcceleration, AxisJerk, AxisVelocity, Collocation, Limit};
use post_feed::{EndSpeeds, Infeasible, Problem, Samples};
use post_testkit::{Rng, randomised};

use crate::support::random::{self, Limits, part};

/// A path of batches under limits, streamed: the law, and the stream for its counts.
fn streamed(
    batches: &[(Samples, Problem, bool)],
    limits: &[&dyn Limit],
    lookahead: usize,
    end: f64,
) -> Result<(Law, JerkStream), Infeasible> {
    let mut stream = JerkStream::new(lookahead, JerkSettings::default());
    let mut law = Law::default();
    let mut take = |passed: SettledInterval<'_>| {
        assert_eq!(passed.sample, law.pieces.len());
        law.steps.push(passed.step);
        law.pieces.push(passed.piece);
        let used = passed.active();
        assert!(used.share < 1.0 + 1e-6, "{used:?}");
    };
    for (samples, problem, corner) in batches {
        let batch = PathBatch { samples, limits, problem, corner: *corner };
        stream.push(batch, &mut take)?;
    }
    stream.finish(end, &mut take)?;
    Ok((law, stream))
}

/// Random limits of velocity, acceleration and jerk.
struct Drives {
    without: Limits,
    jerk: AxisJerk,
}

impl Drives {
    fn new(random: &mut Rng, axes: usize) -> Self {
        Self {
            without: Limits::new(random, axes, Collocation::Throughout),
            jerk: AxisJerk { limits: (0..axes).map(|_| random.range(2e3, 4e4)).collect() },
        }
    }

    fn all(&self) -> Vec<&dyn Limit> {
        let mut all: Vec<&dyn Limit> = self.without.all().to_vec();
        all.push(&self.jerk);
        all
    }
}

/// The jerk of an axis that a law has at a point of an interval.
fn jerk_of(law: &Law, interval: usize, share: f64, derivatives: [f64; 3]) -> f64 {
    let [q, slope, bend] = law.pieces[interval].at(share, law.steps[interval]);
    let [first, second, third] = derivatives;
    q.sqrt() * (0.5 * first * bend + 1.5 * second * slope + third * q)
}

/// Speed and acceleration along the path do not jump from interval to interval.
fn check_joints(law: &Law) {
    for (index, pair) in law.pieces.windows(2).enumerate() {
        let [before, _, _] = pair[0].at(1.0, law.steps[index]);
        let [behind, _, _] = pair[1].at(0.0, law.steps[index + 1]);
        let most = before.max(behind);
        assert!((before - behind).abs() <= 1e-9 * most, "{index}: {before} {behind}");
        let before = pair[0].at(1.0, law.steps[index])[1];
        let behind = pair[1].at(0.0, law.steps[index + 1])[1];
        let size = most / law.steps[index];
        assert!((before - behind).abs() <= 1e-7 * size, "{index}: {before} {behind}");
    }
}

#[test]
fn with_enough_look_ahead_a_stream_is_as_fast_as_the_whole_path_at_once() {
    const FINE: usize = 6;
    for (seed, axes) in [(1, 2), (2, 3), (3, 3), (4, 5)] {
        let count = 1501;
        let mut random = Rng::new(seed);
        let samples = random::samples(&mut random, axes, count, 150.0);
        let drives = Drives::new(&mut random, axes);
        let all = drives.all();
        let whole = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
        let at_once = jerk::solve(&samples, &all, &whole, JerkSettings::default()).unwrap();
        // The same path, denser: derivatives of the path itself between samples.
        let mut random = Rng::new(seed);
        let dense = random::samples(&mut random, axes, FINE * (count - 1) + 1, 150.0);
        for lookahead in [60, 150, 300] {
            let mut batches = Vec::new();
            let mut first = 0;
            while first < count - 1 {
                let next = (first + random.range(1.0, 200.0) as usize).min(count - 1);
                batches.push((part(&samples, first, next), whole.part(first, next), false));
                first = next;
            }
            let begin = std::time::Instant::now();
            let (law, stream) = streamed(&batches, &all, lookahead, 0.0).unwrap();
            let over = law.duration() / at_once.seconds - 1.0;
            println!(
                "seed {seed}, {axes} axes, look-ahead {lookahead}: {over:+.1e} of {:.4} s at once, which is {:.3} of \
                 without jerk; {:?}, {} retries, {:?} for {:?} rounds and iterations at once",
                at_once.seconds,
                at_once.seconds / at_once.bound,
                stream.work(),
                stream.retries(),
                begin.elapsed(),
                [at_once.rounds, at_once.iterations],
            );
            assert_eq!(law.pieces.len(), count - 1);
            check_joints(&law);
            for (sample, (q, upper)) in law.q().iter().zip(&whole.upper).enumerate() {
                assert!(*q <= upper * (1.0 + 1e-9), "{sample}: {q} {upper}");
            }
            for (axis, limit) in drives.jerk.limits.iter().enumerate() {
                for interval in 0..count - 1 {
                    for point in 0..=FINE {
                        let share = (point as f64 / FINE as f64).clamp(1e-6, 1.0 - 1e-6);
                        let at = interval * FINE + point;
                        let axis = &dense.axes[axis];
                        let derivatives = [axis.first[at], axis.second[at], axis.third[at]];
                        let used = jerk_of(&law, interval, share, derivatives) / limit;
                        assert!(used.abs() < 1.01, "{interval}: {used}");
                    }
                }
            }
            // The whole path's plan is a local optimum of the convex-concave procedure: the stream's may be better.
            let most = if lookahead < 150 { 0.25 } else { 0.02 };
            assert!((-0.02..most).contains(&over), "{over}");
            assert!(law.duration() > at_once.bound * 0.999);
        }
    }
}

/// However short: slower, and nothing broken.
#[test]
fn too_short_a_look_ahead_costs_speed_and_breaks_no_limit() {
    let mut retries = 0;
    for seed in 0..6 {
        let (axes, count) = (1 + seed as usize % 3, 400);
        let mut random = Rng::new(seed);
        let samples = random::samples(&mut random, axes, count, 40.0);
        let mut drives = Drives::new(&mut random, axes);
        if seed % 2 == 0 {
            // Jerk alone rules.
            drives.jerk.limits = vec![500.0; axes];
        }
        let all = drives.all();
        let whole = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
        let at_once = jerk::solve(&samples, &all, &whole, JerkSettings::default()).unwrap();
        for lookahead in [1, 4, 7, 15] {
            let batches = [(samples.clone(), whole.clone(), false)];
            let (law, stream) = streamed(&batches, &all, lookahead, 0.0).unwrap();
            check_joints(&law);
            let over = law.duration() / at_once.seconds - 1.0;
            println!(
                "seed {seed}, look-ahead {lookahead}: {over:+.2e}, {:?}, {} retries",
                stream.work(),
                stream.retries()
            );
            retries += stream.retries();
            assert!(over > -0.02 && over < 20.0, "{over}");
            assert_eq!(law.pieces.len(), count - 1);
        }
    }
    println!("{retries} retries");
}

const VELOCITY: f64 = 50.0;
const ACCELERATION: f64 = 400.0;
const JERK: f64 = 5000.0;

/// Two axes alike.
struct Pair {
    velocity: AxisVelocity,
    acceleration: AxisAcceleration,
    jerk: AxisJerk,
}

impl Pair {
    fn new() -> Self {
        let collocation = Collocation::Throughout;
        let limits = vec![VELOCITY; 2];
        let velocity = AxisVelocity { limits, collocation };
        let limits = vec![ACCELERATION; 2];
        let acceleration = AxisAcceleration { limits, collocation };
        let limits = vec![JERK; 2];
        let jerk = AxisJerk { limits };
        Self { velocity, acceleration, jerk }
    }

    fn all(&self) -> [&dyn Limit; 3] {
        [&self.velocity, &self.acceleration, &self.jerk]
    }
}

/// A line along one of two axes.
fn line(direction: [f64; 2], parameters: &[f64]) -> Samples {
    let mut samples = Samples::default();
    for &s in parameters {
        let [x, y] = direction;
        let axes = direction.map(|first| [first, 0.0, 0.0]);
        samples.push(s, [[x, y, 0.0], [0.0; 3], [0.0; 3]], &axes);
    }
    samples
}

/// Time and way of a change of speed by `change` from `from`, with no acceleration at both ends.
fn ramp(from: f64, change: f64) -> [f64; 2] {
    let full = ACCELERATION / JERK;
    let time = if change > ACCELERATION * full {
        change / ACCELERATION + full
    } else {
        2.0 * (change / JERK).sqrt()
    };
    [time, (from + 0.5 * change) * time]
}

/// 40 mm along X and 30 mm along Y, around the corner with 6 mm/s and no acceleration: each side is an S-curve up and
/// one down.
#[test]
fn an_l_with_jerk_limits_is_the_s_curves_of_its_sides() {
    let drives = Pair::new();
    let limits = drives.all();
    let corner = 6.0;
    let side = |length: f64| {
        let [up, way_up] = ramp(0.0, VELOCITY);
        let [down, way_down] = ramp(corner, VELOCITY - corner);
        up + down + (length - way_up - way_down) / VELOCITY
    };
    let exact = side(40.0) + side(30.0);
    let batch = |direction: [f64; 2], length: f64| {
        let samples = line(direction, &jerk::graded(0.0, length, 0.1));
        let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
        (samples, problem)
    };
    let (first, mut before) = batch([1.0, 0.0], 40.0);
    let (second, behind) = batch([0.0, 1.0], 30.0);
    let joint = before.steps.len();
    before.lower(joint, corner * corner, "corner");
    for lookahead in [250, 2000] {
        let batches =
            [(first.clone(), before.clone(), false), (second.clone(), behind.clone(), true)];
        let (law, stream) = streamed(&batches, &limits, lookahead, 0.0).unwrap();
        let over = law.duration() / exact - 1.0;
        println!(
            "look-ahead {lookahead}: {:.5} s of {exact:.5} s, {over:+.1e}; {:?}, {} retries",
            law.duration(),
            stream.work(),
            stream.retries()
        );
        check_joints(&law);
        assert!(over > -1e-9 && over < 3e-3, "{over}");
        // No acceleration at the corner, on either side.
        let [q, slope, _] = law.pieces[joint].at(0.0, law.steps[joint]);
        assert!(slope.abs() < 1e-9 * q / law.steps[joint] && q <= corner * corner, "{q} {slope}");
        assert!(q > 0.99 * corner * corner, "{q}");
        // As a smooth joint the path would keep its acceleration there, and both axes would jump in it.
        let mut smooth = batches;
        smooth[1].2 = false;
        let (law, _) = streamed(&smooth, &limits, lookahead, 0.0).unwrap();
        check_joints(&law);
    }
}

/// A random polygon: short sides, low corners, stops among them, and a start and an end in motion.
#[test]
fn polygons_with_jerk_limits_keep_them_in_windows_of_any_size() {
    let mut random = Rng::new(3);
    let drives = Pair::new();
    let limits = drives.all();
    let mut batches = Vec::new();
    let sides = 40;
    let mut first = 0.0;
    for side in 0..sides {
        let (sin, cos) = libm::sincos(random.range(0.0, 6.3));
        let length = random.range(0.3, 6.0);
        let intervals = random.range(4.0, 60.0) as usize;
        let at = |index: usize| first + length * index as f64 / intervals as f64;
        let parameters: Vec<f64> = (0..=intervals).map(at).collect();
        let samples = line([cos, sin], &parameters);
        let mut problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
        let stop = random.range(0.0, 1.0) < 0.1;
        let corner = if stop { 0.0 } else { random.range(1.0, 30.0) };
        if side > 0 {
            problem.lower(0, corner * corner, "corner");
        }
        if side == 0 {
            problem.ends.start = 16.0;
        }
        batches.push((samples, problem, true));
        first += length;
    }
    let mut times = Vec::new();
    for lookahead in [4, 20, 60, 200, 1000] {
        let (law, stream) = streamed(&batches, &limits, lookahead, 9.0).unwrap();
        check_joints(&law);
        println!(
            "look-ahead {lookahead}: {:.4} s, {:?}, {} retries",
            law.duration(),
            stream.work(),
            stream.retries()
        );
        let q = law.q();
        assert!((q[0] - 16.0).abs() < 1e-12 && (q.last().unwrap() - 9.0).abs() < 1e-9);
        let mut at = 0;
        for (_, problem, _) in &batches {
            for (q, upper) in q[at..].iter().zip(&problem.upper) {
                assert!(*q <= upper * (1.0 + 1e-9), "{q} {upper}");
            }
            at += problem.steps.len();
        }
        times.push(law.duration());
    }
    // All at once is the longest look-ahead.
    assert!(times.iter().all(|time| time / times[4] > 0.98), "{times:?}");
    assert!(times[3] / times[4] < 1.02, "{times:?}");
}

/// What is refused is named with its place, leaves nothing behind, and the path goes on; what waits is the look-ahead.
#[test]
fn a_long_path_goes_on_behind_batches_that_are_refused() {
    let mut random = Rng::new(8);
    let count = 4001;
    let samples = random::samples(&mut random, 1, count, 400.0);
    let drives = Drives::new(&mut random, 1);
    let all = drives.all();
    let whole = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
    let lookahead = 60;
    let mut plans = Vec::new();
    for disturbed in [false, true] {
        let mut stream = JerkStream::new(lookahead, JerkSettings::default());
        let mut law = Law::default();
        let mut names = Vec::new();
        let mut take = |passed: SettledInterval<'_>| {
            law.steps.push(passed.step);
            law.pieces.push(passed.piece);
            names.push(passed.active().source);
        };
        let mut most = 0;
        for first in (0..count - 1).step_by(100) {
            let samples = part(&samples, first, first + 100);
            let problem = whole.part(first, first + 100);
            let batch =
                PathBatch { samples: &samples, limits: &all, problem: &problem, corner: false };
            if disturbed {
                let mut wrong = problem.clone();
                // Were it taken, the path would be slower here.
                wrong.upper[0] = 1e-3;
                wrong.steps[99] = 0.0;
                let refused =
                    stream.push(PathBatch { problem: &wrong, corner: true, ..batch }, &mut take);
                assert_eq!(refused, Err(Infeasible::Standstill { sample: 99 }));
                let short = part(&samples, 0, 50);
                let batch = PathBatch { samples: &short, ..batch };
                assert_eq!(stream.push(batch, &mut take), Err(Infeasible::Shape));
            }
            stream.push(batch, &mut take).unwrap();
            most = most.max(stream.waiting());
        }
        assert_eq!(stream.finish(-1.0, &mut take), Err(Infeasible::Shape));
        stream.finish(0.0, &mut take).unwrap();
        assert!(most <= 4 * lookahead + 5, "{most}");
        assert_eq!(law.pieces.len(), count - 1);
        let named =
            |name: &str| names.iter().filter(|&&source| stream.name(source) == name).count();
        assert!(named("axis jerk of axis 0") > 100);
        assert_eq!(named("bound"), 0);
        plans.push(law);
    }
    assert_eq!(plans[0], plans[1]);
}

/// Too few intervals behind a stop, and a start whose rows cannot be kept: named; then another path.
#[test]
fn what_has_no_plan_with_jerk_limits_is_named_and_the_stream_begins_anew() {
    let drives = Pair::new();
    // Without acceleration, which would be named for the start before jerk.
    let limits: [&dyn Limit; 2] = [&drives.velocity, &drives.jerk];
    let parameters: Vec<f64> = (0..=200).map(|index| 0.1 * f64::from(index)).collect();
    let samples = line([1.0, 0.0], &parameters);
    let mut problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
    let batch = |problem: &Problem, stream: &mut JerkStream| -> Result<f64, Infeasible> {
        let mut law = Law::default();
        let mut take = |passed: SettledInterval<'_>| {
            law.steps.push(passed.step);
            law.pieces.push(passed.piece);
        };
        let batch = PathBatch { samples: &samples, limits: &limits, problem, corner: false };
        let pushed = stream.push(batch, &mut take);
        pushed.and_then(|()| stream.finish(0.0, &mut take))?;
        Ok(law.duration())
    };
    let mut stream = JerkStream::new(20, JerkSettings::default());
    let good = batch(&problem, &mut stream).unwrap();
    let mut short = problem.clone();
    short.lower(100, 0.0, "stop");
    short.lower(103, 0.0, "stop");
    assert_eq!(batch(&short, &mut stream), Err(Infeasible::TooShort { sample: 100 }));
    stream.clear();
    assert_eq!(batch(&problem, &mut stream), Ok(good));
    // 40 mm/s, and a stop 0.5 mm ahead.
    problem.ends.start = 1600.0;
    problem.lower(5, 0.0, "stop");
    for fault in [
        batch(&problem, &mut stream).unwrap_err(),
        jerk::solve(&samples, &limits, &problem, JerkSettings::default()).unwrap_err(),
    ] {
        let Infeasible::Contradiction { source, .. } = fault else {
            panic!("{fault:?}");
        };
        assert_eq!(problem.name(source), "axis jerk of axis 0");
    }
}

/// Smooth pieces that meet at corners of any angle, in steps of any size, some of them stops.
#[test]
fn pieces_of_any_path_meet_at_corners_without_breaking_a_limit() {
    let (rounds, mut random) = randomised(24, 1);
    let (tried, mut refused) = (rounds.end, 0);
    for _ in rounds {
        let seed = random.next();
        let mut random = Rng::new(seed);
        let lookahead = 1 + random.pick(79);
        let axes = 1 + random.pick(3);
        let drives = Drives::new(&mut random, axes);
        let all = drives.all();
        let mut batches = Vec::new();
        for _ in 0..6 {
            let count = 11 + random.pick(90);
            let length = random.range(0.05, 0.3) * count as f64;
            let samples = random::samples(&mut random, axes, count, length);
            let mut problem = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
            let corner = random.pick(4) > 0;
            if random.pick(4) == 0 {
                problem.lower(0, 0.0, "stop");
            } else {
                problem.lower(0, random.range(0.01, 900.0), "corner");
            }
            batches.push((samples, problem, corner));
        }
        let (law, _) = match streamed(&batches, &all, lookahead, 0.0) {
            // Refused by name, which is no limit that is broken.
            Err(Infeasible::NoProgress { .. }) => {
                refused += 1;
                continue;
            }
            planned => planned.unwrap(),
        };
        check_joints(&law);
        let q = law.q();
        let mut at = 0;
        for (_, problem, corner) in &batches {
            for (q, upper) in q[at..].iter().zip(&problem.upper) {
                assert!(*q <= upper * (1.0 + 1e-9), "{} {}", q, upper);
            }
            if *corner && at > 0 && q[at] > 0.0 {
                let slope = law.pieces[at].at(0.0, law.steps[at])[1];
                assert!(slope.abs() <= 1e-9 * q[at] / law.steps[at], "{} {}", slope, q[at]);
            }
            at += problem.steps.len();
        }
        assert_eq!(at, law.pieces.len(), "{seed}");
    }
    // One in a hundred is.
    assert!(refused * 2 <= tried, "{refused} of {tried}");
}
