//! What a plan has to keep, as it is shown beside what it uses: the limits of the machine, of its servos and of the job.

use post_feed::response::{ComplexGain, DriveResponse};
use post_machine::description::Machine;
use post_machine::servo;

/// Points of the table of a servo's deviation.
const STEPS: usize = 4096;

/// What a feed is planned under, mm, rad and s; infinite where there is no limit.
pub struct PlanLimits {
    /// Of the tip against the part.
    pub feed: f64,
    /// By axis, in the order in which they are told.
    pub velocity: Vec<f64>,
    /// By axis, likewise.
    pub acceleration: Vec<f64>,
    /// By axis, likewise.
    pub jerk: Vec<f64>,
    /// Of the tip.
    pub tip_acceleration: f64,
    /// Of the tip.
    pub tip_jerk: f64,
    /// Of one interpolation period.
    pub chord_error: f64,
    /// From one set-point to the next.
    pub period: f64,
    /// By the formula of the steady state.
    pub contour_error: f64,
    /// Blocks in a second.
    pub block_rate: f64,
    /// What the servos do; none where an axis that leads the tip has none.
    pub servos: Option<ServoDeviation>,
}

impl PlanLimits {
    /// The limits of `machine` for its axes at the places `axes`. Feeds and blocks are those of the job: none. Where nothing
    /// is known of the servos there is no contour error either.
    pub fn new(machine: &Machine, axes: &[usize]) -> Self {
        let of = |limit: &dyn Fn(usize) -> f64| axes.iter().map(|place| limit(*place)).collect();
        let servos = ServoDeviation::new(machine, axes);
        let none = |limit: Option<f64>| limit.unwrap_or(f64::INFINITY);
        Self {
            feed: f64::INFINITY,
            velocity: of(&|place| machine.axes[place].max_feed / 60.0),
            acceleration: of(&|place| machine.axes[place].max_accel),
            jerk: of(&|place| machine.axes[place].max_jerk),
            tip_acceleration: machine.motion.tip_accel,
            tip_jerk: machine.motion.tip_jerk,
            chord_error: none(machine.plan.chord_error),
            period: machine.motion.period,
            contour_error: none(servos.as_ref().and(machine.plan.contour_error)),
            block_rate: f64::INFINITY,
            servos,
        }
    }

    /// Some jerk is limited.
    pub fn has_jerk(&self) -> bool {
        self.tip_jerk.is_finite() || self.jerk.iter().any(|jerk| jerk.is_finite())
    }
}

/// What the servos of the axes make of a path.
pub struct ServoDeviation {
    /// The formula goes up to here, rad/s.
    highest: f64,
    /// The answers of the axes at even steps of the frequency's logarithm up to the highest.
    answers: Vec<Vec<ComplexGain>>,
    /// By how much of its radius the path of straight axes strays from a circle, likewise.
    table: Vec<f64>,
}

/// The lowest frequency of the tables, as a share of the highest.
const LOWEST: f64 = 1e-6;

/// An axis without a servo is where it is commanded.
struct AxisResponse(Option<servo::FrequencyResponse>);

impl DriveResponse for AxisResponse {
    fn at(&self, frequency: f64) -> ComplexGain {
        let Some(servo) = &self.0 else {
            return ComplexGain::EXACT;
        };
        let value = servo.at(frequency);
        ComplexGain { real: value.re, imaginary: value.im }
    }
}

impl ServoDeviation {
    /// Of `axes`; none where no axis has a servo, or where, of straight axes alone, one has none.
    fn new(machine: &Machine, axes: &[usize]) -> Option<Self> {
        let servos = axes.iter().map(|place| {
            let servo = machine.axes[*place].servo.as_ref();
            AxisResponse(servo.map(|servo| servo::FrequencyResponse::new(servo)))
        });
        let servos: Vec<AxisResponse> = servos.collect();
        let turns = axes.iter().any(|place| machine.axes[*place].joint.rotary);
        let known = servos.iter().filter(|servo| servo.0.is_some()).count();
        if known == 0 || (!turns && known < servos.len()) {
            return None;
        }
        let highest = servos.iter().filter_map(|servo| servo.0.as_ref());
        let highest =
            highest.map(servo::FrequencyResponse::natural_frequency).fold(f64::INFINITY, f64::min);
        let ratio = libm::log(1.0 / LOWEST) / STEPS as f64;
        let at = |step: usize| highest * libm::exp(-ratio * (STEPS - step) as f64);
        let answers = servos.iter().map(|servo| {
            let each = (0..=STEPS).map(|step| servo.at(at(step)));
            each.collect::<Vec<ComplexGain>>()
        });
        let answers = answers.collect();
        let all: Vec<&dyn DriveResponse> = servos.iter().map(|servo| servo as _).collect();
        let deviation = |step: usize| post_feed::limits::deviation(&all, at(step));
        let table = (0..=STEPS).map(deviation).collect();
        Some(Self { highest, answers, table })
    }

    /// The step of the tables below a frequency, and how far it is to the next.
    fn place(&self, frequency: f64) -> Option<(usize, f64)> {
        let place = 1.0 + libm::log(frequency / self.highest) / libm::log(1.0 / LOWEST);
        let place = place * STEPS as f64;
        let below = (place > 0.0).then(|| (place as usize).min(STEPS - 1))?;
        Some((below, place - below as f64))
    }

    /// The contour error that the formula says of a feed (mm/s) on a path of a curvature (1/mm), mm: that of a circle
    /// that straight axes go along for ever (feedrate paper, eqs. 6, 7).
    pub fn on_a_circle(&self, feed: f64, curvature: f64) -> f64 {
        let curvature = curvature.max(1e-9);
        let frequency = feed * curvature;
        let deviation = match self.place(frequency) {
            Some((below, share)) => {
                self.table[below] + share * (self.table[below + 1] - self.table[below])
            }
            // Where frequencies go to 0 it falls with the frequency at least.
            None => self.table[0] * frequency / (self.highest * LOWEST),
        };
        deviation / curvature
    }

    /// The contour error of axes of any kind: how each moves the tip (mm a unit), its velocity and its acceleration; and
    /// how the tip goes. What each axis strays from where it was commanded, at the frequency with which the path of the
    /// axes bends, as far as it moves the tip across its path (`post_feed::limits::ContourError`).
    pub fn through_axes(&self, axes: &[([f64; 3], f64, f64)], along: [f64; 3]) -> f64 {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (mut speed, mut both) = (0.0, 0.0);
        for (rate, velocity, acceleration) in axes {
            let square = dot(*rate, *rate);
            speed += square * velocity * velocity;
            both += square * velocity * acceleration;
        }
        if speed <= 0.0 {
            return 0.0;
        }
        let bends = axes.iter().map(|(rate, velocity, acceleration)| {
            let rest = acceleration - velocity * both / speed;
            dot(*rate, *rate) * rest * rest
        });
        let frequency = libm::sqrt(bends.sum::<f64>() / speed).clamp(1e-9, self.highest);
        let (below, share) = self.place(frequency).unwrap_or((0, 0.0));
        let frequency = frequency.max(self.highest * LOWEST);
        let length = dot(along, along);
        let mut off = [0.0; 3];
        // A lag that all axes share leaves nothing across the path: that of the first is taken for it.
        let mut common = None;
        for ((rate, velocity, acceleration), answers) in axes.iter().zip(&self.answers) {
            let [a, b] = [answers[below], answers[below + 1]];
            let answer = ComplexGain {
                real: a.real + share * (b.real - a.real),
                imaginary: a.imaginary + share * (b.imaginary - a.imaginary),
            };
            let phase = answer.phase_from(*common.get_or_insert(answer));
            let gain = answer.gain();
            let (sine, cosine) = libm::sincos(-phase);
            let late = gain * sine / frequency;
            let short = (1.0 - gain * cosine) / (frequency * frequency);
            let error = short * acceleration - late * velocity;
            for (off, rate) in off.iter_mut().zip(rate) {
                *off += rate * error;
            }
        }
        let square = dot(off, off);
        let part = if length > 0.0 { dot(off, along) * dot(off, along) / length } else { 0.0 };
        libm::sqrt((square - part).max(0.0))
    }
}
