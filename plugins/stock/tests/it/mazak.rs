use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_mazak::plugin())
}

#[test]
fn three_axes_with_arcs_and_cycles() {
    insta::assert_snapshot!(bench().write_declared(&jobs::three_axes()).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    insta::assert_snapshot!(
        bench().with("clamps", Value::Text("C M10 M11")).write_declared(&jobs::tools()).unwrap()
    );
}

#[test]
fn tilted_planes() {
    insta::assert_snapshot!(bench().write_declared(&jobs::tilted()).unwrap());
}

#[test]
fn five_axes_with_axis_positions() {
    insta::assert_snapshot!(bench().write_job().unwrap());
}

#[test]
fn five_axes_with_tcp() {
    insta::assert_snapshot!(bench().tcp().write_job().unwrap());
}
