use post_kit::{Bench, P1, P3, at, cut, jobs};
use post_plugin::{Coolant, Event, Value};

fn bench() -> Bench {
    Bench::of(post_linuxcnc::plugin())
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
        .with("block_numbers", Value::Text("all"))
        .with("work_offset", Value::Text("G59.1"))
        .with("blend", Value::Number(0.005))
        .with("retract", Value::Text("G53 G0 Z-1."));
    let events = [
        Event::Start,
        Event::Comment { text: " msg, (stop it)" },
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

#[test]
fn three_axes_with_arcs_and_cycles() {
    insta::assert_snapshot!(bench().write_declared(&jobs::three_axes()).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    let bench = bench().with("clamps", Value::Text("C M10 M11"));
    insta::assert_snapshot!(bench.write_declared(&jobs::tools()).unwrap());
}

#[test]
fn a_spline() {
    let bench = bench().with("splines", Value::Flag(true));
    insta::assert_snapshot!(bench.write_declared(&jobs::spline()).unwrap());
}
