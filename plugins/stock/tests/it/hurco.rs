use post_kit::{Bench, jobs, turn};
use post_plugin::{AxisWord, Batch, Event, Promise, Setup, Value};

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
        bench().with("clamps", Value::Text("C M10 M11")).write_declared(&jobs::tools()).unwrap()
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
    assert!(floating.contains("G84 ") && !floating.contains("M29"), "{floating}");
}

/// Words of one turn mean the shorter way, which the control takes between `M126` and `M127` alone.
#[test]
fn words_of_one_turn_go_the_shorter_way() {
    let words = ["X", "Z", "C"].map(|name| AxisWord {
        name,
        rotary: name == "C",
        wrapped: name == "C",
        depth: name == "Z",
        ..AxisWord::default()
    });
    let declared = post_hurco::plugin().options();
    let options: Vec<_> = declared.iter().map(|spec| (spec.key, spec.default)).collect();
    let setup = Setup { words: &words, options: &options, ..Setup::default() };
    let mut dialect = post_hurco::plugin().open(&setup).unwrap().unwrap();
    let mut batch = Batch::default();
    batch.push(1, Event::Start);
    batch.push(2, turn(&[0.0, 0.0, 350.0]));
    batch.push(3, Event::End);
    let promise = Promise { words: 3, inverse_time: false };
    let (mut out, mut ends) = (String::new(), Vec::new());
    dialect.write(&batch, &promise, &mut out, &mut ends).unwrap();
    let place = |word: &str| out.find(word).unwrap_or_else(|| panic!("{word}: {out}"));
    assert!(place("M126") < place("C350.000") && place("C350.000") < place("M127"));
    assert!(place("M127") < place("M30"));
    let plain = bench().write_job().unwrap();
    assert!(!plain.contains("M126"), "{plain}");
}
