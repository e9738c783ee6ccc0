use post_machine::diagnostic::nearest;

const DIALECTS: [&str; 3] = ["fanuc", "heidenhain", "linuxcnc"];

#[test]
fn a_slip_finds_its_name() {
    for (word, name) in [
        ("fanuk", "fanuc"),
        ("Fanuc", "fanuc"),
        ("FANUC", "fanuc"),
        ("faunc", "fanuc"),
        ("heidenhein", "heidenhain"),
        ("haidenhein", "heidenhain"),
        ("linux-cnc", "linuxcnc"),
        // The beginning of one name alone.
        ("heid", "heidenhain"),
    ] {
        assert_eq!(nearest(word, DIALECTS), Some(name), "{word}");
    }
    assert_eq!(nearest("ac_trunion", ["ac-trunnion"]), Some("ac-trunnion"));
}

#[test]
fn another_word_finds_nothing() {
    for word in ["", "siemens", "x", "fnc3k", "cnc"] {
        assert_eq!(nearest(word, DIALECTS), None, "{word}");
    }
    // The beginning of several.
    assert_eq!(nearest("coolant", ["coolant_through", "coolant_air"]), None);
    let endless = "a".repeat(1_000_000);
    assert_eq!(nearest(&endless, [endless.as_str()]), None);
}

#[test]
fn the_nearest_wins_and_among_equals_the_first() {
    assert_eq!(nearest("tcp_of", ["tcp_on", "tcp_off"]), Some("tcp_on"));
    assert_eq!(nearest("tcp_oof", ["tcp_on", "tcp_off"]), Some("tcp_off"));
    assert_eq!(nearest("dmu60", ["dmu50", "dmu65"]), Some("dmu50"));
}
