//! Bodies of a machine and of its tools, as its file and those that it names have them.

use std::io::BufReader;
use std::path::Path;

use nalgebra::{Rotation3, Vector3};
use post_clearance::convex::Convex;
use post_clearance::placement::Placement;
use post_clearance::proof::{Body, BodyKind};
use post_clearance::shape::{MeshFaults, Shape};
use post_machine::description::{
    GivenBody, GivenShape, Machine, Solid, ToolOutline, TurnedProfile,
};
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_report::solid;

use crate::disk;

/// Triangles that are read of one file.
const MOST_TRIANGLES: usize = 2_000_000;

/// More of them say no more of what can be hit, and cost time.
const MANY_TRIANGLES: usize = 200_000;

/// Parts of a file that do not hang together: of each it is asked whether another body encloses it.
const MOST_PARTS: usize = 10_000;

/// What is known of a tool's shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct ToolShape<'a> {
    /// Its number.
    pub number: u32,
    /// From the gauge point to the tip, mm.
    pub length: f64,
    /// What the machine file has of it.
    pub outline: Option<&'a ToolOutline>,
    /// Radius and corner radius as a file of tools or the CL file has them, mm.
    pub size: Option<[f64; 2]>,
}

impl ToolShape<'_> {
    /// What cuts, z in mm from the tip.
    pub fn cutter(&self) -> Option<TurnedProfile> {
        let drawn = self.outline.map(|outline| outline.cutter.clone());
        let drawn = drawn.filter(|profile| !profile.is_empty());
        drawn.or_else(|| {
            let [radius, corner] = self.size?;
            let corner = corner.clamp(0.0, radius.min(self.length));
            let mut profile = TurnedProfile::from(vec![[0.0, radius - corner]]);
            // One that is no arc is the cylinder around it.
            if corner <= 0.0 || profile.arc_to([corner, radius], corner).is_err() {
                profile = TurnedProfile::from(vec![[0.0, radius]]);
            }
            // Nothing says where it ends: up to the gauge point it is as thick as where it cuts.
            profile.line_to([self.length, radius]);
            Some(profile)
        })
    }

    /// The shape of its cutter is known, and not its radius alone.
    pub fn is_drawn(&self) -> bool {
        self.outline.is_some_and(|outline| !outline.cutter.is_empty())
    }
}

/// The bodies of a machine without a tool: what is held and what holds it first. What is wrong with them is said; a body
/// that cannot be had is an error.
pub(super) fn of_machine(machine: &Machine, findings: &mut Vec<Diagnostic>) -> Vec<Body> {
    let mut bodies = Vec::new();
    let given = machine.stocks.iter().map(|body| (BodyKind::Stock, body));
    let given = given.chain(machine.fixtures.iter().map(|body| (BodyKind::Fixture, body)));
    for (kind, given) in given {
        if let Some(shape) = given_shape(machine, given, findings) {
            bodies.push(Body { name: given.name.clone(), kind, link: given.link, shape });
        }
    }
    for solid in &machine.solids {
        let kind =
            if solid.whole || solid.body > 0 { BodyKind::Machine } else { BodyKind::Fixture };
        let name = solid_name(machine, solid);
        let at = (&solid.place, name.as_str());
        if let Some(shape) = mesh(&solid.file, at, &|corner| corner, findings) {
            bodies.push(Body { name, kind, link: solid.body, shape });
        }
    }
    bodies
}

/// What the machine file calls a body of `[solids]`.
pub fn solid_name(machine: &Machine, solid: &Solid) -> String {
    match (solid.whole, solid.body) {
        (false, 0) => "w".to_owned(),
        (false, _) => "t".to_owned(),
        (true, link) => link_name(machine, link),
    }
}

/// What the machine file calls a link: `b` the bed, else the axis that moves it.
pub(super) fn link_name(machine: &Machine, link: usize) -> String {
    let bed = machine.axes.iter().filter(|axis| axis.carries_part).count();
    match link {
        link if link == bed => "b".to_owned(),
        link if link < bed => machine.axes[link].name.clone(),
        link => machine.axes[link - 1].name.clone(),
    }
}

/// The bodies of a tool: what it has no shape for is named.
pub(super) fn of_tool(
    machine: &Machine,
    tool: &ToolShape<'_>,
    lacks: &mut Vec<String>,
) -> Vec<Body> {
    let ToolShape { number, length, outline, .. } = *tool;
    let link = machine.axes.len();
    let tip = machine.gauge - machine.tool_axis * length;
    let holder = outline.map_or(&[][..], |outline| &outline.holder.outer);
    let holder = Shape::turned(holder, machine.gauge, -machine.tool_axis);
    let cutter = tool.cutter();
    let cutter = cutter.and_then(|profile| Shape::turned(&profile.outer, tip, machine.tool_axis));
    let mut bodies = Vec::new();
    for (kind, what, shape) in
        [(BodyKind::Holder, "holder", holder), (BodyKind::Cutter, "cutter", cutter)]
    {
        let name = format!("{what} T{number}");
        match shape {
            Some(shape) => bodies.push(Body { name, kind, link, shape }),
            None => lacks.push(name),
        }
    }
    bodies
}

/// From the frame of a body's shape to that of the machine, every axis at zero: a stock may be where the CL file has it,
/// turned about the part's Z, and where the part sits.
pub fn placed(machine: &Machine, body: &GivenBody) -> Placement {
    match body.in_part {
        true => Placement {
            rotation: Rotation3::from_axis_angle(&Vector3::z_axis(), machine.turn).into_inner(),
            shift: machine.mount,
        },
        false => Placement::identity(),
    }
}

/// The shape of a fixture or of a stock, machine frame.
fn given_shape(
    machine: &Machine,
    given: &GivenBody,
    findings: &mut Vec<Diagnostic>,
) -> Option<Shape> {
    let placed = placed(machine, given);
    let pieces = match &given.shape {
        GivenShape::Block([low, high]) => vec![Convex::block(*low, *high)],
        GivenShape::Cylinder { ends, radius } => {
            let axis = (ends[1] - ends[0]).try_normalize(1e-9).unwrap_or_else(Vector3::z);
            vec![Convex::frustum(*ends, axis, [*radius; 2])]
        }
        GivenShape::File(file) => {
            return mesh(
                file,
                (&given.place, &given.name),
                &|corner| placed.point(corner),
                findings,
            );
        }
    };
    let shape = Shape::new(pieces.iter().map(|piece| piece.placed(&placed)).collect());
    if shape.is_none() {
        let why = ("it is farther than 100 m away", "coordinates are mm");
        findings.push(unusable(&given.name, why, &given.place));
    }
    shape
}

/// A body cannot be used: why, and what helps.
pub(super) fn unusable(
    name: &str,
    (why, help): (&str, &str),
    place: &Option<SourcePlace>,
) -> Diagnostic {
    Diagnostic::error("clearance-body", format!("the body {name} cannot be used: {why}"))
        .at(place.clone())
        .help(help)
}

/// What helps where a mesh is no solid.
const AS_A_SOLID: &str = "let the CAD system write it again, as a solid";

/// The shape in an STL file, its corners placed by `map`.
fn mesh(
    path: &Path,
    at: (&Option<SourcePlace>, &str),
    map: &dyn Fn(Vector3<f64>) -> Vector3<f64>,
    findings: &mut Vec<Diagnostic>,
) -> Option<Shape> {
    let (triangles, shape) = read_mesh(path, at, map, findings)?;
    let (place, name) = at;
    findings.extend(mesh_fault(name, shape.faults(), place));
    if triangles.len() > MANY_TRIANGLES {
        let message = format!(
            "{name} has {} triangles: more than {MANY_TRIANGLES} cost time and say no more of what can be hit",
            triangles.len()
        );
        let help = "a coarser mesh out of the CAD system";
        let many = Diagnostic::warning("clearance-body", message);
        findings.push(many.at(place.clone()).help(help));
    }
    Some(shape)
}

/// The triangles of a body in an STL file that are a closed surface; one that is none cannot be used.
pub(super) fn closed_mesh(
    path: &Path,
    (place, name): (&Option<SourcePlace>, &str),
    findings: &mut Vec<Diagnostic>,
) -> Option<Vec<[Vector3<f64>; 3]>> {
    let (triangles, shape) = read_mesh(path, (place, name), &|corner| corner, findings)?;
    let MeshFaults { open, inverted, empty, .. } = shape.faults();
    if empty > 0 {
        let why = format!("{empty} of its parts enclose no volume: nothing is inside of them");
        findings.push(unusable(name, (&why, AS_A_SOLID), place));
        return None;
    }
    if open + inverted > 0 {
        let why = format!(
            "what is inside is known of closed surfaces alone, and {open} edges of its mesh are not those of two triangles, at {inverted} two do not agree what is outside"
        );
        findings.push(unusable(name, (&why, AS_A_SOLID), place));
        return None;
    }
    Some(triangles)
}

/// The triangles in an STL file, their corners placed by `map`, and their shape.
fn read_mesh(
    path: &Path,
    (place, name): (&Option<SourcePlace>, &str),
    map: &dyn Fn(Vector3<f64>) -> Vector3<f64>,
    findings: &mut Vec<Diagnostic>,
) -> Option<(Vec<[Vector3<f64>; 3]>, Shape)> {
    let shown = path.display();
    let mut refuse = |why: String, help: &str| {
        findings.push(unusable(name, (&format!("{shown}: {why}"), help), place));
    };
    if !disk::is_file(path) {
        let help = "the path is that from the machine file";
        refuse("there is no such regular file".to_owned(), help);
        return None;
    }
    let mut triangles = Vec::new();
    let mut count = 0;
    let read = disk::open(path).map_err(|error| error.to_string()).and_then(|file| {
        let take = &mut |corners: [[f64; 3]; 3]| {
            count += 1;
            if count <= MOST_TRIANGLES {
                triangles.push(corners.map(|corner| map(Vector3::from(corner))));
            }
        };
        solid::triangles(&mut BufReader::new(file), take).map_err(|why| why.to_string())
    });
    let read = read.and_then(|()| match count > MOST_TRIANGLES {
        true => Err(format!("{count} triangles; at most {MOST_TRIANGLES} are possible")),
        false => Shape::mesh(&triangles).ok_or_else(|| {
            "it has no triangle with an area, or a corner farther than 100 m away".to_owned()
        }),
    });
    let read = read.and_then(|shape| match shape.parts() {
        parts if parts > MOST_PARTS => Err(format!(
            "it falls apart into {parts} pieces that share no corner; at most {MOST_PARTS} are possible"
        )),
        _ => Ok(shape),
    });
    match read {
        Ok(shape) => Some((triangles, shape)),
        Err(why) => {
            refuse(why, "an STL file, text or binary, in mm, as a CAD system exports it");
            None
        }
    }
}

/// What is wrong with a mesh that is used all the same.
fn mesh_fault(name: &str, faults: MeshFaults, place: &Option<SourcePlace>) -> Option<Diagnostic> {
    let MeshFaults { open, inverted, empty, .. } = faults;
    let message = match (open + inverted, empty) {
        (0, 0) => return None,
        (0, _) => format!(
            "{name} has {empty} parts without a volume: the two sides of a sheet; its surface counts"
        ),
        _ => format!(
            "{name} is no closed surface: {open} edges are not those of two triangles, at {inverted} two do not agree what is outside; its surface counts, what is wholly inside it may be missed"
        ),
    };
    Some(Diagnostic::warning("clearance-body", message).at(place.clone()).help(AS_A_SOLID))
}
