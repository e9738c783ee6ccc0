//! What is left of a stock behind a program, and its surface as a file.

use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use post_clearance::placement::Placement;
use post_clearance::shape::Shape;
use post_machine::diagnostic::Diagnostic;
use post_removal::compare::{Compared, Nearness};
use post_removal::field::{Field, Volume};

use super::tool_cut::ToolCut;
use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg, Role};
use crate::session::Session;

/// An STL file of what is left.
const SOLID: Role = Role { what: "stock", remedy: "name another file with --stock-stl" };

/// What is left of a stock behind a program.
#[derive(Clone, Debug)]
pub struct StockLeft {
    /// What tables call it: `stock`, or `stock NAME`.
    pub name: String,
    /// What it hangs on: 0 is the part, n what follows the nth axis of the chain.
    pub link: usize,
    /// From the frame of its shape to that of the machine, all axes at zero.
    pub placed: Placement,
    /// Volume before the first cut.
    pub before: Volume,
    /// Volume that is left.
    pub left: Volume,
    /// Edges of a cell, mm.
    pub cell: Vector3<f64>,
    /// What it is against the part that is to become of it, places in the frame of its shape.
    pub part: Option<Compared>,
    /// What each tool takes of it.
    pub cuts: Vec<ToolCut>,
    pub(super) field: Field,
    /// The part, in the frame of the field, and its surface.
    pub(super) wanted: Option<(Field, Shape)>,
    /// The low corner of the field, frame of the shape, mm.
    pub(super) low: Vector3<f64>,
}

impl StockLeft {
    /// The file beside `path` that has its name.
    fn own_path(&self, path: &Path) -> PathBuf {
        let name = self.name.strip_prefix("stock ").unwrap_or(&self.name);
        let mut file = path.file_stem().unwrap_or_default().to_owned();
        file.push(format!("-{name}"));
        if let Some(ending) = path.extension() {
            file.push(".");
            file.push(ending);
        }
        path.with_file_name(file)
    }

    /// How far points of its surface, frame of its shape, are from that of the part, mm: below zero inside of it, zero where
    /// that is not known, for it is no farther than a cell. None where no part is given.
    pub(crate) fn over(&self) -> Option<impl FnMut(Vector3<f64>) -> f64> {
        let (part, surface) = self.wanted.as_ref()?;
        let mut near = Nearness::of(surface)?;
        let within = self.cell.norm();
        Some(move |point: Vector3<f64>| {
            let point = point - self.low;
            let far = near.from(point);
            match () {
                () if far <= within => 0.0,
                () if part.holds(point) => -far,
                () => far,
            }
        })
    }

    /// The STL file of its surface, in memory.
    pub(crate) fn stl(&self) -> Vec<u8> {
        let mut stl = Vec::new();
        self.facets(&mut |bytes| stl.extend_from_slice(bytes));
        stl
    }

    /// The head and the triangles of the file.
    fn facets(&self, take: &mut dyn FnMut(&[u8])) {
        let mut count = 0u32;
        self.field.surface(&mut |_| count += 1);
        let mut head = [0u8; 84];
        head[80..].copy_from_slice(&count.to_le_bytes());
        take(&head);
        self.field.surface(&mut |corners| take(&self.facet(corners)));
    }

    /// A triangle as binary STL has it: normal, corners, two bytes that say nothing.
    fn facet(&self, corners: [Vector3<f64>; 3]) -> [u8; 50] {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
        let points = [normal, a + self.low, b + self.low, c + self.low];
        let numbers = points.iter().flat_map(|point| point.iter().copied());
        let mut facet = [0; 50];
        for (place, number) in facet.chunks_exact_mut(4).zip(numbers) {
            place.copy_from_slice(&(number as f32).to_le_bytes());
        }
        facet
    }
}

/// Writes the surface of what may be left of each stock as an STL file, binary, mm, in the frame of its shape: the part
/// frame as the CL file has it, if nothing else is said. It is closed, and as exact as a cell; edges are bevelled by half
/// of one. Of several each has its name in that of the file: `left-NAME.stl`.
///
/// # Errors
/// A file cannot be written, or several are to go where one fits.
pub fn write_stl(stocks: &[StockLeft], session: &Session, path: &PathArg) -> Result<(), Failure> {
    if *path == PathArg::Standard && stocks.len() > 1 {
        let message = "several stocks are cut: standard output takes what is left of one";
        let help = "--stock-stl FILE.stl; each becomes a file of its own, FILE-NAME.stl";
        return Err(Diagnostic::error("clearance-body", message).help(help).into());
    }
    let own = |left: &StockLeft| match stocks.len() {
        1 => path.clone(),
        _ => path.map(|path| left.own_path(path)),
    };
    let paths: Vec<PathArg> = stocks.iter().map(own).collect();
    let targets: Vec<_> = paths.iter().map(|path| (SOLID, path)).collect();
    let mut files = AtomicFile::create(session, &targets)?;
    for (file, left) in files.iter_mut().zip(stocks) {
        let mut written = Ok(());
        left.facets(&mut |bytes| {
            if written.is_ok() {
                written = file.write_bytes(bytes);
            }
        });
        written?;
    }
    AtomicFile::finish(session, files)?;
    Ok(())
}
