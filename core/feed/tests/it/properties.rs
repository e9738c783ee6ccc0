//! Problems of any numbers, small enough that a failing one shrinks to something to look at.

use post_feed::jerk::{self, Settings};
use post_feed::limits::{AxisJerk, Collocation, Limit};
use post_feed::problem::{Ends, Row};
use post_feed::reach::{self, Stream};
use post_feed::{Infeasible, Problem, linear_program, profile};
use post_testkit::Rng;
use proptest::prelude::*;

use crate::support::oracle::{self, Unsolved};
use crate::support::random::{Limits, samples};

/// A number of any size from a millionth to a thousand, or 0.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        1 => Just(0.0),
        6 => (-6.0..3.0_f64).prop_map(|power| libm::pow(10.0, power)),
    ]
}

fn signed() -> impl Strategy<Value = f64> {
    (number(), any::<bool>()).prop_map(|(size, up)| if up { size } else { -size })
}

/// Up to 20 samples with up to 3 rows an interval, and ends at rest or at a share of their bounds.
fn problem() -> impl Strategy<Value = Problem> {
    (2..20_usize, 0..4_usize, any::<bool>()).prop_flat_map(|(count, stride, rest)| {
        let upper = prop::collection::vec(number(), count);
        let rows = prop::collection::vec((signed(), signed()), stride * (count - 1));
        let ends = (0.0..1.0_f64, 0.0..1.0_f64);
        (upper, rows, ends).prop_map(move |(upper, rows, (start, end))| {
            let rows = rows
                .into_iter()
                .map(|(here, next)| Row { here, next })
                .collect();
            let ends = Ends {
                start: if rest { 0.0 } else { start * upper[0] },
                end: if rest { 0.0 } else { end * upper[count - 1] },
            };
            let mut problem = Problem::from_rows(vec![1.0; count - 1], upper, stride, rows);
            problem.ends = ends;
            problem
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

    /// At rest at both ends there is always a plan; elsewhere what is refused names a limit. Plans keep all limits, and
    /// no plan is above the proven bound.
    #[test]
    fn plans_keep_every_limit_and_none_is_above_the_bound(problem in problem()) {
        let weights = vec![1.0; problem.upper.len()];
        let fast = reach::solve(&problem);
        let best = linear_program::solve(&problem, &weights);
        match (fast, best) {
            (Ok(fast), Ok(best)) => {
                prop_assert!(problem.worst(&fast).share <= 1.0 + 1e-11, "{:?}", problem.worst(&fast));
                prop_assert!(problem.worst(&best.q).share <= 1.0 + 1e-11, "{:?}", problem.worst(&best.q));
                let sum: f64 = fast.iter().sum();
                prop_assert!(sum <= best.bound * (1.0 + 1e-9), "{} {}", sum, best.bound);
                prop_assert!(best.objective <= best.bound * (1.0 + 1e-9));
                // An optimum, or numbers so far apart that it is said how near.
                prop_assert!(best.gap() < 1e-6, "{}", best.gap());
            }
            (Err(fault), other) => {
                prop_assert!(problem.ends != Ends::default());
                prop_assert!(fault.source().is_some());
                prop_assert_eq!(other.unwrap_err(), fault);
            }
            (Ok(_), Err(fault)) => prop_assert!(false, "{:?}", fault),
        }
    }

    /// Clarabel's tolerances are those of its own scaling, so numbers lie closer together here.
    #[test]
    fn the_optimum_is_that_of_clarabel(seed in 0..u64::MAX, count in 2..60_usize) {
        let mut random = Rng::new(seed);
        let upper = (0..count).map(|_| random.range(1.0, 100.0)).collect();
        let rows = (0..2 * (count - 1))
            .map(|_| Row { here: random.range(-0.3, 0.3), next: random.range(-0.3, 0.3) })
            .collect();
        let mut problem = Problem::from_rows(vec![1.0; count - 1], upper, 2, rows);
        if random.range(0.0, 1.0) < 0.5 {
            problem.ends = Ends { start: random.range(0.0, 8.0).min(problem.upper[0]), end: 0.0 };
        }
        let weights: Vec<f64> = (0..count).map(|_| random.range(0.0, 2.0)).collect();
        let ours = linear_program::solve(&problem, &weights);
        let oracle = oracle::solve(&problem, &weights);
        prop_assume!(!matches!(oracle, Err(Unsolved::Undecided)));
        prop_assert_eq!(ours.is_ok(), oracle.is_ok());
        if let (Ok(ours), Ok((_, oracle))) = (ours, oracle) {
            prop_assert!((ours.objective - oracle).abs() <= 1e-6 * oracle.abs().max(1.0), "{} {}", ours.objective, oracle);
        }
    }

    /// From rest to rest, whatever the look-ahead.
    #[test]
    fn a_stream_keeps_every_limit_with_any_look_ahead(problem in problem(), lookahead in 1..12_usize) {
        let mut problem = problem;
        problem.ends = Ends::default();
        let whole = reach::solve(&problem).unwrap();
        let mut stream = Stream::new(problem.stride(), lookahead);
        let mut plan = Vec::new();
        stream.push(&problem, &mut |sample| plan.push(sample.q)).unwrap();
        stream.finish(0.0, &mut |sample| plan.push(sample.q)).unwrap();
        prop_assert!(problem.worst(&plan).share <= 1.0 + 1e-11, "{:?}", problem.worst(&plan));
        if stream.all_certain() {
            prop_assert_eq!(plan, whole);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// On random smooth paths, with a stop on the way: the jerk of each axis by what the samples say, and the order of
    /// the times.
    #[test]
    fn plans_with_jerk_limits_keep_them_and_are_no_faster(seed in 0..u64::MAX, axes in 1..4_usize) {
        let mut random = Rng::new(seed);
        let samples = samples(&mut random, axes, 301, 30.0);
        let limits = Limits::new(&mut random, axes, Collocation::Throughout);
        let jerk = AxisJerk { limits: (0..axes).map(|_| random.range(2e3, 4e4)).collect() };
        let mut all: Vec<&dyn Limit> = limits.all().to_vec();
        all.push(&jerk);
        let mut problem = Problem::new(&samples, &all, Ends::default()).unwrap();
        problem.upper[150] = 0.0;
        let plan = jerk::solve(&samples, &all, &problem, Settings::default()).unwrap();
        prop_assert!(plan.seconds >= plan.bound * 0.999, "{} {}", plan.seconds, plan.bound);
        prop_assert!((plan.law.q()[150]).abs() < 1e-12);
        for (q, upper) in plan.law.q().iter().zip(&problem.upper) {
            prop_assert!(*q <= upper * (1.0 + 1e-12));
        }
        for (interval, piece) in plan.law.pieces.iter().enumerate() {
            let step = plan.law.steps[interval];
            for share in [1e-9, 0.5] {
                let [q, slope, bend] = piece.at(share, step);
                for (axis, limit) in samples.axes.iter().zip(&jerk.limits) {
                    let at = |all: &[f64]| profile::between(all[interval], all[interval + 1], share);
                    let [first, second, third] = [&axis.first, &axis.second, &axis.third].map(|all| at(all));
                    let value = q.sqrt() * (0.5 * first * bend + 1.5 * second * slope + third * q);
                    prop_assert!(value.abs() < 1.02 * limit, "{} {}", value, limit);
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
    let jerk = AxisJerk {
        limits: vec![1e4; 2],
    };
    let mut all: Vec<&dyn Limit> = limits.all().to_vec();
    all.push(&jerk);
    let mut problem = Problem::new(&samples, &all, Ends::default()).unwrap();
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
    let jerk = AxisJerk {
        limits: vec![2e4; 2],
    };
    let mut all: Vec<&dyn Limit> = limits.all().to_vec();
    all.push(&jerk);
    let whole = Problem::new(&samples, &all, Ends::default()).unwrap();
    let slow = jerk::solve(&samples, &all, &whole, Settings::default()).unwrap();
    let least = slow.law.q()[100..300]
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let ends = Ends {
        start: 0.3 * least,
        end: 0.3 * least,
    };
    let moving = Problem { ends, ..whole };
    let plan = jerk::solve(&samples, &all, &moving, Settings::default()).unwrap();
    let q = plan.law.q();
    assert!((q[0] - ends.start).abs() < 1e-12 * q[0] && (q[400] - ends.end).abs() < 1e-12 * q[0]);
    assert_eq!(plan.law.pieces[0].at(0.0, plan.law.steps[0])[1], 0.0);
    assert!(plan.seconds < slow.seconds && plan.seconds > plan.bound);
}
