//! Distances of convex pieces and of shapes.

use nalgebra::{UnitQuaternion, Vector3};
use post_clearance::convex::Convex;
use post_clearance::distance::{meeting, of_convex, of_shapes};
use post_clearance::placement::Placement;
use post_clearance::shape::Shape;
use post_testkit::randomised;

use crate::oracle::{any_piece, apart, moved};

/// Closed forms are kept to this, mm.
const SAME: f64 = 1e-5;

#[test]
fn closed_forms_of_balls_boxes_and_cylinders() {
    let v = Vector3::new;
    let ball = Convex::ball(v(0.0, 0.0, 0.0), 3.0);
    let block = Convex::block(v(-5.0, -5.0, -5.0), v(5.0, 5.0, 5.0));
    let cylinder =
        |at: f64| Convex::frustum([v(at, 0.0, -20.0), v(at, 0.0, 20.0)], Vector3::z(), [4.0, 4.0]);
    let cases = [
        (ball.clone(), Convex::ball(v(10.0, 0.0, 0.0), 2.0), 5.0),
        (block.clone(), Convex::ball(v(8.0, 9.0, 5.0), 1.0), 4.0),
        (block.clone(), Convex::block(v(8.0, 9.0, 7.0), v(9.0, 10.0, 8.0)), 29f64.sqrt()),
        (cylinder(0.0), cylinder(10.0), 2.0),
        (block, cylinder(12.0), 3.0),
        (ball.clone(), Convex::ball(v(4.0, 0.0, 0.0), 2.0), 0.0),
        (ball, cylinder(7.0), 0.0),
    ];
    for (one, other, wanted) in cases {
        let found = of_convex(&one, &other);
        assert!(found.at_least <= wanted && wanted <= found.at_most + 1e-9, "{found:?} {wanted}");
        assert!(found.at_most - found.at_least < SAME, "{found:?} {wanted}");
    }
}

/// How far a point is outside of a box about the origin, and of a frustum, mm.
fn off_block(point: Vector3<f64>, half: Vector3<f64>) -> f64 {
    (point.abs() - half).sup(&Vector3::zeros()).norm()
}

fn off_cylinder(
    point: Vector3<f64>,
    from: Vector3<f64>,
    axis: Vector3<f64>,
    [long, radius]: [f64; 2],
) -> f64 {
    let arm = point - from;
    let z = axis.dot(&arm);
    libm::hypot(((arm - axis * z).norm() - radius).max(0.0), (-z).max(z - long).max(0.0))
}

/// The place that is told of two bodies is on both where they overlap, and else on each, as far apart as they are.
#[test]
fn the_place_that_is_told_is_on_the_bodies() {
    let (rounds, mut rng) = randomised(4000, 302);
    let (mut over, mut beside) = (0, 0);
    for _ in rounds {
        let half = Vector3::from_fn(|_, _| rng.range(0.5, 60.0));
        let block = Convex::block(-half, half);
        let axis = Vector3::from_fn(|_, _| rng.range(-1.0, 1.0));
        let Some(axis) = axis.try_normalize(1e-2) else { continue };
        let from = Vector3::from_fn(|axis, _| half[axis] * rng.range(-1.5, 1.5));
        let size = [rng.range(0.5, 80.0), rng.range(0.1, 30.0)];
        let cylinder = Convex::frustum([from, from + axis * size[0]], axis, [size[1]; 2]);
        let found = of_convex(&block, &cylinder);
        let points = meeting(&block, &cylinder);
        let off = |points: [Vector3<f64>; 2]| {
            off_block(points[0], half).max(off_cylinder(points[1], from, axis, size))
        };
        if found.at_most <= 0.0 {
            over += 1;
            assert!(points[0] == points[1] && off(points) < 1e-5, "{points:?} {}", off(points));
        } else {
            beside += 1;
            let apart = (points[1] - points[0]).norm();
            assert!(off(points) < 1e-5 && (apart - found.at_most).abs() < 1e-5, "{points:?}");
            assert!(off(found.points) < 1e-5, "{:?}", found.points);
        }
    }
    assert!(over > 100 && beside > 100, "{over} {beside}");
    // Of what is round the surface counts, and not the core.
    let ball = Convex::ball(Vector3::zeros(), 3.0);
    let [first, last] = of_convex(&ball, &Convex::ball(Vector3::x() * 10.0, 2.0)).points;
    assert!(
        (first - Vector3::x() * 3.0).norm() < 1e-6 && (last - Vector3::x() * 8.0).norm() < 1e-6
    );
    let [first, last] = meeting(&ball, &Convex::ball(Vector3::x() * 4.0, 2.0));
    assert!(first == last && first.norm() < 3.0 && (first - Vector3::x() * 4.0).norm() < 2.0);
}

#[test]
fn no_piece_is_nearer_than_is_proven() {
    let (rounds, mut rng) = randomised(6000, 301);
    let (mut close, mut all) = (0, 0);
    for _ in rounds {
        let size = rng.order(-0.3, 1.9);
        let one = any_piece(&mut rng, Vector3::zeros(), size);
        let at = rng.point(3.0 * size);
        let other = any_piece(&mut rng, at, size);
        let found = of_convex(&one, &other);
        let truth = apart(&one, &other);
        // Going to and fro comes near slowly, but never nearer than they are.
        assert!(found.at_least <= truth + 1e-9, "{found:?} {truth} {one:?} {other:?}");
        all += 1;
        if found.at_most - found.at_least <= 1e-5 + 1e-6 * truth {
            close += 1;
        }
        assert!(found.at_most >= found.at_least);
    }
    assert!(close * 1000 >= all * 999, "{close} of {all}");
}

/// What rounding leaves of a direction along the axis of a disc points anywhere: it once was taken for a way out of the disc.
#[test]
fn a_disc_is_as_far_as_its_middle_along_its_axis() {
    let (rounds, mut rng) = randomised(6000, 304);
    for _ in rounds {
        let (axis, start) = (rng.direction(), rng.point(30.0));
        let (gap, radius) = (rng.order(-1.0, 2.0), rng.order(-1.0, 2.0));
        let ends = [start, start + axis * rng.range(0.0, 20.0)];
        let one = Convex::ball(start - axis * (gap + 3.0), 3.0);
        let found = of_convex(&one, &Convex::frustum(ends, axis, [radius, 2.0 * radius]));
        assert!(found.at_least <= gap && gap <= found.at_most + 1e-9, "{found:?} {gap}");
        assert!(found.at_most - found.at_least < SAME, "{found:?} {gap}");
    }
}

#[test]
fn slivers_are_never_farther_than_they_are() {
    let (rounds, mut rng) = randomised(6000, 302);
    for _ in rounds {
        // Corners nearly on a line, one edge a millionth of the others, needles side by side.
        let mut sliver = || {
            let (from, along) = (rng.point(20.0), rng.direction());
            let (length, thin) = (rng.order(0.0, 2.5), rng.order(-12.0, -2.0));
            let side = rng.direction() * thin;
            Convex::triangle([from, from + along * length, from + along * (length * 0.5) + side])
        };
        let (one, other) = (sliver(), sliver());
        let (found, truth) = (of_convex(&one, &other), apart(&one, &other));
        assert!(found.at_least <= truth + 1e-9, "{found:?} {truth} {one:?} {other:?}");
        // The planes prove it though the search has little to go by.
        assert!(
            found.at_least >= 0.99 * found.at_most - 1e-4,
            "{found:?} {truth} {one:?} {other:?}"
        );
    }
}

#[test]
fn the_tree_passes_over_nothing() {
    let (rounds, mut rng) = randomised(300, 303);
    for _ in rounds {
        let pieces = |rng: &mut post_testkit::Rng| -> Vec<Convex> {
            let count = 1 + rng.pick(40);
            (0..count)
                .map(|_| {
                    let at = rng.point(100.0);
                    any_piece(rng, at, 8.0)
                })
                .collect()
        };
        let (one, other) = (pieces(&mut rng), pieces(&mut rng));
        let turn = UnitQuaternion::from_scaled_axis(rng.point(3.0));
        let shift = rng.point(300.0);
        let at = Placement { rotation: turn.to_rotation_matrix().into_inner(), shift };
        let there = nalgebra::Isometry3::from_parts(shift.into(), turn);
        let all = one
            .iter()
            .flat_map(|one| other.iter().map(move |other| of_convex(one, &moved(other, &there))));
        let (least, most) = all.fold((f64::INFINITY, f64::INFINITY), |(least, most), found| {
            (found.at_least.min(least), found.at_most.min(most))
        });
        let shapes = [one.clone(), other.clone()].map(|pieces| Shape::new(pieces).unwrap());
        let found = of_shapes(&shapes[0], &shapes[1], &at, [0; 2], 0.0);
        assert!(found.at_least <= most, "{found:?} {most}");
        // How near the search comes hangs on the frame and on where it begins; never nearer than is proven.
        assert!(found.at_most >= least, "{found:?} {least}");
        assert!(found.at_least >= 0.97 * least - 1e-5, "{found:?} {least}");
    }
}

#[test]
fn a_mesh_that_is_no_closed_surface_is_told() {
    let block = crate::proof::block_mesh(Vector3::zeros(), Vector3::repeat(10.0));
    let shape = Shape::mesh(&block).unwrap();
    assert_eq!(shape.faults(), Default::default());
    let mut open = block.clone();
    open.pop();
    assert_eq!(Shape::mesh(&open).unwrap().faults().open, 3);
    let mut turned = block.clone();
    turned[0].swap(0, 1);
    assert_eq!(Shape::mesh(&turned).unwrap().faults().inverted, 3);
    let mut flat = block;
    flat.push([Vector3::zeros(); 3]);
    assert_eq!(Shape::mesh(&flat).unwrap().faults().flat, 1);
    for bad in [f64::NAN, f64::INFINITY, 1e9] {
        assert!(Shape::mesh(&[[Vector3::repeat(bad), Vector3::x(), Vector3::y()]]).is_none());
    }
    assert!(Shape::mesh(&[]).is_none());
}
