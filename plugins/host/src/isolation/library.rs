//! A library that is open in processes of its own.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::Limits;
use super::message::Description;
use super::process::Process;
use crate::call::LoadedLibrary;
use crate::described::FunctionTable;
use crate::function::Function;
use crate::judge::{judge_name, judge_options};
use crate::library_file::LibraryFile;
use crate::shown::sentence;
use crate::{Plugin, PluginFault, PluginKind, Reason};

/// Processes that wait for the next program, at most.
const MOST_IDLE: usize = 8;

/// A library, and its processes that nobody uses now.
#[derive(Debug)]
pub(crate) struct IsolatedLibrary {
    pub(crate) kind: PluginKind,
    name: String,
    path: PathBuf,
    hash: String,
    limits: Limits,
    idle: Mutex<Vec<Process>>,
    /// The sentence of its first `close` that failed.
    unclosed: Mutex<Option<String>>,
}

/// Opens the library whose file was looked at.
pub(crate) fn open(
    name: &str,
    path: &Path,
    file: LibraryFile,
    limits: Limits,
) -> Result<Plugin, Reason> {
    let (process, told) = started(name, &file.path, limits)?;
    let unchanged = match told.hash == file.hash {
        true => file.look_again(),
        false => Err("its file was changed while it was opened".to_owned()),
    };
    unchanged.map_err(|message| Reason::Open { message })?;
    let version = judge_name("version", &told.version)?.to_owned();
    let about = sentence(&told.about);
    let options = judge_options(told.options.into_iter().map(Ok).collect())?;
    let kind = match told.is_model {
        true => PluginKind::ErrorModel,
        false => PluginKind::Dialect,
    };
    let library = IsolatedLibrary {
        kind,
        name: name.to_owned(),
        path: file.path.clone(),
        hash: file.hash.clone(),
        limits,
        idle: Mutex::new(vec![process]),
        unclosed: Mutex::default(),
    };
    let loaded = LoadedLibrary { name: name.to_owned(), path: path.to_owned() };
    Ok(Plugin {
        name: name.to_owned(),
        version,
        about,
        table: FunctionTable::Isolated(Arc::new(library)),
        linked: None,
        library: Some(Box::leak(Box::new(loaded))),
        hash: Some(file.hash),
        options,
    })
}

/// A process that has opened the library, and what that is.
fn started(name: &str, path: &Path, limits: Limits) -> Result<(Process, Description), Reason> {
    let mut process = Process::start(name, path, limits)
        .map_err(|error| Reason::NoProcess { message: error.to_string() })?;
    let mut left = limits.call;
    let told: Result<Result<Description, Reason>, String> =
        process.answer(Function::Opening, &mut left);
    let told = told.map_err(|message| Reason::Nonsense { message })??;
    Ok((process, told))
}

impl IsolatedLibrary {
    /// A process that serves nobody.
    pub(crate) fn process(&self) -> Result<Process, Reason> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        if let Some(process) = idle {
            return Ok(process);
        }
        let (process, told) = started(&self.name, &self.path, self.limits)?;
        if told.hash != self.hash {
            let message = "it is open already, and its file was changed since".to_owned();
            return Err(Reason::Open { message });
        }
        Ok(process)
    }

    /// Has a process close what it has open, for the next program. After a `close` that failed nobody is asked again: a
    /// process ends as well, and a plugin that does not return is waited for once.
    pub(crate) fn close(&self, mut process: Process) {
        if !process.is_alive() || self.unclosed().is_some() {
            return;
        }
        match process.close() {
            Ok(()) => self.take_back(process),
            Err(message) => {
                self.unclosed().get_or_insert(message);
            }
        }
    }

    fn unclosed(&self) -> MutexGuard<'_, Option<String>> {
        self.unclosed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What its first `close` failed of, if one did.
    pub(crate) fn close_fault(&self) -> Option<PluginFault> {
        let message = self.unclosed().clone()?;
        let (plugin, path) = (self.name.clone(), Some(self.path.clone()));
        Some(PluginFault { plugin, path, reason: Reason::Nonsense { message } })
    }

    /// Takes a process back, for the next program.
    fn take_back(&self, process: Process) {
        let mut idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner);
        if idle.len() < MOST_IDLE {
            idle.push(process);
        }
    }

    pub(crate) fn limits(&self) -> Limits {
        self.limits
    }
}
