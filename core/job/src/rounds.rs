//! A program that is made and predicted again and again, until it is as it should be: what planning in rounds, moving points
//! for the servos, and the question whether a plan is worth it share.

use post_machine::diagnostic::Diagnostic;
use post_posting::{PathShift, ProgramPreview};
use post_readback::interpret::Limits;

use super::one_program::OneProgram;
use super::posting_pass::PostingExtras;
use super::predict::{self, PredictReference, Prediction, PredictionSetup, Sample};
use crate::failure::Failure;
use crate::files::{ClSource, Scratch};

/// What messages call a program that is tried.
const NAME: &str = "a program that is tried";

/// Makes programs and predicts them; their texts are in scratch files.
pub struct Rounds<'r, 'p> {
    /// The program as it is asked for.
    pub program: &'r OneProgram<'p>,
    ahead: Option<&'r ProgramPreview>,
    source: &'r mut ClSource,
}

impl<'r, 'p> Rounds<'r, 'p> {
    /// Rounds of a program.
    pub fn new(
        program: &'r OneProgram<'p>,
        ahead: Option<&'r ProgramPreview>,
        source: &'r mut ClSource,
    ) -> Self {
        Self { program, ahead, source }
    }

    /// Makes a program, its points moved by `shift`.
    ///
    /// # Errors
    /// What is wrong with it: [`Failure::Refused`].
    pub fn make(
        &mut self,
        program: OneProgram<'_>,
        shift: Option<&mut dyn PathShift>,
    ) -> Result<Scratch, Failure> {
        let mut text = Scratch::new(NAME)?;
        let beside = PostingExtras { shift, ..PostingExtras::default() };
        let (report, findings): (_, Vec<Diagnostic>) =
            program.write(self.ahead, self.source, &mut text, beside)?;
        match report {
            Some(_) => Ok(text),
            None => Err(findings.into()),
        }
    }

    /// Predicts a program against the path of the CL file; `listen` hears every set-point.
    ///
    /// # Errors
    /// The machine cannot be used, or the program not be predicted.
    pub fn predict(
        &mut self,
        text: Scratch,
        listen: &mut dyn FnMut(&Sample),
    ) -> Result<Prediction, Failure> {
        let OneProgram { session, arguments, machine, finder, lines, threads, .. } = self.program;
        let asked = PredictionSetup {
            session,
            arguments,
            machine,
            finder,
            offsets: None,
            limits: Limits::default(),
            period: None,
            lines: lines.as_ref().map(|lines| lines.ranges.clone()),
            threads: *threads,
        };
        let mut heard = |sample: &Sample| {
            listen(sample);
            Ok(())
        };
        let against = PredictReference::Cl(self.source);
        let text = Box::new(text.reread()?);
        let predicted = predict::predict(&asked, against, NAME, text, &mut heard)?;
        Ok(predicted.found)
    }
}
