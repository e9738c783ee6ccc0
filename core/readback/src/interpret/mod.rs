//! Blocks become motions.
//!
//! | file | does |
//! |---|---|
//! | `state` | what a control remembers from block to block: `ControlState` |
//! | `control` | how it begins; the solver, the zero and the frames that words count from |
//! | `block_words` | the words of a block, by letter |
//! | `block`, `meanings` | a block of words: modes first, then what moves |
//! | `compensation`, `spindle` | lengths, radii, work offsets; tools, spindle, coolant, waits |
//! | `clamps` | axes that are clamped, and move |
//! | `corners` | how the control passes from one motion to the next |
//! | `names` | names, calls and texts among the words |
//! | `run` | plain blocks that are run together |
//! | `go`, `arcs`, `splines`, `machine_moves` | from words to axis values, tip and tool axis |
//! | `face` | polar interpolation by the control |
//! | `feed`, `tools` | time, tool lengths |
//! | `relied` | what the program relies on and does not say, or says otherwise than the machine file |
//! | `frame` | frames within one another |
//! | `flow`, `astray`, `expression`, `variables` | what leads the program elsewhere, and numbers that are worked out |
//! | `cycles`, `planes`, `frames`, `conversational` | cycles, tilted planes, shifts; Heidenhain's blocks |
//! | `statements`, `robot_frames` | moves of robots, and the tool and frame that they go by |

mod along;
mod arcs;
mod assigned;
mod astray;
mod block;
mod block_words;
mod calls;
mod clamps;
mod compensation;
mod control;
mod conversational;
mod corners;
mod cycles;
mod expression;
mod face;
mod feed;
mod flow;
mod frame;
mod frames;
mod go;
mod machine_moves;
mod meanings;
mod mode_words;
mod names;
pub(crate) mod planes;
mod polar;
mod relied;
mod robot_frames;
mod run;
mod spindle;
mod spindle_request;
mod splines;
mod state;
mod statements;
mod tools;
mod variables;
mod wrap;

use std::io::{Read, Seek};
use std::sync::Arc;

use post_grammar::nc::{NcBlock, NcReader, Notation};
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use crate::lexicon::Lexicon;
use crate::{BlockEffect, MachineState, Offsets, ProgramEvent};
use block_words::BlockWords;
use flow::ProgramFlow;
pub use relied::{ContraryMode, ModalGroup};
use run::MotionRun;
use state::ControlState;

/// How far a program may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Blocks that are run once more, by loops, jumps and subprograms.
    pub blocks: u64,
    /// Subprograms and loops inside one another.
    pub depth: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { blocks: 2_000_000, depth: 32 }
    }
}

/// What a reading found, apart from motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadReport {
    /// Blocks that were run.
    pub blocks: u64,
    /// Lines in front of `%` that were skipped.
    pub header: u64,
    /// Words that are not known, how often each, and the line of the first.
    pub unknown: Vec<(String, u64, u64)>,
    /// What was taken for granted.
    pub notes: Vec<Diagnostic>,
    /// The line of the first motion at feed, if the program has not said before where these linear axes stand: it is
    /// taken to begin with them at zero.
    pub unsaid: Option<(u64, String)>,
    /// The same of rotary axes.
    pub unturned: Option<(u64, String)>,
    /// The line at which the depth is led to a position of the program at rapid first, if these axes were led nowhere
    /// before.
    pub blind: Option<(u64, String)>,
    /// The line of the first G92 that says what these axes show, if they were led nowhere before.
    pub unplaced: Option<(u64, String)>,
    /// The first line that moves an axis which is clamped, and the axis.
    pub moved_clamped: Option<(u64, String)>,
    /// The first motion behind a transformation that may have ended the work offset, if no word has named it since.
    pub frame_dropped: Option<u64>,
    /// The first motion in another plane than that in which the tool's length was put on, where the control lays it along
    /// the axis across the plane.
    pub length_across: Option<u64>,
    /// The first line that leads the depth to a position of the machine while a length is in force, where the control's
    /// builder says whether it counts there.
    pub lengthened: Option<u64>,
    /// Line of the first cycle's end that is a word of motion alone.
    pub cycle_cut_off: Option<u64>,
    /// Modes that the program has not set, and the lines of the first words whose meaning hangs on them.
    pub relied: Vec<(u64, ModalGroup)>,
    /// Modes that stand otherwise than the machine file has them where a motion depends on them.
    pub contrary: Vec<ContraryMode>,
    /// Line of the first tap whose cycle no word makes rigid, and how many there are.
    pub bare_taps: Option<(u64, u64)>,
    /// The line at which a tool is changed or led to the part first, if these axes, which the machine file retracts, were
    /// led nowhere before: where they stand then is not known.
    pub unretracted: Option<(u64, String)>,
    /// How the program ends; none: no word of it does that.
    pub end: Option<ModesInForce>,
    /// The first line that names a speed of the spindle above zero.
    pub speed: Option<u64>,
    /// Line of the first rapid in whose block a feed stands, and how many there are.
    pub fed_rapids: Option<(u64, u64)>,
    /// The first tool change with something in force that controls want ended before.
    pub changed: Option<ModesInForce>,
}

/// The end of a program or a tool change, and what is in force there: whatever runs next begins with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModesInForce {
    /// Line of the program.
    pub line: u64,
    /// What is in force, as messages call it.
    pub modes: Vec<&'static str>,
}

/// Runs blocks one by one.
#[derive(Debug)]
struct Runner {
    control: ControlState,
    words: BlockWords,
    notation: Notation,
}

impl Runner {
    /// Runs a block; what it did stands in `control.done`.
    #[inline]
    fn run(&mut self, block: &NcBlock) -> Result<(), Box<Diagnostic>> {
        self.control.line = block.line;
        self.control.number = block.number;
        self.control.exact_stop = false;
        self.control.led = self.control.said;
        if block.skipped {
            self.control.say_skipped();
        }
        let before = self.control.at.joints;
        match self.notation {
            Notation::Words => block::run(&mut self.control, block, &mut self.words),
            Notation::Conversational => {
                conversational::run(&mut self.control, block, &mut self.words)
            }
            Notation::Statements => statements::run(&mut self.control, block),
        }?;
        if !self.control.clamps.are_off() {
            self.control.end_clamped_block(&before);
        }
        Ok(())
    }
}

/// Codes of refusals of blocks whose words are not run; all others say what a motion lacks.
const NOT_RUN: [&str; 10] = [
    "nc-conversational",
    "nc-cycle",
    "nc-expression",
    "nc-flow",
    "nc-machine",
    "nc-statement",
    "nc-subprogram",
    "nc-variable",
    "nc-word",
    "syntax",
];

/// Runs a program block by block.
#[derive(Debug)]
pub struct Interpreter<R> {
    flow: ProgramFlow<R>,
    block: NcBlock,
    runner: Runner,
    run: Box<MotionRun>,
}

impl<R: Read + Seek> Interpreter<R> {
    /// A program from `input`, which messages call `file`, on `machine`.
    ///
    /// # Errors
    /// The machine cannot be solved.
    pub fn new(
        machine: &Machine,
        lexicon: &Lexicon,
        offsets: &Offsets,
        limits: Limits,
        file: &str,
        input: R,
    ) -> Result<Self, Box<Diagnostic>> {
        let reader = NcReader::new(input, lexicon.syntax().clone());
        let runner = Runner {
            control: ControlState::new(machine, lexicon, offsets, file)?,
            words: BlockWords::default(),
            notation: lexicon.syntax().notation,
        };
        Ok(Self {
            flow: ProgramFlow::new(reader, lexicon.language(), limits, file),
            block: NcBlock::default(),
            runner,
            run: MotionRun::new(),
        })
    }

    /// Passes lines with these texts too where they are not run, as those of the machine file: the CL file has them.
    pub fn declaring<'l>(mut self, lines: impl IntoIterator<Item = &'l str>) -> Self {
        lines.into_iter().for_each(|line| self.runner.control.declared.add(line));
        self
    }

    /// Runs so many plain blocks together at most; what they do does not hang on it.
    pub fn with_longest_run(mut self, most: usize) -> Self {
        self.run.longest = most;
        self
    }

    /// Runs the next block and puts what it did after what `done` holds; false at the end. It can be called again after
    /// an error, and goes on with the block after. A block that is not run is passed where the machine file declares its
    /// line.
    ///
    /// # Errors
    /// What stands there that cannot be understood, or is not run, with its place.
    #[inline]
    pub fn next(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>> {
        match self.step(done) {
            Err(fault) => self.pass_declared(fault, done),
            more => more,
        }
    }

    /// The refused block is one of the machine file's own lines: that is noted, and what follows begins where it stood. One
    /// that ends the program, which nobody has called here, ends it.
    #[cold]
    fn pass_declared(
        &mut self,
        fault: Box<Diagnostic>,
        done: &mut Vec<BlockEffect>,
    ) -> Result<bool, Box<Diagnostic>> {
        let control = &mut self.runner.control;
        let place = fault.place.as_ref().filter(|_| NOT_RUN.contains(&fault.code));
        let Some(place) = place.filter(|place| control.declared.has_line(&place.text)) else {
            return Err(fault);
        };
        if control.declared.has_end(&place.text) {
            std::mem::swap(done, &mut control.done);
            control.end();
            std::mem::swap(done, &mut control.done);
            return Ok(true);
        }
        let message = format!(
            "`{}` is a line of the user's own: what it does is not known, and the program is taken to go on from where it stood",
            place.text.trim()
        );
        control.note(Diagnostic::warning("nc-own-line", message).at(Some(place.clone())));
        Ok(true)
    }

    #[inline]
    fn step(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>> {
        if !self.run.is_over() || self.begins_run() {
            let control = &mut self.runner.control;
            std::mem::swap(done, &mut control.done);
            control.tell_next(&mut self.run);
            std::mem::swap(done, &mut control.done);
            return Ok(true);
        }
        let Self { flow, block, runner, .. } = self;
        if runner.control.ended {
            return Ok(false);
        }
        let more = flow.next(&mut runner.control.variables, block);
        runner.control.report.header = flow.reader().header_lines();
        runner.control.line = block.line;
        if let Some(lines) = runner.control.waits.as_ref().filter(|_| !matches!(more, Ok(false)))
            && let Some(mark) = flow.text(block.line).and_then(|text| lines.mark(&text).cloned())
        {
            runner.control.report.blocks += 1;
            std::mem::swap(done, &mut runner.control.done);
            runner.control.tell(ProgramEvent::Sync(mark));
            std::mem::swap(done, &mut runner.control.done);
            return Ok(true);
        }
        if !more.map_err(|finding| flow.show(runner.control.placed(*finding).boxed()))? {
            if runner.control.spline.take().is_some() {
                let message = "a spline begins that never ends";
                return Err(runner.control.refuse("nc-spline", message));
            }
            return Ok(false);
        }
        runner.control.report.blocks += 1;
        // What is done goes straight after what the caller's list holds.
        std::mem::swap(done, &mut runner.control.done);
        let ran = runner.run(block);
        std::mem::swap(done, &mut runner.control.done);
        ran.map(|()| true).map_err(|finding| flow.show(finding))
    }

    /// Whether the next blocks are run together: they wait to be told then.
    fn begins_run(&mut self) -> bool {
        let Self { flow, runner, run, .. } = self;
        if runner.notation != Notation::Words || run.longest == 0 || runner.control.ended {
            return false;
        }
        let Some(rule) = runner.control.run_rule(run) else {
            return false;
        };
        flow.next_run(&rule, &mut run.read);
        let count = runner.control.work_out(run);
        flow.shorten(&mut run.read, count);
        runner.control.begin_run(run);
        count > 0
    }

    /// The line of the block that was run last, and what holds after it.
    pub fn stand(&self) -> (u64, Arc<MachineState>) {
        (self.runner.control.line, self.runner.control.state_now())
    }

    /// What was found so far.
    pub fn report(&self) -> &ReadReport {
        &self.runner.control.report
    }
}
