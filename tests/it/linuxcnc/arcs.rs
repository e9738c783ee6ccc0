//! Arcs in the real LinuxCNC: the tip goes along those of the CL file, upright and across a tilted tool, whoever keeps it.

use std::f64::consts::TAU;

use nalgebra::Unit;

use super::*;

type V = Vector3<f64>;

/// A quarter, a helix the other way round, a whole circle; then half a turn across a tool that leans.
const ARCS: &str = "UNITS/MM
MULTAX/ON
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/ 20.0, 0.0, 30.0, 0.0, 0.0, 1.0
FEDRAT/1500,MMPM
GOTO/ 20.0, 0.0, 15.0, 0.0, 0.0, 1.0
CIRCLE/0,0,15,0,0,1,20
GOTO/ 0.0, 20.0, 15.0
CIRCLE/0,0,15,0,0,-1,20
GOTO/ -20.0, 0.0, 13.0
CIRCLE/0,0,15,0,0,1,20
GOTO/ -20.0, 0.0, 13.0
RAPID
GOTO/ -20.0, 0.0, 35.0
RAPID
GOTO/ 10.0, 10.0, 30.0, 0.0, 0.6, 0.8
FEDRAT/1500,MMPM
GOTO/ 10.0, 10.0, 20.0, 0.0, 0.6, 0.8
CIRCLE/0,10,20,0,0.6,0.8,10
GOTO/ -10.0, 10.0, 20.0, 0.0, 0.6, 0.8
RAPID
GOTO/ -10.0, 16.0, 28.0, 0.0, 0.6, 0.8
FINI
";

/// What LinuxCNC's own interpolation and the tolerance leave, mm.
const NEAR: f64 = 0.008;

/// The cuts of [`ARCS`]: centre, normal, start, turn, rise.
fn cuts() -> Vec<V> {
    let arcs = [
        ([0.0, 0.0, 15.0], [0.0, 0.0, 1.0], [20.0, 0.0, 15.0], 0.25, 0.0),
        ([0.0, 0.0, 15.0], [0.0, 0.0, 1.0], [0.0, 20.0, 15.0], -0.75, -2.0),
        ([0.0, 0.0, 13.0], [0.0, 0.0, 1.0], [-20.0, 0.0, 13.0], 1.0, 0.0),
        ([0.0, 10.0, 20.0], [0.0, 0.6, 0.8], [10.0, 10.0, 20.0], 0.5, 0.0),
    ];
    let mut places = Vec::new();
    for (centre, normal, start, turns, rise) in arcs {
        let (centre, start) = (V::from(centre), V::from(start));
        let normal = Unit::new_normalize(V::from(normal));
        for step in 0..=4000 {
            let t = f64::from(step) / 4000.0;
            let turn = Rotation3::from_axis_angle(&normal, TAU * turns * t);
            places.push(centre + turn * (start - centre) + normal.into_inner() * rise * t);
        }
    }
    places
}

/// Where the arcs are come to and left: a joint follows the motion that LinuxCNC names by two milliseconds.
const BESIDE: [[[f64; 3]; 2]; 4] = [
    [[20.0, 0.0, 15.0], [20.0, 0.0, 30.0]],
    [[-20.0, 0.0, 13.0], [-20.0, 0.0, 35.0]],
    [[10.0, 10.0, 20.0], [10.0, 10.0, 30.0]],
    [[-10.0, 10.0, 20.0], [-10.0, 16.0, 28.0]],
];

/// The least distance from a place to any of `others`.
fn nearest(place: &V, others: &[V]) -> f64 {
    let apart = others.iter().map(|other| (place - other).norm_squared());
    apart.fold(f64::INFINITY, f64::min).sqrt()
}

/// The least distance from a place to the way along `others`, whose places are nearer to one another than 0.04 mm.
fn from_way(place: &V, others: &[V]) -> f64 {
    let pieces = others.windows(2);
    let near = pieces.filter(|ends| (place - ends[0]).norm_squared() < 0.01);
    let apart = near.map(|ends| off(place, &[ends[0], ends[1]]));
    apart.fold(f64::INFINITY, f64::min)
}

fn arcs_on(machine: &Machine) {
    if shared("linuxcnc/run").is_none() {
        return;
    }
    let wanted = cuts();
    // Under TCP an arc across a tool that leans lies in no plane of the program.
    at_once(vec![("control", 3), ("post", 4)], |(tcp, least)| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("fast.toml"), fast(machine)).unwrap();
        fs::write(folder.path().join("arcs.cls"), ARCS).unwrap();
        let done = run(
            command().current_dir(folder.path()).args([
                "-m",
                "fast.toml",
                "--tcp",
                tcp,
                "arcs.cls",
                "-o",
                "arcs.ngc",
                "--summary",
                "arcs.json",
            ]),
            b"",
        );
        assert_eq!(done.code, 0, "{}", done.err);
        let summary = read_json(&folder.path().join("arcs.json"));
        assert!(summary["curves"].as_u64().unwrap() >= least, "{summary}");
        let program = folder.path().join("arcs.ngc");
        let begin = Begin::aside(machine);
        run_until_good(machine, &program, &begin, |rows| {
            let gone: Vec<V> = rows
                .iter()
                .filter(|row| row.arc)
                .map(|row| {
                    let [tilt, c] = row.rotary.map(f64::to_radians);
                    let (tip, _) = (machine.law)(row.linear, tilt, c, row.length);
                    tip - V::z() * machine.part
                })
                .collect();
            let beside = BESIDE.map(|ends| ends.map(V::from));
            let farthest = gone.iter().map(|tip| {
                let lines = beside.iter().map(|line| off(tip, line));
                lines.fold(from_way(tip, &wanted), f64::min)
            });
            let farthest = farthest.fold(0.0, f64::max);
            // They are gone along from end to end: at 25 mm/s a step is 0.025 mm.
            let kept = &wanted[..if least == 4 { wanted.len() } else { 3 * 4001 }];
            let missed = kept.iter().step_by(50).map(|place| nearest(place, &gone));
            let missed = missed.fold(0.0, f64::max);
            match gone.len() > 5000 && farthest < NEAR && missed < 0.03 {
                true => Ok(()),
                false => Err(format!(
                    "{}, tcp = {tcp}: {} samples, {farthest} mm off, {missed} mm left out",
                    machine.file,
                    gone.len()
                )),
            }
        });
    });
}

#[test]
fn arcs_on_a_table_that_tilts_about_x() {
    arcs_on(&MACHINES[0]);
}

#[test]
fn arcs_on_a_table_that_tilts_about_y() {
    arcs_on(&MACHINES[1]);
}
