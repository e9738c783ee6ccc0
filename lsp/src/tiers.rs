//! What is found of a text: at once, and later in the background.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use super::background::{self, BackgroundFacts, Outlet, Token, WorkProduct};
use super::document::{Document, FileKind, Snapshot};
use super::machine::library::Library;
use super::{cl, findings, machine, nc};
use post_job::{machine_files, tools};

/// The machine that CL files and programs are shown on.
#[derive(Clone, Debug, Default)]
pub struct ShownMachine {
    /// Its name or file.
    pub machine: Option<String>,
    /// Length of every tool, mm.
    pub tool_length: Option<f64>,
}

/// A text and all that work on it needs.
struct Work {
    of: Arc<Snapshot>,
    /// The text is the one on the disk.
    saved: bool,
    slow: Arc<BackgroundFacts>,
    token: Token,
    library: Library,
    shown: ShownMachine,
    to: Outlet,
}

/// Finds out about a text: tells at once what takes no time, and begins the rest. Work on what it was is given up.
pub fn begin(document: &Document, library: &Library, shown: &ShownMachine, to: &Outlet) {
    let of = Arc::clone(&document.now);
    let token = document.slow.begin(of.version);
    let Some(kind) = document.kind() else {
        return;
    };
    if kind == FileKind::Machine {
        let found = machine::findings(&of, library);
        document.slow.fast(&of, findings::told(&found, &of), to);
    }
    let work = Work {
        of,
        saved: document.saved,
        slow: Arc::clone(&document.slow),
        token,
        library: library.clone(),
        shown: shown.clone(),
        to: to.clone(),
    };
    background::begin(move || match kind {
        FileKind::Machine => work.derive(),
        FileKind::Cl | FileKind::Points => work.post(),
        FileKind::Nc => work.read_back(),
    });
}

impl Work {
    fn tell(&self, found: &[Diagnostic], keep: WorkProduct) {
        let told = findings::told(found, &self.of);
        self.slow.later(&self.of, &self.token, told, keep, &self.to);
    }

    fn derive(&self) {
        if self.token.rested() {
            let found = machine::derived(&self.of, &self.library);
            if !found.is_empty() {
                self.tell(&found, WorkProduct::Nothing);
            }
        }
    }

    /// The machine of the settings; none, and why, if it cannot be loaded.
    fn machine(&self) -> Option<Result<Machine, Vec<Diagnostic>>> {
        let name = self.shown.machine.as_deref()?;
        let read = |path: &std::path::Path| self.library.read(path);
        let loaded = machine_files::source(name, &self.library.machines, &read)
            .and_then(|source| machine_files::examine(source, &self.library.machines, &[], &read))
            .map_err(post_job::failure::Failure::findings)
            .and_then(|reading| reading.machine)
            .and_then(|mut machine| {
                let equipped = tools::equip(&self.library.session, &mut machine);
                equipped.map(|()| machine).map_err(post_job::failure::Failure::findings)
            });
        Some(loaded)
    }

    fn post(&self) {
        // Posting says of words itself what becomes of them.
        let words = self.shown.machine.is_none();
        let Some(read) = cl::findings(&self.of, words, &self.token) else {
            return;
        };
        self.slow.fast(&self.of, findings::told(&read, &self.of), &self.to);
        if !self.token.rested() {
            return;
        }
        let machine = match self.machine() {
            None => return,
            Some(Err(faults)) => return self.tell(&faults, WorkProduct::Nothing),
            Some(Ok(machine)) => machine,
        };
        let length = self.shown.tool_length;
        match cl::post(&self.of, machine, length, &self.library, &self.token) {
            None => {}
            Some(Err(faults)) => self.tell(&faults, WorkProduct::Nothing),
            Some(Ok((posted, found))) => {
                // Lines that cannot be read were told.
                let more: Vec<Diagnostic> =
                    found.into_iter().filter(|finding| !read.contains(finding)).collect();
                self.tell(&more, WorkProduct::Posted(posted));
            }
        }
    }

    fn read_back(&self) {
        if !self.token.rested() {
            return;
        }
        let machine = match self.machine() {
            None => return,
            Some(Err(faults)) => return self.tell(&faults, WorkProduct::Nothing),
            Some(Ok(machine)) => machine,
        };
        let length = self.shown.tool_length;
        let control = match nc::control(machine, length, &self.library) {
            Ok(control) => control,
            Err(faults) => return self.tell(&faults, WorkProduct::Nothing),
        };
        let Some(read) = nc::read(&self.of, &control, &self.token) else {
            return;
        };
        match read {
            Err(faults) => return self.tell(&faults, WorkProduct::Nothing),
            Ok((program, found)) => self.tell(&found, WorkProduct::Program(program)),
        }
        if self.saved {
            // What cannot be read of it is told again.
            let found = nc::looked_over(&self.of, &control, &self.library, &self.token);
            self.tell(&found, WorkProduct::Nothing);
        }
    }
}
