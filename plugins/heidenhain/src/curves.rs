//! Arcs and helices about the tool axis.

use post_plugin::{Block, Event, NumberStyle};

use crate::{Heidenhain, SIGNED};

/// Decimals of a helix' angle.
const ANGLE: u8 = 5;

impl Heidenhain {
    /// Writes an arc by its centre (`CC` and `C`, a helix as `CC` and `CP`), or by its radius (`CR`).
    pub(crate) fn arc(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let (&Event::Arc { feed, centre, normal, turn, radius, words, .. }, Some([x, y, z])) =
            (event, self.linear)
        else {
            return Err(event.refusal());
        };
        if normal[2].abs() < 0.999_999 || self.at.is_empty() {
            return Err("an arc needs a start, and its plane is X Y".to_owned());
        }
        // Seen from the spindle.
        let turn = turn * normal[2].signum();
        let sense = if turn > 0.0 { "DR+" } else { "DR-" };
        let rise = words[z] - self.at[z];
        let place = 1 << x | 1 << y;
        // A helix has a centre alone.
        let radius = radius.filter(|_| rise == 0.0);
        let trim = NumberStyle { trim: true, ..SIGNED };
        if radius.is_none() {
            self.block.word("CC");
            self.block.number("X", centre[0], self.decimals, SIGNED);
            self.block.number("Y", centre[1], self.decimals, SIGNED).end(out);
        }
        match radius {
            None if rise != 0.0 || turn.abs() > 360.0 => {
                self.block.word("CP").number("IPA", turn, ANGLE, trim);
                self.block.number("IZ", rise, self.decimals, SIGNED);
                // No block has its words: those of the next move are all written.
                let all = place | 1 << z;
                self.axes.write_machine(&mut Block::plain(), all, words);
            }
            None => {
                self.block.word("C");
                self.axes.write_machine(&mut self.block, place, words);
            }
            Some(radius) => {
                self.block.word("CR");
                self.axes.write_machine(&mut self.block, place, words);
                self.block.number("R", radius, self.decimals, SIGNED);
            }
        }
        self.block.word(sense);
        self.finish_move(Some(feed), true, out)?;
        self.stand(words);
        Ok(())
    }

    /// A hole: the definition of its cycle, if it is not in force, and its place with the call.
    pub(crate) fn drill(&mut self, words: &[f64], out: &mut String) -> Result<(), String> {
        let (Some([x, y, z]), Some(drilling)) = (self.linear, self.drilling) else {
            return Err("a point of a cycle comes without its cycle".to_owned());
        };
        let definition = self.cycles.definition(&drilling, words[z], self.rpm)?;
        if definition != self.defined {
            self.block.line(&definition, out);
            self.defined = definition;
        }
        self.block.word("L");
        // Both words, whatever was written before; what is known of the depth stays true at the end of the hole.
        self.axes.write_machine(&mut self.block, 1 << x | 1 << y, words);
        if self.radius.set("R0") {
            self.block.word("R0");
        }
        self.block.line("FMAX M99", out);
        // It has come back to the level between the holes.
        self.stand(words);
        self.at[z] += drilling.retract;
        Ok(())
    }

    /// How far the control may leave the path, mm and degrees; none: as its builder has set it.
    pub(crate) fn smooth(&mut self, tolerance: Option<f64>, axis: Option<f64>, out: &mut String) {
        let name = if self.german { "TOLERANZ" } else { "TOLERANCE" };
        self.block.line(&format!("CYCL DEF 32.0 {name}"), out);
        self.block.word("CYCL DEF 32.1");
        let Some(tolerance) = tolerance else {
            self.block.end(out);
            return;
        };
        let trim = NumberStyle { trim: true, ..NumberStyle::default() };
        self.block.number("T", self.datum.length(tolerance), 5, trim).end(out);
        // Roughing is for speed, finishing for the path.
        let mode = u8::from(tolerance >= 0.05);
        self.block.word("CYCL DEF 32.2").word(&format!("HSC-MODE:{mode}"));
        if let Some(axis) = axis {
            self.block.number("TA", axis, 4, trim);
        }
        self.block.end(out);
    }
}
