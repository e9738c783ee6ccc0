//! Runs of cuts go through the stages as columns: what is written, and all that is said of it, is what single points
//! make, bit by bit.

use std::fmt::Write;

use post_plugin::PlaneAngles;
use post_testruns::posted::{Recorder, watched};

use super::*;

/// A path that wanders, now in small steps and now in large ones, over poles and out of travel, with words between: of a
/// tool that leans any way, about X alone, or not at all. Each of the words stands before `words` of 720 records.
pub(super) fn wander(rng: &mut Rng, rotary: usize, words: usize) -> String {
    let mut text = "UNITS/MM\nLOADTL/1\nSPINDL/1000\nFEDRAT/MMPM,800\n".to_owned();
    let mut tip = rng.point(40.0);
    let (mut lean, mut around) = (rng.range(0.0, 0.8), rng.range(-3.0, 3.0));
    let (mut step, mut turn) = (0.4, 0.01);
    for _ in 0..rng.pick(400) {
        match rng.pick((720 / words).max(9)) {
            0 => text += "RAPID\n",
            1 => writeln!(text, "FEDRAT/MMPM,{:.1}", rng.order(-2.0, 4.3)).unwrap(),
            2 => step = *rng.choose(&[0.0, 0.001, 0.1, 0.4, 0.4, 3.0]),
            3 => turn = *rng.choose(&[0.0, 1e-6, 0.003, 0.01, 0.01, 0.1]),
            4 => text += "COOLNT/FLOOD\n",
            5 => text += "DELAY/1\n",
            6 => lean = rng.range(-0.02, 0.02),
            7 => writeln!(text, "FEDRAT/{:.3},INVERS", rng.range(1.0, 50.0)).unwrap(),
            _ => {}
        }
        tip += rng.direction() * step;
        lean += rng.range(-1.0, 1.0) * turn;
        around += rng.range(-0.5, 1.0) * turn;
        let ((i, k), (b, a)) = (libm::sincos(lean), libm::sincos(around));
        let (x, y, z) = (tip.x, tip.y, tip.z);
        match rotary {
            0 => writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4}"),
            1 => writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4},0.000000,{i:.6},{k:.6}"),
            _ => {
                let (j, i) = (i * b, i * a);
                writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4},{i:.6},{j:.6},{k:.6}")
            }
        }
        .unwrap();
    }
    text + "FINI\n"
}

#[test]
fn a_run_is_written_as_its_points_would_be() {
    let (rounds, mut rng) = randomised(60, 71);
    let mut good = 0;
    for round in rounds {
        let kind = *rng.choose(&["trunnion", "head", "nutating"]);
        let tilt = *rng.choose(&[[-120.0, 120.0], [-120.0, 120.0], [-20.0, 200.0]]);
        let settings: &[&str] = match round % 6 {
            0 => &["control.feed=\"per-minute\""],
            1 => &["control.units=\"inch\""],
            2 => &["axis.X.travel=[-60, 60]"],
            3 => &["accuracy.reduce=true"],
            4 => &["axis.C.range=[0, 360]"],
            _ => &[],
        };
        let model = model(kind, rng.pick(2) == 0, tilt, settings);
        let words = *rng.choose(&[1, 9, 60]);
        let text = wander(&mut rng, 2, words);
        good += u32::from(is_the_same(&model.machine, model.length, &text, None));
    }
    assert!(good > 0);
}

/// Stretches on which the tool axis stays, and others: in small steps and large ones, level in a plane and not.
fn facets(rng: &mut Rng) -> String {
    let mut text = "UNITS/MM\nSPINDL/1000\nFEDRAT/MMPM,800\n".to_owned();
    for tool in 1..=rng.pick(4) + 1 {
        writeln!(text, "LOADTL/{tool}").unwrap();
        let lean = rng.range(0.0, 0.8);
        let around = rng.range(-3.0, 3.0);
        let turn = *rng.choose(&[0.0, 0.0, 1e-3]);
        let mut tip = rng.point(30.0);
        let step = *rng.choose(&[0.0004, 0.01, 0.4, 3.0]);
        for place in 0..rng.pick(300) {
            let ((sine, k), (j, i)) =
                (libm::sincos(lean + turn * place as f64), libm::sincos(around));
            let axis = nalgebra::Vector3::new(sine * i, sine * j, k);
            let way = rng.direction() * step;
            tip += match rng.pick(4) {
                0 => way,
                _ => way - axis * axis.dot(&way),
            };
            match rng.pick(60) {
                0 => text += "RAPID\n",
                1 => text += "COOLNT/FLOOD\n",
                _ => {}
            }
            let (x, y, z) = (tip.x, tip.y, tip.z);
            writeln!(text, "GOTO/{x:.4},{y:.4},{z:.4},{:.7},{:.7},{:.7}", axis.x, axis.y, axis.z)
                .unwrap();
        }
    }
    text + "FINI\n"
}

#[test]
fn a_run_in_a_plane_is_written_as_its_points_would_be() {
    let (rounds, mut rng) = randomised(60, 73);
    let mut good = 0;
    for _ in rounds {
        let kind = *rng.choose(&["trunnion", "head", "nutating"]);
        let model = model(kind, rng.pick(2) == 0, [-120.0, 120.0], &["control.planes=true"]);
        let angles = *rng.choose(&[PlaneAngles::Zxz, PlaneAngles::Xyz, PlaneAngles::Rotary]);
        let text = facets(&mut rng);
        good += u32::from(is_the_same(&model.machine, model.length, &text, Some(angles)));
    }
    assert!(good > 0);
}

/// Machines with one rotary axis, and with none.
#[test]
fn a_run_of_fewer_axes_is_written_as_its_points_would_be() {
    let (rounds, mut rng) = randomised(60, 72);
    let mut good = 0;
    for _ in rounds {
        let rotary = rng.pick(2);
        let range = *rng.choose(&["", "range = [0, 360]", "travel = [-60, 40]"]);
        let cyclic = if range.starts_with("travel") { "" } else { "cyclic = true" };
        let chain = if rotary == 1 { "[w A' b X Y Z t]" } else { "[w b X Y Z t]" };
        let axis = format!(
            "[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 3, 50]\nmax_feed = 900\n{cyclic}\n{range}\n"
        );
        let text = format!(
            "name = \"few\"\nchain = \"{chain}\"\n[workpiece]\nmount = [0, 0, 20]\n\
            [tool]\ngauge = [0, 0, 300]\n{}[control]\ndialect = \"recorder\"\ntcp = \"{}\"\n{LINEAR}",
            if rotary == 1 { &axis } else { "" },
            if rotary == 1 && rng.pick(2) == 0 { "control" } else { "post" },
        );
        let source = Source { name: "few".to_owned(), text };
        let machine = load(source, &[], &mut |_| Err(String::new()))
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
        let words = *rng.choose(&[1, 9, 60]);
        good += u32::from(is_the_same(&machine, 50.0, &wander(&mut rng, rotary, words), None));
    }
    assert!(good > 0);
}

/// Whether the text is posted, which is the same as columns and as single points; `planes` are those of the control.
fn is_the_same(machine: &Machine, length: f64, text: &str, planes: Option<PlaneAngles>) -> bool {
    let told = |longest_run| {
        let job =
            PostingRequest { tool_length: Some(length), longest_run, ..PostingRequest::default() };
        let recorder = Recorder::new(machine, 4);
        let recorder = match planes {
            Some(angles) => recorder.with_planes(angles, 3),
            None => recorder,
        };
        let done = watched(machine, recorder, text, job, &mut Samples, &mut []);
        let Run { asked, report, findings } = done;
        (report.is_some(), format!("{asked:?}\n{report:?}\n{findings:?}"))
    };
    let (is_good, expected) = told(Some(0));
    // As many as nobody has chosen.
    let any = 2 + text.len() % 61;
    for longest in [None, Some(1), Some(7), Some(any)] {
        let (_, told) = told(longest);
        assert!(told == expected, "{}, runs of {longest:?}:\n{text}", machine.name);
    }
    is_good
}
