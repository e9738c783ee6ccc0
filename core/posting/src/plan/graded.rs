//! Samples along straight ways, closer towards the ends of a leg: there the speed changes.

use post_feed::fit::{MOST, Point, Sample};

/// A way is straight whose direction changes by less than this share from sample to sample.
const STRAIGHT: f64 = 1e-3;

/// Samples are as far apart as this share of the way to the nearer end of their leg.
const GRADE: f64 = 0.5;

/// The samples of a leg behind its first, with more of them where it goes straight: `finest` apart at its ends.
pub(super) fn graded(first: &Sample, rest: &[Sample], finest: f64, out: &mut Vec<Sample>) {
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
                out.push(on(from, at));
            }
        }
        out.push(*to);
        from = to;
    }
}

/// As many samples behind the first as that, by halving the longest ways.
pub(super) fn at_least(count: usize, first: &Sample, samples: &mut Vec<Sample>) {
    while !samples.is_empty() && samples.len() < count {
        let from = |place: usize| {
            if place == 0 {
                first
            } else {
                &samples[place - 1]
            }
        };
        let length = |place: &usize| samples[*place].at - from(*place).at;
        let longest = (0..samples.len()).max_by(|one, other| length(one).total_cmp(&length(other)));
        let Some(place) = longest else {
            return;
        };
        let before = from(place);
        let middle = on(before, before.at.midpoint(samples[place].at));
        samples.insert(place, middle);
    }
}

fn straight(from: &Sample, to: &Sample) -> bool {
    let step = to.at - from.at;
    let size = |point: &Point| point.iter().map(|part| part * part).sum::<f64>().sqrt();
    let speed = size(&from.values[1]);
    [from, to]
        .iter()
        .all(|sample| size(&sample.values[2]) * step <= STRAIGHT * speed)
}

/// The curve so far on from a sample, by its derivatives there.
fn on(from: &Sample, at: f64) -> Sample {
    let way = at - from.at;
    let [value, first, second, third] = &from.values;
    let sum = |terms: [(&Point, f64); 4]| -> Point {
        std::array::from_fn(|axis| terms.iter().map(|(term, share)| term[axis] * share).sum())
    };
    let none = [0.0; MOST];
    let (square, cube) = (way * way / 2.0, way * way * way / 6.0);
    Sample {
        at,
        values: [
            sum([(value, 1.0), (first, way), (second, square), (third, cube)]),
            sum([(first, 1.0), (second, way), (third, square), (&none, 0.0)]),
            sum([(second, 1.0), (third, way), (&none, 0.0), (&none, 0.0)]),
            *third,
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(at: f64, bend: f64) -> Sample {
        let mut values = [[0.0; MOST]; 4];
        values[0][0] = at;
        values[1][0] = 1.0;
        values[2][1] = bend;
        Sample { at, values }
    }

    #[test]
    fn a_straight_leg_has_samples_close_to_its_ends() {
        let mut out = Vec::new();
        graded(
            &sample(0.0, 0.0),
            &[sample(20.0, 0.0), sample(40.0, 0.0)],
            0.05,
            &mut out,
        );
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
        assert!(
            places[0] <= 0.05 && 40.0 - places[places.len() - 2] <= 0.15,
            "{places:?}"
        );
    }

    #[test]
    fn a_bent_leg_is_left_as_it_is() {
        let mut out = Vec::new();
        graded(&sample(0.0, 0.1), &[sample(20.0, 0.1)], 0.05, &mut out);
        assert_eq!(out.len(), 1);
    }
}
