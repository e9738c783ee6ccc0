//! Tests of the contract between the command and its plugins.

mod header;
