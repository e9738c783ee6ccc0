use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_hurco::plugin())
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
            .write_declared(&jobs::tools())
            .unwrap()
    );
}

#[test]
fn five_axes_with_axis_positions() {
    insta::assert_snapshot!(bench().write_job().unwrap());
}

#[test]
fn five_axes_with_tcp() {
    let bench = bench().with("tcp_on", Value::Text("G69\nM128"));
    insta::assert_snapshot!(bench.tcp().write_job().unwrap());
}

/// `M29` stands alone, and P is not optional there; without a rigid holder it is left out.
#[test]
fn taps_are_rigid() {
    let rigid = bench().write_declared(&jobs::three_axes()).unwrap();
    let (_, tap) = rigid.split_once("\nM29\n").expect("a rigid tap");
    let tap = tap.lines().next().unwrap();
    assert!(tap.contains("G84 ") && tap.contains(" P0 F"), "{tap}");
    let floating = bench().with("tapping", Value::Text("floating"));
    let floating = floating.write_declared(&jobs::three_axes()).unwrap();
    assert!(
        floating.contains("G84 ") && !floating.contains("M29"),
        "{floating}"
    );
}
