//! Arcs, splines, cycles and planes become moves.
//!
//! What a dialect writes itself it declares at open ([`post_plugin::Capabilities`]). Everything leaves here as moves and
//! commands; those of a curve or a hole that the dialect may write go on as one element, with the curve or the cycle
//! (`stream`).

mod planes;
mod tangential;

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::{Cycles, Machine};
use post_machine::diagnostic::{Diagnostic, Short, SourceFiles};
use post_plugin::{Capabilities, Cycle};

use crate::curve::{CurveMove, CurveMoves, CurvePolicy, CurveShape};
use crate::faces::{FaceChange, FaceTracker};
use crate::findings::Findings;
use crate::preview::{FilePreview, wants_planes};
use crate::program::limits::MOST_CHORDS;
use crate::program::spline::{chords, flatten};
use crate::program::{
    ArcStep, Command, CycleLeg, CycleStep, DrillCycle, MoveFeed, ProgramStep, SplineStep,
    StraightMove,
};
use crate::stream::{BatchSink, HoleMoves, StreamItem, StreamPoint, gathered};
use planes::PlaneTracker;
use tangential::Tangential;

/// A straight move of the path, from its line of the CL file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathMove {
    /// Line of the CL file.
    pub line: u64,
    /// The move.
    pub motion: StraightMove,
}

impl StreamPoint for PathMove {
    type Curve = CurveMoves<Self>;
    type Note = FixedAxis;

    fn line(&self) -> u64 {
        self.line
    }

    fn moves(curve: &Self::Curve) -> usize {
        curve.moves.len()
    }
}

/// The tool axis stays from here on until the next of these, and the control is to get a tilted plane for it, with this
/// origin (mm, part frame); none: no plane. The tool has left the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedAxis(pub Option<Vector3<f64>>);

/// The first stage after the interpreter.
#[derive(Debug)]
pub(crate) struct ExpandStage {
    /// How far chords may stray from arcs and splines, mm.
    chord_tolerance: f64,
    /// Where the tool stands, mm, part frame; none if it is not known.
    tip: Option<Vector3<f64>>,
    /// The CL file says that it stands there (`FROM`), and no move has brought it there.
    only_said: bool,
    /// Tangential control of a tool with a leading edge.
    tangential: Option<Tangential>,
    /// An edge is headed along the travel: chords of a curve carry the direction of travel at their ends, as their edge.
    heads: bool,
    /// Which curves may stay curves; none if none may.
    keeps: Option<CurvePolicy>,
    /// The cycles that the dialect has words for, as far as the machine file wants them.
    cycles: Capabilities,
    /// Every hole goes by its moves, a thread too: the text is thrown away.
    only_moves: bool,
    /// Where the tool axis stays, if the control is to get planes.
    planes: Option<PlaneTracker>,
    /// What is written in polar interpolation of the control, if it has that.
    faces: Option<FaceTracker>,
    findings: Findings,
}

/// The moves and commands of `steps`, each with its line, chords straying by no more than `chord_tolerance` mm; and
/// what cannot be expanded. The tool has no leading edge.
pub fn expanded(
    steps: &[(u64, ProgramStep)],
    chord_tolerance: f64,
) -> (Vec<StreamItem<PathMove>>, Vec<Diagnostic>) {
    let findings = Findings::new(SourceFiles::default());
    let mut stage = ExpandStage {
        chord_tolerance,
        tip: None,
        only_said: false,
        tangential: None,
        heads: false,
        keeps: None,
        cycles: Capabilities::NONE,
        only_moves: false,
        planes: None,
        faces: None,
        findings: findings.clone(),
    };
    let all = gathered(|out| stage.take(steps, out));
    (all, findings.sorted())
}

/// Points that are farther from one another are two, mm.
const APART: f64 = 1e-6;

/// What leaves this stage.
type ExpandedSink<'o> = BatchSink<'o, StreamItem<PathMove>>;

impl ExpandStage {
    /// Makes the stage for a machine and a dialect that declares what it `writes`; `ahead` where the control is to be
    /// told planes.
    pub(crate) fn new(
        machine: &Machine,
        chord_tolerance: f64,
        writes: Capabilities,
        ahead: Option<Arc<FilePreview>>,
        findings: &Findings,
    ) -> Self {
        let tangential = Tangential::new(machine, findings);
        let keeps = CurvePolicy::new(machine, writes);
        Self {
            faces: ahead.as_ref().and_then(|ahead| FaceTracker::new(machine, Arc::clone(ahead))),
            planes: ahead.filter(|_| wants_planes(machine, writes)).map(PlaneTracker::new),
            cycles: match machine.control.cycles {
                Cycles::Native => writes,
                Cycles::Moves => Capabilities::NONE,
            },
            only_moves: false,
            chord_tolerance,
            tip: None,
            only_said: false,
            // An edge turns with the path.
            keeps: tangential.is_none().then_some(keeps),
            heads: machine.heads_edge(),
            tangential,
            findings: findings.clone(),
        }
    }

    /// Has every hole go by its moves, those of threads too.
    pub(crate) fn by_moves_alone(mut self) -> Self {
        self.cycles = Capabilities::NONE;
        self.only_moves = true;
        self
    }

    /// Line of the first step that is kept back.
    pub(crate) fn first_line(&self) -> Option<u64> {
        self.tangential.as_ref()?.first_line()
    }

    /// Corners that a tool with a leading edge was drawn back at.
    pub(crate) fn rewinds(&self) -> u64 {
        self.tangential.as_ref().map_or(0, |edge| edge.rewinds)
    }

    /// Straight moves up to `line` leave the stage as they are.
    pub(crate) fn passes_moves(&self, line: u64) -> bool {
        self.tangential.is_none()
            && self.planes.as_ref().is_none_or(|planes| planes.stays_until(line))
            && self.faces.as_ref().is_none_or(|faces| faces.stays_until(line))
    }

    /// Straight moves have left the stage by another way, the last to `tip`.
    pub(crate) fn passed(&mut self, tip: Vector3<f64>) {
        self.tip = Some(tip);
        self.only_said = false;
    }

    /// Takes a batch of steps, each with its line.
    pub(crate) fn take(&mut self, steps: &[(u64, ProgramStep)], out: &mut ExpandedSink<'_>) {
        let Some(mut tangential) = self.tangential.take() else {
            return self.steps(steps, out);
        };
        let mut batch = Vec::new();
        let mut next = |batch: &mut Vec<StreamItem<PathMove>>| {
            for item in batch.drain(..) {
                tangential.take(item, out);
            }
        };
        let mut moves = BatchSink::new(&mut batch, &mut next);
        self.steps(steps, &mut moves);
        moves.flush();
        self.tangential = Some(tangential);
    }

    fn steps(&mut self, steps: &[(u64, ProgramStep)], out: &mut ExpandedSink<'_>) {
        for (line, step) in steps {
            let line = *line;
            let change = self.planes.as_mut().and_then(|planes| planes.change(line, step));
            if let Some(origin) = change {
                self.left();
                // A curve begins where the tool stood before it left.
                self.only_said = true;
                out.note(line, FixedAxis(origin));
            }
            let change = self.faces.as_mut().and_then(|faces| faces.change(line, step));
            self.face_changes(line, change, out);
            match step {
                ProgramStep::Move(motion) => self.go(line, *motion, out),
                ProgramStep::Arc(arc) => self.arc(line, arc, out),
                ProgramStep::Spline(spline) => self.spline(line, spline, out),
                ProgramStep::Cycle(cycle) => self.cycle(line, cycle, out),
                // Points are in the part frame whatever plane they lie in.
                ProgramStep::Plane(_) | ProgramStep::EndCycle => {}
                ProgramStep::Command(command) => self.command(line, command.clone(), out),
            }
        }
    }

    /// The mode of the control begins or ends.
    fn face_changes(&mut self, line: u64, change: Option<FaceChange>, out: &mut ExpandedSink<'_>) {
        match change {
            None => {}
            Some(FaceChange::Without(finding)) => self.findings.at(line, finding),
            Some(FaceChange::Machine(name)) => {
                self.left();
                // A curve begins where the tool stood before it left.
                self.only_said = true;
                out.command(line, Command::Head(name));
            }
        }
    }

    /// The file ends: what was kept back is handed on; `line` is the last of it.
    pub(crate) fn finish(&mut self, line: u64, out: &mut ExpandedSink<'_>) {
        let change = self.faces.as_mut().and_then(FaceTracker::end);
        self.face_changes(line, change, out);
        if let Some(tangential) = &mut self.tangential {
            tangential.finish(out);
        }
    }

    /// One straight move.
    #[inline]
    fn go(&mut self, line: u64, motion: StraightMove, out: &mut ExpandedSink<'_>) {
        self.tip = Some(motion.tip);
        self.only_said = false;
        out.push_with(|| StreamItem::Point(PathMove { line, motion }));
    }

    fn command(&mut self, line: u64, command: Command, out: &mut ExpandedSink<'_>) {
        if let Command::From { tip, .. } = command {
            self.tip = Some(tip);
            self.only_said = true;
        } else if command.leaves() {
            self.left();
        }
        out.command(line, command);
    }

    /// The tool leaves the part: where it stands is not known.
    fn left(&mut self) {
        self.tip = None;
        self.only_said = false;
    }

    /// An arc. One that may stay an arc goes turn by turn.
    fn arc(&mut self, line: u64, step: &ArcStep, out: &mut ExpandedSink<'_>) {
        let ArcStep { arc, end, .. } = step;
        // After a hole the tool stands above the point that the arc begins on.
        let start = arc.at(0.0);
        if self.only_said || self.tip.is_some_and(|tip| (tip - start).norm() > APART) {
            let to_start = StraightMove { tip: start, axis: step.start_axis, chord: 0.0, ..*end };
            self.go(line, to_start, out);
        }
        let turns = libm::ceil(arc.sweep / TAU - 1e-9).max(1.0);
        let turn = arc.piece(0.0, 1.0 / turns);
        let (count, _) = turn.chords(self.chord_tolerance);
        let planes = self.planes.as_ref().is_some();
        let keeps = |keeps: &CurvePolicy| keeps.arc(arc, end, count, planes);
        if step.start_axis != end.axis
            || count.saturating_mul(turns as u64) > MOST_CHORDS
            || self.faces.as_ref().is_some_and(FaceTracker::is_on)
            || !self.keeps.as_ref().is_some_and(keeps)
        {
            return self.chords(line, step, out);
        }
        for place in 1..=turns as u32 {
            let [from, to] = [place - 1, place].map(|place| f64::from(place) / turns);
            let arc = if turns == 1.0 { *arc } else { arc.piece(from, to) };
            let pace = match end.pace {
                MoveFeed::InverseTime(feed) => MoveFeed::InverseTime(feed * turns),
                pace => pace,
            };
            let tip = if to == 1.0 { end.tip } else { arc.at(1.0) };
            let end = StraightMove { tip, pace, ..*end };
            let step = ArcStep { arc, end, ..*step };
            let moves = gathered(|out| self.chords(line, &step, out));
            let curve = CurveMove { course: CurveShape::Arc(arc), end };
            out.element(StreamItem::Curve { line, curve: Box::new(CurveMoves { curve, moves }) });
        }
    }

    /// Chords, the tool axis turning evenly from start to end.
    fn chords(&mut self, line: u64, step: &ArcStep, out: &mut ExpandedSink<'_>) {
        let ArcStep { arc, end, start_axis } = step;
        let (count, chord) = arc.chords(self.chord_tolerance);
        if count > MOST_CHORDS {
            self.findings.at(line, self.too_many_chords("arc", &count.to_string()));
            return;
        }
        let pace = match end.pace {
            // The time is that of the whole arc.
            MoveFeed::InverseTime(feed) => MoveFeed::InverseTime(feed * count as f64),
            pace => pace,
        };
        for piece in 1..=count {
            let t = piece as f64 / count as f64;
            let axis = if *start_axis == end.axis {
                end.axis
            } else {
                (start_axis * (1.0 - t) + end.axis * t).try_normalize(1e-9).unwrap_or(end.axis)
            };
            let motion = StraightMove {
                tip: if piece == count { end.tip } else { arc.at(t) },
                axis,
                pace,
                chord,
                edge: if self.heads { arc.travel(t) } else { end.edge },
            };
            self.go(line, motion, out);
        }
    }

    fn too_many_chords(&self, curve: &'static str, count: &str) -> Diagnostic {
        Diagnostic::error(
            curve,
            format!(
                "this {curve} needs {count} chords to stay within {} mm; {MOST_CHORDS} are possible",
                Short(self.chord_tolerance)
            ),
        )
        .help("check its numbers, widen the tolerance, or let the CAM system write GOTOs")
    }

    fn spline(&mut self, line: u64, step: &SplineStep, out: &mut ExpandedSink<'_>) {
        let SplineStep { spline, end } = step;
        if self.only_said {
            let tip = spline.poles[0].0;
            let to_start = StraightMove { tip, chord: 0.0, ..*end };
            self.go(line, to_start, out);
        }
        let face = self.faces.as_ref().is_some_and(FaceTracker::is_on);
        let keeps =
            |count| !face && self.keeps.as_ref().is_some_and(|keeps| keeps.spline(end, count));
        let along = match chords(spline, self.chord_tolerance) {
            Some(count) if count <= MOST_CHORDS => keeps(count),
            count => {
                let count = count.map_or("countless".to_owned(), |count| count.to_string());
                self.findings.at(line, self.too_many_chords("spline", &count));
                return;
            }
        };
        let tolerance = self.chord_tolerance;
        let mut flat = |out: &mut ExpandedSink<'_>| {
            flatten(spline, tolerance, &mut |chord| {
                let edge = match self.heads {
                    true => spline.derivatives_on(chord.span, chord.at)[1],
                    false => end.edge,
                };
                let motion = StraightMove { tip: chord.end, chord: chord.stray, edge, ..*end };
                self.go(line, motion, out);
            });
        };
        if !along {
            return flat(out);
        }
        let curve = CurveMove { course: CurveShape::Spline(spline.clone()), end: *end };
        let moves = gathered(flat);
        out.element(StreamItem::Curve { line, curve: Box::new(CurveMoves { curve, moves }) });
    }

    /// Approach, pecks, dwell and retract at one point; where the control has the cycle, as a hole.
    fn cycle(&mut self, line: u64, step: &CycleStep, out: &mut ExpandedSink<'_>) {
        let CycleStep { cycle, point } = *step;
        let native = cycle.native();
        let known = native.filter(|native| self.cycles.has(native.kind.capability()));
        if let (Some(kind), None, false) =
            (native.filter(|native| native.alone).map(|native| native.kind), known, self.only_moves)
        {
            self.findings.at(line, no_moves(kind));
            return;
        }
        let mut legs = Vec::new();
        cycle.legs(&mut |leg| legs.push(leg));
        // The first leg ends on the retract level.
        let (first, rest) = legs.split_at(legs.len().min(1));
        let at = PathMove { line, motion: point };
        let mut above = |out: &mut ExpandedSink<'_>| {
            self.go_aside(&at, &cycle, out);
            self.cycle_legs(&at, first, out);
        };
        let Some(cycle) = known else {
            above(out);
            return self.cycle_legs(&at, rest, out);
        };
        let above = gathered(above);
        let into = gathered(|out| self.cycle_legs(&at, rest, out));
        let StraightMove { tip: point, axis, .. } = point;
        out.element(StreamItem::Hole(Box::new(HoleMoves {
            line,
            cycle,
            point,
            axis,
            above,
            into,
        })));
    }

    /// Between holes the tool goes up before it goes aside, and aside before it goes down.
    fn go_aside(&mut self, at: &PathMove, cycle: &DrillCycle, out: &mut ExpandedSink<'_>) {
        let Some(tip) = self.tip else {
            return;
        };
        let PathMove { line, motion: point } = *at;
        let height = point.axis.dot(&(tip - point.tip));
        let aside = tip - point.tip - point.axis * height;
        if aside.norm() > 1e-6 {
            let level = cycle.retract();
            let rapid = |tip| StraightMove { tip, pace: MoveFeed::Rapid, ..point };
            if height < level {
                self.go(line, rapid(point.tip + aside + point.axis * level), out);
            } else if height > level {
                self.go(line, rapid(point.tip + point.axis * height), out);
            }
        }
    }

    /// Legs of a cycle at a point.
    fn cycle_legs(&mut self, at: &PathMove, legs: &[CycleLeg], out: &mut ExpandedSink<'_>) {
        let PathMove { line, motion: point } = *at;
        for leg in legs {
            let (height, pace) = match *leg {
                CycleLeg::Rapid(height) => (height, MoveFeed::Rapid),
                CycleLeg::Feed(height) => (height, point.pace),
                CycleLeg::Dwell(seconds) => {
                    self.command(line, Command::Dwell(seconds), out);
                    continue;
                }
            };
            let tip = point.tip + point.axis * height;
            self.go(line, StraightMove { tip, pace, ..point }, out);
        }
    }
}

/// A cycle that no moves can do, and that the control does not get.
fn no_moves(kind: Cycle) -> Diagnostic {
    let refused = Diagnostic::error(
        "cycle",
        "this cycle ties the feed to the spindle's turns, or stops the spindle in the hole, which moves cannot do, \
         and this dialect has no words for it or [control] cycles = \"moves\" leaves them out",
    );
    refused.help(match kind {
        Cycle::BoreFine | Cycle::BoreBack => {
            "[program] bore_shift, on the controls that have it, says which way the cycle draws the tool off the wall: it is not written without; or CYCLE/BORE without ORIENT"
        }
        Cycle::Tap | Cycle::TapLeft => {
            "cycles = \"native\" and a control that has it; the dialect's option `tapping` where it must be named (`post plugin show`), and a program in mm where it taps by the pitch; or thread milling in the CAM system"
        }
        _ => "cycles = \"native\" and a control that has it",
    })
}
