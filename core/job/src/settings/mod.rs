//! Settings of jobs, each declared once: name, value, unit, default and doc.
//!
//! From a row of `groups` follow the field of its struct, the flag of the command (`src/arguments`), the key of a job of a
//! batch ([`JobLine`](crate::batch::JobLine)), the key of a job file ([`JobFile`](crate::job_file::JobFile)) and the option that
//! Python passes.

mod groups;
mod table;
pub mod values;

pub use groups::{
    JobSettings, MachineSettings, MakingSettings, Msys, OutputSettings, ProgramSettings,
    ReadingSettings, ReportSettings, Split, StudySettings, ThreadSettings,
};
pub use table::{About, AnySettingsGroup, SettingRow, SettingsGroup, tell};
pub use values::{SettingForm, SettingReader, SettingValue};
