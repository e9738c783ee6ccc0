//! A fit as its receiver sees it, and what is measured on it, from the samples alone.

use post_feed::fit::{CurveSample, FitPoint, FitRules, MOST, PathFit};

/// One leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    pub length: f64,
    pub begins: bool,
    pub ends: bool,
    pub samples: Vec<CurveSample>,
}

/// What a fit hands on of points that follow one another, and how far it says that it was off.
pub fn fitted(rules: &FitRules, points: &[FitPoint]) -> (Vec<Leg>, f64) {
    let mut fit = PathFit::new(rules.clone());
    let mut legs = Vec::new();
    let mut sink = |leg: &post_feed::fit::FittedLeg<'_>| {
        legs.push(Leg {
            length: leg.length,
            begins: leg.begins,
            ends: leg.ends,
            samples: leg.samples.to_vec(),
        });
    };
    for point in points {
        assert!(fit.push(point, &mut sink));
    }
    fit.cut(&mut sink);
    (legs, fit.worst())
}

/// Value and three derivatives between two samples, of the one polynomial of degree five that has their values, first
/// and second derivatives.
pub fn between(pair: [&CurveSample; 2], share: f64) -> [FitPoint; 4] {
    let width = pair[1].at - pair[0].at;
    let t = share;
    let mut result = [[0.0; MOST]; 4];
    for axis in 0..MOST {
        let [a, b] = pair.map(|sample| {
            let [value, first, second, _] = sample.values.map(|point| point[axis]);
            [value, first * width, second * width * width]
        });
        let rest = b[0] - a[0] - a[1] - 0.5 * a[2];
        let slope = b[1] - a[1] - a[2];
        let bend = b[2] - a[2];
        let third = 10.0 * rest - 4.0 * slope + 0.5 * bend;
        let fourth = -15.0 * rest + 7.0 * slope - bend;
        let fifth = 6.0 * rest - 3.0 * slope + 0.5 * bend;
        let t2 = t * t;
        let t3 = t2 * t;
        let value =
            a[0] + a[1] * t + 0.5 * a[2] * t2 + third * t3 + fourth * t2 * t2 + fifth * t2 * t3;
        let first = a[1] + a[2] * t + 3.0 * third * t2 + 4.0 * fourth * t3 + 5.0 * fifth * t2 * t2;
        let second = a[2] + 6.0 * third * t + 12.0 * fourth * t2 + 20.0 * fifth * t3;
        let jerk = 6.0 * third + 24.0 * fourth * t + 60.0 * fifth * t2;
        for (order, value) in [value, first, second, jerk].into_iter().enumerate() {
            let mut scale = 1.0;
            for _ in 0..order {
                scale *= width;
            }
            result[order][axis] = value / scale;
        }
    }
    result
}

/// Curvature of the tip's path.
pub fn curvature(values: &[FitPoint; 4]) -> f64 {
    let [first, second] = [1, 2].map(|order| [0, 1, 2].map(|axis| values[order][axis]));
    post_feed::samples::curvature(first, second)
}

/// What a whole fit has to show, whatever the points: one leg each, in order; ends that are the points; samples that
/// are shared, continuous third derivatives; and nowhere off by more than the tolerances, by brute force. Returns by
/// how many tolerances it is off: the largest, and all of them.
pub fn checked(rules: &FitRules, points: &[FitPoint]) -> (Vec<Leg>, Vec<f64>) {
    let (legs, told) = fitted(rules, points);
    assert_eq!(legs.len(), points.len().saturating_sub(1));
    let mut all = Vec::new();
    let mut open = false;
    let mut last: Option<CurveSample> = None;
    // Legs that are shorter than what counts as length stand at the first of their points.
    let mut stands = points.first().copied().unwrap_or([0.0; MOST]);
    for (index, leg) in legs.iter().enumerate() {
        // A piece ends where the last of those legs leads.
        let standing = legs[index + 1..].iter().take_while(|leg| leg.samples.is_empty());
        let next = points[index + 1 + if leg.ends { standing.count() } else { 0 }];
        if leg.samples.is_empty() {
            assert!(leg.length == 0.0 && !leg.begins && !leg.ends);
            continue;
        }
        let (first, end) = (&leg.samples[0], &leg.samples[leg.samples.len() - 1]);
        assert_eq!(leg.begins, !open, "leg {index} begins a piece");
        open = !leg.ends;
        assert_eq!(first.at, 0.0);
        assert!((end.at - leg.length).abs() <= 1e-9 * leg.length.max(1.0));
        let same = |sample: &CurveSample, point: &FitPoint| {
            let far = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9 * (1.0 + b.abs());
            assert!(sample.values[0].iter().zip(point).all(far), "{sample:?} {point:?}");
        };
        if leg.begins {
            same(first, &stands);
        } else if let Some(last) = last {
            for order in 0..4 {
                let scale: f64 = last.values[order].iter().map(|value| value.abs()).sum();
                for axis in 0..rules.dimensions {
                    let off = (last.values[order][axis] - first.values[order][axis]).abs();
                    assert!(off <= 1e-7 * (1.0 + scale), "leg {index} order {order}: {off}");
                }
            }
        }
        if leg.ends {
            same(end, &next);
        }
        for pair in leg.samples.windows(2) {
            assert!(pair[1].at > pair[0].at);
            let pair = [&pair[0], &pair[1]];
            for step in 0..=16 {
                let share = f64::from(step) / 16.0;
                let at = pair[0].at + share * (pair[1].at - pair[0].at);
                let values = between(pair, share)[0];
                let off: FitPoint = std::array::from_fn(|axis| {
                    values[axis] - stands[axis] - at / leg.length * (next[axis] - stands[axis])
                });
                let tip = (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]).sqrt();
                let mut most = tip / rules.tolerance;
                for turn in &off[3..] {
                    most = most.max(turn.abs() / rules.turn_tolerance);
                }
                all.push(most);
            }
        }
        last = Some(*end);
        stands = next;
    }
    assert!(!open || legs.is_empty(), "the last piece has an end");
    let worst = all.iter().copied().fold(0.0, f64::max);
    assert!(worst <= told.max(1e-3) * 1.002, "off by {worst}, told {told}");
    assert!(worst <= 1.003, "off by {worst} tolerances");
    (legs, all)
}
