//! Cutter-location files and the small languages of a machine file: text in, typed records out.

pub mod record;
