//! What `post tools` is asked: a file of tools or a CL file read, held against a CL file, and written in another format.

use std::collections::BTreeMap;
use std::path::Path;

use post_machine::description::{ToolData, ToolTable};
use post_machine::diagnostic::{Diagnostic, Severity};

use super::{ReadTools, TableUnits, ToolFormat, called, missing, read, write};
use crate::failure::Failure;
use crate::files::{self, PathArg, Role};
use crate::session::Session;

/// Endings of CL files, whose tools are those that they call.
const CL_ENDINGS: [&str; 9] =
    ["as", "clt", "cls", "clsf", "cl", "cldata", "apt", "aptsource", "ncl"];

/// What `--from` calls a CL file.
const CL: &str = "cl";

const TOOLS: Role = Role { what: "file of tools", remedy: "name another file with --output" };

/// What is to be done with a file of tools.
#[derive(Clone, Debug, Default)]
pub struct ToolsRequest {
    /// The file; a CL file where its ending is that of one.
    pub input: Option<PathArg>,
    /// Its format; none: as its text and name say.
    pub from: Option<String>,
    /// Its lengths are in inches where its format does not say in what.
    pub inch: bool,
    /// Length of the tool that its lengths count from, mm.
    pub reference: f64,
    /// Heads of its columns by what stands in them.
    pub columns: BTreeMap<String, String>,
    /// The CL file that calls the tools.
    pub against: Option<PathArg>,
    /// Where they are written to, in which format (none: as the ending says), and whether in inches.
    pub output: Option<PathArg>,
    /// Format of what is written; none: as the ending says.
    pub to: Option<String>,
    /// What is written is in inches.
    pub to_inch: bool,
}

/// The tools that were read.
#[derive(Debug)]
pub struct ListedTools {
    /// What messages call the file.
    pub name: String,
    /// The tools, by number; of a CL file in the order of their first use.
    pub tools: Vec<ToolData>,
    /// Format of the file; none: it is a CL file.
    pub format: Option<&'static ToolFormat>,
    /// Format in which they were written.
    pub written: Option<&'static ToolFormat>,
    /// What was written took standard output.
    pub printed: bool,
    /// What is to be said of them; nothing was written if an error is among it.
    pub findings: Vec<Diagnostic>,
}

impl ListedTools {
    /// Something is wrong.
    pub fn is_wrong(&self) -> bool {
        self.findings.iter().any(|finding| finding.severity == Severity::Error)
    }
}

/// Reads the tools, holds them against the CL file and writes them, as far as that is asked for.
///
/// # Errors
/// A file cannot be read or written, or no format fits.
pub fn list(session: &Session, request: &ToolsRequest) -> Result<ListedTools, Failure> {
    let mut listed = match cl_file(request) {
        Some(_) if request.against.is_some() => {
            let message = "a CL file is held against no other: its own tools are listed";
            let help = "name the file of tools, and the CL file with --against";
            return Err(Diagnostic::error("tools", message).help(help).into());
        }
        Some(file) => of_cl_file(session, file)?,
        None => of_table(session, request)?,
    };
    if let (Some(target), false) = (&request.output, listed.is_wrong()) {
        let units = TableUnits { inch: request.to_inch };
        let (text, format) = write(&listed.tools, target, request.to.as_deref(), units)?;
        listed.printed = files::write(session, &[(TOOLS, target, &text)])?;
        listed.written = Some(format);
    }
    Ok(listed)
}

/// The CL file whose tools are asked for.
fn cl_file(request: &ToolsRequest) -> Option<&PathArg> {
    let file = request.input.as_ref()?;
    let ending = file.path().and_then(Path::extension).unwrap_or_default();
    let is_cl = CL_ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known));
    let is_cl = match request.from.as_deref() {
        Some(format) => format == CL,
        None => is_cl,
    };
    is_cl.then_some(file)
}

fn of_cl_file(session: &Session, file: &PathArg) -> Result<ListedTools, Failure> {
    let (name, calls) = called(session, file)?;
    let tools = calls.into_iter().map(|call| call.tool).collect();
    let findings = Vec::new();
    Ok(ListedTools { name, tools, format: None, written: None, printed: false, findings })
}

fn of_table(session: &Session, request: &ToolsRequest) -> Result<ListedTools, Failure> {
    let file = request.input.as_ref().and_then(PathArg::path).unwrap_or(Path::new("/dev/stdin"));
    let table = ToolTable {
        file: file.to_owned(),
        format: request.from.clone(),
        inch: Some(request.inch),
        reference: request.reference,
        columns: request.columns.clone(),
        place: None,
        by_register: false,
        tools: None,
        findings: Vec::new(),
    };
    let mut read: ReadTools = read(session, &table, request.inch)?;
    let name = table.name();
    if let Some(against) = &request.against {
        let (cl_name, calls) = called(session, against)?;
        let found = missing(&cl_name, &calls, &read, &name);
        read.findings.extend(found);
    }
    let ReadTools { tools, format, findings } = read;
    Ok(ListedTools { name, tools, format: Some(format), written: None, printed: false, findings })
}
