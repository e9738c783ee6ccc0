//! Error control: nodes on the path, the certificate of a block, and where points are put in.
//!
//! [`Lineariser`] takes a [`NodeRun`], CL points that follow one another without a corner, and cuts it into blocks
//! within tolerance. How is the machine file's `[accuracy]`: `bisect` and `even` keep CL points and put points in
//! between (and leave out CL points that are needless, if told to), `fewest` goes as far as the certificate
//! allows, `compensate` moves points that lie on the axes' own straight line.

pub(crate) mod arc_fit;
mod bisect;
mod bound;
pub mod certificate;
mod columns;
mod compensate;
mod deviation;
mod even;
mod even_turn;
mod fewest;
mod heading;
mod linearise;
mod node;
mod placed_batch;
mod printed_arc;
mod run;
mod word_frame;

pub use bound::DeviationBound;
pub(crate) use columns::RunColumns;
pub use deviation::{MoveRoom, MoveTolerances, NodeMove};
pub use linearise::{LinearPiece, LineariseError, Lineariser};
pub use node::{PathNode, PlacementError, Placer};
pub use placed_batch::PlacedBatch;
pub(crate) use printed_arc::{ArcDirection, PrintedArc};
pub use run::NodeRun;
pub(crate) use run::RunPosition;
pub(crate) use word_frame::WordFrame;
