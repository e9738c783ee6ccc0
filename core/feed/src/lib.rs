#![forbid(unsafe_code)]
//! The fastest feed along a path that keeps contour, chord and drive limits (Chen, Ren and Sun 2016, *Contouring
//! accuracy improvement using an adaptive feedrate planning method for CNC machine tools*, here: the feedrate paper).
//!
//! Pure numerics over samples of a path: nothing here knows a machine, a program or a file. [`Samples`] hold the
//! derivatives of tip and axes by a parameter `s` that grows along the path; [`limits`] make a [`Problem`] of them, in
//! the unknowns `q = (ds/dt)²` at the samples; a solver answers with `q`:
//!
//! | solver | keeps | cost | use |
//! |---|---|---|---|
//! | [`reach`] | velocity, acceleration, errors | linear, two passes; streams | the default |
//! | [`linear_program`] | the same | linear an iteration, some twenty of them | the paper's optimum of `Σ f²`, with a proof |
//! | [`jerk`] | jerk too | linear an iteration, some hundred of them; streams | where drives have jerk limits |
//!
//! Where a path is known by points alone, [`fit`] lays smooth curves along them.
//!
//! ```
//! use post_feed::limits::{AxisAcceleration, AxisVelocity, Collocation, TipFeed};
//! use post_feed::{EndSpeeds, Problem, Samples, profile, reach};
//!
//! // 100 mm along X at a millimetre a sample: 50 mm/s at most, 200 mm/s².
//! let mut samples = Samples::default();
//! for index in 0..=100 {
//!     let x = [1.0, 0.0, 0.0];
//!     samples.push(f64::from(index), [x, [0.0; 3], [0.0; 3]], &[x]);
//! }
//! let collocation = Collocation::Throughout;
//! let feed = TipFeed { most: 50.0, collocation };
//! let velocity = AxisVelocity { limits: vec![60.0], collocation };
//! let acceleration = AxisAcceleration { limits: vec![200.0], collocation };
//! let problem = Problem::new(&samples, &[&feed, &velocity, &acceleration], EndSpeeds::default())?;
//! let plan = reach::solve(&problem)?;
//! // A quarter of a second to get up to speed, and down again, each over 6.25 mm.
//! let seconds = profile::duration(&problem.steps, &plan);
//! assert!((seconds - (2.0 * 0.25 + 87.5 / 50.0)).abs() < 0.002, "{seconds}");
//! # Ok::<(), post_feed::Infeasible>(())
//! ```
//!
//! *Never here:* input or output, `unsafe`, trigonometry of the platform, an allocation a sample on the way of
//! [`reach::ReachStream`], a plan that breaks a limit because an iteration was stopped.

mod feed_spline;
pub mod fit;
mod infeasible;
mod interior;
pub mod jerk;
pub mod limits;
pub mod linear_program;
pub mod problem;
pub mod profile;
pub mod quintic;
pub mod reach;
pub mod response;
pub mod samples;
mod table;
mod window;

pub use feed_spline::FeedSpline;
pub use infeasible::Infeasible;
pub use problem::{EndSpeeds, Problem};
pub use samples::Samples;

/// What tests look into; no part of the crate's face.
#[doc(hidden)]
pub mod internals {
    pub use crate::jerk::forms::{
        LinearForm, Q, acceleration, jerk, leaving_acceleration, leaving_jerk,
    };
    pub use crate::limits::channel::Directions;
}
