//! A word that goes with the way of the tip: it must go as far as that asks for.

use post_machine::description::Rapid;
use post_machine::diagnostic::Diagnostic;

use super::block_words::{BlockWords, bit};
use super::feed::tip_length;
use super::relied::ModalGroup;
use super::state::ControlState;
use crate::{BlockEffect, MotionKind};

/// What rounding makes of the word in a block, units of the word: three decimals at both ends.
const ROUNDED: f64 = 1.1e-3;

/// The way of a block differs from that of the CL file by less than this share.
const SHARE: f64 = 0.01;

/// Rounding of the ends of a way, mm.
const ENDS: f64 = 0.003;

/// Where the word stands, and what it has done since the tip last went without it, units of the word.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AlongStand {
    /// Where it stands; none: no word has said so.
    at: Option<f64>,
    /// How far it went, block by block.
    went: f64,
    /// How far the ways asked for.
    asked: f64,
    /// What rounded ends make short ways longer.
    longer: f64,
    /// What the last blocks asked for, in which it stood.
    still: f64,
}

impl AlongStand {
    /// Begins a run.
    fn anew(self) -> Self {
        Self { at: self.at, ..Self::default() }
    }
}

/// Whether a word goes as far as is asked for, but for what is rounded.
fn goes(went: f64, asked: f64, rounded: f64) -> bool {
    libm::fabs(went - asked) <= rounded + SHARE * asked
}

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
        self.along.at = said.or(self.along.at);
        if said.is_some() {
            self.modal.unset &= !ModalGroup::ExtruderStart.bit();
        }
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
        let stood = self.along.at;
        self.along.at = said.or(stood);
        if said.is_some() {
            self.relies_on(ModalGroup::Extruder);
            self.relies_on(ModalGroup::ExtruderStart);
        }
        let before = before.min(self.done.len());
        let (mut way, mut longer) = (0.0, 0.0);
        for effect in &self.done[before..] {
            match effect {
                BlockEffect::Motion(motion) if motion.kind != MotionKind::Rapid => {
                    let own = tip_length(&motion.way, &motion.from, &motion.to);
                    way += own;
                    // An end aside by r makes a way w longer by r²/2w, whichever side it is.
                    longer += (0.5 * ENDS * ENDS / own).min(ENDS);
                }
                BlockEffect::Motion(_) => self.along = self.along.anew(),
                _ => {}
            }
        }
        let per_mm = per_way / self.modal.unit;
        let asked = way * per_mm;
        let went = self.along.at.unwrap_or(0.0) - stood.unwrap_or(0.0);
        if way == 0.0 {
            // The first word says where it begins.
            let first = said.is_some() && stood.is_none();
            return match first || goes(went, 0.0, ROUNDED) {
                true => Ok(()),
                false => Err(self.goes_amiss(&name, "", went, asked)),
            };
        }
        let run = &mut self.along;
        run.still = if went == 0.0 { run.still + asked } else { 0.0 };
        if !goes(0.0, run.still, ROUNDED) {
            // It is no cut, whatever it looks like.
            *run = AlongStand { still: run.still, ..run.anew() };
            self.moves_without(before);
            // A rapid may be written as a feed move: where the machine file asks for it, and while the control keeps the tip.
            let fed = match self.machine.control.rapid {
                Some(rapid) => rapid == Rapid::Linear,
                None => self.state.tcp,
            };
            return match fed {
                true => Ok(()),
                false => Err(self.goes_amiss(&name, "", went, asked)),
            };
        }
        run.went += went;
        run.asked += asked;
        run.longer += longer * per_mm;
        if went != 0.0 {
            self.done[before..].iter_mut().for_each(|effect| {
                if let BlockEffect::Motion(motion) = effect {
                    motion.along = Some(true);
                }
            });
        }
        let AlongStand { went: all, asked: asked_in_all, longer, .. } = self.along;
        if !goes(went, asked, ROUNDED) {
            self.along = self.along.anew();
            return Err(self.goes_amiss(&name, "", went, asked));
        }
        if !goes(all, asked_in_all, 2.0 * ROUNDED + longer) {
            self.along = self.along.anew();
            let since = " in the blocks since it last stood still";
            return Err(self.goes_amiss(&name, since, all, asked_in_all));
        }
        Ok(())
    }

    /// The motions that stand in `done` from `before` on go without the word.
    fn moves_without(&mut self, before: usize) {
        for effect in &mut self.done[before..] {
            if let BlockEffect::Motion(motion) = effect {
                motion.along = Some(false);
            }
        }
    }

    fn goes_amiss(&self, name: &str, since: &str, went: f64, asked: f64) -> Box<Diagnostic> {
        let message =
            format!("{name} goes by {went:.4}{since}, and the way of the tip asks for {asked:.4}");
        self.refuse("nc-along", message)
    }
}
