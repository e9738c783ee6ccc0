//! The search: where travel leaves room, what posting makes of it, and where it costs least.

use nalgebra::Vector3;
use post_machine::description::{Machine, Side};
use post_machine::diagnostic::Diagnostic;
use post_machine::place::{
    HalfSpace, MountCost, descend, most_room, nearest, rounded, shuffled, spread,
};

use super::trial::{PartMount, PostedTrial, TravelBound, Trial, Trials, bodies};
use super::{Least, PlaceRequest};
use crate::failure::Failure;

/// Mounts that are found one from the other before a route is given up: each is bound by what was found at those before.
const ROUNDS: usize = 4;

/// Dry runs that a mount takes: with travel opened, to see what is left, and there, to see that it holds.
const A_LOOK: u32 = 2;

/// Steps of the search for a mount that costs less, mm.
const STEPS: [f64; 5] = [100.0, 40.0, 15.0, 5.0, 1.0];

/// Places all over the room from the best of which that search begins too.
const PLACES: usize = 24;

/// A seat must cost less by this share to be taken for the present one.
const WORTH: f64 = 1e-3;

/// What a room that was asked for may lack, mm: tips are rounded as they are printed.
const ROUNDING: f64 = 2e-3;

/// What was found.
pub struct MountSearchResult {
    /// The CL file, as the user named it.
    pub file: String,
    /// The machine, the part where the command line has it.
    pub machine: Machine,
    /// Where the part sits.
    pub best: Trial,
    /// Where the command line and the machine file have it, if it can be posted there.
    pub present: Option<Trial>,
    /// There something hits, or that it does not is not proven.
    pub hits_here: bool,
    /// Dry runs that were made.
    pub runs: u32,
    /// The number of dry runs ended the search.
    pub spent: bool,
    /// Time is the same wherever the part sits.
    pub evenly: bool,
}

/// Why a turn has no seat.
enum NoMount {
    /// No mount leaves the margin.
    Short(Diagnostic),
    /// With its linear travel opened the machine cannot make it either: no mount helps.
    Anywhere(Vec<Diagnostic>),
    /// Rotary axes place the tip too: no mount follows from travel.
    Unbound,
    /// Posting refuses what travel would allow.
    Refused(Vec<Diagnostic>),
}

impl NoMount {
    /// With the axes turned otherwise it might fit.
    fn may_be_the_route(&self) -> bool {
        match self {
            Self::Short(_) => true,
            Self::Anywhere(_) | Self::Unbound => false,
            Self::Refused(findings) => out_of_travel(findings),
        }
    }
}

/// Searches a seat.
pub struct Search<'s, 'a> {
    trials: &'s mut Trials<'a>,
    request: &'a PlaceRequest,
    machine: Machine,
    present: PartMount,
}

impl<'s, 'a> Search<'s, 'a> {
    /// About where the part sits now.
    pub fn new(request: &'a PlaceRequest, trials: &'s mut Trials<'a>) -> Result<Self, Failure> {
        let machine = trials.machine()?;
        Ok(Self {
            present: PartMount {
                mount: machine.mount,
                turn: libm::rint(machine.turn.to_degrees() * 1e9) / 1e9,
            },
            trials,
            request,
            machine,
        })
    }

    /// The room that is asked for, mm.
    fn margin(&self) -> f64 {
        self.request.margin
    }

    fn holds(&self, trial: &Trial) -> bool {
        trial.room >= self.margin() - ROUNDING
    }

    /// Finds the seat.
    pub fn run(mut self) -> Result<MountSearchResult, Failure> {
        let present = self.trials.post(self.present)?;
        let here = self.seat_at(self.present.turn, present.as_ref().ok())?;
        let (mut best, nothing) = match here {
            Ok(seated) => (Some(seated), None),
            Err(nothing) => (None, Some(nothing)),
        };
        if let Some(step) = self.request.search_turn {
            best = self.turned(best, step)?;
        }
        let Some(BoundedMount { mut trial, bounds, evenly }) = best else {
            return Err(self.refuse(nothing, present.err()));
        };
        // A straight shift of all axes takes no longer, and turns nothing.
        if self.request.least == Least::Time && !evenly {
            self.settle(&mut trial, &bounds)?;
        }
        let hits_here = present.as_ref().is_err_and(|findings| hits(findings));
        let present = present.ok();
        if let Some(present) = &present
            && self.holds(present)
            && trial.cost >= present.cost * (1.0 - WORTH)
        {
            trial = present.clone();
        }
        Ok(MountSearchResult {
            file: self.trials.file().to_owned(),
            machine: self.machine,
            best: trial,
            present,
            hits_here,
            runs: self.trials.runs,
            spent: self.trials.left() < A_LOOK,
            evenly,
        })
    }

    /// The seat with the part turned so. `known` is a trial at that turn that was made already.
    fn seat_at(
        &mut self,
        turn: f64,
        known: Option<&Trial>,
    ) -> Result<Result<BoundedMount, NoMount>, Failure> {
        let mut nothing = None;
        for prefer in self.routes() {
            let found = self.on_route(turn, prefer, known)?;
            match found {
                Ok(seated) => return Ok(Ok(seated)),
                // Another route turns the axes otherwise, but reaches no farther, and mends nothing but travel.
                Err(found) if nothing.is_none() && !found.may_be_the_route() => {
                    return Ok(Err(found));
                }
                Err(found) => nothing = nothing.or(Some(found)),
            }
            if self.trials.left() < A_LOOK {
                break;
            }
        }
        Ok(Err(nothing.unwrap_or(NoMount::Refused(Vec::new()))))
    }

    /// The routes that are tried: as the machine file says, then with each axis rather on one side of zero.
    fn routes(&self) -> Vec<Option<(usize, Side)>> {
        let pointing = self.machine.pointing();
        let sides = pointing.into_iter().flat_map(|joint| {
            let travel = self.machine.axes[joint].travel;
            let both = travel.is_none_or(|[least, most]| least < 0.0 && most > 0.0);
            let sides = [Side::Positive, Side::Negative].into_iter();
            sides.filter(move |_| both).map(move |side| Some((joint, side)))
        });
        [None].into_iter().chain(sides).collect()
    }

    /// The seat next to the present one that a route leaves.
    fn on_route(
        &mut self,
        turn: f64,
        prefer: Option<(usize, Side)>,
        known: Option<&Trial>,
    ) -> Result<Result<BoundedMount, NoMount>, Failure> {
        let wished = self.present.mount;
        let mut seat = PartMount { mount: wished, turn };
        let mut bounds = Vec::new();
        let mut refused = Vec::new();
        for _ in 0..ROUNDS {
            let opened = self.trials.opened(&seat, prefer)?;
            bounds.extend(opened.bounds);
            bounds = shuffled(bounds);
            let seated = |trial: Trial, bounds: Vec<TravelBound>| BoundedMount {
                trial,
                bounds,
                evenly: opened.evenly,
            };
            if let Some(known) = known
                && self.holds(known)
            {
                return Ok(Ok(seated(known.clone(), bounds)));
            }
            if !opened.bound {
                return Ok(Err(NoMount::Unbound));
            }
            if out_of_travel(&opened.faults) {
                return Ok(Err(NoMount::Anywhere(opened.faults)));
            }
            let bodies = bodies(&bounds);
            let Some(point) = nearest(&bodies, &wished, self.margin() + ROUNDING) else {
                return Ok(Err(NoMount::Short(self.short(&bounds, turn))));
            };
            seat.mount = rounded(&bodies, &point, self.margin()).unwrap_or(tidy(&point));
            match self.trials.post(seat)? {
                Ok(trial) if self.holds(&trial) => return Ok(Ok(seated(trial, bounds))),
                Ok(_) => {}
                Err(findings) if hits(&findings) => {
                    refused = findings;
                    if let Some(trial) = self.clear_place(turn, &bounds)? {
                        return Ok(Ok(seated(trial, bounds)));
                    }
                    break;
                }
                Err(findings) => refused = findings,
            }
            if self.trials.left() < A_LOOK || !(refused.is_empty() || out_of_travel(&refused)) {
                break;
            }
        }
        Ok(Err(NoMount::Refused(refused)))
    }

    /// The cheapest of the mounts all over the room where nothing hits anything, of equals the one nearest to the present.
    fn clear_place(&mut self, turn: f64, bounds: &[TravelBound]) -> Result<Option<Trial>, Failure> {
        let bodies = bodies(bounds);
        let places = spread(&bodies, &self.present.mount, self.margin() + ROUNDING, PLACES);
        let seats: Vec<PartMount> =
            places.iter().map(|mount| PartMount { mount: tidy(mount), turn }).collect();
        let mut best: Option<Trial> = None;
        for posted in self.trials.post_all(&seats) {
            let nearer = |trial: &Trial, best: &Trial| {
                let far = |trial: &Trial| (trial.seat.mount - self.present.mount).norm();
                let alike = trial.cost < best.cost * (1.0 + WORTH);
                trial.cost < best.cost * (1.0 - WORTH) || alike && far(trial) < far(best)
            };
            if let Ok(trial) = posted?
                && self.holds(&trial)
                && best.as_ref().is_none_or(|best| nearer(&trial, best))
            {
                best = Some(trial);
            }
        }
        Ok(best)
    }

    /// The cheapest of all turns, `step` degrees apart, and then more closely about it.
    fn turned(
        &mut self,
        here: Option<BoundedMount>,
        step: f64,
    ) -> Result<Option<BoundedMount>, Failure> {
        let mut best = here;
        let count = libm::ceil(360.0 / step - 1e-9) as i32;
        // Those next to the present turn come first: of equals the least turned is taken.
        let coarse = (1..count).map(|index| {
            let half = (index + 1) / 2;
            let signed = if index % 2 == 1 { half } else { -half };
            self.present.turn + f64::from(signed) * step
        });
        for turn in coarse.collect::<Vec<f64>>() {
            self.better(&mut best, turn)?;
        }
        let mut finer = step / 2.0;
        while finer >= 0.5 {
            let Some(middle) = best.as_ref().map(|best| best.trial.seat.turn) else {
                break;
            };
            for turn in [middle + finer, middle - finer] {
                self.better(&mut best, turn)?;
            }
            finer /= 2.0;
        }
        Ok(best)
    }

    fn better(&mut self, best: &mut Option<BoundedMount>, turn: f64) -> Result<(), Failure> {
        if self.trials.left() < A_LOOK {
            return Ok(());
        }
        // From -180 exclusive to 180 inclusive, and no more digits than one would set.
        let turn = libm::remainder(libm::rint(turn * 1e3) / 1e3, 360.0);
        if let Ok(seated) = self.seat_at(turn, None)?
            && best.as_ref().is_none_or(|best| seated.trial.cost < best.trial.cost * (1.0 - WORTH))
        {
            *best = Some(seated);
        }
        Ok(())
    }

    /// Moves a seat to where the program costs less: by steps from where it is, and from the best of the places that lie
    /// all over the room. Each way alone may end where only another one leads on.
    fn settle(&mut self, trial: &mut Trial, bounds: &[TravelBound]) -> Result<(), Failure> {
        let bodies = bodies(bounds);
        let start = MountCost { mount: trial.seat.mount, cost: trial.cost };
        let places = spread(&bodies, &start.mount, self.margin() + ROUNDING, PLACES);
        let mut other: Option<MountCost> = None;
        let inside = places.into_iter().filter(|mount| self.is_inside(mount, &bodies));
        let inside: Vec<Vector3<f64>> = inside.collect();
        let turn = trial.seat.turn;
        let seats: Vec<PartMount> =
            inside.iter().map(|mount| PartMount { mount: tidy(mount), turn }).collect();
        // None of them hangs on what another costs.
        for (mount, posted) in inside.into_iter().zip(self.trials.post_all(&seats)) {
            let cost = self.cost_of(trial, posted)?;
            if let Some(cost) = cost.filter(|cost| other.is_none_or(|other| *cost < other.cost)) {
                other = Some(MountCost { mount, cost });
            }
        }
        for start in [Some(start), other].into_iter().flatten() {
            let mut fault = None;
            descend(start, &STEPS, |mount| {
                if fault.is_some() {
                    return None;
                }
                self.cost_at(trial, mount, &bodies).unwrap_or_else(|failure| {
                    fault = Some(failure);
                    None
                })
            });
            fault.map_or(Ok(()), Err)?;
        }
        Ok(())
    }

    /// What the program costs with the part there, if it can sit there; the least of all is kept in `least`.
    fn cost_at(
        &mut self,
        least: &mut Trial,
        mount: Vector3<f64>,
        bodies: &[HalfSpace],
    ) -> Result<Option<f64>, Failure> {
        if !self.is_inside(&mount, bodies) || self.trials.left() == 0 {
            return Ok(None);
        }
        let seat = PartMount { mount: tidy(&mount), turn: least.seat.turn };
        let posted = self.trials.post(seat);
        self.cost_of(least, posted)
    }

    /// Travel leaves the margin that is asked for.
    fn is_inside(&self, mount: &Vector3<f64>, bodies: &[HalfSpace]) -> bool {
        bodies.iter().all(|body| body.room(mount) >= self.margin())
    }

    /// What the program costs where it was posted, if the part can sit there; the least of all is kept in `least`.
    fn cost_of(&self, least: &mut Trial, posted: PostedTrial) -> Result<Option<f64>, Failure> {
        let trial = match posted? {
            Ok(trial) if self.holds(&trial) => trial,
            _ => return Ok(None),
        };
        let cost = trial.cost;
        if cost < least.cost {
            *least = trial;
        }
        Ok(Some(cost))
    }

    /// Travel is short: by how much, of which axes, at which lines.
    fn short(&self, bounds: &[TravelBound], turn: f64) -> Diagnostic {
        let name = &self.machine.name;
        let bodies = bodies(bounds);
        let Some(tight) = most_room(&bodies, &self.present.mount) else {
            return Diagnostic::error("place", format!("{name} has no mount for this part"));
        };
        let mut ends: Vec<&TravelBound> = Vec::new();
        for index in tight.between {
            let bound = &bounds[index];
            let same = |other: &&TravelBound| {
                other.axis == bound.axis && other.end.side.largest == bound.end.side.largest
            };
            if ends.len() < 4 && !ends.iter().any(same) {
                ends.push(bound);
            }
        }
        ends.sort_by_key(|bound| (&bound.axis, bound.end.side));
        let told: Vec<String> = ends
            .iter()
            .map(|bound| {
                let end = if bound.end.side.largest { "largest" } else { "least" };
                format!("{} at its {end} end on line {}", bound.axis, bound.end.line)
            })
            .collect();
        let told = told.join(" and ");
        let turned = match turn {
            0.0 => String::new(),
            turn => format!(" turned by {turn}°"),
        };
        let at = mount_text(&tight.point.map(|value| libm::rint(value * 10.0) / 10.0));
        if tight.room < 0.0 {
            Diagnostic::error(
                "place",
                format!(
                    "this part{turned} does not fit {name}, wherever it sits: travel is short by {:.3} mm at each of {told} (with --mount {at}, which leaves most)",
                    -tight.room
                ),
            )
            .help(self.else_turned("a shorter tool, or a machine with more travel"))
        } else {
            Diagnostic::error(
                "place",
                format!(
                    "no mount of this part{turned} on {name} leaves {} mm to every end of travel: --mount {at} leaves most, {:.3} mm, between {told}",
                    self.margin(),
                    tight.room
                ),
            )
            .help(format!(
                "--margin {} is the most that fits",
                libm::floor(tight.room * 100.0) / 100.0
            ))
        }
    }

    /// What helps where no mount does: a turn, unless that was searched, and `other`.
    fn else_turned(&self, other: &str) -> String {
        if self.request.search_turn.is_some() {
            return format!("no turn of the part that was tried fits either: {other}");
        }
        format!("--search-turn looks for a turn of the part about its Z that fits; else {other}")
    }

    /// Nothing fits.
    fn refuse(&self, nothing: Option<NoMount>, present: Option<Vec<Diagnostic>>) -> Failure {
        match nothing {
            Some(NoMount::Short(finding)) => finding.into(),
            Some(NoMount::Anywhere(mut findings)) => {
                let name = &self.machine.name;
                let message = format!(
                    "no mount helps: {name} cannot point the tool as the file asks, wherever the part sits"
                );
                let other = "another set-up or machine";
                let rotary = self.machine.axes.iter().any(|axis| axis.joint.rotary);
                findings.push(Diagnostic::error("place", message).help(match rotary {
                    true => self.else_turned(other),
                    false => other.to_owned(),
                }));
                findings.into()
            }
            Some(NoMount::Unbound) => {
                let mut findings = present.unwrap_or_default();
                let message = format!(
                    "no mount is searched for {}: its rotary axes place the tip too, so that none follows from travel",
                    self.machine.name
                );
                findings.push(
                    Diagnostic::error("place", message)
                        .help("try --mount X,Y,Z: `post check` tells where the tip can go"),
                );
                findings.into()
            }
            Some(NoMount::Refused(findings)) if !findings.is_empty() => findings.into(),
            _ => {
                let mut findings = present.unwrap_or_default();
                let message = format!(
                    "no mount was found in {} dry runs that leaves {} mm to every end of travel",
                    self.trials.runs,
                    self.margin()
                );
                findings.push(
                    Diagnostic::error("place", message).help("a smaller --margin, or more --runs"),
                );
                findings.into()
            }
        }
    }
}

/// A seat, and what bounds it.
struct BoundedMount {
    trial: Trial,
    bounds: Vec<TravelBound>,
    evenly: bool,
}

/// Some axis is asked for what it does not reach; of a machine with its linear travel opened that is a rotary one.
fn out_of_travel(findings: &[Diagnostic]) -> bool {
    let codes = ["over-travel", "out-of-reach"];
    findings.iter().any(|finding| codes.contains(&finding.code))
}

/// Something hits, or that it does not is not proven.
fn hits(findings: &[Diagnostic]) -> bool {
    findings.iter().any(|finding| finding.code == "clearance")
}

/// Without what sums leave in the last digits: as it is told, so it is tried.
fn tidy(mount: &Vector3<f64>) -> Vector3<f64> {
    // Adding zero turns -0 into 0.
    mount.map(|value| libm::rint(value * 1e6) / 1e6 + 0.0)
}

/// `X,Y,Z`, as `--mount` takes it.
pub fn mount_text(mount: &Vector3<f64>) -> String {
    let mount = tidy(mount);
    format!("{},{},{}", mount.x, mount.y, mount.z)
}
