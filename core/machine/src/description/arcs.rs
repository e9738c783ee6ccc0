//! What a machine file says of arcs: which stay arcs, and how they are written.

use super::build::Builder;
use super::file::{ArcForm, ArcSplit, ArcsFile};
use crate::diagnostic::Short;

/// Which curves the program has as curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arcs {
    /// Arcs and splines of the CL file stay what they are where dialect and machine allow.
    pub keep: bool,
    /// How an arc is written.
    pub form: ArcForm,
    /// How far one block goes.
    pub split: ArcSplit,
    /// Least and largest radius of an arc, mm.
    pub radii: [f64; 2],
    /// Runs of points become arcs and lines.
    pub fit: bool,
}

impl Builder<'_> {
    pub(super) fn arcs(&mut self, file: &ArcsFile) -> Arcs {
        let least = self.checked(&file.least_radius).unwrap_or(0.01);
        let largest = self.checked(&file.largest_radius).unwrap_or(10_000.0);
        if let Some(quantity) = file.largest_radius.as_ref().or(file.least_radius.as_ref())
            && least >= largest
        {
            let message = format!(
                "least_radius is {} and largest_radius {}: no arc has such a radius",
                Short(least),
                Short(largest)
            );
            let help = "keep = false leaves no arc in the program";
            self.fault("machine-arcs", quantity.span(), message, help);
        }
        Arcs {
            keep: file.keep.unwrap_or(true),
            form: file.form,
            split: file.split,
            radii: [least, largest],
            fit: file.fit,
        }
    }
}
