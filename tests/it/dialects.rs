//! Every dialect that is built in: its programs under review, linked in and from its library, and on the files of CAM
//! systems. Each program is read back and held against its CL file in the run that makes it.
//!
//! A snapshot has the program, or what the dialect refuses. After a change read each new one against the facts of its
//! control.

use crate::common::{self, Run, command, root, run, sample};
use crate::plugins::libraries;
use crate::real_files;

use std::path::Path;
use std::sync::LazyLock;

use post_testkit::{all_drawn, drawn, shared};
use post_testruns::read_back::table;

/// What a job shows, its machine, sample and further arguments.
const JOBS: &[(&str, &str, &str, &[&str])] = &[
    // Arcs in all planes, a helix, cycles of many kinds, tools, stops.
    ("three-axis", "vmc", "flange.ncl", &[]),
    // A tool axis that stays over an operation: the control's plane where it has one.
    ("planes", "ac-trunnion", "wedge.ncl", PLANES),
    // The same with plain index axes.
    ("index", "ac-trunnion", "wedge.ncl", NO_PLANES),
    ("tcp", "ac-trunnion", "facets.apt", &["--tcp", "control", "--set", "control.planes=false"]),
    ("no-tcp", "ac-trunnion", "facets.apt", &["--tcp", "post", "--set", "control.planes=false"]),
];

const PLANES: &[&str] = &["--set", "control.planes=true"];
const NO_PLANES: &[&str] = &["--set", "control.planes=false"];

/// The samples of the jobs.
pub fn samples() -> impl Iterator<Item = &'static str> {
    JOBS.iter().map(|(_, _, sample, _)| *sample)
}

/// What the machine file of a control must name, since its maker's default is beyond doubt nowhere.
pub fn named(dialect: &str) -> &'static [&'static str] {
    match dialect {
        "brother" => &[
            "--set",
            "control.brother.unit_system=\"mm\"",
            "--set",
            "control.brother.tcp_on=\"G43.4 H{h}\"",
        ],
        "mitsubishi" => &["--set", "control.mitsubishi.tapping=\"rigid\""],
        "grbl" => &["--set", "control.grbl.hal=true", "--set", "control.retract={Z=0}"],
        "klipper" => &["--set", "control.klipper.mill=true", "--set", "control.retract={}"],
        "rrf" => &["--set", "control.rrf.mill=true"],
        "marlin" => &["--set", "control.marlin.mill=true", "--set", "control.retract={}"],
        "hurco" => &["--set", "control.hurco.tcp_on=[\"G69\", \"M128\"]"],
        "isg" => &["--set", "control.isg.inch_feeds=true"],
        "siemens" => &["--set", "control.siemens.swivel=true"],
        "okuma" => &[
            "--set",
            "control.okuma.unit_system=\"1 mm\"",
            "--set",
            "control.okuma.tcp_on=\"G169 HL={h}\"",
            "--set",
            "control.okuma.tcp_off=\"G170\"",
            "--set",
            "control.retract={Z=0}",
        ],
        _ => &[],
    }
}

/// [`dialects`], asked for once.
pub static DIALECTS: LazyLock<Vec<String>> = LazyLock::new(dialects);

/// The dialects that are built in.
pub fn dialects() -> Vec<String> {
    let list = common::post(&["plugin", "list"]).out;
    let rows = list.lines().filter(|row| row.ends_with(" built in"));
    let rows = rows.map(str::split_whitespace);
    rows.filter_map(|mut row| Some((row.next()?, row.next()?)))
        .filter(|(_, kind)| *kind == "dialect")
        .map(|(name, _)| name.to_owned())
        .collect()
}

/// Where the depth axis stands clear, as a setting: these controls have no program without it, and `post new` writes it so.
fn top(dialect: &str, machine: &str) -> String {
    let machine = table(machine);
    let end = &machine["axis"]["Z"]["travel"][1];
    let end = end.as_float().or(end.as_integer().map(|end| end as f64));
    // Its end is GRBL's homing switch.
    let pull_off = if dialect == "grbl" { 2.0 } else { 0.0 };
    format!("control.retract={{Z={}}}", end.unwrap() - pull_off)
}

fn post(dialect: &str, machine: &str, file: &Path, with: &[&str]) -> Run {
    run(
        command()
            .args(["-q", "-m", machine, "-o", "-", "--dialect", dialect])
            .args(named(dialect))
            .args(with)
            .arg(file),
        b"",
    )
}

const LENGTH: &[&str] = &["--tool-length", "100"];

#[test]
fn the_programs_are_those_that_were_read() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("tests/snapshots/dialects"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for dialect in dialects() {
            for (job, machine, file, with) in JOBS {
                let with = [LENGTH, with, &["--verify"]].concat();
                let linked = post(&dialect, machine, &sample(file), &with);
                let from = ["--plugins", libraries().to_str().unwrap()];
                let opened = post(&dialect, machine, &sample(file), &[&with[..], &from].concat());
                assert_eq!(linked.out, opened.out, "{dialect} {job}");
                insta::assert_snapshot!(
                    format!("{job}_{dialect}"),
                    format!("{}{}", linked.err, linked.out)
                );
            }
        }
    });
}

/// With nothing said there are planes where the control has cycles, arcs and compensation in them, and nowhere else.
#[test]
fn planes_are_the_default_where_nothing_is_lost_in_them() {
    let mut with_planes = Vec::new();
    for dialect in dialects() {
        for sample_name in ["wedge.ncl", "facets.apt"] {
            let made = |with: &[&str]| {
                let with = [LENGTH, with, &["--verify"]].concat();
                let made = post(&dialect, "ac-trunnion", &sample(sample_name), &with);
                assert_eq!(made.code, 0, "{dialect} {sample_name}: {}", made.err);
                made.out
            };
            let [on, off, unsaid] = [PLANES, NO_PLANES, &[]].map(made);
            assert!(unsaid == on || unsaid == off, "{dialect} {sample_name}:\n{unsaid}");
            if unsaid != off {
                with_planes.push(format!("{dialect} {sample_name}"));
            }
        }
    }
    let expected = ["fagor", "fanuc", "haas", "heidenhain", "isg", "mazak", "siemens"]
        .map(|dialect| ["wedge.ncl", "facets.apt"].map(|name| format!("{dialect} {name}")));
    with_planes.sort();
    let mut expected = expected.concat();
    expected.sort();
    assert_eq!(with_planes, expected);
}

/// Files of CAM systems: what a dialect refuses, by a part of its message. Nothing else may be.
const REFUSED: &[(&str, &str, &str)] = &[
    ("grbl", "nx_HumMan_cutcom.clsf", COMPENSATION),
    ("grbl", "camworks_neMoguta_UniSource.clt", COMPENSATION),
    ("grbl", "swcam_aamorim_Interface-glue.clt", COMPENSATION),
    ("grbl", "swcam_aamorim_Teste-Metrologia.apt", COMPENSATION),
    ("grbl", "swcam_aamorim_basemach.apt", COMPENSATION),
];

/// Firmware of printers, which refuses what GRBL does.
pub const PRINTERS: [&str; 3] = ["klipper", "marlin", "rrf"];

/// Two of them cannot be told of a retract, or of a place for changes, that the machine file has.
const NO_WAY_OUT: &str = "words for positions in machine coordinates";

/// GRBL has no G41.
const COMPENSATION: &str = "no words for cutter radius compensation";

/// What reading back finds in files of CAM systems, by its code and a part of one message: of no other code may be found.
const FOUND: &[(&str, &str, &str)] = &[
    // They work from below, and come there straight from Z9000, and back: through what they cut.
    ("nx_HumMan_ust_a.cls", "rapid", "of what is cut, from 95"),
    ("nx_HumMan_ust_a2.cls", "rapid", "of what is cut, from 95"),
];

/// The run found what is known of the file, and nothing else.
fn found_what_is_known(file: &str, run: &Run) -> bool {
    let known = FOUND.iter().find(|(name, ..)| *name == file);
    known.is_some_and(|(_, code, part)| {
        let errors = run.err.matches("error[").count();
        let of_code = run.err.matches(&format!("error[{code}]")).count();
        run.code == 1 && errors == of_code && run.err.contains(part)
    })
}

#[test]
fn every_file_is_posted_in_every_dialect_and_does_what_it_asks_for() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    let mut failed = Vec::new();
    for (own, dialect) in (0..).zip(dialects()) {
        let mut posted = 0;
        for (file, machine, with) in drawn(real_files::posted::one_each().collect(), own) {
            let mut all = vec!["--verify", "--spindle", "6000"];
            if !with.contains("--tool-length") {
                all.extend(["--tool-length", "0"]);
            }
            all.extend(with.split_whitespace());
            let top = top(&dialect, machine);
            if matches!(dialect.as_str(), "grbl" | "okuma") {
                all.extend(["--set", &top]);
            }
            let done = post(&dialect, machine, &data.join(file), &all);
            let own = if PRINTERS.contains(&dialect.as_str()) { "grbl" } else { &dialect };
            let refused = REFUSED.iter().find(|(name, of, _)| *name == own && *of == file);
            match (done.code, refused) {
                (1, _) if dialect != "rrf" && done.err.contains(NO_WAY_OUT) => {}
                (0, None) => posted += 1,
                (1, None) if found_what_is_known(file, &done) => posted += 1,
                (1, Some((.., why))) if done.err.contains(why) => {}
                _ => failed.push(format!("{file} in {dialect}:\n{}", done.err)),
            }
        }
        assert!(posted > 5 || !all_drawn(), "{dialect}");
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
