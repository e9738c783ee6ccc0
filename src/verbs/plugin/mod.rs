//! `post plugin`: what is done with plugins beside posting, a file each.

mod test;

use clap::{Args, Subcommand};

use crate::failure::Failure;
use test::TestArguments;

/// Works with plugins.
#[derive(Debug, Args)]
pub struct PluginArguments {
    #[command(subcommand)]
    command: PluginCommand,
}

#[derive(Debug, Subcommand)]
enum PluginCommand {
    Test(TestArguments),
}

/// Does as the arguments say.
pub fn run(arguments: &PluginArguments) -> Result<(), Failure> {
    match &arguments.command {
        PluginCommand::Test(arguments) => test::run(arguments),
    }
}
