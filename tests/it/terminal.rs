//! Messages as the user sees them.

use post_cli::internals::plain;
use post_machine::diagnostic::{Diagnostic, SourcePlace};

#[test]
fn what_a_terminal_would_obey_is_written_as_an_escape() {
    let text = "PPRINT \u{1B}[31mred\u{202E} end";
    let place = SourcePlace::new("a\u{1B}b.cls", 3, text, 7..15);
    let finding = Diagnostic::error("x", "say \u{9B}1m\nit").help("\u{7}").at(Some(place));
    let shown = plain(&finding);
    assert!(!shown.contains(|letter: char| letter != '\n' && letter.is_control()));
    assert!(shown.contains("\\u{1b}[31mred"), "{shown}");
    // As many marks as the escaped text has letters.
    assert!(shown.contains(&"^".repeat("\\u{1b}[31mred".len() - 1)), "{shown}");
}
