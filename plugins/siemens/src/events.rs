//! What events become that the engine has no words for.

use post_iso::{Control, Engine};
use post_plugin::{Compensation, Cycle, Drilling, Event, Spindle};

use crate::Siemens;
use crate::table::is_work_offset;
use crate::text::{callable, called, message};

impl Siemens {
    /// Writes an event, and says whether it was written: else the engine writes it.
    pub(crate) fn put(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        if !matches!(event, Event::CyclePoint { .. } | Event::Comment { .. }) {
            self.end_call(engine, out);
        }
        if self.oriented && cuts(event) {
            self.turn_again(engine, out);
        }
        self.motion_event(event, engine, out)
    }

    /// Writes the start of the program and moves, hands on all others.
    fn motion_event(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        match *event {
            Event::Start => {
                engine.motion.axes.shorter_way("=DC(", ")");
                if self.modulo {
                    let ways = ["=DC(", "=ACP(", "=ACN("];
                    engine.motion.axes.modulo(ways, ")");
                }
                if !self.header.is_empty() {
                    engine.bare(&self.header, out);
                }
                self.plane.set("G17");
                self.tcp_active.set(false);
                return Ok(false);
            }
            Event::Linear { words, .. } | Event::Arc { words, .. }
                if let Some(axis) =
                    engine.motion.axes.turns_round(words).filter(|_| !self.by_vector()) =>
            {
                return Err(format!(
                    "{axis} turns by a whole turn or more in one block, which the words of a modulo axis cannot say: \
                     endless = \"counted\" where the control counts turns"
                ));
            }
            Event::Rapid { words, tool } if self.by_vector() => {
                self.go(words, tool, None, engine, out)
            }
            Event::Linear { words, tool, feed } if self.by_vector() => {
                self.go(words, tool, Some(feed), engine, out);
            }
            Event::Rapid { words, .. } | Event::Linear { words, .. } => {
                self.stand(words);
                return Ok(false);
            }
            Event::Position { words, feed, plane_first, .. } => {
                self.position(words, feed, plane_first, engine, out)?;
            }
            Event::Park { .. } => {
                self.length.set(false);
                return Ok(false);
            }
            Event::Retract { .. } => {
                self.length.set(false);
                engine.motion.settle(out);
                if self.rotary && self.tcp_active.set(false) {
                    engine.line(&self.tcp_off, out);
                    self.offset_may_be_off(engine);
                }
                return Ok(false);
            }
            _ => return self.tool_event(event, engine, out),
        }
        Ok(true)
    }

    /// Writes events of tool, spindle and compensation, hands on all others.
    fn tool_event(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        match *event {
            Event::ToolChange { number, register, name, .. }
                if self.tool_names && !name.is_empty() =>
            {
                self.changed();
                engine.change(number, &called(name)?, register, name, out);
            }
            Event::ToolChange { .. } => {
                self.changed();
                return Ok(false);
            }
            Event::Preselect { number } => {
                let name =
                    self.names.iter().find(|(known, name)| *known == number && !name.is_empty());
                match name {
                    Some((_, name)) if self.tool_names => engine.line(&called(name)?, out),
                    _ => return Ok(false),
                }
            }
            Event::Spindle(spindle) => {
                self.oriented = false;
                self.turning = match spindle {
                    Spindle::On { rpm, sense } => Some((rpm, sense)),
                    Spindle::Off | Spindle::Orient => None,
                };
                return Ok(false);
            }
            Event::SurfaceSpeed { .. } => {
                self.turning = None;
                return Ok(false);
            }
            Event::Compensate(Compensation::Left { .. } | Compensation::Right { .. })
                if self.across != "G17" =>
            {
                return Err(
                    "radius compensation lies across Z, and the tool does not, or turns".to_owned()
                );
            }
            Event::Compensate(_) => {
                self.upright(engine, out);
                return Ok(false);
            }
            _ => return self.cycle_event(event, engine, out),
        }
        Ok(true)
    }

    /// Writes cycles, planes and all other events.
    fn cycle_event(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        match *event {
            Event::Arc { .. } => self.arc(event, engine, out)?,
            Event::Cycle { .. } => self.drilling = Drilling::of(event),
            Event::CyclePoint { words, .. } => self.drill(words, engine, out)?,
            Event::CycleOff => self.drilling = None,
            Event::Plane { origin, angles, words, .. } => {
                // The cycle asks for a tool with its length.
                self.length_on(engine, out);
                engine.line(&self.swivel.plane(origin, angles, words), out);
                self.tilted = true;
            }
            Event::PlaneOff => {
                engine.line("CYCLE800()", out);
                self.tilted = false;
            }
            Event::Smoothing { tolerance, axis_tolerance } => {
                engine.line(&self.smoothing.on(tolerance, axis_tolerance), out);
            }
            Event::SmoothingOff => engine.line(self.smoothing.off(), out),
            Event::Operation { name } => {
                if !name.is_empty() {
                    engine.remark(name, out);
                }
                if self.messages {
                    engine.line(&message(name), out);
                }
            }
            Event::OperationEnd => {}
            Event::Message { text } => engine.line(&message(text), out),
            Event::WorkOffset { number, .. } => {
                self.own_offset = false;
                self.offset = (Self::TABLE.offset.word)(number).unwrap_or_default();
                return Ok(false);
            }
            Event::Tcp { on } => {
                let line = if on { &self.tcp_on } else { &self.tcp_off };
                engine.line(line, out);
                self.tcp_active.set(on);
                self.offset_may_be_off(engine);
                engine.motion.axes.forget();
            }
            Event::Subprogram { number, name, .. } => {
                if number.is_none() {
                    callable(name)?;
                }
                self.forget();
                return Ok(false);
            }
            Event::Probe { words, feed, .. } => {
                engine.motion.block.word("MEAS=1");
                engine.motion.arrive(words, None, Some(feed), "", out);
                engine.motion.moved_by_line();
            }
            Event::Literal { text } => {
                if let Some(own) = text.split_whitespace().find(|word| is_work_offset(word)) {
                    self.own_offset = true;
                    self.offset = own.to_owned();
                }
                self.forget();
                return Ok(false);
            }
            // Lines that begin and end polar and cylinder interpolation.
            Event::Word { text } if text.contains(&self.tcp_off) => {
                self.offset_may_be_off(engine);
                return Ok(false);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// The spindle must turn for it, and nothing in it has it turn: boring and tapping cycles do that themselves.
fn cuts(event: &Event<'_>) -> bool {
    match *event {
        Event::Linear { .. }
        | Event::Arc { .. }
        | Event::Spline { .. }
        | Event::Position { .. }
        | Event::Literal { .. }
        | Event::Subprogram { .. } => true,
        Event::Cycle { cycle, .. } => {
            !matches!(cycle, Cycle::Bore | Cycle::BoreFine | Cycle::Tap | Cycle::TapLeft)
        }
        _ => false,
    }
}
