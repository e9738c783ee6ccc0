//! A mesh: its parts that hang together, which of them are closed, and which are convex.

use std::collections::HashMap;
use std::hash::{BuildHasher, Hash, Hasher, RandomState};

use nalgebra::Vector3;

use crate::cloud::Cloud;
use crate::inside::solid_angle;

/// A corner that stands over the face beside it by no more than this is on it, mm: what files of single precision leave of
/// flat faces.
const FLAT: f64 = 1e-3;

/// Faces of a part that all corners are held against, evenly among all: what bends inward by no more than [`FLAT`] from each
/// face to the next is a dent only over many of them.
const MOST_FACES: usize = 500;

/// A part encloses its middle if it covers so much of what is seen from there, as a share of all.
const ALL: f64 = 1e-6;

/// What is wrong with a mesh, and how often.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshFaults {
    /// Triangles without an area, left out: their edges are those of others.
    pub flat: usize,
    /// Edges with one triangle, or more than two: the mesh is no closed surface.
    pub open: usize,
    /// Edges whose two triangles do not agree what is outside.
    pub inverted: usize,
    /// Closed parts that enclose no volume: sheets with two sides.
    pub empty: usize,
}

/// A part of a mesh that hangs together by common corners.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub triangles: Vec<[Vector3<f64>; 3]>,
    /// Each of its corners once.
    pub corners: Vec<Vector3<f64>>,
    /// Its corners, if it is closed and convex: their hull is what it encloses.
    pub hull: Option<Cloud>,
}

/// One of the three edges of a triangle.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Its corners, the lesser first.
    ends: [u32; 2],
    /// The triangle goes along it from the greater to the lesser.
    against: bool,
    triangle: u32,
}

/// What is seen of a part at its edges.
#[derive(Clone, Copy, Debug)]
struct Seen {
    closed: bool,
    /// Least and greatest height of a corner over the face beside it, mm, on the side that the face calls outside.
    heights: [f64; 2],
}

impl Seen {
    fn is_flat(&self) -> bool {
        self.heights.iter().all(|height| libm::fabs(*height) <= FLAT)
    }
}

/// The parts of a mesh, and what is wrong with it.
pub(crate) fn parts(triangles: &[[Vector3<f64>; 3]]) -> (Vec<Part>, MeshFaults) {
    let corners = corners(triangles);
    let mut root: Vec<u32> = (0..corners.len() as u32).collect();
    for [a, b, c] in corners.as_chunks::<3>().0 {
        for beside in [b, c] {
            let (one, other) = (find(&mut root, *a), find(&mut root, *beside));
            root[one.max(other) as usize] = one.min(other);
        }
    }
    let mut place_of = vec![usize::MAX; corners.len()];
    let mut parts: Vec<Part> = Vec::new();
    let mut part_of = Vec::with_capacity(triangles.len());
    for (place, corners_of) in triangles.iter().enumerate() {
        let of = &mut place_of[find(&mut root, corners[3 * place]) as usize];
        if *of == usize::MAX {
            *of = parts.len();
            parts.push(Part { triangles: Vec::new(), corners: Vec::new(), hull: None });
        }
        let part = &mut parts[*of];
        part.triangles.push(*corners_of);
        let numbers = (3 * place..).zip(corners_of);
        part.corners.extend(
            numbers.filter(|(number, _)| corners[*number] as usize == *number).map(|(_, at)| *at),
        );
        part_of.push(*of);
    }
    let mut seen = vec![Seen { closed: true, heights: [0.0; 2] }; parts.len()];
    let mut faults = edges(triangles, &corners, &part_of, &mut seen);
    for (part, seen) in parts.iter_mut().zip(seen) {
        faults.empty += usize::from(seen.closed && seen.is_flat());
        part.hull = hull(part, &seen);
    }
    (parts, faults)
}

/// A corner, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key([u64; 3]);

impl Hash for Key {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.iter().for_each(|bits| state.write_u64(*bits));
    }
}

/// Mixes words by a secret: nobody can make a file whose corners all fall together.
#[derive(Clone, Copy, Debug)]
struct Mixing {
    secret: u64,
    state: u64,
}

impl Mixing {
    fn any() -> Self {
        let secret = RandomState::new().hash_one(0) | 1;
        Self { secret, state: secret }
    }
}

impl BuildHasher for Mixing {
    type Hasher = Self;

    fn build_hasher(&self) -> Self {
        *self
    }
}

impl Hasher for Mixing {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, word: u64) {
        let product = u128::from(self.state ^ word) * u128::from(self.secret);
        self.state = product as u64 ^ (product >> 64) as u64;
    }

    fn finish(&self) -> u64 {
        self.state
    }
}

/// A number for each corner of each triangle: the same for corners that are in the same place.
fn corners(triangles: &[[Vector3<f64>; 3]]) -> Vec<u32> {
    let all = triangles.as_flattened();
    let mut first = HashMap::with_capacity_and_hasher(all.len() / 4, Mixing::any());
    let number = |(place, corner): (usize, &Vector3<f64>)| {
        let key = Key([corner.x, corner.y, corner.z].map(|value| (value + 0.0).to_bits()));
        *first.entry(key).or_insert(place as u32)
    };
    all.iter().enumerate().map(number).collect()
}

fn find(root: &mut [u32], mut place: u32) -> u32 {
    while root[place as usize] != place {
        root[place as usize] = root[root[place as usize] as usize];
        place = root[place as usize];
    }
    place
}

/// Goes over all edges: counts those that are not shared by two triangles that agree, and looks at how the faces of the
/// others stand to one another.
fn edges(
    triangles: &[[Vector3<f64>; 3]],
    corners: &[u32],
    part_of: &[usize],
    seen: &mut [Seen],
) -> MeshFaults {
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for (triangle, [a, b, c]) in corners.as_chunks::<3>().0.iter().enumerate() {
        for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
            let ends = [from.min(to), from.max(to)];
            edges.push(Edge { ends, against: from > to, triangle: triangle as u32 });
        }
    }
    let edges = in_order(&edges, corners.len());
    let mut faults = MeshFaults::default();
    for same in edges.chunk_by(|one, other| one.ends == other.ends) {
        let seen = &mut seen[part_of[same[0].triangle as usize]];
        match same {
            [one, other] if one.against != other.against => {
                let height = height([one, other].map(|edge| &triangles[edge.triangle as usize]));
                let [least, most] = &mut seen.heights;
                (*least, *most) = (least.min(height), most.max(height));
                continue;
            }
            [_, _] => faults.inverted += 1,
            _ => faults.open += 1,
        }
        seen.closed = false;
    }
    faults
}

/// Edges of the same corners follow one another, in the order of their triangles: they are counted by their lesser corner, of
/// which each has few.
fn in_order(edges: &[Edge], corners: usize) -> Vec<Edge> {
    let mut starts = vec![0; corners + 1];
    for edge in edges {
        starts[edge.ends[0] as usize + 1] += 1;
    }
    for corner in 0..corners {
        starts[corner + 1] += starts[corner];
    }
    let mut next = starts.clone();
    let mut ordered = edges.to_vec();
    for edge in edges {
        let place = &mut next[edge.ends[0] as usize];
        ordered[*place] = *edge;
        *place += 1;
    }
    for ends in starts.windows(2) {
        ordered[ends[0]..ends[1]].sort_by_key(|edge| edge.ends[1]);
    }
    ordered
}

/// How high two triangles that share an edge stand over one another, mm: the farthest corner of the smaller over the plane of
/// the larger.
fn height([one, other]: [&[Vector3<f64>; 3]; 2]) -> f64 {
    let [first, last] = [one, other].map(|[a, b, c]| (b - a).cross(&(c - a)));
    let (normal, at, smaller) = match first.norm_squared() > last.norm_squared() {
        true => (first, one[0], other),
        false => (last, other[0], one),
    };
    let Some(normal) = normal.try_normalize(0.0) else { return f64::INFINITY };
    let heights = smaller.map(|corner| normal.dot(&(corner - at)));
    heights
        .into_iter()
        .max_by(|one, other| libm::fabs(*one).total_cmp(&libm::fabs(*other)))
        .unwrap_or(0.0)
}

/// The corners of a part that is closed, and convex but for [`FLAT`]: no face has a corner above it, neither beside it nor
/// elsewhere, and its faces cover all around its middle, once.
fn hull(Part { triangles, corners, .. }: &Part, seen: &Seen) -> Option<Cloud> {
    let Seen { closed, heights: [least, most] } = *seen;
    if !closed || seen.is_flat() || least < -FLAT && most > FLAT {
        return None;
    }
    // Faces that look inward, all of them, enclose the same.
    let sense = if most > FLAT { -1.0 } else { 1.0 };
    let cloud = Cloud::new(corners.clone())?;
    let middle = cloud.mean();
    let seen = triangles.iter().map(|corners| sense * solid_angle(corners, middle));
    let (least_seen, all_seen) =
        seen.fold((f64::INFINITY, 0.0), |(least, all), seen| (least.min(seen), all + seen));
    let once = libm::fabs(all_seen / (4.0 * std::f64::consts::PI) - 1.0) < ALL;
    // Where every corner is below the faces beside it, and faces go around once, it is below all of them.
    let level = (sense * if sense > 0.0 { most } else { least }) <= 0.0;
    let below = |[a, b, c]: &[Vector3<f64>; 3]| {
        let normal = ((b - a).cross(&(c - a)) * sense).try_normalize(0.0);
        normal.is_some_and(|normal| normal.dot(&(cloud.farthest(normal) - a)) <= FLAT)
    };
    let every = triangles.len().div_ceil(MOST_FACES);
    let convex =
        once && least_seen >= -ALL && (level || triangles.iter().step_by(every).all(below));
    convex.then_some(cloud)
}
