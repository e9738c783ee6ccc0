//! Reachability analysis with bounded look-ahead against the whole path at once.

use post_feed::limits::Collocation;
use post_feed::problem::EndSpeeds;
use post_feed::reach::{self, ReachStream};
use post_feed::{Infeasible, Problem};
use post_testkit::Rng;

use crate::support::random;

/// The plan in batches of random length, and how many samples depended on what lies behind the look-ahead.
fn streamed(
    problem: &Problem,
    lookahead: usize,
    seed: u64,
) -> Result<(Vec<f64>, usize), Infeasible> {
    let mut random = Rng::new(seed);
    let mut stream = ReachStream::new(problem.stride(), lookahead);
    let mut plan = Vec::new();
    let last = problem.steps.len();
    let mut first = 0;
    while first < last {
        let next = (first + random.range(1.0, 300.0) as usize).min(last);
        stream.push(&problem.part(first, next), &mut |sample| plan.push(sample.q))?;
        first = next;
    }
    stream.finish(problem.ends.end, &mut |sample| plan.push(sample.q))?;
    Ok((plan, stream.uncertain()))
}

#[test]
fn a_look_ahead_that_is_long_enough_gives_the_plan_of_the_whole_path() {
    let mut longest = 0;
    for seed in 0..12 {
        let problem = random::problem(seed, 3, 6000, Collocation::Throughout);
        let whole = reach::solve(&problem).unwrap();
        let mut lookahead = 25;
        loop {
            let (plan, uncertain) = streamed(&problem, lookahead, seed).unwrap();
            assert_eq!(plan.len(), whole.len());
            if uncertain == 0 {
                assert_eq!(plan, whole, "seed {seed}");
                break;
            }
            lookahead *= 2;
        }
        longest = longest.max(lookahead);
    }
    assert!((50..3000).contains(&longest), "{longest}");
}

#[test]
fn too_short_a_look_ahead_costs_speed_and_breaks_no_limit() {
    let mut slower = 0;
    for seed in 0..12 {
        for problem in [random::problem(seed, 3, 3000, Collocation::Ends), random::any(seed, 3000)]
        {
            let whole = reach::solve(&problem).unwrap();
            for lookahead in [1, 2, 7, 40] {
                let (plan, uncertain) = streamed(&problem, lookahead, seed).unwrap();
                let worst = problem.worst(&plan);
                assert!(worst.share <= 1.0 + 1e-11, "seed {seed}, {lookahead}: {worst:?}");
                assert_eq!((plan[0], plan[3000 - 1]), (0.0, 0.0));
                if uncertain == 0 {
                    assert_eq!(plan, whole, "seed {seed}, {lookahead}");
                }
                slower += usize::from(plan.iter().sum::<f64>() < whole.iter().sum());
            }
        }
    }
    assert!(slower > 20, "{slower}");
}

#[test]
fn a_start_and_an_end_in_motion_are_kept() {
    let mut problem = random::problem(3, 3, 4000, Collocation::Throughout);
    problem.ends = EndSpeeds { start: 0.1 * problem.upper[0], end: 0.1 * problem.upper[3999] };
    let whole = reach::solve(&problem).unwrap();
    let (plan, _) = streamed(&problem, 1500, 3).unwrap();
    assert_eq!((plan[0], plan[3999]), (problem.ends.start, problem.ends.end));
    assert!(problem.worst(&plan).share <= 1.0 + 1e-11);
    assert_eq!(plan, whole);
}
