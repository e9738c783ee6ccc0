//! A recorded log of a machine laid over a prediction: how much later its clock runs, how far its axes count from other
//! zeros, and what is left between the two.
//!
//! A control's log begins when somebody starts it, its clock runs from its own zero, its samples lie 1 to 15 ms apart,
//! and its axes count from the machine's reference points. None of that is an error of the prediction, so it is found
//! ([`align()`]) and told before anything is compared.

mod align;
mod difference;
mod settle;
mod shifts;
mod track;

pub use align::{Alignment, AlignmentFault, align};
pub use difference::DifferenceSum;
pub use track::AxisTrack;
