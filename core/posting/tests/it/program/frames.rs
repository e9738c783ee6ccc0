//! Index moves, frames, and the point that the next move starts from.

use super::*;

/// After a tool change or a bare GOHOME nobody knows where the tip stands: an arc or a step from where it once stood
/// ends anywhere.
#[test]
fn nothing_starts_from_a_point_that_was_left() {
    const ARC: &str = "CIRCLE/0,0,0,0,0,1;GOTO/0,10,0";
    for (before, left) in [("", ""), ("LOADTL/2", "T2/2"), ("GOHOME", "home")] {
        let (text, steps) = match left {
            "" => (String::new(), String::new()),
            _ => (format!("LOADTL/1;GOTO/10,0,0;{before};"), format!("T1/1; F100 10,0,0; {left}")),
        };
        for (word, code) in
            [("GODLTA/1,0,0", "error godlta"), ("GODLTA/5", "error godlta"), (ARC, "error arc")]
        {
            let text = format!("{text}{word}");
            let run = run(&text);
            assert_eq!(run.findings(), code, "{text}");
            assert_eq!(run.steps(), steps, "{text}");
        }
    }
    table(&[
        ("LOADTL/1;GOTO/10,0,0;LOADTL/1;GODLTA/1,2,3", "T1/1; F100 10,0,0; F100 11,2,3", ""),
        ("LOADTL/1;FROM/1,1,1;GODLTA/5", "T1/1; from 1,1,1; F100 1,1,6", ""),
        ("GOHOME/5,5,5;GODLTA/1,0,0", "R 5,5,5; F100 6,5,5", ""),
    ]);
}

/// Points in the turned frame, taken for points of the part, are cut on the wrong side of it.
#[test]
fn index_moves_turn_points_and_axes() {
    const GOTO: &str = "GOTO/1,2,3";
    const A: &str = "ROTABL/1.570796,AAXIS,TABLE,CCLW";
    const A_STEPS: &str = "F100 1,-3,2 @0,-1,0";
    table(&[
        (&format!("{A};{GOTO}"), A_STEPS, ""),
        // CAMWorks states the angle anew: it is no step.
        (&format!("{A};{A};{GOTO}"), A_STEPS, ""),
        (&format!("ROTABL/AAXIS,90;{GOTO}"), A_STEPS, ""),
        (&format!("ROTABL/AAXIS,INCR,45;ROTABL/AAXIS,INCR,45;{GOTO}"), A_STEPS, ""),
        (&format!("ROTABL/1.570796,AAXIS,TABLE,CLW;{GOTO}"), "F100 1,3,-2 @0,1,0", ""),
        (&format!("ROTABL/1.570796,BAXIS,TABLE,CCLW;{GOTO}"), "F100 3,2,-1 @1,0,0", ""),
        (&format!("{A};GOTO/1,2,3,1,0,0"), "F100 1,-3,2 @1,0,0", ""),
        (&format!("{A};GOTO/1,2,3,0,1,0"), "F100 1,-3,2", ""),
        (
            &format!("{A};{GOTO};ROTABL/0,AAXIS,TABLE,CCLW;{GOTO}"),
            "F100 1,-3,2 @0,-1,0; F100 1,2,3",
            "",
        ),
        // A before B, as the chain of the table has them.
        (&format!("{A};ROTABL/1.570796,BAXIS,TABLE,CCLW;{GOTO}"), "F100 3,1,2 @1,0,0", ""),
        (&format!("TLAXIS/0,-1,0;{A};{GOTO}"), A_STEPS, ""),
        (&format!("{A};TLAXIS/0,-2,0;{GOTO}"), A_STEPS, ""),
        (
            &format!("TLAXIS/0,1,0;{A};{GOTO};{GOTO}"),
            &format!("{A_STEPS}; {A_STEPS}"),
            "error rotabl",
        ),
        (
            &format!("ROTABL/AAXIS,80;TLAXIS/0,-1,0;{GOTO}"),
            "F100 1,-2.607,2.491 @0,-0.985,0.174",
            "error rotabl",
        ),
        (&format!("ROTABL/ATANGL,90;{GOTO}"), "F100 1,2,3", "error rotabl"),
        ("TLAXIS/0,-1,0;GOTO/1,2,3", "F100 1,2,3 @0,-1,0", ""),
    ]);
}

/// After an index move the last point has other numbers: a step or an arc from its old ones starts in the air or in
/// the part.
#[test]
fn nothing_starts_from_a_point_of_another_index() {
    const INDEX: &str = "GOTO/10,0,20;ROTABL/1.570796,AAXIS,TABLE,CCLW";
    for (word, code) in [("GODLTA/1,0,0", "godlta"), ("CIRCLE/0,0,20,0,0,1;GOTO/0,10,20", "arc")] {
        let text = format!("{INDEX};{word}");
        run(&text).has_error(code, &text);
    }
}

/// The lift between holes starts at the old hole's numbers: in the turned frame that is a place in the part.
#[test]
fn no_lift_between_holes_of_two_indexes() {
    // The tool stood at 10,0,2 of the part, and the turned part's 10,0,… is another place.
    let run = run("CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPM,50;GOTO/10,0,0;\
         ROTABL/1.570796,AAXIS,TABLE,CCLW;GOTO/0,0,30");
    assert_eq!(
        run.steps(),
        "R 10,0,2; R 10,0,2; F50 10,0,-1; R 10,0,2; \
         R 0,-32,0 @0,-1,0; R 0,-32,0 @0,-1,0; F50 0,-29,0 @0,-1,0; R 0,-32,0 @0,-1,0"
    );
}

/// A frame applied to points alone, or its origin in the wrong unit, shifts the whole operation.
#[test]
fn msys_takes_points_and_axes_when_told_to() {
    const MSYS: &str = "MSYS/10,20,30,0,1,0,-1,0,0";
    for (apply, text, steps, findings) in [
        (false, "UNITS/MM", "R 11,22,33 @1,0,0", ""),
        (true, "UNITS/MM", "R 2,-1,3 @0,-1,0", ""),
        (true, "UNITS/INCH", "R 50.8,-25.4,76.2 @0,-1,0", ""),
    ] {
        let reading = ReadingOptions { apply_msys: apply, ..ReadingOptions::default() };
        let run = Run::of(reading, &format!("{text};{MSYS};GOTO/11,22,33,1,0,0"));
        assert_eq!(run.steps(), steps, "{apply} {text}");
        assert_eq!(run.findings(), findings, "{apply} {text}");
    }
    let text = "MSYS/0,0,0,1,0,0,1,0,0";
    run(text).has_error("msys", text);
}

/// An axis that is lost tilts the tool back through the wall; one kept over the operation's end tilts the next.
#[test]
fn the_axis_stays_until_something_resets_it() {
    const TILTED: &str = "MULTAX/ON;GOTO/0,0,0,3,0,4";
    const AT: &str = "F100 0,0,0 @0.6,0,0.8";
    for (word, steps) in [
        ("GOTO/1,1,1", "F100 1,1,1 @0.6,0,0.8"),
        ("MULTAX/ON;GOTO/1,1,1", "F100 1,1,1 @0.6,0,0.8"),
        ("MULTAX/OFF;GOTO/1,1,1", "F100 1,1,1"),
        ("TOOL PATH/WALL,TOOL,MILL;GOTO/1,1,1", "# WALL; F100 1,1,1"),
        ("GODLTA/5", "F100 3,0,4 @0.6,0,0.8"),
    ] {
        let run = run(&format!("{TILTED};{word}"));
        assert_eq!(run.steps(), format!("{AT}; {steps}"), "{word}");
        assert_eq!(run.findings(), "", "{word}");
    }
    run("GOTO/1,1,1,0,0,0").has_error("axis", "null axis");
}
