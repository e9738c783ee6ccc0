//! Both solvers against each other and against clarabel.

use post_feed::limits::Collocation;
use post_feed::{Problem, linear_program, reach};

use crate::support::{oracle, random};

/// Rounding of a row.
const KEPT: f64 = 1.0 + 1e-11;

fn sum(q: &[f64]) -> f64 {
    q.iter().sum()
}

/// Checks the plans of a problem, and gives the objectives of reachability analysis and of the linear program.
fn check(problem: &Problem, name: &str) -> [f64; 2] {
    let weights = vec![1.0; problem.upper.len()];
    let fast = reach::solve(problem).unwrap();
    let best = linear_program::solve(problem, &weights).unwrap();
    let (_, oracle) = oracle::solve(problem, &weights).unwrap();
    for q in [&fast, &best.q] {
        let worst = problem.worst(q);
        assert!(worst.share <= KEPT, "{name}: {worst:?}");
    }
    // Clarabel itself keeps rows to some 1e-8, so it may have a little more than there is.
    assert!((best.objective / oracle - 1.0).abs() < 1e-6, "{name}: {} {oracle}", best.objective);
    assert!(best.gap() < 1e-6, "{name}: {}", best.gap());
    assert!(sum(&fast) <= best.bound * (1.0 + 1e-12), "{name}");
    [sum(&fast), best.objective]
}

#[test]
fn where_all_limits_are_monotone_both_solvers_have_every_feed_the_same() {
    for seed in 0..40 {
        let problem = random::monotone(seed, 60 + 7 * seed as usize);
        check(&problem, &format!("seed {seed}"));
        let weights = vec![1.0; problem.upper.len()];
        let fast = reach::solve(&problem).unwrap();
        let best = linear_program::solve(&problem, &weights).unwrap();
        for (sample, (fast, best)) in fast.iter().zip(&best.q).enumerate() {
            let size = problem.upper[sample];
            assert!(
                (fast - best).abs() <= 1e-6 * fast.max(1e-3 * size),
                "seed {seed}, sample {sample}: {fast} {best}"
            );
        }
    }
}

#[test]
fn on_smooth_paths_the_optimum_is_that_of_clarabel_and_reachability_is_near() {
    for (seed, axes) in (0..12).zip([2, 3, 5].into_iter().cycle()) {
        for collocation in [Collocation::Start, Collocation::Ends, Collocation::Throughout] {
            let problem = random::problem(seed, axes, 400, collocation);
            let [fast, best] = check(&problem, &format!("seed {seed}, {collocation:?}"));
            assert!(fast > 0.97 * best, "seed {seed}, {collocation:?}: {}", fast / best);
        }
    }
}

#[test]
fn rows_of_any_signs_are_kept_and_the_optimum_is_that_of_clarabel() {
    for seed in 0..60 {
        check(&random::any(seed, 50 + 5 * seed as usize), &format!("seed {seed}"));
    }
}
