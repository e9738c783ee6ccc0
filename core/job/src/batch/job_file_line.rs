//! A program of a job file as a job of a batch.

use post_machine::diagnostic::Diagnostic;
use serde_json::json;

use super::job_line::{JobLine, ValueText};
use crate::failure::Failure;
use crate::job_file::{JobFile, JobProgram, ToldSetting, refuse_channels};
use crate::settings::{ReadingSettings, SettingValue, SettingsGroup as _, StudySettings};

impl JobLine {
    /// The programs of a job file, a job each. What a batch asks of all jobs alike must be asked of it so.
    ///
    /// # Errors
    /// A program is read or made in another way than the batch does it.
    pub fn of_job_file(job: &JobFile, asked: &StudySettings) -> Result<Vec<Self>, Failure> {
        refuse_channels(job)?;
        job.programs.iter().map(|program| Self::of_program(program, asked)).collect()
    }

    fn of_program(program: &JobProgram, asked: &StudySettings) -> Result<Self, Failure> {
        let keys = program.keys()?;
        let mut line = Self::of_file(program.cl.to_string_lossy().into_owned());
        line.machine = Some(program.machine.clone());
        for setting in &program.told {
            let name = setting.about.name;
            if let Some(place) = Self::place(name) {
                line.settings.insert(place, values(&setting.value));
                continue;
            }
            let same = match name {
                "set" => {
                    line.set.extend(pairs(&setting.value));
                    true
                }
                "tools" => {
                    let file = ValueText(json!(setting.value.to_string()).to_string());
                    line.set.insert("tools.file".to_owned(), file);
                    true
                }
                "plan" => keys.making.plan == asked.plan,
                "trust_model" => keys.making.trust_model == asked.trust_model,
                "then" => {
                    line.then = values(&setting.value).into_iter().map(|file| file.0).collect();
                    true
                }
                "operations" => {
                    line.operations =
                        values(&setting.value).into_iter().map(|name| name.0).collect();
                    true
                }
                "plan_rounds" | "compensate_servo" => false,
                name if ReadingSettings::row(name).is_some() => {
                    let alike = |reading: &ReadingSettings| {
                        let (then, operations) = (Vec::new(), Vec::new());
                        format!("{:?}", ReadingSettings { then, operations, ..reading.clone() })
                    };
                    alike(&keys.reading) == alike(&asked.reading)
                }
                _ => true,
            };
            if !same {
                return Err(other(setting).into());
            }
        }
        Ok(line)
    }
}

/// What the batch does not do as the job file says.
fn other(setting: &ToldSetting) -> Diagnostic {
    let name = setting.about.name;
    let message = format!("{name}: a batch does the same for all of its jobs, and this is not it");
    let help = match name {
        "plan_rounds" | "compensate_servo" => "a batch cannot: post this job by itself".to_owned(),
        _ => format!(
            "say it to the batch, --{}, or leave it out of the job file",
            setting.about.flag()
        ),
    };
    Diagnostic::error("job-file", message).help(help).at(setting.place.clone())
}

fn values(value: &SettingValue) -> Vec<ValueText> {
    match value {
        SettingValue::List(values) => {
            values.iter().map(|value| ValueText(value.to_string())).collect()
        }
        value => vec![ValueText(value.to_string())],
    }
}

/// Keys of the machine file and their values; of one key the last wins.
fn pairs(value: &SettingValue) -> Vec<(String, ValueText)> {
    let values = values(value).into_iter();
    let pairs = values.filter_map(|ValueText(text)| {
        let (name, value) = text.split_once('=')?;
        Some((name.to_owned(), ValueText(value.to_owned())))
    });
    pairs.collect()
}
