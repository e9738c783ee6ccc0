//! A program of a job: its machine, its CL file, and what is told of it.

use std::path::{Path, PathBuf};

use super::{JobKeys, JobMark, ToldSetting, is_titled};
use crate::failure::Failure;
use crate::files::PathArg;
use crate::making;
use crate::plugin_finder;
use crate::session::Session;
use crate::settings::{JobSettings, SettingValue};

/// One program.
#[derive(Clone, Debug)]
pub struct JobProgram {
    /// The machine: a TOML file as seen from here, or a bare name.
    pub machine: String,
    /// The CL file, as seen from here.
    pub cl: PathBuf,
    /// What is told of it, a name once.
    pub told: Vec<ToldSetting>,
}

impl JobProgram {
    /// What it tells, each in its group.
    ///
    /// # Errors
    /// A value that is none.
    pub fn keys(&self) -> Result<JobKeys, Failure> {
        let mut keys = JobKeys::default();
        for setting in &self.told {
            if setting.value == SettingValue::Yes(false) {
                continue;
            }
            let mut groups = keys.groups().into_iter();
            let put = groups.find_map(|group| group.put(setting.about.name, &setting.value));
            put.unwrap_or(Ok(())).map_err(|why| setting.fault(&why))?;
        }
        Ok(keys)
    }

    /// The same with one of its CL files alone, for each of them.
    pub fn each_cl(&self) -> Vec<Self> {
        let mut first = self.clone();
        let further = first.told.extract_if(.., |setting| setting.about.name == "then");
        let further: Vec<SettingValue> = further
            .flat_map(|setting| match setting.value {
                SettingValue::List(files) => files,
                file => vec![file],
            })
            .collect();
        let further = further.into_iter().map(|file| {
            let cl = PathBuf::from(file.to_string());
            Self { cl, ..first.clone() }
        });
        std::iter::once(first.clone()).chain(further).collect()
    }

    /// CL file, machine and how the one is posted on the other.
    pub fn settings(&self, keys: &JobKeys, mark: Option<JobMark>) -> JobSettings {
        JobSettings {
            machine: self.machine.clone(),
            input: PathArg::from(self.cl.clone()),
            reading: keys.reading.clone(),
            over: keys.over.clone(),
            mark,
        }
    }

    /// Where its program is written.
    ///
    /// # Errors
    /// Its machine cannot be used, by whose dialect it is named where the file does not say.
    pub fn target(&self, session: &Session) -> Result<PathArg, Failure> {
        let keys = self.keys()?;
        if let Some(output) = &keys.outputs.output {
            return Ok(output.clone());
        }
        let job = self.settings(&keys, None);
        let machine = crate::machine(session, &job, &[])?;
        let finder = plugin_finder::finder(session, &keys.over.plugins)?;
        making::target(&job, None, &machine, &finder)
    }

    /// It wrote the program `path`, as far as the head of that says: its name may be another by now.
    pub fn is_titled(&self, path: &Path) -> bool {
        let stem = match self.told.iter().find(|setting| setting.about.name == "output") {
            Some(ToldSetting { value: SettingValue::Path(output), .. }) => output.file_stem(),
            _ => self.cl.file_stem(),
        };
        stem.is_some_and(|stem| is_titled(path, &stem.to_string_lossy()))
    }

    /// It writes the program `path`, as far as names say.
    pub fn is_named(&self, path: &Path) -> bool {
        let output = self.told.iter().find(|setting| setting.about.name == "output");
        match output.map(|setting| &setting.value) {
            Some(SettingValue::Path(output)) => output.file_name() == path.file_name(),
            _ => self.cl.file_stem() == path.file_stem(),
        }
    }
}
