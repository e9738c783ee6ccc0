//! Polar interpolation of the control (G12.1, TRANSMIT, G112): words are right-angled coordinates on the face, and the axes go
//! in polar ones.

use std::sync::Arc;

use post_machine::diagnostic::Diagnostic;
use post_machine::face_mode::FaceMode;

use super::block::BlockRequest;
use super::block_words::{BlockWords, bit};
use super::go::{MotionTarget, shorter};
use super::state::{AxisLetters, ControlState};
use crate::{Curve, Interpolation, MotionKind};

/// An axis that is so near to a value shows it: radians and mm.
pub(super) const THERE: f64 = 1e-6;

/// What a machine is in its polar interpolation.
#[derive(Clone, Debug)]
pub(super) struct FaceWords {
    mode: Arc<FaceMode>,
    /// Which word is which axis in it.
    letters: AxisLetters,
}

/// The mode in force.
#[derive(Clone, Debug)]
pub(super) struct FaceReading {
    mode: Arc<FaceMode>,
    /// Which word is which axis outside.
    outside: AxisLetters,
    /// Coordinates of the tip on the face, mm.
    place: [f64; 2],
}

impl FaceWords {
    /// Those of a machine whose control has the mode; `outside`: which word is which axis without it.
    pub(super) fn of(
        machine: &post_machine::description::Machine,
        outside: &AxisLetters,
    ) -> Option<Self> {
        let (_, face) = machine.in_face()?;
        let mode = face.face.as_ref()?;
        let own = &machine.axes[mode.turning].name;
        let mut letters = outside.in_mode(mode.turning, [own, &mode.letter], true)?;
        let factor = face.word_map.as_ref().map_or(1.0, |map| map.factor(mode.across));
        letters.scale[mode.across] = 1.0 / factor;
        Some(Self { mode: Arc::new(mode.clone()), letters })
    }
}

impl ControlState {
    /// The control interpolates in polar coordinates from here on, by its data set of that number.
    pub(super) fn begin_face(&mut self, data_set: f64) -> Result<(), Box<Diagnostic>> {
        let Some(words) = self.face_words.clone() else {
            let word = "the control interpolates in polar coordinates from here on";
            return Err(self.unknown_mode(word, "mode.face"));
        };
        let mode = words.mode;
        let lack = self.holds_off_modes();
        let lack = lack.or_else(|| self.other_data_set(data_set, &mode.on));
        let lack = lack.or_else(|| self.stands_apart(&mode));
        if let Some(lack) = lack {
            let message = format!("polar interpolation begins, and {lack}");
            return Err(self.refuse("nc-mode", message));
        }
        let outside = std::mem::replace(&mut self.axes, words.letters);
        let place = [self.at.joints[mode.across] - mode.centre, 0.0];
        self.state.face = Some(Arc::clone(&mode));
        self.face = Some(Box::new(FaceReading { mode, outside, place }));
        self.state_changed();
        Ok(())
    }

    /// `G137 C0`: the turning axis' word beside the word of the mode is the angle from which its frame counts.
    pub(super) fn face_zero(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let turning = self.face_words.as_ref().map(|words| words.mode.turning);
        let name = turning.and_then(|place| self.machine.axes[place].name.bytes().next());
        let Some(letter) = name.filter(|letter| words.present & bit(*letter) != 0) else {
            return Ok(());
        };
        let angle = words.take(letter);
        words.present &= !bit(letter);
        match angle {
            Some(angle) if angle != 0.0 => {
                let message = format!(
                    "polar interpolation begins, and counts from {} {angle}: only from zero is it followed",
                    char::from(letter)
                );
                Err(self.refuse("nc-mode", message))
            }
            _ => Ok(()),
        }
    }

    /// Why the mode cannot begin where the axes stand.
    fn stands_apart(&self, mode: &FaceMode) -> Option<String> {
        let axis = &self.machine.axes[mode.turning];
        let turned = self.at.joints[mode.turning] - self.zero[mode.turning];
        if libm::fabs(shorter(turned, 0.0)) > THERE {
            return Some(format!(
                "{} stands at {:.3}°: the words would count from there",
                axis.name,
                turned.to_degrees()
            ));
        }
        let place = self.at.joints[mode.across] - mode.centre;
        (place < -THERE).then(|| {
            let name = &self.machine.axes[mode.across].name;
            format!("{name} stands {place:.3} mm from the centre, on the negative side")
        })
    }

    /// The axes are themselves again.
    pub(super) fn end_face(&mut self) -> Result<(), Box<Diagnostic>> {
        if self.face.is_some() && self.state.compensation != 0 {
            let message = "polar interpolation ends, and cutter compensation is in force";
            return Err(self.refuse("nc-mode", message));
        }
        if let Some(face) = self.face.take() {
            self.axes = face.outside;
            self.state.face = None;
            self.state_changed();
        }
        Ok(())
    }

    /// What is asked for beside straight moves is not followed in the mode.
    pub(super) fn alone_on_face(&self, asked: &BlockRequest) -> Result<(), Box<Diagnostic>> {
        let other = asked.machine
            || self.modal.machine
            || asked.reference.is_some()
            || asked.cycle.is_some()
            || asked.frame.is_some()
            || asked.plane.is_some()
            || asked.plane_turn.is_some()
            || asked.thread.is_some()
            || asked.work.is_some()
            || asked.change
            || asked.tcp_on
            || asked.length_off;
        match other && (self.face.is_some() || self.state.wrap.is_some()) {
            true => {
                let mode = if self.face.is_some() { "polar" } else { "cylinder" };
                let message = format!(
                    "{mode} interpolation is in force, and this is none of its straight moves: what the machine does then is not followed"
                );
                Err(self.refuse("nc-mode", message))
            }
            false => Ok(()),
        }
    }

    /// Goes straight on the face.
    pub(super) fn lead_on_face(
        &mut self,
        kind: MotionKind,
        path: &Curve,
        target: &MotionTarget,
    ) -> Result<(), Box<Diagnostic>> {
        let Some(mut face) = self.face.take() else {
            return Ok(());
        };
        let mode = Arc::clone(&face.mode);
        let unlike = *path != Curve::Straight || target.vector.is_some() || target.ways != 0;
        if let Err(turned) = self.is_unturned_in("polar") {
            self.face = Some(face);
            return Err(turned);
        }
        if unlike || self.state.compensation != 0 {
            self.face = Some(face);
            let message = "in polar interpolation straight moves to positions are followed, without cutter compensation";
            return Err(self.refuse("nc-mode", message));
        }
        if kind == MotionKind::Rapid {
            let message =
                "a rapid in polar interpolation: Fanuc's control and those after it refuse one";
            self.note(Diagnostic::warning("nc-mode", message));
        }
        let from = self.at;
        let mut joints = from.joints;
        let origin = self.to_work.origin;
        let told = (0..3).filter_map(|row| {
            let place = self.axes.cartesian[row]?;
            Some((place, self.zero[place] + origin[row] + target.point[row]?))
        });
        let said = (0..self.machine.axes.len()).filter(|place| target.said >> place & 1 == 1);
        let told: Vec<_> = told.chain(said.map(|place| (place, target.joints[place]))).collect();
        for (place, value) in told {
            if place == mode.across {
                face.place[0] = value - mode.centre;
            } else if place == mode.turning {
                face.place[1] = value - self.zero[place];
            } else {
                joints[place] = value;
            }
        }
        let joints = mode.real(face.place, &joints, from.joints[mode.turning]);
        self.face = Some(face);
        self.stand(&joints);
        self.moved(kind, Interpolation::Tip(Curve::Straight), from);
        Ok(())
    }
}
