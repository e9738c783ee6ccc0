//! What the legs of a parallel machine make of its axes: what each drive does, how far it goes inside the travel of the
//! axes, and whether the drives tell where the platform stands.

use serde::Serialize;

use super::number;
use super::probe::{Probe, named};
use crate::halton;
use crate::kinematics::{Assembly, AssemblyProof, Drive, Joints, Leg};

/// Places in the travel of the axes at which the legs are looked at.
const PLACES: u32 = 2000;

/// Places from which Newton's way back is tried.
const SEARCHED: usize = 200;

/// Way of an axis in the table of a leg, mm or degrees.
const WAY: f64 = 1.0;

/// Share of the largest determinant below which a place counts as near one where the drives lose hold of the platform.
const NEARLY: f64 = 0.01;

/// Axis values that come back so near are those that went out, mm or radians.
const SAME: f64 = 1e-6;

/// The legs of a machine.
#[derive(Clone, Debug, Serialize)]
pub struct LegsReport {
    /// One by one, in the order of the file.
    pub legs: Vec<LegReport>,
    /// Share of the travel of the axes in which all legs reach inside their travels.
    pub share_of_travel: f64,
    /// Whether the drives tell where the platform stands.
    pub assembly: String,
    /// Newton's way from the drives back to the axes, from the place before.
    pub back: String,
}

/// One leg.
#[derive(Clone, Debug, Serialize)]
pub struct LegReport {
    /// What its drive is called.
    pub name: String,
    /// What is seen when its drive goes plus.
    pub plus: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// What the control shows of it with the axes at rest, if it reaches there.
    pub at_rest: Option<f64>,
    /// Changes at rest, or where the legs reach, while one axis after the other goes one mm or degree plus.
    pub changes: String,
    /// Least and largest reading inside the travel of the axes and of all legs.
    pub room: Option<[f64; 2]>,
    /// Its travel as the file has it.
    pub travel: Option<[f64; 2]>,
}

/// The legs, and what looks wrong with them; none where the machine has none.
pub(super) fn told(probe: &Probe<'_>) -> (Option<LegsReport>, Vec<String>) {
    let machine = probe.machine();
    let legs: Vec<&Leg> = machine.legs().collect();
    if legs.is_empty() {
        return (None, Vec::new());
    }
    let assembly = Assembly::new(legs.iter().copied());
    let inside: Vec<Joints> = places(probe)
        .filter(|joints| machine.limits.iter().all(|limit| limit.holds(joints)))
        .collect();
    let reaches = |joints: &Joints| assembly.drives(joints).is_some();
    let home = *probe.home();
    let rest = Some(home).filter(reaches).or(inside.first().copied());
    let report = |leg: &&Leg| {
        let values = inside.iter().filter_map(|joints| leg.value(joints)).map(|at| leg.reading(at));
        let room = values.fold(None, |room: Option<[f64; 2]>, value| {
            let [least, most] = room.unwrap_or([value; 2]);
            Some([least.min(value), most.max(value)])
        });
        LegReport {
            name: leg.name.clone(),
            plus: plus(leg),
            unit: if leg.turns() { "deg" } else { "mm" },
            at_rest: leg.value(&home).map(|value| leg.reading(value)),
            changes: rest.map_or_else(String::new, |rest| changes(probe, leg, &rest)),
            room,
            travel: leg.travel.map(|travel| travel.map(|end| leg.reading(end))),
        }
    };
    let proof = prove(probe, &assembly);
    let mut warnings = Vec::new();
    if inside.is_empty() {
        warnings.push(
            "the legs reach nowhere that was looked at inside the travel of the axes; is a sign, a side or a travel wrong?"
                .to_owned(),
        );
    }
    let senses = Senses::of(&assembly, &inside);
    if let (AssemblyProof::Open { .. }, false) = (proof, senses.agree()) {
        warnings.push(
            "the platform may come into another assembly inside travel: see `assembly`".to_owned(),
        );
    }
    let report = LegsReport {
        legs: legs.iter().map(report).collect(),
        share_of_travel: inside.len() as f64 / f64::from(PLACES),
        assembly: assembly_told(probe, proof, &senses),
        back: back(&assembly, &inside, proof),
    };
    (Some(report), warnings)
}

/// Places spread over the travel of the axes, the indexed ones where they start.
fn places<'a>(probe: &'a Probe<'_>) -> impl Iterator<Item = Joints> + use<'a> {
    (1..=PLACES).map(|number| {
        let mut joints = *probe.home();
        for (place, share) in (0..probe.machine().axes.len()).zip(halton::place(number)) {
            let [least, most] = probe.span(place);
            joints[place] = least + (most - least) * share;
        }
        joints
    })
}

/// What the eye sees when a drive goes plus.
fn plus(leg: &Leg) -> String {
    match leg.drive {
        Drive::Strut => "it grows".to_owned(),
        Drive::Slide { along, .. } => format!("its carriage moves to {}", named(along)),
        Drive::Formula { turns: true, .. } => "by its formula, deg".to_owned(),
        Drive::Formula { .. } => "by its formula, mm".to_owned(),
        Drive::Crank { about, .. } => {
            // From the plus side of the frame.
            let (sense, view) = match about.sum() >= 0.0 {
                true => ("counter-clockwise", about),
                false => ("clockwise", -about),
            };
            format!("its crank turns {sense} seen from {}", named(view))
        }
    }
}

/// `X -0.412, Z +0.910`: what a drive does while each axis goes one mm or degree.
fn changes(probe: &Probe<'_>, leg: &Leg, joints: &Joints) -> String {
    let Some(rates) = leg.rates(joints) else {
        return String::new();
    };
    let told = leg.places().filter_map(|place| {
        let axis = &probe.machine().axes[place];
        let change = rates[place] * axis.unit() / leg.unit() * WAY;
        let text = number(change, 4);
        let sign = if change > 0.0 { "+" } else { "" };
        (text != "0").then(|| format!("{} {sign}{text}", axis.name))
    });
    told.collect::<Vec<_>>().join(", ")
}

fn prove(probe: &Probe<'_>, assembly: &Assembly<'_>) -> AssemblyProof {
    let ends: [Joints; 2] = [0, 1].map(|end| {
        let mut joints = *probe.home();
        for (place, value) in joints.iter_mut().enumerate().take(probe.machine().axes.len()) {
            *value = probe.span(place)[end];
        }
        joints
    });
    assembly.prove([&ends[0], &ends[1]])
}

/// Determinants of the drives' rates at places that were looked at.
struct Senses {
    places: usize,
    least: f64,
    most: f64,
}

impl Senses {
    fn of(assembly: &Assembly<'_>, inside: &[Joints]) -> Self {
        let mut senses = Self { places: 0, least: f64::INFINITY, most: f64::NEG_INFINITY };
        for value in inside.iter().filter_map(|joints| assembly.determinant(joints)) {
            senses.places += 1;
            senses.least = senses.least.min(value);
            senses.most = senses.most.max(value);
        }
        senses
    }

    /// They have one sign, and none of them is near zero.
    fn agree(&self) -> bool {
        self.places > 0 && self.least * self.most > 0.0 && self.smallest() > NEARLY
    }

    /// The smallest as a share of the largest.
    fn smallest(&self) -> f64 {
        let [one, other] = [self.least, self.most].map(libm::fabs);
        if self.least * self.most > 0.0 { one.min(other) / one.max(other) } else { 0.0 }
    }
}

fn assembly_told(probe: &Probe<'_>, proof: AssemblyProof, senses: &Senses) -> String {
    match proof {
        AssemblyProof::One { boxes } => format!(
            "one: wherever the legs are inside travel the matrix of their rates is regular, proven by {boxes} boxes of axis values"
        ),
        AssemblyProof::Open { beside } if senses.agree() => format!(
            "not proven to be one everywhere (open beside {}), and nothing seen that speaks against it: at {} places inside travel the determinants of the drives' rates have one sign, the smallest {} % of the largest",
            probe.machine().shown(&beside),
            senses.places,
            number(100.0 * senses.smallest(), 1)
        ),
        AssemblyProof::Open { beside } => format!(
            "not proven to be one, in as many boxes of axis values as are looked at: what is left lies beside {}; legs that stand across their way, or in one plane, are singular, and less travel of axes or legs leaves such places out",
            probe.machine().shown(&beside)
        ),
        AssemblyProof::Few => "the legs are fewer than the axes that move them: drives do not tell where the platform stands".to_owned(),
    }
}

/// How many places Newton's steps find back to, each from the one looked at before.
fn back(assembly: &Assembly<'_>, inside: &[Joints], proof: AssemblyProof) -> String {
    if proof == AssemblyProof::Few {
        return "not asked for".to_owned();
    }
    let (mut asked, mut found, mut off): (usize, usize, f64) = (0, 0, 0.0);
    for pair in inside.windows(2).take(SEARCHED) {
        let Some(drives) = assembly.drives(&pair[1]) else {
            continue;
        };
        asked += 1;
        let Some(joints) = assembly.forward(&drives, &pair[0]) else {
            continue;
        };
        // What moves no leg is not told by them.
        let moved = assembly.places().iter();
        let miss = moved.map(|place| libm::fabs(joints[*place] - pair[1][*place]));
        let miss = miss.fold(0.0, f64::max);
        if miss < SAME {
            (found, off) = (found + 1, off.max(miss));
        }
    }
    format!("{found} of {asked} places found from another, off by at most {off:.1e} mm or rad")
}
