//! A linear servo from set-point to set-point.

use post_machine::servo::{Servo, StateSpace};

use super::Output;
use super::discrete::{Discrete, add, columns, dot, padded, play};

/// The exact solution over one period, and where it stands. N states, those that are not needed zero: arrays of one length
/// without a test in the loop are what a compiler makes vector instructions of.
#[derive(Clone, Debug)]
pub(super) struct Linear<const N: usize> {
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
    /// States at rest at the command 1.
    rest: [f64; N],
    /// Half of the play behind the loops, axis units.
    half_play: f64,
    states: [f64; N],
    commanded: f64,
    last_change: f64,
    /// Where the table is within its play.
    table: f64,
}

impl<const N: usize> Linear<N> {
    pub(super) fn new(
        servo: &Servo,
        space: &StateSpace,
        period: f64,
        output: Output,
    ) -> Option<Self> {
        let solved = Discrete::new(&space.a, &space.value, &space.rate, &space.push, period)?;
        // A kink of the command by v makes the states jump by jump·v at the beginning of the period.
        let kink = &solved.transition * &space.jump / period;
        let row = match output {
            Output::Table => &space.position,
            Output::Measured => &space.measured,
        };
        Some(Self {
            transition: columns(&solved.transition),
            value: padded(solved.value.iter().copied()),
            change: padded((&solved.change + &kink).iter().copied()),
            earlier: padded(kink.iter().map(|part| -part)),
            position: padded(row.iter().copied()),
            through: space.through,
            rest: padded(space.rest().iter().flatten().copied()),
            half_play: match output {
                Output::Table => servo.backlash * servo.unit() / 2.0,
                Output::Measured => 0.0,
            },
            states: [0.0; N],
            commanded: 0.0,
            last_change: 0.0,
            table: 0.0,
        })
    }

    pub(super) fn settle(&mut self, value: f64) {
        self.states = self.rest.map(|part| part * value);
        self.commanded = value;
        self.last_change = 0.0;
        self.table = value;
    }

    pub(super) fn states(&self) -> &[f64] {
        &self.states
    }

    pub(super) fn run(
        &mut self,
        count: usize,
        command: impl Fn(usize) -> f64,
        mut put: impl FnMut(usize, f64),
    ) {
        let mut states = self.states;
        let (mut commanded, mut last_change) = (self.commanded, self.last_change);
        let mut table = self.table;
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
        self.states = states;
        (self.commanded, self.last_change) = (commanded, last_change);
        self.table = table;
    }
}
