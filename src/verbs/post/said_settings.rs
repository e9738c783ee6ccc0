//! The settings that a command line says, for a job file.

use clap::{ArgMatches, Args, Command, FromArgMatches};

use post_cli::arguments::said;
use post_job::settings::{
    About, MachineSettings, MakingSettings, OutputSettings, ReadingSettings, ReportSettings,
    SettingValue,
};

/// Every setting that the command line says, and its value, where a job file is asked for; the flags are those of other
/// arguments.
#[derive(Debug, Default)]
pub struct SaidSettings(pub Vec<(&'static About, SettingValue)>);

impl Args for SaidSettings {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

impl FromArgMatches for SaidSettings {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        if !matches.contains_id("save_job") {
            return Ok(Self::default());
        }
        let mut all = said::<OutputSettings>(matches);
        all.extend(said::<ReadingSettings>(matches));
        all.extend(said::<MachineSettings>(matches));
        all.extend(said::<MakingSettings>(matches));
        all.extend(said::<ReportSettings>(matches));
        Ok(Self(all))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
