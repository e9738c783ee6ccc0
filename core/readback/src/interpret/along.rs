//! A word that goes with the way of the tip: it must go as far as that asks for.

use post_machine::description::Rapid;
use post_machine::diagnostic::Diagnostic;

use super::block_words::{BlockWords, bit};
use super::feed::tip_length;
use super::state::ControlState;
use crate::{BlockEffect, MotionKind};

/// What rounding makes of the word in a block, units of the word: three decimals at both ends.
const ROUNDED: f64 = 1.1e-3;

/// The way of a block differs from that of the CL file by less than this share.
const SHARE: f64 = 0.01;

impl ControlState {
    /// Takes the word of the block whose motions stand in `done` from `before` on.
    #[inline]
    pub(super) fn along_word(
        &mut self,
        words: &mut BlockWords,
        before: usize,
    ) -> Result<(), Box<Diagnostic>> {
        match self.machine.along {
            Some(_) => self.take_along(words, before),
            None => Ok(()),
        }
    }

    /// G92 says where the word stands, if it stands in the block.
    pub(super) fn set_along(&mut self, words: &mut BlockWords) -> bool {
        let letter = self.machine.along.as_ref().and_then(|word| word.name.bytes().next());
        let said = letter.and_then(|letter| words.take(letter));
        self.along = said.or(self.along);
        said.is_some()
    }

    #[cold]
    fn take_along(&mut self, words: &mut BlockWords, before: usize) -> Result<(), Box<Diagnostic>> {
        let Some((name, per_way)) =
            self.machine.along.as_ref().map(|word| (word.name.clone(), word.per_way))
        else {
            return Ok(());
        };
        let letter = name.as_bytes().first().copied().unwrap_or(b'E');
        let said = words.get(letter);
        words.used |= bit(letter);
        let stood = self.along;
        self.along = said.or(stood);
        let cuts =
            self.done[before.min(self.done.len())..].iter().filter_map(|effect| match effect {
                BlockEffect::Motion(motion) if motion.kind != MotionKind::Rapid => {
                    Some(tip_length(&motion.way, &motion.from, &motion.to))
                }
                _ => None,
            });
        let asked = cuts.sum::<f64>() / self.modal.unit * per_way;
        let went = self.along.unwrap_or(0.0) - stood.unwrap_or(0.0);
        // The first word says where it begins.
        let first = said.is_some() && stood.is_none() && asked == 0.0;
        // A rapid may be written as a feed move: where the machine file asks for it, and while the control keeps the tip.
        let fed = match self.machine.control.rapid {
            Some(rapid) => rapid == Rapid::Linear,
            None => self.state.tcp,
        };
        let fed_rapid = went == 0.0 && fed;
        if first || fed_rapid || libm::fabs(went - asked) <= ROUNDED + SHARE * asked {
            return Ok(());
        }
        let message =
            format!("{name} goes by {went:.4}, and the way of the tip asks for {asked:.4}");
        Err(self.refuse("nc-along", message))
    }
}
