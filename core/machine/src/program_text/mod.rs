//! Program text of one's own: templates of the machine file, and the facts that they are filled with.
//!
//! The language is that of Jinja, less what a stranger's file could make work without end of: places `{{ … }}`, `if` and
//! `for` over lists of the facts. There is nothing to define, to include or to repeat; what is printed is a number or a
//! text of the facts, and what is not known is an error, never an empty place.

mod declared;
mod facts;
mod template;

pub use declared::DeclaredLines;
pub(crate) use declared::{plain, unnumbered};
pub use facts::{
    CompensationFacts, Extents, Facts, OperationFacts, PlaneFacts, ProgramFacts, SpindleFacts,
    ToolFacts,
};
pub use template::{TemplateFault, TextTemplate};
