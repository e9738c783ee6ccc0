//! Which operations of the CL files become the program.

use std::ops::Range;

use post_grammar::text::{as_remark, excerpt};
use post_grammar::{ClPiece, ClReader, GotoRun, Record, Statement};
use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;
use crate::files::{ClSource, FileFault};
use crate::settings::JobSettings;

/// Longest list of operations in a sentence, bytes.
pub(crate) const LONGEST_LIST: usize = 400;

/// Operations of one text of CL files at most.
const MOST_OPERATIONS: usize = 100_000;

/// Lines of CL files that a program is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramLines {
    /// The lines, in their order.
    pub ranges: Vec<Range<u64>>,
    /// The operations that are left out because others were chosen, as people call them.
    pub left_out: Vec<String>,
}

impl ProgramLines {
    /// Some lines, because a file becomes several programs.
    pub fn part(lines: Range<u64>) -> Self {
        Self { ranges: vec![lines], left_out: Vec::new() }
    }

    /// Those within `part`, because a file becomes several programs.
    pub fn within(&self, part: &Range<u64>) -> Self {
        let ranges = self.ranges.iter().map(|range| Range {
            start: range.start.max(part.start),
            end: range.end.min(part.end),
        });
        Self { ranges: ranges.filter(|range| !range.is_empty()).collect(), left_out: Vec::new() }
    }

    /// What the head of the program says of it.
    pub fn remark(&self) -> Option<String> {
        let list = self.left_out.join(", ");
        (!list.is_empty()).then(|| format!("WITHOUT OPERATIONS {}", excerpt(&list, LONGEST_LIST)))
    }
}

/// An operation of a CL file: from where it begins to where the next one does.
#[derive(Debug)]
struct FoundOperation {
    name: String,
    begins: u64,
}

/// Operations as records come: `TOOL PATH` begins one, in a file without them each other tool.
#[derive(Debug, Default)]
struct OperationFinder {
    found: Vec<FoundOperation>,
    tools: Vec<FoundOperation>,
    /// Number of the tool of the last of `tools`.
    tool: Option<u32>,
    /// Where the file begins that is read.
    begins: u64,
    paths: usize,
}

impl OperationFinder {
    fn record(&mut self, record: &Record<'_>) {
        match &record.statement {
            Statement::ToolPath { name, .. } => {
                let begins = if self.paths == 0 { self.begins } else { record.line };
                self.paths += 1;
                self.found.push(FoundOperation { name: as_remark(name.clone()), begins });
            }
            Statement::LoadTool(tool) if self.tool != Some(tool.number) => {
                let begins = if self.tool.is_none() { self.begins } else { record.line };
                self.tool = Some(tool.number);
                self.tools.push(FoundOperation { name: format!("T{}", tool.number), begins });
            }
            _ => {}
        }
    }

    /// A file ends; the next one begins on this line.
    fn file_ends(&mut self, next: u64) {
        if self.paths == 0 {
            match self.tools.is_empty() {
                true => {
                    self.found.push(FoundOperation { name: String::new(), begins: self.begins })
                }
                false => self.found.append(&mut self.tools),
            }
        }
        self.tools.clear();
        (self.tool, self.begins, self.paths) = (None, next, 0);
    }
}

/// The lines of the operations that a job chooses; none if it takes all.
///
/// # Errors
/// The CL files cannot be read, or have none of that name or number.
pub fn chosen(job: &JobSettings, source: &mut ClSource) -> Result<Option<ProgramLines>, Failure> {
    let wanted = &job.reading.operations;
    if wanted.is_empty() {
        return Ok(None);
    }
    let found = operations(source)?;
    let mut takes = vec![false; found.len()];
    for name in wanted {
        let mut any = false;
        for (place, operation) in found.iter().enumerate() {
            if operation.name == name.trim() {
                (takes[place], any) = (true, true);
            }
        }
        let number = name.trim().parse::<usize>().ok().and_then(|number| number.checked_sub(1));
        if let Some(take) = number.filter(|_| !any).and_then(|place| takes.get_mut(place)) {
            (*take, any) = (true, true);
        }
        if !any {
            return Err(no_operation(name, &found).into());
        }
    }
    let mut lines = ProgramLines::default();
    for (place, operation) in found.iter().enumerate() {
        let end = found.get(place + 1).map_or(u64::MAX, |next| next.begins);
        match (takes[place], lines.ranges.last_mut()) {
            (false, _) => lines.left_out.push(called(place, operation)),
            (true, Some(last)) if last.end == operation.begins => last.end = end,
            (true, _) => lines.ranges.push(operation.begins..end),
        }
    }
    Ok(Some(lines).filter(|lines| !lines.left_out.is_empty()))
}

/// The operations of a text of CL files, in their order.
fn operations(source: &mut ClSource) -> Result<Vec<FoundOperation>, Failure> {
    let input = source.open()?;
    let mut files = input.further.iter();
    let mut next = files.next();
    let mut finder = OperationFinder::default();
    let mut reader = ClReader::new(input.bytes);
    let mut run = GotoRun::default();
    loop {
        reader.skip_gotos();
        match reader.next_piece(&mut run) {
            ClPiece::Record(record) => {
                if let Some(file) = next.filter(|file| record.line >= file.before) {
                    finder.file_ends(file.before);
                    next = files.next();
                }
                finder.record(&record);
            }
            // What cannot be read is told when the program is made.
            ClPiece::Gotos(_) | ClPiece::Unreadable(_) => {}
            ClPiece::End => break,
            ClPiece::Failed(error) => {
                return Err(FileFault::Read { name: input.name, error }.into());
            }
        }
        if finder.found.len() + finder.tools.len() > MOST_OPERATIONS {
            let message = format!("more than {MOST_OPERATIONS} operations");
            return Err(Diagnostic::error("operations", message).into());
        }
    }
    finder.file_ends(u64::MAX);
    Ok(finder.found)
}

/// How people call an operation: its number, and its name if it has one.
fn called(place: usize, operation: &FoundOperation) -> String {
    match operation.name.as_str() {
        "" => format!("{}", place + 1),
        name => format!("{} {name}", place + 1),
    }
}

fn no_operation(name: &str, found: &[FoundOperation]) -> Diagnostic {
    let all: Vec<String> =
        found.iter().enumerate().map(|(place, operation)| called(place, operation)).collect();
    let list = all.join(", ");
    Diagnostic::error("operations", format!("--operations: there is no operation {name}"))
        .help(format!("number and name of each: {}", excerpt(&list, LONGEST_LIST)))
}
