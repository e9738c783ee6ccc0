//! An opened dialect: batches go in raw, and the text that comes back is checked.

#![allow(unsafe_code)]

use std::ffi::c_void;

use post_plugin::raw::{self, PostDialect, PostEvent, PostFormat};
use post_plugin::{
    AxisWord, Batch, DialectSession, Event, Feed, Format, Setup, Spindle, Units, Value, WriteFault,
};

use crate::plugin::Table;
use crate::sink::{message, with_sink};
use crate::{GivenValue, Kind, Plugin, PluginFault, Reason, check_options};

/// What a dialect is told about a program.
#[derive(Clone, Debug)]
pub struct ProgramSetup {
    /// Name of the program (the output file's stem).
    pub program: String,
    /// Name of the machine.
    pub machine: String,
    /// Units of the program.
    pub units: Units,
    /// See [`Setup::tcp`].
    pub tcp: bool,
    /// The axis words, in the order in which they are written.
    pub words: Vec<ProgramWord>,
    /// The options of the machine file, as given.
    pub options: Vec<(String, GivenValue)>,
}

/// See [`AxisWord`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProgramWord {
    /// Its address.
    pub name: String,
    /// A rotary axis.
    pub rotary: bool,
    /// Its words lie within one turn.
    pub wrapped: bool,
    /// The linear axis along the spindle.
    pub depth: bool,
}

/// A dialect that is writing a program.
#[derive(Debug)]
pub struct OpenedDialect {
    plugin: String,
    table: &'static PostDialect,
    ctx: *mut c_void,
    format: Format,
    /// The batch in its raw form; empty but during a call.
    events: Vec<PostEvent>,
    ends: Vec<u64>,
}

// SAFETY: the contract lets a context wander between threads, one call at a time, and `&mut self` sees
// to that; the events hold pointers only during a call.
unsafe impl Send for OpenedDialect {}

impl Plugin {
    /// Opens this dialect for one program.
    ///
    /// # Errors
    /// If it is no dialect, an option does not fit, or it refuses.
    pub fn dialect(&self, setup: &ProgramSetup) -> Result<OpenedDialect, PluginFault> {
        let Table::Dialect(table) = self.table else {
            return Err(self.other_kind(Kind::Dialect));
        };
        if setup.words.len() > raw::MAX_WORDS {
            return Err(self.fault(Reason::Refused {
                message: format!("a program may have {} axis words", raw::MAX_WORDS),
            }));
        }
        let options = check_options(self.options(), &setup.options)
            .map_err(|fault| self.fault(Reason::Option(fault)))?;
        let options: Vec<(&str, Value<'_>)> = options
            .iter()
            .map(|(key, value)| (key.as_str(), value.as_value()))
            .collect();
        let words: Vec<AxisWord<'_>> = setup
            .words
            .iter()
            .map(|word| AxisWord {
                name: &word.name,
                rotary: word.rotary,
                wrapped: word.wrapped,
                depth: word.depth,
            })
            .collect();
        let setup = Setup {
            program: &setup.program,
            machine: &setup.machine,
            units: setup.units,
            tcp: setup.tcp,
            words: &words,
            options: &options,
        };
        let mut ctx = std::ptr::null_mut();
        let refusal = message(|sink| {
            ctx = raw::with_setup(&setup, |setup| {
                // SAFETY: the setup and the sink live for the call; the pointer was checked at loading.
                table
                    .open
                    .map_or(std::ptr::null_mut(), |open| unsafe { open(setup, sink) })
            });
        });
        if ctx.is_null() {
            return Err(self.fault(Reason::Refused { message: refusal }));
        }
        // From here on, dropping it closes the context.
        let mut opened = OpenedDialect {
            plugin: self.name.clone(),
            table,
            ctx,
            format: Format {
                words: Vec::new(),
                feed: 0,
                inverse_time: None,
                feed_per_revolution: 0,
                extension: String::new(),
            },
            events: Vec::new(),
            ends: Vec::new(),
        };
        opened.format = opened
            .ask_format(words.len())
            .map_err(|message| self.fault(Reason::Nonsense { message }))?;
        Ok(opened)
    }
}

impl OpenedDialect {
    fn ask_format(&self, words: usize) -> Result<Format, String> {
        let mut raw = PostFormat::EMPTY;
        // SAFETY: the context is open and `raw` lives for the call.
        let failed = self
            .table
            .format
            .is_none_or(|format| unsafe { format(self.ctx, &mut raw) } != 0);
        if failed {
            return Err(self.last_error());
        }
        if raw.words_len as usize != words {
            return Err(format!(
                "its format has {} axis words, the program has {words}",
                raw.words_len
            ));
        }
        let decimals = |count: i64| match u8::try_from(count) {
            Ok(count) if count <= 9 => Ok(count),
            _ => Err(format!(
                "its format asks for {count} decimals, at most 9 are possible"
            )),
        };
        let extension = raw.extension.split(|byte| *byte == 0).next().unwrap_or(&[]);
        Ok(Format {
            words: raw.words[..words]
                .iter()
                .map(|count| decimals((*count).into()))
                .collect::<Result<_, _>>()?,
            feed: decimals(raw.feed.into())?,
            inverse_time: match raw.inverse_time {
                -1 => None,
                count => Some(decimals(count.into())?),
            },
            feed_per_revolution: decimals(raw.feed_per_revolution.into())?,
            extension: match std::str::from_utf8(extension) {
                Ok(text) if text.bytes().all(|byte| byte.is_ascii_alphanumeric()) => {
                    text.to_owned()
                }
                _ => return Err("its file extension is not letters and digits".to_owned()),
            },
        })
    }

    fn last_error(&self) -> String {
        message(|sink| {
            if let Some(last_error) = self.table.last_error {
                // SAFETY: the context is open and the sink lives for the call.
                unsafe { last_error(self.ctx, sink) };
            }
        })
    }

    /// Keeps the promises made to plugins: right number of words, all numbers finite, feeds that move.
    fn promised(&self, event: &Event<'_>) -> Result<(), String> {
        let words = |words: &[f64]| {
            if words.len() != self.format.words.len() {
                return Err(format!(
                    "{} axis words instead of {}",
                    words.len(),
                    self.format.words.len()
                ));
            }
            match words.iter().find(|word| !word.is_finite()) {
                Some(word) => Err(format!("an axis word is {word}")),
                None => Ok(()),
            }
        };
        let feed = |feed: &Feed| match *feed {
            Feed::InverseTime(_) if self.format.inverse_time.is_none() => {
                Err("this control has no inverse-time feed".to_owned())
            }
            Feed::PerMinute(value) | Feed::InverseTime(value) | Feed::PerRevolution(value) => {
                if value.is_finite() && value > 0.0 {
                    Ok(())
                } else {
                    Err(format!("the feed is {value}"))
                }
            }
        };
        match event {
            Event::Position {
                words: values,
                feed: approach,
            } => words(values).and_then(|()| approach.iter().try_for_each(feed)),
            Event::Rapid { words: values } => words(values),
            Event::Linear {
                words: values,
                feed: cut,
            } => words(values).and_then(|()| feed(cut)),
            Event::Spindle(Spindle::On { rpm: value, .. }) | Event::Dwell { seconds: value } => {
                if value.is_finite() && *value >= 0.0 {
                    Ok(())
                } else {
                    Err(format!("its number is {value}"))
                }
            }
            _ => Ok(()),
        }
    }

    fn fault(&self, batch: &Batch, index: usize, message: &str) -> WriteFault {
        let kind = batch.event(index).name();
        WriteFault {
            index,
            message: format!("dialect `{}`, event {kind}: {message}", self.plugin),
        }
    }

    /// Calls the plugin on `self.events`; says how many it wrote, or why its answer is not believed.
    fn call(&mut self, out: &mut Vec<u8>) -> Result<usize, String> {
        let events = &self.events;
        self.ends.clear();
        self.ends.resize(events.len(), u64::MAX);
        let ends = self.ends.as_mut_ptr();
        let Some(write) = self.table.write else {
            return Err("it has no `write`".to_owned());
        };
        // SAFETY: the events and what they point to (the batch) live for the call, `ends` has room for
        // one number each, the sink is in force, and the context is open and used by this call alone.
        let written = with_sink(out, |sink| unsafe {
            write(self.ctx, events.as_ptr(), events.len(), sink, ends)
        });
        if written > events.len() {
            return Err(format!(
                "it says it wrote {written} events of {}",
                events.len()
            ));
        }
        Ok(written)
    }
}

impl DialectSession for OpenedDialect {
    fn format(&self) -> &Format {
        &self.format
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut Vec<u8>,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        if batch.is_empty() {
            return Ok(());
        }
        self.events.clear();
        let mut broken = None;
        for index in 0..batch.len() {
            let event = batch.event(index);
            if let Err(message) = self.promised(&event) {
                broken = Some(self.fault(batch, index, &message));
                break;
            }
            self.events.push(PostEvent::new(batch.line(index), &event));
        }
        let base = out.len();
        let written = self.call(out);
        let asked = self.events.len();
        // They point into the batch, which is the caller's.
        self.events.clear();
        let written = written.map_err(|message| {
            out.truncate(base);
            self.fault(batch, 0, &message)
        })?;

        // All at once, at the speed of memory; event by event only to name the one that is at fault.
        let sound = is_sound(&out[base..]);
        let mut from = base;
        for index in 0..written {
            let to = usize::try_from(self.ends[index])
                .ok()
                .and_then(|end| base.checked_add(end))
                .filter(|to| (from..=out.len()).contains(to));
            let checked = match to {
                None => Err("the end of its text is not where it says".to_owned()),
                Some(to) if sound && (to == from || out[to - 1] == b'\n') => Ok(to),
                Some(to) => check_text(&out[from..to], &batch.event(index)).map(|()| to),
            };
            match checked {
                Ok(to) => from = to,
                Err(message) => {
                    out.truncate(from);
                    return Err(self.fault(batch, index, &message));
                }
            }
            ends.push(from);
        }
        if written < asked {
            out.truncate(from);
            let message = self.last_error();
            return Err(self.fault(batch, written, &message));
        }
        if from != out.len() {
            out.truncate(from);
            let message = "it wrote text that belongs to no event";
            return Err(self.fault(batch, written.saturating_sub(1), message));
        }
        broken.map_or(Ok(()), Err)
    }
}

impl Drop for OpenedDialect {
    fn drop(&mut self) {
        if let Some(close) = self.table.close {
            // SAFETY: the context is open, and this is its last use.
            unsafe { close(self.ctx) };
        }
    }
}

/// A text in which [`check_text`] can find nothing but a missing line feed; a few others fail here as well.
fn is_sound(text: &[u8]) -> bool {
    // Bit operations without a branch: the compiler makes vectors of them.
    let odd = |byte: u8| (byte < b' ') & (byte != b'\n') | (byte >= 0x7f);
    let word = |a: u8, b: u8, c: u8, word: &[u8; 3]| {
        (a | 32 == word[0]) & (b | 32 == word[1]) & (c | 32 == word[2])
    };
    let second = text.get(1..).unwrap_or(&[]);
    let third = text.get(2..).unwrap_or(&[]);
    let no_number = text
        .iter()
        .zip(second)
        .zip(third)
        .fold(false, |found, ((a, b), c)| {
            found | word(*a, *b, *c, b"nan") | word(*a, *b, *c, b"inf")
        });
    !text
        .iter()
        .fold(no_number, |found, byte| found | odd(*byte))
}

/// The text of one event is whole lines that a control can read, and a move's numbers are numbers.
fn check_text(text: &[u8], event: &Event<'_>) -> Result<(), String> {
    if std::str::from_utf8(text).is_err() {
        return Err("its text is not UTF-8".to_owned());
    }
    if text.last().is_some_and(|byte| *byte != b'\n') {
        return Err("its text does not end with a line feed".to_owned());
    }
    let odd = |byte: &&u8| byte.is_ascii_control() && !matches!(byte, b'\n' | b'\r' | b'\t');
    if let Some(byte) = text.iter().find(odd) {
        return Err(format!("its text holds the control character {byte}"));
    }
    let moves = matches!(
        event,
        Event::Position { .. } | Event::Rapid { .. } | Event::Linear { .. }
    );
    if moves && has_no_number(text) {
        return Err(format!(
            "it wrote something that is no number: {}",
            String::from_utf8_lossy(text).trim()
        ));
    }
    Ok(())
}

/// `nan` or `inf` stands where a word ends, in any case of letters, as C and Rust print them.
fn has_no_number(text: &[u8]) -> bool {
    text.windows(4).any(|window| {
        let word = &window[..3];
        // A move ends with a line feed, so each of its words has a byte behind it.
        (word.eq_ignore_ascii_case(b"nan") || word.eq_ignore_ascii_case(b"inf"))
            && !window[3].is_ascii_alphanumeric()
    })
}
