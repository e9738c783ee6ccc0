//! A plugin: linked in or opened from a file, and checked before anything of it is used.

#![allow(unsafe_code)]

use std::ffi::c_void;
use std::path::{Path, PathBuf};

use object::{Object as _, ObjectSegment as _};
use post_plugin::raw::{self, PostDialect, PostModel, PostOption, PostPlugin, PostText};
use post_plugin::{Linked, OptionKind, OptionSpec};

use crate::options::check;
use crate::{GivenValue, PluginFault, Reason};

/// A checked plugin. Cheap to clone; may be used from any thread.
#[derive(Clone, Debug)]
pub struct Plugin {
    pub(crate) name: String,
    version: String,
    pub(crate) table: Table,
    /// Where it is part of this program.
    pub(crate) linked: Option<Linked>,
    path: Option<PathBuf>,
    hash: Option<String>,
    options: &'static [OptionSpec],
}

/// What a plugin does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Writes one control's language.
    Dialect,
    /// Judges the deviation along a move.
    ErrorModel,
}

/// The functions of a plugin. Every pointer in them was found not to be null.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Table {
    Dialect(&'static PostDialect),
    Model(&'static PostModel),
}

/// Is all of a library there? The system maps what its headers promise and dies where the file ends before that.
fn whole_library(bytes: &[u8]) -> Result<(), String> {
    let file = object::File::parse(bytes).map_err(|error| format!("it is no library: {error}"))?;
    let cut_off = file.segments().any(|segment| {
        let (start, size) = segment.file_range();
        start
            .checked_add(size)
            .is_none_or(|end| end > bytes.len() as u64)
    });
    if cut_off {
        return Err("it is cut off: its headers promise more than the file holds".to_owned());
    }
    Ok(())
}

impl Plugin {
    /// A plugin that is part of this program: `Plugin::linked(post_fanuc::plugin())`.
    ///
    /// # Errors
    /// If what it declares does not hold together.
    pub fn linked(linked: Linked) -> Result<Plugin, PluginFault> {
        // SAFETY: only the export macros make a `Linked`, and only of functions that keep the contract.
        let mut plugin = unsafe { judge(linked.raw()) }.map_err(|reason| PluginFault {
            plugin: "linked in".to_owned(),
            path: None,
            reason,
        })?;
        plugin.linked = Some(linked);
        Ok(plugin)
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
            return Err(fault(Reason::FileName {
                pattern: file_name("<name>"),
            }));
        };
        let system = |error: &dyn std::error::Error| Reason::Open {
            message: error.to_string(),
        };
        // A name without a folder would be looked for in the system's folders.
        let whole = path.canonicalize().map_err(|error| fault(system(&error)))?;
        // Reading a pipe or a device might never end.
        if !whole.is_file() {
            return Err(fault(Reason::Open {
                message: "it is no file".to_owned(),
            }));
        }
        let bytes = std::fs::read(&whole).map_err(|error| fault(system(&error)))?;
        whole_library(&bytes).map_err(|message| fault(Reason::Open { message }))?;
        // SAFETY: the library's initialisers run; the user named this file as one to be run.
        let library = unsafe { libloading::Library::new(whole.as_os_str()) }
            .map_err(|error| fault(system(&error)))?;
        let symbol = format!("post_plugin_{name}");
        // SAFETY: only the symbol's address is taken here; what it leads to is judged below.
        let found = unsafe { library.get::<*const PostPlugin>(symbol.as_bytes()) };
        let Some(exported) = found.ok().map(|found| *found) else {
            return Err(fault(Reason::NoSymbol { symbol }));
        };
        // A library is never closed again: its threads and thread-local destructors may still need its
        // code, so there is no sound way to unload it. What it exports therefore lives for ever.
        std::mem::forget(library);
        if exported.is_null() || !exported.is_aligned() {
            return Err(fault(Reason::NotAPlugin));
        }
        // SAFETY: not null, aligned and never unloaded. That the plugin keeps the contract is its
        // author's promise, made by the magic number.
        let mut plugin = unsafe { judge(exported) }.map_err(fault)?;
        if plugin.name != name {
            return Err(fault(Reason::Nonsense {
                message: format!("it calls itself `{}`", plugin.name),
            }));
        }
        plugin.path = Some(path.to_owned());
        plugin.hash = Some(blake3::hash(&bytes).to_hex().to_string());
        // SAFETY: judged above.
        if let Some(loaded) = unsafe { (*exported).loaded } {
            unsafe { loaded() };
        }
        Ok(plugin)
    }

    /// Its name, as a machine file has it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its own version.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// What it does.
    pub fn kind(&self) -> Kind {
        match self.table {
            Table::Dialect(_) => Kind::Dialect,
            Table::Model(_) => Kind::ErrorModel,
        }
    }

    /// Its file; none if it is linked in.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// BLAKE3 of its file, in hexadecimal digits; none if it is linked in.
    pub fn hash(&self) -> Option<&str> {
        self.hash.as_deref()
    }

    /// The options it declares.
    pub fn options(&self) -> &'static [OptionSpec] {
        self.options
    }

    pub(crate) fn fault(&self, reason: Reason) -> PluginFault {
        PluginFault {
            plugin: self.name.clone(),
            path: self.path.clone(),
            reason,
        }
    }

    pub(crate) fn other_kind(&self, wanted: Kind) -> PluginFault {
        self.fault(Reason::OtherKind {
            wanted: wanted.name(),
            found: self.kind().name(),
        })
    }
}

impl Kind {
    /// With its article, for messages.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Dialect => "a dialect",
            Kind::ErrorModel => "an error model",
        }
    }
}

/// File name of the plugin `name` on this system.
pub(crate) fn file_name(name: &str) -> String {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}")
}

/// The plugin's name in a file name, the inverse of [`file_name`].
fn name_of(path: &Path) -> Option<&str> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let stem = path.file_name()?.to_str()?.strip_suffix(DLL_SUFFIX)?;
    let name = stem.strip_prefix(DLL_PREFIX)?.strip_prefix("post_")?;
    is_name(name).then_some(name)
}

/// `name` can be part of a symbol, and of a file name without leaving its folder.
pub(crate) fn is_name(name: &str) -> bool {
    let known = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    !name.is_empty() && name.bytes().all(known)
}

/// Checks what a library exports, in an order that reads nothing before it is known to be there.
///
/// # Safety
/// `plugin` is aligned and leads to memory that lives for ever. If it begins with the magic number, the
/// version and the layout of this contract, the rest keeps it too.
unsafe fn judge(plugin: *const PostPlugin) -> Result<Plugin, Reason> {
    // SAFETY: for all reads: the caller vouches for the memory, and each field is read only after those
    // before it have said that it is there.
    if unsafe { (*plugin).magic } != raw::MAGIC {
        return Err(Reason::NotAPlugin);
    }
    let (abi, kind, size, table_size, layout) = unsafe {
        (
            (*plugin).abi,
            (*plugin).kind,
            (*plugin).size,
            (*plugin).table_size,
            (*plugin).layout,
        )
    };
    if abi != raw::ABI {
        return Err(Reason::OtherContract {
            found: abi,
            wanted: raw::ABI,
        });
    }
    if layout != raw::LAYOUT {
        return Err(Reason::OtherLayout {
            found: layout,
            wanted: raw::LAYOUT,
        });
    }
    check_size("PostPlugin", size, size_of::<PostPlugin>())?;
    let plugin = unsafe { &*plugin };
    let table = match kind {
        raw::KIND_DIALECT => {
            check_size("PostDialect", table_size, size_of::<PostDialect>())?;
            // SAFETY: not null, and as long as stated.
            let table =
                unsafe { plugin.dialect.as_ref() }.ok_or(Reason::Null { what: "dialect" })?;
            present("open", table.open)?;
            present("format", table.format)?;
            present("write", table.write)?;
            present("last_error", table.last_error)?;
            present("close", table.close)?;
            Table::Dialect(table)
        }
        raw::KIND_MODEL => {
            check_size("PostModel", table_size, size_of::<PostModel>())?;
            // SAFETY: not null, and as long as stated.
            let table = unsafe { plugin.model.as_ref() }.ok_or(Reason::Null { what: "model" })?;
            present("open", table.open)?;
            present("fit", table.fit)?;
            present("value", table.value)?;
            present("last_error", table.last_error)?;
            present("close", table.close)?;
            Table::Model(table)
        }
        _ => {
            return Err(Reason::Nonsense {
                message: format!("its kind {kind} is neither a dialect nor an error model"),
            });
        }
    };
    // SAFETY: the contract holds from here on.
    let name = unsafe { text("name", plugin.name) }?;
    let version = unsafe { text("version", plugin.version) }?;
    if !is_name(name) {
        return Err(Reason::Nonsense {
            message: format!("`{name}` cannot be the name of a plugin"),
        });
    }
    Ok(Plugin {
        name: name.to_owned(),
        version: version.to_owned(),
        table,
        linked: None,
        path: None,
        hash: None,
        options: unsafe { declared(plugin) }?,
    })
}

fn check_size(of: &'static str, found: u32, wanted: usize) -> Result<(), Reason> {
    let wanted = wanted as u32;
    // A later version may append to a struct, but not that much.
    if (wanted..=wanted + 65_536).contains(&found) {
        return Ok(());
    }
    Err(Reason::Size { of, found, wanted })
}

fn present<F>(what: &'static str, function: Option<F>) -> Result<(), Reason> {
    function.map(|_| ()).ok_or(Reason::Null { what })
}

/// # Safety
/// `text` is null, or keeps the contract for ever.
unsafe fn text(what: &'static str, text: PostText) -> Result<&'static str, Reason> {
    if text.ptr.is_null() {
        return Err(Reason::Null { what });
    }
    // SAFETY: the caller vouches for it.
    unsafe { text.get() }.ok_or_else(|| Reason::Nonsense {
        message: format!("its {what} is not UTF-8"),
    })
}

/// The options that a plugin declares. They are kept for ever, once a plugin, like the library itself.
///
/// # Safety
/// The plugin keeps the contract.
unsafe fn declared(plugin: &PostPlugin) -> Result<&'static [OptionSpec], Reason> {
    let Some(describe) = plugin.describe else {
        return Ok(&[]);
    };
    let mut specs: Vec<Option<OptionSpec>> = Vec::new();
    // SAFETY: `emit` takes the vector.
    unsafe { describe((&raw mut specs).cast(), emit) };
    let nonsense = |message: String| Reason::Nonsense { message };
    let mut good: Vec<OptionSpec> = Vec::with_capacity(specs.len());
    for spec in specs {
        let spec = spec.ok_or_else(|| nonsense("an option it declares is not valid".to_owned()))?;
        if good.iter().any(|other| other.key == spec.key) {
            return Err(nonsense(format!(
                "it declares the option `{}` twice",
                spec.key
            )));
        }
        check(&spec, &GivenValue::from(spec.default)).map_err(|fault| {
            nonsense(format!(
                "the default of an option it declares does not fit: {fault}"
            ))
        })?;
        good.push(spec);
    }
    Ok(good.leak())
}

unsafe extern "C" fn emit(host: *mut c_void, option: *const PostOption) {
    // SAFETY: `host` is the vector of `declared`; the plugin vouches for the option.
    let (specs, option) = unsafe {
        (
            &mut *host.cast::<Vec<Option<OptionSpec>>>(),
            option.as_ref(),
        )
    };
    specs.push(option.and_then(|option| unsafe { keep(option) }));
}

/// A copy of a declared option that lives for ever.
///
/// # Safety
/// Every pointer in it is valid for the call.
unsafe fn keep(option: &PostOption) -> Option<OptionSpec> {
    let own = |text: &str| -> &'static str { text.to_owned().leak() };
    // SAFETY: for all calls below, the caller vouches for the pointers.
    let kind = match option.kind {
        raw::OPTION_FLAG => OptionKind::Flag,
        raw::OPTION_INTEGER => OptionKind::Integer {
            min: option.min as i64,
            max: option.max as i64,
        },
        raw::OPTION_NUMBER => OptionKind::Number {
            min: option.min,
            max: option.max,
        },
        raw::OPTION_TEXT => OptionKind::Text,
        raw::OPTION_LINES => OptionKind::Lines,
        raw::OPTION_CHOICE => {
            let choices = unsafe { raw::slice(option.choices, option.choices_len) };
            let choices: Option<Vec<&'static str>> = choices
                .iter()
                .map(|choice| unsafe { choice.get() }.map(own))
                .collect();
            OptionKind::Choice(choices?.leak())
        }
        _ => return None,
    };
    let key = unsafe { option.key.get() }.filter(|key| is_name(key))?;
    let default = match unsafe { option.default_value.get() }? {
        post_plugin::Value::Text(text) => post_plugin::Value::Text(own(text)),
        post_plugin::Value::Flag(flag) => post_plugin::Value::Flag(flag),
        post_plugin::Value::Integer(integer) => post_plugin::Value::Integer(integer),
        post_plugin::Value::Number(number) => post_plugin::Value::Number(number),
    };
    Some(OptionSpec {
        key: own(key),
        kind,
        default,
        help: own(unsafe { option.help.get() }?),
    })
}
