//! What the user sees: results on standard output; questions, progress and messages on standard error.

mod findings;
#[cfg(not(target_family = "wasm"))]
mod progress;
#[cfg(target_family = "wasm")]
#[path = "no_progress.rs"]
mod progress;

use std::borrow::Cow;
use std::io::{self, IsTerminal as _, Write as _};

use post_grammar::text::escaped;
use post_machine::diagnostic::Diagnostic;

pub use findings::plain;
pub use progress::JobsProgress;

use crate::failure::CommandFault;
use post_job::failure::Failure;
use post_job::files::{FileFault, TextOutcomes, standard};
use post_job::session::{Bar, Face, Session};

/// Lines of text in which names and texts from files, plugins and the command line cannot switch the terminal: what it
/// would obey is written as an escape.
fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, &['\n', '\t'])
}

/// The face of the command: findings and bars go to standard error.
pub struct Terminal;

impl Face for Terminal {
    fn findings(&self, findings: &[Diagnostic], texts: &TextOutcomes) {
        findings::findings(findings, texts);
    }

    fn bar(&self, bytes: Option<u64>) -> Option<Box<dyn Bar>> {
        io::stderr().is_terminal().then(|| Box::new(progress::bytes(bytes)) as Box<dyn Bar>)
    }

    fn owns_output(&self) -> bool {
        true
    }
}

/// Prints a result to standard output. A reader that has seen enough closes the pipe; any other fault is told by
/// `all_printed` at the end.
pub fn print(session: &Session, text: &str) {
    // Whoever writes a file has been refused before that.
    if standard::is_read(session).is_some() {
        return;
    }
    let printed = standard::open().and_then(|mut out| {
        out.write_all(printable(text).as_bytes())?;
        out.flush()
    });
    match printed {
        Ok(()) => session.texts().note_printed(),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {}
        Err(error) => {
            session.texts().unprinted.get_or_insert(error);
        }
    }
}

/// Prints a result beside texts that were written: to standard error if one of them has `taken` standard output, alone there.
pub fn print_beside(session: &Session, text: &str, taken: bool) {
    match taken {
        true => tell(text),
        false => print(session, text),
    }
}

/// All results were printed.
pub fn all_printed(session: &Session) -> Result<(), Failure> {
    if let Some(read) = standard::is_read(session) {
        return Err(FileFault::PrintedOverRead(read).into());
    }
    let unprinted = session.texts().unprinted.take();
    match unprinted {
        Some(error) => Err(FileFault::write_named("standard output", error).into()),
        None => Ok(()),
    }
}

/// Prints what is no result to standard error, such as questions; a closed one leaves nobody to tell.
pub fn tell(text: &str) {
    let mut stderr = standard::errors();
    let _ = stderr.write_all(printable(text).as_bytes());
    let _ = stderr.flush();
}

/// Says why the command failed, and what it ends with. Help that could not be printed is a failure of its own.
pub fn explain(session: &Session, fault: CommandFault) -> u8 {
    let code = fault.exit_code();
    match fault {
        CommandFault::Usage(error) => {
            let plain = error.render().to_string();
            match printable(&plain) {
                // Colours are the terminal's own here.
                Cow::Borrowed(_) => match error.print() {
                    Err(fault)
                        if !error.use_stderr() && fault.kind() != io::ErrorKind::BrokenPipe =>
                    {
                        let fault = FileFault::write_named("standard output", fault);
                        return explain(session, CommandFault::Job(fault.into()));
                    }
                    _ => {}
                },
                Cow::Owned(legible) => tell(&legible),
            }
        }
        CommandFault::Job(Failure::Different) => {}
        CommandFault::Job(failure) | CommandFault::NotLooked(failure) => {
            session.findings(&failure.findings());
        }
    }
    code
}
