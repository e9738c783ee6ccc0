//! Random smooth paths through random five-axis machines.

use nalgebra::Vector3;
use post_feed::Samples;
use post_feed::limits::{AxisAcceleration, Collocation, ContourError, Limit, TipFeed};
use post_machine::kinematics::Chain;
use post_machine::servo::{FrequencyResponse, Servo};
use post_testkit::Rng;
use post_testmachines::Random;

use super::{Path, even, limit, of_the_paper, planned, samples, simulated, spread, transfer};

/// Axis values as sums of sines over a length of 1.
struct Waves {
    chain: Chain,
    /// Of each axis: amplitude, frequency and phase of each wave.
    waves: Vec<Vec<[f64; 3]>>,
}

impl Waves {
    /// Whose turns of the tip are no narrower than a millimetre: narrower ones are corners.
    fn new(rng: &mut Rng) -> (Self, Samples) {
        loop {
            let path = Self::any(rng);
            let samples = samples(&path, &even(0.0, 1.0, 2000), 1e-4);
            if samples.curvature.iter().all(|curvature| *curvature < 1.0) {
                return (path, samples);
            }
        }
    }

    fn any(rng: &mut Rng) -> Self {
        let machine = Random::new(rng, 2, 0);
        let joints = machine.reference.joints.clone();
        let wave = |rng: &mut Rng, rotary: bool| {
            let most = if rotary { 0.15 } else { 30.0 };
            let number = 1.0 + rng.range(0.0, 4.0);
            [rng.range(0.0, most) / number, 6.0 * number, rng.range(-3.0, 3.0)]
        };
        let waves =
            joints.iter().map(|joint| (0..4).map(|_| wave(rng, joint.rotary)).collect()).collect();
        Self { chain: machine.reference.chain(), waves }
    }
}

impl Path for Waves {
    fn axes(&self, parameter: f64) -> Vec<[f64; 4]> {
        let each = self.waves.iter().map(|waves| {
            let mut all = [0.0; 4];
            for [amplitude, frequency, phase] in waves {
                let (sine, cosine) = libm::sincos(frequency * parameter + phase);
                let parts = [sine, cosine, -sine, -cosine];
                let mut factor = *amplitude;
                for (sum, part) in all.iter_mut().zip(parts) {
                    *sum += factor * part;
                    factor *= frequency;
                }
            }
            all
        });
        each.collect()
    }

    fn tip(&self, axes: &[f64]) -> Vector3<f64> {
        let mut joints = [0.0; post_machine::kinematics::MAX_AXES];
        joints[..axes.len()].copy_from_slice(axes);
        self.chain.forward(&joints).tip
    }
}

/// Servos of one kind, alike or each a little different.
fn servos(rng: &mut Rng, kind: &str) -> Vec<Servo> {
    let pid = |axis: usize| of_the_paper(axis.is_multiple_of(2));
    let gain = rng.range(30.0, 60.0);
    let (swing, damping) = (rng.range(80.0, 200.0), rng.range(0.6, 1.0));
    let mut near = |value: f64| value * rng.range(0.95, 1.05);
    let first = |gain: f64| transfer(&[gain], &[1.0, gain]);
    let second = |swing: f64, damping: f64| {
        let square = swing * swing;
        transfer(&[square], &[1.0, 2.0 * damping * swing, square])
    };
    let one = |axis: usize| match kind {
        "PID of the paper" => of_the_paper(true),
        "PID of the paper, X and Y by turns" => pid(axis),
        "position loop" => first(gain),
        "position loop, 5 % apart" => first(near(gain)),
        "second order" => second(swing, damping),
        _ => second(near(swing), near(damping)),
    };
    (0..5).map(one).collect()
}

/// Kinds of servos, and how many times its limit their contour error is at most.
const KINDS: [(&str, f64); 6] = [
    ("PID of the paper", 2.5),
    ("PID of the paper, X and Y by turns", 2.5),
    ("position loop", 1.3),
    ("position loop, 5 % apart", 1.3),
    ("second order", 1.6),
    ("second order, 5 % apart", 1.6),
];

/// A path that is planned and simulated.
struct Outcome {
    /// Contour error over its limit at each set-point.
    shares: Vec<f64>,
    /// Time over that of the plan without the limit.
    slower: f64,
}

const TOLERANCE: f64 = 0.02;

fn outcome(path: &Waves, samples: &Samples, servos: &[Servo]) -> Outcome {
    let highest = servos
        .iter()
        .map(|servo| FrequencyResponse::new(servo).natural_frequency())
        .fold(f64::INFINITY, f64::min);
    let collocation = Collocation::default();
    let feed = TipFeed { most: 100.0, collocation };
    let rotary = path.chain.joints().iter().map(|joint| joint.rotary);
    let acceleration = AxisAcceleration {
        limits: rotary.map(|rotary| if rotary { 2.0 } else { 1000.0 }).collect(),
        collocation,
    };
    let contour: ContourError = limit(servos, TOLERANCE, highest);
    let without: [&dyn Limit; 2] = [&feed, &acceleration];
    let (_, fastest) = planned(samples, &without);
    let (plan, seconds) = planned(samples, &[&feed, &acceleration, &contour]);
    let errors = simulated(path, samples, &plan, servos, 1e-3);
    Outcome {
        shares: errors.iter().map(|(_, error)| error / TOLERANCE).collect(),
        slower: seconds / fastest,
    }
}

/// The formula is that of the steady state. Servos whose error follows the acceleration at once keep it but for some per
/// cent; that of the paper has an integral part whose memory is 0.16 s, and strays by up to twice as much where curvature
/// comes and goes faster than that. Neither is far below its limit all the time: the limit is what the plan goes by.
#[test]
fn simulated_servos_stray_little_more_than_the_formula_says() {
    let (rounds, mut rng) = (0..5, Rng::new(15));
    let count = rounds.len();
    for (kind, most) in KINDS {
        let (mut all, mut peaks, mut slower) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..count {
            let (path, samples) = Waves::new(&mut rng);
            let servos = servos(&mut rng, kind);
            let found = outcome(&path, &samples, &servos);
            peaks.push(found.shares.iter().copied().fold(0.0, f64::max));
            all.extend(found.shares);
            slower.push(found.slower);
        }
        let peaks = spread(&mut peaks);
        println!(
            "{kind}: contour error over its limit, all set-points {:.3?}; largest of each path {peaks:.3?}; time over that without {:.3?}",
            spread(&mut all),
            spread(&mut slower),
        );
        assert!(peaks[4] < most, "{kind}: {}", peaks[4]);
        assert!(peaks[4] > 0.9, "{kind}: {}", peaks[4]);
    }
}

/// Without how each axis moves the tip the formula sees the tip's path alone, which says nothing of how rotary axes that
/// are late stray across it.
#[test]
fn the_tips_path_alone_does_not_tell_the_contour_error_of_five_axes() {
    let (rounds, mut rng) = (0..3, Rng::new(16));
    let mut peaks = [0.0_f64; 2];
    for _ in rounds {
        let (path, mut samples) = Waves::new(&mut rng);
        let servos = servos(&mut rng, "position loop, 5 % apart");
        for peak in &mut peaks {
            let found = outcome(&path, &samples, &servos);
            *peak = found.shares.into_iter().fold(*peak, f64::max);
            samples.rates.clear();
        }
    }
    println!(
        "largest over its limit: through the axes {:.2}, by the tip's path {:.2}",
        peaks[0], peaks[1]
    );
    assert!(peaks[0] < 1.3 && peaks[1] > 1.25 * peaks[0], "{peaks:?}");
}
