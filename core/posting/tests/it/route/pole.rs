//! Cuts over the pole and beside it.

use std::ops::Range;
use std::sync::OnceLock;

use super::*;

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
pub(super) struct Outcome {
    way: f64,
    time: f64,
    pub(super) axis: f64,
    pub(super) tip: f64,
    blocks: u64,
    pub(super) eased: u64,
    pub(super) over: (f64, String),
}

pub(super) fn outcome(
    class: &Class<'_>,
    tcp: &str,
    second: [f64; 2],
    solution: &str,
    points: &[Point],
) -> Result<Outcome, String> {
    let given = Given {
        tcp,
        second,
        accelerations: Some([5000.0, 5000.0, 5000.0, 300.0, 600.0]),
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
/// against taking the nearest solution each time. Prints the table of the book (`nc-programmer/solutions.md`).
#[test]
fn close_to_the_pole_axes_are_spared_within_tolerance() {
    let mut paths: Vec<(String, f64, Vec<Point>)> = Vec::new();
    for beside in [0.0, 0.01, 0.1, 1.0] {
        for (grain, count) in [("coarse", 5), ("fine", 200)] {
            let name = if beside == 0.0 { "through".to_owned() } else { format!("at {beside}°") };
            paths.push((format!("{name}, {grain}"), beside, pass(beside, count)));
        }
    }
    for beside in [0.01, 0.1] {
        for (grain, count) in [("coarse", 12), ("fine", 180)] {
            paths.push((format!("round at {beside}°, {grain}"), beside, circle(beside, count)));
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

/// The same on machines whose tilting axis ends at the pole, or a little behind it.
fn one_side() -> &'static Faults {
    // Three tests look at the same runs.
    static FOUND: OnceLock<Faults> = OnceLock::new();
    FOUND.get_or_init(pass_on_one_side)
}

fn pass_on_one_side() -> Faults {
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
fn walks() -> &'static Faults {
    // Two tests look at the same runs.
    static FOUND: OnceLock<Faults> = OnceLock::new();
    let (rounds, rng) = randomised(1_200, 41);
    FOUND.get_or_init(|| walk(rounds, rng))
}

fn walk(rounds: Range<usize>, mut rng: Rng) -> Faults {
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
            // What a warning tells besides is no reason.
            let mut reasons =
                run.findings.iter().filter(|finding| finding.severity == Severity::Error);
            if reasons.any(|reason| {
                !["jump", "over-travel", "out-of-reach", "spindle"].contains(&reason.code)
            }) {
                faults.tolerance.push(format!("{what}: {}", run.told()));
            }
            continue;
        }
        faults.runs += 1;
        let accuracy = &bench.machine.accuracy;
        let (off, axis) = if run.report.as_ref().is_some_and(|report| report.rewinds == 0) {
            strays(&bench, &points, &run)
        } else {
            (0.0, 0.0)
        };
        if off > accuracy.tolerance + 1e-6 || axis > accuracy.axis_tolerance.to_degrees() + 1e-6 {
            faults.tolerance.push(format!("{what}: tip {off}, axis {axis}"));
        }
        let over = left_travel(&bench, &run);
        if over.0 > 1e-6 {
            faults.travel.push(format!("{what}: outside travel {over:?}"));
        }
    }
    eprintln!("{} walks posted, {refused} refused", faults.runs);
    faults
}

#[test]
fn walks_close_to_the_pole_keep_the_tolerance() {
    let faults = walks();
    told(&faults.tolerance, faults.runs);
    assert!(faults.runs > at_least(600));
}

#[test]
fn walks_close_to_the_pole_keep_to_travel() {
    let faults = walks();
    told(&faults.travel, faults.runs);
}

/// In and out of the pole's cone an endless C is chosen as one is that has room for every turn: of the ways that
/// differ by full turns alone one is kept, and it is the cheapest.
#[test]
fn full_turns_of_an_endless_axis_are_one_way() {
    let (rounds, mut rng) = randomised(200, 43);
    let (mut exits, mut posted) = (0, 0);
    for round in rounds {
        let class = &CLASSES[round % 4];
        let points: Vec<Point> = (0..8)
            .map(|index| {
                let tilt = [0.02, 0.06, 2.0][rng.pick(3)] * rng.range(0.0, 1.0);
                exits += u32::from(tilt > 0.05);
                let axis = leaning(tilt, rng.range(-180.0, 180.0));
                point(rng.point(20.0), axis, index == 0)
            })
            .collect();
        let rule = ["time", "travel", "largest-axis"][rng.pick(3)];
        let run = |c: &str| {
            let given = Given {
                tcp: "control",
                c: c.to_owned(),
                more: format!("[solution]\nrule = \"{rule}\""),
                ..Given::default()
            };
            bench(class, &given).run(&cl(&points, 1000.0))
        };
        let (endless, wide) = (run(""), run("[-2160, 2160]"));
        assert!(
            endless.asked == wide.asked,
            "round {round}, {}: {} {}",
            class.name,
            endless.told(),
            wide.told()
        );
        posted += u32::from(endless.report.is_some());
    }
    assert!(exits > at_least(500) && posted > at_least(150), "{exits} exits, {posted} posted");
}

/// Cuts across the pole and beside it, points far apart and close, some of them within what blending takes up.
pub(super) fn over(rng: &mut Rng) -> Vec<Point> {
    let (sine, cosine) = libm::sincos(rng.range(-3.0, 3.0));
    let beside = if rng.pick(2) == 0 { 0.0 } else { rng.order(-5.0, -2.0) };
    let mut along = rng.range(0.2, 0.7);
    let mut tip = Vector3::new(0.0, 0.0, 10.0);
    let count = 3 + rng.pick(5);
    (0..count)
        .map(|index| {
            let axis =
                Vector3::new(cosine * along - sine * beside, sine * along + cosine * beside, 1.0);
            let next = point(tip, axis.normalize(), index == 0);
            tip += Vector3::new(rng.order(-0.5, 1.5), rng.range(-1.0, 1.0), 0.0);
            along -= rng.order(-2.5, -0.1);
            next
        })
        .collect()
}

/// Whatever is written with every point met exactly is written with poles blended.
#[test]
fn blending_refuses_nothing_that_can_be_met_exactly() {
    let (rounds, mut rng) = randomised(150, 83);
    let (mut both, mut blended, mut faults) = (0, 0, Vec::new());
    let mut round = 0;
    // Few are blended: rounds go on until some are.
    while round < rounds.end || blended < 2 && round < 20 * rounds.end {
        round += 1;
        let class = &CLASSES[rng.pick(CLASSES.len())];
        let tcp = ["post", "control"][rng.pick(2)];
        let second = [[-175.0, 175.0], [-120.0, 30.0], [-2.0, 110.0]][rng.pick(3)];
        let points = over(&mut rng);
        let [blend, exact] =
            [BLEND, EXACT].map(|solution| outcome(class, tcp, second, solution, &points));
        match (&blend, &exact) {
            (Err(told), Ok(_)) => faults.push(format!("round {round}, {}: {told}", class.name)),
            (Ok(outcome), exact) => {
                both += usize::from(exact.is_ok());
                blended += usize::from(outcome.eased > 0);
                if outcome.axis > 0.05 + 1e-6 || outcome.tip > 0.005 + 1e-6 {
                    faults.push(format!("round {round}: {} mm, {}°", outcome.tip, outcome.axis));
                }
            }
            _ => {}
        }
    }
    // Eased at the third point, the way from the second through the pole would end in a jump.
    let tilts = [0.59847, 0.04158, -0.00841, -0.96577];
    let points: Vec<Point> = [0.0, 12.0, 13.0, 39.0]
        .iter()
        .zip(tilts)
        .map(|(x, tilt)| {
            let axis = Vector3::new(0.0, tilt, 1.0).normalize();
            point(Vector3::new(*x, 0.0, 10.0), axis, *x == 0.0)
        })
        .collect();
    for tcp in ["post", "control"] {
        if let Err(told) = outcome(&CLASSES[0], tcp, [-120.0, 30.0], BLEND, &points) {
            faults.push(told);
        }
    }
    println!("{both} by both, {blended} of them eased");
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
    assert!(both > at_least(40) && blended >= 2, "{both}, {blended}");
}
