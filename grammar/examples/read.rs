//! Reads CL files and does nothing else: what the grammar costs by itself.
//!
//! `valgrind --tool=callgrind target/release/examples/read part.cls`

use std::error::Error;
use std::fs::File;
use std::io::{Write, stdout};

use post_grammar::ClReader;

fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args().skip(1) {
        let mut reader = ClReader::new(File::open(&path)?);
        let mut records = 0;
        while reader.next_record()?.is_some() {
            records += 1;
        }
        writeln!(stdout(), "{path}: {records} records")?;
    }
    Ok(())
}
