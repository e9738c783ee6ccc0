//! A job as the flags mean it: a CL file, a machine with its settings, and the plugins that the machine asks for.

mod axes;
pub mod batch;
mod beside;
mod blocks_ahead;
pub mod calibrate;
pub mod caller;
pub mod cancellable_text;
pub mod channels;
pub mod cl_facts;
pub mod clearance;
mod columns;
pub mod commission_program;
pub mod compensate;
pub mod convert;
pub mod diff;
pub mod disk;
mod dry_run;
pub mod failure;
pub mod files;
mod given_values;
pub mod job_file;
pub mod library;
pub mod lint;
mod look_ahead;
pub mod machine_files;
pub mod machine_schema;
pub mod making;
mod mode_words;
pub mod nc_program;
mod nc_to_cl;
pub mod old_summary;
mod one_program;
pub mod operations;
mod orientation;
pub mod other_dialect;
mod other_language;
pub mod place;
pub mod plan;
pub mod plan_rounds;
mod plan_worth;
pub mod plugin_finder;
mod plugin_folders;
mod posted;
pub mod posting_pass;
pub mod predict;
pub mod program_digest;
pub mod read;
pub mod read_back;
pub mod report;
mod result_files;
mod rounds;
pub mod session;
pub mod settings;
pub mod summary;
pub mod text;
pub mod text_table;
pub mod tools;
mod unsaid;
pub mod unused_options;
pub mod verify;

use std::path::Path;

use post_grammar::text::as_remark;
use post_host::Finder;
use post_machine::check::Check;
use post_machine::description::{Machine, Setting};

use crate::failure::Failure;
use crate::files::PathArg;
use crate::session::Session;
use crate::settings::JobSettings;
pub use dry_run::DryRun;
use look_ahead::look_ahead;
pub use post_posting::STACK;
pub use posting_pass::try_opening;

/// What tests of single files reach; no part of the face.
#[doc(hidden)]
pub mod internals {
    pub use crate::batch::told;
    pub use crate::plan::gauges::chord_error;
    pub use crate::report::solids::share;
}

/// The machine with all settings of the command line, and `more` after them.
pub fn machine(
    session: &Session,
    arguments: &JobSettings,
    more: &[Setting],
) -> Result<Machine, Failure> {
    let mut settings = arguments.over.settings();
    settings.extend_from_slice(more);
    machine_files::load(session, &arguments.machine, &arguments.over.machines, &settings)
}

/// The machine of a job, and where its plugins come from.
pub struct JobMachine {
    /// The machine with its settings.
    pub machine: Machine,
    /// Its plugins.
    pub finder: Finder,
}

impl JobMachine {
    /// Loads the machine with all settings of the job, and `more` after them; what of its file has no effect is said.
    ///
    /// # Errors
    /// The machine or a folder of plugins cannot be used.
    pub fn load(
        session: &Session,
        arguments: &JobSettings,
        more: &[Setting],
    ) -> Result<Self, Failure> {
        let machine = machine(session, arguments, more)?;
        let finder = plugin_finder::finder(session, &arguments.over.plugins)?;
        say_what_is_left(session, arguments, &machine, &finder);
        Ok(Self { machine, finder })
    }
}

/// Says once what of the machine file has no effect: what `--dialect` leaves behind, and options that no plugin takes.
pub fn say_what_is_left(
    session: &Session,
    arguments: &JobSettings,
    machine: &Machine,
    finder: &Finder,
) {
    unused_options::warn(session, machine, finder);
    other_dialect::say_what_is_left(
        session,
        arguments.over.dialect.as_deref(),
        &arguments.machine,
        &arguments.over.machines,
        &arguments.over.settings(),
    );
}

/// Where a machine or a plugin comes from: its file, or the command itself.
pub fn origin(path: Option<&Path>) -> String {
    path.map_or_else(|| "built in".to_owned(), |path| path.display().to_string())
}

/// What can be derived from a machine with a tool of `length` mm. A chain that cannot be solved is mostly refused as
/// its file is loaded.
pub fn derive(machine: &Machine, length: f64) -> Result<Check, Failure> {
    Check::of(machine, length).map_err(|lack| machine.unsolvable(&lack).into())
}

/// The program is called after its file, or after the CL file.
pub fn program_name(source: &PathArg, target: Option<&PathArg>) -> String {
    target
        .and_then(PathArg::stem)
        .or_else(|| source.stem())
        .map_or_else(|| "PROGRAM".to_owned(), as_remark)
}
