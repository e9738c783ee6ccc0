//! `post lsp`: the language server.

use std::path::PathBuf;

use clap::Args;

use post_cli::arguments::flag_values::length;
use post_job::failure::Failure;
use post_job::session::Session;
use post_lsp::Options;

/// Serves an editor: faults, completion and explanations in machine files, axis values in CL files and programs.
///
/// It is started by an editor and speaks the Language Server Protocol on standard input and output.
#[derive(Clone, Debug, Args)]
pub struct LspArguments {
    /// The machine that CL files and programs are shown on, until the editor's setting post.machine names another.
    #[arg(short, long, value_name = "MACHINE")]
    machine: Option<String>,

    /// Length of every tool from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", value_parser = length)]
    tool_length: Option<f64>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,

    /// A folder of plugin libraries; POST_PLUGINS adds more. No setting of an editor can name one: opening a library runs
    /// its code.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,

    /// Speaks on standard input and output, as it does anyway: many editors say it.
    #[arg(long)]
    stdio: bool,
}

/// Serves.
pub fn run(session: &Session, arguments: &LspArguments) -> Result<(), Failure> {
    let LspArguments { machine, tool_length, machines, plugins, stdio: _ } = arguments.clone();
    post_lsp::serve(session, Options { machine, tool_length, machines, plugins })
}
