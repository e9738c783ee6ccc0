//! Tables as people are shown them: rows of a name and its value, and columns below their heads. A line feed in a file's
//! name begins no line of them.

use std::fmt::{Display, Write as _};

use post_grammar::text::escaped;

/// Rows of a name and its value; a row without a name goes on with the value above it.
#[derive(Clone, Debug, Default)]
pub struct NamedValues {
    rows: Vec<[String; 2]>,
}

impl NamedValues {
    /// Adds a row.
    pub fn row(&mut self, name: impl Display, value: impl Display) {
        self.rows.push([name.to_string(), value.to_string()]);
    }

    /// Adds a row where there is a value.
    pub fn row_if(&mut self, name: impl Display, value: Option<impl Display>) {
        if let Some(value) = value {
            self.row(name, value);
        }
    }

    /// The rows as they are.
    pub fn into_rows(self) -> Vec<[String; 2]> {
        self.rows
    }

    /// A line a row: names are `width` letters wide, and values begin one blank behind them.
    pub fn lines(&self, width: usize) -> String {
        let lines = self.rows.iter().map(|[name, value]| {
            format!("{:<width$} {}\n", escaped(name, &[]), escaped(value, &[]))
        });
        lines.collect()
    }

    /// A line a row, values below one another two blanks behind the longest name.
    pub fn table(self) -> String {
        let mut table = TextTable::new(2);
        self.rows.into_iter().for_each(|row| table.row(row));
        table.text()
    }
}

/// Rows of cells, two blanks between the columns.
#[derive(Clone, Debug)]
pub struct TextTable {
    left: usize,
    rows: Vec<Vec<String>>,
}

/// A column is no wider than so many letters: a longer text stands in its row as it is, and makes no other row longer.
const WIDEST: usize = 1000;

impl TextTable {
    /// An empty table, of which the cells of the first `left` columns begin below one another, the others end so.
    pub fn new(left: usize) -> Self {
        Self { left, rows: Vec::new() }
    }

    /// The same with a row of heads.
    pub fn headed<const N: usize>(left: usize, heads: [&str; N]) -> Self {
        Self { left, rows: vec![heads.map(str::to_owned).to_vec()] }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl Into<Vec<String>>) {
        let cells: Vec<String> = cells.into();
        self.rows.push(cells.iter().map(|cell| escaped(cell, &[]).into_owned()).collect());
    }

    /// A line a row.
    pub fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or_default();
        let widest = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| Some(row.get(column)?.chars().count()));
            cells.max().unwrap_or_default().min(WIDEST)
        };
        let widths: Vec<usize> = (0..columns).map(widest).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for (column, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let between = if column > 0 { "  " } else { "" };
                // Writing to a String cannot fail.
                let _ = match column < self.left {
                    true => write!(line, "{between}{cell:<width$}"),
                    false => write!(line, "{between}{cell:>width$}"),
                };
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }

    /// Appends the table to what stands above it, an empty line between.
    pub fn below(&self, text: &mut String) {
        text.push('\n');
        text.push_str(&self.text());
    }
}

/// A cell; a dash where there is nothing to say.
pub fn or_dash(cell: Option<impl Display>) -> String {
    cell.map_or_else(|| "-".to_owned(), |cell| cell.to_string())
}
