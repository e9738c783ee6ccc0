//! Single files of the command, each by itself: they are compiled here once more, with the tests that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

#[path = "../../../src/deviations/curve.rs"]
mod curve;
#[path = "../../../src/deviations/edge.rs"]
mod edge;
#[path = "../../../src/deviations/statistics.rs"]
mod statistics;
#[path = "../../../src/study/sweep_values.rs"]
mod sweep_values;
#[path = "../../../src/curve/track.rs"]
mod track;
