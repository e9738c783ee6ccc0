//! A control as it is when a program begins, and what all that work on it share.

use std::sync::Arc;

use nalgebra::Matrix3;
use post_machine::axis_words::{is_diameter, unit_length};
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::chain::turn;
use post_machine::kinematics::{Joints, MAX_AXES, Turns};
use post_machine::tilted_plane::TiltedPlane;
use post_machine::wait_rule::WaitRule;
use post_plugin::{Language, Lengths};

use super::ReadReport;
use super::along::AlongStand;
use super::block_words::bit;
use super::face::FaceWords;
use super::frame::{CoordinateFrame, FrameStack};
use super::relied::ModalGroup;
use super::state::{
    ArcPlane, AxisLetters, ControlState, FeedMeaning, ModalState, MotionMode, MountedHead,
    OrientationMode, ReturnTo,
};
use super::wrap::WrapWords;
use crate::lexicon::Lexicon;
use crate::{
    BlockEffect, Coolants, Corners, MachineState, Offsets, ProgramEvent, SpindleState, Stance,
    Standstill,
};

/// Lengths that are kept ready.
const SOLVERS: usize = 64;

/// Notes that are kept.
const NOTES: usize = 100;

/// Unknown words that are counted apart.
const UNKNOWN: usize = 1000;

/// How much of its axis a word of one axis alone is, by place, as the machine file has it. Those of several axes are made by
/// the whole map.
fn described_scale(machine: &Machine) -> [f64; MAX_AXES] {
    let Some(map) = &machine.word_map else { return [1.0; MAX_AXES] };
    std::array::from_fn(|place| if map.is_coupled(place) { 1.0 } else { 1.0 / map.factor(place) })
}

impl AxisLetters {
    fn new(machine: &Machine) -> Self {
        let mut axes = Self {
            letters: [Self::NONE; 26],
            names: Vec::new(),
            cartesian: [None; 3],
            mask: 0,
            rotary: 0,
            scale: [1.0; MAX_AXES],
            coupled: None,
        };
        if let Some(map) = &machine.word_map {
            axes.scale = described_scale(machine);
            axes.coupled = Some(map).filter(|map| map.couples()).cloned().map(Arc::new);
        }
        for (place, axis) in machine.axes.iter().enumerate() {
            axes.rotary |= u32::from(axis.joint.rotary) << place;
            match axis.word().as_bytes() {
                [letter @ b'A'..=b'Z'] => {
                    let letter = usize::from(letter - b'A');
                    axes.letters[letter] = u8::try_from(place).unwrap_or(Self::NONE);
                    axes.mask |= 1 << letter;
                }
                _ => axes.names.push((axis.word().to_owned(), place)),
            }
            let coordinate = ["X", "Y", "Z"].iter().position(|name| *name == axis.word());
            if let (Some(coordinate), false) = (coordinate, axis.joint.rotary) {
                axes.cartesian[coordinate] = Some(place);
            }
        }
        axes
    }

    /// Words with X, Y and Z are the coordinates, as far as the machine has such axes; F is none.
    pub fn are_cartesian(&self) -> bool {
        let own = |row: usize| {
            let letter = 23 + row;
            self.mask & (1 << letter) == 0
                || self.cartesian[row] == Some(usize::from(self.letters[letter]))
        };
        self.mask & bit(b'F') == 0 && (0..3).all(own)
    }

    /// Bits of the places of the axes whose letters are those of `letters`.
    pub fn places_of(&self, letters: u32) -> u32 {
        let letters_of = |letter: &usize| letters & self.mask & (1 << letter) != 0;
        (0..26).filter(letters_of).fold(0, |places, letter| places | 1 << self.letters[letter])
    }
}

impl ControlState {
    /// A control at the beginning of a program: axes at their zeros, no length, the machine file's work offset.
    ///
    /// # Errors
    /// The machine cannot be solved.
    pub fn new(
        machine: &Machine,
        lexicon: &Lexicon,
        offsets: &Offsets,
        file: &str,
    ) -> Result<Self, Box<Diagnostic>> {
        let solver = machine.solver(0.0).map_err(|lack| machine.unsolvable(&lack).boxed())?;
        let solver = Arc::new(solver);
        let heads = machine.named_heads();
        let heads = heads
            .map(|head| MountedHead {
                name: head.name.clone(),
                word: head.word.clone(),
                machine: Arc::new(head.machine.clone()),
            })
            .collect();
        let axes = AxisLetters::new(machine);
        let mut control = Self {
            file: file.to_owned(),
            lexicon: lexicon.clone(),
            declared: machine.declared_lines(),
            waits: machine.wait.as_ref().map(WaitRule::lines),
            offsets: offsets.clone(),
            machine: Arc::new(machine.clone()),
            heads,
            head_by_hand: None,
            face_words: FaceWords::of(machine, &axes),
            face: None,
            wrap_words: WrapWords::of(machine, &axes),
            wrap_outside: None,
            axes,
            modal: ModalState::new(lexicon, machine),
            frames: FrameStack::default(),
            work: None,
            offsets_told: false,
            tools: super::tools::ToolState::default(),
            variables: super::variables::Variables::new(lexicon.language()),
            cycles: super::cycles::CycleState::default(),
            clamps: super::clamps::ClampState::default(),
            spline: None,
            joint_variable: super::statements::JointVariable::default(),
            robot_frames: super::robot_frames::RobotFrames::default(),
            lengths_by_plane: lexicon.tools_have_edges() && turns_in_zx(machine),
            path_velocity: None,
            path: super::conversational::PathMemory::default(),
            state: MachineState {
                solver: Arc::clone(&solver),
                length: 0.0,
                tool: None,
                length_register: None,
                length_of_spindle: false,
                radius_register: None,
                compensation: 0,
                tcp: false,
                plane: None,
                face: None,
                wrap: None,
                work_offset: None,
                offset_assumed: false,
                spindle: SpindleState::Off,
                coolants: Coolants::default(),
                standstill: Standstill::default(),
                operation: None,
                smoothing: None,
                smoothing_turn: 0.0,
                corners: Corners::Unsaid,
            },
            shared: None,
            said: 0,
            led: 0,
            fed: false,
            begun: false,
            at: Stance::default(),
            turns: Turns::default(),
            ended: false,
            in_machine: false,
            exact_stop: false,
            hole: false,
            zero: Joints::default(),
            origin: Joints::default(),
            to_part: CoordinateFrame::default(),
            to_work: CoordinateFrame::default(),
            line: 0,
            number: None,
            report: ReadReport::default(),
            done: Vec::new(),
            along: AlongStand::default(),
            solvers: vec![(0.0, solver)],
        };
        control.stand(&start(machine));
        // A program that names no tool is of the one in the spindle.
        let first = offsets.tools.first().map(|(_, length)| *length);
        let length = offsets.length.or(first).filter(|_| lexicon.lengths() == Lengths::WorkOffset);
        match length {
            Some(length) => {
                control.state.length = length;
                control.solver_changed()?;
            }
            None => control.recount()?,
        }
        Ok(control)
    }

    /// Whether the linear words are the tip, whether control or post keeps it.
    #[inline]
    pub fn tip_words(&self) -> bool {
        self.state.tcp || self.frames.plane.is_some()
    }

    /// Something was told.
    pub fn tell(&mut self, event: ProgramEvent) {
        self.hand_on_state();
        let line = self.line;
        self.done.push(BlockEffect::Event { line, event });
    }

    /// Something of `state` is another.
    #[inline]
    pub fn state_changed(&mut self) {
        self.shared = None;
    }

    /// The state that motions share; what changed is handed on first.
    #[inline]
    pub fn hand_on_state(&mut self) -> Arc<MachineState> {
        if let Some(shared) = &self.shared {
            return Arc::clone(shared);
        }
        let shared = Arc::new(self.state.clone());
        self.done.push(BlockEffect::State(Arc::clone(&shared)));
        self.shared = Some(Arc::clone(&shared));
        shared
    }

    /// The state as it is, whether a motion has shared it or not.
    pub fn state_now(&self) -> Arc<MachineState> {
        let shared = self.shared.as_ref();
        shared.map_or_else(|| Arc::new(self.state.clone()), Arc::clone)
    }

    /// A block that is not run: what is wrong with it, at its line.
    pub fn refuse(&self, code: &'static str, message: impl Into<String>) -> Box<Diagnostic> {
        self.placed(Diagnostic::error(code, message)).boxed()
    }

    /// A finding at the line of the block, unless it has a place.
    pub fn placed(&self, finding: Diagnostic) -> Diagnostic {
        if finding.place.is_some() {
            return finding;
        }
        finding.at(Some(SourcePlace::new(&self.file, self.line, "", 0..0)))
    }

    /// Something that was taken for granted.
    pub fn note(&mut self, note: Diagnostic) {
        if self.report.notes.len() < NOTES
            && !self.report.notes.iter().any(|known| known.message == note.message)
        {
            let note = self.placed(note);
            self.report.notes.push(note);
        }
    }

    /// A block follows `/`.
    #[cold]
    pub fn say_skipped(&mut self) {
        let message = "blocks behind / are run, as with the operator's switch off";
        self.note(Diagnostic::warning("nc-skip", message));
    }

    /// An unknown word that moves nothing.
    pub fn unknown(&mut self, word: &str) {
        let known = self.report.unknown.iter_mut().find(|(name, ..)| name == word);
        if let Some((_, count, _)) = known {
            *count += 1;
        } else if self.report.unknown.len() < UNKNOWN {
            self.report.unknown.push((word.to_owned(), 1, self.line));
            self.tell(ProgramEvent::Unknown(word.to_owned()));
        }
    }

    /// Frames of the program changed: finds what the words count from.
    pub fn frames_changed(&mut self) {
        self.to_work = self.frames.all();
        let work = self.work_frame();
        self.to_part = work.around(&self.to_work);
        let plane = self.frames.plane.map(|_| TiltedPlane {
            origin: self.to_part.origin,
            axes: self.to_part.axes,
            angles: [0.0; 3],
        });
        if plane.is_some() || self.state.plane.is_some() {
            self.state.plane = plane;
            self.state_changed();
        }
    }

    /// The length, the head or the work offset changed: finds the solver, and what the words count from.
    pub fn solver_changed(&mut self) -> Result<(), Box<Diagnostic>> {
        let length = self.state.length;
        let ready = self.solvers.iter().find(|(known, _)| *known == length);
        let solver = match ready {
            Some((_, solver)) => Arc::clone(solver),
            None => {
                let solver = self.machine.solver(length);
                let solver =
                    solver.map_err(|lack| self.placed(self.machine.unsolvable(&lack)).boxed())?;
                let solver = Arc::new(solver);
                if self.solvers.len() == SOLVERS {
                    self.solvers.remove(0);
                }
                self.solvers.push((length, Arc::clone(&solver)));
                solver
            }
        };
        self.state.solver = solver;
        self.state_changed();
        self.recount()?;
        let joints = self.at.joints;
        self.stand(&joints);
        Ok(())
    }

    /// The machine has another head.
    pub fn head_changed(&mut self, machine: Arc<Machine>) -> Result<(), Box<Diagnostic>> {
        // An axis keeps its value where the other chain has one of its name.
        let mut joints = start(&machine);
        let mut said = 0;
        for (place, (joint, axis)) in joints.iter_mut().zip(&machine.axes).enumerate() {
            let before = self.machine.axes.iter().position(|before| before.name == axis.name);
            if let Some(before) = before {
                *joint = self.at.joints[before];
                said |= (self.said >> before & 1) << place;
            }
        }
        self.said = said;
        self.clamps = super::clamps::ClampState::default();
        // Of its own axes the program is to say where they stand, too.
        self.fed = false;
        self.axes = AxisLetters::new(&machine);
        self.machine = machine;
        self.solvers.clear();
        self.at.joints = joints;
        match self.tools.length_on {
            true => self.solver_changed(),
            // Whether it counts without being called is the head's.
            false => self.length_changed(),
        }
    }

    /// The machine stands at `joints`, nothing moves.
    pub fn stand(&mut self, joints: &Joints) {
        let chain = self.state.solver.chain();
        self.turns = chain.turns(joints);
        self.at = Stance { joints: *joints, pose: chain.pose(joints, &self.turns) };
    }

    /// Where the axes stand that the words count from: the tip of the compensated tool on the part origin, rotary axes
    /// showing zero, and the work offset on top.
    fn recount(&mut self) -> Result<(), Box<Diagnostic>> {
        let mut exact = Joints::default();
        for (joint, axis) in exact.iter_mut().zip(&self.machine.axes) {
            if axis.joint.rotary {
                *joint = -axis.zero;
            }
        }
        let solver = &self.state.solver;
        let turns = solver.chain().turns(&exact);
        if solver.place_zero(&mut exact, &turns).is_err() {
            let message = format!(
                "the linear axes of {} do not bring the tip onto the part origin, so nothing is known of its work offset",
                self.machine.name
            );
            return Err(self.refuse("nc-work-offset", message));
        }
        let mut zero = self.counted_from(exact);
        if let Some(work) = self.work.and_then(|work| self.offsets.work.get(work)) {
            for ((zero, exact), shift) in zero.iter_mut().zip(&mut exact).zip(work.shift) {
                *zero += shift;
                *exact += shift;
            }
        }
        self.zero = zero;
        self.origin = exact;
        self.frames_changed();
        Ok(())
    }

    /// The frame of the work offset in the part frame.
    fn work_frame(&self) -> CoordinateFrame {
        let shift = self.work.and_then(|work| self.offsets.work.get(work));
        let Some(shift) = shift.filter(|work| work.shift != Joints::default()) else {
            return CoordinateFrame::default();
        };
        let chain = self.state.solver.chain();
        let turns = chain.turns(&self.origin);
        let rotary = self.machine.axes.iter().zip(shift.shift);
        let upright = rotary.clone().all(|(axis, shift)| !axis.joint.rotary || shift == 0.0);
        let origin = chain.forward(&self.origin).tip;
        if upright {
            return CoordinateFrame::shifted(origin);
        }
        // The machine's directions, seen from the part with its axes there.
        let mut axes = Matrix3::identity();
        for (place, axis) in self.machine.axes.iter().enumerate().rev() {
            if axis.joint.rotary && axis.carries_part {
                let (sine, cosine) = turns.of(place);
                for mut column in axes.column_iter_mut() {
                    let turned = turn(column.clone_owned(), axis.joint.direction, sine, cosine);
                    column.copy_from(&turned);
                }
            }
        }
        CoordinateFrame::new(axes, origin)
    }

    /// Words are worth what the machine file says: none of the program has made diameters or radii of them.
    pub(super) fn counts_as_described(&self) -> bool {
        self.axes.scale == described_scale(&self.machine)
    }
}

impl ModalState {
    fn new(lexicon: &Lexicon, machine: &Machine) -> Self {
        let named = lexicon.language() == Language::Names;
        // A mill has radii, and no program of it says so.
        let turns = machine.spindle.surface_speed
            || (0..machine.axes.len()).any(|place| is_diameter(machine, place));
        let diameters = if turns { 0 } else { ModalGroup::Diameter.bit() };
        let extrudes = machine.along.as_ref().is_some_and(|word| word.name == "E");
        let extruder = if extrudes { 0 } else { ModalGroup::OF_EXTRUDERS };
        Self {
            motion: if named { MotionMode::Linear } else { MotionMode::None },
            unset: lexicon.modes() & !(diameters | extruder),
            plane: ArcPlane::Xy,
            incremental: false,
            centres_absolute: false,
            unit: unit_length(machine.control.units),
            feed_mode: FeedMeaning::PerMinute,
            feed: None,
            speed: 0.0,
            surface_speed: false,
            kept_speed: false,
            most_speed: None,
            return_to: ReturnTo::Start,
            return_level: None,
            smoothing: super::corners::NamedSmoothing::default(),
            master_spindle: 1,
            spindle_used: None,
            shortest: None,
            orientation: OrientationMode::Usual,
            vectors: false,
            tcp_by_length: false,
            named_register: None,
            rigid_taps: false,
            machine: false,
            tapped: false,
            frame_dropped: false,
            ways_are_radii: false,
        }
    }
}

/// Tools are turned with in X and Z, the only axes that there are.
fn turns_in_zx(machine: &Machine) -> bool {
    let mut axes = machine.axes.iter();
    machine.spindle.surface_speed
        && axes.all(|axis| !axis.joint.rotary && matches!(axis.name.as_str(), "X" | "Z"))
}

/// Where the axes stand before a program says so: at the drawing's zeros, or at the end of their travel that is nearest to
/// it, index axes where they start.
fn start(machine: &Machine) -> Joints {
    let mut joints = machine.solution.start;
    for (value, axis) in joints.iter_mut().zip(&machine.axes) {
        if let Some([least, most]) = axis.travel {
            *value = value.max(least).min(most);
        }
    }
    for value in joints.iter_mut().skip(machine.axes.len().min(MAX_AXES)) {
        *value = 0.0;
    }
    joints
}
