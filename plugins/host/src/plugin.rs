//! A plugin: linked in or opened from a file, and checked before anything of it is used.

#![allow(unsafe_code)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use post_plugin::raw::PostPlugin;
use post_plugin::{Linked, OptionSpec};

use crate::call::{Caller, LoadedLibrary};
use crate::described::{Described, FunctionTable, is_name};
use crate::judge::judge;
use crate::leave::library_opened;
use crate::library_file::LibraryFile;
use crate::{PluginFault, Reason};

/// A checked plugin. Cheap to clone; may be used from any thread.
#[derive(Clone, Debug)]
pub struct Plugin {
    pub(crate) name: String,
    version: String,
    about: String,
    pub(crate) table: FunctionTable,
    /// Where it is part of this program.
    pub(crate) linked: Option<Linked>,
    library: Option<&'static LoadedLibrary>,
    hash: Option<String>,
    options: &'static [OptionSpec],
}

/// What a plugin does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PluginKind {
    /// Writes one control's language.
    Dialect,
    /// Judges the deviation along a move.
    ErrorModel,
}

/// The hash of each library that was opened, by where it lies. The system hands out a library that is open already
/// whatever its file has become since.
static OPENED: Mutex<BTreeMap<PathBuf, String>> = Mutex::new(BTreeMap::new());

fn opened() -> MutexGuard<'static, BTreeMap<PathBuf, String>> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Plugin {
    /// A plugin that is part of this program: `Plugin::linked(post_fanuc::plugin())`.
    ///
    /// # Errors
    /// If what it declares does not hold together.
    pub fn linked(linked: Linked) -> Result<Plugin, PluginFault> {
        // SAFETY: only the export macros make a `Linked`, and only of functions that keep the contract.
        let described = unsafe { judge(linked.raw(), &Caller::new(None)) };
        let described = described.map_err(|reason| PluginFault {
            plugin: "linked in".to_owned(),
            path: None,
            reason,
        })?;
        Ok(Plugin { linked: Some(linked), ..described.into() })
    }

    /// Opens `…/libpost_<name>.so` (`.dylib`, `post_<name>.dll`), which must export `post_plugin_<name>`.
    ///
    /// Opening a library runs its code with the rights of this process, so only files that the user
    /// named may be opened.
    ///
    /// # Errors
    /// If the file is not a plugin for this version of the contract.
    pub fn open(path: &Path) -> Result<Plugin, PluginFault> {
        let name = name_of(path);
        let fault = |reason| PluginFault {
            plugin: name.unwrap_or("?").to_owned(),
            path: Some(path.to_owned()),
            reason,
        };
        let Some(name) = name else {
            return Err(fault(Reason::FileName { pattern: file_name("<name>") }));
        };
        open_library(name, path).map_err(fault)
    }

    /// Its name, as a machine file has it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its own version.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// What it is, in one sentence; empty if it does not say.
    pub fn about(&self) -> &str {
        &self.about
    }

    /// What it does.
    pub fn kind(&self) -> PluginKind {
        match self.table {
            FunctionTable::Dialect(_) => PluginKind::Dialect,
            FunctionTable::Model(_) => PluginKind::ErrorModel,
        }
    }

    /// Its file; none if it is linked in.
    pub fn path(&self) -> Option<&Path> {
        self.library.map(|library| library.path.as_path())
    }

    /// BLAKE3 of its file, in hexadecimal digits; none if it is linked in.
    pub fn hash(&self) -> Option<&str> {
        self.hash.as_deref()
    }

    /// The options it declares.
    pub fn options(&self) -> &'static [OptionSpec] {
        self.options
    }

    pub(crate) fn caller(&self) -> Caller {
        Caller::new(self.library)
    }

    pub(crate) fn fault(&self, reason: Reason) -> PluginFault {
        PluginFault { plugin: self.name.clone(), path: self.path().map(Path::to_owned), reason }
    }

    pub(crate) fn other_kind(&self, wanted: PluginKind) -> PluginFault {
        self.fault(Reason::OtherKind { wanted: wanted.name(), found: self.kind().name() })
    }
}

impl From<Described> for Plugin {
    /// As if it were linked in.
    fn from(described: Described) -> Self {
        let Described { name, version, about, table, options } = described;
        Plugin { name, version, about, table, linked: None, library: None, hash: None, options }
    }
}

/// Opens the library at `path`, which must hold the plugin `name`.
fn open_library(name: &str, path: &Path) -> Result<Plugin, Reason> {
    let system = |message: String| Reason::Open { message };
    let symbol = format!("post_plugin_{name}");
    let file = LibraryFile::look(path, &symbol).map_err(|message| match message {
        Some(message) => system(message),
        None => Reason::NoSymbol { symbol: symbol.clone() },
    })?;
    let earlier = opened().get(&file.path).cloned();
    if earlier.is_some_and(|earlier| earlier != file.hash) {
        return Err(system("it is open already, and its file was changed since".to_owned()));
    }
    let loaded: &'static LoadedLibrary =
        Box::leak(Box::new(LoadedLibrary { name: name.to_owned(), path: path.to_owned() }));
    library_opened(loaded);
    let caller = Caller::new(Some(loaded));
    // SAFETY: the library's initialisers run; the user named this file as one to be run.
    let library = caller.call(|| unsafe { libloading::Library::new(file.path.as_os_str()) });
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
    if !file.is_unchanged() {
        return Err(system("its file was changed while it was opened".to_owned()));
    }
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
        caller.call(|| unsafe { loaded() });
    }
    Ok(Plugin { library: Some(loaded), hash: Some(file.hash), ..described.into() })
}

impl PluginKind {
    /// With its article, for messages.
    pub fn name(self) -> &'static str {
        match self {
            PluginKind::Dialect => "a dialect",
            PluginKind::ErrorModel => "an error model",
        }
    }
}

/// File name of the plugin `name` on this system.
pub(crate) fn file_name(name: &str) -> String {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}")
}

/// The plugin's name in a file name, the inverse of [`file_name`].
pub(crate) fn name_of(path: &Path) -> Option<&str> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let stem = path.file_name()?.to_str()?.strip_suffix(DLL_SUFFIX)?;
    let name = stem.strip_prefix(DLL_PREFIX)?.strip_prefix("post_")?;
    is_name(name).then_some(name)
}
