//! Servos: where the axes are while they follow their set-points.
//!
//! [`Servos`] does it for a machine, [`Follower`] for one axis. The equations are those of [`post_machine::servo`].
//! They are solved exactly from set-point to set-point, by the matrix exponential, with the commanded position linear
//! between set-points (a first-order hold): the answer is that of the differential equations, whatever the period. The
//! velocity of the command jumps at a set-point, and with the acceleration fed forward the current (or the speed, where
//! the torque follows its command at once) jumps with it; that is what the equations say of such a command.
//!
//! Dry friction, and play inside the loops, are not linear. With them a period is gone through in equal steps of at
//! most
//! 0.1 ms, and of at most 0.2 radians of the swing of the table on its transmission; within a step the equations are
//! solved exactly, with the friction's force constant (that of the velocity at the step's end, or what stops the table
//! there) and the flanks touching or not as at its beginning. Errors are in proportion to the step.
//!
//! [`post_machine::servo::FrequencyResponse`] answers in the frequency domain, [`fit`] adjusts numbers of a servo to a measured
//! log.

mod discrete;
pub mod fit;
mod linear;
mod stepped;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::kinematics::Joints;
use post_machine::kinematics::batch::widely;
use post_machine::servo::{MAX_ORDER, Servo, StateSpace};

use linear::LinearServo;
use stepped::SteppedServo;

/// The longest period of set-points, s.
const LONGEST_PERIOD: f64 = 1.0;

/// The servos of a machine.
#[derive(Clone, Debug)]
pub struct Servos {
    /// Followers by their axes' places in the chain; an axis without one is followed exactly.
    followers: Vec<(usize, Follower)>,
}

impl Servos {
    /// Servos of `machine`, for set-points every `period` seconds. They stand at zero: [`Servos::settle`] puts them
    /// elsewhere.
    ///
    /// # Errors
    /// A period that is not above zero, or longer than a second.
    pub fn new(machine: &Machine, period: f64) -> Result<Self, Box<Diagnostic>> {
        let mut followers = Vec::new();
        for (place, axis) in machine.axes.iter().enumerate() {
            if let Some(servo) = &axis.servo {
                followers.push((place, Follower::new(servo, period)?));
            }
        }
        Ok(Self { followers })
    }

    /// Places of the axes that have a servo; the others are where they are commanded.
    pub fn places(&self) -> impl Iterator<Item = usize> + '_ {
        self.followers.iter().map(|(place, _)| *place)
    }

    /// The axes have stood still at `joints` for long, up to one period before the next set-point.
    pub fn settle(&mut self, joints: &Joints) {
        for (place, follower) in &mut self.followers {
            follower.settle(joints[*place]);
        }
    }

    /// Where the axes are at the times of the set-points `commanded`, which follow those of the last call: one of
    /// `actual` each, in place of what it held. Axis values in mm and radians; those of a rotary axis go on over full
    /// turns. The commanded values are taken as linear from one set-point to the next.
    pub fn follow(&mut self, commanded: &[Joints], actual: &mut Vec<Joints>) {
        actual.clear();
        actual.extend_from_slice(commanded);
        for (place, follower) in &mut self.followers {
            let place = *place;
            follower.run(
                commanded.len(),
                |index| commanded[index][place],
                |index, value| actual[index][place] = value,
            );
        }
    }
}

/// The servo of one axis.
#[derive(Clone, Debug)]
pub struct Follower {
    kernel: FollowerKernel,
}

/// States are padded to a whole number of vector registers; the shortest that hold them are taken.
#[derive(Clone, Debug)]
enum FollowerKernel {
    Four(Box<LinearServo<4>>),
    Eight(Box<LinearServo<8>>),
    Twelve(Box<LinearServo<MAX_ORDER>>),
    SteppedEight(Box<SteppedServo<8>>),
}

/// What is asked of a [`Follower`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoOutput {
    /// Where the table is.
    Table,
    /// What the position loop measures: a log of the control has this.
    Measured,
}

impl Follower {
    /// Where the table is, for set-points every `period` seconds.
    ///
    /// # Errors
    /// A period that is not above zero, or longer than a second; numbers whose equations cannot be solved (a machine
    /// file with such is refused).
    pub fn new(servo: &Servo, period: f64) -> Result<Self, Box<Diagnostic>> {
        Self::with(servo, period, ServoOutput::Table)
    }

    /// Likewise, what `output` says.
    ///
    /// # Errors
    /// As [`Follower::new`].
    pub fn with(servo: &Servo, period: f64, output: ServoOutput) -> Result<Self, Box<Diagnostic>> {
        if !(period > 0.0 && period <= LONGEST_PERIOD) {
            let message = format!(
                "a period of set-points of {} s: above zero and up to {LONGEST_PERIOD} s are possible",
                Short(period)
            );
            return Err(Diagnostic::error("period", message).at(servo.place.clone()).boxed());
        }
        let space = StateSpace::of(servo);
        let friction = servo.friction.is_some_and(|friction| friction.coulomb > 0.0);
        let play_inside = servo.backlash > 0.0 && servo.play_inside();
        let kernel = if friction || play_inside {
            SteppedServo::new(servo, &space, period, output)
                .map(Box::new)
                .map(FollowerKernel::SteppedEight)
        } else {
            match space.order() {
                0..=4 => LinearServo::new(servo, &space, period, output)
                    .map(Box::new)
                    .map(FollowerKernel::Four),
                5..=8 => LinearServo::new(servo, &space, period, output)
                    .map(Box::new)
                    .map(FollowerKernel::Eight),
                _ => LinearServo::new(servo, &space, period, output)
                    .map(Box::new)
                    .map(FollowerKernel::Twelve),
            }
        };
        let Some(kernel) = kernel else {
            let message = "the equations of this servo are out of all proportion";
            return Err(Diagnostic::error("servo", message)
                .at(servo.place.clone())
                .help("are its numbers in the units of the machine file?")
                .boxed());
        };
        let mut follower = Self { kernel };
        follower.settle(0.0);
        Ok(follower)
    }

    /// The axis has stood still at `value` (mm or radians) for long, up to one period before the next set-point.
    pub fn settle(&mut self, value: f64) {
        match &mut self.kernel {
            FollowerKernel::Four(kernel) => kernel.settle(value),
            FollowerKernel::Eight(kernel) => kernel.settle(value),
            FollowerKernel::Twelve(kernel) => kernel.settle(value),
            FollowerKernel::SteppedEight(kernel) => kernel.settle(value),
        }
    }

    /// Where the axis is when the set-point `commanded` is reached, one period after the last, mm or radians.
    pub fn next(&mut self, commanded: f64) -> f64 {
        let mut actual = commanded;
        self.run(1, |_| commanded, |_, value| actual = value);
        actual
    }

    /// Follows `count` set-points, given by `command` and handed to `put` by their numbers.
    pub fn run(
        &mut self,
        count: usize,
        command: impl Fn(usize) -> f64,
        put: impl FnMut(usize, f64),
    ) {
        widely(
            #[inline(always)]
            || match &mut self.kernel {
                FollowerKernel::Four(kernel) => kernel.run(count, command, put),
                FollowerKernel::Eight(kernel) => kernel.run(count, command, put),
                FollowerKernel::Twelve(kernel) => kernel.run(count, command, put),
                FollowerKernel::SteppedEight(kernel) => kernel.run(count, command, put),
            },
        );
    }

    /// The states, as [`StateSpace`] has them, at the last set-point, before the kink of the command there has its
    /// effect; those beyond its order are zero.
    pub fn states(&self) -> [f64; MAX_ORDER] {
        let mut states = [0.0; MAX_ORDER];
        let held: &[f64] = match &self.kernel {
            FollowerKernel::Four(kernel) => kernel.states(),
            FollowerKernel::Eight(kernel) => kernel.states(),
            FollowerKernel::Twelve(kernel) => kernel.states(),
            FollowerKernel::SteppedEight(kernel) => kernel.states(),
        };
        states[..held.len()].copy_from_slice(held);
        states
    }
}
