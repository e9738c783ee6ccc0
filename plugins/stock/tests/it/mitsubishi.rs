use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_mitsubishi::plugin()).with("tapping", Value::Text("rigid"))
}

#[test]
fn three_axes_with_arcs_and_cycles() {
    insta::assert_snapshot!(bench().write_declared(&jobs::three_axes()).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    insta::assert_snapshot!(
        bench()
            .with("clamps", Value::Text("C M10 M11"))
            .with("smoothing", Value::Text("0 G61.1"))
            .with("smoothing_off", Value::Text("G64"))
            .write_declared(&jobs::tools())
            .unwrap()
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

/// Without `M29` a parameter decides, which is delivered for a compensating chuck: nobody taps without having said which it is.
#[test]
fn taps_are_synchronous() {
    let rigid = bench().write_declared(&jobs::three_axes()).unwrap();
    let (_, tap) = rigid.split_once("M29 S").unwrap();
    assert!(tap.lines().nth(1).unwrap().contains("G84 "), "{rigid}");
    let plain = || Bench::of(post_mitsubishi::plugin());
    let floating = plain().with("tapping", Value::Text("floating"));
    let floating = floating.write_declared(&jobs::three_axes()).unwrap();
    assert!(floating.contains("G84 ") && !floating.contains("M29"), "{floating}");
    let unsaid = plain().write_declared(&jobs::three_axes()).unwrap();
    assert!(!unsaid.contains("G84"), "{unsaid}");
}
