//! What is made of a program's set-points, in batches: servos follow them, and the tool is held against its path. Memory does
//! not grow with the program.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::Solver;
use post_motion::SetPoints;

use super::found;
use super::prediction::Prediction;
use super::run::{PredictWatch, Predicted};
use super::stages::Stages;
use super::trajectory::{Trajectory, TrajectoryNews};
use crate::failure::Failure;
use crate::nc_program;

/// A tool that strays by more from a CL file, mm, hardly cuts its part.
const OTHER_PART: f64 = 1.0;

/// What is made of set-points.
pub struct SetPointStream<'a> {
    /// The program, as messages call it.
    name: &'a str,
    machine: &'a Machine,
    stages: Stages<'a>,
    /// The chains that the axes moved by, and the time from which each did, s.
    chains: Vec<(f64, Arc<Solver>)>,
}

impl<'a> SetPointStream<'a> {
    /// Of the program `name`.
    pub fn new(name: &'a str, machine: &'a Machine, stages: Stages<'a>) -> Self {
        Self { name, machine, stages, chains: Vec::new() }
    }

    /// Takes what becomes known of the program.
    ///
    /// # Errors
    /// Axes that cannot follow, or whoever listens fails.
    pub fn take(
        &mut self,
        news: &mut TrajectoryNews,
        watch: &mut dyn PredictWatch,
    ) -> Result<(), Failure> {
        match news {
            TrajectoryNews::Block(done) => done.iter().for_each(|done| watch.done(done)),
            TrajectoryNews::Start(joints) => self.stages.servos.settle(joints),
            TrajectoryNews::Task(planned) => self.stages.ahead(planned),
            TrajectoryNews::Times(times) => self.stages.done(self.machine, times),
            TrajectoryNews::Points(points) => self.points(points, watch)?,
            TrajectoryNews::Failed(fault) => return Err((**fault).clone().into()),
        }
        Ok(())
    }

    fn points(&mut self, points: &SetPoints, watch: &mut dyn PredictWatch) -> Result<(), Failure> {
        let known = self.chains.last();
        if !points.is_empty() && known.is_none_or(|(_, known)| !Arc::ptr_eq(known, &points.solver))
        {
            self.chains.push((points.time(0), Arc::clone(&points.solver)));
        }
        self.stages.batch(points, &mut |sample| watch.sample(sample))
    }

    /// What was found, once nothing more becomes known of the program.
    ///
    /// # Errors
    /// A block of the program is refused, or whoever listens fails.
    pub fn finish(
        self,
        trajectory: Trajectory<'_>,
        watch: &mut dyn PredictWatch,
    ) -> Result<Predicted, Failure> {
        let Self { name, machine, stages, chains } = self;
        let moved = trajectory.has_moved();
        let (run, mut findings) = trajectory.end();
        if !run.faults().is_empty() {
            // What stands behind a block that is not run counts from elsewhere.
            return Err(run.into_faults().into());
        }
        if !moved {
            findings.push(no_motion(name));
        }
        let report = run.program().report();
        findings.extend(report.notes.iter().cloned());
        findings.extend(nc_program::unknown_words(name, report, machine));
        found::warn(machine, &mut findings);
        let listen = &mut |sample: &_| watch.sample(sample);
        let found = stages.finish(machine, name, report.blocks, listen)?;
        findings.extend(other_part(name, &found));
        Ok(Predicted { found, findings, chains })
    }
}

/// Nothing moves in the program `name`.
fn no_motion(name: &str) -> Diagnostic {
    let message = "nothing moves in this program: no time, no feed and no error can be predicted";
    let help = "is it the program of this machine's control? `post read` says what is read of it";
    let place = SourcePlace::new(name, 1, "", 0..0);
    Diagnostic::warning("no-motion", message).help(help).at(Some(place))
}

/// The tool strays so far from a CL file that this is perhaps that of another part.
fn other_part(name: &str, found: &Prediction) -> Option<Diagnostic> {
    let tip = &found.contour.tip_mm;
    let file = found.against.as_ref().filter(|_| tip.largest > OTHER_PART)?;
    let message = format!("the tool strays by {:.3} mm from the path of {file}", tip.largest);
    let help = "is it the CL file that the program was made from, with the same tool length, mount and units? `post verify` says where they part";
    let place = SourcePlace::new(name, tip.nc_line, "", 0..0);
    Some(Diagnostic::warning("contour-far", message).help(help).at(Some(place)))
}
