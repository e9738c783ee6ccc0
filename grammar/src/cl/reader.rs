//! Chunks of a file to logical lines, in one buffer that is used again and again.
//!
//! A line ends at LF, CR LF or CR. What CAM systems and ISO 4343 agree on about `$`:
//! - a single `$` as the last character of a line, blanks aside: the record goes on in the next line;
//! - `$$`: a comment from there to the end of the line, at the beginning of a line and after a statement alike.
//!   So `$$` never continues a line, and a `$` inside a comment does not either;
//! - `$$->` at the beginning is a directive, which is read, commented and continued like a statement;
//! - in a free text (`PPRINT`, `INSERT`, a comment, …) both are text: a remark that happens to end in `$`
//!   must not swallow the move after it.

use super::foreign;
use super::goto_run::{GotoRun, RunForm, goto_statement};
use super::layout::RecordLayout;
use super::line::{is_free_text, parse_record};
use super::piece::ClPiece;
use super::record::Record;
use super::scan::{self, PlainGoto};
use crate::fault::{ReadError, SyntaxFault};
use crate::points::{ListForm, MOST_JSON, PointList, RecordPlace};
use crate::text::excerpt;
use memchr::{memchr_iter, memchr2, memchr3};
use std::borrow::Cow;
use std::io::{self, ErrorKind, Read};
use std::ops::Range;
use std::sync::Arc;

/// Bytes asked of the input at a time: small enough to stay in the processor's cache.
const CHUNK: usize = 256 * 1024;

/// Longest record, in bytes of the file. Anything longer is not a cutter-location file.
const LONGEST: usize = 1024 * 1024;

/// Bytes of the beginning that say what a file is.
const HEAD: usize = 4096;

/// UTF-8 for U+FEFF, which some editors put before a text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// The file separator of ASCII, at the end of a remark: the next line is the first of another file, whose form may be
/// another. Twice where the file before had no end of its last line.
pub const NEXT_FILE: u8 = 0x1C;

/// How much of a record that is too long is shown.
const SHOWN: usize = 80;

/// Reads the records of a cutter-location file one by one; memory does not grow with the file.
///
/// The input need not be buffered.
#[derive(Debug)]
pub struct ClReader<R> {
    input: R,
    buffer: Vec<u8>,
    /// What is read and not yet consumed: `buffer[start..end]`.
    start: usize,
    end: usize,
    /// The input has ended.
    ended: bool,
    /// Bytes taken from the input.
    taken: u64,
    /// Number of the line that begins at `start`.
    line: u64,
    /// How the records so far were laid out.
    layout: RecordLayout,
    /// The last record was parted by a `$`; the next one is likely to be, too.
    parted: bool,
    /// What was taken last, blanks aside, is no line end.
    unended: bool,
    /// The beginning of the file was looked at.
    begun: bool,
    /// The file is a list of points.
    points: Option<PointList>,
    /// The row whose records are given: its text, where that stands in a list that is held in one piece, and its line.
    row_text: Vec<u8>,
    row: Range<usize>,
    row_line: u64,
    /// Where the record stands that was given last, if that is elsewhere.
    place: Option<Arc<RecordPlace>>,
}

/// A physical line; offsets from `start`.
struct PhysicalLine {
    /// Where its text ends.
    end: usize,
    /// Where the next line begins.
    next: usize,
    /// The record has become too long, and part of it was thrown away.
    overlong: bool,
}

impl<R: Read> ClReader<R> {
    /// Reads from `input`.
    pub fn new(input: R) -> Self {
        Self {
            input,
            buffer: vec![0; CHUNK],
            start: 0,
            end: 0,
            ended: false,
            taken: 0,
            line: 1,
            layout: RecordLayout::new(),
            parted: false,
            unended: false,
            begun: false,
            points: None,
            row_text: Vec::new(),
            row: 0..0,
            row_line: 1,
            place: None,
        }
    }

    /// How many bytes the records so far take up, for a progress bar; at the end the length of the file.
    pub fn bytes_read(&self) -> u64 {
        self.taken - self.pending().len() as u64
    }

    /// The input as far as it was taken ends in the middle of a line: of a file that was read to its end, no line end
    /// follows the last record.
    pub fn ends_within_a_line(&self) -> bool {
        self.unended
    }

    /// The next record; `None` at the end of the file.
    ///
    /// After a [`ReadError::Syntax`] the next call goes on with the next line.
    pub fn next_record(&mut self) -> Result<Option<Record<'_>>, ReadError> {
        if let Some(values) = self.laid_out() {
            return Ok(Some(self.take_laid_out(values)));
        }
        if !self.begun {
            self.begin()?;
        }
        if self.points.is_some() {
            return self.next_of_list();
        }
        if self.layout.learn(&self.buffer, self.start, self.end)
            && let Some(values) = self.laid_out()
        {
            return Ok(Some(self.take_laid_out(values)));
        }
        if !self.parted
            && let Some((plain, next)) = self.plain()
        {
            return Ok(Some(self.take_plain(&plain, next)));
        }
        while let Some(physical) = self.physical(0)? {
            let line = self.line;
            let mut raw = self.start..self.start + physical.end;
            while self.buffer[raw.clone()].ends_with(&[NEXT_FILE]) {
                self.begun = false;
                raw.end -= 1;
            }
            let text = &self.buffer[raw.clone()];
            // A `$` at the end may mean that the record goes on.
            let whole = !physical.overlong && !text.trim_ascii_end().ends_with(b"$");
            if whole && let Some(statement) = scan::record(text) {
                self.consume(&physical, 1);
                self.parted = false;
                return Ok(Some(Record { line, raw: &self.buffer[raw], statement }));
            }
            if let Some(raw) = self.logical(physical)? {
                let raw = &self.buffer[raw];
                let statement = match scan::joined(raw) {
                    Some(statement) => statement,
                    None => {
                        parse_record(&decode(raw)).map_err(|fault| SyntaxFault { line, ..fault })?
                    }
                };
                return Ok(Some(Record { line, raw, statement }));
            }
        }
        Ok(None)
    }

    /// Looks at the beginning: all of a file in another format is passed over.
    #[cold]
    fn begin(&mut self) -> Result<(), ReadError> {
        self.begun = true;
        // Up to the end of a line that says something.
        let says = |line: &[u8]| !line.trim_ascii().is_empty() && !line.starts_with(b"#");
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        while self.pending().len() < HEAD
            && !self.ended
            && !self.pending().split(is_end).rev().skip(1).any(says)
        {
            self.fill()?;
        }
        let head = &self.pending()[..HEAD.min(self.end - self.start)];
        match ListForm::of(head) {
            Some(ListForm::Csv) => {
                self.points = Some(PointList::Csv(Box::default()));
                return Ok(());
            }
            Some(ListForm::Json) => return self.begin_json(),
            None => {}
        }
        let Some(kind) = foreign::kind(head) else {
            return Ok(());
        };
        let head = head.trim_ascii_start();
        let first = head.split(|byte| matches!(byte, b'\n' | b'\r')).next();
        let text = decode(first.unwrap_or_default());
        let text = excerpt(&text, SHOWN).into_owned();
        let message = format!("this is {kind}, no cutter-location file");
        let fault = SyntaxFault::new(&text, 0..text.len(), message);
        self.pass_the_rest();
        let help =
            "let the CAM system write a CL file: APT, CLSF or NCL, one record a line (GOTO/1,2,3)";
        Err(fault.help(help).into())
    }

    /// Reads a list of points in one piece.
    #[cold]
    fn begin_json(&mut self) -> Result<(), ReadError> {
        let mut looked = 0;
        let mark = loop {
            let found = memchr::memchr(NEXT_FILE, &self.pending()[looked..]);
            let read = self.pending().len();
            if self.ended || found.is_some() || read > MOST_JSON {
                break found.map(|at| looked + at);
            }
            looked = read;
            self.fill()?;
        };
        // Up to the line that says that another file begins.
        let all = self.pending();
        let end = mark.map_or(all.len(), |at| {
            memchr::memrchr(b'\n', &all[..at]).map_or(0, |line_end| line_end + 1)
        });
        let bytes = all[..end].to_vec();
        self.start += end;
        let wrong = match String::from_utf8(bytes) {
            Ok(text) if text.len() <= MOST_JSON => {
                self.points = Some(PointList::Json { text, list: Box::default() });
                return Ok(());
            }
            Ok(_) => "a list of points in JSON of more than 256 MiB, which is read in one piece",
            Err(_) => "this list of points is no UTF-8",
        };
        self.pass_the_rest();
        Err(SyntaxFault::new("", 0..0, wrong).help("write it as CSV, a point a line").into())
    }

    /// Nothing more of the input is read.
    fn pass_the_rest(&mut self) {
        self.start = self.end;
        self.ended = true;
        self.unended = false;
    }

    /// The next record of a list of points, or behind it.
    fn next_of_list(&mut self) -> Result<Option<Record<'_>>, ReadError> {
        let more = match &self.points {
            Some(PointList::Csv(_)) => self.row_of_csv()?,
            Some(PointList::Json { .. }) => self.row_of_json()?,
            None => false,
        };
        match more {
            true => Ok(self.row_record()),
            false => self.next_record(),
        }
    }

    /// The next record of the row that was taken last.
    fn row_record(&mut self) -> Option<Record<'_>> {
        let line = self.row_line;
        let ((statement, place), raw) = match self.points.as_mut()? {
            PointList::Csv(list) => (list.records.next()?, self.row_text.as_slice()),
            PointList::Json { text, list } => {
                (list.records.next()?, text.get(self.row.clone())?.as_bytes())
            }
        };
        self.place = place;
        Some(match &self.place {
            Some(place) => Record { line: place.line, raw: place.text.as_bytes(), statement },
            None => Record { line, raw, statement },
        })
    }

    /// Takes lines of a list until one says something; false: the list is over, and what follows is no list.
    fn row_of_csv(&mut self) -> Result<bool, ReadError> {
        loop {
            let Some(PointList::Csv(list)) = &self.points else {
                return Ok(false);
            };
            if list.records.waits() {
                return Ok(true);
            }
            let (line, physical) = (self.line, self.physical(0)?);
            let text = physical.as_ref().map(|physical| &self.pending()[..physical.end]);
            // Another file begins there.
            let over = text.is_none_or(|text| text.starts_with(b"$$"));
            let cut = text.is_some_and(|text| text.ends_with(&[NEXT_FILE, NEXT_FILE]));
            let Some(PointList::Csv(list)) = &mut self.points else {
                return Ok(false);
            };
            if over {
                if cut && !list.ended() {
                    list.end();
                    let fault = cut_off_row(&decode(&self.row_text));
                    return Err(SyntaxFault { line: self.row_line, ..fault }.into());
                }
                // The end is told on the last line: the next one may be another file's.
                if list.end() {
                    self.points = None;
                    return Ok(false);
                }
                continue;
            }
            let Some(physical) = physical else {
                continue;
            };
            if physical.overlong {
                let shown = decode(&self.buffer[self.start..self.start + SHOWN]).into_owned();
                self.consume(&physical, 1);
                let message = format!("a row of more than {LONGEST} bytes");
                let fault = SyntaxFault::new(&shown, 0..shown.len(), message);
                let fault = fault.help("a point has a line of its own");
                return Err(SyntaxFault { line, ..fault }.into());
            }
            let raw = &self.buffer[self.start..self.start + physical.end];
            // Old DOS systems end a text file with 0x1A.
            if matches!(raw.trim_ascii(), b"" | b"\x1A") {
                self.consume(&physical, 1);
                continue;
            }
            self.row_text.clear();
            self.row_text.extend_from_slice(raw);
            self.row_line = line;
            let text = decode(&self.row_text);
            let (taken, has_header) = (list.take(&text, line), list.has_header());
            let ended = self.ended && physical.next == physical.end;
            let text = ended.then(|| text.into_owned());
            self.consume(&physical, 1);
            if let Err(fault) = taken {
                if !has_header {
                    self.pass_the_rest();
                }
                return Err(SyntaxFault { line, ..fault }.into());
            }
            if let Some(text) = text {
                self.pass_the_rest();
                return Err(SyntaxFault { line, ..cut_off_row(&text) }.into());
            }
        }
    }

    /// Takes the next point of a list, and what stands ahead of the first; false: the list is over, and what follows is
    /// none.
    fn row_of_json(&mut self) -> Result<bool, ReadError> {
        loop {
            let Some(PointList::Json { text, list }) = &mut self.points else {
                return Ok(false);
            };
            if list.records.waits() {
                return Ok(true);
            }
            let first = self.line;
            match list.take(text, first) {
                Ok(Some((row, line))) => (self.row, self.row_line) = (row, first + line),
                Ok(None) => {
                    let lines = text.as_bytes()[..list.end].iter().filter(|byte| **byte == b'\n');
                    self.line += lines.count() as u64;
                    // Another file may follow.
                    let mut rest = text.as_bytes()[list.end..].to_vec();
                    rest.extend_from_slice(&self.buffer[self.start..self.end]);
                    self.buffer = rest;
                    (self.start, self.end) = (0, self.buffer.len());
                    self.buffer.resize(self.end.max(CHUNK), 0);
                    self.points = None;
                    return Ok(false);
                }
                Err(fault) => {
                    return Err(SyntaxFault { line: first + fault.line, ..fault }.into());
                }
            }
        }
    }

    /// Takes the `GOTO` records that follow as far as they are laid out as those before, into `run`; gives their text.
    /// There may be none: [`Self::next_record`] goes on then.
    pub fn next_gotos(&mut self, run: &mut GotoRun) -> &[u8] {
        let text = self.take_gotos(run);
        &self.buffer[text]
    }

    /// What stands next: records of one layout together, into `run`; then what [`Self::next_record`] gives.
    #[inline]
    pub fn next_piece(&mut self, run: &mut GotoRun) -> ClPiece<'_> {
        let text = self.take_gotos(run);
        if !text.is_empty() {
            return ClPiece::Gotos(&self.buffer[text]);
        }
        match self.next_record() {
            Ok(Some(record)) => ClPiece::Record(record),
            Ok(None) => ClPiece::End,
            Err(ReadError::Syntax(fault)) => ClPiece::Unreadable(fault),
            Err(ReadError::Io(error)) => ClPiece::Failed(error),
        }
    }

    /// [`Self::next_gotos`], where the text stands in the buffer.
    #[inline]
    fn take_gotos(&mut self, run: &mut GotoRun) -> Range<usize> {
        let start = self.start;
        self.gotos_ahead(run);
        let RunForm { count, lines, stride, .. } = run.form;
        if lines > 1 {
            for place in 0..count {
                self.layout.join(&mut self.buffer[start + place * stride..]);
            }
        }
        self.pass_gotos(run);
        start..self.start
    }

    /// Fills in the `GOTO` records that follow as far as they are laid out as those before. None of them is taken:
    /// [`Self::pass_gotos`] does that, or [`Self::next_record`] one by one.
    pub fn gotos_ahead(&mut self, run: &mut GotoRun) {
        run.form = RunForm {
            count: self.layout.gotos(&self.buffer, self.start, self.end, &mut run.values),
            line: self.line,
            lines: self.layout.lines(),
            has_axis: self.layout.has_axis(),
            stride: self.layout.length(),
            length: self.layout.joined_length(),
        };
    }

    /// Takes the records that [`Self::gotos_ahead`] has filled in.
    pub fn pass_gotos(&mut self, run: &GotoRun) {
        self.start += run.form.count * run.form.stride;
        self.line += run.form.count as u64 * run.form.lines;
    }

    /// Passes over the `GOTO` records that follow, whose numbers nobody wants, but for the last of them that is read in whole:
    /// that is left for [`Self::next_gotos`] or [`Self::next_record`].
    pub fn skip_gotos(&mut self) {
        let (mut begins, mut line) = (self.start, self.line);
        while let Some((length, lines)) = self.goto_length(begins) {
            (self.start, self.line) = (begins, line);
            begins += length;
            line += lines;
        }
    }

    /// Bytes and lines of the `GOTO` that begins in the buffer at `from`, if it takes a line without a `$`, or is laid out
    /// as those before.
    #[inline]
    fn goto_length(&self, from: usize) -> Option<(usize, u64)> {
        let text = &self.buffer[from..self.end];
        let end = memchr3(b'\n', b'\r', b'$', text.strip_prefix(b"GOTO")?)? + b"GOTO".len();
        match text[end..] {
            [b'\n', ..] => Some((end + 1, 1)),
            [b'\r', b'\n', ..] => Some((end + 2, 1)),
            _ if self.layout.begins(&self.buffer, from, self.end) => {
                Some((self.layout.length(), self.layout.lines()))
            }
            _ => None,
        }
    }

    /// Numbers of the `GOTO` that begins here, if it is laid out as those before.
    #[inline(always)]
    fn laid_out(&mut self) -> Option<[f64; 6]> {
        self.layout.goto(&self.buffer, self.start, self.end)
    }

    /// Consumes the `GOTO` that begins here, laid out as those before.
    #[inline(always)]
    fn take_laid_out(&mut self, values: [f64; 6]) -> Record<'_> {
        let (start, line) = (self.start, self.line);
        let end = start + self.layout.join(&mut self.buffer[start..]);
        self.start += self.layout.length();
        self.line += self.layout.lines();
        let statement = goto_statement(&values, self.layout.has_axis());
        Record { line, raw: &self.buffer[start..end], statement }
    }

    /// The plain `GOTO` that begins here, and where the next line begins; `None` if there is none, or if more of the
    /// file must be read to know where it ends.
    #[inline(always)]
    fn plain(&self) -> Option<(PlainGoto, usize)> {
        let pending = self.pending();
        let plain = scan::plain_goto(pending)?;
        let next = match pending[plain.end..] {
            [b'\r', b'\n', ..] => plain.end + 2,
            [b'\r'] if !self.ended => return None,
            [_, ..] => plain.end + 1,
            [] if self.ended => plain.end,
            [] => return None,
        };
        (plain.end <= LONGEST).then_some((plain, next))
    }

    /// Consumes the plain `GOTO` that begins here.
    #[inline(always)]
    fn take_plain(&mut self, plain: &PlainGoto, next: usize) -> Record<'_> {
        let (start, line) = (self.start, self.line);
        self.start += next;
        self.line += 1;
        Record { line, raw: &self.buffer[start..start + plain.end], statement: plain.statement() }
    }

    /// Consumes the logical line that begins with `first`, and gives its place in the buffer; `None` if it is blank.
    ///
    /// Continued lines are moved together in the buffer, over the `$` and the line end between them.
    fn logical(&mut self, first: PhysicalLine) -> Result<Option<Range<usize>>, ReadError> {
        let line = self.line;
        let mut begin = 0;
        if line == 1 && self.pending().starts_with(BYTE_ORDER_MARK) {
            begin = BYTE_ORDER_MARK.len();
        }
        let text = &self.pending()[begin..first.end.max(begin)];
        // Old DOS systems end a text file with 0x1A.
        let blank = matches!(text.trim_ascii(), b"" | b"\x1A");
        let mut continued = if is_free_text(text) { None } else { continued(text) };
        let mut end = match continued {
            Some(body) => begin + body,
            None => first.end,
        };
        let mut last = first;
        let mut lines = 1;
        while continued.is_some() && !last.overlong {
            let from = last.next;
            let Some(physical) = self.physical(from)? else {
                let text = decode(&self.pending()[begin..end]).into_owned();
                self.consume(&last, lines);
                let at = text.len()..text.len();
                let fault =
                    SyntaxFault::new(&text, at, "the file ends where this record should go on");
                return Err(SyntaxFault { line, ..fault }
                    .help("a `$` at the end of a line means that the next one belongs to it")
                    .into());
            };
            let piece = &self.pending()[from..physical.end];
            let lead = piece.len() - piece.trim_ascii_start().len();
            continued = self::continued(piece);
            let length = continued.unwrap_or(piece.len()).max(lead);
            let piece = self.start + from + lead..self.start + from + length;
            let to = self.start + end;
            // The `$` and the line end before it leave room for the blank.
            self.buffer[to] = b' ';
            end += 1 + piece.len();
            self.buffer.copy_within(piece, to + 1);
            last = physical;
            lines += 1;
        }
        if last.overlong {
            let mut text =
                String::from_utf8_lossy(&self.pending()[..SHOWN.min(self.end - self.start)])
                    .into_owned();
            self.consume(&last, lines);
            text.push('…');
            let fault = SyntaxFault::new(
                &text,
                0..text.len(),
                format!("a record of more than {LONGEST} bytes"),
            );
            return Err(SyntaxFault { line, ..fault }
                .help("is this a cutter-location file?")
                .into());
        }
        let raw = self.start + begin..self.start + end;
        self.consume(&last, lines);
        self.parted = lines > 1;
        Ok((!blank).then_some(raw))
    }

    /// What is read and not yet consumed.
    fn pending(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// Goes on after the line `last`; its bytes stay in the buffer until it is filled again.
    fn consume(&mut self, last: &PhysicalLine, lines: u64) {
        self.start += last.next;
        self.line += lines;
    }

    /// The line that begins at the offset `from`; `None` at the end of the file.
    fn physical(&mut self, from: usize) -> io::Result<Option<PhysicalLine>> {
        let mut searched = from;
        let mut overlong = false;
        loop {
            let pending = self.pending();
            if let Some(at) = memchr2(b'\n', b'\r', &pending[searched..]) {
                let end = searched + at;
                let pair = pending[end] == b'\r' && pending.get(end + 1) == Some(&b'\n');
                // After a CR at the end of a chunk an LF may follow.
                if pending[end] == b'\n' || end + 1 < pending.len() || self.ended {
                    overlong |= end > LONGEST;
                    let next = end + 1 + usize::from(pair);
                    return Ok(Some(PhysicalLine { end, next, overlong }));
                }
                searched = end;
            } else {
                searched = pending.len();
                overlong |= searched > LONGEST;
                if self.ended {
                    let line = PhysicalLine { end: searched, next: searched, overlong };
                    return Ok((searched > from).then_some(line));
                }
                if searched > LONGEST {
                    searched = from.max(SHOWN);
                    self.end = self.start + searched;
                }
            }
            self.fill()?;
        }
    }

    /// Moves what is left to the front of the buffer and reads more after it.
    fn fill(&mut self) -> io::Result<()> {
        if self.start > 0 {
            self.buffer.copy_within(self.start..self.end, 0);
            self.end -= self.start;
            self.start = 0;
        }
        if self.end == self.buffer.len() {
            self.buffer.resize(2 * self.end, 0);
        }
        loop {
            match self.input.read(&mut self.buffer[self.end..]) {
                Ok(0) => self.ended = true,
                Ok(count) => {
                    // Old DOS systems end a text file with 0x1A.
                    let taken = &self.buffer[self.end..self.end + count];
                    let told = |byte: &&u8| !matches!(**byte, b' ' | b'\t' | b'\x1A');
                    if let Some(last) = taken.iter().rev().find(told) {
                        self.unended = !matches!(last, b'\n' | b'\r');
                    }
                    self.end += count;
                    self.taken += count as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            }
            return Ok(());
        }
    }
}

/// If the record goes on in the next line, how far it reaches in this one.
fn continued(text: &[u8]) -> Option<usize> {
    // The `$$` of a directive is no comment.
    let from = match text.trim_ascii_start().strip_prefix(b"$$") {
        Some(rest) if rest.trim_ascii_start().starts_with(b"->") => text.len() - rest.len(),
        _ => 0,
    };
    let comment =
        memchr_iter(b'$', &text[from..]).find(|at| text.get(from + at + 1) == Some(&b'$'));
    let body = match comment {
        Some(at) => &text[..from + at],
        None => text,
    };
    let body = body.trim_ascii_end().strip_suffix(b"$")?;
    Some(body.trim_ascii_end().len())
}

/// A list whose last row has no line end.
fn cut_off_row(text: &str) -> SyntaxFault {
    let message = "the list ends within this line: what follows may be missing";
    let fault = SyntaxFault::new(text, text.len()..text.len(), message);
    fault.help("end the last line as the others, with a line end")
}

/// The text of a line. What is not UTF-8 is taken for Latin-1, which older CAM systems write:
/// an `INSERT` has to reach the program letter for letter.
fn decode(raw: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(raw) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(raw.iter().map(|&byte| char::from(byte)).collect()),
    }
}
