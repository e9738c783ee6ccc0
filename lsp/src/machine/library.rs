//! Where machines come from while files are open.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use post_machine::description::Source;

use crate::document::Snapshot;
use post_job::machine_files::{self, Missing};
use post_job::session::Session;

/// Folders of machines and plugins, and the texts that are open.
#[derive(Clone)]
pub struct Library {
    /// The run that serves the editor.
    pub session: Session,
    /// Folders of machine files, as the command line names them.
    pub machines: Vec<PathBuf>,
    /// Folders of plugin libraries, as the command line names them.
    pub plugins: Vec<PathBuf>,
    /// The texts that are open, by their paths.
    pub open: BTreeMap<PathBuf, Arc<Snapshot>>,
}

impl Library {
    /// The text of a machine file: as it is open, else from the disk.
    pub fn read(&self, path: &Path) -> Result<Source, Missing> {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        match self.open.get(&absolute) {
            Some(open) => Ok(Source { name: path.display().to_string(), text: open.text.clone() }),
            None => machine_files::read(&self.session, path),
        }
    }

    /// The machine that the file `child` extends by the name `parent`.
    pub fn parent(&self, child: &str, parent: &str) -> Option<Source> {
        machine_files::parent(child, parent, &self.machines, &|path| self.read(path)).ok()
    }

    /// Bare names of machines that the file `beside` may extend, and their files.
    pub fn names(&self, beside: &str) -> Vec<(String, Option<PathBuf>)> {
        machine_files::known(beside, &self.machines)
    }
}
