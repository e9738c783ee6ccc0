//! How a CL file is meant: what the machine file says of it, and what the user does.

use std::sync::Arc;

use post_grammar::{MajorWord, Units};
use post_machine::description::{
    EdgeSource, Insert, Machine, NoseRule, Print, ToolLength, WordRule,
};
use post_machine::diagnostic::{FurtherFile, SourceFiles};
use post_machine::wait_rule::WaitRule;

/// How a CL file is meant. What `post` was told must be told here, so that the same job is judged.
#[derive(Clone, Debug, Default)]
pub struct ClSettings {
    /// The file's name in messages.
    pub file: String,
    /// Files that are read behind it, as one text: each begins as a file of its own.
    pub further: Arc<[FurtherFile]>,
    /// Units of its numbers, whatever it says (`--units`).
    pub units: Option<Units>,
    /// Points and axes are taken into the frame of `MSYS` (`--msys apply`).
    pub apply_msys: bool,
    /// The tool of a file that loads none (`--tool`).
    pub tool: Option<u32>,
    /// Tools are numbered from 1 in the order of their cutters (`--tool-from-cutter`).
    pub tool_from_cutter: bool,
    /// Feed where the file gives none, mm/min (`--feed`).
    pub feed: Option<f64>,
    /// What the spindle does at each tool for which the file does not say, clockwise, revolutions a minute (`--spindle`).
    pub spindle: Option<f64>,
    /// Words that the user takes upon himself, in capitals (`--allow`): they do nothing.
    pub allowed: Vec<String>,
    /// Words that nobody knows are left out (`--unknown warn`, `pass`).
    pub unknown_left_out: bool,
    /// How the part sits turned about its Z, radians, right-handed: `machine.turn`.
    pub turn: f64,
    /// Which length of a tool counts: `control.tool_length`.
    pub tool_length: ToolLength,
    /// Words that the machine file has lines of the program for: they do what these lines do, and move nothing here.
    pub rules: Vec<WordRule>,
    /// How the machine waits for other channels: a mark is as the line for it has it.
    pub wait: Option<WaitRule>,
    /// What `PPRINT` is: a message, a remark or a line of the program.
    pub print: Print,
    /// What `INSERT` is: a remark or a line of the program.
    pub insert: Insert,
    /// Cutting speeds are kept by the control (the spindle turns the part): `spindle.surface_speed`.
    pub surface_speed: bool,
    /// What leads to the points that the control counts by: `cl.points`.
    pub nose: Option<NoseRule>,
    /// Where the leading edge of a knife points; none for a tool that turns.
    pub edge: Option<EdgeSource>,
    /// Heads that have a work offset of their own, and its number: `head.NAME.offset`.
    pub head_offsets: Vec<(String, u32)>,
}

impl ClSettings {
    /// As the machine file has it, of a file that messages call `file`; what the user says is to be filled in.
    pub fn of(machine: &Machine, file: &str) -> Self {
        Self {
            file: file.to_owned(),
            turn: machine.turn,
            tool_length: machine.control.tool_length,
            rules: machine.word_rules.clone(),
            wait: machine.wait.clone(),
            print: machine.control.print,
            insert: machine.control.insert,
            surface_speed: machine.spindle.surface_speed,
            nose: machine.nose.clone(),
            edge: machine.edge.map(|_| machine.solution.edge),
            head_offsets: (machine.heads.iter())
                .filter_map(|head| Some((head.name.clone(), head.offset?)))
                .collect(),
            ..Self::default()
        }
    }

    /// The files of the text.
    pub fn files(&self) -> SourceFiles {
        SourceFiles::new(&self.file, Arc::clone(&self.further))
    }

    /// The user takes upon himself what becomes of the word, in any of its spellings.
    pub(super) fn allows(&self, word: &str) -> bool {
        let row = MajorWord::find(word);
        self.allowed.iter().any(|allowed| {
            allowed == word || row.is_some_and(|row| row.spellings.contains(&allowed.as_str()))
        })
    }
}
