//! Work that is slow: on threads of its own, given up when its text is edited.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use gen_lsp_types::{Diagnostic as LspDiagnostic, PublishDiagnosticsParams};
use lsp_server::{Message, Notification};
use post_machine::diagnostic::Diagnostic;

use super::cl::Posted;
use super::document::Snapshot;
use super::nc::InterpretedProgram;

/// How long a text rests before slow work on it begins: a key is pressed more often.
const REST: Duration = Duration::from_millis(250);

/// How often a thread that waits looks whether it is given up.
const LOOK: Duration = Duration::from_millis(10);

const WANTED: u8 = 0;
const EDITED: u8 = 1;
const CANCELLED: u8 = 2;
const DONE: u8 = 3;

/// Whether work is given up.
#[derive(Clone, Debug, Default)]
pub struct Token {
    state: Arc<AtomicU8>,
}

impl Token {
    /// The text is another one by now.
    pub fn give_up(&self) {
        self.state.store(EDITED, Ordering::Relaxed);
    }

    /// The editor takes its question back.
    pub fn cancel(&self) {
        self.state.store(CANCELLED, Ordering::Relaxed);
    }

    /// Nobody wants the answer any more.
    pub fn is_given_up(&self) -> bool {
        self.state.load(Ordering::Relaxed) != WANTED
    }

    /// The work is done.
    pub fn done(&self) {
        self.state.store(DONE, Ordering::Relaxed);
    }

    /// Whether it is.
    pub fn is_done(&self) -> bool {
        self.state.load(Ordering::Relaxed) == DONE
    }

    /// It was the editor that took its question back.
    pub fn is_cancelled(&self) -> bool {
        self.state.load(Ordering::Relaxed) == CANCELLED
    }

    /// Waits until the text has rested; false if the work is given up before.
    pub fn rested(&self) -> bool {
        if cfg!(target_family = "wasm") {
            // Whoever asks for the work has let it rest.
            return !self.is_given_up();
        }
        let begin = Instant::now();
        while begin.elapsed() < REST {
            if self.is_given_up() {
                return false;
            }
            thread::sleep(LOOK);
        }
        !self.is_given_up()
    }
}

/// Begins work on a thread of its own; where there are none it waits until [`work`] is called.
#[cfg(not(target_family = "wasm"))]
pub fn begin(work: impl FnOnce() + Send + 'static) {
    thread::spawn(work);
}

/// Work that waits.
#[cfg(target_family = "wasm")]
static WAITING: Mutex<std::collections::VecDeque<Box<dyn FnOnce() + Send>>> =
    Mutex::new(std::collections::VecDeque::new());

/// Work that waits until [`work`] is called.
#[cfg(target_family = "wasm")]
pub fn begin(work: impl FnOnce() + Send + 'static) {
    WAITING.lock().unwrap_or_else(PoisonError::into_inner).push_back(Box::new(work));
}

/// Does all work that waits: none, where threads do it.
pub fn work() {
    #[cfg(target_family = "wasm")]
    loop {
        let next = WAITING.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
        let Some(work) = next else {
            return;
        };
        work();
    }
}

/// What slow work has found out about a text.
#[derive(Default)]
pub struct TextFacts {
    /// The version of the text that it is about.
    version: Option<i32>,
    /// What is told of it at once.
    fast: Vec<LspDiagnostic>,
    /// What posting a CL file said of each of its lines.
    posted: Option<Arc<Posted>>,
    /// What reading a program back said of each of its lines.
    program: Option<Arc<InterpretedProgram>>,
    /// The work on it.
    token: Token,
}

/// What is known of a text beside the text itself. What is sent about one version is sent while this is locked, so that
/// nothing old follows what is new.
#[derive(Default)]
pub struct BackgroundFacts {
    known: Mutex<TextFacts>,
}

impl BackgroundFacts {
    fn lock(&self) -> MutexGuard<'_, TextFacts> {
        // What is in it is whole whatever a thread died of.
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A new version of the text: work on the old one is given up. Returns what the new work is given up by.
    pub fn begin(&self, version: i32) -> Token {
        let mut known = self.lock();
        known.token.give_up();
        *known = TextFacts { version: Some(version), ..TextFacts::default() };
        known.token.clone()
    }

    /// The text is closed: nothing more is said of it but that nothing is wrong.
    pub fn close(&self, of: &Snapshot, to: &Outlet) {
        self.lock().token.give_up();
        to.publish(of, Vec::new());
    }

    /// What posting said, if that is done.
    pub fn posted(&self) -> Option<Arc<Posted>> {
        self.lock().posted.clone()
    }

    /// What reading back said, if that is done.
    pub fn program(&self) -> Option<Arc<InterpretedProgram>> {
        self.lock().program.clone()
    }

    /// Tells what was found at once.
    pub fn fast(&self, of: &Snapshot, found: Vec<LspDiagnostic>, to: &Outlet) {
        let mut known = self.lock();
        if known.version == Some(of.version) {
            known.fast.clone_from(&found);
            to.publish(of, found);
        }
    }

    /// Tells what was found later, behind what was found at once, and keeps what `keep` puts away.
    pub fn later(
        &self,
        of: &Snapshot,
        token: &Token,
        found: Vec<LspDiagnostic>,
        keep: WorkProduct,
        to: &Outlet,
    ) {
        let mut known = self.lock();
        if token.is_given_up() || known.version != Some(of.version) {
            return;
        }
        match keep {
            WorkProduct::Nothing => {}
            WorkProduct::Posted(posted) => known.posted = Some(Arc::new(posted)),
            WorkProduct::Program(program) => known.program = Some(Arc::new(program)),
        }
        let mut all = known.fast.clone();
        all.extend(found);
        to.publish(of, all);
    }
}

/// What slow work on a machine comes to: what it found out, and what is told beside it; or why it cannot be done. None if
/// it was given up.
pub type WorkResult<T> = Option<Result<(T, Vec<Diagnostic>), Vec<Diagnostic>>>;

/// What is kept of slow work.
pub enum WorkProduct {
    /// Nothing.
    Nothing,
    /// What posting said of each line.
    Posted(Posted),
    /// What reading back said of each line.
    Program(InterpretedProgram),
}

/// Where messages to the editor go.
#[derive(Clone)]
pub struct Outlet {
    send: Arc<dyn Fn(Message) + Send + Sync>,
}

impl Outlet {
    /// Through `send`.
    pub fn new(send: impl Fn(Message) + Send + Sync + 'static) -> Self {
        Self { send: Arc::new(send) }
    }

    /// Sends a message; an editor that is gone hears nothing.
    pub fn send(&self, message: impl Into<Message>) {
        (self.send)(message.into());
    }

    fn publish(&self, of: &Snapshot, diagnostics: Vec<LspDiagnostic>) {
        let params = PublishDiagnosticsParams {
            uri: of.uri.clone(),
            version: Some(of.version),
            diagnostics,
        };
        self.send(Notification::new("textDocument/publishDiagnostics".to_owned(), params));
    }
}
