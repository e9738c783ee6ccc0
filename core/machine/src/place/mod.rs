//! Where the part can sit: the mounts that keep every linear axis inside its travel.
//!
//! With the rotary axes where they stand, a linear axis is at `q + g · (mount − mount now)`: `g` is a row of the inverse
//! of the small system that places the tip, and neither the tool's length nor the point has a say in it. So each point
//! of a program and each end of travel leave one half-space of mounts ([`MountRoom`]), and all of them a convex body, of which
//! the point next to a wished mount is found exactly ([`nearest`]). No linear-programming crate stands behind it: with
//! three unknowns the incremental method is some fifty lines, needs memory for its answer alone, and says why there is
//! none.

mod descent;
mod half_space;
mod room;

pub use descent::{MountCost, descend, rounded, spread};
pub use half_space::{HalfSpace, Tight, most_room, nearest, shuffled};
pub use room::{MountConstraint, MountRoom, TravelEnd, opened};
