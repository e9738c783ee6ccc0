//! The order of events that the kit holds.

use post_kit::{ASIDE, EventOrder, ORDER, P1, P2, TOOL, TOP, at, cut, job, rapid, turn, turning};
use post_plugin::{Coolant, Cycle, EVENTS, Event, Feed};

const CYCLE: Event<'static> = Event::Cycle {
    cycle: Cycle::Drill,
    feed: Feed::PerMinute(100.0),
    depth: 10.0,
    clearance: 2.0,
    retract: 2.0,
    step: None,
    dwell: None,
    pitch: None,
};
const POINT: Event<'static> = Event::CyclePoint { tool: None, words: P2 };
const PLANE: Event<'static> = Event::Plane {
    origin: [0.0; 3],
    x: [1.0, 0.0, 0.0],
    z: [0.0, 0.0, 1.0],
    angles: [0.0; 3],
    words: P1,
};

fn follow(events: &[Event<'_>]) -> Result<(), String> {
    let mut order = EventOrder::default();
    events.iter().try_for_each(|event| order.next(event))
}

#[test]
fn every_kind_of_event_has_its_place() {
    let names: Vec<&str> = ORDER.iter().map(|(name, _)| *name).collect();
    let kinds: Vec<&str> = EVENTS.iter().map(|event| event.name).collect();
    assert_eq!(names, kinds);
}

#[test]
fn a_program_in_order_passes() {
    let hole = [CYCLE, POINT, CYCLE, POINT, POINT, Event::CycleOff];
    let plane = [TOP, turn(P1), PLANE, at(P1), CYCLE, POINT, Event::CycleOff, TOP];
    let mut events = vec![Event::Start, TOP, TOOL, turning(3000.0), TOP, turn(P1), at(P1)];
    events.extend(hole);
    events.extend(plane);
    events.extend([Event::PlaneOff, ASIDE, Event::End]);
    follow(&events).unwrap();
    follow(&job(true)).unwrap();
}

#[test]
fn what_comes_where_it_must_not_is_said() {
    let start = [Event::Start, TOP, TOOL, TOP, turn(P1), at(P1)];
    let on = turning(3000.0);
    for (behind, lack) in [
        (&[Event::Start] as &[Event<'_>], "Start comes a second time"),
        (&[TOOL], "ToolChange comes at the part, before a retract"),
        (&[on, TOP, TOOL], "ToolChange comes while the spindle turns"),
        (&[Event::Coolant(Coolant::Mist), TOP, TOOL], "while the coolant flows"),
        (&[at(P1)], "Position comes without a retract since the last move"),
        (&[TOP, rapid(P1)], "Rapid comes before a first position"),
        (&[TOP, TOP], "Retract comes twice without a move between"),
        (&[turn(P1)], "Turn comes at the part, before a retract"),
        (&[TOP, PLANE, ASIDE], "Park comes inside a tilted plane"),
        (&[TOP, PLANE, TOOL], "ToolChange comes inside a tilted plane"),
        (&[TOP, PLANE, PLANE], "Plane comes inside another plane"),
        (&[TOP, PLANE, Event::WorkOffset { number: 2, name: "" }], "WorkOffset comes inside"),
        (&[PLANE], "Plane comes at the part"),
        (&[TOP, Event::PlaneOff], "PlaneOff comes without a plane"),
        (&[CYCLE, cut(P1, 1.0)], "Linear comes while a cycle is in force"),
        (&[CYCLE, Event::CycleOff], "CycleOff comes behind a cycle without a point"),
        (&[POINT], "CyclePoint comes without a cycle"),
        (&[CYCLE, POINT, TOP], "Retract comes while a cycle is in force"),
        (&[TOP, Event::SmoothingOff], "SmoothingOff comes without smoothing"),
        (&[Event::OperationEnd], "OperationEnd comes without an operation"),
        (&[Event::End], "End comes at the part"),
        (&[TOP, Event::End, Event::Stop], "Stop comes behind the end"),
    ] {
        let fault = follow(&[&start, behind].concat()).unwrap_err();
        assert!(fault.contains(lack), "{lack}: {fault}");
    }
    assert_eq!(follow(&[TOP]).unwrap_err(), "Retract comes before the start");
}
