//! The settings that a job file can have: those of the groups that posting and reading back are told by.

use crate::settings::{
    About, AnySettingsGroup, MachineSettings, MakingSettings, OutputSettings, ProgramSettings,
    ReadingSettings, ReportSettings, SettingsGroup,
};

/// Of how a program is read back, what posting is not told.
const READ_BACK: [&str; 2] = ["offsets", "most_blocks"];

/// Keys that stand beside the settings, each with what it means.
pub(super) const BESIDE: [(&str, &str); 4] = [
    ("machine", "The machine: a TOML file, or the name of one in a machine folder or built in."),
    ("cl", "The CL file; several, in their order, become one program."),
    (
        "program",
        "A program of its own, [[program]]: with its CL file, and keys over those above all programs.",
    ),
    (
        "channel",
        "The program of a channel of the machine, [[channel]], from 1: with its machine and CL file. All run at the same time.",
    ),
];

/// All settings that a job file can have, each in its group.
#[derive(Clone, Debug, Default)]
pub struct JobKeys {
    /// What is written.
    pub outputs: OutputSettings,
    /// How the CL file is read.
    pub reading: ReadingSettings,
    /// What is set over the machine file.
    pub over: MachineSettings,
    /// How programs are made.
    pub making: MakingSettings,
    /// The page.
    pub report: ReportSettings,
    /// How programs are read back.
    pub program: ProgramSettings,
}

impl JobKeys {
    /// What they are, each name once.
    pub fn about() -> impl Iterator<Item = &'static About> {
        let outputs = rows::<OutputSettings>().chain(rows::<ReportSettings>());
        let made = rows::<ReadingSettings>().chain(rows::<MachineSettings>());
        let program = rows::<ProgramSettings>().filter(|about| READ_BACK.contains(&about.name));
        made.chain(rows::<MakingSettings>()).chain(program).chain(outputs)
    }

    /// The setting of that name.
    pub fn named(name: &str) -> Option<&'static About> {
        Self::about().find(|about| about.name == name)
    }

    /// The setting names a place where something is written.
    pub fn is_output(about: &About) -> bool {
        OutputSettings::row(about.name).is_some() || ReportSettings::row(about.name).is_some()
    }

    /// The groups, to be told by name.
    pub fn groups(&mut self) -> [&mut dyn AnySettingsGroup; 6] {
        let Self { outputs, reading, over, making, report, program } = self;
        [outputs, reading, over, making, report, program]
    }
}

fn rows<S: SettingsGroup>() -> impl Iterator<Item = &'static About> {
    S::ROWS.iter().map(|row| &row.about)
}
