//! Texts of a program in a CL file.

/// A text behind `PPRINT`: one line.
pub(super) fn free(text: &str) -> String {
    let clean = |letter: char| if letter.is_control() { ' ' } else { letter };
    text.trim().chars().map(clean).collect()
}

/// A name between commas: what parts a record is left out of it.
pub(super) fn name(text: &str) -> String {
    let clean = |letter: char| match letter {
        ',' | '/' | '$' | '=' => '_',
        letter if letter.is_control() => '_',
        letter => letter,
    };
    text.trim().chars().map(clean).collect()
}
