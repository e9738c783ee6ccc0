//! What a dialect is told about a program, with texts of its own.

use post_plugin::{Accuracy, Ahead, AxisWord, Setup, Tool, Units, Value};

use crate::GivenValue;

/// What a dialect is told about a program.
#[derive(Clone, Debug, Default)]
pub struct ProgramSetup {
    /// Name of the program (the output file's stem).
    pub program: String,
    /// Name of the machine.
    pub machine: String,
    /// Units of the program.
    pub units: Units,
    /// See [`Setup::tcp`].
    pub tcp: bool,
    /// See [`Setup::turns_part`].
    pub turns_part: bool,
    /// The axis words, in the order in which they are written.
    pub words: Vec<ProgramWord>,
    /// The options of the machine file, as given.
    pub options: Vec<(String, GivenValue)>,
    /// See [`Setup::cl_file`].
    pub cl_file: String,
    /// See [`Setup::accuracy`].
    pub accuracy: Option<Accuracy>,
    /// See [`Setup::ahead`].
    pub ahead: Option<ProgramAhead>,
}

/// See [`AxisWord`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramWord {
    /// Its address.
    pub name: String,
    /// A rotary axis.
    pub rotary: bool,
    /// Its words lie within one turn.
    pub wrapped: bool,
    /// They are places within one turn, and their sign is the way there.
    pub signed: bool,
    /// The linear axis along the spindle.
    pub depth: bool,
    /// The axis carries the part.
    pub carries_part: bool,
    /// See [`AxisWord::diameter`].
    pub diameter: bool,
    /// See [`AxisWord::travel`].
    pub travel: Option<[f64; 2]>,
}

/// See [`post_plugin::Ahead`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramAhead {
    /// The tools in the order in which they are first used.
    pub tools: Vec<ProgramTool>,
    /// Least and largest tip, mm, part frame.
    pub extents: Option<[[f64; 3]; 2]>,
    /// The program's time, seconds.
    pub time: Option<f64>,
}

/// See [`post_plugin::Tool`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramTool {
    /// Tool number.
    pub number: u32,
    /// Its name, empty if not known.
    pub name: String,
    /// From the gauge point to the tip, mm.
    pub length: Option<f64>,
    /// Of the cutter, mm.
    pub diameter: Option<f64>,
    /// Of the cutter's corner, mm.
    pub corner_radius: Option<f64>,
}

impl ProgramSetup {
    /// Hands it to `take` as a dialect sees it, with `options` completed.
    pub(crate) fn with<R>(
        &self,
        options: &[(String, GivenValue)],
        take: impl FnOnce(&Setup<'_>) -> R,
    ) -> R {
        let options: Vec<(&str, Value<'_>)> =
            options.iter().map(|(key, value)| (key.as_str(), value.as_value())).collect();
        let words: Vec<AxisWord<'_>> = self
            .words
            .iter()
            .map(|word| AxisWord {
                name: &word.name,
                rotary: word.rotary,
                wrapped: word.wrapped,
                signed: word.signed,
                depth: word.depth,
                carries_part: word.carries_part,
                diameter: word.diameter,
                travel: word.travel,
            })
            .collect();
        let tools = self.ahead.iter().flat_map(|ahead| &ahead.tools);
        let tools: Vec<Tool<'_>> = tools
            .map(|tool| Tool {
                number: tool.number,
                name: &tool.name,
                length: tool.length,
                diameter: tool.diameter,
                corner_radius: tool.corner_radius,
            })
            .collect();
        take(&Setup {
            program: &self.program,
            machine: &self.machine,
            units: self.units,
            tcp: self.tcp,
            turns_part: self.turns_part,
            words: &words,
            options: &options,
            cl_file: &self.cl_file,
            accuracy: self.accuracy,
            ahead: self.ahead.as_ref().map(|ahead| Ahead {
                tools: &tools,
                extents: ahead.extents,
                time: ahead.time,
            }),
        })
    }
}
