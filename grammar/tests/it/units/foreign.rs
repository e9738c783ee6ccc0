use post_grammar::internals::kind;

#[test]
fn programs_are_told_from_cl_files() {
    for (head, expected) in [
        ("%\nO0001 (PART)\nN10 G21 G90\nN20 T1 M6\nN30 G0 X1. Y2.\n", Some("an NC program")),
        ("0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S1000\n2 L X+10 R0 FMAX\n", Some("an NC program")),
        ("N10 G54\nN20 G0 X0\nN30 M30\n", Some("an NC program")),
        (
            "1050\n0 0 8. 25. 1 2024\n1053\n(MACHINE)\n1011\n0. 0. 0.\n1016\n1 2 3\n",
            Some("Mastercam's NCI"),
        ),
        ("PARTNO x\nGOTO/1,2,3\nN10 G0 X1\nN20 G1 X2\nN30 M30\n", None),
        ("$$ CLF\nRAPID\n", None),
        ("RAPID\nSTOP\n", None),
        ("", None),
        ("M3\nUNITS/MM\nM4\nM5\nM6", None),
    ] {
        assert_eq!(kind(head.as_bytes()), expected, "{head}");
    }
}
