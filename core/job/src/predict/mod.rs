//! What a program does on the machine before it is run there: set-points, servos, contour error.

mod cl_path;
mod feeds;
mod found;
pub mod measured;
mod prediction;
mod run;
mod sample;
mod stages;
mod text;
mod times;

pub use prediction::Prediction;
pub use run::{Against, Asked, PredictWatch, Predicted, predict};
pub use sample::Sample;
pub use text::text;
