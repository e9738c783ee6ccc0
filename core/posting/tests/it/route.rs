//! Which of several solutions is taken, over whole paths: against exhaustive search, published examples, and what
//! comes out close to poles and at the end of travel. The printed words are judged by nothing of the crate.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};
use post_machine::description::{Rule, Side};
use post_machine::kinematics::{Joints, Pose, Solver};
use post_plugin::Feed;
use post_testkit::posted::Asked;
use post_testkit::posted::{Bench, Point, Run, cl, line, point};
use post_testkit::{Rng, across, angle, distance, randomised, repository, slerp, turned};

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
            linear: 5000.0,
            accuracy: "tolerance = 0.005\naxis_tolerance = 0.05\nrapid_tolerance = 0.5",
            more: String::new(),
            decimals: 3,
        }
    }
}

fn bench(class: &Class<'_>, given: &Given<'_>) -> Bench {
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
            named = if axis.joint.rotary {
                way.to_degrees()
            } else {
                way
            };
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
                let cost =
                    cost(self.bench, at, &next, index > 0) + AGAINST * against(self.bench, &next);
                self.go(index + 1, &next, so_far + cost, left);
            }
        } else {
            let from = (&self.points[index - 1], at);
            let end = followed(self.bench, self.solver, from, &self.points[index]);
            if let Some((next, leaves)) = end
                && inside(self.bench, &next)
            {
                let cost = cost(self.bench, at, &next, true) + AGAINST * against(self.bench, &next);
                self.go(index + 1, &next, so_far + cost, left || leaves);
            }
        }
    }
}

/// A short path of cuts and rapids that stays clear of the pole and of the edge of reach.
fn short(rng: &mut Rng, class: &Class<'_>) -> Vec<Point> {
    let clear = |axis: Vector3<f64>| {
        let tilt = angle(axis, Vector3::z()).to_degrees();
        let most = if class.name == "nutating head" {
            80.0
        } else {
            150.0
        };
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
    exhaustive(31, false);
}

/// The same where sides are preferred: as few points as may be stand against them, and of those ways the cheapest.
#[test]
fn with_preferred_sides_the_choice_is_the_cheapest_too() {
    exhaustive(32, true);
}

/// How many preferred sides a way of standing goes against.
fn against(bench: &Bench, joints: &Joints) -> f64 {
    let prefer = bench.machine.solution.prefer.iter();
    let wrong = prefer.filter(|(place, side)| match side {
        Side::Positive => joints[*place] < -1e-6,
        Side::Negative => joints[*place] > 1e-6,
    });
    wrong.count() as f64
}

/// More than any travel costs.
const AGAINST: f64 = 1e6;

fn exhaustive(seed: u64, sides: bool) {
    let (rounds, mut rng) = randomised(60, seed);
    let (mut chosen, mut refused, mut careless, mut states) = (0, 0, 0, 0);
    let mut worst = 0.0f64;
    let mut faults: Vec<String> = Vec::new();
    for class in &CLASSES {
        for rule in [
            "time",
            "travel",
            "largest-axis",
            "axis:C",
            "axis:second",
            "axis:X",
        ] {
            for round in rounds.clone() {
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
                let prefer = match rng.pick(3) {
                    _ if !sides => String::new(),
                    0 => format!("prefer = {{ {} = \"negative\" }}\n", class.second),
                    1 => format!("prefer = {{ {} = \"positive\" }}\n", class.second),
                    _ => format!(
                        "prefer = {{ C = \"negative\", {} = \"positive\" }}\n",
                        class.second
                    ),
                };
                let given = Given {
                    tcp: ["post", "control"][rng.pick(2)],
                    c: format!("{c:?}"),
                    second: tilt,
                    feeds: std::array::from_fn(|_| rng.range(2000.0, 20_000.0).round()),
                    linear: if rng.pick(4) == 0 { 700.0 } else { 5000.0 },
                    accuracy: "tolerance = 0.05\naxis_tolerance = 0.05\nrapid_tolerance = 1000000",
                    more: format!(
                        "[solution]\nrule = \"{}\"\nstart = {{ C = {}, {} = {} }}\n{require}{prefer}",
                        rule.replace("second", class.second),
                        start[0],
                        class.second,
                        start[1]
                    ),
                    decimals: 7,
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
                    faults.push(format!(
                        "{what}{}: {text}",
                        if crossing { " (between points)" } else { "" }
                    ));
                };
                if run.report.is_none() {
                    refused += 1;
                    if best.is_finite() {
                        fault(format!(
                            "refused, and there is a way of cost {best}: {}\n{text}{given_text}",
                            run.told(),
                            given_text = given.more
                        ));
                    }
                    continue;
                }
                chosen += 1;
                let mut at = bench.machine.solution.start;
                let mut sum = 0.0;
                for index in 0..points.len() {
                    let words = run.arrival(line(index)).expect("a position");
                    let next = bench.joints(words);
                    sum += cost(&bench, &at, &next, index > 0) + AGAINST * against(&bench, &next);
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
                let rest = best % AGAINST;
                worst = worst.max((sum - best).abs() / rest);
                if (sum - best).abs() > 1e-6 * rest + 1e-9 {
                    fault(format!("costs {sum}, the cheapest way {best}"));
                }
            }
        }
    }
    eprintln!(
        "{chosen} paths chosen, {refused} refused, {careless} with a cheaper way that leaves travel between two points; {states} states; costs differ by {worst:.1e} at most"
    );
    for fault in faults.iter().take(8) {
        eprintln!("{fault}");
    }
    assert!(faults.is_empty(), "{} faults", faults.len());
    assert!(chosen > 400 && refused > 100);
}

/// The rotary values, degrees, at which a CL line is arrived at: C and the other axis.
fn angles(bench: &Bench, run: &Run, line: u64) -> [f64; 2] {
    let joints = bench.joints(run.arrival(line).expect("a position"));
    let c = bench.place("C");
    let other = bench.rotary().into_iter().find(|place| *place != c);
    [joints[c], joints[other.expect("another axis")]].map(f64::to_degrees)
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
                    worst = (
                        over,
                        format!("{} at CL line {}, {}", axis.name, asked.line, asked.kind),
                    );
                }
            }
        }
    }
    worst
}

/// The sum of all rotary ways over the blocks of a run, degrees.
fn rotary_way(bench: &Bench, run: &Run) -> f64 {
    let values: Vec<Joints> = run
        .motions()
        .iter()
        .map(|asked| bench.joints(&asked.words))
        .collect();
    let ways = values.windows(2).map(|pair| {
        let rotary = bench.rotary();
        rotary
            .iter()
            .map(|place| (pair[1][*place] - pair[0][*place]).abs())
            .sum::<f64>()
    });
    ways.sum::<f64>().to_degrees()
}

fn close(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 2e-3)
}

/// PostWorks' published example: the rotary axes may move by (50, 90) or by (110, 0) degrees; root of squares,
/// largest axis, sum and one named axis choose the sets 1, 1, 2, 2.
#[test]
fn the_four_measures_choose_as_published() {
    // A head inclined so that B 45 and B -45 lay the tool 160° apart about C.
    let (tan_10, tan_22) = (
        libm::tan(10f64.to_radians()),
        libm::tan(22.5f64.to_radians()),
    );
    let tilt = libm::acos(tan_10 / tan_22);
    let direction = format!("[0, {}, {}]", libm::sin(tilt), libm::cos(tilt));
    let class = Class {
        direction: &direction,
        ..CLASSES[3]
    };
    for (rule, set) in [
        ("travel", 1),
        ("largest-axis", 1),
        ("time", 2),
        ("axis:B", 2),
    ] {
        let given = Given {
            feeds: [10_000.0; 5],
            more: format!("[solution]\nrule = \"{rule}\"\nstart = {{ C = 20, B = -45 }}"),
            ..Given::default()
        };
        let bench = bench(&class, &given);
        // Where the machine points with C 70 and B 45, which C -90 and B -45 do as well.
        let mut joints = Joints::default();
        joints[bench.place("C")] = 70f64.to_radians();
        joints[bench.place("B")] = 45f64.to_radians();
        let axis = bench.reference.forward(&joints).1;
        let run = bench.run(&cl(&[point(Vector3::zeros(), axis, true)], 1000.0));
        let run = run.good(rule);
        let stands = angles(&bench, &run, line(0));
        let moves = [stands[0] - 20.0, stands[1] + 45.0];
        let expected = if set == 1 {
            [50.0, 90.0]
        } else {
            [-110.0, 0.0]
        };
        assert!(close(moves, expected), "{rule}: moves by {moves:?}");
    }
}

/// Heidenhain's table for PLANE SPATIAL with SPB+45 on a machine with A and C, from A0 C0.
#[test]
fn sides_are_chosen_as_heidenhain_s_table_has_it() {
    let tool = Rotation3::from_axis_angle(&Vector3::y_axis(), 45f64.to_radians()) * Vector3::z();
    let table = [
        ("", [-120.0, 120.0], Some([90.0, 45.0])),
        (
            "prefer = { A = \"positive\" }",
            [-120.0, 120.0],
            Some([90.0, 45.0]),
        ),
        (
            "prefer = { A = \"negative\" }",
            [-120.0, 120.0],
            Some([-90.0, -45.0]),
        ),
        (
            "require = { A = \"negative\" }",
            [-120.0, 120.0],
            Some([-90.0, -45.0]),
        ),
        (
            "require = { A = \"positive\" }",
            [-120.0, 120.0],
            Some([90.0, 45.0]),
        ),
        ("", [-90.0, 10.0], Some([-90.0, -45.0])),
        (
            "prefer = { A = \"positive\" }",
            [-90.0, 10.0],
            Some([-90.0, -45.0]),
        ),
        ("require = { A = \"positive\" }", [-90.0, 10.0], None),
    ];
    for (side, travel, expected) in table {
        for rule in ["time", "travel", "largest-axis", "axis:C"] {
            let given = Given {
                second: travel,
                more: format!("[solution]\nrule = \"{rule}\"\n{side}"),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let run = bench.run(&cl(&[point(Vector3::zeros(), tool, true)], 1000.0));
            match expected {
                Some(expected) => {
                    let run = run.good(side);
                    let stands = angles(&bench, &run, line(0));
                    assert!(
                        close(stands, expected),
                        "{side} {travel:?} {rule}: {stands:?}"
                    );
                }
                None => {
                    assert!(run.report.is_none());
                    assert_eq!(run.findings[0].code, "over-travel", "{}", run.told());
                }
            }
        }
    }
}

/// A tool axis tilted by so many degrees, leaning to `lean` degrees about Z (0 leans to -Y, as A does).
fn leaning(tilt: f64, lean: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(tilt.to_radians());
    Rotation3::from_axis_angle(&Vector3::z_axis(), lean.to_radians())
        * Vector3::new(0.0, -sine, cosine)
}

/// A preferred side is taken off the part where travel lets it be, at any cost, and never in a cut.
#[test]
fn a_preferred_side_is_soft() {
    let points = [
        point(Vector3::zeros(), leaning(45.0, 0.0), true),
        point(Vector3::new(10.0, 0.0, 0.0), leaning(20.0, 0.0), false),
        point(Vector3::new(20.0, 0.0, 0.0), leaning(20.0, 0.0), false),
        point(Vector3::new(20.0, 0.0, 50.0), leaning(20.0, 0.0), true),
        point(Vector3::new(30.0, 0.0, 0.0), leaning(25.0, 0.0), false),
    ];
    // At 45° the negative side is outside travel; at 20° it is not, but only the rapid may change to it.
    let given = Given {
        second: [-30.0, 120.0],
        more: "[solution]\nprefer = { A = \"negative\" }".to_owned(),
        ..Given::default()
    };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&points, 1000.0)).good("prefer");
    let tilts: Vec<f64> = (0..5)
        .map(|index| angles(&bench, &run, line(index))[1])
        .collect();
    for (tilt, expected) in tilts.iter().zip([45.0, 20.0, 20.0, -20.0, -25.0]) {
        assert!((tilt - expected).abs() < 2e-3, "{tilts:?}");
    }
    assert_eq!(run.report.expect("a report").branch_changes, 1);
    // Required, there is no way.
    let given = Given {
        second: [-30.0, 120.0],
        more: "[solution]\nrequire = { A = \"negative\" }".to_owned(),
        ..Given::default()
    };
    let refused = self::bench(&CLASSES[0], &given).run(&cl(&points, 1000.0));
    assert!(refused.report.is_none());
    assert_eq!(
        refused.findings[0].code,
        "over-travel",
        "{}",
        refused.told()
    );
}

/// The axes go to the solution nearest to where they start, on the turn where they start.
#[test]
fn a_start_is_gone_on_from() {
    let axis = leaning(30.0, 0.0);
    for (start, expected) in [
        ("C = 0, A = 0", [0.0, 30.0]),
        ("C = 0, A = 30", [0.0, 30.0]),
        ("C = 120, A = -60", [180.0, -30.0]),
        ("C = 170, A = 0", [180.0, -30.0]),
        ("C = 300, A = 10", [360.0, 30.0]),
        ("C = 720, A = 10", [720.0, 30.0]),
        ("C = -200, A = -10", [-180.0, -30.0]),
    ] {
        let given = Given {
            feeds: [10_000.0; 5],
            more: format!("[solution]\nstart = {{ {start} }}"),
            ..Given::default()
        };
        let bench = bench(&CLASSES[0], &given);
        let run = bench.run(&cl(&[point(Vector3::zeros(), axis, true)], 1000.0));
        let stands = angles(&bench, &run.good(start), line(0));
        assert!(close(stands, expected), "{start}: {stands:?}");
    }
}

/// With `look_ahead = 1` the nearest solution is taken each time: it may turn more in the end, and may come to where
/// it cannot go on, where looking ahead finds the way.
#[test]
fn looking_ahead_is_better_than_taking_the_nearest() {
    // The second tilt is possible on one side of A alone.
    let mut points = vec![point(Vector3::zeros(), leaning(45.0, 85.0), true)];
    for step in 1..=6 {
        let x = 5.0 * f64::from(step);
        points.push(point(
            Vector3::new(x, 0.0, 0.0),
            leaning(45.0, 85.0 + f64::from(step)),
            false,
        ));
    }
    points.push(point(
        Vector3::new(30.0, 0.0, 80.0),
        leaning(70.0, 91.0),
        true,
    ));
    points.push(point(
        Vector3::new(40.0, 0.0, 0.0),
        leaning(72.0, 91.0),
        false,
    ));
    let way = |look_ahead: u32, second: [f64; 2], points: &[Point]| {
        let given = Given {
            second,
            more: format!("[solution]\nlook_ahead = {look_ahead}"),
            ..Given::default()
        };
        let bench = bench(&CLASSES[0], &given);
        let run = bench.run(&cl(points, 1000.0));
        let way = run.report.as_ref().map(|_| rotary_way(&bench, &run));
        (way, run)
    };
    let (greedy, run) = way(1, [-120.0, 50.0], &points);
    assert_eq!(
        run.good("greedy").report.expect("a report").branch_changes,
        1
    );
    let (ahead, run) = way(2000, [-120.0, 50.0], &points);
    assert_eq!(
        run.good("ahead").report.expect("a report").branch_changes,
        0
    );
    let (greedy, ahead) = (greedy.expect("a way"), ahead.expect("a way"));
    println!("rotary way: {greedy:.1}° taking the nearest, {ahead:.1}° looking ahead");
    assert!(ahead < 40.0 && greedy > 250.0, "{greedy} {ahead}");

    // The same in one cut: the nearest side of A ends at 50°.
    let cut: Vec<Point> = points
        .iter()
        .enumerate()
        .map(|(index, old)| point(old.tip, old.axis, index == 0))
        .collect();
    let (greedy, run) = way(1, [-120.0, 50.0], &cut);
    assert!(greedy.is_none());
    assert_eq!(run.findings[0].code, "jump", "{}", run.told());
    assert!(way(2000, [-120.0, 50.0], &cut).0.is_some());
}

/// The sample of an ultrasonic knife on the trunnion table: refused taking the nearest, posted looking ahead.
#[test]
fn the_knife_is_posted_looking_ahead() {
    let read = |path: &str| {
        std::fs::read_to_string(repository().join(path)).expect("a file of the repository")
    };
    let (machine, text) = (
        read("machines/ac-trunnion.toml"),
        read("tests/samples/knife.ncl"),
    );
    for (look_ahead, possible) in [(1, false), (50, true), (2000, true)] {
        let machine = format!("{machine}\n[solution]\nlook_ahead = {look_ahead}\n");
        let bench = Bench::new(&machine, 3, 0.0);
        let run = bench.run(&text);
        assert_eq!(
            run.report.is_some(),
            possible,
            "{look_ahead}: {}",
            run.told()
        );
        if let Some(report) = &run.report {
            println!(
                "knife, look_ahead {look_ahead}: {} blocks, rotary way {:.0}°, {} branch changes",
                report.blocks,
                rotary_way(&bench, &run),
                report.branch_changes
            );
        } else {
            assert_eq!(run.findings[0].code, "jump", "{}", run.told());
        }
    }
}

/// A tool that leans by `tilt` degrees and goes round once every 360 steps of a degree, from `from` to `to` degrees.
fn orbit(tilt: f64, from: i32, to: i32, rapid: impl Fn(i32) -> bool) -> Vec<Point> {
    (from..=to)
        .map(|step| {
            let lean = f64::from(step);
            let (sine, cosine) = libm::sincos(lean.to_radians());
            let tip = Vector3::new(60.0 * cosine, 60.0 * sine, 0.05 * lean);
            point(tip, leaning(tilt, lean), rapid(step))
        })
        .collect()
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

/// C would pass its travel: off the part it is turned back.
#[test]
fn a_rapid_turns_the_axis_back() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: "[-200, 400]".to_owned(),
                // One side of the tilting axis alone.
                second: [-1.0, 120.0],
                ..Given::default()
            };
            let bench = bench(class, &given);
            // Off the part between 300° and 305°, and on round to 700°.
            let points = orbit(30.0, 0, 700, |step| {
                step == 0 || (300..=305).contains(&step)
            });
            let what = format!("{}, {tcp}", class.name);
            let run = bench.run(&cl(&points, 1000.0)).good(&what);
            let report = run.report.as_ref().expect("a report");
            assert_eq!((report.branch_changes, report.rewinds), (1, 0), "{what}");
            let (tip, axis) = strays(&bench, &points, &run);
            assert!(
                tip < 0.005 + 1e-9 && axis < 0.05 + 1e-9,
                "{what}: {tip} {axis}"
            );
            let c: Vec<f64> = run
                .motions()
                .iter()
                .map(|asked| bench.joints(&asked.words)[bench.place("C")].to_degrees())
                .collect();
            assert!(c.iter().all(|c| (-200.0..=400.0).contains(c)), "{what}");
            // The large turn is made in rapids alone.
            for (pair, c) in run.motions().windows(2).zip(c.windows(2)) {
                assert!(
                    pair[1].kind == "Rapid" || (c[1] - c[0]).abs() < 10.0,
                    "{what}"
                );
            }
        }
    }
}

/// A turn off the part leaves the travel of no axis on its way.
#[test]
fn a_rapid_turn_stays_inside_travel() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: "[-200, 400]".to_owned(),
                second: [-1.0, 120.0],
                ..Given::default()
            };
            let bench = bench(class, &given);
            let points = orbit(30.0, 0, 700, |step| {
                step == 0 || (300..=305).contains(&step)
            });
            let run = bench.run(&cl(&points, 1000.0)).good(class.name);
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{}, {tcp}: {axis} by {over}", class.name);
        }
    }
}

/// A long cut without a rapid is refused without `[rewind]`, and the refusal says what was tried.
#[test]
fn without_a_rewind_the_cut_is_refused_and_says_why() {
    for class in &CLASSES {
        let given = Given {
            c: "[-200, 400]".to_owned(),
            second: [-1.0, 120.0],
            ..Given::default()
        };
        let bench = bench(class, &given);
        let points = orbit(30.0, 0, 700, |step| step == 0);
        let run = bench.run(&cl(&points, 1000.0));
        assert!(run.report.is_none());
        let finding = &run.findings[0];
        let told = format!("{}: {}", class.name, finding.message);
        assert_eq!(finding.code, "jump", "{told}");
        // How far C is ahead of the lean.
        let solver = bench.machine.solver(class.length).expect("a form");
        let begin = stands(&bench, &solver, &points[0]);
        let ahead = begin[0][bench.place("C")].to_degrees();
        let place = finding.place.as_ref().expect("a place");
        let index = ((place.line - line(0)) / 2) as usize;
        assert_eq!(place.line, line(index));
        let passes = libm::remainder(ahead + index as f64 - 401.0, 360.0);
        assert!(
            passes.abs() < 1.0,
            "{told}: at point {index}, C ahead by {ahead}"
        );
        for word in [
            "C to 40",
            "travel -200.000° to 400.000°",
            "cannot go on from",
        ] {
            assert!(told.contains(word), "{told}");
        }
        assert!(told.contains(class.second), "{told}");
        assert!(
            finding
                .help
                .as_ref()
                .is_some_and(|help| help.contains("[rewind]"))
        );
    }
}

/// One cause, one error: behind it the path goes on as if it began there.
#[test]
fn a_refused_cut_is_told_once() {
    let given = Given {
        c: "[-200, 400]".to_owned(),
        second: [-1.0, 120.0],
        ..Given::default()
    };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&orbit(30.0, 0, 700, |step| step == 0), 1000.0));
    assert_eq!(run.findings.len(), 1, "{}", run.told());
}

/// A block's time as its control understands it, minutes; none at rapid.
fn minutes(bench: &Bench, from: &Asked, to: &Asked) -> Option<f64> {
    let way = |linear: bool| {
        let steps = bench.order.iter().enumerate();
        steps
            .filter(|(_, place)| bench.reference.joints[**place].rotary != linear)
            .map(|(word, _)| (to.words[word] - from.words[word]).abs())
            .fold(0.0, |sum: f64, step| libm::hypot(sum, step))
    };
    match to.feed? {
        Feed::InverseTime(feed) => Some(1.0 / feed),
        Feed::PerMinute(feed) if way(true) > 1e-9 => Some(way(true) / feed),
        Feed::PerMinute(feed) => Some(way(false) / feed),
        Feed::PerRevolution(_) => None,
    }
}

/// With `[rewind]` the tool is drawn back along its axis, turned with its tip held, and brought back to where it was.
#[test]
fn a_rewind_draws_back_turns_and_returns() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            for (retract, plane) in [("distance = 25", None), ("plane = 90", Some(90.0))] {
                for feeds in [
                    "",
                    "retract_feed = 4000\nturn_feed = 1800\nplunge_feed = 300",
                ] {
                    let given = Given {
                        tcp,
                        c: "[-200, 400]".to_owned(),
                        second: [-1.0, 120.0],
                        more: format!("[rewind]\n{retract}\n{feeds}"),
                        ..Given::default()
                    };
                    let bench = bench(class, &given);
                    let points = orbit(30.0, 0, 700, |step| step == 0);
                    let what = format!("{}, {tcp}, {retract}, {feeds}", class.name);
                    let run = bench.run(&cl(&points, 1000.0)).good(&what);
                    let report = run.report.as_ref().expect("a report");
                    assert_eq!(report.rewinds, 1, "{what}");
                    let turning = rewound(&what, &bench, &points, &run, plane, !feeds.is_empty());
                    let (over, axis) = left_travel(&bench, &run);
                    println!(
                        "    turned at {turning:.0} degrees a minute; outside travel by {over:.3} {axis}"
                    );
                }
            }
        }
    }
}

/// The run of one machine that rewinds.
fn rewinding(class: &Class<'_>, tcp: &str, rewind: &str) -> (Bench, Vec<Point>, Run) {
    let given = Given {
        tcp,
        c: "[-200, 400]".to_owned(),
        second: [-1.0, 120.0],
        more: format!("[rewind]\n{rewind}"),
        ..Given::default()
    };
    let bench = bench(class, &given);
    let points = orbit(30.0, 0, 700, |step| step == 0);
    let run = bench.run(&cl(&points, 1000.0)).good(class.name);
    (bench, points, run)
}

/// While it is turned, no axis leaves its travel.
#[test]
fn a_rewind_stays_inside_travel() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let (bench, _, run) = rewinding(class, tcp, "distance = 25");
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{}, {tcp}: {axis} by {over}", class.name);
        }
    }
}

/// It is turned as fast as the machine file says.
#[test]
fn a_rewind_turns_at_its_feed() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let rewind = "distance = 25\nretract_feed = 4000\nturn_feed = 1800\nplunge_feed = 300";
            let (bench, points, run) = rewinding(class, tcp, rewind);
            let feed = rewound(class.name, &bench, &points, &run, None, true);
            assert!(
                (1700.0..1810.0).contains(&feed),
                "{}, {tcp}: {feed}",
                class.name
            );
        }
    }
}

/// Checks the blocks of the only rewind of a run; gives the feed of the turn, degrees a minute.
fn rewound(
    what: &str,
    bench: &Bench,
    points: &[Point],
    run: &Run,
    plane: Option<f64>,
    feeds: bool,
) -> f64 {
    let motions = run.motions();
    let rotary = |words: &[f64]| -> Vec<f64> {
        let joints = bench.joints(words);
        bench
            .rotary()
            .iter()
            .map(|place| joints[*place].to_degrees())
            .collect()
    };
    let turn = |from: &[f64], to: &[f64]| -> f64 {
        let (from, to) = (rotary(from), rotary(to));
        from.iter().zip(&to).map(|(a, b)| (a - b).abs()).sum()
    };
    // Its blocks belong to the point where it begins and ends: the tip comes there, leaves it, and comes back.
    let index = (0..points.len())
        .find(|index| {
            let blocks = motions.iter().filter(|asked| asked.line == line(*index));
            blocks.clone().any(|asked| {
                (bench.at(&asked.words, &asked.words, 0.0).0 - points[*index].tip).norm() > 10.0
            })
        })
        .unwrap_or_else(|| panic!("{what}: no rewind"));
    let (tip, axis) = (points[index].tip, points[index].axis.normalize());
    let blocks: Vec<usize> = (0..motions.len())
        .filter(|place| motions[*place].line == line(index))
        .collect();
    let at = |place: usize| bench.at(&motions[place].words, &motions[place].words, 0.0);
    let first = blocks
        .iter()
        .copied()
        .find(|place| (at(*place).0 - tip).norm() > 10.0)
        .expect("the way out");
    let begin = first - 1;
    assert!(
        (at(begin).0 - tip).norm() < 0.002,
        "{what}: it does not begin at the point"
    );
    let last = *blocks.last().expect("blocks");
    assert!(
        (at(last).0 - tip).norm() < 0.002,
        "{what}: it does not end at the point"
    );
    assert!(angle(at(last).1, axis).to_degrees() < 0.05, "{what}");
    // As far as it is drawn back.
    let away = match plane {
        None => tip + axis * 25.0,
        Some(height) => tip + axis * ((height - tip.z) / axis.z),
    };
    // Out, turn and back, told apart by where their blocks end.
    let turned: Vec<usize> = (first..=last)
        .filter(|place| turn(&motions[*place - 1].words, &motions[*place].words) > 1e-3)
        .collect();
    let (turn_first, turn_last) = (turned[0], turned[turned.len() - 1]);
    assert!(turn_first > first, "{what}: it turns on its way out");
    assert!(turn_last < last, "{what}: it turns on its way back");
    assert!(
        (at(turn_first - 1).0 - away).norm() < 0.002,
        "{what}: {:?} {away:?}",
        at(turn_first - 1)
    );
    let whole = turn(&motions[begin].words, &motions[last].words);
    assert!((whole - 360.0).abs() < 0.01, "{what}: turned by {whole}");
    let mut time = [0.0f64; 3];
    let mut way = [0.0f64; 3];
    let mut lowest = f64::INFINITY;
    let mut strayed = [0.0f64; 3];
    for place in first..=last {
        let (from, to) = (motions[place - 1], motions[place]);
        let stage = if place < turn_first {
            0
        } else {
            usize::from(place > turn_last) + 1
        };
        assert_eq!(
            to.kind,
            if feeds || stage == 2 {
                "Linear"
            } else {
                "Rapid"
            },
            "{what} stage {stage}"
        );
        time[stage] += minutes(bench, from, to).unwrap_or(0.0);
        way[stage] += (at(place).0 - at(place - 1).0).norm();
        for step in 0..=20 {
            let (reached, _) = bench.at(&from.words, &to.words, f64::from(step) / 20.0);
            lowest = lowest.min((reached - tip).dot(&axis));
            let off = match stage {
                1 => (reached - away).norm(),
                _ => distance(reached, tip, away),
            };
            strayed[stage] = strayed[stage].max(off);
        }
    }
    assert!(
        lowest > -0.002,
        "{what}: the tip goes below its start by {lowest}"
    );
    // Off the part the tolerance of a rapid will do; back it comes as a cut does.
    assert!(
        strayed[0] < 0.5 + 1e-6 && strayed[1] < 0.5 + 1e-6,
        "{what}: {strayed:?}"
    );
    assert!(strayed[2] < 0.005 + 1e-6, "{what}: {strayed:?}");
    way[1] = whole;
    let feed = [0, 1, 2].map(|stage| way[stage] / time[stage]);
    eprintln!(
        "{what}: {} blocks, strays {strayed:.3?} mm, feeds {feed:.0?}",
        last - begin
    );
    let asked = if feeds {
        [4000.0, f64::INFINITY, 300.0]
    } else {
        [f64::INFINITY, f64::INFINITY, 1000.0]
    };
    for stage in [0, 2] {
        if asked[stage] < f64::INFINITY {
            assert!(
                feed[stage] < 1.01 * asked[stage] && feed[stage] > 0.98 * asked[stage],
                "{what}: feed {} of stage {stage}, asked {}",
                feed[stage],
                asked[stage]
            );
        }
    }
    feed[1]
}

/// Points along a great circle that passes the pole at `beside` degrees, from 5° before to 5° behind it.
fn pass(beside: f64, count: usize) -> Vec<Point> {
    (0..=count)
        .map(|index| {
            let s = -1.0 + 2.0 * index as f64 / count as f64;
            let axis = Vector3::new(
                libm::tan((5.0 * s).to_radians()),
                libm::tan(beside.to_radians()),
                1.0,
            );
            // No axis of the machine lies along the path.
            let axis = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7) * axis;
            let tip = Vector3::new(40.0 * s, 10.0, 5.0 * s * s);
            point(tip, axis.normalize(), index == 0)
        })
        .collect()
}

/// Points of a circle about the pole at a distance of `beside` degrees.
fn circle(beside: f64, count: usize) -> Vec<Point> {
    (0..=count)
        .map(|index| {
            let lean = 360.0 * index as f64 / count as f64 + 40.0;
            let (sine, cosine) = libm::sincos(lean.to_radians());
            let tip = Vector3::new(20.0 * cosine, 20.0 * sine, 0.0);
            point(tip, leaning(beside, lean), index == 0)
        })
        .collect()
}

/// What came of a path close to the pole.
struct Outcome {
    way: f64,
    time: f64,
    axis: f64,
    tip: f64,
    blocks: u64,
    eased: u64,
    over: (f64, String),
}

fn outcome(
    class: &Class<'_>,
    tcp: &str,
    second: [f64; 2],
    solution: &str,
    points: &[Point],
) -> Result<Outcome, String> {
    let given = Given {
        tcp,
        second,
        more: format!("[solution]\n{solution}"),
        ..Given::default()
    };
    let bench = bench(class, &given);
    let run = bench.run(&cl(points, 1000.0));
    let Some(report) = &run.report else {
        return Err(run.told());
    };
    let (tip, axis) = strays(&bench, points, &run);
    Ok(Outcome {
        way: rotary_way(&bench, &run),
        time: report.time_s,
        axis: axis.max(report.axis_deviation_deg.value),
        tip: tip.max(report.tip_deviation_mm.value),
        blocks: report.blocks,
        eased: report.points_eased,
        over: left_travel(&bench, &run),
    })
}

const BLEND: &str = "pole = \"blend\"";
const EXACT: &str = "pole = \"exact\"";
const GREEDY: &str = "pole = \"exact\"\nlook_ahead = 1";

/// Through the pole, beside it and round it: what blending costs and saves against meeting every point exactly and
/// against taking the nearest solution each time. Prints the table of the README.
#[test]
fn close_to_the_pole_axes_are_spared_within_tolerance() {
    let mut paths: Vec<(String, f64, Vec<Point>)> = Vec::new();
    for beside in [0.0, 0.01, 0.1, 1.0] {
        for (grain, count) in [("coarse", 5), ("fine", 200)] {
            let name = if beside == 0.0 {
                "through".to_owned()
            } else {
                format!("at {beside}°")
            };
            paths.push((format!("{name}, {grain}"), beside, pass(beside, count)));
        }
    }
    for beside in [0.01, 0.1] {
        for (grain, count) in [("coarse", 12), ("fine", 180)] {
            paths.push((
                format!("round at {beside}°, {grain}"),
                beside,
                circle(beside, count),
            ));
        }
    }
    let mut faults = Vec::new();
    println!(
        "| machine | tcp | path | rotary travel: blend, exact, greedy (°) | time (s) | axis off (°) | blocks | eased |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for class in [&CLASSES[0], &CLASSES[2], &CLASSES[3]] {
        for tcp in ["post", "control"] {
            for (name, beside, points) in &paths {
                let what = format!("{}, {tcp}, {name}", class.name);
                let results = [BLEND, EXACT, GREEDY]
                    .map(|solution| outcome(class, tcp, [-175.0, 175.0], solution, points));
                let column = |number: &dyn Fn(&Outcome) -> String| {
                    results
                        .iter()
                        .map(|result| result.as_ref().map_or("—".to_owned(), number))
                        .collect::<Vec<_>>()
                        .join(", ")
                };
                println!(
                    "| {} | {tcp} | {name} | {} | {} | {} | {} | {} |",
                    class.name,
                    column(&|outcome| format!("{:.1}", outcome.way)),
                    column(&|outcome| format!("{:.2}", outcome.time)),
                    column(&|outcome| format!("{:.3}", outcome.axis)),
                    column(&|outcome| outcome.blocks.to_string()),
                    column(&|outcome| outcome.eased.to_string()),
                );
                for (result, mode) in results.iter().zip(["blend", "exact", "greedy"]) {
                    match result {
                        Err(told) if mode != "greedy" => {
                            faults.push(format!("{what}, {mode}: refused: {told}"))
                        }
                        Err(_) => {}
                        Ok(outcome) => {
                            if outcome.axis > 0.05 + 1e-6 {
                                faults
                                    .push(format!("{what}, {mode}: axis off by {}", outcome.axis));
                            }
                            if outcome.tip > 0.005 + 1e-6 {
                                faults.push(format!("{what}, {mode}: tip off by {}", outcome.tip));
                            }
                            if outcome.over.0 > 1e-6 {
                                faults.push(format!(
                                    "{what}, {mode}: outside travel: {:?}",
                                    outcome.over
                                ));
                            }
                        }
                    }
                }
                if let [Ok(blend), Ok(exact), _] = &results {
                    if blend.way > exact.way + 0.05 {
                        faults.push(format!(
                            "{what}: blend turns {}, exact {}",
                            blend.way, exact.way
                        ));
                    }
                    if blend.time > exact.time * 1.001 + 0.001 {
                        faults.push(format!(
                            "{what}: blend takes {} s, exact {}",
                            blend.time, exact.time
                        ));
                    }
                    // A lean of 10° there and back is what the path asks for; half a turn of C is not.
                    let least = if name.starts_with("round") {
                        5.0
                    } else if class.name == "nutating head" {
                        // B 14° for 10° of lean, and C follows it by 7°.
                        40.0
                    } else {
                        12.0
                    };
                    if *beside <= 0.01 && blend.way > least {
                        faults.push(format!("{what}: blend turns {}", blend.way));
                    }
                }
            }
        }
    }
    for fault in &faults {
        println!("{fault}");
    }
    assert!(faults.is_empty(), "{} faults", faults.len());
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

/// The same on machines whose tilting axis ends at the pole, or a little behind it.
fn one_side() -> Faults {
    let mut faults = Faults::default();
    for class in [&CLASSES[0], &CLASSES[1], &CLASSES[2], &CLASSES[3]] {
        for tcp in ["post", "control"] {
            for second in [[-120.0, 0.0], [0.0, 120.0], [-0.02, 120.0], [-120.0, 0.2]] {
                for solution in [BLEND, EXACT] {
                    for beside in [0.0, 0.001, 0.01, 0.04, 0.1, 1.0] {
                        for (shape, points) in [
                            ("past, 1", pass(beside, 1)),
                            ("past, 5", pass(beside, 5)),
                            ("past, 200", pass(beside, 200)),
                            ("round, 12", circle(beside, 12)),
                            ("round, 180", circle(beside, 180)),
                        ] {
                            faults.runs += 1;
                            let what = format!(
                                "{}, {tcp}, tilt {second:?}, {solution}, {beside}° {shape}",
                                class.name
                            );
                            match outcome(class, tcp, second, solution, &points) {
                                Err(told) => {
                                    faults.tolerance.push(format!("{what}: refused: {told}"))
                                }
                                Ok(outcome) => {
                                    // Upright all the way is within tolerance.
                                    if shape.starts_with("round")
                                        && solution == BLEND
                                        && beside < 0.03
                                        && outcome.way > 1.0
                                    {
                                        faults
                                            .needless
                                            .push(format!("{what}: turns {:.1}°", outcome.way));
                                    }
                                    if outcome.axis > 0.05 + 1e-6 || outcome.tip > 0.005 + 1e-6 {
                                        faults.tolerance.push(format!(
                                            "{what}: tip {} mm, axis {}°",
                                            outcome.tip, outcome.axis
                                        ));
                                    }
                                    if outcome.over.0 > 1e-6 {
                                        faults.travel.push(format!(
                                            "{what}: outside travel {:?}",
                                            outcome.over
                                        ));
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    faults
}

#[test]
fn one_side_of_the_pole_is_enough() {
    let faults = one_side();
    told(&faults.tolerance, faults.runs);
    assert!(faults.runs > 1_000);
}

#[test]
fn one_side_of_the_pole_is_not_left() {
    let faults = one_side();
    told(&faults.travel, faults.runs);
}

#[test]
fn a_tilt_that_ends_at_the_pole_rests_there() {
    let faults = one_side();
    told(&faults.needless, faults.runs);
}

/// Random walks close to the pole, cuts and rapids, on machines with all kinds of travel: whatever is posted keeps
/// tip, axis and travel; what is refused is refused for a jump or for travel.
fn walks() -> Faults {
    let (rounds, mut rng) = randomised(1_200, 41);
    let mut refused = 0;
    let mut faults = Faults::default();
    for round in rounds {
        let class = &CLASSES[round % 4];
        let second = [
            [-175.0, 175.0],
            [-120.0, 0.0],
            [0.0, 120.0],
            [-120.0, rng.range(0.0, 3.0)],
            [-rng.range(0.0, 3.0), 120.0],
        ][rng.pick(5)];
        let given = Given {
            tcp: ["post", "control"][rng.pick(2)],
            c: ["", "[-180, 180]", "[-30, 370]", "[-720, 720]"][rng.pick(4)].to_owned(),
            second,
            accuracy: [
                "tolerance = 0.005\naxis_tolerance = 0.05\nrapid_tolerance = 0.5",
                "tolerance = 0.02\naxis_tolerance = 0.5\nrapid_tolerance = 100",
            ][rng.pick(2)],
            more: format!(
                "[solution]\nlook_ahead = {}\n{}\n{}",
                [2, 10, 2000][rng.pick(3)],
                [BLEND, EXACT][rng.pick(2)],
                ["", "[rewind]\ndistance = 20"][rng.pick(2)]
            ),
            ..Given::default()
        };
        let bench = bench(class, &given);
        let size = rng.order(-4.0, -1.0);
        let mut tip = rng.point(50.0);
        let mut lean = Vector3::zeros();
        let points: Vec<Point> = (0..40)
            .map(|index| {
                tip += rng.direction() * rng.order(-0.3, 1.3);
                let step = rng.direction() * size * rng.range(0.0, 1.0);
                lean = (lean + Vector3::new(step.x, step.y, 0.0)) * 0.95;
                if rng.pick(12) == 0 {
                    lean = Vector3::zeros();
                }
                let axis = (lean + Vector3::z()).normalize();
                point(tip, axis, index == 0 || rng.pick(8) == 0)
            })
            .collect();
        let text = cl(&points, 1000.0);
        let run = bench.run(&text);
        let what = format!(
            "round {round}, {}, {}, C {}, tilt {second:?}, size {size:.1e}, {}",
            class.name,
            given.tcp,
            given.c,
            given.more.replace('\n', " ")
        );
        if run.report.is_none() {
            refused += 1;
            if run.findings.iter().any(|finding| {
                !["jump", "over-travel", "out-of-reach", "spindle"].contains(&finding.code)
            }) {
                faults.tolerance.push(format!("{what}: {}", run.told()));
            }
            continue;
        }
        faults.runs += 1;
        let accuracy = &bench.machine.accuracy;
        let (off, axis) = if run
            .report
            .as_ref()
            .is_some_and(|report| report.rewinds == 0)
        {
            strays(&bench, &points, &run)
        } else {
            (0.0, 0.0)
        };
        if off > accuracy.tolerance + 1e-6 || axis > accuracy.axis_tolerance.to_degrees() + 1e-6 {
            faults
                .tolerance
                .push(format!("{what}: tip {off}, axis {axis}"));
        }
        let over = left_travel(&bench, &run);
        if over.0 > 1e-6 {
            faults
                .travel
                .push(format!("{what}: outside travel {over:?}"));
        }
    }
    eprintln!("{} walks posted, {refused} refused", faults.runs);
    faults
}

#[test]
fn walks_close_to_the_pole_keep_the_tolerance() {
    let faults = walks();
    told(&faults.tolerance, faults.runs);
    assert!(faults.runs > 600);
}

#[test]
fn walks_close_to_the_pole_keep_to_travel() {
    let faults = walks();
    told(&faults.travel, faults.runs);
}

/// A spiral of twenty thousand points turns an endless C on and on. How far is looked ahead makes no difference where
/// nothing is eased, and next to none where a window ends in the middle of a stretch that is.
#[test]
fn an_endless_axis_turns_on_and_on() {
    for class in &CLASSES {
        for sway in [15.0, 19.9] {
            let points: Vec<Point> = (0..20_000)
                .map(|index| {
                    let lean = 3.0 * f64::from(index);
                    let (sine, cosine) = libm::sincos(lean.to_radians());
                    let radius = 20.0 + 0.002 * f64::from(index);
                    let tip =
                        Vector3::new(radius * cosine, radius * sine, 0.001 * f64::from(index));
                    let tilt = 20.0 + sway * libm::sin(f64::from(index) * 0.0007);
                    point(tip, leaning(tilt, lean), index == 0)
                })
                .collect();
            let text = cl(&points, 3000.0);
            let run = |look_ahead: u32| {
                let given = Given {
                    tcp: "control",
                    more: format!("[solution]\nlook_ahead = {look_ahead}"),
                    ..Given::default()
                };
                let bench = bench(class, &given);
                let run = bench.run(&text).good(class.name);
                let end = bench.joints(run.arrival(line(19_999)).expect("a position"));
                let way = rotary_way(&bench, &run);
                (run, end[bench.place("C")].to_degrees(), way)
            };
            let (short, c, short_way) = run(200);
            let (long, _, long_way) = run(2000);
            let report = short.report.as_ref().expect("a report");
            println!(
                "{}: C comes to {c:.0}°, {} blocks, {} eased; rotary way {short_way:.1}° and {long_way:.1}°",
                class.name, report.blocks, report.points_eased
            );
            assert!((c - 60_000.0).abs() < 400.0, "{}: C at {c}", class.name);
            assert_eq!((report.branch_changes, report.rewinds), (0, 0));
            if sway < 18.0 {
                assert_eq!(report.points_eased, 0);
                assert!(
                    short.asked == long.asked,
                    "{}: 200 and 2000 differ",
                    class.name
                );
            } else {
                assert!(
                    (short_way / long_way - 1.0).abs() < 1e-3,
                    "{short_way} {long_way}"
                );
            }
        }
    }
}

/// One long cut, clear of the pole: it arrives where the axes come to when the path is followed step by step, however
/// far they turn.
#[test]
fn long_cuts_arrive_where_the_axes_come_to() {
    let (rounds, mut rng) = randomised(800, 51);
    let mut faults = Faults::default();
    let mut far = 0;
    for round in rounds {
        let class = &CLASSES[round % 4];
        let given = Given {
            tcp: ["post", "control"][rng.pick(2)],
            ..Given::default()
        };
        let bench = bench(class, &given);
        let most = if class.name == "nutating head" {
            85.0
        } else {
            160.0
        };
        let clear =
            |axis: Vector3<f64>| (4.0..most).contains(&angle(axis, Vector3::z()).to_degrees());
        let (from, to) = loop {
            let from = rng.direction();
            let about = Unit::new_normalize(across(&mut rng, from));
            let to = Rotation3::from_axis_angle(&about, rng.range(1.0, 3.0)) * from;
            if (0..=40).all(|step| clear(slerp(from, to, f64::from(step) / 40.0))) {
                break (from, to);
            }
        };
        let points = [
            point(rng.point(50.0), from, true),
            point(rng.point(50.0), to, false),
        ];
        let run = bench.run(&cl(&points, 1000.0));
        faults.runs += 1;
        let what = format!(
            "round {round}, {}, {}, from {:.4?} to {:.4?}",
            class.name,
            given.tcp,
            points[0].axis.as_slice(),
            points[1].axis.as_slice()
        );
        if run.report.is_none() {
            faults.tolerance.push(format!("{what}: {}", run.told()));
            continue;
        }
        let begin = bench.joints(run.arrival(line(0)).expect("a position"));
        let end = bench.joints(run.arrival(line(1)).expect("a position"));
        let solver = bench.machine.solver(class.length).expect("a form");
        let steps: Vec<Point> = (0..=200)
            .map(|step| {
                let t = f64::from(step) / 200.0;
                Point {
                    tip: points[0].tip * (1.0 - t) + points[1].tip * t,
                    axis: slerp(points[0].axis.normalize(), points[1].axis.normalize(), t),
                    rapid: false,
                }
            })
            .collect();
        let mut at = begin;
        for pair in steps.windows(2) {
            at = followed(&bench, &solver, (&pair[0], &at), &pair[1])
                .expect("a way")
                .0;
        }
        let off = bench
            .rotary()
            .iter()
            .map(|place| (at[*place] - end[*place]).abs())
            .fold(0.0, f64::max);
        let turn = bench
            .rotary()
            .iter()
            .map(|place| (at[*place] - begin[*place]).abs())
            .fold(0.0, f64::max);
        far += usize::from(turn > std::f64::consts::PI);
        if off > 1e-3 {
            faults.travel.push(format!(
                "{what}: ends {:.1}° off, after a turn by {:.1}°",
                off.to_degrees(),
                turn.to_degrees()
            ));
        }
        let (tip, axis) = strays(&bench, &points, &run);
        if tip > 0.005 + 1e-6 || axis > 0.05 + 1e-6 {
            faults
                .tolerance
                .push(format!("{what}: tip {tip}, axis {axis}"));
        }
    }
    println!(
        "{} long cuts, {far} of them turn an axis by more than half a turn; {} end elsewhere",
        faults.runs,
        faults.travel.len()
    );
    for fault in faults.travel.iter().take(5) {
        println!("{fault}");
    }
    told(&faults.tolerance, faults.runs);
}

/// Between two points that an axis can stand at its travel may end: the side on which it does not is taken.
#[test]
fn a_side_whose_travel_ends_between_two_points_is_not_taken() {
    let points = [
        point(Vector3::zeros(), leaning(95.0, -28.0), true),
        point(Vector3::new(40.0, 0.0, 0.0), leaning(95.0, 28.0), false),
    ];
    for (start, tilt) in [("A = -95", [-95.3, 120.0]), ("A = 95", [-120.0, 95.3])] {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                second: tilt,
                more: format!("[solution]\nstart = {{ {start} }}"),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let run = bench
                .run(&cl(&points, 1000.0))
                .good(&format!("{start}, {tcp}"));
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{start}, {tcp}: {axis} by {over}");
        }
    }
}

/// A control that shows C over one turn takes the shorter way: every word is within that turn, and every block's
/// shorter way is the one that is meant.
#[test]
fn an_axis_shown_over_one_turn_goes_the_way_that_is_meant() {
    let (rounds, mut rng) = randomised(200, 61);
    let mut stages = 0;
    let mut refused = Vec::new();
    for round in rounds {
        let class = &CLASSES[round % 4];
        let range = [[0.0, 360.0], [-180.0, 180.0]][rng.pick(2)];
        let given = Given {
            tcp: ["post", "control"][rng.pick(2)],
            more: "[solution]\npole = \"blend\"".to_owned(),
            ..Given::default()
        };
        let plain = bench(class, &given);
        let shown = plain.text.replace(
            "cyclic = true",
            &format!("cyclic = true\nrange = {range:?}"),
        );
        let bench = Bench::new(&shown, 3, class.length);
        let points = short(&mut rng, class);
        let text = cl(&points, 1000.0);
        let (endless, run) = (plain.run(&text), bench.run(&text));
        if endless.report.is_some() != run.report.is_some() {
            let at = run
                .findings
                .iter()
                .find_map(|finding| finding.place.as_ref());
            let line = at.map_or(0, |place| place.line);
            refused.push(format!(
                "round {round}, {}, {}, {range:?}, refused at line {line}: {}\n{:?} to {:?} on an endless axis\n{text}",
                class.name,
                given.tcp,
                run.told(),
                endless.arrival(line - 2),
                endless.arrival(line)
            ));
            continue;
        }
        if run.report.is_none() {
            continue;
        }
        let place = bench
            .order
            .iter()
            .position(|place| *place == bench.place("C"))
            .expect("C");
        let motions = run.motions();
        let mut c = endless.motions()[0].words[place];
        for (index, asked) in motions.iter().enumerate() {
            let word = asked.words[place];
            assert!(word >= range[0] && word < range[1], "{word} {range:?}");
            if index > 0 {
                let way = turned(
                    motions[index - 1].words[place].to_radians(),
                    word.to_radians(),
                );
                assert!(way.abs().to_degrees() < 179.0, "{way}");
                c += way.to_degrees();
            }
            // Counted by the shorter ways, C is at every CL point where the endless one is.
            if motions
                .get(index + 1)
                .is_none_or(|next| next.line != asked.line)
            {
                let meant = endless.arrival(asked.line).expect("a position")[place];
                assert!(
                    (c - meant).abs() < 0.01,
                    "round {round}, {}: {c} for {meant}",
                    class.name
                );
            }
        }
        stages += motions.len() - endless.motions().len().min(motions.len());
    }
    println!("{stages} blocks more than on an endless axis");
    told(&refused, 200);
}

/// The cheapest way through a path, by the cheapest way to every way of standing at every point.
fn cheapest(bench: &Bench, solver: &Solver, points: &[Point]) -> f64 {
    let mut states: Vec<(f64, Joints)> = Vec::new();
    for (index, target) in points.iter().enumerate() {
        let mut next: Vec<(f64, Joints)> = Vec::new();
        if index == 0 {
            let start = bench.machine.solution.start;
            for joints in stands(bench, solver, target) {
                next.push((cost(bench, &start, &joints, false), joints));
            }
        } else if target.rapid {
            for joints in stands(bench, solver, target) {
                let ways = states
                    .iter()
                    .map(|(so_far, at)| so_far + cost(bench, at, &joints, true));
                next.push((ways.fold(f64::INFINITY, f64::min), joints));
            }
        } else {
            for (so_far, at) in &states {
                let end = followed(bench, solver, (&points[index - 1], at), target);
                if let Some((joints, false)) = end {
                    next.push((so_far + cost(bench, at, &joints, true), joints));
                }
            }
        }
        states = next;
    }
    states
        .iter()
        .map(|(cost, _)| *cost)
        .fold(f64::INFINITY, f64::min)
}

/// Longer paths and short windows: what is chosen hangs together at every point, looking ahead over the whole path
/// costs what the cheapest way costs, and looking less far costs more at most.
#[test]
fn a_window_of_any_length_gives_a_path_that_hangs_together() {
    let (rounds, mut rng) = randomised(80, 71);
    let (mut posted, mut refused, mut lost) = (0, 0, 0);
    let mut dearer: std::collections::BTreeMap<u32, f64> = std::collections::BTreeMap::new();
    for round in rounds {
        let class = &CLASSES[round % 4];
        let c = turns(&mut rng);
        let tilt = [[-175.0, 175.0], [-100.0, 40.0], [-30.0, 120.0]][rng.pick(3)];
        // Pieces of short paths, one after the other.
        let mut points: Vec<Point> = Vec::new();
        while points.len() < 45 {
            points.extend(short(&mut rng, class));
        }
        let text = cl(&points, 1000.0);
        let mut best = None;
        for look_ahead in [2000, 46, 45, 30, 13, 7, 4, 3, 2, 1] {
            let given = Given {
                c: format!("{c:?}"),
                second: tilt,
                accuracy: "tolerance = 0.05\naxis_tolerance = 0.05\nrapid_tolerance = 1000000",
                more: format!("[solution]\nlook_ahead = {look_ahead}"),
                decimals: 7,
                ..Given::default()
            };
            let bench = bench(class, &given);
            let solver = bench.machine.solver(class.length).expect("a closed form");
            let best = *best.get_or_insert_with(|| cheapest(&bench, &solver, &points));
            let run = bench.run(&text);
            let what = format!("round {round}, {}, look_ahead {look_ahead}", class.name);
            if run.report.is_none() {
                if look_ahead == 2000 {
                    refused += 1;
                    assert!(best.is_infinite(), "{what}: {}", run.told());
                } else {
                    lost += usize::from(best.is_finite());
                }
                continue;
            }
            assert!(best.is_finite(), "{what}: posted, and there is no way");
            posted += 1;
            let mut at = bench.machine.solution.start;
            let mut sum = 0.0;
            for (index, target) in points.iter().enumerate() {
                let next = bench.joints(run.arrival(line(index)).expect("a position"));
                assert!(
                    inside(
                        &bench,
                        &std::array::from_fn(|place| {
                            // To the decimals.
                            (next[place] * 1e6).round() / 1e6
                        })
                    ),
                    "{what}: {next:?}"
                );
                if index > 0 && !target.rapid {
                    let from = (&points[index - 1], &at);
                    let (end, _) = followed(&bench, &solver, from, target).expect("a way");
                    for place in bench.rotary() {
                        assert!(
                            (end[place] - next[place]).abs() < 1e-5,
                            "{what}: point {index} jumps"
                        );
                    }
                }
                sum += cost(&bench, &at, &next, index > 0);
                at = next;
            }
            let over = sum / best - 1.0;
            assert!(over > -1e-6, "{what}: costs {sum}, less than {best}");
            if look_ahead == 2000 {
                assert!(over < 1e-6, "{what}: costs {sum}, the cheapest way {best}");
            }
            let most = dearer.entry(look_ahead).or_insert(0.0);
            *most = most.max(over);
        }
    }
    println!("{posted} posted, {refused} refused, {lost} more where the window was too short");
    println!("dearer than the cheapest way at most, by look_ahead: {dearer:.3?}");
    assert!(posted > 200);
}

/// No more rewinds than the travel asks for, however many turns the cut has.
#[test]
fn a_cut_of_many_turns_rewinds_no_more_than_it_must() {
    // From 0 to 400, and then 360° at a time; or 1440° at a time.
    for (c, rewinds) in [("[-200, 400]", 4), ("[-720, 720]", 1), ("[-350, 350]", 5)] {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: c.to_owned(),
                second: [-1.0, 120.0],
                more: "[rewind]\ndistance = 25".to_owned(),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let points = orbit(30.0, 0, 1800, |step| step == 0);
            let run = bench.run(&cl(&points, 1000.0)).good(c);
            let report = run.report.as_ref().expect("a report");
            println!(
                "C {c}, {tcp}: {} rewinds, rotary way {:.0}°",
                report.rewinds,
                rotary_way(&bench, &run)
            );
            assert_eq!(report.rewinds, rewinds, "C {c}, {tcp}");
        }
    }
}

/// A portal without Z, its Z made by two swinging arms: there is no closed form, and every block of a program holds
/// tip and axis all the same.
#[test]
fn a_machine_without_a_closed_form_makes_its_program() {
    let text = r#"
name = "two slides, three turns"
chain = "[w b X Y C B A t]"
tool = { gauge = [0, 0, -50] }
control = { dialect = "recorder", tcp = "post" }
[axis]
X = { linear = [1, 0, 0], travel = [-1000, 1000] }
Y = { linear = [0, 1, 0], travel = [-1000, 1000] }
C = { rotary = [0, 0, 1], point = [0, 0, 0], travel = [-400, 400] }
B = { rotary = [0, 1, 0], point = [0, 0, 400], travel = [-170, 170] }
A = { rotary = [0.1, 1, 0.05], point = [0, 5, 150], travel = [-170, 170] }
[solution]
start = { B = 30, A = -30 }
[accuracy]
tolerance = 0.01
axis_tolerance = 0.05
rapid_tolerance = 0.5
"#;
    let bench = Bench::new(text, 4, 0.0);
    assert!(!bench.machine.solver(0.0).expect("a form").closed_form());
    let (rounds, mut rng) = randomised(30, 81);
    let (mut posted, mut refused) = (0, 0);
    let mut faults = Faults::default();
    for round in rounds {
        // A walk of the axes, so that every point can be reached.
        let mut q = Joints::default();
        let slope: Joints = std::array::from_fn(|_| rng.range(-1.0, 1.0));
        let points: Vec<Point> = (0..25)
            .map(|index| {
                let s = 0.2 + 0.01 * f64::from(index);
                for (place, value) in q.iter_mut().enumerate().take(5) {
                    *value = match place {
                        0 | 1 => 100.0 * slope[place] * s,
                        2 => slope[2] * s,
                        3 => 0.5 + slope[3] * s * 0.5,
                        _ => -0.6 + slope[4] * s * 0.5,
                    };
                }
                let (tip, axis) = bench.reference.forward(&q);
                point(tip, axis, index == 0)
            })
            .collect();
        let run = bench.run(&cl(&points, 1000.0));
        faults.runs += 1;
        if run.report.is_none() {
            refused += 1;
            faults
                .needless
                .push(format!("round {round}: {}", run.told()));
            continue;
        }
        posted += 1;
        let (tip, axis) = strays(&bench, &points, &run);
        if tip > 0.01 + 1e-6 || axis > 0.05 + 1e-6 {
            faults
                .tolerance
                .push(format!("round {round}: tip {tip}, axis {axis}"));
        }
        let (over, axis) = left_travel(&bench, &run);
        if over > 1e-6 {
            faults
                .tolerance
                .push(format!("round {round}: {axis} outside travel by {over}"));
        }
    }
    println!("without a closed form: {posted} posted, {refused} refused");
    for fault in faults.needless.iter().take(6) {
        println!("{fault}");
    }
    told(&faults.tolerance, faults.runs);
    told(&faults.needless, faults.runs);
}

/// A rewind turns no farther back than the rest of the cut asks for.
#[test]
fn a_rewind_turns_back_no_farther_than_it_must() {
    let given = Given {
        tcp: "control",
        c: "[-720, 720]".to_owned(),
        second: [-1.0, 120.0],
        more: "[rewind]\ndistance = 25\n[solution]\nstart = { C = -720 }".to_owned(),
        ..Given::default()
    };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&orbit(30.0, 0, 1500, |step| step == 0), 1000.0));
    let way = rotary_way(&bench, &run.good("rewind"));
    assert!((way - 1860.0).abs() < 1.0, "{way}");
}
