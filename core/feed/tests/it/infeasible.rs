//! What cannot be planned is named: which limit, and where.

use post_feed::limits::Collocation;
use post_feed::problem::{LimitRow, LimitSource};
use post_feed::{Infeasible, Problem, linear_program, reach};
use post_testkit::Rng;

use crate::support::{oracle, random};

/// Ten samples a millimetre apart, 50 mm/s² and 100 mm/s; at sample 6 a bound of 10 (mm/s)².
fn slope() -> Problem {
    let row = LimitRow { here: -0.01, next: 0.01 };
    let mut upper = vec![1e4; 10];
    upper[6] = 10.0;
    Problem::from_rows(vec![1.0; 9], upper, 1, vec![row; 9])
}

#[test]
fn a_start_too_fast_for_a_bound_ahead_is_named_with_the_bound() {
    let mut problem = slope();
    problem.ends.start = 611.0;
    let bound = LimitSource::default();
    let row = problem.sources[0];
    let fault = reach::solve(&problem).unwrap_err();
    let want = Infeasible::TooFastStart {
        sample: 6,
        source: bound,
        needed: 11.0,
        allowed: 10.0,
        braking: Some(row),
    };
    assert!(
        matches!((fault, want), (
        Infeasible::TooFastStart { sample: a, source: b, braking: c, .. },
        Infeasible::TooFastStart { sample: d, source: e, braking: f, .. },
    ) if (a, b, c) == (d, e, f)),
        "{fault:?}"
    );
    assert_eq!(
        problem.describe(&fault),
        "the start is too fast: at sample 6 the squared parameter speed is still 11.000000 after the hardest braking \
         (row allows no more), and bound allows 10.000000"
    );
    problem.ends.start = 609.0;
    assert!(reach::solve(&problem).is_ok());
}

#[test]
fn an_end_that_cannot_be_reached_is_named_with_the_bound_before() {
    let mut problem = slope();
    problem.ends.end = 311.0;
    let fault = reach::solve(&problem).unwrap_err();
    assert!(matches!(fault, Infeasible::OutOfReach { sample: 6, .. }), "{fault:?}");
    assert_eq!(linear_program::solve(&problem, &[1.0; 10]).unwrap_err(), fault);
    problem.ends.end = 309.0;
    assert!(reach::solve(&problem).is_ok());
    // From rest at the start of a path without the bound.
    let mut problem = slope();
    problem.upper[6] = 1e4;
    problem.ends.end = 901.0;
    let fault = reach::solve(&problem).unwrap_err();
    assert!(matches!(fault, Infeasible::OutOfReach { sample: 0, .. }), "{fault:?}");
}

#[test]
fn what_is_no_problem_is_refused_by_its_place() {
    let mut problem = slope();
    problem.upper[4] = f64::INFINITY;
    assert_eq!(reach::solve(&problem), Err(Infeasible::Unbounded { sample: 4 }));
    problem.upper[4] = f64::NAN;
    assert!(matches!(reach::solve(&problem), Err(Infeasible::NotANumber { sample: 4, .. })));
    problem.upper[4] = -1.0;
    assert!(matches!(reach::solve(&problem), Err(Infeasible::NotANumber { sample: 4, .. })));
    let mut problem = slope();
    problem.rows[5].next = f64::NAN;
    assert!(matches!(reach::solve(&problem), Err(Infeasible::NotANumber { sample: 5, .. })));
    let mut problem = slope();
    problem.steps[3] = 0.0;
    assert_eq!(reach::solve(&problem), Err(Infeasible::Standstill { sample: 3 }));
    let problem = Problem::from_rows(Vec::new(), vec![1.0], 0, Vec::new());
    assert_eq!(reach::solve(&problem), Err(Infeasible::Shape));
}

/// Random ends: what is refused has no plan by clarabel either, and what has one is not refused.
#[test]
fn clarabel_finds_the_same_problems_infeasible() {
    let mut refused = 0;
    for seed in 0..60 {
        let mut problem = if seed % 2 == 0 {
            random::any(seed, 40)
        } else {
            random::problem(seed, 3, 60, Collocation::Ends)
        };
        let mut random = Rng::new(seed + 1000);
        problem.ends.start = problem.upper[0] * random.range(0.0, 1.0);
        problem.ends.end = problem.upper.last().unwrap() * random.range(0.0, 1.0);
        let weights = vec![1.0; problem.upper.len()];
        let ours = linear_program::solve(&problem, &weights);
        let oracle = oracle::solve(&problem, &weights);
        assert_eq!(ours.is_ok(), oracle.is_ok(), "seed {seed}: {ours:?}");
        match (ours, oracle) {
            (Ok(ours), Ok((_, oracle))) => {
                assert!(
                    (ours.objective / oracle - 1.0).abs() < 1e-6,
                    "seed {seed}: {} {oracle}",
                    ours.objective
                );
                assert!(problem.worst(&ours.q).share < 1.0 + 1e-11, "seed {seed}");
            }
            (Err(fault), _) => {
                refused += 1;
                assert!(fault.sample().is_some() && fault.source().is_some(), "{fault:?}");
                // On a path something is above a bound somewhere; rows of any signs may contradict each other.
                let named = !matches!(fault, Infeasible::Contradiction { .. });
                assert!(named || seed % 2 == 0, "seed {seed}: {fault:?}");
            }
            _ => {}
        }
    }
    assert!((10..50).contains(&refused), "{refused}");
}
