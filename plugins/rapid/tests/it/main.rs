//! The dialect for ABB's robots, as the kit sees it and on a short program.

use post_host::{Plugin, ProgramSetup, ProgramWord};
use post_kit::conformance;
use post_plugin::{Batch, DialectSession as _, Event, Feed};

fn plugin() -> Plugin {
    Plugin::linked(post_rapid::plugin()).expect("a plugin")
}

#[test]
fn the_kit_finds_nothing_wrong() {
    let report = conformance::test(&plugin(), &[]).expect("a report");
    assert!(report.is_good(), "{report}");
}

/// The arm's axes stand in their places whatever the order of the words is, a rail behind them, and a time is a time.
#[test]
fn a_move_is_a_target_with_its_time() {
    let word = |(name, rotary): (&str, bool)| ProgramWord {
        name: name.to_owned(),
        rotary,
        ..ProgramWord::default()
    };
    let names = [("Y", false), ("U", true), ("V", true), ("W", true)];
    let names = names.into_iter().chain([("A", true), ("B", true), ("C", true)]);
    let setup = ProgramSetup { words: names.map(word).collect(), ..ProgramSetup::default() };
    let mut session = plugin().dialect(&setup).expect("a dialect");
    let words = [1500.0, 4.0, 5.0, 6.0, 1.0, 2.0, 3.0];
    let mut batch = Batch::default();
    batch.push(1, Event::rapid(&words));
    batch.push(2, Event::linear(&words, Feed::InverseTime(120.0)));
    batch.push(3, Event::linear(&words, Feed::PerMinute(600.0)));
    let (mut text, mut ends) = (String::new(), Vec::new());
    session.write_batch(&batch, &mut text, &mut ends).expect("a program");
    let target =
        "MoveAbsJ [[1.0000,2.0000,3.0000,4.0000,5.0000,6.0000],[9E9,1500.000,9E9,9E9,9E9,9E9]]";
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines,
        [
            format!("{target},vmax,fine,tool0;"),
            format!("{target},v1000\\T:=0.50000000000,fine,tool0;"),
            format!("{target},v1000\\V:=10.00000,fine,tool0;"),
        ]
    );
    let inch = ProgramSetup { units: post_plugin::Units::Inch, ..setup.clone() };
    assert!(plugin().dialect(&inch).is_err());
    assert!(plugin().dialect(&ProgramSetup { tcp: true, ..setup }).is_err());
}
