//! Bodies of the machine for the choice among solutions while a program is made.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use post_clearance::piece::Way;
use post_clearance::proof::{Body, BodyKind, Look, Move, Proof};
use post_machine::description::{Machine, RapidAxes};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_machine::kinematics::Joints;
use post_motion::path::{Curve, Interpolation, Stance, turns};
use post_posting::{BodyClearance, ClearTool, Contact, TrialWay, TrialWayKind};

use super::bodies::{self, ToolShape, of_tool};
use super::{names, proof};
use crate::failure::Failure;

/// Ways that are followed side by side: what is known of distances goes on along each.
const MOST_TRACKS: usize = 6;

/// Ways that may as well be others keep so much more than they have to, mm, and distances are told apart no closer for them.
const COARSE: f64 = 0.5;

/// Ways that are remembered: full turns of a rotary axis are nothing to bodies.
const MOST_ASKED: usize = 64;

/// A proof that goes on along one way.
#[derive(Debug)]
struct Track {
    proof: Proof,
    stands: Joints,
    /// When it was last asked.
    used: u64,
}

/// What was said of a way.
#[derive(Debug)]
struct Asked {
    ends: [Joints; 2],
    kind: TrialWayKind,
    bodies: Option<[String; 2]>,
}

/// The bodies.
#[derive(Debug)]
pub(crate) struct ChoiceBodies<'a> {
    machine: &'a Machine,
    fixed: Vec<Body>,
    tool: Vec<Body>,
    tracks: Vec<Track>,
    asked: VecDeque<Asked>,
    count: u64,
    /// How closely distances are told apart, mm; none: as in the proof of the program.
    within: Option<f64>,
}

impl<'a> ChoiceBodies<'a> {
    /// Those of a machine; warnings go to `told`.
    ///
    /// # Errors
    /// A body that cannot be had.
    pub fn of(machine: &'a Machine, told: &mut Vec<Diagnostic>) -> Result<Self, Failure> {
        let mut findings = names::unknown(machine, None);
        let fixed = bodies::of_machine(machine, &mut findings);
        if findings.iter().any(|finding| finding.severity == Severity::Error) {
            return Err(findings.into());
        }
        told.append(&mut findings);
        Ok(Self::with(machine, fixed, None))
    }

    fn with(machine: &'a Machine, fixed: Vec<Body>, within: Option<f64>) -> Self {
        let (tool, tracks, asked) = (Vec::new(), Vec::new(), VecDeque::new());
        Self { machine, fixed, tool, tracks, asked, count: 0, within }
    }

    /// The same for ways that may as well be others: where bodies come by closely nothing is looked at for long.
    pub fn coarse(&self) -> Self {
        Self::with(self.machine, self.fixed.clone(), Some(COARSE))
    }

    /// The track that stands on `joints`; else another begins, in the place of the one that was asked longest ago.
    fn track(&mut self, joints: &Joints) -> &mut Track {
        self.count += 1;
        let known = self.tracks.iter().position(|track| track.stands == *joints);
        let place = known.unwrap_or_else(|| {
            if self.tracks.len() < MOST_TRACKS {
                let all = [self.fixed.as_slice(), &self.tool].concat();
                let proof = proof(self.machine, all);
                let proof = match self.within {
                    Some(within) => proof.known_within(within),
                    None => proof,
                };
                self.tracks.push(Track { proof, stands: *joints, used: 0 });
                return self.tracks.len() - 1;
            }
            let oldest = self.tracks.iter().enumerate().min_by_key(|(_, track)| track.used);
            oldest.map_or(0, |(place, _)| place)
        });
        let track = &mut self.tracks[place];
        track.used = self.count;
        track
    }

    /// Bodies that are not proven to be clear of one another on a way.
    fn prove(&mut self, way: &TrialWay<'_>, ends: [Joints; 2]) -> Option<[String; 2]> {
        let chain = way.solver.chain();
        let stances = ends.map(|joints| Stance { joints, pose: chain.forward(&joints) });
        let [from, to] = &stances;
        // Where axes turn the tip goes straight: by points that are put in, or because the control keeps it.
        let off_part = matches!(way.kind, TrialWayKind::Turn | TrialWayKind::Across);
        let straight = !off_part && turns(chain, [from, to]);
        let interpolation = match straight {
            true => Interpolation::Tip(Curve::Straight),
            false => Interpolation::Axes,
        };
        let rapid = way.kind != TrialWayKind::Cut;
        let together = self.machine.clearance.rapid_axes == RapidAxes::Together;
        let independent = rapid && !straight && !together;
        let way_of = Way {
            solver: way.solver,
            interpolation: &interpolation,
            ends: [from, to],
            independent,
        };
        // Where the tip goes in the part is the same whatever solution is taken, but for ways that the CL file does not have, and
        // for a stock that hangs elsewhere, which a cut may be in.
        let looks = |one: &Body, other: &Body| {
            let kinds = [one.kind, other.kind];
            let touches = kinds.contains(&BodyKind::Cutter) && kinds.contains(&BodyKind::Stock);
            let stock = if one.kind == BodyKind::Stock { one } else { other };
            match off_part || !touches || rapid && stock.link != 0 {
                true => Look::Prove,
                false => Look::LeaveOut,
            }
        };
        let track = self.track(&ends[0]);
        track.stands = ends[1];
        let before: Vec<u64> = track.proof.results().map(|result| result.faults).collect();
        let beyond = (way.kind == TrialWayKind::Across).then_some(COARSE);
        track.proof.take(&Move { way: way_of, rapid, line: 0, beyond, instead: false }, looks);
        let mut results = track.proof.results().zip(before);
        let (hit, _) = results.find(|(result, before)| result.faults > *before)?;
        Some(hit.bodies.map(|place| track.proof.bodies()[place].name.clone()))
    }
}

impl BodyClearance for ChoiceBodies<'_> {
    fn equip(&mut self, tool: Option<&ClearTool>) {
        self.tracks.clear();
        self.asked.clear();
        self.tool.clear();
        let Some((tool, length)) = tool.and_then(|tool| Some((tool, tool.length?))) else {
            return;
        };
        let machine = self.machine;
        let number = tool.number;
        let listed = machine.tool_table.as_ref();
        let listed = listed.and_then(|table| {
            let tool = table.entry(number, number)?;
            Some([tool.diameter()?, tool.corner_radius.unwrap_or(0.0)])
        });
        // The corner of one that the CL file describes is what the proof of the program knows.
        let size = listed.or(tool.diameter.map(|diameter| [diameter, 0.0]));
        let size = size.filter(|[size, _]| *size > 0.0);
        let shape = ToolShape {
            number,
            length,
            outline: machine.outlines.iter().find(|outline| outline.number == number),
            size: size.map(|[diameter, corner]| [0.5 * diameter, corner]),
        };
        self.tool = of_tool(machine, &shape, &mut Vec::new());
    }

    fn contact(&mut self, way: &TrialWay<'_>) -> Option<Contact> {
        let mut ends = way.ends.map(|joints| *joints);
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if axis.joint.rotary {
                let turns = TAU * libm::rint(ends[0][place] / TAU);
                ends.iter_mut().for_each(|joints| joints[place] -= turns);
            }
        }
        let known = self.asked.iter().find(|asked| (asked.ends, asked.kind) == (ends, way.kind));
        let bodies = match known {
            Some(known) => known.bodies.clone(),
            None => {
                let bodies = self.prove(way, ends);
                if self.asked.len() == MOST_ASKED {
                    self.asked.pop_front();
                }
                self.asked.push_back(Asked { ends, kind: way.kind, bodies: bodies.clone() });
                bodies
            }
        };
        bodies.map(|bodies| Contact { bodies, joints: *way.ends[1] })
    }
}
