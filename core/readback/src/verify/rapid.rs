//! What a rapid promises: past the points of the course, along its ways, and no end where something is cut.

use post_machine::diagnostic::Short;
use post_machine::kinematics::Pose;
use post_motion::path::nearest_share;

use super::detour::{RapidAllowance, StrayKind};
use super::hole::below_mouth;
use super::place::{PlaceBound, ShareSpan, ToolPlace, free, nearest};
use super::report::BlockPlace;
use super::sweep::draws_back;
use super::track::ElementKind;
use super::{RAPID_TURN, Verifier};
use crate::course::Course;
use crate::{Motion, MotionKind};

impl<C: Course> Verifier<'_, C> {
    /// A motion at rapid.
    pub(super) fn rapid(&mut self, motion: &Motion, places: &[ToolPlace]) {
        if self.hole.is_some() {
            return self.hole_motion(motion, places);
        }
        self.come_back_to_the_course(&places[0]);
        self.leave_cut();
        self.passed.clear();
        let end = &places[places.len() - 1];
        // Before it passes them: points of the course where it ends.
        let asked = self.ends_on_the_course(end);
        let led = asked || self.leads_past(end);
        // A way that bodies leave goes where it likes, from a place of the course on to another.
        let proven = motion.machine && self.machine.clearance.shortens_ways();
        let follows = !proven && self.keeps_to_the_way(motion, places);
        let was_known = self.placed;
        self.look_how_low(motion, places);
        // Where a first retract comes from is not known: a point on that way was not asked for.
        if self.placed || !motion.machine {
            self.pass(motion, places);
        }
        self.look_how_deep(motion, places);
        self.apart = true;
        let known = self.placed;
        if known && self.pecks_again(motion, places) {
            return;
        }
        self.look_along_the_next_cut(motion, places);
        let asked = asked || self.may_begin(end);
        let cut_end = self.cut_end;
        let leaves = self.leaves_along_itself(places);
        if known && !follows && !leaves {
            self.look_how_near(motion, places);
            if !asked {
                self.look_where_it_ends(motion, end);
            }
            let stood = cut_end
                .filter(|end| (end.point - places[0].point).norm() <= self.rapid_bound.point);
            if let Some(stood) = stood.filter(|_| self.arm && !asked && !led) {
                self.look_how_it_leaves(motion, stood, places);
            }
        }
        // Where a rapid comes from that leads to the course first of all, nothing has asked for.
        let known = if self.rules.own || self.arm { was_known } else { known };
        self.detour.take(motion, [asked, led], known);
    }

    /// Whether a rapid goes from one place of a rapid of the course to another as that does, and on.
    fn keeps_to_the_way(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let mut bound = self.rapid_bound;
        bound.axis = 2.0;
        let Some(element) = self.due() else {
            return false;
        };
        if !matches!(element.what, ElementKind::Way) {
            return false;
        }
        let (line, from, to) = (element.line, element.from, element.to);
        let on = |place: &ToolPlace| free(place, &from, &to, &bound);
        let (start, end) = (on(&places[0]), on(&places[places.len() - 1]));
        if start.is_empty() || end.is_empty() {
            return false;
        }
        let off = |place: &ToolPlace| {
            let share = nearest_share([&from.point, &to.point], &place.point);
            (place.point - from.point - (to.point - from.point) * share).norm()
        };
        let most = places.iter().map(off).fold(0.0, f64::max);
        let message = if end.to < start.from {
            "a rapid goes back on its way".to_owned()
        } else if most > bound.point && self.planar && self.apart {
            // Two linear axes cannot follow every straight way: away from the part they go straight to their values.
            self.found.axis_rapids.take(most, motion.line, line);
            return false;
        } else if most > bound.point {
            format!("a rapid strays by {most:.3} mm from the way of the CL file's")
        } else {
            return true;
        };
        self.fault("rapid", message, Some(motion), Some(line), Some(most));
        false
    }

    /// Looks that no rapid goes into the hole that is due: where another tool has drilled before, a larger one, or a tap,
    /// breaks.
    fn look_how_deep(&mut self, motion: &Motion, places: &[ToolPlace]) {
        let bound = self.bound;
        let tool = motion.state.tool;
        let Some(due) = self.due() else {
            return;
        };
        if !matches!(due.what, ElementKind::Hole(_)) || tool.is_some() && due.asked.tool != tool {
            return;
        }
        let (line, by) = (due.line, below_mouth(due, &places[places.len() - 1], &bound));
        if by <= bound.point || self.goes_into_made(motion, places) {
            return;
        }
        let key = "a rapid goes into a hole that this tool has still to make".to_owned();
        let message = format!("{key}, {by:.3} mm below where its feed begins");
        self.limit_fault("hole", key, message, motion, line, by);
    }

    /// Looks how low rapids go to holes: to the first, and from one to the next along the same axis, none goes across
    /// lower than the CL file does: up first, then across.
    fn look_how_low(&mut self, motion: &Motion, places: &[ToolPlace]) {
        let slack = self.rapid_bound.point;
        let Some(due) = self.due() else {
            return;
        };
        let ElementKind::Hole(hole) = &due.what else {
            return;
        };
        let (foot, up, line) = (due.from.point, due.from.axis, due.line);
        let upright = |place: &ToolPlace| (place.axis - up).norm() <= RAPID_TURN;
        let height = |place: &ToolPlace| (place.point - foot).dot(&up);
        let across = |[from, to]: [&ToolPlace; 2]| {
            let way = to.point - from.point;
            (way - up * way.dot(&up)).norm() > slack
        };
        let lowest = |[from, to]: [&ToolPlace; 2]| height(from).min(height(to));
        // What the course crosses by leaning the tool it crosses at heights of its own.
        if !hole.approach.iter().flatten().all(upright) || !places.iter().all(upright) {
            return;
        }
        let ways = hole.approach.iter().map(|[from, to]| [from, to]);
        let asked = ways.filter(|ends| across(*ends)).map(lowest);
        let asked = asked.fold(f64::INFINITY, f64::min);
        if !asked.is_finite() {
            return;
        }
        let ways = places.windows(2).map(|ends| [&ends[0], &ends[1]]);
        let low = ways.filter(|ends| across(*ends)).map(lowest);
        let low = low.fold(f64::INFINITY, f64::min);
        if low < asked - slack {
            let by = asked - low;
            let message =
                format!("a rapid goes to the next hole {by:.3} mm lower than the CL file's");
            self.fault("rapid", message, Some(motion), Some(line), Some(by));
        }
    }

    /// The course comes past this place on its own way to the hole that is due, however the tool leans there.
    fn is_on_the_way_to_a_hole(&mut self, place: &ToolPlace) -> bool {
        let mut bound = self.rapid_bound;
        bound.axis = 2.0;
        self.due().is_some_and(|due| match &due.what {
            ElementKind::Hole(hole) => {
                let mut ways = hole.approach.iter();
                ways.any(|[from, to]| !free(place, from, to, &bound).is_empty())
            }
            _ => false,
        })
    }

    /// The tip comes past this place on a way of the course, before its next cut, however the tool leans.
    fn leads_past(&mut self, end: &ToolPlace) -> bool {
        let mut bound = self.rapid_bound;
        bound.axis = 2.0;
        self.is_on_the_way_to_a_hole(end) || self.is_on_the_course(end, bound)
    }

    /// A rapid of the course leads past this place, before its next cut.
    fn ends_on_the_course(&mut self, end: &ToolPlace) -> bool {
        self.is_on_the_course(end, self.rapid_bound)
    }

    fn is_on_the_course(&mut self, end: &ToolPlace, bound: PlaceBound) -> bool {
        let mut index = self.next.unwrap_or(0);
        while let Some(element) = self.track.get(index) {
            match element.what {
                ElementKind::Way | ElementKind::Reach(_) => {
                    let mut bound = bound;
                    if element.from.axis != element.to.axis {
                        // How the axis goes from one end to the other is not asked for.
                        bound.axis = 2.0;
                    }
                    if !free(end, &element.from, &element.to, &bound).is_empty() {
                        return true;
                    }
                }
                ElementKind::Event(..) => {}
                _ => return false,
            }
            index += 1;
        }
        false
    }

    /// Passes points of the course, in their order.
    pub(super) fn pass(&mut self, motion: &Motion, places: &[ToolPlace]) {
        let Some(mut next) = self.next else {
            return;
        };
        let bound = self.rapid_bound;
        for ends in places.windows(2) {
            let mut least = 0.0;
            while let Some(element) = self.track.get(next) {
                match &element.what {
                    // Whether it was met is asked before the next cut.
                    ElementKind::Event(..) => {}
                    ElementKind::Way | ElementKind::Reach(_) => {
                        let span = free(&element.to, &ends[0], &ends[1], &bound);
                        if span.is_empty() || span.to < least {
                            break;
                        }
                        let span = span.meet(&ShareSpan { from: least, to: 1.0 });
                        let near = nearest(&element.to, &ends[0], &ends[1], &span);
                        least = span.from;
                        let (line, place) = (element.line, element.to);
                        if matches!(element.what, ElementKind::Way) {
                            self.passed.push([element.from.point, element.to.point]);
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

    /// Since the last cut the tool was drawn back from where that ended, and nothing else: where its holder goes it has been
    /// itself, however near to a wall it has cut.
    fn leaves_along_itself(&mut self, places: &[ToolPlace]) -> bool {
        let bound = self.bound;
        let back = |end: &ToolPlace| {
            let stays = |place: &ToolPlace| place.within(end, &bound);
            let rises =
                |pair: &[ToolPlace]| (pair[1].point - pair[0].point).dot(&end.axis) >= -bound.point;
            places.windows(2).all(rises)
                && places.iter().all(|place| stays(place) || draws_back(&[*end, *place], &bound))
        };
        self.cut_end = self.cut_end.filter(back);
        self.cut_end.is_some()
    }

    /// A first point of the course is where the tool stands already: nothing has moved since its length was called.
    pub(super) fn stands_at_a_first_point(&mut self, motion: &Motion, place: ToolPlace) {
        if self.due().is_some_and(|due| matches!(due.what, ElementKind::Reach(MotionKind::Rapid))) {
            self.pass(motion, &[place, place]);
        }
    }

    /// A rapid must not go from the start of the next cut along its line: what stands there was not cut yet.
    fn look_along_the_next_cut(&mut self, motion: &Motion, places: &[ToolPlace]) {
        let [from, to] = [&places[0], &places[places.len() - 1]];
        let (slack, bound) = (self.rapid_bound.point, self.bound);
        let Some(due) = self.due().filter(|due| due.is_cut()) else {
            return;
        };
        let (cl_line, line) = (due.line, due.to.point - due.from.point);
        if free(from, &due.from, &due.to, &bound).is_empty() || line.norm() <= slack {
            return;
        }
        let line = line / line.norm();
        let way = to.point - from.point;
        let ahead = way.dot(&line);
        let draws = draws_back(&[*from, *to], &bound);
        if ahead > slack && (way - line * ahead).norm() <= slack && !draws {
            let message =
                format!("a rapid goes {} mm along a cut that was not made yet", Short(ahead));
            self.fault("rapid", message, Some(motion), Some(cl_line), None);
        }
    }

    /// A rapid must not end where something is cut, unless the course does.
    fn look_where_it_ends(&mut self, motion: &Motion, end: &ToolPlace) {
        if self.cut_path.is_off(end.point, self.rapid_bound.point) {
            return;
        }
        let near = self.cut_path.distance(end.point);
        let slack = self.rapid_bound.point + self.cut_path.blur();
        let from = ToolPlace::new(&motion.from.pose, self.along);
        // Along what is cut it may leave it.
        if near <= slack
            && self.cut_path.distance(from.point) > slack
            && !self.is_on_the_way_to_a_hole(end)
        {
            let message =
                "a rapid ends where something is cut, and no rapid of the CL file does".to_owned();
            self.fault("rapid", message, Some(motion), None, None);
        }
    }

    /// From where its last cut ended, at `from`, an arm leaves along the line of its tool, unless the course has it leave
    /// otherwise: no axis of it would draw the tool back by itself, and no depth shows it.
    fn look_how_it_leaves(&mut self, motion: &Motion, from: ToolPlace, places: &[ToolPlace]) {
        let bound = self.rapid_bound;
        let mut most = 0.0;
        for place in places {
            let way = place.point - from.point;
            let along = way.dot(&from.axis).max(0.0);
            let aside = (way - from.axis * along).norm();
            // Along what is cut it does no harm.
            if aside > bound.point + bound.axis * along
                && self.cut_path.distance(place.point) > bound.point + self.cut_path.blur()
            {
                most = f64::max(most, aside);
            }
        }
        if most > 0.0 {
            let message = format!(
                "a rapid leaves what is cut {most:.1} mm aside of the line of the tool, and no rapid of the CL file does"
            );
            self.fault("rapid", message, Some(motion), None, Some(most));
        }
    }

    /// Rapids between the cuts must not lead where neither the course nor the machine file sends them.
    pub(super) fn look_for_detours(&mut self, motion: Option<&Motion>) {
        let axes = [self.rapid_bound.point, RAPID_TURN];
        let lean = self.rules.axis_tolerance;
        let allowed = RapidAllowance { axes, lean, arm: self.arm };
        let own = self.rules.own;
        let Some(astray) = self.detour.end(self.machine, motion, own, allowed) else {
            return;
        };
        let axis = &self.machine.axes[astray.axis];
        let unit = match axis.joint.rotary {
            true => "°",
            false => " mm",
        };
        let (name, by) = (&axis.name, astray.by);
        let mut message = match astray.kind {
            StrayKind::Short => {
                format!("a retract ends {by:.3}{unit} short of where the machine file has {name}")
            }
            StrayKind::Far => format!(
                "a rapid takes {name} {by:.3}{unit} from all where the CL file and the machine file send it"
            ),
            StrayKind::Tip => {
                format!("a rapid takes the tip {by:.3} mm from all where the CL file sends it")
            }
            StrayKind::Low => format!(
                "a rapid takes the tip {by:.3} mm lower than all that the CL file asks for between these cuts"
            ),
            StrayKind::Turns => format!(
                "{name} turns by {by:.3}{unit} off the ways of the CL file, and the tool is not retracted"
            ),
        };
        if own && astray.machine && !self.machine.clearance.shortens_ways() {
            message.push_str("; a program that was posted with [clearance] low_retracts or link is verified with it");
        }
        let place = Some(BlockPlace { line: astray.line, number: astray.number });
        self.fault_at("rapid", message, place, None, Some(by));
    }
}
