//! What each dialect writes, word for word: one binary for all of them.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

mod brother;
mod fagor;
mod fanuc;
mod grbl;
mod haas;
mod heidenhain;
mod hurco;
mod interpreter;
mod isg;
mod linuxcnc;
mod list;
mod mazak;
mod mitsubishi;
mod models;
mod okuma;
mod order;
mod siemens;
mod syntec;
