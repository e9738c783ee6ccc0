//! Mounts put to the proof: the whole file posted there, its text thrown away.

use nalgebra::Vector3;
use post_host::Finder;
use post_machine::description::{Axis, Machine, Setting, Side};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_machine::kinematics::Second;
use post_machine::place::{HalfSpace, MountConstraint, opened};
use post_posting::MountBounds;
use post_posting::report::PostingReport;

use super::{Least, PlaceRequest};
use crate::DryRun;
use crate::failure::Failure;
use crate::session::Session;
use crate::settings::JobSettings;

/// Where a part sits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartMount {
    /// Its origin with all axes at zero, machine frame, mm.
    pub mount: Vector3<f64>,
    /// How it is turned about its Z, degrees.
    pub turn: f64,
}

/// A program that can be made with the part there.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Where it sits.
    pub seat: PartMount,
    /// What posting it there comes to.
    pub report: PostingReport,
    /// Warnings.
    pub findings: Vec<Diagnostic>,
    /// Seconds, or degrees.
    pub cost: f64,
    /// The least that is left to the end of any linear axis, mm; infinite where nothing ends.
    pub room: f64,
}

/// An end of travel that bounds the mount.
#[derive(Clone, Debug, PartialEq)]
pub struct TravelBound {
    /// Name of the axis.
    pub axis: String,
    /// The end of its travel.
    pub end: MountConstraint,
}

/// What posting with linear travel opened says.
pub struct OpenTravelResult {
    /// Ends of travel that bound the mount.
    pub bounds: Vec<TravelBound>,
    /// Errors that no mount helps.
    pub faults: Vec<Diagnostic>,
    /// The linear axes bound the mount at all.
    pub bound: bool,
    /// Time is the same wherever the part sits.
    pub evenly: bool,
}

/// Dry runs, counted.
pub struct Trials<'a> {
    dry_run: DryRun<'a>,
    least: Least,
    /// Dry runs that were made.
    pub runs: u32,
    most: u32,
}

impl<'a> Trials<'a> {
    /// None yet.
    pub fn new(
        session: &'a Session,
        job: &'a JobSettings,
        request: &PlaceRequest,
    ) -> Result<Self, Failure> {
        Ok(Self {
            dry_run: DryRun::new(session, "place", "post", job, false)?,
            least: request.least,
            runs: 0,
            most: request.runs,
        })
    }

    /// The CL file, as the user named it.
    pub fn file(&self) -> &str {
        &self.dry_run.name
    }

    /// Where its plugins come from.
    pub fn finder(&self) -> &Finder {
        &self.dry_run.finder
    }

    /// How many dry runs may still be made.
    pub fn left(&self) -> u32 {
        self.most.saturating_sub(self.runs)
    }

    /// The machine with the part where the command line has it.
    pub fn machine(&self) -> Result<Machine, Failure> {
        self.dry_run.machine(&[])
    }

    /// The machine with the part there.
    fn machine_at(&self, seat: &PartMount) -> Result<Machine, Failure> {
        let settings = [Setting::Mount(seat.mount.into()), Setting::Turn(seat.turn)];
        self.dry_run.machine(&settings)
    }

    /// Posts the file with the part there; the findings if it cannot be.
    pub fn post(&mut self, seat: PartMount) -> Result<Result<Trial, Vec<Diagnostic>>, Failure> {
        self.runs += 1;
        let machine = self.machine_at(&seat)?;
        let (report, findings) = match self.dry_run.pass(&machine, None) {
            Ok(posted) => posted,
            Err(Failure::Refused(findings)) => return Ok(Err(findings)),
            Err(failure) => return Err(failure),
        };
        let rotary =
            |name: &str| machine.with_axis(name).is_some_and(|(_, axis)| axis.joint.rotary);
        let turning = report.axes.iter().filter(|axis| rotary(&axis.name));
        let cost = match self.least {
            Least::Time => report.time_s,
            Least::Rotary => turning.map(|axis| axis.way).sum(),
        };
        let left = report.axes.iter().filter_map(|range| {
            let (machine, axis) = machine.with_axis(&range.name)?;
            let [least, most] = range.travel?;
            let left = (range.min - least).min(most - range.max);
            follows_the_part(machine, axis).then_some(left)
        });
        Ok(Ok(Trial { room: left.fold(f64::INFINITY, f64::min), seat, cost, findings, report }))
    }

    /// Posts the file with the part there on the machine with its linear travel opened; `prefer` is a side on which a
    /// rotary axis should rather stand.
    pub fn opened(
        &mut self,
        seat: &PartMount,
        prefer: Option<(usize, Side)>,
    ) -> Result<OpenTravelResult, Failure> {
        self.runs += 1;
        let machine = self.machine_at(seat)?;
        let mut wide = opened(&machine);
        if let Some(prefer) = prefer {
            wide.solution.prefer = vec![prefer];
        }
        let mut watch = MountBounds::new(&machine).map_err(|lack| machine.unsolvable(&lack))?;
        let faults = match self.dry_run.pass(&wide, Some(&mut watch)) {
            Ok(_) => Vec::new(),
            Err(Failure::Refused(findings)) => findings,
            Err(failure) => return Err(failure),
        };
        let bounds = watch.ends().map(|(axis, end)| TravelBound { axis: axis.to_owned(), end });
        Ok(OpenTravelResult {
            bounds: bounds.collect(),
            faults: faults
                .into_iter()
                .filter(|finding| finding.severity == Severity::Error)
                .collect(),
            bound: watch.bounds(),
            evenly: watch.goes_evenly(),
        })
    }
}

/// A linear axis whose room the mount decides: one that stands between cuts, and one that waits at its end until another
/// takes its place, may be there.
fn follows_the_part(machine: &Machine, axis: &Axis) -> bool {
    let shares = |other: &Axis| match other.second {
        Some(Second::Reserve { of }) => {
            other.name == axis.name || machine.axes[of].name == axis.name
        }
        _ => false,
    };
    !axis.joint.rotary && axis.indexed.is_none() && !machine.axes.iter().any(shares)
}

/// The half-spaces of bounds.
pub fn bodies(bounds: &[TravelBound]) -> Vec<HalfSpace> {
    bounds.iter().map(|bound| bound.end.body).collect()
}
