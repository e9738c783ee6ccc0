//! The contract between `post` and its plugins.
//!
//! `post` turns the cutter-location file of a CAM system into the NC program of one machine. What the program says is
//! worked out and certified by the host; how a control is told so is a *dialect*, and how far a move's tool leaves its
//! chord is judged by an *error model*. Both are plugins: shared libraries that the host opens by name. An author
//! implements [`Dialect`] or [`ErrorModel`] and writes one export line; everything else here is what those traits speak
//! of. Nothing in this crate depends on another crate.
//!
//! # A dialect
//!
//! A library crate called `post_<name>` with `crate-type = ["cdylib", "rlib"]`, and a type that writes the text of each
//! event. This one rapids and cuts on three axes; what else it is sent it refuses, never drops:
//!
//! ```
//! use post_plugin::{Dialect, Event, Feed, Format, Setup, fixed, remark};
//!
//! struct Writer {
//!     names: Vec<String>,
//! }
//!
//! impl Dialect for Writer {
//!     fn open(setup: &Setup<'_>) -> Result<Self, String> {
//!         if setup.tcp {
//!             return Err("this control does not keep the tip: tcp = \"post\"".to_owned());
//!         }
//!         let names = setup.words.iter().map(|word| word.name.to_owned());
//!         Ok(Writer { names: names.collect() })
//!     }
//!
//!     fn format(&self) -> Format {
//!         Format {
//!             words: vec![3; self.names.len()],
//!             feed: 1,
//!             extension: "nc".to_owned(),
//!             ..Format::default()
//!         }
//!     }
//!
//!     fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
//!         match *event {
//!             Event::Start => out.push_str("G21 G90 G94"),
//!             Event::Comment { text } => out.push_str(&remark(text)),
//!             Event::Rapid { words, .. } => self.go("G0", words, out),
//!             Event::Linear { words, feed: Feed::PerMinute(feed), .. } => {
//!                 self.go("G1", words, out);
//!                 out.push_str(" F");
//!                 fixed(out, feed, 1);
//!             }
//!             Event::End => out.push_str("M30"),
//!             other => return Err(other.refusal()),
//!         }
//!         out.push('\n');
//!         Ok(())
//!     }
//! }
//!
//! impl Writer {
//!     fn go(&self, motion: &str, words: &[f64], out: &mut String) {
//!         out.push_str(motion);
//!         for (name, word) in self.names.iter().zip(words) {
//!             out.push(' ');
//!             out.push_str(name);
//!             fixed(out, *word, 3);
//!         }
//!     }
//! }
//! ```
//!
//! The crate `post_mine` exports it as the plugin `mine`:
//!
//! ```ignore
//! post_plugin::export_dialect!(mine, Writer);
//! ```
//!
//! `post plugin new NAME --rust` writes a whole one that builds as it stands, `post plugin test` holds the text of any
//! library against every event that it is sent, number by number.
//!
//! # What a dialect is sent
//!
//! [`Event`] is one step of a program; [`EVENTS`] is the same as a table. All dialects are sent the kinds up to
//! [`Event::Word`]; the others go to those that declare them ([`Dialect::capabilities`], [`Event::sent_under`]), and the
//! host turns what is not declared into straight moves, or refuses it by name. [`Setup`] says what is known at the
//! opening: axis words, units, options, tools. [`Dialect::vocabulary`] tells what the words mean, and [`Format::language`]
//! what stands around them, so that a program can be read back.
//!
//! # Helpers
//!
//! [`Block`] makes lines of words and numbers them, [`Modal`] is a value that holds, [`Axes`] writes the words that
//! have changed, [`AxisNames`] says which names a control can write; [`ArmWords`] and [`ArmLanguage`] are what robots'
//! languages have in common; [`fixed`] prints a number to so many decimals and
//! [`quantise`] rounds as it does; [`Standstill`] knows when spindle and coolant are to be on again after a stop;
//! [`remark`], [`ascii`] and [`wrapped`] make text safe.
//!
//! # Other languages
//!
//! [`raw`] is the contract in C, [`raw::HEADER`] its header. A library exports one constant, which is judged before any
//! of its functions runs.

mod arm;
mod axis_names;
mod batch;
mod block;
mod capabilities;
mod command;
mod cuts;
mod deviation;
mod dialect;
mod drilling;
mod event;
#[doc(hidden)]
pub mod export;
mod field;
mod flat;
mod language;
mod model;
mod number;
mod plane;
pub mod raw;
mod setup;
mod standstill;
mod text;
mod vocabulary;

pub use arm::{ARM_AXES, ARM_JOINTS, ArmLanguage, ArmWords, arm_axis, identifier};
pub use axis_names::AxisNames;
pub use batch::Batch;
pub use block::{Axes, Block, CutLine, Group, Modal, NumberStyle};
pub use capabilities::{CAPABILITIES, Capabilities, CapabilitySpec};
pub use command::{CODES, Compensation, Coolant, Cycle, Feed, Spindle, SpindleSense};
pub use cuts::{Columns, CutRun};
pub use deviation::{ask, length};
pub use dialect::{Dialect, DialectSession, Format, WriteFault};
pub use drilling::Drilling;
pub use event::{EVENTS, Event, EventSpec, FieldSpec};
pub use export::{Linked, LinkedDialect};
pub use field::{Codes, FieldShape, List, Promise, ToolPose};
pub use language::{Language, Lengths};
pub use model::{Curve, Deviation, ErrorModel, ModelSession, Tolerance};
pub use number::{fixed, fixed_text, quantise};
pub use plane::PlaneAngles;
pub use setup::{
    Accuracy, Ahead, AxisWord, Kinematics, OptionKind, OptionSpec, Setup, Tool, Units, Value,
};
pub use standstill::Standstill;
pub use text::{ascii, remark, wrapped};
pub use vocabulary::{AxisWords, Meaning, VocabularyWord};

/// What tests look into; no part of the contract.
#[doc(hidden)]
pub mod internals {
    pub use crate::deviation::peak;
}
