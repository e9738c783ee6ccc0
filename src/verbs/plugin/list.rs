//! `post plugin list`: the plugins that a machine file can name.

use std::path::PathBuf;

use clap::Args;
use post_host::{ListedPlugin, Plugin, PluginFault};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::raw::ABI;

use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::origin;
use post_job::plugin_finder::{diagnostic, finder};
use post_job::session::Session;

/// Lists the plugins that a machine file can name: those of the folders and those built in.
///
/// Each library in a folder of --plugins or POST_PLUGINS is opened, which runs its code.
#[derive(Debug, Args)]
pub struct ListArguments {
    /// A folder of plugin libraries; POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &ListArguments) -> Result<(), Failure> {
    let finder = finder(session, &arguments.plugins)?;
    let listed = finder.list().map_err(|(folder, error)| {
        let message = format!("{} cannot be read: {error}", folder.display());
        Diagnostic::error("plugin", message)
    })?;
    let mut text = format!("plugins of contract {ABI}\n\n");
    let mut warnings = Vec::new();
    for row in &listed {
        if row.hidden {
            text.push_str(&line(&row.name, "-", "-", &from(row)));
            text.push_str("    not used: another of this name comes first\n");
            continue;
        }
        let found: Result<Plugin, PluginFault> = match &row.path {
            Some(path) => Plugin::open(path),
            None => finder.find(&row.name),
        };
        match found {
            Ok(plugin) => {
                let kind = plugin.kind().name();
                let kind = kind.split_once(' ').map_or(kind, |(_, kind)| kind);
                text.push_str(&line(&row.name, kind, plugin.version(), &from(row)));
                if !plugin.about().is_empty() {
                    text.push_str(&format!("    {}\n", plugin.about()));
                }
            }
            Err(fault) => {
                text.push_str(&line(&row.name, "broken", "-", &from(row)));
                warnings.push(Diagnostic {
                    severity: Severity::Warning,
                    ..diagnostic(&fault, &[], None)
                });
            }
        }
    }
    session.findings(&warnings);
    print(session, &text);
    Ok(())
}

fn from(row: &ListedPlugin) -> String {
    origin(row.path.as_deref())
}

fn line(name: &str, kind: &str, version: &str, from: &str) -> String {
    format!("{name:<16} {kind:<12} {version:<10} {from}\n")
}
