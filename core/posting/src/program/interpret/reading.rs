//! How a file is read: what the user and the machine file say of it.

use std::sync::Arc;

use post_grammar::{MajorWord, Units};
use post_machine::description::{
    CompensationOnCentre, Insert, Machine, NoseRule, Print, SmoothingRules, ToolLength, WordRule,
};

use post_machine::diagnostic::{FurtherFile, SourceFiles};
use post_machine::wait_rule::WaitRule;

use crate::program::UnknownWordPolicy;

/// How a file is read.
#[derive(Clone, Debug, Default)]
pub struct ReadingOptions {
    /// The file's name in messages.
    pub file: String,
    /// Files that are read behind it, as one text: each begins as a file of its own.
    pub further: Arc<[FurtherFile]>,
    /// Units of the numbers, whatever the file says.
    pub units: Option<Units>,
    /// The tool that a file without `LOADTL` works with.
    pub tool: Option<u32>,
    /// Take points and axes into the frame of `MSYS`.
    pub apply_msys: bool,
    /// How the part sits turned about its Z, radians, right-handed: points and axes are taken into a frame at its origin
    /// that stands as the machine's does.
    pub turn: f64,
    /// What to do with unknown words.
    pub unknown: UnknownWordPolicy,
    /// What becomes of `INSERT`.
    pub insert: Insert,
    /// What becomes of `CUTCOM` on points of the tool's centre.
    pub compensation_on_centre: CompensationOnCentre,
    /// Which tool length counts.
    pub tool_length: ToolLength,
    /// How far chords may stray from arcs and splines, mm.
    pub chord_tolerance: f64,
    /// What the spindle does where the file does not say.
    pub spindle: DefaultSpindle,
    /// Feed of the cuts that the file gives none, mm/min.
    pub feed: Option<f64>,
    /// The file loads no tools: they are numbered in the order of their cutters.
    pub tool_from_cutter: bool,
    /// Words that the user takes upon himself, in capitals.
    pub allowed: Vec<String>,
    /// Lines of the program that the machine has for words.
    pub rules: Vec<WordRule>,
    /// How it waits for other channels.
    pub wait: Option<WaitRule>,
    /// The tool has an edge that leads, or is an extruder: it cuts without turning.
    pub knife: bool,
    /// What becomes of `PPRINT`.
    pub print: Print,
    /// The spindle turns the part: `SFM` and `SMM` are constant cutting speeds.
    pub surface_speed: bool,
    /// The axis by which the part is turned to positions too: its spindle cannot turn it meanwhile.
    pub turned_by: Option<String>,
    /// What leads to the points that the control counts by, where the file has others.
    pub nose: Option<NoseRule>,
    /// The feed is planned, which is one a minute.
    pub plans: bool,
    /// Tolerances by which the control may leave the path, by operation.
    pub smoothing: SmoothingRules,
}

/// What the spindle does where the file does not say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DefaultSpindle {
    /// Not known: a cut is refused.
    #[default]
    Unknown,
    /// The spindle stands still, and the tool cuts so.
    Still,
    /// The spindle turns at this speed, revolutions a minute.
    On(f64),
}

impl DefaultSpindle {
    /// The speed, rpm, if it turns.
    pub(super) fn speed(self) -> Option<f64> {
        match self {
            Self::On(rpm) => Some(rpm),
            Self::Unknown | Self::Still => None,
        }
    }
}

impl ReadingOptions {
    /// The files of the text.
    pub(crate) fn files(&self) -> SourceFiles {
        SourceFiles::new(&self.file, Arc::clone(&self.further))
    }

    /// Adds what the machine's file says of it.
    pub(crate) fn on(mut self, machine: &Machine) -> Self {
        // Half of the tolerance goes to chords of arcs and splines, half is left for the axes.
        self.chord_tolerance = machine.accuracy.tolerance / 2.0;
        self.turn = machine.turn;
        self.insert = machine.control.insert;
        self.compensation_on_centre = machine.control.compensation_on_centre;
        self.tool_length = machine.control.tool_length;
        self.rules.clone_from(&machine.word_rules);
        self.wait.clone_from(&machine.wait);
        self.knife = machine.edge.is_some() || machine.along.is_some();
        self.print = machine.control.print;
        self.surface_speed = machine.spindle.surface_speed;
        let turns = machine.axes.iter().find(|axis| axis.joint.rotary && axis.carries_part);
        self.turned_by = turns.map(|axis| axis.name.clone());
        self.nose.clone_from(&machine.nose);
        self.smoothing.clone_from(&machine.smoothing);
        self
    }

    /// The user takes upon himself what becomes of the word, in any of its spellings.
    pub(super) fn allows(&self, word: &str) -> bool {
        let same = |allowed: &String| {
            allowed == word
                || MajorWord::find(allowed).is_some_and(|row| row.spellings.contains(&word))
        };
        self.allowed.iter().any(same)
    }
}
