//! A library in a process of its own: what it does to that process it does to nobody else.
//!
//! The command starts itself again ([`serve_if_asked`]); that process opens the library in the way of all hosts, and is
//! asked through a connection, a batch at a time. The system sets it limits before any code of the library runs. A
//! process serves one dialect or one error model at a time, so that a fault has one author, and is used again by the
//! next: to start one takes some milliseconds.
//!
//! Why messages through a socket, and the events' ends alone in shared memory: the way of a batch there and back is that
//! of two switches of the scheduler whatever carries the bytes, which are some ten thousand; the socket says of itself
//! that the other side is gone. Of a process that has died only memory can tell how far it came, and so which event it
//! died of.
//!
//! What it prints goes through a pipe of its own, and is told as what it is.
//!
//! A library's process is as little believed as the library: whatever it tells is judged by the host again.

mod channel;
mod library;
mod message;
mod printed;
mod process;
mod progress;
mod served;
mod session;
mod wire;

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::described::FunctionTable;
use crate::{Plugin, PluginFault, Reason};

pub(crate) use library::IsolatedLibrary;
pub(crate) use process::kill_all;
pub(crate) use progress::Progress;
pub use served::serve_if_asked;
pub(crate) use session::{IsolatedDialect, IsolatedModel};

/// What a library's process may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Of a call into the library; what the host does meanwhile does not count.
    pub call: Duration,
    /// Bytes of memory that the library may take, as the system counts addresses.
    pub memory: u64,
}

impl Default for Limits {
    /// A minute, and two gibibytes.
    fn default() -> Self {
        Self { call: Duration::from_secs(60), memory: 2 << 30 }
    }
}

/// Libraries in processes of their own. Clones share the processes, which end with the last one.
#[derive(Clone, Debug, Default)]
pub struct Isolation {
    limits: Limits,
    opened: Arc<Mutex<Vec<Plugin>>>,
}

impl Isolation {
    /// Within `limits`; none where there are no such processes. The program must call [`serve_if_asked`] before it does anything else.
    pub fn new(limits: Limits) -> Option<Self> {
        Some(Self { limits, opened: Arc::default() })
    }

    /// Of each library whose `close` failed, in the order of opening: who it is and how. What it wrote is whole.
    pub fn close_faults(&self) -> Vec<PluginFault> {
        let opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        let libraries = opened.iter().filter_map(|plugin| match &plugin.table {
            FunctionTable::Isolated(library) => library.close_fault(),
            _ => None,
        });
        libraries.collect()
    }

    /// The library at `path`, which must hold the plugin `name`.
    pub(crate) fn open(&self, name: &str, path: &Path) -> Result<Plugin, Reason> {
        let file = crate::library::looked(name, path)?;
        let mut opened = self.opened.lock().unwrap_or_else(PoisonError::into_inner);
        let earlier = opened.iter().find(|plugin| plugin.path() == Some(path));
        match earlier {
            Some(earlier) if earlier.hash() == Some(&file.hash) => Ok(earlier.clone()),
            Some(_) => Err(Reason::Open {
                message: "it is open already, and its file was changed since".to_owned(),
            }),
            None => {
                let plugin = library::open(name, path, file, self.limits)?;
                opened.push(plugin.clone());
                Ok(plugin)
            }
        }
    }
}
