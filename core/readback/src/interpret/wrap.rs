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
        if self.lexicon.value_letter(code).is_some() {
            return self.map_on_cylinder(code, letter, words);
        }
        let mut radius = None;
        for letter in letter.into_iter().chain([b'R']) {
            radius = words.take(letter).or(radius);
            words.present &= !bit(letter);
        }
        let radius = radius.map(|radius| radius * self.modal.unit);
        match radius.filter(|radius| *radius != 0.0) {
            None if self.wrap_words.is_some() => self.end_wrap(),
            radius => self.begin_wrap(radius, 1.0, &code.to_string()),
        }
    }

    /// G107 of Haas: the letter of a linear axis, whose words are laid along the cylinder, that of the turning axis, and R, the
    /// radius, or Q, the diameter; alone it ends the mode (Haas Automation, G107 cylindrical mapping).
    fn map_on_cylinder(
        &mut self,
        code: GCode,
        turning: Option<u8>,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let mut take = |letter: u8| {
            let value = words.take(letter);
            words.present &= !bit(letter);
            value
        };
        let mapped = [b'X', b'Y', b'Z'].into_iter().find(|letter| take(*letter).is_some());
        let turning = turning.and_then(&mut take).is_some();
        let radius = take(b'R').or(take(b'Q').map(|diameter| diameter / 2.0));
        let radius = radius.map(|radius| radius * self.modal.unit);
        let Some(mapped) = mapped.map(char::from) else {
            return match (turning, radius) {
                (false, None) => self.end_wrap(),
                _ => {
                    let message = format!(
                        "{code} without the letter of a linear axis begins no mode, and the diameter that it sets is not followed"
                    );
                    Err(self.refuse("nc-mode", message))
                }
            };
        };
        let lack = match &self.wrap_words {
            Some(WrapWords { mode, .. }) if mode.letter != mapped.to_string() || !mode.lengths => {
                format!(
                    "lengths of {mapped} along the cylinder, and [mode.wrap] has {} of {}",
                    if mode.lengths { "lengths" } else { "angles" },
                    mode.letter
                )
            }
            _ if !turning => "a cylinder, and not which axis turns it".to_owned(),
            _ if radius.is_some() => return self.begin_wrap(radius, 1.0, &code.to_string()),
            _ => "a cylinder, and not its radius: that of the last is taken".to_owned(),
        };
        Err(self.refuse("nc-mode", format!("{code} tells of {lack}")))
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
        self.is_unturned_in("cylinder")?;
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
