//! What a program did, as a course.
//!
//! What a program does because of its own machine is not part of the path of the tool against the part, and does not
//! become one on another machine: ways in positions of the machine, and what follows them up to where the tool is at a
//! place of the part again. A linear axis that was last moved in positions of the machine (at the beginning all were) has
//! no place of the part, and rapids are left out until each has one; then the tool [reaches](CourseItem::Reach) where it is.

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, MAX_AXES, Pose};
use post_motion::path::piece_ends;

use super::descent::{Descent, descends};
use super::{Course, CourseItem, CoursePiece, Curve, ReachedPose};
use crate::{
    BlockEffect, BlockRunner, Interpolation, MachineState, Motion, MotionKind, ProgramEvent,
};

/// How near a course stays to a program whose tip goes on curves that no piece has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chords {
    /// Of the tip at feed, mm.
    pub tip: f64,
    /// Of the tool axis, radians.
    pub axis: f64,
    /// Of the tip at rapid, mm.
    pub rapid: f64,
    /// Of the tool axis at rapid, radians.
    pub rapid_axis: f64,
}

/// Rapids may stray by so much more than cuts, but by half a millimetre, and their tool axis by 10°: they are off the part.
const RAPIDS: f64 = 100.0;
const RAPID: f64 = 0.5;
const RAPID_AXIS: f64 = 10.0 / 180.0 * std::f64::consts::PI;

impl Chords {
    /// Cuts within `tip` mm and `axis` radians.
    pub fn within(tip: f64, axis: f64) -> Self {
        Self { tip, axis, rapid: (tip * RAPIDS).max(RAPID), rapid_axis: RAPID_AXIS }
    }
}

/// Poses nearer than this are one: mm, and of unit vectors.
const SAME: f64 = 1e-9;

/// Ways shorter than this take no time at a feed, mm.
const NO_WAY: f64 = 1e-9;

/// A motion becomes so many pieces at most: some thousand turns of an axis.
const MOST_PIECES: u64 = 100_000;

/// A program's path, block by block.
#[derive(Debug)]
pub struct ProgramCourse<P> {
    program: P,
    chords: Chords,
    done: Vec<BlockEffect>,
    waiting: VecDeque<(Option<Arc<MachineState>>, CourseItem)>,
    /// A pose that is reached, and what was told since: if the tool leaves again before it goes anywhere from there, it was
    /// not reached for the part.
    held: VecDeque<(Option<Arc<MachineState>>, CourseItem)>,
    /// What held during the item that was handed out last.
    state: Option<Arc<MachineState>>,
    /// What a cycle does at a point, up to its end.
    hole: Option<Vec<(Option<Arc<MachineState>>, CourseItem)>>,
    /// What holds in the program.
    latest: Option<Arc<MachineState>>,
    /// Where the tool stands.
    stands: Option<Pose>,
    /// Bits of the linear axes that have no place of the part.
    astray: u32,
    /// Axis values behind the last way in machine coordinates.
    retracted: Option<Joints>,
    /// The tool has come down aside of its own line, to where it goes in along it.
    on_line: bool,
    /// Why the motion that was taken last becomes no pieces.
    refused: Option<Box<Diagnostic>>,
    ended: bool,
}

impl<P: BlockRunner> ProgramCourse<P> {
    /// The path of `program`.
    pub fn new(program: P, chords: Chords) -> Self {
        Self {
            program,
            chords,
            done: Vec::new(),
            waiting: VecDeque::new(),
            held: VecDeque::new(),
            state: None,
            hole: None,
            latest: None,
            stands: None,
            astray: u32::MAX,
            retracted: None,
            on_line: false,
            refused: None,
            ended: false,
        }
    }

    /// What held in the program during the item that was handed out last; none before its first motion.
    pub fn state(&self) -> Option<&Arc<MachineState>> {
        self.state.as_ref()
    }

    /// The program.
    pub fn program(&self) -> &P {
        &self.program
    }

    fn take(&mut self, done: BlockEffect) {
        match done {
            BlockEffect::State(state) => self.latest = Some(state),
            BlockEffect::Event { line, event } => {
                if leaves(&event) {
                    self.stands = None;
                    self.astray = u32::MAX;
                }
                self.hand_on(CourseItem::Event { line, event });
            }
            BlockEffect::Motion(motion) => self.motion(&motion),
        }
    }

    fn hand_on(&mut self, item: CourseItem) {
        match (&mut self.hole, &item) {
            (Some(_), CourseItem::Event { event: ProgramEvent::CycleEnd, .. }) => {
                let done = self.hole.take().unwrap_or_default();
                let done = in_one_go(done);
                self.waiting.append(&mut self.held);
                self.waiting.extend(done);
            }
            (Some(hole), _) => {
                hole.push((self.latest.clone(), item));
                return;
            }
            (None, CourseItem::Event { event: ProgramEvent::Cycle(_), .. }) => {
                self.hole = Some(Vec::new())
            }
            (None, _) => {}
        }
        let leaves = match &item {
            CourseItem::Event { event, .. } => leaves(event),
            CourseItem::Away { .. } => true,
            CourseItem::Reach(_) | CourseItem::Piece(_) => false,
        };
        let told = matches!(item, CourseItem::Event { .. });
        if leaves {
            self.held.retain(|(_, held)| !matches!(held, CourseItem::Reach(_)));
        }
        let next = (self.latest.clone(), item);
        if matches!(next.1, CourseItem::Reach(_)) || (told && !leaves && !self.held.is_empty()) {
            self.held.push_back(next);
            return;
        }
        self.waiting.append(&mut self.held);
        self.waiting.push_back(next);
    }

    fn motion(&mut self, motion: &Motion) {
        self.latest = Some(Arc::clone(&motion.state));
        // A program that retracts first moves nothing where the tool stands up there.
        self.retracted.get_or_insert(motion.from.joints);
        let moved = moved(motion);
        if motion.machine {
            self.astray |= moved;
            self.retracted = Some(motion.to.joints);
            if moved != 0 && self.stands.take().is_some() {
                self.hand_on(CourseItem::Away { line: motion.line });
            }
            return;
        }
        // Another length puts the tip elsewhere, though nothing moves.
        let follows = |stands: Pose| {
            (stands.tip - motion.from.pose.tip).norm() < SAME
                && (stands.axis - motion.from.pose.axis).norm() < SAME
        };
        if self.stands.take_if(|stands| !follows(*stands)).is_some() {
            self.astray = u32::MAX;
        }
        let cuts = motion.kind != MotionKind::Rapid;
        self.astray = match motion.way {
            Interpolation::Axes if !cuts => self.astray & !moved & linear(motion),
            // A tip has a place of the part, and so has what is cut.
            _ => 0,
        };
        let feed = (cuts && motion.feed > 0.0).then_some(motion.feed);
        if self.stands.is_none() {
            if self.astray != 0 {
                return;
            }
            let to = match cuts {
                true => motion.from.pose,
                false => motion.to.pose,
            };
            self.hand_on(CourseItem::Reach(ReachedPose {
                line: motion.line,
                kind: MotionKind::Rapid,
                to,
                feed: None,
                hole: motion.hole,
            }));
            self.stands = Some(motion.to.pose);
            if !cuts {
                return;
            }
        }
        if !self.comes_down(motion) {
            self.pieces(motion, feed);
        }
        self.stands = Some(motion.to.pose);
    }

    /// The tool comes on to its first position from about where it was retracted, by the depth axis alone or along its own
    /// line: the pose that is reached is the one below.
    fn comes_down(&mut self, motion: &Motion) -> bool {
        let on_line = std::mem::take(&mut self.on_line);
        let known = self.retracted.as_ref();
        let known = known.filter(|_| motion.kind == MotionKind::Rapid);
        let descent = known.and_then(|retracted| descends(motion, retracted, on_line));
        let Some(descent) = descent else {
            return false;
        };
        let held = self.held.iter_mut().rev();
        let Some(CourseItem::Reach(reach)) =
            held.map(|(_, item)| item).find(|item| matches!(item, CourseItem::Reach(_)))
        else {
            return false;
        };
        reach.to = motion.to.pose;
        reach.line = motion.line;
        self.on_line = descent == Descent::ToLine;
        true
    }

    /// The pieces of a motion.
    fn pieces(&mut self, motion: &Motion, feed: Option<f64>) {
        let Chords { tip, axis, rapid, rapid_axis } = self.chords;
        let (chord, angle) = match motion.kind {
            MotionKind::Rapid => (rapid, rapid_axis),
            MotionKind::Feed | MotionKind::Thread => (tip, axis),
        };
        let mut count = motion.pieces(chord, angle);
        // A spline stays one where the tool axis does.
        let curve = match motion.way.curve() {
            Curve::Spline(_) if motion.turns() => {
                count = count.max(motion.spline_chords(chord));
                Curve::Straight
            }
            Curve::Arc { centre, normal, sweep } => arc(*centre, *normal, sweep / count as f64),
            curve => curve.clone(),
        };
        if count > MOST_PIECES {
            let message = format!(
                "line {} of the program turns the tool so far against the part that it would become more than {MOST_PIECES} pieces",
                motion.line
            );
            let help = "is a decimal point missing in it? else divide the turn into blocks";
            self.refused = Some(Diagnostic::error("course", message).help(help).boxed());
            return;
        }
        let mut from = motion.from.pose;
        for to in piece_ends(count, motion.to.pose, |t| motion.at(t)) {
            let mut piece = CoursePiece {
                line: motion.line,
                kind: motion.kind,
                curve: curve.clone(),
                from,
                to,
                feed,
                turned_feed: None,
                hole: motion.hole,
            };
            if count > 1 && motion.minutes > 0.0 && feed.is_some() {
                // All axes linearly in time: the tip is faster on some pieces than on others.
                let way = piece.length();
                piece.feed = (way > NO_WAY).then(|| way * count as f64 / motion.minutes).or(feed);
            }
            self.hand_on(CourseItem::Piece(piece));
            from = to;
        }
    }
}

/// The tool comes from the changer, another head has another chain, a subprogram goes anywhere, and at the end nothing is
/// left to do.
fn leaves(event: &ProgramEvent) -> bool {
    matches!(
        event,
        ProgramEvent::ToolChange { .. }
            | ProgramEvent::Head(_)
            | ProgramEvent::Subprogram(_)
            | ProgramEvent::End
    )
}

/// Arcs turn right-handed by an angle above zero.
fn arc(centre: nalgebra::Vector3<f64>, normal: nalgebra::Vector3<f64>, sweep: f64) -> Curve {
    let normal = match sweep < 0.0 {
        true => -normal,
        false => normal,
    };
    Curve::Arc { centre, normal, sweep: sweep.abs() }
}

/// A hole without its pecks: the ways to where the feed begins, one down to the bottom, what is waited for there, and the
/// ways out of it.
fn in_one_go(
    done: Vec<(Option<Arc<MachineState>>, CourseItem)>,
) -> Vec<(Option<Arc<MachineState>>, CourseItem)> {
    let piece = |item: &CourseItem| match item {
        CourseItem::Piece(piece) => Some(piece.clone()),
        _ => None,
    };
    let cuts = |(_, item): &(Option<Arc<MachineState>>, CourseItem)| {
        piece(item).is_some_and(|piece| piece.kind != MotionKind::Rapid)
    };
    let Some(first) = done.iter().position(cuts) else {
        return done;
    };
    let Some(begin) = piece(&done[first].1) else {
        return done;
    };
    let height = |pose: &Pose| begin.from.axis.dot(&(pose.tip - begin.from.tip));
    let (mut last, mut bottom) = (first, begin.to);
    for (place, (_, item)) in done.iter().enumerate().skip(first) {
        if let Some(piece) = piece(item)
            && piece.kind != MotionKind::Rapid
            && height(&piece.to) <= height(&bottom) + SAME
        {
            (last, bottom) = (place, piece.to);
        }
    }
    let down = CoursePiece { to: bottom, ..begin };
    let mut whole: Vec<_> = done[..first].to_vec();
    whole.push((done[first].0.clone(), CourseItem::Piece(down)));
    whole.extend(done[last + 1..].iter().cloned());
    whole
}

/// Bits of the linear axes that go elsewhere.
fn moved(motion: &Motion) -> u32 {
    let differs = |place: &usize| motion.from.joints[*place] != motion.to.joints[*place];
    (0..MAX_AXES).filter(differs).fold(0, |bits, place| bits | 1 << place) & linear(motion)
}

/// Bits of the linear axes.
fn linear(motion: &Motion) -> u32 {
    let joints = motion.state.solver.chain().joints();
    let places = joints.iter().enumerate().filter(|(_, joint)| !joint.rotary);
    places.fold(0, |bits, (place, _)| bits | 1 << place)
}

impl<P: BlockRunner> Course for ProgramCourse<P> {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        loop {
            if let Some((state, item)) = self.waiting.pop_front() {
                self.state = state;
                return Ok(Some(item));
            }
            if self.ended {
                return Ok(None);
            }
            let mut done = std::mem::take(&mut self.done);
            let more = self.program.next(&mut done);
            done.drain(..).for_each(|done| self.take(done));
            self.done = done;
            if let Some(refused) = self.refused.take() {
                return Err(refused);
            }
            self.ended = !more?;
            if self.ended {
                self.waiting.extend(self.hole.take().unwrap_or_default());
                self.waiting.append(&mut self.held);
            }
        }
    }
}
