use post_kit::{Bench, TOOL, TOP, at, cut, job, jobs, turn};
use post_plugin::{Compensation, Event, Value};

fn bench() -> Bench {
    Bench::of(post_isg::plugin())
}

/// A job, but for the compensation by another register than that of the length.
fn by_one_register(mut job: Vec<Event<'static>>) -> Vec<Event<'static>> {
    job.retain(|event| !matches!(event, Event::Compensate(_)));
    job
}

#[test]
fn three_axes_with_arcs() {
    let job = by_one_register(jobs::three_axes());
    insta::assert_snapshot!(bench().write_declared(&job).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    insta::assert_snapshot!(
        bench().with("clamps", Value::Text("C M80 M81")).write_declared(&jobs::tools()).unwrap()
    );
}

#[test]
fn five_axes_with_axis_positions() {
    insta::assert_snapshot!(bench().write(&by_one_register(job(false))).unwrap());
}

#[test]
fn five_axes_with_tcp() {
    insta::assert_snapshot!(bench().tcp().write_job().unwrap());
}

#[test]
fn tilted_planes() {
    insta::assert_snapshot!(bench().write_declared(&jobs::tilted()).unwrap());
}

/// D names length and radius together: a radius of its own has no word.
#[test]
fn another_radius_than_that_of_the_tool_is_refused() {
    const P: &[f64] = &[0.0, 0.0, 10.0, 0.0, 0.0];
    const TO: &[f64] = &[5.0, 0.0, 10.0, 0.0, 0.0];
    let with = |register: u32| {
        let left = Event::Compensate(Compensation::Left { register });
        bench().write(&[
            Event::Start,
            TOP,
            TOOL,
            turn(P),
            at(P),
            left,
            cut(TO, 500.0),
            TOP,
            Event::End,
        ])
    };
    let text = with(1).unwrap();
    assert!(text.contains("G41 X5.000 F500."), "{text}");
    assert!(with(21).unwrap_err().contains("D names length and radius together"));
}
