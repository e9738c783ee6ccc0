//! The path of the program that another one is held against: a table, the lines that belong together, and how far the new
//! path is from the old one.

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_motion::path::piece_ends;
use post_readback::{BlockEffect, ProgramRun};

use super::cl_points::{self, ClPointRow};
use super::page_table::PageTable;
use super::parts::Parts;
use super::segments::Segments;
use crate::failure::Failure;
use crate::nc_program::RunningProgram;

/// How far chords of a path may stray that is only looked at, mm.
const CHORD: f64 = 0.001;

/// Chords of a curve.
const MOST_CHORDS: u64 = 64;

/// Segments in which the place of the old path is looked for first, and where it is not near there.
const AHEAD: [usize; 2] = [64, 4096];

/// Segments that are kept behind the place that was found: a program may go back a little.
const BEHIND: usize = 64;

/// Farther apart, mm, the paths are not of the same cut.
const APART: f64 = 10.0;

/// Reads the old program as far as it is asked for.
pub struct OldPath {
    run: ProgramRun<RunningProgram<'static>>,
    table: PageTable<ClPointRow>,
    segments: Segments,
    /// Segments that stand behind the place that was found last.
    behind: usize,
    done: Vec<BlockEffect>,
    ended: bool,
}

impl OldPath {
    /// Of a program at its beginning.
    ///
    /// # Errors
    /// There is no place for its table.
    pub fn new(
        machine: &Machine,
        run: ProgramRun<RunningProgram<'static>>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            run,
            table: cl_points::table(machine, false)?,
            segments: Segments::default(),
            behind: 0,
            done: Vec::new(),
            ended: false,
        })
    }

    /// The new program comes to `tip`: the line of the old one that does the same, where one is near.
    pub fn advance(&mut self, tip: Vector3<f64>) -> Option<u64> {
        for ahead in AHEAD {
            let last = self.behind + ahead;
            while self.segments.known.len() < last && !self.ended {
                self.read();
            }
            let near = self.segments.known.iter().take(last).enumerate();
            let far = near.map(|(place, segment)| {
                // Of places as near that at the end of a line, and that which was not passed yet.
                let off = (tip - segment.nearest(tip)).norm() + 1e-3 * (tip - segment.to).norm();
                let passed = if place < self.behind { CHORD } else { 0.0 };
                (place, off + passed, segment.line)
            });
            let nearest = far.min_by(|one, other| one.1.total_cmp(&other.1));
            let (place, off, line) = nearest?;
            let limit = if ahead == AHEAD[0] { APART / 100.0 } else { APART };
            if off < limit {
                let gone = place.saturating_sub(BEHIND);
                self.segments.known.drain(..gone);
                self.behind = place - gone;
                return Some(line);
            }
        }
        None
    }

    /// From the nearest point of the old path to `tip`, mm; none where the paths are far apart.
    pub fn off(&self, tip: Vector3<f64>) -> Option<Vector3<f64>> {
        let off = self.segments.off(tip, self.behind + AHEAD[0]);
        off.filter(|off| off.norm() < APART)
    }

    /// Reads the rest; the table goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(mut self, parts: &mut Parts) -> Result<(), Failure> {
        while !self.ended {
            self.segments.known.clear();
            self.read();
        }
        self.table.finish(parts)
    }

    fn read(&mut self) {
        let Some(done) = self.run.block() else {
            self.ended = true;
            return;
        };
        std::mem::swap(done, &mut self.done);
        let done = std::mem::take(&mut self.done);
        for next in &done {
            let BlockEffect::Motion(motion) = next else {
                continue;
            };
            let chords = match motion.way.is_curved() {
                true => MOST_CHORDS,
                false => motion.pieces(CHORD, 1.0).min(MOST_CHORDS),
            };
            let tips = piece_ends(chords, motion.to.pose.tip, |t| motion.at(t).tip);
            let row = |row: ClPointRow| _ = self.table.row(&row);
            self.segments.go(motion.line, motion.kind, motion.from.pose.tip, tips, row);
        }
        self.done = done;
    }
}
