//! Structural codes of ISO 10791.

use post_grammar::{Link, LinkKind, parse_chain};

fn axis(name: &str, primed: bool) -> LinkKind {
    LinkKind::Axis { name: name.to_owned(), primed }
}

fn kinds(text: &str) -> Vec<LinkKind> {
    let links = parse_chain(text).unwrap_or_else(|fault| panic!("{text}: {fault}"));
    links.into_iter().map(|link| link.kind).collect()
}

#[test]
fn a_table_table_machine() {
    let expected = vec![
        LinkKind::Workpiece,
        axis("C", true),
        axis("A", true),
        LinkKind::Bed,
        axis("Y", false),
        axis("X", false),
        axis("Z", false),
        LinkKind::Spindle { name: "S".to_owned() },
        LinkKind::Tool,
    ];
    for text in ["[w C' A' b Y X Z (S) t]", " [ w C’ A′ b Y X Z ( S )t ] ", "[wC'A'bYXZ(S)t]"] {
        assert_eq!(kinds(text), expected, "{text}");
    }
}

#[test]
fn other_machines() {
    assert_eq!(kinds("[w b t]"), [LinkKind::Workpiece, LinkKind::Bed, LinkKind::Tool]);
    assert_eq!(
        kinds("[w X2' b W C12 t]")[1..5],
        [axis("X2", true), LinkKind::Bed, axis("W", false), axis("C12", false)]
    );
}

#[test]
fn spans_point_into_the_text() {
    let text = "[w C' b X (S1) t]";
    let spans: Vec<&str> =
        parse_chain(text).unwrap().into_iter().map(|Link { span, .. }| &text[span]).collect();
    assert_eq!(spans, ["w", "C'", "b", "X", "(S1)", "t"]);
}

#[test]
fn faults_say_where_and_what() {
    for (text, at, marked, message) in [
        ("", 0, "", "a structural code begins with `[`"),
        ("w b X t]", 0, "w", "a structural code begins with `[`"),
        ("[w b X t", 8, "", "the closing `]` is missing"),
        ("[w b X t] Y", 10, "Y", "nothing may follow the `]`"),
        (
            "[w b x t]",
            5,
            "x",
            "`x` is not a member: axes are capitals, `w`, `b` and `t` are workpiece, bed and tool",
        ),
        ("[w b X, Y t]", 6, ",", "`,` is not a member"),
        ("[w b X ' t]", 7, "'", "a prime belongs directly behind the name of an axis"),
        ("[w b X (s) t]", 8, "s", "a spindle is one axis name in parentheses"),
        ("[w b X (S t]", 7, "(", "a spindle is one axis name in parentheses"),
        ("[w b 5 t]", 5, "5", "`5` is not a member"),
        ("[]", 1, "", "`w`, the workpiece, is missing"),
        ("[X b t]", 1, "", "`w`, the workpiece, is missing"),
        ("[w X t]", 6, "", "`b`, the bed, is missing"),
        ("[w b X]", 6, "", "`t`, the tool, is missing"),
        ("[X w b t]", 1, "X", "a structural code begins with `w`, the workpiece"),
        ("[w b t X]", 7, "X", "a structural code ends with `t`, the tool"),
        ("[w b X b t]", 7, "b", "`b`, the bed, stands here a second time"),
        ("[w b t t]", 7, "t", "`t`, the tool, stands here a second time"),
    ] {
        let fault = parse_chain(text).expect_err(text);
        let found = (fault.span.start, &text[fault.span.clone()], fault.message.as_str());
        assert_eq!(found, (at, marked, message), "{text}");
        assert!(fault.help.is_some());
    }
}
