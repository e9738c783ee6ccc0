//! Kinematics, derived from the chain: forward by product of exponentials, inverse in closed form where there is
//! one, and numerically else.

pub mod chain;
pub mod choose;
pub mod inverse;
mod linear;
mod numeric;
pub mod orientation;

pub use chain::{Chain, Joint, Joints, MAX_AXES, Pose, Trace};
pub use inverse::{Freedom, NoClosedForm, Solver, Unreachable};
pub use linear::Second;
