//! Lines that are no blocks of the engine's: remarks, and what the user writes letter for letter.

use post_plugin::{ascii, wrapped};

use crate::table::Table;

/// Characters that a remark may have around its text: parentheses, and what keeps the control from acting on it.
const AROUND: usize = 4;

/// What stands in front of the program's name in its line, at most: `O1234 `.
const TITLE: usize = 6;

/// A text as remarks of this control, each short enough.
pub(crate) fn remark_lines(table: &Table, text: &str) -> Vec<String> {
    let whole = (table.remark)(text);
    if whole.len() <= table.remark_length {
        return vec![whole];
    }
    let pieces = wrapped(&ascii(text), table.remark_length - AROUND);
    pieces.iter().map(|piece| (table.remark)(piece)).collect()
}

/// The program's name, cut so that the line with it is short enough.
pub(crate) fn program_name(table: &Table, name: &str) -> String {
    let plain = ascii(name);
    match plain.get(..table.remark_length - AROUND - TITLE) {
        Some(cut) => cut.trim_end().to_owned(),
        None => name.to_owned(),
    }
}

/// A line of the user's own is no longer than the control reads.
///
/// # Errors
/// The sentence that refuses it.
pub(crate) fn fits(table: &Table, line: &str) -> Result<(), String> {
    // A block number and its blank.
    const NUMBER: usize = 10;
    match table.line_length {
        Some(most) if line.len() + NUMBER > most => Err(format!(
            "the line has {} characters, and this control reads {most} with the block number: part it",
            line.len()
        )),
        _ => Ok(()),
    }
}

/// Is the line a block, which may have a number? Remarks, marks of the program and blocks that may be skipped are not;
/// neither is one that has its number.
pub(crate) fn takes_number(line: &str) -> bool {
    let mut letters = line.trim_start().bytes();
    match letters.next() {
        None | Some(b'(' | b';' | b'%' | b':' | b'/') => false,
        Some(b'N' | b'n' | b'O' | b'o') => {
            !letters.next().is_some_and(|next| next.is_ascii_digit() || next == b'<')
        }
        Some(_) => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_take_numbers_and_other_lines_do_not() {
        for line in ["M77", " G0 X1", "#100=1", "NEXT", "$AA=1"] {
            assert!(takes_number(line), "{line}");
        }
        for line in
            ["", "(M77)", "; M77", "%", "/M77", "N10 M77", "O100 CALL", "O<pocket> CALL", ":1"]
        {
            assert!(!takes_number(line), "{line}");
        }
    }

    #[test]
    fn a_remark_is_as_many_lines_as_it_needs() {
        let short = "short  (as it is)";
        assert_eq!(remark_lines(&Table::ISO, short), ["(SHORT  [AS IT IS])"]);
        let long = "Größe ".repeat(100);
        let lines = remark_lines(&Table::ISO, &long);
        assert!(lines.len() > 5);
        for line in &lines {
            assert!(line.len() <= 80 && line.starts_with("(GROESSE") && line.ends_with("E)"));
        }
        let found: usize = lines.iter().map(|line| line.matches("GROESSE").count()).sum();
        assert_eq!(found, 100);
    }
}
