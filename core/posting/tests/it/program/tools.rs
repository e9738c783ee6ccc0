//! Tools, registers and cutter compensation.

use super::*;

/// Without a length the tool is driven into the table; a second change to the same tool costs a minute, but another
/// register is another length.
#[test]
fn tools_and_registers() {
    table(&[
        ("LOADTL/0;GOTO/1,0,0", "F100 1,0,0", "error tool"),
        ("LOAD/TOOL,0", "", "error tool"),
        ("LOADTL/3,ADJUST,0", "", "error tool"),
        ("LOADTL/3,OSETNO,0", "", "error tool"),
        // CATIA writes a register behind the number, others pockets: nothing of it goes without a word.
        ("LOADTL/3,5;GOTO/1,0,0", "T3/3; F100 1,0,0", "warning tool"),
        ("LOADTL/3,IN,4;GOTO/1,0,0", "T3/3; F100 1,0,0", "warning tool"),
        (
            "LOADTL/3;GOTO/1,0,0;LOADTL/3;GOTO/2,0,0;LOADTL/3,ADJUST,3",
            "T3/3; F100 1,0,0; F100 2,0,0",
            "",
        ),
        (
            "LOADTL/3;GOTO/1,0,0;LOADTL/3,ADJUST,7;GOTO/2,0,0;LOADTL/3",
            "T3/3; F100 1,0,0; T3/7; F100 2,0,0; T3/3",
            "",
        ),
    ]);
}

/// The spindle switched on before the tool change is stopped by it, and cuts standing still.
#[test]
fn the_told_tool_is_loaded_before_anything_that_needs_it() {
    for (text, steps) in [
        ("SPINDL/RPM,1000;GOTO/1,2,3", "T5/5; S1000; F100 1,2,3"),
        ("COOLNT/MIST;GOTO/1,2,3", "T5/5; Coolant(Mist); F100 1,2,3"),
        (
            "SPINDL/RPM,1000;COOLNT/ON;GOTO/1,2,3;GOTO/2,2,3",
            "T5/5; S1000; Coolant(Flood); F100 1,2,3; F100 2,2,3",
        ),
        ("GOTO/1,2,3", "T5/5; F100 1,2,3"),
        ("LOADTL/5;SPINDL/RPM,1000;GOTO/1,2,3", "T5/5; S1000; F100 1,2,3"),
    ] {
        assert_eq!(with_tool(text), (steps.to_owned(), String::new()), "{text}");
    }
    let (_, findings) = with_tool("LOADTL/3;GOTO/1,2,3;LOADTL/4;GOTO/2,2,3");
    assert_eq!(findings, "error tool");
}

/// Compensation that the tool change switches off again leaves the contour oversize by the radius.
#[test]
fn the_told_tool_is_loaded_before_compensation() {
    let (steps, findings) = with_tool("CUTCOM/LEFT;GOTO/1,0,0;GOTO/2,0,0");
    assert_eq!(steps, "T5/5; G41 5; F100 1,0,0; F100 2,0,0");
    assert_eq!(findings, "");
}

/// Steps and findings with tool 5 told.
fn with_tool(text: &str) -> (String, String) {
    let reading = ReadingOptions { tool: Some(5), ..ReadingOptions::default() };
    let run = Run::of(reading, &format!("UNITS/MM;FEDRAT/100;{text}"));
    (run.steps(), run.findings())
}

/// Compensation left on over a tool change moves the approach of the next tool sideways.
#[test]
fn a_tool_change_ends_compensation() {
    table(&[
        (
            "LOADTL/1;CUTCOM/LEFT;GOTO/1,0,0;LOADTL/2;GOTO/2,0,0",
            "T1/1; G41 1; F100 1,0,0; G40; T2/2; F100 2,0,0",
            "warning compensation",
        ),
        (
            "LOADTL/1;CUTCOM/RIGHT,8;GOTO/1,0,0;CUTCOM/OFF;LOADTL/2;GOTO/2,0,0",
            "T1/1; G42 8; F100 1,0,0; G40; T2/2; F100 2,0,0",
            "",
        ),
        (
            "LOADTL/1;CUTCOM/LEFT;GOTO/1,0,0;LOADTL/1;GOTO/2,0,0",
            "T1/1; G41 1; F100 1,0,0; F100 2,0,0",
            "",
        ),
    ]);
}

/// The radius of the tool before is that of another tool: the contour is off by the difference.
#[test]
fn the_register_of_compensation_does_not_outlive_its_tool() {
    table(&[(
        "LOADTL/1;CUTCOM/LEFT,11;GOTO/1,0,0;CUTCOM/OFF;LOADTL/2;CUTCOM/LEFT;GOTO/2,0,0",
        "T1/1; G41 11; F100 1,0,0; G40; T2/2; G41 2; F100 2,0,0",
        "",
    )]);
}

/// Points of the tool's centre and the radius in the register: the part would be off by the radius.
#[test]
fn compensation_on_the_tools_centre_is_wear_or_refused() {
    use post_machine::description::CompensationOnCentre::{Contour, Refuse, Wear};
    let centre = "$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER";
    let remark = "REMARK -> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER";
    let contour = "$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE";
    let cut = "CUTCOM/LEFT,7;GOTO/1,0,0;CUTCOM/OFF;GOTO/2,0,0;CUTCOM/RIGHT,7;GOTO/3,0,0";
    for (before, on_centre, findings) in [
        (centre, Refuse, "error compensation"),
        (remark, Refuse, "error compensation"),
        (centre, Wear, "warning compensation"),
        (contour, Refuse, ""),
        (centre, Contour, "error compensation"),
        ("$$ centerline data", Refuse, "error compensation"),
        ("$$ centerline data", Wear, "warning compensation"),
        ("$$ centerline data", Contour, "error compensation"),
        // SolidWorks CAM does not say.
        ("MOVE_ATTRIB/LEADIN", Refuse, "error compensation"),
        ("MOVE_ATTRIB/LEADIN", Wear, "warning compensation"),
        ("MOVE_ATTRIB/LEADIN", Contour, ""),
    ] {
        let reading =
            ReadingOptions { compensation_on_centre: on_centre, ..ReadingOptions::default() };
        let text = format!("UNITS/MM;FEDRAT/100;LOADTL/1;{before};{cut}");
        let run = Run::of(reading.clone(), &text);
        assert_eq!(run.findings(), findings, "{before}");
        assert_eq!(run.steps(), "T1/1; G41 7; F100 1,0,0; G40; F100 2,0,0; G42 7; F100 3,0,0");
        // It says whose register, and names the option.
        if let [told] = run.findings.as_slice() {
            let text = format!("{}; {}", told.message, told.help.clone().unwrap_or_default());
            assert!(text.contains("register 7"), "{text}");
            let names_it = text.contains("compensation_on_centre = \"wear\"");
            assert_eq!(names_it, on_centre != Wear, "{text}");
            assert_eq!(told.place.as_ref().map(|place| place.line), Some(5));
        }
        // Without CUTCOM nobody cares, and the next operation may say otherwise.
        let text = format!("UNITS/MM;FEDRAT/100;{before};GOTO/1,0,0;{contour};{cut}");
        assert_eq!(Run::of(reading, &text).findings(), "", "{before}");
    }
}

/// Another cutter described and none loaded: the path of a small tool is cut with a large one.
#[test]
fn a_second_cutter_without_a_tool_change_is_refused() {
    for (text, findings) in [
        ("CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;GOTO/2,0,0", "error cutter"),
        (
            "CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;GOTO/2,0,0;GOTO/3,0,0;CUTTER/4;GOTO/4,0,0",
            "error cutter; error cutter",
        ),
        // The same diameter, and a ball.
        ("CUTTER/10,0;GOTO/1,0,0;CUTTER/10,5;GOTO/2,0,0", "error cutter"),
        ("CUTTER/10;GOTO/1,0,0;TLDATA/MILL,6,0;GOTO/2,0,0", "error cutter"),
        ("CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/10;GOTO/2,0,0", ""),
        ("CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;LOADTL/2;GOTO/2,0,0", ""),
        ("CUTTER/10;LOADTL/1;GOTO/1,0,0;LOADTL/2;CUTTER/6;GOTO/2,0,0", ""),
        ("LOADTL/1;CUTTER/10;CUTTER/6;GOTO/2,0,0", ""),
    ] {
        assert_eq!(run(text).findings(), findings, "{text}");
    }
}
