//! Tests of posting: from CL text to the events that a dialect is asked to write.

mod accuracy;
mod certificate;
mod path;
mod program;
mod route;
