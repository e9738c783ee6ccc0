use post_kit::{Bench, P1, P3, P4, TOOL, at, cut, timed, turning};
use post_plugin::{Coolant, Event, Spindle, Value};

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
        .tcp()
        .with("preset", Value::Integer(-1))
        .with("rotary_way", Value::Text("M126"))
        .with("retract", Value::Text("L Z-1 R0 FMAX M91"))
        .with(
            "tcp_on",
            Value::Text("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"),
        )
        .with("tcp_off", Value::Text("FUNCTION RESET TCPM"));
    let events = [
        Event::Start,
        TOOL,
        Event::Comment { text: "rough ~" },
        turning(3000.0),
        at(P1),
        cut(P3, 12.3),
        turning(4000.0),
        cut(P4, 12.3),
        post_kit::TOP,
        Event::End,
    ];
    insta::assert_snapshot!(bench.write(&events).unwrap());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |events: &[Event<'_>]| bench().write(events).unwrap_err();
    assert!(refused(&[timed(P1, 2.0)]).contains("in inverse time"));
    assert!(refused(&[Event::Coolant(Coolant::Mist)]).contains("coolant_mist"));
    assert!(refused(&[Event::Spindle(Spindle::Orient)]).contains("cycle"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
}
