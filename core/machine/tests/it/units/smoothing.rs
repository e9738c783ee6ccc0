use post_machine::internals::fits;

#[test]
fn stars_stand_for_any_text() {
    for (pattern, text, whether) in [
        ("ROUGH", "ROUGH", true),
        ("ROUGH", "ROUGH_1", false),
        ("ROUGH*", "ROUGH_1", true),
        ("*FINISH", "PRE_FINISH", true),
        ("*FINISH", "FINISH_2", false),
        ("*", "", true),
        ("A*A", "A", false),
        ("A*A", "AA", true),
        ("A*B*C", "A1B2C", true),
        ("A*B*C", "A1C2C", false),
        ("*B*B*", "AB", false),
        ("**", "X", true),
    ] {
        assert_eq!(fits(pattern, text), whether, "{pattern} {text}");
    }
}
