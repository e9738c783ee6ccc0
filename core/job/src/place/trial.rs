//! Mounts put to the proof: the whole file posted there, its text thrown away.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

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
use crate::clearance::ClearanceSummary;
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
    /// What was proven of it, where the machine has bodies about the part.
    pub clearance: Option<ClearanceSummary>,
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

/// What posting comes to: a trial, or the findings that refuse it.
pub type PostedTrial = Result<Result<Trial, Vec<Diagnostic>>, Failure>;

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
        let mut dry_run = DryRun::new(session, "place", "post", job, false)?;
        dry_run.threads = request.threads;
        let machine = dry_run.machine(&[])?;
        // What stands about the part.
        dry_run.keeps_clear = !machine.stocks.is_empty() || !machine.fixtures.is_empty();
        Ok(Self { dry_run, least: request.least, runs: 0, most: request.runs })
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

    /// Posts the file with the part there; the findings if it cannot be.
    pub fn post(&mut self, seat: PartMount) -> PostedTrial {
        self.runs += 1;
        posted(&self.dry_run, self.least, seat)
    }

    /// [`Trials::post`] of each of these, as many as may still be made: several at a time.
    pub fn post_all(&mut self, seats: &[PartMount]) -> Vec<PostedTrial> {
        let seats = &seats[..seats.len().min(self.left() as usize)];
        self.runs += seats.len() as u32;
        let (least, next) = (self.least, AtomicUsize::new(0));
        let work = |dry_run: &DryRun<'_>| {
            let mut done = Vec::new();
            loop {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let Some(seat) = seats.get(place) else {
                    return done;
                };
                done.push((place, posted(dry_run, least, *seat)));
            }
        };
        let mut done = thread::scope(|scope| {
            let others = self.dry_run.threads.get().min(seats.len());
            let threads: Vec<_> = (1..others)
                .filter_map(|_| {
                    let dry_run = self.dry_run.of_one_thread();
                    let thread = thread::Builder::new();
                    thread.spawn_scoped(scope, move || work(&dry_run)).ok()
                })
                .collect();
            let mut done = work(&self.dry_run.of_one_thread());
            for thread in threads {
                done.extend(thread.join().unwrap_or_else(|payload| resume_unwind(payload)));
            }
            done
        });
        done.sort_by_key(|(place, _)| *place);
        done.into_iter().map(|(_, posted)| posted).collect()
    }

    /// Posts the file with the part there on the machine with its linear travel opened; `prefer` is a side on which a
    /// rotary axis should rather stand.
    pub fn opened(
        &mut self,
        seat: &PartMount,
        prefer: Option<(usize, Side)>,
    ) -> Result<OpenTravelResult, Failure> {
        self.runs += 1;
        let machine = machine_at(&self.dry_run, seat)?;
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

/// The machine with the part there.
fn machine_at(dry_run: &DryRun<'_>, seat: &PartMount) -> Result<Machine, Failure> {
    let settings = [Setting::Mount(seat.mount.into()), Setting::Turn(seat.turn)];
    dry_run.machine(&settings)
}

/// Posts the file with the part there; the findings if it cannot be.
fn posted(dry_run: &DryRun<'_>, least: Least, seat: PartMount) -> PostedTrial {
    let machine = machine_at(dry_run, &seat)?;
    let (report, mut findings) = match dry_run.pass(&machine, None) {
        Ok(posted) => posted,
        Err(Failure::Refused(findings)) => return Ok(Err(findings)),
        Err(failure) => return Err(failure),
    };
    let clearance = match dry_run.keeps_clear {
        true => match dry_run.prove(&machine) {
            Ok(proven) if proven.pairs.iter().any(|pair| pair.faults > 0) => {
                return Ok(Err(proven.findings));
            }
            Ok(proven) if proven.is_wrong() => {
                findings.extend(proven.findings.into_iter().map(unproven));
                None
            }
            Ok(proven) => Some(proven.summary()),
            Err(Failure::Refused(findings)) => return Ok(Err(findings)),
            Err(failure) => return Err(failure),
        },
        false => None,
    };
    let rotary = |name: &str| machine.with_axis(name).is_some_and(|(_, axis)| axis.joint.rotary);
    let turning = report.axes.iter().filter(|axis| rotary(&axis.name));
    let cost = match least {
        Least::Time => report.time_s,
        Least::Rotary => turning.map(|axis| axis.way).sum(),
    };
    let left = report.axes.iter().filter_map(|range| {
        let (machine, axis) = machine.with_axis(&range.name)?;
        let [least, most] = range.travel?;
        let left = (range.min - least).min(most - range.max);
        follows_the_part(machine, axis).then_some(left)
    });
    let room = left.fold(f64::INFINITY, f64::min);
    Ok(Ok(Trial { room, seat, cost, findings, report, clearance }))
}

/// What is not known of the bodies does not speak against a mount, but nothing is proven there.
fn unproven(finding: Diagnostic) -> Diagnostic {
    let message = format!("it is not proven that nothing hits anything: {}", finding.message);
    let place = finding.place.filter(|place| place.line == 0);
    Diagnostic { severity: Severity::Warning, message, place, ..finding }
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
