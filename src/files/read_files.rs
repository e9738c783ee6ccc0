//! The files that a run reads: none of them is written to.

use std::cell::RefCell;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::file_id::FileId;

/// One of them, and what it is to the user: `the CL file part.cls`.
struct ReadFile {
    id: FileId,
    what: String,
}

/// Of the whole run, so that no verb can forget one.
static READ: Mutex<Vec<ReadFile>> = Mutex::new(Vec::new());

thread_local! {
    /// Those of the job that this thread does by itself; none of a thread of the run.
    static APART: RefCell<Option<Vec<ReadFile>>> = const { RefCell::new(None) };
}

/// Puts back what was there, whatever becomes of the job.
struct Before(Option<Vec<ReadFile>>);

impl Drop for Before {
    fn drop(&mut self) {
        APART.replace(self.0.take());
    }
}

/// Does a job by itself, inside another program: what it reads, no other job minds.
pub fn apart<T>(job: impl FnOnce() -> T) -> T {
    let _before = Before(APART.replace(Some(Vec::new())));
    job()
}

/// The job of this thread is done by itself.
pub fn is_apart() -> bool {
    APART.with_borrow(Option::is_some)
}

/// Does something with the files that are read.
fn with_all<T>(take: impl FnOnce(&mut Vec<ReadFile>) -> T) -> T {
    APART.with_borrow_mut(|apart| match apart {
        Some(own) => take(own),
        // A list is whole whatever a thread died of.
        None => take(&mut READ.lock().unwrap_or_else(PoisonError::into_inner)),
    })
}

/// Says that `path` is read, as `kind`: `the CL file`.
pub fn note(kind: &str, path: &Path) {
    // What cannot be looked up cannot be read either, and that is said elsewhere.
    if let Ok(id) = FileId::of(path) {
        note_id(id, format!("{kind} {}", path.display()));
    }
}

/// Says that the file `id` is read, and what it is to the user.
pub fn note_id(id: FileId, what: String) {
    with_all(|all| {
        if all.iter().all(|read| read.id != id) {
            all.push(ReadFile { id, what });
        }
    });
}

/// Says that a run may load a plugin from any library in `folder`.
pub fn note_libraries(folder: &Path) {
    let libraries = folder.read_dir().into_iter().flatten().flatten();
    for path in libraries.map(|entry| entry.path()) {
        let name = path.as_os_str().as_encoded_bytes();
        if name.ends_with(std::env::consts::DLL_SUFFIX.as_bytes()) {
            note("the plugin", &path);
        }
    }
}

/// What the file `id` is, if the run reads it.
pub fn what(id: &FileId) -> Option<String> {
    with_all(|all| {
        let found = all.iter().find(|read| read.id == *id)?;
        Some(found.what.clone())
    })
}
