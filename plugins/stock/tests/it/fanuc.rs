use post_kit::{ASIDE, Bench, P1, P3, TOP, at, cut, jobs, turn};
use post_plugin::{Compensation, Coolant, Event, Value};

fn bench() -> Bench {
    Bench::of(post_fanuc::plugin())
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
        .with("program_number", Value::Integer(7))
        .with("block_numbers", Value::Text("all"))
        .with("trailing_zeros", Value::Flag(false))
        .with("work_offset", Value::Text("G54.1 P12"))
        .with("cancel", Value::Text("G69"))
        .with("coolant_through_off", Value::Text("M89"))
        .with("length_register", Value::Integer(5))
        .with("coolant_through", Value::Text("M88"))
        .with("retract", Value::Text("G91 G28 Z0."));
    let events = [
        Event::Start,
        TOP,
        Event::Coolant(Coolant::Through),
        Event::Preselect { number: 3 },
        turn(P1),
        at(P1),
        cut(P3, 12.25),
        Event::Compensate(Compensation::Off),
        TOP,
        Event::Coolant(Coolant::Off),
        ASIDE,
        Event::End,
    ];
    insta::assert_snapshot!(bench.write(&events).unwrap());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |events: &[Event<'_>]| bench().write(events).unwrap_err();
    assert!(refused(&[Event::Start, at(P1)]).contains("length_register"));
    assert!(refused(&[Event::Coolant(Coolant::Air)]).contains("coolant_air"));
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

#[test]
fn tilted_planes() {
    insta::assert_snapshot!(bench().write_declared(&jobs::tilted()).unwrap());
}
