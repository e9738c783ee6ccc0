//! Forward and inverse against each other, over random poses that are the same in every run.

use serde::Serialize;

use super::probe::Probe;
use crate::kinematics::orientation::angle;

/// Poses that are tried.
const POSES: usize = 1000;

/// The same of a chain that is searched.
const SEARCHED: usize = 25;

/// The largest differences.
#[derive(Clone, Debug, Serialize)]
pub struct RoundTrip {
    /// Poses that were tried.
    pub poses: usize,
    /// Solutions that came back for them.
    pub solutions: usize,
    /// Poses for which none did.
    pub not_found: usize,
    /// Largest distance between the tip wanted and the tip reached, mm.
    pub tip_mm: f64,
    /// Largest angle between the tool axis wanted and reached, radians.
    pub axis_rad: f64,
}

impl RoundTrip {
    pub(super) fn of(probe: &Probe<'_>) -> Self {
        let mut random = Random(0x706f_7374);
        let poses = if probe.closed_form() { POSES } else { SEARCHED };
        let mut trip = Self { poses, solutions: 0, not_found: 0, tip_mm: 0.0, axis_rad: 0.0 };
        for _ in 0..poses {
            let mut joints = *probe.home();
            let count = probe.machine().axes.len();
            for (place, value) in joints.iter_mut().enumerate().take(count) {
                let [least, most] = probe.span(place);
                *value = least + (most - least) * random.share();
            }
            let wanted = probe.chain().forward(&joints);
            let found = probe.inverse(wanted.tip, wanted.axis).unwrap_or_default();
            trip.not_found += usize::from(found.is_empty());
            trip.solutions += found.len();
            for solution in &found {
                let reached = probe.chain().forward(solution);
                trip.tip_mm = trip.tip_mm.max((reached.tip - wanted.tip).norm());
                trip.axis_rad = trip.axis_rad.max(angle(reached.axis, wanted.axis));
            }
        }
        trip
    }
}

/// A linear congruential generator with Knuth's MMIX constants; its high bits are good enough for samples.
struct Random(u64);

impl Random {
    /// Even in 0 to 1.
    fn share(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}
