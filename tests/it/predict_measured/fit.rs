//! `--fit`: the numbers of another simulation come back, as well as is said.

use super::plant::{AS_FILED, Truth};
use super::*;
use crate::common::assert_contains;

/// The machine file with other numbers for X.
fn wrong() -> String {
    let changed = MILL
        .replacen("kv = 40\n", "kv = 30\n", 1)
        .replacen("velocity_feed_forward = 0.5", "velocity_feed_forward = 0.3", 1)
        .replacen("table_mass = 300", "table_mass = 380", 1);
    assert_ne!(changed, MILL);
    changed
}

fn log_of(truth: Truth, change: impl Fn(&mut Recorder)) -> String {
    let course = Course::new();
    let mut recorder = Recorder::plain(course.seconds);
    recorder.period = 0.002;
    change(&mut recorder);
    recorder.log(&plant::Run::of(&course, truth))
}

fn fitted<'v>(found: &'v Value, name: &str) -> &'v Value {
    let mut numbers = found["fitted"][0]["numbers"].as_array().unwrap().iter();
    numbers.find(|number| number["name"] == name).unwrap()
}

#[test]
fn numbers_come_back_as_well_as_is_said() {
    let course = Course::new();
    let run = plant::Run::of(&course, AS_FILED);
    let truth = [("kv", 40.0), ("velocity_feed_forward", 0.5), ("table_mass", 300.0)];
    let names = "X.kv,X.velocity_feed_forward,X.table_mass";
    let mut scores = Vec::new();
    let mut pasted = None;
    for seed in 1..=10 {
        let mut recorder = Recorder::plain(course.seconds);
        (recorder.period, recorder.noise, recorder.seed) = (0.002, 2e-3, seed);
        // The other simulation goes along smooth commands: set-points so close that straight lines between them are, too.
        let machine = wrong().replace("[motion]\n", "[motion]\nperiod = 0.00025\n");
        let shop = Shop::new(&machine, &recorder.log(&run));
        let (said, found) = shop.found(&["--fit", names]);
        let fit = &found["fitted"][0];
        close(&fit["after"], 2e-3, 2e-4);
        assert!(number(&fit["before"]) > 0.1, "{fit}");
        assert!(number(&fit["rows_alike"]) < 3.0, "{fit}");
        for (name, value) in truth {
            let one = fitted(&found, name);
            assert_eq!(one["determined"], true, "{one}");
            scores.push((number(&one["value"]) - value) / number(&one["deviation"]));
        }
        assert_contains(
            &said.out,
            &[
                "servo of X",
                "± (standard error)",
                "for the machine file:\n[servo.X.loops]\nkv = ",
                "[servo.X.loops.screw]\ntable_mass = ",
            ],
        );
        pasted = Some((fit["machine_file"].as_str().unwrap().to_owned(), shop));
    }
    let squares = scores.iter().map(|score| score * score).sum::<f64>() / scores.len() as f64;
    let within = scores.iter().filter(|score| score.abs() < 3.0).count();
    assert!((0.3..2.2).contains(&squares) && within >= 29, "{squares} {scores:?}");
    // What is said to be written into the machine file can be written there: over the one that was wrong.
    let (lines, shop) = pasted.unwrap();
    fs::write(shop.path("better.toml"), format!("extends = \"mill.toml\"\n{lines}")).unwrap();
    let arguments = [
        "predict",
        "part.nc",
        "-m",
        "better.toml",
        "--measured",
        "log.csv",
        "--summary",
        "better.json",
    ];
    let run = post_in(shop.0.path(), &arguments);
    assert_eq!(run.code, 0, "{}\n{lines}", run.err);
    let better = read_json(&shop.path("better.json"));
    close(&axis(&better, "X")["following"]["rms"], 2e-3, 2e-4);
    close(&axis(&better, "X")["following"]["mean"], 0.0, 2e-4);
}

#[test]
fn what_the_log_does_not_determine_is_named_and_not_pasted() {
    let log = log_of(AS_FILED, |recorder| recorder.noise = 1e-3);
    let shop = Shop::new(&MILL.replacen("kp = 30", "kp = 24", 1), &log);
    // Of gain and its three parts only the products are in the motion.
    let (said, found) = shop.found(&["--fit", "Y.kp,Y.ki,Y.kd,Y.gain"]);
    for name in ["kp", "ki", "kd", "gain"] {
        assert_eq!(fitted(&found, name)["determined"], false, "{name}");
    }
    let fit = &found["fitted"][0];
    close(&fit["after"], 1e-3, 1e-4);
    let product = number(&fitted(&found, "kp")["value"]) * number(&fitted(&found, "gain")["value"]);
    assert!((product / (30.0 * 1.6) - 1.0).abs() < 0.01, "{product}");
    assert_contains(
        &said.out,
        &[
            "kp, ki, kd, gain are not determined by this log one by one",
            "# kp = 24  # not determined by this log",
        ],
    );
    // The three alone are.
    let (_, found) = shop.found(&["--fit", "Y.kp,Y.ki,Y.kd"]);
    for (name, value) in [("kp", 30.0), ("ki", 120.0), ("kd", 0.9)] {
        let one = fitted(&found, name);
        assert_eq!(one["determined"], true, "{one}");
        close(&one["value"], value, 4.0 * number(&one["deviation"]));
    }
    // While only C moves, X says nothing of its mass.
    let log = log_of(AS_FILED, |recorder| {
        recorder.noise = 1e-3;
        recorder.window = [7.0, 10.0];
    });
    let shop = Shop::new(&wrong(), &log);
    let (said, found) = shop.found(&["--fit", "X.table_mass"]);
    assert_eq!(fitted(&found, "table_mass")["determined"], false);
    close(&fitted(&found, "table_mass")["value"], 380.0, 40.0);
    assert_contains(&said.out, &["table_mass is not determined by this log"]);
}

#[test]
fn a_model_that_lacks_something_leaves_more_than_noise() {
    let truth = Truth { friction: 900.0, ..AS_FILED };
    let log = log_of(truth, |recorder| recorder.noise = 1e-3);
    let shop = Shop::new(&wrong(), &log);
    let (said, found) = shop.found(&["--fit", "X.kv,X.velocity_feed_forward"]);
    let fit = &found["fitted"][0];
    assert!(number(&fit["after"]) > 2e-3, "{fit}");
    assert!(number(&fit["rows_alike"]) > 5.0, "{fit}");
    assert_contains(
        &said.out,
        &["what is left is no noise", "the model lacks something (friction, backlash"],
    );
    // With friction in the model it is noise.
    let with = wrong() + "[servo.X.friction]\ncoulomb = 300\nwidth = 1\n";
    let shop = Shop::new(&with, &log);
    let (said, found) =
        shop.found(&["--fit", "X.kv,X.velocity_feed_forward,X.table_mass,X.coulomb"]);
    close(&found["fitted"][0]["after"], 1e-3, 3e-4);
    let coulomb = fitted(&found, "coulomb");
    assert!((number(&coulomb["value"]) / 900.0 - 1.0).abs() < 0.05, "{coulomb}");
    assert_contains(&said.out, &["[servo.X.friction]\ncoulomb = "]);
}

#[test]
fn a_name_that_is_none_and_a_log_that_lacks_the_axis() {
    let log = log_of(AS_FILED, |recorder| {
        recorder.commanded = false;
        recorder.head = "time,X_act,Y_act,Z_act,C_act\n".to_owned();
    });
    let shop = Shop::new(MILL, &log);
    for (name, said) in [
        ("X.kv", "the log does not have X both commanded and actual"),
        ("X.kw", "the log does not have X both"),
        ("B.kv", "B.kv names no number of a servo of this machine"),
        ("X", "X names no number of a servo of this machine"),
    ] {
        let run = shop.run(&["--fit", name]);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{name}: {}", run.err);
        assert_contains(&run.err, &[said, "help:"]);
    }
    let log = log_of(AS_FILED, |_| {});
    let shop = Shop::new(MILL, &log);
    let run = shop.run(&["--fit", "X.kw"]);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["this servo has no number called kw", "did you mean `kv`"]);
}
