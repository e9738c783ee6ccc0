//! Rows of numbers, packed as they come.

use std::io::{self, Write};

use crate::deflate::Deflate;
use crate::meta::{ColumnMeta, TableMeta};
use crate::{integers, part};

/// Rows of a chunk: few enough that memory is small, enough that the codes are good.
const CHUNK: usize = 1 << 15;

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// Name of the column.
    pub name: String,
    /// What it is counted in, `mm`; empty for bare numbers.
    pub unit: &'static str,
    /// Decimals that are kept.
    pub decimals: u8,
    /// What the rows tell it against ([`ColumnMeta::from`]).
    pub from: Option<&'static str>,
}

impl TableColumn {
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
    columns: Vec<TableColumn>,
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
    pub fn new(name: &'static str, columns: Vec<TableColumn>, out: W) -> Self {
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
            column.push(rounded(scaled));
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

/// Floats next to it are the integers next to it: 3 · 2^51.
const ROUNDER: f64 = (3u64 << 51) as f64;

/// The integer next to `value`, of two the even one; `value` lies within [`LARGEST`].
///
/// The sum has no place for a fraction, and is rounded as an integer is: a call of the library's function costs more than
/// all the rest of a value.
#[inline]
fn rounded(value: f64) -> i64 {
    (value + ROUNDER).to_bits().wrapping_sub(ROUNDER.to_bits()).cast_signed()
}

/// Integers up to here are exact in the page, and so are their second differences.
const LARGEST: f64 = (1u64 << 50) as f64;

fn scale(decimals: u8) -> f64 {
    (0..decimals).fold(1.0, |scale, _| scale * 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_rounded_as_by_the_library() {
        let mut seed = 1u64;
        for round in 0..100_000 {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let size = (1u64 << (round % 50)) as f64;
            let value = (seed >> 11) as f64 / (1u64 << 53) as f64 * size - size / 2.0;
            let half = (value * 2.0).trunc() / 2.0;
            for value in [value, half, -half, half + 0.25, 0.0, -0.0, LARGEST - 0.5, 0.5 - LARGEST]
            {
                assert_eq!(rounded(value), value.round_ties_even() as i64, "{value}");
            }
        }
    }
}
