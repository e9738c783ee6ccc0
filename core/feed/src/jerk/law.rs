//! The feed between samples of a plan with jerk limits.

/// `q = (ds/dt)²` over one interval of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntervalLaw {
    /// A quadratic, by its three Bernstein coefficients.
    Quadratic([f64; 3]),
    /// Leaves rest for this `q` at the interval's end, with constant jerk along the path: `q * share^(4/3)`.
    Leave(f64),
    /// Comes to rest from this `q` at its beginning.
    Arrive(f64),
}

impl IntervalLaw {
    /// `q` and its first and second derivative by the parameter at a share of the interval, 0 to 1. At rest the second
    /// is infinite; the path's jerk, `q'' * sqrt(q) / 2`, is not.
    #[must_use]
    pub fn at(self, share: f64, step: f64) -> [f64; 3] {
        match self {
            Self::Quadratic([a, b, c]) => {
                let [left, right] = [a + (b - a) * share, b + (c - b) * share];
                [
                    left + (right - left) * share,
                    2.0 * (right - left) / step,
                    2.0 * (a - 2.0 * b + c) / (step * step),
                ]
            }
            Self::Leave(q) => {
                let root = libm::cbrt(share);
                [
                    q * share * root,
                    q * 4.0 / 3.0 * root / step,
                    q * 4.0 / 9.0 / (root * root * step * step),
                ]
            }
            Self::Arrive(q) => {
                let [value, slope, bend] = Self::Leave(q).at(1.0 - share, step);
                [value, -slope, bend]
            }
        }
    }

    /// The time it takes, s.
    #[must_use]
    pub fn duration(self, step: f64) -> f64 {
        match self {
            // The integral of step * share^(-2/3) / sqrt(q).
            Self::Leave(q) | Self::Arrive(q) => 3.0 * step / q.sqrt(),
            // Constant acceleration, from rest too.
            Self::Quadratic([a, b, c]) if (a - 2.0 * b + c).abs() <= 1e-12 * (a + c) => {
                2.0 * step / (a.sqrt() + c.sqrt())
            }
            Self::Quadratic(_) => {
                let speed = |share: f64| self.at(share, step)[0].sqrt();
                let each = GAUSS.iter().map(|[node, weight]| {
                    weight * (1.0 / speed(0.5 - node) + 1.0 / speed(0.5 + node))
                });
                step * each.sum::<f64>()
            }
        }
    }
}

/// Nodes from the middle, and weights, of Gauss' rule of six points on an interval of length 1.
const GAUSS: [[f64; 2]; 3] = [
    [0.119_309_593_041_598_5, 0.233_956_967_286_345_5],
    [0.330_604_693_233_132_2, 0.180_380_786_524_069_3],
    [0.466_234_757_101_576, 0.085_662_246_189_585_2],
];

/// The feed of a whole path. Velocity and acceleration are continuous; the jerk along the path jumps at samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Law {
    /// Increase of the parameter over each interval.
    pub steps: Vec<f64>,
    /// `q` over each.
    pub pieces: Vec<IntervalLaw>,
}

impl Law {
    /// The time of the whole path, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        let each = self.pieces.iter().zip(&self.steps);
        each.map(|(piece, &step)| piece.duration(step)).sum()
    }

    /// `q` at each sample.
    #[must_use]
    pub fn q(&self) -> Vec<f64> {
        let mut q: Vec<f64> = Vec::with_capacity(self.pieces.len() + 1);
        for (index, (piece, &step)) in self.pieces.iter().zip(&self.steps).enumerate() {
            if index == 0 {
                q.push(piece.at(0.0, step)[0]);
            }
            q.push(piece.at(1.0, step)[0]);
        }
        q
    }
}
