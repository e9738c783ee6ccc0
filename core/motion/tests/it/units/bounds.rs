//! Bounds of moves: all places of what is limited together, against one after the other.

use post_machine::kinematics::{Joints, MAX_AXES};
use post_motion::limits::{AxisLimits, MoveLimits};
// As the file below names it.
use post_motion::trajectory::TimeLimit;
use post_testkit::{Rng, randomised};

#[path = "../../../src/trajectory/bounds.rs"]
mod source;
use source::{
    ARC, CURVE, DerivativeBounds, MoveBounds, MoveDemand, NORMAL, PlaceLimits, largest_rate,
};

/// As the file has it, s.
const INSTANT: f64 = 1e-6;

/// One thing that is limited.
struct Quantity {
    derivatives: [f64; 3],
    circle: f64,
    limits: [f64; 3],
    by: [TimeLimit; 3],
}

/// Bounds as they follow from the rules one limit after the other, for what goes at all.
fn one_by_one(
    found: &MoveLimits,
    rules: &AxisLimits,
    [seconds, share]: [f64; 2],
    sweep: Option<f64>,
) -> MoveBounds {
    let mut all: Vec<Quantity> = (0..MAX_AXES)
        .map(|place| Quantity {
            derivatives: [found.first[place], found.second[place], found.third[place]],
            circle: found.circle.map_or(0.0, |circle| circle[place]),
            limits: [rules.velocity[place], rules.acceleration[place], rules.jerk[place]],
            by: [
                TimeLimit::AxisVelocity(place as u8),
                TimeLimit::AxisAcceleration(place as u8),
                TimeLimit::AxisJerk(place as u8),
            ],
        })
        .collect();
    all.push(Quantity {
        derivatives: found.tip,
        circle: found.tip[0],
        limits: [f64::INFINITY, rules.tip_acceleration, rules.tip_jerk],
        by: [TimeLimit::Feed, TimeLimit::TipAcceleration, TimeLimit::TipJerk],
    });
    all.retain(|one| one.derivatives.iter().any(|value| *value > 0.0));
    let mut bounds = MoveBounds {
        rate: 1.0 / seconds.max(INSTANT),
        acceleration: f64::INFINITY,
        jerk: f64::INFINITY,
        by: [TimeLimit::Feed; 3],
    };
    let least = |bound: &mut f64, own: &mut TimeLimit, value: f64, by: TimeLimit| {
        if value < *bound {
            (*bound, *own) = (value, by);
        }
    };
    let mut free = f64::INFINITY;
    for one in &all {
        let [first, second, third] = one.derivatives;
        free = free.min(one.limits[0] / first);
        let (rate, by) = (&mut bounds.rate, &mut bounds.by[0]);
        least(rate, by, one.limits[0] / first, one.by[0]);
        let most = match sweep {
            Some(sweep) => ARC * share * one.limits[1] / (sweep * one.circle),
            None => NORMAL * share * one.limits[1] / second,
        };
        least(rate, by, most.sqrt(), one.by[1]);
        least(rate, by, libm::cbrt(share * one.limits[2] / (CURVE * third)), one.by[2]);
    }
    let rate = bounds.rate;
    for one in &all {
        let [first, second, third] = one.derivatives;
        let (most, hardest) = (share * one.limits[1], share * one.limits[2]);
        let (change, by) = (&mut bounds.acceleration, &mut bounds.by[1]);
        let along = match sweep {
            Some(sweep) => {
                let first = one.circle.max(first);
                let across = sweep * first * free * free;
                match second > 0.0 && across > ARC * most {
                    true => 0.5 * most / first,
                    false => (most * most - across * across).sqrt() / first,
                }
            }
            None => (most - second * rate * rate) / first,
        };
        least(change, by, along, one.by[1]);
        if second > 0.0 {
            least(change, by, hardest / (9.0 * second * rate), one.by[2]);
        }
        let spent = third * rate * rate * rate;
        let mixed = 3.0 * second * rate * bounds.acceleration;
        let left = (hardest - spent - mixed).max(hardest / 3.0);
        least(&mut bounds.jerk, &mut bounds.by[2], left / first, one.by[2]);
    }
    bounds.acceleration = bounds.acceleration.min(rate / INSTANT);
    bounds
}

/// A size over many orders; at times nothing, and at times one that others have too.
fn size(rng: &mut Rng) -> f64 {
    match rng.pick(6) {
        0 => 0.0,
        1 => 2.0,
        _ => libm::pow(10.0, rng.range(-6.0, 4.0)),
    }
}

fn limit(rng: &mut Rng) -> f64 {
    match rng.pick(8) {
        0 => f64::INFINITY,
        1 => 0.0,
        2 => 16.0,
        _ => libm::pow(10.0, rng.range(-2.0, 6.0)),
    }
}

/// All places together give the bits that one after the other gives, and the same reasons: where nothing goes, where
/// limits are missing or zero, and where several ask for the same.
#[test]
fn bounds_of_all_places_are_those_of_one_after_the_other() {
    let (rounds, mut rng) = randomised(60_000, 71);
    let mut reasons = std::collections::BTreeSet::new();
    for round in rounds {
        let axes = 1 + rng.pick(MAX_AXES);
        let mut joints = |each: fn(&mut Rng) -> f64, rest: f64| -> Joints {
            std::array::from_fn(|place| if place < axes { each(&mut rng) } else { rest })
        };
        let mut found = MoveLimits { first: joints(size, 0.0), ..MoveLimits::default() };
        if round % 3 > 0 {
            (found.second, found.third) = (joints(size, 0.0), joints(size, 0.0));
        }
        let circle = (round % 4 == 0).then(|| joints(size, 0.0));
        let rules = AxisLimits {
            velocity: joints(limit, f64::INFINITY),
            acceleration: joints(limit, f64::INFINITY),
            jerk: joints(limit, f64::INFINITY),
            jump: [f64::INFINITY; MAX_AXES],
            tip_acceleration: limit(&mut rng),
            tip_jerk: limit(&mut rng),
            tip_jump: f64::INFINITY,
            programmed: None,
        };
        found.circle = circle;
        found.tip = [size(&mut rng), size(&mut rng), size(&mut rng)];
        let sweep = circle.map(|_| rng.range(0.01, 6.0));
        let asked = [size(&mut rng), if round % 2 == 0 { 1.0 } else { 0.5 }];
        let demand = MoveDemand { seconds: asked[0], share: asked[1], sweep };
        let (derivatives, limits) = (DerivativeBounds::of(&found), PlaceLimits::of(&rules));
        let together = MoveBounds::new(&derivatives, &limits, &demand);
        assert_eq!(largest_rate(&derivatives, &limits, &demand), together.rate);
        let single = one_by_one(&found, &rules, asked, sweep);
        let bits = |bounds: &MoveBounds| {
            let values = [bounds.rate, bounds.acceleration, bounds.jerk];
            (values.map(f64::to_bits), bounds.by)
        };
        assert_eq!(bits(&together), bits(&single), "{found:?} {rules:?} {asked:?} {sweep:?}");
        reasons.extend(single.by.map(|by| format!("{by:?}")));
    }
    assert!(reasons.len() > 3 * MAX_AXES, "{reasons:?}");
}
