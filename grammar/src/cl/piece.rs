//! What stands next in a CL file, and such pieces kept until somebody takes them.

use std::io::{self, Read};
use std::ops::Range;

use super::goto_run::{GotoRun, RunForm};
use super::reader::ClReader;
use super::record::{Record, Statement};
use crate::fault::SyntaxFault;

/// Bytes of the file that are read for a batch, unless it ends before: what is made of them stays in the processor's
/// cache while it is handed over.
const ENOUGH: u64 = 64 * 1024;

/// Most pieces of a batch: short ones take up more than their text.
const MOST_PIECES: usize = 1024;

/// What stands next in a CL file.
#[derive(Debug)]
pub enum ClPiece<'t> {
    /// Records of a run, at least one; this is its text.
    Gotos(&'t [u8]),
    /// A record.
    Record(Record<'t>),
    /// A line that cannot be read; what follows is the line after it.
    Unreadable(Box<SyntaxFault>),
    /// The input failed, and nothing follows.
    Failed(io::Error),
    /// The file ends, and nothing follows.
    End,
}

/// Pieces of a CL file with their text, in their order: read by one thread, taken by another.
#[derive(Debug, Default)]
pub struct ClBatch {
    text: Vec<u8>,
    /// Numbers of the points of runs, run by run, column by column.
    numbers: Vec<f64>,
    pieces: Vec<KeptPiece>,
    /// Pieces that are taken, and numbers of their runs.
    taken: usize,
    numbers_taken: usize,
    position: u64,
    ends_within_a_line: bool,
}

/// A piece that is kept.
#[derive(Debug)]
struct KeptPiece {
    kind: PieceKind,
    /// Where its text stands.
    text: Range<usize>,
    /// Bytes of the file up to its end.
    position: u64,
}

#[derive(Debug)]
enum PieceKind {
    Gotos(RunForm),
    Record { line: u64, statement: Statement },
    Unreadable(Box<SyntaxFault>),
    Failed(io::Error),
    End,
}

impl ClBatch {
    /// Takes what stands next in a file, in the place of what was there; false if nothing follows it. `run` is room for a
    /// run.
    pub fn fill<R: Read>(&mut self, reader: &mut ClReader<R>, run: &mut GotoRun) -> bool {
        self.text.clear();
        self.numbers.clear();
        self.pieces.clear();
        (self.taken, self.numbers_taken) = (0, 0);
        let from = reader.bytes_read();
        let mut goes_on = true;
        while goes_on
            && self.pieces.len() < MOST_PIECES
            && reader.bytes_read().saturating_sub(from) < ENOUGH
        {
            let start = self.text.len();
            let kind = match reader.next_piece(run) {
                ClPiece::Gotos(text) => {
                    self.text.extend_from_slice(text);
                    for column in &run.values[..run.form.columns()] {
                        self.numbers.extend_from_slice(&column[..run.form.count]);
                    }
                    PieceKind::Gotos(run.form)
                }
                ClPiece::Record(record) => {
                    self.text.extend_from_slice(record.raw);
                    PieceKind::Record { line: record.line, statement: record.statement }
                }
                ClPiece::Unreadable(fault) => PieceKind::Unreadable(fault),
                ClPiece::Failed(error) => PieceKind::Failed(error),
                ClPiece::End => PieceKind::End,
            };
            goes_on = !matches!(kind, PieceKind::Failed(_) | PieceKind::End);
            let (text, position) = (start..self.text.len(), reader.bytes_read());
            self.pieces.push(KeptPiece { kind, text, position });
        }
        self.ends_within_a_line = reader.ends_within_a_line();
        goes_on
    }

    /// The next piece; the numbers of a run go into `run`. None: all are taken.
    pub fn next_piece(&mut self, run: &mut GotoRun) -> Option<ClPiece<'_>> {
        let next = self.pieces.get_mut(self.taken)?;
        self.taken += 1;
        self.position = next.position;
        let text = &self.text[next.text.clone()];
        Some(match std::mem::replace(&mut next.kind, PieceKind::End) {
            PieceKind::Gotos(form) => {
                run.form = form;
                let (given, others) = run.values.split_at_mut(form.columns());
                for column in given {
                    let numbers = &self.numbers[self.numbers_taken..];
                    column[..form.count].copy_from_slice(&numbers[..form.count]);
                    self.numbers_taken += form.count;
                }
                others.iter_mut().for_each(|column| column[..form.count].fill(0.0));
                ClPiece::Gotos(text)
            }
            PieceKind::Record { line, statement } => {
                ClPiece::Record(Record { line, raw: text, statement })
            }
            PieceKind::Unreadable(fault) => ClPiece::Unreadable(fault),
            PieceKind::Failed(error) => ClPiece::Failed(error),
            PieceKind::End => ClPiece::End,
        })
    }

    /// All pieces are taken.
    pub fn is_taken(&self) -> bool {
        self.taken == self.pieces.len()
    }

    /// Bytes of the file up to the end of the piece that was taken last.
    pub fn position(&self) -> u64 {
        self.position
    }

    /// [`ClReader::ends_within_a_line`] after the last piece.
    pub fn ends_within_a_line(&self) -> bool {
        self.ends_within_a_line
    }
}
