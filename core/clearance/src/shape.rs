//! The shape of a body: convex pieces, and a tree of spheres around them.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::convex::Convex;
use crate::inside::Shell;

/// Pieces that a leaf of the tree holds at most.
const LEAF: usize = 4;

/// A shape, in the frame of its link.
#[derive(Clone, Debug)]
pub struct Shape {
    pub(crate) pieces: Vec<Convex>,
    /// A sphere around each piece: centre and radius, mm.
    pub(crate) spheres: Vec<(Vector3<f64>, f64)>,
    pub(crate) nodes: Vec<Node>,
    pub(crate) shells: Vec<Shell>,
    faults: MeshFaults,
}

/// A sphere around some of the pieces.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub centre: Vector3<f64>,
    pub radius: f64,
    /// Half the box around them, along the frame's axes, about the same middle.
    pub half: Vector3<f64>,
    /// Of a leaf the first piece and how many; of others the two nodes below.
    pub below: Below,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Below {
    Pieces(usize, usize),
    Nodes([usize; 2]),
}

/// What is wrong with a mesh, and how often.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshFaults {
    /// Triangles without an area, left out: their edges are those of others.
    pub flat: usize,
    /// Edges with one triangle, or more than two: the mesh is no closed surface.
    pub open: usize,
    /// Edges whose two triangles do not agree what is outside.
    pub inverted: usize,
}

impl Shape {
    /// The union of convex pieces. None where there is no piece, or one is too far away or no number.
    pub fn new(pieces: Vec<Convex>) -> Option<Self> {
        Self::with(pieces, Vec::new(), MeshFaults::default())
    }

    /// The profile of revolution through `profile`, points [z, r] in mm along `axis` (a unit vector) from `origin`. Between
    /// points of a falling z it goes on as well: pieces may overlap.
    pub fn turned(profile: &[[f64; 2]], origin: Vector3<f64>, axis: Vector3<f64>) -> Option<Self> {
        Self::new(turned_pieces(profile, origin, axis))
    }

    /// A mesh, corners in mm; what it encloses belongs to it. None where nothing is left of it.
    pub fn mesh(triangles: &[[Vector3<f64>; 3]]) -> Option<Self> {
        let all = triangles.len();
        let kept: Vec<[Vector3<f64>; 3]> =
            triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a).copied().collect();
        let mut faults = edges(&kept);
        faults.flat = all - kept.len();
        let shells = Shell::all(&kept);
        Self::with(kept.into_iter().map(Convex::triangle).collect(), shells, faults)
    }

    fn with(mut pieces: Vec<Convex>, shells: Vec<Shell>, faults: MeshFaults) -> Option<Self> {
        if pieces.is_empty() || !pieces.iter().all(Convex::is_near) {
            return None;
        }
        let mut nodes = Vec::new();
        grow(&mut pieces, 0, &mut nodes);
        let spheres = pieces.iter().map(Convex::sphere).collect();
        Some(Self { pieces, spheres, nodes, shells, faults })
    }

    /// A sphere that holds all of it: centre and radius, mm.
    pub fn sphere(&self) -> (Vector3<f64>, f64) {
        self.nodes.first().map_or((Vector3::zeros(), 0.0), |root| (root.centre, root.radius))
    }

    /// What is wrong with its mesh.
    pub fn faults(&self) -> MeshFaults {
        self.faults
    }

    /// How many convex pieces it is made of.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// A point of each part of it that hangs together; of convex pieces one each.
    pub(crate) fn points(&self) -> Vec<Vector3<f64>> {
        if self.shells.is_empty() {
            return self.pieces.iter().map(|piece| piece.core.centre()).collect();
        }
        self.shells.iter().map(Shell::corner).collect()
    }
}

/// Convex pieces of a profile of revolution.
pub fn turned_pieces(
    profile: &[[f64; 2]],
    origin: Vector3<f64>,
    axis: Vector3<f64>,
) -> Vec<Convex> {
    let pairs = profile.windows(2).filter(|pair| pair[0] != pair[1]);
    pairs
        .map(|pair| {
            let ends = [pair[0], pair[1]].map(|[z, _]| origin + axis * z);
            Convex::frustum(ends, axis, [pair[0][1], pair[1][1]])
        })
        .collect()
}

/// Makes the tree of `pieces`, which it puts in order; `first` is the place of the first of them among all.
fn grow(pieces: &mut [Convex], first: usize, nodes: &mut Vec<Node>) -> usize {
    let spheres: Vec<_> = pieces.iter().map(Convex::sphere).collect();
    let infinite = Vector3::repeat(f64::INFINITY);
    let (low, high) = pieces.iter().fold((infinite, -infinite), |(low, high), piece| {
        let [least, most] = piece.extents();
        (low.inf(&least), high.sup(&most))
    });
    let centre = (low + high) * 0.5;
    let radius = spheres.iter().map(|(at, radius)| (at - centre).norm() + radius);
    let radius = radius.fold(0.0, f64::max) + crate::ALLOWANCE;
    let place = nodes.len();
    let half = (high - low) * 0.5;
    nodes.push(Node { centre, radius, half, below: Below::Pieces(first, pieces.len()) });
    if pieces.len() > LEAF {
        let axis = (high - low).imax();
        let middle = pieces.len() / 2;
        pieces.select_nth_unstable_by(middle, |one, other| {
            one.core.centre()[axis].total_cmp(&other.core.centre()[axis])
        });
        let (left, right) = pieces.split_at_mut(middle);
        let left = grow(left, first, nodes);
        let right = grow(right, first + middle, nodes);
        nodes[place].below = Below::Nodes([left, right]);
    }
    place
}

/// Counts edges that are not shared by two triangles that agree.
fn edges(triangles: &[[Vector3<f64>; 3]]) -> MeshFaults {
    let bits =
        |corner: &Vector3<f64>| [corner.x, corner.y, corner.z].map(|value| (value + 0.0).to_bits());
    // How often an edge is gone along in each of its senses.
    let mut seen: HashMap<[[u64; 3]; 2], [usize; 2]> = HashMap::new();
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (from, to) = (bits(from), bits(to));
            let (edge, sense) = if from <= to { ([from, to], 0) } else { ([to, from], 1) };
            seen.entry(edge).or_default()[sense] += 1;
        }
    }
    let mut faults = MeshFaults::default();
    for [along, against] in seen.into_values().collect::<Vec<_>>() {
        match (along, against) {
            (1, 1) => {}
            (2, 0) | (0, 2) => faults.inverted += 1,
            _ => faults.open += 1,
        }
    }
    faults
}
