//! `post._native`: what the package `post` does in Rust. The Python half (`post/`) is what users see; it hands in arrays of
//! float64 in one piece, and dresses what comes back.

mod apart;
mod machine;
mod refusal;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::machine::Machine;
}
