//! Rows of numbers, packed as they come.

use std::io::{self, Write};

use crate::deflate::Deflate;
use crate::meta::{ColumnMeta, TableMeta};
use crate::{integers, part};

/// Rows of a chunk: few enough that memory is small, enough that the codes are good.
const CHUNK: usize = 1 << 15;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name of the column.
    pub name: String,
    /// What it is counted in, `mm`; empty for bare numbers.
    pub unit: &'static str,
    /// Decimals that are kept.
    pub decimals: u8,
    /// What the rows tell it against ([`ColumnMeta::from`]).
    pub from: Option<&'static str>,
}

impl Column {
    /// A column.
    pub fn new(name: impl Into<String>, unit: &'static str, decimals: u8) -> Self {
        Self { name: name.into(), unit, decimals, from: None }
    }

    /// The column, told against what the page derives.
    pub fn from(mut self, what: &'static str) -> Self {
        self.from = Some(what);
        self
    }
}

/// Takes the rows of a table and hands them on packed.
pub struct TableWriter<W> {
    name: &'static str,
    columns: Vec<Column>,
    scales: Vec<f64>,
    /// The rows of the chunk, column by column.
    values: Vec<Vec<i64>>,
    rows: u64,
    bytes: u64,
    deflate: Deflate,
    plain: Vec<u8>,
    packed: Vec<u8>,
    out: W,
}

impl<W: Write> TableWriter<W> {
    /// An empty table of that name, whose chunks go to `out`.
    pub fn new(name: &'static str, columns: Vec<Column>, out: W) -> Self {
        let scales = columns.iter().map(|column| scale(column.decimals));
        Self {
            name,
            scales: scales.collect(),
            values: columns.iter().map(|_| Vec::with_capacity(CHUNK)).collect(),
            columns,
            rows: 0,
            bytes: 0,
            deflate: Deflate::of_numbers(),
            plain: Vec::new(),
            packed: Vec::new(),
            out,
        }
    }

    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Takes a row: a value for each column.
    ///
    /// # Errors
    /// A value is no number or too large for its decimals, or what is packed cannot be written.
    #[inline]
    pub fn row(&mut self, row: &[f64]) -> io::Result<()> {
        debug_assert_eq!(row.len(), self.columns.len());
        let places = self.values.iter_mut().zip(&self.scales);
        for (index, ((column, scale), value)) in places.zip(row).enumerate() {
            let scaled = value * scale;
            if scaled.is_nan() || scaled.abs() >= LARGEST {
                let name = &self.columns[index].name;
                let message = format!("{value} cannot stand in the column {name} of the report");
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            }
            column.push(scaled.round_ties_even() as i64);
        }
        self.rows += 1;
        match self.values.first() {
            Some(first) if first.len() < CHUNK => Ok(()),
            _ => self.flush(),
        }
    }

    /// The end of the table: what the page must know of it, and its sink.
    ///
    /// # Errors
    /// What is packed cannot be written.
    pub fn finish(mut self) -> io::Result<(TableMeta, W)> {
        self.flush()?;
        let columns = self.columns.into_iter().map(|column| ColumnMeta {
            name: column.name,
            unit: column.unit,
            decimals: column.decimals,
            from: column.from,
        });
        let meta = TableMeta {
            name: self.name,
            rows: self.rows,
            columns: columns.collect(),
            bytes: self.bytes,
        };
        Ok((meta, self.out))
    }

    fn flush(&mut self) -> io::Result<()> {
        let rows = self.values.first().map_or(0, Vec::len);
        if rows == 0 {
            return Ok(());
        }
        self.deflate.piece(&(rows as u32).to_le_bytes());
        for column in &mut self.values {
            self.plain.clear();
            integers::encode(column, &mut self.plain);
            self.deflate.piece(&self.plain);
            column.clear();
        }
        self.deflate.take(&mut self.packed);
        self.bytes += part::write(&mut self.out, self.name, &self.packed)?;
        Ok(())
    }
}

/// Integers up to here are exact in the page, and so are their second differences.
const LARGEST: f64 = (1u64 << 50) as f64;

fn scale(decimals: u8) -> f64 {
    (0..decimals).fold(1.0, |scale, _| scale * 10.0)
}

#[cfg(test)]
mod tests {
    use miniz_oxide::inflate::decompress_to_vec;

    use super::*;

    /// Elements of a document, packed.
    fn parts(text: &[u8]) -> Vec<Vec<u8>> {
        let text = String::from_utf8(text.to_vec()).unwrap();
        let parts = text.split("data-name=\"t\">").skip(1);
        parts
            .map(|part| {
                let letters = part.split('<').next().unwrap();
                let mut bytes = Vec::new();
                let (mut bits, mut count) = (0u32, 0);
                for letter in letters.bytes().take_while(|letter| *letter != b'=') {
                    let value = match letter {
                        b'A'..=b'Z' => letter - b'A',
                        b'a'..=b'z' => letter - b'a' + 26,
                        b'0'..=b'9' => letter - b'0' + 52,
                        b'+' => 62,
                        _ => 63,
                    };
                    bits = bits << 6 | u32::from(value);
                    count += 6;
                    if count >= 8 {
                        count -= 8;
                        bytes.push((bits >> count) as u8);
                    }
                }
                decompress_to_vec(&bytes).unwrap()
            })
            .collect()
    }

    #[test]
    fn rows_come_back_in_their_chunks() {
        let columns =
            vec![Column::new("a", "mm", 3), Column::new("b", "", 0), Column::new("c", "deg", 5)];
        let mut table = TableWriter::new("t", columns, Vec::new());
        let row = |place: usize| {
            let t = place as f64;
            [
                (t * 0.37 - 40.0).rem_euclid(9.0) - 4.5,
                (place % 7) as f64,
                (place * place % 100_003) as f64 / 1e3,
            ]
        };
        let count = 2 * CHUNK + 11;
        for place in 0..count {
            table.row(&row(place)).unwrap();
        }
        let (meta, text) = table.finish().unwrap();
        assert_eq!(meta.rows, count as u64);
        assert_eq!(meta.bytes, text.len() as u64);
        let chunks = parts(&text);
        assert_eq!(chunks.len(), 3);
        let mut place = 0;
        for chunk in chunks {
            let rows = u32::from_le_bytes(chunk[..4].try_into().unwrap()) as usize;
            let mut at = 4;
            let read: Vec<Vec<i64>> =
                (0..3).map(|_| integers::decode(&chunk, rows, &mut at).unwrap()).collect();
            assert_eq!(at, chunk.len());
            for index in 0..rows {
                for ((column, value), scale) in read.iter().zip(row(place)).zip([1e3, 1.0, 1e5]) {
                    assert_eq!(column[index], (value * scale).round_ties_even() as i64);
                }
                place += 1;
            }
        }
        assert_eq!(place, count);
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for value in [f64::NAN, f64::INFINITY, 1e300] {
            let mut table = TableWriter::new("t", vec![Column::new("a", "mm", 3)], Vec::new());
            let fault = table.row(&[value]).unwrap_err().to_string();
            assert!(fault.contains("column a"), "{fault}");
        }
    }
}
