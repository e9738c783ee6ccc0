//! A CL file posted on the chosen machine: where the axes come to stand, and how far the program strays, line by line.

use std::io::{self, Cursor, Read};
use std::num::NonZeroUsize;
use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_plugin::DialectSession as _;
use post_posting::preview;
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_posting::{MotionBlock, Observer, PostingRequest};

use crate::background::{Token, WorkResult};
use crate::document::Snapshot;
use crate::machine::library::Library;
use post_job::files::ClInput;
use post_job::plugin_finder;
use post_job::posting_pass::{self, OpenedPlugins, PostingPass, ProgramHead};

/// Lines of which it is kept what posting said.
const MOST_LINES: usize = 500_000;

/// Bytes that are read between two looks whether the work is given up.
const PIECE: usize = 32 * 1024;

/// What posting said of each line.
#[derive(Clone, Debug)]
pub struct Posted {
    /// The machine.
    pub machine: Box<Machine>,
    /// The program is not made: the axes stand so until the first fault.
    pub refused: bool,
    lines: Vec<PostedLine>,
}

/// What posting said of one line.
#[derive(Clone, Copy, Debug)]
pub struct PostedLine {
    line: u64,
    /// Blocks that it became.
    pub blocks: u32,
    /// Axis values at its end, mm and radians.
    pub joints: Joints,
    /// Largest certified deviation of the tip, mm, and of the tool axis, radians.
    pub deviation: [f64; 2],
    /// Minutes.
    pub minutes: f64,
    /// What made a block slower than asked for.
    pub limit: Option<&'static str>,
}

impl Posted {
    /// Of a line, counted from 1.
    pub fn line(&self, line: u64) -> Option<&PostedLine> {
        let found = self.lines.binary_search_by_key(&line, |posted| posted.line);
        self.lines.get(found.ok()?)
    }
}

/// Posts the text on a machine, its program thrown away. None if the work is given up.
pub fn post(
    of: &Snapshot,
    machine: Machine,
    tool_length: Option<f64>,
    library: &Library,
    token: &Token,
) -> WorkResult<Posted> {
    let finder = match plugin_finder::finder(&library.session, &library.plugins) {
        Ok(finder) => finder,
        Err(faults) => return Some(Err(faults)),
    };
    let head = ProgramHead { name: "EDITOR", cl_file: None, preview: None };
    let mut opened = match OpenedPlugins::open(&finder, &machine, head) {
        Ok(opened) => opened,
        Err(faults) => return Some(Err(faults)),
    };
    let reading = ReadingOptions {
        file: of.name.clone(),
        // Nothing is written: how fast the spindle turns is nobody's business.
        spindle: DefaultSpindle::Still,
        ..ReadingOptions::default()
    };
    let ahead = match preview::is_wanted(&machine, opened.dialect.capabilities()) {
        true => match posting_pass::first_pass(input(of, token), &machine, reading.clone()) {
            Ok(ahead) => Some(ahead),
            // The text lies in the memory: it fails where the work is given up.
            Err(_) => return None,
        },
        false => None,
    };
    let request = PostingRequest { reading, tool_length, ahead, ..PostingRequest::default() };
    let (dialect, model) = (&mut opened.dialect, &mut opened.model);
    let (threads, keeps_clear) = (NonZeroUsize::MIN, false);
    let pass = PostingPass { machine: &machine, request, threads, dialect, model, keeps_clear };
    let mut watch = LineObserver::default();
    let (report, found) = match pass.run_dry(&library.session, input(of, token), Some(&mut watch)) {
        _ if token.is_given_up() => return None,
        Ok(ended) => ended,
        Err(failure) => return Some(Err(failure.findings())),
    };
    let mut lines = watch.lines;
    lines.sort_by_key(|posted| posted.line);
    let posted = Posted { machine: Box::new(machine), refused: report.is_none(), lines };
    Some(Ok((posted, found)))
}

/// The text as a CL file that cannot be read on once the work is given up.
fn input(of: &Snapshot, token: &Token) -> ClInput {
    let text = Cursor::new(of.text.clone().into_bytes());
    ClInput {
        name: of.name.clone(),
        bytes: Box::new(StoppableText { text, token: token.clone() }),
        length: None,
        further: Arc::default(),
    }
}

/// A text that is read as long as it is wanted.
struct StoppableText {
    text: Cursor<Vec<u8>>,
    token: Token,
}

impl Read for StoppableText {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.token.is_given_up() {
            return Err(io::Error::other("given up"));
        }
        let most = into.len().min(PIECE);
        self.text.read(&mut into[..most])
    }
}

/// Looks on while blocks are made.
#[derive(Default)]
struct LineObserver {
    lines: Vec<PostedLine>,
}

impl Observer for LineObserver {
    fn block(&mut self, block: &MotionBlock) {
        let deviation = [block.deviation.tip, block.deviation.axis];
        let full = self.lines.len() == MOST_LINES;
        match self.lines.last_mut() {
            Some(last) if last.line == block.line => {
                last.blocks += 1;
                last.joints = block.joints;
                last.deviation = [0, 1].map(|part| last.deviation[part].max(deviation[part]));
                last.minutes += block.time.minutes;
                last.limit = last.limit.or(block.time.limit);
            }
            _ if full => {}
            _ => self.lines.push(PostedLine {
                line: block.line,
                blocks: 1,
                joints: block.joints,
                deviation,
                minutes: block.time.minutes,
                limit: block.time.limit,
            }),
        }
    }
}
