//! Cuts: one motion of the program along the course, never back (Alt and Godau 1995, swept motion by motion).
//!
//! A piece of the program against a piece of the course is a cell; where the two are within the bound is convex in it,
//! so that what can be reached on its far sides follows from what can be reached on its near ones. Kept is the side at
//! which the program stands now: one span for each element of the course.
//!
//! A motion that finds no way strays. Then the bound is widened until there is one, which says how far the program is
//! off, and it stays wide until the program is back on the course.

use super::hole::goes_down;
use super::place::{PlaceBound, PlaceDistance, ShareSpan, ToolPlace, free, nearest};
use super::report::{BlockPlace, lines_of};
use super::track::{ElementKind, MOST_AT_ONCE, MOST_HELD, MOST_WIDENED};
use super::{COMPUTED, Verifier, state};
use crate::course::Course;
use crate::{Motion, MotionKind};

/// A stretch of the program that is off the course.
#[derive(Clone, Copy, Debug)]
pub(super) struct StrayStretch {
    /// Factor of the tolerance that the bound is.
    pub factor: f64,
    pub line: u64,
    pub number: Option<u64>,
    pub last: u64,
    /// Lines of the course, from and to.
    pub asked: [u64; 2],
    /// How far its ends are off at least.
    pub worst: PlaceDistance,
}

/// Share of the tolerance by which an element must be nearer to count in place of one before it.
const LEADS_ON: f64 = 0.25;

/// A bound so wide that nothing is told apart by it.
const WIDEST: f64 = 1e8;

/// Steps in which it is found how far a motion is off: to a part in a thousand of twice as far.
const STEPS: usize = 9;

/// How a sweep ended.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SweepOutcome {
    /// The whole motion has a place on the course.
    Through,
    /// The motion has no place, and one reason is that this element was in the way.
    Stopped(usize),
    /// The motion has no place.
    Nowhere,
    /// The motion has more places than are held against it.
    Lost,
}

/// What of a free side of a cell can be reached: all of it where the side `across` it is entered; else, from the one that
/// it faces, what lies no further back than where that one is entered.
fn reached(side: ShareSpan, across: ShareSpan, facing: ShareSpan) -> ShareSpan {
    match across.is_empty() {
        false => side,
        true => side.meet(&ShareSpan { from: facing.from, to: 1.0 }),
    }
}

impl<C: Course> Verifier<'_, C> {
    /// A motion at feed.
    pub(super) fn feed(&mut self, motion: &Motion, places: &[ToolPlace]) {
        if self.hole.is_some() {
            return self.hole_motion(motion, places);
        }
        self.come_back_to_the_course(&places[0]);
        let fast = self.is_as_fast_as_rapids(motion);
        if fast && !self.apart && self.next.is_none() {
            // A rapid after the cut, not the cut's way back.
            self.leave_cut();
            if self.follows_a_rapid(motion, places) {
                return;
            }
            self.next = None;
        }
        if self.apart {
            self.stands_at_a_first_point(motion, places[0]);
            if self.is_no_cut(motion, places, fast) {
                return;
            }
            self.begin_cut(motion, &places[0]);
        }
        self.cut_end = places.last().copied();
        self.cut(motion, places);
    }

    /// Whether a motion at feed between two cuts is something else than the next cut: a hole, a way to it, a rapid of
    /// the course, a peck. It is then dealt with.
    fn is_no_cut(&mut self, motion: &Motion, places: &[ToolPlace], fast: bool) -> bool {
        // Where a hole is due, a feed motion is its business unless the tool is elsewhere.
        if !fast && self.hole_is_due() && self.begins_hole(motion, places) {
            self.hole_motion(motion, places);
            return true;
        }
        if self.reaches_at_feed(motion, places) || self.follows_a_rapid(motion, places) {
            return true;
        }
        if fast && (stands(places) || motion.along == Some(false) && self.keeps_still(places)) {
            // The part turns about the tool: no cut, though the next may begin here. What an extruder does not go with is
            // none either, as long as the nozzle stays within the tolerance of beads.
            self.found.rapids_at_feed += 1;
            self.set_kind("rapid");
            return true;
        }
        let hole = self.hole_is_due();
        let into_hole = hole && self.due().is_some_and(|due| goes_down(due, places));
        // What is due goes first; a hole is drilled by what goes down, and stays due else.
        if self.may_go_on(&places[0]) || (!hole || into_hole) && self.may_be_first(&places[0]) {
            return false;
        }
        if hole && stands(places) {
            self.set_kind("rapid");
            return true;
        }
        if self.pecks_again(motion, places) {
            return true;
        }
        let down = self.comes_down(places);
        if down {
            self.look_how_it_comes_back(motion, &places[places.len() - 1]);
        }
        if draws_back(places, &self.rapid_bound) || down || turns(places, self.rapid_bound.point) {
            self.set_kind("rapid");
            return true;
        }
        if fast {
            self.found.rapids_at_feed += 1;
            self.set_kind("rapid");
            self.rapid(motion, places);
        }
        fast
    }

    /// The tip stays where it is, as cuts do.
    fn keeps_still(&self, places: &[ToolPlace]) -> bool {
        places.iter().all(|place| (place.point - places[0].point).norm() <= self.bound.point)
    }

    /// A cut: it has a place on the course, or is a fault.
    fn cut(&mut self, motion: &Motion, places: &[ToolPlace]) {
        self.next = None;
        self.set_kind("cut");
        self.goes_along(motion, true);
        let mut begun = std::mem::take(&mut self.begun);
        begun.clone_from(&self.reach);
        if self.keeps_to_the_course(motion, places, &begun) {
            self.found.cuts += 1;
            self.compare(motion, places);
            self.look_where_the_edge_points(motion, places, &begun);
        }
        self.begun = begun;
    }

    /// Whether a cut that began where `begun` says has a place on the course, however wide; else it was dealt with.
    fn keeps_to_the_course(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        begun: &[ShareSpan],
    ) -> bool {
        let go_back = |reach: &mut Vec<ShareSpan>| {
            reach.clear();
            reach.extend_from_slice(begun);
        };
        loop {
            let swept = self.sweep(motion, places, self.factor(), true);
            match swept {
                SweepOutcome::Through => return true,
                SweepOutcome::Stopped(index) => {
                    go_back(&mut self.reach);
                    if self.remove_obstacle(index, motion, places) {
                        if self.hole.is_some() || self.apart {
                            return false;
                        }
                        continue;
                    }
                }
                SweepOutcome::Nowhere => go_back(&mut self.reach),
                SweepOutcome::Lost => {
                    self.lose_the_place(
                        motion,
                        &format!("more than {MOST_AT_ONCE} pieces of the CL path lie within the tolerance of one point, or more than {MOST_HELD} pairs of a piece of it and one of this motion"),
                    );
                    return false;
                }
            }
            if draws_back(places, &self.bound) {
                go_back(&mut self.reach);
                self.leave_cut();
                self.apart = true;
                self.set_kind("rapid");
                return false;
            }
            self.widened += 1;
            if self.widened > MOST_WIDENED {
                let why = format!(
                    "{MOST_WIDENED} motions of it went farther off the CL path than those before them"
                );
                self.lose_the_place(motion, &why);
                return false;
            }
            if !self.widen(motion, places, begun) {
                go_back(&mut self.reach);
                self.fault(
                    "added",
                    "a motion at feed that the CL file does not ask for".to_owned(),
                    Some(motion),
                    None,
                    None,
                );
                return false;
            }
            return true;
        }
    }

    /// Nobody can say any more where on the course the program stands: nothing of it is looked at further.
    fn lose_the_place(&mut self, motion: &Motion, why: &str) {
        let message = format!("verify has lost the program's place: {why}");
        let cl_line = self.stands_at();
        self.fault("lost", message, Some(motion), Some(cl_line), None);
        self.found.gave_up = true;
    }

    fn factor(&self) -> f64 {
        self.stray.map_or(1.0, |stray| stray.factor)
    }

    /// Ends a stretch that was off, where the program is within the tolerance again.
    pub(super) fn come_back_to_the_course(&mut self, place: &ToolPlace) {
        if self.stray.is_none() {
            return;
        }
        let bound = self.bound;
        let kept = self.track.kept();
        let narrowed: Vec<ShareSpan> = self
            .reach
            .iter()
            .zip(kept)
            .map(|(span, element)| match span.is_empty() || !element.is_cut() {
                true => ShareSpan::EMPTY,
                false => span.meet(&free(place, &element.from, &element.to, &bound)),
            })
            .collect();
        if narrowed.iter().any(|span| !span.is_empty()) {
            self.reach = narrowed;
            self.flush_stray();
        }
    }

    /// Tells of a stretch that was off.
    pub(super) fn flush_stray(&mut self) {
        let Some(stray) = self.stray.take() else {
            return;
        };
        // That wide it was found to be near enough; which of the two asked for it the ends of its motions say.
        let bound = self.bound.times(stray.factor);
        let (point, angle) = (bound.point, bound.axis.min(2.0));
        let angle = (2.0 * libm::asin(0.5 * angle)).to_degrees();
        let [tip_off, axis_off] = [
            stray.worst.point > self.bound.point,
            PlaceBound::new(1.0, stray.worst.axis).axis > self.bound.axis,
        ];
        let off = match (tip_off, axis_off) {
            (true, false) => format!("{point:.3} mm"),
            (false, true) => format!("{angle:.3}°"),
            _ => format!("{point:.3} mm or {angle:.3}°"),
        };
        if tip_off || !axis_off {
            self.found.tip.take(point, stray.line, stray.asked[0]);
        }
        if axis_off || !tip_off {
            self.found.axis.take(angle, stray.line, stray.asked[0]);
        }
        let lines = |from: u64, to: u64| match from == to {
            true => format!("line {from}"),
            false => format!("lines {from} to {to}"),
        };
        let asked = match self.rules.files.is_joined() {
            true => lines_of(&self.rules.files, stray.asked),
            false => format!("{} of the CL file", lines(stray.asked[0], stray.asked[1])),
        };
        let message = format!(
            "off the CL path by {off} in {} of the program, {asked}; allowed are {} mm and {:.3}°",
            lines(stray.line, stray.last),
            self.rules.tolerance,
            self.rules.axis_tolerance.to_degrees(),
        );
        self.fault_at(
            "deviation",
            message,
            Some(BlockPlace { line: stray.line, number: stray.number }),
            Some(stray.asked[0]),
            Some(point),
        );
    }

    /// Carries what can be reached along a motion.
    fn sweep(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        factor: f64,
        measured: bool,
    ) -> SweepOutcome {
        let mut reach = std::mem::take(&mut self.reach);
        let mut spare = std::mem::take(&mut self.spare);
        let bound = self.bound.times(factor);
        let mut worst = PlaceDistance::default();
        let mut asked = 0;
        let mut swept = SweepOutcome::Through;
        // Pieces of the program held against elements.
        let mut held = 0;
        for ends in places.windows(2) {
            spare.clear();
            let column = self.column(&ends[0], &ends[1], bound, &reach, &mut spare);
            std::mem::swap(&mut reach, &mut spare);
            held += column.held;
            if held > MOST_HELD || column.cut_short && self.stray.is_none() && measured {
                swept = SweepOutcome::Lost;
                break;
            }
            let Some((apart, line)) = column.here else {
                swept = column.stopped.map_or(SweepOutcome::Nowhere, SweepOutcome::Stopped);
                break;
            };
            (worst, asked) = (worst.larger(&apart), line);
        }
        (self.reach, self.spare) = (reach, spare);
        if measured && swept == SweepOutcome::Through {
            self.block.cl_line = Some(asked);
            match &mut self.stray {
                None => self.note_deviation(worst, motion.line, asked),
                Some(stray) => {
                    stray.worst = stray.worst.larger(&worst);
                    stray.last = motion.line;
                    stray.asked[1] = stray.asked[1].max(asked);
                    let angle = worst.axis.to_degrees();
                    self.block.tip_deviation_mm = self.block.tip_deviation_mm.max(worst.point);
                    self.block.axis_deviation_deg = self.block.axis_deviation_deg.max(angle);
                }
            }
        }
        swept
    }

    /// One straight piece of the program against the course.
    fn column(
        &mut self,
        from: &ToolPlace,
        to: &ToolPlace,
        bound: PlaceBound,
        reach: &[ShareSpan],
        out: &mut Vec<ShareSpan>,
    ) -> PieceOutcome {
        let mut column = PieceOutcome::default();
        let mut apart: Option<PlaceDistance> = None;
        // The element that the piece leads to, and how far its end is from it.
        let (mut line, mut off) = (0, f64::INFINITY);
        // What can be reached of the program's piece at the beginning of the element.
        let mut below = ShareSpan::EMPTY;
        let mut index = 0;
        while index < reach.len() || !below.is_empty() {
            let left = reach.get(index).copied().unwrap_or(ShareSpan::EMPTY);
            if left.is_empty() && below.is_empty() {
                out.push(ShareSpan::EMPTY);
                index += 1;
                continue;
            }
            if column.held == MOST_AT_ONCE {
                column.cut_short = true;
                break;
            }
            column.held += 1;
            let Some(element) = self.track.get(index) else {
                break;
            };
            match &element.what {
                ElementKind::Cut | ElementKind::Thread => {}
                // It was met: nothing of the way.
                ElementKind::Event(_, true) => {
                    out.push(ShareSpan::EMPTY);
                    index += 1;
                    continue;
                }
                ElementKind::Event(_, false)
                | ElementKind::Hole(_)
                | ElementKind::Reach(_)
                | ElementKind::Way => {
                    column.stopped = Some(index);
                    out.push(ShareSpan::EMPTY);
                    below = ShareSpan::EMPTY;
                    index += 1;
                    continue;
                }
            }
            if left.from <= 0.0 {
                let edge = free(&element.from, from, to, &bound);
                if edge.from <= 0.0 && !edge.is_empty() {
                    below = match below.is_empty() {
                        true => edge,
                        false => ShareSpan { from: 0.0, to: edge.to },
                    };
                }
            }
            let right = free(to, &element.from, &element.to, &bound);
            let right = reached(right, below, left);
            let top = free(&element.to, from, to, &bound);
            let top = reached(top, left, below);
            if !right.is_empty() {
                let near = nearest(to, &element.from, &element.to, &right);
                // A place where two meet is the end of the first, whatever the words round off.
                if near.point < off - LEADS_ON * self.bound.point {
                    (line, off) = (element.line, near.point);
                }
                apart = Some(apart.map_or(near, |best| best.smaller(&near)));
            }
            if !top.is_empty() {
                element.near = element.near.smaller(&nearest(&element.to, from, to, &top));
            }
            out.push(right);
            below = top;
            index += 1;
        }
        column.here = apart.map(|apart| (apart, line));
        column
    }

    /// Widens the bound until the motion has a place on the course; false if none is wide enough.
    fn widen(&mut self, motion: &Motion, places: &[ToolPlace], begun: &[ShareSpan]) -> bool {
        let mut low = self.factor();
        let mut high = low;
        let mut thin = Vec::new();
        loop {
            (low, high) = (high, high * 2.0);
            if high > WIDEST {
                return false;
            }
            if self.has_place(motion, places, begun, high, &mut thin) {
                break;
            }
        }
        for _ in 0..STEPS {
            let middle = 0.5 * (low + high);
            match self.has_place(motion, places, begun, middle, &mut thin) {
                true => high = middle,
                false => low = middle,
            }
        }
        thinned(places, high, &mut thin);
        self.begin_from(begun, &places[0], high);
        let asked = self.stands_at();
        let stray = self.stray.get_or_insert(StrayStretch {
            factor: high,
            line: motion.line,
            number: motion.number,
            last: motion.line,
            asked: [asked, asked],
            worst: PlaceDistance::default(),
        });
        stray.factor = high;
        self.sweep(motion, &thin, high, true);
        true
    }

    /// Whether the motion has a place on the course within `factor` times the bound.
    fn has_place(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        begun: &[ShareSpan],
        factor: f64,
        thin: &mut Vec<ToolPlace>,
    ) -> bool {
        thinned(places, factor, thin);
        self.begin_from(begun, &places[0], factor);
        self.sweep(motion, thin, factor, false) == SweepOutcome::Through
    }

    /// What can be reached with a wider bound where less could be with the narrower one: all around it that is free.
    fn begin_from(&mut self, begun: &[ShareSpan], place: &ToolPlace, factor: f64) {
        self.reach.clear();
        self.reach.extend_from_slice(begun);
        let bound = self.bound.times(factor);
        for (index, span) in self.reach.iter_mut().enumerate() {
            if span.is_empty() {
                continue;
            }
            if let Some(element) = self.track.kept().get(index)
                && element.is_cut()
            {
                let wide = free(place, &element.from, &element.to, &bound);
                if !wide.is_empty() {
                    *span = ShareSpan {
                        from: span.from.min(wide.from.max(span.from)),
                        to: span.to.max(wide.to),
                    };
                }
            }
        }
    }

    /// The line of the course at which the program stands, as far on as it may.
    pub(super) fn stands_at(&self) -> u64 {
        let index = self.reach.iter().rposition(|span| !span.is_empty());
        let index = index.or(self.next).unwrap_or(0);
        let element = self.track.kept().get(index);
        element.map_or(self.track.line(), |element| element.line)
    }

    /// Something of the course stands between cuts. True if the motion can be tried again, or was dealt with.
    fn remove_obstacle(&mut self, index: usize, motion: &Motion, places: &[ToolPlace]) -> bool {
        let Some(element) = self.track.get(index) else {
            return false;
        };
        let line = element.line;
        match &mut element.what {
            ElementKind::Event(event, met @ false) => {
                *met = true;
                let message = format!("{} is left out", state::event_name(event));
                self.fault("event", message, Some(motion), Some(line), None);
                true
            }
            ElementKind::Hole(_) => {
                self.next = Some(index);
                if !self.begins_hole(motion, places) {
                    self.next = None;
                    return false;
                }
                self.leave_cuts();
                self.hole_motion(motion, places);
                true
            }
            ElementKind::Reach(_) => {
                self.next = Some(index);
                if !self.reaches_at_feed(motion, places) {
                    self.next = None;
                    return false;
                }
                self.leave_cuts();
                true
            }
            ElementKind::Way => {
                self.leave_cut();
                if self.follows_a_rapid(motion, places) {
                    return true;
                }
                self.next = None;
                false
            }
            _ => false,
        }
    }

    fn leave_cuts(&mut self) {
        self.reach.iter_mut().for_each(|span| *span = ShareSpan::EMPTY);
        self.apart = true;
    }

    /// The tool comes down to where a cut was left: the spindle does there what the course asks for.
    fn look_how_it_comes_back(&mut self, motion: &Motion, place: &ToolPlace) {
        let bound = self.bound;
        let left = self.reach.iter().zip(self.track.kept()).find(|(span, element)| {
            element.is_cut()
                && !span.meet(&free(place, &element.from, &element.to, &bound)).is_empty()
        });
        let Some((_, element)) = left else {
            return;
        };
        let (spindle, asked, line) = (motion.state.spindle, element.asked.spindle, element.line);
        if !state::same_spindle(spindle, asked) {
            let message = format!(
                "the spindle {} where the tool comes back to a cut, and the CL file asks that it {}",
                state::spindle_name(spindle),
                state::spindle_name(asked)
            );
            self.fault("spindle", message, Some(motion), Some(line), None);
        }
    }

    /// Along its own axis at feed to where a cut may begin, or towards a first point that is reached at feed.
    fn comes_down(&mut self, places: &[ToolPlace]) -> bool {
        let (from, to) = (&places[0], &places[places.len() - 1]);
        let bound = self.bound;
        let mut over_first = || {
            self.due().is_some_and(|due| {
                matches!(due.what, ElementKind::Reach(MotionKind::Feed))
                    && draws_back(&[due.to, *to], &bound)
            })
        };
        draws_back(&[*to, *from], &bound) && (over_first() || self.may_cut(to))
    }
}

/// Along the tool's own axis to the holder: a tool that leaves what it cuts so does no harm, at whatever feed.
pub(super) fn draws_back(places: &[ToolPlace], bound: &PlaceBound) -> bool {
    let (from, to) = (&places[0], &places[places.len() - 1]);
    let way = to.point - from.point;
    let along = way.dot(&from.axis);
    along > 0.0
        && (way - from.axis * along).norm() <= bound.point + bound.axis * along
        && (to.axis - from.axis).norm() <= bound.axis
}

/// The part sees the tool stand as it is.
fn stands(places: &[ToolPlace]) -> bool {
    let first = &places[0];
    let same = |place: &ToolPlace| {
        (place.point - first.point).norm() <= COMPUTED
            && (place.axis - first.axis).norm() <= COMPUTED
    };
    places.iter().all(same)
}

/// The tool turns about where it stands, off the part: a rewind turns so at feed.
fn turns(places: &[ToolPlace], most: f64) -> bool {
    let from = &places[0];
    let stays = |to: &ToolPlace| (to.point - from.point).norm() <= most;
    places[places.len() - 1].axis != from.axis && places.iter().all(stays)
}

/// Places of a motion as close as a bound widened by `factor` asks for: chords over k pieces stray k² times as far.
fn thinned(places: &[ToolPlace], factor: f64, thin: &mut Vec<ToolPlace>) {
    let stride = (0.5 * libm::sqrt(factor)).max(1.0) as usize;
    let last = places.len() - 1;
    thin.clear();
    thin.extend(places[..last].iter().step_by(stride));
    thin.push(places[last]);
}

/// What became of a piece.
#[derive(Default)]
struct PieceOutcome {
    /// How near its end is to the course, and the line there; none if it has no place.
    here: Option<(PlaceDistance, u64)>,
    /// An element that no cut passes.
    stopped: Option<usize>,
    /// How many elements it was held against.
    held: usize,
    /// There were more elements to hold it against than are.
    cut_short: bool,
}
