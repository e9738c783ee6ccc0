//! The files that a run reads: none of them is written to.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::file_id::FileId;

/// One of them, and what it is to the user: `the CL file part.cls`.
struct ReadFile {
    id: FileId,
    what: String,
}

/// Of the whole run, so that no verb can forget one.
static READ: Mutex<Vec<ReadFile>> = Mutex::new(Vec::new());

fn all() -> MutexGuard<'static, Vec<ReadFile>> {
    // A list is whole whatever a thread died of.
    READ.lock().unwrap_or_else(PoisonError::into_inner)
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
    let mut all = all();
    if all.iter().all(|read| read.id != id) {
        all.push(ReadFile { id, what });
    }
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
    let all = all();
    let found = all.iter().find(|read| read.id == *id)?;
    Some(found.what.clone())
}
