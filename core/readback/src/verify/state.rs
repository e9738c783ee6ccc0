//! What holds while the tool cuts: tool, registers, spindle, coolants.

use std::sync::Arc;

use post_machine::axis_words::is_depth;
use post_machine::tilted_plane::ROUNDED;
use post_plugin::Lengths;

use super::place::{ToolPlace, free, nearest_point};
use super::report::BlockPlace;

use super::Verifier;
use super::track::Element;
use crate::course::Course;
use crate::{Coolants, Motion, MotionKind, ProgramEvent, SpindleState};

/// Share of a printed speed or feed that is rounding.
pub(super) const SHARE: f64 = 0.005;

/// Half of the last place of a feed or speed without decimals.
pub(super) const PLACE: f64 = 0.51;

/// Times of dwells are rounded, s.
const DWELL: f64 = 0.01;

/// Ways shorter than this take no time that could be compared, mm.
pub(super) const SHORT: f64 = 1e-3;

impl<C: Course> Verifier<'_, C> {
    /// Compares what holds in a cut with what the course asks for where the motion has its place.
    pub(super) fn compare(&mut self, motion: &Motion, places: &[ToolPlace]) {
        if motion.machine && !self.rules.work_offsets {
            let message = "cuts in positions of the machine: where that is on the part hangs on where the part sits, which no work offset says";
            self.fault("work-offset", message.to_owned(), Some(motion), None, None);
        }
        if let Some(asked) = self.asks_as_before(motion)
            && self.keeps_feed(motion, places, asked)
        {
            return;
        }
        let Some(mut element) = self.element_of(places) else {
            return;
        };
        let told = self.told;
        self.compare_with(motion, &element);
        let states = (Arc::clone(&motion.state), Arc::clone(&element.asked));
        self.agreed = (told == self.told).then_some(states);
        if element.feed.is_some_and(|feed| motion.feed > feed) {
            element.feed = self.feed_of(places, &element);
        }
        self.compare_feed(motion, places, &element);
    }

    /// The feed that is asked for, if one is, where nothing else is wrong, whichever element of those that it may follow a
    /// motion does follow: all of them ask for the same, and that was compared with what holds.
    fn asks_as_before(&self, motion: &Motion) -> Option<Option<f64>> {
        let (state, asked) = self.agreed.as_ref()?;
        let last = self.reach.iter().rposition(|span| !span.is_empty())?;
        if !Arc::ptr_eq(state, &motion.state) || !self.turned.is_empty() || self.running.changes() {
            return None;
        }
        let mut cuts = self.track.kept().iter().take(last + 1).filter(|element| element.is_cut());
        let first = cuts.next()?;
        let same = |other: &Element| {
            Arc::ptr_eq(asked, &other.asked)
                && other.feed == first.feed
                && other.turned_feed.is_none()
        };
        (same(first) && cuts.all(same)).then_some(first.feed)
    }

    /// The element of the course that a motion follows: where all that it may follow ask for the same, any of them;
    /// else that at the middle of its way.
    fn element_of(&mut self, places: &[ToolPlace]) -> Option<Element> {
        let bound = self.bound.times(self.stray.map_or(1.0, |stray| stray.factor));
        let last = self.reach.iter().rposition(|span| !span.is_empty())?;
        let middle = match places.len() {
            2 => places[0].between(&places[1], 0.5),
            count => places[count / 2],
        };
        let before = &places[(places.len() - 1) / 2];
        let ahead = places[places.len() / 2].point - before.point;
        let mut best: Option<(f64, usize)> = None;
        let mut differ = false;
        let mut first: Option<&Element> = None;
        for (index, element) in self.track.kept().iter().enumerate().take(last + 1) {
            if !element.is_cut() {
                continue;
            }
            let one = first.get_or_insert(element);
            differ |= !Arc::ptr_eq(&one.asked, &element.asked)
                || one.feed != element.feed
                || one.turned_feed != element.turned_feed;
            let span = free(&middle, &element.from, &element.to, &bound);
            // The way back lies on the same line.
            let back = ahead.dot(&(element.to.point - element.from.point)) < 0.0;
            if span.is_empty() || back {
                continue;
            }
            let near = nearest_point(&middle, &element.from, &element.to, &span);
            // Of two that are as near the later: after a corner the next holds.
            if best.is_none_or(|(least, _)| near <= least + 1e-9) {
                best = Some((near, index));
            }
        }
        let index = match (differ, best) {
            (_, Some((_, index))) => index,
            (false, None) => last,
            (true, None) => return None,
        };
        self.track.kept().get(index).cloned()
    }

    /// Compares tool, registers, spindle and coolants.
    pub(super) fn compare_with(&mut self, motion: &Motion, element: &Element) {
        let state = &motion.state;
        let asked = &element.asked;
        let cl_line = Some(element.line);
        if state.tool != asked.tool
            && let (Some(has), Some(wants)) = (state.tool, asked.tool)
        {
            let message = format!("cuts with tool {has}, and the CL file asks for tool {wants}");
            self.fault("tool", message, Some(motion), cl_line, None);
        } else if state.tool.is_none()
            && let Some(wants) = asked.tool
            && (self.rules.own || self.rules.length_from.are_named())
        {
            let message = format!("cuts with no tool changed in, and the CL file asks for {wants}");
            self.fault("tool", message, Some(motion), cl_line, None);
        }
        if !same_spindle(state.spindle, asked.spindle) {
            let message = format!(
                "the spindle {} in a cut, and the CL file asks that it {}",
                spindle_name(state.spindle),
                spindle_name(asked.spindle)
            );
            self.fault("spindle", message, Some(motion), cl_line, None);
        }
        self.compare_standstill(motion, element);
        self.compare_speeds(motion, element);
        self.compare_change(element);
        if self.rules.coolants && state.coolants != asked.coolants {
            let message = format!(
                "cuts with {}, and the CL file asks for {}",
                coolant_name(state.coolants),
                coolant_name(asked.coolants)
            );
            self.fault("coolant", message, Some(motion), cl_line, None);
        }
        if state.compensation != asked.side {
            let message = format!(
                "cuts with radius compensation {}, and the CL file asks for {}",
                side_name(state.compensation),
                side_name(asked.side)
            );
            self.fault("compensation", message, Some(motion), cl_line, None);
        } else if asked.side != 0
            && let (Some(has), Some(wants)) = (state.radius_register, asked.register)
            && has != wants
        {
            let message =
                format!("cuts with radius register {has}, and the CL file asks for {wants}");
            self.fault("register", message, Some(motion), cl_line, None);
        }
        if asked.side != 0
            && state.compensation == asked.side
            && state.radius_register.is_none()
            && self.rules.radius_registers
            && let Some(wants) = asked.register
        {
            let message = format!(
                "cuts with radius compensation and no radius register, and the CL file asks for {wants}"
            );
            self.fault("register", message, Some(motion), cl_line, None);
        }
        self.compare_register(motion, element);
        self.compare_length(motion, element);
        self.compare_work_offset(motion, element);
        self.compare_smoothing(motion);
    }

    /// What the control may leave the path by is told where it is more than the tolerance and than the machine file's
    /// own: how far it does leave it follows from its accelerations.
    fn compare_smoothing(&mut self, motion: &Motion) {
        let leeway = motion.state.leeway();
        if leeway == self.smoothing {
            return;
        }
        self.smoothing = leeway;
        let (tolerance, axis_tolerance) = (self.rules.tolerance, self.rules.axis_tolerance);
        if let Some(message) = leeway.beyond(self.machine, tolerance, axis_tolerance) {
            self.left_on(motion.line, "smoothing", message);
        }
    }

    /// Compares the spindle between the tool change and its first cut with what the course has of this tool: the speed
    /// of the tool before bursts a large one.
    fn compare_speeds(&mut self, motion: &Motion, element: &Element) {
        let asked = &element.asked;
        if self.turned.is_empty() || motion.state.tool != asked.tool {
            return;
        }
        for turned in std::mem::take(&mut self.turned) {
            let (spindle, line) = (turned.spindle, turned.line);
            let known = [asked.spindle, motion.state.spindle, SpindleState::Off];
            let mut known = known.iter().chain(&asked.turned);
            // On its way from one command to the next the speed counts, and not the sense.
            let passes = |known: SpindleState| match (spindle.rpm(), known.rpm()) {
                (Some(has), Some(wants)) => turned.passing && libm::fabs(has - wants) <= PLACE,
                _ => false,
            };
            if known.any(|known| same_spindle(spindle, *known) || passes(*known)) {
                continue;
            }
            let message = format!(
                "the spindle {} with this tool before it cuts, and the CL file asks that it {}",
                spindle_name(spindle),
                spindle_name(asked.spindle)
            );
            let place = Some(BlockPlace::of_line(line));
            self.fault_at("spindle", message, place, Some(element.line), None);
        }
    }

    /// Where nothing is said of where work offsets lie, each that the course asks for is one of the program's, always
    /// the same and no other's.
    fn compare_work_offset(&mut self, motion: &Motion, element: &Element) {
        let asked = element.asked.work_offset;
        if self.rules.work_offsets {
            return;
        }
        let wanted = self.rules.work_offset.as_deref();
        let Some(name) = &motion.state.work_offset else {
            let message = match (asked, wanted) {
                (Some(asked), Some(_)) => format!(
                    "cuts in no work offset that the program names, and the CL file asks for work offset {asked}"
                ),
                (None, Some(wanted)) => format!(
                    "cuts in no work offset that the program names, and that of the machine file is {wanted}"
                ),
                (_, None) => return,
            };
            let cl_line = Some(element.line);
            return self.fault("work-offset", message, Some(motion), cl_line, None);
        };
        if let (None, Some(wanted)) = (asked, wanted) {
            if !name.eq_ignore_ascii_case(wanted) {
                let message = format!(
                    "cuts in {name}: the CL file names no work offset, and that of the machine file is {wanted}"
                );
                let cl_line = Some(element.line);
                self.fault("work-offset", message, Some(motion), cl_line, None);
            }
            return;
        }
        let known = |of: Option<u32>| {
            let mut worked = self.worked.iter();
            worked.find(|(other, _)| *other == of).map(|(_, name)| name)
        };
        let number = number_of(name, self.rules.first_preset);
        let message = match (known(asked), asked, number) {
            (Some(known), _, _) if known != name => {
                format!(
                    "cuts in {name}, and in {known} before: the CL file asks for no other work offset"
                )
            }
            (_, Some(asked), Some(number)) if asked != number => {
                format!("cuts in {name}, and the CL file asks for work offset {asked}")
            }
            (Some(_), _, _) => return,
            (None, _, _) => {
                let taken = self
                    .worked
                    .iter()
                    .any(|(other, used)| used == name && other.is_some() && asked.is_some());
                self.worked.push((asked, name.clone()));
                match taken {
                    true => format!(
                        "cuts in {name} once more, and the CL file asks for another work offset"
                    ),
                    false => return,
                }
            }
        };
        self.fault("work-offset", message, Some(motion), Some(element.line), None);
    }

    /// What is compensated is the length that the tool has, as far as that is known.
    fn compare_length(&mut self, motion: &Motion, element: &Element) {
        let Some(tool) = element.asked.tool.or(motion.state.tool) else {
            return;
        };
        let of = |known: &[(u32, f64)], wanted: u32| {
            let mut known = known.iter();
            known.find(|(number, _)| *number == wanted).map(|(_, length)| *length)
        };
        let register = self.register_of(tool);
        let Some(offsets) = &self.rules.lengths else {
            return;
        };
        let length =
            of(&offsets.tools, tool).or_else(|| of(&offsets.lengths, register)).or(offsets.length);
        let has = motion.state.length;
        if let Some(length) = length
            && libm::fabs(has - length) > SHORT
        {
            let message = format!(
                "cuts with a length of {has} mm compensated, and tool {tool} is {length} mm long"
            );
            self.fault("length", message, Some(motion), Some(element.line), None);
        }
    }

    fn compare_register(&mut self, motion: &Motion, element: &Element) {
        let state = &motion.state;
        let Some(tool) = element.asked.tool.or(state.tool) else {
            return;
        };
        let Some(wants) = self.length_register_of(tool) else {
            return;
        };
        let message = match state.length_register {
            Some(has) if has == wants => return,
            Some(has) => {
                format!("cuts with length register {has}, and that of tool {tool} is {wants}")
            }
            None => format!("cuts without length compensation, tool {tool}"),
        };
        self.fault("register", message, Some(motion), Some(element.line), None);
    }

    /// The register that the length of a tool stands in, where the program names registers.
    fn length_register_of(&self, tool: u32) -> Option<u32> {
        match self.rules.length_from {
            Lengths::Tools | Lengths::WorkOffset => None,
            Lengths::Registers => Some(self.register_of(tool)),
            Lengths::Edges => Some(1),
        }
    }

    fn register_of(&self, tool: u32) -> u32 {
        let mut known = self.rules.tool_registers.iter();
        known.find(|(number, _)| *number == tool).map_or(tool, |(_, register)| *register)
    }

    /// Words of the depth mean nothing known before the length of the tool is compensated, or by that of another tool: the
    /// tip is lower than they say.
    pub(super) fn look_for_length(&mut self, motion: &Motion) {
        let state = &motion.state;
        if !self.rules.length_from.are_named() || motion.machine || state.length_of_spindle {
            return;
        }
        let wants = state.tool.and_then(|tool| self.length_register_of(tool));
        if state.length_register.is_some() && state.length_register == wants {
            return;
        }
        let axes = &self.machine.axes;
        let way = |joint: usize| libm::fabs(motion.to.joints[joint] - motion.from.joints[joint]);
        let slides = (0..axes.len()).filter(|joint| !axes[*joint].joint.rotary);
        // Across a tilted plane whose angles are rounded.
        let across = slides.map(way).fold(0.0, f64::max) * ROUNDED;
        let deeper = |joint: &usize| way(*joint) > SHORT + across && is_depth(self.machine, *joint);
        if let Some(joint) = (0..axes.len()).find(deeper) {
            let name = &self.machine.axes[joint].name;
            let message = match (motion.state.length_register, wants) {
                (None, _) => format!("{name} moves without length compensation"),
                // A cut is held against what is asked for there.
                (Some(has), Some(wants)) if motion.kind == MotionKind::Rapid => {
                    format!(
                        "{name} moves at rapid with length register {has}, and that of the tool is {wants}"
                    )
                }
                _ => return,
            };
            self.fault("register", message, Some(motion), None, None);
        }
    }
}

/// How an event is told.
pub(super) fn event_name(event: &ProgramEvent) -> String {
    match event {
        ProgramEvent::Stop => "a stop".to_owned(),
        ProgramEvent::OptionalStop => "an optional stop".to_owned(),
        ProgramEvent::Sync(mark) => format!("a wait for other channels at {mark}"),
        ProgramEvent::Dwell { time, revolutions: true } => format!("a dwell of {time} turns"),
        ProgramEvent::Dwell { time, .. } => format!("a dwell of {time} s"),
        other => format!("{other:?}"),
    }
}

/// The program does what is asked, while the spindle turns as the course has it: turns of a dwell take their time.
pub(super) fn same_event(asked: &ProgramEvent, done: &ProgramEvent, spindle: SpindleState) -> bool {
    match (asked, done) {
        (
            ProgramEvent::Dwell { time: asked, revolutions: turns },
            ProgramEvent::Dwell { time, revolutions },
        ) => {
            let rpm = spindle.rpm().unwrap_or(0.0);
            let [asked, time] = match turns == revolutions {
                true => [*asked, *time],
                false if rpm > 0.0 => {
                    let seconds = |time: f64, turns: bool| match turns {
                        true => time * 60.0 / rpm,
                        false => time,
                    };
                    [seconds(*asked, *turns), seconds(*time, *revolutions)]
                }
                // How long turns take is not known.
                false => return false,
            };
            libm::fabs(asked - time) <= DWELL + SHARE * asked
        }
        (ProgramEvent::Sync(asked), ProgramEvent::Sync(done)) => asked == done,
        (ProgramEvent::Stop, ProgramEvent::Stop)
        | (ProgramEvent::OptionalStop, ProgramEvent::OptionalStop) => true,
        _ => false,
    }
}

/// The number of a work offset whose name has one, as posting counts them; G500 and G53, which are none, are 0. `first`
/// is the row of presets that is the first.
fn number_of(name: &str, first: u32) -> Option<u32> {
    if let Some(row) = name.strip_prefix("CYCL DEF 247 Q339=") {
        let row: u32 = row.parse().ok()?;
        return Some((row + 1).saturating_sub(first));
    }
    let beyond = |prefix: &str| name.strip_prefix(prefix)?.parse::<u32>().ok();
    if let Some(number) = beyond("G15 H") {
        return Some(number);
    }
    if let Some(number) = beyond("G54.1 P").or(beyond("G154 P")) {
        return Some(6 + number);
    }
    match beyond("G")? {
        53 | 500 => Some(0),
        code @ 54..=59 => Some(code - 53),
        code @ 505..=599 => Some(code - 500),
        _ => None,
    }
}

pub(super) fn same_spindle(has: SpindleState, wants: SpindleState) -> bool {
    // Printed without decimals, or with some.
    let same = |a: f64, b: f64| libm::fabs(a - b) <= PLACE;
    match (has, wants) {
        (SpindleState::Clockwise(a), SpindleState::Clockwise(b))
        | (SpindleState::CounterClockwise(a), SpindleState::CounterClockwise(b)) => same(a, b),
        (
            SpindleState::Off | SpindleState::Oriented,
            SpindleState::Off | SpindleState::Oriented,
        ) => true,
        (
            SpindleState::Surface { speed: a, most: most_a, clockwise: sense_a },
            SpindleState::Surface { speed: b, most: most_b, clockwise: sense_b },
        ) => {
            let bounded = match (most_a, most_b) {
                (Some(a), Some(b)) => same(a, b),
                (_, None) => true,
                (None, Some(_)) => false,
            };
            same(a, b) && bounded && sense_a == sense_b
        }
        _ => false,
    }
}

pub(super) fn spindle_name(spindle: SpindleState) -> String {
    match spindle {
        SpindleState::Off => "stands".to_owned(),
        SpindleState::Oriented => "stands at an angle".to_owned(),
        SpindleState::Clockwise(rpm) => format!("turns clockwise at {rpm}/min"),
        SpindleState::CounterClockwise(rpm) => format!("turns counter-clockwise at {rpm}/min"),
        SpindleState::Surface { speed, most, clockwise } => {
            let sense = match clockwise {
                true => "clockwise",
                false => "counter-clockwise",
            };
            let limit = match most {
                Some(most) => format!("at most {most}/min"),
                None => "no limit of its speed".to_owned(),
            };
            format!("turns {sense} at {speed} m/min of cutting speed, {limit}")
        }
    }
}

pub(super) fn coolant_name(coolants: Coolants) -> String {
    let names =
        [(coolants.flood, "flood"), (coolants.mist, "mist"), (coolants.other, "another coolant")];
    let on: Vec<&str> = names.iter().filter(|(on, _)| *on).map(|(_, name)| *name).collect();
    match on.is_empty() {
        true => "no coolant".to_owned(),
        false => on.join(" and "),
    }
}

fn side_name(side: i8) -> &'static str {
    match side {
        ..=-1 => "left",
        0 => "off",
        1.. => "right",
    }
}
