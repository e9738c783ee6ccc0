//! How a machine moves along a path, and how far it strays from it: the system of Zhang, Chen (2025), "Offline prediction
//! of contour errors for five-axis machine tools based on processing instructions", for any chain and any control.
//!
//! | part | takes | hands on |
//! |---|---|---|
//! | [`path`] | two stances of the machine | where the tool is between them, as the control leads it |
//! | [`limits`] | a move, and the limits of the machine | how the axes and the tip go along it: bounds, and both ends |
//! | [`task`] | what a program asks for | [`Task`]: moves with their pace and corners, waits |
//! | [`trajectory`] | tasks, and the limits of the machine | [`SetPoints`]: where the axes are commanded, at any period |
//! | [`servo`] | set-points | where the axes really are |
//! | [`contour`] | both | how far the tip is off the commanded path, and off the CL path |
//! | [`measured`] | a recorded log, and a prediction | how they lie over one another, and what is left |
//! | [`fourier`] | values at even distances | how much of each frequency is in them |
//!
//! This crate stands on `post-machine` alone; `post-readback` stands on its [`path`]. There is no input or output here,
//! no unsafe code and no dialect's name, and memory does not grow with the program.

pub mod contour;
pub mod fourier;
pub mod limits;
pub mod measured;
pub mod path;
pub mod servo;
mod set_points;
pub mod task;
pub mod trajectory;

pub use set_points::{ProgramPlace, SetPoints, VelocityJump};
pub use task::{CornerMode, Move, MovePace, Task, WaitReason};
