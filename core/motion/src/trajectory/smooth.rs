//! Look-ahead with jerk limits.
//!
//! An acceleration that went to zero where each block ends would never get far in thousands of short ones: it is
//! planned over many. The envelope of the accelerations alone is found first. Its *knots* are where a bound of the
//! velocity is met: a corner, the beginning of a slower block, a standstill. From knot to knot it goes up at most once,
//! holds, and goes down: a *hill*, over which a double S is laid, whatever blocks it spans. A ramp up that begins as early
//! as it can, with no more than the least acceleration under it, stays below the envelope, which goes up with the largest
//! one; so does a ramp down that ends as late as it can. Where a hill is too short to get from one knot's velocity to the
//! other's, the higher one is lowered: backwards, then forwards. Where blocks are very unlike, the least acceleration and
//! jerk of them all are too little for most: such a hill is split where that makes it shorter in time.
//!
//! Knots closer together than an acceleration takes to rise (`a/j`, or `√(v/j)` where that is less) are worth little, as
//! what lies between could hardly be used: if their velocities are alike it is run through at the least of them.
//!
//! At a knot the acceleration is zero. A plan is carried out up to such a place; what was planned behind it, down to the
//! standstill at its end, is kept and carried out in its turn where a new plan, which sees more, cannot go on from there
//! (its knots lie elsewhere).

use super::block::{Part, Why};
use super::envelope::Envelope;
use super::profile::{Phase, Profile, Ramp};

/// Velocities this near to each other, as a share, are one.
const SAME: f64 = 1e-9;

/// Knots are brought to one velocity where its square is no less than this of the largest one's: a slow corner must not
/// hold up what is near it.
const ALIKE: f64 = 0.5;

/// Blocks are unlike from this ratio of their accelerations or jerks on.
const UNLIKE: f64 = 2.0;

/// A place of the envelope where a bound is met, and what follows on it.
#[derive(Clone, Copy, Debug)]
struct Knot {
    /// It stands in front of this block.
    place: usize,
    velocity: f64,
    /// Length, least acceleration and jerk, and the envelope's highest velocity, from here to the next one.
    length: f64,
    ramp: Ramp,
    top: f64,
    /// A corner or a standstill is the reason for it.
    corner: bool,
}

impl Default for Knot {
    fn default() -> Self {
        Self {
            place: 0,
            velocity: 0.0,
            length: 0.0,
            ramp: Ramp {
                acceleration: f64::INFINITY,
                jerk: f64::INFINITY,
            },
            top: 0.0,
            corner: false,
        }
    }
}

impl Knot {
    /// The hill from it to the next knot, which is passed at `velocity`.
    fn profile(&self, velocity: f64) -> Profile {
        let ends = [self.velocity, velocity];
        Profile::new(self.length, ends, self.top, self.ramp, self.ramp)
    }

    /// The next knot's velocity can be come to, up or down.
    fn covers(&self, velocity: f64) -> bool {
        self.ramp.length(self.velocity, velocity) <= self.length
    }
}

/// Constant jerk, however many blocks it spans.
#[derive(Clone, Copy, Debug)]
struct Step {
    phase: Phase,
    why: Why,
    /// The acceleration is zero where it ends: the plan can be left there.
    rests: bool,
    /// It ends in front of this block, where it does at a block's end.
    ends: Option<usize>,
}

/// What a plan works with.
#[derive(Debug, Default)]
pub(super) struct Work {
    knots: Vec<Knot>,
    steps: Vec<Step>,
    /// The rest of the last plan, from where the run has got to, places counted as they are now.
    kept: Vec<Step>,
    /// Largest velocities along the blocks, lowered between near knots.
    velocities: Vec<f64>,
}

/// How a plan is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    /// Near knots are brought to one velocity.
    Thinned,
    /// All knots stay.
    Plain,
    /// The same, and the run's velocity goes on whatever that asks for.
    Forced,
}

impl Work {
    /// A new run begins.
    pub fn forget(&mut self) {
        self.kept.clear();
    }

    /// Hands over the parts of the first `done` blocks, or of about as many: of all of them if these are all.
    pub fn settle(&mut self, ahead: &mut Envelope, done: usize, take: &mut dyn FnMut(Part)) {
        let all = done == ahead.blocks.len();
        loop {
            let planned = self.plan(ahead, Mode::Thinned)
                || self.plan(ahead, Mode::Plain)
                || self.kept.is_empty() && self.plan(ahead, Mode::Forced);
            let count = match (planned, all) {
                (true, true) => self.steps.len(),
                (true, false) => self.leave(ahead, done),
                // The old plan, to the next place where it can be left.
                (false, _) => {
                    std::mem::swap(&mut self.steps, &mut self.kept);
                    let moves = |step: &Step| step.rests && step.phase.seconds > 0.0;
                    let place = self.steps.iter().position(moves);
                    place.map_or(self.steps.len(), |place| place + 1)
                }
            };
            let gone = self.carry_out(ahead, count, take);
            self.kept.clear();
            let rest = self.steps.drain(..).skip(count).map(|step| Step {
                ends: step.ends.map(|place| place - gone),
                ..step
            });
            self.kept.extend(rest);
            if !all || ahead.blocks.is_empty() {
                return;
            }
        }
    }

    /// Plans all blocks; false where the run is too fast for what lies ahead, planned like that.
    fn plan(&mut self, ahead: &mut Envelope, mode: Mode) -> bool {
        self.velocities.clear();
        let own = ahead.blocks.iter().map(|block| block.velocity);
        self.velocities.extend(own);
        ahead.set_caps();
        ahead.raise();
        if mode == Mode::Thinned && self.thin(ahead) {
            ahead.raise();
        }
        self.find_knots(ahead);
        let count = self.knots.len();
        for place in (1..count - 1).rev() {
            let next = self.knots[place + 1].velocity;
            let knot = &mut self.knots[place];
            knot.velocity = knot.velocity.min(knot.ramp.reach(next, knot.length));
        }
        let [first, second] = [self.knots[0], self.knots[1]];
        let possible = first.ramp.reach(second.velocity, first.length);
        if mode != Mode::Forced && first.velocity > possible * (1.0 + SAME) {
            return false;
        }
        for place in 1..count {
            let last = self.knots[place - 1];
            let knot = &mut self.knots[place];
            knot.velocity = knot
                .velocity
                .min(last.ramp.reach(last.velocity, last.length));
        }
        self.lay_hills(ahead);
        true
    }

    /// The velocity in front of the block at `place` is at a bound, and not amid blocks that go at the same.
    fn is_knot(&self, ahead: &Envelope, place: usize) -> bool {
        let cap = ahead.caps[place];
        let met = ahead.squares[place] >= cap * cap * (1.0 - SAME);
        let level = |velocity: f64| velocity <= cap * (1.0 + SAME);
        met && !(level(self.velocities[place - 1]) && level(self.velocities[place]))
    }

    /// Brings knots that are closer than an acceleration takes to rise to the least of their velocities; true if any.
    fn thin(&mut self, ahead: &mut Envelope) -> bool {
        let count = ahead.blocks.len();
        let mut lowered = false;
        let mut place = 1;
        while place < count {
            if !self.is_knot(ahead, place) {
                place += 1;
                continue;
            }
            let begins = place;
            let block = &ahead.blocks[begins];
            let rise = block.acceleration / block.jerk;
            let mut left = rise.min((self.velocities[begins] / block.jerk).sqrt());
            let (mut last, mut least) = (begins, ahead.squares[begins]);
            let mut most = least;
            while place + 1 < count {
                let ends = [place, place + 1].map(|place| ahead.squares[place].sqrt());
                left -= 2.0 * ahead.blocks[place].length / (ends[0] + ends[1]);
                if left < 0.0 {
                    break;
                }
                place += 1;
                if self.is_knot(ahead, place) {
                    let square = ahead.squares[place];
                    most = most.max(square);
                    if least.min(square) < ALIKE * most {
                        break;
                    }
                    (last, least) = (place, least.min(square));
                }
            }
            if last > begins {
                lowered = true;
                let velocity = least.sqrt();
                for place in begins..=last {
                    ahead.caps[place] = ahead.caps[place].min(velocity);
                }
                for place in begins..last {
                    self.velocities[place] = self.velocities[place].min(velocity);
                }
            }
            place = last + 1;
        }
        lowered
    }

    fn find_knots(&mut self, ahead: &Envelope) {
        let count = ahead.blocks.len();
        self.knots.clear();
        for place in 0..=count {
            if place > 0 && place < count && !self.is_knot(ahead, place) {
                continue;
            }
            self.knots.push(Knot {
                place,
                velocity: ahead.squares[place].sqrt(),
                corner: ahead.at_corner(place),
                ..Knot::default()
            });
        }
        let knots = self.knots.len();
        for index in 0..knots - 1 {
            let next = self.knots[index + 1].place;
            self.knots[index] = self.up_to(ahead, self.knots[index], next);
        }
    }

    /// A knot with what follows on it up to the block at `next`.
    fn up_to(&self, ahead: &Envelope, knot: Knot, next: usize) -> Knot {
        let mut knot = Knot {
            place: knot.place,
            velocity: knot.velocity,
            corner: knot.corner,
            ..Knot::default()
        };
        for place in knot.place..next {
            let block = &ahead.blocks[place];
            let length = ahead.left(place);
            knot.length += length;
            knot.ramp.acceleration = knot.ramp.acceleration.min(block.acceleration);
            knot.ramp.jerk = knot.ramp.jerk.min(block.jerk);
            let mean = 0.5 * (ahead.squares[place] + ahead.squares[place + 1]);
            let peak = (mean + block.acceleration * length).sqrt();
            knot.top = knot.top.max(peak.min(self.velocities[place]));
        }
        knot
    }

    fn lay_hills(&mut self, ahead: &Envelope) {
        self.steps.clear();
        for index in 0..self.knots.len() - 1 {
            self.lay(ahead, self.knots[index], self.knots[index + 1]);
        }
    }

    /// One hill, or several where these are gone over sooner.
    fn lay(&mut self, ahead: &Envelope, knot: Knot, next: Knot) {
        let profile = knot.profile(next.velocity);
        if let Some((knot, middle)) = self.split(ahead, &knot, &next, profile.seconds()) {
            self.lay(ahead, knot, middle);
            return self.lay(ahead, middle, next);
        }
        let why = |corner: bool| match corner {
            true => Why::Corner,
            false => Why::Change,
        };
        let [up, cruise, _] = profile.counts();
        let phases = profile.phases();
        for (place, phase) in phases.iter().enumerate() {
            let reached = phase.velocity >= knot.top * (1.0 - 1e-6);
            let why = match place {
                _ if place < up => why(knot.corner),
                _ if place >= up + cruise => why(next.corner),
                _ if reached => Why::Velocity,
                _ => why(knot.corner || next.corner),
            };
            let last = place + 1 == phases.len();
            self.steps.push(Step {
                phase: *phase,
                why,
                rests: last || place + 1 == up || place + 1 == up + cruise,
                ends: last.then_some(next.place),
            });
        }
    }

    /// A hill in two where its blocks are least alike, if that takes less than `seconds`.
    fn split(
        &self,
        ahead: &Envelope,
        knot: &Knot,
        next: &Knot,
        seconds: f64,
    ) -> Option<(Knot, Knot)> {
        let unlike = |place: usize| {
            let [last, next] = [&ahead.blocks[place - 1], &ahead.blocks[place]];
            let ratio = |one: f64, other: f64| (one / other).max(other / one);
            ratio(last.acceleration, next.acceleration).max(ratio(last.jerk, next.jerk))
        };
        let places = (knot.place + 1..next.place).map(|place| (place, unlike(place)));
        let (place, unlike) = places.max_by(|one, other| one.1.total_cmp(&other.1))?;
        if unlike < UNLIKE {
            return None;
        }
        let first = self.up_to(ahead, *knot, place);
        let middle = Knot {
            place,
            velocity: ahead.squares[place].sqrt(),
            ..Knot::default()
        };
        let mut middle = self.up_to(ahead, middle, next.place);
        let reached = [
            first.ramp.reach(first.velocity, first.length),
            middle.ramp.reach(next.velocity, middle.length),
        ];
        middle.velocity = middle.velocity.min(reached[0]).min(reached[1]);
        let possible = first.covers(middle.velocity) && middle.covers(next.velocity);
        let both =
            || first.profile(middle.velocity).seconds() + middle.profile(next.velocity).seconds();
        (possible && both() < seconds * (1.0 - SAME)).then_some((first, middle))
    }

    /// How many steps are carried out where the control has seen enough of the first `done` blocks: to the last place in
    /// them where the plan can be left, else to the next.
    fn leave(&mut self, ahead: &Envelope, done: usize) -> usize {
        let wanted: f64 = (0..done).map(|place| ahead.left(place)).sum();
        let mut covered = 0.0;
        let mut best = 0;
        for place in 0..self.steps.len() {
            let step = self.steps[place];
            let phase = step.phase;
            let length = phase.length(phase.seconds);
            let level = phase.acceleration == 0.0 && phase.jerk == 0.0 && phase.velocity > 0.0;
            let ends = step.ends.unwrap_or(usize::MAX);
            if level && ends > done && covered + length > wanted {
                let seconds = (wanted - covered) / phase.velocity;
                if seconds > 0.0 && seconds < phase.seconds {
                    let part = |seconds: f64, ends: Option<usize>| Step {
                        phase: Phase { seconds, ..phase },
                        ends,
                        ..step
                    };
                    self.steps[place] = part(phase.seconds - seconds, step.ends);
                    self.steps.insert(place, part(seconds, Some(done)));
                    return place + 1;
                }
            }
            covered += length;
            if covered > wanted && best > 0 && ends > done {
                return best;
            }
            if step.rests && covered > 0.0 {
                best = place + 1;
                if covered >= wanted {
                    return best;
                }
            }
        }
        self.steps.len()
    }

    /// Hands over the first `count` steps block by block; how many blocks are behind.
    fn carry_out(
        &mut self,
        ahead: &mut Envelope,
        count: usize,
        take: &mut dyn FnMut(Part),
    ) -> usize {
        let (mut place, mut begun) = (0, ahead.begun);
        for index in 0..count {
            let hill = self.steps[index..].iter().find_map(|step| step.ends);
            let last = hill.unwrap_or(ahead.blocks.len()) - 1;
            let mut step = self.steps[index];
            loop {
                let block = &ahead.blocks[place];
                let left = block.length - begun;
                let covered = step.phase.length(step.phase.seconds);
                let within = place >= last || covered <= left;
                let seconds = match within {
                    true => step.phase.seconds,
                    false => step.phase.time_at(left),
                };
                if seconds > 0.0 {
                    take(Part {
                        block: ahead.first + place as u64,
                        from: begun,
                        phase: Phase {
                            seconds,
                            ..step.phase
                        },
                        why: step.why,
                    });
                }
                if within {
                    begun += covered;
                    break;
                }
                step.phase = step.phase.after(seconds);
                (place, begun) = (place + 1, 0.0);
            }
            ahead.velocity = step.phase.velocity(step.phase.seconds).max(0.0);
            if let Some(ends) = step.ends {
                (place, begun) = (ends, 0.0);
            }
        }
        ahead.begun = begun;
        ahead.first += place as u64;
        ahead.blocks.drain(..place);
        place
    }
}
