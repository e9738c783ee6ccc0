//! Motions in machine coordinates, to reference positions, and words with a way or a sense of their own.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_grammar::nc::Approach;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, MAX_AXES};
use post_plugin::{Language, Meaning};

use super::block_words::{BlockWords, bit};
use super::go::{MotionTarget, shorter};
use super::state::{ControlState, MotionMode};
use crate::g_code::GCode;
use crate::{Curve, CycleCall, CycleKind, MotionKind, ProgramEvent, SpindleState};

impl ControlState {
    /// A motion in machine coordinates: G53, SUPA. Words alone change nothing.
    pub(super) fn machine_move(
        &mut self,
        words: &mut BlockWords,
        rapid: bool,
    ) -> Result<(), Box<Diagnostic>> {
        let said = words.present & self.axes.mask;
        words.used |= said | bit(b'H');
        if said == 0 && words.named_axes == 0 {
            return Ok(());
        }
        if self.modal.incremental && said & !words.absolute != 0 {
            return Err(self.refuse(
                "nc-machine",
                "machine coordinates are positions, and the words of this block are ways (G91)",
            ));
        }
        let mode = if rapid { MotionMode::Rapid } else { self.modal.motion };
        let kind = match mode {
            MotionMode::Rapid => MotionKind::Rapid,
            MotionMode::Linear => MotionKind::Feed,
            MotionMode::None => {
                return Err(self
                    .refuse("nc-motion", "words of axes without a word that says how they move"));
            }
            MotionMode::Clockwise | MotionMode::CounterClockwise | MotionMode::Spline => {
                return Err(self.refuse(
                    "nc-machine",
                    "machine coordinates are approached on a straight line, and a curve is in force",
                ));
            }
        };
        let mut joints = self.at.joints;
        let mut stated = words.named_axes;
        let mut left = said;
        while left != 0 {
            let letter = left.trailing_zeros() as usize % 26;
            left &= left - 1;
            let place = usize::from(self.axes.letters[letter]).min(MAX_AXES - 1);
            joints[place] = self.shown(place, words.values[letter]);
            stated |= 1 << place;
            if self.axes.rotary & (1 << place) != 0 {
                joints[place] = match words.approaches[letter]
                    .filter(|_| words.approached & (1 << letter) != 0)
                {
                    Some(approach) => self.approach(place, joints[place], Some(approach)),
                    None => {
                        let last = self.word_at(place);
                        self.turned_counting(place, joints[place], last, 0.0)
                    }
                };
            }
        }
        for (place, joint) in joints.iter_mut().enumerate() {
            if words.named_axes & (1 << place) != 0 {
                *joint = words.named_values[place];
            }
        }
        self.uncouple(&mut joints, stated);
        let letter = [b'X', b'Y', b'Z'][self.modal.plane.coordinates()[2]];
        if self.lexicon.machine_lengths_vary()
            && self.state.length_register.is_some()
            && stated & self.axes.places_of(bit(letter)) != 0
        {
            self.report.lengthened.get_or_insert(self.line);
        }
        self.go_machine(kind, &joints, stated)
    }

    /// Where a control has no words for positions of the machine, a rapid by the axes of the retract alone to where the
    /// machine file has it is the retract: the axis values, and the places of the axes that are said.
    pub(super) fn retracts(&self, words: &mut BlockWords) -> Option<(Joints, u32)> {
        /// Ends of words are rounded, mm.
        const ROUNDED: f64 = 1e-3;
        let retract = &self.machine.frame.retract;
        let plain = self.to_work.upright() && !self.modal.incremental && words.named_axes == 0;
        if !self.lexicon.has_no_positions() || retract.is_empty() || !plain {
            return None;
        }
        let (mut joints, mut said, mut letters) = (self.at.joints, 0, 0);
        for &(place, position) in retract {
            let row = self.axes.cartesian.iter().position(|known| *known == Some(place))?;
            let value = words.get(b'X' + row as u8)?;
            let at = self.zero[place] + self.to_work.origin[row] + value * self.modal.unit;
            if libm::fabs(at - position) > ROUNDED {
                return None;
            }
            joints[place] = at;
            said |= 1 << place;
            letters |= bit(b'X' + row as u8);
        }
        if words.present & self.axes.mask != letters {
            return None;
        }
        words.used |= letters;
        Some((joints, said))
    }

    /// Goes to `joints`, which the program states as positions of the machine; those of the places in `said` are stated.
    pub(super) fn go_machine(
        &mut self,
        kind: MotionKind,
        joints: &Joints,
        said: u32,
    ) -> Result<(), Box<Diagnostic>> {
        self.in_machine = true;
        self.said |= said;
        // A control whose kinematics are switched has no other coordinates than those of the tip then.
        let went = if self.state.tcp && self.lexicon.language() == Language::Rs274 {
            self.go_world(kind, joints, said)
        } else {
            self.go_joints(kind, joints);
            Ok(())
        };
        self.in_machine = false;
        went
    }

    /// Machine coordinates of the kinematics that keep the tip: those of the axes with the rotary ones at zero, fixed to
    /// the part.
    fn go_world(
        &mut self,
        kind: MotionKind,
        joints: &Joints,
        said: u32,
    ) -> Result<(), Box<Diagnostic>> {
        let mut world = self.at.joints;
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if axis.joint.rotary {
                world[place] = -axis.zero;
            }
        }
        let solver = std::sync::Arc::clone(&self.state.solver);
        let turns = solver.chain().turns(&world);
        if solver.place(self.at.pose.tip, &mut world, &turns).is_err() {
            return Err(self.refuse(
                "nc-reach",
                "the linear axes do not place the tip with the rotary axes at zero",
            ));
        }
        let mut target = MotionTarget::default();
        for place in 0..self.machine.axes.len() {
            if said & (1 << place) == 0 {
                continue;
            }
            if self.axes.cartesian.contains(&Some(place)) {
                world[place] = joints[place];
            } else {
                target.say(place, joints[place]);
            }
        }
        let tip = self.to_part.inside(solver.chain().forward(&world).tip);
        target.point = [Some(tip.x), Some(tip.y), Some(tip.z)];
        self.go(kind, &Curve::Straight, &target)
    }

    /// The axis value (from the drawing's zero, mm or radians) of a machine coordinate in program units.
    pub(super) fn shown(&self, place: usize, value: f64) -> f64 {
        let axis = &self.machine.axes[place];
        let value = value * self.axes.scale[place];
        let value = if axis.joint.rotary { value.to_radians() } else { value * self.modal.unit };
        value - axis.zero
    }

    /// G28, G30: by way of the point that is said to the reference position, axis by axis.
    pub(super) fn reference(
        &mut self,
        which: u8,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        words.used |= bit(b'P');
        let said = words.present & self.axes.mask;
        let target = self.target(words)?;
        let mut places = Vec::new();
        for letter in b'A'..=b'Z' {
            if let (true, Some(place)) = (said & bit(letter) != 0, self.axis_of(letter)) {
                places.push(place);
            }
        }
        if places.is_empty() {
            // LinuxCNC and the names' controls take all axes along.
            match self.lexicon.language() {
                Language::Rs274 => places.extend(0..self.machine.axes.len()),
                _ => {
                    return Err(self.refuse(
                        "nc-reference",
                        "no axis is said that goes to its reference position",
                    ));
                }
            }
        }
        self.go(MotionKind::Rapid, &Curve::Straight, &MotionTarget { vector: None, ..target })?;
        let mut joints = self.at.joints;
        let mut stated = 0;
        for place in places {
            joints[place] = self.reference_position(which, place);
            stated |= 1 << place;
        }
        self.go_machine(MotionKind::Rapid, &joints, stated)
    }

    /// Where an axis has its reference position: as `--offsets` says, else at machine coordinate 0.
    fn reference_position(&mut self, which: u8, place: usize) -> f64 {
        let name = &self.machine.axes[place].name;
        let mut list = self.offsets.references.iter();
        let said = list.find(|reference| reference.which == which && reference.axis == *name);
        if let Some(reference) = said {
            return reference.value - self.machine.axes[place].zero;
        }
        let message =
            "reference positions of which nothing is said are taken to be machine coordinate 0";
        self.note(
            Diagnostic::warning("nc-reference", message).help(
                "state it by --offsets, in a table [reference.1] (G28) or [reference.2] (G30)",
            ),
        );
        -self.machine.axes[place].zero
    }

    /// A straight move tied to the spindle: `G33 Z K`; `G33.1` comes back with the spindle reversed.
    pub(super) fn thread(
        &mut self,
        code: GCode,
        meaning: Meaning,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        if meaning == Meaning::ThreadBack || self.lexicon.language() == Language::Names {
            let message =
                format!("{code} is not run: how its pitch is stated hangs on the control");
            return Err(self.refuse("nc-thread", message));
        }
        let Some(pitch) = words.take(b'K').filter(|pitch| *pitch > 0.0) else {
            let message = format!("{code} does not say its pitch K");
            return Err(self.refuse("nc-thread", message));
        };
        let pitch = pitch * self.modal.unit;
        let target = self.target(words)?;
        let from = self.point();
        let to = Vector3::from_fn(|row, _| target.point[row].unwrap_or(from[row]));
        let tap = meaning == Meaning::ThreadAndBack;
        if tap {
            let left = matches!(self.state.spindle, SpindleState::CounterClockwise(_));
            self.tell(ProgramEvent::Cycle(CycleCall {
                kind: if left { CycleKind::TapLeft } else { CycleKind::Tap },
                depth: (to - from).norm(),
                feed: pitch,
                per_revolution: true,
                ..CycleCall::default()
            }));
        }
        let before = (self.modal.feed, self.hole);
        self.modal.feed = Some(pitch);
        self.hole |= tap;
        let mut went = self.go(MotionKind::Thread, &Curve::Straight, &target);
        if tap && went.is_ok() {
            went = self.straight(MotionKind::Thread, from);
        }
        (self.modal.feed, self.hole) = before;
        if tap {
            self.tell(ProgramEvent::CycleEnd);
        }
        went
    }

    /// The value to which a rotary axis goes where the word says how it turns.
    pub(super) fn approach(&self, place: usize, value: f64, approach: Option<Approach>) -> f64 {
        let last = self.at.joints[place];
        let near = shorter(value, last);
        // Within this of where it stands it does not turn round once more.
        let there = libm::fabs(near - last) < 1e-9;
        match approach {
            Some(Approach::Positive) if near < last && !there => near + TAU,
            Some(Approach::Negative) if near > last && !there => near - TAU,
            Some(Approach::Shortest | Approach::Positive | Approach::Negative) => near,
            _ => value,
        }
    }

    /// I J K as the tool axis; what is not said is zero, as the manuals of such words have it.
    pub(super) fn vector_words(&self, words: &mut BlockWords, target: &mut MotionTarget) {
        if words.present & (bit(b'I') | bit(b'J') | bit(b'K')) == 0 {
            return;
        }
        let mut part = |letter| words.take(letter).unwrap_or(0.0);
        target.vector = Some(Vector3::new(part(b'I'), part(b'J'), part(b'K')));
    }

    /// Numbers without a point: some controls count them in their least increment.
    #[cold]
    pub(super) fn least_increments(
        &mut self,
        words: &BlockWords,
        letters: u32,
    ) -> Result<(), Box<Diagnostic>> {
        if self.lexicon.counts_by_point() && words.present & letters & words.pointless != 0 {
            let message = "axis words without a decimal point are taken in the units of the program: by a parameter of the control they may be its least increments";
            self.note(Diagnostic::warning("nc-number", message));
        }
        Ok(())
    }
}
