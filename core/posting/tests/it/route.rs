//! Which of several solutions is taken, over whole paths: against exhaustive search, published examples, and what
//! comes out close to poles and at the end of travel. The printed words are judged by nothing of the crate.

mod choice;
mod cycle_time;
mod exhaustive;
mod pole;
mod rewind;
mod turns;

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};
use post_machine::description::{Side, SolutionCriterion};
use post_machine::diagnostic::Severity;
use post_machine::kinematics::{Joints, Pose, Solver};
use post_plugin::Feed;
use post_testkit::{Rng, at_least, randomised, repository};
use post_testmachines::{across, angle, distance, slerp, turned};
use post_testruns::posted::Asked;
use post_testruns::posted::{Bench, Point, Run, cl, line, point};

/// A machine of a class: chain, rotary axes with their lines, gauge and tool length.
#[derive(Clone, Copy)]
struct Class<'a> {
    name: &'a str,
    chain: &'a str,
    second: &'a str,
    direction: &'a str,
    point: &'a str,
    gauge: f64,
    length: f64,
}

const CLASSES: [Class<'static>; 4] = [
    Class {
        name: "table-table AC",
        chain: "[w C' A' b Y X Z t]",
        second: "A",
        direction: "[1, 0, 0]",
        point: "[0, 0.012, 50.004]",
        gauge: 400.0,
        length: 0.0,
    },
    Class {
        name: "head-table BC",
        chain: "[w C' b X Y Z B t]",
        second: "B",
        direction: "[0, 1, 0]",
        point: "[0, 0, 250]",
        gauge: 100.0,
        length: 0.0,
    },
    Class {
        name: "head-head AC",
        chain: "[w b X Y Z C A t]",
        second: "A",
        direction: "[1, 0, 0]",
        point: "[0, 0, 250]",
        gauge: 0.0,
        length: 120.0,
    },
    Class {
        name: "nutating head",
        chain: "[w C' b X Y Z B t]",
        second: "B",
        direction: "[0, 1, 1]",
        point: "[0, 0, 680]",
        gauge: 500.0,
        length: 0.0,
    },
];

/// What a machine of a class is given for one test.
struct Given<'a> {
    tcp: &'a str,
    /// Of C; empty for a cyclic one.
    c: String,
    second: [f64; 2],
    feeds: [f64; 5],
    /// Of X, Y, Z, the other axis and C; none: none are given.
    accelerations: Option<[f64; 5]>,
    linear: f64,
    accuracy: &'a str,
    /// Further tables: `[solution]`, `[rewind]`.
    more: String,
    decimals: u8,
}

impl Default for Given<'_> {
    fn default() -> Self {
        Self {
            tcp: "post",
            c: String::new(),
            second: [-175.0, 175.0],
            feeds: [20_000.0, 20_000.0, 15_000.0, 5400.0, 9000.0],
            accelerations: None,
            linear: 5000.0,
            accuracy: "tolerance = 0.005\naxis_tolerance = 0.05\nrapid_tolerance = 0.5",
            more: String::new(),
            decimals: 3,
        }
    }
}

fn bench(class: &Class<'_>, given: &Given<'_>) -> Bench {
    let Class { name, chain, second, direction, point, gauge, length } = class;
    let Given {
        tcp,
        c,
        second: tilt,
        feeds: [x, y, z, tilting, turning],
        accelerations,
        linear,
        accuracy,
        more,
        decimals,
    } = given;
    let c = if c.is_empty() { "cyclic = true".to_owned() } else { format!("travel = {c}") };
    let [ax, ay, az, tilted, turned] = match accelerations {
        Some(values) => values.map(|value| format!("max_accel = {value}")),
        None => Default::default(),
    };
    let text = format!(
        r#"
name = "{name}"
chain = "{chain}"
[workpiece]
mount = [10, -20, 30]
[tool]
gauge = [0, 0, {gauge}]
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
{c}
max_feed = {turning}
{turned}
[axis.{second}]
rotary = {direction}
point = {point}
travel = {tilt:?}
max_feed = {tilting}
{tilted}
[axis.X]
linear = [1, 0, 0]
travel = [-{linear}, {linear}]
max_feed = {x}
{ax}
[axis.Y]
linear = [0, 1, 0]
travel = [-{linear}, {linear}]
max_feed = {y}
{ay}
[axis.Z]
linear = [0, 0, 1]
travel = [-{linear}, {linear}]
max_feed = {z}
{az}
[control]
dialect = "recorder"
tcp = "{tcp}"
[accuracy]
{accuracy}
{more}
"#
    );
    Bench::new(&text, *decimals, *length)
}

/// The documented cost of a move, in the units of the rule, and its time: minutes.
fn cost(bench: &Bench, from: &Joints, to: &Joints, linear: bool) -> f64 {
    let machine = &bench.machine;
    let (mut time, mut squares, mut largest, mut named) = (0.0, 0.0f64, 0.0f64, 0.0);
    for (place, axis) in machine.axes.iter().enumerate() {
        let way = (to[place] - from[place]).abs();
        if axis.joint.rotary {
            squares += way.to_degrees() * way.to_degrees();
            largest = largest.max(way.to_degrees());
        }
        if machine.solution.rule == SolutionCriterion::Axis(place) {
            named = if axis.joint.rotary { way.to_degrees() } else { way };
        }
        if axis.joint.rotary || linear {
            time += way / axis.max_feed;
        }
    }
    // The time breaks the ties of the other rules.
    match machine.solution.rule {
        SolutionCriterion::Time => time,
        SolutionCriterion::CycleTime => unreachable!("not a sum over the axes"),
        SolutionCriterion::Travel => squares.sqrt() + 1e-6 * time,
        SolutionCriterion::LargestAxis => largest + 1e-6 * time,
        SolutionCriterion::Axis(_) => named + 1e-6 * time,
    }
}

/// Every value that stands inside travel and on the side that is required.
fn inside(bench: &Bench, joints: &Joints) -> bool {
    let axes = bench.machine.axes.iter().enumerate();
    let travel = axes.clone().all(|(place, axis)| {
        axis.travel
            .is_none_or(|[least, most]| (least - 1e-9..=most + 1e-9).contains(&joints[place]))
    });
    let sides = &bench.machine.solution.require;
    travel
        && sides.iter().all(|(place, side)| match side {
            Side::Positive => joints[*place] >= -1e-9,
            Side::Negative => joints[*place] <= 1e-9,
        })
}

/// Every way to stand at a point: both branches, on every full turn inside travel.
fn stands(bench: &Bench, solver: &Solver, target: &Point) -> Vec<Joints> {
    let pose = Pose { tip: target.tip, axis: target.axis.normalize(), ..Pose::default() };
    let Ok(solutions) = solver.inverse(&pose, &Joints::default(), 1e-9) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let [first, second] = [bench.rotary()[0], bench.rotary()[1]];
    for solution in solutions {
        for i in -3..=3 {
            for j in -3..=3 {
                let mut joints = solution;
                joints[first] += TAU * f64::from(i);
                joints[second] += TAU * f64::from(j);
                if inside(bench, &joints) {
                    all.push(joints);
                }
            }
        }
    }
    all
}

/// Goes along a cut from a way of standing at its start: where the axes come to stand at its end, each step
/// continued by the nearest solution; and whether they left their travel on the way.
fn followed(
    bench: &Bench,
    solver: &Solver,
    from: (&Point, &Joints),
    to: &Point,
) -> Option<(Joints, bool)> {
    const STEPS: usize = 64;
    let mut joints = *from.1;
    let mut left = false;
    for step in 1..=STEPS {
        let t = step as f64 / STEPS as f64;
        let pose = Pose {
            tip: from.0.tip * (1.0 - t) + to.tip * t,
            axis: slerp(from.0.axis.normalize(), to.axis.normalize(), t),
            ..Pose::default()
        };
        let solutions = solver.inverse(&pose, &joints, 1e-9).ok()?;
        let continued = solutions.into_iter().map(|solution| {
            let mut next = solution;
            let mut way = 0.0f64;
            for place in bench.rotary() {
                let turn = turned(joints[place], solution[place]);
                next[place] = joints[place] + turn;
                way = way.max(turn.abs());
            }
            (way, next)
        });
        let (way, next) = continued.min_by(|a, b| a.0.total_cmp(&b.0))?;
        assert!(way < 0.6, "the test's own path is too coarse: {way}");
        joints = next;
        left |= !inside(bench, &joints);
    }
    Some((joints, left))
}

/// A short path of cuts and rapids that stays clear of the pole and of the edge of reach.
fn short(rng: &mut Rng, class: &Class<'_>) -> Vec<Point> {
    let clear = |axis: Vector3<f64>| {
        let tilt = angle(axis, Vector3::z()).to_degrees();
        let most = if class.name == "nutating head" { 80.0 } else { 150.0 };
        (12.0..most).contains(&tilt)
    };
    loop {
        let mut points: Vec<Point> = Vec::new();
        let count = 3 + rng.pick(4);
        let mut tries = 0;
        while points.len() < count && tries < 500 {
            tries += 1;
            let rapid = points.is_empty() || rng.pick(3) == 0;
            let last = points.last().map(|last| last.axis);
            let axis = match last {
                Some(last) if !rapid => {
                    let about = Unit::new_normalize(rng.direction());
                    Rotation3::from_axis_angle(&about, rng.range(0.0, 1.0)) * last
                }
                _ => {
                    let axis = rng.direction();
                    // As tools stand mostly.
                    if rng.pick(3) > 0 { Vector3::new(axis.x, axis.y, axis.z.abs()) } else { axis }
                }
            };
            let way_is_clear = |last: Vector3<f64>| {
                (0..=20).all(|step| clear(slerp(last, axis, f64::from(step) / 20.0)))
            };
            if !clear(axis) || (!rapid && !last.is_none_or(way_is_clear)) {
                continue;
            }
            points.push(point(rng.point(80.0), axis.normalize(), rapid));
        }
        if points.len() == count {
            return points;
        }
    }
}

/// Travel of an axis that lets it stand on one to three turns.
fn turns(rng: &mut Rng) -> [f64; 2] {
    let width = rng.range(340.0, 1000.0);
    let least = -rng.range(0.15, 0.85) * width;
    [least, least + width].map(f64::round)
}

/// The farthest that any printed value lies outside the travel of its axis, mm or degrees, and which.
fn left_travel(bench: &Bench, run: &Run) -> (f64, String) {
    let mut worst = (0.0, String::new());
    for asked in run.motions() {
        let joints = bench.joints(&asked.words);
        for (place, axis) in bench.machine.axes.iter().enumerate() {
            if let Some([least, most]) = axis.travel {
                let over = (least - joints[place]).max(joints[place] - most) / axis.unit();
                if over > worst.0 + 1e-6 {
                    worst =
                        (over, format!("{} at CL line {}, {}", axis.name, asked.line, asked.kind));
                }
            }
        }
    }
    worst
}

/// The sum of all rotary ways over the blocks of a run, degrees.
fn rotary_way(bench: &Bench, run: &Run) -> f64 {
    let values: Vec<Joints> =
        run.motions().iter().map(|asked| bench.joints(&asked.words)).collect();
    let ways = values.windows(2).map(|pair| {
        let rotary = bench.rotary();
        rotary.iter().map(|place| (pair[1][*place] - pair[0][*place]).abs()).sum::<f64>()
    });
    ways.sum::<f64>().to_degrees()
}

/// A tool axis tilted by so many degrees, leaning to `lean` degrees about Z (0 leans to -Y, as A does).
fn leaning(tilt: f64, lean: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(tilt.to_radians());
    Rotation3::from_axis_angle(&Vector3::z_axis(), lean.to_radians())
        * Vector3::new(0.0, -sine, cosine)
}

/// How far each block of a cut strays from the straight line between its CL points, and the tool axis from the great
/// circle: 20 samples a block, mm and degrees.
fn strays(bench: &Bench, points: &[Point], run: &Run) -> (f64, f64) {
    let (mut worst_tip, mut worst_axis) = (0.0f64, 0.0f64);
    let motions = run.motions();
    let mut index = 0;
    for pair in motions.windows(2) {
        let (from, to): (&Asked, &Asked) = (pair[0], pair[1]);
        while line(index) < to.line {
            index += 1;
        }
        if index == 0 || points[index].rapid {
            continue;
        }
        let (start, target) = (&points[index - 1], &points[index]);
        let along = target.tip - start.tip;
        let length = along.norm();
        let place =
            |tip: Vector3<f64>| ((tip - start.tip).dot(&along) / (length * length)).clamp(0.0, 1.0);
        let (a, b) = (start.axis.normalize(), target.axis.normalize());
        let ends = [0.0, 1.0].map(|t| place(bench.at(&from.words, &to.words, t).0));
        // The place of a block's end on its line is known to the rounding of the words only.
        let blur = (angle(a, b) * 0.001 / length).to_degrees();
        for step in 0..=20 {
            let t = f64::from(step) / 20.0;
            let (tip, axis) = bench.at(&from.words, &to.words, t);
            worst_tip = worst_tip.max(distance(tip, start.tip, target.tip));
            let wanted = slerp(a, b, ends[0] * (1.0 - t) + ends[1] * t);
            worst_axis = worst_axis.max(angle(axis, wanted).to_degrees() - blur);
        }
    }
    (worst_tip, worst_axis)
}

/// What went wrong: tip, axis or a refusal; and travel that was left.
#[derive(Default)]
struct Faults {
    tolerance: Vec<String>,
    travel: Vec<String>,
    /// Rotary ways of paths that need none, degrees.
    needless: Vec<String>,
    runs: usize,
}

fn told(faults: &[String], runs: usize) {
    for fault in faults.iter().take(30) {
        eprintln!("{fault}");
    }
    assert!(faults.is_empty(), "{} faults in {runs} runs", faults.len());
}
