//! Operations and tools of a CL file.

use gen_lsp_types::{
    DocumentSymbol, FoldingRange, FoldingRangeKind, Position, Range as LspRange, SymbolKind,
};
use post_grammar::{ClReader, ReadError, Statement};

use super::EVERY;
use crate::background::Token;
use crate::document::Snapshot;
use crate::positions::number;

/// A part of the file, lines counted from 0.
struct OutlineSection {
    name: String,
    kind: SymbolKind,
    first: usize,
    last: usize,
}

/// The parts of a file; none if the work is given up.
fn sections(of: &Snapshot, token: &Token) -> Option<Vec<OutlineSection>> {
    let mut reader = ClReader::new(of.text.as_bytes());
    let mut sections: Vec<OutlineSection> = Vec::new();
    // Operations and tools that have not ended, by their places among all.
    let mut operation: Option<usize> = None;
    let mut tool: Option<usize> = None;
    let mut records = 0_u64;
    loop {
        records += 1;
        if records.is_multiple_of(EVERY) && token.is_given_up() {
            return None;
        }
        let record = match reader.next_record() {
            Ok(Some(record)) => record,
            Err(ReadError::Syntax(_)) => continue,
            Ok(None) | Err(ReadError::Io(_)) => break,
        };
        let line = usize::try_from(record.line).unwrap_or(usize::MAX) - 1;
        let mut begin = |open: &mut Option<usize>, name: String, kind: SymbolKind| {
            end(&mut sections, open.take(), line.saturating_sub(1));
            *open = Some(sections.len());
            sections.push(OutlineSection { name, kind, first: line, last: line });
        };
        match record.statement {
            Statement::ToolPath { name, .. } => {
                begin(&mut operation, name, SymbolKind::Function);
            }
            Statement::EndOfPath => end(&mut sections, operation.take(), line),
            Statement::LoadTool(load) => {
                let name = format!("tool {}", load.number);
                begin(&mut tool, name, SymbolKind::Object);
            }
            Statement::PartName(name) if !name.trim().is_empty() => {
                begin(&mut None, name.trim().to_owned(), SymbolKind::Package);
            }
            Statement::Fini => {
                for open in [operation.take(), tool.take()] {
                    end(&mut sections, open, line.saturating_sub(1));
                }
            }
            _ => {}
        }
    }
    for open in [operation, tool] {
        end(&mut sections, open, of.lines.count() - 1);
    }
    // Tools and operations begin and end across one another: where there are both, operations are what is folded.
    if sections.iter().any(|section| section.kind == SymbolKind::Function) {
        let tools = sections.iter_mut();
        for tool in tools.filter(|section| section.kind == SymbolKind::Object) {
            tool.last = tool.first;
        }
    }
    Some(sections)
}

/// A section ends with a line.
fn end(sections: &mut [OutlineSection], open: Option<usize>, last: usize) {
    if let Some(section) = open.and_then(|open| sections.get_mut(open)) {
        section.last = last.max(section.first);
    }
}

/// Operations and tools to go to; none if the work is given up.
pub fn symbols(of: &Snapshot, token: &Token) -> Option<Vec<DocumentSymbol>> {
    let sections = sections(of, token)?.into_iter();
    let symbols = sections.map(|section| {
        let selection_range = of.lines.whole(&of.text, section.first as u64 + 1);
        let end = of.lines.whole(&of.text, section.last as u64 + 1).end;
        #[allow(deprecated, reason = "the protocol's own field, left out")]
        DocumentSymbol {
            name: section.name,
            detail: None,
            kind: section.kind,
            tags: None,
            deprecated: None,
            range: LspRange::new(Position::new(selection_range.start.line, 0), end),
            selection_range,
            children: None,
        }
    });
    Some(symbols.collect())
}

/// Operations and tools to fold; none if the work is given up.
pub fn folds(of: &Snapshot, token: &Token) -> Option<Vec<FoldingRange>> {
    let sections = sections(of, token)?.into_iter();
    let folds = sections.filter(|section| section.last > section.first);
    let folds = folds.map(|section| FoldingRange {
        start_line: number(section.first),
        end_line: number(section.last),
        kind: Some(FoldingRangeKind::Region),
        ..FoldingRange::default()
    });
    Some(folds.collect())
}
