//! The contour error limit of `post-feed`, held against servos that are simulated along its plans.
//!
//! The limit is a formula of the steady state. What is asserted here is how far the simulation may stray from it; what it
//! really strays by is printed.

mod five_axes;
mod paper;

use nalgebra::Vector3;
use post_feed::limits::{ContourError, Limit};
use post_feed::response::{ComplexGain, DriveResponse};
use post_feed::{EndSpeeds, Problem, Samples, profile, reach};
use post_machine::servo::{self, Pid, Servo, ServoModel, Transfer};
use post_motion::servo::Follower;

/// A path in the axes: their values, and where the tip is in the part frame.
trait Path {
    /// Values of the axes and their first three derivatives by the parameter.
    fn axes(&self, parameter: f64) -> Vec<[f64; 4]>;

    /// Where the tip stands, mm.
    fn tip(&self, axes: &[f64]) -> Vector3<f64>;

    /// How it goes with each axis.
    fn rates(&self, axes: &[f64]) -> Vec<[f64; 3]> {
        let step = 1e-4;
        let rate = |axis: usize| {
            let at = |sign: f64| {
                let mut moved = axes.to_vec();
                moved[axis] += sign * step;
                self.tip(&moved)
            };
            ((at(1.0) - at(-1.0)) / (2.0 * step)).into()
        };
        (0..axes.len()).map(rate).collect()
    }

    fn place(&self, parameter: f64) -> Vector3<f64> {
        let values: Vec<f64> = self.axes(parameter).iter().map(|axis| axis[0]).collect();
        self.tip(&values)
    }
}

/// The path at these parameters as limits see it. The tip's derivatives are differences of fourth order.
fn samples(path: &dyn Path, parameters: &[f64], step: f64) -> Samples {
    let mut samples = Samples::default();
    for &parameter in parameters {
        let at = |steps: f64| path.place(parameter + steps * step);
        let (near, far) = (at(1.0) - at(-1.0), at(2.0) - at(-2.0));
        let first = (near * 8.0 - far) / (12.0 * step);
        let both = (at(1.0) + at(-1.0)) * 16.0 - (at(2.0) + at(-2.0)) - at(0.0) * 30.0;
        let second = both / (12.0 * step * step);
        let axes = path.axes(parameter);
        let values: Vec<f64> = axes.iter().map(|axis| axis[0]).collect();
        let derivatives: Vec<[f64; 3]> = axes.iter().map(|all| [all[1], all[2], all[3]]).collect();
        samples.push(parameter, [first.into(), second.into(), [0.0; 3]], &derivatives);
        samples.push_rates(&path.rates(&values));
    }
    samples
}

fn transfer(numerator: &[f64], denominator: &[f64]) -> Servo {
    let model = ServoModel::Transfer(Transfer {
        numerator: numerator.to_vec(),
        denominator: denominator.to_vec(),
    });
    plain(model)
}

/// X or Y of the feedrate paper's Table 1.
fn of_the_paper(x: bool) -> Servo {
    let pick = |a: f64, b: f64| if x { a } else { b };
    plain(ServoModel::Pid(Pid {
        kp: pick(10.0, 12.344),
        ki: pick(50.0, 61.718),
        kd: pick(0.3, 0.367),
        gain: pick(6.5723, 6.2274) * 0.4769 * 1.5915,
        inertia: pick(7.0028e-3, 8.1904e-3),
        damping: pick(0.023_569, 0.043_009),
    }))
}

fn plain(model: ServoModel) -> Servo {
    Servo { place: None, rotary: false, model, friction: None, backlash: 0.0 }
}

/// The limit for these servos.
fn limit(servos: &[Servo], tolerance: f64, highest: f64) -> ContourError {
    let responses: Vec<servo::FrequencyResponse> =
        servos.iter().map(servo::FrequencyResponse::new).collect();
    let answers: Vec<_> = responses
        .iter()
        .map(|response| {
            |frequency: f64| {
                let answer = response.at(frequency);
                ComplexGain { real: answer.re, imaginary: answer.im }
            }
        })
        .collect();
    let answers: Vec<&dyn DriveResponse> =
        answers.iter().map(|answer| answer as &dyn DriveResponse).collect();
    ContourError::new(&answers, tolerance, highest, Default::default())
}

fn planned(samples: &Samples, limits: &[&dyn Limit]) -> (Vec<f64>, f64) {
    let problem = Problem::new(samples, limits, EndSpeeds::default()).unwrap();
    let plan = reach::solve(&problem).unwrap();
    let seconds = profile::duration(&problem.steps, &plan);
    (plan, seconds)
}

/// What the servos leave between tip and path: parameter and contour error at each set-point, mm.
fn simulated(
    path: &dyn Path,
    samples: &Samples,
    plan: &[f64],
    servos: &[Servo],
    period: f64,
) -> Vec<(f64, f64)> {
    let mut followers: Vec<Follower> =
        servos.iter().map(|servo| Follower::new(servo, period).unwrap()).collect();
    let start = path.axes(samples.parameter[0]);
    for (follower, axis) in followers.iter_mut().zip(&start) {
        follower.settle(axis[0]);
    }
    let mut nearest = samples.parameter[0];
    let mut errors = Vec::new();
    let mut take = |parameter: f64| {
        let commanded = path.axes(parameter);
        let each = followers.iter_mut().zip(&commanded);
        let actual: Vec<f64> = each.map(|(follower, axis)| follower.next(axis[0])).collect();
        let tip = path.tip(&actual);
        // From the nearest point before to where it is commanded: a narrow turn has more than one foot.
        let starts = even(nearest, parameter, 2).into_iter();
        let feet = starts.map(|start| foot(path, &tip, start));
        let far = |at: &f64| (tip - path.place(*at)).norm();
        nearest = feet.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap();
        errors.push((nearest, (tip - path.place(nearest)).norm()));
    };
    let mut left = 0.0;
    for (interval, q) in plan.windows(2).enumerate() {
        let step = samples.step(interval);
        let (from, to) = (q[0].sqrt(), q[1].sqrt());
        let seconds = 2.0 * step / (from + to);
        let push = (to - from) / seconds;
        let mut time = left;
        while time <= seconds {
            take(samples.parameter[interval] + (from + 0.5 * push * time) * time);
            time += period;
        }
        left = time - seconds;
    }
    let end = *samples.parameter.last().unwrap();
    for _ in 0..(0.5 / period) as usize {
        take(end);
    }
    errors
}

/// The parameter of the nearest point of the path, near `start`: Newton's steps, halved until they come nearer.
fn foot(path: &dyn Path, tip: &Vector3<f64>, start: f64) -> f64 {
    let step = 1e-5;
    let far = |at: f64| (tip - path.place(at)).norm();
    let (mut nearest, mut least) = (start, far(start));
    for _ in 0..20 {
        let [before, here, after] = [-step, 0.0, step].map(|by| path.place(nearest + by));
        let along = (after - before) / (2.0 * step);
        let bend = (after + before - here * 2.0) / (step * step);
        let off = tip - here;
        let slope = (along.norm_squared() - off.dot(&bend)).max(0.2 * along.norm_squared());
        let mut by = off.dot(&along) / slope;
        while by.abs() > 1e-9 && far(nearest + by) > least {
            by *= 0.5;
        }
        if by.abs() <= 1e-9 {
            break;
        }
        nearest += by;
        least = far(nearest);
    }
    nearest
}

fn even(first: f64, last: f64, count: usize) -> Vec<f64> {
    let at = |index: usize| first + (last - first) * index as f64 / count as f64;
    (0..=count).map(at).collect()
}

/// How values are spread: the share below 1, the median, what 95 % and 99 % stay below, the largest.
fn spread(values: &mut [f64]) -> [f64; 5] {
    values.sort_by(f64::total_cmp);
    let below = values.partition_point(|value| *value <= 1.0) as f64 / values.len() as f64;
    let at = |share: f64| values[((values.len() - 1) as f64 * share) as usize];
    [below, at(0.5), at(0.95), at(0.99), at(1.0)]
}
