//! How the control passes from one motion to the next, as far as the rule of a word is documented.
//!
//! | word | controls | rule |
//! |---|---|---|
//! | G61 | LinuxCNC | the path is kept, and the axes stand still where its direction changes |
//! | G61 | GRBL | said to be an exact path, carried out as the control is set ($11) |
//! | G61 | Fanuc and its kin | the axes stand still at the end of every block |
//! | G61.1 | LinuxCNC | the same |
//! | G60 | Siemens | the same |
//! | G9 | Fanuc, Siemens | the same, for its block |
//! | G64 P | LinuxCNC | the path is left by no more than P |
//! | G64 | all | the path is left, by as much as follows from the control's accelerations |
//! | G641 | Siemens | the path is left within ADIS of a corner, nothing if it is not said |
//! | G642 to G645, compressors | Siemens | the path is left by no more than CTOL, where that is said |
//! | CYCLE832 | Siemens | the path is left by no more than its first argument |
//! | CYCL DEF 32 T | Heidenhain | the path is left by no more than T |
//! | G187 E | Haas | the path is left by no more than E |
//!
//! Of what else smooths (G5.1 Q1, G8 P1, G5 P10000, G187 P, compressors without CTOL) the rule lies in parameters of
//! the control: [`Corners::Own`].

use post_motion::CornerMode;
use post_plugin::Language;

use super::state::ControlState;
use crate::Corners;
use crate::g_code::GCode;

impl ControlState {
    /// A word that ends smoothing or asks for the exact path; `code` is its G code, if it has one.
    pub(super) fn keeps_corners(&mut self, code: Option<GCode>) {
        self.modal.rounds_by_distance = false;
        let keeps_path = self.lexicon.has_path_modes();
        self.corners(match (self.lexicon.language(), code.map(GCode::parts)) {
            (Language::Rs274, Some((61, 0))) if keeps_path => Corners::Said(CornerMode::Path),
            (Language::Rs274, Some((61, 1)))
            | (Language::Macro, Some((61, 0)))
            | (Language::Names, Some((60, 0))) => Corners::Said(CornerMode::Stop),
            // The end of what was switched on.
            _ => Corners::Unsaid,
        });
    }

    /// A word that lets the control leave the path by `tolerance` mm, if it says how much; `code` as above.
    pub(super) fn leaves_corners(&mut self, code: Option<GCode>, tolerance: Option<f64>) {
        let names = self.lexicon.language() == Language::Names;
        let g64 = code == Some(GCode::whole(64));
        let tolerance = match tolerance {
            None if names && !g64 => self.modal.contour_tolerance,
            said => said,
        };
        self.corners(match (tolerance, g64) {
            (Some(0.0), _) => Corners::Unsaid,
            (Some(_), _) | (None, true) => Corners::Said(CornerMode::Blend { tolerance }),
            (None, false) => Corners::Own,
        });
    }

    /// How far the control may leave the path by a word that says `tolerance` mm, or by what was said before it; `code` as
    /// above.
    pub(super) fn allowed_off_path(
        &mut self,
        code: Option<GCode>,
        tolerance: Option<f64>,
    ) -> Option<f64> {
        let language = self.lexicon.language();
        self.modal.rounds_by_distance =
            language == Language::Names && code == Some(GCode::whole(641));
        match tolerance {
            // No curve within so far of a corner is farther from it.
            None if self.modal.rounds_by_distance => Some(self.modal.rounding_distance),
            // As far as it takes to keep the speed.
            None if language == Language::Rs274
                && self.lexicon.has_path_modes()
                && code == Some(GCode::whole(64)) =>
            {
                Some(f64::INFINITY)
            }
            said => said,
        }
    }

    /// Siemens' ADIS: mm.
    pub(super) fn rounding_distance(&mut self, distance: f64) {
        self.modal.rounding_distance = distance * self.modal.unit;
        if self.modal.rounds_by_distance {
            self.smooth(Some(self.modal.rounding_distance));
        }
    }

    /// Siemens' CTOL: mm; below zero it gives back what the machine's data say.
    pub(super) fn contour_tolerance(&mut self, tolerance: f64) {
        let said = (tolerance > 0.0).then_some(tolerance * self.modal.unit);
        self.modal.contour_tolerance = said;
        let smooths = match self.state.corners {
            Corners::Own => true,
            Corners::Said(CornerMode::Blend { tolerance }) => tolerance.is_some(),
            _ => false,
        };
        if smooths {
            self.leaves_corners(None, None);
        }
    }

    fn corners(&mut self, corners: Corners) {
        if self.state.corners != corners {
            self.state.corners = corners;
            self.state_changed();
        }
    }
}
