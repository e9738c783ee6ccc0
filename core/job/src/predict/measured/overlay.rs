//! A log laid over a prediction.
//!
//! Two things are compared, apart from one another. What the control commands: predicted and logged positions at the same
//! time, the clocks aligned; a cycle time that is wrong by a second shows here and leaves nothing else to be seen. What the
//! servos make of it: they follow the *logged* commands, as the prediction paper has it (Zhang, Chen 2025, section 5), so
//! that actual positions and contour errors are those of the same instant whatever the cycle time.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{MAX_AXES, Solver};
use post_motion::ProgramPlace;
use post_motion::measured::AxisTrack;

use super::aligned;
use super::coarse;
use super::compare::LogComparison;
use super::log::{Log, LoggedPosition};
use super::logged_path::MeasuredPoint;
use super::report::{ColumnRead, MeasuredFound};
use crate::failure::Failure;
use crate::predict::Sample;

/// Set-points of a prediction that a log is laid over: 136 bytes are kept of each.
const MOST_SET_POINTS: usize = 2_000_000;

/// What the servos were doing before the log began is not known; if the axes move there, so long passes before anything is
/// compared, s.
pub const UNKNOWN: f64 = 0.5;

/// An axis that is commanded by more than this from row to row moves, mm or radians.
pub const MOVES: f64 = 1e-6;

/// A prediction that is kept to lay a log over it.
#[derive(Debug)]
pub struct Overlay {
    pub(super) log: Log,
    /// What it counts from, where that is said, mm or radians.
    zeros: [Option<f64>; MAX_AXES],
    pub(super) commanded: AxisTrack,
    pub(super) actual: AxisTrack,
    /// What is carried out from a set-point on.
    runs: Vec<(usize, ProgramPlace)>,
}

impl Overlay {
    /// Of a prediction every `period` seconds that is still to come.
    pub fn new(log: Log, zeros: [Option<f64>; MAX_AXES], period: f64) -> Self {
        let track = || AxisTrack { begins: 0.0, period, joints: Vec::new() };
        Self { log, zeros, commanded: track(), actual: track(), runs: Vec::new() }
    }

    /// Takes the next set-point of the prediction.
    ///
    /// # Errors
    /// Too many.
    pub fn take(&mut self, sample: &Sample) -> Result<(), Failure> {
        let place = self.commanded.joints.len();
        if place == 0 {
            self.commanded.begins = sample.point.time;
            self.actual.begins = sample.point.time;
        }
        if place == MOST_SET_POINTS {
            let message = format!(
                "the prediction has more than {MOST_SET_POINTS} set-points, a log cannot be laid over it"
            );
            let help = "--period: a longer time from one to the next";
            return Err(Diagnostic::error("log", message).help(help).into());
        }
        let at = ProgramPlace { task: 0, ..sample.at };
        if self.runs.last().is_none_or(|(_, last)| *last != at) {
            self.runs.push((place, at));
        }
        self.commanded.joints.push(sample.point.commanded_joints);
        self.actual.joints.push(sample.point.actual_joints);
        Ok(())
    }

    /// Lays the log over it. `chains` are those of the prediction, with the time from which each holds; `listen` is told
    /// of each row of the log in which a following error is known, `findings` gets what makes it doubtful.
    ///
    /// # Errors
    /// They are not alike, or the period of the log is none for servos.
    pub fn finish(
        &self,
        machine: &Machine,
        chains: &[(f64, Arc<Solver>)],
        listen: &mut dyn FnMut(&MeasuredPoint),
        findings: &mut Vec<Diagnostic>,
    ) -> Result<MeasuredFound, Failure> {
        let log = &self.log;
        let alignment = aligned::aligned(self, machine)?;
        aligned::doubts(&alignment, machine, findings);
        let between = coarse::between(machine, log);
        if let Some(between) = &between {
            coarse::doubt(machine, log, between, findings);
        }
        let mut compared = LogComparison::new(self, machine, &alignment)?;
        compared.run(chains, listen);
        let columns = log.columns.read.iter().map(|column| ColumnRead {
            column: column.name.clone(),
            holds: column.content.spoken(machine),
            unit: column.unit.name,
        });
        Ok(MeasuredFound {
            log: log.name.clone(),
            rows: log.rows,
            columns: columns.collect(),
            unread: log.columns.unread.clone(),
            period_s: log.clock.period,
            seconds: (compared.count.max(1) - 1) as f64 * compared.period,
            missing_rows: log.clock.missing,
            jitter_s: log.clock.jitter,
            rounded_times: log.clock.rounded,
            turns: log.turns,
            shift_s: alignment.shift,
            shift_deviation_s: alignment.shift_deviation,
            rival_shift_s: alignment.rival,
            correlation: alignment.correlation,
            far_off: alignment.far_off,
            overlap_s: alignment.overlap,
            predicted_s: self.commanded.seconds(),
            motion_s: self.motion(),
            axes: compared.axes(machine, between.as_ref()),
            contour: compared.contour(),
        })
    }

    /// From the first commanded motion to the last: in the log, and as predicted.
    fn motion(&self) -> Option<[f64; 2]> {
        let axes = self.log.axes(LoggedPosition::Commanded);
        let logged = aligned::moving(&self.log.commanded, &axes, false)?;
        Some([logged, aligned::moving(&self.commanded, &axes, true)?])
    }

    /// The log.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// What the log counts from, where that is said.
    pub(super) fn zeros(&self) -> &[Option<f64>; MAX_AXES] {
        &self.zeros
    }

    /// What is carried out at the set-point `place`, looked for from the run `run` on.
    pub(super) fn at(&self, place: usize, run: &mut usize) -> ProgramPlace {
        while self.runs.get(*run + 1).is_some_and(|(from, _)| *from <= place) {
            *run += 1;
        }
        self.runs.get(*run).map_or_else(ProgramPlace::default, |(_, at)| *at)
    }
}
