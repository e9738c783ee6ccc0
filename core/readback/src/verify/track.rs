//! The course, cut into what a program is held against: short straight pieces, points, holes and events.
//!
//! Only what the program may stand at is kept: what lies behind it is dropped, what lies ahead is not read yet.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_motion::path::circle_ends;

use super::chop;
use super::place::{PlaceBound, PlaceDistance, ToolPlace};
use crate::course::{Course, CourseItem, CoursePiece, CutRun};
use crate::{Coolants, CycleCall, CycleKind, MOST_FAULTS, MotionKind, ProgramEvent, SpindleState};

/// What a course asks to hold while the tool cuts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CutState {
    pub tool: Option<u32>,
    /// What the spindle and the coolants did as the tool came.
    pub at_change: (SpindleState, Coolants),
    pub spindle: SpindleState,
    /// What the spindle was told since the tool came.
    pub turned: Vec<SpindleState>,
    pub coolants: Coolants,
    /// Side of the contour: -1 left, 1 right, 0 off.
    pub side: i8,
    /// Register of the compensation.
    pub register: Option<u32>,
    /// Number of the work offset, from 1; none: the file names none.
    pub work_offset: Option<u32>,
}

/// One thing that a course asks for.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub line: u64,
    pub what: ElementKind,
    pub from: ToolPlace,
    pub to: ToolPlace,
    pub asked: Arc<CutState>,
    /// mm/min.
    pub feed: Option<f64>,
    /// mm a revolution of the part, at a constant cutting speed.
    pub turned_feed: Option<f64>,
    /// Whether its end is the end of what the course calls one piece.
    pub ends: bool,
    /// How near the program has come to its end while it might stand there.
    pub near: PlaceDistance,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub(super) enum ElementKind {
    /// A straight piece at feed.
    Cut,
    /// A straight piece along a thread.
    Thread,
    /// A point that is passed at rapid, and the straight way to it.
    Way,
    /// A point that is reached by whatever way; at rapid, or at feed too.
    Reach(MotionKind),
    /// A hole of a cycle.
    Hole(Box<CourseHole>),
    /// The program stops or waits; it was met.
    Event(ProgramEvent, bool),
}

/// A hole: from the level where the feed begins to the bottom.
#[derive(Clone, Debug)]
pub(super) struct CourseHole {
    pub kind: CycleKind,
    /// How far below the level where its feed begins the first peck may come, and how far each after it, mm; none: in
    /// one go.
    pub pecks: Option<[f64; 2]>,
    /// Wait at the bottom.
    pub dwell: Option<ProgramEvent>,
    /// How the tool comes back.
    pub back: Option<MotionKind>,
    /// Feed at which it comes back, mm/min; none at rapid.
    pub out: Option<f64>,
    /// How the course comes to it at rapid: a control may go otherwise.
    pub approach: Vec<[ToolPlace; 2]>,
}

/// A course on its way to a program.
#[derive(Debug)]
pub(super) struct CourseTrack<C> {
    course: C,
    along: f64,
    sag: PlaceBound,
    elements: VecDeque<Element>,
    asked: Arc<CutState>,
    cycle: Option<CycleCall>,
    hole: Option<Element>,
    /// Rapids towards the next hole.
    approach: Vec<[ToolPlace; 2]>,
    places: Vec<ToolPlace>,
    /// Cuts that were read together.
    cuts: CutRun,
    /// Their tool axes, and where the great circle from each to the next ends.
    axes: Vec<Vector3<f64>>,
    circle_ends: Vec<Vector3<f64>>,
    ended: bool,
    /// Line of the item read last.
    line: u64,
    /// What cannot be understood.
    pub faults: Vec<Diagnostic>,
}

/// More elements are not kept.
pub(super) const MOST: usize = 60_000;

/// A program that may stand on more elements at a time is lost: each of its motions would be held against all of them.
pub(super) const MOST_AT_ONCE: usize = 10_000;

/// Pieces of one motion are held against so many elements in all: one that turns hundreds of times near many of them is lost.
pub(super) const MOST_HELD: usize = 10_000_000;

/// A program is lost whose motions go farther off so often: a loop of circles beside the path takes minutes else.
pub(super) const MOST_WIDENED: u32 = 20_000;

/// Commands of the spindle that are kept of a tool.
pub(super) const MOST_SPEEDS: usize = 64;

/// Rapids towards one hole that are kept.
const MOST_APPROACH: usize = 64;

/// Infinitely far.
const FAR: PlaceDistance = PlaceDistance { point: f64::INFINITY, axis: f64::INFINITY };

impl<C: Course> CourseTrack<C> {
    pub fn new(course: C, along: f64, sag: PlaceBound) -> Self {
        Self {
            course,
            along,
            sag,
            elements: VecDeque::new(),
            asked: Arc::default(),
            cycle: None,
            hole: None,
            approach: Vec::new(),
            places: Vec::new(),
            cuts: CutRun::default(),
            axes: Vec::new(),
            circle_ends: Vec::new(),
            ended: false,
            line: 0,
            faults: Vec::new(),
        }
    }

    /// The element at `index` of those that are kept; read if need be. None at the end, and where too many are kept.
    pub fn get(&mut self, index: usize) -> Option<&mut Element> {
        while self.elements.len() <= index {
            if self.ended || index >= MOST {
                return None;
            }
            self.read();
        }
        self.elements.get_mut(index)
    }

    /// The elements that are kept.
    pub fn kept(&self) -> &VecDeque<Element> {
        &self.elements
    }

    /// Drops the first.
    pub fn pop(&mut self) -> Option<Element> {
        self.elements.pop_front()
    }

    /// Line that was read last.
    pub fn line(&self) -> u64 {
        self.line
    }

    fn read(&mut self) {
        if self.course.next_cuts(&mut self.cuts) {
            return self.take_cuts();
        }
        match self.course.next() {
            Ok(Some(item)) => self.take(item),
            Ok(None) => {
                self.end_hole();
                self.ended = true;
            }
            Err(fault) => {
                if self.faults.len() < MOST_FAULTS {
                    self.faults.push(*fault);
                } else {
                    self.ended = true;
                }
            }
        }
    }

    /// Takes the cuts that were read together.
    fn take_cuts(&mut self) {
        self.end_hole();
        self.approach.clear();
        let cuts = std::mem::take(&mut self.cuts);
        let mut ends = std::mem::take(&mut self.circle_ends);
        self.axes.clear();
        self.axes.extend(cuts.poses.iter().map(|pose| pose.axis));
        circle_ends(&self.axes, &mut ends);
        for (place, (poses, end)) in cuts.poses.windows(2).zip(&ends).enumerate() {
            let poses = [&poses[0], &poses[1]];
            self.line = cuts.line(place);
            let from = ToolPlace::new(poses[0], self.along);
            match chop::straight_cut(poses, *end, self.along, &self.sag) {
                Some(to) => self.push(self.line, ElementKind::Cut, [from, to], cuts.feed),
                None => self.pieces(&cuts.piece(place), ElementKind::Cut, from),
            }
        }
        (self.cuts, self.circle_ends) = (cuts, ends);
    }

    fn take(&mut self, item: CourseItem) {
        match item {
            CourseItem::Piece(piece) => {
                self.line = piece.line;
                self.piece(&piece);
            }
            CourseItem::Reach(reach) => {
                self.line = reach.line;
                self.end_hole();
                if reach.hole {
                    return;
                }
                let to = ToolPlace::new(&reach.to, self.along);
                self.push(reach.line, ElementKind::Reach(reach.kind), [to, to], None);
            }
            CourseItem::Away { line } => {
                self.line = line;
                self.end_hole();
            }
            CourseItem::Event { line, event } => {
                self.line = line;
                self.take_event(line, event);
            }
        }
    }

    fn piece(&mut self, piece: &CoursePiece) {
        let from = ToolPlace::new(&piece.from, self.along);
        let to = ToolPlace::new(&piece.to, self.along);
        if piece.hole && self.of_hole(piece, from, to) {
            return;
        }
        self.end_hole();
        let what = match piece.kind {
            // Between holes a control goes its own ways; where their feed begins is looked at.
            MotionKind::Rapid if piece.hole => {
                if self.approach.len() < MOST_APPROACH {
                    self.approach.push([from, to]);
                }
                return;
            }
            MotionKind::Rapid => {
                self.push(piece.line, ElementKind::Way, [from, to], None);
                return;
            }
            MotionKind::Feed => ElementKind::Cut,
            MotionKind::Thread => ElementKind::Thread,
        };
        self.pieces(piece, what, from);
    }

    /// Takes the straight pieces of a cut, which begins at `from`.
    fn pieces(&mut self, piece: &CoursePiece, what: ElementKind, from: ToolPlace) {
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        chop::piece(piece, self.along, &self.sag, &mut places);
        let mut last = from;
        let count = places.len();
        for (index, place) in places.iter().enumerate() {
            self.push(piece.line, what.clone(), [last, *place], piece.feed);
            if let Some(element) = self.elements.back_mut() {
                element.turned_feed = piece.turned_feed;
                element.ends = index + 1 == count;
            }
            last = *place;
        }
        self.places = places;
    }

    /// Takes a piece of a hole; false if it belongs neither to the way down nor up.
    fn of_hole(&mut self, piece: &CoursePiece, from: ToolPlace, to: ToolPlace) -> bool {
        let down = piece.kind != MotionKind::Rapid;
        match &mut self.hole {
            None if down => {
                let cycle = self.cycle.unwrap_or_default();
                let later = match cycle.later_peck > 0.0 {
                    true => cycle.later_peck,
                    false => cycle.peck,
                };
                let pecks = [cycle.clearance + cycle.peck, later];
                let hole = CourseHole {
                    kind: cycle.kind,
                    pecks: (cycle.peck > 0.0).then_some(pecks),
                    dwell: None,
                    back: None,
                    out: None,
                    approach: std::mem::take(&mut self.approach),
                };
                self.hole = Some(Element {
                    line: piece.line,
                    what: ElementKind::Hole(Box::new(hole)),
                    from,
                    to,
                    asked: Arc::clone(&self.asked),
                    feed: piece.feed,
                    turned_feed: None,
                    ends: true,
                    near: FAR,
                });
                true
            }
            None => false,
            Some(element) => {
                // Up again; whatever else a control does at the bottom is its business.
                let up = (to.point - element.from.point).norm() <= self.sag.point * 32.0;
                match &mut element.what {
                    ElementKind::Hole(hole) if hole.back.is_none() => {
                        if up {
                            (hole.back, hole.out) = (Some(piece.kind), piece.feed);
                        }
                        true
                    }
                    _ => false,
                }
            }
        }
    }

    fn end_hole(&mut self) {
        if let Some(hole) = self.hole.take() {
            self.elements.push_back(hole);
        }
    }

    /// Takes an element. Of cuts on one and the same place the first stands for all, however many a CL file has there.
    fn push(&mut self, line: u64, what: ElementKind, ends: [ToolPlace; 2], feed: Option<f64>) {
        self.approach.clear();
        if ends[0] == ends[1]
            && let ElementKind::Cut = what
            && self.elements.back().is_some_and(|last| self.lingers(last, &ends[1], feed))
        {
            return;
        }
        self.elements.push_back(Element {
            line,
            what,
            from: ends[0],
            to: ends[1],
            asked: Arc::clone(&self.asked),
            feed,
            turned_feed: None,
            ends: true,
            near: FAR,
        });
    }

    /// Whether `last` is a cut that stands at `place` with all that is asked for now.
    fn lingers(&self, last: &Element, place: &ToolPlace, feed: Option<f64>) -> bool {
        matches!(last.what, ElementKind::Cut)
            && last.ends
            && [last.from, last.to] == [*place; 2]
            && last.feed == feed
            && Arc::ptr_eq(&last.asked, &self.asked)
    }

    fn take_event(&mut self, line: u64, event: ProgramEvent) {
        match event {
            ProgramEvent::ToolChange { number, .. } => {
                self.end_hole();
                let asked = Arc::make_mut(&mut self.asked);
                asked.tool = number;
                asked.at_change = (asked.spindle, asked.coolants);
                asked.turned.clear();
            }
            ProgramEvent::Spindle(spindle) => {
                let asked = Arc::make_mut(&mut self.asked);
                asked.spindle = spindle;
                if asked.turned.len() < MOST_SPEEDS {
                    asked.turned.push(spindle);
                }
            }
            ProgramEvent::Coolant(coolants) => Arc::make_mut(&mut self.asked).coolants = coolants,
            ProgramEvent::Compensation { side, register } => {
                let asked = Arc::make_mut(&mut self.asked);
                (asked.side, asked.register) = (side, register);
            }
            ProgramEvent::WorkOffset(name) => {
                Arc::make_mut(&mut self.asked).work_offset = name.parse().ok();
            }
            ProgramEvent::Cycle(call) => {
                self.end_hole();
                self.cycle = Some(call);
            }
            ProgramEvent::CycleEnd => {
                self.end_hole();
                self.cycle = None;
            }
            ProgramEvent::Dwell { .. } if self.hole.is_some() => {
                if let Some(Element { what: ElementKind::Hole(hole), .. }) = &mut self.hole {
                    hole.dwell = Some(event);
                }
            }
            ProgramEvent::Dwell { .. }
            | ProgramEvent::Stop
            | ProgramEvent::OptionalStop
            | ProgramEvent::Sync(_) => {
                self.end_hole();
                let at = self.elements.back().map_or_else(ToolPlace::default, |last| last.to);
                self.push(line, ElementKind::Event(event, false), [at, at], None);
            }
            _ => {}
        }
    }
}

impl Element {
    pub fn is_cut(&self) -> bool {
        matches!(self.what, ElementKind::Cut | ElementKind::Thread)
    }
}
