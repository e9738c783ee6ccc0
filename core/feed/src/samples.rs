//! A path as limits see it: derivatives by its parameter at samples, one array a quantity.

/// Derivatives of one axis by the path parameter. Lengths in mm, or rad for an axis that turns, or whatever unit the
/// axis's limits are in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisSamples {
    /// First derivative at each sample.
    pub first: Vec<f64>,
    /// Second derivative.
    pub second: Vec<f64>,
    /// Third derivative; where it jumps (at the knots of a cubic spline, which then must be samples), the one after.
    pub third: Vec<f64>,
}

/// The path at `n + 1` values of its parameter. The parameter may be the arc length or any other that grows along the
/// path; `q` is the square of its speed. First and second derivatives must be continuous: a path with corners, or with
/// arcs beside lines, is more than one path, or stops there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// The parameter, growing.
    pub parameter: Vec<f64>,
    /// First, second and third derivative of the tip in the part frame, mm.
    pub tip: [Vec<[f64; 3]>; 3],
    /// Curvature of the tip's path, 1/mm.
    pub curvature: Vec<f64>,
    /// The machine's axes.
    pub axes: Vec<AxisSamples>,
    /// Length of the block of the program that goes on after each sample, in units of the parameter; empty where
    /// there are no blocks.
    pub blocks: Vec<f64>,
    /// Largest feed of the block of the program that goes on after each sample (at the last sample: of the one before
    /// it), mm/s; infinite where the program sets none, empty where there are no blocks.
    pub feeds: Vec<f64>,
    /// How the tip goes in the part frame per unit of each axis: of each axis, at each sample, mm/mm or mm/rad. Empty
    /// where it is not known. There may be fewer than [`Samples::axes`]: what stands after them there, coordinates with
    /// limits of their own, moves no tip.
    pub rates: Vec<Vec<[f64; 3]>>,
    /// Share of the tolerance of the contour error that may be used at each sample, above 0 and up to 1; empty: all
    /// of it.
    pub contour_share: Vec<f64>,
    /// Third derivatives are continuous at the samples, as those of a quintic spline are; else each sample has the one
    /// after it, and the one ahead of it follows from the second, which is exact where the path is cubic.
    pub smooth: bool,
}

/// Least speed of the tip per unit of parameter speed, mm, below which it counts as standing still: rotary axes alone
/// turn, and what is left of `|P'|` is rounding.
const STILL: f64 = 1e-9;

impl Samples {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.parameter.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.parameter.is_empty()
    }

    /// Number of intervals between samples.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.len().saturating_sub(1)
    }

    /// Step from sample `interval` to the next, in units of the parameter.
    #[must_use]
    pub fn step(&self, interval: usize) -> f64 {
        self.parameter[interval + 1] - self.parameter[interval]
    }

    /// Whether every array has a value for each sample; lengths and feeds of blocks may be missing, and so may shares of
    /// the contour error and the rates of all axes together.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let count = self.len();
        let axes = self.axes.iter().flat_map(|axis| [&axis.first, &axis.second, &axis.third]);
        self.tip.iter().all(|all| all.len() == count)
            && self.curvature.len() == count
            && axes.into_iter().all(|all| all.len() == count)
            && [&self.blocks, &self.feeds, &self.contour_share]
                .into_iter()
                .all(|all| all.is_empty() || all.len() == count)
            && (!self.has_rates()
                || self.rates.len() <= self.axes.len()
                    && self.rates.iter().all(|all| all.len() == count))
    }

    /// Removes all samples and keeps the memory.
    pub fn clear(&mut self) {
        self.parameter.clear();
        self.tip.iter_mut().for_each(Vec::clear);
        self.curvature.clear();
        for axis in &mut self.axes {
            axis.first.clear();
            axis.second.clear();
            axis.third.clear();
        }
        self.blocks.clear();
        self.feeds.clear();
        self.contour_share.clear();
        self.rates.iter_mut().for_each(Vec::clear);
    }

    /// Whether it is known how each axis moves the tip.
    #[must_use]
    pub fn has_rates(&self) -> bool {
        self.rates.iter().any(|all| !all.is_empty())
    }

    /// Appends how each axis moves the tip at the sample that was pushed last: [`Samples::rates`], one for each axis.
    pub fn push_rates(&mut self, rates: &[[f64; 3]]) {
        self.rates.resize_with(rates.len(), Vec::new);
        for (all, &one) in self.rates.iter_mut().zip(rates) {
            all.push(one);
        }
    }

    /// Appends a sample: parameter, first to third derivative of the tip, first to third derivative of each axis. The
    /// curvature follows from the tip; length and feed of its block, where there are blocks, rates and shares are
    /// appended apart.
    pub fn push(&mut self, parameter: f64, tip: [[f64; 3]; 3], axes: &[[f64; 3]]) {
        self.parameter.push(parameter);
        for (all, one) in self.tip.iter_mut().zip(tip) {
            all.push(one);
        }
        self.curvature.push(curvature(tip[0], tip[1]));
        self.axes.resize_with(axes.len(), AxisSamples::default);
        for (axis, &[first, second, third]) in self.axes.iter_mut().zip(axes) {
            axis.first.push(first);
            axis.second.push(second);
            axis.third.push(third);
        }
    }

    /// Speed of the tip at each sample per unit of parameter speed: `|dP/ds|`, 1 for the arc length.
    #[must_use]
    pub fn stretch(&self, sample: usize) -> f64 {
        norm(self.tip[0][sample])
    }

    /// Weights with which the sum of `q` is the sum of the squares of the feed: the objective of the feedrate paper's
    /// linear program (eq. 25).
    #[must_use]
    pub fn squared_feed_weights(&self) -> Vec<f64> {
        let square = |vector: &[f64; 3]| dot(*vector, *vector);
        self.tip[0].iter().map(square).collect()
    }
}

/// Curvature of a path with these first and second derivatives; 0 where the tip stands still.
#[must_use]
pub fn curvature(first: [f64; 3], second: [f64; 3]) -> f64 {
    let speed = norm(first);
    if is_still(speed) { 0.0 } else { norm(cross(first, second)) / (speed * speed * speed) }
}

/// Whether `|P'|` says that the tip stands still.
pub(crate) fn is_still(stretch: f64) -> bool {
    stretch <= STILL
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}
