//! Shapes of the machine's bodies, as the page draws them.

use std::fs::File;
use std::io::BufReader;

use post_machine::description::{self, Machine};
use post_machine::diagnostic::Diagnostic;
use post_report::meta::Meta;
use post_report::solid::{DrawnSolid, MOST_EDGES, MOST_TRIANGLES};
use post_report::table::{TableColumn, TableWriter};

use super::parts::{Parts, fault};
use crate::failure::Failure;

/// A shape that a machine file names, few enough triangles for a frame.
type Shape<'m> = (&'m description::Solid, DrawnSolid);

/// What cannot be shown of the shapes that a machine file names; a picture lacks them, and nothing else.
pub fn faults(machine: &Machine) -> Vec<Diagnostic> {
    sets(machine).into_iter().flat_map(|set| shapes(set).1).collect()
}

/// The shapes of a machine and those of its heads that have others.
fn sets(machine: &Machine) -> Vec<&[description::Solid]> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let mut sets: Vec<&[description::Solid]> = Vec::new();
    for machine in std::iter::once(machine).chain(heads) {
        if sets.iter().all(|set| !same(set, &machine.solids)) {
            sets.push(&machine.solids);
        }
    }
    sets
}

/// They show the same, wherever they are named.
fn same(one: &[description::Solid], other: &[description::Solid]) -> bool {
    let key = |solid: &description::Solid| (solid.body, solid.whole, solid.file.clone());
    one.iter().map(key).eq(other.iter().map(key))
}

/// Adds the shapes of a machine and its heads to the parts of a report; what cannot be shown comes back.
///
/// A row of the table is a corner: `corners` of them are a triangle (3) or an edge (2) of `body`, in the `set` of those that
/// the machine or a head has; mm, machine frame, every axis at zero.
///
/// # Errors
/// They cannot be kept.
pub(super) fn add(
    machine: &Machine,
    meta: &mut Meta,
    parts: &mut Parts,
) -> Result<Vec<Diagnostic>, Failure> {
    let columns = ["set", "corners", "body"].into_iter();
    let columns = columns.map(|name| TableColumn::new(name, "", 0));
    let places = ["x", "y", "z"].map(|name| TableColumn::new(name, "mm", 2));
    let columns = columns.chain(places).collect();
    let mut table = TableWriter::new("solids", columns, Parts::scratch()?);
    let mut faults = Vec::new();
    let heads = machine.heads.iter().map(|head| &head.machine);
    let machines: Vec<&Machine> = std::iter::once(machine).chain(heads).collect();
    for (number, set) in sets(machine).into_iter().enumerate() {
        let (shapes, found) = shapes(set);
        faults.extend(found);
        let told = meta.machine.iter_mut().chain(&mut meta.heads);
        for (_, told) in machines.iter().zip(told).filter(|(one, _)| same(&one.solids, set)) {
            told.shapes = number;
            told.solid = shapes
                .iter()
                .filter(|(given, _)| given.whole)
                .map(|(given, _)| given.body)
                .collect();
        }
        for (given, solid) in &shapes {
            let triangles = solid.triangles.iter().map(|corners| corners.as_slice());
            let edges = solid.edges.iter().map(|corners| corners.as_slice());
            for corners in triangles.chain(edges) {
                let [set, count, body] =
                    [number, corners.len(), given.body].map(|value| value as f64);
                for &[x, y, z] in corners {
                    table.row(&[set, count, body, x, y, z]).map_err(fault)?;
                }
            }
        }
    }
    if table.rows() > 0 {
        parts.table(table)?;
    }
    Ok(faults)
}

/// The shapes that can be read, few enough for a frame; and why others cannot.
fn shapes(set: &[description::Solid]) -> (Vec<Shape<'_>>, Vec<Diagnostic>) {
    let (mut shapes, mut faults): (Vec<Shape<'_>>, Vec<Diagnostic>) = Default::default();
    // Each has an equal part: a file is read once, whatever the others hold.
    let part = MOST_TRIANGLES / set.len().max(1);
    for given in set {
        match load(given, part) {
            Ok(solid) => shapes.push((given, solid)),
            Err(fault) => faults.push(*fault),
        }
    }
    let edges = share(shapes.iter().map(|(_, solid)| solid.edges.len()), MOST_EDGES);
    for (_, solid) in &mut shapes {
        solid.edges.truncate(edges);
    }
    (shapes, faults)
}

/// The largest part that each may have so that all together have no more than `all`: who needs less leaves it to the others.
pub fn share(needs: impl Iterator<Item = usize>, all: usize) -> usize {
    let mut needs: Vec<usize> = needs.collect();
    needs.sort_unstable();
    let (mut left, mut others) = (all, needs.len());
    for need in needs {
        if need > left / others {
            return left / others;
        }
        left -= need;
        others -= 1;
    }
    all
}

/// A shape of at most so many triangles; or why there is none.
fn load(given: &description::Solid, most: usize) -> Result<DrawnSolid, Box<Diagnostic>> {
    let path = &given.file;
    let fault = |why: &dyn std::fmt::Display, help: &str| {
        let message = format!("the solid {} is not shown: {why}", path.display());
        let instead = match given.whole {
            true => "; what follows from the chain is drawn instead",
            false => "",
        };
        Diagnostic::warning("solid", message)
            .at(given.place.clone())
            .help(format!("{help}{instead}"))
            .boxed()
    };
    let named = "its path is that from the machine file, with --set that from here";
    if !path.exists() {
        return Err(fault(&"there is no such file", named));
    }
    // A machine file may be a stranger's: a pipe could keep the command waiting, a device has no end.
    if !path.is_file() {
        return Err(fault(&"it is no regular file", named));
    }
    let file = File::open(path).map_err(|error| fault(&error, "check its rights"))?;
    let read = DrawnSolid::read(&mut BufReader::new(file), most);
    read.map_err(|why| fault(&why, "let the CAD system write it again, as STL in mm"))
}
