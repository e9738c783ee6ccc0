//! `post._native`: what the package `post` does in Rust. The Python half (`post/`) is what users see; it hands in arrays of
//! float64 in one piece, and dresses what comes back.

mod apart;
mod job;
mod machine;
mod options;
mod refusal;
mod study;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::apart::fail;
    #[pymodule_export]
    use super::job::{Job, job};
    #[pymodule_export]
    use super::machine::Machine;
    #[pymodule_export]
    use super::study::{Study, run_part};
}
