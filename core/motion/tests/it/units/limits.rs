//! Bounds against what dense samples of the way do, on machines of the library.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::{LimitsActOn, Machine, Source, load};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_testkit::{Rng, randomised, repository};

use post_motion::limits::{AxisLimits, of};
use post_motion::path::{BSpline, Curve, Interpolation, Stance};
use post_motion::{CornerMode, Move, MovePace};

/// Values of the dense samples: axes, then the tip.
const VALUES: usize = MAX_AXES + 3;

/// A bound may lie so far above what a way does anywhere: the series' terms are summed whatever their signs.
const LOOSE: [f64; 3] = [1.35, 1.8, 2.6];

fn machine(name: &str) -> Machine {
    let source = |name: &str| Source {
        name: format!("{name}.toml"),
        text: std::fs::read_to_string(repository().join(format!("machines/{name}.toml"))).unwrap(),
    };
    load(source(name), &[], &mut |parent| Ok(source(parent))).unwrap()
}

/// A move between the tips, the rotary axes from and to the angles (degrees, in the order of the chain).
fn task(machine: &Machine, way: Interpolation, tips: [[f64; 3]; 2], angles: [[f64; 2]; 2]) -> Move {
    let solver = Arc::new(machine.solver(80.0).unwrap());
    let stances = [0, 1].map(|end| {
        let mut joints = Joints::default();
        let rotary = (0..machine.axes.len()).filter(|place| machine.axes[*place].joint.rotary);
        for (place, angle) in rotary.zip(angles[end]) {
            joints[place] = angle.to_radians();
        }
        let turns = solver.chain().turns(&joints);
        solver.place(Vector3::from(tips[end]), &mut joints, &turns).unwrap();
        Stance { joints, pose: solver.chain().forward(&joints) }
    });
    let [from, to] = stances;
    Move {
        line: 1,
        way,
        from,
        to,
        solver,
        keeps_tip: true,
        pace: MovePace::Rapid,
        corner: CornerMode::Stop,
    }
}

/// What is limited at `t`, and the tip.
fn at(task: &Move, limits: &AxisLimits, t: f64, near: &Joints) -> [f64; VALUES] {
    let stance = task.way.stance_at(&task.solver, [&task.from, &task.to], t, near).unwrap();
    let mut values = [0.0; VALUES];
    values[..MAX_AXES].copy_from_slice(&stance.joints);
    values[MAX_AXES..].copy_from_slice(stance.pose.tip.as_slice());
    if task.way != Interpolation::Axes
        && let Some(programmed) = &limits.programmed
    {
        for (place, coordinate) in programmed.iter().enumerate() {
            if let Some(coordinate) = coordinate {
                values[place] = values[MAX_AXES + coordinate];
            }
        }
    }
    values
}

/// The largest magnitudes of the first three derivatives of each value by central differences, and the first at the ends.
fn dense(task: &Move, limits: &AxisLimits) -> ([[f64; VALUES]; 3], [[f64; VALUES]; 2]) {
    const COUNT: usize = 480;
    let step = 1.0 / COUNT as f64;
    let mut rows = Vec::new();
    let mut near = task.from.joints;
    for place in 0..=COUNT {
        let row = at(task, limits, place as f64 * step, &near);
        if limits.programmed.is_none() || task.way == Interpolation::Axes {
            near.copy_from_slice(&row[..MAX_AXES]);
        } else {
            let ends = [&task.from, &task.to];
            near = task.way.joints_at(&task.solver, ends, place as f64 * step, &near).unwrap();
        }
        rows.push(row);
    }
    let mut most = [[0.0; VALUES]; 3];
    for window in rows.windows(5) {
        for value in 0..VALUES {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|row: usize| window[row][value]);
            let found = [
                (8.0 * (d - b) - (e - a)) / (12.0 * step),
                (b - 2.0 * c + d) / (step * step),
                (e - 2.0 * d + 2.0 * b - a) / (2.0 * step * step * step),
            ];
            for (most, found) in most.iter_mut().zip(found) {
                most[value] = f64::max(most[value], found.abs());
            }
        }
    }
    // Of fourth order, one-sided.
    let slope = |rows: [&[f64; VALUES]; 5]| {
        std::array::from_fn(|value| {
            let [a, b, c, d, e] = rows.map(|row| row[value]);
            (-25.0 * a + 48.0 * b - 36.0 * c + 16.0 * d - 3.0 * e) / (12.0 * step)
        })
    };
    let first = slope([0, 1, 2, 3, 4].map(|row| &rows[row]));
    let last: [f64; VALUES] = slope([0, 1, 2, 3, 4].map(|row| &rows[COUNT - row]));
    (most, [first, last.map(|value| -value)])
}

/// Every bound holds and none is much too large; the ends are exact.
fn check(what: &str, machine: &Machine, task: &Move) {
    for limits in [
        AxisLimits::new(machine),
        AxisLimits {
            programmed: {
                let mut machine = machine.clone();
                machine.motion.limits = LimitsActOn::Programmed;
                AxisLimits::new(&machine).programmed
            },
            ..AxisLimits::new(machine)
        },
    ] {
        let found = of(task, &limits).unwrap();
        let (most, ends) = dense(task, &limits);
        let bounds = [found.first, found.second, found.third];
        for order in 0..3 {
            // What differences of so close samples cannot tell from zero.
            let noise = [1e-7, 1e-5, 2e-2][order];
            for place in 0..machine.axes.len() {
                let (bound, most) = (bounds[order][place], most[order][place]);
                let name = format!(
                    "{what}, {}, derivative {}: {bound} {most}",
                    machine.axes[place].name,
                    order + 1
                );
                assert!(most <= bound * 1.001 + noise, "{name}");
                assert!(bound <= most * LOOSE[order] + noise, "{name}: too large");
            }
            let tip = (0..3).map(|row| most[order][MAX_AXES + row]).fold(0.0, f64::max);
            assert!(
                tip <= found.tip[order] * 1.001 + noise,
                "{what}: tip {} {tip}",
                found.tip[order]
            );
            // The coordinates need not be largest in one place.
            let within = LOOSE[order] * 3f64.sqrt();
            assert!(found.tip[order] <= tip * within + noise, "{what}: tip");
        }
        for (end, wanted) in ends.iter().enumerate() {
            let axes = found.ends[end][..machine.axes.len()].iter().zip(wanted);
            let tip = found.tip_ends[end].iter().zip(&wanted[MAX_AXES..]);
            for (found, wanted) in axes.chain(tip) {
                let off = (found - wanted).abs();
                assert!(off < 1e-4 * (1.0 + wanted.abs()), "{what}: {off}");
            }
        }
    }
}

#[test]
fn bounds_hold_along_every_way() {
    let tips = [[10.0, 20.0, 30.0], [40.0, -10.0, 55.0]];
    for name in ["ac-trunnion", "head-head", "nutating-table", "head-table-bc"] {
        let machine = machine(name);
        for angles in [
            [[5.0, -10.0], [5.0, -10.0]],
            [[5.0, -10.0], [9.0, -14.0]],
            [[5.0, -10.0], [75.0, 25.0]],
            [[-170.0, 20.0], [200.0, -25.0]],
        ] {
            let straight = |way| task(&machine, way, tips, angles);
            check(&format!("{name} axes"), &machine, &straight(Interpolation::Axes));
            check(&format!("{name} tip"), &machine, &straight(Interpolation::Tip(Curve::Straight)));
            let circle = Interpolation::Tip(Curve::Arc {
                centre: Vector3::new(25.0, 5.0, 0.0),
                normal: Vector3::z(),
                sweep: 1.25 * std::f64::consts::PI,
            });
            let helix = task(
                &machine,
                circle,
                [[45.0, 5.0, 30.0], [10.857_864_376_269_05, -9.142_135_623_730_95, 40.0]],
                angles,
            );
            check(&format!("{name} arc"), &machine, &helix);
        }
        let spline = Interpolation::Tip(Curve::Spline(Arc::new(BSpline {
            degree: 3,
            knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0],
            poles: [
                [10.0, 20.0, 30.0],
                [15.0, 30.0, 35.0],
                [25.0, 30.0, 35.0],
                [35.0, 5.0, 50.0],
                [40.0, -10.0, 55.0],
            ]
            .map(|pole| (Vector3::from(pole), 1.0))
            .to_vec(),
        })));
        let spline = task(&machine, spline, tips, [[5.0, -10.0]; 2]);
        check(&format!("{name} spline"), &machine, &spline);
    }
    // On a great circle away from the pole, by the nearest solution.
    let machine = machine("ac-trunnion");
    let vectors = task(&machine, Interpolation::TipAndAxis, tips, [[20.0, -30.0], [60.0, -40.0]]);
    check("vectors", &machine, &vectors);
}

/// Stances that are asked for together are those that are asked for one after the other, bit by bit.
#[test]
fn stances_of_a_way_are_those_of_its_places() {
    let machine = machine("ac-trunnion");
    let (rounds, mut rng) = randomised(200u64, 32);
    for _ in rounds {
        let tip = |rng: &mut Rng| [(); 3].map(|()| rng.range(-50.0, 50.0));
        let angle = |rng: &mut Rng| [rng.range(5.0, 40.0), rng.range(-90.0, 90.0)];
        let tips = [tip(&mut rng), tip(&mut rng)];
        let angles = [angle(&mut rng), angle(&mut rng)];
        let shares = [0.0, 0.1, rng.range(0.1, 0.4), 0.5, rng.range(0.6, 0.9), 1.0];
        for way in
            [Interpolation::Axes, Interpolation::Tip(Curve::Straight), Interpolation::TipAndAxis]
        {
            let task = task(&machine, way, tips, angles);
            let ends = [&task.from, &task.to];
            let mut near = task.from.joints;
            let together = task.way.stances_at(&task.solver, ends, &shares, &near).unwrap();
            for (stance, share) in together.iter().zip(shares) {
                let alone = task.way.stance_at(&task.solver, ends, share, &near).unwrap();
                near = alone.joints;
                assert_eq!(stance.joints.map(f64::to_bits), alone.joints.map(f64::to_bits));
                for (one, other) in
                    [(stance.pose.tip, alone.pose.tip), (stance.pose.axis, alone.pose.axis)]
                {
                    assert_eq!(one.map(f64::to_bits), other.map(f64::to_bits));
                }
            }
        }
    }
}
