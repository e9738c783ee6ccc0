//! Holes of cycles: down the axis at feed to the bottom, and out again, in no larger pecks than asked for.

use nalgebra::Vector3;
use post_machine::kinematics::orientation::on_two_faces;

use super::Verifier;
use super::place::{PlaceBound, PlaceDistance, ToolPlace};
use super::report::BlockPlace;
use super::state;
use super::track::{CourseHole, Element, ElementKind};
use crate::course::Course;
use crate::{CycleKind, Motion, MotionKind, ProgramEvent, SpindleState};

/// A hole in the making.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoleRun {
    /// Number of the hole's element.
    pub index: usize,
    /// How far below the level where its feed begins something was cut, mm.
    deepest: f64,
    /// Where the tool stands on its axis, mm, down positive.
    at: f64,
    /// The bottom was reached.
    bottom: bool,
    dwelt: bool,
    stroke: HoleDescent,
    /// How far it is off its axis as a whole, mm: told once.
    shift: Vector3<f64>,
}

/// One way down in a hole.
#[derive(Clone, Copy, Debug, Default)]
struct HoleDescent {
    /// Others went before it.
    later: bool,
    /// How far the hole was cut when it began, mm.
    from: f64,
    /// How far up the tool went since the last cut, mm below the level where the feed begins.
    highest: f64,
    /// What is wrong with pecks was told.
    told: bool,
}

/// A hole that was made, as long as nothing else is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct DrilledHole {
    axis: HoleAxis,
    deepest: f64,
    /// How the spindle has turned in it.
    spindle: SpindleState,
    /// A cycle was called since.
    pub again: bool,
    /// A hole of a cycle that was made twice is told once.
    cycle: bool,
}

/// Where a rapid in a hole is off its axis.
#[derive(Clone, Copy, Debug, Default)]
struct HoleStray {
    off: PlaceDistance,
    /// How far below the level where the feed begins, mm; zero: nowhere.
    depth: f64,
}

impl HoleStray {
    /// The one whose tip is farther off.
    fn larger(self, other: Self) -> Self {
        match other.depth > 0.0 && (self.depth <= 0.0 || other.off.point > self.off.point) {
            true => other,
            false => self,
        }
    }
}

/// The axis of a hole, from the level where the feed begins.
#[derive(Clone, Copy, Debug)]
struct HoleAxis {
    top: ToolPlace,
    down: Vector3<f64>,
    depth: f64,
}

impl HoleAxis {
    fn of(element: &Element) -> Self {
        let way = element.to.point - element.from.point;
        let depth = way.norm();
        let down = match depth > 0.0 {
            true => way / depth,
            false => -element.from.axis,
        };
        Self { top: element.from, down, depth }
    }

    /// How far down a place is, mm, and how far it is off.
    fn split(&self, place: &ToolPlace) -> (f64, PlaceDistance) {
        let offset = place.point - self.top.point;
        let depth = offset.dot(&self.down);
        let apart = PlaceDistance {
            point: (offset - self.down * depth).norm(),
            axis: place.apart(&self.top).axis,
        };
        (depth, apart)
    }

    fn too_deep(&self, to: f64) -> String {
        format!(
            "a hole is {:.3} mm too deep: {:.3} mm below where its feed begins, and the CL file asks for {:.3} mm",
            to - self.depth,
            to,
            self.depth
        )
    }
}

impl HoleRun {
    /// Whether the cycle itself goes off the axis at its bottom.
    fn shifts(&self, asked: &CourseHole, motion: &Motion) -> bool {
        motion.hole
            && self.bottom
            && matches!(asked.kind, CycleKind::BoreFine | CycleKind::BoreBack)
    }

    /// What is wrong with a rapid between two depths, mm below the level where the feed begins, and by how much.
    fn rapid_fault(
        &self,
        asked: &CourseHole,
        [from, to]: [f64; 2],
        on_axis: bool,
        bound: f64,
    ) -> Option<(String, Option<f64>)> {
        if to > self.deepest + bound && on_axis {
            let message = format!(
                "a rapid goes {:.3} mm into a hole that is cut {:.3} mm deep",
                to, self.deepest
            );
            return Some((message, Some(to - self.deepest)));
        }
        let at_feed = matches!(asked.back, Some(MotionKind::Feed | MotionKind::Thread));
        let leaves = to < from && self.bottom && from > bound && at_feed;
        leaves.then(|| {
            ("a hole is left at rapid, and the CL file asks for the feed".to_owned(), None)
        })
    }

    /// What is wrong with going down to `to` at feed, if no peck goes so far, or comes out before the next: told once a
    /// hole.
    fn too_long(&mut self, asked: &CourseHole, to: f64, bound: f64) -> Option<String> {
        let [first, later] = asked.pecks?;
        if to <= self.deepest {
            return None;
        }
        // Up since the last cut: another stroke begins.
        let up = self.stroke.highest < self.deepest - bound && self.deepest > 0.0;
        let in_it = up && self.stroke.highest > bound;
        if up {
            self.stroke.later = true;
            self.stroke.from = self.deepest;
        }
        self.stroke.highest = f64::INFINITY;
        let most = if self.stroke.later { later } else { first };
        let cut = to - self.stroke.from;
        let message = if cut > most + bound {
            format!(
                "{cut:.3} mm of a hole are cut in one go, and the CL file asks for pecks of {most:.3} mm"
            )
        } else if in_it && asked.kind == CycleKind::Deep {
            "the tool stays in a hole between its pecks, and the CL file asks to come out"
                .to_owned()
        } else {
            return None;
        };
        (!std::mem::replace(&mut self.stroke.told, true)).then_some(message)
    }
}

impl<C: Course> Verifier<'_, C> {
    /// The hole that is due begins with this motion, if it goes down its axis.
    pub(super) fn begins_hole(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let Some(index) = self.next else {
            return false;
        };
        let bound = self.bound;
        let Some(element) = self.track.get(index) else {
            return false;
        };
        if !matches!(element.what, ElementKind::Hole(_)) {
            return false;
        }
        let axis = HoleAxis::of(element);
        let cl_line = element.line;
        let (from, off) = axis.split(&places[0]);
        let (to, _) = axis.split(&places[places.len() - 1]);
        // Off its axis it is a hole in the wrong place, if it is one.
        let near = off.point <= bound.point.max(0.5 * axis.depth).max(1.0);
        // Drawn back off another face, the tool may go towards the hole, its holder ahead.
        let faces = !on_two_faces(&places[0].axis, &axis.top.axis);
        if to <= from || !near || !faces {
            return false;
        }
        // A last peck of less than the tolerance, in the hole before: the bottom of that was reached without it.
        if off.point > bound.point && self.goes_into_made(motion, places) {
            return false;
        }
        let mut shift = Vector3::zeros();
        if off.point > bound.point {
            let offset = places[0].point - axis.top.point;
            shift = offset - axis.down * offset.dot(&axis.down);
            let message = format!("a hole is {:.3} mm off its place", off.point);
            self.fault("deviation", message, Some(motion), Some(cl_line), Some(off.point));
        }
        if from > bound.point {
            let message =
                format!("a rapid goes {from:.3} mm below where the feed of a hole begins");
            self.fault("hole", message, Some(motion), Some(cl_line), Some(from));
        }
        if self.rules.own && from < -bound.point {
            let by = -from;
            let message =
                format!("the feed of a hole begins {by:.3} mm above where the CL file has it");
            self.fault("hole", message, Some(motion), Some(cl_line), Some(by));
        }
        self.compare_cycle(motion, index);
        self.miss_events(Some(BlockPlace::of(motion)), index);
        self.look_for_detours(Some(motion));
        self.made = None;
        self.hole = Some(HoleRun {
            index,
            deepest: from.max(0.0),
            at: from,
            bottom: false,
            dwelt: false,
            stroke: HoleDescent::default(),
            shift,
        });
        true
    }

    /// A thread is no hole that is drilled, and back in the other sense; what else tells kinds of holes apart is seen
    /// by how the tool moves.
    fn compare_cycle(&mut self, motion: &Motion, index: usize) {
        use CycleKind::{BoreBack, Tap, TapLeft};
        let (Some(done), true) = (self.cycle, motion.hole) else {
            return;
        };
        let Some(element) = self.track.get(index) else {
            return;
        };
        let ElementKind::Hole(hole) = &element.what else {
            return;
        };
        let class = |kind: CycleKind| match kind {
            Tap | TapLeft | BoreBack => Some(kind),
            _ => None,
        };
        if class(done) != class(hole.kind) {
            let (line, asked) = (element.line, hole.kind);
            let message =
                format!("a hole of the kind {done:?}, and the CL file asks for the kind {asked:?}");
            self.fault("hole", message, Some(motion), Some(line), None);
        }
    }

    /// A motion while a hole is made.
    pub(super) fn hole_motion(&mut self, motion: &Motion, places: &[ToolPlace]) {
        let Some(mut run) = self.hole else {
            return;
        };
        let Some(element) = self.track.get(run.index).map(|element| element.clone()) else {
            self.hole = None;
            return;
        };
        let ElementKind::Hole(asked) = &element.what else {
            self.hole = None;
            return;
        };
        let mut axis = HoleAxis::of(&element);
        axis.top.point += run.shift;
        let bound = self.bound;
        let cl_line = Some(element.line);
        let (end, _) = axis.split(&places[places.len() - 1]);
        let rapid = motion.kind == MotionKind::Rapid
            || end <= run.deepest.max(run.at) && self.is_as_fast_as_rapids(motion);
        if !rapid {
            self.set_kind("hole");
        }
        self.block.cl_line = cl_line;
        let mut worst = PlaceDistance::default();
        let mut strays = HoleStray::default();
        let mut down = false;
        for ends in places.windows(2) {
            let ((from, _), (to, off)) = (axis.split(&ends[0]), axis.split(&ends[1]));
            let on_axis = off.is_within(&bound);
            if rapid {
                let depth = from.max(to);
                if !on_axis && depth > bound.point {
                    if !run.shifts(asked, motion) {
                        strays = strays.larger(HoleStray { off, depth });
                    }
                } else if let Some((message, by)) =
                    run.rapid_fault(asked, [from, to], on_axis, bound.point)
                {
                    self.fault("hole", message, Some(motion), cl_line, by);
                }
            } else {
                down |= to > from;
                if let Some(message) = run.too_long(asked, to, bound.point) {
                    self.fault("hole", message, Some(motion), cl_line, None);
                }
                worst = worst.larger(&off);
                if to > axis.depth + bound.point {
                    let message = axis.too_deep(to);
                    self.fault("hole", message, Some(motion), cl_line, Some(to - axis.depth));
                }
                run.deepest = run.deepest.max(to);
                run.bottom |= run.deepest >= axis.depth - bound.point;
            }
            if to < from {
                run.stroke.highest = run.stroke.highest.min(to);
            }
            run.at = to;
        }
        self.tell_stray(motion, &strays, element.line);
        if !rapid {
            self.compare_hole(motion, &element, worst);
            if down {
                self.compare_with(motion, &element);
                self.compare_feed(motion, places, &at_the_speed_of(motion, &element));
            } else if run.bottom && asked.back == Some(MotionKind::Feed) {
                let out = Element { feed: asked.out, ..element.clone() };
                self.compare_feed(motion, places, &out);
            }
        }
        self.hole = Some(run);
        let above = run.at <= bound.point;
        // Out of it, or elsewhere.
        if above && (run.bottom || rapid && self.goes_elsewhere(&axis, places)) {
            self.made = run.bottom.then_some(DrilledHole {
                axis,
                deepest: run.deepest,
                spindle: motion.state.spindle,
                again: false,
                cycle: motion.hole,
            });
            self.end_hole(motion, run, &element, axis.depth);
            if rapid {
                self.pass(motion, places);
            }
        }
    }

    /// Tells where a rapid in a hole is off its axis.
    fn tell_stray(&mut self, motion: &Motion, stray: &HoleStray, cl_line: u64) {
        let HoleStray { off, depth } = stray;
        if *depth <= 0.0 {
            return;
        }
        let (by, leans) = (off.point, off.axis.to_degrees());
        let key = "a rapid leaves the axis of a hole".to_owned();
        let message = format!(
            "{key}: by {by:.3} mm and {leans:.3}° where it is {depth:.3} mm below the level where the feed begins"
        );
        self.limit_fault("hole", key, message, motion, cl_line, by);
    }

    /// Compares how far a cut in a hole is off its axis.
    fn compare_hole(&mut self, motion: &Motion, element: &Element, worst: PlaceDistance) {
        let bound = self.bound;
        if !worst.is_within(&bound) {
            let message = format!(
                "a hole is {:.3} mm or {:.3}° off its axis",
                worst.point,
                worst.axis.to_degrees()
            );
            self.fault("deviation", message, Some(motion), Some(element.line), Some(worst.point));
        } else {
            self.note_deviation(worst, motion.line, element.line);
        }
    }

    /// Whether a motion goes into the hole that was made last, and no deeper than that may be.
    pub(super) fn goes_into_made(&self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let Some(made) = self.made else {
            return false;
        };
        let (axis, bound) = (made.axis, self.bound);
        let most = match motion.kind {
            MotionKind::Rapid => made.deepest,
            _ => axis.depth,
        };
        let in_it = places.iter().all(|place| {
            let (depth, off) = axis.split(place);
            off.point <= bound.point && off.axis <= bound.axis && depth <= most + bound.point
        });
        // Out of it other points may be due.
        in_it && axis.split(&places[places.len() - 1]).0 > bound.point
    }

    /// A further peck in the hole that was made last: one before may have come to the bottom within the tolerance.
    /// False if the motion is no peck.
    pub(super) fn pecks_again(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let Some(made) = self.made.filter(|_| self.goes_into_made(motion, places)) else {
            return false;
        };
        let has = motion.state.spindle;
        let cuts = motion.kind != MotionKind::Rapid;
        if cuts && !state::same_spindle(has, made.spindle) {
            let message = format!(
                "the spindle {} in a hole that was made, and as it was made it {}",
                state::spindle_name(has),
                state::spindle_name(made.spindle)
            );
            self.fault("spindle", message, Some(motion), None, None);
        }
        if cuts && made.again && made.cycle && motion.hole {
            let message = "a hole is made once more, and the CL file asks for it once".to_owned();
            self.fault("hole", message, Some(motion), None, None);
            if let Some(made) = &mut self.made {
                made.again = false;
            }
        }
        self.set_kind(if cuts { "hole" } else { "rapid" });
        true
    }

    /// The next hole that is due has another axis than the one that was made last, of the same face of the part: the course
    /// itself goes straight there, and what it passes is not kept.
    pub(super) fn turns_between_holes(&mut self) -> bool {
        let (Some(made), Some(index)) = (self.made, self.next) else {
            return false;
        };
        let due = self.track.get(index);
        due.is_some_and(|element| {
            let (before, then) = (made.axis.top.axis, element.from.axis);
            matches!(element.what, ElementKind::Hole(_))
                && then != before
                && !on_two_faces(&before, &then)
        })
    }

    fn goes_elsewhere(&self, axis: &HoleAxis, places: &[ToolPlace]) -> bool {
        let (_, off) = axis.split(&places[places.len() - 1]);
        off.point > self.rapid_bound.point
    }

    fn end_hole(&mut self, motion: &Motion, run: HoleRun, element: &Element, depth: f64) {
        self.hole = None;
        self.next = Some(run.index + 1);
        self.apart = true;
        self.reach.iter_mut().for_each(|span| *span = super::place::ShareSpan::EMPTY);
        let cl_line = Some(element.line);
        if !run.bottom {
            let message = format!(
                "a hole is {:.3} mm deep, counted from where its feed begins, and the CL file asks for {depth:.3} mm",
                run.deepest
            );
            self.fault("hole", message, Some(motion), cl_line, Some(depth - run.deepest));
            return;
        }
        self.found.holes += 1;
        let off = PlaceDistance { point: libm::fabs(depth - run.deepest), axis: 0.0 };
        self.note_deviation(off, motion.line, element.line);
        if let ElementKind::Hole(hole) = &element.what
            && let Some(dwell) = &hole.dwell
            && !run.dwelt
        {
            let message =
                format!("{} at the bottom of a hole is left out", state::event_name(dwell));
            self.fault("event", message, Some(motion), cl_line, None);
        }
    }

    /// The program waits in a hole. False if it is in none.
    pub(super) fn hole_dwell(&mut self, event: &ProgramEvent) -> bool {
        let (Some(run), ProgramEvent::Dwell { .. }) = (self.hole, event) else {
            return false;
        };
        let Some(element) = self.track.get(run.index) else {
            return false;
        };
        let ElementKind::Hole(hole) = &element.what else {
            return false;
        };
        let same = hole
            .dwell
            .as_ref()
            .is_some_and(|asked| state::same_event(asked, event, element.asked.spindle));
        let wrong = match &hole.dwell {
            None if run.bottom
                && !matches!(event, ProgramEvent::Dwell { time, .. } if *time <= 0.0) =>
            {
                Some(format!(
                    "{} at the bottom of a hole that the CL file does not ask for",
                    state::event_name(event)
                ))
            }
            Some(asked) if run.bottom && !same => Some(format!(
                "{} at the bottom of a hole in place of {}",
                state::event_name(event),
                state::event_name(asked)
            )),
            _ => None,
        };
        let line = element.line;
        if let Some(run) = &mut self.hole
            && run.bottom
        {
            run.dwelt = true;
        }
        if let Some(message) = wrong {
            let place = Some(BlockPlace { line: self.block.nc_line, number: self.block.block });
            self.fault_at("event", message, place, Some(line), None);
        }
        true
    }
}

/// How far a place on the axis of a hole is below the level where its feed begins, mm; zero beside that axis.
pub(super) fn below_mouth(hole: &Element, place: &ToolPlace, bound: &PlaceBound) -> f64 {
    let (depth, off) = HoleAxis::of(hole).split(place);
    if off.is_within(bound) { depth.max(0.0) } else { 0.0 }
}

/// Whether a motion goes down the axis of a hole.
pub(super) fn goes_down(hole: &Element, places: &[ToolPlace]) -> bool {
    let axis = HoleAxis::of(hole);
    axis.split(&places[places.len() - 1]).0 > axis.split(&places[0]).0
}

/// What is asked of a hole, a thread's feed by the speed that is printed: its pitch counts, and S has no decimals.
fn at_the_speed_of(motion: &Motion, element: &Element) -> Element {
    let mut element = element.clone();
    let speeds = (motion.state.spindle.rpm(), element.asked.spindle.rpm());
    if let (ElementKind::Hole(hole), (Some(printed), Some(asked))) = (&element.what, speeds)
        && matches!(hole.kind, CycleKind::Tap | CycleKind::TapLeft)
        && asked > 0.0
    {
        element.feed = element.feed.map(|feed| feed * printed / asked);
    }
    element
}
