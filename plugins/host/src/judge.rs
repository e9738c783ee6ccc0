//! What a library says about itself, checked before anything else of it is used.

#![allow(unsafe_code)]

use std::ffi::c_void;
use std::mem::{MaybeUninit, offset_of};

use post_plugin::raw::{self, PostDialect, PostModel, PostOption, PostPlugin, PostText};
use post_plugin::{OptionKind, OptionSpec, Value};

use crate::call::Caller;
use crate::described::{Described, FunctionTable, is_name};
use crate::function::Function;
use crate::options::check;
use crate::shown::{is_odd, quoted, sentence};
use crate::{GivenValue, Reason};

/// Bytes of [`PostPlugin`] as version 2 of the contract began: what stands behind them may be missing.
const LEAST: usize = offset_of!(PostPlugin, about);

/// Bytes of [`PostDialect`] then.
const LEAST_DIALECT: usize = offset_of!(PostDialect, vocabulary);

/// Most bytes by which a later version's struct or table may be longer than ours.
const MOST_MORE: usize = 65_536;

/// Most bytes of a name, a key, a version, or a text of a choice.
pub(crate) const MOST_NAME: usize = 200;

/// Most bytes of a sentence, or of an option's default.
const MOST_SENTENCE: usize = 16 << 10;

/// Most options, and most texts of a choice.
const MOST_OPTIONS: usize = 1000;

/// Checks what a library exports, in an order that reads nothing before it is known to be there.
///
/// # Safety
/// `plugin` is aligned and leads to memory that lives for ever. If it begins with the magic number, the
/// version and the layout of this contract, the rest keeps it too.
pub(crate) unsafe fn judge(
    plugin: *const PostPlugin,
    caller: &Caller,
) -> Result<Described, Reason> {
    // SAFETY: for all reads: the caller vouches for the memory, and each field is read only after those
    // before it have said that it is there.
    if unsafe { (*plugin).magic } != raw::MAGIC {
        return Err(Reason::NotAPlugin);
    }
    let (abi, kind, size, table_size, layout) = unsafe {
        ((*plugin).abi, (*plugin).kind, (*plugin).size, (*plugin).table_size, (*plugin).layout)
    };
    if abi != raw::ABI {
        return Err(Reason::OtherContract { found: abi, wanted: raw::ABI });
    }
    if layout != raw::LAYOUT {
        return Err(Reason::OtherLayout { found: layout, wanted: raw::LAYOUT });
    }
    check_size("PostPlugin", size, LEAST)?;
    // SAFETY: as long as stated; of zeros all fields are valid.
    let plugin = &unsafe { own(plugin, size) };
    let table = match kind {
        raw::KIND_DIALECT => {
            check_size("PostDialect", table_size, LEAST_DIALECT)?;
            // SAFETY: as long as stated; of zeros all fields are valid.
            let table = unsafe { table("dialect", plugin.dialect, table_size) }?;
            present("open", table.open)?;
            present("format", table.format)?;
            present("write", table.write)?;
            present("last_error", table.last_error)?;
            present("close", table.close)?;
            FunctionTable::Dialect(table)
        }
        raw::KIND_MODEL => {
            check_size("PostModel", table_size, size_of::<PostModel>())?;
            // SAFETY: as long as stated; of zeros all fields are valid.
            let table = unsafe { table("model", plugin.model, table_size) }?;
            present("open", table.open)?;
            present("fit", table.fit)?;
            present("value", table.value)?;
            present("last_error", table.last_error)?;
            present("close", table.close)?;
            FunctionTable::Model(table)
        }
        _ => {
            return Err(Reason::Nonsense {
                message: format!("its kind {kind} is neither a dialect nor an error model"),
            });
        }
    };
    // SAFETY: for the texts, the contract holds from here on.
    let name = unsafe { name("name", plugin.name) }?;
    let version = unsafe { self::name("version", plugin.version) }?;
    if !is_name(name) {
        return Err(nonsense(format!("`{}` cannot be the name of a plugin", quoted(name))));
    }
    let about = unsafe { text(plugin.about, MOST_SENTENCE) };
    let about = about.map_err(|lack| nonsense(format!("its description {lack}")))?;
    Ok(Described {
        name: name.to_owned(),
        version: version.to_owned(),
        about: sentence(about),
        table,
        options: unsafe { declared(plugin, caller) }?,
    })
}

fn nonsense(message: String) -> Reason {
    Reason::Nonsense { message }
}

/// What a plugin of an earlier version does not have is zero.
///
/// # Safety
/// `given` leads to `size` bytes, and a `T` may be zeros.
unsafe fn own<T>(given: *const T, size: u32) -> T {
    let mut own = MaybeUninit::<T>::zeroed();
    let there = size_of::<T>().min(size as usize);
    // SAFETY: as many bytes as both have; the caller vouches for the zeros behind them.
    unsafe {
        given.cast::<u8>().copy_to_nonoverlapping(own.as_mut_ptr().cast(), there);
        own.assume_init()
    }
}

/// # Safety
/// `table` is null, or not aligned, or leads to a table of `size` bytes; a `T` may be zeros.
unsafe fn table<T>(what: &'static str, table: *const T, size: u32) -> Result<T, Reason> {
    if !table.is_aligned() {
        return Err(Reason::NotAligned { what });
    }
    if table.is_null() {
        return Err(Reason::Null { what });
    }
    // SAFETY: not null; the caller vouches for the rest.
    Ok(unsafe { own(table, size) })
}

fn check_size(of: &'static str, found: u32, wanted: usize) -> Result<(), Reason> {
    let wanted = wanted as u32;
    let most = wanted + MOST_MORE as u32;
    if (wanted..=most).contains(&found) {
        return Ok(());
    }
    Err(Reason::Size { of, found, wanted, most })
}

fn present<F>(what: &'static str, function: Option<F>) -> Result<(), Reason> {
    function.map(|_| ()).ok_or(Reason::Null { what })
}

/// A name, or the like: there, short, and of one line.
///
/// # Safety
/// `given` is null, or keeps the contract for ever.
unsafe fn name(what: &'static str, given: PostText) -> Result<&'static str, Reason> {
    if given.ptr.is_null() {
        return Err(Reason::Null { what });
    }
    // SAFETY: the caller vouches for it.
    let name = unsafe { text(given, MOST_NAME) };
    let name = name.map_err(|lack| nonsense(format!("its {what} {lack}")))?;
    judge_name(what, name)
}

/// A name, or the like, is short and of one line.
pub(crate) fn judge_name<'a>(what: &str, name: &'a str) -> Result<&'a str, Reason> {
    if name.len() > MOST_NAME {
        let count = name.len();
        return Err(nonsense(format!(
            "its {what} has {count} bytes, at most {MOST_NAME} are taken"
        )));
    }
    match name.chars().find(|letter| is_odd(*letter)) {
        None => Ok(name),
        Some(_) => Err(nonsense(format!(
            "its {what} `{}` holds a character that no line has",
            quoted(name)
        ))),
    }
}

/// A text of at most `most` bytes; or what is wrong with it, to be said behind what it is.
///
/// # Safety
/// `text` is null, or keeps the contract for `'a`.
pub(crate) unsafe fn text<'a>(text: PostText, most: usize) -> Result<&'a str, String> {
    if text.len > most {
        return Err(format!("has {} bytes, at most {most} are taken", text.len));
    }
    if text.ptr.is_null() && text.len > 0 {
        return Err("is null".to_owned());
    }
    // SAFETY: the caller vouches for it.
    unsafe { text.get() }.ok_or_else(|| "is not UTF-8".to_owned())
}

/// The options that a plugin declares. They are kept for ever, once a plugin, like the library itself.
///
/// # Safety
/// The plugin keeps the contract.
unsafe fn declared(plugin: &PostPlugin, caller: &Caller) -> Result<&'static [OptionSpec], Reason> {
    let Some(describe) = plugin.describe else {
        return Ok(&[]);
    };
    let mut specs: Vec<Result<OptionSpec, String>> = Vec::new();
    let host = (&raw mut specs).cast();
    // SAFETY: `emit` takes the vector.
    caller.call(Function::Describe, || unsafe { describe(host, emit) });
    judge_options(specs)
}

/// The options of a plugin, each once and with a default that fits. They are kept for ever.
pub(crate) fn judge_options(
    specs: Vec<Result<OptionSpec, String>>,
) -> Result<&'static [OptionSpec], Reason> {
    if specs.len() > MOST_OPTIONS {
        return Err(nonsense(format!("it declares more than {MOST_OPTIONS} options")));
    }
    let mut good: Vec<OptionSpec> = Vec::with_capacity(specs.len());
    for spec in specs {
        let spec = spec.map_err(|lack| nonsense(format!("an option it declares {lack}")))?;
        if !is_name(spec.key) || spec.key.len() > MOST_NAME {
            let lack = format!("has the key `{}`, which is no name", quoted(spec.key));
            return Err(nonsense(format!("an option it declares {lack}")));
        }
        if good.iter().any(|other| other.key == spec.key) {
            return Err(nonsense(format!("it declares the option `{}` twice", spec.key)));
        }
        check(&spec, &GivenValue::from(spec.default)).map_err(|fault| {
            nonsense(format!("the default of an option it declares does not fit: {fault}"))
        })?;
        good.push(spec);
    }
    Ok(good.leak())
}

unsafe extern "C" fn emit(host: *mut c_void, option: *const PostOption) {
    // SAFETY: `host` is the vector of `declared`.
    let specs = unsafe { &mut *host.cast::<Vec<Result<OptionSpec, String>>>() };
    // One more than is allowed says that there were more.
    if specs.len() > MOST_OPTIONS {
        return;
    }
    specs.push(if option.is_null() {
        Err("is null".to_owned())
    } else if !option.is_aligned() {
        Err("is not aligned".to_owned())
    } else {
        // SAFETY: the plugin vouches for the option.
        unsafe { keep(&*option) }
    });
}

/// A copy of a declared option that lives for ever; or what is wrong with it, to be said behind what it is.
///
/// # Safety
/// Every pointer in it is valid for the call.
unsafe fn keep(option: &PostOption) -> Result<OptionSpec, String> {
    let own = |text: &str| -> &'static str { text.to_owned().leak() };
    // SAFETY: for all calls below, the caller vouches for the pointers.
    let key =
        unsafe { text(option.key, MOST_NAME) }.map_err(|lack| format!("has a key that {lack}"))?;
    let of = |what: &str, lack: String| format!("has {what} that {lack} (`{key}`)");
    let kind = match option.kind {
        raw::OPTION_FLAG => OptionKind::Flag,
        raw::OPTION_INTEGER => {
            OptionKind::Integer { min: option.min as i64, max: option.max as i64 }
        }
        raw::OPTION_NUMBER => OptionKind::Number { min: option.min, max: option.max },
        raw::OPTION_TEXT => OptionKind::Text,
        raw::OPTION_LINES => OptionKind::Lines,
        raw::OPTION_CHOICE => {
            let choices = (option.choices, option.choices_len);
            let choices = unsafe { kept_choices(choices) };
            OptionKind::Choice(choices.map_err(|lack| of("a choice", lack))?)
        }
        other => return Err(of("a kind", format!("is not known, {other}"))),
    };
    let value = &option.default_value;
    let default = match value.kind {
        raw::OPTION_FLAG => Value::Flag(value.integer != 0),
        raw::OPTION_INTEGER => Value::Integer(value.integer),
        raw::OPTION_NUMBER => Value::Number(value.number),
        raw::OPTION_TEXT => {
            let text = unsafe { text(value.text, MOST_SENTENCE) };
            Value::Text(own(text.map_err(|lack| of("a default", lack))?))
        }
        other => return Err(of("a default", format!("is of no known kind, {other}"))),
    };
    let help = unsafe { text(option.help, MOST_SENTENCE) };
    Ok(OptionSpec {
        key: own(key),
        kind,
        default,
        help: own(&sentence(help.map_err(|lack| of("a help", lack))?)),
    })
}

/// # Safety
/// As [`keep`].
unsafe fn kept_choices(
    (choices, len): (*const PostText, usize),
) -> Result<&'static [&'static str], String> {
    if len > MOST_OPTIONS {
        return Err(format!("is one of {len}"));
    }
    if !choices.is_aligned() || (choices.is_null() && len > 0) {
        return Err("is at a null pointer, or one that is not aligned".to_owned());
    }
    // SAFETY: aligned and not null; the caller vouches for the rest.
    let choices = unsafe { raw::slice(choices, len) };
    let mut kept: Vec<&'static str> = Vec::with_capacity(len);
    for choice in choices {
        // SAFETY: as above.
        let choice = unsafe { text(*choice, MOST_NAME) }?;
        if choice.contains(is_odd) {
            return Err(format!("no line can hold, `{}`", quoted(choice)));
        }
        kept.push(choice.to_owned().leak());
    }
    Ok(kept.leak())
}
