//! The tools that a CL file calls, and which of them a file of tools does not have.

use post_grammar::{Argument, ClReader, Statement};
use post_machine::description::ToolData;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_readback::course::Course as _;
use post_readback::course::cl::{ClCourse, ClSettings};

use super::ReadTools;
use crate::failure::Failure;
use crate::files::{ClSource, PathArg};
use crate::session::Session;

/// A tool as a CL file calls it.
#[derive(Clone, Debug)]
pub struct CalledTool {
    /// What the file says of it.
    pub tool: ToolData,
    /// Register of its length.
    pub register: u32,
}

/// Records that cannot be understood until the rest is given up.
const MOST_FAULTS: usize = 10_000;

/// The CL word that has how far the tool sticks out (SolidWorks CAM).
const STICK_OUT: &str = "CSI_SET_EXTENSION_LENGTH";

/// The tools that a CL file calls, in the order of their first use.
///
/// # Errors
/// The file cannot be read.
pub fn called(session: &Session, file: &PathArg) -> Result<(String, Vec<CalledTool>), Failure> {
    let mut source = ClSource::new(session, file, true)?;
    let first = source.open()?;
    let name = first.name.clone();
    // Of words that move nothing here nothing is wanted.
    let settings =
        ClSettings { file: name.clone(), unknown_left_out: true, ..ClSettings::default() };
    let mut course = ClCourse::new(settings, first.bytes);
    let mut faults = Vec::new();
    loop {
        match course.next() {
            Ok(None) => break,
            Ok(Some(_)) => {}
            Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
            Err(_) => break,
        }
    }
    let tools = course.tools().to_vec();
    if tools.is_empty() && !faults.is_empty() {
        return Err(faults.into());
    }
    let sticks = stick_outs(&mut source)?;
    let tools = tools.into_iter().map(|tool| {
        let stick_out = sticks.iter().find(|(number, _)| *number == tool.number);
        CalledTool {
            register: tool.register,
            tool: ToolData {
                number: tool.number,
                name: tool.name,
                length: tool.length,
                radius: tool.diameter.map(|diameter| diameter / 2.0),
                stick_out: stick_out.map(|(_, length)| *length),
                line: tool.line,
                ..ToolData::default()
            },
        }
    });
    Ok((name, tools.collect()))
}

/// How far tools stick out, by number, in mm: behind the record that loads them.
fn stick_outs(source: &mut ClSource) -> Result<Vec<(u32, f64)>, Failure> {
    let mut reader = ClReader::new(source.open()?.bytes);
    let mut found: Vec<(u32, f64)> = Vec::new();
    let mut loaded = None;
    let mut unit = 1.0;
    // What cannot be read was told, or is no business of tools.
    while let Ok(Some(record)) = reader.next_record() {
        match &record.statement {
            Statement::Units(units) => unit = units.millimetres(),
            Statement::LoadTool(tool) => loaded = Some(tool.number),
            Statement::Other { word, arguments, .. } if word == STICK_OUT => {
                let length = arguments.iter().find_map(|argument| match argument {
                    Argument::Number(number) => Some(*number * unit),
                    Argument::Word(_) => None,
                });
                if let (Some(number), Some(length)) = (loaded, length)
                    && found.iter().all(|(known, _)| *known != number)
                {
                    found.push((number, length));
                }
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The tools of a CL file `name` that `read` from the file `table` does not have, each with the line that calls it.
pub fn missing(name: &str, calls: &[CalledTool], read: &ReadTools, table: &str) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    for CalledTool { tool, register } in calls {
        let wanted = if read.format.by_register { *register } else { tool.number };
        let at = SourcePlace::new(name, tool.line, "", 0..0);
        let listed = read.tools.iter().find(|listed| listed.number == wanted);
        let finding = match listed {
            None => {
                let what = if read.format.by_register { "register" } else { "tool" };
                let message = format!("{what} {wanted} is called, and is not in {table}");
                let help = "measure the tool, or let the CAM system call the one that is there";
                Some(Diagnostic::error("tool-missing", message).help(help))
            }
            Some(listed) => listed.other_cutter(tool.number, tool.diameter(), table),
        };
        findings.extend(finding.map(|finding| finding.at(Some(at))));
    }
    findings
}
