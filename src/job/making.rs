//! Programs of a job: made, read back, predicted.

use std::io::{Read, Seek};
use std::ops::Range;

use post_host::Finder;
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::Diagnostic;
use post_plugin::DialectSession as _;
use post_posting::report::Report;
use post_posting::{LookedAhead, Output};
use post_readback::interpret::Limits;
use post_readback::verify::BlockReport;

use crate::arguments::{JobArguments, MakingArguments};
use crate::failure::Failure;
use crate::files::{ClSource, PathArg};
use crate::job::compensate::{self, Compensation, Moved};
use crate::job::one_program::{Beside, OneProgram};
use crate::job::plan_rounds;
use crate::job::plan_worth;
use crate::job::plugin_finder;
use crate::job::predict::{self, Against, Asked, Predicted, Sample};
use crate::job::read_back::{self, Held, Reading};
use crate::job::report::PredictedParts;
use crate::session::Session;

/// The machine of the command line, its program so numbered if a number is given.
pub fn numbered(
    session: &Session,
    arguments: &JobArguments,
    number: Option<i64>,
) -> Result<Machine, Failure> {
    let machine = super::machine(session, arguments, &[])?;
    let Some(number) = number else {
        return Ok(machine);
    };
    let dialect = machine.control.dialect;
    let setting = Setting::Written(format!("control.{dialect}.program_number={number}"));
    super::machine(session, arguments, &[setting])
}

/// Where a program goes: to `output`, else beside the CL file, with the ending of the machine or of its dialect.
///
/// # Errors
/// Its dialect cannot be opened.
pub fn target(
    arguments: &JobArguments,
    output: Option<&PathArg>,
    machine: &Machine,
    finder: &Finder,
) -> Result<PathArg, Failure> {
    let source = arguments.input();
    let program = super::program_name(source, output);
    let (dialect, _) = plugin_finder::dialect(finder, machine, &program, Some(source))?;
    let extension = machine.program.extension.clone();
    let extension = extension.unwrap_or(dialect.format().extension.clone());
    let beside = || source.map(|path| path.with_extension(&extension));
    Ok(output.cloned().unwrap_or_else(beside))
}

/// One program of a run.
#[derive(Clone, Debug)]
pub struct Part {
    /// Lines of the CL file that it is made of; none: all.
    pub lines: Option<Range<u64>>,
    /// Where it goes.
    pub target: PathArg,
    /// The machine with its settings.
    pub machine: Machine,
}

impl Part {
    /// Reads the program `name` back and holds it against the CL file; `moved` if its points were moved for the servos.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_back(
        &self,
        session: &Session,
        arguments: &JobArguments,
        finder: &Finder,
        (moved, planned): (bool, bool),
        source: &mut ClSource,
        (name, text): (String, impl Read + Seek),
    ) -> Result<Held, Failure> {
        // What was moved on purpose is off the CL file by that.
        let accuracy = &self.machine.accuracy;
        let bound = accuracy.servo_compensation.filter(|_| moved);
        let moved = bound.map(|bound| accuracy.tolerance + bound);
        let reading = Reading {
            session,
            arguments,
            machine: &self.machine,
            finder,
            offsets: None,
            limits: Limits::default(),
            tolerances: [moved, None],
            planned,
            solutions: false,
            any_coolant: false,
            // It was written in this run, or lines of the user's have another.
            any_work_offset: true,
            own: true,
            lines: self.lines.clone(),
        };
        read_back::verify(&reading, source, &name, text, &mut |_: &BlockReport| {})
    }

    /// Predicts what the program `name` does; `period` between set-points, s, over the machine file's.
    ///
    /// # Errors
    /// A file that cannot be read, or a machine that cannot be used.
    pub fn predict(
        &self,
        session: &Session,
        arguments: &JobArguments,
        finder: &Finder,
        period: Option<f64>,
        (source, mut heard): (&mut ClSource, Option<&mut PredictedParts>),
        (name, text): (String, impl Read + Seek),
    ) -> Result<Predicted, Failure> {
        let asked = Asked {
            session,
            arguments,
            machine: &self.machine,
            finder,
            offsets: None,
            limits: Limits::default(),
            period,
            lines: self.lines.clone(),
        };
        predict::predict(&asked, Against::Cl(source), &name, text, &mut |sample: &Sample| {
            if let Some(heard) = &mut heard {
                heard.take(sample);
            }
            Ok(())
        })
    }
}

/// A program that is ready to be written: its feed planned in rounds, its points moved, where that is asked for.
pub struct Ready<'a> {
    program: OneProgram<'a>,
    plan_rounds: Option<plan_rounds::Found>,
    /// Its plan is left out, and why.
    unplanned: Option<Diagnostic>,
    compensation: Option<Compensation>,
}

impl<'a> Ready<'a> {
    /// Does what comes before. Where the plan itself is `shown`, it is written whatever it gains.
    ///
    /// # Errors
    /// The machine file does not allow it, or the program cannot be made.
    pub fn new(
        mut program: OneProgram<'a>,
        making: &MakingArguments,
        ahead: Option<&LookedAhead>,
        source: &mut ClSource,
        shown: bool,
    ) -> Result<Self, Failure> {
        let mut rounds = None;
        if let Some(most) = making.plan_rounds {
            let (tightening, found) = plan_rounds::plan(&program, most, ahead, source)?;
            program.tightening = tightening;
            rounds = Some(found);
        }
        let mut unplanned = None;
        if program.plans && rounds.is_none() && !shown {
            unplanned = plan_worth::gains_nothing(&program, ahead, source)?;
            program.plans = unplanned.is_none();
        }
        let compensation = match making.compensate_servo {
            true => Some(compensate::compensate(&program, ahead, source)?),
            false => None,
        };
        Ok(Self { program, plan_rounds: rounds, unplanned, compensation })
    }

    /// What the user should know of the plan.
    pub fn warning(&self) -> Option<Diagnostic> {
        let rounds = self.plan_rounds.as_ref();
        let unplanned = || self.unplanned.clone();
        rounds.and_then(plan_rounds::warning).or_else(unplanned)
    }

    /// Its points are moved.
    pub fn is_moved(&self) -> bool {
        let compensation = self.compensation.as_ref();
        compensation.is_some_and(|moved| moved.found.kept)
    }

    /// What planning in rounds and moving points have done.
    pub fn found(self) -> (Option<plan_rounds::Found>, Option<compensate::Found>) {
        let compensation = self.compensation.map(|moved| moved.found);
        (self.plan_rounds, compensation)
    }

    /// Writes it, its points moved where that helps; `beside` sees its plan and its blocks.
    ///
    /// # Errors
    /// A file that cannot be read, or a machine that cannot be used.
    pub fn write(
        &self,
        ahead: Option<&LookedAhead>,
        source: &mut ClSource,
        file: &mut dyn Output,
        beside: Beside<'_, '_, '_>,
    ) -> Result<(Option<Report>, Vec<Diagnostic>), Failure> {
        let program = self.program.clone();
        let compensation = self.compensation.as_ref();
        let moved = compensation.and_then(|found| Some((&found.machine, found.moves.as_ref()?)));
        let Some((machine, moves)) = moved else {
            return program.write(ahead, source, file, beside);
        };
        let program = OneProgram { machine, ..program };
        let mut moved = Moved::new(moves);
        let beside = Beside { shift: Some(&mut moved), ..beside };
        program.write(ahead, source, file, beside)
    }
}
