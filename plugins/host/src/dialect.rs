//! An opened dialect: batches go in raw, and the text that comes back is checked.

#![allow(unsafe_code)]

use std::ffi::c_void;
use std::fmt;

use post_plugin::raw::{self, PostDialect, PostEvent, PostFormat, PostText};
use post_plugin::{
    Accuracy, Ahead, AxisWord, Batch, Capabilities, DialectSession, Event, Format, LinkedDialect,
    Promise, Setup, Tool, Units, Value, VocabularyWord, WriteFault,
};

use crate::call::Caller;
use crate::described::FunctionTable;
use crate::shown::{is_odd, quoted, sentence};
use crate::sink::{MOST_TEXT, message, with_sink};
use crate::vocabulary;
use crate::{GivenValue, Plugin, PluginFault, PluginKind, Reason, check_options};

/// What a dialect is told about a program.
#[derive(Clone, Debug, Default)]
pub struct ProgramSetup {
    /// Name of the program (the output file's stem).
    pub program: String,
    /// Name of the machine.
    pub machine: String,
    /// Units of the program.
    pub units: Units,
    /// See [`Setup::tcp`].
    pub tcp: bool,
    /// See [`Setup::turns_part`].
    pub turns_part: bool,
    /// The axis words, in the order in which they are written.
    pub words: Vec<ProgramWord>,
    /// The options of the machine file, as given.
    pub options: Vec<(String, GivenValue)>,
    /// See [`Setup::cl_file`].
    pub cl_file: String,
    /// See [`Setup::accuracy`].
    pub accuracy: Option<Accuracy>,
    /// See [`Setup::ahead`].
    pub ahead: Option<ProgramAhead>,
}

/// See [`AxisWord`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramWord {
    /// Its address.
    pub name: String,
    /// A rotary axis.
    pub rotary: bool,
    /// Its words lie within one turn.
    pub wrapped: bool,
    /// They are places within one turn, and their sign is the way there.
    pub signed: bool,
    /// The linear axis along the spindle.
    pub depth: bool,
    /// The axis carries the part.
    pub carries_part: bool,
    /// See [`AxisWord::diameter`].
    pub diameter: bool,
    /// See [`AxisWord::travel`].
    pub travel: Option<[f64; 2]>,
}

/// See [`post_plugin::Ahead`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramAhead {
    /// The tools in the order in which they are first used.
    pub tools: Vec<ProgramTool>,
    /// Least and largest tip, mm, part frame.
    pub extents: Option<[[f64; 3]; 2]>,
    /// The program's time, seconds.
    pub time: Option<f64>,
}

/// See [`post_plugin::Tool`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramTool {
    /// Tool number.
    pub number: u32,
    /// Its name, empty if not known.
    pub name: String,
    /// From the gauge point to the tip, mm.
    pub length: Option<f64>,
    /// Of the cutter, mm.
    pub diameter: Option<f64>,
    /// Of the cutter's corner, mm.
    pub corner_radius: Option<f64>,
}

impl ProgramSetup {
    /// Hands it to `take` as a dialect sees it, with `options` completed.
    fn with<R>(&self, options: &[(String, GivenValue)], take: impl FnOnce(&Setup<'_>) -> R) -> R {
        let options: Vec<(&str, Value<'_>)> =
            options.iter().map(|(key, value)| (key.as_str(), value.as_value())).collect();
        let words: Vec<AxisWord<'_>> = self
            .words
            .iter()
            .map(|word| AxisWord {
                name: &word.name,
                rotary: word.rotary,
                wrapped: word.wrapped,
                signed: word.signed,
                depth: word.depth,
                carries_part: word.carries_part,
                diameter: word.diameter,
                travel: word.travel,
            })
            .collect();
        let tools = self.ahead.iter().flat_map(|ahead| &ahead.tools);
        let tools: Vec<Tool<'_>> = tools
            .map(|tool| Tool {
                number: tool.number,
                name: &tool.name,
                length: tool.length,
                diameter: tool.diameter,
                corner_radius: tool.corner_radius,
            })
            .collect();
        take(&Setup {
            program: &self.program,
            machine: &self.machine,
            units: self.units,
            tcp: self.tcp,
            turns_part: self.turns_part,
            words: &words,
            options: &options,
            cl_file: &self.cl_file,
            accuracy: self.accuracy,
            ahead: self.ahead.as_ref().map(|ahead| Ahead {
                tools: &tools,
                extents: ahead.extents,
                time: ahead.time,
            }),
        })
    }
}

/// A dialect that is writing a program.
pub struct OpenedDialect {
    plugin: String,
    access: DialectAccess,
    format: Format,
    capabilities: Capabilities,
}

/// How a dialect is reached.
enum DialectAccess {
    /// It is part of this program and writes straight into the host's text.
    Linked(Box<dyn LinkedDialect>),
    /// Through the C contract.
    Library(LibraryDialect),
}

/// A context behind the C contract.
struct LibraryDialect {
    caller: Caller,
    table: PostDialect,
    ctx: *mut c_void,
    /// The batch in its raw form; empty but during a call.
    events: Vec<PostEvent>,
    texts: Vec<PostText>,
    ends: Vec<u64>,
    /// What it wrote, before it is believed.
    written: Vec<u8>,
}

// SAFETY: the contract lets a context wander between threads, one call at a time, and `&mut self` sees
// to that; events and texts hold pointers only during a call.
unsafe impl Send for LibraryDialect {}

impl Plugin {
    /// Opens this dialect for one program.
    ///
    /// # Errors
    /// If it is no dialect, an option does not fit, or it refuses.
    pub fn dialect(&self, setup: &ProgramSetup) -> Result<OpenedDialect, PluginFault> {
        let FunctionTable::Dialect(table) = self.table else {
            return Err(self.other_kind(PluginKind::Dialect));
        };
        let words = setup.words.len();
        if words > raw::MAX_WORDS {
            return Err(self.fault(Reason::Refused {
                message: format!("a program may have {} axis words", raw::MAX_WORDS),
            }));
        }
        let options = check_options(self.options(), &setup.options)
            .map_err(|fault| self.fault(Reason::Option(Box::new(fault))))?;
        let refused = |message| self.fault(Reason::Refused { message });
        let nonsense = |message| self.fault(Reason::Nonsense { message });
        let linked =
            self.linked.and_then(|linked| setup.with(&options, |setup| linked.open(setup)));
        let (access, format, capabilities) = match linked {
            Some(opened) => {
                let mut dialect = opened.map_err(|message| refused(reason_of(message)))?;
                let (format, capabilities) = dialect.format().map_err(nonsense)?;
                (DialectAccess::Linked(dialect), format, capabilities)
            }
            None => {
                let library = setup
                    .with(&options, |setup| LibraryDialect::open(self.caller(), table, setup))
                    .map_err(refused)?;
                let (format, capabilities) = library.ask_format(words).map_err(nonsense)?;
                (DialectAccess::Library(library), format, capabilities)
            }
        };
        check_format(&format, words).map_err(nonsense)?;
        Ok(OpenedDialect { plugin: self.name.clone(), access, format, capabilities })
    }
}

/// What a format says must be possible.
fn check_format(format: &Format, words: usize) -> Result<(), String> {
    if format.words.len() != words {
        return Err(format!(
            "its format has {} axis words, the program has {words}",
            format.words.len()
        ));
    }
    let feeds = [
        Some(format.feed),
        format.inverse_time,
        Some(format.feed_per_revolution),
        Some(format.plane_decimals),
    ];
    let decimals = format.words.iter().copied().chain(feeds.into_iter().flatten());
    if let Some(count) = decimals.max().filter(|count| *count > 9) {
        return Err(format!("its format asks for {count} decimals, at most 9 are possible"));
    }
    if let Some(most) = format.most_inverse_time.filter(|most| most.is_nan() || *most <= 0.0) {
        return Err(format!("its largest inverse-time feed is {most}"));
    }
    let extension = &format.extension;
    if extension.len() > 16 || !extension.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
        return Err("its file extension is not letters and digits".to_owned());
    }
    Ok(())
}

impl LibraryDialect {
    /// # Errors
    /// Why it refuses.
    fn open(caller: Caller, table: PostDialect, setup: &Setup<'_>) -> Result<Self, String> {
        let mut ctx = std::ptr::null_mut();
        let refusal = message(|sink| {
            raw::with_setup(setup, |setup| {
                if let Some(open) = table.open {
                    // SAFETY: the setup and the sink live for the call.
                    ctx = caller.call(|| unsafe { open(setup, sink) });
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
            ends: Vec::new(),
            written: Vec::new(),
        })
    }

    fn ask_format(&self, words: usize) -> Result<(Format, Capabilities), String> {
        let mut raw = PostFormat::EMPTY;
        // SAFETY: the context is open and `raw` lives for the call.
        let failed = self
            .table
            .format
            .is_none_or(|format| self.caller.call(|| unsafe { format(self.ctx, &mut raw) }) != 0);
        if failed {
            return Err(self.last_error());
        }
        let decimals_of = raw.words.get(..raw.words_len as usize).ok_or_else(|| {
            format!("its format has {} axis words, the program has {words}", raw.words_len)
        })?;
        // More than a byte holds is more than is allowed.
        let decimals = |count: u32| u8::try_from(count).unwrap_or(u8::MAX);
        let extension = raw.extension.split(|byte| *byte == 0).next().unwrap_or(&[]);
        let format = Format {
            words: decimals_of.to_vec(),
            feed: decimals(raw.feed),
            inverse_time: match raw.inverse_time {
                -1 => None,
                count => Some(u8::try_from(count).unwrap_or(u8::MAX)),
            },
            feed_per_revolution: decimals(raw.feed_per_revolution),
            extension: String::from_utf8_lossy(extension).into_owned(),
            most_inverse_time: Some(raw.most_inverse_time).filter(|most| *most != 0.0),
            plane_angles: raw
                .plane()
                .ok_or("its format has angles of a plane that this version does not know")?,
            plane_decimals: decimals(raw.plane_decimals),
            language: raw
                .language()
                .ok_or("its format has a language that this version does not know")?,
        };
        Ok((format, Capabilities::from_bits(raw.writes)))
    }

    fn vocabulary(&self) -> Result<Vec<VocabularyWord>, String> {
        let Some(vocabulary) = self.table.vocabulary else {
            return Ok(Vec::new());
        };
        let asked = vocabulary::taken(|host, emit| {
            // SAFETY: the context is open, and `emit` takes `host`.
            self.caller.call(|| unsafe { vocabulary(self.ctx, host, emit) })
        });
        match asked {
            (0, words) => words,
            _ => Err(self.last_error()),
        }
    }

    fn relies_on(&self) -> Result<Vec<String>, String> {
        let Some(relies_on) = self.table.relies_on else {
            return Ok(Vec::new());
        };
        let mut told = Vec::new();
        let code = with_sink(&mut told, MOST_TEXT, |sink| {
            // SAFETY: the context is open and the sink lives for the call.
            self.caller.call(|| unsafe { relies_on(self.ctx, sink) })
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
                self.caller.call(|| unsafe { last_error(self.ctx, sink) });
            }
        })
    }

    /// Calls the plugin on the first `count` events of `batch`; says how many it wrote, or why its answer is not
    /// believed.
    fn call(&mut self, batch: &Batch, count: usize) -> Result<usize, String> {
        raw::events(batch, count, &mut self.events, &mut self.texts);
        self.ends.clear();
        self.ends.resize(count, u64::MAX);
        self.written.clear();
        let (events, ends) = (self.events.as_ptr(), self.ends.as_mut_ptr());
        let Some(write) = self.table.write else {
            return Err("it has no `write`".to_owned());
        };
        let ctx = self.ctx;
        // SAFETY: the events and what they point to (the batch) live for the call, `ends` has room for
        // one number each, the sink is in force, and the context is open and used by this call alone.
        let caller = &self.caller;
        let written = with_sink(&mut self.written, MOST_TEXT, |sink| {
            caller.call(|| unsafe { write(ctx, events, count, sink, ends) })
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
    fn write(
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
            let to = usize::try_from(self.ends[index]).ok();
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

impl OpenedDialect {
    /// The words of this control and what they mean; none if the dialect does not tell them.
    ///
    /// # Errors
    /// A sentence: it failed to tell them, or told what cannot be.
    pub fn vocabulary(&mut self) -> Result<Vec<VocabularyWord>, String> {
        let told = match &mut self.access {
            DialectAccess::Linked(dialect) => dialect.vocabulary(),
            DialectAccess::Library(library) => library.vocabulary(),
        };
        let judged = told.and_then(vocabulary::judge);
        judged.map_err(|message| format!("dialect `{}`: {}", self.plugin, reason_of(message)))
    }

    /// What programs of this dialect rely on at the control, a sentence each.
    ///
    /// # Errors
    /// A sentence: it failed to tell, or what it told is no text.
    pub fn relies_on(&mut self) -> Result<Vec<String>, String> {
        let told = match &mut self.access {
            DialectAccess::Linked(dialect) => dialect.relies_on(),
            DialectAccess::Library(library) => library.relies_on(),
        };
        match told {
            Ok(sentences) => {
                let shown = sentences.iter().map(|told| sentence(told));
                Ok(shown.filter(|told| !told.is_empty()).take(MOST_SENTENCES).collect())
            }
            Err(message) => Err(format!("dialect `{}`: {}", self.plugin, reason_of(message))),
        }
    }
}

/// No more sentences of what programs rely on are shown.
const MOST_SENTENCES: usize = 100;

impl Drop for LibraryDialect {
    fn drop(&mut self) {
        if let Some(close) = self.table.close {
            // SAFETY: the context is open, and this is its last use.
            self.caller.call(|| unsafe { close(self.ctx) });
        }
    }
}

impl DialectSession for OpenedDialect {
    fn format(&self) -> &Format {
        &self.format
    }

    fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        if batch.is_empty() {
            return Ok(());
        }
        let promise = Promise {
            words: self.format.words.len(),
            inverse_time: self.format.inverse_time.is_some(),
        };
        let (base, first) = (out.len(), ends.len());
        let written = match &mut self.access {
            DialectAccess::Linked(dialect) => dialect.write(batch, &promise, out, ends),
            DialectAccess::Library(library) => library.write(batch, &promise, out, ends),
        };
        let believed = check_batch(batch, out, base, ends, first);
        believed.and(written).map_err(|fault| {
            let event = batch.event(fault.index.min(batch.len() - 1)).name();
            WriteFault {
                message: format!(
                    "dialect `{}`, event {event}: {}",
                    self.plugin,
                    sentence(&fault.message)
                ),
                ..fault
            }
        })
    }
}

impl fmt::Debug for OpenedDialect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { plugin, format, .. } = self;
        f.debug_struct("OpenedDialect")
            .field("plugin", plugin)
            .field("format", format)
            .finish_non_exhaustive()
    }
}

/// No reason is no sentence.
fn reason_of(message: String) -> String {
    let message = sentence(&message);
    if message.is_empty() { "it gives no reason".to_owned() } else { message }
}

/// The text of each event is whole lines that a control can read, and a move's numbers are numbers. What does not
/// fit is taken back, with all that comes behind it.
fn check_batch(
    batch: &Batch,
    out: &mut String,
    base: usize,
    ends: &mut Vec<usize>,
    first: usize,
) -> Result<(), WriteFault> {
    if out.len() - base > MOST_TEXT {
        out.truncate(base);
        ends.truncate(first);
        let message = format!("it wrote more than {MOST_TEXT} bytes in one call");
        return Err(WriteFault { index: 0, message });
    }
    // All at once, at the speed of memory; event by event only to name the one that is at fault.
    let bytes = out.as_bytes();
    let sound = is_sound(&bytes[base..]);
    let mut from = base;
    for (index, &to) in ends[first..].iter().enumerate() {
        if !(sound && (to == from || bytes[to - 1] == b'\n'))
            && let Err(message) = check_text(&out[from..to], &batch.event(index))
        {
            out.truncate(from);
            ends.truncate(first + index);
            return Err(WriteFault { index, message });
        }
        from = to;
    }
    Ok(())
}

/// A text in which [`check_text`] can find nothing but a missing line feed; a few others fail here as well.
fn is_sound(text: &[u8]) -> bool {
    // Bit operations without a branch: the compiler makes vectors of them.
    let odd = |byte: u8| (byte < b' ') & (byte != b'\n') | (byte >= 0x7f);
    let suspect = |byte: u8| odd(byte) | (byte | 32 == b'n');
    if !text.iter().fold(false, |found, byte| found | suspect(*byte)) {
        // Both words have an N.
        return true;
    }
    let word = |a: u8, b: u8, c: u8, word: &[u8; 3]| {
        (a | 32 == word[0]) & (b | 32 == word[1]) & (c | 32 == word[2])
    };
    let second = text.get(1..).unwrap_or(&[]);
    let third = text.get(2..).unwrap_or(&[]);
    let no_number = text.iter().zip(second).zip(third).fold(false, |found, ((a, b), c)| {
        found | word(*a, *b, *c, b"nan") | word(*a, *b, *c, b"inf")
    });
    !text.iter().fold(no_number, |found, byte| found | odd(*byte))
}

/// The text of one event is whole lines that a control can read, and a move's numbers are numbers.
fn check_text(text: &str, event: &Event<'_>) -> Result<(), String> {
    let Some(lines) = text.strip_suffix('\n') else {
        return match text.is_empty() {
            true => Ok(()),
            false => Err("its text does not end with a line feed".to_owned()),
        };
    };
    for line in lines.split('\n') {
        let inner = line.strip_suffix('\r').unwrap_or(line);
        let odd = |letter: &char| is_odd(*letter) && *letter != '\t';
        if let Some(letter) = inner.chars().find(odd) {
            return Err(format!(
                "its line `{}` holds the character U+{:04X}: a line of a program is printable letters, blanks and tabs, and ends with a line feed, or with CR and LF",
                quoted(line),
                u32::from(letter)
            ));
        }
    }
    if event.moves() && has_no_number(text.as_bytes()) {
        return Err(format!("it wrote something that is no number: {}", quoted(text.trim())));
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
