//! An opened error model.

#![allow(unsafe_code)]

use std::any::Any;
use std::cell::RefCell;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use post_plugin::raw::{self, PostModel, PostPair};
use post_plugin::{Curve, Deviation, ModelSession, Tolerance};

use crate::call::Caller;
use crate::described::FunctionTable;
use crate::float_mode::FloatMode;
use crate::sink::message;
use crate::{GivenValue, Plugin, PluginFault, PluginKind, Reason, check_options};

/// An error model at work, for one thread.
#[derive(Debug)]
pub struct OpenedModel {
    plugin: String,
    caller: Caller,
    table: PostModel,
    ctx: *mut c_void,
    /// Why a value since the last fit could not be had.
    fault: RefCell<Option<String>>,
}

// SAFETY: the contract lets a context wander between threads, one call at a time; `value` takes `&self`,
// but the type is not `Sync`, so there is one call at a time.
unsafe impl Send for OpenedModel {}

impl Plugin {
    /// Opens this error model for one program and one thread.
    ///
    /// # Errors
    /// If it is no error model, an option does not fit, or it refuses.
    pub fn error_model(
        &self,
        options: &[(String, GivenValue)],
    ) -> Result<OpenedModel, PluginFault> {
        let FunctionTable::Model(table) = self.table else {
            return Err(self.other_kind(PluginKind::ErrorModel));
        };
        let options = check_options(self.options(), options)
            .map_err(|fault| self.fault(Reason::Option(Box::new(fault))))?;
        let pairs: Vec<PostPair> =
            options.iter().map(|(key, value)| PostPair::new(key, &value.as_value())).collect();
        let caller = self.caller();
        let mut ctx = std::ptr::null_mut();
        let refusal = message(|sink| {
            if let Some(open) = table.open {
                // SAFETY: the options and the sink live for the call.
                ctx = caller.call(|| unsafe { open(pairs.as_ptr(), pairs.len(), sink) });
            }
        });
        if ctx.is_null() {
            return Err(self.fault(Reason::Refused { message: refusal }));
        }
        Ok(OpenedModel { plugin: self.name.clone(), caller, table, ctx, fault: RefCell::new(None) })
    }
}

impl OpenedModel {
    fn say(&self, message: &str) -> String {
        format!("error model `{}`: {message}", self.plugin)
    }

    fn last_error(&self) -> String {
        let reason = message(|sink| {
            if let Some(last_error) = self.table.last_error {
                // SAFETY: the context is open and the sink lives for the call.
                self.caller.call(|| unsafe { last_error(self.ctx, sink) });
            }
        });
        self.say(&reason)
    }

    fn values<const N: usize>(
        &self,
        curve: &Curve,
        ts: [f64; N],
    ) -> Result<[Deviation; N], String> {
        let mut out = [Deviation::default(); N];
        // SAFETY: the context is open, all pointers live for the call and hold `N` things.
        let failed = self.table.value.is_none_or(|value| {
            let call = || unsafe { value(self.ctx, curve, N, ts.as_ptr(), out.as_mut_ptr()) };
            self.caller.short_call(call) != 0
        });
        if failed {
            return Err(self.last_error());
        }
        if out.iter().all(Deviation::is_finite) {
            Ok(out)
        } else {
            Err(self.say("the deviation of its curve is not a finite number"))
        }
    }

    /// Whether a curve of its answer can be: what the model answers is not believed before this.
    ///
    /// # Errors
    /// A sentence.
    pub fn check(&self, curve: &Curve) -> Result<(), String> {
        let peaks = [curve.tip_peak, curve.axis_peak];
        if !peaks.iter().all(|peak| peak.is_finite() && *peak >= 0.0) {
            return Err(
                self.say(&format!("its peaks are {} and {}", curve.tip_peak, curve.axis_peak))
            );
        }
        let places = [curve.tip_at, curve.axis_at];
        if !places.iter().all(|at| (0.0..=1.0).contains(at)) {
            return Err(self.say(&format!(
                "its peaks stand at {} and {}, outside the move",
                curve.tip_at, curve.axis_at
            )));
        }
        if !curve.terms.iter().all(|term| term.is_finite()) {
            return Err(self.say("a term of its curve is not a finite number"));
        }
        self.values(curve, [0.0, 0.5, 1.0]).map(|_| ())
    }

    /// The model's answer as it comes, which [`ModelSession::fit`] checks.
    ///
    /// # Errors
    /// Its sentence, or why it could not be asked.
    pub fn answer(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
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
            self.caller.call(call) != 0
        });
        if let Some(payload) = bridge.panic {
            // The panic was ours, not the plugin's.
            resume_unwind(payload);
        }
        if let Some(fault) = bridge.fault {
            return Err(self.say(&fault));
        }
        if failed {
            return Err(self.last_error());
        }
        Ok(curve)
    }
}

impl ModelSession for OpenedModel {
    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let curve = self.answer(tolerance, deviation)?;
        self.check(&curve)?;
        Ok(curve)
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        match self.values(curve, [t]) {
            Ok([deviation]) => deviation,
            Err(fault) => {
                self.fault.replace(Some(fault));
                Deviation::default()
            }
        }
    }

    fn fault(&self) -> Option<String> {
        self.fault.borrow().clone()
    }
}

impl Drop for OpenedModel {
    fn drop(&mut self) {
        if let Some(close) = self.table.close {
            // SAFETY: the context is open, and this is its last use.
            self.caller.call(|| unsafe { close(self.ctx) });
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
