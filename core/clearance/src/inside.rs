//! What a mesh encloses.

use std::collections::HashMap;

use nalgebra::Vector3;

/// A part of a mesh that hangs together.
#[derive(Clone, Debug)]
pub(crate) struct Shell {
    triangles: Vec<[Vector3<f64>; 3]>,
}

/// Of a full turn of the solid angle so much is inside. A closed shell has all of it inside and nothing outside; of an open
/// one what sees more than a quarter of the sphere covered counts as inside.
const INSIDE: f64 = 0.25;

impl Shell {
    /// The parts of a mesh that hang together by common corners.
    pub(crate) fn all(triangles: &[[Vector3<f64>; 3]]) -> Vec<Self> {
        let mut root: Vec<usize> = (0..triangles.len()).collect();
        let mut first: HashMap<[u64; 3], usize> = HashMap::new();
        for (place, corners) in triangles.iter().enumerate() {
            for corner in corners {
                let key = [corner.x, corner.y, corner.z].map(|value| (value + 0.0).to_bits());
                let known = *first.entry(key).or_insert(place);
                let (one, other) = (find(&mut root, known), find(&mut root, place));
                root[one.max(other)] = one.min(other);
            }
        }
        let mut shells: Vec<Self> = Vec::new();
        let mut place_of: HashMap<usize, usize> = HashMap::new();
        for (place, corners) in triangles.iter().enumerate() {
            let of = find(&mut root, place);
            let shell = *place_of.entry(of).or_insert_with(|| {
                shells.push(Self { triangles: Vec::new() });
                shells.len() - 1
            });
            shells[shell].triangles.push(*corners);
        }
        shells
    }

    /// A point of it.
    pub(crate) fn corner(&self) -> Vector3<f64> {
        self.triangles.first().map_or_else(Vector3::zeros, |corners| corners[0])
    }

    /// Whether it encloses `point`: each shell by itself, so that a hollow, or a shell whose faces look inward, is no way
    /// out of what encloses both.
    pub(crate) fn holds(&self, point: Vector3<f64>) -> bool {
        let full = 4.0 * std::f64::consts::PI;
        let seen: f64 = self.triangles.iter().map(|corners| solid_angle(corners, point)).sum();
        libm::fabs(seen / full) > INSIDE
    }
}

fn find(root: &mut [usize], mut place: usize) -> usize {
    while root[place] != place {
        root[place] = root[root[place]];
        place = root[place];
    }
    place
}

/// The solid angle under which a triangle is seen (van Oosterom, Strackee 1983), with the sign of its sense.
fn solid_angle(corners: &[Vector3<f64>; 3], from: Vector3<f64>) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - from);
    let [x, y, z] = [a, b, c].map(|arm| arm.norm());
    let volume = a.dot(&b.cross(&c));
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * libm::atan2(volume, below)
}
