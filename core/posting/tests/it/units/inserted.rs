use post_posting::internals::Inserted;

#[test]
fn a_code_is_told_from_a_remark() {
    for (text, held) in [
        ("M8", Inserted::Code),
        ("m08", Inserted::Code),
        ("G04 X2.", Inserted::Code),
        ("G0X10.Y-2.5", Inserted::Code),
        ("N10 G54 (FIXTURE TWO)", Inserted::Code),
        ("(FIRST) G55 ; SECOND", Inserted::Code),
        ("#100=5", Inserted::Code),
        ("R1=2", Inserted::Code),
        ("CALL LBL 1", Inserted::Code),
        ("call lbl 1 REP 3", Inserted::Code),
        ("CYCL DEF 7.0 DATUM SHIFT", Inserted::Code),
        ("LBL 0", Inserted::Code),
        ("L X+10 R0 FMAX", Inserted::Code),
        ("FN 0: Q1 = +5", Inserted::Code),
        ("TOOL CALL 5 Z S1000", Inserted::Code),
        ("TRAORI", Inserted::Code),
        ("GOTO 100", Inserted::Code),
        ("IF [#1 EQ 2] GOTO 10", Inserted::Code),
        ("IF#1 EQ 2", Inserted::Remark),
        ("CALL THE FOREMAN", Inserted::Remark),
        ("IF IT RATTLES STOP", Inserted::Remark),
        ("TOOL 5 IS LONG", Inserted::Remark),
        ("ROT X AXIS FREE", Inserted::Remark),
        ("M 5 SCREWS", Inserted::Remark),
        // Real ones of SolidWorks CAM.
        ("14MM CRB 4FL 32 LOC", Inserted::Remark),
        ("4.0mm JOBBER DRILL", Inserted::Remark),
        ("Stock Size X85. Y38. Z48.", Inserted::Remark),
        ("STOP  change fixture", Inserted::Remark),
        ("", Inserted::Remark),
        ("(M8)", Inserted::Remark),
        ("M8 TAP", Inserted::Mixed),
        ("M8 on for this", Inserted::Mixed),
        ("NOW G54", Inserted::Mixed),
        ("12 PLACES", Inserted::Remark),
        ("É 3", Inserted::Remark),
    ] {
        assert_eq!(Inserted::of(text), held, "{text}");
    }
}
