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

    #[inline(always)]
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

#[cfg(test)]
mod tests {
    use post_machine::kinematics::batch::widely;
    use post_testkit::{Rng, randomised};

    use super::*;

    fn random<const N: usize>(rng: &mut Rng) -> LinearServo<N> {
        let half_play = if rng.pick(2) == 0 { 0.0 } else { 0.01 };
        let mut row = || std::array::from_fn(|_| rng.range(-0.3, 0.3));
        LinearServo {
            transition: std::array::from_fn(|_| row()),
            value: row(),
            change: row(),
            earlier: row(),
            position: row(),
            through: 0.25,
            half_play,
            stand: ServoState {
                rest: [0.0; N],
                states: [0.0; N],
                commanded: 0.0,
                last_change: 0.0,
                table: 0.0,
            },
        }
    }

    fn the_same_bits<const N: usize>(rng: &mut Rng) {
        let mut wide = random::<N>(rng);
        let mut plain = wide.clone();
        for _ in 0..3 {
            let commands: Vec<f64> = (0..rng.pick(20)).map(|_| rng.range(-100.0, 100.0)).collect();
            let [mut one, mut other] = [const { Vec::new() }; 2];
            let command = |index: usize| commands[index];
            widely(
                #[inline(always)]
                || wide.run(commands.len(), command, |_, value| one.push(value.to_bits())),
            );
            plain.run(commands.len(), command, |_, value| other.push(value.to_bits()));
            assert_eq!(one, other);
            assert_eq!(bits(wide.states()), bits(plain.states()));
        }
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|value| value.to_bits()).collect()
    }

    /// Wide vectors change no bit of where an axis is.
    #[test]
    fn an_axis_is_followed_with_the_same_bits_in_wide_vectors() {
        let (rounds, mut rng) = randomised(200u64, 31);
        for _ in rounds {
            the_same_bits::<4>(&mut rng);
            the_same_bits::<8>(&mut rng);
            the_same_bits::<12>(&mut rng);
        }
    }
}
