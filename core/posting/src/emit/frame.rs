//! The frame around the moves: retracts, positions of the machine, the way to a first position.

use post_machine::axis_words::{self, AxisWords, WordValues, unit_length};
use post_machine::description::{Machine, OutputUnits, Tcp, TextPlace};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_machine::tilted_plane::TiltedPlane;
use post_plugin::{Capabilities, Coolant, Event, Spindle};

use super::cycles::CycleWordPlaces;
use super::state::FirstPosition;
use super::{EmitStage, stands};
use crate::blocks::{BlockReason, MotionBlock};
use crate::program::{MoveFeed, ToolChange};

/// Full turns that an axis may stand away from its park position without a warning, degrees.
const TURN: f64 = 360.0;

/// An axis that is as near to a place stands there, mm or radians.
const SAME: f64 = 1e-9;

/// What an axis does for the tool on its way to the part.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum AxisRole {
    Rotary,
    Plane,
    Depth,
}

impl AxisRole {
    pub(super) fn of(machine: &Machine, joint: usize) -> Self {
        if machine.axes[joint].joint.rotary {
            Self::Rotary
        } else if axis_words::is_depth(machine, joint) {
            Self::Depth
        } else {
            Self::Plane
        }
    }
}

fn parks(axes: u32, words: &[f64]) -> Event<'_> {
    Event::Park { axes, words }
}

impl EmitStage<'_> {
    /// The depth axes to where the tool is clear of the part, and everything cancelled that a first position put in
    /// force.
    pub(super) fn retract(&mut self, line: u64) {
        if std::mem::replace(&mut self.clear, true) {
            return;
        }
        if self.compensation.commanded.is_some() {
            self.compensation.left.get_or_insert(line);
        }
        self.keep_tip(line, false);
        self.end_face(line);
        self.instead(line, TextPlace::Retract);
        let machine = self.machine;
        let low = self.across.as_ref().map(|way| [way.retract]);
        let positions = low.as_ref().map_or(machine.frame.retract.as_slice(), |low| low);
        self.go(line, positions, |axes, words| Event::Retract { axes, words });
        if std::mem::take(&mut self.plane.on) {
            self.writer.push(line, Event::PlaneOff);
            self.say(line, TextPlace::AfterPlane);
        }
        if std::mem::take(&mut self.came_with_tcp) {
            self.say(line, TextPlace::AfterTcp);
        }
        match machine.frame.leave {
            // One after the other.
            Some(_) => {
                for position in &machine.frame.aside {
                    self.set_clamp(line, position.0, false, true);
                    self.go(line, &[*position], parks);
                }
            }
            None if machine.frame.aside.is_empty() => {}
            None => self.go(line, &machine.frame.aside, parks),
        }
    }

    /// Cutter compensation ends while the tool still cuts: on the way out the control would go aside, into what stands
    /// there, or stop with an alarm.
    fn tell_compensation(&mut self) {
        let Some(line) = self.compensation.left.take() else {
            return;
        };
        self.settle();
        // After another fault nothing is written, and ways are missing: it may end there.
        if !self.findings.failed() {
            self.findings.at(
                line,
                Diagnostic::error(
                    "compensation",
                    "the tool leaves the part here with cutter compensation on (CUTCOM/LEFT or RIGHT without an OFF)",
                )
                .help("let the CAM system end it, CUTCOM/OFF, with a move off the contour"),
            );
        }
    }

    /// Axes to positions in machine coordinates, by one event.
    fn go(
        &mut self,
        line: u64,
        positions: &[(usize, f64)],
        event: for<'e> fn(u32, &'e [f64]) -> Event<'e>,
    ) {
        self.keep_going(line, positions);
        let mut axes = 0;
        let mut words = WordValues::default();
        for &(joint, value) in positions {
            let travel = self.machine.axes[joint].travel;
            let mut to = self.last;
            positions.iter().for_each(|(joint, value)| to[*joint] = *value);
            for (place, word) in self.words.coupled_words(joint, &to) {
                axes |= 1 << place;
                words[place] = word;
            }
            let own = self.words.machine_word(joint, value, travel);
            if let Some((place, word)) = own.filter(|(place, _)| axes >> place & 1 == 0) {
                axes |= 1 << place;
                words[place] = word;
            }
            self.last[joint] = value;
        }
        self.writer.push(line, event(axes, &words[..self.writer.words()]));
    }

    /// All axes that do not stand there to a place on the way across.
    fn go_by(&mut self, line: u64, place: &Joints) {
        let axes = (0..self.machine.axes.len()).map(|joint| (joint, place[joint]));
        let moved: Vec<(usize, f64)> =
            axes.filter(|(joint, value)| libm::fabs(self.last[*joint] - value) > SAME).collect();
        if !moved.is_empty() {
            self.go(line, &moved, parks);
        }
    }

    /// Axes to positions of the machine, the tool retracted: the rotary ones, those across the tool, and the depth last.
    fn park(&mut self, line: u64, positions: &[(usize, f64)]) {
        for part in [AxisRole::Rotary, AxisRole::Plane, AxisRole::Depth] {
            let group: Vec<(usize, f64)> = positions
                .iter()
                .copied()
                .filter(|(joint, _)| AxisRole::of(self.base, *joint) == part)
                .collect();
            if group.is_empty() {
                continue;
            }
            // From there the tool is retracted again before anything turns or goes across.
            self.clear &= part != AxisRole::Depth;
            for &(joint, value) in &group {
                self.tell_unwinding(line, joint, value);
                self.set_clamp(line, joint, false, true);
            }
            self.go(line, &group, parks);
            for &(joint, _) in &group {
                self.set_clamp(line, joint, true, false);
            }
        }
    }

    /// An axis that turns back by whole turns takes its time: the program says why.
    fn tell_unwinding(&self, line: u64, joint: usize, value: f64) {
        let axis = &self.machine.axes[joint];
        if !axis.joint.rotary || axis.range.is_some() || axis.signed {
            return;
        }
        let (from, to) = (axis.reading(self.last[joint]), axis.reading(value));
        let way = libm::fabs(to - from);
        if way <= TURN {
            return;
        }
        let time = match axis.max_feed.is_finite() {
            true => format!(", {:.1} min at its max_feed", way / axis.max_feed.to_degrees()),
            false => String::new(),
        };
        self.findings.at(
            line,
            Diagnostic::warning(
                "unwinding",
                format!(
                    "{} turns back from {from:.3}° to {to:.3}°, {:.0} turns, to where [control] parks it{time}",
                    axis.name,
                    libm::floor(way / TURN)
                ),
            )
            .help("a control that shows the axis over one turn has no such way: [axis] range"),
        );
    }

    /// Warns of an axis that stands whole turns away from zero at the end where nothing turns it back.
    fn tell_wound(&self, line: u64) {
        for (joint, axis) in self.machine.axes.iter().enumerate() {
            let parked = self.machine.frame.park.iter().any(|(place, _)| *place == joint);
            let stands = axis.reading(self.last[joint]);
            if !axis.joint.rotary
                || axis.range.is_some()
                || axis.signed
                || parked
                || libm::fabs(stands) <= TURN
            {
                continue;
            }
            self.findings.at(
                line,
                Diagnostic::warning(
                    "unwinding",
                    format!("at the end {} stands at {stands:.3}°: the next program turns it back", axis.name),
                )
                .help(format!("[control] park = {{ {} = 0 }} turns it back off the part, at the end of this one", axis.name)),
            );
        }
    }

    /// The spindle and the coolant stand still while nothing is cut; what the CL file wants is on again at the next first
    /// position.
    fn rest(&mut self, line: u64) {
        if std::mem::take(&mut self.spindle.turning) {
            self.writer.push(line, Event::Spindle(Spindle::Off));
        }
        self.coolant.waits = false;
        if self.coolant.commanded.is_some() && !std::mem::replace(&mut self.coolant.due, true) {
            self.writer.push(line, Event::Coolant(Coolant::Off));
        }
    }

    pub(super) fn change(&mut self, line: u64, tool: &ToolChange) {
        if self.offsets(line, tool) {
            return;
        }
        self.leave(line);
        self.rest(line);
        (self.spindle.tool_changed, self.spindle.waits) = (true, None);
        if self.texts.any_tool() {
            self.say(line, TextPlace::BetweenTools);
        }
        let machine = self.machine;
        self.park(line, &machine.frame.change);
        self.texts.tool(tool);
        if tool.register != tool.number && self.writer.knows(Capabilities::TOOL_TABLE) {
            self.findings.at(
                line,
                Diagnostic::warning(
                    "register",
                    format!(
                        "tool {} asks for the length in register {}, and this control takes that of the tool from its own table",
                        tool.number, tool.register
                    ),
                )
                .help("the length of the tool must stand in its own line of the table"),
            );
        }
        if let (Some(length), true) = (tool.length, machine.holds_on_length_alone()) {
            let units = machine.control.units;
            let unit = if units == OutputUnits::Inch { "inch" } else { "mm" };
            let length = length / unit_length(units);
            let text = format!("for tool {} of {length:.3} {unit} alone", tool.number);
            self.writer.push(line, Event::Comment { text: &text });
        }
        self.instead(line, TextPlace::ToolChange);
        self.writer.push(
            line,
            Event::ToolChange {
                number: tool.number,
                register: tool.register,
                length: tool.length,
                diameter: tool.diameter,
                corner_radius: tool.corner_radius,
                name: &tool.name,
            },
        );
        // It was retracted before, and a changer leaves the depth axis where the next tool goes across and axes turn, unless
        // `change` says that it stands elsewhere; behind lines of the machine's own nobody knows.
        let own = self.say(line, TextPlace::AfterToolChange);
        self.clear &= !own;
        let next = self.texts.next_tool();
        if let Some(number) = next.filter(|_| self.texts.preselects()) {
            self.writer.push(line, Event::Preselect { number });
        }
    }

    /// Another head: the machine is that of the head from here on.
    pub(super) fn swap_head(&mut self, line: u64, name: &str) {
        if self.base.has_modes() {
            if let Some(machine) = self.base.changed_to(name) {
                self.change_mode(line, machine);
            }
            return;
        }
        let Some(place) = self.base.heads.iter().position(|head| head.name == name) else {
            return;
        };
        let head = &self.base.heads[place];
        // Away first: a spindle that stops in the part tears.
        self.leave(line);
        self.rest(line);
        (self.spindle.tool_changed, self.spindle.waits) = (true, None);
        self.tool = None;
        self.machine = &head.machine;
        self.words = AxisWords::new(self.machine, self.writer.format());
        self.cycle_words = CycleWordPlaces::new(self.machine);
        match &head.word {
            Some(word) => self.writer.push(line, Event::Word { text: word }),
            None => {
                let text = format!("CHANGE TO HEAD {name}");
                self.writer.push(line, Event::Comment { text: &text });
                self.writer.push(line, Event::Stop);
            }
        }
        self.clear = false;
        let other = self.head.replace(place) != Some(place);
        match head.offset {
            Some(number) => self.offset_of_head(line, number),
            None if other && self.worked => self.tell_shared_offset(line, name),
            None => {}
        }
    }

    /// Retracted, spindle and coolant at rest; `forgets`: until they are switched on.
    pub(super) fn apart(&mut self, line: u64, forgets: bool) {
        self.leave(line);
        self.rest(line);
        self.spindle.waits = None;
        if forgets {
            (self.spindle.commanded, self.spindle.tool_changed) = (None, false);
            (self.coolant.commanded, self.coolant.due) = (None, false);
        }
    }

    /// Home: retracted, and parked.
    pub(super) fn go_home(&mut self, line: u64) {
        self.leave(line);
        let machine = self.machine;
        self.park(line, &machine.frame.park);
    }

    pub(super) fn end(&mut self, line: u64) {
        // The tool leaves the part first: a spindle that stops in it tears.
        self.leave(line);
        self.rest(line);
        self.go_home(line);
        self.tell_compensation();
        self.tell_wound(line);
        if let Some(warning) = self.texts.without_operations() {
            self.findings.add(warning);
        }
        self.say(line, TextPlace::Footer);
        self.instead(line, TextPlace::End);
        self.writer.push(line, Event::End);
        self.say_bare(line, TextPlace::LastLines);
    }

    /// Warns of rotary axes that turn as the program begins, where `leave` says no place of the machine at which the tool is
    /// off the part: nobody knows where it stands then.
    fn tell_first_turn(&self, line: u64) {
        let machine = self.machine;
        let frame = &machine.frame;
        let says_none = frame.retract.is_empty() && frame.aside.is_empty();
        let slides = machine.axes.iter().any(|axis| !axis.joint.rotary);
        let turns = machine.axes.iter().any(|axis| axis.joint.rotary);
        let (Some(_), true) = (frame.leave, says_none && slides && turns && !self.comes_at_once())
        else {
            return;
        };
        let message = "rotary axes turn as the program begins, with the tool where the operator left it: [control] leave says no then";
        self.findings.at(
            line,
            Diagnostic::warning("retract", message)
                .help("then = { Z = \"max\" } of leave is where axes go before any turn"),
        );
    }

    /// The first position after the start, a tool change or a retract: the rotary axes turn with the tool clear of the
    /// part, are clamped, and then it comes near.
    pub(super) fn position(&mut self, block: &MotionBlock) {
        let line = block.line;
        if !std::mem::replace(&mut self.worked, true) {
            self.tell_first_turn(line);
        }
        match block.reason {
            BlockReason::Above => self.extremes.reach_above(),
            _ => {
                let [_, to] = self.real_ends(block);
                self.extremes.reach(&to);
            }
        }
        let rotary = self.machine.axes.iter().any(|axis| axis.joint.rotary);
        self.retract(line);
        self.tell_compensation();
        if self.spindle.tool_changed
            && self.spindle.commanded.is_some()
            && block.pace == MoveFeed::Rapid
        {
            // The tool's own speed may stand after its first position.
            self.spindle.waits = Some(FirstPosition::of(block));
        } else {
            self.wake(line);
        }
        if let Some(mode) = &self.machine.face {
            return self.position_on_face(block, mode);
        }
        if let Some(mode) = &self.machine.wrap {
            return self.position_on_mantle(block, mode);
        }
        let words = &block.words[..self.writer.words()];
        // Whether they are clamped is not known.
        self.clamps.free = 0;
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, false, true);
        }
        let way = self.across.take();
        way.iter().flat_map(|way| &way.through).for_each(|place| self.go_by(line, place));
        if rotary {
            self.say_turned(line, TextPlace::BeforeTurn, words);
        }
        let turns = rotary && !self.comes_at_once();
        if turns {
            self.writer.push(line, Event::Turn { words });
            for joint in 0..self.machine.axes.len() {
                if self.machine.axes[joint].joint.rotary {
                    self.set_clamp(line, joint, true, false);
                }
            }
            self.say_turned(line, TextPlace::AfterTurn, words);
        }
        self.smooth(line);
        // In a plane the length alone is in force.
        if self.plane.wanted.is_some() {
            self.keep_tip(line, false);
            self.say_turned(line, TextPlace::BeforePlane, words);
        }
        if let Some(plane) = &self.plane.wanted {
            self.plane.on = true;
            self.writer.push(
                line,
                Event::Plane {
                    origin: plane.origin.into(),
                    x: plane.axes.column(0).into_owned().into(),
                    z: plane.normal().into(),
                    angles: plane.angles,
                    words,
                },
            );
        }
        if !self.plane.on {
            self.came_with_tcp = rotary && self.machine.control.tcp == Tcp::Control;
            if self.came_with_tcp {
                self.say_turned(line, TextPlace::BeforeTcp, words);
            }
            self.keep_tip(line, true);
        }
        if block.reason != BlockReason::Above {
            self.begin_compensation(line);
        }
        self.writer.push(
            line,
            Event::Position {
                tool: stands(block),
                feed: block.time.feed,
                plane_first: !matches!(block.reason, BlockReason::Above | BlockReason::AtOnce),
                words,
            },
        );
        self.clear = false;
        // A linear axis that stands between cuts has come to its place with the others.
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, true, false);
        }
        if rotary && !turns {
            self.say_turned(line, TextPlace::AfterTurn, words);
        }
    }

    /// The tool is led by linear and rotary axes together, and no axis of its own retracts it: with one of them alone, ahead
    /// of the others, it would go anywhere.
    fn comes_at_once(&self) -> bool {
        let machine = self.machine;
        let retracts = machine.frame.leave.is_none() && !machine.frame.retract.is_empty();
        let slides = machine.axes.iter().any(|axis| !axis.joint.rotary);
        machine.control.tcp == Tcp::Post && slides && !retracts && machine.is_arm()
    }

    /// The words after it are those of a plane, or of none: the plane before it ends, the tool clear of the
    /// part.
    pub(super) fn set_plane(&mut self, line: u64, plane: Option<Box<TiltedPlane>>) {
        if self.plane.on {
            self.retract(line);
        }
        self.plane.wanted = plane;
    }

    /// Spindle and coolant on as the CL file takes them to be.
    pub(super) fn wake(&mut self, line: u64) {
        self.spindle.waits = None;
        if let (false, Some(spindle)) = (self.spindle.turning, self.spindle.commanded) {
            // The tool change stopped it, and the CL file takes it to be turning.
            self.spindle.turning = true;
            self.writer.push(line, spindle);
            if std::mem::take(&mut self.spindle.tool_changed) {
                self.findings.at(
                    line,
                    Diagnostic::warning(
                        "spindle",
                        "no SPINDL since the tool change; the spindle was switched on again as before it",
                    )
                    .help("check that the speed fits the new tool"),
                );
            }
        }
        // A tool that stands still comes near as it is.
        self.spindle.tool_changed &= self.spindle.commanded.is_some();
        self.flow(line);
    }

    /// Coolant on, if it was switched off in between.
    fn flow(&mut self, line: u64) {
        self.coolant.waits = false;
        if let (true, Some(coolant)) =
            (std::mem::take(&mut self.coolant.due), self.coolant.commanded)
        {
            self.writer.push(line, Event::Coolant(coolant));
        }
    }

    pub(super) fn coolant(&mut self, line: u64, coolant: Coolant) {
        self.coolant.commanded = (coolant != Coolant::Off).then_some(coolant);
        // Over the part it goes on where the CL file says so; before, once the spindle turns.
        let away = self.clear || self.spindle.tool_changed;
        self.coolant.waits = coolant != Coolant::Off && away && !self.spindle.turning;
        self.coolant.due = self.coolant.waits;
        if !self.coolant.waits {
            self.writer.push(line, Event::Coolant(coolant));
        }
    }

    pub(super) fn spindle(&mut self, line: u64, spindle: Spindle) {
        let event = Event::Spindle(spindle);
        let on = matches!(spindle, Spindle::On { .. }).then_some(event);
        self.set_spindle(line, on, event);
    }

    /// The spindle by `event`; `on` is what switches it on again as it turns then.
    pub(super) fn set_spindle(&mut self, line: u64, on: Option<Event<'static>>, event: Event<'_>) {
        self.spindle.turning = on.is_some();
        self.spindle.commanded = on;
        self.spindle.tool_changed = false;
        self.writer.push(line, event);
        let waited = self.spindle.waits.take().is_some();
        if waited || (self.spindle.turning && self.coolant.waits) {
            self.flow(line);
        }
    }
}
