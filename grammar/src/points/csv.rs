//! CSV: settings, a header, and a row a line; between commas, semicolons or tabs.

use std::borrow::Cow;
use std::ops::Range;

use super::row::is_column;
use super::setting::is_setting;
use super::{Cell, CellFault, RecordPlace, RowColumns, RowRecords, Settings};
use crate::cl::line::number_of;
use crate::fault::SyntaxFault;

/// A list that is read line by line.
#[derive(Debug, Default)]
pub(crate) struct CsvList {
    pub(crate) records: RowRecords,
    settings: Settings,
    /// Once the header was read.
    table: Option<CsvTable>,
    /// Room for the cells of a row.
    cells: Vec<Cell>,
}

#[derive(Debug)]
struct CsvTable {
    separator: char,
    columns: RowColumns,
}

const SEPARATORS: [char; 3] = [';', '\t', ','];

/// The file is a list: its first line is a header, a setting, or a row without a header ahead.
pub(super) fn begins(head: &[u8]) -> bool {
    let head = String::from_utf8_lossy(head);
    let mut lines = head.split(['\n', '\r']).map(str::trim);
    let Some(first) = lines.find(|line| !line.is_empty() && !line.starts_with('#')) else {
        return false;
    };
    let bare = outside_quotes(first);
    if bare.contains(['/', '$']) || !bare.contains(SEPARATORS) {
        return false;
    }
    let separator = separator(first);
    let cells: Vec<_> = cells(first, separator).collect();
    let mut cells = cells.iter().map(AsRef::as_ref);
    let count = cells.clone().count();
    // What follows a word of a CL file may be anything: `REMARK x,y,z`.
    let name = |cell: &str| {
        cell.starts_with(|first: char| first.is_alphabetic()) && !cell.contains(char::is_whitespace)
    };
    let names = cells.clone().all(|cell| cell.is_empty() || name(cell));
    // No record of a CL file is a word and a value with nothing but a separator between them.
    let setting = count == 2 && cells.clone().next().is_some_and(name);
    is_setting(cells.clone().next().unwrap_or_default())
        || setting
        || names && count >= 3
        || count >= 3 && cells.all(|cell| number_of(cell).is_some())
}

/// A line of the beginning of a file names the columns x, y and z.
pub(super) fn heads(head: &str) -> bool {
    head.lines().any(|line| {
        let names: Vec<_> = cells(line, separator(line)).collect();
        let has = |column: &&str| names.iter().any(|name| name.eq_ignore_ascii_case(column));
        ["x", "y", "z"].iter().all(has)
    })
}

/// What stands between the cells of a line: a comma only if nothing else does.
fn separator(line: &str) -> char {
    let bare = outside_quotes(line);
    SEPARATORS.into_iter().find(|separator| bare.contains(*separator)).unwrap_or(',')
}

/// The line without what stands in quotation marks.
fn outside_quotes(line: &str) -> Cow<'_, str> {
    if !line.contains('"') {
        return Cow::Borrowed(line);
    }
    line.split('"').step_by(2).collect::<String>().into()
}

/// A cell without blanks and quotation marks around it; two of these inside are one.
fn unquoted(cell: &str) -> Cow<'_, str> {
    let cell = cell.trim();
    let inside = cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"'));
    match inside.map(str::trim) {
        None => Cow::Borrowed(cell),
        Some(inside) if inside.contains("\"\"") => Cow::Owned(inside.replace("\"\"", "\"")),
        Some(inside) => Cow::Borrowed(inside),
    }
}

/// A cell begins with a quotation mark, and the one that closes it is missing.
fn is_open(cell: &str) -> bool {
    cell.starts_with('"') && cell.matches('"').count() % 2 == 1
}

/// The cells of a line.
fn cells(line: &str, separator: char) -> impl Iterator<Item = Cow<'_, str>> {
    Cells { line, separator, at: Some(0) }.map(|span| unquoted(&line[span]))
}

/// Where the cells of a line stand in it, without the blanks around them.
fn spans(line: &str, separator: char) -> impl Iterator<Item = Range<usize>> {
    Cells { line, separator, at: Some(0) }.map(|Range { start, end }| {
        let cell = &line[start..end];
        let blank = cell.len() - cell.trim_start().len();
        start + blank..start + blank.max(cell.trim_end().len())
    })
}

/// Where the cells of a line stand in it: a separator in quotation marks parts nothing.
struct Cells<'l> {
    line: &'l str,
    separator: char,
    /// Where the next begins; none behind the last.
    at: Option<usize>,
}

impl Iterator for Cells<'_> {
    type Item = Range<usize>;

    fn next(&mut self) -> Option<Range<usize>> {
        let begin = self.at.take()?;
        let rest = &self.line[begin..];
        let quoted = rest.trim_start_matches([' ', '\t']).starts_with('"');
        let mut inside = false;
        let parts = |sign: char| {
            inside ^= quoted && sign == '"';
            sign == self.separator && !inside
        };
        let length = rest.find(parts);
        self.at = length.map(|length| begin + length + self.separator.len_utf8());
        Some(begin..length.map_or(self.line.len(), |length| begin + length))
    }
}

fn cell_of(text: &str) -> Cell {
    if text.is_empty() {
        return Cell::Empty;
    }
    match number_of(text) {
        Some(number) => Cell::Number(number),
        None if text.eq_ignore_ascii_case("true") => Cell::Flag(true),
        None if text.eq_ignore_ascii_case("false") => Cell::Flag(false),
        None => Cell::Text(text.to_owned()),
    }
}

impl CsvList {
    /// Takes the line of this number; what it says stands in [`Self::records`].
    ///
    /// # Errors
    /// It cannot be read; the fault does not name the line.
    pub(crate) fn take(&mut self, line: &str, number: u64) -> Result<(), SyntaxFault> {
        let text = line.trim_start_matches('\u{FEFF}');
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            return Ok(());
        }
        let separator =
            self.table.as_ref().map_or_else(|| separator(text), |table| table.separator);
        // Ahead of the header spreadsheets leave rows that were deleted; behind it such a row is a point that is missing.
        if !self.has_header() && cells(text, separator).all(|cell| cell.is_empty()) {
            return Ok(());
        }
        if let Some(open) =
            spans(text, separator).last().filter(|last| is_open(&text[last.clone()]))
        {
            let fault = SyntaxFault::new(text, open, "a quotation mark is still open");
            let help =
                "a text in quotation marks ends on its line; one inside of it is written twice";
            return Err(fault.help(help));
        }
        self.take_cells(text, separator, number).map_err(|fault| {
            fault.told(text, |cell| spans(text, separator).nth(cell).unwrap_or(0..text.len()))
        })
    }

    fn take_cells(&mut self, text: &str, separator: char, line: u64) -> Result<(), CellFault> {
        if let Some(table) = &self.table {
            self.cells.clear();
            self.cells.extend(cells(text, separator).map(|cell| cell_of(&cell)));
            let row = table.columns.row(&self.cells)?;
            self.records.row(row, &self.settings);
            return Ok(());
        }
        let names: Vec<_> = cells(text, separator).collect();
        let mut names = names.iter().map(AsRef::as_ref);
        let first = names.clone().next().unwrap_or_default();
        // Spreadsheets fill a line up with separators.
        let told = names.clone().filter(|name| !name.is_empty()).count();
        let heads = names.clone().skip(1).any(is_column);
        if told <= 2 && !heads && number_of(first).is_none() {
            let value = names.nth(1).map_or(Cell::Empty, cell_of);
            self.settings.take(first, &value)?;
            self.settings.put(first, RecordPlace { line, text: text.to_owned() });
            return Ok(());
        }
        if is_setting(first) && !heads {
            let message = format!("`{first}` has {} values", told - 1);
            let help = "a setting has one value: numbers without commas in them, names without a separator";
            return Err(CellFault::at(0, message, help));
        }
        if number_of(first).is_some() {
            return Err(CellFault::whole(
                "rows of points without a header".to_owned(),
                "write the names of the columns into the line before: x,y,z or x,y,z,i,j,k",
            ));
        }
        let columns = RowColumns::of(names)?;
        self.records.settings(&self.settings);
        self.table = Some(CsvTable { separator, columns });
        Ok(())
    }

    /// The header was read: what follows are rows.
    pub(crate) fn has_header(&self) -> bool {
        self.table.is_some()
    }

    /// The end was told.
    pub(crate) fn ended(&self) -> bool {
        self.records.ended
    }

    /// The list is over; true if that was told before.
    pub(crate) fn end(&mut self) -> bool {
        self.records.end()
    }
}
