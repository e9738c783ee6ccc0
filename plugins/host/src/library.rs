//! A library is opened, and what it exports becomes a plugin.

#![allow(unsafe_code)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use post_plugin::raw::PostPlugin;

use crate::call::{Caller, LoadedLibrary};
use crate::function::Function;
use crate::judge::judge;
use crate::leave::library_opened;
use crate::library_file::LibraryFile;
use crate::{Plugin, Reason};

/// The hash of each library that was opened, by where it lies. The system hands out a library that is open already
/// whatever its file has become since.
static OPENED: Mutex<BTreeMap<PathBuf, String>> = Mutex::new(BTreeMap::new());

fn opened() -> MutexGuard<'static, BTreeMap<PathBuf, String>> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The file at `path`, which must be a library with the plugin `name`, before any of its code runs.
pub(crate) fn looked(name: &str, path: &Path) -> Result<LibraryFile, Reason> {
    let symbol = symbol(name);
    LibraryFile::look(path, &symbol).map_err(|message| match message {
        Some(message) => system(message),
        None => Reason::NoSymbol { symbol },
    })
}

fn symbol(name: &str) -> String {
    format!("post_plugin_{name}")
}

fn system(message: String) -> Reason {
    Reason::Open { message }
}

/// Opens the library at `path`, which must hold the plugin `name`.
pub(crate) fn open_library(name: &str, path: &Path) -> Result<Plugin, Reason> {
    let symbol = symbol(name);
    let file = looked(name, path)?;
    let earlier = opened().get(&file.path).cloned();
    if earlier.is_some_and(|earlier| earlier != file.hash) {
        return Err(system("it is open already, and its file was changed since".to_owned()));
    }
    let loaded: &'static LoadedLibrary =
        Box::leak(Box::new(LoadedLibrary { name: name.to_owned(), path: path.to_owned() }));
    library_opened(loaded);
    let caller = Caller::new(Some(loaded));
    // SAFETY: the library's initialisers run; the user named this file as one to be run.
    let library = caller
        .call(Function::Opening, || unsafe { libloading::Library::new(file.path.as_os_str()) });
    let library = library.map_err(|error| system(error.to_string()))?;
    // SAFETY: only the symbol's address is taken here; what it leads to is judged below.
    let found = unsafe { library.get::<*const PostPlugin>(symbol.as_bytes()) };
    let found = found.ok().map(|found| *found);
    // A library is never closed again: its threads and thread-local destructors may still need its
    // code, so there is no sound way to unload it. What it exports therefore lives for ever.
    std::mem::forget(library);
    let Some(exported) = found else {
        return Err(Reason::NoSymbol { symbol });
    };
    opened().insert(file.path.clone(), file.hash.clone());
    file.look_again().map_err(system)?;
    if exported.is_null() || !exported.is_aligned() {
        return Err(Reason::NotAPlugin);
    }
    // SAFETY: not null, aligned and never unloaded. That the plugin keeps the contract is its
    // author's promise, made by the magic number.
    let described = unsafe { judge(exported, &caller) }?;
    if described.name != name {
        return Err(Reason::Nonsense { message: format!("it calls itself `{}`", described.name) });
    }
    // SAFETY: judged above.
    if let Some(loaded) = unsafe { (*exported).loaded } {
        caller.call(Function::Loaded, || unsafe { loaded() });
    }
    Ok(Plugin { library: Some(loaded), hash: Some(file.hash), ..described.into() })
}
