//! Programs run by the interpreter, against chains multiplied by isometries and against what is worked out by hand.

mod instructions;
mod modes;
mod places;
mod return_levels;
mod splines;

use std::io::Cursor;

use post_machine::description::{Machine, Source, load};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Capabilities, Language, Meaning as M, VocabularyWord};
use post_readback::interpret::{Interpreter, Limits, ReadReport};
use post_readback::lexicon::Lexicon;
use post_readback::{BlockEffect, Motion, Offsets, ProgramEvent};
use post_testkit::repository;

/// A control of letters that keeps the tip with G43.4 and with M428.
pub const LETTERS: &[(&str, M)] = &[
    ("(", M::RemarkOpen),
    (")", M::RemarkClose),
    ("%", M::Nothing),
    ("I", M::CentreX),
    ("J", M::CentreY),
    ("K", M::CentreZ),
    ("R", M::Radius),
    ("F", M::Feed),
    ("T", M::Tool),
    ("S", M::SpindleSpeed),
    ("M6", M::ToolChange),
    ("H", M::LengthRegister),
    ("D", M::RadiusRegister),
    ("G43.4", M::TcpOn),
    ("G43.5", M::TcpVectorOn),
    ("M128", M::TcpOn),
    ("M129", M::TcpOff),
    ("G54.1", M::WorkOffset),
    ("G4 P", M::DwellMilliseconds),
    ("G4 X", M::DwellSeconds),
    ("G187 P3 E", M::Smoothing),
    ("G187", M::SmoothingOff),
];

/// A control of names.
const NAMES: &[(&str, M)] = &[
    (";", M::Remark),
    ("I", M::CentreX),
    ("J", M::CentreY),
    ("K", M::CentreZ),
    ("CR", M::Radius),
    ("F", M::Feed),
    ("T", M::Tool),
    ("S", M::SpindleSpeed),
    ("M6", M::ToolChange),
    ("D", M::LengthOn),
    ("D0", M::LengthOff),
    ("SUPA", M::MachineCoordinates),
    ("TRAORI", M::TcpOn),
    ("TRAFOOF", M::TcpOff),
];

/// A machine of the library.
pub fn machine(name: &str) -> Machine {
    let path = |name: &str| repository().join(format!("machines/{name}.toml"));
    let source = |name: &str| Source {
        name: format!("{name}.toml"),
        text: std::fs::read_to_string(path(name)).unwrap(),
    };
    load(source(name), &[], &mut |parent| Ok(source(parent))).unwrap()
}

/// What a program did, what was refused, and what was found.
pub struct Ran {
    pub motions: Vec<Motion>,
    pub told: Vec<ProgramEvent>,
    pub refused: Vec<Diagnostic>,
    pub report: ReadReport,
}

impl Ran {
    /// Nothing was refused.
    pub fn whole(self) -> Self {
        assert!(self.refused.is_empty(), "{:#?}", self.refused);
        self
    }

    /// The last motion.
    pub fn last(&self) -> &Motion {
        self.motions.last().unwrap()
    }
}

/// Runs a program.
pub fn ran(machine: &Machine, words: &[(&'static str, M)], offsets: &Offsets, text: &str) -> Ran {
    ran_in(Language::Macro, machine, words, offsets, text)
}

/// Runs a program of a control with this language; one of names has tools with edges.
pub fn ran_in(
    language: Language,
    machine: &Machine,
    words: &[(&'static str, M)],
    offsets: &Offsets,
    text: &str,
) -> Ran {
    let writes = match language {
        Language::Names => Capabilities::TOOL_EDGES,
        _ => Capabilities::NONE,
    };
    let words: Vec<VocabularyWord> =
        words.iter().map(|(word, meaning)| VocabularyWord::new(word, *meaning)).collect();
    let lexicon = Lexicon::new(language, writes, &words);
    let input = Cursor::new(text.as_bytes());
    let limits = Limits::default();
    let mut run = Interpreter::new(machine, &lexicon, offsets, limits, "p.nc", input).unwrap();
    let mut ran = Ran {
        motions: Vec::new(),
        told: Vec::new(),
        refused: Vec::new(),
        report: ReadReport::default(),
    };
    let mut done = Vec::new();
    loop {
        let more = run.next(&mut done);
        match more {
            Ok(true) => {}
            Ok(false) => break,
            Err(fault) => ran.refused.push(*fault),
        }
    }
    for what in done {
        match what {
            BlockEffect::Motion(motion) => ran.motions.push(motion),
            BlockEffect::Event { event: told, .. } => ran.told.push(told),
            BlockEffect::State(_) => {}
        }
    }
    ran.report = run.report().clone();
    ran
}

/// Runs a program of letters without offsets.
pub fn letters(machine: &Machine, text: &str) -> Ran {
    ran(machine, LETTERS, &Offsets::default(), text)
}
