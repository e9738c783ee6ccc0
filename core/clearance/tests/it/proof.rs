//! The proof along motions of random machines, held against samples of them.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use post_clearance::convex::Convex;
use post_clearance::piece::Way;
use post_clearance::proof::{Body, BodyKind, Look, Move, Proof, Rules, Verdict};
use post_clearance::shape::Shape;
use post_machine::kinematics::{Joints, Solver};
use post_motion::path::{Curve, Interpolation, Stance};
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::Random;

use crate::oracle::{any_piece, apart, moved, product};

type V = Vector3<f64>;

/// Triangles of a block.
pub fn block_mesh(low: V, high: V) -> Vec<[V; 3]> {
    let corner = |place: usize| {
        let pick = |axis: usize| if place >> axis & 1 == 1 { high[axis] } else { low[axis] };
        Vector3::new(pick(0), pick(1), pick(2))
    };
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
    halves.map(|corners| corners.map(corner)).collect()
}

/// Triangles of a prism of height `size` over an L of two squares and one between them.
fn bracket_mesh(size: f64) -> Vec<[V; 3]> {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |place: usize, z: f64| {
        let [x, y] = outline[place % 6];
        Vector3::new(x, y, z) * size
    };
    let caps = (1..5).flat_map(|place| {
        [
            [at(0, 1.0), at(place, 1.0), at(place + 1, 1.0)],
            [at(0, 0.0), at(place + 1, 0.0), at(place, 0.0)],
        ]
    });
    let walls = (0..6).flat_map(|place| {
        let [a, b, c, d] = [at(place, 0.0), at(place + 1, 0.0), at(place + 1, 1.0), at(place, 1.0)];
        [[a, b, c], [a, c, d]]
    });
    caps.chain(walls).collect()
}

/// A mesh around `middle`, a box or a bracket, turned anyhow, and the convex pieces that fill it.
fn mesh(rng: &mut Rng, middle: V, size: f64) -> (Shape, Vec<Convex>) {
    let (triangles, solid) = match rng.pick(2) {
        0 => {
            let half = Vector3::new(0.1, 0.1, 0.1) * size + Vector3::repeat(0.2);
            let half = half.component_mul(&Vector3::from_fn(|_, _| rng.range(0.5, 5.0)));
            (block_mesh(-half, half), vec![Convex::block(-half, half)])
        }
        _ => {
            let size = 0.4 * size;
            let long = Convex::block(Vector3::zeros(), Vector3::new(2.0, 1.0, 1.0) * size);
            let short = Convex::block(Vector3::zeros(), Vector3::new(1.0, 2.0, 1.0) * size);
            (bracket_mesh(size), vec![long, short])
        }
    };
    let turn = UnitQuaternion::from_scaled_axis(rng.point(2.0));
    let there = Isometry3::from_parts(middle.into(), turn);
    let placed = |corners: &[V; 3]| corners.map(|corner| (there * Point3::from(corner)).coords);
    let mut triangles: Vec<_> = triangles.iter().map(placed).collect();
    // Faces that look inward enclose the same.
    if rng.pick(3) == 0 {
        triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
    }
    let pieces = solid.iter().map(|piece| moved(piece, &there)).collect();
    (Shape::mesh(&triangles).unwrap(), pieces)
}

struct Bodies {
    /// Convex pieces of each.
    pieces: [Vec<Convex>; 2],
    links: [usize; 2],
    proof: Proof,
}

/// Two bodies on two links of a machine.
fn bodies(rng: &mut Rng, machine: &Random, size: f64, rules: Rules) -> Bodies {
    let joints = &machine.reference.joints;
    let (first, second) = loop {
        let links = (rng.pick(joints.len() + 1), rng.pick(joints.len() + 1));
        if links.0 != links.1 {
            break links;
        }
    };
    let mut shape = || {
        let middle = rng.point(300.0);
        if rng.pick(3) == 0 {
            return mesh(rng, middle, size);
        }
        let count = 1 + rng.pick(3);
        let mut pieces = Vec::new();
        for _ in 0..count {
            let at = middle + rng.point(size);
            pieces.push(any_piece(rng, at, size));
        }
        (Shape::new(pieces.clone()).unwrap(), pieces)
    };
    let [(one, filled), (other, beside)] = [shape(), shape()];
    let body = |link, shape| Body { name: String::new(), kind: BodyKind::Machine, link, shape };
    let all = vec![body(first, one), body(second, other)];
    let pieces = [filled, beside];
    let proof = Proof::new(joints, all, rules, |_, _| true);
    Bodies { pieces, links: [first, second], proof }
}

impl Bodies {
    /// Begins the proof anew, by other rules.
    fn keep(&mut self, machine: &Random, rules: Rules) {
        let all = self.proof.bodies().to_vec();
        self.proof = Proof::new(&machine.reference.joints, all, rules, |_, _| true);
    }

    /// The distance at a pose, by other means: no less than it is.
    fn apart(&self, machine: &Random, q: &Joints) -> f64 {
        let place = |link: usize| product(&machine.reference.joints, q, 0, link);
        let [one, other] = self.links.map(place);
        let found = self.pieces[0].iter().flat_map(|first| {
            let first = moved(first, &one);
            self.pieces[1].iter().map(move |second| apart(&first, &moved(second, &other)))
        });
        found.fold(f64::INFINITY, f64::min)
    }

    fn take(
        &mut self,
        solver: &Solver,
        way: &Interpolation,
        ends: [&Stance; 2],
        independent: bool,
    ) {
        let way = Way { solver, interpolation: way, ends, independent };
        self.proof.take(
            &Move { way, rapid: independent, line: 1, beyond: None, instead: false },
            |_, _| Look::Prove,
        );
    }
}

fn stance(solver: &Solver, joints: Joints) -> Stance {
    Stance { joints, pose: solver.chain().forward(&joints) }
}

fn solver(machine: &Random) -> Option<Solver> {
    Solver::new(machine.reference.chain(), &machine.free, machine.held).ok()
}

/// What came of random motions.
#[derive(Default, Debug)]
struct Count {
    clear: u32,
    faults: u32,
    close: u32,
}

/// Holds a motion against samples of it.
fn judge(bodies: &Bodies, sampled: f64, rules: &Rules, count: &mut Count) {
    let result = bodies.proof.results().next().unwrap().clone();
    if result.faults > 0 {
        count.faults += 1;
        return;
    }
    count.clear += 1;
    assert!(result.clear_by <= sampled + 1e-9, "proven {} sampled {sampled}", result.clear_by);
    assert!(sampled >= rules.keep, "{sampled}");
    if result.clear_by >= 0.93 * sampled - 2.0 * rules.within {
        count.close += 1;
    }
}

#[test]
fn no_motion_of_axes_comes_nearer_than_is_proven() {
    let (rounds, mut rng) = randomised(1500, 311);
    let mut count = Count::default();
    for _ in rounds {
        let (free, held) = (rng.pick(3), rng.pick(2));
        let machine = Random::new(&mut rng, free, held);
        let Some(solver) = solver(&machine) else { continue };
        let rules = Rules { keep: rng.order(-2.0, 1.3), rapid: 0.0, within: 0.01 };
        let size = rng.range(20.0, 200.0);
        let mut bodies = bodies(&mut rng, &machine, size, rules);
        let mut sampled = f64::INFINITY;
        let mut from = machine.values(&mut rng);
        // Motions in a row: what is known of the first holds on.
        let (motions, most) = if rng.pick(4) == 0 { (12, -1.0) } else { (3, 0.0) };
        for _ in 0..motions {
            let mut to = machine.values(&mut rng);
            let share = rng.order(-3.0, most);
            for (to, from) in to.iter_mut().zip(from) {
                *to = from + (*to - from) * share;
            }
            let ends = [stance(&solver, from), stance(&solver, to)];
            bodies.take(&solver, &Interpolation::Axes, [&ends[0], &ends[1]], false);
            for look in 0..=24 {
                let t = f64::from(look) / 24.0;
                let q = std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * t);
                sampled = sampled.min(bodies.apart(&machine, &q));
            }
            from = to;
        }
        judge(&bodies, sampled, &rules, &mut count);
        // What is found at a pose is one.
        let result = bodies.proof.results().next().unwrap();
        if let Some(fault) = &result.fault {
            assert!(fault.at_most < rules.keep + 3.0 * rules.within || sampled < rules.keep);
        }
    }
    assert!(count.clear > at_least(300) && count.faults > at_least(30), "{count:?}");
    assert!(count.close * 20 >= count.clear * 19, "{count:?}");
}

#[test]
fn axes_that_arrive_when_they_like_stay_as_far_apart_as_is_proven() {
    let (rounds, mut rng) = randomised(1200, 312);
    let mut count = Count::default();
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let rules = Rules { keep: 0.0, rapid: rng.order(-2.0, 1.3), within: 0.05 };
        let size = rng.range(20.0, 150.0);
        let mut bodies = bodies(&mut rng, &machine, size, rules);
        let from = machine.values(&mut rng);
        let mut to = machine.values(&mut rng);
        let share = rng.order(-3.0, 0.0);
        for (to, from) in to.iter_mut().zip(from) {
            *to = from + (*to - from) * share;
        }
        let ends = [stance(&solver, from), stance(&solver, to)];
        bodies.take(&solver, &Interpolation::Axes, [&ends[0], &ends[1]], true);
        let mut sampled = f64::INFINITY;
        for _ in 0..60 {
            let q = std::array::from_fn(|axis| {
                from[axis] + (to[axis] - from[axis]) * rng.range(0.0, 1.0)
            });
            sampled = sampled.min(bodies.apart(&machine, &q));
        }
        let rules = Rules { keep: rules.rapid, ..rules };
        judge(&bodies, sampled, &rules, &mut count);
    }
    assert!(count.clear > at_least(100) && count.faults > at_least(15), "{count:?}");
}

/// Boxes of five axes, wide as those of rapids: what is to spare by half is proven, and what is not is told without a hit.
#[test]
fn what_is_kept_anywhere_in_a_box_with_half_to_spare_is_proven() {
    let (rounds, mut rng) = randomised(300, 319);
    let (mut proven, mut all, mut unfinished) = (0, 0, 0);
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let size = rng.range(20.0, 100.0);
        let from = machine.values(&mut rng);
        let mut to = machine.values(&mut rng);
        let share = rng.order(-1.5, 0.0);
        for (to, from) in to.iter_mut().zip(from) {
            *to = from + (*to - from) * share;
        }
        let ends = [stance(&solver, from), stance(&solver, to)];
        let mut bodies = bodies(&mut rng, &machine, size, Rules::default());
        let mut sampled = f64::INFINITY;
        for look in 0..200 {
            let q = std::array::from_fn(|axis| {
                let share = if look < 100 { rng.pick(2) as f64 } else { rng.range(0.0, 1.0) };
                from[axis] + (to[axis] - from[axis]) * share
            });
            sampled = sampled.min(bodies.apart(&machine, &q));
        }
        let rapid = 0.5 * sampled - 0.1;
        if rapid <= 0.0 {
            continue;
        }
        bodies.keep(&machine, Rules { rapid, ..Rules::default() });
        bodies.take(&solver, &Interpolation::Axes, [&ends[0], &ends[1]], true);
        all += 1;
        let result = bodies.proof.results().next().unwrap();
        proven += u32::from(result.faults == 0);
        if let Some(fault) = &result.fault {
            let moving = (0..from.len()).filter(|axis| from[*axis] != to[*axis]).count();
            let box_of = matches!(fault.verdict, Verdict::Unproven | Verdict::Unfinished);
            assert!(box_of || moving < 2, "{fault:?}");
            unfinished += u32::from(fault.verdict == Verdict::Unfinished);
        }
    }
    println!("{proven} of {all} proven, the work ran out on {unfinished}");
    assert!(all > at_least(50) && proven * 100 >= all * 90, "{proven} of {all}");
}

#[test]
fn a_tip_that_the_control_keeps_is_proven_by_where_the_axes_go() {
    let (rounds, mut rng) = randomised(800, 313);
    let mut count = Count::default();
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let rules = Rules { keep: rng.order(-2.0, 1.3), rapid: 0.0, within: 0.01 };
        let size = rng.range(20.0, 200.0);
        let mut bodies = bodies(&mut rng, &machine, size, rules);
        let from = machine.values(&mut rng);
        let mut to = machine.values(&mut rng);
        let share = rng.order(-3.0, -0.5);
        for (to, from) in to.iter_mut().zip(from) {
            *to = from + (*to - from) * share;
        }
        let mut ends = [stance(&solver, from), stance(&solver, to)];
        let curve = match rng.pick(3) {
            0 => {
                // The end is where the arc leads.
                let normal = rng.direction();
                let centre = ends[0].pose.tip + rng.point(100.0);
                let sweep = rng.range(-6.0, 6.0);
                let arm = ends[0].pose.tip - centre;
                let turn = nalgebra::UnitQuaternion::from_scaled_axis(normal * sweep);
                let tip = centre + turn * arm + normal * rng.range(-20.0, 20.0);
                let joints = machine.reference.put(tip, ends[1].joints);
                ends[1] = stance(&solver, joints);
                Curve::Arc { centre, normal, sweep }
            }
            _ => Curve::Straight,
        };
        let way = Interpolation::Tip(curve);
        bodies.take(&solver, &way, [&ends[0], &ends[1]], false);
        let mut sampled = f64::INFINITY;
        let (mut near, mut lost) = (from, false);
        for look in 0..=40 {
            let t = f64::from(look) / 40.0;
            let Ok(q) = way.joints_at(&solver, [&ends[0], &ends[1]], t, &near) else {
                lost = true;
                break;
            };
            near = q;
            sampled = sampled.min(bodies.apart(&machine, &q));
        }
        if !lost {
            judge(&bodies, sampled, &rules, &mut count);
        }
    }
    assert!(count.clear > at_least(80) && count.faults > at_least(50), "{count:?}");
}

/// Of several bodies the nearest two are told of each motion by itself, whatever was known of the motion before.
#[test]
fn on_each_motion_the_nearest_two_are_told() {
    let (rounds, mut rng) = randomised(600, 315);
    let (mut told, mut close, mut touching) = (0, 0, 0);
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let joints = &machine.reference.joints;
        let size = rng.range(20.0, 120.0);
        let mut piece = || {
            let at = rng.point(150.0);
            any_piece(&mut rng, at, size)
        };
        let pieces = [0, joints.len(), 0, joints.len()].map(|link| (link, piece()));
        let body = |(link, piece): &(usize, Convex)| Body {
            name: String::new(),
            kind: BodyKind::Machine,
            link: *link,
            shape: Shape::new(vec![piece.clone()]).unwrap(),
        };
        let all = pieces.iter().map(body).collect();
        let mut proof = Proof::new(joints, all, Rules::default(), |_, _| true);
        let mut from = machine.values(&mut rng);
        for _ in 0..4 {
            let mut to = machine.values(&mut rng);
            let share = rng.order(-3.0, -0.5);
            for (to, from) in to.iter_mut().zip(from) {
                *to = from + (*to - from) * share;
            }
            let ends = [stance(&solver, from), stance(&solver, to)];
            let way = Way {
                solver: &solver,
                interpolation: &Interpolation::Axes,
                ends: [&ends[0], &ends[1]],
                independent: false,
            };
            let found = proof
                .closest(
                    &Move { way, rapid: false, line: 1, beyond: None, instead: false },
                    |_, _| Look::Prove,
                )
                .unwrap();
            let mut sampled = f64::INFINITY;
            for look in 0..=24 {
                let t = f64::from(look) / 24.0;
                let q = std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * t);
                let placed = pieces
                    .each_ref()
                    .map(|(link, piece)| (*link, moved(piece, &product(joints, &q, 0, *link))));
                for (first, one) in &placed {
                    for (_, other) in placed.iter().filter(|(second, _)| second > first) {
                        sampled = sampled.min(apart(one, other));
                    }
                }
            }
            assert!(found <= sampled + 1e-9, "told {found} sampled {sampled}");
            touching += u32::from(found == 0.0);
            if found > 0.0 {
                told += 1;
                close += u32::from(found >= 0.93 * sampled - 0.03);
            }
            from = to;
        }
    }
    assert!(told > at_least(300) && touching > 0, "{told} {touching}");
    assert!(close * 20 >= told * 19, "{close} of {told}");
}

/// Many bodies along many motions, short ones mostly: pairs that sleep in a box of axis values are as far apart there as is
/// proven.
#[test]
fn pairs_that_sleep_are_as_far_apart_as_is_proven() {
    let (rounds, mut rng) = randomised(90, 318);
    let (mut clear, mut close, mut faults, mut distances, mut motions) = (0, 0, 0, 0, 0);
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let joints = &machine.reference.joints;
        let size = rng.range(10.0, 80.0);
        let pieces: Vec<(usize, Convex)> = (0..6)
            .map(|_| {
                let at = rng.point(300.0);
                (rng.pick(joints.len() + 1), any_piece(&mut rng, at, size))
            })
            .collect();
        let body = |(link, piece): &(usize, Convex)| Body {
            name: String::new(),
            kind: BodyKind::Machine,
            link: *link,
            shape: Shape::new(vec![piece.clone()]).unwrap(),
        };
        let rules = Rules { keep: rng.order(-2.0, 1.0), rapid: rng.order(-2.0, 1.0), within: 0.01 };
        let all = pieces.iter().map(body).collect();
        let mut proof = Proof::new(joints, all, rules, |_, _| true);
        let order: Vec<_> = proof.results().map(|result| result.bodies).collect();
        let mut sampled = BTreeMap::new();
        let mut from = machine.values(&mut rng);
        for motion in 0..120 {
            let mut to = machine.values(&mut rng);
            let share = if motion % 40 == 10 { 0.3 } else { rng.order(-4.5, -2.5) };
            for (to, from) in to.iter_mut().zip(from) {
                // Some axes stand still.
                *to = from + (*to - from) * share * f64::from(rng.pick(3).min(1) as u8);
            }
            let ends = [stance(&solver, from), stance(&solver, to)];
            let rapid = rng.pick(4) == 0;
            let interpolation = &Interpolation::Axes;
            let way = Way {
                solver: &solver,
                interpolation,
                ends: [&ends[0], &ends[1]],
                independent: rapid,
            };
            // Ways that keep more come between others: who sleeps by what those keep is looked at again.
            let beyond = (rng.pick(4) == 0).then(|| rng.range(0.0, 4.0));
            let keep = if rapid { rules.rapid } else { rules.keep } + beyond.unwrap_or(0.0);
            let before: Vec<u64> = proof.results().map(|result| result.faults).collect();
            proof.take(&Move { way, rapid, line: motion, beyond, instead: false }, |_, _| {
                Look::Prove
            });
            let now = proof.results().zip(before);
            let kept = now.filter(|(result, before)| result.faults == *before);
            let kept: BTreeSet<[usize; 2]> = kept.map(|(result, _)| result.bodies).collect();
            motions += 1;
            for look in 0..=3 {
                let t = f64::from(look) / 3.0;
                let share = |_| if rapid { rng.range(0.0, 1.0) } else { t };
                let shares: [f64; post_machine::kinematics::MAX_AXES] = std::array::from_fn(share);
                let q =
                    std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * shares[axis]);
                let placed: Vec<_> = pieces
                    .iter()
                    .map(|(link, piece)| moved(piece, &product(joints, &q, 0, *link)))
                    .collect();
                for first in 0..placed.len() {
                    for second in first + 1..placed.len() {
                        let found = apart(&placed[first], &placed[second]);
                        let keeps = !kept.contains(&[first, second]) || found >= keep - 1e-9;
                        assert!(keeps, "{found} apart where {keep} are kept");
                        let least = sampled.entry([first, second]).or_insert(f64::INFINITY);
                        *least = found.min(*least);
                    }
                }
            }
            from = to;
        }
        // Whoever compares results of two motions counts on their order.
        assert!(proof.results().map(|result| result.bodies).eq(order));
        distances += proof.distances();
        for result in proof.results() {
            let truth = sampled[&result.bodies];
            if result.faults > 0 {
                faults += 1;
                continue;
            }
            clear += 1;
            assert!(result.clear_by <= truth + 1e-9, "proven {} sampled {truth}", result.clear_by);
            close += u32::from(result.clear_by >= 0.93 * result.nearest.0 - 0.02);
        }
    }
    println!("{clear} clear, {faults} not, {distances} distances on {motions} motions");
    assert!(clear > at_least(200), "{clear} {faults}");
    assert!(close * 20 >= clear * 19, "{close} of {clear}");
}

/// A tool along a fixture of curved pieces: what is to spare by a hundredth is proven.
#[test]
fn what_is_kept_with_a_hundredth_to_spare_is_proven() {
    let (rounds, mut rng) = randomised(300, 316);
    let (mut proven, mut all) = (0, 0);
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let size = rng.range(20.0, 100.0);
        let from = machine.values(&mut rng);
        let mut to = machine.values(&mut rng);
        let share = rng.order(-3.0, -1.0);
        for (to, from) in to.iter_mut().zip(from) {
            *to = from + (*to - from) * share;
        }
        let ends = [stance(&solver, from), stance(&solver, to)];
        let mut bodies = bodies(&mut rng, &machine, size, Rules::default());
        let looks = (0..=200).map(|look| {
            let t = f64::from(look) / 200.0;
            let q = std::array::from_fn(|axis| from[axis] + (to[axis] - from[axis]) * t);
            bodies.apart(&machine, &q)
        });
        let sampled = looks.fold(f64::INFINITY, f64::min);
        let keep = 0.99 * sampled - 0.03;
        if keep <= 0.0 {
            continue;
        }
        bodies.keep(&machine, Rules { keep, ..Rules::default() });
        bodies.take(&solver, &Interpolation::Axes, [&ends[0], &ends[1]], false);
        all += 1;
        proven += u32::from(bodies.proof.results().next().unwrap().faults == 0);
    }
    assert!(all > at_least(50) && proven * 100 >= all * 95, "{proven} of {all}");
}

/// Parts of a mesh that are closed and convex are taken whole, and no others.
#[test]
fn a_part_is_convex_if_no_face_has_a_corner_above_it() {
    let (rounds, mut rng) = randomised(300, 315);
    for _ in rounds {
        let size = rng.range(1.0, 100.0);
        let (shape, pieces) = mesh(&mut rng, Vector3::zeros(), size);
        let bracket = pieces.len() > 1;
        assert_eq!(shape.pieces(), if bracket { 20 } else { 1 });
        let half = Vector3::repeat(size);
        let mut open = block_mesh(-half, half);
        open.truncate(10);
        assert_eq!(Shape::mesh(&open).unwrap().pieces(), 10);
        // Two of them that share no corner, of which one is dented.
        let mut both = block_mesh(-half, half);
        let dented = block_mesh(half * 2.0, half * 4.0);
        let middle = Vector3::new(3.0, 3.0, rng.range(2.1, 3.9)) * size;
        both.extend(dented.iter().enumerate().flat_map(|(place, [a, b, c])| match place {
            2 => vec![[*a, *b, middle], [*b, *c, middle], [*c, *a, middle]],
            _ => vec![[*a, *b, *c]],
        }));
        let shape = Shape::mesh(&both).unwrap();
        assert_eq!((shape.parts(), shape.pieces()), (2, 15));
    }
}

/// A body inside another whose surface it does not touch.
#[test]
fn what_a_mesh_encloses_hits() {
    let (rounds, mut rng) = randomised(1200, 314);
    let mut hits = 0;
    for _ in rounds {
        let machine = Random::new(&mut rng, 2, 0);
        let Some(solver) = solver(&machine) else { continue };
        let size = rng.range(50.0, 400.0);
        let block = Vector3::repeat(size);
        let links = [0, machine.reference.joints.len()];
        let ball = Convex::ball(rng.point(500.0), rng.range(1.0, 30.0));
        let body = |link, shape| Body { name: String::new(), kind: BodyKind::Machine, link, shape };
        let mesh = Shape::mesh(&block_mesh(-block, block)).unwrap();
        let solid = Shape::new(vec![Convex::block(-block, block)]).unwrap();
        let q = machine.values(&mut rng);
        let found = [mesh, solid].map(|shape| {
            let ball = Shape::new(vec![ball.clone()]).unwrap();
            let all = vec![body(links[0], shape), body(links[1], ball)];
            let joints = &machine.reference.joints;
            let mut proof = Proof::new(joints, all, Rules::default(), |_, _| true);
            let at = stance(&solver, q);
            let way = Way {
                solver: &solver,
                interpolation: &Interpolation::Axes,
                ends: [&at, &at],
                independent: false,
            };
            proof.take(
                &Move { way, rapid: false, line: 1, beyond: None, instead: false },
                |_, _| Look::Prove,
            );
            proof.results().next().unwrap().faults
        });
        assert_eq!(found[0], found[1]);
        hits += found[0];
    }
    assert!(hits > 5, "{hits}");
}
