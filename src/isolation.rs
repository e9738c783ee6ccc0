//! How libraries of plugins run: flags of the verbs that open them.

use std::time::Duration;

use clap::Args;
use post_host::{Isolation, Limits};
use post_job::session::Session;

// How libraries of plugins run. On the command line alone: a job file or a machine file may be a stranger's. This and the
// text below are no documentation, which clap would take for that of the verb.
#[derive(Debug, Args)]
#[command(next_help_heading = "Plugins")]
pub struct IsolationArguments {
    /// Runs libraries of plugins in this process, and not in one of their own each: one that crashes, hangs or ends the
    /// process then takes the command with it.
    #[arg(long, conflicts_with_all = ["plugin_seconds", "plugin_memory"])]
    no_isolate: bool,

    /// Seconds that a call into a library may take, 60 if it is not said; then its process is stopped.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    plugin_seconds: Option<Duration>,

    /// Memory that a library may take in its process, MiB, 2048 if it is not said.
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(64..=1 << 24))]
    plugin_memory: Option<u64>,
}

impl IsolationArguments {
    /// Has the libraries of the run in processes as these arguments say.
    pub fn apply(&self, session: &Session) {
        if self.no_isolate {
            return session.isolate(None);
        }
        let usual = Limits::default();
        let limits = Limits {
            call: self.plugin_seconds.unwrap_or(usual.call),
            memory: self.plugin_memory.map_or(usual.memory, |mib| mib << 20),
        };
        if limits != usual && session.isolation().is_some() {
            session.isolate(Isolation::new(limits));
        }
    }
}

// Arguments of a verb that opens plugins, and how their libraries run.
#[derive(Debug, Args)]
pub struct OpensPlugins<T: Args> {
    #[command(flatten)]
    arguments: T,
    #[command(flatten)]
    isolation: IsolationArguments,
}

impl<T: Args> OpensPlugins<T> {
    /// The verb's own arguments, behind [`IsolationArguments::apply`].
    pub fn applied(&self, session: &Session) -> &T {
        self.isolation.apply(session);
        &self.arguments
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let seconds: Option<f64> = text.parse().ok();
    let fits = seconds.filter(|seconds| (0.01..=86_400.0).contains(seconds));
    fits.map(Duration::from_secs_f64).ok_or_else(|| "it must be 0.01 to 86400".to_owned())
}
