//! Cutter-location files, NC programs and the small languages of a machine file: text in, typed records out.
//!
//! A cutter-location file goes through [`ClReader`], which splits it into logical lines in one reused buffer.
//! A list of points, CSV or JSON, becomes the same records there.
//! The language is that of the pest grammar `line.pest`; a hand-written scanner gives the same for every usual line
//! and leaves the others to pest, which reads them or says what is wrong.
//! An NC program becomes blocks ([`nc`]).
//! The structural code of a machine ([`parse_chain`]), the expressions in its file ([`parse_expression`]), what must
//! hold between its axes ([`parse_inequality`]) and the lines
//! of a program that it has for words of the CL file ([`Template`]) have grammars of their own.

mod chain;
mod cl;
mod decimal;
mod expression;
mod fault;
mod inequality;
mod layout;
pub mod nc;
mod points;
mod template;
pub mod text;

pub use chain::{Link, LinkKind, parse_chain};
pub use cl::*;
pub use expression::{
    Bounds, EvaluationFault, Expression, FUNCTIONS, LinearForm, Slope, parse_expression,
};
pub use fault::{ReadError, SyntaxFault};
pub use inequality::{Inequality, parse_inequality};
pub use points::is_point_list;
pub use template::{FillFault, Template};

/// What tests look into; no part of the crate's face.
#[doc(hidden)]
pub mod internals {
    pub use crate::cl::foreign::kind;
    pub use crate::cl::line::is_free_text;
    pub use crate::cl::scan::{plain_goto, record};
}
