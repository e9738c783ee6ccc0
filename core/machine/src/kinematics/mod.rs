//! Kinematics, derived from the chain: forward by product of exponentials, inverse in closed form where there is
//! one (with three linear axes, or two, or six rotary ones of a robot's arm), and numerically else.

mod arm;
mod arm_bend;
mod assembly;
pub mod batch;
pub mod chain;
pub mod choose;
mod derivatives;
mod errors;
mod fault;
pub mod inverse;
mod kept_tip;
pub mod lane_math;
mod leg;
mod linear;
mod numeric;
pub mod orientation;
mod planar;
mod surplus;
pub mod travel;
mod turning_axis;

pub use assembly::{Assembly, AssemblyProof};
pub use chain::{AxisBits, Chain, Joint, Joints, MAX_AXES, Pose, Trace, Turns};
pub use derivatives::{JointDerivatives, ORDERS};
pub(crate) use errors::acts_before;
pub use errors::{AxisErrors, SmallMotion};
pub use fault::{NoClosedForm, POLE, Unreachable};
pub use inverse::{Freedom, Solver};
pub use kept_tip::{LinearMotion, TcpBlock};
pub use leg::{AxesWay, AxisRegion, Drive, DriveBounds, Leg, least_drive_minutes};
pub use linear::Second;
pub use planar::{Meeting, NextSolution};
pub use turning_axis::direction;
