//! Problems of any numbers, small enough that a failing one shrinks to something to look at.

use post_feed::jerk::{self, Settings};
use post_feed::limits::{AxisJerk, Collocation, Limit};
use post_feed::problem::{EndSpeeds, LimitRow};
use post_feed::reach::{self, Stream};
use post_feed::{Infeasible, Problem, linear_program, profile};
use post_testkit::{Rng, randomised};

use crate::support::oracle::{self, Unsolved};
use crate::support::random::{Limits, samples};

/// A number of any size from a millionth to a thousand, or 0.
fn number(random: &mut Rng) -> f64 {
    match random.pick(7) {
        0 => 0.0,
        _ => random.order(-6.0, 3.0),
    }
}

fn signed(random: &mut Rng) -> f64 {
    let size = number(random);
    if random.pick(2) == 0 { size } else { -size }
}

/// Up to 20 samples with up to 3 rows an interval, and ends at rest or at a share of their bounds.
fn problem(random: &mut Rng) -> Problem {
    let (count, stride) = (2 + random.pick(18), random.pick(4));
    let upper: Vec<f64> = (0..count).map(|_| number(random)).collect();
    let rows = (0..stride * (count - 1))
        .map(|_| LimitRow { here: signed(random), next: signed(random) })
        .collect();
    let mut ends = EndSpeeds::default();
    if random.pick(2) == 0 {
        ends.start = random.range(0.0, 1.0) * upper[0];
        ends.end = random.range(0.0, 1.0) * upper[count - 1];
    }
    let mut problem = Problem::from_rows(vec![1.0; count - 1], upper, stride, rows);
    problem.ends = ends;
    problem
}

/// At rest at both ends there is always a plan; elsewhere what is refused names a limit. Plans keep all limits, and
/// no plan is above the proven bound.
#[test]
fn plans_keep_every_limit_and_none_is_above_the_bound() {
    let (rounds, mut random) = randomised(1000, 1);
    for _ in rounds {
        let problem = problem(&mut random);
        let weights = vec![1.0; problem.upper.len()];
        let fast = reach::solve(&problem);
        let best = linear_program::solve(&problem, &weights);
        match (fast, best) {
            (Ok(fast), Ok(best)) => {
                assert!(problem.worst(&fast).share <= 1.0 + 1e-11, "{problem:?}");
                assert!(problem.worst(&best.q).share <= 1.0 + 1e-11, "{problem:?}");
                let sum: f64 = fast.iter().sum();
                assert!(sum <= best.bound * (1.0 + 1e-9), "{problem:?}");
                assert!(best.objective <= best.bound * (1.0 + 1e-9), "{problem:?}");
                // An optimum, or numbers so far apart that it is said how near.
                assert!(best.gap() < 1e-6, "{} {problem:?}", best.gap());
            }
            (Err(fault), other) => {
                assert!(problem.ends != EndSpeeds::default(), "{problem:?}");
                assert!(fault.source().is_some(), "{problem:?}");
                assert_eq!(other.unwrap_err(), fault, "{problem:?}");
            }
            (Ok(_), Err(fault)) => panic!("{fault:?} {problem:?}"),
        }
    }
}

/// Clarabel's tolerances are those of its own scaling, so numbers lie closer together here.
#[test]
fn the_optimum_is_that_of_clarabel() {
    let (rounds, mut random) = randomised(1000, 2);
    for _ in rounds {
        let count = 2 + random.pick(58);
        let upper = (0..count).map(|_| random.range(1.0, 100.0)).collect();
        let rows = (0..2 * (count - 1))
            .map(|_| LimitRow { here: random.range(-0.3, 0.3), next: random.range(-0.3, 0.3) })
            .collect();
        let mut problem = Problem::from_rows(vec![1.0; count - 1], upper, 2, rows);
        if random.range(0.0, 1.0) < 0.5 {
            problem.ends =
                EndSpeeds { start: random.range(0.0, 8.0).min(problem.upper[0]), end: 0.0 };
        }
        let weights: Vec<f64> = (0..count).map(|_| random.range(0.0, 2.0)).collect();
        let ours = linear_program::solve(&problem, &weights);
        let oracle = oracle::solve(&problem, &weights);
        if matches!(oracle, Err(Unsolved::Undecided)) {
            continue;
        }
        assert_eq!(ours.is_ok(), oracle.is_ok(), "{problem:?}");
        if let (Ok(ours), Ok((_, oracle))) = (ours, oracle) {
            let apart = (ours.objective - oracle).abs();
            assert!(
                apart <= 1e-6 * oracle.abs().max(1.0),
                "{} {oracle} {problem:?}",
                ours.objective
            );
        }
    }
}

/// From rest to rest, whatever the look-ahead.
#[test]
fn a_stream_keeps_every_limit_with_any_look_ahead() {
    let (rounds, mut random) = randomised(1000, 3);
    for _ in rounds {
        let mut problem = problem(&mut random);
        let lookahead = 1 + random.pick(11);
        problem.ends = EndSpeeds::default();
        let whole = reach::solve(&problem).unwrap();
        let mut stream = Stream::new(problem.stride(), lookahead);
        let mut plan = Vec::new();
        stream.push(&problem, &mut |sample| plan.push(sample.q)).unwrap();
        stream.finish(0.0, &mut |sample| plan.push(sample.q)).unwrap();
        assert!(problem.worst(&plan).share <= 1.0 + 1e-11, "{problem:?}");
        if stream.all_certain() {
            assert_eq!(plan, whole, "{problem:?}");
        }
    }
}

/// On random smooth paths, with a stop on the way: the jerk of each axis by what the samples say, and the order of
/// the times.
#[test]
fn plans_with_jerk_limits_keep_them_and_are_no_faster() {
    let (rounds, mut random) = randomised(12, 4);
    for _ in rounds {
        let seed = random.next();
        let axes = 1 + random.pick(3);
        let mut random = Rng::new(seed);
        let samples = samples(&mut random, axes, 301, 30.0);
        let limits = Limits::new(&mut random, axes, Collocation::Throughout);
        let jerk = AxisJerk { limits: (0..axes).map(|_| random.range(2e3, 4e4)).collect() };
        let mut all: Vec<&dyn Limit> = limits.all().to_vec();
        all.push(&jerk);
        let mut problem = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
        problem.upper[150] = 0.0;
        let plan = jerk::solve(&samples, &all, &problem, Settings::default()).unwrap();
        assert!(plan.seconds >= plan.bound * 0.999, "{seed}: {} {}", plan.seconds, plan.bound);
        assert!((plan.law.q()[150]).abs() < 1e-12, "{seed}");
        for (q, upper) in plan.law.q().iter().zip(&problem.upper) {
            assert!(*q <= upper * (1.0 + 1e-12), "{seed}");
        }
        for (interval, piece) in plan.law.pieces.iter().enumerate() {
            let step = plan.law.steps[interval];
            for share in [1e-9, 0.5] {
                let [q, slope, bend] = piece.at(share, step);
                for (axis, limit) in samples.axes.iter().zip(&jerk.limits) {
                    let at =
                        |all: &[f64]| profile::between(all[interval], all[interval + 1], share);
                    let [first, second, third] =
                        [&axis.first, &axis.second, &axis.third].map(|all| at(all));
                    let value = q.sqrt() * (0.5 * first * bend + 1.5 * second * slope + third * q);
                    assert!(value.abs() < 1.02 * limit, "{seed}: {value} {limit}");
                }
            }
        }
    }
}

#[test]
fn too_few_samples_between_two_stops_are_named() {
    let mut random = Rng::new(5);
    let samples = samples(&mut random, 2, 101, 10.0);
    let limits = Limits::new(&mut random, 2, Collocation::Throughout);
    let jerk = AxisJerk { limits: vec![1e4; 2] };
    let mut all: Vec<&dyn Limit> = limits.all().to_vec();
    all.push(&jerk);
    let mut problem = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
    (problem.upper[50], problem.upper[53]) = (0.0, 0.0);
    let fault = jerk::solve(&samples, &all, &problem, Settings::default()).unwrap_err();
    assert_eq!(fault, Infeasible::TooShort { sample: 50 });
}

/// Cut at a sample that it passes evenly, at the speed it has there, the halves take about as long as the whole.
#[test]
fn plans_with_jerk_limits_begin_and_end_at_given_speeds() {
    let mut random = Rng::new(11);
    let samples = samples(&mut random, 2, 401, 40.0);
    let limits = Limits::new(&mut random, 2, Collocation::Throughout);
    let jerk = AxisJerk { limits: vec![2e4; 2] };
    let mut all: Vec<&dyn Limit> = limits.all().to_vec();
    all.push(&jerk);
    let whole = Problem::new(&samples, &all, EndSpeeds::default()).unwrap();
    let slow = jerk::solve(&samples, &all, &whole, Settings::default()).unwrap();
    let least = slow.law.q()[100..300].iter().copied().fold(f64::INFINITY, f64::min);
    let ends = EndSpeeds { start: 0.3 * least, end: 0.3 * least };
    let moving = Problem { ends, ..whole };
    let plan = jerk::solve(&samples, &all, &moving, Settings::default()).unwrap();
    let q = plan.law.q();
    assert!((q[0] - ends.start).abs() < 1e-12 * q[0] && (q[400] - ends.end).abs() < 1e-12 * q[0]);
    assert_eq!(plan.law.pieces[0].at(0.0, plan.law.steps[0])[1], 0.0);
    assert!(plan.seconds < slow.seconds && plan.seconds > plan.bound);
}
