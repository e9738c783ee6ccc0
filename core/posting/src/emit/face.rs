//! Polar and cylinder interpolation of the control around the moves of an operation: how the tool comes to them, how they begin
//! and end, and what the real axes do.

use post_machine::axis_words::{self, AxisWords, WordValues};
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::face_mode::FaceMode;
use post_machine::kinematics::Joints;
use post_machine::kinematics::travel::{AT_END, OverTravel, passed};
use post_machine::wrap_mode::WrapMode;
use post_plugin::{Event, Feed};

use super::EmitStage;
use super::cycles::CycleWordPlaces;
use crate::accuracy::PlacementError;
use crate::blocks::{BlockReason, MotionBlock};
use crate::refusal;

/// The tool goes round to its first place so far below the retract, mm: rounded words do not pass it.
const BELOW: f64 = 0.01;

/// Words of a block by what they mean on the face: places among them.
struct FaceWords {
    turning: usize,
    across: usize,
    along: usize,
    /// Units of the word of the axis across in a mm, in the mode and outside.
    scales: [f64; 2],
    /// Largest feed along the tool, mm/min.
    down: f64,
}

/// How a mode is told of.
struct ModeWords<'a> {
    /// Lines that begin it, and lines that end it.
    lines: [&'a [String]; 2],
    /// The letter of the turning axis' word in it.
    letter: &'a str,
    /// That word is a length.
    length: bool,
    /// Place in the chain of the axis that turns the part.
    turning: usize,
}

impl<'a> ModeWords<'a> {
    /// Those of a machine that is in a mode.
    fn of(machine: &'a Machine) -> Option<Self> {
        if let Some(FaceMode { on, off, letter, turning, .. }) = &machine.face {
            return Some(Self { lines: [on, off], letter, length: true, turning: *turning });
        }
        let WrapMode { on, off, letter, lengths, turning, .. } = machine.wrap.as_ref()?;
        Some(Self { lines: [on, off], letter, length: *lengths, turning: *turning })
    }
}

/// What the mode is told by.
#[derive(Clone, Debug, Default)]
pub(super) struct FaceState {
    /// It is in force.
    on: bool,
    /// Where the real axes stand: mm and radians.
    stands: Joints,
}

impl<'a> EmitStage<'a> {
    /// The machine works on as another one of its modes; the tool is away from the part then.
    pub(super) fn change_mode(&mut self, line: u64, machine: &'a Machine) {
        self.leave(line);
        self.machine = machine;
        self.words = AxisWords::new(machine, self.writer.format());
        self.cycle_words = CycleWordPlaces::new(machine);
    }

    /// The mode ends, ahead of a retract, if it is in force: the axes are themselves again.
    pub(super) fn end_face(&mut self, line: u64) {
        let Some(mode) = ModeWords::of(self.machine).filter(|_| self.face.on) else {
            return;
        };
        self.face.on = false;
        if self.machine.face.is_some() {
            self.last = self.face.stands;
        }
        let letter = &self.base.axes[mode.turning].name;
        self.tell_mode(line, &mode, mode.lines[1], (false, letter));
    }

    /// The lines that begin or end a mode, and what the turning axis' word is from here on: whether a length, and its letter.
    fn tell_mode(
        &mut self,
        line: u64,
        mode: &ModeWords<'_>,
        lines: &[String],
        (coordinate, letter): (bool, &str),
    ) {
        for text in lines {
            self.writer.push(line, Event::Word { text });
        }
        let own = &self.base.axes[mode.turning].name;
        let word = self.word_of(mode.turning);
        if let Some(word) = word.filter(|_| mode.length || mode.letter != own) {
            let word = word as u32;
            self.writer.push(line, Event::WordLetter { word, coordinate, letter });
        }
    }

    /// The way to the first position of an operation in a mode: the part is turned to zero, the tool comes to `words` far from
    /// the part, and the mode begins. It is the machine itself that comes there.
    fn come_and_begin(&mut self, line: u64, words: &[f64]) {
        let Some(mode) = ModeWords::of(self.machine) else {
            return;
        };
        if let Some(clamp) = self.base.axes[mode.turning].clamp.as_ref() {
            self.writer.push(line, Event::Word { text: &clamp.off });
            self.clamps.on &= !(1 << mode.turning);
        }
        self.writer.push(line, Event::Turn { words });
        self.smooth(line);
        self.keep_tip(line, false);
        let tool = None;
        self.writer.push(line, Event::Position { tool, feed: None, plane_first: true, words });
        self.clear = false;
        self.tell_mode(line, &mode, mode.lines[0], (mode.length, mode.letter));
        self.face.on = true;
    }

    /// The last move to the first position of an operation in a mode: down to it, at no more than `most` mm/min.
    fn go_down(&mut self, block: &MotionBlock, most: f64) {
        let count = self.writer.words();
        match block.time.feed {
            Some(feed) => self.linear(block.line, feed, &block.words[..count]),
            None => self.go_at(block.line, most, &block.words[..count]),
        }
        if block.reason != BlockReason::Above {
            self.begin_compensation(block.line);
        }
    }

    /// Refuses to wait for other channels in the mode.
    pub(super) fn refuse_wait_on_face(&self, line: u64, mark: u32) {
        if self.face.on {
            let message =
                format!("mark {mark} of SYNC stands inside polar or cylinder interpolation");
            let help = "let the CAM system put it between operations";
            self.findings.at(line, Diagnostic::error("wait", message).help(help));
        }
    }

    /// The first position of an operation in the mode: the part is turned to zero, the tool comes to the radius of the place
    /// far from it, the mode begins, and the part turns with the tool over the place before it goes down.
    pub(super) fn position_on_face(&mut self, block: &MotionBlock, mode: &'a FaceMode) {
        let line = block.line;
        let Some(places) = self.face_words(mode) else {
            return;
        };
        let place = mode.place(&block.joints);
        let radius = libm::hypot(place[0], place[1]);
        let count = self.writer.words();
        let high = self.height(block, places.along);
        let mut words: WordValues = block.words;
        words[places.turning] = 0.0;
        words[places.along] = high;
        words[places.across] = self.rounded(places.across, radius * places.scales[1]);
        self.come_and_begin(line, &words[..count]);
        let mut from = [radius, 0.0];
        for to in FaceMode::round_to(place) {
            words[places.across] = self.rounded(places.across, to[0] * places.scales[0]);
            words[places.turning] = self.rounded(places.turning, to[1] * self.length_unit());
            let minutes = mode.least_minutes(from, to);
            let way = libm::hypot(to[0] - from[0], to[1] - from[1]);
            self.go_at(line, way / minutes, &words[..count]);
            from = to;
        }
        self.go_down(block, places.down);
    }

    /// The first position of an operation on the mantle: the part is turned to zero, the tool comes over the place far from
    /// it, the mode begins, and the part turns before the tool goes down.
    pub(super) fn position_on_mantle(&mut self, block: &MotionBlock, mode: &'a WrapMode) {
        let line = block.line;
        let (Some(turning), Some(along)) =
            (self.word_of(mode.turning), axis_words::depth(self.base))
        else {
            return;
        };
        let Some(depth) = self.word_of(along) else {
            return;
        };
        let count = self.writer.words();
        let mut words: WordValues = block.words;
        words[turning] = 0.0;
        words[depth] = self.height(block, depth);
        self.come_and_begin(line, &words[..count]);
        words[turning] = block.words[turning];
        let around = self.base.axes[mode.turning].max_feed * mode.radius;
        self.go_at(line, around, &words[..count]);
        self.go_down(block, self.base.axes[along].max_feed);
    }

    /// The block in real axis values: where it begins and where it ends, which is checked and noted.
    pub(super) fn real_ends(&mut self, block: &MotionBlock) -> [Joints; 2] {
        let Some(mode) = &self.machine.face else {
            return [self.last, block.joints];
        };
        let to = mode.place(&block.joints);
        let (from, stands) = match self.face.on {
            true => (mode.place(&self.last), self.face.stands),
            false => (to, mode.real(to, &block.joints, 0.0)),
        };
        let real = mode.real(to, &block.joints, stands[mode.turning]);
        self.face.stands = real;
        let mut close = real;
        close[mode.across] = mode.centre + FaceMode::nearest(from, to);
        self.extremes.cover(&close);
        let axis = &self.base.axes[mode.across];
        let ends = [close, real].map(|joints| joints[mode.across]);
        let over = ends.into_iter().find_map(|value| {
            let limit = passed(axis.travel, value, AT_END)?;
            Some(OverTravel { joint: mode.across, value, limit })
        });
        if let Some(over) = over {
            let refused = PlacementError::OverTravel { over, tried: 1 };
            self.findings.at(block.line, refusal::refused(self.base, &refused));
        }
        [stands, real]
    }

    /// A move at a feed of so many mm/min.
    fn go_at(&mut self, line: u64, feed: f64, words: &[f64]) {
        let whole = libm::floor(feed * self.length_unit() * (1.0 + 1e-9));
        self.linear(line, Feed::PerMinute(whole.max(1.0)), words);
    }

    fn linear(&mut self, line: u64, feed: Feed, words: &[f64]) {
        self.writer.push(line, Event::Linear { tool: None, feed, words });
    }

    /// The word along the tool near the retract, or that of the block, if it is higher.
    fn height(&self, block: &MotionBlock, along: usize) -> f64 {
        let own = block.words[along];
        let mut retract = self.base.frame.retract.iter();
        let Some((joint, value)) = retract.next() else {
            return own;
        };
        let axis = &self.base.axes[*joint];
        let up = libm::copysign(1.0, axis.joint.direction.dot(&self.base.tool_axis));
        let way = (value - block.joints[*joint]) * up - BELOW;
        match way > 0.0 {
            true => self.rounded(along, own + way * up * self.factor(*joint) * self.length_unit()),
            false => own,
        }
    }

    /// What the word of the axis at `joint` multiplies it by.
    fn factor(&self, joint: usize) -> f64 {
        self.base.word_map.as_ref().map_or(1.0, |map| map.factor(joint))
    }

    /// Units of the program in a mm.
    fn length_unit(&self) -> f64 {
        1.0 / axis_words::unit_length(self.base.control.units)
    }

    fn rounded(&self, place: usize, value: f64) -> f64 {
        self.words.printed(place, value).unwrap_or(value)
    }

    /// Place among the words of that of the axis at `joint`.
    fn word_of(&self, joint: usize) -> Option<usize> {
        axis_words::order(self.base).iter().position(|other| *other == joint)
    }

    fn face_words(&self, mode: &FaceMode) -> Option<FaceWords> {
        let along = (0..self.base.axes.len())
            .find(|joint| *joint != mode.turning && *joint != mode.across)?;
        let inside = self.machine.word_map.as_ref().map_or(1.0, |map| map.factor(mode.across));
        let scales = [inside, self.factor(mode.across)].map(|scale| scale * self.length_unit());
        Some(FaceWords {
            turning: self.word_of(mode.turning)?,
            across: self.word_of(mode.across)?,
            along: self.word_of(along)?,
            scales,
            down: self.base.axes[along].max_feed,
        })
    }
}
