//! `[solids]`: files with the shapes of the machine's bodies.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::keys::axes_are;
use crate::diagnostic::SourcePlace;

/// The shape of a body of the machine, for pictures and for `post clearance`: nothing of a program depends on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// The body: 0 is the part, n what follows the nth axis of the chain.
    pub body: usize,
    /// It shows the body in place of what follows from the chain; else it is drawn besides.
    pub whole: bool,
    /// An STL file: mm, machine frame, every axis at zero.
    pub file: PathBuf,
    /// Where the machine file names it.
    pub place: Option<SourcePlace>,
}

impl Builder<'_> {
    pub(super) fn solids(
        &mut self,
        file: &BTreeMap<Spanned<String>, Spanned<String>>,
        axes: &[Axis],
    ) -> Vec<Solid> {
        let mut solids = Vec::new();
        for (link, path) in file {
            let name = link.get_ref().as_str();
            let Some(body) = link_of(name, axes) else {
                let help = format!("{}; w, b and t are part, bed and tool", axes_are(axes));
                let message = format!("the machine has no `{name}` that could have a shape");
                self.fault("machine-solid", link.span(), message, &help);
                continue;
            };
            let whole = !matches!(name, "w" | "t");
            // A machine that refines another takes a shape away so.
            if path.get_ref().is_empty() {
                continue;
            }
            let Some(file) = self.stl_path("machine-solid", path) else { continue };
            let place = self.sources.place(path.span());
            solids.push(Solid { body, whole, file, place });
        }
        solids
    }

    /// The STL file that is named, as seen from the folder of the machine file; a fault of `code` if it is none.
    pub(super) fn stl_path(
        &mut self,
        code: &'static str,
        path: &Spanned<String>,
    ) -> Option<PathBuf> {
        let named = Path::new(path.get_ref());
        let ending = named.extension().unwrap_or_default();
        if !ending.eq_ignore_ascii_case("stl") {
            let message = format!("`{}` is no name of an STL file", path.get_ref());
            let help = "the ending is .stl; a CAD system exports it, in mm";
            self.fault(code, path.span(), message, help);
            return None;
        }
        let place = self.sources.place(path.span());
        let folder = place.as_ref().and_then(|at| Path::new(&at.file).parent());
        Some(folder.unwrap_or_else(|| Path::new("")).join(named))
    }
}

/// The body of the machine that a file calls so: w carries the part, b is the bed, t the tool's side, an axis letter what
/// that axis moves.
pub(super) fn link_of(name: &str, axes: &[Axis]) -> Option<usize> {
    let bed = axes.iter().filter(|axis| axis.carries_part).count();
    let axis = axes.iter().position(|axis| axis.name == name);
    match (name, axis) {
        ("w", _) => Some(0),
        ("b", _) => Some(bed),
        ("t", _) => Some(axes.len()),
        (_, Some(at)) if axes[at].carries_part => Some(at),
        (_, Some(at)) => Some(at + 1),
        (_, None) => None,
    }
}
