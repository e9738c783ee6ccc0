//! The scanner of plain blocks against the grammar.

use super::{conversational, hash, names, read};
use post_grammar::nc::{NcSyntax, parse_block};
use post_testkit::{Rng, randomised};

/// What stands behind a plain block in a file must not matter to it.
const BEHIND: [&str; 3] = ["\n", "\r\nX1 Y2\nZ3", "\n                          "];

/// The reader, which scans where it can, makes of `line` what the grammar makes of it, a fault included.
fn assert_as_parsed(line: &str, syntax: &NcSyntax) {
    let parsed = parse_block(line, syntax);
    for behind in BEHIND {
        let (blocks, faults) = read(format!("{line}{behind}").as_bytes(), syntax);
        match &parsed {
            Ok(parsed) => {
                let nothing =
                    parsed.items.is_empty() && parsed.remarks.is_empty() && !parsed.skipped;
                if !nothing {
                    assert_eq!(blocks.first(), Some(parsed), "{line:?}");
                }
                assert!(faults.is_empty(), "{line:?}: {faults:?}");
            }
            Err(fault) => assert_eq!(faults.first(), Some(fault), "{line:?}"),
        }
    }
}

/// A number as controls write it.
const NUMBER: &str = "([+-]?[0-9]{1,5}|[+-]?[0-9]{1,4}\\.[0-9]{0,4}|[+-]?\\.[0-9]{1,8}|[+-]?[0-9]{1,12}\\.[0-9]{0,12})";

/// Words of letters and numbers, with blanks or without.
fn words(rng: &mut Rng) -> String {
    let mut line = rng.text("(|N[0-9]{1,6} ?| )");
    for _ in 0..rng.pick(8) {
        if rng.pick(9) < 8 {
            line += &rng.text("[A-Za-z] ?");
            line += &rng.text(NUMBER);
            line += &rng.text(" {0,2}");
        } else {
            line += &rng.text("(A3|B3|CR|X|F)=");
            line += &rng.text(NUMBER);
            line += " ";
        }
    }
    line
}

/// Conversational motions.
fn motions(rng: &mut Rng) -> String {
    const NAMES: [&str; 15] = [
        "FMAX ", "R0 ", "RL ", "RR ", "DR+ ", "DR- ", "R+ ", "F MAX ", "TX+0.5 ", "NZ-0.25 ",
        "MB MAX ", "FQ1 ", "X+Q5 ", "DR-0.1 ", "r0 ",
    ];
    let mut line = rng.text("[0-9]{0,5} (L |LN |C |CC |CR ||CP )");
    for _ in 0..rng.pick(7) {
        if rng.pick(5) < 4 {
            line += &rng.text("I?[A-Z](|||| )");
            line += &rng.text(NUMBER);
            line += &rng.text(" {1,2}");
        } else {
            line += NAMES[rng.pick(NAMES.len())];
        }
    }
    line
}

/// The line with something odd in it.
fn spoilt(rng: &mut Rng, line: &str, odd: &str) -> String {
    let at = rng.pick(60).min(line.len());
    format!("{}{}{}", &line[..at], rng.text(odd), &line[at..])
}

#[test]
fn words_and_numbers_as_parsed() {
    let (rounds, mut rng) = randomised(256, 1);
    for _ in rounds {
        let line = words(&mut rng);
        assert_as_parsed(&line, &hash());
        assert_as_parsed(&line, &names());
    }
}

#[test]
fn a_second_sign_is_none_of_a_number() {
    for line in ["X++5", "G1 X++.5 Y1", "X+-5", "X-+5", "X--5", "X=++5"] {
        assert_as_parsed(line, &hash());
        assert_as_parsed(line, &names());
        assert!(parse_block(line, &hash()).is_err(), "{line}");
    }
    assert_as_parsed("12 L X++5", &conversational());
}

#[test]
fn conversational_motions_as_parsed() {
    let (rounds, mut rng) = randomised(256, 2);
    for _ in rounds {
        assert_as_parsed(&motions(&mut rng), &conversational());
    }
}

#[test]
fn nearly_plain_blocks_as_parsed() {
    let (rounds, mut rng) = randomised(256, 3);
    for _ in rounds {
        let line = words(&mut rng);
        let line = spoilt(&mut rng, &line, "[A-Z0-9=.+\\-#\\[\\](),;:/ \"_%~<>$*EX]{1,2}");
        // A line of `%` alone is no block.
        if line.trim() != "%" {
            assert_as_parsed(&line, &hash());
            assert_as_parsed(&line, &names());
        }
    }
}

#[test]
fn nearly_plain_motions_as_parsed() {
    let (rounds, mut rng) = randomised(256, 4);
    for _ in rounds {
        let line = motions(&mut rng);
        let line = spoilt(&mut rng, &line, "[A-Z0-9=.+\\-#\\[\\](),;:/ \"_<>$*]{1,2}");
        assert_as_parsed(&line, &conversational());
    }
}
