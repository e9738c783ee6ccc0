//! Reads CL files and does nothing else: what the grammar costs by itself.
//!
//! `valgrind --tool=callgrind target/release/examples/read part.cls`; behind `--points`, runs of points come as arrays.

use std::error::Error;
use std::fs::File;
use std::io::{Write, stdout};

use post_grammar::{Points, Reader};

fn main() -> Result<(), Box<dyn Error>> {
    let mut batches = false;
    let mut points = Points::default();
    for path in std::env::args().skip(1) {
        if path == "--points" {
            batches = true;
            continue;
        }
        let mut reader = Reader::new(File::open(&path)?);
        let mut records = 0;
        loop {
            if batches {
                reader.next_points(&mut points, 128)?;
            }
            records += points.len();
            if points.is_empty() {
                if reader.next_record()?.is_none() {
                    break;
                }
                records += 1;
            }
        }
        writeln!(stdout(), "{path}: {records} records")?;
    }
    Ok(())
}
