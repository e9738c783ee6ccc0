//! Which of several solutions is taken, over whole paths: against exhaustive search, published examples, and what
//! comes out close to poles and at the end of travel. The printed words are judged by nothing of the crate.

mod common;

use std::f64::consts::{PI, TAU};

use common::posted::{Bench, Point, Run, cl, line, point};
use common::{Rng, angle, distance, slerp, turned};
use nalgebra::{Rotation3, Unit, Vector3};
use post_core::kinematics::{Joints, MAX_AXES, Pose, Solver};
use post_core::machine::{Rule, Side};

/// A machine of a class: chain, rotary axes with their lines, gauge and tool length.
struct Class {
    name: &'static str,
    chain: &'static str,
    second: &'static str,
    direction: &'static str,
    point: &'static str,
    gauge: f64,
    length: f64,
}

const CLASSES: [Class; 4] = [
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
struct Given {
    tcp: &'static str,
    /// Of C; empty for a cyclic one.
    c: String,
    second: [f64; 2],
    feeds: [f64; 5],
    linear: f64,
    accuracy: &'static str,
    /// Further tables: `[solution]`, `[rewind]`.
    more: String,
    decimals: u8,
}

impl Default for Given {
    fn default() -> Self {
        Self {
            tcp: "post",
            c: String::new(),
            second: [-175.0, 175.0],
            feeds: [20_000.0, 20_000.0, 15_000.0, 5400.0, 9000.0],
            linear: 5000.0,
            accuracy: "tolerance = 0.005\naxis_tolerance = 0.05\nrapid_tolerance = 0.5",
            more: String::new(),
            decimals: 3,
        }
    }
}

fn bench(class: &Class, given: &Given) -> Bench {
    let Class {
        name,
        chain,
        second,
        direction,
        point,
        gauge,
        length,
    } = class;
    let Given {
        tcp,
        c,
        second: tilt,
        feeds: [x, y, z, tilting, turning],
        linear,
        accuracy,
        more,
        decimals,
    } = given;
    let c = if c.is_empty() {
        "cyclic = true".to_owned()
    } else {
        format!("travel = {c}")
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
[axis.{second}]
rotary = {direction}
point = {point}
travel = {tilt:?}
max_feed = {tilting}
[axis.X]
linear = [1, 0, 0]
travel = [-{linear}, {linear}]
max_feed = {x}
[axis.Y]
linear = [0, 1, 0]
travel = [-{linear}, {linear}]
max_feed = {y}
[axis.Z]
linear = [0, 0, 1]
travel = [-{linear}, {linear}]
max_feed = {z}
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
        if machine.solution.rule == Rule::Axis(place) {
            named = if axis.joint.rotary { way.to_degrees() } else { way };
        }
        if axis.joint.rotary || linear {
            time += way / axis.max_feed;
        }
    }
    // The time breaks the ties of the other rules.
    match machine.solution.rule {
        Rule::Time => time,
        Rule::Travel => squares.sqrt() + 1e-6 * time,
        Rule::LargestAxis => largest + 1e-6 * time,
        Rule::Axis(_) => named + 1e-6 * time,
    }
}

/// Every value that stands inside travel and on the side that is required.
fn inside(bench: &Bench, joints: &Joints) -> bool {
    let axes = bench.machine.axes.iter().enumerate();
    let travel = axes.clone().all(|(place, axis)| {
        axis.travel.is_none_or(|[least, most]| {
            (least - 1e-9..=most + 1e-9).contains(&joints[place])
        })
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
    let pose = Pose {
        tip: target.tip,
        axis: target.axis.normalize(),
        ..Pose::default()
    };
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

/// The cheapest of all ways through a path, by trying every one.
struct Search<'a> {
    bench: &'a Bench,
    solver: &'a Solver,
    points: &'a [Point],
    stands: Vec<Vec<Joints>>,
    best: f64,
    /// The cheapest if leaving travel between two points counted for nothing.
    careless: f64,
}

impl Search<'_> {
    fn go(&mut self, index: usize, at: &Joints, so_far: f64, left: bool) {
        if so_far >= self.best && (left || so_far >= self.careless) {
            return;
        }
        if index == self.points.len() {
            self.careless = self.careless.min(so_far);
            if !left {
                self.best = self.best.min(so_far);
            }
            return;
        }
        if self.points[index].rapid || index == 0 {
            for next in self.stands[index].clone() {
                let cost = cost(self.bench, at, &next, index > 0);
                self.go(index + 1, &next, so_far + cost, left);
            }
        } else {
            let from = (&self.points[index - 1], at);
            let end = followed(self.bench, self.solver, from, &self.points[index]);
            if let Some((next, leaves)) = end
                && inside(self.bench, &next)
            {
                let cost = cost(self.bench, at, &next, true);
                self.go(index + 1, &next, so_far + cost, left || leaves);
            }
        }
    }
}

/// A short path of cuts and rapids that stays clear of the pole and of the edge of reach.
fn short(rng: &mut Rng, class: &Class) -> Vec<Point> {
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
                    if rng.pick(3) > 0 {
                        Vector3::new(axis.x, axis.y, axis.z.abs())
                    } else {
                        axis
                    }
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

/// What post chose costs what the cheapest of all ways costs; it refuses where there is none; travel is never left.
#[test]
fn the_choice_costs_no_more_than_the_cheapest_of_all_ways() {
    let mut rng = Rng(31);
    let (mut chosen, mut refused, mut careless, mut states) = (0, 0, 0, 0);
    let mut worst = 0.0f64;
    let mut faults: Vec<String> = Vec::new();
    for class in &CLASSES {
        for rule in ["time", "travel", "largest-axis", "axis:C", "axis:second", "axis:X"] {
            for round in 0..60 {
                let tilt = match rng.pick(3) {
                    0 => [-175.0, 175.0],
                    1 => [-rng.range(20.0, 120.0), rng.range(20.0, 120.0)].map(f64::round),
                    _ => [-rng.range(0.0, 30.0), rng.range(60.0, 200.0)].map(f64::round),
                };
                let c = turns(&mut rng);
                let start = [
                    rng.range(c[0], c[1]).round(),
                    rng.range(tilt[0], tilt[1]).round(),
                ];
                let require = match rng.pick(6) {
                    0 => format!("require = {{ {} = \"negative\" }}\n", class.second),
                    1 => "require = { C = \"positive\" }\n".to_owned(),
                    _ => String::new(),
                };
                let given = Given {
                    c: format!("{c:?}"),
                    second: tilt,
                    feeds: std::array::from_fn(|_| rng.range(2000.0, 20_000.0).round()),
                    linear: if rng.pick(4) == 0 { 700.0 } else { 5000.0 },
                    accuracy: "tolerance = 0.05\naxis_tolerance = 0.05\nrapid_tolerance = 1000000",
                    more: format!(
                        "[solution]\nrule = \"{}\"\nstart = {{ C = {}, {} = {} }}\n{require}",
                        rule.replace("second", class.second),
                        start[0],
                        class.second,
                        start[1]
                    ),
                    decimals: 7,
                    ..Given::default()
                };
                let bench = bench(class, &given);
                let points = short(&mut rng, class);
                let solver = bench.machine.solver(class.length).expect("a closed form");
                let mut search = Search {
                    bench: &bench,
                    solver: &solver,
                    points: &points,
                    stands: points
                        .iter()
                        .map(|point| stands(&bench, &solver, point))
                        .collect(),
                    best: f64::INFINITY,
                    careless: f64::INFINITY,
                };
                states += search.stands.iter().map(Vec::len).sum::<usize>();
                search.go(0, &bench.machine.solution.start, 0.0, false);
                let best = search.best;
                let text = cl(&points, 1000.0);
                let run = bench.run(&text);
                let what = format!("{}, {rule}, round {round}", class.name);
                let crossing = search.careless < best * (1.0 - 1e-9);
                careless += usize::from(crossing);
                let mut fault = |text: String| {
                    faults.push(format!("{what}{}: {text}", if crossing { " (between points)" } else { "" }));
                };
                if run.report.is_none() {
                    refused += 1;
                    if best.is_finite() {
                        fault(format!("refused, and there is a way of cost {best}: {}\n{text}{given_text}", run.told(), given_text = given.more));
                    }
                    continue;
                }
                chosen += 1;
                let mut at = bench.machine.solution.start;
                let mut sum = 0.0;
                for index in 0..points.len() {
                    let words = run.arrival(line(index)).expect("a position");
                    let next = bench.joints(words);
                    sum += cost(&bench, &at, &next, index > 0);
                    at = next;
                }
                for asked in run.motions() {
                    let joints = bench.joints(&asked.words);
                    let axes = bench.machine.axes.iter().enumerate();
                    for (place, axis) in axes {
                        let [least, most] = axis.travel.expect("travel");
                        assert!(
                            (least - 1e-6..=most + 1e-6).contains(&joints[place]),
                            "{what}: {} stands at {}",
                            axis.name,
                            joints[place]
                        );
                    }
                }
                if best.is_infinite() {
                    fault(format!("chosen at a cost of {sum}, and there is no way"));
                    continue;
                }
                worst = worst.max((sum - best).abs() / best);
                if (sum - best).abs() > 1e-6 * best {
                    fault(format!("costs {sum}, the cheapest way {best}"));
                }
            }
        }
    }
    println!(
        "{chosen} paths chosen, {refused} refused, {careless} with a cheaper way that leaves travel between two points; {states} states; costs differ by {worst:.1e} at most"
    );
    for fault in faults.iter().take(8) {
        println!("{fault}");
    }
    assert!(faults.is_empty(), "{} faults", faults.len());
    assert!(chosen > 400 && refused > 100);
}
