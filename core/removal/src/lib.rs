//! What is left of a stock while a program cuts it, between two bounds.
//!
//! | part | holds |
//! |---|---|
//! | [`profile`] | a tool as a body of revolution, and where a line is inside of it |
//! | [`rays`] | what is left along the prisms of a grid in one direction |
//! | [`field`] | prisms along X, Y and Z: what may be left, and what certainly is |
//! | [`chip`] | what a cut takes, and how deep and wide it goes |
//! | [`mesh`] | a stock from a closed mesh |
//! | [`near`] | how far a body is from what may be left |
//! | [`surface`] | the surface of what may be left, as triangles |
//! | [`compare`] | what is left against the part that is wanted |
//! | [`been`] | where a tool has been: what it need not be held against |
//! | [`along`] | all of this along the ways of a machine |
//!
//! What certainly is removed is removed from the upper bound, what may be touched is removed from the lower one. A prism
//! of the upper bound loses the stretch on which the lines through all four corners of its section are inside of the tool,
//! or inside of what a convex part of it sweeps on a straight way: what is between four lines is inside of a convex body if
//! they are. What may be left is what all three directions agree on, so that faces across X, Y and Z are as exact as their
//! numbers, and others are known to within the section of a prism. Memory hangs on the section and not on the program.
//!
//! A field of its own, because the bounds are the point: `cutrail` 0.1 keeps the stock as a mesh and subtracts hulls of
//! swept tools within a chord tolerance, which may remove more than was cut and grows with the program, and knows end mills
//! alone. Simulations by dexels and voxels (van Hook 1986; Inui and others 2020; Joy 2017) sample the surface and say
//! nothing of what is between samples. `fidget` evaluates implicit surfaces, whose sum over a program grows with it, and
//! `parry` voxelises a mesh without a bound.

pub mod along;
pub mod been;
pub mod chip;
pub mod compare;
pub mod field;
pub mod mesh;
pub mod near;
pub mod profile;
pub mod rays;
pub mod surface;
mod sweep;
