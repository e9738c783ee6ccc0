//! The shape of a body: convex pieces, and a tree of spheres around them.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::cloud::Cloud;
use crate::convex::{Convex, Support};
use crate::inside::Shell;
use crate::mesh;

pub use crate::mesh::MeshFaults;

/// Pieces that a leaf of the tree holds at most.
const LEAF: usize = 4;

/// A shape, in the frame of its link.
#[derive(Clone, Debug)]
pub struct Shape {
    pub(crate) pieces: Vec<Convex>,
    /// A sphere around each piece: centre and radius, mm.
    pub(crate) spheres: Vec<(Vector3<f64>, f64)>,
    pub(crate) nodes: Vec<Node>,
    /// Parts of a mesh that are not convex.
    pub(crate) shells: Vec<Shell>,
    /// A point of each part that hangs together; of convex pieces one each.
    pub(crate) points: Vec<Vector3<f64>>,
    /// All corners of a mesh.
    cloud: Option<Arc<Cloud>>,
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

/// What is around one piece.
struct Around {
    /// Least and largest coordinates, mm.
    extents: [Vector3<f64>; 2],
    /// Centre and radius, mm.
    sphere: (Vector3<f64>, f64),
}

impl Around {
    fn new(piece: &Convex) -> Self {
        Self { extents: piece.extents(), sphere: piece.sphere() }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Below {
    Pieces(usize, usize),
    Nodes([usize; 2]),
}

impl Shape {
    /// The union of convex pieces. None where there is no piece, or one is too far away or no number.
    pub fn new(pieces: Vec<Convex>) -> Option<Self> {
        if pieces.is_empty() || !pieces.iter().all(Convex::is_near) {
            return None;
        }
        let points = pieces.iter().map(|piece| piece.core.centre()).collect();
        let around: Vec<_> = pieces.iter().map(Around::new).collect();
        let mut order: Vec<usize> = (0..pieces.len()).collect();
        let mut nodes = Vec::new();
        grow(&around, &mut order, 0, &mut nodes);
        let spheres = order.iter().map(|place| around[*place].sphere).collect();
        let pieces = order.iter().map(|place| pieces[*place].clone()).collect();
        let (shells, faults) = (Vec::new(), MeshFaults::default());
        Some(Self { pieces, spheres, nodes, shells, points, cloud: None, faults })
    }

    /// The profile of revolution through `profile`, points [z, r] in mm along `axis` (a unit vector) from `origin`. Between
    /// points of a falling z it goes on as well: pieces may overlap.
    pub fn turned(profile: &[[f64; 2]], origin: Vector3<f64>, axis: Vector3<f64>) -> Option<Self> {
        Self::new(turned_pieces(profile, origin, axis))
    }

    /// A mesh, corners in mm; what it encloses belongs to it. None where nothing is left of it.
    pub fn mesh(triangles: &[[Vector3<f64>; 3]]) -> Option<Self> {
        let near = |at: &Vector3<f64>| at.iter().all(|value| libm::fabs(*value) < crate::FARTHEST);
        if !triangles.as_flattened().iter().all(near) {
            return None;
        }
        let kept: Vec<[Vector3<f64>; 3]> =
            triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a).copied().collect();
        let (parts, faults) = mesh::parts(&kept);
        let faults = MeshFaults { flat: triangles.len() - kept.len(), ..faults };
        let points = parts.iter().map(|part| part.corners[0]).collect();
        let corners = parts.iter().flat_map(|part| &part.corners).copied().collect();
        let mut pieces = Vec::new();
        let mut shells = Vec::new();
        for part in parts {
            match part.hull {
                Some(hull) => pieces.push(Convex::hull(Arc::new(hull))),
                None => {
                    pieces.extend(part.triangles.iter().copied().map(Convex::triangle));
                    shells.extend(Shell::new(part.triangles));
                }
            }
        }
        let cloud = Cloud::new(corners).map(Arc::new);
        Some(Self { shells, points, cloud, faults, ..Self::new(pieces)? })
    }

    /// A sphere that holds all of it: centre and radius, mm.
    pub fn sphere(&self) -> (Vector3<f64>, f64) {
        self.nodes.first().map_or((Vector3::zeros(), 0.0), |root| (root.centre, root.radius))
    }

    /// Its convex pieces; of a mesh they are its parts that are convex, and the triangles of others.
    pub fn convex(&self) -> &[Convex] {
        &self.pieces
    }

    /// The farthest of it along `along`, which is likely to be `guess` if that was it along another direction.
    pub(crate) fn support_or(
        &self,
        along: Vector3<f64>,
        guess: Option<Vector3<f64>>,
    ) -> Vector3<f64> {
        match (&self.cloud, guess) {
            (Some(cloud), Some(guess)) => cloud.farthest_or(along, guess),
            _ => self.support(along),
        }
    }

    /// What is wrong with its mesh.
    pub fn faults(&self) -> MeshFaults {
        self.faults
    }

    /// How many convex pieces it is made of.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// Parts that hang together; convex pieces are one each.
    pub fn parts(&self) -> usize {
        self.points.len()
    }
}

/// The hull of all of it.
impl Support for Shape {
    fn support(&self, along: Vector3<f64>) -> Vector3<f64> {
        if let Some(cloud) = &self.cloud {
            return cloud.farthest(along);
        }
        let unit = along.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let points = self.pieces.iter().map(|piece| piece.core.support(along) + unit * piece.round);
        let first = (f64::NEG_INFINITY, Vector3::zeros());
        let farther = |best: (f64, Vector3<f64>), point: Vector3<f64>| {
            let far = along.dot(&point);
            if far > best.0 { (far, point) } else { best }
        };
        points.fold(first, farther).1
    }

    fn centre(&self) -> Vector3<f64> {
        self.pieces[0].core.centre()
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

/// Makes the tree of the pieces that `order` names, which it puts in order, by what is `around` them; `first` is the place
/// of the first of them among all.
fn grow(around: &[Around], order: &mut [usize], first: usize, nodes: &mut Vec<Node>) -> usize {
    let infinite = Vector3::repeat(f64::INFINITY);
    let (low, high) = order.iter().fold((infinite, -infinite), |(low, high), place| {
        let [least, most] = around[*place].extents;
        (low.inf(&least), high.sup(&most))
    });
    let centre = (low + high) * 0.5;
    let radius = order.iter().map(|place| {
        let (at, radius) = around[*place].sphere;
        (at - centre).norm() + radius
    });
    let radius = radius.fold(0.0, f64::max) + crate::ALLOWANCE;
    let place = nodes.len();
    let half = (high - low) * 0.5;
    nodes.push(Node { centre, radius, half, below: Below::Pieces(first, order.len()) });
    if order.len() > LEAF {
        let axis = half.imax();
        let middle = order.len() / 2;
        let along = |place: &usize| around[*place].sphere.0[axis];
        order.select_nth_unstable_by(middle, |one, other| along(one).total_cmp(&along(other)));
        let (left, right) = order.split_at_mut(middle);
        let left = grow(around, left, first, nodes);
        let right = grow(around, right, first + middle, nodes);
        nodes[place].below = Below::Nodes([left, right]);
    }
    place
}
