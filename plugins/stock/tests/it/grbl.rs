use post_kit::{Bench, jobs};
use post_plugin::{Event, Value};

fn bench() -> Bench {
    Bench::of(post_grbl::plugin())
}

#[test]
fn three_axes_with_arcs_and_cycles() {
    let mut job = jobs::three_axes();
    job.retain(|event| !matches!(event, Event::Compensate(_)));
    insta::assert_snapshot!(bench().three_axes().write_declared(&job).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    insta::assert_snapshot!(bench().three_axes().write_declared(&jobs::tools()).unwrap());
}

#[test]
fn five_axes_of_grblhal() {
    let bench = bench().with("hal", Value::Flag(true)).with("change", Value::Text("M6"));
    let mut job = post_kit::job(true);
    job.retain(|event| !matches!(event, Event::Compensate(_)));
    insta::assert_snapshot!(bench.write(&job).unwrap());
}
