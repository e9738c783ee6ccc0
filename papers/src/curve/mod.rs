//! Feeds planned along a curve of a curve file: the feedrate paper's system (Chen, Ren, Sun 2016) from one file.

mod file;
mod found;
mod json_text;
mod limits;
mod parts;
mod path;
mod rows;
mod simulate;
mod solve;
mod text;
mod track;
mod walk;

use std::io::Read as _;

use post_feed::jerk::IntervalLaw;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use file::{CurveFile, GivenPath, Pointing, Splines};
use found::SplineFound;
use path::CurvePath;
use post_job::failure::Failure;
use post_job::files::{FileFault, PathArg};
use post_job::nc_program::open_as;
use post_job::plan::gauges::Gauges;
use post_job::plan::keep::PlanLimits;
use post_job::plan::pictures::PlanRooms;
use post_job::plan::tally::Tally;
use post_job::plan::{drawn, rooms};
use post_job::session::Session;
use post_job::text::number;
use rows::PlanRow;
use simulate::Timeline;
use walk::walk;

pub use found::CurveSummary;
pub use rows::csv;
pub use solve::{SolverChoice, SolverRequest};
pub use text::text;

/// A curve, and the machine that goes along it.
pub struct CurveJob {
    file: CurveFile,
    /// As the user named it.
    name: String,
    machine: Machine,
}

/// What the command line says over the files.
#[derive(Clone, Copy, Debug)]
pub struct CurveOverrides {
    /// mm/s.
    pub feed: Option<f64>,
    /// mm; infinite: no limit.
    pub chord_error: Option<f64>,
    /// mm; infinite: no limit.
    pub contour_error: Option<f64>,
    /// s.
    pub period: Option<f64>,
}

/// What came of planning it.
pub struct PlannedCurve {
    pub found: CurveSummary,
    /// What is kept for its pictures, and the line below their titles.
    pub rooms: PlanRooms,
    pub note: String,
}

impl CurveJob {
    /// Reads a curve file; `machine` is the one that was named, else the limits of the file make one.
    ///
    /// # Errors
    /// The file cannot be read, or what is wrong with it.
    pub fn read(
        session: &Session,
        source: &PathArg,
        machine: Option<Machine>,
    ) -> Result<(Self, Vec<Diagnostic>), Failure> {
        let (name, input) = open_as(session, "the curve file", source)?;
        let mut text = String::new();
        let read = input.take(file::MOST_BYTES + 1).read_to_string(&mut text);
        read.map_err(|error| FileFault::Read { name: name.clone(), error })?;
        if text.len() as u64 > file::MOST_BYTES {
            let message = format!("{name} is longer than {} bytes", file::MOST_BYTES);
            return Err(Diagnostic::error("curve", message).into());
        }
        let file = CurveFile::parse(&name, &text)?;
        let mut findings = Vec::new();
        let machine = match machine {
            Some(machine) => {
                if !file.limits.axes.is_empty() {
                    let message = format!(
                        "{name}: its limits of axes do not count: those of {} do",
                        machine.name
                    );
                    findings.push(Diagnostic::warning("plan", message));
                }
                machine
            }
            None => {
                let rotary: Vec<String> = match &file.path {
                    GivenPath::Splines(Splines { pointing: Pointing::Rotary(axes), .. }) => {
                        axes.iter().map(|(name, _)| name.clone()).collect()
                    }
                    _ => Vec::new(),
                };
                file.limits.machine(&name, &rotary)?
            }
        };
        let curve = Self { file, name, machine };
        Ok((curve, findings))
    }

    /// The machine with what is said over it: by the curve file, and over that by `over`.
    fn limited(&self, over: &CurveOverrides) -> Machine {
        let (mut machine, limits) = (self.machine.clone(), &self.file.limits);
        let lay = |said: Option<f64>, limit: &mut Option<f64>| {
            *limit = said.or(*limit).filter(|error| error.is_finite());
        };
        lay(over.chord_error.or(limits.chord_error), &mut machine.plan.chord_error);
        lay(over.contour_error.or(limits.contour_error), &mut machine.plan.contour_error);
        machine.motion.period = over.period.or(limits.period).unwrap_or(machine.motion.period);
        machine
    }

    /// Its path, gone along by a machine with a length of the tool in mm.
    fn path<'m>(&self, machine: &'m Machine, tool_length: f64) -> Result<CurvePath<'m>, Failure> {
        Ok(match &self.file.path {
            GivenPath::Splines(splines) => CurvePath::new(machine, tool_length, splines)?,
            GivenPath::Points(points, axes) => {
                CurvePath::through(machine, tool_length, points, axes.as_deref(), &self.name)?
            }
        })
    }

    /// What a plan keeps.
    fn keep(
        &self,
        path: &CurvePath<'_>,
        solver: SolverChoice,
        over: &CurveOverrides,
    ) -> Result<PlanLimits, Failure> {
        let machine = path.machine;
        let mut keep = PlanLimits::new(machine, &path.axes);
        if keep.servos.is_none() && machine.plan.contour_error.is_some() {
            let message = format!(
                "{}: a contour error is to be kept, and not every axis that leads the tip has a servo",
                machine.name
            );
            let help = "servo in the limits of the curve file, or [servo.X] of the machine file, says what a servo does; --contour-error off plans without";
            return Err(Diagnostic::error("plan", message).help(help).into());
        }
        keep.feed = over.feed.or(self.file.limits.tip[0]).unwrap_or(f64::INFINITY);
        keep.block_rate = 1.0 / machine.motion.block_time;
        if solver == SolverChoice::Jerk && !keep.has_jerk() {
            let message = format!("{}: --solver jerk, and no jerk is limited", self.name);
            let help =
                "j in the limits of the curve file, or max_jerk of the machine's axes, limits it";
            return Err(Diagnostic::error("plan", message).help(help).into());
        }
        Ok(keep)
    }

    /// Plans the feed along it. With a length of the tool in mm, and simulated if it is asked for.
    ///
    /// # Errors
    /// Which limit cannot be kept, and where; axes that cannot follow.
    pub fn plan(
        &self,
        asked: SolverRequest,
        over: CurveOverrides,
        tool_length: f64,
        simulated: bool,
    ) -> Result<PlannedCurve, Failure> {
        let machine = &self.limited(&over);
        let mut path = self.path(machine, tool_length)?;
        let keep = self.keep(&path, asked.solver, &over)?;
        let mut plans = solve::plan(&mut path, keep.feed, asked, &self.name)?;
        let jerk = asked.solver == SolverChoice::Jerk;
        let gauges = Gauges::new(machine, &path.axes, true, &keep, jerk);
        let refused = |(at, why): (f64, path::NoStation)| path.refused(&self.name, at, &why);
        let mut first = Tally::new(&gauges);
        walk(&path, &plans.stretches, &gauges, &mut |step| {
            first.take(step.point, step.way, step.time);
        })
        .map_err(refused)?;
        let slower = first.slower();
        plans.stretches.iter_mut().for_each(|stretch| stretch.spline.slow(slower));
        let names = path.axes.iter().map(|place| machine.axes[*place].name.clone());
        let names: Vec<String> = names.collect();
        let mut rooms = rooms(machine, &path.axes, &keep);
        let mut tally = Tally::new(&gauges);
        let mut timeline = Timeline::default();
        let mut rows = Vec::new();
        walk(&path, &plans.stretches, &gauges, &mut |step| {
            let active = tally.take(step.point, step.way, step.time);
            timeline.take(step);
            let point = step.point;
            rooms.take(&drawn(point));
            if step.knot {
                let limit = active.map(|place| gauges.all[place].name.as_str());
                rows.push(PlanRow::new(machine, &path.axes, point, limit));
            }
        })
        .map_err(refused)?;
        let simulated = match simulated {
            true => Some(timeline.simulate(&path, &plans.stretches, keep.contour_error)?),
            false => None,
        };
        let stops = plans.stretches.iter().skip(1).map(|stretch| stretch.parameters[0]);
        let found = CurveSummary {
            curve: self.name.clone(),
            name: self.file.name.clone(),
            machine: machine.name.clone(),
            stops: stops.collect(),
            samples: plans.samples,
            length_mm: tally.way(),
            seconds: tally.time(),
            solvers: plans.solvers,
            monotone: plans.monotone,
            spline_slower: 1.0 - slower,
            limits: tally.limits(),
            simulated,
            feed_splines: plans.stretches.iter().map(|stretch| spline(&stretch.spline)).collect(),
            axes: names,
            rows,
        };
        let note =
            format!("{} on {}, {} s", self.file.name, machine.name, number(found.seconds, 3));
        Ok(PlannedCurve { found, rooms, note })
    }
}

fn spline(spline: &post_feed::FeedSpline) -> SplineFound {
    let (knots, coefficients) = spline.b_spline();
    let ends = [spline.pieces.first(), spline.pieces.last()];
    SplineFound {
        degree: 2,
        range: [spline.knots[0], spline.knots[spline.knots.len() - 1]],
        constant_jerk_at_ends: ends
            .map(|piece| matches!(piece, Some(IntervalLaw::Leave(_) | IntervalLaw::Arrive(_)))),
        knots,
        coefficients,
    }
}
