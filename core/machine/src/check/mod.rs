//! What can be derived from a machine file, so that its builder can compare it with the machine.
//!
//! Everything here comes from the forward product and from [`Solver::inverse`](crate::kinematics::Solver) of
//! the machine as it would be used for posting; nothing is asked of the file twice. Directions and tips are
//! in the part frame, which with all axes at zero is parallel to the machine frame; lengths in mm, angles of
//! the reports in degrees as the control shows them.

mod class;
mod commission;
mod control;
mod errors;
mod leaving;
mod legs;
mod limited_box;
mod limits;
mod nominal;
mod pointing;
mod probe;
mod reach;
mod round_trip;
mod search;
mod settings;
mod signs;
mod volume;
mod words;

use serde::Serialize;

pub use class::{AxisLine, MachineClass};
pub use commission::{Commission, CommissionMove};
pub use errors::{AxisErrorsReport, ErrorsReport};
pub use legs::{LegReport, LegsReport};
pub use limits::{LimitReport, LimitRoom};
pub use nominal::{Comparison, DifferenceShare, Differing, compare};
pub use pointing::{AxisReadout, DirectionSolutions, Pole, Poles, WayOfPointing};
pub use reach::{DirectionMap, ReachableCone};
pub use round_trip::RoundTrip;
pub use signs::Sign;
pub use volume::Volume;
pub use words::WordReport;

pub use probe::{InverseWork, Probe};

use crate::description::{Axis, Machine};
use crate::diagnostic::Diagnostic;
use crate::kinematics::NoClosedForm;
use crate::kinematics::travel::{AT_END, passed};
use crate::work_spindle;

/// Everything that `post check` tells of one machine.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Name of the machine.
    pub machine: String,
    /// Numbers of the file that are not those of the machine, and what to measure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub not_known: Vec<String>,
    /// Length of the tool that it was derived with, mm from the gauge point.
    pub tool_length_mm: f64,
    /// Chain and class.
    pub class: MachineClass,
    /// How the chain is solved: in closed form, or numerically.
    pub solved: String,
    /// How the tool leaves the part, where the machine file has another way than that of the depth axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leaves: Option<String>,
    /// What the control makes of words of the program, where the machine file says so.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub control: Vec<String>,
    /// What each axis does, a line an axis and direction.
    pub signs: Vec<Sign>,
    /// What words that are no axis values do.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub words: Vec<WordReport>,
    /// What the words of X are on a lathe that says nothing of diameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<String>,
    /// What limits that depend on other axes leave of the travel.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<LimitReport>,
    /// What errors of axes do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<ErrorsReport>,
    /// What legs make of the axes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub legs: Option<LegsReport>,
    /// The solutions for one direction, written out.
    pub typical: Option<DirectionSolutions>,
    /// Directions that can be made in no single way.
    pub poles: Poles,
    /// Which directions the tool can take, and in how many ways.
    pub reach: ReachableCone,
    /// Where the tip can go with the tool upright.
    pub volume: Option<Volume>,
    /// Forward and inverse against each other.
    pub round_trip: RoundTrip,
    /// What looks wrong.
    pub warnings: Vec<String>,
    /// What it cost.
    #[serde(skip)]
    pub work: InverseWork,
}

impl Check {
    /// Derives all of it with a tool of `length` mm.
    ///
    /// # Errors
    /// What the chain lacks.
    pub fn of(machine: &Machine, length: f64) -> Result<Self, NoClosedForm> {
        let erring = Probe::new(machine, length)?;
        // All else is told of the lines alone.
        let lines = Machine { errors: [].into(), ..machine.clone() };
        let machine = if machine.errors.is_empty() { machine } else { &lines };
        let probe = Probe::new(machine, length)?;
        let class = MachineClass::of(machine);
        let reach = ReachableCone::of(&probe);
        let volume = Volume::of(&probe);
        let round_trip = RoundTrip::of(&probe);
        let mut warnings = warnings(&probe, &reach, volume.as_ref(), &round_trip);
        let (limits, wrong) = limits::told(&probe);
        warnings.extend(wrong);
        let (legs, wrong) = legs::told(&probe);
        warnings.extend(wrong);
        let typical = pointing::typical(&probe);
        let poles = Poles::of(&probe);
        Ok(Self {
            machine: machine.name.clone(),
            tool_length_mm: length,
            class,
            solved: if probe.closed_form() {
                "closed form"
            } else if probe.solver().planar() && probe.free().is_empty() {
                "closed form, in the plane of two linear axes; what lies off it is refused"
            } else if probe.solver().has_arm() {
                "closed form of a robot's arm, and from point to point numerically; each solution verified by the forward product"
            } else if probe.solver().planar() {
                "closed form: a rotary axis brings the tip into the plane of two linear ones; what it cannot bring there is refused"
            } else {
                "numerically, from the point before; each solution verified by the forward product"
            }
            .to_owned(),
            not_known: machine.profile.not_known(),
            leaves: leaving::told(machine),
            control: control::told(machine),
            signs: signs::table(&probe),
            words: words::told(&probe),
            radius: words::radius(&probe),
            limits,
            legs,
            errors: errors::told(&erring),
            typical,
            poles,
            reach,
            volume,
            round_trip,
            warnings,
            work: probe.work(),
        })
    }

    /// The warnings as findings.
    pub fn findings(&self) -> Vec<Diagnostic> {
        self.warnings.iter().map(|warning| Diagnostic::warning("check", warning.clone())).collect()
    }
}

/// A tip error of the round trip above this is no rounding error any more, mm.
const ROUND_TRIP: f64 = 1e-6;

fn warnings(
    probe: &Probe<'_>,
    reach: &ReachableCone,
    volume: Option<&Volume>,
    round_trip: &RoundTrip,
) -> Vec<String> {
    let mut warnings = Vec::new();
    let machine = probe.machine();
    // Where rotary axes place the tip, what can be made depends on the point.
    let at_origin = match probe.closed_form() {
        true => "",
        false => " with the tip on the part origin",
    };
    if reach.ways_upright == 0 {
        warnings.push(format!(
            "the tool cannot stand upright in the part{at_origin}: no axis values inside travel point it along +Z, which is what a CL point without a tool axis asks for"
        ));
    }
    if reach.share_of_sphere == 0.0 && reach.freedom == 2 && !reach.tied_to_the_tip {
        warnings.push(format!(
            "no direction of the tool can be made inside travel{at_origin}{}",
            match probe.closed_form() {
                true => "",
                false => ": does --mount or [workpiece] mount lie within reach?",
            }
        ));
    }
    warnings.extend(misnamed(machine));
    warnings.extend(in_metres(machine));
    warnings.extend(work_spindle::beside(machine).map(|warning| warning.message));
    // A tool that cannot stand upright is not asked for on the part origin: a live tool across a lathe never is there.
    if let Some(volume) = volume.filter(|_| reach.ways_upright > 0) {
        for beyond in &volume.origin_beyond {
            warnings.push(format!(
                "with the tool upright and {} mm long, its tip on the part origin: {beyond}",
                number(probe.length(), 3)
            ));
        }
        for out in &volume.origin_out {
            warnings.push(format!(
                "with the tool upright and {} mm long, the part origin is out of travel: {} would stand at {:.3}, its travel is {:.3} to {:.3}",
                number(probe.length(), 3),
                out.axis,
                out.value,
                out.travel[0],
                out.travel[1],
            ));
        }
    }
    let slides = machine.axes.iter().any(|axis| !axis.joint.rotary);
    warnings.extend(machine.axes.iter().flat_map(|axis| axis_warnings(axis, slides)));
    warnings.extend(inverse_warnings(probe, round_trip));
    warnings
}

/// Lines of an arm no farther than this from its gauge point were told in metres, mm.
const METRES: f64 = 10.0;

/// Rotary axes that only an arm has.
const OF_AN_ARM: usize = 5;

/// An arm whose lines all lie within millimetres of its gauge point.
fn in_metres(machine: &Machine) -> Option<String> {
    let rotary = machine.axes.iter().filter(|axis| axis.joint.rotary);
    let apart: Vec<f64> = rotary.map(|axis| (axis.joint.point - machine.gauge).norm()).collect();
    let farthest = apart.iter().fold(0.0, |most: f64, apart| most.max(*apart));
    (apart.len() >= OF_AN_ARM && farthest > 0.0 && farthest < METRES).then(|| {
        format!(
            "all axes that turn have their points within {} mm of the gauge point: lengths here are mm, and data sheets and DH tables of arms are often in metres",
            number(farthest, 3)
        )
    })
}

/// What an axis by itself makes a builder look at; on a machine that `slides` linear words count from a work offset.
fn axis_warnings(axis: &Axis, slides: bool) -> Vec<String> {
    let mut warnings = Vec::new();
    if axis.joint.rotary && axis.indexed.is_none() && axis.max_feed.is_infinite() {
        warnings.push(format!(
            "{} has no max_feed: no block will be slowed down for it, and the way that is taken does not weigh it",
            axis.name
        ));
    }
    if let Some([least, most]) = axis.travel.filter(|_| axis.joint.rotary && slides)
        && passed(axis.travel, -axis.zero, AT_END).is_some()
    {
        warnings.push(format!(
            "{} cannot stand where it shows 0: its travel is {} to {}; the work offset is taken there",
            axis.name,
            number(axis.reading(least), 3),
            number(axis.reading(most), 3)
        ));
    }
    warnings
}

/// What the inverse does not find.
fn inverse_warnings(probe: &Probe<'_>, round_trip: &RoundTrip) -> Vec<String> {
    let mut warnings = Vec::new();
    // A lathe of two axes turns what lies in their plane, and is asked for nothing else.
    let spindle = &probe.machine().spindle;
    let turns = spindle.surface_speed && probe.free().is_empty();
    if let Some([ways @ 0..3, _]) = probe.ways_by_search().filter(|_| !turns) {
        warnings.push(format!(
            "while the tool keeps its direction the tip can go {}: most programs ask for more, and are refused where they do",
            match ways {
                0 => "nowhere",
                1 => "along a line or curve alone",
                _ => "over a surface alone",
            }
        ));
    }
    if !probe.closed_form() {
        if round_trip.not_found == round_trip.poses {
            warnings.push(format!(
                "the search found axis values for none of {} poses that the machine stands in",
                round_trip.poses
            ));
        }
    } else if round_trip.tip_mm > ROUND_TRIP || round_trip.not_found > 0 {
        warnings.push(format!(
            "the inverse does not give back what the forward product made: off by up to {:.1e} mm, {} of {} poses not found",
            round_trip.tip_mm, round_trip.not_found, round_trip.poses
        ));
    }
    warnings
}

/// An axis whose letter stands for less of its direction than this is called by another's, if that other stands for more
/// than so much: a line 45 degrees between two is nobody's.
const LETTERED: [f64; 2] = [0.5, 0.9];

/// Axes whose letter says otherwise than their direction: ISO 841 has A, B, C about X, Y, Z. Arms are lettered otherwise, and
/// of two axes about the same line one alone can have its letter.
fn misnamed(machine: &Machine) -> Vec<String> {
    let axes = &machine.axes;
    let sliding = axes.iter().filter(|axis| !axis.joint.rotary).count();
    let taken = |name: &str| axes.iter().any(|axis| axis.name == name);
    let told = |axis: &Axis| {
        let (letters, moves) = match axis.joint.rotary {
            true => (["A", "B", "C"], "turns about"),
            false => (["X", "Y", "Z"], "slides along"),
        };
        let own = letters.iter().position(|letter| *letter == axis.name)?;
        let parts = axis.joint.direction.abs();
        let along = parts.imax();
        let (line, letter) = (["X", "Y", "Z"][along], letters[along]);
        let [little, nearly_all] = LETTERED;
        (parts[own] < little && parts[along] > nearly_all && !taken(letter)).then(|| {
            format!(
                "{} {moves} {line}, and ISO 841 calls such an axis {letter}: is its direction right, in a machine frame with Z along the spindle?",
                axis.name
            )
        })
    };
    axes.iter().filter(|_| sliding >= 2).filter_map(told).collect()
}

/// `value` with at most `decimals` decimals, no zeros behind, never `-0`.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" {
        return "0".to_owned();
    }
    text.to_owned()
}
