//! What can be wrong with a plugin, and what would help.

use std::fmt;
use std::path::PathBuf;

/// A plugin that cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub struct PluginFault {
    /// Its name, as far as it is known.
    pub plugin: String,
    /// Its file; none if it is linked in or was not found.
    pub path: Option<PathBuf>,
    /// Why.
    pub reason: Reason,
}

/// Why a plugin cannot be used.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// No such plugin.
    NotFound {
        /// Files that would have been taken.
        tried: Vec<PathBuf>,
        /// Names of the plugins that there are, those that are linked in first.
        known: Vec<String>,
    },
    /// The file's name is not that of a plugin.
    FileName {
        /// What it should look like.
        pattern: String,
    },
    /// The file cannot be read or is no library of this system.
    Open {
        /// The system's words.
        message: String,
    },
    /// The system gives it no process of its own.
    NoProcess {
        /// The system's words.
        message: String,
    },
    /// The library does not export what its name promises.
    NoSymbol {
        /// The symbol looked for.
        symbol: String,
    },
    /// The symbol leads to something else.
    NotAPlugin,
    /// Built for another version of the contract.
    OtherContract {
        /// The plugin's version.
        found: u32,
        /// Ours.
        wanted: u32,
    },
    /// Built against other structs, or for another kind of machine.
    OtherLayout {
        /// The plugin's hash.
        found: u64,
        /// Ours.
        wanted: u64,
    },
    /// A struct or a table is shorter than this version of the contract has it, or absurdly long.
    Size {
        /// Which.
        of: &'static str,
        /// Its size as the plugin states it.
        found: u32,
        /// The least.
        wanted: u32,
        /// The most.
        most: u32,
    },
    /// A pointer is null that must not be.
    Null {
        /// Which.
        what: &'static str,
    },
    /// A pointer does not stand where a table can.
    NotAligned {
        /// Which.
        what: &'static str,
    },
    /// It is not what it is used as.
    OtherKind {
        /// What it was to be used as.
        wanted: &'static str,
        /// What it is.
        found: &'static str,
    },
    /// It says something about itself that cannot be.
    Nonsense {
        /// What.
        message: String,
    },
    /// An option does not fit.
    Option(Box<OptionFault>),
    /// It refused, in its own words.
    Refused {
        /// The plugin's sentence.
        message: String,
    },
}

/// Plugins whose source comes with that of `post`, and which are not linked in.
const OF_THE_SOURCE: [&str; 3] = ["krl", "rapid", "urscript"];

/// How to come by a plugin whose source comes with that of `post`; none of others.
pub fn of_the_source(plugin: &str) -> Option<String> {
    let own = OF_THE_SOURCE.contains(&plugin);
    own.then(|| {
        format!("its source comes with that of post: cargo build --release -p post-{plugin} makes the plugin there, and --plugins target/release finds it")
    })
}

/// An option that does not fit what the plugin declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OptionFault {
    /// The key in the machine file.
    pub key: String,
    /// What is wrong with it.
    pub message: String,
    /// The key or the text that was written where one of `allowed` was meant.
    pub written: String,
    /// The keys, or the values, that are allowed.
    pub allowed: Vec<String>,
}

impl PluginFault {
    /// What would help; empty if nothing general can be said.
    pub fn help(&self) -> String {
        match &self.reason {
            Reason::NotFound { tried, known } => {
                let mut help = of_the_source(&self.plugin).unwrap_or_default();
                if !help.is_empty() {
                    help.push_str("; ");
                }
                help.push_str(&format!("there are {}", known.join(", ")));
                for path in tried {
                    help.push_str(&format!("; looked for {}", path.display()));
                }
                if tried.is_empty() {
                    help.push_str("; name the folder of further plugins with --plugins");
                }
                help
            }
            Reason::FileName { .. } => "rename the file after its plugin".to_owned(),
            Reason::Open { .. } => {
                "the plugin must be a shared library built for this system".to_owned()
            }
            Reason::NoProcess { .. } => "--no-isolate does without".to_owned(),
            Reason::NoSymbol { .. } | Reason::NotAPlugin => {
                "check that this is a plugin of post, and that the file was not renamed".to_owned()
            }
            Reason::OtherContract { found, wanted } if found > wanted => {
                "use a newer post, or a plugin built for this one".to_owned()
            }
            Reason::OtherContract { .. } | Reason::OtherLayout { .. } | Reason::Size { .. } => {
                "build the plugin again with this version of post-plugin (or of post_plugin.h)"
                    .to_owned()
            }
            Reason::Null { .. } | Reason::NotAligned { .. } | Reason::Nonsense { .. } => {
                "the fault is in the plugin: tell its author".to_owned()
            }
            Reason::OtherKind { .. } => {
                "a dialect is named by [control] dialect, an error model by [accuracy] model"
                    .to_owned()
            }
            Reason::Option(fault) if !fault.allowed.is_empty() => {
                format!("allowed are {}", fault.allowed.join(", "))
            }
            Reason::Option(_) | Reason::Refused { .. } => String::new(),
        }
    }
}

impl fmt::Display for PluginFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "plugin `{}`", self.plugin)?;
        if let Some(path) = &self.path {
            write!(f, " ({})", path.display())?;
        }
        f.write_str(": ")?;
        match &self.reason {
            Reason::NotFound { .. } => f.write_str("there is no such plugin"),
            Reason::FileName { pattern } => {
                write!(f, "the file of a plugin is called {pattern}")
            }
            Reason::Open { message } => write!(f, "it cannot be opened: {message}"),
            Reason::NoProcess { message } => {
                write!(f, "no process of its own can be started: {message}")
            }
            Reason::NoSymbol { symbol } => write!(f, "it does not export `{symbol}`"),
            Reason::NotAPlugin => f.write_str("what it exports is not a plugin of post"),
            Reason::OtherContract { found, wanted } => write!(
                f,
                "it was built for version {found} of the plugin contract, this is version {wanted}"
            ),
            Reason::OtherLayout { found, wanted } => write!(
                f,
                "it was built against other structs (layout {found:016x}, here {wanted:016x})"
            ),
            Reason::Size { of, found, wanted, most } => {
                let (limit, what) = match found < wanted {
                    true => (wanted, "it must have at least"),
                    false => (most, "it can have at most"),
                };
                write!(f, "its {of} has {found} bytes, {what} {limit}")
            }
            Reason::NotAligned { what } => {
                write!(f, "its `{what}` is at an address that no table can have")
            }
            Reason::Null { what } => write!(f, "its `{what}` is null"),
            Reason::OtherKind { wanted, found } => {
                write!(f, "it is used as {wanted} but is {found}")
            }
            Reason::Nonsense { message } | Reason::Refused { message } => f.write_str(message),
            Reason::Option(fault) => fault.fmt(f),
        }
    }
}

impl std::error::Error for PluginFault {}

impl fmt::Display for OptionFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "option `{}`: {}", self.key, self.message)
    }
}

impl std::error::Error for OptionFault {}
