//! The way from the safe traits to the C contract: what the export lines expand to.
//!
//! Every entry catches panics, since none may cross the border; its message is kept for `last_error`.

#![allow(unsafe_code)]

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::ffi::c_void;
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{null, null_mut};
use std::sync::Once;

use crate::raw::{self, PostDialect, PostEmit, PostFormat, PostModel, PostPlugin, PostText};
use crate::raw::{PostDeviationFn, PostEmitWord, PostEvent, PostPair, PostSetup, PostSink};
use crate::{
    Batch, Capabilities, Curve, Deviation, Dialect, ErrorModel, Format, OptionSpec, Promise, Setup,
    Tolerance, VocabularyWord, WriteFault,
};

/// A plugin that is part of the program itself.
///
/// The host judges and describes it through what its library would export. An error model is called through that
/// as well; a dialect writes straight into the host's text, by the same code that stands behind the exported
/// functions.
#[derive(Clone, Copy, Debug)]
pub struct Linked {
    exported: &'static Exported,
    name: &'static str,
    options: fn() -> &'static [OptionSpec],
    open: Option<OpenLinked>,
}

type OpenLinked = fn(&Setup<'_>) -> Result<Box<dyn LinkedDialect>, String>;

/// An opened dialect that is part of the program itself.
pub trait LinkedDialect: Send {
    /// See [`Dialect::format`] and [`Dialect::capabilities`].
    ///
    /// # Errors
    /// The dialect panicked.
    fn format(&mut self) -> Result<(Format, Capabilities), String>;

    /// See [`Dialect::vocabulary`].
    ///
    /// # Errors
    /// The dialect panicked.
    fn vocabulary(&mut self) -> Result<Vec<VocabularyWord>, String>;

    /// See [`Dialect::relies_on`].
    ///
    /// # Errors
    /// The dialect panicked.
    fn relies_on(&mut self) -> Result<Vec<String>, String>;

    /// Appends the text of all events to `out`, and to `ends` the length of `out` after each.
    ///
    /// # Errors
    /// Which event breaks the promise or could not be written, and why; what was appended before it stays.
    fn write(
        &mut self,
        batch: &Batch,
        promise: &Promise,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault>;
}

impl Linked {
    /// Linked plugin of the export line of a dialect.
    #[doc(hidden)]
    pub const fn dialect<D: Dialect>(exported: &'static Exported, name: &'static str) -> Self {
        Linked { exported, name, options: D::options, open: Some(open_linked::<D>) }
    }

    /// Linked plugin of the export line of an error model.
    #[doc(hidden)]
    pub const fn model<M: ErrorModel>(exported: &'static Exported, name: &'static str) -> Self {
        Linked { exported, name, options: M::options, open: None }
    }

    /// What the library of this plugin would export.
    pub fn raw(self) -> &'static PostPlugin {
        &self.exported.0
    }

    /// Name of the plugin, as in a machine file.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Whether the plugin is an error model, else a dialect.
    pub fn is_model(self) -> bool {
        self.open.is_none()
    }

    /// The options that it declares.
    pub fn options(self) -> &'static [OptionSpec] {
        (self.options)()
    }

    /// Opens it for a program; none if it is no dialect.
    pub fn open(self, setup: &Setup<'_>) -> Option<Result<Box<dyn LinkedDialect>, String>> {
        self.open.map(|open| open(setup))
    }
}

fn open_linked<D: Dialect>(setup: &Setup<'_>) -> Result<Box<dyn LinkedDialect>, String> {
    let value = guarded(|| D::open(setup))?;
    Ok(Box::new(Context::new(value)))
}

impl<D: Dialect> LinkedDialect for Context<D> {
    fn format(&mut self) -> Result<(Format, Capabilities), String> {
        self.run(|dialect| Ok((dialect.format(), dialect.capabilities())))
            .ok_or_else(|| self.error.clone())
    }

    fn vocabulary(&mut self) -> Result<Vec<VocabularyWord>, String> {
        self.run(|dialect| Ok(dialect.vocabulary())).ok_or_else(|| self.error.clone())
    }

    fn relies_on(&mut self) -> Result<Vec<String>, String> {
        self.run(|dialect| Ok(dialect.relies_on())).ok_or_else(|| self.error.clone())
    }

    fn write(
        &mut self,
        batch: &Batch,
        promise: &Promise,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        let mut index = 0;
        let (base, first) = (out.len(), ends.len());
        let mut good = base;
        let done = self.run(|dialect| {
            for event in batch.iter() {
                event.check(promise)?;
                dialect.write(&event, out)?;
                if out.len() < good {
                    return Err(TOOK_BACK.to_owned());
                }
                good = out.len();
                ends.push(good);
                index += 1;
            }
            Ok(())
        });
        match done {
            Some(()) => Ok(()),
            None if out.len() < good => {
                // Whatever else it says: nothing of this batch can be believed.
                ends.truncate(first);
                out.truncate(base);
                out.extend(std::iter::repeat_n('\n', base - out.len()));
                let message = TOOK_BACK.to_owned();
                Err(WriteFault { index: 0, message })
            }
            None => {
                out.truncate(good);
                let message = self.error.clone();
                Err(WriteFault { index, message })
            }
        }
    }
}

/// A [`PostPlugin`] whose functions are those of this module, so that safe code can vouch for it.
#[doc(hidden)]
#[derive(Debug)]
#[repr(transparent)]
pub struct Exported(PostPlugin);

impl Exported {
    pub const fn dialect<D: Dialect>(
        name: &'static str,
        version: &'static str,
        about: &'static str,
    ) -> Self {
        let mut plugin = common([name, version, about], raw::KIND_DIALECT);
        plugin.describe = Some(describe_dialect::<D>);
        plugin.table_size = size_of::<PostDialect>() as u32;
        plugin.dialect = PluginFunctions::<D>::DIALECT;
        Exported(plugin)
    }

    pub const fn model<M: ErrorModel>(
        name: &'static str,
        version: &'static str,
        about: &'static str,
    ) -> Self {
        let mut plugin = common([name, version, about], raw::KIND_MODEL);
        plugin.describe = Some(describe_model::<M>);
        plugin.table_size = size_of::<PostModel>() as u32;
        plugin.model = PluginFunctions::<M>::MODEL;
        Exported(plugin)
    }
}

const fn common([name, version, about]: [&'static str; 3], kind: u32) -> PostPlugin {
    PostPlugin {
        magic: raw::MAGIC,
        abi: raw::ABI,
        kind,
        size: size_of::<PostPlugin>() as u32,
        table_size: 0,
        layout: raw::LAYOUT,
        name: PostText::new(name),
        version: PostText::new(version),
        describe: None,
        loaded: Some(loaded),
        dialect: null(),
        model: null(),
        about: PostText::new(about),
    }
}

/// Exports a [`Dialect`](crate::Dialect) as `post_plugin_<name>` from the crate `post_<name>`, and makes
/// `pub fn plugin() -> Linked` for those who link the crate.
///
/// The symbol carries the name, so that several plugins can be linked into one program. Version and description are
/// those of the crate.
///
/// ```ignore
/// post_plugin::export_dialect!(fanuc, Fanuc);
/// ```
#[macro_export]
macro_rules! export_dialect {
    ($name:ident, $type:ty) => {
        $crate::export_plugin!($name, $type, dialect);
    };
}

/// Exports an [`ErrorModel`](crate::ErrorModel), as [`export_dialect!`] does a dialect.
#[macro_export]
macro_rules! export_error_model {
    ($name:ident, $type:ty) => {
        $crate::export_plugin!($name, $type, model);
    };
}

#[doc(hidden)]
#[macro_export]
macro_rules! export_plugin {
    ($name:ident, $type:ty, $kind:ident) => {
        const _: () = assert!(
            $crate::export::names_crate(stringify!($name), option_env!("CARGO_CRATE_NAME")),
            concat!("the crate of this plugin must be called post_", stringify!($name)),
        );

        #[allow(unsafe_code)]
        #[unsafe(export_name = concat!("post_plugin_", stringify!($name)))]
        static POST_PLUGIN: $crate::export::Exported = $crate::export::Exported::$kind::<$type>(
            stringify!($name),
            env!("CARGO_PKG_VERSION"),
            env!("CARGO_PKG_DESCRIPTION"),
        );

        /// This plugin, linked in.
        pub const fn plugin() -> $crate::Linked {
            $crate::Linked::$kind::<$type>(&POST_PLUGIN, stringify!($name))
        }
    };
}

/// The crate is `post_<name>`: the host derives the symbol from the file's name, and that is the crate's.
#[doc(hidden)]
pub const fn names_crate(name: &str, krate: Option<&str>) -> bool {
    // Built without cargo: nothing to compare with.
    let Some(krate) = krate else { return true };
    let (name, krate) = (name.as_bytes(), krate.as_bytes());
    let prefix = b"post_";
    if krate.len() != prefix.len() + name.len() {
        return false;
    }
    let mut index = 0;
    while index < krate.len() {
        let wanted = if index < prefix.len() { prefix[index] } else { name[index - prefix.len()] };
        if krate[index] != wanted {
            return false;
        }
        index += 1;
    }
    true
}

thread_local! {
    /// How many entries of this plugin are running on this thread.
    static INSIDE: Cell<u32> = const { Cell::new(0) };
    /// Where the last panic inside an entry was raised.
    static PLACE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// A library has its own copy of std, whose panic printer would write to the user's terminal behind the
/// host's back; it is silenced while an entry runs. A linked-in plugin shares the host's std, and there
/// the hook is the host's own: so the host calls this for opened libraries alone.
unsafe extern "C" fn loaded() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if INSIDE.get() == 0 {
                previous(info);
            } else if let Some(place) = info.location() {
                PLACE.set(format!(" ({place})"));
            }
        }));
    });
}

/// Runs `call`; a panic becomes its message.
fn guarded<R>(call: impl FnOnce() -> Result<R, String>) -> Result<R, String> {
    PLACE.take();
    INSIDE.set(INSIDE.get() + 1);
    let outcome = catch_unwind(AssertUnwindSafe(call));
    INSIDE.set(INSIDE.get() - 1);
    outcome.unwrap_or_else(|payload| {
        Err(format!("the plugin panicked: {}{}", message(payload), PLACE.take()))
    })
}

fn message(payload: Box<dyn Any + Send>) -> String {
    if let Some(text) = payload.downcast_ref::<&str>() {
        return (*text).to_owned();
    }
    if let Some(text) = payload.downcast_ref::<String>() {
        return text.clone();
    }
    // The payload's own destructor could panic once more.
    std::mem::forget(payload);
    "without a message".to_owned()
}

/// An open plugin with what its last call left behind.
struct Context<T> {
    value: T,
    error: String,
    text: String,
    /// Whether a call has panicked: the value may be half-changed, so it is not used again.
    broken: bool,
}

impl<T> Context<T> {
    fn new(value: T) -> Self {
        Context { value, error: String::new(), text: String::new(), broken: false }
    }

    /// Runs `call` on the value, keeping the message if it fails.
    fn run<R>(&mut self, call: impl FnOnce(&mut T) -> Result<R, String>) -> Option<R> {
        if self.broken {
            return None;
        }
        self.broken = true;
        let value = &mut self.value;
        // The inner result is the author's, the outer one fails only by a panic.
        match guarded(|| Ok(call(value))) {
            Ok(outcome) => {
                self.broken = false;
                outcome.map_err(|error| self.error = error).ok()
            }
            Err(error) => {
                self.error = error;
                None
            }
        }
    }
}

/// Moves a fresh value behind a pointer, or reports why there is none.
///
/// # Safety
/// `error` is null or a sink in force.
unsafe fn hand_over<T>(opened: Result<T, String>, error: *const PostSink) -> *mut c_void {
    match opened {
        Ok(value) => Box::into_raw(Box::new(Context::new(value))).cast(),
        Err(message) => {
            // SAFETY: the caller vouches for the sink.
            if let Some(sink) = unsafe { error.as_ref() } {
                unsafe { sink.put(&message) };
            }
            null_mut()
        }
    }
}

/// # Safety
/// `ctx` came from [`hand_over`] with the same `T` and was not closed; no other call uses it.
unsafe fn context<'a, T>(ctx: *mut c_void) -> &'a mut Context<T> {
    // SAFETY: the caller vouches for it.
    unsafe { &mut *ctx.cast::<Context<T>>() }
}

const TOOK_BACK: &str = "it took back text of earlier events";

const NOT_TEXT: &str = "the host handed over text that is not UTF-8";

struct PluginFunctions<T>(PhantomData<T>);

impl<D: Dialect> PluginFunctions<D> {
    const DIALECT: &'static PostDialect = &PostDialect {
        open: Some(open_dialect::<D>),
        format: Some(format::<D>),
        write: Some(write::<D>),
        last_error: Some(last_error::<D>),
        close: Some(close::<D>),
        vocabulary: Some(vocabulary::<D>),
        relies_on: Some(relies_on::<D>),
    };
}

impl<M: ErrorModel> PluginFunctions<M> {
    const MODEL: &'static PostModel = &PostModel {
        open: Some(open_model::<M>),
        fit: Some(fit::<M>),
        value: Some(value::<M>),
        last_error: Some(last_error::<M>),
        close: Some(close::<M>),
    };
}

// Safety of all entries below: the host keeps the promises that `raw` states on each function pointer,
// so every pointer is valid for the call, and a context is in use by one call at a time.

unsafe extern "C" fn describe_dialect<D: Dialect>(host: *mut c_void, emit: PostEmit) {
    // SAFETY: as stated above.
    unsafe { describe(D::options, host, emit) };
}

unsafe extern "C" fn describe_model<M: ErrorModel>(host: *mut c_void, emit: PostEmit) {
    // SAFETY: as stated above.
    unsafe { describe(M::options, host, emit) };
}

/// # Safety
/// `emit` accepts `host`.
unsafe fn describe(
    options: impl FnOnce() -> &'static [OptionSpec],
    host: *mut c_void,
    emit: PostEmit,
) {
    // A plugin that panics here declares nothing, so the first option given is refused as unknown.
    for spec in guarded(|| Ok(options())).unwrap_or_default() {
        // SAFETY: the caller vouches for it.
        raw::with_option(spec, |option| unsafe { emit(host, option) });
    }
}

unsafe extern "C" fn open_dialect<D: Dialect>(
    setup: *const PostSetup,
    error: *const PostSink,
) -> *mut c_void {
    // SAFETY: as stated above.
    let opened = guarded(|| {
        unsafe { PostSetup::with(setup, D::open) }.unwrap_or_else(|| Err(NOT_TEXT.to_owned()))
    });
    unsafe { hand_over(opened, error) }
}

unsafe extern "C" fn format<D: Dialect>(ctx: *mut c_void, out: *mut PostFormat) -> i32 {
    // SAFETY: as stated above.
    let context = unsafe { context::<D>(ctx) };
    let format = context.run(|dialect| {
        PostFormat::new(&dialect.format(), dialect.capabilities())
            .ok_or_else(|| "its format has too many words or too long an extension".to_owned())
    });
    match format {
        Some(format) => {
            // SAFETY: as stated above.
            unsafe { format.write(out) };
            0
        }
        None => 1,
    }
}

unsafe extern "C" fn write<D: Dialect>(
    ctx: *mut c_void,
    events: *const PostEvent,
    n: usize,
    out: *const PostSink,
    ends: *mut u64,
) -> usize {
    // SAFETY: as stated above.
    let context = unsafe { context::<D>(ctx) };
    let events = unsafe { raw::slice(events, n) };
    let mut text = std::mem::take(&mut context.text);
    text.clear();
    let mut written = 0;
    let mut good = 0;
    context.run(|dialect| {
        for event in events {
            // SAFETY: as stated above.
            let event = unsafe { event.get() }.ok_or_else(|| NOT_TEXT.to_owned())?;
            dialect.write(&event, &mut text)?;
            good = text.len();
            // SAFETY: `ends` has room for `n` numbers, and `written` is less.
            unsafe { *ends.add(written) = good as u64 };
            written += 1;
        }
        Ok(())
    });
    // SAFETY: as stated above. What an event left before it failed is not handed on; an author who
    // shortened the text is found out by the host, since the ends are then not in order.
    unsafe { (*out).put(text.get(..good).unwrap_or_default()) };
    context.text = text;
    written
}

unsafe extern "C" fn vocabulary<D: Dialect>(
    ctx: *mut c_void,
    host: *mut c_void,
    emit: PostEmitWord,
) -> i32 {
    // SAFETY: as stated above.
    let context = unsafe { context::<D>(ctx) };
    let Some(words) = context.run(|dialect| Ok(dialect.vocabulary())) else {
        return 1;
    };
    for VocabularyWord { word, meaning } in &words {
        // SAFETY: as stated above; the word lives for the call.
        unsafe { emit(host, meaning.number(), word.as_ptr(), word.len()) };
    }
    0
}

unsafe extern "C" fn relies_on<D: Dialect>(ctx: *mut c_void, out: *const PostSink) -> i32 {
    // SAFETY: as stated above.
    let context = unsafe { context::<D>(ctx) };
    let Some(sentences) = context.run(|dialect| Ok(dialect.relies_on())) else {
        return 1;
    };
    // SAFETY: as stated above.
    unsafe { (*out).put(&sentences.join("\n")) };
    0
}

unsafe extern "C" fn open_model<M: ErrorModel>(
    options: *const PostPair,
    n: usize,
    error: *const PostSink,
) -> *mut c_void {
    // SAFETY: as stated above.
    let opened = guarded(|| match unsafe { raw::pairs(options, n) } {
        Some(options) => M::open(&options),
        None => Err(NOT_TEXT.to_owned()),
    });
    unsafe { hand_over(opened, error) }
}

unsafe extern "C" fn fit<M: ErrorModel>(
    ctx: *mut c_void,
    tolerance: *const Tolerance,
    deviation: PostDeviationFn,
    host: *mut c_void,
    curve: *mut Curve,
) -> i32 {
    // SAFETY: as stated above.
    let (context, tolerance) = unsafe { (context::<M>(ctx), &*tolerance) };
    let fitted = context.run(|model| {
        model.fit(tolerance, &mut |ts, out| {
            let n = ts.len().min(out.len());
            // SAFETY: both hold `n` numbers, and the call is inside `fit`.
            unsafe { deviation(host, n, ts.as_ptr(), out.as_mut_ptr()) };
        })
    });
    match fitted {
        Some(fitted) => {
            // SAFETY: as stated above.
            unsafe { *curve = fitted };
            0
        }
        None => 1,
    }
}

unsafe extern "C" fn value<M: ErrorModel>(
    ctx: *mut c_void,
    curve: *const Curve,
    n: usize,
    ts: *const f64,
    out: *mut Deviation,
) -> i32 {
    // SAFETY: as stated above; `out` has room for `n` deviations.
    let (context, curve) = unsafe { (context::<M>(ctx), &*curve) };
    let ts = unsafe { raw::slice(ts, n) };
    let done = context.run(|model| {
        for (index, t) in ts.iter().enumerate() {
            unsafe { *out.add(index) = model.value(curve, *t) };
        }
        Ok(())
    });
    i32::from(done.is_none())
}

unsafe extern "C" fn last_error<T>(ctx: *mut c_void, out: *const PostSink) {
    // SAFETY: as stated above.
    unsafe { (*out).put(&context::<T>(ctx).error) };
}

unsafe extern "C" fn close<T>(ctx: *mut c_void) {
    // SAFETY: as stated above; the host does not use `ctx` again.
    let context = unsafe { Box::from_raw(ctx.cast::<Context<T>>()) };
    // A destructor that panics has nobody to tell.
    let _ = guarded(|| {
        drop(context);
        Ok(())
    });
}
