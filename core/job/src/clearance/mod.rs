//! Whether anything hits anything while an NC program runs.

mod bodies;
mod choice;
mod left;
mod line_row;
mod line_table;
mod names;
mod of_job;
mod outlines;
mod pair_row;
mod spared;
mod start;
mod stock_left;
mod summary;
pub mod text;
mod told;
mod tool_cut;
mod watch;

use std::path::{Path, PathBuf};

use post_clearance::proof::{Body, BodyKind, Proof, Rules};
use post_machine::description::{GivenBody, GivenShape, Machine};
use post_machine::diagnostic::{Diagnostic, Severity, Short};
use post_machine::kinematics::{Joint, Joints};
use post_readback::course::cl::ClSettings;
use post_readback::{MOST_FAULTS, ProgramRun};

use crate::cl_facts::ClFacts;
use crate::columns::CsvTable;
use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg, Role};
use crate::nc_program::{self, NcControl, ProgramFile, ProgramText, open_as};
use crate::session::Session;
pub(crate) use bodies::{placed, solid_name};

use bodies::link_name;
use line_table::LineTable;
use watch::ClearanceWatch;

pub(crate) use choice::ChoiceBodies;
pub use line_row::LineRow;
pub use of_job::of_job;
pub use pair_row::PairRow;
pub use post_removal::compare::Farthest;
pub use stock_left::{StockLeft, write_stl};
pub use summary::{ClearanceSummary, CutSummary, PairSummary, StockSummary};
pub use tool_cut::{LongestAt, MostAt, ToolCut};
pub use watch::{Heard, Hearer};

/// A program that is to be proven.
#[derive(Clone, Debug)]
pub struct ClearanceRequest {
    /// The program.
    pub input: PathArg,
    /// The CL file that tells how thick its cutters are.
    pub cl: Option<PathArg>,
    /// Where a row of each line that moves goes, as CSV.
    pub csv: Option<PathArg>,
}

/// A table of lines.
const LINES: Role = Role { what: "table", remedy: "name another file with --csv" };

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
    /// What is left of each stock that gets less by what is cut.
    pub left: Vec<StockLeft>,
}

impl ClearanceFound {
    /// Something is not clear, or that it is is not proven.
    pub fn is_wrong(&self) -> bool {
        self.findings.iter().any(|finding| finding.severity == Severity::Error)
    }
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
    let facts = match &request.cl {
        Some(cl) => {
            let (name, file) = open_as(session, "the CL file", cl)?;
            ClFacts::read(ClSettings::of(&control.machine, &name), file)?
        }
        None => ClFacts::default(),
    };
    let program = ProgramFile::open(session, &request.input)?;
    let name = &program.name;
    let text = Box::new(program.text()?);
    let Some(target) = &request.csv else { return prove(control, name, text, &facts, None) };
    let mut files = AtomicFile::create(session, &[(LINES, target)])?;
    let [file] = files.as_mut_slice() else { return prove(control, name, text, &facts, None) };
    let (mut last, mut lines) = (LineRow::default(), LineTable::new()?);
    let mut hear = |heard: &Heard| {
        if let Some(row) = last.hear(heard) {
            lines.take(&row);
        }
    };
    let found = prove(control, name, text, &facts, Some(&mut hear))?;
    if last.is_told() {
        lines.take(&last);
    }
    let mut table = CsvTable::new(LineRow::columns(), file);
    let mut written = Ok(());
    lines.hand_on(&mut |row| {
        if written.is_ok() {
            written = table.row(row);
        }
    })?;
    written?;
    table.finish()?;
    AtomicFile::finish(session, files)?;
    Ok(found)
}

/// Proves the program `name` in `text`, which `control` runs; `facts` are those of its CL file. Who
/// `hear`s is told of each motion how near any two bodies come on it.
///
/// # Errors
/// The program cannot be read, or the machine not be solved.
pub fn prove(
    control: &NcControl,
    name: &str,
    text: ProgramText<'_>,
    facts: &ClFacts,
    hear: Option<&mut Hearer<'_>>,
) -> Result<ClearanceFound, Failure> {
    let machine = &control.machine;
    let mut findings = Vec::new();
    let called: Vec<u32> = facts.tools.iter().map(|tool| tool.number).collect();
    let (bodies, stocks) = described(machine, Some(&called), &mut findings);
    let tools = facts.tools.iter();
    let sizes = tools.filter_map(|tool| Some((tool.number, [tool.diameter?, tool.corner_radius])));
    let cuts = Cuts { sizes: sizes.collect(), fastest: facts.fastest };
    let mut run = ProgramRun::new(control.program_with_rapids(name, text)?);
    let mut watch = ClearanceWatch::new(control, bodies, cuts, hear, stocks);
    while let Some(done) = run.block() {
        for what in done.iter() {
            watch.take(what);
        }
    }
    let mut found = watch.finish(name);
    findings.extend(run.faults().iter().cloned());
    if run.faults().len() == MOST_FAULTS {
        findings.push(nc_program::given_up());
    }
    if found.motions == 0 && run.faults().is_empty() {
        let message = format!("{name} moves nothing, and nothing is proven of it");
        findings.push(Diagnostic::warning("clearance", message).help("is the file whole?"));
    }
    let notes = &run.program().program().report().notes;
    let skipped = notes.iter().filter(|note| note.code == "nc-skip");
    findings.extend(skipped.map(|note| {
        let message = "blocks behind / are run here; with the switch on the machine leaves them out, and of that nothing is proven";
        Diagnostic::error("clearance", message)
            .at(note.place.clone())
            .help("take the / away where the block is wanted, or the block where it is not")
    }));
    findings.extend(notes.iter().filter(|note| note.code == "nc-peck").cloned());
    findings.append(&mut found.findings);
    found.findings = findings;
    found.lacks.splice(0..0, without_body(machine));
    Ok(found)
}

/// The bodies of a machine and the stocks that are cut, as they are proven; `called` are the tools of the program's CL
/// file. What is wrong with them is said, once.
fn described(
    machine: &Machine,
    called: Option<&[u32]>,
    findings: &mut Vec<Diagnostic>,
) -> (Vec<Body>, Vec<left::CutStock>) {
    findings.extend(names::unknown(machine, called));
    let bodies = bodies::of_machine(machine, findings);
    let mut again = Vec::new();
    let stocks = left::CutStock::all(machine, &mut again);
    // What is wrong with the body of a stock was said of it as a body.
    again.retain(|finding| !findings.contains(finding));
    findings.append(&mut again);
    (bodies, stocks)
}

/// Ways between passes go past bodies: a part that nobody has drawn would be in no way's way.
pub(crate) fn without_stock(machine: &Machine) -> Option<Diagnostic> {
    if !machine.clearance.shortens_ways() || !machine.stocks.is_empty() {
        return None;
    }
    let message = "ways between passes are to be shortened ([clearance] low_retracts, link), and no [stock] is drawn: they would go through the part";
    let help =
        "[stock] block, cylinder or file: the part as it is clamped, in the frame of the part";
    Some(Diagnostic::error("clearance-body", message).help(help))
}

/// The STL files of a machine's bodies, whether they are there or not.
pub fn files(machine: &Machine) -> impl Iterator<Item = &Path> {
    let given =
        machine.stocks.iter().chain(&machine.fixtures).filter_map(|body| match &body.shape {
            GivenShape::File(file) => Some(file),
            _ => None,
        });
    given.chain(machine.solids.iter().map(|solid| &solid.file)).map(PathBuf::as_path)
}

/// What a CL file tells of its cuts.
#[derive(Clone, Debug, Default)]
struct Cuts {
    /// Diameters and corner radii of the cutters by tool, mm.
    sizes: Vec<(u32, [f64; 2])>,
    /// The largest feed of a cut, mm/min; zero where none is known.
    fastest: f64,
}

/// Links of the machine that no body hangs on.
fn without_body(machine: &Machine) -> Vec<String> {
    let links = 0..=machine.axes.len();
    let bare = links.filter(|link| {
        machine.solids.iter().all(|solid| solid.body != *link)
            && machine.fixtures.iter().all(|body| body.link != *link)
    });
    let mut lacks: Vec<String> = bare.map(|link| link_name(machine, link)).collect();
    if machine.stocks.is_empty() {
        lacks.push("stock".to_owned());
    }
    lacks
}

/// What is cut is taken from a stock of a machine.
pub fn cuts_stock(machine: &Machine) -> bool {
    machine.stocks.iter().any(|stock| stock.cut.is_some())
}

/// A machine file says something of bodies besides pictures.
pub fn is_described(machine: &Machine) -> bool {
    !machine.stocks.is_empty()
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
    let mut findings: Vec<Diagnostic> = without_stock(machine).into_iter().collect();
    let (all, _) = described(machine, None, &mut findings);
    let lacks = without_body(machine);
    if !lacks.is_empty() {
        let message = format!("nothing is proven of what has no body: {}", lacks.join(", "));
        let help =
            "[solids] names STL files of the machine, [fixture.NAME] and [stock] what is on it";
        findings.push(Diagnostic::warning("clearance-body", message).help(help));
    }
    findings.extend(outlines::of_tools(machine));
    findings.extend(machine.stocks.iter().filter_map(coarse_cells));
    if machine.stocks.iter().any(|stock| stock.cut.is_none())
        && machine.outlines.iter().any(|outline| !outline.cutter.is_empty())
    {
        let whole = machine.stocks.iter().filter(|stock| stock.cut.is_none());
        findings.extend(whole.map(|stock| {
            let what = match stock.name.as_str() {
                "stock" => "the stock",
                name => name,
            };
            let message =
                format!("{what} counts as it is before the first cut, whatever is cut of it");
            let table = stock.name.replace(' ', ".");
            let help =
                format!("cut = true under [{table}] takes from it what the drawn cutters remove");
            Diagnostic::warning("clearance-body", message).help(help)
        }));
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

/// Cells that are larger than a stock is thick tell nothing of what is left of it.
fn coarse_cells(stock: &GivenBody) -> Option<Diagnostic> {
    let resolution = stock.cut.as_ref()?.resolution?;
    let [low, high] = stock.extents()?;
    let thin = low.iter().zip(high).map(|(low, high)| high - low).fold(f64::INFINITY, f64::min);
    (resolution > thin).then(|| {
        let (name, resolution, thin) = (&stock.name, Short(resolution), Short(thin));
        let message = format!(
            "resolution of {name} is {resolution} mm, and it is {thin} mm thick: what is cut of it is not known"
        );
        let help = "a tenth of the smallest cutter, or leave it out: it follows from the size";
        Diagnostic::warning("clearance-body", message).at(stock.place.clone()).help(help)
    })
}

/// The proof for the bodies of a machine.
fn proof(machine: &Machine, bodies: Vec<Body>) -> Proof {
    let axes: Vec<Joint> = machine.axes.iter().map(|axis| axis.joint).collect();
    let rules = &machine.clearance;
    let counts = |one: &Body, other: &Body| {
        let both = one.kind == BodyKind::Machine && other.kind == BodyKind::Machine;
        let beside = one.link.abs_diff(other.link) == 1;
        // Of neighbours in the chain one slides or turns on the other.
        let mut ignored = rules.ignore.iter();
        !(both && beside || ignored.any(|pair| names::mean(machine, pair, [one, other])))
    };
    let of = |one: &Body, other: &Body| {
        let pairs = rules.pairs.iter();
        let pair = pairs.rev().find(|pair| names::mean(machine, &pair.between, [one, other]))?;
        Some(Rules { keep: pair.keep, rapid: pair.rapid, ..Rules::default() })
    };
    let kept = Rules { keep: rules.keep, rapid: rules.rapid, ..Rules::default() };
    Proof::new(&axes, bodies, kept, counts).with_rules(of)
}
