//! Edges of a shape that are worth a line.

use std::collections::BTreeMap;

use super::Vertex;

/// Faces that meet at a larger angle have an edge: the cosine of 30 degrees.
const BENT: f64 = 0.866;

/// Corners that are the same to the micrometre.
type VertexKey = [i64; 3];

/// Where two triangles meet at an angle, or one has no neighbour, the longest first; of a smooth body all edges, so that it is
/// seen where faces are not drawn.
pub(super) fn sharp(triangles: &[[Vertex; 3]]) -> Vec<[Vertex; 2]> {
    let key = |corner: Vertex| corner.map(|value| (value * 1e3).round() as i64);
    let mut edges = BTreeMap::<[VertexKey; 2], ([Vertex; 2], Vec<Vertex>)>::new();
    for triangle in triangles {
        let Some(normal) = normal(triangle) else {
            continue;
        };
        for at in 0..3 {
            let (from, to) = (triangle[at], triangle[(at + 1) % 3]);
            let mut keys = [key(from), key(to)];
            keys.sort_unstable();
            let (_, normals) = edges.entry(keys).or_insert_with(|| ([from, to], Vec::new()));
            normals.push(normal);
        }
    }
    let sharp = |normals: &[Vertex]| match normals {
        [one, other] => dot(*one, *other) < BENT,
        _ => true,
    };
    let smooth = edges.values().all(|(_, normals)| !sharp(normals));
    let mut kept: Vec<[Vertex; 2]> = edges
        .into_values()
        .filter(|(_, normals)| smooth || sharp(normals))
        .map(|(edge, _)| edge)
        .collect();
    let length = |[from, to]: &[Vertex; 2]| {
        let way = minus(*to, *from);
        dot(way, way)
    };
    kept.sort_by(|one, other| length(other).total_cmp(&length(one)));
    kept
}

/// The unit vector across a triangle; none where it has no area.
pub(super) fn normal([a, b, c]: &[Vertex; 3]) -> Option<Vertex> {
    let (u, v) = (minus(*b, *a), minus(*c, *a));
    let across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = dot(across, across).sqrt();
    (length > 0.0).then(|| across.map(|value| value / length))
}

fn minus(a: Vertex, b: Vertex) -> Vertex {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vertex, b: Vertex) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
