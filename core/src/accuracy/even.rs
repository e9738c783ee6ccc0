//! `even`: as many equal pieces as the model's peak asks for.

use post_plugin::ModelSession;

use super::bisect::put_in;
use super::deviation::Move;
use super::linearise::{Linearise, Stuck};

/// More pieces than this times what the model asked for do not help: the move is not smooth.
const MOST: u32 = 4;

/// Not even a model that sees an infinite deviation gets more pieces.
const LIMIT: f64 = 1e6;

impl Linearise {
    /// Cuts a move into `n = ceil(sqrt(E/tolerance))` equal pieces, E the peak of the model: the deviation of a piece
    /// falls with the square of its length. Where the certificate finds that too few, there are more; where no
    /// number serves (close to a pole) the move is bisected.
    ///
    /// # Errors
    /// Why it cannot be done.
    pub(super) fn even(
        &mut self,
        whole: &Move<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(), Stuck> {
        let judged = self.judge(whole, model)?;
        if judged.good {
            self.keep(*whole.to, judged.bound);
            return Ok(());
        }
        let times =
            (judged.peak.tip / whole.tolerances.tip).max(judged.peak.axis / whole.tolerances.axis);
        let asked = libm::ceil(libm::sqrt(times.min(LIMIT))).max(2.0) as u32;
        let before = self.count();
        let mut count = asked;
        while count <= MOST * asked {
            if self.equal(whole, count) || (self.trust_model && self.count() > before) {
                return Ok(());
            }
            self.take_back(before);
            if count == asked {
                self.overruled += 1;
            }
            count += 1 + count / 8;
        }
        self.halve(whole, model)
    }

    /// Cuts a move into `count` equal pieces; says whether all of them are within tolerance.
    fn equal(&mut self, whole: &Move<'_>, count: u32) -> bool {
        let before = self.count();
        let mut from = *whole.from;
        let mut good = true;
        for step in 1..=count {
            let to = if step == count {
                *whole.to
            } else {
                let share = f64::from(step) / f64::from(count);
                let holds = || whole.measured().axis <= whole.tolerances.axis;
                let placed = put_in(whole, share, holds);
                let Ok(node) = placed else {
                    self.take_back(before);
                    return false;
                };
                node
            };
            let piece = Move {
                from: &from,
                to: &to,
                ..*whole
            };
            let bound = piece.certify();
            good &= whole.tolerances.hold(bound);
            self.keep(to, bound);
            if !good && !self.trust_model {
                return false;
            }
            from = to;
        }
        good
    }
}
