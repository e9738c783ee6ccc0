//! A linear servo from set-point to set-point.

use post_machine::servo::{Servo, StateSpace};

use super::ServoOutput;
use super::discrete::{DiscreteSolution, ServoState, add, columns, dot, padded, play};

/// The exact solution over one period, and where it stands. N states, those that are not needed zero: arrays of one length
/// without a test in the loop are what a compiler makes vector instructions of.
#[derive(Clone, Debug)]
pub(super) struct LinearServo<const N: usize> {
    /// Column by column.
    transition: [[f64; N]; N],
    /// How the command at the beginning of the period enters.
    value: [f64; N],
    /// How its change over the period enters.
    change: [f64; N],
    /// How its change over the period before enters: that is left where the command has a kink.
    earlier: [f64; N],
    /// Row of the position.
    position: [f64; N],
    /// What of the command is in the position at once.
    through: f64,
    /// Half of the play behind the loops, axis units.
    half_play: f64,
    stand: ServoState<N>,
}

impl<const N: usize> LinearServo<N> {
    pub(super) fn new(
        servo: &Servo,
        space: &StateSpace,
        period: f64,
        output: ServoOutput,
    ) -> Option<Self> {
        let solved =
            DiscreteSolution::new(&space.a, &space.value, &space.rate, &space.push, period)?;
        // A kink of the command by v makes the states jump by jump·v at the beginning of the period.
        let kink = &solved.transition * &space.jump / period;
        let row = match output {
            ServoOutput::Table => &space.position,
            ServoOutput::Measured => &space.measured,
        };
        Some(Self {
            transition: columns(&solved.transition),
            value: padded(solved.value.iter().copied()),
            change: padded((&solved.change + &kink).iter().copied()),
            earlier: padded(kink.iter().map(|part| -part)),
            position: padded(row.iter().copied()),
            through: space.through,
            half_play: match output {
                ServoOutput::Table => servo.backlash * servo.unit() / 2.0,
                ServoOutput::Measured => 0.0,
            },
            stand: ServoState::new(space),
        })
    }

    pub(super) fn settle(&mut self, value: f64) {
        self.stand.settle(value);
    }

    pub(super) fn states(&self) -> &[f64] {
        &self.stand.states
    }

    pub(super) fn run(
        &mut self,
        count: usize,
        command: impl Fn(usize) -> f64,
        mut put: impl FnMut(usize, f64),
    ) {
        let mut states = self.stand.states;
        let (mut commanded, mut last_change) = (self.stand.commanded, self.stand.last_change);
        let mut table = self.stand.table;
        for index in 0..count {
            let next = command(index);
            let change = next - commanded;
            let mut sum = [0.0; N];
            add(&mut sum, &self.value, commanded);
            add(&mut sum, &self.change, change);
            add(&mut sum, &self.earlier, last_change);
            for (column, state) in self.transition.iter().zip(states) {
                add(&mut sum, column, state);
            }
            states = sum;
            (commanded, last_change) = (next, change);
            let motor = dot(&self.position, &states) + self.through * next;
            table = play(table, motor, self.half_play);
            put(index, table);
        }
        self.stand.states = states;
        (self.stand.commanded, self.stand.last_change) = (commanded, last_change);
        self.stand.table = table;
    }
}
