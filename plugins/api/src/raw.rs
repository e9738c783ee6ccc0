//! The C contract: what crosses the border between `post` and a library, and nothing else.
//!
//! Only fixed-width integers, `f64`, pointers with a length, and function pointers. No `bool`, no Rust
//! enum, no ownership: the side that made a thing frees it. Text is UTF-8 without a terminating zero and lives
//! as long as the call that hands it over. Text of a plugin leaves it through a [`PostSink`].
//!
//! `include/post_plugin.h` and `post_plugin_tables.h` say the same in C; `tests/it/header.rs` keeps them together.

#![allow(unsafe_code)]

mod event;
mod layout;
mod setup;

use std::ffi::c_void;

use crate::{Curve, Deviation, OptionKind, OptionSpec, Tolerance, Value};

pub use event::events;
pub use layout::{LAYOUT, LAYOUTS, Layout, TABLES};
pub use setup::with_setup;

/// First field of every [`PostPlugin`]: the letters `POSTPLUG` in memory on a little-endian machine.
pub const MAGIC: u64 = u64::from_le_bytes(*b"POSTPLUG");

/// Version of the contract. It changes when a struct of [`LAYOUTS`] or the meaning of a call does. What may grow
/// without a new one: tables of functions, [`PostPlugin`], [`PostSetup`] and [`PostFormat`] at their end, events (more
/// kinds; more numbers and texts after those of a kind), capabilities.
pub const ABI: u32 = 2;

/// [`PostPlugin::kind`] of a dialect.
pub const KIND_DIALECT: u32 = 1;
/// [`PostPlugin::kind`] of an error model.
pub const KIND_MODEL: u32 = 2;

/// The contract in C: `post_plugin.h`.
pub const HEADER: &str = include_str!("../include/post_plugin.h");
/// The meanings of words and the layout of structs in C, which [`HEADER`] includes: `post_plugin_tables.h`.
pub const TABLES_HEADER: &str = include_str!("../include/post_plugin_tables.h");

/// Most axis words that a program may have.
pub const MAX_WORDS: usize = 32;

/// Text: `len` bytes of UTF-8 at `ptr`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostText {
    /// First byte; may be anything if `len` is 0.
    pub ptr: *const u8,
    /// Number of bytes.
    pub len: usize,
}

/// Takes text from a plugin: call `write` as often as liked, before the call that brought the sink returns.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostSink {
    /// Handed back to `write`.
    pub ctx: *mut c_void,
    /// Copies `len` bytes.
    pub write: Option<unsafe extern "C" fn(ctx: *mut c_void, ptr: *const u8, len: usize)>,
}

/// Value of an option. `kind` says which field counts.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostValue {
    /// One of `OPTION_FLAG`, `OPTION_INTEGER`, `OPTION_NUMBER`, `OPTION_TEXT`.
    pub kind: u32,
    /// 0.
    pub reserved: u32,
    /// A whole number; a flag is 0 or 1.
    pub integer: i64,
    /// A number.
    pub number: f64,
    /// Text, also that of a choice.
    pub text: PostText,
}

/// `true` or `false`.
pub const OPTION_FLAG: u32 = 1;
/// A whole number.
pub const OPTION_INTEGER: u32 = 2;
/// A number.
pub const OPTION_NUMBER: u32 = 3;
/// Text.
pub const OPTION_TEXT: u32 = 4;
/// One of several texts.
pub const OPTION_CHOICE: u32 = 5;
/// A [`PostOption`] that takes lines of the program, or a text of one.
pub const OPTION_LINES: u32 = 6;

/// An option that has a value.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostPair {
    /// Key of the option.
    pub key: PostText,
    /// Value of the option.
    pub value: PostValue,
}

/// An option that a plugin declares.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostOption {
    /// Key in the machine file.
    pub key: PostText,
    /// One sentence on what it does, with its unit.
    pub help: PostText,
    /// One of `OPTION_…`.
    pub kind: u32,
    /// 0.
    pub reserved: u32,
    /// Least value of an integer or a number.
    pub min: f64,
    /// Largest value of an integer or a number.
    pub max: f64,
    /// Value where the machine file gives none.
    pub default_value: PostValue,
    /// The texts of a choice.
    pub choices: *const PostText,
    /// Number of choices.
    pub choices_len: usize,
}

/// One axis word.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostAxisWord {
    /// Address of the axis.
    pub name: PostText,
    /// 1 for a rotary axis (degrees), 2 for one whose words lie within one turn, so that the control must take
    /// the shorter way, 3 for one whose word is a place within one turn and by its sign the way there, 0 for a linear one.
    pub rotary: u32,
    /// 1 for the linear axis along the spindle at all axes zero.
    pub depth: u32,
    /// 1 if the axis carries the part, 0 if it carries the tool.
    pub carries_part: u32,
    /// 0.
    pub reserved: u32,
    /// Least position of the axis as the machine shows it, mm or degrees; NaN without ends.
    pub least: f64,
    /// Largest.
    pub largest: f64,
}

/// A tool of the program. A number that is not known is NaN.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostTool {
    /// Name of the tool.
    pub name: PostText,
    /// Tool number.
    pub number: u32,
    /// 0.
    pub reserved: u32,
    /// Length from the gauge point to the tip, mm.
    pub length: f64,
    /// Diameter of the cutter, mm.
    pub diameter: f64,
    /// Radius of the cutter's corner, mm.
    pub corner_radius: f64,
}

/// What a dialect is told when it is opened. Later versions may append to it, so a plugin reads no further than
/// `size`; what is not there is 0.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostSetup {
    /// Bytes of this struct as the host knows it.
    pub size: u64,
    /// Name of the program.
    pub program: PostText,
    /// Name of the machine.
    pub machine: PostText,
    /// `UNITS_…`.
    pub units: u32,
    /// 1 if the control keeps the tip on its path, else 0.
    pub tcp: u32,
    /// The axis words of a move, at most `MAX_WORDS`.
    pub words: *const PostAxisWord,
    /// Number of axis words.
    pub words_len: usize,
    /// Every option that the plugin declared, with its value.
    pub options: *const PostPair,
    /// Number of options.
    pub options_len: usize,
    /// Name of the CL file.
    pub cl_file: PostText,
    /// Tolerance of a cut's tip, mm; 0 where nothing is certified.
    pub tip_tolerance: f64,
    /// Tolerance of the tool axis, degrees.
    pub axis_tolerance: f64,
    /// Tolerance of a rapid's tip, mm.
    pub rapid_tolerance: f64,
    /// 1 if the host has looked ahead, so that what follows is known.
    pub ahead: u32,
    /// 1 if there are extents.
    pub moves: u32,
    /// The tools in the order in which they are first used.
    pub tools: *const PostTool,
    /// Number of tools.
    pub tools_len: usize,
    /// Least X, Y, Z of the tip, mm, part frame.
    pub least: [f64; 3],
    /// Largest.
    pub largest: [f64; 3],
    /// The program's time, seconds; NaN if not known.
    pub time: f64,
    /// 1 if the spindle turns the part: a lathe.
    pub turns_part: u32,
    /// The axis words that are diameters, twice the position of their axis: a bit by their place in `words`.
    pub diameters: u32,
}

/// One event: see [`EVENTS`](crate::EVENTS) for the numbers and texts of each kind. Those that a reader does not
/// know follow those that it knows; those that are missing have their default (0, none, empty).
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostEvent {
    /// Kind of the event. One that the plugin does not know must be refused.
    pub kind: u32,
    /// Number of texts.
    pub texts_len: u32,
    /// Line of the CL file.
    pub line: u64,
    /// Numbers of the event, finite but where NaN stands for one that is not given.
    pub numbers: *const f64,
    /// Number of numbers.
    pub numbers_len: usize,
    /// Texts of the event.
    pub texts: *const PostText,
}

/// How a dialect writes numbers and what it writes; filled in by the plugin. The host hands it over filled with
/// zeros but for `size`, and a plugin writes no further than that.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostFormat {
    /// Bytes of this struct as the host knows it.
    pub size: u64,
    /// Decimals of each axis word, at most 9.
    pub words: [u8; MAX_WORDS],
    /// Decimals of a feed a minute.
    pub feed: u32,
    /// Decimals of an inverse-time feed; -1 if the control has no G93.
    pub inverse_time: i32,
    /// Decimals of a feed a revolution.
    pub feed_per_revolution: u32,
    /// Number of entries of `words` that were filled in: as many as the setup has words.
    pub words_len: u32,
    /// Usual ending of a program's file name, without the dot, padded with zeros.
    pub extension: [u8; 16],
    /// The sum of `WRITES_…`: see [`Capabilities`](crate::Capabilities).
    pub writes: u64,
    /// The largest F under inverse time, 1/min; 0 if it has no end.
    pub most_inverse_time: f64,
    /// `PLANE_…`: how the control is told a tilted plane.
    pub plane_angles: u32,
    /// Decimals of those angles, degrees, at most 9.
    pub plane_decimals: u32,
    /// `LANGUAGE_…`: what its programs are written in.
    pub language: u32,
    /// Zero.
    pub reserved: u32,
    /// The feed of rapids where G0 goes at F, program units a minute; 0 if it goes as fast as the axes can.
    pub rapid_feed: f64,
}

/// Host's function that takes a declared option.
pub type PostEmit = unsafe extern "C" fn(host: *mut c_void, option: *const PostOption);

/// Host's function that takes a word of a vocabulary: `len` bytes of UTF-8 at `word`, and one of `MEANING_…`.
pub type PostEmitWord =
    unsafe extern "C" fn(host: *mut c_void, meaning: u32, word: *const u8, len: usize);

/// Host's function that computes `n` deviations. Callable only inside the `fit` that brought it.
pub type PostDeviationFn =
    unsafe extern "C" fn(host: *mut c_void, n: usize, ts: *const f64, out: *mut Deviation);

/// What a library exports as `post_plugin_<name>`.
///
/// It is a constant, not a function, so that the host can judge a library before it runs any of it.
/// Fields up to `layout` never move, in any version of the contract.
#[derive(Debug)]
#[repr(C)]
pub struct PostPlugin {
    /// [`MAGIC`].
    pub magic: u64,
    /// [`ABI`].
    pub abi: u32,
    /// `KIND_DIALECT` or `KIND_MODEL`.
    pub kind: u32,
    /// `sizeof(PostPlugin)` as the plugin knows it.
    pub size: u32,
    /// `sizeof(PostDialect)` or `sizeof(PostModel)` as the plugin knows it.
    pub table_size: u32,
    /// [`LAYOUT`] as the plugin knows it.
    pub layout: u64,
    /// Name of the plugin, as in the symbol.
    pub name: PostText,
    /// Version of the plugin.
    pub version: PostText,
    /// Declares the options: calls `emit` once for each. Null: none. Called once, when the library is
    /// opened, from the thread that opens it.
    pub describe: Option<unsafe extern "C" fn(host: *mut c_void, emit: PostEmit)>,
    /// Called once after a library was opened from a file, before anything but `describe`; never for a
    /// plugin that is linked in. Rust plugins silence their own panic printer here. May be null.
    pub loaded: Option<unsafe extern "C" fn()>,
    /// The functions of a dialect, else null.
    pub dialect: *const PostDialect,
    /// The functions of an error model, else null.
    pub model: *const PostModel,
    /// What the plugin is, in one sentence, for lists; may be empty. A library whose `size` ends before it has none.
    pub about: PostText,
}

// SAFETY: every pointer in it leads to constants that live as long as the library, which is never closed.
unsafe impl Sync for PostPlugin {}

/// The functions of a dialect. None up to `close` may be null.
///
/// A context is used from one thread at a time, though not always the same; several may be open at once.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostDialect {
    /// Called once a program. Returns its context, or null after a sentence to `error`.
    pub open: Option<
        unsafe extern "C" fn(setup: *const PostSetup, error: *const PostSink) -> *mut c_void,
    >,
    /// Called once after `open`. Returns 0, else the reason is in `last_error`.
    pub format: Option<unsafe extern "C" fn(ctx: *mut c_void, format: *mut PostFormat) -> i32>,
    /// Writes `n` events in order: their text to `out`, and to `ends[i]` the number of bytes written in
    /// this call up to the end of event `i`. Returns the number of events written; if that is less than
    /// `n`, the next one failed, nothing of it stands in `out`, and the reason is in `last_error`.
    pub write: Option<
        unsafe extern "C" fn(
            ctx: *mut c_void,
            events: *const PostEvent,
            n: usize,
            out: *const PostSink,
            ends: *mut u64,
        ) -> usize,
    >,
    /// Why the last call on this context failed.
    pub last_error: Option<unsafe extern "C" fn(ctx: *mut c_void, out: *const PostSink)>,
    /// Called once at the end, also after a failure. The context is not used again.
    pub close: Option<unsafe extern "C" fn(ctx: *mut c_void)>,
    /// Calls `emit` once for each word of the control and what it means: [`VocabularyWord`](crate::VocabularyWord).
    /// Called at most once, after `format`. Returns 0, else the reason is in `last_error`. Null, or a table that ends
    /// before it: programs of this dialect cannot be read back.
    pub vocabulary: Option<
        unsafe extern "C" fn(ctx: *mut c_void, host: *mut c_void, emit: PostEmitWord) -> i32,
    >,
    /// Hands over what its programs rely on at the control (parameters, options), one sentence a line, for the setup
    /// sheet. Called at most once, after `format`. Returns 0, else the reason is in `last_error`. Null, or a table that
    /// ends before it: nothing.
    pub relies_on: Option<unsafe extern "C" fn(ctx: *mut c_void, out: *const PostSink) -> i32>,
}

/// The functions of an error model. None may be null. Contexts are used as those of a dialect.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostModel {
    /// Called once a program and thread. Returns its context, or null after a sentence to `error`.
    pub open: Option<
        unsafe extern "C" fn(
            options: *const PostPair,
            n: usize,
            error: *const PostSink,
        ) -> *mut c_void,
    >,
    /// Fits a curve to one move; `deviation(host, …)` may be called as often as needed, from this thread
    /// and inside this call. Returns 0, else the reason is in `last_error`.
    pub fit: Option<
        unsafe extern "C" fn(
            ctx: *mut c_void,
            tolerance: *const Tolerance,
            deviation: PostDeviationFn,
            host: *mut c_void,
            curve: *mut Curve,
        ) -> i32,
    >,
    /// Deviations of a fitted curve at `n` places. Returns 0, else the reason is in `last_error`.
    pub value: Option<
        unsafe extern "C" fn(
            ctx: *mut c_void,
            curve: *const Curve,
            n: usize,
            ts: *const f64,
            out: *mut Deviation,
        ) -> i32,
    >,
    /// Why the last call on this context failed.
    pub last_error: Option<unsafe extern "C" fn(ctx: *mut c_void, out: *const PostSink)>,
    /// Called once at the end, also after a failure.
    pub close: Option<unsafe extern "C" fn(ctx: *mut c_void)>,
}

impl PostText {
    /// `text` as it crosses the border. The caller keeps it alive for the call.
    pub const fn new(text: &str) -> Self {
        PostText { ptr: text.as_ptr(), len: text.len() }
    }

    /// No text.
    pub const EMPTY: PostText = PostText::new("");

    /// The text, if it is valid UTF-8.
    ///
    /// # Safety
    /// `ptr` leads to `len` bytes that live and stay unchanged for `'a`, or `len` is 0.
    pub unsafe fn get<'a>(self) -> Option<&'a str> {
        // SAFETY: handed on to the caller.
        std::str::from_utf8(unsafe { slice(self.ptr, self.len) }).ok()
    }
}

impl PostSink {
    /// Hands `text` to the other side.
    ///
    /// # Safety
    /// The sink came with a call that has not returned yet.
    pub unsafe fn put(&self, text: &str) {
        if let Some(write) = self.write {
            // SAFETY: the caller vouches that the sink is still in force.
            unsafe { write(self.ctx, text.as_ptr(), text.len()) };
        }
    }
}

/// `len` things at `ptr`; nothing if `len` is 0, whatever `ptr` is, as C callers expect.
///
/// # Safety
/// If `len` is not 0, `ptr` leads to `len` valid things that live and stay unchanged for `'a`.
pub unsafe fn slice<'a, T>(ptr: *const T, len: usize) -> &'a [T] {
    if len == 0 || ptr.is_null() {
        return &[];
    }
    // SAFETY: not null, and the caller vouches for the rest.
    unsafe { std::slice::from_raw_parts(ptr, len) }
}

impl PostValue {
    /// `value` as it crosses the border.
    pub const fn new(value: &Value<'_>) -> Self {
        let (kind, integer, number, text) = match value {
            Value::Flag(flag) => (OPTION_FLAG, *flag as i64, 0.0, PostText::EMPTY),
            Value::Integer(integer) => (OPTION_INTEGER, *integer, 0.0, PostText::EMPTY),
            Value::Number(number) => (OPTION_NUMBER, 0, *number, PostText::EMPTY),
            Value::Text(text) => (OPTION_TEXT, 0, 0.0, PostText::new(text)),
        };
        PostValue { kind, reserved: 0, integer, number, text }
    }

    /// The value, if it is one.
    ///
    /// # Safety
    /// As [`PostText::get`].
    pub unsafe fn get<'a>(&self) -> Option<Value<'a>> {
        Some(match self.kind {
            OPTION_FLAG => Value::Flag(self.integer != 0),
            OPTION_INTEGER => Value::Integer(self.integer),
            OPTION_NUMBER => Value::Number(self.number),
            // SAFETY: handed on to the caller.
            OPTION_TEXT => Value::Text(unsafe { self.text.get() }?),
            _ => return None,
        })
    }
}

impl PostPair {
    /// A key with its value, as it crosses the border.
    pub const fn new(key: &str, value: &Value<'_>) -> Self {
        PostPair { key: PostText::new(key), value: PostValue::new(value) }
    }
}

/// The options of a call, if all are valid.
///
/// # Safety
/// `ptr` leads to `len` pairs, all valid for `'a`.
pub unsafe fn pairs<'a>(ptr: *const PostPair, len: usize) -> Option<Vec<(&'a str, Value<'a>)>> {
    // SAFETY: handed on to the caller, here and in the two calls below.
    let pairs = unsafe { slice(ptr, len) };
    pairs
        .iter()
        .map(|pair| Some((unsafe { pair.key.get() }?, unsafe { pair.value.get() }?)))
        .collect()
}

/// Hands `spec` to `take` in its raw form.
pub fn with_option(spec: &OptionSpec, take: impl FnOnce(&PostOption)) {
    let (kind, min, max, choices) = match spec.kind {
        OptionKind::Flag => (OPTION_FLAG, 0.0, 0.0, &[][..]),
        OptionKind::Integer { min, max } => (OPTION_INTEGER, min as f64, max as f64, &[][..]),
        OptionKind::Number { min, max } => (OPTION_NUMBER, min, max, &[][..]),
        OptionKind::Text => (OPTION_TEXT, 0.0, 0.0, &[][..]),
        OptionKind::Lines => (OPTION_LINES, 0.0, 0.0, &[][..]),
        OptionKind::Choice(choices) => (OPTION_CHOICE, 0.0, 0.0, choices),
    };
    let choices: Vec<PostText> = choices.iter().map(|text| PostText::new(text)).collect();
    take(&PostOption {
        key: PostText::new(spec.key),
        help: PostText::new(spec.help),
        kind,
        reserved: 0,
        min,
        max,
        default_value: PostValue::new(&spec.default),
        choices: choices.as_ptr(),
        choices_len: choices.len(),
    });
}
