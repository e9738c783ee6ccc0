//! Whole programs under review: every machine with every sample that it can make.
//!
//! After a change of the output, read each new snapshot as the machine's operator would, then accept it:
//! `cargo insta review`, or `INSTA_UPDATE=always cargo test --test it snapshots`.

use crate::{common, dialects, generate};

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

use common::{CASES, Case, check_numbers, post, root, sample};
use serde_json::Value;

#[test]
fn the_programs_are_those_that_were_reviewed() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("tests/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for case in CASES {
            let (run, summary) = case.post(&[]);
            check_numbers(&run.out);
            insta::assert_snapshot!(case.name(), format!("{}{}", head(case, &summary), run.out));
        }
    });
}

/// How it was made, and what the summary says of it.
fn head(case: &Case, summary: &Value) -> String {
    let deviation = |key: &str| {
        let deviation = &summary[key];
        format!(
            "{:.5} in line {}, CL line {}",
            deviation["value"].as_f64().unwrap(),
            deviation["block"],
            deviation["line"]
        )
    };
    let mut head =
        format!("post --machine {} {} {}\n", case.machine, case.sample, case.with.join(" "));
    writeln!(
        head,
        "{} records, {} moves, {} blocks, {} points added; tip {}; axis {}; rapid {}; {:.1} s",
        summary["records"],
        summary["moves"],
        summary["blocks"],
        summary["points_added"],
        deviation("tip_deviation_mm"),
        deviation("axis_deviation_deg"),
        deviation("rapid_deviation_mm"),
        summary["time_s"].as_f64().unwrap()
    )
    .unwrap();
    for warning in summary["warnings"].as_array().unwrap() {
        writeln!(head, "warning: {}", warning.as_str().unwrap()).unwrap();
    }
    head.push('\n');
    head
}

#[test]
fn no_snapshot_is_left_over() {
    let names: BTreeSet<String> = CASES.iter().map(Case::name).collect();
    assert_eq!(names.len(), CASES.len(), "two cases of one name");
    let found: BTreeSet<String> = fs::read_dir(root().join("tests/snapshots"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|name| name.strip_suffix(".snap").map(str::to_owned))
        .collect();
    assert_eq!(found, names);
}

#[test]
fn every_sample_is_posted() {
    let listed: BTreeSet<String> = fs::read_dir(root().join("tests/samples"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let samples = CASES.iter().map(|case| case.sample);
    let samples = samples.chain(dialects::samples()).map(str::to_owned);
    assert_eq!(samples.collect::<BTreeSet<_>>(), listed);
}

#[test]
fn what_three_axes_cannot_make_is_refused() {
    for name in ["blade.cls", "facets.apt", "knife.ncl"] {
        let path = sample(name);
        let run = post(&["-m", "vmc", "-o", "-", path.to_str().unwrap()]);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{name}");
        assert!(run.err.contains("error[out-of-reach]"), "{}", run.err);
    }
}

#[test]
fn the_blade_is_what_the_generator_writes() {
    let mut text = Vec::new();
    generate::write_blade(&mut text, 4).unwrap();
    let kept = fs::read(root().join("tests/samples/disc-blade.cls")).unwrap();
    assert!(kept == text, "cargo run --example generate -- blade 4");
}
