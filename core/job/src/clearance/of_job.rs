//! A program of a job that is proven: its tools are those of the CL file, and lines of that are told.

use std::collections::BTreeMap;

use post_machine::diagnostic::SourceFiles;
use post_readback::verify::BlockReport;

use super::{ClearanceFound, Hearer, prove};
use crate::cl_facts::ClFacts;
use crate::failure::Failure;
use crate::files::{ClSource, FileFault};
use crate::nc_program::ProgramText;
use crate::read_back::{self, ReadingSetup};

/// Proves the program `name` in `text`, of the CL file in `source`. What is not clear is told with the line of the CL file
/// besides, where it is known which one asks for it. Who `hear`s is told as by [`prove`].
///
/// # Errors
/// A file that cannot be read, or a machine or dialect that cannot be used.
pub fn of_job(
    reading: &ReadingSetup<'_>,
    source: &mut ClSource,
    name: &str,
    mut text: ProgramText<'_>,
    hear: Option<&mut Hearer<'_>>,
) -> Result<ClearanceFound, Failure> {
    let facts = ClFacts::of_job(reading.arguments, reading.machine, source)?;
    let mut control = reading.control(&facts.tools)?;
    control.own_lines.clone_from(&facts.own_lines);
    let mut found = prove(&control, name, Box::new(&mut text), &facts, hear)?;
    if found.is_wrong() {
        let again = text.rewind();
        again.map_err(|error| FileFault::Read { name: name.to_owned(), error })?;
        tell_cl_lines(&mut found, reading, source, name, text, &facts.files)?;
    }
    Ok(found)
}

/// Puts the line of the CL file into what is told of a line of the program.
fn tell_cl_lines(
    found: &mut ClearanceFound,
    reading: &ReadingSetup<'_>,
    source: &mut ClSource,
    name: &str,
    text: ProgramText<'_>,
    files: &SourceFiles,
) -> Result<(), Failure> {
    let places = found.findings.iter().filter_map(|finding| finding.place.as_ref());
    let mut lines: BTreeMap<u64, Option<u64>> =
        places.filter(|place| place.file == name).map(|place| (place.line, None)).collect();
    let mut hear = |row: &BlockReport| {
        if let Some(line) = lines.get_mut(&row.nc_line) {
            *line = line.or(row.cl_line);
        }
    };
    read_back::verify(reading, source, name, text, &mut hear)?;
    for finding in &mut found.findings {
        // Of what cannot be read verifying says the same.
        let told = finding.code == "clearance";
        let place = finding.place.as_ref().filter(|place| told && place.file == name);
        let line = place.and_then(|place| lines.get(&place.line).copied().flatten());
        if let Some(line) = line {
            let (file, line) = files.locate(line);
            finding.message.push_str(&format!(" ({file}, line {line})"));
        }
    }
    Ok(())
}
