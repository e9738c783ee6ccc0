//! What a CL file says of its tools and of lines of the program, which stands anywhere in it.

use std::io::Read;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourceFiles};
use post_readback::course::cl::{ClCourse, ClSettings, ClTool};
use post_readback::course::{Course as _, CourseItem, CutRun};
use post_readback::{MOST_FAULTS, MotionKind};

use crate::failure::Failure;
use crate::files::ClSource;
use crate::read_back::course_settings;
use crate::settings::JobSettings;

/// What is known of a CL file that was read to its end.
#[derive(Clone, Debug, Default)]
pub struct ClFacts {
    /// Its tools.
    pub tools: Vec<ClTool>,
    /// The largest feed of a cut, mm/min; zero where none is known.
    pub fastest: f64,
    /// Its texts that are lines of the program.
    pub own_lines: Vec<String>,
    /// Its files, as messages call them.
    pub files: SourceFiles,
}

impl ClFacts {
    /// Of the CL file of a job.
    ///
    /// # Errors
    /// It cannot be read, or something in it cannot be understood.
    pub fn of_job(
        job: &JobSettings,
        machine: &Machine,
        source: &mut ClSource,
    ) -> Result<Self, Failure> {
        let input = source.open()?;
        let files = input.files();
        let facts = Self::read(course_settings(job, machine, &input), input.bytes)?;
        Ok(Self { files, ..facts })
    }

    /// Of the CL file in `input`.
    ///
    /// # Errors
    /// It cannot be read, or something in it cannot be understood.
    pub fn read(settings: ClSettings, input: impl Read) -> Result<Self, Failure> {
        let mut course = ClCourse::new(settings, input);
        let mut faults: Vec<Diagnostic> = Vec::new();
        let mut cuts = CutRun::default();
        let mut fastest = 0.0f64;
        loop {
            // Nothing is asked of points but how fast they are cut.
            if course.next_cuts(&mut cuts) {
                fastest = fastest.max(cuts.feed.unwrap_or(0.0));
                continue;
            }
            match course.next() {
                Ok(Some(CourseItem::Piece(piece))) if piece.kind == MotionKind::Feed => {
                    fastest = fastest.max(piece.feed.unwrap_or(0.0));
                }
                Ok(Some(_)) => {}
                Ok(None) => break,
                Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
                Err(_) => break,
            }
        }
        if !faults.is_empty() {
            return Err(faults.into());
        }
        let own_lines = course.own_lines().map(str::to_owned).collect();
        let tools = course.tools().to_vec();
        Ok(Self { tools, fastest, own_lines, files: SourceFiles::default() })
    }
}
