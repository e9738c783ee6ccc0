//! Rapids of the course that the program makes at feed.

use super::Verifier;
use super::place::{ToolPlace, free};
use super::track::ElementKind;
use crate::course::Course;
use crate::{Motion, MotionKind, fed_rapids};

/// Share of a feed by which two that are the same may differ.
const ROUNDED_FEED: f64 = 1e-6;

impl<C: Course> Verifier<'_, C> {
    /// A first point that the program comes to at feed. False if the motion is no such.
    pub(super) fn reaches_at_feed(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let bound = self.bound;
        let due = self.due().and_then(|element| {
            let reached = places[places.len() - 1].within(&element.to, &bound);
            match element.what {
                ElementKind::Reach(kind) if reached => Some((kind, element.line)),
                _ => None,
            }
        });
        let Some((kind, cl_line)) = due else {
            return false;
        };
        if kind == MotionKind::Rapid {
            self.rapid_at_feed(motion, cl_line);
        }
        let known = self.placed;
        self.pass(motion, places);
        self.detour.take(motion, [true, true], known);
        self.set_kind("rapid");
        true
    }

    /// A motion at feed where a rapid is due, along it. False if the motion is no such.
    pub(super) fn follows_a_rapid(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let Some(index) = self.next.and_then(|next| self.behind_events(next)) else {
            return false;
        };
        let bound = self.rapid_bound;
        let (from, to) = (&places[0], &places[places.len() - 1]);
        let cut = self.bound;
        let mut stays = false;
        let due = self.track.get(index).is_some_and(|element| {
            // The end of the cut before, as it is rounded.
            stays = [from, to].iter().all(|place| place.within(&element.from, &cut));
            let mut bound = bound;
            if element.from.axis != element.to.axis {
                // How the axis goes from one end to the other is not asked for.
                bound.axis = 2.0;
            }
            let on = |place: &ToolPlace| free(place, &element.from, &element.to, &bound);
            let (start, end) = (on(from), on(to));
            matches!(element.what, ElementKind::Way) && !end.is_empty() && start.from <= end.to
        });
        if !due {
            return false;
        }
        let cl_line = self.track.get(index).map_or(0, |element| element.line);
        if !stays {
            self.rapid_at_feed(motion, cl_line);
        }
        self.set_kind("rapid");
        self.rapid(motion, places);
        true
    }

    /// A motion at feed that the machine file lets a rapid be: as fast as its axes go.
    pub(super) fn is_as_fast_as_rapids(&self, motion: &Motion) -> bool {
        let from_anywhere = || self.apart && fed_rapids::comes_from_anywhere(self.machine, motion);
        self.has_linear_rapids(motion)
            && motion.kind == MotionKind::Feed
            && (fed_rapids::is_as_fast_as_rapids(&self.axes, self.machine, motion)
                || from_anywhere())
    }

    /// Where G0 goes at F, each rapid has the F that the dialect writes.
    pub(super) fn look_at_rapid_feed(&mut self, motion: &Motion) {
        let Some(due) = self.rules.rapid_feed else {
            return;
        };
        let feed = motion.rapid_feed;
        if libm::fabs(feed - due) <= self.rules.feed_place.max(ROUNDED_FEED * due) {
            return;
        }
        let message = format!("G0 goes at F, and that is not the {due} of the dialect's rapids");
        let told = match feed > 0.0 {
            true => format!("{message}: F{feed:.0}"),
            false => format!("{message}: none is said"),
        };
        self.limit_fault("rapid", message, told, motion, 0, libm::fabs(feed - due));
    }

    /// The word that goes with the way of the tip does so in cuts, and in no rapid.
    pub(super) fn goes_along(&mut self, motion: &Motion, cuts: bool) {
        let Some(word) = self.machine.along.as_ref().filter(|_| motion.along == Some(!cuts)) else {
            return;
        };
        let message = match cuts {
            true => format!("{} stands still in a cut of the CL file", word.name),
            false => format!("{} goes along a rapid of the CL file", word.name),
        };
        self.fault("nc-along", message, Some(motion), None, None);
    }

    /// The machine file has rapids as feed moves, or there are none in the mode that the control is in.
    fn has_linear_rapids(&self, motion: &Motion) -> bool {
        let state = &motion.state;
        self.rules.linear_rapids || state.face.is_some() || state.wrap.is_some()
    }

    /// A rapid of the course is made at feed: where the machine file has it so, as fast as the axes hold.
    fn rapid_at_feed(&mut self, motion: &Motion, cl_line: u64) {
        self.found.rapids_at_feed += 1;
        self.goes_along(motion, false);
        let feed = motion.feed;
        if !self.has_linear_rapids(motion) {
            let message = "a rapid of the CL file is made at feed".to_owned();
            let told = format!("{message}: {feed:.1} mm/min");
            self.limit_fault("rapid", message, told, motion, cl_line, feed);
            return;
        }
        let least = self.axes.least_minutes(self.machine, motion, 0.0);
        if let Some((minutes, joint)) = least
            && !self.is_as_fast_as_rapids(motion)
        {
            let name = self.machine.mover(joint);
            let message = "a rapid of the CL file is made slower than its axes go".to_owned();
            let share = minutes / motion.minutes * 100.0;
            let told = format!("{message}: at {share:.0} % of the max_feed of {name}");
            self.limit_fault("rapid", message, told, motion, cl_line, 100.0 - share);
        }
    }
}
