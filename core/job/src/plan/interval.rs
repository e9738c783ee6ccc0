//! The plan of a posted program between two samples of its path.

use post_feed::jerk::IntervalLaw;
use post_feed::quintic;
use post_machine::description::Machine;
use post_machine::kinematics::{JointDerivatives, ORDERS};
use post_posting::plan::PlannedPoint;

use super::gauges::Station;

/// Squared speed halfway of a start from rest with constant jerk, as a share of that at its end: 2^(-4/3).
const HALF_BY_ROOT: f64 = 0.396_850_262_992_049_9;

/// As near as this to its ends such a start is looked at: at rest its bend is infinite.
const END: f64 = 1e-6;

/// One end of an interval.
#[derive(Clone, Copy, Debug)]
struct End {
    tip: [[f64; 3]; ORDERS],
    course: JointDerivatives,
    q: [f64; 3],
}

impl End {
    fn of(point: &PlannedPoint<'_>) -> Self {
        Self { tip: *point.tip, course: *point.course, q: point.q }
    }

    /// Way of the tip for that of the parameter, and its derivative by it.
    fn rate(&self) -> [f64; 2] {
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let rate = libm::sqrt(dot(self.tip[1], self.tip[1]));
        match rate > 0.0 {
            true => [rate, dot(self.tip[1], self.tip[2]) / rate],
            false => [0.0; 2],
        }
    }
}

/// What is planned from one sample of the path to the next.
#[derive(Debug)]
pub struct Interval<'p> {
    /// Whose axes they are.
    pub machine: &'p Machine,
    /// Line of the CL file.
    pub line: u64,
    /// The limit that is used most.
    pub limit: &'static str,
    /// The axis that it is of, by its place in the chain.
    pub axis: Option<u16>,
    /// In units of the parameter.
    pub length: f64,
    /// What the plan takes for it, s.
    pub seconds: f64,
    ends: [End; 2],
}

/// Makes intervals of the places that are shown, two by two.
#[derive(Debug, Default)]
pub struct Intervals {
    from: Option<End>,
}

impl Intervals {
    /// Takes the next place: the interval that ends there.
    pub fn take<'p>(&mut self, point: &PlannedPoint<'p>) -> Option<Interval<'p>> {
        let here = End::of(point);
        let Some(from) = self.from.take() else {
            self.from = Some(here);
            return None;
        };
        Some(Interval {
            machine: point.machine,
            line: point.line,
            limit: point.limit,
            axis: point.axis,
            length: point.step,
            seconds: point.seconds,
            ends: [from, here],
        })
    }
}

impl Interval<'_> {
    /// Of the tip, mm; by the fourth order of the parameter.
    pub fn way(&self) -> f64 {
        let [[from, from_slope], [to, to_slope]] = self.ends.each_ref().map(End::rate);
        let length = self.length;
        (length * (0.5 * (from + to) + length / 12.0 * (from_slope - to_slope))).max(0.0)
    }

    /// Squared speed of the parameter at its beginning, halfway and at its end.
    fn three(&self) -> [f64; 3] {
        let [from, to] = self.ends.each_ref().map(|end| end.q);
        let [value, slope, bend] = from;
        let half = 0.5 * self.length;
        [value, (value + (slope + 0.5 * bend * half) * half).max(0.0), to[0]]
    }

    /// Squared speed of the parameter at a share of it, and its first and second derivative.
    pub fn q(&self, share: f64) -> [f64; 3] {
        let [from, middle, to] = self.three();
        // Of constant jerk off from rest and to it three places tell too.
        let by_root = |end: f64| (middle - HALF_BY_ROOT * end).abs() <= 1e-9 * end;
        let piece = match [from, to] {
            [0.0, to] if to > 0.0 && by_root(to) => IntervalLaw::Leave(to),
            [from, 0.0] if from > 0.0 && by_root(from) => IntervalLaw::Arrive(from),
            _ => {
                let inner = 2.0 * middle - 0.5 * (from + to);
                return IntervalLaw::Quadratic([from, inner, to]).at(share, self.length);
            }
        };
        piece.at(share.clamp(END, 1.0 - END), self.length)
    }

    /// Feed of the tip at its beginning, halfway and at its end, mm/s.
    pub fn feeds(&self) -> [f64; 3] {
        let [from, to] = self.ends.each_ref().map(|end| end.rate()[0]);
        let rates = [from, 0.5 * (from + to), to];
        let q = self.three();
        std::array::from_fn(|place| q[place].max(0.0).sqrt() * rates[place])
    }

    /// Where the path is at a share of it: a quintic, as the planned curve is, with the derivatives of both ends.
    pub fn station(&self, share: f64) -> Station {
        let [from, to] = &self.ends;
        let mut station = Station {
            parameter: 0.0,
            tip: quintic::between(&from.tip, &to.tip, self.length, share),
            course: from.course,
            block: f64::INFINITY,
        };
        let joints = [from, to].map(|end| &end.course.joints);
        station.course.joints = quintic::between(joints[0], joints[1], self.length, share);
        for (rate, to) in station.course.rates.iter_mut().zip(&to.course.rates) {
            *rate += (to - *rate) * share;
        }
        station
    }
}
