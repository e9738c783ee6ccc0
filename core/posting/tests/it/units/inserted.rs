use post_posting::internals::InsertContent;

#[test]
fn a_code_is_told_from_a_remark() {
    for (text, held) in [
        ("M8", InsertContent::Code),
        ("m08", InsertContent::Code),
        ("G04 X2.", InsertContent::Code),
        ("G0X10.Y-2.5", InsertContent::Code),
        ("N10 G54 (FIXTURE TWO)", InsertContent::Code),
        ("(FIRST) G55 ; SECOND", InsertContent::Code),
        ("#100=5", InsertContent::Code),
        ("R1=2", InsertContent::Code),
        ("CALL LBL 1", InsertContent::Code),
        ("call lbl 1 REP 3", InsertContent::Code),
        ("CYCL DEF 7.0 DATUM SHIFT", InsertContent::Code),
        ("LBL 0", InsertContent::Code),
        ("L X+10 R0 FMAX", InsertContent::Code),
        ("FN 0: Q1 = +5", InsertContent::Code),
        ("TOOL CALL 5 Z S1000", InsertContent::Code),
        ("TRAORI", InsertContent::Code),
        ("GOTO 100", InsertContent::Code),
        ("IF [#1 EQ 2] GOTO 10", InsertContent::Code),
        ("IF#1 EQ 2", InsertContent::Remark),
        ("CALL THE FOREMAN", InsertContent::Remark),
        ("IF IT RATTLES STOP", InsertContent::Remark),
        ("TOOL 5 IS LONG", InsertContent::Remark),
        ("ROT X AXIS FREE", InsertContent::Remark),
        ("M 5 SCREWS", InsertContent::Remark),
        // Real ones of SolidWorks CAM.
        ("14MM CRB 4FL 32 LOC", InsertContent::Remark),
        ("4.0mm JOBBER DRILL", InsertContent::Remark),
        ("Stock Size X85. Y38. Z48.", InsertContent::Remark),
        ("STOP  change fixture", InsertContent::Remark),
        ("", InsertContent::Remark),
        ("(M8)", InsertContent::Remark),
        ("M8 TAP", InsertContent::Mixed),
        ("M8 on for this", InsertContent::Mixed),
        ("NOW G54", InsertContent::Mixed),
        ("12 PLACES", InsertContent::Remark),
        ("É 3", InsertContent::Remark),
    ] {
        assert_eq!(InsertContent::of(text), held, "{text}");
    }
}
