//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, unused_imports, reason = "tests do not use all of a file")]

mod b_spline;
mod bounds;
mod fourier;
mod limits;
mod measured;

#[path = "../../../src/contour/axes.rs"]
mod axes;
#[path = "../../../src/servo/discrete.rs"]
mod discrete;
#[path = "../../../src/servo/linear.rs"]
mod linear;
#[path = "../../../src/contour/path/mod.rs"]
mod path;
#[path = "../../../src/contour/spline.rs"]
mod spline;
#[path = "../../../src/contour/spread.rs"]
mod spread;

// As `linear` names it.
use post_motion::servo::ServoOutput;
