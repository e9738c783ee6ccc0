//! Cycles and their depths.

use super::*;

/// A tap without the spindle in step strips the thread; a rapid to a level that nobody gave ends in the part.
#[test]
fn cycles_that_moves_cannot_make_are_errors() {
    for (cycle, findings) in [
        ("DRILL,FEDTO,-5,RAPTO,2,MMPM,50", ""),
        ("DRILL,FEDTO,-5,RAPTO,0,MMPM,50", ""),
        ("DRILL,DEEP,FEDTO,-5,RAPTO,2,STEP,1,MMPM,50", ""),
        ("DEEP,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("BRKCHP,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("DEEP,FEDTO,-5,RAPTO,2,STEP,0,MMPM,50", "error cycle"),
        // Creo's fixed form: the feed before its unit.
        ("DRILL,-5,100,MMPM,2", "error cycle"),
        ("TAP,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("RTAP,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("DRILL,TAP,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("MILL,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("FROB,FEDTO,-5,RAPTO,2,MMPM,50", "error cycle"),
        ("DRILL,FEDTO,-5,MMPM,50", "error cycle"),
        ("DRILL,FEDTO,-5,RAPTO,-2,MMPM,50", "error cycle"),
        ("DRILL,RAPTO,2,MMPM,50", "error cycle"),
        ("DEEP,FEDTO,-5,RAPTO,2,STEP,0.0001,MMPM,50", "error cycle"),
    ] {
        let run = run(&format!("CYCLE/{cycle};GOTO/0,0,0"));
        assert_eq!(run.findings(), findings, "{cycle}");
    }
    let text = "GOTO/10,0,0;CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPM,50;CIRCLE/0,0,0,0,0,1;GOTO/0,10,0";
    run(text).has_error("arc", text);
}

/// NX writes the depth below the point negative, others positive: upwards no hole is drilled, and a peck without its
/// step is one plunge.
#[test]
fn depths_of_either_sign_go_down() {
    const DRILLED: &str = "R 0,0,2; R 0,0,2; F50 0,0,-5; R 0,0,2";
    const PECKED: &str = "R 0,0,2; R 0,0,2; F50 0,0,-3; R 0,0,2; R 0,0,-2.5; F50 0,0,-5; R 0,0,2";
    table(&[
        ("CYCLE/DRILL,FEDTO,-5,RAPTO,2,MMPM,50;GOTO/0,0,0", DRILLED, ""),
        ("CYCLE/DRILL,FEDTO,5,RAPTO,2,MMPM,50;GOTO/0,0,0", DRILLED, ""),
        ("CYCLE/DRILL,5,IPM,2,2;GOTO/0,0,0", &DRILLED.replace("F50", "F50.8"), ""),
        ("CYCLE/DEEP,FEDTO,-5,STEP,3,RAPTO,2,MMPM,50;GOTO/0,0,0", PECKED, ""),
        ("CYCLE/DEEP,FEDTO,5,STEP,-3,RAPTO,2,MMPM,50;GOTO/0,0,0", PECKED, ""),
        (
            "CYCLE/DRILL,FEDTO,5,RAPTO,2,MMPM,50;GOTO/0,0,0,1,0,0",
            "R 2,0,0 @1,0,0; R 2,0,0 @1,0,0; F50 -5,0,0 @1,0,0; R 2,0,0 @1,0,0",
            "",
        ),
    ]);
}

/// The straight way from hole to hole goes through the step between them.
#[test]
fn between_holes_up_comes_before_aside_and_aside_before_down() {
    table(&[(
        "CYCLE/DRILL,FEDTO,-10,RAPTO,2,RTRCTO,5,MMPM,50;GOTO/0,0,0;GOTO/10,0,8;GOTO/20,0,-8",
        "R 0,0,5; R 0,0,2; F50 0,0,-10; R 0,0,5; \
         R 0,0,13; R 10,0,13; R 10,0,10; F50 10,0,-2; R 10,0,13; \
         R 20,0,13; R 20,0,-3; R 20,0,-6; F50 20,0,-18; R 20,0,-3",
        "",
    )]);
}

/// With a cycle on, the tool stands above its hole: what steps from there, or goes home, must not drill at that height.
#[test]
fn a_step_or_a_home_position_with_a_cycle_on_drills_no_wrong_hole() {
    const CYCLE: &str = "CYCLE/DRILL,FEDTO,-10,RAPTO,2,RTRCTO,5,MMPM,50;GOTO/0,0,0";
    let wrong: Vec<String> = [("GODLTA/10,0,0", -10.0), ("GOHOME/50,50,50", 50.0)]
        .into_iter()
        .filter_map(|(word, lowest)| {
            let run = run(&format!("{CYCLE};{word}"));
            let refused = run.findings().contains("error");
            let moves = run.moves();
            let heights = moves[4..].iter().map(|motion| motion.tip.z);
            let reached = heights.fold(f64::INFINITY, f64::min);
            let right = refused || reached == lowest;
            (!right).then(|| format!("{word}: down to {reached}, not {lowest}: {}", run.steps()))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}
