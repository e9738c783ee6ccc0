//! Text of a plugin as a message may show it.

/// Most letters of a plugin's sentence that a message repeats.
const LONGEST: usize = 1000;

/// Most letters of a line that a message quotes.
const LONGEST_LINE: usize = 200;

/// No line of a program holds such a letter: a control would read it as the end of a line, leave it out, or show the
/// line in another order than it is read (the marks of writing from right to left); nobody would see it.
pub(crate) fn is_odd(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{2028}' | '\u{2029}')
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
        || matches!(letter, '\u{ad}' | '\u{200b}'..='\u{200d}' | '\u{2060}'..='\u{2064}' | '\u{feff}')
}

/// A plugin's sentence on one line, cut where it is long.
pub(crate) fn sentence(text: &str) -> String {
    let text = text.trim();
    shown(text, LONGEST, |letter| matches!(letter, '\n' | '\r' | '\t'))
}

/// Letters of a program as they are, but for the odd ones, which are escaped; cut where they are many.
pub(crate) fn quoted(text: &str) -> String {
    shown(text, LONGEST_LINE, |_| false)
}

fn shown(text: &str, longest: usize, blank: impl Fn(char) -> bool) -> String {
    // All options of all plugins come by here.
    if text.len() <= longest && text.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
        return text.to_owned();
    }
    let mut shown = String::new();
    for (index, letter) in text.chars().enumerate() {
        if index == longest {
            shown.push('…');
            break;
        }
        match letter {
            _ if blank(letter) => shown.push(' '),
            '\n' | '\r' | '\t' => shown.extend(letter.escape_default()),
            _ if is_odd(letter) => shown.extend(letter.escape_unicode()),
            _ => shown.push(letter),
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_moves_a_cursor_is_left() {
        let hostile =
            "a\u{1b}[2Jb\rc\u{85}d\u{2028}e\u{202e}\u{61c}\u{200b}\u{feff}f\u{0}g\u{9b}h\n";
        for text in [sentence(hostile), quoted(hostile)] {
            assert!(!text.contains(is_odd), "{text}");
        }
        assert_eq!(quoted("G0\r X1\t\u{1b}"), "G0\\r X1\\t\\u{1b}");
        assert_eq!(sentence("  one\ntwo  "), "one two");
    }

    #[test]
    fn long_text_is_cut() {
        let long = "ä".repeat(1000);
        assert_eq!(quoted(&long).chars().count(), LONGEST_LINE + 1);
        assert_eq!(sentence(&"x".repeat(LONGEST)), "x".repeat(LONGEST));
    }
}
