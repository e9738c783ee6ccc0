//! Writes a program by a [`Table`].

mod approach;
mod opening;
mod spindle;

use post_plugin::{
    Capabilities, Compensation, CutRun, Event, Format, Meaning, Modal, NumberStyle, Spindle,
    Standstill, Units,
};

use approach::leaning;

use crate::block_style::BlockStyle;
use crate::cycles::CycleWords;
use crate::lines::{fits, remark_lines};
use crate::motion::{ArcWords, MotionWriter};
use crate::planes::PlaneWords;
use crate::settings::SettingWords;
use crate::splines;
use crate::table::{Dwell, Leave, MotionCodes, Table, Tcp};

/// A program on its way out: what is in force, and the words that a table and the options give.
#[derive(Debug)]
pub struct Engine {
    pub(crate) table: &'static Table,
    /// Moves, with the block under construction.
    pub motion: MotionWriter,
    pub(crate) style: BlockStyle,
    pub(crate) settings: SettingWords,
    pub(crate) cycles: CycleWords,
    pub(crate) plane: PlaneWords,
    /// Decimals of the tool vector's words; none: rotary words are written.
    vector: Option<u8>,
    splines: bool,
    /// Arcs in G18 and G19 leave the tool's length where it is.
    arcs_off_xy: bool,
    /// The program's title, with its number.
    title: String,
    machine: String,
    percent: bool,
    /// The parameters that it relies on are written as remarks.
    parameters: bool,
    /// The N of the next block that changes a tool, and the step; none: they have no other numbers than all blocks.
    tool_blocks: Option<[u32; 2]>,
    /// A safe state is written after each tool change.
    restart: bool,
    pub(crate) change: String,
    pub(crate) inch: bool,
    pub(crate) tcp: bool,
    work_offset: String,
    cancel: String,
    /// Whether the cancelling words wait for the length to be off.
    cancel_due: bool,
    /// Words in the place of a retract in machine coordinates; empty: none.
    retract: String,
    tcp_on: String,
    /// Empty: nothing is written about it.
    tcp_off: String,
    most_inverse_time: Option<f64>,
    coolant_codes: [String; 5],
    /// What ends each of them.
    coolant_ends: [String; 5],
    /// Register of the tool in use.
    pub(crate) register: Option<u32>,
    offset_active: Modal<bool>,
    /// A line of the user's own has named a work offset: which one is in force is the user's from there on.
    own_offset: bool,
    pub(crate) length_active: Modal<bool>,
    pub(crate) tcp_active: Modal<bool>,
    /// The tool centre point is kept, and I J K are written in the place of rotary words.
    follows_vector: bool,
    /// The spindle's last command, if that has it turning.
    pub(crate) turning: Option<Spindle>,
    /// A rigid tap has stopped the spindle.
    pub(crate) tapped: bool,
    spindle: Modal<bool>,
    coolant: Modal<bool>,
    /// The coolant that is on: its place in [`spindle::COOLANTS`].
    flowing: Option<usize>,
    /// What a stop has switched off.
    pub(crate) standstill: Standstill,
}

impl Engine {
    pub(crate) fn format(&self) -> Format {
        let (plane_angles, plane_decimals) = self.plane.angles();
        Format {
            most_inverse_time: self.most_inverse_time,
            plane_angles,
            plane_decimals,
            language: self.table.language,
            ..self.motion.format(self.table.extension)
        }
    }

    /// What table and options give it words for.
    pub(crate) fn capabilities(&self) -> Capabilities {
        let table = self.table;
        let mut writes = Capabilities::OPERATION | Capabilities::INSTEAD;
        if table.interpolates {
            writes |= Capabilities::WORD_LETTER;
        }
        if !table.codes.arc[0].is_empty() {
            writes |= Capabilities::ARC_XY | Capabilities::HELIX | Capabilities::ARC_RADIUS;
            if self.arcs_off_xy {
                writes |= Capabilities::ARC_ZX | Capabilities::ARC_YZ;
            }
        }
        if table.smoothing_in_mm {
            writes |= Capabilities::SMOOTHING_IN_MM;
        }
        if !self.arcs_off_xy {
            writes |= Capabilities::LENGTH_ACROSS_PLANE;
        }
        if self.splines && table.splines != crate::SplineForm::None {
            writes |= Capabilities::SPLINE;
        }
        if self.vector.is_some() {
            writes |= Capabilities::TOOL_VECTOR;
        }
        if table.units_inside {
            writes |= Capabilities::UNITS;
        }
        if (table.offset.word)(2).is_some() {
            writes |= Capabilities::WORK_OFFSET;
        }
        if !table.length.on.is_empty() && !table.length.by_itself {
            writes |= Capabilities::OFFSETS;
        }
        if table.sign_is_way {
            writes |= Capabilities::SIGN_IS_WAY;
        }
        if table.rapids_at_feed {
            writes |= Capabilities::RAPIDS_AT_FEED;
        }
        if table.command_a_line {
            writes |= Capabilities::COMMAND_A_LINE;
        }
        if table.feed_all_axes {
            writes |= Capabilities::FEED_ALL_AXES;
        }
        // Its cycles go along Z, across X and Y: on a machine without one of them holes are moves.
        let drills =
            self.motion.linear.iter().all(Option::is_some) && self.motion.axes.depth() == "Z";
        if drills {
            writes |= self.cycles.capabilities();
        }
        writes | self.plane.capabilities() | self.settings.capabilities(table)
    }

    /// A block of these words, or of each line of them; none for no words.
    pub fn line(&mut self, words: &str, out: &mut String) {
        self.motion.line(words, out);
    }

    /// A line that is no block.
    pub fn bare(&self, line: &str, out: &mut String) {
        out.push_str(line);
        out.push('\n');
    }

    /// A remark in a line of its own, or in as many as it needs.
    pub fn remark(&self, text: &str, out: &mut String) {
        for line in remark_lines(self.table, text) {
            self.bare(&line, out);
        }
    }

    /// Words that the options name, for reading back.
    pub(crate) fn own_words(&self, add: &mut dyn FnMut(&str, Meaning)) {
        if matches!(self.table.tcp, Tcp::Blocks { .. }) {
            // Of several lines the last switches it that does not stand on both sides: M66 waits for M68 either way.
            let last = |lines: &str, other: &str| {
                let mut own = lines.lines().rev();
                let found = own.find(|line| !other.lines().any(|known| known == *line));
                found.unwrap_or("").to_owned()
            };
            let lines = self.tcp_on.to_ascii_uppercase();
            for kinematics in lines.lines().filter_map(|line| line.split_once("#KIN ID")) {
                let number = kinematics.1.split_inclusive(']').next().unwrap_or_default();
                add(&format!("#KIN ID {}", number.trim()), Meaning::Nothing);
            }
            add(&last(&self.tcp_on, &self.tcp_off), Meaning::TcpOn);
            add(&last(&self.tcp_off, &self.tcp_on), Meaning::TcpOff);
        }
        let [off, on @ ..] = &self.coolant_codes;
        add(off, Meaning::CoolantOff);
        on.iter().for_each(|word| add(word, Meaning::CoolantOn));
        self.settings.words(add);
    }

    /// Lines that take the place of a retract in machine coordinates from here on, empty: none; gives those before.
    pub(crate) fn retract_by(&mut self, lines: String) -> String {
        std::mem::replace(&mut self.retract, lines)
    }

    pub(crate) fn start(&mut self, out: &mut String) {
        if self.percent {
            self.bare("%", out);
        }
        if !self.title.is_empty() {
            self.bare(&self.title, out);
        }
        if !self.machine.is_empty() {
            self.remark(&self.machine, out);
        }
        if self.parameters {
            for sentence in self.table.relies {
                self.remark(sentence, out);
            }
        }
        self.line(self.table.codes.units[usize::from(self.inch)], out);
        self.safe(out);
    }

    /// Everything modal in a known state.
    fn safe(&mut self, out: &mut String) {
        if self.table.surface.is_some_and(|words| words.per_minute.is_some()) {
            // The feed of the block ends the cutting speed.
            self.end_surface_speed();
        }
        let mut safe = self.table.safe.to_owned();
        if self.table.offset.at_start {
            safe.push(' ');
            safe.push_str(&self.work_offset);
            self.offset_active.set(true);
        }
        self.line(&safe, out);
        self.cancel_due = true;
        if !self.table.cancel_behind_length || self.length_active.is(false) {
            self.cancel_what_was(out);
        }
        self.motion.feeds_per_minute();
        self.motion.plane_is_among(&safe);
    }

    /// What shifts, turns, scales or mirrors is cancelled, unless it is.
    pub(crate) fn cancel_what_was(&mut self, out: &mut String) {
        if std::mem::take(&mut self.cancel_due) {
            self.motion.line(&self.cancel, out);
        }
    }

    /// Runs of cuts are worth more than cuts one by one.
    pub(crate) fn takes_runs(&self) -> bool {
        self.vector.is_none() && self.style.is_plain()
    }

    /// Of the cuts of `run` nothing but words and feeds is to be written.
    pub(crate) fn carries_on(&self, run: &CutRun<'_>) -> bool {
        self.takes_runs()
            && !self.cancel_due
            && !self.follows_vector
            && !self.tapped
            && self.motion.carries_on(run.kind())
    }

    /// Writes any event but the program's start.
    ///
    /// # Errors
    /// A sentence for the user.
    #[inline]
    pub fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            _ if self.cancel_due => return self.command(event, out),
            Event::Rapid { words, .. } if !self.follows_vector => self.motion.rapid(words, out),
            Event::Linear { words, feed, .. }
                if self.motion.has(feed) && !self.follows_vector && !self.tapped =>
            {
                self.motion.cut(words, feed, out);
            }
            _ => return self.command(event, out),
        }
        Ok(())
    }

    /// Refuses an event that the control has no words for, or none where it stands.
    fn allow(&self, event: &Event<'_>) -> Result<(), String> {
        match *event {
            Event::Linear { feed, .. }
            | Event::Arc { feed, .. }
            | Event::Spline { feed, .. }
            | Event::Cycle { feed, .. }
            | Event::Probe { feed, .. }
            | Event::Position { feed: Some(feed), .. }
                if !self.motion.has(feed) =>
            {
                Err(format!("this control has no feed like {feed}"))
            }
            Event::Compensate(Compensation::Left { .. } | Compensation::Right { .. })
                if self.table.codes.compensation[1].is_empty() =>
            {
                Err(event.refusal())
            }
            Event::Compensate(Compensation::Left { .. } | Compensation::Right { .. })
                if self.plane.is_on() && !self.plane.curves() =>
            {
                Err(
                    "cutter compensation inside a tilted plane is not confirmed on this control: the option \
                     `cycles_in_plane` says that yours has it, [control] planes = false does without the plane"
                        .to_owned(),
                )
            }
            _ => Ok(()),
        }
    }

    fn command(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        self.allow(event)?;
        let codes: &MotionCodes = &self.table.codes;
        match *event {
            Event::Linear { words, feed, tool } => {
                // A program that comes to no first position: the axes move one by one.
                self.cancel_what_was(out);
                self.turn_again(out)?;
                match self.follows_vector {
                    true => self.motion.lead(words, leaning(tool)?, Some(feed), out),
                    false => self.motion.cut(words, feed, out),
                }
            }
            Event::Rapid { words, .. } if !self.follows_vector => {
                self.cancel_what_was(out);
                self.motion.rapid(words, out);
            }
            Event::Rapid { words, tool } => self.motion.lead(words, leaning(tool)?, None, out),
            Event::Arc { .. } if !codes.arc[0].is_empty() => self.curve(event, out)?,
            Event::Spline { .. } if self.splines => self.curve(event, out)?,
            Event::Comment { text } => self.remark(text, out),
            Event::Operation { name: "" } | Event::OperationEnd => {}
            Event::Operation { name } => self.remark(name, out),
            Event::Literal { text } => {
                fits(self.table, text)?;
                self.line(text, out);
                self.forget();
                self.own_offset |= names_offset(self.table, text);
            }
            Event::Word { text } => {
                fits(self.table, text)?;
                self.line(text, out);
            }
            Event::ToolChange { number, register, name, .. } => {
                self.plane.must_be_off("a tool change")?;
                self.change(number, &format!("T{number}"), register, name, out);
            }
            Event::Preselect { number } => self.line(&format!("T{number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out)?,
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            Event::Compensate(compensation) => self.motion.compensate(compensation),
            Event::Turn { words } => {
                self.before_position(out);
                self.motion.turn(words, out);
            }
            Event::Position { words, feed, plane_first, tool } => {
                self.position(words, tool, feed, plane_first, out)?
            }
            Event::Retract { axes, words } => self.leave(axes, words, out)?,
            Event::Park { axes, words } => self.machine_positions(axes, words, out)?,
            Event::Dwell { seconds } => self.dwell(seconds, out),
            Event::Stop => self.stop(codes.stop[0], out)?,
            Event::OptionalStop => self.stop(codes.stop[1], out)?,
            Event::End => self.end(out),
            Event::WorkOffset { number, .. } => self.another_offset(number, out)?,
            Event::Units(units) if self.table.units_inside => {
                self.inch = units == Units::Inch;
                self.line(codes.units[usize::from(self.inch)], out);
                self.motion.forget();
            }
            Event::Plane { origin, angles, words, .. } => {
                self.offset_in_force(out);
                self.begin_plane(origin, angles, words, out)?;
            }
            Event::PlaneOff => self.end_plane(out)?,
            Event::Cycle { .. } => self.begin_cycle(event)?,
            Event::CyclePoint { words, .. } => self.cycle_point(words, out)?,
            Event::CycleOff => self.end_cycle(out),
            Event::WordLetter { word, coordinate, letter } if self.table.interpolates => {
                self.motion.settle(out);
                self.motion.axes.rename(word as usize, letter, coordinate);
                self.motion.moved_by_line();
                self.motion.forget_feed();
            }
            ref other => self.setting(other, out)?,
        }
        Ok(())
    }

    /// Cuts along an arc or a spline, with the spindle turning.
    fn curve(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        self.turn_again(out)?;
        match *event {
            Event::Arc { feed, centre, normal, turn, radius, words, .. } => {
                let arc = ArcWords { centre, normal, turn, radius, words };
                self.motion.arc(&arc, feed, out)
            }
            Event::Spline { feed, degree, knots, weights, points } => {
                let [knots, weights, points] = [knots.0, weights.0, points.0];
                let spline = splines::SplineWords { degree, knots, weights, points };
                self.motion.spline(self.table.splines, &spline, feed, out)
            }
            _ => Ok(()),
        }
    }

    /// Puts the work offset `number`, from 1, in force.
    fn another_offset(&mut self, number: u32, out: &mut String) -> Result<(), String> {
        self.plane.must_be_off("another work offset")?;
        if self.tcp_active.is(true) {
            return Err(
                "tool centre point control is on across a change of the work offset".to_owned()
            );
        }
        let word = (self.table.offset.word)(number);
        self.work_offset = word.ok_or_else(|| {
            let range = self.table.offset.range;
            format!("the work offset has the number {number}, and this control has {range}")
        })?;
        self.own_offset = false;
        self.offset_active.forget();
        self.offset_in_force(out);
        Ok(())
    }

    /// Changes to a tool that is called by `call` (`T1`).
    pub fn change(&mut self, number: u32, call: &str, register: u32, name: &str, out: &mut String) {
        self.motion.settle(out);
        if !name.is_empty() {
            self.remark(&format!("T{number} {name}"), out);
        }
        if let Some([number, step]) = &mut self.tool_blocks {
            self.motion.block.integer("N", *number);
            *number += *step;
        }
        let change = format!("{call} {}", self.change);
        self.line(change.trim_end(), out);
        // The changer may have moved any axis.
        self.motion.moved_by_line();
        self.motion.forget_feed();
        self.register = Some(register);
        if !self.table.offset.at_start {
            self.offset_active.forget();
        }
        self.turning = None;
        self.tapped = false;
        self.spindle.forget();
        if self.restart {
            self.forget();
            self.safe(out);
        }
    }

    /// The control may have ended the work offset: it is named again ahead of the next position.
    pub fn offset_may_be_off(&mut self) {
        self.offset_active.forget();
    }

    fn offset_in_force(&mut self, out: &mut String) {
        if !self.own_offset && self.offset_active.set(true) {
            self.motion.line(&self.work_offset, out);
        }
    }

    /// What comes ahead of the first words of a way to a first position.
    pub fn before_position(&mut self, out: &mut String) {
        self.cancel_what_was(out);
        self.offset_before_position(out);
    }

    fn offset_before_position(&mut self, out: &mut String) {
        if !self.table.offset.at_start {
            self.offset_in_force(out);
        }
    }

    /// The number of the length's register, for the words of the user's own.
    fn h(&self) -> String {
        self.register.map_or(String::new(), |register| register.to_string())
    }

    /// The lines that switch tool centre point control on.
    pub(crate) fn tcp_begin(&self) -> String {
        self.tcp_on.replace("{h}", &self.h())
    }

    /// The lines that switch it off, those of the table where neither machine file nor program needs others.
    pub(crate) fn tcp_end(&self) -> &str {
        match self.table.tcp {
            Tcp::Blocks { off, .. } if self.tcp_off.is_empty() => off,
            _ => &self.tcp_off,
        }
    }

    /// The words that put the length in force.
    pub(crate) fn length(&self) -> Result<String, String> {
        let length = &self.table.length;
        let on = match self.table.tcp {
            Tcp::Length(_) if self.tcp && !self.plane.is_on() && self.vector.is_some() => {
                self.table.vector
            }
            Tcp::Length(word) if self.tcp && !self.plane.is_on() => word,
            _ => length.on,
        };
        match self.register {
            _ if on.is_empty() => Ok(String::new()),
            Some(register) if length.is_register() => Ok(format!("{on}{register}")),
            Some(register) => Ok(format!("{on} {}{register}", length.register)),
            None if length.by_itself => Ok(on.to_owned()),
            None => Err(
                "no tool was loaded, so the length register is not known: load one (LOADTL; --tool N where the CL file loads none), or set the \
                 option `length_register`"
                    .to_owned(),
            ),
        }
    }

    fn dwell(&mut self, seconds: f64, out: &mut String) {
        self.motion.block.word("G4");
        self.wait(seconds);
        self.motion.block.end(out);
    }

    /// The word of a wait, in the block under construction.
    fn wait(&mut self, seconds: f64) {
        let (Dwell::Milliseconds(address) | Dwell::Seconds(address, _)) = self.table.dwell;
        self.wait_by(address, seconds);
    }

    /// Writes the word of a wait by another address.
    pub(crate) fn wait_by(&mut self, address: &str, seconds: f64) {
        let (value, decimals) = match self.table.dwell {
            // A dwell too short to be written waits the least.
            Dwell::Milliseconds(_) => ((seconds * 1000.0).round().max(1.0), 0),
            Dwell::Seconds(_, decimals) => (seconds, decimals),
        };
        let block = &mut self.motion.block;
        block.number(address, value, decimals, NumberStyle::default());
    }

    /// The tool leaves the part, and what was in force is cancelled, in the order of the table.
    fn leave(&mut self, axes: u32, words: &[f64], out: &mut String) -> Result<(), String> {
        self.motion.settle(out);
        let mut cancelled = false;
        for step in self.table.leave {
            match step {
                Leave::Retract => self.go_up(axes, words, out)?,
                Leave::Length => {
                    cancelled = self.length_active.set(false);
                    if cancelled {
                        self.motion.line(self.table.length.off, out);
                    }
                    self.cancel_what_was(out);
                }
                Leave::Again if cancelled => self.go_up(axes, words, out)?,
                Leave::Again => {}
                Leave::Tcp => {
                    self.end_kept_plane(out);
                    if self.tcp_active.set(false) {
                        self.motion.line(&self.tcp_off, out);
                    }
                }
            }
        }
        self.tcp_active.set(false);
        self.follows_vector = false;
        self.motion.follow_vector(None);
        self.motion.axes.forget();
        Ok(())
    }

    /// The depth axes to where the tool is clear of the part.
    fn go_up(&mut self, axes: u32, words: &[f64], out: &mut String) -> Result<(), String> {
        if self.retract.is_empty() {
            return self.machine_positions(axes, words, out);
        }
        self.motion.line(&self.retract, out);
        if counts_on(&self.retract) {
            self.motion.line("G90", out);
        }
        self.motion.moved_by_line();
        Ok(())
    }

    /// Axes at rapid to positions in machine coordinates.
    fn machine_positions(
        &mut self,
        axes: u32,
        words: &[f64],
        out: &mut String,
    ) -> Result<(), String> {
        let Table { machine, machine_off, .. } = *self.table;
        if machine.is_empty() && axes != 0 {
            return Err(
                "this control has no words for positions in machine coordinates: [control] retract = {} retracts nothing, \
                 the option `retract` is a way out in lines of your own"
                    .to_owned(),
            );
        }
        match machine_off {
            "" => self.motion.machine(machine, axes, words, out),
            off if axes != 0 => {
                self.motion.line(machine, out);
                self.motion.machine(self.table.codes.motion[0], axes, words, out);
                self.motion.line(off, out);
            }
            _ => {}
        }
        Ok(())
    }

    fn end(&mut self, out: &mut String) {
        self.motion.settle(out);
        self.settings.end_smoothing(&mut self.motion, out);
        if self.spindle.set(false) {
            self.line(self.table.spindle[2], out);
        }
        if !self.coolant.is(false) {
            self.end_coolant(out);
        }
        self.motion.line(&self.settings.end, out);
        if self.percent {
            self.bare("%", out);
        }
    }

    /// Forgets what is in force: after a line of the user's own nothing is known of it.
    pub fn forget(&mut self) {
        self.motion.forget();
        self.offset_active.forget();
        self.length_active.forget();
        self.tcp_active.forget();
        // What turns and flows was asked for all the same: a stop after it switches that off.
        self.spindle.forget();
        self.coolant.forget();
        self.cycles.forget();
    }
}

/// Own lines that end with counting from where the tool stands (`G91 G28 Z0.`) leave that in force.
fn counts_on(lines: &str) -> bool {
    let mut words = lines.split_whitespace().rev();
    words.find(|word| ["G90", "G91"].contains(word)) == Some("G91")
}

/// A line names a work offset: alone, or with the number after it (`G54.1 P12`).
fn names_offset(table: &Table, line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    (0..words.len()).any(|at| {
        let next = words.get(at + 1).map(|next| format!("{} {next}", words[at]));
        (table.offset.known)(words[at]) || next.is_some_and(|pair| (table.offset.known)(&pair))
    })
}

/// One M in a block, as most controls have it by default.
pub(crate) fn one_by_one(codes: &str, motion: &mut MotionWriter, out: &mut String) {
    for code in codes.split_whitespace() {
        motion.line(code, out);
    }
}
