//! Tables of options for plugins that a run does not open: no plugin judges them, so that a slip would be lost.

use post_host::Finder;
use post_machine::description::{Machine, UnusedOptions};
use post_machine::diagnostic::{Diagnostic, meant};
use post_stock::plugin;

use super::plugin_finder::built_in;
use crate::session::Session;

/// Warns of tables whose plugin is not there, of options that a plugin of the command does not have, and of what is to be
/// said of the file of tools.
pub fn warn(session: &Session, machine: &Machine, finder: &Finder) {
    session.findings(&found(machine, finder));
}

/// What is warned of.
pub fn found(machine: &Machine, finder: &Finder) -> Vec<Diagnostic> {
    let file = machine.tool_table.iter();
    let mut warnings: Vec<Diagnostic> =
        file.flat_map(|file| file.findings.iter().cloned()).collect();
    for table in &machine.unused_options {
        let is_model = table.section == "accuracy";
        match plugin(&table.plugin).filter(|plugin| plugin.is_model() == is_model) {
            Some(plugin) => {
                let keys: Vec<&str> = plugin.options().iter().map(|option| option.key).collect();
                warnings.extend(unknown(table, &keys));
            }
            None if finder.has_library(&table.plugin) => {}
            None => warnings.push(no_plugin(table, is_model)),
        }
    }
    warnings
}

/// The options that a plugin does not have.
fn unknown(table: &UnusedOptions, keys: &[&str]) -> Vec<Diagnostic> {
    let options = table.options.iter();
    let unknown = options.filter(|option| !keys.contains(&option.key.as_str()));
    unknown
        .map(|option| {
            let UnusedOptions { section, plugin, .. } = table;
            let message = format!("[{section}.{plugin}]: {plugin} has no option `{}`", option.key);
            Diagnostic::warning("plugin", message).at(option.place.clone()).help(meant(
                &option.key,
                "it has",
                keys,
            ))
        })
        .collect()
}

/// The plugin of a table is not there.
fn no_plugin(table: &UnusedOptions, is_model: bool) -> Diagnostic {
    let UnusedOptions { section, plugin, .. } = table;
    let what = if is_model { "an error model" } else { "a dialect" };
    let message =
        format!("[{section}.{plugin}] has options for {what} that is not here: they do nothing");
    let first = table.options.first();
    Diagnostic::warning("plugin", message)
        .at(first.and_then(|option| option.place.clone()))
        .help(meant(plugin, "built in are", &built_in(is_model)))
}
