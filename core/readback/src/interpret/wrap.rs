//! Cylinder interpolation of the control (G7.1, TRACYL): the axes go as outside, and the word of the turning axis and F are
//! those of a mantle.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::wrap_mode::WrapMode;

use super::block_words::{BlockWords, bit};
use super::face::THERE;
use super::go::{MotionTarget, shorter};
use super::state::{AxisLetters, ControlState};
use crate::g_code::GCode;
use crate::{Curve, MotionKind};

/// Radii that differ by less are one, mm: words are rounded.
const SAME: f64 = 2e-3;

/// What a machine is in its cylinder interpolation.
#[derive(Clone, Debug)]
pub(super) struct WrapWords {
    mode: Arc<WrapMode>,
    /// Which word is which axis in it.
    letters: AxisLetters,
}

impl WrapWords {
    /// Those of a machine whose control has the mode; `outside`: which word is which axis without it.
    pub(super) fn of(machine: &Machine, outside: &AxisLetters) -> Option<Self> {
        let (_, wrap) = machine.in_wrap()?;
        let mode = wrap.wrap.as_ref()?;
        let own = &machine.axes[mode.turning].name;
        let mut letters = outside.in_mode(mode.turning, [own, &mode.letter], mode.lengths)?;
        if mode.lengths {
            letters.scale[mode.turning] = 1.0 / mode.radius;
        }
        Some(Self { mode: Arc::new(mode.clone()), letters })
    }
}

impl ControlState {
    /// G7.1 and its kin: the letter of the turning axis, or R, has the radius; zero or none ends the mode.
    pub(super) fn wrap_code(
        &mut self,
        code: GCode,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let own = self.wrap_words.as_ref().map(|words| words.mode.turning);
        let letter = own.and_then(|place| self.machine.axes[place].name.bytes().next());
        // Where the dialect has a letter for the radius, that of the axis is something else beside the code.
        let of_radius = self.lexicon.value_letter(code);
        let letters = if of_radius.is_some() { [None, of_radius] } else { [letter, Some(b'R')] };
        if let (Some(own), Some(right)) = (letter, of_radius)
            && words.present & bit(own) != 0
        {
            let [own, right] = [own, right].map(char::from);
            let message = format!(
                "{own} beside {code} does not say the radius of the cylinder on this control, and what it does there is not followed: {right} does"
            );
            return Err(self.refuse("nc-word", message));
        }
        let mut radius = None;
        for letter in letters.into_iter().flatten() {
            radius = words.take(letter).or(radius);
            words.present &= !bit(letter);
        }
        let radius = radius.map(|radius| radius * self.modal.unit);
        match radius.filter(|radius| *radius != 0.0) {
            None if self.wrap_words.is_some() => self.end_wrap(),
            radius => self.begin_wrap(radius, 1.0, &code.to_string()),
        }
    }

    /// The control interpolates on a cylinder from here on, whose radius (mm) `word` says, if it does, by its data set of that
    /// number.
    pub(super) fn begin_wrap(
        &mut self,
        radius: Option<f64>,
        data_set: f64,
        word: &str,
    ) -> Result<(), Box<Diagnostic>> {
        let Some(words) = self.wrap_words.clone() else {
            let word = format!("{word}: the control interpolates on a cylinder from here on");
            return Err(self.unknown_mode(&word, "mode.wrap"));
        };
        let mode = words.mode;
        let axis = &self.machine.axes[mode.turning];
        let turned = shorter(self.at.joints[mode.turning] - self.zero[mode.turning], 0.0);
        let lack = if let Some(lack) = self.holds_off_modes() {
            Some(lack)
        } else if let Some(lack) = self.other_data_set(data_set, &mode.on) {
            Some(lack)
        } else if let Some(radius) = radius.filter(|radius| (radius - mode.radius).abs() > SAME) {
            let [said, known] = [radius, mode.radius].map(Short);
            Some(format!("its radius is {said} mm, that of [mode.wrap] {known} mm"))
        } else if mode.lengths && libm::fabs(turned) > THERE {
            let turned = turned.to_degrees();
            Some(format!("{} stands at {turned:.3}°: the words would count from there", axis.name))
        } else {
            None
        };
        if let Some(lack) = lack {
            let message = format!("cylinder interpolation begins, and {lack}");
            return Err(self.refuse("nc-mode", message));
        }
        let outside = std::mem::replace(&mut self.axes, words.letters);
        self.wrap_outside = Some(Box::new(outside));
        self.state.wrap = Some(mode);
        self.state_changed();
        Ok(())
    }

    /// Words are those of the axes again.
    pub(super) fn end_wrap(&mut self) -> Result<(), Box<Diagnostic>> {
        if let Some(outside) = self.wrap_outside.take() {
            self.axes = *outside;
            self.state.wrap = None;
            self.state_changed();
        }
        Ok(())
    }

    /// The place of the turning axis, as a bit, where its word may be a length: it turns all the same.
    #[inline]
    pub(super) fn turned_by_length(&self) -> u32 {
        self.state.wrap.as_ref().map_or(0, |mode| 1 << mode.turning)
    }

    /// What is asked for beside straight moves to positions is not followed in the mode.
    pub(super) fn straight_on_mantle(
        &mut self,
        kind: MotionKind,
        path: &Curve,
        target: &MotionTarget,
    ) -> Result<(), Box<Diagnostic>> {
        let unlike = *path != Curve::Straight || target.vector.is_some() || target.ways != 0;
        if unlike || self.state.compensation != 0 {
            let message = "in cylinder interpolation straight moves to positions are followed, without cutter compensation";
            return Err(self.refuse("nc-mode", message));
        }
        if kind == MotionKind::Rapid {
            let message =
                "a rapid in cylinder interpolation: Fanuc's control and those after it refuse one";
            self.note(Diagnostic::warning("nc-mode", message));
        }
        Ok(())
    }
}
