//! The conformance kit finds what is wrong, and nothing where nothing is.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use post_host::{GivenValue, Plugin};
use post_kit::conformance::{self, Report, Verdict};
use post_plugin::Linked;

use crate::{boastful, sloppy};

/// A plugin that is part of the product.
fn stock(name: &str) -> Linked {
    post_stock::plugin(name).unwrap()
}

fn run(linked: Linked, options: &[(&str, GivenValue)]) -> Report {
    let options: Vec<(String, GivenValue)> =
        options.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    conformance::test(&Plugin::linked(linked).unwrap(), &options).unwrap()
}

fn faulty(fault: &str) -> Report {
    let fault = GivenValue::Text(fault.to_owned());
    run(post_faulty::plugin(), &[("fault", fault)])
}

#[test]
fn the_stock_plugins_are_good() {
    let number = GivenValue::Integer;
    let plain = post_stock::plugins().iter().map(|plugin| match plugin.name() {
        // GRBL 1.1 has three axes.
        "grbl" => run(*plugin, &[("hal", GivenValue::Flag(true))]),
        // Nothing is written in a unit that nobody has named.
        "okuma" => run(*plugin, &[("unit_system", GivenValue::Text("1 mm".to_owned()))]),
        "brother" => run(*plugin, &[("unit_system", GivenValue::Text("mm".to_owned()))]),
        _ => run(*plugin, &[]),
    });
    let with_options = [
        run(stock("harmonic"), &[("order", number(2))]),
        run(stock("harmonic"), &[("order", number(3))]),
        run(stock("harmonic"), &[("order", number(8)), ("samples", number(15))]),
        run(stock("sampled"), &[("accuracy", GivenValue::Number(1e-4))]),
        faulty("nothing"),
    ];
    for report in plain.chain(with_options) {
        assert!(report.is_good(), "{report}");
    }
}

#[test]
fn what_a_model_may_miss_is_said_and_not_held_against_it() {
    let verdict = |report: &Report, name: &str| {
        let case = report.cases.iter().find(|case| case.name == name).unwrap();
        case.verdict()
    };
    let parabolic = run(stock("parabolic"), &[]);
    assert_eq!(verdict(&parabolic, "two humps"), Verdict::Approximate);
    assert!(parabolic.table().contains(
        "two humps: it says 0.0000 µm for the tip, the deviation reaches 20.0000 µm at t = 0.25; the certificate \
         will overrule it"
    ));
    let sampled = run(stock("sampled"), &[]);
    assert_eq!(verdict(&sampled, "two humps"), Verdict::Good);

    let figures = |report: &Report, name: &str| {
        let case = report.cases.iter().find(|case| case.name == name).unwrap();
        case.figures.unwrap()
    };
    // Half a sine leaves 5.6 % of a parabola and the other way round; three places tell.
    let harmonic = run(stock("harmonic"), &[]);
    for figures in [figures(&harmonic, "parabola"), figures(&parabolic, "half a sine")] {
        assert_eq!(figures.asked, 3);
        assert!((figures.tip.left / figures.tip.actual - 0.056).abs() < 1e-4);
        assert!((figures.axis.left / figures.axis.actual - 0.056).abs() < 1e-4);
    }
    // Two half waves meet the two humps that one cannot see.
    let second = run(
        stock("harmonic"),
        &[("order", GivenValue::Integer(2)), ("samples", GivenValue::Integer(3))],
    );
    assert!(figures(&second, "two humps").tip.left < 1e-12);
}

/// A control that always keeps the tip is tried under TCP alone, and one that writes the tool's direction too.
#[test]
fn dialects_under_tcp_and_with_vectors_are_driven() {
    let report =
        run(sloppy::plugin(), &[("fault", GivenValue::Text("lives under TCP".to_owned()))]);
    assert!(report.is_good(), "{report}");
    let note = "all cases are under TCP, since it refuses to open without: ";
    assert!(report.table().contains(note), "{report}");
    assert!(!report.cases.iter().any(|case| case.name == "with TCP"), "{report}");
    let flag = GivenValue::Flag(true);
    for (name, option) in
        [("fanuc", "tool_vector"), ("siemens", "tool_vectors"), ("heidenhain", "tool_vectors")]
    {
        let report = run(stock(name), &[(option, flag.clone())]);
        assert!(report.is_good(), "{name}: {report}");
    }
}

#[test]
fn every_fault_is_found_where_it_is() {
    for (fault, sentences) in [
        (
            "content",
            &[
                "parabola: it says 0.0000 µm for the tip, the deviation reaches 20.0000 µm at t = 0.5: it is \
                 content with a plain bow over the tolerance of 5.0000 µm",
            ] as &[&str],
        ),
        (
            "understates",
            &[
                "parabola: its peak of the tip is 4.9500 µm, and its own curve reaches 20.0000 µm at t = 0.5",
                "content with a plain bow",
            ],
        ),
        (
            "shrinks",
            &[
                "half a sine: it says 16.0000 µm for the tip, the deviation reaches 20.0000 µm at t = 0.5: on a \
               plain bow it may be off by 1.0000 µm",
            ],
        ),
        (
            "misplaces",
            &[
                "parabola: its peak of the tool axis is to stand at t = 0, where its curve has 0.0000 °, not at \
               0.5, where it has 0.2000 °",
            ],
        ),
        ("flat", &["parabola: its curve leaves 9.9970 µm of a plain bow of 20.0000 µm in the tip"]),
        (
            "grows",
            &[
                "repeated: in round 1 its answer to `axis alone` is another than at first: tip peak 20.0000 µm instead of 0.0000 µm",
            ],
        ),
        (
            "remembers",
            &["repeated: after `none` the curve of `parabola` has other values than before"],
        ),
        ("flattens", &["turned: the curve of `parabola`, turned, is another one"]),
        (
            "offset",
            &[
                "none: it says 1.0000 µm for the tip, the deviation reaches 0.0000 µm",
                "scaled: the curve of `none`, scaled, is another one",
            ],
        ),
        ("outside", &["none: it asks for the deviation at t = 1.5, outside the move"]),
        ("timid", &["huge: no answer: error model `faulty`: that is too far"]),
        (
            "panics",
            &[
                "not a number: it does not refuse in words: error model `faulty`: the plugin panicked: the \
               deviation at 0 of the move is not a finite number",
            ],
        ),
        (
            "passes",
            &["infinite: it passes on what is no number: error model `faulty`: its peaks are NaN"],
        ),
    ] {
        let report = faulty(fault);
        let found: Vec<String> = report.wrong().collect();
        for sentence in sentences {
            assert!(
                found.iter().any(|found| found.contains(sentence)),
                "{fault}: {sentence}\n{report}"
            );
        }
    }
    let report = faulty("ignores");
    assert!(report.is_good());
    assert!(report.table().contains(
        "not a number: it answers with a tip peak of 0.0000 µm where every deviation is NaN; it should refuse"
    ));
}

/// What is declared is written with all of its numbers; sessions do not disturb one another.
#[test]
fn what_is_declared_and_not_done_is_found() {
    let boastful = |fault: &str| {
        let fault = GivenValue::Text(fault.to_owned());
        run(boastful::plugin(), &[("fault", fault)])
    };
    let good = boastful("");
    assert!(good.is_good(), "{good}");
    assert!(good.table().contains("two threads: 8192 events, "), "{good}");
    assert!(good.table().contains("vocabulary: 1 words"), "{good}");
    let mut missed = Vec::new();
    for (fault, sentence) in boastful::FAULTS {
        let report = boastful(fault);
        if !report.wrong().any(|found| found.contains(sentence)) {
            missed.push(format!("{fault}: {sentence}\n{report}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

/// What a certificate speaks of must be in the text: each of these dialects leaves some of it out.
#[test]
fn every_word_that_is_not_printed_is_found() {
    let sloppy = |fault: &str| {
        let fault = GivenValue::Text(fault.to_owned());
        run(sloppy::plugin(), &[("fault", fault)])
    };
    let good = sloppy("");
    assert!(good.is_good(), "{good}");
    let mut missed = Vec::new();
    for (fault, sentence) in sloppy::FAULTS {
        let report = sloppy(fault);
        if !report.wrong().any(|found| found.contains(sentence)) {
            missed.push(format!("{fault}: {sentence}\n{report}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn an_option_that_does_not_fit_is_refused() {
    let plugin = Plugin::linked(stock("harmonic")).unwrap();
    let options = [("order".to_owned(), GivenValue::Integer(9))];
    let fault = conformance::test(&plugin, &options).unwrap_err();
    assert!(fault.to_string().contains("9 is not between 1 and 8"));
}
