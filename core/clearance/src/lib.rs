//! Bodies on the links of a machine, and the proof that they stay clear of one another along motions.
//!
//! | part | holds |
//! |---|---|
//! | [`convex`] | one convex piece: a part of a profile of revolution, a box, a triangle, the hull of points |
//! | [`shape`] | a body's pieces with a tree of spheres around them; what is wrong with a mesh |
//! | [`distance`] | how far two shapes are apart: a proven lower bound, and an upper one with two points |
//! | [`piece`] | a part of a way: between which axis values all axes stay on it |
//! | [`pair`] | two bodies, and how far one can come nearer to the other on a piece |
//! | [`beside`] | rapids that begin or end nearer to the stock than is kept |
//! | `around` | how far anything is, in a box of axis values, from where it is in the middle of it |
//! | `planes` | two planes that hold two bodies apart on all of a piece |
//! | `mesh`, `inside`, `cloud` | parts of a mesh, and what they enclose; the farthest of many points along a direction |
//! | [`proof`] | all pairs along a program: clear, a hit, or not proven |
//!
//! A link is what moves together: 0 carries the part, n is what follows the nth axis of the chain. Bodies are given in
//! the machine frame with every axis at zero, mm.
//!
//! What is said to be clear is proven: a distance counts only as far as a plane between the two shapes shows it, whatever
//! the search says that found the plane, and on the way between poses as far as the chain bounds how far each point goes.
//! There is no input or output here, and memory does not grow with the program.

mod around;
pub mod beside;
mod cloud;
pub mod convex;
pub mod distance;
mod inside;
mod mesh;
pub mod pair;
pub mod piece;
pub mod placement;
mod planes;
pub mod proof;
pub mod shape;

/// What rounding may take from a distance, mm: coordinates stay below [`FARTHEST`], a number has 16 digits, and a chain of
/// eight axes with the search behind it rounds some hundred times, which is a hundred times less.
pub const ALLOWANCE: f64 = 1e-6;

/// Largest coordinate of a body, mm.
pub const FARTHEST: f64 = 1e5;
