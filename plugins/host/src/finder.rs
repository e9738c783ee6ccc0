//! A name in a machine file is the registry: no list to edit.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::described::is_name;
use crate::plugin::{file_name, name_of};
use crate::{Isolation, LinkedPlugin, Plugin, PluginFault, Reason};

/// Where plugins are looked for.
#[derive(Clone, Debug, Default)]
pub struct Finder {
    /// Folders that the user named, in order; the first that has the file wins, and wins over what is
    /// linked in. No other folder is ever looked into.
    pub folders: Vec<PathBuf>,
    /// The plugins that are part of this program, each judged when it is found.
    pub linked: Vec<LinkedPlugin>,
    /// Where those of the folders run in processes of their own.
    pub isolation: Option<Isolation>,
}

/// A plugin that could be found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ListedPlugin {
    /// Its name.
    pub name: String,
    /// Its file; none if it is linked in.
    pub path: Option<PathBuf>,
    /// Another of the same name comes first.
    pub hidden: bool,
}

impl Finder {
    /// The plugin `name`; in file names `-` is written as `_`.
    ///
    /// # Errors
    /// If there is none, or what should be it is none: a broken file in a named folder, a link that leads nowhere, a
    /// folder that cannot be looked into are never passed over in silence.
    pub fn find(&self, name: &str) -> Result<Plugin, PluginFault> {
        let wanted = name.replace('-', "_");
        let mut tried = Vec::new();
        if is_name(&wanted) {
            for folder in &self.folders {
                let path = folder.join(file_name(&wanted));
                match path.symlink_metadata() {
                    Ok(_) => return Plugin::open_in(&path, self.isolation.as_ref()),
                    Err(error) if error.kind() == io::ErrorKind::NotFound => tried.push(path),
                    Err(error) => {
                        return Err(PluginFault {
                            plugin: wanted,
                            path: Some(path),
                            reason: Reason::Open { message: error.to_string() },
                        });
                    }
                }
            }
        }
        if let Some(linked) = self.linked.iter().find(|plugin| plugin.name() == wanted) {
            return linked.plugin();
        }
        Err(self.not_found(name, tried))
    }

    /// The fault of a name that no plugin has.
    fn not_found(&self, name: &str, tried: Vec<PathBuf>) -> PluginFault {
        let linked = self.linked.iter().map(|plugin| plugin.name().to_owned());
        let mut known: Vec<String> = linked.collect();
        for (name, _) in self.folders.iter().flat_map(|folder| names(folder)).flatten() {
            if !known.contains(&name) {
                known.push(name);
            }
        }
        PluginFault {
            plugin: name.to_owned(),
            path: None,
            reason: Reason::NotFound { tried, known },
        }
    }

    /// A folder holds what should be the library of the plugin `name`; nothing of it is opened.
    pub fn has_library(&self, name: &str) -> bool {
        let file = file_name(&name.replace('-', "_"));
        self.folders.iter().any(|folder| folder.join(&file).exists())
    }

    /// All plugins, by the names of their files alone: none is opened. In the order in which they are looked for.
    ///
    /// # Errors
    /// Which folder cannot be read, and why.
    pub fn list(&self) -> Result<Vec<ListedPlugin>, (PathBuf, io::Error)> {
        let mut listed: Vec<ListedPlugin> = Vec::new();
        let mut add = |name: String, path| {
            let hidden = listed.iter().any(|other| other.name == name);
            listed.push(ListedPlugin { name, path, hidden });
        };
        for folder in &self.folders {
            let names = names(folder).map_err(|error| (folder.clone(), error))?;
            for (name, path) in names {
                add(name, Some(path));
            }
        }
        for plugin in &self.linked {
            add(plugin.name().to_owned(), None);
        }
        Ok(listed)
    }
}

/// The plugins of a folder and their files, in the order of their names.
fn names(folder: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if let Some(name) = name_of(&path) {
            names.push((name.to_owned(), path));
        }
    }
    names.sort();
    Ok(names)
}
