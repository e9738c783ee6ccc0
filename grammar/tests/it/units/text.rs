use std::borrow::Cow;

use post_grammar::text::{as_remark, escaped, excerpt, is_unprintable};

#[test]
fn what_ends_a_line_or_hides_text_is_unprintable() {
    for character in "\n\r\t\u{0}\u{B}\u{C}\u{1B}\u{7F}\u{85}\u{9B}\u{2028}\u{2029}\u{202E}\u{2066}\u{200B}\u{FEFF}".chars() {
        assert!(is_unprintable(character), "{character:?}");
    }
    for character in " ~äß°中…\u{FFFD}\u{A0}".chars() {
        assert!(!is_unprintable(character), "{character:?}");
    }
}

#[test]
fn escapes_keep_what_they_are_told_to_keep() {
    assert_eq!(escaped("a\tb\u{1B}[31m\n", &['\t']), "a\tb\\u{1b}[31m\\u{a}");
    assert!(matches!(escaped("°", &[]), Cow::Borrowed("°")));
    assert_eq!(as_remark("a\u{2028}M30\u{1B}".to_owned()), "a M30 ");
}

#[test]
fn excerpts_end_between_characters() {
    assert_eq!(excerpt("äöü", 3), "ä…");
    assert_eq!(excerpt("äöü", 6), "äöü");
}
