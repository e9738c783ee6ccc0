//! The files that a run reads: none of them is written to.

use std::path::Path;

use super::file_id::FileId;

/// One of them, and what it is to the user: `the CL file part.cls`.
struct ReadFile {
    id: FileId,
    what: String,
}

/// Those of the whole run, so that no job can forget one.
#[derive(Default)]
pub struct ReadFiles(Vec<ReadFile>);

impl ReadFiles {
    /// Says that `path` is read, as `kind`: `the CL file`.
    pub fn note(&mut self, kind: &str, path: &Path) {
        // What cannot be looked up cannot be read either, and that is said elsewhere.
        if let Ok(id) = FileId::of(path) {
            self.note_id(id, format!("{kind} {}", path.display()));
        }
    }

    /// Says that the file `id` is read, and what it is to the user.
    pub fn note_id(&mut self, id: FileId, what: String) {
        if self.0.iter().all(|read| read.id != id) {
            self.0.push(ReadFile { id, what });
        }
    }

    /// Says that a run may load a plugin from any library in `folder`.
    pub fn note_libraries(&mut self, folder: &Path) {
        let libraries = folder.read_dir().into_iter().flatten().flatten();
        for path in libraries.map(|entry| entry.path()) {
            let name = path.as_os_str().as_encoded_bytes();
            if name.ends_with(std::env::consts::DLL_SUFFIX.as_bytes()) {
                self.note("the plugin", &path);
            }
        }
    }

    /// What the file `id` is, if the run reads it.
    pub fn what(&self, id: &FileId) -> Option<String> {
        let found = self.0.iter().find(|read| read.id == *id)?;
        Some(found.what.clone())
    }
}
