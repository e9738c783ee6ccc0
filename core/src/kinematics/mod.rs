//! Kinematics, derived from the chain: forward by product of exponentials, inverse in closed form, choice.

pub mod chain;
pub mod choose;
pub mod inverse;

pub use chain::{Chain, Joint, Joints, MAX_AXES, Pose, Trace};
pub use inverse::{NoClosedForm, Solver, Unreachable};
