//! Tests of the reader of NC programs.

mod blocks;
mod files;
mod places;
mod robust;
mod scanner;

use post_grammar::nc::{NcBlock, NcReader, NcSyntax, Notation};
use post_grammar::{ReadError, SyntaxFault};
use std::io::Cursor;

/// Fanuc and its kin, LinuxCNC, Okuma.
fn hash() -> NcSyntax {
    NcSyntax {
        notation: Notation::Words,
        line_remarks: vec![";".to_owned()],
        semicolon_ends: false,
        enclosed_remarks: Some(('(', ')')),
        hash_variables: true,
        instructions: false,
    }
}

/// Fagor, ISG.
fn instructions() -> NcSyntax {
    NcSyntax { hash_variables: false, instructions: true, ..hash() }
}

/// Siemens.
fn names() -> NcSyntax {
    NcSyntax { enclosed_remarks: None, hash_variables: false, ..hash() }
}

/// Heidenhain.
fn conversational() -> NcSyntax {
    NcSyntax { notation: Notation::Conversational, ..names() }
}

/// All blocks of a text, and its faults.
fn read(text: &[u8], syntax: &NcSyntax) -> (Vec<NcBlock>, Vec<SyntaxFault>) {
    let mut reader = NcReader::new(Cursor::new(text), syntax.clone());
    let (mut blocks, mut faults) = (Vec::new(), Vec::new());
    let mut block = NcBlock::default();
    loop {
        match reader.next_block(&mut block) {
            Ok(false) => return (blocks, faults),
            Ok(true) => blocks.push(block.clone()),
            Err(ReadError::Syntax(fault)) => faults.push(*fault),
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
}
