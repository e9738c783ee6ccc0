//! Text out of a plugin, through a callback, so that no allocator is shared.

#![allow(unsafe_code)]

use std::ffi::c_void;

use post_plugin::raw::PostSink;

/// Runs `call` with a sink that appends to `out`. The sink is in force until `call` returns.
pub(crate) fn with_sink<R>(out: &mut Vec<u8>, call: impl FnOnce(&PostSink) -> R) -> R {
    let sink = PostSink {
        ctx: (&raw mut *out).cast(),
        write: Some(append),
    };
    call(&sink)
}

/// The text that `call` writes to its sink, for messages: what is not UTF-8 is replaced.
pub(crate) fn message(call: impl FnOnce(&PostSink)) -> String {
    let mut out = Vec::new();
    with_sink(&mut out, call);
    let text = String::from_utf8_lossy(&out).trim().to_owned();
    if text.is_empty() {
        return "it gives no reason".to_owned();
    }
    text
}

unsafe extern "C" fn append(ctx: *mut c_void, ptr: *const u8, len: usize) {
    // SAFETY: `ctx` is the vector of `with_sink`, which nothing else uses while the sink is in force;
    // the plugin vouches for the bytes.
    let (out, bytes) = unsafe {
        (
            &mut *ctx.cast::<Vec<u8>>(),
            post_plugin::raw::slice(ptr, len),
        )
    };
    out.extend_from_slice(bytes);
}
