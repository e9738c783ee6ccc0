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
//! | G64 P Q | LinuxCNC | the path is left by no more than P, points by no more than Q (P, if it is not said) |
//! | G64 | all | the path is left, by as much as follows from the control's accelerations; so by LinuxCNC's G64 P0 |
//! | G641 | Siemens | the path is left within ADIS of a corner; if it is not said, as under G64 |
//! | G642, G643, G645, compressors | Siemens | the path is left by no more than CTOL, the tool axis by OTOL, where that is said |
//! | CYCLE832 | Siemens | its first argument is CTOL; the third is OTOL where the tens of the second are 1 |
//! | CYCL DEF 32 T | Heidenhain | the path is left by no more than T, the tool axis by TA |
//! | G187 E | Haas | the path is left by no more than E |
//!
//! Of what else smooths (G5.1 Q1, G8 P1, G5 P10000, G187 P, G644, compressors without CTOL) the rule lies in parameters of
//! the control: [`Corners::Own`]. What CTOL and OTOL are for: SINUMERIK 840D sl, Job Planning, 6FC5398-2BP20-0BA0, 8.8.

use post_motion::CornerMode;
use post_plugin::Language;

use super::state::ControlState;
use crate::Corners;
use crate::g_code::GCode;

/// What the words of a Siemens have said of smoothing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NamedSmoothing {
    /// Distance by which smoothing may leave the contour, mm: CTOL.
    contour: Option<f64>,
    /// Angle by which it may turn the tool axis off, radians: OTOL.
    turn: Option<f64>,
    /// Distance from a corner within which the control may leave the path under G641, mm: ADIS.
    distance: f64,
    /// The code of exact stop or rounding that holds: 60, 64, 641 to 645.
    code: Option<u16>,
    /// A compressor is on.
    compresses: bool,
}

impl ControlState {
    /// A word that ends smoothing or asks for the exact path; `code` is its G code, if it has one.
    pub(super) fn keeps_corners(&mut self, code: Option<GCode>) {
        if self.lexicon.language() == Language::Names {
            match code {
                Some(code) => self.modal.smoothing.code = Some(code.parts().0),
                None => self.modal.smoothing.compresses = false,
            }
            return self.settle_named();
        }
        self.smooth(None, 0.0);
        let keeps_path = self.lexicon.has_path_modes();
        self.corners(match (self.lexicon.language(), code.map(GCode::parts)) {
            (Language::Rs274, Some((61, 0))) if keeps_path => Corners::Said(CornerMode::Path),
            (Language::Rs274, Some((61, 1))) | (Language::Macro, Some((61, 0))) => {
                Corners::Said(CornerMode::Stop)
            }
            // The end of what was switched on.
            _ => Corners::Unsaid,
        });
    }

    /// A word that lets the control leave the path by `tolerance` mm, if it says how much, and points by `merged` mm;
    /// `code` as above.
    pub(super) fn leaves_corners(
        &mut self,
        code: Option<GCode>,
        tolerance: Option<f64>,
        merged: Option<f64>,
    ) {
        if self.lexicon.language() == Language::Names {
            match code {
                Some(code) => self.modal.smoothing.code = Some(code.parts().0),
                None => self.modal.smoothing.compresses = true,
            }
            return self.settle_named();
        }
        let g64 = code == Some(GCode::whole(64));
        let blends = g64 && self.lexicon.language() == Language::Rs274;
        let blends = blends && self.lexicon.has_path_modes();
        // There P0 is no tolerance.
        let tolerance = tolerance.filter(|tolerance| !blends || *tolerance > 0.0);
        let off_path = match tolerance {
            // As far as it takes to keep the speed; by parameters of the control (Fagor's G5 and G50).
            None if blends
                || self.lexicon.language() == Language::Instructions && code.is_some() =>
            {
                Some(f64::INFINITY)
            }
            said => said.map(|said| said.max(merged.filter(|_| blends).unwrap_or(0.0))),
        };
        self.smooth(off_path, 0.0);
        self.corners(match (tolerance, g64) {
            (Some(0.0), _) => Corners::Unsaid,
            (Some(_), _) | (None, true) => Corners::Said(CornerMode::Blend { tolerance }),
            (None, false) => Corners::Own,
        });
    }

    /// Heidenhain's TA: how far the tool axis may be turned off, degrees.
    pub(super) fn leaves_axis(&mut self, angle: f64) {
        self.smooth(self.state.smoothing, angle.to_radians());
    }

    /// CYCLE832 of Siemens: the path may be left by `tolerance` mm, the tool axis by `turn` degrees.
    pub(super) fn smoothing_cycle(&mut self, tolerance: Option<f64>, turn: Option<f64>) {
        self.modal.smoothing = NamedSmoothing {
            contour: tolerance.filter(|tolerance| *tolerance > 0.0),
            turn: turn.map(f64::to_radians),
            compresses: tolerance != Some(0.0),
            code: None,
            ..self.modal.smoothing
        };
        self.settle_named();
    }

    /// The end of CYCLE832 and of what it had set.
    pub(super) fn smoothing_cycle_off(&mut self) {
        self.modal.smoothing = NamedSmoothing::default();
        self.settle_named();
    }

    /// Siemens' ADIS: mm.
    pub(super) fn rounding_distance(&mut self, distance: f64) {
        self.modal.smoothing.distance = distance * self.modal.unit;
        self.settle_named();
    }

    /// Siemens' CTOL: mm; below zero it gives back what the machine's data say.
    pub(super) fn contour_tolerance(&mut self, tolerance: f64) {
        let said = (tolerance > 0.0).then_some(tolerance * self.modal.unit);
        self.modal.smoothing.contour = said;
        self.settle_named();
    }

    /// Siemens' OTOL: degrees; below zero it gives back what the machine's data say.
    pub(super) fn turn_tolerance(&mut self, angle: f64) {
        self.modal.smoothing.turn = (angle > 0.0).then(|| angle.to_radians());
        self.settle_named();
    }

    /// What follows from all that a Siemens was told.
    fn settle_named(&mut self) {
        let NamedSmoothing { contour, turn, distance, code, compresses } = self.modal.smoothing;
        let stops = code == Some(60);
        let by_tolerance = !stops && (compresses || matches!(code, Some(642 | 643 | 645)));
        let blend = |tolerance| Corners::Said(CornerMode::Blend { tolerance });
        let rounds = code == Some(641) && distance > 0.0;
        self.corners(match code {
            Some(60) => Corners::Said(CornerMode::Stop),
            _ if by_tolerance => contour.map_or(Corners::Own, |contour| blend(Some(contour))),
            Some(641) if rounds => Corners::Said(CornerMode::Within { distance }),
            Some(64 | 641) => blend(None),
            Some(_) => Corners::Own,
            None => Corners::Unsaid,
        });
        // No curve within so far of a corner is farther from it.
        let rounded = rounds.then_some(distance);
        let off_path = match by_tolerance {
            true => contour.into_iter().chain(rounded).reduce(f64::max),
            false => rounded,
        };
        self.smooth(off_path, turn.filter(|_| by_tolerance).unwrap_or(0.0));
    }

    /// How far the control may leave the path, mm, and the tool axis, radians.
    fn smooth(&mut self, off_path: Option<f64>, turn: f64) {
        if (self.state.smoothing, self.state.smoothing_turn) != (off_path, turn) {
            (self.state.smoothing, self.state.smoothing_turn) = (off_path, turn);
            self.state_changed();
        }
    }

    fn corners(&mut self, corners: Corners) {
        if self.state.corners != corners {
            self.state.corners = corners;
            self.state_changed();
        }
    }
}
