//! Error control: nodes on the path, the certificate of a block, and where points are put in.

pub mod certificate;
mod linearise;
mod node;

pub use linearise::{Bound, Linearise, Move, Piece, Stuck, Tolerances};
pub use node::{Node, Placer, Refused};
