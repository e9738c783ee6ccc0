//! Files of tools: tool tables of controls, their offsets as programs, libraries of CAM systems and tables of presetters,
//! read into one type ([`ToolData`]), checked, and written.
//!
//! A format is a row of [`FORMATS`] and a file beside this one. Whatever a reader cannot be sure of is a fault with its
//! line; nothing is guessed.

mod called;
mod csv_table;
mod format;
mod freecad;
mod fusion;
mod heidenhain;
mod linuxcnc;
mod machine_toml;
mod offset_program;
mod reading;
mod request;
mod siemens;
mod written;

use std::io::{self, Read as _};
use std::path::Path;

use post_machine::description::{Machine, OutputUnits, ToolData, ToolTable};
use post_machine::diagnostic::{Diagnostic, Severity, Short};

use crate::disk::{self, File};
use crate::failure::Failure;
use crate::files::FileFault;
use crate::session::Session;
pub use called::{CalledTool, called, missing};
pub use format::{FORMATS, ToolFormat, format_named};
pub use reading::ToolReading;
pub use request::{ListedTools, ToolsRequest, list};
pub use written::{TableUnits, write};

/// Longest file of tools, bytes: libraries of CAM systems have megabytes.
const MOST_BYTES: u64 = 1 << 26;

/// Tools of one file.
pub const MOST_TOOLS: usize = 20_000;

/// Tools as a file has them, and what is to be said of it.
#[derive(Debug)]
pub struct ReadTools {
    /// The tools, by number.
    pub tools: Vec<ToolData>,
    /// Its format.
    pub format: &'static ToolFormat,
    /// What is wrong, and what is worth a look.
    pub findings: Vec<Diagnostic>,
}

impl ReadTools {
    /// Something is wrong with the file.
    pub fn is_wrong(&self) -> bool {
        self.findings.iter().any(|finding| finding.severity == Severity::Error)
    }
}

/// Reads a file of tools, as `table` says; where its format does not say the units of its lengths, they are in inches if
/// `inch` says so.
///
/// # Errors
/// The file cannot be read, or its format is not known.
pub fn read(session: &Session, table: &ToolTable, inch: bool) -> Result<ReadTools, Failure> {
    let name = table.name();
    let text = text(session, table)?;
    let format = format::of(table, &text)?;
    let near = |path: &Path| bit(session, &table.file, path);
    let mut reading = ToolReading::new(&name, &text, table);
    reading.near = Some(&near);
    reading.unit = if table.inch.unwrap_or(inch) { 25.4 } else { 1.0 };
    (format.read)(&mut reading);
    let (tools, findings) = reading.finish(table.reference);
    Ok(ReadTools { tools, format, findings })
}

/// Text of the file, which may be one of an older system: what is no UTF-8 is Latin-1.
fn text(session: &Session, table: &ToolTable) -> Result<String, Failure> {
    let bytes = bytes(session, &table.file).map_err(|error| {
        let fault = Diagnostic::from(FileFault::read(&table.file, error));
        fault.at(table.place.clone())
    })?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("{} is longer than any file of tools", table.name());
        return Err(Diagnostic::error("tools", message).into());
    }
    if bytes.starts_with(b"PK\x03\x04") {
        let message = format!("{} is a packed archive", table.name());
        let help = "unpack it, or export the library as JSON: the text in it is what is read";
        return Err(Diagnostic::error("tools", message).help(help).into());
    }
    let text = String::from_utf8(bytes).unwrap_or_else(|fault| {
        let bytes = fault.into_bytes();
        bytes.into_iter().map(char::from).collect()
    });
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    // Lines end with LF, CR and LF, or CR alone.
    Ok(match text.contains('\r') {
        true => text.replace("\r\n", "\n").replace('\r', "\n"),
        false => text,
    })
}

/// The bytes of a regular file: a pipe could keep the command waiting, a device has no end.
fn bytes(session: &Session, path: &Path) -> io::Result<Vec<u8>> {
    if !disk::metadata(path)?.is_file() {
        return Err(io::Error::other("no regular file"));
    }
    session.read_files().note("the file of tools", path);
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A file that a library names: beside it, or in the folder `Bit` beside the library's.
fn bit(session: &Session, library: &Path, named: &Path) -> io::Result<String> {
    let folder = library.parent().unwrap_or(Path::new(""));
    let beside = folder.join(named);
    let path = match disk::is_file(&beside) {
        true => beside,
        false => folder.join("..").join("Bit").join(named),
    };
    let bytes = bytes(session, &path)?;
    String::from_utf8(bytes).map_err(|_| io::Error::other("it is no text"))
}

/// Puts what the file of tools has into a machine and its heads, if the machine names one; what is worth a look is kept
/// there ([`ToolTable::findings`]).
///
/// # Errors
/// The file cannot be read, something is wrong with it, or it has a length that is none.
pub fn equip(session: &Session, machine: &mut Machine) -> Result<(), Failure> {
    let Some(table) = machine.tool_table.clone() else {
        return Ok(());
    };
    let inch = machine.control.units == OutputUnits::Inch;
    let mut read = read(session, &table, inch)?;
    refuse_negative(&mut read, &table.name());
    if read.is_wrong() {
        return Err(read.findings.into());
    }
    let mut findings = read.findings;
    let by_register = read.format.by_register;
    let heads = machine.heads.iter_mut().map(|head| &mut head.machine);
    let filled = ToolTable { by_register, tools: Some(read.tools), ..table };
    for head in heads {
        merge(head, &filled, &mut Vec::new());
    }
    merge(machine, &filled, &mut findings);
    // A run may load its machine more than once.
    if let Some(table) = &mut machine.tool_table {
        table.findings = findings;
    }
    Ok(())
}

/// A length from the gauge point is not below zero.
fn refuse_negative(read: &mut ReadTools, name: &str) {
    for tool in &read.tools {
        let Some(length) = tool.total_length().filter(|length| *length < 0.0) else {
            continue;
        };
        let message = format!(
            "tool {} is {} mm long: this is an offset that was touched off, no length from the gauge point to the tip",
            tool.number,
            Short(length)
        );
        let help = "[tools] reference = MM (--set tools.reference=MM) is the length of the tool that the offsets count from";
        read.findings.push(
            Diagnostic::error("tools", message).help(help).at(reading::line(name, tool.line)),
        );
    }
}

/// The lengths of the file go before those that stand in the machine file; where they differ, that is said.
fn merge(machine: &mut Machine, table: &ToolTable, findings: &mut Vec<Diagnostic>) {
    let name = table.name();
    if table.by_register {
        machine.tools.clear();
    }
    for tool in table.tools.iter().flatten() {
        let Some(length) = tool.total_length() else {
            continue;
        };
        let own = machine.tools.iter_mut().find(|(number, _)| *number == tool.number);
        let Some((number, own)) = own else {
            machine.tools.push((tool.number, length));
            continue;
        };
        if (*own - length).abs() > 1e-6 {
            let message = format!(
                "tool {number} is {} mm long in [tools] of the machine file, {} mm in {name}:{}, which is taken",
                Short(*own),
                Short(length),
                tool.line
            );
            let help = "let one of the two say it";
            findings.push(Diagnostic::warning("tools", message).help(help));
        }
        *own = length;
    }
    machine.tool_table = Some(table.clone());
}
