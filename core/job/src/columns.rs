//! Tables as lists of columns: what each is called, what it is counted in, and what it is of a row. Whoever writes a table
//! walks through them, so that a column is one line: for the report's page, CSV, arrays, and the results of a batch.

use std::borrow::Cow;
use std::fmt::Write as _;

use post_plugin::fixed;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::value::RawValue;

use crate::files::{AtomicFile, FileFault};

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Numbers in the unit of the column.
    Number,
    /// How often, a line, or a place in a list.
    Count,
    /// Places in a short list of words.
    Choice,
    /// 1 for yes, 0 for no.
    Flag,
    /// Words and sentences.
    Text,
}

/// A value of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum CellValue {
    /// In the unit of the column.
    Number(f64),
    /// A count, a place or a flag.
    Count(i64),
    /// A word or a sentence.
    Text(Cow<'static, str>),
}

impl CellValue {
    /// The value as a number, where it is one.
    #[inline]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Count(count) => Some(*count as f64),
            Self::Text(_) => None,
        }
    }
}

impl<'de> Deserialize<'de> for CellValue {
    /// Numbers are read by the standard library, to the last bit.
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let raw = Box::<RawValue>::deserialize(from)?;
        let raw = raw.get();
        if raw.starts_with('"') {
            let text = serde_json::from_str(raw).map(Self::Text);
            return text.map_err(serde::de::Error::custom);
        }
        match raw.parse::<i64>() {
            Ok(count) => Ok(Self::Count(count)),
            Err(_) => raw.parse::<f64>().map(Self::Number).map_err(serde::de::Error::custom),
        }
    }
}

/// What can stand in a column.
pub trait IntoCell {
    /// What the column is by it.
    const KIND: ColumnKind;

    /// The value; none where the row has none.
    fn value(self) -> Option<CellValue>;
}

macro_rules! cells {
    ($($type:ty: $kind:ident = |$cell:ident| $value:expr;)*) => {$(
        impl IntoCell for $type {
            const KIND: ColumnKind = ColumnKind::$kind;

            #[inline]
            fn value(self) -> Option<CellValue> {
                let $cell = self;
                Some($value)
            }
        }
    )*};
}

cells! {
    f64: Number = |number| CellValue::Number(number);
    i64: Count = |count| CellValue::Count(count);
    u64: Count = |count| CellValue::Count(i64::try_from(count).unwrap_or(i64::MAX));
    u32: Count = |count| CellValue::Count(count.into());
    u8: Choice = |place| CellValue::Count(place.into());
    bool: Flag = |flag| CellValue::Count(flag.into());
    &'static str: Text = |word| CellValue::Text(word.into());
    String: Text = |text| CellValue::Text(text.into());
}

impl<C: IntoCell> IntoCell for Option<C> {
    const KIND: ColumnKind = C::KIND;

    #[inline]
    fn value(self) -> Option<CellValue> {
        self.and_then(C::value)
    }
}

/// Reads a column's value, the first or a further one, off a row.
trait ReadCell<R> {
    fn cell(&self, row: &R, place: usize) -> Option<CellValue>;

    /// The value of a column of numbers: no cell is made of it. None where it is none.
    fn number(&self, row: &R, place: usize) -> Option<f64>;
}

impl<R, C: IntoCell, F: Fn(&R, usize) -> C> ReadCell<R> for F {
    fn cell(&self, row: &R, place: usize) -> Option<CellValue> {
        self(row, place).value()
    }

    fn number(&self, row: &R, place: usize) -> Option<f64> {
        self(row, place).value().and_then(|cell| cell.number())
    }
}

/// A column of a table whose rows are `R`.
pub struct Column<R> {
    /// Its name.
    pub name: Cow<'static, str>,
    /// What it is counted in, `mm`; empty for bare numbers, and where the name has it.
    pub unit: &'static str,
    /// Decimals that are kept of numbers.
    pub decimals: u8,
    /// What it is; empty where a page or a manual says so.
    pub doc: Cow<'static, str>,
    /// What the page tells it against (`post_report::meta::ColumnMeta::from`).
    pub from: Option<&'static str>,
    /// What its values are.
    pub kind: ColumnKind,
    /// How many values a row has in it, where it has a list of them.
    pub width: Option<usize>,
    value: Box<dyn ReadCell<R>>,
}

impl<R> Column<R> {
    /// A column with one value a row.
    pub fn new<C: IntoCell>(
        name: impl Into<Cow<'static, str>>,
        unit: &'static str,
        decimals: u8,
        value: impl Fn(&R) -> C + 'static,
    ) -> Self {
        Self { decimals, unit, width: None, ..Self::wide(name, 1, move |row, _| value(row)) }
    }

    /// A column with a list of `width` values a row, which `value` is asked for by their places.
    pub fn wide<C: IntoCell>(
        name: impl Into<Cow<'static, str>>,
        width: usize,
        value: impl Fn(&R, usize) -> C + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            unit: "",
            decimals: 0,
            doc: Cow::Borrowed(""),
            from: None,
            kind: C::KIND,
            width: Some(width),
            value: Box::new(value),
        }
    }

    /// The same, told against what the page derives.
    pub fn from(self, what: &'static str) -> Self {
        Self { from: Some(what), ..self }
    }

    /// The same, with what it is.
    pub fn doc(self, doc: impl Into<Cow<'static, str>>) -> Self {
        Self { doc: doc.into(), ..self }
    }

    /// What it is of a row; none where the row has no such value.
    #[inline]
    pub fn of(&self, row: &R, place: usize) -> Option<CellValue> {
        self.value.cell(row, place)
    }

    /// The first value of a row as a number; none where it is none.
    #[inline]
    pub fn number(&self, row: &R) -> Option<f64> {
        self.value.number(row, 0)
    }
}

/// So many bytes of rows are written at once.
const BUFFER: usize = 1 << 16;

/// A table as CSV, written as its rows come. Names and texts are ours: they need no quotes.
pub struct CsvTable<'f, R> {
    columns: Vec<Column<R>>,
    file: &'f mut AtomicFile,
    text: String,
}

impl<'f, R> CsvTable<'f, R> {
    /// With its first line, the names.
    pub fn new(columns: Vec<Column<R>>, file: &'f mut AtomicFile) -> Self {
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_ref()).collect();
        let mut text = String::with_capacity(2 * BUFFER);
        text.push_str(&names.join(","));
        text.push('\n');
        Self { columns, file, text }
    }

    /// Takes the next row.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn row(&mut self, row: &R) -> Result<(), FileFault> {
        let text = &mut self.text;
        for (place, column) in self.columns.iter().enumerate() {
            if place > 0 {
                text.push(',');
            }
            match column.of(row, 0) {
                Some(CellValue::Number(number)) => fixed(text, number, column.decimals),
                // Writing to a String cannot fail.
                Some(CellValue::Count(count)) => drop(write!(text, "{count}")),
                Some(CellValue::Text(word)) => text.push_str(&word),
                None => {}
            }
        }
        text.push('\n');
        if text.len() > BUFFER {
            self.file.write_bytes(text.as_bytes())?;
            text.clear();
        }
        Ok(())
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self) -> Result<(), FileFault> {
        self.file.write_bytes(self.text.as_bytes())
    }
}
