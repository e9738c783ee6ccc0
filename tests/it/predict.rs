//! `post predict`: what a program does on a machine with servos, against numbers that are known apart from it.

use crate::{common, generate};

use std::fs;

#[test]
fn the_s_piece_is_what_the_generator_writes() {
    let mut text = Vec::new();
    generate::write_s_piece(&mut text, 240).unwrap();
    let kept = fs::read(common::root().join("tests/samples/s-piece.cls")).unwrap();
    assert!(kept == text, "cargo run --example generate -- s-piece 240");
}
