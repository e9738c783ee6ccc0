//! `post plugin`: what is done with plugins beside posting, a file each.

mod list;
mod new;
mod read_back;
mod show;
mod test;

use clap::{Args, Subcommand};
use post_host::Plugin;

use crate::isolation::OpensPlugins;

use list::ListArguments;
use new::NewPluginArguments;
use post_job::failure::Failure;
use post_job::session::Session;
use show::ShowArguments;
use test::TestArguments;

/// Works with plugins.
#[derive(Debug, Args)]
pub struct PluginArguments {
    #[command(subcommand)]
    command: PluginCommand,
}

#[derive(Debug, Subcommand)]
enum PluginCommand {
    List(OpensPlugins<ListArguments>),
    New(NewPluginArguments),
    Show(OpensPlugins<ShowArguments>),
    Test(OpensPlugins<TestArguments>),
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &PluginArguments) -> Result<(), Failure> {
    match &arguments.command {
        PluginCommand::List(verb) => list::run(session, verb.applied(session)),
        PluginCommand::New(arguments) => new::run(session, arguments),
        PluginCommand::Show(verb) => show::run(session, verb.applied(session)),
        PluginCommand::Test(verb) => test::run(session, verb.applied(session)),
    }
}

/// Which plugin it is, and the hash of its file.
fn title(plugin: &Plugin) -> String {
    let (name, version) = (plugin.name(), plugin.version());
    let kind = plugin.kind().name();
    let from = match (plugin.path(), plugin.hash()) {
        (Some(path), Some(hash)) => format!("{}, {hash}", path.display()),
        (Some(path), None) => path.display().to_string(),
        (None, _) => "built in".to_owned(),
    };
    format!("{name} {version} ({from}), {kind}")
}
