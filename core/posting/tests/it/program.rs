//! What CL texts mean: each is read from its characters to the steps and findings that come of it.
//!
//! Texts are written in one line, `;` for the line end; steps as [`Run`] prints them. A row is text, steps, findings.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;
use post_grammar::{Reader, Units};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::{Compensation, Spindle};
use post_posting::Flow;
use post_posting::expand::{Line, expanded};
use post_posting::program::{Command, Interpreter, Motion, Pace, Reading, Unknown};

/// What comes of a text.
struct Run {
    /// Curves and cycles as moves.
    steps: Vec<Flow<Line>>,
    findings: Vec<Diagnostic>,
}

impl Run {
    fn of(reading: Reading, text: &str) -> Self {
        let reading = Reading {
            chord_tolerance: 0.01,
            ..reading
        };
        let text = text.replace(';', "\n");
        let mut reader = Reader::new(text.as_bytes());
        let mut interpreter = Interpreter::new(reading.clone());
        let mut steps = Vec::new();
        while let Some(record) = reader.next_record().unwrap() {
            interpreter.record(&record, &mut |step| steps.push((record.line, step)));
        }
        interpreter.finish();
        let mut findings = interpreter.take_findings();
        let (steps, faults) = expanded(steps, reading.chord_tolerance);
        findings.extend(faults);
        Self { steps, findings }
    }

    fn moves(&self) -> Vec<Motion> {
        let motion = |step: &Flow<Line>| match step {
            Flow::Point(line) => Some(line.motion),
            Flow::Command { .. } => None,
        };
        self.steps.iter().filter_map(motion).collect()
    }

    /// `R 1,2,3`, `F100 1,2,3`, `V4 1,2,3` (inverse time), with `@i,j,k` where the axis is not Z; `T5/7` is tool and
    /// register, `G41 7` compensation and register, `# text` a comment.
    /// Index moves apart: the points that follow are turned.
    fn steps(&self) -> String {
        let steps: Vec<String> = self
            .steps
            .iter()
            .filter(|step| {
                !matches!(
                    step,
                    Flow::Command {
                        command: Command::Index { .. },
                        ..
                    }
                )
            })
            .map(step)
            .collect();
        steps.join("; ")
    }

    /// `error code`, `warning code`.
    fn findings(&self) -> String {
        let found: Vec<String> = self.findings.iter().map(finding).collect();
        found.join("; ")
    }

    #[track_caller]
    fn has_error(&self, code: &str, text: &str) {
        let named = |found: &&Diagnostic| found.code == code;
        assert!(
            self.findings
                .iter()
                .filter(named)
                .any(|found| found.severity == Severity::Error),
            "no error {code:?} in {text:?}: {} / {}",
            self.steps(),
            self.findings()
        );
    }
}

fn finding(finding: &Diagnostic) -> String {
    let severity = match finding.severity {
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    format!("{severity} {}", finding.code)
}

fn number(value: f64) -> String {
    // Plus zero: no minus before a zero.
    ((value * 1000.0).round() / 1000.0 + 0.0).to_string()
}

fn vector(vector: Vector3<f64>) -> String {
    let [x, y, z] = [vector.x, vector.y, vector.z].map(number);
    format!("{x},{y},{z}")
}

fn placed(tip: Vector3<f64>, axis: Vector3<f64>) -> String {
    if (axis - Vector3::z()).norm() < 1e-9 {
        return vector(tip);
    }
    format!("{} @{}", vector(tip), vector(axis))
}

fn step(step: &Flow<Line>) -> String {
    let command = match step {
        Flow::Point(line) => {
            let motion = &line.motion;
            let pace = match motion.pace {
                Pace::Rapid => "R".to_owned(),
                Pace::PerMinute(feed) => format!("F{}", number(feed)),
                Pace::InverseTime(feed) => format!("V{}", number(feed)),
            };
            return format!("{pace} {}", placed(motion.tip, motion.axis));
        }
        Flow::Command { command, .. } => command,
    };
    match command {
        Command::From { tip, axis } => format!("from {}", placed(*tip, *axis)),
        Command::Tool(tool) => format!("T{}/{}", tool.number, tool.register),
        Command::Spindle(Spindle::On { rpm, .. }) => format!("S{}", number(*rpm)),
        Command::Compensate(Compensation::Off) => "G40".to_owned(),
        Command::Compensate(Compensation::Left { register }) => format!("G41 {register}"),
        Command::Compensate(Compensation::Right { register }) => format!("G42 {register}"),
        Command::Comment(text) => format!("# {text}"),
        Command::Home => "home".to_owned(),
        other => format!("{other:?}"),
    }
}

/// Reads mm at 100 mm/min, unless the text says otherwise.
fn run(text: &str) -> Run {
    Run::of(Reading::default(), &format!("UNITS/MM;FEDRAT/100;{text}"))
}

/// Rows of text, steps and findings, read as by [`run`].
#[track_caller]
fn table(rows: &[(&str, &str, &str)]) {
    for (text, steps, findings) in rows {
        let run = run(text);
        assert_eq!(run.steps(), *steps, "steps of {text:?}");
        assert_eq!(run.findings(), *findings, "findings of {text:?}");
    }
}

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
        (
            "RAPID;FEDRAT/50;GOTO/1,0,0;GOTO/2,0,0",
            "R 1,0,0; F50 2,0,0",
            "",
        ),
        ("RAPID;GOHOME;GOTO/1,0,0", "home; F100 1,0,0", ""),
        ("GOHOME/5,5,5;GOTO/1,0,0", "R 5,5,5; F100 1,0,0", ""),
        ("RAPID;GOHOME/5,5,5;GOTO/1,0,0", "R 5,5,5; F100 1,0,0", ""),
        (
            "FEDRAT/RAPID;GOTO/1,0,0;GOTO/2,0,0;FEDRAT/50;GOTO/3,0,0",
            "R 1,0,0; R 2,0,0; F50 3,0,0",
            "",
        ),
        (
            "FEDRAT/RAPID;RAPID;GOTO/1,0,0;FEDRAT/50;GOTO/2,0,0",
            "R 1,0,0; F50 2,0,0",
            "",
        ),
        (
            "CYCLE/DRILL,FEDTO,-1,RAPTO,2,MMPM,50;RAPID;GOTO/0,0,0;CYCLE/OFF;GOTO/1,0,0",
            "R 0,0,2; R 0,0,2; F50 0,0,-1; R 0,0,2; F100 1,0,0",
            "",
        ),
    ]);
    let text = "UNITS/MM;GOTO/1,0,0;GOTO/2,0,0";
    let run = Run::of(Reading::default(), text);
    assert_eq!(
        (run.steps().as_str(), run.findings().as_str()),
        ("R 1,0,0", "error no-feed")
    );
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
        let run = Run::of(Reading::default(), &text);
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
        (
            "CUTTER/10;FEDRAT/MMPR,0.1;SPINDL/SMM,31.4159265;GOTO/1,0,0",
            "S1000; F100 1,0,0",
            "",
        ),
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
        assert_eq!(motion.pace, Pace::InverseTime(4.0 * chords as f64));
    }
    assert_eq!(moves[chords + 1].pace, Pace::InverseTime(4.0));
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
        let reading = Reading {
            units: Some(units),
            ..Reading::default()
        };
        let run = Run::of(reading, &format!("{text};GOTO/1,0,0"));
        assert_eq!(run.steps(), steps, "{units:?} {text}");
        assert_eq!(run.findings(), "", "{units:?} {text}");
    }
}

/// Half a file in mm and half in inches: the second half is cut 25.4 times too large, or too small.
#[test]
fn units_come_before_what_is_read_in_them() {
    let told = |units| Reading {
        units,
        ..Reading::default()
    };
    for (units, text, findings) in [
        (None, "UNITS/INCH;GOTO/1,0,0", ""),
        (
            None,
            "UNITS/INCH;FROM/0,0,0;RAPID;GOTO/1,0,0;UNITS/INCH",
            "",
        ),
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
    .filter(|text| Run::of(Reading::default(), text).findings() != "error units")
    .collect();
    assert!(accepted.is_empty(), "no error: {accepted:#?}");
}

/// A tap without the spindle in step strips the thread; a rapid to a level that nobody gave ends in the part.
#[test]
fn cycles_that_moves_cannot_make_are_errors() {
    for (cycle, findings) in [
        ("DRILL,FEDTO,-5,RAPTO,2,MMPM,50", ""),
        ("DRILL,FEDTO,-5,RAPTO,0,MMPM,50", ""),
        ("DRILL,DEEP,FEDTO,-5,RAPTO,2,STEP,1,MMPM,50", ""),
        ("DEEP,FEDTO,-5,RAPTO,2,MMPM,50", "warning cycle"),
        ("BRKCHP,FEDTO,-5,RAPTO,2,MMPM,50", "warning cycle"),
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
        (
            "CYCLE/DRILL,FEDTO,-5,RAPTO,2,MMPM,50;GOTO/0,0,0",
            DRILLED,
            "",
        ),
        (
            "CYCLE/DRILL,FEDTO,5,RAPTO,2,MMPM,50;GOTO/0,0,0",
            DRILLED,
            "",
        ),
        (
            "CYCLE/DRILL,5,IPM,2,2;GOTO/0,0,0",
            &DRILLED.replace("F50", "F50.8"),
            "",
        ),
        (
            "CYCLE/DEEP,FEDTO,-5,STEP,3,RAPTO,2,MMPM,50;GOTO/0,0,0",
            PECKED,
            "",
        ),
        (
            "CYCLE/DEEP,FEDTO,5,STEP,-3,RAPTO,2,MMPM,50;GOTO/0,0,0",
            PECKED,
            "",
        ),
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

/// Without a length the tool is driven into the table; a second change to the same tool costs a minute, but another
/// register is another length.
#[test]
fn tools_and_registers() {
    table(&[
        ("LOADTL/0;GOTO/1,0,0", "F100 1,0,0", "error tool"),
        ("LOAD/TOOL,0", "", "error tool"),
        ("LOADTL/3,ADJUST,0", "", "error tool"),
        ("LOADTL/3,OSETNO,0", "", "error tool"),
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
        (
            "LOADTL/3;SPINDL/RPM,1000;GOTO/1,2,3",
            "T3/3; S1000; F100 1,2,3",
        ),
    ] {
        assert_eq!(with_tool(text), (steps.to_owned(), String::new()), "{text}");
    }
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
    let reading = Reading {
        tool: Some(5),
        ..Reading::default()
    };
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

/// Another cutter described and none loaded: the path of a small tool is cut with a large one.
#[test]
fn a_second_cutter_without_a_tool_change_is_told_once() {
    for (text, findings) in [
        (
            "CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;GOTO/2,0,0",
            "warning cutter",
        ),
        (
            "CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;GOTO/2,0,0;GOTO/3,0,0;CUTTER/4;GOTO/4,0,0",
            "warning cutter",
        ),
        (
            "CUTTER/10;GOTO/1,0,0;TLDATA/MILL,6,0;GOTO/2,0,0",
            "warning cutter",
        ),
        ("CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/10;GOTO/2,0,0", ""),
        (
            "CUTTER/10;LOADTL/1;GOTO/1,0,0;CUTTER/6;LOADTL/2;GOTO/2,0,0",
            "",
        ),
        (
            "CUTTER/10;LOADTL/1;GOTO/1,0,0;LOADTL/2;CUTTER/6;GOTO/2,0,0",
            "",
        ),
        ("LOADTL/1;CUTTER/10;CUTTER/6;GOTO/2,0,0", ""),
    ] {
        assert_eq!(run(text).findings(), findings, "{text}");
    }
}

/// After a tool change or a bare GOHOME nobody knows where the tip stands: an arc or a step from where it once stood
/// ends anywhere.
#[test]
fn nothing_starts_from_a_point_that_was_left() {
    const ARC: &str = "CIRCLE/0,0,0,0,0,1;GOTO/0,10,0";
    for (before, left) in [("", ""), ("LOADTL/2", "T2/2"), ("GOHOME", "home")] {
        let (text, steps) = match left {
            "" => (String::new(), String::new()),
            _ => (
                format!("LOADTL/1;GOTO/10,0,0;{before};"),
                format!("T1/1; F100 10,0,0; {left}"),
            ),
        };
        for (word, code) in [
            ("GODLTA/1,0,0", "error godlta"),
            ("GODLTA/5", "error godlta"),
            (ARC, "error arc"),
        ] {
            let text = format!("{text}{word}");
            let run = run(&text);
            assert_eq!(run.findings(), code, "{text}");
            assert_eq!(run.steps(), steps, "{text}");
        }
    }
    table(&[
        (
            "LOADTL/1;GOTO/10,0,0;LOADTL/1;GODLTA/1,2,3",
            "T1/1; F100 10,0,0; F100 11,2,3",
            "",
        ),
        (
            "LOADTL/1;FROM/1,1,1;GODLTA/5",
            "T1/1; from 1,1,1; F100 1,1,6",
            "",
        ),
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
        (
            &format!("ROTABL/AAXIS,INCR,45;ROTABL/AAXIS,INCR,45;{GOTO}"),
            A_STEPS,
            "",
        ),
        (
            &format!("ROTABL/1.570796,AAXIS,TABLE,CLW;{GOTO}"),
            "F100 1,3,-2 @0,1,0",
            "",
        ),
        (
            &format!("ROTABL/1.570796,BAXIS,TABLE,CCLW;{GOTO}"),
            "F100 3,2,-1 @1,0,0",
            "",
        ),
        (&format!("{A};GOTO/1,2,3,1,0,0"), "F100 1,-3,2 @1,0,0", ""),
        (&format!("{A};GOTO/1,2,3,0,1,0"), "F100 1,-3,2", ""),
        (
            &format!("{A};{GOTO};ROTABL/0,AAXIS,TABLE,CCLW;{GOTO}"),
            "F100 1,-3,2 @0,-1,0; F100 1,2,3",
            "",
        ),
        // A before B, as the chain of the table has them.
        (
            &format!("{A};ROTABL/1.570796,BAXIS,TABLE,CCLW;{GOTO}"),
            "F100 3,1,2 @1,0,0",
            "",
        ),
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
        (
            &format!("ROTABL/ATANGL,90;{GOTO}"),
            "F100 1,2,3",
            "error rotabl",
        ),
        ("TLAXIS/0,-1,0;GOTO/1,2,3", "F100 1,2,3 @0,-1,0", ""),
    ]);
}

/// After an index move the last point has other numbers: a step or an arc from its old ones starts in the air or in
/// the part.
#[test]
fn nothing_starts_from_a_point_of_another_index() {
    const INDEX: &str = "GOTO/10,0,20;ROTABL/1.570796,AAXIS,TABLE,CCLW";
    for (word, code) in [
        ("GODLTA/1,0,0", "godlta"),
        ("CIRCLE/0,0,20,0,0,1;GOTO/0,10,20", "arc"),
    ] {
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
        let reading = Reading {
            apply_msys: apply,
            ..Reading::default()
        };
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

/// A copy or a transformation that is left out leaves holes undrilled, or drills them elsewhere.
#[test]
fn words_that_move_the_tool_are_refused() {
    for word in [
        "TRACUT/LAST",
        "COPY/1,2",
        "TRANS/1,2,3",
        "ORIGIN/1,2,3",
        "INDEX/1",
        "MACRO/1",
        "CALL/M1",
        "HEAD/1,2",
        "PIVOTZ/10",
        "COUPLE/1",
        "GOFWD/1",
        "CLEARP/10",
        "RETRCT",
        "POSTN/1",
        "PLUNGE/1",
        "THREAD/1",
    ] {
        let run = run(&format!("{word};GOTO/1,0,0"));
        assert_eq!(run.findings(), "error refused-word", "{word}");
        assert!(
            run.findings[0]
                .message
                .contains(word.split('/').next().unwrap())
        );
        assert_eq!(run.findings[0].place.as_ref().unwrap().line, 3, "{word}");
    }
}

/// A word that is known, in a form that is not: dropped without a sign, the part is not turned, the coolant is off.
#[test]
fn known_words_in_unknown_forms_are_reported() {
    let silent: Vec<&str> = [
        "ROTABL/FROB,90",
        "COOLNT/SUPER",
        "TLAXIS/FROB",
        "LOAD/FROB,3",
        "CUTCOM/FROB",
    ]
    .into_iter()
    .filter(|text| run(text).findings.is_empty())
    .collect();
    assert!(silent.is_empty(), "nothing is said about {silent:?}");
}

/// A word that nobody knows may be the one that matters: it must not vanish.
#[test]
fn unknown_words_go_by_the_policy() {
    const TEXT: &str = "UNITS/MM;FEDRAT/100;FROBN/1,UP;GOTO/1,0,0;FROBN/2";
    let cases = [
        (Unknown::Error, "F100 1,0,0", "error unknown-word"),
        (Unknown::Warn, "F100 1,0,0", "warning unknown-word"),
        (
            Unknown::Pass,
            "# FROBN/1,UP; F100 1,0,0; # FROBN/2",
            "warning unknown-word",
        ),
    ];
    for (unknown, steps, findings) in cases {
        let reading = || Reading {
            unknown,
            ..Reading::default()
        };
        let run = Run::of(reading(), TEXT);
        assert_eq!(run.steps(), steps, "{unknown:?}");
        assert_eq!(run.findings(), findings, "{unknown:?}");
        let told = &run.findings[0];
        assert!(told.message.contains("FROBN") && told.message.contains("twice"));
        assert_eq!(told.place.as_ref().unwrap().line, 3, "{unknown:?}");
        // A directive is meant for another program.
        let run = Run::of(reading(), "UNITS/MM;$$-> FROBN / 1;PAINT/PATH;GOTO/1,0,0");
        assert_eq!(
            (run.steps().as_str(), run.findings().as_str()),
            ("R 1,0,0", "")
        );
    }
}
