//! Polar coordinates in words of a block: `@` and `^` of LinuxCNC, distance from the origin of X and Y and angle from X.
//! The one that is not said is that of the place where the tool stands (LinuxCNC, G-code overview, polar coordinates).

use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Language;

use super::block::BlockRequest;
use super::block_words::{BlockWords, bit};
use super::state::ControlState;

impl ControlState {
    /// Takes one of both.
    pub(super) fn polar_word(
        &mut self,
        letter: u8,
        value: &NcValue,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let name = char::from(letter);
        if self.lexicon.language() != Language::Rs274 {
            let message = format!("{name} is no word that is known of this control");
            return Err(self.refuse("nc-word", message));
        }
        let worth = self.variables.worth(value);
        let worth = worth.map_err(|finding| self.placed(*finding).boxed())?;
        match words.polar[usize::from(letter == b'^')].replace(worth) {
            None => Ok(()),
            Some(_) => Err(self.refuse("nc-word", format!("{name} stands twice in one block"))),
        }
    }

    /// X and Y of the place that both say; the codes of the block were taken.
    pub(super) fn polar_place(
        &mut self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        let [radius, angle] = words.polar;
        if radius.is_none() && angle.is_none() {
            return Ok(());
        }
        let axes = bit(b'X') | bit(b'Y');
        let places = [0, 1].map(|row| self.axes.cartesian[row]);
        let plain =
            places.iter().all(|place| place.is_some_and(|place| self.axes.scale[place] == 1.0));
        // From where the other would count is another place then.
        let shifted = asked.work.is_some() || asked.frame.is_some() || asked.machine;
        let shifted = shifted && (radius.is_none() || angle.is_none());
        if words.present & axes != 0 || shifted || self.modal.incremental || !plain {
            let message = "`@` and `^` are run where X and Y are positions of axes, and neither they nor another zero stand beside them";
            return Err(self.refuse("nc-word", message));
        }
        let here = self.point();
        let [x, y] = [here[0], here[1]].map(|value| value / self.modal.unit);
        let radius = radius.unwrap_or_else(|| libm::hypot(x, y));
        let (sine, cosine) = match angle {
            Some(angle) => libm::sincos(angle.to_radians()),
            None => libm::sincos(libm::atan2(y, x)),
        };
        words.present |= axes;
        for (letter, value) in [(b'X', radius * cosine), (b'Y', radius * sine)] {
            words.values[usize::from(letter - b'A')] = value;
        }
        Ok(())
    }
}
