use post_kit::{Bench, jobs};
use post_plugin::Value;

fn bench() -> Bench {
    Bench::of(post_brother::plugin()).with("unit_system", Value::Text("mm"))
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
    let bench = bench().with("tcp_on", Value::Text("G43.4 H{h}"));
    insta::assert_snapshot!(bench.tcp().write_job().unwrap());
}

/// No word chooses the units: nobody posts without having said which the control is set to.
#[test]
fn the_units_are_those_of_the_control() {
    let refused = Bench::of(post_brother::plugin()).write_job().unwrap_err();
    assert!(refused.to_string().contains("unit_system"), "{refused}");
    let program = bench().write_declared(&jobs::three_axes()).unwrap();
    assert!(!program.contains("G21") && !program.contains("G20"), "{program}");
}

/// The pitch stands in the place of F, in mm; with a compensating chuck it is a plain tap with F.
#[test]
fn taps_are_told_their_pitch() {
    let rigid = bench().write_declared(&jobs::three_axes()).unwrap();
    let taps: Vec<&str> = rigid.lines().filter(|line| line.contains("G77 ")).collect();
    let told = |tap: &&str| tap.contains(" I") && !tap.contains('F');
    assert!(!taps.is_empty() && taps.iter().all(told), "{rigid}");
    let floating = bench().with("tapping", Value::Text("floating"));
    let floating = floating.write_declared(&jobs::three_axes()).unwrap();
    let taps: Vec<&str> = floating.lines().filter(|line| line.contains("G84 ")).collect();
    assert!(!taps.is_empty() && taps.iter().all(|tap| tap.contains('F')), "{floating}");
}
