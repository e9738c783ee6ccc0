//! Close to a singular direction: the axis that turns the tool by nearly nothing there need not stand exactly
//! where the path asks for it. At an angle θ from the pole, turning it by δ too far moves the tool axis by
//! sin θ · δ only, so each point leaves it a range, and over all points these ranges are a tube around its
//! values. The shortest way through that tube, drawn over time, is the string pulled taut: it has the least
//! travel and at the same time the least largest speed that the tolerance permits. Holding the axis, turning it
//! early and turning it evenly are what the string does when the tube is wide, when it ends at a new angle, and
//! between two of them.

/// One point of the tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TubePoint {
    /// Time from the point before, minutes; none where the axis may turn as it likes (a rapid).
    pub time: Option<f64>,
    /// Least and largest value, radians.
    pub range: [f64; 2],
}

/// The taut string through `gates` from `start`, one value a gate.
pub(crate) fn taut(start: Option<f64>, gates: &[TubePoint]) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::with_capacity(gates.len());
    let mut first = 0;
    let mut from = start;
    while first < gates.len() {
        // A piece without a free jump in it; the first gate's own time belongs to the way to it.
        let end = gates[first + 1..]
            .iter()
            .position(|gate| gate.time.is_none())
            .map_or(gates.len(), |place| first + 1 + place);
        pull(from, &gates[first..end], &mut values);
        from = values.last().copied();
        first = end;
    }
    values
}

/// One piece: on from `before`, or, where its first gate may be jumped to, from anywhere.
fn pull(before: Option<f64>, gates: &[TubePoint], values: &mut Vec<f64>) {
    let start = before.filter(|_| gates[0].time.is_some());
    let mut from = start.unwrap_or_else(|| free_start(gates, before.unwrap_or(0.0)));
    let mut times: Vec<f64> = Vec::with_capacity(gates.len());
    let mut clock = 0.0;
    for (index, gate) in gates.iter().enumerate() {
        if index > 0 || start.is_some() {
            clock += gate.time.unwrap_or(0.0).max(1e-9);
        }
        times.push(clock);
    }
    let mut at = 0.0;
    let mut next = 0;
    if start.is_none() {
        values.push(from);
        next = 1;
    }
    while next < gates.len() {
        // The steepest and the flattest string from here that all gates so far let through, and where each
        // of the two is held.
        let (mut least, mut most) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut least_at, mut most_at) = (next, next);
        let mut kink = None;
        for index in next..gates.len() {
            let time = times[index] - at;
            let [low, high] = gates[index].range;
            let (low, high) = ((low - from) / time, (high - from) / time);
            if low > most {
                kink = Some((most_at, most));
                break;
            }
            if high < least {
                kink = Some((least_at, least));
                break;
            }
            if low >= least {
                (least, least_at) = (low, index);
            }
            if high <= most {
                (most, most_at) = (high, index);
            }
        }
        // To the end nothing stops it: as flat as may be.
        let (to, slope) = kink.unwrap_or_else(|| {
            let flat = 0f64.max(least).min(most);
            let to = if flat == 0.0 {
                gates.len() - 1
            } else if flat == least {
                least_at
            } else {
                most_at
            };
            (to, flat)
        });
        for index in next..=to {
            let [low, high] = gates[index].range;
            let value = from + slope * (times[index] - at);
            values.push(value.max(low).min(high));
        }
        from = values.last().copied().unwrap_or(from);
        at = times[to];
        next = to + 1;
    }
}

/// Where a string begins that may begin anywhere: where it need not turn for as long as possible, and of
/// those values at the one nearest to `before`.
fn free_start(gates: &[TubePoint], before: f64) -> f64 {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for gate in gates {
        let [least, most] = gate.range;
        if least > high {
            return high;
        }
        if most < low {
            return low;
        }
        (low, high) = (low.max(least), high.min(most));
    }
    before.max(low).min(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate(time: f64, low: f64, high: f64) -> TubePoint {
        TubePoint { time: Some(time), range: [low, high] }
    }

    fn wide(time: f64) -> TubePoint {
        gate(time, f64::NEG_INFINITY, f64::INFINITY)
    }

    #[test]
    fn it_turns_evenly_between_two_values() {
        let gates = [wide(1.0), wide(2.0), gate(1.0, 4.0, 4.0)];
        assert_eq!(taut(Some(0.0), &gates), [1.0, 3.0, 4.0]);
    }

    #[test]
    fn it_holds_where_nothing_is_asked() {
        assert_eq!(taut(Some(2.0), &[wide(1.0), gate(1.0, -3.0, 3.0)]), [2.0, 2.0]);
    }

    #[test]
    fn it_turns_early_where_it_may_jump() {
        let jump = TubePoint { time: None, range: [f64::NEG_INFINITY, f64::INFINITY] };
        let gates = [wide(1.0), jump, wide(1.0), gate(1.0, 5.0, 5.0)];
        assert_eq!(taut(Some(0.0), &gates), [0.0, 5.0, 5.0, 5.0]);
    }

    #[test]
    fn it_kinks_at_the_gates_that_hold_it() {
        let gates = [gate(1.0, 2.0, 9.0), gate(1.0, -9.0, 1.0), gate(2.0, 1.0, 1.0)];
        assert_eq!(taut(Some(0.0), &gates), [2.0, 1.0, 1.0]);
    }

    /// Against the least sum of squared slopes, by many small steps downhill: the same string.
    #[test]
    fn it_is_the_string_with_the_least_squared_speed() {
        let mut seed = 7u64;
        let mut random = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..200 {
            let count = 2 + (random() * 8.0) as usize;
            let gates: Vec<TubePoint> = (0..count)
                .map(|_| {
                    let middle = 4.0 * random();
                    let half = 1.5 * random();
                    gate(0.2 + random(), middle - half, middle + half)
                })
                .collect();
            let string = taut(Some(1.0), &gates);
            // Gauss and Seidel: each value to its best place between its neighbours, inside its gate.
            let mut values: Vec<f64> = gates.iter().map(|gate| gate.range[0]).collect();
            for _ in 0..20_000 {
                for index in 0..count {
                    let before = if index == 0 { 1.0 } else { values[index - 1] };
                    let (time, _) = (gates[index].time.expect("timed"), ());
                    let best = match gates.get(index + 1) {
                        Some(next) => {
                            let after = next.time.expect("timed");
                            (before * after + values[index + 1] * time) / (time + after)
                        }
                        None => before,
                    };
                    let [low, high] = gates[index].range;
                    values[index] = best.max(low).min(high);
                }
            }
            for (a, b) in string.iter().zip(&values) {
                assert!((a - b).abs() < 1e-6, "{string:?} {values:?} {gates:?}");
            }
        }
    }
}
