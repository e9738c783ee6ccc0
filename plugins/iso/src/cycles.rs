//! Drilling cycles: one position a block, bottom and clearance plane absolute.

use post_plugin::{
    Capabilities, Cycle, Event, Feed, Group, Modal, NumberStyle, Setup, Spindle, SpindleSense,
    Value,
};

use crate::engine::Engine;
use crate::options::text;
use crate::planes::INCH;
use crate::table::{CycleCode, CycleReturn, Rigid, Table};

/// Decimals of a pitch in mm: 40 threads an inch are 0.635.
const PITCH_DECIMALS: u8 = 4;

/// The cycles of a control, and the one in force.
#[derive(Debug)]
pub(crate) struct CycleWords {
    codes: &'static [CycleCode],
    rigid: Option<Rigid>,
    /// What a tap is told is settled: whether it is rigid, and what its pitch counts in.
    taps: bool,
    /// Way off the wall, program units; 0: fine boring is not written.
    shift: f64,
    running: Option<ModalCycle>,
}

/// A cycle in force. Lengths are in program units.
#[derive(Clone, Copy, Debug)]
struct ModalCycle {
    kind: Cycle,
    code: &'static str,
    feed: Feed,
    depth: f64,
    clearance: f64,
    retract: f64,
    step: Option<f64>,
    dwell: Option<f64>,
    pitch: Option<f64>,
    /// Whether no point has been written under the cycle.
    first: bool,
    bottom: Modal<f64>,
    plane: Modal<f64>,
    level: Modal<&'static str>,
    /// Level to which it returns, where a block of its own says it.
    top: Option<f64>,
}

impl ModalCycle {
    /// The word that begins it: rigid taps may have codes of their own, to the right and to the left.
    fn word(&self, rigid: Option<Rigid>) -> &'static str {
        match (rigid, self.kind) {
            (Some(Rigid::Codes { codes: [_, left], .. }), Cycle::TapLeft) => left,
            (Some(Rigid::Codes { codes: [right, _], .. }), _) => right,
            _ => self.code,
        }
    }

    /// The pitch of a thread, program units, that is cut at `rpm`.
    fn thread_pitch(&self, rpm: f64) -> f64 {
        match (self.pitch, self.feed) {
            (Some(pitch), _) | (None, Feed::PerRevolution(pitch)) => pitch,
            (None, Feed::PerMinute(feed) | Feed::InverseTime(feed)) => feed / rpm,
        }
    }
}

/// Whether the cycle draws the tool off the wall.
const fn shifts(kind: Cycle) -> bool {
    matches!(kind, Cycle::BoreFine | Cycle::BoreBack)
}

const fn taps(kind: Cycle) -> bool {
    matches!(kind, Cycle::Tap | Cycle::TapLeft)
}

/// Whether the cycle goes down in steps.
const fn pecks(kind: Cycle) -> bool {
    matches!(kind, Cycle::Deep | Cycle::BreakChip)
}

impl CycleWords {
    pub(crate) fn new(table: &'static Table, setup: &Setup<'_>) -> Self {
        let shift = match setup.option("bore_shift") {
            Some(Value::Number(shift)) => shift,
            _ => 0.0,
        };
        let inch = setup.units == post_plugin::Units::Inch;
        let tapping = text(setup, "tapping", "rigid");
        let rigid = (tapping == "rigid").then_some(table.rigid);
        // What a pitch in the place of F counts in in an inch program no source says.
        let by_pitch = matches!(rigid, Some(Rigid::Codes { pitch, .. }) if !pitch.is_empty());
        CycleWords {
            codes: table.cycles,
            rigid,
            taps: !(tapping.is_empty() || inch && by_pitch),
            shift: if inch { shift / INCH } else { shift },
            running: None,
        }
    }

    /// Taps are written for a holder that gives way.
    pub(crate) fn floats(&self) -> bool {
        self.rigid.is_none()
    }

    /// Cycles of the control that the options leave.
    pub(crate) fn codes(&self) -> impl Iterator<Item = &'static CycleCode> {
        let (shift, settled) = (self.shift, self.taps);
        let codes = self.codes.iter();
        codes.filter(move |code| match code.kind {
            kind if shifts(kind) => shift > 0.0,
            kind => !taps(kind) || settled,
        })
    }

    pub(crate) fn capabilities(&self) -> Capabilities {
        self.codes().fold(Capabilities::NONE, |all, code| all | code.kind.capability())
    }

    /// A line of the user's own stands between its points: all is written again.
    pub(crate) fn forget(&mut self) {
        if let Some(running) = &mut self.running {
            running.first = true;
        }
    }
}

impl Engine {
    /// A cycle is in force from the next point on.
    pub(crate) fn begin_cycle(&mut self, event: &Event<'_>) -> Result<(), String> {
        let &Event::Cycle { cycle: kind, feed, depth, clearance, retract, step, dwell, pitch } =
            event
        else {
            return Err(event.refusal());
        };
        let code = self.cycles.codes().find(|code| code.kind == kind);
        let code = code.ok_or_else(|| format!("this control has no cycle of the kind {kind:?}"))?;
        let code = match dwell {
            Some(_) => code.waits,
            None => code.plain,
        };
        if code.is_empty() {
            return Err(format!(
                "this control has no cycle of the kind {kind:?} {} a dwell at the bottom",
                if dwell.is_some() { "with" } else { "without" }
            ));
        }
        if pecks(kind) && step.is_none_or(|step| step <= 0.0) {
            return Err("a cycle in steps without a step".to_owned());
        }
        if depth + clearance <= 0.0 || retract < clearance {
            return Err(format!(
                "a cycle with the depth {depth}, the clearance {clearance} and the retract {retract}: the tool would \
                 not go from the retract by the clearance to the bottom"
            ));
        }
        if matches!(feed, Feed::InverseTime(_)) {
            return Err("a cycle has no inverse-time feed".to_owned());
        }
        self.cycles.running = Some(ModalCycle {
            kind,
            code,
            feed: self.cycle_feed(kind, feed, pitch),
            depth,
            clearance,
            retract,
            step,
            dwell,
            pitch,
            first: true,
            bottom: Modal::default(),
            plane: Modal::default(),
            level: Modal::default(),
            top: None,
        });
        Ok(())
    }

    /// The feed of a thread is its pitch, times the speed as S says it where it counts by the minute.
    fn cycle_feed(&self, kind: Cycle, feed: Feed, pitch: Option<f64>) -> Feed {
        match (feed, pitch, self.turning) {
            (Feed::PerMinute(_), Some(pitch), Some(Spindle::On { rpm, .. })) if taps(kind) => {
                Feed::PerMinute(pitch * rpm.round())
            }
            (Feed::PerRevolution(_), Some(pitch), _) if taps(kind) => Feed::PerRevolution(pitch),
            _ => feed,
        }
    }

    /// The cycle in force at a point: the words have the tip on it.
    pub(crate) fn cycle_point(&mut self, words: &[f64], out: &mut String) -> Result<(), String> {
        let Some(mut running) = self.cycles.running.take() else {
            return Err("a point of a cycle, and none is in force".to_owned());
        };
        let depth = self.motion.linear[2].filter(|_| self.motion.axes.depth() == "Z");
        let [Some(x), Some(y), Some(z)] = [self.motion.linear[0], self.motion.linear[1], depth]
        else {
            return Err("cycles of this control go along Z, across X and Y".to_owned());
        };
        if running.first && !taps(running.kind) {
            self.turn_again(out)?;
        }
        let bottom = words[z] - running.depth;
        let plane = words[z] + running.clearance;
        let top = words[z] + running.retract;
        let rigid = self.cycles.rigid.filter(|_| taps(running.kind));
        if let Some(Rigid::Move(code)) = rigid {
            self.tap_by_move(code, &running, words, z, [bottom, plane, top], out)?;
            self.cycles.running = Some(running);
            return Ok(());
        }
        self.begin_anew(&mut running, [bottom, plane, top], out);
        if running.first {
            self.announce_rigid_tap(rigid, out)?;
        }
        self.tapped |= rigid.is_some();
        let level = self.return_code(&running, self.motion.stands_on(z), [plane, top])?;
        let first = std::mem::take(&mut running.first);
        if first {
            self.motion.plane_xy();
            self.motion.feed_mode(running.feed);
            running.level.forget();
            running.bottom.forget();
            running.plane.forget();
            self.motion.axes.forget_some(1 << x | 1 << y);
        }
        if let Some(level) = level.filter(|level| running.level.set(level)) {
            self.motion.block.word(level);
        }
        if first {
            self.motion.block.word(running.word(rigid));
        } else if !self.motion.axes.moved_group(words, Group::Plane) {
            // Without a word of an axis no hole is drilled.
            self.motion.axes.forget_some(1 << x);
        }
        let (style, places) = (self.motion.style, self.motion.linear_decimals(2));
        self.motion.axes.write_group(&mut self.motion.block, words, Group::Plane);
        let addresses = self.table.cycle_addresses;
        let mut levels = [
            (addresses.bottom, running.bottom.set(bottom), bottom),
            (addresses.clearance, running.plane.set(plane), plane),
        ];
        if addresses.clearance == "Z" {
            levels.reverse();
        }
        for (address, _, level) in levels.into_iter().filter(|(_, other, _)| *other) {
            self.motion.block.number(address, level, places, style);
        }
        if first {
            self.cycle_words(&running, rigid);
            match rigid {
                Some(Rigid::Codes { pitch, .. }) if !pitch.is_empty() => {
                    self.pitch_word(pitch, &running)?
                }
                // Spindle and axis are told the same thread.
                _ => self.motion.feed_again(running.feed, if taps(running.kind) { 3 } else { 0 }),
            }
            if let Some(Rigid::Beside(word)) = rigid {
                self.motion.block.word(word);
            }
            if let CycleReturn::Level { word, .. } = self.table.cycle_return {
                self.motion.block.word(word);
            }
        }
        self.motion.block.end(out);
        self.motion.at_level(words, z, top);
        self.cycles.running = Some(running);
        Ok(())
    }

    /// Where the cycle returns to a level of its own, that of the next hole: with other levels the cycle ends and begins
    /// anew, since none of them is written between holes.
    fn begin_anew(&mut self, running: &mut ModalCycle, levels: [f64; 3], out: &mut String) {
        let CycleReturn::Level { block, .. } = self.table.cycle_return else {
            return;
        };
        let [bottom, plane, top] = levels;
        let same = running.bottom.is(bottom) && running.plane.is(plane) && running.top == Some(top);
        if !running.first && same {
            return;
        }
        if let Some(stands) = running.top.filter(|_| !running.first) {
            self.rise(stands, out);
        }
        running.first = true;
        running.top = Some(top);
        let (style, places) = (self.motion.style, self.motion.linear_decimals(2));
        // The level lies along the axis across the plane in force.
        self.motion.plane_xy();
        self.motion.block.word(block).number("Z", top, places, style).end(out);
    }

    /// At rapid to the level where the tool stands behind a cycle, which ends by that.
    fn rise(&mut self, level: f64, out: &mut String) {
        let (style, places) = (self.motion.style, self.motion.linear_decimals(2));
        let block = self.motion.block.word(self.table.codes.motion[0]);
        block.number("Z", level, places, style).end(out);
        self.motion.forget_motion();
    }

    /// The code that says where the cycle returns to, `top` or `plane`, where such codes do.
    fn return_code(
        &self,
        running: &ModalCycle,
        stands: Option<f64>,
        [plane, top]: [f64; 2],
    ) -> Result<Option<&'static str>, String> {
        if self.table.cycle_return != CycleReturn::Codes {
            return Ok(None);
        }
        let level = match top > plane + 1e-9 {
            true => "G98",
            false => "G99",
        };
        let stands = stands.filter(|_| running.first);
        if let Some(stands) = stands.filter(|z| level == "G98" && (z - top).abs() > 1e-6) {
            return Err(format!(
                "a cycle begins at Z {stands}, to where it returns, and is to return to Z {top}"
            ));
        }
        Ok(Some(level))
    }

    /// Writes the block that makes the taps of a cycle rigid, where the control has one ahead of it.
    fn announce_rigid_tap(&mut self, rigid: Option<Rigid>, out: &mut String) -> Result<(), String> {
        match rigid {
            Some(Rigid::Ahead(word)) => {
                let Some(Spindle::On { rpm, .. }) = self.turning else {
                    return Err("a rigid tap without a speed of the spindle".to_owned());
                };
                self.motion.block.word(word);
                let block = &mut self.motion.block;
                block.number("S", rpm, 0, NumberStyle::default()).end(out);
            }
            Some(Rigid::Alone(word)) => self.line(word, out),
            _ => {}
        }
        Ok(())
    }

    /// Writes step, shift and wait.
    fn cycle_words(&mut self, running: &ModalCycle, rigid: Option<Rigid>) {
        let places = self.motion.linear_decimals(2);
        let style = self.motion.style;
        let q = match running.step.filter(|_| pecks(running.kind)) {
            Some(step) => Some(step),
            None => shifts(running.kind).then_some(self.cycles.shift),
        };
        let addresses = self.table.cycle_addresses;
        if let Some(q) = q {
            // Rounded down: a step is never longer than asked for.
            let scale = (0..places).fold(1.0, |scale, _| scale * 10.0);
            let q = (q * scale + 1e-6).floor().max(1.0) / scale;
            self.motion.block.number(addresses.step, q, places, style);
            if !addresses.beside_step.is_empty() {
                self.motion.block.word(addresses.beside_step);
            }
        }
        match running.dwell {
            Some(seconds) => self.wait_by(addresses.dwell, seconds),
            None if matches!(rigid, Some(Rigid::Alone(_))) => {
                // None, whatever the unit.
                let style = NumberStyle::default();
                self.motion.block.number(addresses.dwell, 0.0, 0, style);
            }
            None => {}
        }
    }

    /// Writes the pitch of a thread, mm.
    fn pitch_word(&mut self, address: &str, running: &ModalCycle) -> Result<(), String> {
        let Some(Spindle::On { rpm, .. }) = self.turning else {
            return Err("a rigid tap without a speed of the spindle".to_owned());
        };
        let pitch = running.thread_pitch(rpm);
        self.motion.block.number(address, pitch, PITCH_DECIMALS, self.motion.style);
        Ok(())
    }

    /// Down and up with the spindle, and rapids around it.
    fn tap_by_move(
        &mut self,
        code: &str,
        running: &ModalCycle,
        words: &[f64],
        z: usize,
        [bottom, plane, top]: [f64; 3],
        out: &mut String,
    ) -> Result<(), String> {
        let wanted = match running.kind {
            Cycle::TapLeft => SpindleSense::CounterClockwise,
            _ => SpindleSense::Clockwise,
        };
        let Some(Spindle::On { rpm, sense }) = self.turning.filter(|_| running.dwell.is_none())
        else {
            return Err("a rigid tap needs a turning spindle, and has no dwell".to_owned());
        };
        if sense != wanted {
            return Err("the spindle turns the other way than the thread".to_owned());
        }
        let pitch = running.thread_pitch(rpm);
        let mut level = words.to_vec();
        for height in [top, plane] {
            level[z] = height;
            self.motion.rapid(&level, out);
        }
        let (style, places) = (self.motion.style, self.motion.linear_decimals(2));
        let block = &mut self.motion.block;
        block.word(code).number("Z", bottom, places, style);
        block.number("K", pitch, places + 2, style).end(out);
        self.motion.forget_motion();
        level[z] = top;
        self.motion.rapid(&level, out);
        Ok(())
    }

    /// No cycle any more; the tool stands at the retract level.
    pub(crate) fn end_cycle(&mut self, out: &mut String) {
        let running = self.cycles.running.take();
        let by_move = running.is_some_and(|running| {
            taps(running.kind) && matches!(self.cycles.rigid, Some(Rigid::Move(_)))
        });
        match running.and_then(|running| running.top) {
            Some(top) => self.rise(top, out),
            None if !by_move => {
                self.line("G80", out);
                self.motion.forget_motion();
            }
            None => {}
        }
    }
}
