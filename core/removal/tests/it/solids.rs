//! Stocks of every shape, and distances from them.

use std::collections::HashMap;
use std::f64::consts::PI;

use nalgebra::Vector3;
use post_clearance::convex::Convex;
use post_clearance::distance::of_convex;
use post_removal::compare::surface_of;
use post_removal::field::{Cutter, Field};
use post_removal::profile::ToolPose;
use post_testkit::{Rng, randomised};

type V = Vector3<f64>;

/// A closed mesh of a frustum along Z with so many sides.
fn prism(centre: V, radii: [f64; 2], height: f64, sides: usize) -> Vec<[V; 3]> {
    let rim = |end: usize, side: usize| {
        let angle = 2.0 * PI * (side % sides) as f64 / sides as f64 + 0.1;
        centre
            + V::new(
                radii[end] * libm::cos(angle),
                radii[end] * libm::sin(angle),
                end as f64 * height,
            )
    };
    let middles = [centre, centre + V::z() * height];
    (0..sides)
        .flat_map(|side| {
            let [a, b] = [rim(0, side), rim(0, side + 1)];
            let [c, d] = [rim(1, side), rim(1, side + 1)];
            [[middles[0], b, a], [middles[1], c, d], [a, b, d], [a, d, c]]
        })
        .collect()
}

#[test]
fn a_cylinder_and_its_mesh_lie_between_their_bounds() {
    let size = V::new(22.0, 24.0, 14.0);
    let truth = PI * 81.0 * 12.0;
    let mut last = [f64::INFINITY; 2];
    for resolution in [1.0, 0.5, 0.25] {
        let ends = [V::new(11.0, 12.0, 1.0), V::new(11.0, 12.0, 13.0)];
        let round = Field::cylinder(size, ends, 9.0, resolution);
        let mesh = Field::mesh(size, &prism(ends[0], [9.0; 2], 12.0, 720), resolution);
        for (field, last) in [round, mesh].iter().zip(&mut last) {
            let volume = field.volume();
            assert!(
                volume.at_least <= truth && truth <= volume.at_most + 0.1,
                "{volume:?} {truth}"
            );
            let between = volume.at_most - volume.at_least;
            assert!(between < 0.7 * *last, "{between} {last}");
            *last = between;
        }
    }
    assert!(last.iter().all(|last| *last < 0.12 * truth), "{last:?}");
}

/// Points inside of a mesh may be left, those outside are not for certain.
#[test]
fn a_mesh_holds_what_it_encloses() {
    let (rounds, mut rng) = randomised(60, 3311);
    for _ in rounds {
        let sides = 3 + rng.pick(9);
        let radii = [rng.range(2.0, 9.0), rng.range(2.0, 9.0)];
        let height = rng.range(3.0, 15.0);
        let centre = V::new(10.0, 10.0, 1.0);
        let mut triangles = prism(centre, radii, height, sides);
        // A hollow in it, its faces towards the inside of the hollow.
        let hollow = rng.pick(2) == 0;
        let inner = [0.4 * radii[0], 0.4 * radii[1]];
        if hollow {
            let low = centre + V::z() * 0.2 * height;
            let faces = prism(low, inner, 0.6 * height, sides);
            triangles.extend(faces.into_iter().map(|[a, b, c]| [a, c, b]));
        }
        let field = Field::mesh(V::new(20.0, 20.0, 17.0), &triangles, rng.range(0.3, 1.0));
        for _ in 0..400 {
            let point = V::new(rng.range(0.0, 20.0), rng.range(0.0, 20.0), rng.range(0.0, 17.0));
            let seen: f64 = triangles.iter().map(|corners| angle(corners, point)).sum();
            let inside = (seen / (4.0 * PI)).abs() > 0.5;
            match inside {
                true => assert!(field.may_hold(point), "{point:?}"),
                false => assert!(!field.holds(point), "{point:?}"),
            }
        }
    }
}

/// Solid angle of a triangle.
fn angle(corners: &[V; 3], from: V) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - from);
    let [x, y, z] = [a.norm(), b.norm(), c.norm()];
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * libm::atan2(a.dot(&b.cross(&c)), below)
}

fn body(rng: &mut Rng) -> Convex {
    let at = V::new(rng.range(-20.0, 40.0), rng.range(-20.0, 40.0), rng.range(-10.0, 50.0));
    let axis = rng.direction();
    let ends = [at, at + axis * rng.range(0.1, 20.0)];
    Convex::frustum(ends, axis, [rng.range(0.0, 9.0), rng.range(0.0, 9.0)])
}

/// The distance from a block is that of its one box, however it is cut into cells.
#[test]
fn the_distance_from_a_block_is_that_of_a_box() {
    let (rounds, mut rng) = randomised(300, 3312);
    for _ in rounds {
        let size = V::new(rng.range(5.0, 30.0), rng.range(5.0, 30.0), rng.range(5.0, 30.0));
        let mut field = Field::block(size, rng.range(0.7, 4.0));
        for _ in 0..4 {
            let body = body(&mut rng);
            let whole = of_convex(&body, &Convex::block(V::zeros(), size));
            let found = field.apart(std::slice::from_ref(&body));
            assert!(found.at_least <= whole.at_most + 1e-4, "{found:?} {whole:?}");
            assert!(found.at_most >= whole.at_least - 1e-4, "{found:?} {whole:?}");
            assert!(found.at_least >= 0.97 * whole.at_least - 1e-4, "{found:?} {whole:?}");
        }
    }
}

/// The surface is closed, each edge gone along as often in both senses, and encloses what is left to within its cells.
#[test]
fn the_surface_of_what_is_left_is_closed() {
    let (rounds, mut rng) = randomised(24, 3313);
    for _ in rounds {
        let size = V::new(14.0, 12.0, 9.0);
        let mut field = Field::block(size, rng.range(0.3, 0.7));
        let truth = size.product();
        for _ in 0..rng.pick(4) {
            let axis = rng.direction();
            let cutter = Cutter::new(&[[0.0, 2.0], [30.0, rng.range(1.0, 3.0)]]);
            let tip = V::new(rng.range(0.0, 14.0), rng.range(0.0, 12.0), rng.range(0.0, 9.0));
            let to = tip + rng.point(9.0);
            field.remove_straight(&cutter, [tip, to].map(|tip| ToolPose { tip, axis }));
        }
        let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
        let mut volume = 0.0;
        field.surface(&mut |corners| {
            let [a, b, c] = corners;
            volume += a.dot(&b.cross(&c)) / 6.0;
            let bits = |corner: V| [corner.x, corner.y, corner.z].map(f64::to_bits);
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let (from, to) = (bits(from), bits(to));
                let (edge, sense) = if from < to { ([from, to], 1) } else { ([to, from], -1) };
                *edges.entry(edge).or_default() += sense;
            }
        });
        assert!(edges.values().all(|count| *count == 0));
        let left = field.volume().at_most;
        assert!((volume - left).abs() < 0.12 * truth, "{volume} of {left}");
    }
}

/// A block in a block: what is left on it is what is around it, and a hole that is drilled into it is a gouge.
#[test]
fn what_is_cut_into_and_what_is_left_lie_between_their_bounds() {
    let size = V::new(20.0, 20.0, 12.0);
    // A square of 12.7 mm, on the bottom, 8 mm high: a prism of four sides.
    let triangles = prism(V::new(10.0, 10.0, 0.0), [9.0; 2], 8.0, 4);
    let volume = 2.0 * 81.0 * 8.0;
    let surface = surface_of(&triangles).unwrap();
    for resolution in [0.8, 0.4] {
        let part = Field::mesh(size, &triangles, resolution);
        let mut field = Field::block(size, resolution);
        let found = field.compare(&part, &surface);
        let rest = size.product() - volume;
        assert!(found.gouge.at_least == 0.0 && found.deepest.at_least == 0.0, "{found:?}");
        assert!(found.rest.at_least <= rest && rest <= found.rest.at_most, "{found:?} {rest}");
        // The corner of the block is farthest from the part, by the turn of the square.
        let out = found.thickest;
        assert!(out.at_least > 5.0 && out.at_least < out.at_most, "{out:?}");
        // A hole of 4 mm down to 3 mm above the bottom: 5 mm deep in the part, no more than 2 mm from the hole's side.
        let cutter = Cutter::new(&[[0.0, 2.0], [30.0, 2.0]]);
        let pose = ToolPose { tip: V::new(10.0, 10.0, 5.0), axis: V::z() };
        field.remove(&cutter, &pose);
        field.doubt(&cutter, &pose, 0.0);
        let found = field.compare(&part, &surface);
        let truth = PI * 4.0 * 3.0;
        assert!(found.gouge.at_least <= truth && truth <= found.gouge.at_most, "{found:?}");
        assert!(found.gouge.at_least > 0.3 * truth, "{found:?}");
        let deep = found.deepest;
        assert!(deep.at_least > 3.0 - 1.2 * resolution && deep.at_least <= 3.0, "{deep:?}");
        assert!(deep.at_most >= 3.0 && deep.at_most < 3.0 + 3.0 * resolution, "{deep:?}");
    }
}
