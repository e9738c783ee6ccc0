//! A command line of `post`, run on the files in memory.

use std::ffi::OsString;
use std::io::Write as _;
use std::sync::{Arc, Mutex, PoisonError};

use post_cli::failure::CommandFault;
use post_cli::terminal;
use post_job::disk;
use post_job::files::{TextOutcomes, standard};
use post_job::session::{Bar, Face, Session};
use post_machine::diagnostic::{Diagnostic, Severity};
use serde::Serialize;

use crate::exports::lent;

/// What came of a command line.
#[derive(Serialize)]
pub struct Ran {
    /// With what the command ends: 0 good, 1 refused, 2 the command line is wrong.
    code: u8,
    /// What stands on standard output.
    printed: String,
    /// What else was said: on standard error, but for findings.
    said: String,
    /// What was found.
    findings: Vec<Finding>,
}

/// A finding.
#[derive(Serialize)]
struct Finding {
    /// `error` or `warning`.
    severity: &'static str,
    /// Its code, `over-travel`.
    code: &'static str,
    /// What, with the value and the limit.
    message: String,
    /// What would help.
    help: Option<String>,
    /// The file, as it was named.
    file: Option<String>,
    /// Line of the file, counted from 1.
    line: Option<u64>,
    /// All of it as a terminal shows it.
    shown: String,
}

impl From<&Diagnostic> for Finding {
    fn from(found: &Diagnostic) -> Self {
        Self {
            severity: match found.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            code: found.code,
            message: found.message.clone(),
            help: found.help.clone(),
            file: found.place.as_ref().map(|place| place.file.clone()),
            line: found.place.as_ref().map(|place| place.line),
            shown: terminal::plain(found),
        }
    }
}

/// A face that keeps findings, and tells how far reading has come.
struct Page {
    found: Arc<Mutex<Vec<Finding>>>,
}

impl Face for Page {
    fn findings(&self, findings: &[Diagnostic], _: &TextOutcomes) {
        // A list is whole whatever has died of it.
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.extend(findings.iter().map(Finding::from));
    }

    fn bar(&self, bytes: Option<u64>) -> Option<Box<dyn Bar>> {
        Some(Box::new(PageBar { of: bytes.map_or(-1.0, |bytes| bytes as f64) }))
    }

    fn owns_output(&self) -> bool {
        true
    }
}

struct PageBar {
    /// Bytes there are; below zero if nobody knows.
    of: f64,
}

impl Bar for PageBar {
    fn set(&self, position: u64) {
        lent::tell_progress(position as f64, self.of);
    }
}

/// Verbs that need what only a system has: threads, a clock, other programs, folders to be filled.
const OF_A_SYSTEM: [&[&str]; 6] =
    [&["batch"], &["lsp"], &["man"], &["plugin", "new"], &["plugin", "test"], &["view"]];

/// Why this command line cannot be run here.
fn fault(words: &[String]) -> Option<Diagnostic> {
    let begins = |verb: &&&[&str]| {
        verb.len() <= words.len() && verb.iter().eq(words.iter().take(verb.len()))
    };
    let verb = OF_A_SYSTEM.iter().find(begins)?.join(" ");
    let message =
        format!("post {verb} needs threads, files or programs of a system, and there is none here");
    Some(Diagnostic::error("option", message).help("it is done by the command post"))
}

/// Runs the command line of these words, `post` itself not among them.
pub fn run(words: &[String]) -> Ran {
    if let Some(fault) = fault(words) {
        let (printed, said) = Default::default();
        return Ran { code: 1, printed, said, findings: vec![Finding::from(&fault)] };
    }
    let found = Arc::default();
    let session = Session::new(Page { found: Arc::clone(&found) });
    let line: Vec<OsString> =
        std::iter::once("post").chain(words.iter().map(String::as_str)).map(Into::into).collect();
    let done = post_command::run_words(&session, &line);
    let code = done.as_ref().map_or_else(CommandFault::exit_code, |()| 0);
    match done {
        // Help and version are results.
        Err(CommandFault::Usage(fault)) if code == 0 => {
            terminal::print(&session, &fault.to_string());
        }
        Err(CommandFault::Usage(fault)) => {
            let _ = standard::errors().write_all(fault.to_string().as_bytes());
        }
        Err(CommandFault::Job(fault) | CommandFault::NotLooked(fault)) => {
            session.findings(&fault.findings());
        }
        Ok(()) => {}
    }
    let findings = std::mem::take(&mut *found.lock().unwrap_or_else(PoisonError::into_inner));
    let [printed, said] = [standard::OUTPUT, standard::ERRORS].map(taken);
    Ran { code, printed, said, findings }
}

/// A text that is fetched once.
fn taken(name: &str) -> String {
    if !cfg!(target_family = "wasm") {
        // What is printed is printed there.
        return String::new();
    }
    let text = disk::read(name).unwrap_or_default();
    // There may be none.
    let _ = disk::remove_file(name);
    String::from_utf8_lossy(&text).into_owned()
}
