//! Text out of a plugin, through a callback, so that no allocator is shared.

#![allow(unsafe_code)]

use std::ffi::c_void;

use post_plugin::raw::PostSink;

use crate::shown::sentence;

/// Most bytes of a program that a plugin may write in one call, that is for one batch: a batch is some 128 events,
/// and an event a line or a few.
pub(crate) const MOST_TEXT: usize = 16 << 20;

/// Most bytes of a sentence that are taken.
const MOST_MESSAGE: usize = 16 << 10;

/// What a sink leads to.
struct Taken<'a> {
    bytes: &'a mut Vec<u8>,
    most: usize,
    /// Why nothing more is taken.
    fault: Option<String>,
}

/// Runs `call` with a sink that appends to `out`, until that has `most` bytes. The sink is in force until `call`
/// returns.
///
/// # Errors
/// What was handed over was no text, or too much of it.
pub(crate) fn with_sink<R>(
    out: &mut Vec<u8>,
    most: usize,
    call: impl FnOnce(&PostSink) -> R,
) -> Result<R, String> {
    let mut taken = Taken { bytes: out, most, fault: None };
    let sink = PostSink { ctx: (&raw mut taken).cast(), write: Some(append) };
    let result = call(&sink);
    taken.fault.map_or(Ok(result), Err)
}

/// The text that `call` writes to its sink, for messages: on one line, cut if it is long, what is not UTF-8 replaced.
pub(crate) fn message(call: impl FnOnce(&PostSink)) -> String {
    let mut out = Vec::new();
    // Of a message that is too long the beginning is as good.
    let _ = with_sink(&mut out, MOST_MESSAGE, call);
    let text = sentence(&String::from_utf8_lossy(&out));
    if text.is_empty() {
        return "it gives no reason".to_owned();
    }
    text
}

unsafe extern "C" fn append(ctx: *mut c_void, ptr: *const u8, len: usize) {
    // SAFETY: `ctx` is what `with_sink` waits for, and nothing else uses it while the sink is in force.
    let taken = unsafe { &mut *ctx.cast::<Taken<'_>>() };
    if taken.fault.is_some() || len == 0 {
        return;
    }
    if ptr.is_null() {
        taken.fault = Some(format!("it handed over {len} bytes of text at a null pointer"));
        return;
    }
    if len > MOST_TEXT {
        taken.fault = Some(format!("it handed over {len} bytes of text at once"));
        return;
    }
    let room = taken.most.saturating_sub(taken.bytes.len());
    // SAFETY: not null; the plugin vouches for `len` bytes, of which no more are read than there is room for.
    let bytes = unsafe { post_plugin::raw::slice(ptr, len.min(room)) };
    taken.bytes.extend_from_slice(bytes);
    if len > room {
        taken.fault = Some(format!("it wrote more than {} bytes in one call", taken.most));
    }
}
