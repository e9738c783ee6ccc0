//! The scanner of plain blocks against the grammar.

use super::{conversational, hash, names, read};
use post_grammar::nc::{NcSyntax, parse_block};
use proptest::prelude::*;

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
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        "[+-]?[0-9]{1,5}",
        "[+-]?[0-9]{1,4}\\.[0-9]{0,4}",
        "[+-]?\\.[0-9]{1,8}",
        "[+-]?[0-9]{1,12}\\.[0-9]{0,12}",
    ]
}

/// Words of letters and numbers, with blanks or without.
fn words() -> impl Strategy<Value = String> {
    let word = ("[A-Za-z]", "[ ]{0,1}", number(), "[ ]{0,2}")
        .prop_map(|(letter, blank, number, behind)| format!("{letter}{blank}{number}{behind}"));
    let named = (
        prop_oneof![
            Just("A3="),
            Just("B3="),
            Just("CR="),
            Just("X="),
            Just("F=")
        ],
        number(),
    )
        .prop_map(|(name, number)| format!("{name}{number} "));
    let number = prop_oneof!["", "N[0-9]{1,6} ?", " "];
    let items = prop::collection::vec(prop_oneof![8 => word, 1 => named], 0..8);
    (number, items).prop_map(|(number, items)| number + &items.concat())
}

/// Conversational motions.
fn motions() -> impl Strategy<Value = String> {
    let word = (
        "I?[A-Z]",
        prop_oneof![4 => Just(""), 1 => Just(" ")],
        number(),
        "[ ]{1,2}",
    )
        .prop_map(|(letter, blank, number, behind)| format!("{letter}{blank}{number}{behind}"));
    let name = prop_oneof![
        Just("FMAX "),
        Just("R0 "),
        Just("RL "),
        Just("RR "),
        Just("DR+ "),
        Just("DR- "),
        Just("R+ "),
        Just("F MAX "),
        Just("TX+0.5 "),
        Just("NZ-0.25 "),
        Just("MB MAX "),
        Just("FQ1 "),
        Just("X+Q5 "),
        Just("DR-0.1 "),
        Just("r0 "),
    ];
    let keyword = prop_oneof![
        Just("L "),
        Just("LN "),
        Just("C "),
        Just("CC "),
        Just("CR "),
        Just(""),
        Just("CP ")
    ];
    let items = prop::collection::vec(
        prop_oneof![4 => word, 1 => name.prop_map(str::to_owned)],
        0..7,
    );
    ("[0-9]{0,5} ", keyword, items)
        .prop_map(|(number, keyword, items)| number + keyword + &items.concat())
}

proptest! {
    #![proptest_config(crate::cases())]

    #[test]
    fn words_and_numbers_as_parsed(line in words()) {
        assert_as_parsed(&line, &hash());
        assert_as_parsed(&line, &names());
    }

    #[test]
    fn conversational_motions_as_parsed(line in motions()) {
        assert_as_parsed(&line, &conversational());
    }

    #[test]
    fn nearly_plain_blocks_as_parsed(line in words(), at in 0..60_usize, odd in "[A-Z0-9=.+\\-#\\[\\](),;:/ \"_%~<>$*EX]{1,2}") {
        let at = at.min(line.len());
        let line = format!("{}{odd}{}", &line[..at], &line[at..]);
        // A line of `%` alone is no block.
        prop_assume!(line.trim() != "%");
        assert_as_parsed(&line, &hash());
        assert_as_parsed(&line, &names());
    }

    #[test]
    fn nearly_plain_motions_as_parsed(line in motions(), at in 0..60_usize, odd in "[A-Z0-9=.+\\-#\\[\\](),;:/ \"_<>$*]{1,2}") {
        let at = at.min(line.len());
        let line = format!("{}{odd}{}", &line[..at], &line[at..]);
        assert_as_parsed(&line, &conversational());
    }
}
