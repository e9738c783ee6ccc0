//! Chains with two linear axes, which a rotary axis carries round the part.

use post_machine::kinematics::Joint;
use post_testmachines::{Reference, distance};

use super::*;

/// What the tip may miss, mm.
const TOLERANCE: f64 = 0.01;

/// A chain of a rotary axis, two linear ones behind it in any directions, and perhaps a head that swings the tool.
struct Polar {
    machine: Random,
    solver: Solver,
}

impl Polar {
    /// With a head the tool lies anywhere; without one it lies along the rotary axis, or across it.
    fn new(rng: &mut Rng, head: bool, across_it: bool) -> Self {
        let mut kinds = vec![true, false, false];
        kinds.extend(head.then_some(true));
        let joints: Vec<Joint> = kinds
            .iter()
            .map(|rotary| Joint {
                rotary: *rotary,
                direction: rng.direction(),
                point: rng.point(SIZE),
            })
            .collect();
        let k = joints[0].direction;
        let axis = match (head, across_it) {
            (true, _) => rng.direction(),
            (false, true) => across(rng, k),
            (false, false) => k,
        };
        let reference = Reference { joints, mount: rng.point(SIZE), tip: rng.point(SIZE), axis };
        let free: Vec<usize> = (0..kinds.len()).filter(|joint| kinds[*joint]).collect();
        let held = Joints::default();
        let solver = Solver::new(reference.chain(), &free, held).expect("a form");
        assert!(solver.planar() && !solver.closed_form());
        Self { machine: Random { reference, free, held }, solver: solver.within(TOLERANCE) }
    }

    fn pose(&self, q: &Joints) -> Pose {
        let (tip, axis) = self.machine.reference.forward(q);
        Pose { tip, axis, ..Pose::default() }
    }

    /// By how much the isometries of `found` miss the tip, mm; the tool axis is met.
    fn miss(&self, pose: &Pose, found: &Joints, most: f64) -> f64 {
        let (tip, axis) = self.machine.reference.forward(found);
        assert!(angle(axis, pose.axis) <= most, "{found:?}");
        (tip - pose.tip).norm()
    }

    /// Normal of the plane of the two linear axes, part frame.
    fn normal(&self, q: &Joints) -> Vector3<f64> {
        let [a, b] = [1, 2].map(|joint| self.machine.reference.direction(q, joint));
        a.cross(&b).normalize()
    }
}

/// What stands behind a pose is found again, with no more than a second solution beside it, and the isometries say so too.
#[test]
fn poses_of_two_linear_axes_are_solved_in_closed_form() {
    let (rounds, mut rng) = randomised(400, 3);
    let (mut both, mut worst, mut poses) = (0, 0.0f64, 0);
    for (head, across_it) in [(false, false), (false, true), (true, false)] {
        for _ in rounds.clone() {
            let polar = Polar::new(&mut rng, head, across_it);
            let q = polar.machine.values(&mut rng);
            let pose = polar.pose(&q);
            let found = polar.solver.inverse(&pose, &polar.machine.held, 1e-9);
            let found = found.unwrap_or_else(|fault| panic!("{fault:?} at {q:?}"));
            poses += 1;
            both += usize::from(found.len() == 2);
            assert!(found.len() <= if across_it { 1 } else { 2 });
            let own = |found: &Joints| apart(&polar.machine, found, &q) < 1e-3;
            assert!(found.iter().any(own), "{q:?} {found:?}");
            for solution in &found {
                // A second solution of a head lies in the plane by chance alone.
                let most = if head && !own(solution) { TOLERANCE + 2e-6 } else { 1e-6 };
                let miss = polar.miss(&pose, solution, 2e-9);
                assert!(miss <= most, "{miss}");
                worst = worst.max(if own(solution) { miss } else { 0.0 });
            }
        }
    }
    assert!(worst < 1e-9 * 4.0 * SIZE, "{worst}");
    assert!(both > poses / 5, "{both} of {poses} poses with two solutions");
}

/// Where the rotary axis points the tool the tip must lie in the plane: what it misses by is reached as nearly as it can be,
/// or refused with the distance.
#[test]
fn a_tip_beside_the_plane_is_reached_within_tolerance_or_refused() {
    let (rounds, mut rng) = randomised(300, 3);
    for _ in rounds {
        let polar = Polar::new(&mut rng, false, true);
        let q = polar.machine.values(&mut rng);
        let mut pose = polar.pose(&q);
        let off = rng.range(-2.0, 2.0) * TOLERANCE;
        pose.tip += polar.normal(&q) * off;
        match polar.solver.inverse(&pose, &q, 1e-9) {
            Ok(found) => {
                assert!(off.abs() <= TOLERANCE + 2e-6, "{off}");
                let miss = polar.miss(&pose, &found[0], 2e-9);
                assert!((miss - off.abs()).abs() < 2e-6, "{miss} {off}");
            }
            Err(Unreachable::Plane { miss }) => {
                assert!(off.abs() > TOLERANCE && (miss - off.abs()).abs() < 2e-6, "{miss} {off}");
            }
            Err(other) => panic!("{other:?}"),
        }
    }
}

/// A cut goes on along its chord without a jump: as far from the centre line as the chord is, no step turns farther than its
/// share of the way; both sides are offered where it passes that line.
#[test]
fn a_chord_is_gone_along_on_one_side_of_the_centre_line() {
    let (rounds, mut rng) = randomised(200, 3);
    let (mut gone, mut crossed) = (0, 0);
    for _ in rounds {
        let polar = Polar::new(&mut rng, false, false);
        let reference = &polar.machine.reference;
        let from = polar.machine.values(&mut rng);
        let start = polar.pose(&from);
        let end = polar.pose(&polar.machine.values(&mut rng));
        let at = |share: f64| Pose { tip: start.tip * (1.0 - share) + end.tip * share, ..start };
        let meeting = polar.solver.meeting([start.tip, end.tip], &from).expect("a carrier");
        // Inside the ring that the plane never comes to, there is nothing to go along.
        if polar.solver.inverse(&at(meeting.share), &from, 1e-9).is_err() {
            continue;
        }
        if meeting.gap <= TOLERANCE {
            crossed += 1;
            continue;
        }
        let mut joints = from;
        let mut last = start;
        for step in 1..=200 {
            let next = at(f64::from(step) / 200.0);
            let Ok(ways) = polar.solver.next([&last, &next], &joints, 1e-9) else {
                break;
            };
            assert!(ways.len() == 1 && ways[0].sure, "{ways:?}");
            let to = ways[0].joints;
            assert!(polar.miss(&next, &to, 2e-9) < 1e-6);
            // Halfway the axes are where the chord is nearly: nothing has jumped to the other side.
            let halfway: Joints = std::array::from_fn(|place| (joints[place] + to[place]) / 2.0);
            let middle = reference.forward(&halfway).0;
            let step = (next.tip - last.tip).norm();
            let off = distance(middle, last.tip, next.tip);
            let turn = (to[0] - joints[0]).abs();
            assert!(turn < 2.0 * step / meeting.gap, "{turn} {step} {meeting:?}");
            assert!(off <= step, "{off} of {step}");
            (joints, last) = (to, next);
            gone += 1;
        }
    }
    assert!(gone > 0 && crossed < gone);
}

/// Two linear axes alone reach what lies in their plane.
#[test]
fn two_axes_drill_in_their_plane() {
    let (rounds, mut rng) = randomised(60, 3);
    for _ in rounds {
        let joints = (0..2)
            .map(|_| Joint { rotary: false, direction: rng.direction(), point: Vector3::zeros() })
            .collect();
        let reference = Reference {
            joints,
            mount: rng.point(SIZE),
            tip: rng.point(SIZE),
            axis: rng.direction(),
        };
        let solver = Solver::new(reference.chain(), &[], Joints::default()).expect("a form");
        let solver = solver.within(TOLERANCE);
        let q = std::array::from_fn(|place| if place < 2 { rng.range(-SIZE, SIZE) } else { 0.0 });
        let (tip, axis) = reference.forward(&q);
        let pose = Pose { tip, axis, ..Pose::default() };
        let found = solver.inverse(&pose, &q, 1e-9).expect("a solution");
        assert!((reference.forward(&found[0]).0 - tip).norm() < 1e-6);
        let [a, b] = [0, 1].map(|joint| reference.joints[joint].direction);
        let beside = Pose { tip: tip + a.cross(&b).normalize() * (2.0 * TOLERANCE), ..pose };
        let refused = solver.inverse(&beside, &q, 1e-9);
        assert!(matches!(refused, Err(Unreachable::Plane { .. })), "{refused:?}");
    }
}
