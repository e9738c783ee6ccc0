//! Profiles from one velocity to another over a length, as fast as the limits allow: trapezoid and double S.
//!
//! A *ramp* takes the velocity from one value to another, its acceleration zero at both ends: with a jerk limit `j` it
//! rises to at most `a`, holds, and falls (a constant `a` where `j` is infinite). For a change `Δ` it lasts
//! `T = Δ/a + a/j` where `Δ ≥ a²/j`, else `2·√(Δ/j)`, and as it is symmetric about its middle it covers `T·(v0 + v1)/2`
//! either way. A profile is a ramp up to a peak, a cruise there, and a ramp down: at most seven phases of constant
//! jerk.
//!
//! The unit of length is that of the caller, mm or any other.

/// Acceleration and jerk that a ramp may have; an infinite jerk makes it one of constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// Largest acceleration, above zero and finite.
    pub acceleration: f64,
    /// Largest jerk, above zero.
    pub jerk: f64,
}

/// A piece of a profile in which the jerk is constant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phase {
    /// Duration, s.
    pub seconds: f64,
    /// Velocity that it begins with, a second.
    pub velocity: f64,
    /// Acceleration that it begins with, a second squared.
    pub acceleration: f64,
    /// Jerk, a second cubed.
    pub jerk: f64,
}

impl Phase {
    /// The length covered after `t` seconds.
    #[inline]
    pub fn length(&self, t: f64) -> f64 {
        ((self.jerk / 6.0 * t + self.acceleration / 2.0) * t + self.velocity) * t
    }

    /// The velocity after `t` seconds.
    #[inline]
    pub fn velocity(&self, t: f64) -> f64 {
        (self.jerk / 2.0 * t + self.acceleration) * t + self.velocity
    }

    /// The acceleration after `t` seconds.
    #[inline]
    pub fn acceleration(&self, t: f64) -> f64 {
        self.jerk * t + self.acceleration
    }

    /// When its velocity, which only falls, has come down to `velocity`, s; at most `seconds`.
    pub fn time_of(&self, velocity: f64) -> f64 {
        if self.jerk == 0.0 {
            let seconds = (velocity - self.velocity) / self.acceleration;
            return seconds.clamp(0.0, self.seconds);
        }
        let [mut low, mut high] = [0.0, self.seconds];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match self.velocity(middle) > velocity {
                true => low = middle,
                false => high = middle,
            }
        }
        high
    }

    /// What is left of it after `t` seconds.
    pub fn after(&self, t: f64) -> Self {
        Self {
            seconds: (self.seconds - t).max(0.0),
            velocity: self.velocity(t).max(0.0),
            acceleration: self.acceleration(t),
            jerk: self.jerk,
        }
    }

    /// When it has covered `length`, s; at most `seconds`.
    pub fn time_at(&self, length: f64) -> f64 {
        let [mut low, mut high] = [0.0, self.seconds];
        if length <= 0.0 {
            return low;
        }
        if length >= self.length(high) {
            return high;
        }
        if self.jerk == 0.0 {
            // 2·l / (v + √(v² + 2·a·l)): no difference of like numbers, whatever the sign of a.
            let square = self.velocity * self.velocity + 2.0 * self.acceleration * length;
            return (2.0 * length / (self.velocity + square.max(0.0).sqrt())).min(high);
        }
        // Newton's steps, halving where one leads out.
        let mut t = high * (length / self.length(high));
        for _ in 0..100 {
            let off = self.length(t) - length;
            if off > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let next = t - off / self.velocity(t);
            let next = match next > low && next < high {
                true => next,
                false => 0.5 * (low + high),
            };
            if libm::fabs(next - t) <= 1e-15 * self.seconds {
                return next;
            }
            t = next;
        }
        t
    }
}

impl Ramp {
    /// How long a change of the velocity by `change` (either way) takes, s.
    pub fn seconds(&self, change: f64) -> f64 {
        let change = libm::fabs(change);
        if change >= self.whole() {
            change / self.acceleration + self.acceleration / self.jerk
        } else {
            2.0 * (change / self.jerk).sqrt()
        }
    }

    /// The change from which on the acceleration reaches its limit.
    fn whole(&self) -> f64 {
        self.acceleration * self.acceleration / self.jerk
    }

    /// The length that a ramp between two velocities covers.
    pub fn length(&self, from: f64, to: f64) -> f64 {
        0.5 * (from + to) * self.seconds(to - from)
    }

    /// The highest velocity that a ramp from `from` reaches within `length`; from which, therefore, it also comes down
    /// to `from` within it.
    pub fn reach(&self, from: f64, length: f64) -> f64 {
        let (a, j) = (self.acceleration, self.jerk);
        if j == f64::INFINITY {
            return (from * from + 2.0 * a * length).sqrt();
        }
        // Δ²/2a + Δ·(v/a + a/2j) + v·a/j - l = 0.
        let half = from + 0.5 * a * a / j;
        let rest = 2.0 * a * (length - from * a / j);
        if rest > 0.0 {
            let change = rest / (half + (half * half + rest).sqrt());
            if change >= self.whole() {
                return from + change;
            }
        }
        // The acceleration does not get as far: with x = √(Δ/j), j·x³ + 2·v·x = l, whose root is one.
        let p = 2.0 * from / (3.0 * j);
        let q = 0.5 * length / j;
        let u = libm::cbrt(q + (q * q + p * p * p).sqrt());
        if u <= 0.0 {
            return from;
        }
        let mut x = (u - p / u).max(0.0);
        for _ in 0..2 {
            let slope = 3.0 * j * x * x + 2.0 * from;
            if slope > 0.0 {
                x = (x - ((j * x * x + 2.0 * from) * x - length) / slope).max(0.0);
            }
        }
        from + j * x * x
    }

    /// How the length of a ramp from `from` to `to` grows with `to` above it.
    fn growth(&self, from: f64, to: f64) -> f64 {
        let change = to - from;
        let slope = match change >= self.whole() {
            true => 1.0 / self.acceleration,
            false => 1.0 / (change * self.jerk).sqrt(),
        };
        0.5 * self.seconds(change) + 0.5 * (from + to) * slope
    }

    /// Phases of the ramp, in order, without those of no duration.
    fn phases(&self, from: f64, to: f64, mut take: impl FnMut(Phase)) {
        let change = libm::fabs(to - from);
        if change == 0.0 {
            return;
        }
        let sense = if to > from { 1.0 } else { -1.0 };
        if self.jerk == f64::INFINITY {
            return take(Phase {
                seconds: change / self.acceleration,
                velocity: from,
                acceleration: sense * self.acceleration,
                jerk: 0.0,
            });
        }
        let (peak, held) = match change >= self.whole() {
            true => (self.acceleration, (change - self.whole()) / self.acceleration),
            false => ((change * self.jerk).sqrt(), 0.0),
        };
        let rise = peak / self.jerk;
        let step = sense * 0.5 * peak * rise;
        take(Phase { seconds: rise, velocity: from, acceleration: 0.0, jerk: sense * self.jerk });
        if held > 0.0 {
            take(Phase {
                seconds: held,
                velocity: from + step,
                acceleration: sense * peak,
                jerk: 0.0,
            });
        }
        take(Phase {
            seconds: rise,
            velocity: to - step,
            acceleration: sense * peak,
            jerk: -sense * self.jerk,
        });
    }
}

/// A ramp up, a cruise, a ramp down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityProfile {
    phases: [Phase; 7],
    /// How many of them there are up to the peak, of the cruise, and after it.
    counts: [u8; 3],
}

impl VelocityProfile {
    /// Profile over `length` between the velocities `ends`, never above `most` or the ends, with these ramps up and
    /// down.
    ///
    /// Where an end cannot be reached from the other at all within the length, it is by a constant acceleration that
    /// passes the limits: a look-ahead does not ask for that.
    pub fn new(length: f64, ends: [f64; 2], most: f64, up: Ramp, down: Ramp) -> Self {
        let [from, to] = ends;
        let mut profile = Self::default();
        let floor = from.max(to);
        let covered = |peak: f64| up.length(from, peak) + down.length(to, peak);
        if covered(floor) > length * (1.0 + 1e-9) && floor > 0.0 {
            let mean = 0.5 * (from + to);
            profile.add(
                1,
                Phase {
                    seconds: length / mean,
                    velocity: from,
                    acceleration: (to - from) * mean / length.max(f64::MIN_POSITIVE),
                    jerk: 0.0,
                },
            );
            return profile;
        }
        let peak = peak(length, ends, most.max(floor), up, down);
        up.phases(from, peak, |phase| profile.add(0, phase));
        let rest = length - covered(peak);
        if rest > 0.0 && peak > 0.0 {
            profile.add(
                1,
                Phase { seconds: rest / peak, velocity: peak, acceleration: 0.0, jerk: 0.0 },
            );
        }
        down.phases(peak, to, |phase| profile.add(2, phase));
        profile
    }

    fn add(&mut self, part: usize, phase: Phase) {
        let place: u8 = self.counts.iter().sum();
        self.phases[usize::from(place)] = phase;
        self.counts[part] += 1;
    }

    /// Phases in order.
    pub fn phases(&self) -> &[Phase] {
        let count: u8 = self.counts.iter().sum();
        &self.phases[..usize::from(count)]
    }

    /// How many phases stand in the ramp up, the cruise, and the ramp down.
    pub fn counts(&self) -> [usize; 3] {
        self.counts.map(usize::from)
    }

    /// How long it takes, s.
    pub fn seconds(&self) -> f64 {
        self.phases().iter().map(|phase| phase.seconds).sum()
    }

    /// Length covered, velocity and acceleration after `t` seconds.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let (mut covered, mut left) = (0.0, t.max(0.0));
        let mut last = [0.0; 3];
        for phase in self.phases() {
            let within = left.min(phase.seconds);
            last = [
                covered + phase.length(within),
                phase.velocity(within),
                phase.acceleration(within),
            ];
            if left <= phase.seconds {
                break;
            }
            left -= phase.seconds;
            covered = last[0];
        }
        last
    }
}

/// The highest velocity, up to `most`, from which and to which the ramps fit into `length`.
fn peak(length: f64, ends: [f64; 2], most: f64, up: Ramp, down: Ramp) -> f64 {
    let [from, to] = ends;
    let floor = from.max(to);
    let covered = |peak: f64| up.length(from, peak) + down.length(to, peak);
    if most.is_finite() && covered(most) <= length {
        return most;
    }
    if up.jerk == f64::INFINITY && down.jerk == f64::INFINITY {
        // v² - v0² = 2·a·s, twice.
        let [a, b] = [up.acceleration, down.acceleration];
        let square = (2.0 * a * b * length + b * from * from + a * to * to) / (a + b);
        return square.sqrt().clamp(floor, most);
    }
    let reach = up.reach(from, length).min(down.reach(to, length));
    let [mut low, mut high] = [floor, most.min(reach).max(floor)];
    let mut peak = high;
    for _ in 0..100 {
        let off = covered(peak) - length;
        if off > 0.0 {
            high = peak;
        } else {
            low = peak;
        }
        if high - low <= 1e-14 * high {
            break;
        }
        // A little beyond where Newton leads: from there the bracket closes from the other side.
        let beyond = libm::copysign(5e-15 * peak, off);
        let next = peak - off / (up.growth(from, peak) + down.growth(to, peak)) - beyond;
        peak = match next > low && next < high {
            true => next,
            false => 0.5 * (low + high),
        };
    }
    low
}
