//! Words that move the tool, and words that are not known.

use super::*;

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
        assert!(run.findings[0].message.contains(word.split('/').next().unwrap()));
        assert_eq!(run.findings[0].place.as_ref().unwrap().line, 3, "{word}");
    }
}

/// A word that is known, in a form that is not: dropped without a sign, the part is not turned, the coolant is off.
#[test]
fn known_words_in_unknown_forms_are_reported() {
    let silent: Vec<&str> =
        ["ROTABL/FROB,90", "COOLNT/SUPER", "TLAXIS/FROB", "LOAD/FROB,3", "CUTCOM/FROB"]
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
        (UnknownWordPolicy::Error, "F100 1,0,0", "error unknown-word"),
        (UnknownWordPolicy::Known, "F100 1,0,0", "error unknown-word"),
        (UnknownWordPolicy::Warn, "F100 1,0,0", "warning unknown-word"),
        (UnknownWordPolicy::Pass, "# FROBN/1,UP; F100 1,0,0; # FROBN/2", "warning unknown-word"),
    ];
    for (unknown, steps, findings) in cases {
        let reading = || ReadingOptions { unknown, ..ReadingOptions::default() };
        let run = Run::of(reading(), TEXT);
        assert_eq!(run.steps(), steps, "{unknown:?}");
        assert_eq!(run.findings(), findings, "{unknown:?}");
        let told = &run.findings[0];
        assert!(told.message.contains("FROBN") && told.message.contains("twice"));
        assert_eq!(told.place.as_ref().unwrap().line, 3, "{unknown:?}");
        // A directive is meant for another program.
        let run = Run::of(reading(), "UNITS/MM;$$-> FROBN / 1;PAINT/PATH;GOTO/1,0,0");
        assert_eq!((run.steps().as_str(), run.findings().as_str()), ("R 1,0,0", ""));
    }
}
