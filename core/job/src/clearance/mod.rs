//! Whether anything hits anything while an NC program runs.

mod bodies;
mod watch;

use std::io::BufReader;

use post_clearance::proof::{BodyKind, Proof, Rules};
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joint, Joints};
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::verify::CutBounds;
use post_readback::{MOST_FAULTS, ProgramRun};

use crate::failure::Failure;
use crate::files::PathArg;
use crate::nc_program::{self, NcControl, ProgramFile, open_as};
use crate::session::Session;
use bodies::link_name;
use watch::ClearanceWatch;

pub use watch::PairRow;

/// A program that is to be proven.
#[derive(Clone, Debug)]
pub struct ClearanceRequest {
    /// The program.
    pub input: PathArg,
    /// The CL file that tells how thick its cutters are.
    pub cl: Option<PathArg>,
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct ClearanceFound {
    /// What is known of each pair of bodies.
    pub pairs: Vec<PairRow>,
    /// What has no body, and is not looked at.
    pub lacks: Vec<String>,
    /// Motions that were looked at.
    pub motions: u64,
    /// Distances that were computed for it.
    pub distances: u64,
    /// What is not clear, and what could not be read; errors and warnings.
    pub findings: Vec<Diagnostic>,
}

/// Proves a program.
///
/// # Errors
/// A file that cannot be read, or a machine that cannot be used.
pub fn clearance(
    session: &Session,
    control: &NcControl,
    request: &ClearanceRequest,
) -> Result<ClearanceFound, Failure> {
    let machine = &control.machine;
    let mut findings = unknown_names(machine);
    let bodies = bodies::of_machine(machine, &mut findings);
    let diameters = match &request.cl {
        Some(cl) => diameters(session, machine, cl)?,
        None => Vec::new(),
    };
    let program = ProgramFile::open(session, &request.input)?;
    let mut run = ProgramRun::new(control.program_with_rapids(&program)?);
    let mut watch = ClearanceWatch::new(control, bodies, diameters);
    while let Some(done) = run.block() {
        for what in done.iter() {
            watch.take(what);
        }
    }
    let mut found = watch.finish(&program.name);
    findings.extend(run.faults().iter().cloned());
    if run.faults().len() == MOST_FAULTS {
        findings.push(nc_program::given_up());
    }
    findings.append(&mut found.findings);
    found.findings = findings;
    found.lacks.splice(0..0, without_body(machine));
    Ok(found)
}

/// Diameters of the cutters of a CL file by tool, mm.
fn diameters(
    session: &Session,
    machine: &Machine,
    cl: &PathArg,
) -> Result<Vec<(u32, f64)>, Failure> {
    let (name, file) = open_as(session, "the CL file", cl)?;
    let settings = ClSettings::of(machine, &name);
    let mut course = ClCourse::new(settings, BufReader::new(file));
    let (_, findings) = CutBounds::of(&mut course, machine.control_point.along);
    if !findings.is_empty() {
        return Err(findings.into());
    }
    let tools = course.tools().iter();
    Ok(tools.filter_map(|tool| Some((tool.number, tool.diameter?))).collect())
}

/// Links of the machine that no body hangs on.
fn without_body(machine: &Machine) -> Vec<String> {
    let links = 0..=machine.axes.len();
    let bare = links.filter(|link| {
        machine.solids.iter().all(|solid| solid.body != *link)
            && machine.fixtures.iter().all(|body| body.link != *link)
    });
    let mut lacks: Vec<String> = bare.map(|link| link_name(machine, link)).collect();
    if machine.stock.is_none() {
        lacks.push("stock".to_owned());
    }
    lacks
}

/// Names of `[clearance] ignore` that nothing has.
fn unknown_names(machine: &Machine) -> Vec<Diagnostic> {
    let known = |name: &String| {
        ["w", "b", "t", "stock", "holder", "cutter"].contains(&name.as_str())
            || machine.axes.iter().any(|axis| axis.name == *name)
            || machine.fixtures.iter().any(|body| body.name == *name)
    };
    let names = machine.clearance.ignore.iter().flatten().filter(|name| !known(name));
    names
        .map(|name| {
            let message = format!("[clearance] ignore names {name}, and nothing is called so");
            let help = "an axis letter, b, w, t, stock, holder, cutter, or the name of a fixture";
            Diagnostic::error("clearance-body", message).help(help)
        })
        .collect()
}

/// A machine file says something of bodies besides pictures.
fn is_described(machine: &Machine) -> bool {
    machine.stock.is_some()
        || !machine.fixtures.is_empty()
        || !machine.outlines.is_empty()
        || machine.clearance != Default::default()
}

/// What of a machine's bodies is worth a word before a program runs: what has none, what cannot be used, and which touch
/// where all axes are at zero, or as near to it as their travel lets them. Nothing of a machine that describes none.
pub fn of_machine(machine: &Machine) -> Vec<Diagnostic> {
    if !is_described(machine) {
        return Vec::new();
    }
    let mut findings = unknown_names(machine);
    let all = bodies::of_machine(machine, &mut findings);
    let lacks = without_body(machine);
    if !lacks.is_empty() {
        let message = format!("nothing is proven of what has no body: {}", lacks.join(", "));
        let help =
            "[solids] names STL files of the machine, [fixture.NAME] and [stock] what is on it";
        findings.push(Diagnostic::warning("clearance-body", message).help(help));
    }
    let mut joints = Joints::default();
    for (value, axis) in joints.iter_mut().zip(&machine.axes) {
        if let Some([least, most]) = axis.travel {
            *value = value.max(least).min(most);
        }
    }
    let mut proof = proof(machine, all);
    for (pair, apart) in proof.at(&joints) {
        if apart.at_most <= 0.0 {
            let [one, other] = pair.map(|place| proof.bodies()[place].name.as_str());
            let message = format!("{one} and {other} touch where the axes stand at zero");
            let help = "[clearance] ignore = [[\"…\", \"…\"]] leaves a pair out; else one of them is not drawn true to size";
            findings.push(Diagnostic::warning("clearance-body", message).help(help));
        }
    }
    findings
}

/// The proof for the bodies of a machine.
fn proof(machine: &Machine, bodies: Vec<post_clearance::proof::Body>) -> Proof {
    let axes: Vec<Joint> = machine.axes.iter().map(|axis| axis.joint).collect();
    let rules = &machine.clearance;
    let called = |body: &post_clearance::proof::Body, name: &String| {
        let kind = match body.kind {
            BodyKind::Holder => "holder",
            BodyKind::Cutter => "cutter",
            BodyKind::Stock => "stock",
            BodyKind::Machine | BodyKind::Fixture => "",
        };
        let ends = (name == "w" && body.link == 0) || (name == "t" && body.link == axes.len());
        body.name == *name || kind == name || ends || link_name(machine, body.link) == *name
    };
    let counts = |one: &post_clearance::proof::Body, other: &post_clearance::proof::Body| {
        let both = one.kind == BodyKind::Machine && other.kind == BodyKind::Machine;
        let beside = one.link.abs_diff(other.link) == 1;
        let ignored = rules.ignore.iter().any(|[first, last]| {
            (called(one, first) && called(other, last))
                || (called(one, last) && called(other, first))
        });
        // Of neighbours in the chain one slides or turns on the other.
        !(ignored || both && beside)
    };
    let kept = Rules { keep: rules.keep, rapid: rules.rapid, ..Rules::default() };
    Proof::new(&axes, bodies, kept, counts)
}
