//! Tests of the machine: chain, kinematics both ways, machine file, and what is derived from it.

mod batch;
mod check;
mod freedom;
mod kinematics;
mod linuxcnc;
mod machine_file;
