//! A CL file posted on the chosen machine: where the axes come to stand, and how far the program strays, line by line.

use post_grammar::{ReadError, Reader};
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_posting::{MotionBlock, Observer, Post, PostingRequest};

use super::EVERY;
use crate::background::{Token, Worked};
use crate::document::Snapshot;
use crate::machine::library::Library;
use post_job::files::NullSink;
use post_job::plugin_finder;

/// Lines of which it is kept what posting said.
const MOST_LINES: usize = 500_000;

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
) -> Worked<Posted> {
    let finder = match plugin_finder::finder(&library.session, &library.plugins) {
        Ok(finder) => finder,
        Err(faults) => return Some(Err(faults)),
    };
    let opened = plugin_finder::dialect(&finder, &machine, "EDITOR", None)
        .and_then(|(dialect, _)| Ok((dialect, plugin_finder::model(&finder, &machine)?.0)));
    let (mut dialect, mut model) = match opened {
        Ok(opened) => opened,
        Err(faults) => return Some(Err(faults)),
    };
    let job = PostingRequest {
        reading: ReadingOptions {
            file: of.name.clone(),
            // Nothing is written: how fast the spindle turns is nobody's business.
            spindle: DefaultSpindle::Still,
            ..ReadingOptions::default()
        },
        tool_length,
        ..PostingRequest::default()
    };
    // What a template asks for may not be known here, and nobody reads it.
    let plain = machine.without_text();
    let mut sink = NullSink;
    let mut watch = Watch::default();
    let ended = {
        let mut post = match Post::new(&plain, job, &mut dialect, &mut model, &mut sink) {
            Ok(post) => post,
            Err(finding) => return Some(Err(vec![*finding])),
        };
        post.watch(&mut watch);
        let mut reader = Reader::new(of.text.as_bytes());
        let mut records = 0_u64;
        while !post.gave_up() {
            records += 1;
            if records.is_multiple_of(EVERY) && token.is_given_up() {
                return None;
            }
            match reader.next_record() {
                Ok(Some(record)) => post.record(&record),
                Ok(None) => {
                    post.ended(!reader.ends_within_a_line());
                    break;
                }
                Err(ReadError::Syntax(fault)) => post.unreadable(&fault),
                // A text in memory does not fail.
                Err(ReadError::Io(_)) => break,
            }
        }
        post.finish()
    };
    let (report, found) = ended;
    let mut lines = watch.lines;
    lines.sort_by_key(|posted| posted.line);
    let posted = Posted { machine: Box::new(machine), refused: report.is_none(), lines };
    Some(Ok((posted, found)))
}

/// Looks on while blocks are made.
#[derive(Default)]
struct Watch {
    lines: Vec<PostedLine>,
}

impl Observer for Watch {
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
