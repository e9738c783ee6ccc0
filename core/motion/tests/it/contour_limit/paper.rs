//! The feedrate paper's case set (Table 3: 50 mm/s, 200 mm/s² an axis, T = 4 ms, chord 0.5 µm, contour 20 µm) on the
//! butterfly and on a curve of a hundred control points of our own, with its servos (Table 1) simulated.

use std::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};
use post_feed::Samples;
use post_feed::limits::{
    AxisAcceleration, AxisVelocity, ChordError, Collocation, ContourError, Limit, TipFeed,
    deviation,
};
use post_feed::response::{ComplexGain, DriveResponse};
use post_machine::servo::{self, Servo};
use post_motion::path::BSpline;
use post_testkit::shared;

use super::{Path, even, limit, of_the_paper, planned, samples, simulated};

const TOLERANCE: f64 = 0.02;

/// A plane curve, its coordinates being X and Y.
struct Plane(BSpline<2>);

impl Path for Plane {
    fn axes(&self, parameter: f64) -> Vec<[f64; 4]> {
        let [value, one, two, three] = self.0.derivatives(parameter.clamp(0.0, 1.0));
        (0..2).map(|axis| [value[axis], one[axis], two[axis], three[axis]]).collect()
    }

    fn tip(&self, axes: &[f64]) -> Vector3<f64> {
        Vector3::new(axes[0], axes[1], 0.0)
    }
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    let all = value.as_array().unwrap().iter();
    all.map(|value| value.as_f64().unwrap()).collect()
}

/// As long as the first curve of the paper, 793 mm.
fn butterfly() -> Option<Plane> {
    let text = std::fs::read_to_string(shared("data/geometry/butterfly_nurbs.json")?).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    let points = value["control_points_mm"].as_array().unwrap().iter();
    let scale = 793.0 / 382.859_558;
    let points = points.map(|point| [0, 1].map(|axis| scale * numbers(point)[axis]));
    let poles = points.map(Vector2::from).zip(numbers(&value["weights"])).collect();
    Some(Plane(BSpline { degree: 3, knots: numbers(&value["knots"]), poles }))
}

/// A rosette of eleven lobes with narrow tips: a hundred control points, cubic.
fn rosette() -> Plane {
    let points: Vec<[f64; 2]> = even(0.0, TAU, 99)
        .into_iter()
        .map(|angle| {
            let radius = 62.0 + 17.0 * libm::cos(11.0 * angle) + 9.0 * libm::sin(3.0 * angle);
            [radius * libm::cos(angle), radius * libm::sin(angle)]
        })
        .collect();
    assert_eq!(points.len(), 100);
    let mut knots = vec![0.0; 3];
    knots.extend(even(0.0, 1.0, points.len() - 3));
    knots.extend([1.0; 3]);
    Plane(BSpline::unweighted(3, knots, points))
}

/// The largest contour error by the formula for all directions, µm.
fn by_formula(samples: &Samples, plan: &[f64], servos: &[Servo]) -> f64 {
    let responses: Vec<servo::FrequencyResponse> =
        servos.iter().map(servo::FrequencyResponse::new).collect();
    let answer = |response: &servo::FrequencyResponse, frequency: f64| {
        let answer = response.at(frequency);
        ComplexGain { real: answer.re, imaginary: answer.im }
    };
    let x = |frequency: f64| answer(&responses[0], frequency);
    let y = |frequency: f64| answer(&responses[1], frequency);
    let axes: [&dyn DriveResponse; 2] = [&x, &y];
    let each = plan.iter().enumerate().map(|(sample, q)| {
        let curvature = samples.curvature[sample].max(1e-9);
        deviation(&axes, q.sqrt() * samples.stretch(sample) * curvature) / curvature
    });
    1e3 * each.fold(0.0, f64::max)
}

/// What a plan comes to.
struct Outcome {
    seconds: f64,
    /// Largest contour error by the formula, and simulated, µm.
    formula: f64,
    simulated: f64,
    /// The largest simulated one beside each sample, mm.
    beside: Vec<f64>,
}

struct Case {
    path: Plane,
    samples: Samples,
    servos: Vec<Servo>,
    contour: ContourError,
}

impl Case {
    fn new(path: Plane, rates: bool) -> Self {
        let breaks: Vec<f64> = path.0.breaks().collect();
        let mut parameters = vec![breaks[0]];
        for pair in breaks.windows(2) {
            parameters.extend(&even(pair[0], pair[1], 60)[1..]);
        }
        let mut samples = samples(&path, &parameters, 1e-6);
        // Differences do not reach over the ends.
        for (sample, parameter) in parameters.iter().enumerate() {
            let [_, first, second, _] = path.0.derivatives(*parameter);
            samples.tip[0][sample] = [first[0], first[1], 0.0];
            samples.tip[1][sample] = [second[0], second[1], 0.0];
            samples.curvature[sample] =
                post_feed::samples::curvature(samples.tip[0][sample], samples.tip[1][sample]);
        }
        if !rates {
            samples.rates.clear();
        }
        let servos = vec![of_the_paper(true), of_the_paper(false)];
        Self { contour: limit(&servos, TOLERANCE, 49.8), path, samples, servos }
    }

    fn run(&self, with: bool) -> Outcome {
        let collocation = Collocation::default();
        let feed = TipFeed { most: 50.0, collocation };
        let velocity = AxisVelocity { limits: vec![50.0; 2], collocation };
        let acceleration = AxisAcceleration { limits: vec![200.0; 2], collocation };
        let chord = ChordError { tolerance: 0.0005, period: 0.004, collocation };
        let mut limits: Vec<&dyn Limit> = vec![&feed, &velocity, &acceleration, &chord];
        if with {
            limits.push(&self.contour);
        }
        let (plan, seconds) = planned(&self.samples, &limits);
        let errors = simulated(&self.path, &self.samples, &plan, &self.servos, 0.001);
        let mut beside = vec![0.0_f64; self.samples.len()];
        let mut largest: f64 = 0.0;
        for (parameter, error) in errors {
            let sample = self.samples.parameter.partition_point(|at| *at < parameter);
            let sample = sample.min(beside.len() - 1);
            beside[sample] = beside[sample].max(error);
            largest = largest.max(error);
        }
        Outcome {
            seconds,
            formula: by_formula(&self.samples, &plan, &self.servos),
            simulated: 1e3 * largest,
            beside,
        }
    }

    /// Tightens the limit where the simulation exceeds it, over `reach` mm to both sides.
    fn tighten(&mut self, outcome: &Outcome, reach: f64, margin: f64) {
        let count = self.samples.len();
        let mut way = vec![0.0; count];
        for sample in 1..count {
            let stretch = self.samples.stretch(sample - 1) + self.samples.stretch(sample);
            way[sample] = way[sample - 1] + 0.5 * stretch * self.samples.step(sample - 1);
        }
        let mut factors = vec![1.0_f64; count];
        for (sample, error) in outcome.beside.iter().enumerate() {
            if *error <= TOLERANCE {
                continue;
            }
            let factor = (1.0 - margin) * TOLERANCE / error;
            let first = way.partition_point(|at| *at < way[sample] - reach);
            let last = way.partition_point(|at| *at <= way[sample] + reach);
            for held in &mut factors[first..last] {
                *held = held.min(factor);
            }
        }
        self.samples.contour_share.resize(count, 1.0);
        for (share, factor) in self.samples.contour_share.iter_mut().zip(factors) {
            *share *= factor;
        }
    }
}

#[test]
fn without_the_limit_the_contour_error_peaks_above_it_and_with_it_the_formula_keeps_it() {
    let curves = [("butterfly", butterfly()), ("rosette of 100 control points", Some(rosette()))];
    for (name, path) in curves {
        let Some(path) = path else { continue };
        let mut case = Case::new(path, false);
        let without = case.run(false);
        let with = case.run(true);
        println!(
            "{name}: without the limit {:.3} s, formula {:.1} µm, simulated {:.1} µm; with it {:.3} s, {:.1} µm, {:.1} µm",
            without.seconds,
            without.formula,
            without.simulated,
            with.seconds,
            with.formula,
            with.simulated
        );
        assert!(without.formula > 20.0 && without.simulated > 20.0);
        assert!(with.formula <= 20.0, "{}", with.formula);
        let mut last = with;
        let first = last.seconds;
        for round in 1..=12 {
            if last.simulated <= 20.0 {
                break;
            }
            case.tighten(&last, 1.0, 0.02);
            last = case.run(true);
            println!(
                "  round {round}: {:.3} s ({:+.2} %), simulated {:.2} µm, margin {:.2} µm",
                last.seconds,
                100.0 * (last.seconds / first - 1.0),
                last.simulated,
                20.0 - last.simulated
            );
        }
        assert!(last.simulated <= 20.0, "{}", last.simulated);
    }
}
