//! A dialect behind the C contract: batches go in raw, and how its answer holds together is checked.

#![allow(unsafe_code)]

use std::ffi::c_void;

use post_plugin::raw::{self, PostDialect, PostEvent, PostFormat, PostText};
use post_plugin::{Batch, Promise, Setup, VocabularyWord, WriteFault};

use crate::call::Caller;
use crate::described::FunctionTable;
use crate::ends::Ends;
use crate::function::Function;
#[cfg(unix)]
use crate::isolation::Progress;
use crate::sink::{MOST_TEXT, message, with_sink};
use crate::{Plugin, ProgramSetup, vocabulary};

/// A context behind the C contract.
pub(crate) struct LibraryDialect {
    caller: Caller,
    table: PostDialect,
    ctx: *mut c_void,
    /// The batch in its raw form; empty but during a call.
    events: Vec<PostEvent>,
    texts: Vec<PostText>,
    ends: Ends,
    /// What it wrote, before it is believed.
    written: Vec<u8>,
}

// SAFETY: the contract lets a context wander between threads, one call at a time, and `&mut self` sees
// to that; events and texts hold pointers only during a call.
unsafe impl Send for LibraryDialect {}

impl LibraryDialect {
    /// Opens a plugin that is no other kind, for a setup whose options are complete.
    ///
    /// # Errors
    /// Why it refuses.
    pub(crate) fn open_plugin(plugin: &Plugin, setup: &ProgramSetup) -> Result<Self, String> {
        let FunctionTable::Dialect(table) = &plugin.table else {
            return Err("it is no dialect".to_owned());
        };
        setup.with(&setup.options, |setup| Self::open(plugin.caller(), *table, setup))
    }

    /// # Errors
    /// Why it refuses.
    pub(crate) fn open(
        caller: Caller,
        table: PostDialect,
        setup: &Setup<'_>,
    ) -> Result<Self, String> {
        let mut ctx = std::ptr::null_mut();
        let refusal = message(|sink| {
            raw::with_setup(setup, |setup| {
                if let Some(open) = table.open {
                    // SAFETY: the setup and the sink live for the call.
                    ctx = caller.call(Function::Open, || unsafe { open(setup, sink) });
                }
            });
        });
        if ctx.is_null() {
            return Err(refusal);
        }
        // From here on, dropping it closes the context.
        Ok(LibraryDialect {
            caller,
            table,
            ctx,
            events: Vec::new(),
            texts: Vec::new(),
            ends: Ends::default(),
            written: Vec::new(),
        })
    }

    /// Its format as it comes, which [`judged_format`](crate::dialect::judged_format) reads.
    ///
    /// # Errors
    /// Why it cannot tell.
    pub(crate) fn raw_format(&self) -> Result<PostFormat, String> {
        let mut raw = PostFormat::EMPTY;
        // SAFETY: the context is open and `raw` lives for the call.
        let failed = self.table.format.is_none_or(|format| {
            self.caller.call(Function::Format, || unsafe { format(self.ctx, &mut raw) }) != 0
        });
        if failed {
            return Err(self.last_error());
        }
        Ok(raw)
    }

    /// Tells where events end in memory that another process sees; or gives that memory back.
    #[cfg(unix)]
    pub(crate) fn progress(&mut self) -> &mut Option<Progress> {
        &mut self.ends.progress
    }

    pub(crate) fn vocabulary(&self) -> Result<Vec<VocabularyWord>, String> {
        let Some(vocabulary) = self.table.vocabulary else {
            return Ok(Vec::new());
        };
        let asked = vocabulary::taken(|host, emit| {
            // SAFETY: the context is open, and `emit` takes `host`.
            self.caller.call(Function::Vocabulary, || unsafe { vocabulary(self.ctx, host, emit) })
        });
        match asked {
            (0, words) => words,
            _ => Err(self.last_error()),
        }
    }

    pub(crate) fn relies_on(&self) -> Result<Vec<String>, String> {
        let Some(relies_on) = self.table.relies_on else {
            return Ok(Vec::new());
        };
        let mut told = Vec::new();
        let code = with_sink(&mut told, MOST_TEXT, |sink| {
            // SAFETY: the context is open and the sink lives for the call.
            self.caller.call(Function::ReliesOn, || unsafe { relies_on(self.ctx, sink) })
        })?;
        if code != 0 {
            return Err(self.last_error());
        }
        let text = String::from_utf8(told)
            .map_err(|_| "what its programs rely on is not UTF-8".to_owned())?;
        Ok(text.lines().map(str::to_owned).collect())
    }

    fn last_error(&self) -> String {
        message(|sink| {
            if let Some(last_error) = self.table.last_error {
                // SAFETY: the context is open and the sink lives for the call.
                self.caller.call(Function::LastError, || unsafe { last_error(self.ctx, sink) });
            }
        })
    }

    /// Calls the plugin on the first `count` events of `batch`; says how many it wrote, or why its answer is not
    /// believed.
    fn call(&mut self, batch: &Batch, count: usize) -> Result<usize, String> {
        raw::events(batch, count, &mut self.events, &mut self.texts);
        self.written.clear();
        let events = self.events.as_ptr();
        let Some(write) = self.table.write else {
            return Err("it has no `write`".to_owned());
        };
        let ctx = self.ctx;
        // SAFETY: the events and what they point to (the batch) live for the call, `ends` has room for
        // one number each, the sink is in force, and the context is open and used by this call alone.
        let (caller, out) = (&self.caller, &mut self.written);
        let written = self.ends.tell(count, |ends| {
            let ends = ends.as_mut_ptr();
            with_sink(out, MOST_TEXT, |sink| {
                caller.call(Function::Write, || unsafe { write(ctx, events, count, sink, ends) })
            })
        });
        // They point into the batch, which is the caller's.
        self.events.clear();
        self.texts.clear();
        let written = written?;
        if written > count {
            return Err(format!("it says it wrote {written} events of {count}"));
        }
        Ok(written)
    }

    /// As [`LinkedDialect::write`].
    pub(crate) fn write(
        &mut self,
        batch: &Batch,
        promise: &Promise,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        let broken = batch.iter().enumerate().find_map(|(index, event)| {
            let message = event.check(promise).err()?;
            Some(WriteFault { index, message })
        });
        let asked = broken.as_ref().map_or(batch.len(), |fault| fault.index);
        let fault = |index, message| Err(WriteFault { index, message });
        let written = match self.call(batch, asked) {
            Ok(written) => written,
            Err(message) => return fault(0, message),
        };
        // All at once; event by event only to name the one that is at fault.
        let whole = std::str::from_utf8(&self.written);
        let base = out.len();
        let mut from = 0;
        for index in 0..written {
            let to = usize::try_from(self.ends.told()[index]).ok();
            let piece = to.and_then(|to| Some((to, self.written.get(from..to)?)));
            let Some((to, piece)) = piece else {
                return fault(index, "the end of its text is not where it says".to_owned());
            };
            // Whole text may still be cut within a letter.
            let text = match whole {
                Ok(whole) => whole.get(from..to),
                Err(_) => std::str::from_utf8(piece).ok(),
            };
            let Some(text) = text else {
                return fault(index, "its text is not UTF-8".to_owned());
            };
            out.push_str(text);
            from = to;
            ends.push(base + from);
        }
        if written < asked {
            return fault(written, self.last_error());
        }
        if from != self.written.len() {
            let message = "it wrote text that belongs to no event".to_owned();
            return fault(written.saturating_sub(1), message);
        }
        broken.map_or(Ok(()), Err)
    }
}

impl Drop for LibraryDialect {
    fn drop(&mut self) {
        if let Some(close) = self.table.close {
            // SAFETY: the context is open, and this is its last use.
            self.caller.call(Function::Close, || unsafe { close(self.ctx) });
        }
    }
}
