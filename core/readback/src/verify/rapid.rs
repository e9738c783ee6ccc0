//! Between the cuts: rapids past the points of the course, and where the next cut begins.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::detour::Detour;
use super::place::{Apart, Place, Span, free, nearest};
use super::sweep::Stray;
use super::track::{MOST, What};
use super::{RAPID_TURN, Verifier, state};
use crate::course::Course;
use crate::{Motion, MotionKind, Told, fed_rapids};

/// So far ahead a cut is looked for that has no place where the program stands.
const AHEAD: usize = 20_000;

impl<C: Course> Verifier<'_, C> {
    /// A motion at rapid.
    pub(super) fn rapid(&mut self, motion: &Motion, places: &[Place]) {
        if self.hole.is_some() {
            return self.hole_motion(motion, places);
        }
        self.come_back_to_the_course(&places[0]);
        self.leave_cut();
        self.course_near = f64::INFINITY;
        let end = &places[places.len() - 1];
        // Before it passes them: points of the course where it ends.
        let asked = self.ends_on_the_course(end);
        let follows = self.keeps_to_the_way(motion, places);
        self.pass(motion, places);
        self.apart = true;
        let known = self.placed;
        if known && self.pecks_again(motion, places) {
            return;
        }
        let asked = asked || self.may_begin(end);
        if known && !follows {
            self.look_how_near(motion, places);
            if !asked {
                self.look_where_it_ends(motion, end);
            }
        }
        self.detour.take(motion, asked, known);
    }

    /// From one place of a rapid of the course to another a rapid goes as it does, and on. True if it does.
    fn keeps_to_the_way(&mut self, motion: &Motion, places: &[Place]) -> bool {
        let Some(index) = self.next.and_then(|next| self.behind_events(next)) else {
            return false;
        };
        let mut bound = self.rapid_bound;
        bound.axis = 2.0;
        let Some(element) = self.track.get(index) else {
            return false;
        };
        if !matches!(element.what, What::Way) {
            return false;
        }
        let (line, from, to) = (element.line, element.from, element.to);
        let on = |place: &Place| free(place, &from, &to, &bound);
        let (start, end) = (on(&places[0]), on(&places[places.len() - 1]));
        if start.is_empty() || end.is_empty() {
            return false;
        }
        let way = to.point - from.point;
        let length = way.norm();
        let off = |place: &Place| {
            let offset = place.point - from.point;
            let share = match length > 0.0 {
                true => (offset.dot(&way) / (length * length)).clamp(0.0, 1.0),
                false => 0.0,
            };
            (offset - way * share).norm()
        };
        let most = places.iter().map(off).fold(0.0, f64::max);
        let message = if end.to < start.from {
            "a rapid goes back on its way".to_owned()
        } else if most > bound.point {
            format!("a rapid strays by {most:.3} mm from the way of the CL file's")
        } else {
            return true;
        };
        self.fault("rapid", message, Some(motion), Some(line), Some(most));
        false
    }

    /// A rapid must not come nearer to the cuts than its ends, unless the course's own does.
    ///
    /// Where the tool stands before it comes to its first point is not known, and how machines turn off the part is often
    /// their own: what comes near is told, and what touches is a fault.
    fn look_how_near(&mut self, motion: &Motion, places: &[Place]) {
        let ends = [&places[0], &places[places.len() - 1]];
        let ends = ends.map(|end| self.cut_path.distance(end.point));
        let slack = self.rapid_bound.point + self.cut_path.blur();
        let least = ends[0].min(ends[1]) - slack;
        if least <= 0.0 || !least.is_finite() {
            return;
        }
        let mut near = f64::INFINITY;
        for ends in places.windows(2) {
            near = near.min(self.cut_path.least_on(ends[0].point, ends[1].point, least));
        }
        if near >= least {
            return;
        }
        if near >= self.course_is_near() - slack {
            return;
        }
        let message = format!(
            "a rapid comes to {near:.1} mm of what is cut, from {:.1} mm to {:.1} mm at its ends",
            ends[0], ends[1]
        );
        if near <= slack && !self.turns_between_holes() {
            let by = least + slack - near;
            self.fault("rapid", message, Some(motion), None, Some(by));
        } else {
            self.found.near_rapids += 1;
            self.found
                .nearest_rapid
                .get_or_insert((motion.line, message));
        }
    }

    /// A rapid must not end where something is cut, unless the course does.
    fn look_where_it_ends(&mut self, motion: &Motion, end: &Place) {
        let near = self.cut_path.distance(end.point);
        let slack = self.rapid_bound.point + self.cut_path.blur();
        let from = Place::new(&motion.from.pose, self.along);
        // Along what is cut it may leave it.
        if near <= slack && self.cut_path.distance(from.point) > slack {
            let message =
                "a rapid ends where something is cut, and no rapid of the CL file does".to_owned();
            self.fault("rapid", message, Some(motion), None, None);
        }
    }

    /// A rapid of the course leads past this place, before its next cut.
    fn ends_on_the_course(&mut self, end: &Place) -> bool {
        let bound = self.rapid_bound;
        let mut index = self.next.unwrap_or(0);
        while let Some(element) = self.track.get(index) {
            match element.what {
                What::Way | What::Reach(_) => {
                    let mut bound = bound;
                    if element.from.axis != element.to.axis {
                        // How the axis goes from one end to the other is not asked for.
                        bound.axis = 2.0;
                    }
                    if !free(end, &element.from, &element.to, &bound).is_empty() {
                        return true;
                    }
                }
                What::Event(..) => {}
                _ => return false,
            }
            index += 1;
        }
        false
    }

    /// How near the rapids of the course that a motion has passed and the one that it is on come to its cuts between their
    /// ends, and at points of the course in the midst of the motion, mm.
    fn course_is_near(&mut self) -> f64 {
        let mut under_way = None;
        if let Some(index) = self.next.and_then(|next| self.behind_events(next))
            && let Some(element) = self.track.get(index)
            && matches!(element.what, What::Way)
        {
            under_way = Some((element.from.point, element.to.point));
        }
        let under_way = under_way.map_or(f64::INFINITY, |(from, to)| self.dips(from, to));
        self.course_near.min(under_way)
    }

    /// How near a rapid of the course comes to the cuts, if between its ends it is nearer than at both, mm.
    fn dips(&self, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
        let ends = [from, to].map(|end| self.cut_path.distance(end));
        let least = ends[0].min(ends[1]);
        let near = self.cut_path.least_on(from, to, 0.0);
        match near < least - self.cut_path.blur() {
            true => near,
            false => f64::INFINITY,
        }
    }

    /// Where a cut of the course may have ended, what comes behind it may be passed.
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
    fn behind_events(&mut self, mut index: usize) -> Option<usize> {
        while let What::Event(..) = self.track.get(index)?.what {
            index += 1;
        }
        Some(index)
    }

    /// Passes points of the course, in their order.
    pub(super) fn pass(&mut self, motion: &Motion, places: &[Place]) {
        let Some(mut next) = self.next else {
            return;
        };
        let bound = self.rapid_bound;
        for ends in places.windows(2) {
            let mut least = 0.0;
            while let Some(element) = self.track.get(next) {
                match &element.what {
                    // Whether it was met is asked before the next cut.
                    What::Event(..) => {}
                    What::Way | What::Reach(_) => {
                        let span = free(&element.to, &ends[0], &ends[1], &bound);
                        if span.is_empty() || span.to < least {
                            break;
                        }
                        let span = span.meet(&Span {
                            from: least,
                            to: 1.0,
                        });
                        let near = nearest(&element.to, &ends[0], &ends[1], &span);
                        least = span.from;
                        let (line, place) = (element.line, element.to);
                        if matches!(element.what, What::Way) {
                            let (from, to) = (element.from.point, element.to.point);
                            let point = self.cut_path.distance(to);
                            self.course_near = self.course_near.min(self.dips(from, to)).min(point);
                        }
                        self.detour.passes(Pose {
                            tip: place.point - place.axis * self.along,
                            axis: place.axis,
                            edge: motion.to.pose.edge,
                        });
                        self.placed = true;
                        self.found.rapid.take(near.point, motion.line, line);
                        self.block.cl_line = Some(line);
                    }
                    _ => break,
                }
                next += 1;
            }
        }
        self.next = Some(next);
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
            .is_some_and(|element| matches!(element.what, What::Hole(_)));
        if due {
            self.next = Some(index);
        }
        due
    }

    /// A first point that the program comes to at feed. False if the motion is no such.
    pub(super) fn reaches_at_feed(&mut self, motion: &Motion, places: &[Place]) -> bool {
        let Some(index) = self.next.and_then(|next| self.behind_events(next)) else {
            return false;
        };
        let bound = self.bound;
        let due = self.track.get(index).and_then(|element| {
            let reached = places[places.len() - 1].within(&element.to, &bound);
            match element.what {
                What::Reach(kind) if reached => Some((kind, element.line)),
                _ => None,
            }
        });
        let Some((kind, cl_line)) = due else {
            return false;
        };
        if kind == MotionKind::Rapid {
            self.rapid_at_feed(motion, cl_line);
        }
        self.pass(motion, places);
        self.set_kind("rapid");
        true
    }

    /// A motion at feed where a rapid is due, along it. False if the motion is no such.
    pub(super) fn follows_a_rapid(&mut self, motion: &Motion, places: &[Place]) -> bool {
        let Some(index) = self.next.and_then(|next| self.behind_events(next)) else {
            return false;
        };
        let bound = self.rapid_bound;
        let (from, to) = (&places[0], &places[places.len() - 1]);
        let due = self.track.get(index).is_some_and(|element| {
            let mut bound = bound;
            if element.from.axis != element.to.axis {
                // How the axis goes from one end to the other is not asked for.
                bound.axis = 2.0;
            }
            let on = |place: &Place| free(place, &element.from, &element.to, &bound);
            let (start, end) = (on(from), on(to));
            matches!(element.what, What::Way) && !end.is_empty() && start.from <= end.to
        });
        if !due {
            return false;
        }
        let cl_line = self.track.get(index).map_or(0, |element| element.line);
        self.rapid_at_feed(motion, cl_line);
        self.set_kind("rapid");
        self.rapid(motion, places);
        true
    }

    /// A motion at feed that the machine file lets a rapid be: as fast as its axes go.
    pub(super) fn is_as_fast_as_rapids(&self, motion: &Motion) -> bool {
        let from_anywhere = || self.apart && fed_rapids::comes_from_anywhere(self.machine, motion);
        self.rules.linear_rapids
            && motion.kind == MotionKind::Feed
            && (fed_rapids::is_as_fast_as_rapids(&self.axes, self.machine, motion)
                || from_anywhere())
    }

    /// A rapid of the course is made at feed: where the machine file has it so, as fast as the axes hold.
    fn rapid_at_feed(&mut self, motion: &Motion, cl_line: u64) {
        self.found.rapids_at_feed += 1;
        let feed = motion.feed;
        if !self.rules.linear_rapids {
            let message = "a rapid of the CL file is made at feed".to_owned();
            let told = format!("{message}: {feed:.1} mm/min");
            self.limit_fault("rapid", message, told, motion, cl_line, feed);
            return;
        }
        let least = self.axes.least_minutes(self.machine, motion);
        if let Some((minutes, joint)) = least
            && !self.is_as_fast_as_rapids(motion)
        {
            let name = &self.machine.axes[joint].name;
            let message = "a rapid of the CL file is made slower than its axes go".to_owned();
            let share = minutes / motion.minutes * 100.0;
            let told = format!("{message}: at {share:.0} % of the max_feed of {name}");
            self.limit_fault("rapid", message, told, motion, cl_line, 100.0 - share);
        }
    }

    /// A cut that was left goes on here, or the next one begins; or a rapid is due that passes here.
    pub(super) fn may_begin(&mut self, place: &Place) -> bool {
        let rapid = self.rapid_bound;
        let due = self.next.and_then(|next| self.behind_events(next));
        let due = due.and_then(|index| self.track.get(index));
        let passes = due.is_some_and(|element| {
            matches!(element.what, What::Way | What::Reach(_))
                && !free(place, &element.from, &element.to, &rapid).is_empty()
        });
        passes || self.may_cut(place)
    }

    /// A cut that was left goes on here, or the next one begins.
    pub(super) fn may_cut(&mut self, place: &Place) -> bool {
        let bound = self.bound;
        let kept = self.reach.iter().zip(self.track.kept());
        let goes_on = kept.filter(|(span, element)| !span.is_empty() && element.is_cut());
        let mut goes_on = goes_on
            .map(|(span, element)| span.meet(&free(place, &element.from, &element.to, &bound)));
        if goes_on.any(|span| !span.is_empty()) {
            return true;
        }
        let Some(index) = self.next.and_then(|next| self.behind_events(next)) else {
            return false;
        };
        self.track.get(index).is_some_and(|element| {
            !matches!(element.what, What::Way | What::Reach(_))
                && place.within(&element.from, &bound)
        })
    }

    /// Rapids between the cuts must not lead where neither the course nor the machine file sends them.
    pub(super) fn look_for_detours(&mut self, motion: Option<&Motion>) {
        let slack = [self.rapid_bound.point, RAPID_TURN];
        let lean = self.rules.axis_tolerance;
        let Some(astray) = self.detour.end(self.machine, motion, slack, lean) else {
            return;
        };
        let axis = &self.machine.axes[astray.axis];
        let unit = match axis.joint.rotary {
            true => "°",
            false => " mm",
        };
        let (name, by) = (&axis.name, astray.by);
        let message = match astray.short {
            true => {
                format!("a retract ends {by:.3}{unit} short of where the machine file has {name}")
            }
            false => format!(
                "a rapid takes {name} {by:.3}{unit} from all where the CL file and the machine file send it"
            ),
        };
        let place = Some((astray.line, astray.number));
        self.fault_at("rapid", message, place, None, Some(by));
    }

    /// A cut begins: where on the course may that be?
    pub(super) fn begin_cut(&mut self, motion: &Motion, place: &Place) {
        let bound = self.bound;
        let mut reach = std::mem::take(&mut self.reach);
        // Behind what was cut so far.
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
                    reach.resize(index + 1, Span::EMPTY);
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
        if self.reach.iter().all(Span::is_empty) {
            self.find_cut(motion, place, self.next.unwrap_or(stood));
        }
        self.next = None;
        self.apart = false;
        self.made = None;
        self.miss_events(motion);
    }

    /// Events in front of where a cut begins must have been met.
    fn miss_events(&mut self, motion: &Motion) {
        let Some(first) = self.reach.iter().position(|span| !span.is_empty()) else {
            return;
        };
        let mut missed = Vec::new();
        for index in 0..first {
            if let Some(element) = self.track.get(index)
                && let What::Event(told, met @ false) = &mut element.what
            {
                *met = true;
                missed.push((state::event_name(told), element.line));
            }
        }
        for (name, line) in missed {
            let message = format!("{name} is left out");
            self.fault("event", message, Some(motion), Some(line), None);
        }
    }

    /// No cut of the course is due here. Looks for it farther on, and tells what was left out; else takes the nearest that
    /// is due, and tells how far that is.
    fn find_cut(&mut self, motion: &Motion, place: &Place, first: usize) {
        let bound = self.bound;
        let mut found = None;
        let mut index = first;
        while found.is_none() && index < AHEAD.min(MOST) {
            let Some(element) = self.track.get(index) else {
                break;
            };
            let near = match &element.what {
                What::Cut | What::Thread => free(place, &element.from, &element.to, &bound),
                What::Hole(_) => match place.within(&element.from, &bound) {
                    true => Span::WHOLE,
                    false => Span::EMPTY,
                },
                _ => Span::EMPTY,
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
            self.reach.resize(index + 1, Span::EMPTY);
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
                What::Cut | What::Thread | What::Hole(_) => &mut cuts,
                What::Way | What::Reach(_) => &mut ways,
                What::Event(..) => continue,
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
            [from, to] if from == to => format!("line {from} of the CL file {what}"),
            [from, to] => format!("what lines {from} to {to} of the CL file ask for {what}"),
        };
        self.fault("missing", message, Some(motion), Some(lines[0]), None);
    }

    /// A cut begins off the course: at the nearest place where one could.
    fn begin_astray(&mut self, motion: &Motion, place: &Place, first: usize) {
        let mut best: Option<(f64, usize, Span)> = None;
        let mut index = first;
        while index < first + AHEAD {
            let Some(element) = self.track.get(index) else {
                break;
            };
            if element.is_cut() {
                let apart = place.apart(&element.from);
                let factor = (apart.point / self.bound.point).max(apart.axis / self.bound.axis);
                best = Some((factor, index, Span { from: 0.0, to: 0.0 }));
                break;
            }
            index += 1;
        }
        let Some((factor, index, span)) = best else {
            return;
        };
        let line = self
            .track
            .kept()
            .get(index)
            .map_or(0, |element| element.line);
        self.reach.clear();
        self.reach.resize(index + 1, Span::EMPTY);
        self.reach[index] = span;
        self.stray = Some(Stray {
            worst: Apart::default(),
            factor: (factor * 1.001).max(1.0),
            line: motion.line,
            number: motion.number,
            last: motion.line,
            asked: [line, line],
        });
    }

    /// The program stops or waits.
    pub(super) fn event(&mut self, line: u64, told: &Told) {
        if self.hole_dwell(told) {
            return;
        }
        self.leave_cut();
        // Up to the next cut of which nothing was reached.
        let reached = self.reach.iter().rposition(|span| !span.is_empty());
        let mut index = 0;
        let place = Some((line, None));
        while let Some(element) = self.track.get(index) {
            let ahead = reached.is_none_or(|reached| index > reached) && Some(index) >= self.next;
            if ahead && (element.is_cut() || matches!(element.what, What::Hole(_))) {
                break;
            }
            if let What::Event(asked, met @ false) = &mut element.what {
                let cl_line = element.line;
                *met = true;
                let same = state::same_event(asked, told, element.asked.spindle);
                let name = state::event_name(told);
                let asked = state::event_name(asked);
                if !same {
                    let message = format!("{name} in place of {asked}");
                    self.fault_at("event", message, place, Some(cl_line), None);
                } else if self.next.is_none() && !self.stand_behind(index) {
                    let message = format!("{name} before the CL file asks for it");
                    self.fault_at("event", message, place, Some(cl_line), None);
                }
                return;
            }
            index += 1;
        }
        let message = format!(
            "{} that the CL file does not ask for",
            state::event_name(told)
        );
        self.fault_at("event", message, place, None, None);
    }

    /// What lies before an event cannot be cut behind it. False if the program is not there yet.
    fn stand_behind(&mut self, index: usize) -> bool {
        let last = self.reach.iter().rposition(|span| !span.is_empty());
        let Some(last) = last.filter(|last| *last < index) else {
            return true;
        };
        if self.reach[last].to < 1.0 {
            return false;
        }
        self.reach[..last].fill(Span::EMPTY);
        self.reach[last] = Span { from: 1.0, to: 1.0 };
        true
    }

    /// The program is at its end; is the course?
    pub(super) fn look_at_the_rest(&mut self) {
        self.leave_cut();
        self.look_for_detours(None);
        let from = match self.next {
            Some(next) => next,
            None => self
                .reach
                .iter()
                .rposition(|span| !span.is_empty())
                .unwrap_or(0),
        };
        let mut lines: [Option<[u64; 2]>; 2] = [None, None];
        let mut index = from;
        // Elements that were looked at are let go: the rest may be long.
        while let Some(element) = self.track.get(index) {
            let line = element.line;
            let place = match &element.what {
                What::Way | What::Reach(_) => Some(1),
                What::Event(_, true) => None,
                What::Event(told, false) => {
                    let message = format!("{} is left out", state::event_name(told));
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
                let message = format!(
                    "the program ends, and what lines {from} to {to} of the CL file ask for is not {what}"
                );
                self.fault_at("missing", message, None, Some(from), None);
            }
        }
    }
}
