use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_mitsubishi::plugin())
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

/// Without `,R1` a parameter decides, which is delivered for a compensating chuck.
#[test]
fn taps_are_synchronous() {
    let rigid = bench().write_declared(&jobs::three_axes()).unwrap();
    let taps: Vec<&str> = rigid.lines().filter(|line| line.contains("G84 ")).collect();
    assert!(!taps.is_empty() && taps.iter().all(|tap| tap.ends_with(" ,R1")), "{rigid}");
    let floating = bench().with("tapping", Value::Text("floating"));
    let floating = floating.write_declared(&jobs::three_axes()).unwrap();
    assert!(floating.contains("G84 ") && !floating.contains(",R"), "{floating}");
}
