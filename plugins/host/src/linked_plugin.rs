//! A plugin that is part of this program.

use std::sync::OnceLock;

use post_plugin::Linked;

use crate::{Plugin, PluginFault};

/// A plugin that is part of this program. It is judged when it is first asked for: a job opens two of them.
#[derive(Clone, Debug)]
pub struct LinkedPlugin {
    linked: Linked,
    judged: OnceLock<Result<Plugin, PluginFault>>,
}

impl From<Linked> for LinkedPlugin {
    fn from(linked: Linked) -> Self {
        Self { linked, judged: OnceLock::new() }
    }
}

impl LinkedPlugin {
    /// Its name, as a machine file has it.
    pub fn name(&self) -> &'static str {
        self.linked.name()
    }

    /// The plugin, judged once.
    ///
    /// # Errors
    /// If what it declares does not hold together.
    pub fn plugin(&self) -> Result<Plugin, PluginFault> {
        self.judged.get_or_init(|| Plugin::linked(self.linked)).clone()
    }
}
