//! Shapes of the machine's bodies, fixtures and stock among them, as the page draws them.

use std::borrow::Cow;
use std::io::{BufReader, Cursor};

use nalgebra::Vector3;
use post_clearance::placement::Placement;
use post_machine::description::{GivenShape, Machine};
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_report::meta::Meta;
use post_report::solid::{DrawnSolid, MOST_EDGES, MOST_TRIANGLES, Vertex};
use post_report::table::{TableColumn, TableWriter};

use super::given_bodies;
use super::parts::{Parts, fault};
use crate::clearance::{self, StockLeft};
use crate::disk;
use crate::failure::Failure;

/// A body that is drawn as a machine file describes it.
#[derive(Clone)]
struct DrawnBody<'m> {
    /// What tables of clearance call it.
    name: String,
    /// What it hangs on: 0 is the part, n what follows the nth axis of the chain.
    link: usize,
    /// It stands in place of what follows from the chain.
    whole: bool,
    shape: Cow<'m, GivenShape>,
    place: &'m Option<SourcePlace>,
    /// A stock: from its frame to the machine's. Its edges alone are drawn, the path goes through it.
    stock: Option<Placement>,
}

/// A body and its shape, few enough triangles for a frame.
type Shape<'m> = (DrawnBody<'m>, DrawnSolid);

/// What cannot be shown of the shapes that a machine file names; a picture lacks them, and nothing else.
pub fn faults(machine: &Machine) -> Vec<Diagnostic> {
    sets(machine).iter().flat_map(|set| shapes(set).1).collect()
}

/// A body as lines: its name, as tables of clearance have it, and its edges, mm, machine frame, every axis at zero.
#[derive(Clone, Debug)]
pub struct BodyEdges {
    /// The name.
    pub name: String,
    /// The edges.
    pub edges: Vec<[Vertex; 2]>,
}

/// All bodies of a machine without its heads, and of its tools, of which a shape is known.
pub fn edges(machine: &Machine) -> Vec<BodyEdges> {
    let set = bodies(machine);
    let shapes = shapes(&set).0.into_iter();
    let mut all: Vec<BodyEdges> =
        shapes.map(|(body, solid)| BodyEdges { name: body.name, edges: solid.edges }).collect();
    for outline in &machine.outlines {
        let number = outline.number;
        let length = machine.tools.iter().find(|(tool, _)| *tool == number);
        let tip = machine.gauge - machine.tool_axis * length.map_or(0.0, |(_, length)| *length);
        let holder =
            given_bodies::turned(&outline.holder.points, machine.gauge, -machine.tool_axis);
        let cutter = given_bodies::turned(&outline.cutter.points, tip, machine.tool_axis);
        for (what, edges) in [("holder", holder), ("cutter", cutter)] {
            all.push(BodyEdges { name: format!("{what} T{number}"), edges });
        }
    }
    all.retain(|body| !body.edges.is_empty());
    all
}

/// The bodies of a machine and those of its heads that have others.
fn sets(machine: &Machine) -> Vec<Vec<DrawnBody<'_>>> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let mut sets: Vec<Vec<DrawnBody<'_>>> = Vec::new();
    for machine in std::iter::once(machine).chain(heads) {
        let bodies = bodies(machine);
        if sets.iter().all(|set| !same(set, &bodies)) {
            sets.push(bodies);
        }
    }
    sets
}

/// The bodies of a machine without its heads.
fn bodies(machine: &Machine) -> Vec<DrawnBody<'_>> {
    let solids = machine.solids.iter().map(|solid| DrawnBody {
        name: clearance::solid_name(machine, solid),
        link: solid.body,
        whole: solid.whole,
        shape: Cow::Owned(GivenShape::File(solid.file.clone())),
        place: &solid.place,
        stock: None,
    });
    let fixtures = machine.fixtures.iter().map(|body| (body, None));
    let stocks = machine.stocks.iter().map(|body| (body, Some(clearance::placed(machine, body))));
    let given = fixtures.chain(stocks).map(|(body, stock)| DrawnBody {
        name: body.name.clone(),
        link: body.link,
        whole: false,
        shape: Cow::Borrowed(&body.shape),
        place: &body.place,
        stock,
    });
    solids.chain(given).collect()
}

/// They show the same, wherever they are named.
fn same(one: &[DrawnBody<'_>], other: &[DrawnBody<'_>]) -> bool {
    let equal = |one: &DrawnBody<'_>, other: &DrawnBody<'_>| {
        let (hung, other_hung) = ((one.link, one.whole), (other.link, other.whole));
        hung == other_hung && one.shape == other.shape && one.stock == other.stock
    };
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| equal(one, other))
}

/// Adds the shapes of a machine and its heads to the parts of a report; what cannot be shown comes back.
///
/// A row of the table is a corner: `corners` of them are a triangle (3) or an edge (2) of `body`, in the `set` of those that
/// the machine or a head has; mm, machine frame, every axis at zero. What is `left` of each stock hangs where it does; `over` of a
/// table of its own is how far it is from the part that is to become of it, mm.
///
/// # Errors
/// They cannot be kept.
pub(super) fn add(
    machine: &Machine,
    left: &[StockLeft],
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
    for (number, set) in sets(machine).iter().enumerate() {
        let (shapes, found) = shapes(set);
        faults.extend(found);
        let told = meta.machine.iter_mut().chain(&mut meta.heads);
        for (_, told) in machines.iter().zip(told).filter(|(one, _)| same(&bodies(one), set)) {
            told.shapes = number;
            told.solid = shapes
                .iter()
                .filter(|(given, _)| given.whole)
                .map(|(given, _)| given.link)
                .collect();
        }
        for (given, solid) in &shapes {
            let triangles = solid.triangles.iter().map(|corners| corners.as_slice());
            let edges = solid.edges.iter().map(|corners| corners.as_slice());
            for corners in triangles.chain(edges) {
                let [set, count, body] =
                    [number, corners.len(), given.link].map(|value| value as f64);
                for &[x, y, z] in corners {
                    table.row(&[set, count, body, x, y, z]).map_err(fault)?;
                }
            }
        }
    }
    let most = MOST_TRIANGLES / 2 / left.len().max(1);
    let mut compared: Vec<(&StockLeft, Vec<ToldTriangle>)> = Vec::new();
    for left in left {
        let triangles = what_is_left(left, most).unwrap_or_default();
        match left.over() {
            Some(over) => compared.push((left, told(left, over, triangles))),
            None => {
                let corners = triangles.iter().flatten();
                for [x, y, z] in corners {
                    table.row(&[0.0, 3.0, left.link as f64, *x, *y, *z]).map_err(fault)?;
                }
            }
        }
    }
    if table.rows() > 0 {
        parts.table(table)?;
    }
    if !compared.is_empty() {
        let body = TableColumn::new("body", "", 0);
        let columns = [("over", 3), ("x", 2), ("y", 2), ("z", 2)];
        let columns = columns.map(|(name, decimals)| TableColumn::new(name, "mm", decimals));
        let columns = std::iter::once(body).chain(columns).collect();
        let mut table = TableWriter::new("left", columns, Parts::scratch()?);
        for (left, triangles) in compared {
            for (over, corners) in triangles {
                for [x, y, z] in corners {
                    table.row(&[left.link as f64, over, x, y, z]).map_err(fault)?;
                }
            }
        }
        parts.table(table)?;
    }
    Ok(faults)
}

/// A triangle, and how far it is from the part that is to become of its stock, mm: below zero in it, zero where it is as near
/// as a cell tells.
type ToldTriangle = (f64, [Vertex; 3]);

/// Triangles of what is left of a stock, no more than `most`, mm, machine frame; none where nothing is.
fn what_is_left(left: &StockLeft, most: usize) -> Option<Vec<[Vertex; 3]>> {
    let solid = DrawnSolid::read(&mut Cursor::new(left.stl()), most).ok()?;
    let place = |corner: Vertex| left.placed.point(Vector3::from(corner)).into();
    Some(solid.triangles.into_iter().map(|corners| corners.map(place)).collect())
}

/// The same with how far each is from the part.
fn told(
    left: &StockLeft,
    mut over: impl FnMut(Vector3<f64>) -> f64,
    triangles: Vec<[Vertex; 3]>,
) -> Vec<ToldTriangle> {
    let told = triangles.into_iter().map(|corners| {
        let middle = corners.map(Vector3::from).iter().sum::<Vector3<f64>>() / 3.0;
        (over(left.placed.back(middle)), corners)
    });
    told.collect()
}

/// The shapes that can be read, few enough for a frame; and why others cannot.
fn shapes<'m>(set: &[DrawnBody<'m>]) -> (Vec<Shape<'m>>, Vec<Diagnostic>) {
    let (mut shapes, mut faults): (Vec<Shape<'_>>, Vec<Diagnostic>) = Default::default();
    let files = set.iter().filter(|given| matches!(*given.shape, GivenShape::File(_)));
    // Each has an equal part: a file is read once, whatever the others hold.
    let part = MOST_TRIANGLES / files.count().max(1);
    for given in set {
        match load(given, part) {
            Ok(mut solid) => {
                if let Some(stock) = &given.stock {
                    solid.triangles.clear();
                    for corner in solid.edges.iter_mut().flatten() {
                        *corner = stock.point(Vector3::from(*corner)).into();
                    }
                }
                shapes.push((given.clone(), solid));
            }
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
fn load(given: &DrawnBody<'_>, most: usize) -> Result<DrawnSolid, Box<Diagnostic>> {
    let path = match &*given.shape {
        GivenShape::File(path) => path,
        GivenShape::Block(corners) => return Ok(given_bodies::block(*corners)),
        GivenShape::Cylinder { ends, radius } => {
            return Ok(given_bodies::cylinder(*ends, *radius));
        }
    };
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
    if !disk::exists(path) {
        return Err(fault(&"there is no such file", named));
    }
    // A machine file may be a stranger's: a pipe could keep the command waiting, a device has no end.
    if !disk::is_file(path) {
        return Err(fault(&"it is no regular file", named));
    }
    let file = disk::open(path).map_err(|error| fault(&error, "check its rights"))?;
    let read = DrawnSolid::read(&mut BufReader::new(file), most);
    read.map_err(|why| fault(&why, "let the CAD system write it again, as STL in mm"))
}
