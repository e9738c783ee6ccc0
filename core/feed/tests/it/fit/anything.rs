//! What holds for any points whatever.

use post_feed::fit::{FitPoint, FitRules, MOST, PathFit};

use super::course::{checked, fitted};
use post_testkit::{Rng, randomised};

/// A path of steps whose lengths span decades, with bends, corners, points that stand and turns alone.
fn wild(seed: u64, count: usize, dimensions: usize, scale: f64) -> Vec<FitPoint> {
    let mut random = Rng::new(seed);
    let mut direction = [0.0; MOST];
    direction[0] = 1.0;
    let mut point = [0.0; MOST];
    let mut all = vec![point];
    let mut length = scale;
    while all.len() < count {
        let chance = random.range(0.0, 1.0);
        if chance < 0.05 {
            length = scale * libm::pow(10.0, random.range(-4.0, 2.0));
        } else if chance < 0.1 {
            all.push(point);
            continue;
        }
        let bend = if random.range(0.0, 1.0) < 0.03 { 2.0 } else { 0.15 };
        for value in &mut direction[..dimensions] {
            *value += random.range(-bend, bend);
        }
        let size = direction.iter().map(|value| value * value).sum::<f64>().sqrt();
        direction = direction.map(|value| value / size);
        for (axis, value) in point[..dimensions].iter_mut().enumerate() {
            let step = length * direction[axis];
            *value += if axis < 3 { step } else { 0.01 * step / scale.max(1.0) };
        }
        all.push(point);
    }
    all
}

fn rules(dimensions: usize, tolerance: f64, spacing: Option<f64>) -> FitRules {
    FitRules {
        dimensions,
        tolerance,
        turn_tolerance: 0.02 * tolerance,
        corner: 0.6,
        turn_weight: 20.0,
        spacing,
        ..FitRules::default()
    }
}

#[test]
fn any_path_is_followed_within_its_tolerance() {
    let (rounds, mut random) = randomised(96, 1);
    for _ in rounds {
        let (seed, count, dimensions) = (random.next(), 1 + random.pick(699), 3 + random.pick(6));
        let (tolerance, scale) = (random.order(-3.0, -0.5), random.order(-1.0, 1.0));
        let spaced = random.pick(2) == 0;
        let points = wild(seed, count, dimensions, scale);
        let rules = rules(dimensions, tolerance, spaced.then_some(scale));
        checked(&rules, &points);
    }
}

/// Where the path is cut for other reasons, nothing changes before the window.
#[test]
fn what_is_settled_does_not_depend_on_what_comes_later() {
    let (rounds, mut random) = randomised(96, 2);
    for _ in rounds {
        let (seed, cut) = (random.next(), 10 + random.pick(1490));
        let points = wild(seed, 1500, 4, 1.0);
        let rules = rules(4, 0.01, None);
        let (whole, _) = fitted(&rules, &points);
        let mut fit = PathFit::new(rules);
        let mut early = Vec::new();
        for point in &points[..cut] {
            fit.push(point, &mut |leg| early.push(leg.samples.to_vec()));
        }
        for (early, whole) in early.iter().zip(&whole) {
            assert_eq!(early, &whole.samples, "{seed} {cut}");
        }
    }
}

#[test]
fn points_that_are_no_numbers_are_refused() {
    let mut fit = PathFit::new(FitRules::default());
    let mut legs = 0;
    let mut push = |fit: &mut PathFit, x: f64| {
        let mut point = [0.0; MOST];
        point[0] = x;
        fit.push(&point, &mut |leg| {
            assert!(
                leg.samples.iter().flat_map(|sample| sample.values).flatten().all(f64::is_finite)
            );
            legs += 1;
        })
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300] {
        assert!(!push(&mut fit, bad));
    }
    assert!(push(&mut fit, 0.0) && !push(&mut fit, f64::NAN) && push(&mut fit, 1.0));
    fit.cut(&mut |leg| {
        assert!(leg.begins && leg.ends && leg.length == 1.0);
        legs += 1;
    });
    assert_eq!(legs, 1);
}

/// A fit is ended where nothing was begun, twice, and by points that stand.
#[test]
fn cuts_without_points_hand_nothing_on() {
    let mut fit = PathFit::new(FitRules::default());
    let mut lengths = Vec::new();
    let point = |x: f64| {
        let mut point = [0.0; MOST];
        point[0] = x;
        point
    };
    let mut sink =
        |leg: &post_feed::fit::FittedLeg<'_>| lengths.push((leg.length, leg.samples.len()));
    fit.cut(&mut sink);
    fit.push(&point(1.0), &mut sink);
    fit.cut(&mut sink);
    fit.push(&point(1.0), &mut sink);
    fit.cut(&mut sink);
    fit.push(&point(3.0), &mut sink);
    fit.push(&point(3.0), &mut sink);
    fit.cut(&mut sink);
    fit.cut(&mut sink);
    assert_eq!(lengths, [(0.0, 0), (2.0, 2), (0.0, 0)]);
}
