use post_kit::{Bench, P1, P3, at, cut};
use post_plugin::{Coolant, Event, Value};

fn bench() -> Bench {
    Bench::of(crate::plugin())
}

#[test]
fn a_job_with_axis_positions() {
    insta::assert_snapshot!(bench().write_job().unwrap());
}

#[test]
fn a_job_with_tcp() {
    insta::assert_snapshot!(bench().tcp().write_job().unwrap());
}

#[test]
fn options_change_what_they_say() {
    let bench = bench()
        .inch()
        .with("percent", Value::Flag(true))
        .with("block_numbers", Value::Flag(true))
        .with("work_offset", Value::Text("G59.1"))
        .with("blend", Value::Number(0.005))
        .with("retract", Value::Text("G53 G0 Z-1."));
    let events = [
        Event::Start,
        Event::Comment {
            text: " msg, (stop it)",
        },
        at(P1),
        cut(P3, 12.25),
        Event::End,
    ];
    insta::assert_snapshot!(bench.write(&events).unwrap());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |events: &[Event<'_>]| bench().write(events).unwrap_err();
    assert!(refused(&[Event::Coolant(Coolant::Through)]).contains("coolant_through"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
    let offset = bench().with("work_offset", Value::Text("G60"));
    assert!(offset.write(&[]).is_err());
}
