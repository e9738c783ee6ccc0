use post_grammar::{Statement, parse_record};

#[test]
fn arcs_are_taken_apart_and_nothing_is_guessed() {
    let round = "TLON,GOFWD/ (CIRCLE/ 1,2,3,$$ x";
    assert!(parse_record(round).is_err());
    for (line, known) in [
        ("TLON,GOFWD/ (CIRCLE/ 1,2,3, 10),ON,(LINE/ 1,2,3, 11,2,3)", true),
        ("tlon , gofwd / (circle/ 1,2,3, 10),on,(line/ 1,2,3, 11,2,3) $$ end", true),
        (
            "TLON,GOFWD/ (CYLNDR/ 0,0,0, 0,1,0, 5),ON,(PLANE/PERPTO,(PLANE/(POINT/0,0,0),PERPTO,(VECTOR/0,1,0)),(POINT/0,0,0),(POINT/5,0,0))",
            true,
        ),
        ("TLON,GOFWD/ (CIRCLE/ 1,2,3, 10),ON,2,INTOF,(LINE/ 1,2,3, 11,2,3)", false),
        ("TLON,GOLFT/ (CIRCLE/ 1,2,3, 10),ON,(LINE/ 1,2,3, 11,2,3)", false),
        ("TLON,GOFWD/ C1,ON,L1", false),
        ("TLLFT,GOLFT/ L1,PAST,L2", false),
    ] {
        let read = parse_record(line).unwrap();
        assert_eq!(matches!(read, Statement::AlongArc(_)), known, "{line}: {read:?}");
    }
    for line in [
        "TLON,GOFWD/ (CIRCLE/ 1,2,3, 10),ON,(LINE/ 0,2,3, 11,2,3)",
        "TLON,GOFWD/ (CIRCLE/ 1,2,3, 10),ON,(LINE/ 1,2,3, 11,2,3",
        "TLON,GOFWD/",
    ] {
        assert!(parse_record(line).is_err(), "{line}");
    }
}
