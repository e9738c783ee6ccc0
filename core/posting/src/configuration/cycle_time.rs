//! Estimate of how long the axes take: the measure of the rule `cycle-time`.
//!
//! A rapid goes from rest to rest, and as long as the axis takes that needs longest, with its feed, acceleration and jerk: the
//! closed form of a double S (Biagiotti, Melchiorri: Trajectory Planning for Automatic Machines and Robots, 2008, section
//! 3.4). Where axes turn and the control does not keep the tip, it goes in as many pieces as the tolerance of rapids makes of
//! it, and the machine stands still between them, unless `[motion]` says otherwise. A step of a cut takes what the program asks for, or what the slowest axis needs at its largest feed. Where the
//! velocity of an axis changes from step to step by more than its acceleration makes of the time of the shorter one, the
//! machine slows down there; a ramp from standstill to a velocity takes half its time longer than the same way at that
//! velocity, so half of what is lacking is added. That is the time of an axis that turns on the spot, exactly, and less than
//! the machine takes wherever several axes are limited in turn.

use post_machine::description::{Machine, Method, Placement, RapidRule, Tcp};
use post_machine::kinematics::{Chain, Joints, MAX_AXES};

/// What the drives of a machine can do.
#[derive(Clone, Debug)]
pub(crate) struct DriveLimits {
    /// Largest velocities, mm/s or rad/s.
    velocity: Joints,
    /// Largest accelerations, mm/s² or rad/s².
    acceleration: Joints,
    /// Largest jerks, mm/s³ or rad/s³.
    jerk: Joints,
    /// How far the tip may be off a straight rapid, mm; infinite where the machine does not stand still between its pieces.
    rapid_tolerance: f64,
    /// Points are put into the middle: as many pieces as a power of two.
    halves: bool,
    /// Time that the machine waits where it stands still, s.
    in_position: f64,
}

/// Most pieces of one rapid; more count as this many.
const MOST_PIECES: f64 = 1024.0;

impl DriveLimits {
    pub(crate) fn new(machine: &Machine) -> Self {
        let mut drives = Self {
            velocity: [f64::INFINITY; MAX_AXES],
            acceleration: [f64::INFINITY; MAX_AXES],
            jerk: [f64::INFINITY; MAX_AXES],
            rapid_tolerance: match (machine.control.tcp, machine.motion.rapids) {
                (Tcp::Post, RapidRule::Stop) => machine.accuracy.rapid_tolerance,
                _ => f64::INFINITY,
            },
            halves: machine.accuracy.method == Method::Linearise
                && machine.accuracy.placement == Placement::Bisect,
            in_position: machine.motion.in_position,
        };
        for (place, axis) in machine.axes.iter().enumerate() {
            drives.velocity[place] = axis.max_feed / 60.0;
            drives.acceleration[place] = axis.max_accel;
            drives.jerk[place] = axis.max_jerk;
        }
        drives
    }

    /// A rapid from one set of axis values to another, s.
    pub(crate) fn rapid(&self, chain: &Chain, from: &Joints, to: &Joints) -> f64 {
        let pieces = self.pieces(chain, from, to);
        pieces * (self.rest_to_rest(from, to, 1.0 / pieces, |_| true) + self.in_position)
    }

    /// A share of the way between two sets of axis values from rest to rest, of the axes alone that `counts`, s.
    pub(crate) fn rest_to_rest(
        &self,
        from: &Joints,
        to: &Joints,
        share: f64,
        counts: impl Fn(usize) -> bool,
    ) -> f64 {
        let axes = (0..MAX_AXES).filter(|place| counts(*place));
        axes.map(|place| {
            let limits = [self.velocity, self.acceleration, self.jerk].map(|limit| limit[place]);
            rest_to_rest(share * (to[place] - from[place]).abs(), limits)
        })
        .fold(0.0, f64::max)
    }

    /// As many pieces as keep the tip near enough to its straight line: how far it is off in the middle falls with the square
    /// of their length.
    fn pieces(&self, chain: &Chain, from: &Joints, to: &Joints) -> f64 {
        if self.rapid_tolerance.is_infinite() {
            return 1.0;
        }
        let middle: Joints = std::array::from_fn(|place| 0.5 * (from[place] + to[place]));
        let [from, middle, to] = [from, &middle, to].map(|joints| chain.forward(joints).tip);
        let times = (middle - 0.5 * (from + to)).norm() / self.rapid_tolerance;
        let pieces = libm::ceil(libm::sqrt(times).min(MOST_PIECES)).max(1.0);
        match self.halves {
            true => libm::exp2(libm::ceil(libm::log2(pieces))),
            false => pieces,
        }
    }

    /// A step of a cut that the program asks `asked` seconds for: how long it takes if nothing has to be accelerated, s.
    #[inline]
    pub(crate) fn step(&self, from: &Joints, to: &Joints, asked: f64) -> f64 {
        let mut seconds = asked;
        for place in 0..MAX_AXES {
            seconds = seconds.max((to[place] - from[place]).abs() / self.velocity[place]);
        }
        seconds
    }

    /// What is lost where one step passes into the next, s: `ways` are those of the axes, `seconds` what [`DriveLimits::step`] gives.
    #[inline]
    pub(crate) fn ramp(&self, ways: [&Joints; 2], seconds: [f64; 2]) -> f64 {
        let velocity = |step: usize, place: usize| match seconds[step] > 0.0 {
            true => ways[step][place] / seconds[step],
            false => 0.0,
        };
        let mut needed = 0.0f64;
        for place in 0..MAX_AXES {
            let change = (velocity(1, place) - velocity(0, place)).abs();
            needed = needed.max(change / self.acceleration[place]);
        }
        0.5 * (needed - seconds[0].min(seconds[1])).max(0.0)
    }
}

/// Time of a double S over `way` with these largest velocity, acceleration and jerk.
fn rest_to_rest(way: f64, [velocity, acceleration, jerk]: [f64; 3]) -> f64 {
    if way == 0.0 {
        return 0.0;
    }
    if acceleration.is_infinite() && jerk.is_infinite() {
        return way / velocity;
    }
    // Times over which the jerk is applied, and over which there is any acceleration, while the velocity is reached.
    let ramp = |velocity: f64| match velocity * jerk < acceleration * acceleration {
        true => 2.0 * libm::sqrt(velocity / jerk),
        false => velocity / acceleration + acceleration / jerk,
    };
    if velocity.is_finite() && way >= velocity * ramp(velocity) {
        return way / velocity + ramp(velocity);
    }
    // The largest velocity is not reached; the acceleration is, if the way is as long as two ramps at its velocity.
    let rise = acceleration / jerk;
    if way >= 2.0 * acceleration * rise * rise {
        rise + libm::sqrt(rise * rise + 4.0 * way / acceleration)
    } else {
        libm::cbrt(32.0 * way / jerk)
    }
}

/// Adds the time of a path up, step by step.
#[derive(Clone, Debug)]
pub(crate) struct PathClock<'a> {
    drives: &'a DriveLimits,
    /// Where the axes stand.
    at: Joints,
    /// The last step: ways of the axes, and how long it took; none if it is not known.
    last: Option<(Joints, f64)>,
    /// Time so far.
    pub(crate) seconds: f64,
}

/// A standstill beside a step; it lasts no time in which something could be accelerated.
const AT_REST: (Joints, f64) = ([0.0; MAX_AXES], 0.0);

impl<'a> PathClock<'a> {
    /// Begins at `at`; how the axes came there is not known.
    pub(crate) fn new(drives: &'a DriveLimits, at: Joints) -> Self {
        Self { drives, at, last: None, seconds: 0.0 }
    }

    /// The machine comes to rest.
    pub(crate) fn rests(&mut self) {
        if let Some((ways, seconds)) = &self.last {
            self.seconds += self.drives.ramp([ways, &AT_REST.0], [*seconds, AT_REST.1]);
        }
        self.last = Some(AT_REST);
    }

    /// A step of a cut.
    pub(crate) fn cuts(&mut self, to: &Joints, asked: f64) {
        let seconds = self.drives.step(&self.at, to, asked);
        let ways: Joints = std::array::from_fn(|place| to[place] - self.at[place]);
        if let Some((before, last)) = &self.last {
            self.seconds += self.drives.ramp([before, &ways], [*last, seconds]);
        }
        self.seconds += seconds;
        self.at = *to;
        // Where nothing moves, and no time is asked for, there is no block.
        if seconds > 0.0 {
            self.last = Some((ways, seconds));
        }
    }

    /// A rapid, from rest to rest.
    pub(crate) fn rapid(&mut self, chain: &Chain, to: &Joints) {
        self.rests();
        self.seconds += self.drives.rapid(chain, &self.at, to);
        self.at = *to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: f64 = 1e-6;

    /// The least time over a way from rest to rest, by steps of time: half of it is sped up with the jerk, as far as the
    /// acceleration and the velocity go, and slowed down the same way.
    fn stepped(way: f64, limits: [f64; 3]) -> f64 {
        // Way and time until a velocity is reached.
        let ramp = |top: f64| {
            let [_, most, jerk] = limits;
            let (mut velocity, mut acceleration, mut passed, mut time) = (0.0, 0.0f64, 0.0, 0.0);
            while velocity < top {
                // As soon as the acceleration's own way down to zero would lead to the top, it goes down.
                let falls = velocity + 0.5 * acceleration * acceleration / jerk >= top;
                let change = if falls { -jerk } else { jerk };
                let next = (acceleration + change * FINE).min(most);
                if next <= 0.0 {
                    break;
                }
                velocity += 0.5 * (acceleration + next) * FINE;
                acceleration = next;
                passed += velocity * FINE;
                time += FINE;
            }
            (passed, time)
        };
        let (mut low, mut high) = (0.0, limits[0]);
        let (passed, time) = ramp(high);
        if 2.0 * passed <= way {
            return 2.0 * time + (way - 2.0 * passed) / high;
        }
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            match 2.0 * ramp(middle).0 <= way {
                true => low = middle,
                false => high = middle,
            }
        }
        2.0 * ramp(low).1
    }

    #[test]
    fn a_double_s_takes_as_long_as_when_it_is_gone_through_step_by_step() {
        // Velocity and acceleration reached, velocity alone, acceleration alone, neither.
        for (way, limits) in [
            (180.0, [150.0, 600.0, 12_000.0]),
            (20.0, [15.0, 600.0, 12_000.0]),
            (30.0, [150.0, 600.0, 12_000.0]),
            (1.0, [150.0, 600.0, 12_000.0]),
        ] {
            let (closed, steps) = (rest_to_rest(way, limits), stepped(way, limits));
            assert!(
                (closed - steps).abs() < 2e-3 * steps,
                "{way} {limits:?}: {closed} and {steps}"
            );
        }
    }

    /// Calculated by hand: without jerk limits `way / v + v / a`, or `2·√(way / a)` where the velocity is not reached.
    #[test]
    fn without_jerk_limits_it_is_a_trapezoid() {
        let limits = [150.0, 600.0, f64::INFINITY];
        assert!((rest_to_rest(180.0, limits) - (1.2 + 0.25)).abs() < 1e-12);
        assert!((rest_to_rest(20.0, limits) - 2.0 * libm::sqrt(20.0 / 600.0)).abs() < 1e-12);
        let endless = [f64::INFINITY, 600.0, f64::INFINITY];
        assert!((rest_to_rest(600.0, endless) - 2.0).abs() < 1e-12);
        assert_eq!(rest_to_rest(0.0, limits), 0.0);
        let free = f64::INFINITY;
        assert_eq!(rest_to_rest(60.0, [30.0, free, free]), 2.0);
        assert_eq!(rest_to_rest(60.0, [free; 3]), 0.0);
    }

    fn drives() -> DriveLimits {
        DriveLimits {
            velocity: [150.0; MAX_AXES],
            acceleration: [600.0; MAX_AXES],
            jerk: [f64::INFINITY; MAX_AXES],
            rapid_tolerance: f64::INFINITY,
            halves: false,
            in_position: 0.0,
        }
    }

    fn first(value: f64) -> Joints {
        let mut joints = [0.0; MAX_AXES];
        joints[0] = value;
        joints
    }

    /// A turn on the spot between two standstills takes as long as a rapid over it, in one step and in many.
    #[test]
    fn a_turn_on_the_spot_takes_the_time_from_rest_to_rest() {
        let drives = drives();
        let whole = rest_to_rest(180.0, [150.0, 600.0, f64::INFINITY]);
        for count in [1, 2, 10] {
            let mut clock = PathClock::new(&drives, first(0.0));
            clock.rests();
            for step in 1..=count {
                clock.cuts(&first(180.0 * f64::from(step) / f64::from(count)), 1e-3);
            }
            clock.rests();
            let steps = clock.seconds;
            assert!((steps - whole).abs() < 1e-12, "{count}: {steps}");
        }
    }

    /// What is slow enough for its accelerations takes what the program asks for.
    #[test]
    fn what_is_asked_for_is_what_it_takes_where_nothing_limits_it() {
        let drives = drives();
        let mut clock = PathClock::new(&drives, first(0.0));
        // 600 units a second squared, nowhere more than 500, and no faster than 50.
        for step in 1..=100 {
            let t = 0.1 * f64::from(step) / 100.0;
            clock.cuts(&first(250.0 * t * t), 1e-3);
        }
        assert!((clock.seconds - 0.1).abs() < 1e-12, "{}", clock.seconds);
    }
}
