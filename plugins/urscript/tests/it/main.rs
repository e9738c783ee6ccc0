//! The dialect for Universal Robots on a short program. The kit has no machine of six joints.

use post_host::{Plugin, ProgramSetup, ProgramWord};
use post_plugin::{Batch, DialectSession as _, Event, Feed};

fn plugin() -> Plugin {
    Plugin::linked(post_urscript::plugin()).expect("a plugin")
}

/// The joints stand in their places whatever the order of the words is, and a time is a time.
#[test]
fn a_move_has_all_joints_and_its_time() {
    let word =
        |name: &str| ProgramWord { name: name.to_owned(), rotary: true, ..ProgramWord::default() };
    let setup = |names: &[&str]| ProgramSetup {
        words: names.iter().map(|name| word(name)).collect(),
        ..ProgramSetup::default()
    };
    let mut session = plugin().dialect(&setup(&["U", "V", "W", "A", "B", "C"])).expect("a dialect");
    let words = [4.0, 5.0, 6.0, 1.0, 2.0, 3.0];
    let mut batch = Batch::default();
    batch.push(1, Event::Retract { axes: 0b1000, words: &words });
    batch.push(2, Event::rapid(&words));
    batch.push(3, Event::linear(&words, Feed::InverseTime(120.0)));
    let (mut text, mut ends) = (String::new(), Vec::new());
    session.write_batch(&batch, &mut text, &mut ends).expect("a program");
    let joints = "[d2r(1.0000), d2r(2.0000), d2r(3.0000), d2r(4.0000), d2r(5.0000), d2r(6.0000)]";
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines,
        [
            "  here = get_actual_joint_positions()".to_owned(),
            "  here[0] = d2r(1.0000)".to_owned(),
            "  movej(here, a=1.400, v=1.050, r=0)".to_owned(),
            format!("  movej({joints}, a=1.400, v=1.050, r=0)"),
            format!("  movej({joints}, t=0.500000000, r=0)"),
        ]
    );
    let mut batch = Batch::default();
    batch.push(1, Event::linear(&words, Feed::PerMinute(600.0)));
    assert!(session.write_batch(&batch, &mut text, &mut ends).is_err());
    let refused =
        [&["A", "B", "C", "U", "V", "W", "Y"][..], &["A", "B", "C", "U", "V"], &["A", "A1"]];
    for names in refused {
        assert!(plugin().dialect(&setup(names)).is_err(), "{names:?}");
    }
    let numbered = ["A1", "A2", "A3", "A4", "A5", "A6"];
    assert!(plugin().dialect(&setup(&numbered)).is_ok());
}
