//! A setting as a job file has it.

use post_machine::diagnostic::SourcePlace;

use crate::settings::{About, SettingValue};

/// A setting, its value, and where the file says it.
#[derive(Clone, Debug)]
pub struct ToldSetting {
    /// What it is.
    pub about: &'static About,
    /// Its value; paths as seen from the folder that the command works in.
    pub value: SettingValue,
    /// Where it stands.
    pub place: Option<SourcePlace>,
}
