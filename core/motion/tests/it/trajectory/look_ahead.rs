//! Many blocks in one go.

use post_machine::description::Machine;
use post_motion::path::{Curve, Interpolation};
use post_motion::{CornerMode, MovePace};
use post_testkit::{randomised, seeded};

use super::build::{Program, run, trunnion};

const ROTARY: &str = "max_feed = 7200, max_accel = 600";

/// Blocks along X, of these lengths (mm) at these feeds (mm/min).
fn straight(machine: &Machine, blocks: &[[f64; 2]]) -> Program {
    let mut program = Program::new(machine, [0.0; 3]);
    let mut x = 0.0;
    for [length, feed] in blocks {
        x += length;
        let to = program.stance([x, 0.0, 0.0], &program.here.joints);
        program.go(Interpolation::Axes, to, MovePace::Minutes(length / feed), CornerMode::Path);
    }
    program
}

/// How long a program takes, s.
fn seconds(machine: &Machine, program: &Program) -> f64 {
    let run = run(machine, &program.tasks, &program.solver, 1000);
    run.times.iter().map(|time| time.seconds).sum()
}

#[test]
fn velocities_are_bounded_by_the_way_to_every_slower_place() {
    let (rounds, mut rng) = randomised(60u16, 11);
    let machine = trunnion("max_feed = 12000, max_accel = 800", ROTARY, "look_ahead = 1000");
    let a = 800.0;
    for _ in rounds {
        let count = 2 + rng.pick(200);
        let blocks: Vec<[f64; 2]> =
            (0..count).map(|_| [rng.order(-2.0, 1.3), rng.order(1.0, 4.3)]).collect();
        let own = seconds(&machine, &straight(&machine, &blocks));
        // Another way to the same: each place against each bound, no pass.
        let velocities: Vec<f64> =
            blocks.iter().map(|[_, feed]| feed.min(12000.0) / 60.0).collect();
        let places: Vec<f64> = blocks
            .iter()
            .scan(0.0, |x, [length, _]| {
                *x += length;
                Some(*x)
            })
            .collect();
        let end = *places.last().expect("some");
        let mut due = 0.0;
        let bound = |x: f64| {
            let mut square = (2.0 * a * x).min(2.0 * a * (end - x));
            for place in 0..count - 1 {
                let cap = velocities[place].min(velocities[place + 1]);
                square = square.min(cap * cap + 2.0 * a * libm::fabs(places[place] - x));
            }
            square.max(0.0).sqrt()
        };
        for place in 0..count {
            let to = places[place];
            let from = to - blocks[place][0];
            let (v, [v0, v1]) = (velocities[place], [bound(from), bound(to)]);
            let peak = v.min((0.5 * (v0 * v0 + v1 * v1) + a * (to - from)).sqrt());
            let ramps = (2.0 * peak * peak - v0 * v0 - v1 * v1) / (2.0 * a);
            due += (2.0 * peak - v0 - v1) / a + (to - from - ramps).max(0.0) / peak;
        }
        assert!(libm::fabs(own - due) < 1e-7 * due, "{own} s, not {due} s");
    }
}

#[test]
fn a_line_in_thousands_of_blocks_takes_hardly_longer_than_in_one() {
    for (jerk, slower) in [("", 1e-9), (", max_jerk = 20000", 0.01)] {
        let linear = format!("max_feed = 12000, max_accel = 1000{jerk}");
        let machine = trunnion(&linear, ROTARY, "look_ahead = 2000");
        let one = seconds(&machine, &straight(&machine, &[[150.0, 6000.0]]));
        let many = seconds(&machine, &straight(&machine, &[[0.1, 6000.0]; 1500]));
        let seen = trunnion(&linear, ROTARY, "look_ahead = 400");
        let bounded = seconds(&seen, &straight(&seen, &[[0.1, 6000.0]; 1500]));
        println!("{one} s in one block, {many} s in 1500, {bounded} s with 400 seen");
        for seconds in [many, bounded] {
            assert!(seconds >= one * (1.0 - 1e-9) && seconds < one * (1.0 + slower));
        }
    }
}

#[test]
fn looking_further_ahead_is_never_slower_and_not_at_all_stands_still() {
    let mut rng = seeded(12);
    for jerk in ["", ", max_jerk = 40000"] {
        let linear = format!("max_feed = 12000, max_accel = 1000{jerk}");
        let blocks: Vec<[f64; 2]> =
            (0..400).map(|_| [rng.order(-1.0, 0.5), rng.order(2.5, 4.0)]).collect();
        let mut last = f64::INFINITY;
        for depth in [1, 2, 4, 10, 50, 200, 1000] {
            let machine = trunnion(&linear, ROTARY, &format!("look_ahead = {depth}"));
            let own = seconds(&machine, &straight(&machine, &blocks));
            println!("{depth} blocks: {own} s");
            if depth == 1 {
                let alone =
                    blocks.iter().map(|block| seconds(&machine, &straight(&machine, &[*block])));
                let alone: f64 = alone.sum();
                assert!(libm::fabs(own - alone) < 1e-9 * alone);
            }
            // With jerk limits knots lie elsewhere for every depth: a percent.
            let slack = if jerk.is_empty() { 1e-9 } else { 0.01 };
            assert!(own <= last * (1.0 + slack), "{depth} blocks: {own} s, fewer {last} s");
            last = own;
        }
    }
}

#[test]
fn no_jerk_limit_is_passed_however_many_blocks_a_ramp_spans() {
    let (rounds, mut rng) = randomised(40u16, 13);
    for round in rounds {
        let [a, j] = [rng.order(2.0, 3.7), rng.order(3.7, 5.5)];
        let depth = [3, 20, 100, 1000][rng.pick(4)];
        let machine = trunnion(
            &format!("max_feed = 12000, max_accel = {a:?}, max_jerk = {j:?}"),
            ROTARY,
            &format!("period = 0.001\nlook_ahead = {depth}"),
        );
        let scatter = rng.range(0.0, 0.8);
        let blocks: Vec<[f64; 2]> = (0..300)
            .map(|_| [rng.order(-2.0, 0.0), rng.order(3.5 - scatter, 3.5 + scatter)])
            .collect();
        let program = straight(&machine, &blocks);
        let run = run(&machine, &program.tasks, &program.solver, 1000);
        let x = machine.axes.iter().position(|axis| axis.name == "X").expect("X");
        let values: Vec<f64> = run.points.joints.iter().map(|joints| joints[x]).collect();
        let h = run.points.period;
        for four in values.windows(4) {
            let [p0, p1, p2, p3] = [four[0], four[1], four[2], four[3]];
            let acceleration = (p3 - 2.0 * p2 + p1) / (h * h);
            let jerk = (p3 - 3.0 * p2 + 3.0 * p1 - p0) / (h * h * h);
            assert!(p3 >= p2 - 1e-12);
            assert!(libm::fabs(acceleration) < a * 1.0001, "{round}: {acceleration}, limit {a}");
            assert!(libm::fabs(jerk) < j * 1.0001 + 0.1, "{round}: {jerk}, limit {j}");
        }
        for (time, [length, feed]) in run.times.iter().zip(&blocks) {
            assert!(time.seconds >= 60.0 * length / feed * (1.0 - 1e-9));
        }
    }
}

#[test]
fn a_curve_of_many_blocks_is_gone_round_at_its_feed() {
    let machine = trunnion(
        "max_feed = 12000, max_accel = 2000, max_jerk = 50000",
        "max_feed = 7200, max_accel = 600, max_jerk = 20000",
        "",
    );
    let mut program = Program::new(&machine, [50.0, 0.0, 0.0]);
    let (count, feed) = (3000, 3000.0);
    for place in 1..=count {
        let angle = 2.0 * std::f64::consts::PI * f64::from(place) / f64::from(count);
        let (sine, cosine) = libm::sincos(angle);
        let mut joints = program.here.joints;
        joints[0] = 0.3 * sine;
        joints[1] = 0.2 * cosine - 0.2;
        let to = program.stance([50.0 * cosine, 50.0 * sine, 5.0 * sine * sine], &joints);
        let length = (to.pose.tip - program.here.pose.tip).norm();
        program.go(
            Interpolation::Tip(Curve::Straight),
            to,
            MovePace::Minutes(length / feed),
            CornerMode::Path,
        );
    }
    let begun = std::time::Instant::now();
    let run = run(&machine, &program.tasks, &program.solver, 1000);
    let cost = begun.elapsed().as_secs_f64() / run.points.len() as f64;
    let [asked, taken]: [f64; 2] = [
        run.times.iter().map(|time| time.asked).sum(),
        run.times.iter().map(|time| time.seconds).sum(),
    ];
    println!("{taken} s, {asked} s asked, {:.0} ns a set-point", cost * 1e9);
    assert!(taken < asked * 1.05, "{taken} s, {asked} s asked");
}
