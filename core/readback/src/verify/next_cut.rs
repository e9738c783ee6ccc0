//! What happens between cuts: where one is left, what is due before the next, and where that begins.

use super::detour::Detour;
use super::feed_sum::FeedSum;
use super::hole::goes_down;
use super::place::{PlaceDistance, ShareSpan, ToolPlace, free};
use super::report::{BlockPlace, lines_of};
use super::sweep::StrayStretch;
use super::track::{Element, ElementKind, MOST};
use super::{RAPID_TURN, Verifier, state};
use crate::course::Course;
use crate::{Motion, ProgramEvent};

/// Elements ahead within which a cut is looked for that has no place where the program stands.
const AHEAD: usize = 20_000;

impl<C: Course> Verifier<'_, C> {
    /// Where a cut of the course may have ended, what comes after it may be passed.
    pub(super) fn leave_cut(&mut self) {
        if self.next.is_some() {
            return;
        }
        let mut index = self.reach.len();
        while index > 0 {
            index -= 1;
            let span = self.reach[index];
            if span.is_empty() {
                continue;
            }
            if self.track.kept().get(index).is_none() {
                continue;
            }
            if span.to < 1.0 {
                return;
            }
            let goes_on = match self.behind_events(index + 1) {
                Some(behind) => self.track.get(behind).is_some_and(|next| next.is_cut()),
                None => false,
            };
            if !goes_on {
                self.next = Some(index + 1);
            }
            return;
        }
    }

    /// The first element from `index` on that is no event.
    pub(super) fn behind_events(&mut self, mut index: usize) -> Option<usize> {
        while let ElementKind::Event(..) = self.track.get(index)?.what {
            index += 1;
        }
        Some(index)
    }

    /// The element that is due next, events apart.
    pub(super) fn due(&mut self) -> Option<&Element> {
        let index = self.behind_events(self.next?)?;
        self.track.get(index).map(|element| &*element)
    }

    /// The next thing due is a hole.
    pub(super) fn hole_is_due(&mut self) -> bool {
        let Some(next) = self.next else {
            return false;
        };
        let Some(index) = self.behind_events(next) else {
            return false;
        };
        let due = self
            .track
            .get(index)
            .is_some_and(|element| matches!(element.what, ElementKind::Hole(_)));
        if due {
            self.next = Some(index);
        }
        due
    }

    /// A cut that was left goes on here, or the next one begins; or a rapid is due that passes here.
    pub(super) fn may_begin(&mut self, place: &ToolPlace) -> bool {
        let rapid = self.rapid_bound;
        let passes = self.due().is_some_and(|element| {
            matches!(element.what, ElementKind::Way | ElementKind::Reach(_))
                && !free(place, &element.from, &element.to, &rapid).is_empty()
        });
        passes || self.may_cut(place)
    }

    /// A cut that was left goes on here, or the next one begins.
    pub(super) fn may_cut(&mut self, place: &ToolPlace) -> bool {
        self.may_go_on(place) || self.may_be_first(place)
    }

    /// A cut that was left goes on here.
    pub(super) fn may_go_on(&self, place: &ToolPlace) -> bool {
        let bound = self.bound;
        let kept = self.reach.iter().zip(self.track.kept());
        let goes_on = kept.filter(|(span, element)| !span.is_empty() && element.is_cut());
        let mut goes_on = goes_on
            .map(|(span, element)| span.meet(&free(place, &element.from, &element.to, &bound)));
        goes_on.any(|span| !span.is_empty())
    }

    /// The next cut begins here, or the next hole.
    pub(super) fn may_be_first(&mut self, place: &ToolPlace) -> bool {
        let bound = self.bound;
        self.due().is_some_and(|element| {
            !matches!(element.what, ElementKind::Way | ElementKind::Reach(_))
                && place.within(&element.from, &bound)
        })
    }

    /// A cut begins: where on the course may that be?
    pub(super) fn begin_cut(&mut self, motion: &Motion, place: &ToolPlace) {
        let bound = self.bound;
        let mut reach = std::mem::take(&mut self.reach);
        // After what was cut so far.
        let stood = reach.iter().rposition(|span| !span.is_empty());
        let stood = stood.map_or(0, |index| index + usize::from(reach[index].to >= 1.0));
        let mut goes_on = false;
        for (span, element) in reach.iter_mut().zip(self.track.kept()) {
            if !span.is_empty() && element.is_cut() {
                *span = span.meet(&free(place, &element.from, &element.to, &bound));
                goes_on |= !span.is_empty() && span.to < 1.0;
            }
        }
        if let Some(next) = self.next
            && let Some(index) = self.behind_events(next)
            && let Some(element) = self.track.get(index)
            && element.is_cut()
        {
            let span = free(place, &element.from, &element.to, &bound);
            if span.from <= 0.0 && !span.is_empty() {
                if reach.len() <= index {
                    reach.resize(index + 1, ShareSpan::EMPTY);
                }
                reach[index] = span;
            }
        }
        self.reach = reach;
        if goes_on {
            // A cut that is left and gone on with: what was done in between is the program's own business.
            self.found.excursions += 1;
            self.detour = Detour::default();
        } else {
            self.look_for_detours(Some(motion));
        }
        if self.reach.iter().all(ShareSpan::is_empty) {
            self.find_cut(motion, place, self.next.unwrap_or(stood));
        }
        self.next = None;
        self.apart = false;
        self.made = None;
        self.feeds = FeedSum::default();
        if let Some(first) = self.reach.iter().position(|span| !span.is_empty()) {
            self.miss_events(Some(BlockPlace::of(motion)), first);
        }
    }

    /// Events in front of the element at `first`, where the program comes to at `place`, must have been met; none: it ends.
    pub(super) fn miss_events(&mut self, place: Option<BlockPlace>, first: usize) {
        let mut missed = Vec::new();
        for index in 0..first {
            if let Some(element) = self.track.get(index)
                && let ElementKind::Event(event, met @ false) = &mut element.what
            {
                *met = true;
                missed.push((state::event_name(event), element.line));
            }
        }
        for (name, line) in missed {
            let message = format!("{name} is left out");
            self.fault_at("event", message, place, Some(line), None);
        }
    }

    /// No cut of the course is due here. Looks for it farther on, and tells what was left out; else takes the nearest
    /// that is due, and tells how far that is.
    fn find_cut(&mut self, motion: &Motion, place: &ToolPlace, first: usize) {
        let bound = self.bound;
        let mut found = None;
        let mut index = first;
        while found.is_none() && index < AHEAD.min(MOST) {
            let Some(element) = self.track.get(index) else {
                break;
            };
            let near = match &element.what {
                ElementKind::Cut | ElementKind::Thread => {
                    free(place, &element.from, &element.to, &bound)
                }
                ElementKind::Hole(_) => {
                    let ends = [*place, ToolPlace::new(&motion.to.pose, self.along)];
                    match place.within(&element.from, &bound) && goes_down(element, &ends) {
                        true => ShareSpan::WHOLE,
                        false => ShareSpan::EMPTY,
                    }
                }
                _ => ShareSpan::EMPTY,
            };
            if !near.is_empty() {
                found = Some((index, near));
            }
            index += 1;
        }
        if let Some((index, span)) = found {
            // Its beginning too, if that is farther.
            self.tell_left_out(first, index + usize::from(span.from > 0.0), motion);
            self.reach.clear();
            self.reach.resize(index + 1, ShareSpan::EMPTY);
            self.reach[index] = span;
            return;
        }
        self.begin_astray(motion, place, first);
    }

    /// Tells what lies between two elements of the course.
    fn tell_left_out(&mut self, from: usize, to: usize, motion: &Motion) {
        let mut cuts: Option<[u64; 2]> = None;
        let mut ways: Option<[u64; 2]> = None;
        for index in from..to {
            let Some(element) = self.track.kept().get(index) else {
                break;
            };
            let lines = match element.what {
                ElementKind::Cut | ElementKind::Thread | ElementKind::Hole(_) => &mut cuts,
                // Across lower than the CL file has it, which is a matter of clearance.
                ElementKind::Way
                    if self.machine.clearance.link
                        && (element.from.axis - element.to.axis).norm() <= RAPID_TURN =>
                {
                    continue;
                }
                ElementKind::Way | ElementKind::Reach(_) => &mut ways,
                ElementKind::Event(..) => continue,
            };
            let first = lines.map_or(element.line, |[first, _]| first);
            *lines = Some([first, element.line]);
        }
        let (what, lines) = match (cuts, ways) {
            (Some(lines), _) => ("is not cut", lines),
            (None, Some(lines)) => ("is not passed at rapid before this cut", lines),
            (None, None) => return,
        };
        let message = match lines {
            lines if self.rules.files.is_joined() => {
                format!("what {} asks for {what}", lines_of(&self.rules.files, lines))
            }
            [from, to] if from == to => format!("line {from} of the CL file {what}"),
            [from, to] => format!("what lines {from} to {to} of the CL file ask for {what}"),
        };
        self.fault("missing", message, Some(motion), Some(lines[0]), None);
    }

    /// A cut begins off the course: at the nearest place where one could.
    fn begin_astray(&mut self, motion: &Motion, place: &ToolPlace, first: usize) {
        let mut best: Option<(f64, usize, ShareSpan)> = None;
        let mut index = first;
        while index < first + AHEAD {
            let Some(element) = self.track.get(index) else {
                break;
            };
            if element.is_cut() {
                let apart = place.apart(&element.from);
                let factor = (apart.point / self.bound.point).max(apart.axis / self.bound.axis);
                best = Some((factor, index, ShareSpan { from: 0.0, to: 0.0 }));
                break;
            }
            index += 1;
        }
        let Some((factor, index, span)) = best else {
            return;
        };
        let line = self.track.kept().get(index).map_or(0, |element| element.line);
        self.reach.clear();
        self.reach.resize(index + 1, ShareSpan::EMPTY);
        self.reach[index] = span;
        self.stray = Some(StrayStretch {
            worst: PlaceDistance::default(),
            factor: (factor * 1.001).max(1.0),
            line: motion.line,
            number: motion.number,
            last: motion.line,
            asked: [line, line],
        });
    }

    /// The program stops or waits.
    pub(super) fn event(&mut self, line: u64, event: &ProgramEvent) {
        if self.hole_dwell(event) {
            return;
        }
        self.leave_cut();
        // Up to the next cut of which nothing was reached.
        let reached = self.reach.iter().rposition(|span| !span.is_empty());
        let mut index = 0;
        let mut other = None;
        let place = Some(BlockPlace::of_line(line));
        while let Some(element) = self.track.get(index) {
            let ahead = reached.is_none_or(|reached| index > reached) && Some(index) >= self.next;
            if ahead && (element.is_cut() || matches!(element.what, ElementKind::Hole(_))) {
                break;
            }
            if let ElementKind::Event(asked, met @ false) = &mut element.what {
                let cl_line = element.line;
                if !state::same_event(asked, event, element.asked.spindle) {
                    other.get_or_insert(index);
                    index += 1;
                    continue;
                }
                *met = true;
                let name = state::event_name(event);
                // One that stands before it will not come any more.
                self.miss_events(place, index);
                if self.next.is_none() && !self.stand_behind(index) {
                    let message = format!("{name} before the CL file asks for it");
                    self.fault_at("event", message, place, Some(cl_line), None);
                }
                return;
            }
            index += 1;
        }
        if !self.rules.own_stops.may_be(event) {
            self.other_event(place, event, other);
        }
    }

    /// The program stops or waits otherwise than it should: in place of the event of the course at `other`, if one is due.
    fn other_event(
        &mut self,
        place: Option<BlockPlace>,
        event: &ProgramEvent,
        other: Option<usize>,
    ) {
        let name = state::event_name(event);
        if let Some(element) = other.and_then(|index| self.track.get(index))
            && let ElementKind::Event(asked, met) = &mut element.what
        {
            *met = true;
            let cl_line = Some(element.line);
            let message = format!("{name} in place of {}", state::event_name(asked));
            return self.fault_at("event", message, place, cl_line, None);
        }
        let message = format!("{name} that the CL file does not ask for");
        self.fault_at("event", message, place, None, None);
    }

    /// What lies before an event cannot be cut after it. False if the program is not there yet.
    fn stand_behind(&mut self, index: usize) -> bool {
        let last = self.reach.iter().rposition(|span| !span.is_empty());
        let Some(last) = last.filter(|last| *last < index) else {
            return true;
        };
        if self.reach[last].to < 1.0 {
            return false;
        }
        self.reach[..last].fill(ShareSpan::EMPTY);
        self.reach[last] = ShareSpan { from: 1.0, to: 1.0 };
        true
    }

    /// The program is at its end; is the course?
    pub(super) fn look_at_the_rest(&mut self) {
        self.leave_cut();
        self.look_for_detours(None);
        let from = match self.next {
            Some(next) => next,
            None => self.reach.iter().rposition(|span| !span.is_empty()).unwrap_or(0),
        };
        self.miss_events(None, from);
        let mut lines: [Option<[u64; 2]>; 2] = [None, None];
        let mut index = from;
        // Elements that were looked at are let go: the rest may be long.
        while let Some(element) = self.track.get(index) {
            let line = element.line;
            let place = match &element.what {
                ElementKind::Way | ElementKind::Reach(_) => Some(1),
                ElementKind::Event(_, true) => None,
                ElementKind::Event(event, false) => {
                    let message = format!("{} is left out", state::event_name(event));
                    self.fault_at("event", message, None, Some(line), None);
                    None
                }
                _ => Some(0),
            };
            if let Some(place) = place {
                let first = lines[place].map_or(line, |[first, _]| first);
                lines[place] = Some([first, line]);
            }
            if index > 0 {
                index += 1;
            } else {
                self.track.pop();
            }
            if index >= MOST {
                break;
            }
        }
        for (lines, what) in lines.into_iter().zip(["cut", "passed at rapid"]) {
            if let Some([from, to]) = lines {
                let asked = match self.rules.files.is_joined() {
                    true => format!("{} asks", lines_of(&self.rules.files, [from, to])),
                    false => format!("lines {from} to {to} of the CL file ask"),
                };
                let message = format!("the program ends, and what {asked} for is not {what}");
                self.fault_at("missing", message, None, Some(from), None);
            }
        }
    }
}
