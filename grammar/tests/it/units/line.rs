use post_grammar::internals::is_free_text;
use post_grammar::parse_record;

#[test]
fn the_reader_and_the_grammar_agree_on_what_is_free_text() {
    for (line, free) in [
        ("PARTNO", true),
        (" pprint", true),
        ("INSERT.", true),
        ("REMARK -", true),
        ("REMARK ->FEATNO/", false),
        ("remark->FEATNO/", false),
        ("OPFEATSTART/", true),
        ("OPFEATEND/", true),
        ("TOOL PATH/", true),
        ("TOOL/", false),
        ("\t$$", true),
        ("$$ -> FEATNO/", false),
        ("PARTNOX/", false),
        ("RAPID", false),
        ("NOSUCH/", false),
    ] {
        assert_eq!(is_free_text(line.as_bytes()), free, "{line}");
        // In a free text, a comment is text.
        let statement = parse_record(&format!("{line} $$ x")).unwrap();
        assert_eq!(format!("{statement:?}").contains("$$ x"), free, "{line}: {statement:?}");
    }
}
