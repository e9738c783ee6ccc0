//! An error model behind the C contract.

#![allow(unsafe_code)]

use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use post_plugin::raw::{self, PostModel, PostPair};
use post_plugin::{Curve, Deviation, Tolerance};

use crate::call::Caller;
use crate::described::FunctionTable;
use crate::float_mode::FloatMode;
use crate::function::Function;
use crate::sink::message;
use crate::{GivenValue, Plugin};

/// A context behind the C contract.
#[derive(Debug)]
pub(crate) struct LibraryModel {
    caller: Caller,
    table: PostModel,
    ctx: *mut c_void,
}

// SAFETY: the contract lets a context wander between threads, one call at a time; `values` takes `&self`,
// but the type is not `Sync`, so there is one call at a time.
unsafe impl Send for LibraryModel {}

impl LibraryModel {
    /// Opens a plugin that is no other kind; the options are complete.
    ///
    /// # Errors
    /// Why it refuses.
    pub(crate) fn open_plugin(
        plugin: &Plugin,
        options: &[(String, GivenValue)],
    ) -> Result<Self, String> {
        let FunctionTable::Model(table) = plugin.table else {
            return Err("it is no error model".to_owned());
        };
        let pairs: Vec<PostPair> =
            options.iter().map(|(key, value)| PostPair::new(key, &value.as_value())).collect();
        let caller = plugin.caller();
        let mut ctx = std::ptr::null_mut();
        let refusal = message(|sink| {
            if let Some(open) = table.open {
                // SAFETY: the options and the sink live for the call.
                ctx = caller
                    .call(Function::Open, || unsafe { open(pairs.as_ptr(), pairs.len(), sink) });
            }
        });
        if ctx.is_null() {
            return Err(refusal);
        }
        // From here on, dropping it closes the context.
        Ok(LibraryModel { caller, table, ctx })
    }

    fn last_error(&self) -> String {
        message(|sink| {
            if let Some(last_error) = self.table.last_error {
                // SAFETY: the context is open and the sink lives for the call.
                self.caller.call(Function::LastError, || unsafe { last_error(self.ctx, sink) });
            }
        })
    }

    /// Deviations of a fitted curve at `ts`, to as many of `out`.
    ///
    /// # Errors
    /// Its sentence.
    pub(crate) fn values(
        &self,
        curve: &Curve,
        ts: &[f64],
        out: &mut [Deviation],
    ) -> Result<(), String> {
        let count = ts.len().min(out.len());
        // SAFETY: the context is open, all pointers live for the call and hold `count` things.
        let failed = self.table.value.is_none_or(|value| {
            let call = || unsafe { value(self.ctx, curve, count, ts.as_ptr(), out.as_mut_ptr()) };
            self.caller.short_call(Function::Value, call) != 0
        });
        if failed { Err(self.last_error()) } else { Ok(()) }
    }

    /// The model's answer as it comes.
    ///
    /// # Errors
    /// Its sentence, or why it could not be asked.
    pub(crate) fn answer(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let mut bridge = Bridge { deviation, mode: FloatMode::now(), panic: None, fault: None };
        let mut curve = Curve {
            tip_peak: f64::NAN,
            tip_at: f64::NAN,
            axis_peak: f64::NAN,
            axis_at: f64::NAN,
            terms: [0.0; 60],
        };
        // SAFETY: the context is open, all pointers live for the call, and `ask` takes the bridge.
        let host = (&raw mut bridge).cast();
        let failed = self.table.fit.is_none_or(|fit| {
            let call = || unsafe { fit(self.ctx, tolerance, ask, host, &mut curve) };
            self.caller.call(Function::Fit, call) != 0
        });
        if let Some(payload) = bridge.panic {
            // The panic was ours, not the plugin's.
            resume_unwind(payload);
        }
        if let Some(fault) = bridge.fault {
            return Err(fault);
        }
        if failed {
            return Err(self.last_error());
        }
        Ok(curve)
    }
}

impl Drop for LibraryModel {
    fn drop(&mut self) {
        if let Some(close) = self.table.close {
            // SAFETY: the context is open, and this is its last use.
            self.caller.call(Function::Close, || unsafe { close(self.ctx) });
        }
    }
}

/// Most places of a move that a model may ask for at once.
const MOST_PLACES: usize = 1 << 20;

/// The host's function on its way through the plugin.
struct Bridge<'a> {
    deviation: &'a mut dyn FnMut(&[f64], &mut [Deviation]),
    /// The host computes with its own rounding, whatever the plugin has set.
    mode: FloatMode,
    /// No panic may cross the plugin, so it waits here.
    panic: Option<Box<dyn Any + Send>>,
    /// What the plugin asked for that cannot be answered.
    fault: Option<String>,
}

unsafe extern "C" fn ask(host: *mut c_void, n: usize, ts: *const f64, out: *mut Deviation) {
    // SAFETY: `host` is the bridge of `fit`, which waits for this call.
    let bridge = unsafe { &mut *host.cast::<Bridge<'_>>() };
    if n == 0 || bridge.panic.is_some() || bridge.fault.is_some() {
        return;
    }
    bridge.fault = if n > MOST_PLACES {
        Some(format!("it asks for {n} deviations at once"))
    } else if ts.is_null() || out.is_null() {
        Some("it asks for deviations by a null pointer".to_owned())
    } else if !ts.is_aligned() || !out.is_aligned() {
        Some("it asks for deviations by a pointer that is not aligned".to_owned())
    } else {
        None
    };
    if bridge.fault.is_some() {
        return;
    }
    // SAFETY: the plugin vouches for `n` places to read and to write. The latter may be fresh memory, so they are
    // filled before they are borrowed.
    let (ts, out) = unsafe {
        for index in 0..n {
            out.add(index).write(Deviation::default());
        }
        (raw::slice(ts, n), std::slice::from_raw_parts_mut(out, n))
    };
    let of_plugin = FloatMode::now();
    bridge.mode.restore();
    let call = AssertUnwindSafe(|| (bridge.deviation)(ts, out));
    bridge.panic = catch_unwind(call).err();
    of_plugin.restore();
}
