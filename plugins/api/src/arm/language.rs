//! What robots' languages write between the moves of an arm: remarks, and calls of what the user has on the control.

use crate::command::{Coolant, Spindle, SpindleSense};
use crate::event::Event;
use crate::number::fixed_text;
use crate::text::ascii;
use crate::vocabulary::{Meaning, VocabularyWord};

/// How a robot's language writes remarks and calls: one constant a dialect.
#[derive(Clone, Copy, Debug)]
pub struct ArmLanguage {
    /// What its lines begin with.
    pub indent: &'static str,
    /// What a remark begins with.
    pub remark: &'static str,
    /// What stands before and behind the argument of a call, and where it has none.
    pub call: [&'static str; 3],
    /// What the language calls what is called: `procedures`.
    pub kind: &'static str,
    /// What is called, with speed in 1/min: the spindle on to the right and to the left.
    pub spindle_on: [&'static str; 2],
    /// The spindle at its place.
    pub spindle_orient: &'static str,
    /// The spindle off.
    pub spindle_off: &'static str,
    /// Coolant on, with its name as a text.
    pub coolant_on: &'static str,
    /// Coolant off.
    pub coolant_off: &'static str,
    /// An optional stop, where the user has no lines of his own for it.
    pub optional_stop: &'static str,
    /// Another tool, with its number.
    pub tool_change: &'static str,
}

impl ArmLanguage {
    /// A line of the program.
    pub fn line(&self, text: &str, out: &mut String) {
        out.push_str(self.indent);
        out.push_str(text);
        out.push('\n');
    }

    /// Writes an event that leads the arm nowhere; false of any other, and of those that each language has its own way of.
    pub fn write(&self, event: &Event<'_>, out: &mut String) -> bool {
        let line = match *event {
            Event::Comment { text } => format!("{} {}", self.remark, ascii(text)),
            Event::Literal { text } | Event::Word { text } => text.to_owned(),
            Event::ToolChange { number, .. } => {
                self.called(self.tool_change, Some(&number.to_string()))
            }
            Event::Spindle(Spindle::On { rpm, sense }) => {
                let [right, left] = self.spindle_on;
                let name = if sense == SpindleSense::Clockwise { right } else { left };
                self.called(name, Some(&fixed_text(rpm, 0)))
            }
            Event::Spindle(Spindle::Off) => self.called(self.spindle_off, None),
            Event::Spindle(Spindle::Orient) => self.called(self.spindle_orient, None),
            Event::Coolant(Coolant::Off) => self.called(self.coolant_off, None),
            Event::Coolant(coolant) => {
                self.called(self.coolant_on, Some(&format!("\"{coolant:?}\"")))
            }
            _ => return false,
        };
        self.line(&line, out);
        true
    }

    fn called(&self, name: &str, argument: Option<&str>) -> String {
        let [before, behind, alone] = self.call;
        match argument {
            Some(argument) => format!("{name}{before}{argument}{behind}"),
            None => format!("{name}{alone}"),
        }
    }

    /// The names of its programs: those of the language itself, what it calls, and the first names of the lines of an
    /// optional stop.
    pub fn vocabulary(
        &self,
        own: &[(&'static str, Meaning)],
        optional_stop: &str,
    ) -> Vec<VocabularyWord> {
        let called = [
            (self.remark, Meaning::Remark),
            (self.tool_change, Meaning::ToolChange),
            (self.spindle_on[0], Meaning::SpindleClockwise),
            (self.spindle_on[1], Meaning::SpindleCounterClockwise),
            (self.spindle_off, Meaning::SpindleOff),
            (self.spindle_orient, Meaning::SpindleOrient),
            (self.coolant_on, Meaning::CoolantOn),
            (self.coolant_off, Meaning::CoolantOff),
        ];
        let known = own.iter().copied().chain(called);
        let known = known.map(|(word, meaning)| VocabularyWord::new(word, meaning));
        known.chain(VocabularyWord::first_of(optional_stop, Meaning::OptionalStop)).collect()
    }

    /// What the setup sheet says of what is called.
    pub fn relies_on(&self) -> String {
        let [right, left] = self.spindle_on;
        let Self { kind, spindle_orient, spindle_off, coolant_on, coolant_off, .. } = self;
        let Self { optional_stop, tool_change, .. } = self;
        format!(
            "the {kind} {right}, {left}, {spindle_orient}, {spindle_off}, {coolant_on}, {coolant_off}, {optional_stop} and {tool_change} are on the control, where the program calls them"
        )
    }
}
