//! The surface of what may be left, as triangles.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::field::Field;
use crate::mesh::Triangle;

/// A node of the grid: the middle of a cell, or beyond the first or the last one.
type Node = [i32; 3];

impl Field {
    /// Tells of all triangles of the surface of what may be left (Gibson 1998: a corner in each cube of eight nodes that it
    /// runs through, at the mean of where it crosses the cube's edges). It is closed, and as exact as a cell; it is looked
    /// at, and proves nothing.
    pub fn surface(&self, take: &mut dyn FnMut(Triangle)) {
        let [columns, rows, layers] = self.grid.counts.map(|count| count as i32);
        // Corners of the cubes whose lowest nodes lie in two layers: none is needed any more above the next.
        let mut corners: BTreeMap<Node, Vector3<f64>> = BTreeMap::new();
        let mut below = self.layer(-1);
        for layer in -1..layers {
            let above = self.layer(layer + 1);
            corners.retain(|node, _| node[2] >= layer - 1);
            let solid = |[column, row, place]: Node| {
                let nodes = if place == layer { &below } else { &above };
                nodes[((row + 1) * (columns + 2) + column + 1) as usize]
            };
            for row in -1..rows {
                for column in -1..columns {
                    let node = [column, row, layer];
                    if let Some(corner) = self.corner(node, &solid) {
                        corners.insert(node, corner);
                    }
                }
            }
            for row in -1..=rows {
                for column in -1..=columns {
                    self.faces([column, row, layer], &solid, &corners, take);
                }
            }
            below = above;
        }
    }

    /// Which nodes of a layer are in what may be left, a node around it on each side.
    fn layer(&self, layer: i32) -> Vec<bool> {
        let [columns, rows, _] = self.grid.counts.map(|count| count as i32);
        let nodes = (-1..=rows).flat_map(|row| (-1..=columns).map(move |column| [column, row]));
        nodes.map(|[column, row]| self.may_hold(self.node([column, row, layer]))).collect()
    }

    fn node(&self, node: Node) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| (f64::from(node[axis]) + 0.5) * self.grid.cell[axis])
    }

    /// The corner in the cube above a node: none where all of its nodes are on one side.
    fn corner(&self, node: Node, solid: &dyn Fn(Node) -> bool) -> Option<Vector3<f64>> {
        let (mut sum, mut count) = (Vector3::zeros(), 0.0);
        for axis in 0..3 {
            for aside in 0..4 {
                let mut from = node;
                from[(axis + 1) % 3] += aside & 1;
                from[(axis + 2) % 3] += aside >> 1;
                let mut to = from;
                to[axis] += 1;
                if solid(from) != solid(to) {
                    sum += self.crossing(from, axis);
                    count += 1.0;
                }
            }
        }
        (count > 0.0).then(|| sum / count)
    }

    /// Where the surface crosses the edge from a node to the next along an axis: the middle where no prism along it ends.
    fn crossing(&self, from: Node, axis: usize) -> Vector3<f64> {
        let mut point = self.node(from);
        let cell = self.grid.cell[axis];
        let ends = [point[axis], point[axis] + cell];
        point[axis] += 0.5 * cell;
        let rays = &self.upper[axis];
        let [u, v] = rays.section().map(|axis| from[axis]);
        let [columns, rows] = rays.counts().map(|count| count as i32);
        if (0..columns).contains(&u) && (0..rows).contains(&v) {
            let spans = rays.at([u as usize, v as usize]).iter().flatten();
            let mut within =
                spans.map(|end| f64::from(*end)).filter(|end| (ends[0]..=ends[1]).contains(end));
            point[axis] = within.next().unwrap_or(point[axis]);
        }
        point
    }

    /// Two triangles across each edge from a node that the surface crosses: those to nodes in its layer that lie between
    /// this and the last one, and the one to the next layer.
    fn faces(
        &self,
        node: Node,
        solid: &dyn Fn(Node) -> bool,
        corners: &BTreeMap<Node, Vector3<f64>>,
        take: &mut dyn FnMut(Triangle),
    ) {
        for axis in 0..3 {
            let mut next = node;
            next[axis] += 1;
            if axis < 2 && next[axis] > self.grid.counts[axis] as i32 {
                continue;
            }
            let inside = solid(node);
            if inside == solid(next) {
                continue;
            }
            let cube = |u: i32, v: i32| {
                let mut cube = node;
                cube[(axis + 1) % 3] -= u;
                cube[(axis + 2) % 3] -= v;
                corners.get(&cube)
            };
            let around = [cube(1, 1), cube(0, 1), cube(0, 0), cube(1, 0)];
            let [Some(a), Some(b), Some(c), Some(d)] = around else { continue };
            let halves = [[*a, *b, *c], [*a, *c, *d]];
            for [a, b, c] in halves {
                // Outward is along the axis where the node is inside.
                take(if inside { [a, b, c] } else { [a, c, b] });
            }
        }
    }
}
