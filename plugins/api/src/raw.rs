//! The C contract: what crosses the border between `post` and a library, and nothing else.
//!
//! Only fixed-width integers, `f64`, pointers with a length, and function pointers. No `bool`, no Rust
//! enum, no ownership: whoever made a thing frees it. Text is UTF-8 without a terminating zero and lives
//! as long as the call that hands it over. Text of a plugin leaves it through a [`PostSink`].
//!
//! `include/post_plugin.h` says the same in C; `tests/it/header.rs` keeps the two together.

#![allow(unsafe_code)]

use std::ffi::c_void;
use std::mem::{align_of, offset_of, size_of};

use crate::{
    AxisWord, Compensation, Coolant, Curve, Deviation, Event, Feed, Format, OptionKind, OptionSpec,
    Setup, Spindle, SpindleSense, Tolerance, Units, Value,
};

/// First field of every [`PostPlugin`]: the letters `POSTPLUG` in memory on a little-endian machine.
pub const MAGIC: u64 = u64::from_le_bytes(*b"POSTPLUG");

/// Version of the contract. It changes when a shared struct or the meaning of a call does; functions
/// that are appended to a table do not change it.
pub const ABI: u32 = 1;

/// [`PostPlugin::kind`] of a dialect.
pub const KIND_DIALECT: u32 = 1;
/// [`PostPlugin::kind`] of an error model.
pub const KIND_MODEL: u32 = 2;

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

/// An option that has a value.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostPair {
    /// Its key.
    pub key: PostText,
    /// Its value.
    pub value: PostValue,
}

/// An option that a plugin declares.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostOption {
    /// Its key in the machine file.
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
    /// Its value where the machine file gives none.
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
    /// Its address.
    pub name: PostText,
    /// 1 for a rotary axis (degrees), 2 for one whose words lie within one turn, so that the control must take
    /// the shorter way, 0 for a linear one.
    pub rotary: u32,
    /// 1 for the linear axis along the spindle at all axes zero.
    pub depth: u32,
}

/// What a dialect is told when it is opened.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostSetup {
    /// Name of the program.
    pub program: PostText,
    /// Name of the machine.
    pub machine: PostText,
    /// `UNITS_MILLIMETRE` or `UNITS_INCH`.
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
}

/// mm, mm/min.
pub const UNITS_MILLIMETRE: u32 = 1;
/// inch, inch/min.
pub const UNITS_INCH: u32 = 2;

/// One event. What a field means depends on `kind`; a field that the kind does not use is 0.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostEvent {
    /// One of `EVENT_…`. A kind that the plugin does not know must be refused.
    pub kind: u32,
    /// Spindle: `SPINDLE_…`; coolant: `COOLANT_…`; compensation: `COMPENSATE_…`; moves: `FEED_…`.
    pub code: u32,
    /// Line of the CL file.
    pub line: u64,
    /// Tool number.
    pub number: u32,
    /// Register of the length (tool change) or the radius (compensation).
    pub register: u32,
    /// Moves: the feed; spindle: revolutions a minute; dwell: seconds. Always finite.
    pub value: f64,
    /// Moves: one number for each word of the setup, rounded to the decimals of the format. Always finite.
    pub words: *const f64,
    /// Number of words.
    pub words_len: usize,
    /// Comment, literal, name of a tool.
    pub text: PostText,
}

/// See [`Event::Start`].
pub const EVENT_START: u32 = 1;
/// See [`Event::Comment`]: `text`.
pub const EVENT_COMMENT: u32 = 2;
/// See [`Event::Literal`]: `text`.
pub const EVENT_LITERAL: u32 = 3;
/// See [`Event::ToolChange`]: `number`, `register`, `text`.
pub const EVENT_TOOL_CHANGE: u32 = 4;
/// See [`Event::Preselect`]: `number`.
pub const EVENT_PRESELECT: u32 = 5;
/// See [`Event::Spindle`]: `code`, `value`.
pub const EVENT_SPINDLE: u32 = 6;
/// See [`Event::Coolant`]: `code`.
pub const EVENT_COOLANT: u32 = 7;
/// See [`Event::Compensate`]: `code`, `register`.
pub const EVENT_COMPENSATE: u32 = 8;
/// See [`Event::Position`]: `words`, `code`, `value`.
pub const EVENT_POSITION: u32 = 9;
/// See [`Event::Release`].
pub const EVENT_RELEASE: u32 = 10;
/// See [`Event::Rapid`]: `words`.
pub const EVENT_RAPID: u32 = 11;
/// See [`Event::Linear`]: `words`, `code`, `value`.
pub const EVENT_LINEAR: u32 = 12;
/// See [`Event::Dwell`]: `value`.
pub const EVENT_DWELL: u32 = 13;
/// See [`Event::Stop`].
pub const EVENT_STOP: u32 = 14;
/// See [`Event::OptionalStop`].
pub const EVENT_OPTIONAL_STOP: u32 = 15;
/// See [`Event::Home`].
pub const EVENT_HOME: u32 = 16;
/// See [`Event::End`].
pub const EVENT_END: u32 = 17;
/// See [`Event::Word`]: `text`.
pub const EVENT_WORD: u32 = 18;

/// No feed: rapid.
pub const FEED_NONE: u32 = 0;
/// See [`Feed::PerMinute`].
pub const FEED_PER_MINUTE: u32 = 1;
/// See [`Feed::InverseTime`].
pub const FEED_INVERSE_TIME: u32 = 2;
/// See [`Feed::PerRevolution`].
pub const FEED_PER_REVOLUTION: u32 = 3;

/// Spindle off.
pub const SPINDLE_OFF: u32 = 0;
/// Clockwise, seen from the spindle to the part.
pub const SPINDLE_CLOCKWISE: u32 = 1;
/// Counter-clockwise.
pub const SPINDLE_COUNTER_CLOCKWISE: u32 = 2;
/// Oriented stop.
pub const SPINDLE_ORIENT: u32 = 3;

/// All coolant off.
pub const COOLANT_OFF: u32 = 0;
/// Flood.
pub const COOLANT_FLOOD: u32 = 1;
/// Mist.
pub const COOLANT_MIST: u32 = 2;
/// Through the tool.
pub const COOLANT_THROUGH: u32 = 3;
/// Air.
pub const COOLANT_AIR: u32 = 4;

/// No cutter compensation.
pub const COMPENSATE_OFF: u32 = 0;
/// Tool left of the path.
pub const COMPENSATE_LEFT: u32 = 1;
/// Tool right of the path.
pub const COMPENSATE_RIGHT: u32 = 2;

/// How a dialect writes numbers; filled in by the plugin. The host hands it over filled with zeros.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PostFormat {
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
}

/// Host's function that takes a declared option.
pub type PostEmit = unsafe extern "C" fn(host: *mut c_void, option: *const PostOption);

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
}

// SAFETY: every pointer in it leads to constants that live as long as the library, which is never closed.
unsafe impl Sync for PostPlugin {}

/// The functions of a dialect. None may be null.
///
/// A context is used from one thread at a time, though not always the same; several may be open at once.
#[derive(Debug)]
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
}

/// The functions of an error model. None may be null. Contexts are used as those of a dialect.
#[derive(Debug)]
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

/// Size, alignment and fields of a shared struct, as the C header must have them.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Its name in C.
    pub name: &'static str,
    /// Bytes.
    pub size: usize,
    /// Bytes.
    pub align: usize,
    /// Name and offset of each field.
    pub fields: &'static [(&'static str, usize)],
}

macro_rules! layouts {
    ($($type:ident as $name:literal { $($field:ident)* })*) => {
        &[$(Layout {
            name: $name,
            size: size_of::<$type>(),
            align: align_of::<$type>(),
            fields: &[$((stringify!($field), offset_of!($type, $field))),*],
        }),*]
    };
}

/// The data that is shared. A change here is a new [`ABI`].
pub const LAYOUTS: &[Layout] = layouts! {
    PostText as "PostText" { ptr len }
    PostSink as "PostSink" { ctx write }
    PostValue as "PostValue" { kind reserved integer number text }
    PostPair as "PostPair" { key value }
    PostOption as "PostOption" { key help kind reserved min max default_value choices choices_len }
    PostAxisWord as "PostAxisWord" { name rotary depth }
    PostSetup as "PostSetup" { program machine units tcp words words_len options options_len }
    PostEvent as "PostEvent" { kind code line number register value words words_len text }
    PostFormat as "PostFormat" { words feed inverse_time feed_per_revolution words_len extension }
    Deviation as "PostDeviation" { tip axis }
    Tolerance as "PostTolerance" { tip axis }
    Curve as "PostCurve" { tip_peak tip_at axis_peak axis_at terms }
};

/// The tables of functions. They may grow at their end, so they are not part of [`LAYOUT`].
pub const TABLES: &[Layout] = layouts! {
    PostPlugin as "PostPlugin" {
        magic abi kind size table_size layout name version describe loaded dialect model
    }
    PostDialect as "PostDialect" { open format write last_error close }
    PostModel as "PostModel" { open fit value last_error close }
};

/// Hash over size, alignment and offsets of the shared data: catches a plugin that was built against
/// another header, or for another kind of machine.
pub const LAYOUT: u64 = {
    // FNV-1a, a number at a time: its only use is to differ when a number does.
    const fn mix(hash: u64, value: usize) -> u64 {
        (hash ^ value as u64).wrapping_mul(0x0000_0100_0000_01b3)
    }
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut index = 0;
    while index < LAYOUTS.len() {
        let layout = LAYOUTS[index];
        hash = mix(mix(hash, layout.size), layout.align);
        let mut field = 0;
        while field < layout.fields.len() {
            hash = mix(hash, layout.fields[field].1);
            field += 1;
        }
        index += 1;
    }
    hash
};

impl PostText {
    /// `text` as it crosses the border. The caller keeps it alive for the call.
    pub const fn new(text: &str) -> Self {
        PostText {
            ptr: text.as_ptr(),
            len: text.len(),
        }
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
        PostValue {
            kind,
            reserved: 0,
            integer,
            number,
            text,
        }
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
        PostPair {
            key: PostText::new(key),
            value: PostValue::new(value),
        }
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

/// Hands `setup` to `take` in its raw form.
pub fn with_setup<R>(setup: &Setup<'_>, take: impl FnOnce(&PostSetup) -> R) -> R {
    let words: Vec<PostAxisWord> = setup
        .words
        .iter()
        .map(|word| PostAxisWord {
            name: PostText::new(word.name),
            rotary: u32::from(word.rotary) + u32::from(word.rotary && word.wrapped),
            depth: word.depth.into(),
        })
        .collect();
    let options: Vec<PostPair> = setup
        .options
        .iter()
        .map(|(key, value)| PostPair::new(key, value))
        .collect();
    take(&PostSetup {
        program: PostText::new(setup.program),
        machine: PostText::new(setup.machine),
        units: match setup.units {
            Units::Millimetre => UNITS_MILLIMETRE,
            Units::Inch => UNITS_INCH,
        },
        tcp: setup.tcp.into(),
        words: words.as_ptr(),
        words_len: words.len(),
        options: options.as_ptr(),
        options_len: options.len(),
    })
}

impl PostSetup {
    /// Hands the setup to `take` in its safe form; none if a text is not valid or the units are not known.
    ///
    /// # Safety
    /// Every pointer in it is valid for the call.
    pub unsafe fn with<R>(&self, take: impl FnOnce(&Setup<'_>) -> R) -> Option<R> {
        // SAFETY: handed on to the caller, here and in the calls below.
        let raw_words = unsafe { slice(self.words, self.words_len) };
        let mut words = Vec::with_capacity(raw_words.len());
        for word in raw_words {
            words.push(AxisWord {
                name: unsafe { word.name.get() }?,
                rotary: word.rotary != 0,
                wrapped: word.rotary == 2,
                depth: word.depth != 0,
            });
        }
        let options = unsafe { pairs(self.options, self.options_len) }?;
        Some(take(&Setup {
            program: unsafe { self.program.get() }?,
            machine: unsafe { self.machine.get() }?,
            units: match self.units {
                UNITS_MILLIMETRE => Units::Millimetre,
                UNITS_INCH => Units::Inch,
                _ => return None,
            },
            tcp: self.tcp != 0,
            words: &words,
            options: &options,
        }))
    }
}

impl PostEvent {
    /// `event` as it crosses the border; it borrows from `event` without the compiler's help.
    pub fn new(line: u64, event: &Event<'_>) -> Self {
        let mut raw = PostEvent {
            kind: 0,
            code: 0,
            line,
            number: 0,
            register: 0,
            value: 0.0,
            words: std::ptr::null(),
            words_len: 0,
            text: PostText::EMPTY,
        };
        raw.kind = match *event {
            Event::Start => EVENT_START,
            Event::Comment { text } => {
                raw.text = PostText::new(text);
                EVENT_COMMENT
            }
            Event::Literal { text } => {
                raw.text = PostText::new(text);
                EVENT_LITERAL
            }
            Event::Word { text } => {
                raw.text = PostText::new(text);
                EVENT_WORD
            }
            Event::ToolChange {
                number,
                register,
                name,
            } => {
                raw.number = number;
                raw.register = register;
                raw.text = PostText::new(name);
                EVENT_TOOL_CHANGE
            }
            Event::Preselect { number } => {
                raw.number = number;
                EVENT_PRESELECT
            }
            Event::Spindle(spindle) => {
                (raw.code, raw.value) = match spindle {
                    Spindle::Off => (SPINDLE_OFF, 0.0),
                    Spindle::Orient => (SPINDLE_ORIENT, 0.0),
                    Spindle::On { rpm, sense } => match sense {
                        SpindleSense::Clockwise => (SPINDLE_CLOCKWISE, rpm),
                        SpindleSense::CounterClockwise => (SPINDLE_COUNTER_CLOCKWISE, rpm),
                    },
                };
                EVENT_SPINDLE
            }
            Event::Coolant(coolant) => {
                raw.code = match coolant {
                    Coolant::Off => COOLANT_OFF,
                    Coolant::Flood => COOLANT_FLOOD,
                    Coolant::Mist => COOLANT_MIST,
                    Coolant::Through => COOLANT_THROUGH,
                    Coolant::Air => COOLANT_AIR,
                };
                EVENT_COOLANT
            }
            Event::Compensate(compensation) => {
                (raw.code, raw.register) = match compensation {
                    Compensation::Off => (COMPENSATE_OFF, 0),
                    Compensation::Left { register } => (COMPENSATE_LEFT, register),
                    Compensation::Right { register } => (COMPENSATE_RIGHT, register),
                };
                EVENT_COMPENSATE
            }
            Event::Position { words, feed } => {
                raw.put_move(words, feed);
                EVENT_POSITION
            }
            Event::Release => EVENT_RELEASE,
            Event::Rapid { words } => {
                raw.put_move(words, None);
                EVENT_RAPID
            }
            Event::Linear { words, feed } => {
                raw.put_move(words, Some(feed));
                EVENT_LINEAR
            }
            Event::Dwell { seconds } => {
                raw.value = seconds;
                EVENT_DWELL
            }
            Event::Stop => EVENT_STOP,
            Event::OptionalStop => EVENT_OPTIONAL_STOP,
            Event::Home => EVENT_HOME,
            Event::End => EVENT_END,
            Event::Unknown { kind } => kind,
        };
        raw
    }

    fn put_move(&mut self, words: &[f64], feed: Option<Feed>) {
        self.words = words.as_ptr();
        self.words_len = words.len();
        (self.code, self.value) = match feed {
            None => (FEED_NONE, 0.0),
            Some(Feed::PerMinute(feed)) => (FEED_PER_MINUTE, feed),
            Some(Feed::InverseTime(feed)) => (FEED_INVERSE_TIME, feed),
            Some(Feed::PerRevolution(feed)) => (FEED_PER_REVOLUTION, feed),
        };
    }

    /// The event in its safe form. A kind or a code that is not known comes out as [`Event::Unknown`];
    /// none if a text is not valid UTF-8.
    ///
    /// # Safety
    /// Every pointer in it is valid for `'a`.
    pub unsafe fn get<'a>(&self) -> Option<Event<'a>> {
        // SAFETY: handed on to the caller, here and for the words.
        let text = unsafe { self.text.get() }?;
        let words = unsafe { slice(self.words, self.words_len) };
        let unknown = Event::Unknown { kind: self.kind };
        let feed = match self.code {
            FEED_PER_MINUTE => Some(Feed::PerMinute(self.value)),
            FEED_INVERSE_TIME => Some(Feed::InverseTime(self.value)),
            FEED_PER_REVOLUTION => Some(Feed::PerRevolution(self.value)),
            _ => None,
        };
        let turn = |sense| {
            Event::Spindle(Spindle::On {
                rpm: self.value,
                sense,
            })
        };
        Some(match self.kind {
            EVENT_START => Event::Start,
            EVENT_COMMENT => Event::Comment { text },
            EVENT_LITERAL => Event::Literal { text },
            EVENT_WORD => Event::Word { text },
            EVENT_TOOL_CHANGE => Event::ToolChange {
                number: self.number,
                register: self.register,
                name: text,
            },
            EVENT_PRESELECT => Event::Preselect {
                number: self.number,
            },
            EVENT_SPINDLE => match self.code {
                SPINDLE_OFF => Event::Spindle(Spindle::Off),
                SPINDLE_CLOCKWISE => turn(SpindleSense::Clockwise),
                SPINDLE_COUNTER_CLOCKWISE => turn(SpindleSense::CounterClockwise),
                SPINDLE_ORIENT => Event::Spindle(Spindle::Orient),
                _ => unknown,
            },
            EVENT_COOLANT => match self.code {
                COOLANT_OFF => Event::Coolant(Coolant::Off),
                COOLANT_FLOOD => Event::Coolant(Coolant::Flood),
                COOLANT_MIST => Event::Coolant(Coolant::Mist),
                COOLANT_THROUGH => Event::Coolant(Coolant::Through),
                COOLANT_AIR => Event::Coolant(Coolant::Air),
                _ => unknown,
            },
            EVENT_COMPENSATE => match self.code {
                COMPENSATE_OFF => Event::Compensate(Compensation::Off),
                COMPENSATE_LEFT => Event::Compensate(Compensation::Left {
                    register: self.register,
                }),
                COMPENSATE_RIGHT => Event::Compensate(Compensation::Right {
                    register: self.register,
                }),
                _ => unknown,
            },
            EVENT_POSITION if self.code == FEED_NONE || feed.is_some() => {
                Event::Position { words, feed }
            }
            EVENT_RELEASE => Event::Release,
            EVENT_RAPID => Event::Rapid { words },
            EVENT_LINEAR => match feed {
                Some(feed) => Event::Linear { words, feed },
                None => unknown,
            },
            EVENT_DWELL => Event::Dwell {
                seconds: self.value,
            },
            EVENT_STOP => Event::Stop,
            EVENT_OPTIONAL_STOP => Event::OptionalStop,
            EVENT_HOME => Event::Home,
            EVENT_END => Event::End,
            _ => unknown,
        })
    }
}

impl PostFormat {
    /// All zero, as the host hands it over.
    pub const EMPTY: PostFormat = PostFormat {
        words: [0; MAX_WORDS],
        feed: 0,
        inverse_time: 0,
        feed_per_revolution: 0,
        words_len: 0,
        extension: [0; 16],
    };

    /// `format` as it crosses the border; none if it has too many words or too long an extension.
    pub fn new(format: &Format) -> Option<Self> {
        let mut raw = PostFormat {
            feed: format.feed.into(),
            inverse_time: format.inverse_time.map_or(-1, i32::from),
            feed_per_revolution: format.feed_per_revolution.into(),
            words_len: format.words.len() as u32,
            ..PostFormat::EMPTY
        };
        raw.words
            .get_mut(..format.words.len())?
            .copy_from_slice(&format.words);
        raw.extension
            .get_mut(..format.extension.len())?
            .copy_from_slice(format.extension.as_bytes());
        Some(raw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_comes_back_as_it_went() {
        let words = [1.0, -2.5];
        let feeds = [
            Feed::PerMinute(100.0),
            Feed::InverseTime(2.5),
            Feed::PerRevolution(0.1),
        ];
        let mut events = vec![
            Event::Start,
            Event::Comment { text: "a µ" },
            Event::Literal { text: "" },
            Event::Word { text: "M10" },
            Event::ToolChange {
                number: 3,
                register: 4,
                name: "ball 10",
            },
            Event::Preselect { number: 7 },
            Event::Spindle(Spindle::Off),
            Event::Spindle(Spindle::Orient),
            Event::Position {
                words: &words,
                feed: None,
            },
            Event::Release,
            Event::Rapid { words: &words },
            Event::Dwell { seconds: 2.5 },
            Event::Stop,
            Event::OptionalStop,
            Event::Home,
            Event::End,
            Event::Unknown { kind: 4711 },
        ];
        for sense in [SpindleSense::Clockwise, SpindleSense::CounterClockwise] {
            events.push(Event::Spindle(Spindle::On { rpm: 3000.0, sense }));
        }
        for coolant in [
            Coolant::Off,
            Coolant::Flood,
            Coolant::Mist,
            Coolant::Through,
            Coolant::Air,
        ] {
            events.push(Event::Coolant(coolant));
        }
        for compensation in [
            Compensation::Off,
            Compensation::Left { register: 5 },
            Compensation::Right { register: 6 },
        ] {
            events.push(Event::Compensate(compensation));
        }
        for feed in feeds {
            events.push(Event::Linear {
                words: &words,
                feed,
            });
            events.push(Event::Position {
                words: &words,
                feed: Some(feed),
            });
        }
        for event in events {
            // SAFETY: what the raw event points to outlives it.
            let back = unsafe { PostEvent::new(12, &event).get() };
            assert_eq!(back, Some(event));
        }
    }

    #[test]
    fn a_code_that_is_not_known_makes_the_event_unknown() {
        let mut raw = PostEvent::new(1, &Event::Coolant(Coolant::Flood));
        raw.code = 99;
        // SAFETY: the event has no pointers.
        let event = unsafe { raw.get() };
        assert_eq!(
            event,
            Some(Event::Unknown {
                kind: EVENT_COOLANT
            })
        );
    }
}
