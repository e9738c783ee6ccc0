//! CSV: settings, a header, and a row a line; between commas, semicolons or tabs.

use std::ops::Range;

use super::row::is_column;
use super::setting::is_setting;
use super::{Cell, CellFault, RowColumns, RowRecords, Settings};
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
    if first.contains(['/', '$']) || !first.contains(SEPARATORS) {
        return false;
    }
    let separator = separator(first);
    let mut cells = first.split(separator).map(unquoted);
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

/// What stands between the cells of a line: a comma only if nothing else does.
fn separator(line: &str) -> char {
    SEPARATORS.into_iter().find(|separator| line.contains(*separator)).unwrap_or(',')
}

/// A cell without blanks and quotation marks around it.
fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    let inside = cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"'));
    inside.map_or(cell, str::trim)
}

fn cell_of(text: &str) -> Cell {
    let text = unquoted(text);
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

/// Where the cells of a line stand in it, without the blanks around them.
fn spans(line: &str, separator: char) -> impl Iterator<Item = Range<usize>> {
    line.split(separator).map(move |cell| {
        let begin = cell.as_ptr() as usize - line.as_ptr() as usize;
        let blank = cell.len() - cell.trim_start().len();
        begin + blank..begin + blank.max(cell.trim_end().len())
    })
}

impl CsvList {
    /// Takes a line; what it says stands in [`Self::records`].
    ///
    /// # Errors
    /// It cannot be read; its line is not known here.
    pub(crate) fn take(&mut self, line: &str) -> Result<(), SyntaxFault> {
        let text = line.trim_start_matches('\u{FEFF}');
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            return Ok(());
        }
        let separator =
            self.table.as_ref().map_or_else(|| separator(text), |table| table.separator);
        // Ahead of the header spreadsheets leave rows that were deleted; behind it such a row is a point that is missing.
        if !self.has_header() && text.split(separator).all(|cell| unquoted(cell).is_empty()) {
            return Ok(());
        }
        self.take_cells(text, separator).map_err(|fault| {
            fault.told(text, |cell| spans(text, separator).nth(cell).unwrap_or(0..text.len()))
        })
    }

    fn take_cells(&mut self, text: &str, separator: char) -> Result<(), CellFault> {
        if let Some(table) = &self.table {
            self.cells.clear();
            self.cells.extend(text.split(separator).map(cell_of));
            let row = table.columns.row(&self.cells)?;
            self.records.row(row, &self.settings);
            return Ok(());
        }
        let names = text.split(separator).map(unquoted);
        let first = names.clone().next().unwrap_or_default();
        // Spreadsheets fill a line up with separators.
        let told = names.clone().filter(|name| !name.is_empty()).count();
        let heads = names.clone().skip(1).any(is_column);
        if told <= 2 && !heads && number_of(first).is_none() {
            let value = text.split(separator).nth(1).map_or(Cell::Empty, cell_of);
            return self.settings.take(first, &value);
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
