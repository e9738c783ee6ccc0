//! Arcs, rapids, feeds and units.

use super::*;

/// A wrong sense takes the tool the other way round: through the wall that the arc was to go along.
#[test]
fn arcs_go_the_way_that_their_form_says() {
    const NX: &str = "CIRCLE/0,0,0,0,0,1,10,0.06,0.5,10,0";
    const NX_DOWN: &str = "CIRCLE/0,0,0,0,0,-1,10,0.06,0.5,10,0";
    const CREO: &str = "CIRCLE/0,0,0,0,0,1,10";
    const CREO_DOWN: &str = "CIRCLE/0,0,0,0,0,-1,10";
    const SHORT: &str = "CIRCLE/0,0,0,0,0,1";
    // Quarters of a turn from X+, counter-clockwise about Z.
    for (circle, words, end, quarters) in [
        (NX, "", "0,10,0", -3.0),
        (NX, "", "0,-10,0", -1.0),
        (NX, "", "10,0,0", -4.0),
        (NX, ",TIMES,2", "0,-10,0", -5.0),
        (NX_DOWN, "", "0,10,0", 1.0),
        (NX_DOWN, "", "0,-10,0", 3.0),
        (CREO, "", "0,10,0", 1.0),
        (CREO, "", "0,-10,0", 3.0),
        (CREO, ",CLW", "0,10,0", -3.0),
        (CREO, ",CLOCKWISE", "0,-10,0", -1.0),
        (CREO, ",CCLW", "0,10,0", 1.0),
        (CREO_DOWN, "", "0,10,0", -3.0),
        (CREO_DOWN, "", "0,-10,0", -1.0),
        (CREO_DOWN, ",CLW", "0,10,0", 1.0),
        (SHORT, "", "0,10,0", 1.0),
        (SHORT, "", "0,-10,0", 3.0),
        (SHORT, "", "10,0,0", 4.0),
        (SHORT, ",CLW", "0,-10,0", -1.0),
        (SHORT, ",TIMES,1", "0,10,0", 1.0),
        (SHORT, ",TIMES,2", "0,10,0", 5.0),
        (SHORT, ",TIMES,2", "10,0,0", 8.0),
        (SHORT, ",CLW,TIMES,3", "0,-10,0", -9.0),
    ] {
        let text = format!("GOTO/10,0,0;{circle}{words};GOTO/{end}");
        let run = run(&text);
        assert_eq!(run.findings(), "", "{text}");
        let moves = run.moves();
        let sense = f64::signum(quarters);
        let mut sweep = 0.0;
        for pair in moves.windows(2) {
            let (from, to) = (pair[0].tip, pair[1].tip);
            let angle = libm::atan2(from.cross(&to).z, from.dot(&to));
            assert!(angle * sense > 0.0, "{text}: a chord goes back");
            assert!((to.norm() - 10.0).abs() < 1e-9, "{text}: off the arc");
            let stray = 10.0 - (0.5 * (from + to)).norm();
            assert!(
                stray <= pair[1].chord && pair[1].chord <= 0.01,
                "{text}: strays by {stray}, says {}",
                pair[1].chord
            );
            sweep += angle;
        }
        assert!(
            (sweep - quarters * FRAC_PI_2).abs() < 1e-9,
            "{text}: {} quarters",
            sweep / FRAC_PI_2
        );
        assert_eq!(vector(moves.last().unwrap().tip), end, "{text}");
    }
}

/// A rapid that stays in force goes through the material; one that is lost costs minutes at a creep.
#[test]
fn rapid_is_for_one_move_and_as_a_feed_until_the_next_feed() {
    table(&[
        ("RAPID;GOTO/1,0,0;GOTO/2,0,0", "R 1,0,0; F100 2,0,0", ""),
        ("RAPID;FEDRAT/50;GOTO/1,0,0;GOTO/2,0,0", "R 1,0,0; F50 2,0,0", ""),
        ("RAPID;GOHOME;GOTO/1,0,0", "home; F100 1,0,0", ""),
        ("GOHOME/5,5,5;GOTO/1,0,0", "R 5,5,5; F100 1,0,0", ""),
        ("RAPID;GOHOME/5,5,5;GOTO/1,0,0", "R 5,5,5; F100 1,0,0", ""),
        (
            "FEDRAT/RAPID;GOTO/1,0,0;GOTO/2,0,0;FEDRAT/50;GOTO/3,0,0",
            "R 1,0,0; R 2,0,0; F50 3,0,0",
            "",
        ),
        ("FEDRAT/RAPID;RAPID;GOTO/1,0,0;FEDRAT/50;GOTO/2,0,0", "R 1,0,0; F50 2,0,0", ""),
        (
            "CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPM,50;RAPID;GOTO/0,0,0;CYCLE/OFF;GOTO/1,0,0",
            "R 0,0,2; R 0,0,2; F50 0,0,-1; R 0,0,2; F100 1,0,0",
            "warning cycle",
        ),
    ]);
    let text = "UNITS/MM;GOTO/1,0,0;GOTO/2,0,0";
    let run = Run::of(ReadingOptions::default(), text);
    assert_eq!((run.steps().as_str(), run.findings().as_str()), ("R 1,0,0", "error no-feed"));
}

/// A feed in the wrong unit is 25.4 times or a thousand times too fast: the cutter breaks.
#[test]
fn feeds_of_every_unit() {
    const TURNING: &str = "SPINDL/RPM,1000,CLW";
    for (units, text, pace) in [
        ("MM", "FEDRAT/10", "F10 1,0,0"),
        ("MM", "FEDRAT/MMPM,10", "F10 1,0,0"),
        ("MM", "FEDRAT/10,MMPM", "F10 1,0,0"),
        ("MM", "FEDRAT/IPM,10", "F254 1,0,0"),
        ("MM", "FEDRAT/PERMIN,10", "F10 1,0,0"),
        ("MM", "FEDRAT/10,FPM", "F10 1,0,0"),
        ("INCH", "FEDRAT/10", "F254 25.4,0,0"),
        ("INCH", "FEDRAT/PERMIN,10", "F254 25.4,0,0"),
        ("INCH", "FEDRAT/IPM,10", "F254 25.4,0,0"),
        ("INCH", "FEDRAT/MMPM,10", "F10 25.4,0,0"),
        ("CM", "FEDRAT/PERMIN,10", "F100 10,0,0"),
        ("MM", "FEDRAT/MMPR,0.1", "F100 1,0,0"),
        ("MM", "FEDRAT/0.1,PERREV", "F100 1,0,0"),
        ("MM", "FEDRAT/0.1,FPR", "F100 1,0,0"),
        ("MM", "FEDRAT/IPR,0.01", "F254 1,0,0"),
        ("INCH", "FEDRAT/0.01,PERREV", "F254 25.4,0,0"),
        ("INCH", "FEDRAT/IPR,0.01", "F254 25.4,0,0"),
        ("INCH", "FEDRAT/MMPR,0.1", "F100 25.4,0,0"),
        ("MM", "FEDRAT/INVERS,4", "V4 1,0,0"),
        ("INCH", "FEDRAT/4,INVERSE", "V4 25.4,0,0"),
        ("MM", "FEDRAT/4,FRN", "V4 1,0,0"),
        ("MM", "FEDRAT/RAPID", "R 1,0,0"),
    ] {
        let text = format!("UNITS/{units};{TURNING};{text};GOTO/1,0,0");
        let run = Run::of(ReadingOptions::default(), &text);
        assert_eq!(run.steps(), format!("S1000; {pace}"), "{text}");
        assert_eq!(run.findings(), "", "{text}");
    }
    for text in ["FEDRAT/0", "FEDRAT/-5", "FEDRAT/MMPR,0.1;GOTO/1,0,0"] {
        run(text).has_error("feed", text);
    }
}

/// NX writes the feed before the speed: at the old speed of the spindle the tooth takes ten times its chip.
#[test]
fn a_feed_per_revolution_goes_with_the_speed_at_the_move() {
    table(&[
        (
            "FEDRAT/MMPR,0.1;SPINDL/RPM,1000;GOTO/1,0,0;SPINDL/RPM,200;GOTO/2,0,0",
            "S1000; F100 1,0,0; S200; F20 2,0,0",
            "",
        ),
        ("CUTTER/10;FEDRAT/MMPR,0.1;SPINDL/SMM,31.4159265;GOTO/1,0,0", "S1000; F100 1,0,0", ""),
        (
            "CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPR,0.1;SPINDL/RPM,500;GOTO/0,0,0",
            "S500; R 0,0,2; R 0,0,2; F50 0,0,-1; R 0,0,2",
            "",
        ),
    ]);
}

/// An inverse-time feed given to each chord would take the arc as many times too slowly.
#[test]
fn an_inverse_time_feed_is_the_time_of_the_whole_arc() {
    let run = run("GOTO/10,0,0;FEDRAT/INVERS,4;CIRCLE/0,0,0,0,0,1,10;GOTO/0,10,0;GOTO/0,20,0");
    assert_eq!(run.findings(), "");
    let moves = run.moves();
    let chords = moves.len() - 2;
    assert!(chords > 5, "{chords}");
    for motion in &moves[1..=chords] {
        assert_eq!(motion.pace, MoveFeed::InverseTime(4.0 * chords as f64));
    }
    assert_eq!(moves[chords + 1].pace, MoveFeed::InverseTime(4.0));
}

/// A file that lies about its units: lengths and feeds must be put right together, or the feed is off by 25.4.
#[test]
fn overridden_units_take_the_declared_feed_words_with_them() {
    let cases = [
        (Units::Millimetre, "UNITS/INCH;FEDRAT/IPM,10", "F10 1,0,0"),
        (Units::Millimetre, "UNITS/INCH;FEDRAT/10", "F10 1,0,0"),
        (Units::Millimetre, "UNITS/INCH;FEDRAT/MMPM,10", "F10 1,0,0"),
        (Units::Millimetre, "UNITS/MM;FEDRAT/IPM,10", "F254 1,0,0"),
        (Units::Millimetre, "FEDRAT/IPM,10", "F254 1,0,0"),
        (Units::Inch, "UNITS/MM;FEDRAT/MMPM,10", "F254 25.4,0,0"),
        (Units::Inch, "UNITS/MM;FEDRAT/10", "F254 25.4,0,0"),
        (Units::Inch, "UNITS/INCH;FEDRAT/IPM,10", "F254 25.4,0,0"),
        (Units::Inch, "FEDRAT/MMPM,10", "F10 25.4,0,0"),
    ];
    for (units, text, steps) in cases {
        let reading = ReadingOptions { units: Some(units), ..ReadingOptions::default() };
        let run = Run::of(reading, &format!("{text};GOTO/1,0,0"));
        assert_eq!(run.steps(), steps, "{units:?} {text}");
        assert_eq!(run.findings(), "", "{units:?} {text}");
    }
}

/// Half a file in mm and half in inches: the second half is cut 25.4 times too large, or too small.
#[test]
fn units_come_before_what_is_read_in_them() {
    let told = |units| ReadingOptions { units, ..ReadingOptions::default() };
    for (units, text, findings) in [
        (None, "UNITS/INCH;GOTO/1,0,0", ""),
        (None, "UNITS/INCH;FROM/0,0,0;RAPID;GOTO/1,0,0;UNITS/INCH", ""),
        (None, "GOTO/1,0,0;UNITS/MM", ""),
        (None, "GOTO/1,0,0;UNITS/INCH", "error units"),
        (None, "FROM/1,0,0;UNITS/INCH", "error units"),
        (None, "FEDRAT/10;UNITS/INCH;GOTO/1,0,0", "error units"),
        (None, "UNITS/INCH;GOTO/1,0,0;UNITS/MM", "error units"),
        (None, "GOTO/1,0,0", "warning units"),
        (Some(Units::Inch), "GOTO/1,0,0;UNITS/MM", ""),
        (Some(Units::Inch), "GOTO/1,0,0", ""),
    ] {
        let run = Run::of(told(units), text);
        assert_eq!(run.findings(), findings, "{units:?} {text}");
    }
}

/// A change of units behind a tool change or a home position is a change of units all the same, and so is one behind
/// a length that was kept.
#[test]
fn units_after_numbers_are_refused_whatever_stands_between() {
    let accepted: Vec<&str> = [
        "GOTO/1,0,0;LOADTL/2;UNITS/INCH;GOTO/1,0,0",
        "GOTO/1,0,0;GOHOME;UNITS/INCH;GOTO/1,0,0",
        "CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPM,50;UNITS/INCH;GOTO/1,0,0",
        "LOADTL/1,LENGTH,100;UNITS/INCH;GOTO/1,0,0",
    ]
    .into_iter()
    .filter(|text| Run::of(ReadingOptions::default(), text).findings() != "error units")
    .collect();
    assert!(accepted.is_empty(), "no error: {accepted:#?}");
}
