//! A plugin: linked in or opened from a file, and checked before anything of it is used.

#![allow(unsafe_code)]

use std::path::Path;

use post_plugin::{Linked, OptionSpec};

use crate::call::{Caller, LoadedLibrary};
use crate::described::{Described, FunctionTable, is_name};
use crate::judge::judge;
#[cfg(not(target_family = "wasm"))]
use crate::library::open_library;
use crate::{Isolation, PluginFault, Reason};

/// A checked plugin. Cheap to clone; may be used from any thread.
#[derive(Clone, Debug)]
pub struct Plugin {
    pub(crate) name: String,
    pub(crate) version: String,
    pub(crate) about: String,
    pub(crate) table: FunctionTable,
    /// Where it is part of this program.
    pub(crate) linked: Option<Linked>,
    pub(crate) library: Option<&'static LoadedLibrary>,
    pub(crate) hash: Option<String>,
    pub(crate) options: &'static [OptionSpec],
}

/// What a plugin does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PluginKind {
    /// Writes one control's language.
    Dialect,
    /// Judges the deviation along a move.
    ErrorModel,
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
        Self::open_with(path, open_library)
    }

    /// As [`Plugin::open`], in a process of its own if there is `isolation`.
    ///
    /// # Errors
    /// As [`Plugin::open`], and if it does not survive that, or does not return in time.
    pub fn open_in(path: &Path, isolation: Option<&Isolation>) -> Result<Plugin, PluginFault> {
        match isolation {
            Some(isolation) => Self::open_with(path, |name, path| isolation.open(name, path)),
            None => Self::open(path),
        }
    }

    fn open_with(
        path: &Path,
        open: impl FnOnce(&str, &Path) -> Result<Plugin, Reason>,
    ) -> Result<Plugin, PluginFault> {
        let name = name_of(path);
        let fault = |reason| PluginFault {
            plugin: name.unwrap_or("?").to_owned(),
            path: Some(path.to_owned()),
            reason,
        };
        let Some(name) = name else {
            return Err(fault(Reason::FileName { pattern: file_name("<name>") }));
        };
        open(name, path).map_err(fault)
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
        match &self.table {
            FunctionTable::Dialect(_) => PluginKind::Dialect,
            FunctionTable::Model(_) => PluginKind::ErrorModel,
            #[cfg(unix)]
            FunctionTable::Isolated(library) => library.kind,
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

/// There are no libraries here.
#[cfg(target_family = "wasm")]
fn open_library(_: &str, _: &Path) -> Result<Plugin, Reason> {
    Err(Reason::Open { message: "libraries cannot be opened here".to_owned() })
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
