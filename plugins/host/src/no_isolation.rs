//! Where a library cannot have a process of its own, it runs in that of its host.

use std::convert::Infallible;
use std::path::Path;
use std::time::Duration;

use crate::{Plugin, PluginFault, Reason};

/// What a library's process may take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Of a call into the library.
    pub call: Duration,
    /// Bytes of memory.
    pub memory: u64,
}

/// Libraries in processes of their own: there are none here.
#[derive(Clone, Debug)]
pub struct Isolation(Infallible);

impl Isolation {
    /// None.
    pub fn new(_: Limits) -> Option<Self> {
        None
    }

    /// There is none to close.
    pub fn close_faults(&self) -> Vec<PluginFault> {
        match self.0 {}
    }

    pub(crate) fn open(&self, _: &str, _: &Path) -> Result<Plugin, Reason> {
        match self.0 {}
    }
}

/// No process is started for a library here.
pub fn serve_if_asked() {}
