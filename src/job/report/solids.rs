//! Shapes of the machine's bodies, as the page draws them.

use std::fs::File;
use std::io::BufReader;

use post_machine::description::{self, Machine};
use post_machine::diagnostic::Diagnostic;
use post_report::meta::Meta;
use post_report::solid::{MOST_EDGES, MOST_TRIANGLES, Solid};
use post_report::table::{Column, TableWriter};

use super::parts::{Parts, fault};
use crate::failure::Failure;

/// What cannot be shown of the shapes that a machine file names; a picture lacks them, and nothing else.
pub fn faults(machine: &Machine) -> Vec<Diagnostic> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let machines = std::iter::once(machine).chain(heads);
    let mut found: Vec<Diagnostic> = Vec::new();
    for solid in machines.flat_map(|machine| &machine.solids) {
        if let Err(fault) = load(solid, 1)
            && found.iter().all(|known| known.message != fault.message)
        {
            found.push(*fault);
        }
    }
    found
}

/// Adds the shapes of a machine and its heads to the parts of a report; what cannot be shown comes back.
///
/// A row of the table is a corner: `corners` of them are a triangle (3) or an edge (2) of `body`, of the machine (0) or the nth
/// of its heads; mm, machine frame, every axis at zero.
///
/// # Errors
/// They cannot be kept.
pub(super) fn add(
    machine: &Machine,
    meta: &mut Meta,
    parts: &mut Parts,
) -> Result<Vec<Diagnostic>, Failure> {
    let columns = [("machine", ""), ("corners", ""), ("body", "")].into_iter();
    let columns = columns.map(|(name, unit)| Column::new(name, unit, 0));
    let places = ["x", "y", "z"].map(|name| Column::new(name, "mm", 2));
    let columns = columns.chain(places).collect();
    let mut table = TableWriter::new("solids", columns, Parts::scratch()?);
    let heads = machine.heads.iter().map(|head| &head.machine);
    let told = meta.machine.iter_mut().chain(&mut meta.heads);
    for (number, (machine, told)) in std::iter::once(machine).chain(heads).zip(told).enumerate() {
        for (given, solid) in shapes(machine) {
            if given.whole && !told.solid.contains(&given.body) {
                told.solid.push(given.body);
            }
            let triangles = solid.triangles.iter().map(|corners| corners.as_slice());
            let edges = solid.edges.iter().map(|corners| corners.as_slice());
            for corners in triangles.chain(edges) {
                for &[x, y, z] in corners {
                    let about = [number, corners.len(), given.body].map(|value| value as f64);
                    table
                        .row(&[about[0], about[1], about[2], x, y, z])
                        .map_err(fault)?;
                }
            }
        }
    }
    if table.rows() > 0 {
        parts.table(table)?;
    }
    Ok(faults(machine))
}

/// The shapes that can be read, few enough for a frame.
fn shapes(machine: &Machine) -> Vec<(&description::Solid, Solid)> {
    let named = machine.solids.iter();
    let mut shapes: Vec<(&description::Solid, Solid)> = named
        .filter_map(|given| Some((given, load(given, MOST_TRIANGLES).ok()?)))
        .collect();
    let most = share(
        shapes.iter().map(|(_, solid)| solid.triangles.len()),
        MOST_TRIANGLES,
    );
    for (given, solid) in &mut shapes {
        if solid.triangles.len() > most
            && let Ok(fewer) = load(given, most)
        {
            *solid = fewer;
        }
    }
    let most = share(
        shapes.iter().map(|(_, solid)| solid.edges.len()),
        MOST_EDGES,
    );
    for (_, solid) in &mut shapes {
        solid.edges.truncate(most);
    }
    shapes
}

/// The largest part that each may have so that all together have no more than `all`: who needs less leaves it to the others.
fn share(needs: impl Iterator<Item = usize>, all: usize) -> usize {
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
fn load(given: &description::Solid, most: usize) -> Result<Solid, Box<Diagnostic>> {
    let path = &given.file;
    let fault = |why: &dyn std::fmt::Display| {
        let message = format!("the solid {} is not shown: {why}", path.display());
        Diagnostic::warning("solid", message)
            .at(given.place.clone())
            .help("what follows from the chain is drawn instead")
            .boxed()
    };
    // A machine file may be a stranger's: a pipe could keep the command waiting, a device has no end.
    if path.exists() && !path.is_file() {
        return Err(fault(&"it is no regular file"));
    }
    let file = File::open(path).map_err(|error| fault(&error))?;
    Solid::read(&mut BufReader::new(file), most).map_err(|why| fault(&why))
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn who_needs_less_leaves_it_to_the_others() {
        for (needs, all, each) in [
            (vec![], 10, 10),
            (vec![3, 4], 10, 10),
            (vec![20, 2], 10, 8),
            (vec![20, 20, 2], 10, 4),
            (vec![9, 9, 9], 10, 3),
        ] {
            assert_eq!(share(needs.clone().into_iter(), all), each, "{needs:?}");
        }
    }
}
