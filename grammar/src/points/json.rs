//! JSON: a list of points, or an object with one and what else is said.

use std::ops::Range;

use super::row::is_column;
use super::{Cell, CellFault, RecordPlace, RowColumns, RowRecords, SHOWN, Settings};
use crate::fault::SyntaxFault;

/// Longest list, bytes: it is read in one piece.
pub(crate) const MOST_JSON: usize = 256 << 20;

/// Most values of a point.
const MOST_VALUES: usize = 64;

/// Deepest nesting.
const DEEPEST: usize = 3;

/// The columns of points that are lists of numbers, where the list does not name them.
const PLAIN: [&str; 6] = ["x", "y", "z", "i", "j", "k"];

/// A list in one piece, whose points are taken one by one.
#[derive(Debug, Default)]
pub(crate) struct JsonList {
    pub(crate) records: RowRecords,
    settings: Settings,
    /// Names of the columns, if the list says them.
    columns: Option<RowColumns>,
    /// The next point begins here; none: the points are over, or were not found yet.
    next: Option<usize>,
    /// Of a list that has its columns one by one: where the next value of each begins.
    tracks: Vec<usize>,
    /// The list was looked over.
    begun: bool,
    /// Line of the file on which it begins.
    first: u64,
    /// Bytes whose lines are counted, and line ends in them.
    counted: usize,
    lines: u64,
    /// How far the list reaches, bytes.
    pub(crate) end: usize,
}

/// A value and where it stands.
#[derive(Debug)]
struct Value {
    kind: Kind,
    span: Range<usize>,
}

#[derive(Debug)]
enum Kind {
    Cell(Cell),
    List(Vec<Value>),
    Object(Vec<Entry>),
}

#[derive(Debug)]
struct Entry {
    key: String,
    key_span: Range<usize>,
    value: Value,
}

/// What is wrong, and where.
struct Wrong {
    span: Range<usize>,
    message: String,
    help: String,
}

type Read<T> = Result<T, Wrong>;

fn wrong<T>(span: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Read<T> {
    Err(Wrong { span, message: message.into(), help: help.into() })
}

impl JsonList {
    /// Takes the next point of `text`, which is the whole list: what it says stands in [`Self::records`]. Gives where in the
    /// text it stands, and its line counted from 0; none after the last. The text begins on the line `first` of its file.
    ///
    /// # Errors
    /// It cannot be read; `line` of the fault counts from 0.
    pub(crate) fn take(
        &mut self,
        text: &str,
        first: u64,
    ) -> Result<Option<(Range<usize>, u64)>, SyntaxFault> {
        self.first = first;
        let taken = self.take_next(text);
        match taken {
            Ok(span) => Ok(span.map(|span| {
                let line = self.line(text, span.start);
                (span, line)
            })),
            Err(fault) => Err(self.told(text, fault)),
        }
    }

    fn take_next(&mut self, text: &str) -> Read<Option<Range<usize>>> {
        if !self.begun {
            self.begun = true;
            // A fault in it ends the list.
            self.end = text.len();
            self.next = self.look_over(text)?;
            self.records.settings(&self.settings);
        }
        if !self.tracks.is_empty() {
            return self.take_across(text);
        }
        let Some(at) = self.next.take() else {
            return Ok(self.close());
        };
        let mut cursor = JsonCursor { text, at };
        cursor.blanks();
        // Behind a comma a point stands.
        if !text[..at].ends_with(',') && cursor.taken(b']') {
            return Ok(self.close());
        }
        let value = cursor.value(0)?;
        if cursor.separated(b']')? {
            self.next = Some(cursor.at);
        }
        let span = value.span.clone();
        self.point(value)?;
        Ok(Some(span))
    }

    /// The end of the list.
    fn close(&mut self) -> Option<Range<usize>> {
        let told = self.records.end();
        (!told).then_some(self.end..self.end)
    }

    /// Takes the next value of each column. What cannot be read ends the list.
    fn take_across(&mut self, text: &str) -> Read<Option<Range<usize>>> {
        let mut tracks = std::mem::take(&mut self.tracks);
        let (mut cells, mut spans, mut over) = (Vec::new(), Vec::new(), None);
        for track in &mut tracks {
            let mut cursor = JsonCursor { text, at: *track };
            cursor.blanks();
            // Behind a comma a value stands.
            if cursor.taken(b']') && !text[..*track].ends_with(',') {
                over = Some(cursor.at - 1..cursor.at);
                continue;
            }
            let mut cursor = JsonCursor { text, at: *track };
            let value = cursor.value(0)?;
            spans.push(value.span.clone());
            cells.push(cell(value)?);
            cursor.blanks();
            // The bracket that closes stays for the next time.
            if cursor.peek() != Some(b']') {
                cursor.separated(b']')?;
            }
            *track = cursor.at;
        }
        match over {
            None => {}
            Some(_) if cells.is_empty() => return Ok(self.close()),
            Some(end) => {
                let message = "this column ends before others do";
                return wrong(end, message, "as many values in each");
            }
        }
        self.tracks = tracks;
        let span = spans[0].clone();
        let columns = self.columns.as_ref().map(|columns| columns.row(&cells));
        if let Some(row) = columns {
            let row = row.map_err(|fault| {
                located(fault, |cell| spans.get(cell).cloned().unwrap_or_default()).or(span.clone())
            })?;
            self.records.row(row, &self.settings);
        }
        Ok(Some(span))
    }

    /// Reads all but the points: gives where these begin; none where the columns stand one by one.
    fn look_over(&mut self, text: &str) -> Read<Option<usize>> {
        let mut cursor = JsonCursor { text, at: 0 };
        if text.starts_with('\u{FEFF}') {
            cursor.at = '\u{FEFF}'.len_utf8();
        }
        cursor.blanks();
        let begin = cursor.at;
        let points = match cursor.taken(b'{') {
            true => self.object(&mut cursor)?,
            false => cursor.points()?,
        };
        self.end = cursor.at;
        cursor.blanks();
        if cursor.at < text.len() {
            let rest = cursor.at..text.len().min(cursor.at + 1);
            return wrong(rest, "something stands behind the list", "one list a file");
        }
        match points {
            Some(points) => Ok(Some(points)),
            None if !self.tracks.is_empty() => Ok(None),
            None => wrong(
                begin..begin + 1,
                "the list has no `points`",
                "\"points\": [[0, 0, 0], [10, 0, 0]]",
            ),
        }
    }

    /// The keys of the object whose brace was taken; gives where the points begin.
    fn object(&mut self, cursor: &mut JsonCursor<'_>) -> Read<Option<usize>> {
        let mut points = None;
        let mut tracks: Vec<(String, Range<usize>)> = Vec::new();
        cursor.blanks();
        if cursor.taken(b'}') {
            return Ok(None);
        }
        loop {
            let (key, key_span) = cursor.key()?;
            match key.as_str() {
                "points" if points.is_some() => {
                    return wrong(key_span, "`points` stands here twice", "one list a file");
                }
                "points" => points = cursor.points()?,
                "columns" if self.columns.is_some() => {
                    return wrong(key_span, "`columns` stands here twice", "names once");
                }
                "columns" => {
                    let value = cursor.value(0)?;
                    self.columns = Some(columns(&value)?);
                }
                _ if is_column(&key) && cursor.lists() => {
                    self.tracks.extend(cursor.points()?);
                    tracks.push((key, key_span));
                }
                _ => {
                    let value = cursor.value(0)?;
                    let cell = match &value.kind {
                        Kind::Cell(cell) => cell.clone(),
                        _ => Cell::Empty,
                    };
                    let spans = [key_span, value.span];
                    self.settings.take(&key, &cell).map_err(|fault| {
                        located(fault, |cell| spans.get(cell).cloned().unwrap_or_default())
                    })?;
                    let (line, _, shown) = self.shown(cursor.text, spans[0].start);
                    let place = RecordPlace { line: self.first + line, text: shown.to_owned() };
                    self.settings.put(&key, place);
                }
            }
            if !cursor.separated(b'}')? {
                break;
            }
        }
        if let Some((_, span)) = tracks.first() {
            if points.is_some() || self.columns.is_some() {
                let message = "the list has `points`, or `columns`, and columns one by one as well";
                return wrong(span.clone(), message, "leave one of them out");
            }
            let columns = RowColumns::of(tracks.iter().map(|(name, _)| name.as_str()));
            self.columns =
                Some(columns.map_err(|fault| {
                    located(fault, |cell| tracks[cell].1.clone()).or(span.clone())
                })?);
        }
        Ok(points)
    }

    /// Takes a point.
    fn point(&mut self, value: Value) -> Read<()> {
        let whole = value.span.clone();
        let (cells, spans, columns) = match value.kind {
            Kind::List(values) => {
                let spans: Vec<_> = values.iter().map(|value| value.span.clone()).collect();
                let cells = values.into_iter().map(cell).collect::<Read<Vec<_>>>()?;
                let columns = match &self.columns {
                    Some(columns) => columns.clone(),
                    None => {
                        let count = if cells.len() == 6 { 6 } else { 3 };
                        let plain = RowColumns::of(PLAIN[..count].iter().copied());
                        plain.map_err(|fault| located(fault, |_| whole.clone()))?
                    }
                };
                (cells, spans, columns)
            }
            Kind::Object(entries) => {
                let mut named = NamedCells::default();
                for entry in entries {
                    named.take(entry)?;
                }
                let columns = RowColumns::of(named.names.iter().map(String::as_str));
                let columns = columns.map_err(|fault| {
                    located(fault, |cell| named.keys.get(cell).cloned().unwrap_or(whole.clone()))
                        .or(whole.clone())
                })?;
                (named.cells, named.spans, columns)
            }
            Kind::Cell(_) => {
                return wrong(
                    whole,
                    "this is no point",
                    "[x, y, z], [x, y, z, i, j, k] or {\"x\": …, \"y\": …, \"z\": …}",
                );
            }
        };
        let row = columns.row(&cells).map_err(|fault| {
            located(fault, |cell| spans.get(cell).cloned().unwrap_or_default()).or(whole)
        })?;
        self.records.row(row, &self.settings);
        Ok(())
    }

    /// Line ends ahead of the byte `at`; asked for places that only grow, but for the start.
    fn line(&mut self, text: &str, at: usize) -> u64 {
        if at < self.counted {
            (self.counted, self.lines) = (0, 0);
        }
        let passed = &text.as_bytes()[self.counted..at];
        self.lines += memchr::memchr_iter(b'\n', passed).count() as u64;
        self.counted = at;
        self.lines
    }

    /// The line of the byte `at` counted from 0, and of its text what is shown: where that begins, and it.
    fn shown<'t>(&mut self, text: &'t str, at: usize) -> (u64, usize, &'t str) {
        let line = self.line(text, at);
        let from = boundary(text, at.saturating_sub(SHOWN));
        let until = boundary(text, at.saturating_add(2 * SHOWN).min(text.len()));
        let from = text[from..at].rfind('\n').map_or(from, |end| from + end + 1);
        let until = text[at..until].find('\n').map_or(until, |end| at + end);
        (line, from, text[from..until].trim_end_matches('\r'))
    }

    /// The fault in the line that it stands in, or a part of it.
    fn told(&mut self, text: &str, fault: Wrong) -> SyntaxFault {
        let Wrong { span, message, help } = fault;
        let start = span.start.min(text.len());
        let (line, from, shown) = self.shown(text, start);
        let span = start - from..span.end.max(start) - from;
        let span = span.start.min(shown.len())..span.end.min(shown.len());
        SyntaxFault { line, ..SyntaxFault::new(shown, span, message).help(help) }
    }
}

/// The last place between characters up to `at`.
fn boundary(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

impl Wrong {
    /// Of the whole, where no place is said.
    fn or(self, whole: Range<usize>) -> Self {
        if self.span.is_empty() { Self { span: whole, ..self } } else { self }
    }
}

/// A fault of cells whose places `span` gives; that of a row as a whole has none yet.
fn located(fault: CellFault, span: impl FnOnce(usize) -> Range<usize>) -> Wrong {
    let CellFault { cell, message, help } = fault;
    Wrong { span: cell.map_or(0..0, span), message, help }
}

fn cell(value: Value) -> Read<Cell> {
    match value.kind {
        Kind::Cell(cell) => Ok(cell),
        _ => wrong(value.span, "a list where a value is expected", "one value of each column"),
    }
}

/// The names of `columns`.
fn columns(value: &Value) -> Read<RowColumns> {
    let Kind::List(names) = &value.kind else {
        return wrong(value.span.clone(), "`columns` is no list", "[\"x\", \"y\", \"z\"]");
    };
    let mut known = Vec::new();
    for name in names {
        let Kind::Cell(Cell::Text(text)) = &name.kind else {
            return wrong(name.span.clone(), "this is no name", "[\"x\", \"y\", \"z\"]");
        };
        known.push(text.as_str());
    }
    let span = |cell: usize| names.get(cell).map_or(0..0, |name| name.span.clone());
    RowColumns::of(known.into_iter()).map_err(|fault| located(fault, span).or(value.span.clone()))
}

/// The cells of a point that names them, with the places of names and values.
#[derive(Default)]
struct NamedCells {
    names: Vec<String>,
    keys: Vec<Range<usize>>,
    cells: Vec<Cell>,
    spans: Vec<Range<usize>>,
}

/// Names that stand for three columns each.
const TRIPLES: [(&str, [&str; 3]); 4] = [
    ("to", ["x", "y", "z"]),
    ("tool_axis", ["i", "j", "k"]),
    ("center", ["arc_x", "arc_y", "arc_z"]),
    ("axis", ["arc_i", "arc_j", "arc_k"]),
];

impl NamedCells {
    fn take(&mut self, entry: Entry) -> Read<()> {
        let Entry { key, key_span, value } = entry;
        // The parts of an arc stand for themselves.
        if let ("arc", Kind::Object(_)) = (key.as_str(), &value.kind) {
            let Kind::Object(parts) = value.kind else {
                return Ok(());
            };
            return parts.into_iter().try_for_each(|part| self.take(part));
        }
        let key = if key == "centre" { "center".to_owned() } else { key };
        let three = TRIPLES.iter().find(|(name, _)| *name == key).map(|(_, three)| three);
        let Some(three) = three else {
            self.push(key, key_span, Value { span: value.span.clone(), kind: value.kind })?;
            return Ok(());
        };
        let span = value.span.clone();
        match value.kind {
            Kind::List(values) if values.len() == 3 => {
                for (name, value) in three.iter().zip(values) {
                    self.push((*name).to_owned(), key_span.clone(), value)?;
                }
                Ok(())
            }
            _ => wrong(span, format!("`{key}` is no list of three numbers"), "[0, 0, 1]"),
        }
    }

    fn push(&mut self, name: String, key: Range<usize>, value: Value) -> Read<()> {
        self.names.push(name);
        self.keys.push(key);
        self.spans.push(value.span.clone());
        self.cells.push(cell(value)?);
        Ok(())
    }
}

/// Where in a text of JSON something is read.
struct JsonCursor<'t> {
    text: &'t str,
    at: usize,
}

impl JsonCursor<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t' | b'\n' | b'\r')) {
            self.at += 1;
        }
    }

    fn taken(&mut self, byte: u8) -> bool {
        let next = self.peek() == Some(byte);
        self.at += usize::from(next);
        next
    }

    /// A fault at what stands next.
    fn fault<T>(&self, message: &str) -> Read<T> {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let length = rest.chars().next().map_or(0, char::len_utf8);
        let help = "is this JSON, and all of it? json.dump() writes it";
        match length {
            0 => wrong(self.at..self.at, format!("the file ends where {message}"), help),
            _ => wrong(self.at..self.at + length, message, help),
        }
    }

    /// A comma, or what closes; true if something follows.
    fn separated(&mut self, close: u8) -> Read<bool> {
        self.blanks();
        if self.taken(b',') {
            return Ok(true);
        }
        if self.taken(close) {
            return Ok(false);
        }
        self.fault(&format!("a comma or `{}` is expected", char::from(close)))
    }

    fn key(&mut self) -> Read<(String, Range<usize>)> {
        self.blanks();
        let from = self.at;
        if !self.taken(b'"') {
            return self.fault("a name in quotation marks is expected");
        }
        let key = self.string()?;
        let span = from..self.at;
        self.blanks();
        if !self.taken(b':') {
            return self.fault("a colon is expected");
        }
        Ok((key, span))
    }

    /// A list stands next.
    fn lists(&mut self) -> bool {
        self.blanks();
        self.peek() == Some(b'[')
    }

    /// Passes over the points; gives where the first begins.
    fn points(&mut self) -> Read<Option<usize>> {
        self.blanks();
        if !self.taken(b'[') {
            return self.fault("a list of points is expected");
        }
        let first = self.at;
        self.pass()?;
        Ok(Some(first))
    }

    /// Passes over what stands up to the bracket that closes the one that was taken; what is inside is read later.
    fn pass(&mut self) -> Read<()> {
        let mut open = 1usize;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'"' => {
                    self.string()?;
                }
                b'[' | b'{' => open += 1,
                b']' | b'}' => open -= 1,
                _ => {}
            }
            if open == 0 {
                return Ok(());
            }
        }
        self.fault("a bracket is still open")
    }

    fn value(&mut self, depth: usize) -> Read<Value> {
        self.blanks();
        let from = self.at;
        if depth > DEEPEST {
            return self.fault("lists within lists, too deep for points");
        }
        let kind = match self.peek() {
            Some(b'[') => {
                self.at += 1;
                Kind::List(self.list(depth)?)
            }
            Some(b'{') => {
                self.at += 1;
                Kind::Object(self.entries(depth)?)
            }
            Some(b'"') => {
                self.at += 1;
                Kind::Cell(Cell::Text(self.string()?))
            }
            Some(_) => Kind::Cell(self.bare()?),
            None => return self.fault("a value is expected"),
        };
        Ok(Value { kind, span: from..self.at })
    }

    fn list(&mut self, depth: usize) -> Read<Vec<Value>> {
        let mut values = Vec::new();
        self.blanks();
        if self.taken(b']') {
            return Ok(values);
        }
        loop {
            values.push(self.value(depth + 1)?);
            self.refuse_many(values.len())?;
            if !self.separated(b']')? {
                return Ok(values);
            }
        }
    }

    fn entries(&mut self, depth: usize) -> Read<Vec<Entry>> {
        let mut entries = Vec::new();
        self.blanks();
        if self.taken(b'}') {
            return Ok(entries);
        }
        loop {
            let (key, key_span) = self.key()?;
            entries.push(Entry { key, key_span, value: self.value(depth + 1)? });
            self.refuse_many(entries.len())?;
            if !self.separated(b'}')? {
                return Ok(entries);
            }
        }
    }

    fn refuse_many(&self, count: usize) -> Read<()> {
        match count > MOST_VALUES {
            true => self.fault(&format!("more than {MOST_VALUES} values in one point")),
            false => Ok(()),
        }
    }

    /// What stands up to the quotation mark that closes, its escapes read.
    fn string(&mut self) -> Read<String> {
        let from = self.at;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'\\' => self.at += 1,
                b'"' => {
                    let whole = from - 1..self.at;
                    let read = self.text.get(whole.clone()).map(serde_json::from_str);
                    return match read {
                        Some(Ok(text)) => Ok(text),
                        _ => wrong(whole, "this is no text of JSON", "json.dump() writes it"),
                    };
                }
                b'\n' => break,
                _ => {}
            }
        }
        self.at = self.at.min(self.text.len());
        wrong(from - 1..from, "a quotation mark is still open", "the text ends on its line")
    }

    /// A number, or one of three words.
    fn bare(&mut self) -> Read<Cell> {
        let rest = &self.text[self.at..];
        let told = |byte: char| byte.is_ascii_alphanumeric() || "+-._".contains(byte);
        let length = rest.find(|byte: char| !told(byte)).unwrap_or(rest.len());
        let word = &rest[..length];
        let cell = match word {
            "null" => Some(Cell::Empty),
            "true" => Some(Cell::Flag(true)),
            "false" => Some(Cell::Flag(false)),
            _ => crate::cl::line::number_of(word).map(Cell::Number),
        };
        match cell {
            Some(cell) => {
                self.at += length;
                Ok(cell)
            }
            None if matches!(word, "NaN" | "Infinity" | "-Infinity") => wrong(
                self.at..self.at + length,
                format!("{word} is no number that a machine goes to"),
                "leave the point out, or find out where it comes from",
            ),
            None => self.fault("a value is expected"),
        }
    }
}
