//! `even`: as many equal pieces as the model's peak asks for.

use super::bisect::put_in;
use super::deviation::NodeMove;
use super::linearise::{Lineariser, PieceAssessment};
use super::node::{PathNode, PlacementError};

/// More pieces than this times what the model asked for do not help: the move is not smooth.
const MOST: u32 = 4;

/// No number of pieces helps a move that strays by more than this times its tolerance.
const LIMIT: f64 = 1e6;

/// Equal pieces that bring a deviation of `times` the tolerance within it: it falls with the square of their length.
pub(super) fn pieces(times: f64) -> u32 {
    libm::ceil(libm::sqrt(times.min(LIMIT))).max(2.0) as u32
}

impl Lineariser {
    /// Cuts a move into `n = ceil(sqrt(E/tolerance))` equal pieces, E the peak of the model. Where the certificate
    /// finds that too few, there are more. False where no number serves (close to a pole): nothing is kept then.
    pub(super) fn even(&mut self, whole: &NodeMove<'_>, judged: &PieceAssessment) -> bool {
        let (peak, tolerances) = (&judged.peak, &whole.tolerances);
        let asked = pieces((peak.tip / tolerances.tip).max(peak.axis / tolerances.axis));
        let mut count = asked;
        while count <= MOST * asked {
            let made = self.equal(whole, count, |share| {
                put_in(whole, share, || whole.measured().axis <= tolerances.axis)
            });
            if made.is_ok_and(|good| good) {
                return true;
            }
            if count == asked {
                self.overruled += 1;
            }
            count += 1 + count / 8;
        }
        false
    }

    /// Cuts a move into `count` equal pieces, whose ends `place` finds, if all of them are within tolerance or the
    /// model is trusted; else nothing is kept.
    pub(super) fn equal(
        &mut self,
        whole: &NodeMove<'_>,
        count: u32,
        mut place: impl FnMut(f64) -> Result<PathNode, PlacementError>,
    ) -> Result<bool, PlacementError> {
        let before = self.count();
        let mut from = *whole.from;
        for step in 1..=count {
            let to = if step == count {
                *whole.to
            } else {
                place(f64::from(step) / f64::from(count)).inspect_err(|_| self.take_back(before))?
            };
            let piece = NodeMove { from: &from, to: &to, ..*whole };
            let bound = piece.certify();
            if !whole.tolerances.hold(bound) && (!self.trust_model || piece.goes_another_way()) {
                self.take_back(before);
                return Ok(false);
            }
            self.keep(to, bound);
            from = to;
        }
        Ok(true)
    }
}
