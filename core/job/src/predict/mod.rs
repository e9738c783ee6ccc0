//! What a program does on the machine before it is run there: set-points, servos, contour error.

mod cl_path;
mod cycle_time;
mod feeds;
mod found;
pub mod measured;
mod page;
mod pictures;
mod prediction;
mod program;
mod run;
mod sample;
mod set_point_stream;
mod set_points_csv;
mod stages;
mod text;
mod times;
mod trajectory;

pub use cycle_time::cycle_time;
pub use prediction::Prediction;
pub use program::{MeasuredRequest, PredictRequest, PredictedProgram, predict_program};
pub use run::{PredictReference, PredictWatch, Predicted, PredictionSetup, predict};
pub use sample::Sample;
pub use text::text;
