//! What each event becomes.

use post_plugin::{Compensation, Drilling, Event, Group, NumberStyle, Spindle};

use crate::tool::tool_call;
use crate::{Heidenhain, PendingEvent, ToolCall};

impl Heidenhain {
    /// Holds an event back that waits for the tool call, and says whether it did; calls the tool ahead of those that
    /// need it. The speed belongs to the tool call, so this waits for it; what needs no tool may come between.
    fn waits_for_tool(&mut self, event: &Event<'_>, out: &mut String) -> Result<bool, String> {
        match *event {
            Event::Spindle(Spindle::On { .. })
            | Event::Comment { .. }
            | Event::Operation { .. }
            | Event::OperationEnd
            | Event::Smoothing { .. }
            | Event::SmoothingOff
            | Event::WorkOffset { .. } => {}
            Event::Preselect { number } if self.tool.is_some() => {
                self.held.push(PendingEvent::Preselect(number));
                return Ok(true);
            }
            Event::Coolant(coolant) if self.tool.is_some() => {
                self.held.push(PendingEvent::Coolant(coolant));
                return Ok(true);
            }
            Event::Word { text } if self.tool.is_some() => {
                self.held.push(PendingEvent::Word(text.to_owned()));
                return Ok(true);
            }
            _ => self.call_tool(None, out)?,
        }
        Ok(false)
    }

    pub(crate) fn put(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        self.goes_on &= matches!(event, Event::Literal { .. } | Event::Word { .. });
        self.resume(event, out);
        if self.waits_for_tool(event, out)? {
            return Ok(());
        }
        match *event {
            Event::Start => self.start(out),
            Event::Comment { text } => self.comment(text, out),
            Event::Literal { text } => {
                self.own(text, out);
                self.forget();
            }
            Event::Word { text } => self.own(text, out),
            Event::ToolChange { number, name, .. } => self.change_tool(number, name, out)?,
            Event::Preselect { number } => self.preselect(number, out)?,
            Event::Spindle(spindle) => self.turn(spindle, out)?,
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            // The radius stands in the tool table, not in a register.
            Event::Compensate(compensation) => {
                self.compensation = match compensation {
                    Compensation::Off => "R0",
                    Compensation::Left { .. } => "RL",
                    Compensation::Right { .. } => "RR",
                }
            }
            Event::Turn { .. }
            | Event::Position { .. }
            | Event::Park { .. }
            | Event::Rapid { .. }
            | Event::Linear { .. }
                if self.stays =>
            {
                return Err(
                    "`M140` retracts along the tool's axis, which no TOOL CALL has named yet: load a tool ahead of this (LOADTL; --tool N \
                     where the CL file loads none), or name another `retract`"
                        .to_owned(),
                );
            }
            Event::Turn { words } => {
                self.axes.forget();
                self.rapid_group(words, Group::Rotary, out)?;
            }
            Event::Position { words, feed, plane_first, .. } => {
                self.approach(words, feed, plane_first, out)?
            }
            Event::Retract { axes, words } => self.leave(axes, words, out),
            Event::Park { axes, words } => self.in_machine_coordinates(axes, words, out),
            Event::Rapid { words, tool } => self.go(words, tool, None, None, out)?,
            Event::Linear { words, tool, feed } => self.go(words, tool, None, Some(feed), out)?,
            Event::Surface { words, tool, feed, normal } => {
                self.go(words, tool, Some(normal), Some(feed), out)?
            }
            Event::Arc { .. } => self.arc(event, out)?,
            Event::Cycle { .. } => self.drilling = Drilling::of(event),
            Event::CyclePoint { words, .. } => self.drill(words, out)?,
            Event::CycleOff => self.drilling = None,
            Event::Plane { origin, angles, .. } => self.tilt(origin, angles, out),
            Event::PlaneOff => self.upright(out),
            Event::Smoothing { tolerance, axis_tolerance } => {
                self.smooth(Some(tolerance), axis_tolerance, out)
            }
            Event::SmoothingOff => self.smooth(None, None, out),
            Event::WorkOffset { number, .. } => self.preset(number, out),
            Event::Operation { name } => self.structure(name, out),
            Event::OperationEnd => {}
            Event::Subprogram { number, times, name } => self.subprogram(number, times, name, out),
            Event::Units(_) => {
                return Err("the units of this control stand in the first line: a program has one"
                    .to_owned());
            }
            Event::Dwell { seconds } => self.dwell(seconds, out),
            Event::Stop => self.halt("M0", out),
            Event::OptionalStop => self.halt("M1", out),
            Event::End => self.end(out),
            other => return Err(other.refusal()),
        }
        Ok(())
    }

    /// The call waits for the spindle event, whose speed it names.
    fn change_tool(&mut self, number: u32, name: &str, out: &mut String) -> Result<(), String> {
        if !name.is_empty() {
            self.comment(&format!("T{number} {name}"), out);
        }
        self.tool = Some(ToolCall::Tool(tool_call(number, name, self.tool_names)?));
        Ok(())
    }

    fn dwell(&mut self, seconds: f64, out: &mut String) {
        let [name, word] = match self.german {
            true => ["VERWEILZEIT", "V.ZEIT"],
            false => ["DWELL TIME", "DWELL"],
        };
        self.block.line(&format!("CYCL DEF 9.0 {name}"), out);
        self.block.word("CYCL DEF 9.1").word(word);
        self.block.number("", seconds, 3, NumberStyle::default()).end(out);
    }
}
