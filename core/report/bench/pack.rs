//! What packing costs: nanoseconds a row and bytes a row, for rows like those of a five-axis program, and for its text.
#![allow(clippy::print_stdout, reason = "a benchmark prints what it has measured")]

use std::fmt::Write as _;
use std::time::Instant;

use post_report::table::{TableColumn, TableWriter};
use post_report::text::TextWriter;

const ROWS: usize = 1_000_000;

/// Columns of a program that is posted, with their decimals.
const COLUMNS: [(&str, u8); 27] = [
    ("nc", 0),
    ("cl", 0),
    ("t0", 4),
    ("t1", 4),
    ("kind", 0),
    ("reason", 0),
    ("q.C", 5),
    ("q.A", 5),
    ("q.Y", 4),
    ("q.X", 4),
    ("q.Z", 4),
    ("tip.x", 4),
    ("tip.y", 4),
    ("tip.z", 4),
    ("axis.i", 6),
    ("axis.j", 6),
    ("axis.k", 6),
    ("deviation", 4),
    ("axis_deviation", 3),
    ("tolerance", 6),
    ("feed", 1),
    ("asked", 1),
    ("limit", 0),
    ("tool_length", 4),
    ("d.x", 3),
    ("d.y", 3),
    ("d.z", 3),
];

/// A value between 0 and 1 that looks like chance.
fn noise(row: usize) -> f64 {
    let mixed = (row as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    ((mixed ^ mixed >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64 / (1u64 << 24) as f64
}

/// A wave of period 2 and height 1, smooth enough: parabolas.
fn sine(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x < 1.0 { 4.0 * x * (1.0 - x) } else { -4.0 * (x - 1.0) * (2.0 - x) }
}

fn main() {
    let columns = COLUMNS.map(|(name, decimals)| TableColumn::new(name, "", decimals));
    let mut table = TableWriter::new("blocks", columns.to_vec(), std::io::sink());
    let rounded = |value: f64| (value * 1e3).round() / 1e3;
    let rows: Vec<[f64; 27]> = (0..ROWS)
        .map(|row| {
            let t = row as f64 * 0.01;
            // A wave with waves on it: second differences of some steps of the last digit.
            let wave = |k: f64| rounded(80.0 * sine(t * 0.02 * k) + 3.0 * sine(t * k));
            let mut values = [0.0; 27];
            values[..6].copy_from_slice(&[
                row as f64 + 20.0,
                (row / 3) as f64,
                0.0,
                t * 0.1 + 0.001 * noise(row),
                3.0,
                2.0,
            ]);
            for (place, value) in values[6..11].iter_mut().enumerate() {
                *value = wave(1.0 + place as f64 * 0.3);
            }
            values[17] = 0.005 * noise(row + 7);
            values[18] = 0.002;
            values[19] = 0.005;
            values[20] = 1500.0 - (noise(row + 3) * 3.0).floor() * 0.1;
            values[21] = 1500.0;
            values[22] = -1.0;
            values[23] = 120.0;
            values[24] = rounded(0.003 * (noise(row + 1) - 0.5));
            values
        })
        .collect();
    let start = Instant::now();
    for row in &rows {
        table.row(row).expect("a sink takes all");
    }
    let (meta, _) = table.finish().expect("a sink takes all");
    let spent = start.elapsed().as_secs_f64();
    println!(
        "rows: {:.0} ns a row, {:.2} bytes a row in the document ({:.2} before base64)",
        1e9 * spent / ROWS as f64,
        meta.bytes as f64 / ROWS as f64,
        0.75 * meta.bytes as f64 / ROWS as f64,
    );
    let mut text = String::new();
    for (row, values) in rows.iter().enumerate() {
        let _ = writeln!(
            text,
            "N{} G1 X{:.3} Y{:.3} Z{:.3} A{:.3} C{:.3}",
            row * 10,
            values[9],
            values[8],
            values[10],
            values[7],
            values[6]
        );
    }
    let mut writer = TextWriter::new("nc", std::io::sink());
    let start = Instant::now();
    writer.write(text.as_bytes()).expect("a sink takes all");
    let (meta, _) = writer.finish().expect("a sink takes all");
    let spent = start.elapsed().as_secs_f64();
    println!(
        "text: {:.0} ns a line, {:.2} bytes a line in the document, of {:.1}",
        1e9 * spent / ROWS as f64,
        meta.bytes as f64 / ROWS as f64,
        text.len() as f64 / ROWS as f64,
    );
}
