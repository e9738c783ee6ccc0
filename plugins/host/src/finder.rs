//! A name in a machine file is the registry: no list to edit.

use std::path::PathBuf;

use crate::plugin::{file_name, is_name};
use crate::{Plugin, PluginFault, Reason};

/// Where plugins are looked for.
#[derive(Clone, Debug, Default)]
pub struct Finder {
    /// Folders that the user named, in order; the first that has the file wins, and wins over what is
    /// linked in. No other folder is ever looked into.
    pub folders: Vec<PathBuf>,
    /// The plugins that are part of this program.
    pub linked: Vec<Plugin>,
}

impl Finder {
    /// The plugin `name`; in file names `-` is written as `_`.
    ///
    /// # Errors
    /// If there is none, or the file that should be it is none: a broken file in a named folder is never
    /// passed over in silence.
    pub fn find(&self, name: &str) -> Result<Plugin, PluginFault> {
        let wanted = name.replace('-', "_");
        let mut tried = Vec::new();
        if is_name(&wanted) {
            for folder in &self.folders {
                let path = folder.join(file_name(&wanted));
                if path.exists() {
                    return Plugin::open(&path);
                }
                tried.push(path);
            }
        }
        let linked = self.linked.iter().find(|plugin| plugin.name() == wanted);
        linked.cloned().ok_or_else(|| PluginFault {
            plugin: name.to_owned(),
            path: None,
            reason: Reason::NotFound {
                tried,
                linked: self
                    .linked
                    .iter()
                    .map(|plugin| plugin.name().to_owned())
                    .collect(),
            },
        })
    }
}
