//! Text from files: what of it may stand in a program or on a terminal, and how much of it is shown.

use std::borrow::Cow;
use std::fmt::Write as _;

/// A character that no line of a program and no message holds as it is: controls (a line feed, ESC), the further line
/// ends of Unicode (NEL, U+2028, U+2029), and invisible characters that turn or hide the text around it (marks of the
/// writing direction, characters without a width).
pub fn is_unprintable(character: char) -> bool {
    character.is_control()
        || matches!(
            character,
            '\u{61C}'
                | '\u{180E}'
                | '\u{200B}'..='\u{200F}'
                | '\u{2028}'..='\u{202E}'
                | '\u{2060}'..='\u{206F}'
                | '\u{FEFF}'
                | '\u{FFF9}'..='\u{FFFB}'
        )
}

/// `text` with each [unprintable](is_unprintable) character but those of `kept` written as `\u{1b}`.
pub fn escaped<'t>(text: &'t str, kept: &[char]) -> Cow<'t, str> {
    let odd = |character: char| is_unprintable(character) && !kept.contains(&character);
    if !text.contains(odd) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if odd(character) {
            // Writing to a String cannot fail.
            let _ = write!(plain, "\\u{{{:x}}}", u32::from(character));
        } else {
            plain.push(character);
        }
    }
    Cow::Owned(plain)
}

/// `text` with a blank for each [unprintable](is_unprintable) character: a remark, which is read and not carried out.
pub fn as_remark(text: String) -> String {
    if !text.contains(is_unprintable) {
        return text;
    }
    text.replace(is_unprintable, " ")
}

/// `text`, or its first `most` bytes with `…` after them, cut between characters.
pub fn excerpt(text: &str, most: usize) -> Cow<'_, str> {
    if text.len() <= most {
        return Cow::Borrowed(text);
    }
    let mut end = most;
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    Cow::Owned(format!("{}…", &text[..end]))
}
