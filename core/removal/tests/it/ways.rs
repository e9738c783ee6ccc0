//! Cuts and checks along the ways of random machines, held against samples of them.

use nalgebra::{Matrix3, Vector3};
use post_clearance::piece::Way;
use post_clearance::placement::Placement;
use post_machine::kinematics::{Joints, Solver};
use post_motion::path::{Curve, Interpolation, Stance};
use post_removal::along::{Found, Mounted, Seat, Watched, cut};
use post_removal::field::{Cutter, Field};
use post_removal::profile::ToolPose;
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::Random;

use crate::depth;

type V = Vector3<f64>;

const SIZE: V = V::new(24.0, 20.0, 16.0);

struct Case {
    machine: Random,
    solver: Solver,
    /// Where the field is on the link of the part.
    frame: Placement,
}

impl Case {
    fn any(rng: &mut Rng, near: &Joints, machine: Random) -> Option<Self> {
        let solver = Solver::new(machine.reference.chain(), &machine.free, machine.held).ok()?;
        let turn = nalgebra::Rotation3::from_axis_angle(&V::z_axis(), rng.range(-3.0, 3.0));
        let mut case = Self { machine, solver, frame: Placement::identity() };
        let rotation: Matrix3<f64> = turn.into_inner();
        let middle = rotation * V::from_fn(|axis, _| SIZE[axis] * rng.range(0.2, 0.8));
        case.frame = Placement { rotation, shift: case.on_part(near).tip - middle };
        Some(case)
    }

    /// The tool on the link of the part, by the product of the chain.
    fn on_part(&self, joints: &Joints) -> ToolPose {
        let (tip, axis) = self.machine.reference.forward(joints);
        ToolPose { tip: tip + self.machine.reference.mount, axis }
    }

    fn pose(&self, joints: &Joints) -> ToolPose {
        let pose = self.on_part(joints);
        let axis = self.frame.rotation.transpose() * pose.axis;
        ToolPose { tip: self.frame.back(pose.tip), axis }
    }

    fn mounted(&self, profile: &[[f64; 2]]) -> Mounted {
        let reference = &self.machine.reference;
        let pose = ToolPose { tip: reference.tip, axis: reference.axis };
        let top = profile.iter().map(|[z, _]| *z).fold(0.0, f64::max);
        let widest = profile.iter().map(|[_, r]| *r).fold(0.0, f64::max);
        let sphere = (pose.tip + pose.axis * 0.5 * top, libm::hypot(0.5 * top, widest));
        Mounted::new(&reference.joints, &Seat { link: 0, frame: self.frame }, pose, sphere)
    }

    fn stance(&self, joints: Joints) -> Stance {
        Stance { joints, pose: self.solver.chain().forward(&joints) }
    }
}

/// Two stances near one another, and how the control goes between them.
fn any_way(
    rng: &mut Rng,
    case: &Case,
    from: Joints,
    mut to: Joints,
) -> ([Stance; 2], Interpolation) {
    let share = rng.order(-2.5, -0.7);
    let turns = rng.pick(2) == 0;
    for (place, joint) in case.machine.reference.joints.iter().enumerate() {
        let share = if joint.rotary && !turns { 0.0 } else { share };
        to[place] = from[place] + (to[place] - from[place]) * share;
    }
    let mut ends = [case.stance(from), case.stance(to)];
    let way = match rng.pick(3) {
        0 => Interpolation::Axes,
        1 => Interpolation::Tip(Curve::Straight),
        _ => {
            let normal = rng.direction();
            let centre = ends[0].pose.tip + rng.point(10.0);
            let sweep = rng.range(-4.0, 4.0);
            let turn = nalgebra::UnitQuaternion::from_scaled_axis(normal * sweep);
            let tip = centre + turn * (ends[0].pose.tip - centre) + normal * rng.range(-5.0, 5.0);
            ends[1] = case.stance(case.machine.reference.put(tip, ends[1].joints));
            Interpolation::Tip(Curve::Arc { centre, normal, sweep })
        }
    };
    (ends, way)
}

/// Axis values along a way, none where there is no answer.
fn samples(
    case: &Case,
    ends: &[Stance; 2],
    way: &Interpolation,
    count: u32,
) -> Option<Vec<Joints>> {
    let mut near = ends[0].joints;
    let at = |look: u32| {
        let t = f64::from(look) / f64::from(count);
        near = way.joints_at(&case.solver, [&ends[0], &ends[1]], t, &near).ok()?;
        Some(near)
    };
    (0..=count).map(at).collect()
}

#[test]
fn what_no_pose_of_a_way_touches_is_never_removed() {
    let (rounds, mut rng) = randomised(240, 3321);
    let (mut removed, mut certain, mut heights) = (0, 0, 0);
    for _ in rounds {
        let free = rng.pick(3);
        let machine = Random::new(&mut rng, free, 0);
        let (from, to) = (machine.values(&mut rng), machine.values(&mut rng));
        let Some(case) = Case::any(&mut rng, &from, machine) else { continue };
        let (ends, way) = any_way(&mut rng, &case, from, to);
        let Some(joints) = samples(&case, &ends, &way, 600) else { continue };
        let r = rng.range(1.0, 6.0);
        let profile = [[0.0, r], [rng.range(5.0, 40.0), r]];
        let mut field = Field::block(SIZE, rng.range(0.5, 1.5));
        let before = field.volume();
        let way = Way {
            solver: &case.solver,
            interpolation: &way,
            ends: [&ends[0], &ends[1]],
            independent: false,
        };
        let chip = cut(&mut field, &case.mounted(&profile), &Cutter::new(&profile), &way, false);
        let (engagement, chip) = (chip.engagement, chip.volume);
        let after = field.volume();
        assert!(chip.at_least <= before.at_least - after.at_least + 1e-2);
        assert!(chip.at_most + 1e-2 >= before.at_most - after.at_most, "{chip:?} {after:?}");
        let poses: Vec<ToolPose> = joints.iter().map(|joints| case.pose(joints)).collect();
        let steps = poses.windows(2).map(|pair| {
            (pair[1].tip - pair[0].tip).norm() + 45.0 * (pair[1].axis - pair[0].axis).norm()
        });
        let between = steps.fold(1e-5, f64::max);
        for _ in 0..300 {
            let point = V::from_fn(|axis, _| rng.range(0.0, SIZE[axis]));
            let deepest = poses.iter().map(|pose| depth(&profile, pose, point));
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
            let (may, holds) = (field.may_hold(point), field.holds(point));
            assert!(may || deepest > -between, "{point:?} was removed, {deepest} deep");
            if let (Some(engaged), true) = (engagement, deepest > 0.0) {
                // What is cut is no higher above the tip as it is cut first.
                let first = poses.iter().find(|pose| depth(&profile, pose, point) > 0.0);
                let high = first.map_or(0.0, |pose| (point - pose.tip).dot(&pose.axis));
                assert!(high <= engaged.depth.at_most + between, "{high} {engaged:?}");
                heights += 1;
            }
            assert!(!holds || deepest < 1e-5, "{point:?} is said to be left, {deepest} deep");
            removed += u32::from(!may);
            certain += u32::from(holds);
        }
    }
    assert!(removed > at_least(600) && certain > at_least(8000), "{removed} {certain}");
    assert!(heights > at_least(200), "{heights}");
}

#[test]
fn no_body_is_clear_of_what_it_comes_near_to() {
    let (rounds, mut rng) = randomised(400, 3322);
    let (mut clear, mut hits, mut unproven) = (0, 0, 0);
    for _ in rounds {
        let free = rng.pick(3);
        let machine = Random::new(&mut rng, free, 0);
        let (from, to) = (machine.values(&mut rng), machine.values(&mut rng));
        let Some(case) = Case::any(&mut rng, &from, machine) else { continue };
        let mut field = Field::block(SIZE, rng.range(0.5, 1.5));
        // A wide hole around where it begins, so that much of it is clear.
        let pose = case.pose(&from);
        let r = rng.range(1.0, 4.0);
        let wide = [[0.0, r + rng.range(0.1, 5.0)], [40.0, r + 5.0]];
        let hole = Cutter::new(&wide);
        let tip = pose.tip - pose.axis * rng.range(0.1, 9.0);
        let low = ToolPose { tip, ..pose };
        field.remove(&hole, &low);
        field.doubt(&hole, &low, 0.0);
        let (ends, way) = any_way(&mut rng, &case, from, to);
        let Some(joints) = samples(&case, &ends, &way, 60) else { continue };
        // Half of the bodies begin above the tip, so that many stay clear.
        let low = if rng.pick(2) == 0 { 0.0 } else { rng.range(5.0, 40.0) };
        let profile = vec![[low, r], [low + rng.range(5.0, 40.0), r]];
        let mut watched = Watched::new(case.mounted(&profile), profile.clone(), &profile);
        let keep = rng.order(-2.0, 0.5);
        let independent = way == Interpolation::Axes && rng.pick(3) == 0;
        let interpolation = &way;
        let way =
            Way { solver: &case.solver, interpolation, ends: [&ends[0], &ends[1]], independent };
        let found = watched.along(&mut field, &way, keep, 0.05);
        // Points that are left for certain, and how near they come.
        let mut near = f64::INFINITY;
        for _ in 0..300 {
            let point = V::from_fn(|axis, _| rng.range(0.0, SIZE[axis]));
            if field.holds(point) {
                let apart = joints.iter().map(|joints| {
                    let pose = case.pose(joints);
                    let arm = point - pose.tip;
                    let z = arm.dot(&pose.axis);
                    let aside = (arm - pose.axis * z).norm() - r;
                    libm::hypot(aside.max(0.0), (low - z).max(z - profile[1][0]).max(0.0))
                });
                near = apart.fold(near, f64::min);
            }
        }
        match found {
            Found::Clear(by) => {
                clear += 1;
                assert!(by >= keep && near >= by - 1e-4, "{near} {by}");
            }
            Found::Hits(place) => {
                hits += 1;
                assert!(depth(&profile, &case.pose(&place.joints), place.point) > -1e-3);
                assert!(field.may_hold(place.point));
            }
            Found::Unproven(place) => {
                unproven += 1;
                // The place that is told is in what may be left.
                let near = (0..27).any(|at| {
                    let off = V::new(f64::from(at % 3), f64::from(at / 3 % 3), f64::from(at / 9));
                    field.may_hold(place.point + (off - V::repeat(1.0)) * 1e-4)
                });
                assert!(!place.at_most.is_finite() || near, "{place:?}");
            }
        }
    }
    println!("{clear} clear, {hits} hit, {unproven} not proven");
    assert!(clear > at_least(40) && hits > at_least(40), "{clear} {hits} {unproven}");
}
