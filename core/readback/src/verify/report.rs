//! What holding a program against a course has found.

use std::borrow::Cow;

use post_machine::diagnostic::{Diagnostic, SourceFiles, SourcePlace};
use serde::Serialize;

use crate::Motion;

/// A block of the program: its line, and its number if it has one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BlockPlace {
    pub line: u64,
    pub number: Option<u64>,
}

impl BlockPlace {
    /// A block that is known by its line alone.
    pub const fn of_line(line: u64) -> Self {
        Self { line, number: None }
    }

    /// The block of a motion.
    pub const fn of(motion: &Motion) -> Self {
        Self { line: motion.line, number: motion.number }
    }
}

/// Result of holding a program against a course.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verification {
    /// Motions of the program.
    pub motions: u64,
    /// Cuts at feed that were held against the course.
    pub cuts: u64,
    /// Rapids.
    pub rapids: u64,
    /// Holes that were made.
    pub holes: u64,
    /// Motions at feed that the course asks for at rapid.
    pub rapids_at_feed: u64,
    /// Rapids that come nearer to what is cut than their ends and the course's own rapids, and do not touch it.
    pub near_rapids: u64,
    /// Line of the first of them, and how near.
    pub nearest_rapid: Option<(u64, String)>,
    /// What still runs where a tool is changed, and the CL file does not have it off: a control may stop it by itself.
    #[serde(skip)]
    pub left_on: Vec<LeftOn>,
    /// How much travel the program needs, where nobody says where the part sits and not all of it lies inside.
    #[serde(skip)]
    pub part_place: Option<Diagnostic>,
    /// What of the course could not be understood, or not be read.
    #[serde(skip)]
    pub course_faults: Vec<Diagnostic>,
    /// Times that the tool left a cut and came back to where it left.
    pub excursions: u64,
    /// Cuts that are slower than the course asks, because an axis could not go faster, the control takes no larger F by
    /// time, or the feed is planned.
    pub limited: u64,
    /// Cuts that are slower than the course asks, and no axis explains it.
    pub slower: u64,
    /// Largest deviation of the guided point from the course in a cut, mm.
    pub tip: WorstDeviation,
    /// Largest deviation of the tool axis in a cut, degrees.
    pub axis: WorstDeviation,
    /// Largest distance at which a rapid passes a point of the course, mm.
    pub rapid: WorstDeviation,
    /// Farthest that two linear axes, which go straight to their values at rapid, take the tip from the straight way of the
    /// course, mm.
    #[serde(skip_serializing_if = "WorstDeviation::is_none")]
    pub axis_rapids: WorstDeviation,
    /// Time of the motions as the program states it, s; without rapids of machines whose file names no largest feeds.
    pub time_s: f64,
    /// What is wrong, in the order of the program; what is wrong in the same way again and again is one of them.
    pub faults: Vec<Fault>,
    /// Whether it was given up: there are more faults.
    pub gave_up: bool,
}

/// Something that still runs where a tool is changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeftOn {
    /// The first line of the program.
    pub line: u64,
    /// What: the code of its warning.
    pub code: &'static str,
    /// Text of the warning.
    pub message: String,
    /// Number of tool changes at which it runs.
    pub count: u64,
}

/// A deviation and where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct WorstDeviation {
    /// How large; the unit is told where it is used.
    pub value: f64,
    /// Line of the NC program.
    pub nc_line: u64,
    /// Line of the course.
    pub cl_line: u64,
}

impl WorstDeviation {
    /// Nothing was taken.
    pub fn is_none(&self) -> bool {
        self.nc_line == 0
    }

    pub(super) fn take(&mut self, value: f64, nc_line: u64, cl_line: u64) {
        if value > self.value {
            *self = Self { value, nc_line, cl_line };
        }
    }
}

/// Something that the program does otherwise than it should.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fault {
    /// A stable name for programs to read: `deviation`, `spindle`.
    pub code: &'static str,
    /// What is the same in faults of one kind.
    #[serde(skip)]
    pub(super) key: String,
    /// What, with the value and the limit.
    pub message: String,
    /// Line of the NC program, if one has it.
    pub nc_line: Option<u64>,
    /// Number of the block, if it has one.
    pub block: Option<u64>,
    /// Line of the course, if one asks for it.
    pub cl_line: Option<u64>,
    /// How often the same was found.
    pub count: u64,
    /// Amount by which a limit is passed, in the unit of the message.
    pub by: Option<f64>,
}

impl Fault {
    /// The fault as a message about a line of the program `file`, of which `text` is the line's text.
    pub fn diagnostic(&self, file: &str, text: &str, course: &SourceFiles) -> Diagnostic {
        let mut message = self.message.clone();
        if let Some(line) = self.cl_line {
            let (course, line) = course.locate(line);
            message.push_str(&format!(" ({course}, line {line})"));
        }
        if self.count > 1 {
            message.push_str(&format!("; so in {} places", self.count));
        }
        let place =
            self.nc_line.map(|line| SourcePlace::new(file, line, text, 0..text.trim_end().len()));
        Diagnostic::error(self.code, message).at(place)
    }
}

/// What became of one line of the program.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BlockReport {
    /// Line of the NC program.
    pub nc_line: u64,
    /// Number of the block, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<u64>,
    /// Line of the course that asks for where it ends; none for a motion that nothing asks for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cl_line: Option<u64>,
    /// `cut`, `rapid` or `hole`.
    pub kind: &'static str,
    /// Which of the machine's solutions it ends in, counted from 1 as the inverse of its chain gives them; none where there
    /// is one alone, or it was not asked for ([`super::VerifyRules::solutions`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solution: Option<usize>,
    /// Largest deviation of the guided point, mm.
    pub tip_deviation_mm: f64,
    /// Largest deviation of the tool axis, degrees.
    pub axis_deviation_deg: f64,
    /// What makes it slower than the course asks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limited_by: Option<Cow<'static, str>>,
}

/// Lines of a course of several files, as a sentence has them.
pub(super) fn lines_of(files: &SourceFiles, [from, to]: [u64; 2]) -> String {
    match from == to {
        true => format!("line {}", files.line(from)),
        false => format!("from line {} to line {}", files.line(from), files.line(to)),
    }
}
