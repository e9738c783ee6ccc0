//! What JavaScript calls: a place for a request, the request done, and where its answer stands. What it lends: two
//! functions of the module `post`.

// Exported names and borrowed functions are beyond what the compiler can check.
#![allow(unsafe_code)]

use std::cell::RefCell;
use std::panic;

use crate::request;

thread_local! {
    /// The request that is written, and the answer that is read.
    static REQUEST: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Where a request of so many bytes is written to, until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        request.clear();
        request.resize(length, 0);
        request.as_mut_ptr()
    })
}

/// Does the request that was written: length of its answer, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    panic::set_hook(Box::new(|what| lent::tell_panic(&what.to_string())));
    let answer = REQUEST.with_borrow(|request| request::answer(request));
    ANSWER.with_borrow_mut(|kept| {
        *kept = answer;
        kept.len()
    })
}

/// Where the answer stands, until the next request.
#[unsafe(no_mangle)]
pub extern "C" fn answer_at() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}

/// What JavaScript lends.
#[cfg(target_family = "wasm")]
pub mod lent {
    mod post {
        #[link(wasm_import_module = "post")]
        unsafe extern "C" {
            /// So many bytes of so many are read; of fewer than none if it is not known how many there are.
            pub safe fn progress(done: f64, of: f64);
            /// The module dies: why, as UTF-8.
            pub safe fn died(at: *const u8, length: usize);
        }
    }

    /// So many bytes of so many are read.
    pub fn tell_progress(done: f64, of: f64) {
        post::progress(done, of);
    }

    /// Why the module dies.
    pub fn tell_panic(why: &str) {
        post::died(why.as_ptr(), why.len());
    }
}

/// Nobody lends anything to what is no module.
#[cfg(not(target_family = "wasm"))]
pub mod lent {
    /// Nobody hears it.
    pub fn tell_progress(_: f64, _: f64) {}

    /// Nobody hears it.
    pub fn tell_panic(_: &str) {}
}
