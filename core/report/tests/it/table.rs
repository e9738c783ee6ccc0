use miniz_oxide::inflate::decompress_to_vec;
use post_report::table::{TableColumn, TableWriter};

use crate::integers;

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
    let columns = vec![
        TableColumn::new("a", "mm", 3),
        TableColumn::new("b", "", 0),
        TableColumn::new("c", "deg", 5),
    ];
    let mut table = TableWriter::new("t", columns, Vec::new());
    let row = |place: usize| {
        let t = place as f64;
        [
            (t * 0.37 - 40.0).rem_euclid(9.0) - 4.5,
            (place % 7) as f64,
            (place * place % 100_003) as f64 / 1e3,
        ]
    };
    let count = 2 * (1 << 15) + 11;
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
        let mut table = TableWriter::new("t", vec![TableColumn::new("a", "mm", 3)], Vec::new());
        let fault = table.row(&[value]).unwrap_err().to_string();
        assert!(fault.contains("column a"), "{fault}");
    }
}
