//! The shape of a body of the machine: triangles of an STL file, few enough to be drawn in every frame.

mod coarse;
mod edges;
mod stl;

use std::io::{BufRead, Seek};

pub use stl::StlFault;

/// A corner, mm.
pub type Vertex = [f64; 3];

/// Triangles of all solids of one machine that a frame draws.
pub const MOST_TRIANGLES: usize = 3_800;

/// Edges of all solids of one machine that a frame draws.
pub const MOST_EDGES: usize = 2_500;

/// Decimals of a millimetre that are kept: ten to their power.
const SCALE: f64 = 100.0;

/// A shape as it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnSolid {
    /// Faces of the shape.
    pub triangles: Vec<[Vertex; 3]>,
    /// Edges at which the shape is bent sharply or ends, the longest first.
    pub edges: Vec<[Vertex; 2]>,
}

/// Hands every triangle of an STL file, binary or text, to `take`, from the file's beginning; a coordinate is at most a
/// kilometre.
///
/// # Errors
/// What is read is no STL file, or cannot be read.
pub fn triangles(
    file: &mut (impl BufRead + Seek),
    take: &mut dyn FnMut([Vertex; 3]),
) -> Result<(), StlFault> {
    stl::read(file, take)
}

impl DrawnSolid {
    /// Reads an STL file, binary or text. More triangles than `most` become fewer: corners that are close together
    /// become one of them, and triangles that have shrunk to a line go. Memory grows with what is kept and not with the
    /// file.
    ///
    /// # Errors
    /// What is read is no STL file, or cannot be read.
    pub fn read(file: &mut (impl BufRead + Seek), most: usize) -> Result<Self, StlFault> {
        let mut triangles = Vec::new();
        let mut count = 0;
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        stl::read(file, &mut |triangle| {
            count += 1;
            if count <= most {
                triangles.push(triangle);
            }
            for corner in triangle {
                for at in 0..3 {
                    low[at] = low[at].min(corner[at]);
                    high[at] = high[at].max(corner[at]);
                }
            }
        })?;
        if count > most {
            let mut coarse = coarse::ClusteredMesh::new(low, high);
            stl::read(file, &mut |triangle| coarse.add(triangle))?;
            triangles = coarse.triangles(most);
        }
        for value in triangles.iter_mut().flatten().flatten() {
            *value = (*value * SCALE).round_ties_even() / SCALE;
        }
        triangles.retain(|triangle| edges::normal(triangle).is_some());
        if triangles.is_empty() {
            return Err(StlFault::Empty);
        }
        let edges = edges::sharp(&triangles);
        Ok(Self { triangles, edges })
    }
}
