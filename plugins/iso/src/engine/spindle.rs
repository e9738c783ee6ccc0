//! Spindle, coolant, and the stops that switch them off.

use post_plugin::{Coolant, Event, NumberStyle, Spindle, SpindleSense};

use super::{Engine, one_by_one};

/// Coolants in the order of [`crate::Table::coolant`], with the options that say what switches them on and off.
pub(super) const COOLANTS: [(Coolant, &str, &str); 5] = [
    (Coolant::Off, "coolant_off", "coolant_off"),
    (Coolant::Flood, "coolant_flood", "coolant_off"),
    (Coolant::Mist, "coolant_mist", "coolant_mist_off"),
    (Coolant::Through, "coolant_through", "coolant_through_off"),
    (Coolant::Air, "coolant_air", "coolant_air_off"),
];

impl Engine {
    /// The spindle turns again after a rigid tap, which has stopped it.
    pub(crate) fn turn_again(&mut self, out: &mut String) -> Result<(), String> {
        match self.turning {
            Some(spindle) if std::mem::take(&mut self.tapped) => self.turn(spindle, out),
            _ => Ok(()),
        }
    }

    pub(crate) fn turn(&mut self, spindle: Spindle, out: &mut String) -> Result<(), String> {
        let [clockwise, counter, off, orient] = self.table.spindle;
        let on = matches!(spindle, Spindle::On { .. });
        self.spindle.set(on);
        self.turning = on.then_some(spindle);
        self.tapped = false;
        if let Some(fixed) = self.end_surface_speed() {
            // The next speed is one in revolutions, whatever stands between.
            self.motion.block.word(fixed);
        }
        match spindle {
            Spindle::Off => self.line(off, out),
            Spindle::Orient if orient.is_empty() => {
                return Err("this dialect has no words for an oriented stop".to_owned());
            }
            Spindle::Orient => self.line(orient, out),
            Spindle::On { .. } if clockwise.is_empty() => {
                return Err("this control has no words for a spindle".to_owned());
            }
            Spindle::On { rpm, sense } => {
                let block = &mut self.motion.block;
                let word = match sense {
                    SpindleSense::Clockwise => clockwise,
                    SpindleSense::CounterClockwise => counter,
                };
                let command_first = self.table.command_a_line;
                if command_first {
                    block.word(word);
                }
                block.number("S", rpm, 0, NumberStyle::default());
                if !command_first {
                    block.word(word);
                }
                block.end(out);
            }
        }
        Ok(())
    }

    /// The spindle turns by a command other than [`Event::Spindle`].
    pub(crate) fn spindle_turns(&mut self) {
        self.spindle.set(true);
        self.turning = None;
    }

    pub(super) fn cool(&mut self, coolant: Coolant, out: &mut String) -> Result<(), String> {
        let known = COOLANTS.iter().position(|(known, ..)| *known == coolant);
        let place = known.unwrap_or_default();
        if coolant == Coolant::Off {
            self.end_coolant(out);
            return Ok(());
        }
        if self.coolant_codes[place].is_empty() {
            let option = COOLANTS[place].1;
            let offered = self.table.options.iter().any(|spec| spec.key == option);
            return Err(match offered {
                true => format!(
                    "the M code of this coolant is the machine builder's: set the option `{option}`"
                ),
                false => "this control has no such coolant".to_owned(),
            });
        }
        if self.flowing.is_some_and(|flowing| flowing != place) {
            // One coolant takes the place of another.
            self.end_coolant(out);
        }
        self.coolant.set(true);
        self.flowing = Some(place);
        one_by_one(&self.coolant_codes[place], &mut self.motion, out);
        Ok(())
    }

    /// What ends the coolant that is on; where it is not known, all of them.
    pub(super) fn end_coolant(&mut self, out: &mut String) {
        let flowing = self.flowing.take().unwrap_or_default();
        one_by_one(&self.coolant_ends[flowing], &mut self.motion, out);
        self.coolant.set(false);
    }

    /// A stop; what it has switched off is on again once the tool needs it.
    pub(super) fn stop(&mut self, word: &str, out: &mut String) -> Result<(), String> {
        if word.is_empty() {
            return Err("this control has no word for such a stop".to_owned());
        }
        self.line(word, out);
        let stops = self.table.stops;
        self.standstill.stop(stops.spindle, stops.coolant);
        Ok(())
    }

    /// Ahead of `event`: what a stop has switched off, if the tool needs it now.
    #[inline]
    pub(crate) fn resume(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match self.standstill.before(event) {
            [false, false] => Ok(()),
            due => self.switch_on(due, out),
        }
    }

    #[cold]
    fn switch_on(&mut self, [spindle, coolant]: [bool; 2], out: &mut String) -> Result<(), String> {
        if spindle {
            match self.turning {
                Some(spindle) => self.turn(spindle, out)?,
                None => self.surface_speed_again(out)?,
            }
        }
        if let (true, Some(flowing)) = (coolant, self.flowing) {
            one_by_one(&self.coolant_codes[flowing], &mut self.motion, out);
        }
        Ok(())
    }
}
