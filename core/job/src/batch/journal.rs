//! Outcomes in a file that only grows, a line of JSON each: a run that was killed goes on where it was.

use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::outcome::{FAILED, JobOutcome};
use crate::disk::{self, File, MOST_TABLE, OpenOptions};
use crate::files::FileFault;

fn no_journal() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "this is no journal of post batch")
}

/// Outcomes by their keys, on the disk as soon as they are there.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    known: BTreeMap<String, JobOutcome>,
    /// Opened at the first line that is added.
    file: Mutex<Option<File>>,
}

impl Journal {
    /// The journal in the file `path`; what it holds is taken from it if `resume` says so, and stays there in any case. A
    /// line that is not whole, as of a run that was killed, is passed over.
    ///
    /// # Errors
    /// It cannot be read, or is a file of another kind, to which nothing is added.
    pub fn open(path: &Path, resume: bool) -> Result<Self, FileFault> {
        let mut known = BTreeMap::new();
        let fault = |error| FileFault::read(path, error);
        match disk::open(path) {
            Ok(file) => {
                let mut lines = BufReader::new(file);
                let mut line = Vec::new();
                // A whole line that is no outcome shows a file of another kind, unless outcomes stand in it too.
                let mut other = false;
                let mut read = 0;
                loop {
                    let piece = &mut (&mut lines).take(MOST_TABLE + 1);
                    read += piece.read_until(b'\n', &mut line).map_err(fault)? as u64;
                    if line.is_empty() {
                        break;
                    }
                    // One outcome, or what holds none from its beginning on.
                    if line.len() as u64 > MOST_TABLE || known.is_empty() && read > MOST_TABLE {
                        return Err(fault(no_journal()));
                    }
                    match serde_json::from_slice::<JobOutcome>(&line) {
                        Ok(outcome) if outcome.key.is_some() => {
                            known.extend(outcome.key.clone().map(|key| (key, outcome)));
                        }
                        _ => other |= !line.starts_with(b"{\"") || line.ends_with(b"\n"),
                    }
                    line.clear();
                }
                if other && known.is_empty() {
                    return Err(fault(no_journal()));
                }
                if !resume {
                    known.clear();
                }
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(fault(error)),
        }
        Ok(Self { path: path.to_owned(), known, file: Mutex::default() })
    }

    /// What came of the job with that key.
    pub fn known(&self, key: &str) -> Option<JobOutcome> {
        self.known.get(key).cloned()
    }

    /// Adds an outcome. What has no key is not kept, nor what failed: it may go well next time.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn add(&self, outcome: &JobOutcome) -> Result<(), FileFault> {
        if outcome.key.is_none() || outcome.state() == FAILED {
            return Ok(());
        }
        let mut line = crate::files::json_line(outcome);
        line.push('\n');
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let name = self.path.display().to_string();
        let fault = |error| FileFault::write_named(&name, error);
        let open = match file.take() {
            Some(open) => open,
            None => self.append().map_err(fault)?,
        };
        // In one call: other runs may add to the same file.
        let written = (&open).write_all(line.as_bytes());
        *file = Some(open);
        written.map_err(fault)
    }

    /// Opens the file for more lines, after the end of one that is not whole.
    fn append(&self) -> io::Result<File> {
        let options = || {
            let mut options = OpenOptions::new();
            options.create(true).append(true).read(true);
            options
        };
        let mut file = options().open(&self.path)?;
        if file.seek(SeekFrom::End(0))? > 0 {
            file.seek(SeekFrom::End(-1))?;
            let mut last = [0];
            file.read_exact(&mut last)?;
            if last != *b"\n" {
                file.write_all(b"\n")?;
            }
        }
        Ok(file)
    }
}
