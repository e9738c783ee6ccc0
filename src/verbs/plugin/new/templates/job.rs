//! A short job, held against what the control should read.

use post_kit::{Bench, P1, P2, TOOL, TOP, at, cut, turn, turning};
use post_plugin::Event;

#[test]
fn a_short_job_has_its_lines() {
    let events = [
        Event::Start,
        TOP,
        TOOL,
        turning(3000.0),
        TOP,
        turn(P1),
        at(P1),
        cut(P2, 500.0),
        TOP,
        Event::End,
    ];
    let text = Bench::of(post_NAME::plugin()).write(&events).unwrap();
    for line in ["T1 M6", "M30"] {
        assert!(text.lines().any(|own| own == line), "{line} in\n{text}");
    }
}

#[test]
fn what_it_does_not_know_it_refuses() {
    let events = [Event::Start, Event::Unknown { kind: 60_000 }];
    assert!(Bench::of(post_NAME::plugin()).write(&events).is_err());
}
