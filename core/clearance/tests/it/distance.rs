//! Distances of convex pieces and of shapes.

use nalgebra::{UnitQuaternion, Vector3};
use post_clearance::convex::Convex;
use post_clearance::distance::{of_convex, of_shapes};
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
