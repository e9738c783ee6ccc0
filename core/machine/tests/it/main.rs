//! Tests of the machine: chain, kinematics both ways, machine file, and what is derived from it.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod batch;
mod chains;
mod check;
mod declared;
mod dependent_limit;
mod derivatives;
mod errors;
mod formulas;
mod freedom;
mod kept_tip;
mod kinematics;
mod legs;
mod linuxcnc;
mod machine_file;
mod place;
mod servo;
mod tilted_plane;
mod turned;
mod units;

use post_machine::description::Source;

/// A machine file that is nowhere but here.
fn source(name: &str, text: &str) -> Source {
    Source { name: name.to_owned(), text: text.to_owned() }
}
