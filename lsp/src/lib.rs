//! The language server: what an editor is told of machine files, CL files and NC programs.
//!
//! | part | does |
//! |---|---|
//! | `transport` | messages over standard input and output |
//! | `embedded` | the server inside of another program: a message in, messages out |
//! | `server` | the loop: what the editor asks and tells, one message after the other |
//! | `announced` | what the server says it can do |
//! | `answers` | a question, and what is answered at once |
//! | `tiers` | what is found of a text at once, and later |
//! | `document`, `positions`, `uri` | texts that are open, their edits, places in UTF-16 |
//! | `findings` | findings of the core as the protocol has them |
//! | `fixes`, `offers` | what a click puts right, what is offered while a text is written |
//! | `background` | work that is slow, given up when its text is edited |
//! | `commands` | `post check` of a file, asked for by a click |
//! | `readings` | what the axes show |
//! | `machine`, `cl`, `nc` | what is told of each kind of file |
//!
//! The thread that answers never posts, reads back or derives: that is done in the background, and an answer says what
//! is known by then. What a key means comes from the schema, what a number is from the loader, what a line does from
//! posting and reading back: nothing here knows any of it a second time. Only standard input and output are spoken to,
//! in the Language Server Protocol.

mod announced;
mod answers;
mod background;
mod cl;
mod commands;
mod document;
mod embedded;
mod findings;
mod fixes;
mod machine;
mod nc;
mod offers;
mod positions;
mod readings;
mod server;
mod tiers;
mod transport;
mod uri;

use std::path::PathBuf;

use post_machine::diagnostic::Diagnostic;

use post_job::failure::Failure;
use post_job::session::Session;

pub use embedded::Embedded;

/// What the server is started with. What an editor sends later never names folders of plugins: a workspace may be a
/// stranger's.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The machine that CL files and programs are shown on, until the editor's settings name another.
    pub machine: Option<String>,
    /// Length of every tool, mm.
    pub tool_length: Option<f64>,
    /// Folders of machine files.
    pub machines: Vec<PathBuf>,
    /// Folders of plugin libraries.
    pub plugins: Vec<PathBuf>,
}

/// Serves an editor on standard input and output until it says that it ends.
///
/// # Errors
/// What comes in is no Language Server Protocol, or the streams fail.
pub fn serve(session: &Session, options: Options) -> Result<(), Failure> {
    let (connection, transport) = transport::open().map_err(|fault| failed(&fault.to_string()))?;
    let served = server::run(session, &connection, options);
    // The writing thread ends when nothing can be sent any more.
    drop(connection);
    transport.end().map_err(|fault| failed(&fault.to_string()))?;
    served.map_err(|fault| failed(&fault))
}

fn failed(fault: &str) -> Failure {
    Diagnostic::error("lsp", format!("the editor cannot be served: {fault}"))
        .help("post lsp is started by an editor, which speaks the Language Server Protocol on standard input and output")
        .into()
}
