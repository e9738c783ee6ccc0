use post_feed::limits::{Collocation, TipFeed};
use post_feed::samples::Samples;
use post_feed::{EndSpeeds, Infeasible, Problem};

/// Ten samples a millimetre apart: 40 mm/s, from sample 4 on 10 mm/s.
fn slower() -> Samples {
    let mut samples = Samples::default();
    for index in 0..10 {
        let first = [0.0, 2.0, 0.0];
        samples.push(f64::from(index), [first, [0.0; 3], [0.0; 3]], &[]);
        samples.feeds.push(if index < 4 { 40.0 } else { 10.0 });
    }
    samples
}

fn speeds(samples: &Samples, collocation: Collocation) -> Result<Vec<f64>, Infeasible> {
    let feed = TipFeed { most: 30.0, collocation };
    let problem = Problem::new(samples, &[&feed], EndSpeeds::default())?;
    Ok(problem.upper.into_iter().map(f64::sqrt).collect())
}

#[test]
fn the_feed_of_a_block_counts_where_it_is_the_lower() {
    let mut samples = slower();
    // Two millimetres of the tip for one of the parameter.
    let at_samples = [[15.0; 4].as_slice(), &[5.0; 6]].concat();
    assert_eq!(speeds(&samples, Collocation::Start), Ok(at_samples));
    // The slower block may begin anywhere after sample 3.
    let throughout = [[15.0; 3].as_slice(), &[5.0; 7]].concat();
    assert_eq!(speeds(&samples, Collocation::Throughout), Ok(throughout.clone()));
    // And the same backwards.
    samples.feeds.reverse();
    let backwards: Vec<f64> = throughout.into_iter().rev().collect();
    assert_eq!(speeds(&samples, Collocation::Throughout), Ok(backwards));
}

#[test]
fn where_rotary_axes_alone_turn_the_feed_counts_by_the_parameter() {
    let mut samples = slower();
    // What is left of a tip that stands still is rounding.
    for first in &mut samples.tip[0][5..] {
        *first = [1e-17, 0.0, 0.0];
    }
    let at_samples = [[15.0; 4].as_slice(), &[5.0], &[10.0; 5]].concat();
    assert_eq!(speeds(&samples, Collocation::Start), Ok(at_samples));
    let throughout = [[15.0; 3].as_slice(), &[5.0; 3], &[10.0; 4]].concat();
    assert_eq!(speeds(&samples, Collocation::Throughout), Ok(throughout));
    let still = [1e-17, 0.0, 0.0];
    assert_eq!(post_feed::samples::curvature(still, [0.0, 1e-17, 0.0]), 0.0);
}

#[test]
fn a_feed_that_is_none_is_refused_by_its_place() {
    for wrong in [f64::NAN, -1.0] {
        for collocation in [Collocation::Start, Collocation::Throughout] {
            let mut samples = slower();
            samples.feeds[7] = wrong;
            let fault = speeds(&samples, collocation).unwrap_err();
            assert!(matches!(fault, Infeasible::NotANumber { .. }), "{fault:?}");
        }
    }
    let mut samples = slower();
    samples.feeds.pop();
    assert_eq!(speeds(&samples, Collocation::Start), Err(Infeasible::Shape));
}
