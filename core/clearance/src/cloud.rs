//! Points, and the farthest of them along a direction.

use nalgebra::Vector3;

/// Points that a leaf of the tree holds at most.
const LEAF: usize = 8;

/// Points in a tree of boxes, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    points: Vec<Vector3<f64>>,
    /// The root first, each before the two below it, of which the first follows at once.
    nodes: Vec<Node>,
    /// Mean of the points: in their hull.
    mean: Vector3<f64>,
}

/// A box around points that follow one another.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    centre: Vector3<f64>,
    half: Vector3<f64>,
    first: usize,
    count: usize,
    /// The second of the two nodes below; none of a leaf.
    second: Option<usize>,
}

impl Cloud {
    /// None of no points.
    pub(crate) fn new(mut points: Vec<Vector3<f64>>) -> Option<Self> {
        if points.is_empty() {
            return None;
        }
        let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
        let mut nodes = Vec::new();
        grow(&mut points, 0, &mut nodes);
        Some(Self { points, nodes, mean })
    }

    /// A point of their hull.
    pub(crate) fn mean(&self) -> Vector3<f64> {
        self.mean
    }

    /// A sphere that holds them: centre and radius, mm.
    pub(crate) fn sphere(&self) -> (Vector3<f64>, f64) {
        let root = self.nodes[0];
        let far = self.points.iter().map(|point| (point - root.centre).norm_squared());
        (root.centre, far.fold(0.0, f64::max).sqrt())
    }

    /// The farthest along `along`, which need not be a unit vector: no other is farther by more than rounding.
    pub(crate) fn farthest(&self, along: Vector3<f64>) -> Vector3<f64> {
        let mut best = (f64::NEG_INFINITY, self.points[0]);
        self.look(0, along, along.abs(), &mut best);
        best.1
    }

    /// The same, which is likely to be `guess`, one of them.
    pub(crate) fn farthest_or(&self, along: Vector3<f64>, guess: Vector3<f64>) -> Vector3<f64> {
        let mut best = (along.dot(&guess), guess);
        self.look(0, along, along.abs(), &mut best);
        best.1
    }

    fn look(
        &self,
        place: usize,
        along: Vector3<f64>,
        size: Vector3<f64>,
        best: &mut (f64, Vector3<f64>),
    ) {
        let node = &self.nodes[place];
        let Some(second) = node.second else {
            for point in &self.points[node.first..node.first + node.count] {
                let far = along.dot(point);
                if far > best.0 {
                    *best = (far, *point);
                }
            }
            return;
        };
        let far = |place: usize| {
            let Node { centre, half, .. } = &self.nodes[place];
            along.dot(centre) + size.dot(half)
        };
        let mut below = [(far(place + 1), place + 1), (far(second), second)];
        if below[1].0 > below[0].0 {
            below.swap(0, 1);
        }
        for (far, place) in below {
            if far > best.0 {
                self.look(place, along, size, best);
            }
        }
    }
}

fn grow(points: &mut [Vector3<f64>], first: usize, nodes: &mut Vec<Node>) {
    let (low, high) =
        points.iter().fold((points[0], points[0]), |(low, high), at| (low.inf(at), high.sup(at)));
    let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let place = nodes.len();
    nodes.push(Node { centre, half, first, count: points.len(), second: None });
    if points.len() > LEAF {
        let axis = half.imax();
        let middle = points.len() / 2;
        points.select_nth_unstable_by(middle, |one, other| one[axis].total_cmp(&other[axis]));
        let (left, right) = points.split_at_mut(middle);
        grow(left, first, nodes);
        nodes[place].second = Some(nodes.len());
        grow(right, first + middle, nodes);
    }
}
