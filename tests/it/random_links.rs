//! Random five-axis jobs whose rapids go for themselves: what is clear without links is clear with them.

use std::fmt::Write;
use std::fs;

use post_testkit::{Rng, at_least, randomised};
use serde_json::Value;
use tempfile::TempDir;

use crate::common::post_in;

/// A machine of each kind, and how high over its table the part stands, mm.
const KINDS: [(&str, [f64; 3]); 3] = [
    ("ac-trunnion", [0.0, 0.0, 60.0]),
    ("head-table-bc", [0.0, 0.0, 60.0]),
    ("head-head", [300.0, 200.0, -900.0]),
];

/// Where the spindle nose stands with all axes at zero, mm.
const NOSE: [f64; 3] = [400.0, 450.0, 0.0];

fn block(name: &str, low: [f64; 3], high: [f64; 3], on: &str) -> String {
    format!("[fixture.{name}]\nblock = [{low:?}, {high:?}]\non = \"{on}\"\n")
}

/// A machine with a vise, what stands about it, a head and a tool.
fn machine(rng: &mut Rng, kind: usize) -> String {
    let (extends, mount) = KINDS[kind];
    let nose = if kind == 2 { -250.0 } else { NOSE[kind] };
    let mut text = format!(
        "extends = \"{extends}\"\nname = \"random\"\n[workpiece]\nmount = {mount:?}\n\
         [stock]\nblock = [[-30, -30, 0], [30, 30, 40]]\n\
         [tools.6]\nlength = 120\nholder = [[0, 32], [20, 32], [20, 20], [60, 18]]\ncutter = [[0, 2.5], [55, 2.5]]\n\
         [fixture.head]\ncylinder = [[0, 0, {}], [0, 0, {}]]\nradius = {:.1}\non = \"t\"\n\
         [clearance]\nkeep = {:.2}\n",
        nose + 1.0,
        nose + 120.0,
        rng.range(40.0, 80.0),
        rng.range(0.0, 2.0),
    );
    let at = |offset: [f64; 3]| std::array::from_fn::<f64, 3, _>(|axis| mount[axis] + offset[axis]);
    let vise = rng.range(35.0, 60.0);
    text +=
        &block("vise", at([-vise, -40.0, -60.0]), at([vise, 40.0, rng.range(-20.0, 20.0)]), "w");
    for place in 0..rng.pick(3) + 1 {
        let (turn, far) = (rng.range(0.0, std::f64::consts::TAU), rng.range(70.0, 180.0));
        let (x, y) = (far * libm::cos(turn), far * libm::sin(turn));
        let half = rng.range(4.0, 25.0);
        let on = if rng.pick(3) == 0 { "b" } else { "w" };
        let top = rng.range(-20.0, 140.0);
        text += &block(
            &format!("f{place}"),
            at([x - half, y - half, -60.0]).map(libm::round),
            at([x + half, y + half, top]).map(libm::round),
            on,
        );
    }
    text
}

/// Passes over the part, each with a tool that leans its own way, or as the one before.
fn program(rng: &mut Rng) -> String {
    let mut text = "TLDATA/MILL,5,0,120,0,0\nLOAD/TOOL,6\nSPINDL/RPM,6000,CLW\n".to_owned();
    let mut lean = [0.0; 2];
    for pass in 0..rng.pick(3) + 2 {
        if pass == 0 || rng.pick(3) > 0 {
            lean = [rng.range(0.0, 45.0).to_radians(), rng.range(0.0, std::f64::consts::TAU)];
        }
        let [tilt, turn] = lean;
        let axis =
            [libm::sin(tilt) * libm::cos(turn), libm::sin(tilt) * libm::sin(turn), libm::cos(tilt)];
        let [x, y] = [rng.range(-20.0, 5.0), rng.range(-20.0, 20.0)];
        let up = rng.range(20.0, 60.0);
        let mut go = |word: &str, x: f64, out: f64| {
            let [px, py, pz] = [x + out * axis[0], y + out * axis[1], 44.5 + out * axis[2]];
            let [i, j, k] = axis;
            writeln!(text, "{word}\nGOTO/{px:.4},{py:.4},{pz:.4},{i:.7},{j:.7},{k:.7}").unwrap();
        };
        go("RAPID", x, up);
        go("RAPID", x, 3.0);
        go("FEDRAT/MMPM,800", x, 0.0);
        go("FEDRAT/MMPM,800", x + 20.0, 0.0);
        go("RAPID", x + 20.0, up);
    }
    text + "FINI\n"
}

/// What is clear without links, but for what `--clearance` sees to, is clear with them.
#[test]
fn what_is_clear_without_links_is_clear_with_them() {
    let (rounds, mut rng) = randomised(24, 97);
    let (mut clear, mut ways) = (0_u64, 0_u64);
    for _ in rounds {
        let folder: TempDir = tempfile::tempdir().unwrap();
        let kind = rng.pick(KINDS.len());
        let (machine, program) = (machine(&mut rng, kind), program(&mut rng));
        fs::write(folder.path().join("m.toml"), &machine).unwrap();
        fs::write(folder.path().join("p.cls"), &program).unwrap();
        let words = ["-m", "m.toml", "p.cls", "-o", "p.nc", "-q", "--clearance"];
        let ever = post_in(folder.path(), &words);
        if ever.code != 0 {
            continue;
        }
        clear += 1;
        let link = ["--set", "clearance.link=true", "--summary", "s.json"];
        let run = post_in(folder.path(), &[&words[..], &link].concat());
        assert_eq!(run.code, 0, "{}\n{machine}\n{program}", run.err);
        let summary = fs::read_to_string(folder.path().join("s.json")).unwrap();
        let summary: Value = serde_json::from_str(&summary).unwrap();
        let count = |key: &str| summary["ways_across"][key].as_u64().unwrap();
        ways += count("low") + count("past") + count("rapids");
    }
    assert!(clear >= at_least(8) && ways >= at_least(8), "{clear} jobs, {ways} ways");
}
