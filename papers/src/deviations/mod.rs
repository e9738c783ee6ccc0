//! How far the tool strays from the path, move by move, and what models and placements make of it: the comparisons
//! of the harmonic paper (Li 2024) and the parabolic paper (Sha et al. 2022).
//!
//! [`CutSurvey`] looks on while a file is posted and keeps one [`MoveRow`] a move. [`KeptMove`] holds single moves for pictures.
//! Lengths in mm, angles in radians, `t` is the share of a move.

mod curve;
mod edge;
mod kept;
mod placed;
mod statistics;
mod survey;

pub use edge::Rim;
pub use kept::{DeviationPiece, Keeper, KeptMove};
pub use placed::Placed;
pub use statistics::{Distribution, histogram};
pub use survey::{CutSurvey, MoveRow};
