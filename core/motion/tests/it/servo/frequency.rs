//! Frequency responses, by complex algebra from the block diagram.

use std::f64::consts::FRAC_1_SQRT_2;

use libm::{atan2, cos, hypot, sin};
use nalgebra::Complex;
use post_machine::servo::{Feedback, FrequencyResponse, Loops};
use post_motion::servo::Follower;

use super::{all_loops, feedrate_paper, of_loops, transfer};

type Number = Complex<f64>;

fn real(value: f64) -> Number {
    Complex::new(value, 0.0)
}

/// `x/r` of the loops at s, block by block in torques and angles of the motor.
fn block_diagram(loops: &Loops, s: Number) -> Number {
    let drive = loops.drive.mechanics();
    let travel = drive.travel;
    // Table over motor: eq. 10 of the prediction paper, with the damping of the transmission.
    let table = match drive.stiffness {
        Some(stiffness) => {
            let handed = real(stiffness) + s * drive.stiffness_damping;
            handed / (s * s * drive.mass + s * drive.damping + handed)
        }
        None => real(1.0),
    };
    // Torque that the motor's angle asks for: its own inertia, and the table's force.
    let force = (s * s * drive.mass + s * drive.damping) * table * travel;
    let impedance = s * s * loops.motor_inertia
        + s * (loops.motor_damping + drive.shaft_damping)
        + force * travel;
    let inertia = loops.motor_inertia + drive.mass * travel * travel;
    let velocity_loop = match loops.velocity_time {
        Some(time) => (real(1.0) + real(1.0) / (s * time)) * loops.velocity_gain,
        None => real(loops.velocity_gain),
    };
    let measured = match loops.feedback {
        Feedback::Scale => table * travel,
        Feedback::Motor => real(travel),
    };
    // Commanded torque = of_command·r - of_angle·θ.
    let of_command = velocity_loop * (s * loops.velocity_feed_forward + loops.kv) / travel
        + s * s * loops.acceleration_feed_forward * inertia / travel;
    let of_angle = velocity_loop * (s + measured * loops.kv / travel);
    // Torque = share·commanded - braking·θ.
    let (share, braking) = match loops.current {
        None => (real(1.0), real(0.0)),
        Some(current) => {
            let controller = match current.time {
                Some(time) => (real(1.0) + real(1.0) / (s * time)) * current.gain,
                None => real(current.gain),
            };
            let winding = s * current.inductance * 1e-3 + current.resistance + controller;
            (controller / winding, s * current.back_emf * current.torque_constant / winding)
        }
    };
    let angle = share * of_command / (impedance + braking + share * of_angle);
    angle * travel * table
}

#[test]
fn loops_are_their_block_diagram() {
    for loops in all_loops() {
        let response = FrequencyResponse::new(&of_loops(loops.clone()));
        for omega in [0.1, 3.0, 30.0, 90.0, 250.0, 590.0, 1500.0, 2e4] {
            let found = response.at(omega);
            let expected = block_diagram(&loops, Complex::new(0.0, omega));
            let error = (found - expected).norm_sqr().sqrt();
            let size = expected.norm_sqr().sqrt();
            assert!(error < 1e-9 * size + 1e-12, "{omega}: {found} {expected}");
        }
    }
}

/// Amplitude and phase of the simulation's answer to a sine are those of the block diagram. The sine is given by straight
/// pieces: the share of its own frequency in them is `(sin(ωT/2)/(ωT/2))²`.
#[test]
fn a_sine_comes_out_as_the_block_diagram_says() {
    for loops in all_loops() {
        let servo = of_loops(loops.clone());
        for (omega, count) in [(40.0, 4000), (300.0, 4000), (800.0, 2000)] {
            // A whole number of set-points a turn.
            let period = std::f64::consts::TAU / omega / f64::from(count);
            let mut follower = Follower::new(&servo, period).unwrap();
            let turns = (0.8 / (f64::from(count) * period)).ceil() as u32 + 1;
            let mut sums = [0.0; 2];
            for k in 1..=turns * count {
                let angle = omega * period * f64::from(k);
                let found = follower.next(sin(angle));
                if k > (turns - 1) * count {
                    sums[0] += found * sin(angle);
                    sums[1] += found * cos(angle);
                }
            }
            let half = f64::from(count) / 2.0;
            let [sine, cosine] = sums.map(|sum| sum / half);
            let expected = block_diagram(&loops, Complex::new(0.0, omega));
            let share = sin(omega * period / 2.0) / (omega * period / 2.0);
            let amplitude = hypot(expected.re, expected.im) * share * share;
            let phase = atan2(expected.im, expected.re);
            // What swings on its own has died away to e^(-0.8·30) of it.
            assert!((hypot(sine, cosine) - amplitude).abs() < 1e-7, "{omega}");
            let turned = atan2(cosine, sine) - phase;
            let turned = atan2(sin(turned), cos(turned));
            assert!(turned.abs() < 1e-6, "{omega}: {turned}");
        }
    }
}

/// Recomputed for the X axis of Chen, Ren, Sun (2016): what the paper plots.
#[test]
fn the_feedrate_papers_gains() {
    let response = FrequencyResponse::new(&feedrate_paper());
    for (omega, gain) in [(1.0, 1.00010), (5.0, 1.00321), (10.0, 1.01462), (20.0, 1.04902)] {
        let found = response.gain(omega);
        assert!((found - gain).abs() < 6e-6, "{omega}: {found}");
    }
    // The peak is flat: 1.0996 at 49.8 rad/s too.
    assert!((response.gain(49.8) - 1.0996).abs() < 5e-5);
    let peak = (1..20_000)
        .map(|k| f64::from(k) * 0.01)
        .map(|omega| (response.gain(omega), omega))
        .fold((0.0, 0.0), |most, next| if next.0 > most.0 { next } else { most });
    assert!((peak.0 - 1.09963).abs() < 1e-5 && (peak.1 - 49.66).abs() < 0.02, "{peak:?}");
    // By the transfer function alone: it falls through 1 at 113.2 rad/s.
    assert!(response.gain(113.1) > 1.0 && response.gain(113.3) < 1.0);
}

/// `bandwidth` and `faithful_up_to`, where they can be said in closed form or by looking everywhere.
#[test]
fn how_far_a_gain_holds() {
    // 50/(s + 50) is at -3 dB at 50 rad/s; |G| = 1 - share at 50·sqrt(1/(1 - share)² - 1).
    let first = FrequencyResponse::new(&transfer(&[50.0], &[1.0, 50.0]));
    assert!((first.bandwidth() - 50.0).abs() < 1e-9);
    for share in [1e-6, 0.01, 0.3] {
        let expected = 50.0 * (1.0 / ((1.0 - share) * (1.0 - share)) - 1.0_f64).sqrt();
        let found = first.faithful_up_to(share);
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    }
    assert_eq!(
        FrequencyResponse::new(&transfer(&[0.9, 50.0], &[1.0, 50.0])).bandwidth(),
        f64::INFINITY
    );
    // The feedrate paper's: |G| rises to 1.0996 first, so 0.05 holds up to a little above 20 rad/s, where it is 0.04902,
    // and 0.2 until |G| has fallen to 0.8.
    let paper = FrequencyResponse::new(&feedrate_paper());
    for share in [0.001, 0.05, 0.0995, 0.2] {
        let found = paper.faithful_up_to(share);
        let step = 1e-3;
        let mut omega = step;
        while (1.0 - paper.gain(omega)).abs() <= share {
            omega += step;
        }
        assert!((found - omega).abs() <= step, "{share}: {found} {omega}");
    }
}

/// As far as the steady state goes: the swing of the table on its transmission, unless the loops end before.
#[test]
fn the_natural_frequency_is_that_of_the_table_or_of_the_loops() {
    for loops in all_loops() {
        let response = FrequencyResponse::new(&of_loops(loops.clone()));
        let (least, band) = (response.natural_frequency(), response.bandwidth());
        assert!(least > 0.0 && least <= band);
        let swing = loops.drive.mechanics().natural_frequency();
        assert!(swing.is_none_or(|swing| least <= swing), "{least}");
        // Up to there the axis follows, with more than half of the power.
        for part in 1..=50 {
            let omega = least.min(1e4) * f64::from(part) / 50.0;
            assert!(response.gain(omega) > 0.999 * FRAC_1_SQRT_2, "{omega}");
        }
    }
    let paper = FrequencyResponse::new(&feedrate_paper());
    assert_eq!(paper.natural_frequency(), paper.bandwidth());
}

/// A resonance so narrow that no grid of frequencies would meet it.
#[test]
fn a_narrow_resonance_is_found() {
    // (s² + 2·0.01·s·w + w²) over the same with damping 1e-6, beside a slow first order.
    let (w, thin) = (400.0, 1e-6);
    let numerator = [1.0, 2.0 * 1e-5 * w, w * w];
    let denominator = [1.0, 2.0 * thin * w, w * w];
    let response = FrequencyResponse::new(&transfer(&numerator, &denominator));
    assert!(response.gain(w) > 9.0);
    let found = response.faithful_up_to(0.5);
    assert!((found / w - 1.0).abs() < 1e-4 && found < w, "{found}");
}
