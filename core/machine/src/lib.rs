//! A machine as its TOML file describes it.
//!
//! [`description`] reads the file, [`kinematics`] derives forward and inverse solutions from its chain,
//! [`axis_words`] turns axis values into the words of a block and back ([`word_map`]: words that are no axis values),
//! [`check`] derives what the machine's builder can compare, [`calibrate`] what readings of a ball say of its lines,
//! [`dependent_limit`] holds axes to limits that depend on other axes, [`axis_formula`] quantities that follow from several of them,
//! [`place`] says where a part can sit, and [`tilted_plane`] how a control is told a plane; [`face_mode`] what its axes do while it
//! interpolates in polar coordinates; [`wait_rule`] how its channels wait for one another. [`servo`] has the equations of the axes'
//! servos. [`diagnostic`] is how every storey of the core says what is wrong.
//! There is no input or output here, no unsafe code, no CL record and no dialect's name.

pub mod along_word;
pub mod axis_formula;
pub mod axis_words;
pub mod calibrate;
pub mod check;
pub mod dependent_limit;
pub mod description;
pub mod diagnostic;
pub mod face_mode;
mod halton;
pub mod kinematics;
pub mod part_anywhere;
pub mod place;
pub mod program_text;
pub mod servo;
pub mod tilted_plane;
pub mod vector_choice;
pub mod wait_rule;
pub mod word_map;
pub mod work_spindle;
pub mod wrap_mode;

/// What tests look into; no part of the crate's face.
#[doc(hidden)]
pub mod internals {
    pub use crate::description::smoothing::fits;
}
