//! Reads an NC program and says how long that took: `read_nc FILE [hash|names|conversational]`; with `-v` behind it,
//! each block too.

use std::error::Error;
use std::fs::File;
use std::io::{Write, stdout};
use std::time::Instant;

use post_grammar::nc::{NcBlock, NcReader, NcSyntax, Notation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("a file is missing")?;
    let family = arguments.next().unwrap_or_default();
    let verbose = arguments.next().is_some();
    let hash = !matches!(family.as_str(), "names" | "conversational");
    let syntax = NcSyntax {
        notation: match family.as_str() {
            "conversational" => Notation::Conversational,
            _ => Notation::Words,
        },
        line_remarks: vec![";".to_owned()],
        semicolon_ends: false,
        enclosed_remarks: hash.then_some(('(', ')')),
        hash_variables: hash,
        instructions: false,
    };
    let mut reader = NcReader::new(File::open(path)?, syntax);
    let mut block = NcBlock::default();
    let (mut blocks, mut items, mut faults) = (0_u64, 0, 0_u64);
    let begin = Instant::now();
    loop {
        match reader.next_block(&mut block) {
            Ok(false) => break,
            Ok(true) => {
                blocks += 1;
                items += block.items.len();
                if verbose {
                    writeln!(stdout(), "{block:?}")?;
                }
            }
            Err(fault) => {
                faults += 1;
                writeln!(stdout(), "{fault}")?;
            }
        }
    }
    let seconds = begin.elapsed().as_secs_f64();
    writeln!(
        stdout(),
        "{blocks} blocks with {items} items and {faults} faults in {:.1} ms, {:.0} ns a block, {} + {} lines skipped",
        1e3 * seconds,
        1e9 * seconds / blocks as f64,
        reader.header_lines(),
        reader.trailer_lines()
    )?;
    Ok(())
}
