use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_fagor::plugin())
}

#[test]
fn three_axes_with_arcs_and_cycles() {
    insta::assert_snapshot!(bench().write_declared(&jobs::three_axes()).unwrap());
}

#[test]
fn tools_and_what_stands_between_them() {
    insta::assert_snapshot!(
        bench().with("clamps", Value::Text("C M80 M81")).write_declared(&jobs::tools()).unwrap()
    );
}

#[test]
fn five_axes_with_axis_positions() {
    insta::assert_snapshot!(bench().write_job().unwrap());
}

#[test]
fn five_axes_with_tcp() {
    let bench = bench().with("tcp_on", Value::Text("#KIN ID [1]\n#RTCP ON"));
    insta::assert_snapshot!(bench.tcp().write_job().unwrap());
}

#[test]
fn tilted_planes() {
    insta::assert_snapshot!(bench().write_declared(&jobs::tilted()).unwrap());
}

/// The word of a rigid tap stands in its block; without a rigid holder it is left out.
#[test]
fn taps_are_rigid() {
    let taps = |bench: Bench| {
        let text = bench.write_declared(&jobs::three_axes()).unwrap();
        let taps: Vec<String> =
            text.lines().filter(|line| line.contains("G84 ")).map(str::to_owned).collect();
        assert!(!taps.is_empty(), "{text}");
        taps
    };
    assert!(taps(bench()).iter().all(|tap| tap.ends_with(" R1")));
    let floating = bench().with("tapping", Value::Text("floating"));
    assert!(taps(floating).iter().all(|tap| !tap.contains(" R")));
}
