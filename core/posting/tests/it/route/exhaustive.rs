//! Paths of a few points against every way of making them.

use super::*;

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
        for rule in ["time", "travel", "largest-axis", "axis:C", "axis:second", "axis:X"] {
            for round in rounds.clone() {
                let tilt = match rng.pick(3) {
                    0 => [-175.0, 175.0],
                    1 => [-rng.range(20.0, 120.0), rng.range(20.0, 120.0)].map(f64::round),
                    _ => [-rng.range(0.0, 30.0), rng.range(60.0, 200.0)].map(f64::round),
                };
                let c = turns(&mut rng);
                let start = [rng.range(c[0], c[1]).round(), rng.range(tilt[0], tilt[1]).round()];
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
                    ..Given::default()
                };
                let bench = bench(class, &given);
                let points = short(&mut rng, class);
                let solver = bench.machine.solver(class.length).expect("a closed form");
                let mut search = Search {
                    bench: &bench,
                    solver: &solver,
                    points: &points,
                    stands: points.iter().map(|point| stands(&bench, &solver, point)).collect(),
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
    assert!(chosen > at_least(400) && refused > at_least(100));
}
