//! More samples of a leg: along straight ways, closer towards its ends, where the speed changes; next to stops; and where
//! the way bends otherwise between samples than at them.

use post_feed::fit::{CurveSample, FitPoint};
use post_feed::quintic;

/// A way is straight whose direction changes by less than this share from sample to sample.
const STRAIGHT: f64 = 1e-3;

/// A way is bent evenly whose second derivative halfway is off what is between those of its ends by less than this share
/// of the largest of the three.
const UNEVEN: f64 = 0.05;

/// Largest number of times that a way is halved.
const MOST_HALVED: usize = 3;

/// Samples are as far apart as this share of the way to the nearer end of their leg.
const GRADE: f64 = 0.5;

/// The samples of a leg after its first, with more of them where it goes straight: `finest` apart at its ends.
pub(super) fn graded(
    first: &CurveSample,
    rest: &[CurveSample],
    finest: f64,
    out: &mut Vec<CurveSample>,
) {
    out.clear();
    let Some(end) = rest.last().map(|last| last.at) else {
        return;
    };
    let mut from = first;
    for to in rest {
        if straight(from, to) {
            let mut at = from.at;
            loop {
                let room = |at: f64| (at - first.at).min(end - at).max(0.0);
                let step = (GRADE * room(at)).max(finest);
                // On the way to the end steps get shorter: what is left then counts.
                let step = step.min((GRADE * room(at + step)).max(finest));
                at += step;
                if at + 0.5 * finest >= to.at {
                    break;
                }
                out.push(on(from, to, at));
            }
        }
        out.push(*to);
        from = to;
    }
}

/// As many samples after the first as that, by halving the longest ways.
pub(super) fn at_least(count: usize, first: &CurveSample, samples: &mut Vec<CurveSample>) {
    while !samples.is_empty() && samples.len() < count {
        let from = |place: usize| {
            if place == 0 { first } else { &samples[place - 1] }
        };
        let length = |place: &usize| samples[*place].at - from(*place).at;
        let longest = (0..samples.len()).max_by(|one, other| length(one).total_cmp(&length(other)));
        let Some(place) = longest else {
            return;
        };
        let middle = halfway(from(place), &samples[place]);
        samples.insert(place, middle);
    }
}

/// Puts in samples where the second derivative halfway is not about what is between those of both sides: limits are held
/// against what is linear from sample to sample.
pub(super) fn evenly_bent(first: &CurveSample, samples: &mut Vec<CurveSample>) {
    let mut place = 0;
    let mut from = *first;
    while place < samples.len() {
        let to = samples[place];
        place = halve(&from, &to, place, MOST_HALVED, samples) + 1;
        from = to;
    }
}

/// Puts what is needed between two samples, the second of which stands at `place`: where it stands then.
fn halve(
    from: &CurveSample,
    to: &CurveSample,
    place: usize,
    times: usize,
    samples: &mut Vec<CurveSample>,
) -> usize {
    let middle = halfway(from, to);
    let [here, half, there] = [from, &middle, to].map(|sample| sample.values[2]);
    let off: FitPoint = std::array::from_fn(|axis| half[axis] - 0.5 * (here[axis] + there[axis]));
    let most = size(&here).max(size(&half)).max(size(&there));
    if times == 0 || size(&off) <= UNEVEN * most {
        return place;
    }
    samples.insert(place, middle);
    let place = halve(from, &middle, place, times - 1, samples);
    halve(&middle, to, place + 1, times - 1, samples)
}

fn straight(from: &CurveSample, to: &CurveSample) -> bool {
    let step = to.at - from.at;
    let speed = size(&from.values[1]);
    [from, to].iter().all(|sample| size(&sample.values[2]) * step <= STRAIGHT * speed)
}

fn size(point: &FitPoint) -> f64 {
    point.iter().map(|part| part * part).sum::<f64>().sqrt()
}

fn halfway(from: &CurveSample, to: &CurveSample) -> CurveSample {
    on(from, to, from.at.midpoint(to.at))
}

/// The curve between two samples.
fn on(from: &CurveSample, to: &CurveSample, at: f64) -> CurveSample {
    let step = to.at - from.at;
    CurveSample {
        at,
        values: quintic::between(&from.values, &to.values, step, (at - from.at) / step),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_feed::fit;

    fn sample(at: f64, bend: f64) -> CurveSample {
        let mut values = [[0.0; fit::MOST]; 4];
        values[0][0] = at;
        values[1][0] = 1.0;
        values[2][1] = bend;
        CurveSample { at, values }
    }

    /// Sample of `y = s⁵ / 20`, whose second derivative is a cubic.
    fn fifth(at: f64) -> CurveSample {
        let mut values = [[0.0; fit::MOST]; 4];
        (values[0][0], values[1][0]) = (at, 1.0);
        let [square, cube] = [at * at, at * at * at];
        values[0][1] = cube * square / 20.0;
        values[1][1] = square * square / 4.0;
        values[2][1] = cube;
        values[3][1] = 3.0 * square;
        CurveSample { at, values }
    }

    #[test]
    fn an_uneven_bend_has_samples_between_which_it_is_about_linear() {
        let (first, mut samples) = (fifth(-2.0), vec![fifth(0.5), fifth(2.0)]);
        evenly_bent(&first, &mut samples);
        assert!((6..=16).contains(&samples.len()), "{}", samples.len());
        let mut from = first;
        for to in samples {
            let wanted = fifth(to.at);
            for (found, wanted) in to.values.iter().flatten().zip(wanted.values.iter().flatten()) {
                assert!((found - wanted).abs() < 1e-12);
            }
            let linear = 0.5 * (from.values[2][1] + to.values[2][1]);
            let off = (fifth(from.at.midpoint(to.at)).values[2][1] - linear).abs();
            let most = from.values[2][1].abs().max(to.values[2][1].abs());
            assert!(off <= 0.05 * most || to.at - from.at < 0.32, "{}", to.at);
            from = to;
        }
        let (first, mut even) = (sample(0.0, 0.1), vec![sample(20.0, 0.1)]);
        even[0].values[1][1] = 2.0;
        even[0].values[0][1] = 20.0;
        evenly_bent(&first, &mut even);
        assert_eq!(even.len(), 1);
    }

    #[test]
    fn a_straight_leg_has_samples_close_to_its_ends() {
        let mut out = Vec::new();
        graded(&sample(0.0, 0.0), &[sample(20.0, 0.0), sample(40.0, 0.0)], 0.05, &mut out);
        let places: Vec<f64> = out.iter().map(|sample| sample.at).collect();
        assert!(out.len() < 60, "{places:?}");
        let mut before: f64 = 0.0;
        for (sample, at) in out.iter().zip(&places) {
            let room = before.max(0.1).min((40.0 - at).max(0.1));
            assert!(at - before <= 1.01 * room.max(0.05), "{before} {at}");
            assert!(*at > before && (sample.values[0][0] - at).abs() < 1e-12);
            before = *at;
        }
        assert_eq!(before, 40.0);
        assert!(places[0] <= 0.05 && 40.0 - places[places.len() - 2] <= 0.15, "{places:?}");
    }

    #[test]
    fn a_bent_leg_is_left_as_it_is() {
        let mut out = Vec::new();
        graded(&sample(0.0, 0.1), &[sample(20.0, 0.1)], 0.05, &mut out);
        assert_eq!(out.len(), 1);
    }
}
