//! Deviations whose peaks are known.

use post_plugin::{Deviation, Tolerance};

/// Peak of the tip in a plain case, mm.
const TIP: f64 = 0.02;

/// Peak of the tool axis in a plain case, degrees.
const AXIS: f64 = 0.2;

/// What the cases must stay within, if they do not say otherwise.
pub(super) const TOLERANCE: Tolerance = Tolerance { tip: 0.005, axis: 0.05 };

/// What a model must make of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DeviationKind {
    /// One bow, symmetrical: its peak must be met.
    Bow,
    /// Smooth: a model may miss it.
    Smooth,
    /// With a jump: a model may miss it, and its curve may swing over.
    Rough,
}

/// A case: the deviation along a move, and what it must stay within.
pub(super) struct KnownDeviation {
    pub name: &'static str,
    pub kind: DeviationKind,
    pub tolerance: Tolerance,
    pub at: Box<dyn Fn(f64) -> Deviation>,
}

/// Tip along (2, -3, 6)/7, tool axis about (6, 2, -3)/7, as far as `tip` and `axis` say.
fn straight(tip: f64, axis: f64) -> Deviation {
    Deviation {
        tip: [2.0, -3.0, 6.0].map(|part| tip * part / 7.0),
        axis: [6.0, 2.0, -3.0].map(|part| axis * part / 7.0),
    }
}

pub(super) fn parabola(t: f64) -> f64 {
    4.0 * t * (1.0 - t)
}

/// sin(πt), t from 0 to 2.
fn sine(t: f64) -> f64 {
    if t == t.floor() {
        return 0.0;
    }
    let sign = if t > 1.0 { -1.0 } else { 1.0 };
    let x = std::f64::consts::PI * (t - t.floor());
    // The Taylor series about the middle, where |x| is at most π/2.
    let x = x - std::f64::consts::FRAC_PI_2;
    let (mut term, mut sum) = (1.0, 1.0);
    for n in 1..12 {
        let n = f64::from(n);
        term *= -x * x / ((2.0 * n - 1.0) * (2.0 * n));
        sum += term;
    }
    sign * sum
}

/// The shapes that every model is run on.
pub(super) fn all() -> Vec<KnownDeviation> {
    let shape = |name, kind, at: Box<dyn Fn(f64) -> Deviation>| KnownDeviation {
        name,
        kind,
        tolerance: TOLERANCE,
        at,
    };
    let bow = |name, tip: f64, axis: f64| {
        let at = move |t: f64| straight(tip * parabola(t), axis * parabola(t));
        shape(name, DeviationKind::Bow, Box::new(at))
    };
    let smooth = |name, at: fn(f64) -> f64| {
        let at = move |t: f64| straight(TIP * at(t), AXIS * at(t));
        shape(name, DeviationKind::Smooth, Box::new(at))
    };
    let within = |shape: KnownDeviation, factor: f64| KnownDeviation {
        tolerance: Tolerance { tip: TIP * factor, axis: AXIS * factor },
        ..shape
    };
    vec![
        bow("none", 0.0, 0.0),
        bow("parabola", TIP, AXIS),
        KnownDeviation { kind: DeviationKind::Bow, ..smooth("half a sine", sine) },
        bow("tip alone", TIP, 0.0),
        bow("axis alone", 0.0, AXIS),
        within(bow("just over", TIP, AXIS), 1.0 / 1.1),
        within(bow("far over", TIP, AXIS), 1e-3),
        within(bow("far under", TIP, AXIS), 100.0),
        bow("tiny", 1e-12, 1e-12),
        bow("huge", 1e3, 90.0),
        shape(
            "rounded ends",
            DeviationKind::Smooth,
            Box::new(|t| {
                let ends = straight(-5e-4, 3e-4).lerp(straight(3e-4, 5e-4), t);
                straight(TIP * parabola(t), AXIS * parabola(t)) + ends
            }),
        ),
        smooth("skewed", |t| 256.0 / 27.0 * t * t * t * (1.0 - t)),
        smooth("two humps", |t| sine(2.0 * t)),
        shape(
            "bow and wave",
            DeviationKind::Smooth,
            Box::new(|t| Deviation {
                tip: [TIP * parabola(t), 0.0, 0.5 * TIP * sine(2.0 * t)],
                axis: [0.0, 0.5 * AXIS * sine(2.0 * t), AXIS * parabola(t)],
            }),
        ),
        KnownDeviation {
            kind: DeviationKind::Rough,
            ..smooth("jump", |t| if t < 0.3 { 0.0 } else { 1.0 })
        },
    ]
}
