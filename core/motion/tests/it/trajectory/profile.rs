//! Profiles against the closed forms of textbooks, and against their own sums.

use post_motion::trajectory::profile::{Ramp, VelocityProfile};
use post_testkit::{Rng, randomised};

/// From rest to rest: trapezoid or triangle; with jerk the four double S.
fn textbook(length: f64, v: f64, a: f64, j: f64) -> f64 {
    if j == f64::INFINITY {
        return match length >= v * v / a {
            true => length / v + v / a,
            false => 2.0 * (length / a).sqrt(),
        };
    }
    let reaches_acceleration = v * j >= a * a;
    let ramps = match reaches_acceleration {
        true => v * (v / a + a / j),
        false => 2.0 * v * (v / j).sqrt(),
    };
    if length >= ramps {
        return match reaches_acceleration {
            true => length / v + v / a + a / j,
            false => length / v + 2.0 * (v / j).sqrt(),
        };
    }
    if length >= 2.0 * a * a * a / (j * j) {
        let half = a / (2.0 * j);
        return a / j + 2.0 * (half * half + length / a).sqrt();
    }
    4.0 * libm::cbrt(length / (2.0 * j))
}

#[test]
fn from_rest_to_rest_it_takes_the_time_of_the_textbook() {
    let (rounds, mut rng) = randomised(20_000u32, 1);
    for _ in rounds {
        let [length, v, a] =
            [(-6.0, 4.0), (-2.0, 4.0), (-1.0, 5.0)].map(|(from, to)| rng.order(from, to));
        let j = match rng.pick(3) {
            0 => f64::INFINITY,
            _ => rng.order(0.0, 7.0),
        };
        let ramp = Ramp { acceleration: a, jerk: j };
        let profile = VelocityProfile::new(length, [0.0, 0.0], v, ramp, ramp);
        let (own, due) = (profile.seconds(), textbook(length, v, a, j));
        assert!(libm::fabs(own - due) <= 1e-9 * due, "{length} {v} {a} {j}: {own}, not {due}");
    }
}

fn ramp(rng: &mut Rng) -> Ramp {
    Ramp {
        acceleration: rng.order(0.0, 5.0),
        jerk: match rng.pick(3) {
            0 => f64::INFINITY,
            _ => rng.order(1.0, 7.0),
        },
    }
}

#[test]
fn profiles_keep_their_limits_and_end_where_and_as_they_should() {
    let (rounds, mut rng) = randomised(20_000u32, 2);
    for _ in rounds {
        let length = rng.order(-6.0, 3.0);
        let [up, down] = [ramp(&mut rng), ramp(&mut rng)];
        let from = [0.0, rng.order(-2.0, 3.0)][rng.pick(2)];
        // The other end is one that can be reached, its very limit at times.
        let most = up.reach(from, length);
        let share = [0.0, 0.999_999, rng.range(0.0, 1.0)][rng.pick(3)];
        let to = match rng.pick(2) {
            0 => from + (most - from) * share,
            _ => from * share,
        };
        if to < from && down.length(from, to) > length {
            continue;
        }
        let top = from.max(to) * rng.range(1.0, 2.0) + [0.0, rng.order(-2.0, 3.0)][rng.pick(2)];
        // A change that rounding makes half of says nothing of its own time.
        let change = libm::fabs(to - from);
        if top == 0.0 || change > 0.0 && change < 1e-6 * from {
            continue;
        }
        let profile = VelocityProfile::new(length, [from, to], top, up, down);
        let (mut covered, mut velocity, mut last) = (0.0, from, 0.0);
        let counts = profile.counts();
        for (place, phase) in profile.phases().iter().enumerate() {
            let ramp = if place < counts[0] { up } else { down };
            let near = |one: f64, other: f64, size: f64| libm::fabs(one - other) <= 1e-8 * size;
            assert!(phase.seconds >= 0.0);
            assert!(near(phase.velocity, velocity, top.max(1e-9)), "{profile:?}");
            if ramp.jerk.is_finite() {
                assert!(near(phase.acceleration, last, ramp.acceleration));
                assert!(libm::fabs(phase.jerk) <= ramp.jerk * (1.0 + 1e-9));
            }
            for t in [0.0, 0.5, 1.0].map(|share| share * phase.seconds) {
                assert!(
                    phase.velocity(t) >= -1e-9 * top && phase.velocity(t) <= top * (1.0 + 1e-9)
                );
                assert!(libm::fabs(phase.acceleration(t)) <= ramp.acceleration * (1.0 + 1e-9));
            }
            covered += phase.length(phase.seconds);
            velocity = phase.velocity(phase.seconds);
            last = match ramp.jerk.is_finite() {
                true => phase.acceleration(phase.seconds),
                false => 0.0,
            };
        }
        // Without jerk limits the peak is a root, rounded by up to two units of its last place; a ramp covers `v/a` more
        // for each unit of velocity that it reaches more. With them the ramps are made to fit.
        let rounding = match up.jerk == f64::INFINITY && down.jerk == f64::INFINITY {
            true => {
                2.0 * f64::EPSILON * top * top * (1.0 / up.acceleration + 1.0 / down.acceleration)
            }
            false => 0.0,
        };
        assert!(
            libm::fabs(covered - length) <= 1e-8 * length + 1e-12 + rounding,
            "{covered} {length} {profile:?}"
        );
        assert!(libm::fabs(velocity - to) <= 1e-7 * top, "{velocity} {to}");
        let middle = 0.37 * profile.seconds();
        let step = 1e-6 * profile.seconds();
        let [before, at, after] = [-step, 0.0, step].map(|off| profile.at(middle + off));
        let slope = (after[0] - before[0]) / (2.0 * step);
        assert!(libm::fabs(slope - at[1]) <= 1e-4 * top.max(at[1]), "{slope} {at:?}");
    }
}

#[test]
fn a_ramp_reaches_what_its_length_allows() {
    let (rounds, mut rng) = randomised(20_000u32, 3);
    for _ in rounds {
        let ramp = ramp(&mut rng);
        let from = [0.0, rng.order(-3.0, 3.0)][rng.pick(2)];
        let length = rng.order(-9.0, 4.0);
        let to = ramp.reach(from, length);
        let covered = ramp.length(from, to);
        // Where hardly anything is gained, the velocity says nothing of the length any more: rounded by two units of its last
        // place, 4e-16 of it, it says what is gained to 4e-8 here.
        let gained = (to - from) > 1e-8 * from;
        assert!(covered <= length * (1.0 + 1e-7) || !gained, "{ramp:?} {from} {length}: {to}");
        assert!(covered >= length * (1.0 - 1e-6) || !gained, "{ramp:?} {from} {length}: {to}");
    }
}
