//! A program read back on the chosen machine: what each line does, and what holds there.

use std::io::Cursor;
use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::VocabularyWord;
use post_readback::interpret::Limits;
use post_readback::{BlockEffect, MachineState, MotionKind, Offsets, ProgramEvent};

use crate::background::{Token, WorkResult};
use crate::document::Snapshot;
use crate::machine::library::Library;
use post_job::failure::Failure;
use post_job::nc_program::{self, NcControl};
use post_job::plugin_finder;

/// Blocks between two looks whether the work is given up.
const EVERY: u64 = 256;

/// Lines that are kept.
const MOST_LINES: usize = 500_000;

/// Blocks that are run once more: an editor does not wait for a loop.
const MOST_BLOCKS: u64 = 100_000;

/// What each line of a program does.
#[derive(Clone, Debug)]
pub struct InterpretedProgram {
    /// The machine.
    pub machine: Box<Machine>,
    /// The words of its control.
    pub words: Vec<VocabularyWord>,
    lines: Vec<ProgramLine>,
}

/// What a line does.
#[derive(Clone, Debug)]
pub struct ProgramLine {
    line: u64,
    /// How its last motion goes; none if nothing moves.
    pub kind: Option<MotionKind>,
    /// Axis values behind it, mm and radians.
    pub joints: Joints,
    /// The feed of its last motion, mm/min.
    pub feed: f64,
    /// What holds while it moves; behind it if nothing moves.
    pub state: Option<Arc<MachineState>>,
    /// Remarks and operations that it holds.
    pub told: Vec<String>,
}

impl InterpretedProgram {
    /// The last line up to this one, counted from 1, that was run; and whether it is that line itself.
    pub fn line(&self, line: u64) -> Option<(&ProgramLine, bool)> {
        let behind = self.lines.partition_point(|run| run.line <= line);
        let run = self.lines.get(behind.checked_sub(1)?)?;
        Some((run, run.line == line))
    }
}

/// The control of a machine that runs programs, every tool so long, mm.
///
/// # Errors
/// Why its dialect cannot be used.
pub fn control(
    machine: Machine,
    tool_length: Option<f64>,
    library: &Library,
) -> Result<NcControl, Vec<Diagnostic>> {
    let finder = plugin_finder::finder(&library.session, &library.plugins)?;
    let spoken = nc_program::spoken(&finder, &machine).map_err(Failure::findings)?;
    let offsets = Offsets { length: tool_length, ..Offsets::default() };
    let limits = Limits { blocks: MOST_BLOCKS, ..Limits::default() };
    Ok(NcControl::of(&machine, spoken, offsets, limits))
}

/// Reads a program back. None if the work is given up.
pub fn read(of: &Snapshot, control: &NcControl, token: &Token) -> WorkResult<InterpretedProgram> {
    let mut run = match control.run(&of.name, Cursor::new(of.text.as_bytes())) {
        Ok(run) => run,
        Err(fault) => return Some(Err(vec![*fault])),
    };
    let mut lines = LineCollector::default();
    let mut blocks = 0_u64;
    while let Some(done) = run.block() {
        blocks += 1;
        if blocks.is_multiple_of(EVERY) && token.is_given_up() {
            return None;
        }
        for one in done.drain(..) {
            lines.take(one);
        }
        // Beyond the limits the same fault would come without end.
        if let [.., before, last] = run.faults()
            && before == last
        {
            break;
        }
        let (line, state) = run.program().stand();
        lines.hold(line, state);
    }
    let notes = run.program().report().notes.clone();
    let mut found = run.into_faults();
    found.extend(notes);
    let mut lines = lines.run;
    // A loop runs its lines again: the last time counts.
    lines.sort_by_key(|run| run.line);
    lines.reverse();
    lines.dedup_by_key(|run| run.line);
    lines.reverse();
    let program = InterpretedProgram {
        machine: Box::new(control.machine.clone()),
        words: control.spoken.words.clone(),
        lines,
    };
    Some(Ok((program, found)))
}

/// What is done, line by line.
#[derive(Default)]
struct LineCollector {
    run: Vec<ProgramLine>,
    state: Option<Arc<MachineState>>,
}

impl LineCollector {
    fn at(&mut self, line: u64) -> Option<&mut ProgramLine> {
        let last = self.run.last();
        if last.is_none_or(|last| last.line != line) {
            if self.run.len() == MOST_LINES {
                return None;
            }
            let joints = last.map(|last| last.joints).unwrap_or_default();
            self.run.push(ProgramLine {
                line,
                kind: None,
                joints,
                feed: last.map_or(0.0, |last| last.feed),
                state: self.state.clone(),
                told: Vec::new(),
            });
        }
        self.run.last_mut()
    }

    /// What holds behind a block; while it moves, what its motion has.
    fn hold(&mut self, line: u64, state: Arc<MachineState>) {
        if let Some(run) = self.at(line).filter(|run| run.kind.is_none()) {
            run.state = Some(Arc::clone(&state));
        }
        self.state = Some(state);
    }

    fn take(&mut self, done: BlockEffect) {
        match done {
            BlockEffect::State(state) => self.state = Some(state),
            BlockEffect::Motion(motion) => {
                if let Some(line) = self.at(motion.line) {
                    line.kind = Some(motion.kind);
                    line.joints = motion.to.joints;
                    if motion.kind != MotionKind::Rapid {
                        line.feed = motion.feed;
                    }
                    line.state = Some(motion.state);
                }
            }
            BlockEffect::Event { line, event: told } => {
                let text = match told {
                    ProgramEvent::Operation(name) => format!("operation {name}"),
                    ProgramEvent::Remark(text) | ProgramEvent::Message(text) => text,
                    ProgramEvent::ToolChange { number, name } => {
                        let number = number.map(|number| number.to_string());
                        format!("tool {}", name.or(number).unwrap_or_default())
                    }
                    ProgramEvent::Dwell { time, .. } => format!("waits {time}"),
                    ProgramEvent::End => "the program ends".to_owned(),
                    _ => return self.at(line).map_or((), |_| ()),
                };
                if let Some(line) = self.at(line) {
                    line.told.push(text);
                }
            }
        }
    }
}
