//! An opened dialect, wherever it is: the text that comes back is checked.

use std::fmt;

use post_plugin::raw::{self, PostFormat};
use post_plugin::{
    Batch, Capabilities, DialectSession, Event, Format, LinkedDialect, Promise, VocabularyWord,
    WriteFault,
};

#[cfg(unix)]
use crate::described::FunctionTable;
#[cfg(unix)]
use crate::isolation::IsolatedDialect;
use crate::library_dialect::LibraryDialect;
use crate::shown::{is_odd, quoted, sentence};
use crate::sink::MOST_TEXT;
use crate::vocabulary;
use crate::{Plugin, PluginFault, PluginKind, ProgramSetup, Reason, check_options};

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
    /// In a process of its own.
    #[cfg(unix)]
    Isolated(IsolatedDialect),
}

impl Plugin {
    /// Opens this dialect for one program.
    ///
    /// # Errors
    /// If it is no dialect, an option does not fit, or it refuses.
    pub fn dialect(&self, setup: &ProgramSetup) -> Result<OpenedDialect, PluginFault> {
        if self.kind() != PluginKind::Dialect {
            return Err(self.other_kind(PluginKind::Dialect));
        }
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
        let (access, format, capabilities) = match (linked, &self.table) {
            (Some(opened), _) => {
                let mut dialect = opened.map_err(|message| refused(reason_of(message)))?;
                let (format, capabilities) = dialect.format().map_err(nonsense)?;
                (DialectAccess::Linked(dialect), format, capabilities)
            }
            #[cfg(unix)]
            (None, FunctionTable::Isolated(library)) => {
                let setup = ProgramSetup { options, ..setup.clone() };
                let (dialect, raw) =
                    IsolatedDialect::open(library, setup).map_err(|reason| self.fault(reason))?;
                let (format, capabilities) = judged_format(&raw, words).map_err(nonsense)?;
                (DialectAccess::Isolated(dialect), format, capabilities)
            }
            (None, _) => {
                let setup = ProgramSetup { options, ..setup.clone() };
                let library = LibraryDialect::open_plugin(self, &setup).map_err(refused)?;
                let raw = library.raw_format().map_err(nonsense)?;
                let (format, capabilities) = judged_format(&raw, words).map_err(nonsense)?;
                (DialectAccess::Library(library), format, capabilities)
            }
        };
        check_format(&format, capabilities, words).map_err(nonsense)?;
        Ok(OpenedDialect { plugin: self.name.clone(), access, format, capabilities })
    }
}

/// A format as it was told, in its safe form.
///
/// # Errors
/// What this version does not know.
pub(crate) fn judged_format(
    raw: &PostFormat,
    words: usize,
) -> Result<(Format, Capabilities), String> {
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
        rapid_feed: Some(raw.rapid_feed).filter(|feed| *feed != 0.0),
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

/// What a format says must be possible.
fn check_format(format: &Format, writes: Capabilities, words: usize) -> Result<(), String> {
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
    if let Some(feed) = format.rapid_feed.filter(|feed| !(feed.is_finite() && *feed > 0.0)) {
        return Err(format!("its feed of rapids is {feed}"));
    }
    if format.rapid_feed.is_some() != writes.has(Capabilities::RAPIDS_AT_FEED) {
        return Err("RAPIDS_AT_FEED and `rapid_feed` of its format go together".to_owned());
    }
    let extension = &format.extension;
    if extension.len() > 16 || !extension.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
        return Err("its file extension is not letters and digits".to_owned());
    }
    Ok(())
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
            #[cfg(unix)]
            DialectAccess::Isolated(dialect) => dialect.vocabulary(),
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
            #[cfg(unix)]
            DialectAccess::Isolated(dialect) => dialect.relies_on(),
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
            #[cfg(unix)]
            DialectAccess::Isolated(dialect) => dialect.write(batch, out, ends),
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

/// Most bytes of a line of a program: what reads it back takes no longer one.
const LONGEST_LINE: usize = 16 * 1024;

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
        let short = to - from <= LONGEST_LINE;
        if !(sound && short && (to == from || bytes[to - 1] == b'\n'))
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
        if inner.len() > LONGEST_LINE {
            return Err(format!(
                "its line `{}` has {} bytes: a line of a program has at most {LONGEST_LINE}",
                quoted(line),
                inner.len()
            ));
        }
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
