//! What several verbs take on the command line, and how its values are read.
//!
//! A flag becomes what it means to the core as it is parsed, and is not turned into text again.

pub mod flag_values;
mod flags;

use clap::Args;

use flag_values::file;
pub use flags::{Flags, said};
use post_job::files::PathArg;
use post_job::settings::{JobSettings, MachineSettings, ProgramSettings, ReadingSettings};

/// A CL file, how it is read, and the machine.
#[derive(Debug, Args)]
pub struct JobArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    machine: String,

    /// The CL file, `-` for standard input.
    #[arg(value_name = "CL-FILE", value_parser = file())]
    input: PathArg,

    /// How the CL file is read.
    #[command(flatten)]
    more: JobFlags,
}

impl JobArguments {
    /// The job that they mean.
    pub fn settings(&self) -> JobSettings {
        self.more.settings(&self.machine, &self.input)
    }
}

/// How a CL file is read, and what is set over the machine file.
#[derive(Debug, Args)]
pub struct JobFlags {
    #[command(flatten)]
    reading: Flags<ReadingSettings>,

    #[command(flatten)]
    over: Flags<MachineSettings>,
}

impl JobFlags {
    /// The job of that machine and that CL file.
    pub fn settings(&self, machine: &str, input: &PathArg) -> JobSettings {
        JobSettings {
            machine: machine.to_owned(),
            input: input.clone(),
            reading: self.reading.0.clone(),
            over: self.over.0.clone(),
            mark: None,
        }
    }
}

/// An NC program that is read back, and the machine that runs it.
#[derive(Debug, Args)]
pub struct ProgramArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    machine: String,

    #[command(flatten)]
    more: Flags<ProgramSettings>,
}

impl ProgramArguments {
    /// What they mean.
    pub fn settings(&self) -> ProgramSettings {
        ProgramSettings { machine: self.machine.clone(), ..self.more.0.clone() }
    }
}
