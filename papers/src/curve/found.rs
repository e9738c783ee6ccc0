//! What planning a curve has found, for programs to read; its text for people is in `text`.

use post_job::plan::tally::LimitFound;
use serde::Serialize;

use super::rows::PlanRow;
use super::simulate::Simulated;
use super::solve::SolverFound;

/// All of it.
#[derive(Debug, Serialize)]
pub struct CurveSummary {
    /// The curve file.
    pub curve: String,
    pub name: String,
    pub machine: String,
    /// What stands between a stretch and the next: there the path stops.
    pub stops: Vec<f64>,
    pub samples: usize,
    pub length_mm: f64,
    /// Of the feed spline.
    pub seconds: f64,
    /// Of the plan at the samples, by each solver.
    pub solvers: Vec<SolverFound>,
    /// No larger feed at a sample ever forbids a larger one at the next.
    pub monotone: bool,
    /// By how much the feed spline is slower than the plan at the samples, so that every limit is kept between them too:
    /// a share of the speed.
    pub spline_slower: f64,
    pub limits: Vec<LimitFound>,
    pub simulated: Option<Simulated>,
    /// A spline for each stretch.
    pub feed_splines: Vec<SplineFound>,
    /// The names of the axes, in the order of the rows' values.
    pub axes: Vec<String>,
    /// A row at each knot of the feed splines.
    pub rows: Vec<PlanRow>,
}

/// A feed spline: the squared speed of the path parameter `(ds/dt)²`, 1/s², as a B-spline of the parameter. The feed of
/// the tip is its root times `|dP/ds|`.
#[derive(Debug, Serialize)]
pub struct SplineFound {
    pub degree: usize,
    /// From this parameter to that.
    pub range: [f64; 2],
    /// The motion leaves rest (comes to rest) with constant jerk over the first (last) piece, on which the squared speed
    /// is its value at the inner knot times the share of the piece to the power of 4/3; the B-spline counts from the
    /// inner knot on.
    pub constant_jerk_at_ends: [bool; 2],
    pub knots: Vec<f64>,
    pub coefficients: Vec<f64>,
}
