//! A servo with dry friction, or with play inside its loops.
//!
//! A period is gone through in equal steps of at most [`LONGEST_STEP`] and at most [`STEP_SHARE`] over the angular
//! frequency of the table on its transmission. Within a step the equations are solved exactly, with these two taken as
//! constant:
//!
//! - **Friction.** Its force over a step is the one that belongs to the velocity at the step's end. That equation has
//!   one solution, in closed form, however steep the friction is, so that no step is too long to be stable; where the
//!   force that would stop the table within the step is less than the friction can be, the table sticks.
//! - **Play.** Whether the flanks touch, and which, is what holds at the beginning of the step. Touching, the
//!   transmission is the linear one with a constant force that takes half the play off; else it hands no force on.
//!
//! Both are right in the limit of short steps, with errors in proportion to the step.

use post_machine::servo::{Servo, ServoModel, StateSpace};

use super::ServoOutput;
use super::discrete::{DiscreteSolution, ServoState, add, columns, dot, padded, play};

/// Longest step, s.
const LONGEST_STEP: f64 = 1e-4;

/// Largest step, in radians of the swing of the table on its transmission.
const STEP_SHARE: f64 = 0.2;

/// One step of the linear equations.
#[derive(Clone, Debug)]
struct ServoStep<const N: usize> {
    transition: [[f64; N]; N],
    value: [f64; N],
    change: [f64; N],
    /// How friction enters, N or N·m.
    push: [f64; N],
    /// How much slower the table is at the end for one N or N·m of friction, m/s or rad/s.
    slowing: f64,
}

/// A servo that is solved in short steps: where it stands, and how it goes on.
#[derive(Clone, Debug)]
pub(super) struct SteppedServo<const N: usize> {
    /// Step while the flanks touch, or without play.
    touching: ServoStep<N>,
    /// Step while the flanks do not touch.
    released: Option<BacklashStep<N>>,
    /// Steps in a period.
    count: u32,
    /// How a change of the change of the command over a period enters.
    kink: [f64; N],
    coulomb: f64,
    /// m/s or radians/s.
    width: f64,
    velocity: [f64; N],
    position: [f64; N],
    /// Half of the play behind the loops, axis units.
    half_play: f64,
    stand: ServoState<N>,
}

#[derive(Clone, Debug)]
struct BacklashStep<const N: usize> {
    step: ServoStep<N>,
    /// Row of how far the transmission is stretched, m or radians.
    stretch: [f64; N],
    /// Half of the play, m or radians.
    half: f64,
    /// How the force that half the play takes off enters into a step with touching flanks.
    offset: [f64; N],
}

impl<const N: usize> ServoStep<N> {
    fn new(space: &StateSpace, solved: &DiscreteSolution) -> Self {
        Self {
            transition: columns(&solved.transition),
            value: padded(solved.value.iter().copied()),
            change: padded(solved.change.iter().copied()),
            push: padded(solved.force.iter().copied()),
            slowing: -(&space.velocity * &solved.force)[0],
        }
    }

    #[inline(always)]
    fn free(&self, states: &[f64; N], commanded: f64, change: f64) -> [f64; N] {
        let mut sum = [0.0; N];
        add(&mut sum, &self.value, commanded);
        add(&mut sum, &self.change, change);
        for (column, state) in self.transition.iter().zip(states) {
            add(&mut sum, column, *state);
        }
        sum
    }
}

impl<const N: usize> SteppedServo<N> {
    pub(super) fn new(
        servo: &Servo,
        space: &StateSpace,
        period: f64,
        output: ServoOutput,
    ) -> Option<Self> {
        let swing = match &servo.model {
            ServoModel::Loops(loops) => loops.drive.mechanics().natural_frequency(),
            ServoModel::Transfer(_) | ServoModel::Pid(_) => None,
        };
        let longest = swing.map_or(LONGEST_STEP, |swing| LONGEST_STEP.min(STEP_SHARE / swing));
        // A period is a second at most, a swing 1e5 rad/s: this is a small number.
        let count = libm::ceil(period / longest * (1.0 - 1e-9)).max(1.0);
        let step = period / count;
        let solve = |a, force| DiscreteSolution::new(a, &space.value, &space.rate, force, step);
        let touching = solve(&space.a, &space.push)?;
        // In axis units; the equations have m or radians.
        let whole_play = servo.backlash * servo.unit();
        let length = if servo.rotary { 1.0 } else { 1e-3 };
        let inside = servo.play_inside() && whole_play > 0.0;
        let released = match space.released.as_ref().filter(|_| inside) {
            None => None,
            Some(released) => {
                let half = whole_play / 2.0 * length;
                let pulled = solve(&space.a, &released.force)?.force * (released.stiffness * half);
                Some(BacklashStep {
                    step: ServoStep::new(space, &solve(&released.a, &space.push)?),
                    stretch: padded(released.stretch.iter().copied()),
                    half,
                    offset: padded(pulled.iter().copied()),
                })
            }
        };
        let row = match output {
            ServoOutput::Table => &space.position,
            ServoOutput::Measured => &space.measured,
        };
        let outside = output == ServoOutput::Table && !servo.play_inside();
        let friction = servo.friction;
        Some(Self {
            touching: ServoStep::new(space, &touching),
            released,
            count: count as u32,
            kink: padded(space.jump.iter().map(|part| part / period)),
            coulomb: friction.map_or(0.0, |friction| friction.coulomb),
            width: friction.map_or(0.0, |friction| friction.width * servo.unit() * length),
            velocity: padded(space.velocity.iter().copied()),
            position: padded(row.iter().copied()),
            half_play: if outside { whole_play / 2.0 } else { 0.0 },
            stand: ServoState::new(space),
        })
    }

    pub(super) fn settle(&mut self, value: f64) {
        self.stand.settle(value);
    }

    pub(super) fn states(&self) -> &[f64] {
        &self.stand.states
    }

    #[inline(always)]
    pub(super) fn run(
        &mut self,
        count: usize,
        command: impl Fn(usize) -> f64,
        mut put: impl FnMut(usize, f64),
    ) {
        for index in 0..count {
            let next = command(index);
            let change = next - self.stand.commanded;
            add(&mut self.stand.states, &self.kink, change - self.stand.last_change);
            let part = change / f64::from(self.count);
            for step in 0..self.count {
                self.step(self.stand.commanded + part * f64::from(step), part);
            }
            self.stand.commanded = next;
            self.stand.last_change = change;
            let motor = dot(&self.position, &self.stand.states);
            self.stand.table = play(self.stand.table, motor, self.half_play);
            put(index, self.stand.table);
        }
    }

    #[inline(always)]
    fn step(&mut self, commanded: f64, change: f64) {
        let (step, offset) = match &self.released {
            None => (&self.touching, None),
            Some(play) => {
                let stretch = dot(&play.stretch, &self.stand.states);
                if libm::fabs(stretch) < play.half {
                    (&play.step, None)
                } else {
                    (&self.touching, Some((&play.offset, stretch)))
                }
            }
        };
        let mut free = step.free(&self.stand.states, commanded, change);
        if let Some((offset, stretch)) = offset {
            add(&mut free, offset, -libm::copysign(1.0, stretch));
        }
        if self.coulomb > 0.0 {
            let velocity = dot(&self.velocity, &free);
            let force = self.coulomb * velocity / (self.width + self.coulomb * step.slowing);
            let force = force.clamp(-self.coulomb, self.coulomb);
            add(&mut free, &step.push, force);
        }
        self.stand.states = free;
    }
}
