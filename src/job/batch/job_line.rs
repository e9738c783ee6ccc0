//! One job as a line of JSON.

use std::collections::BTreeMap;
use std::path::PathBuf;

use post_machine::description::{Setting, Tcp};
use post_machine::diagnostic::Diagnostic;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

use crate::arguments::flag_values::{finite, length, positive};
use crate::arguments::{JobArguments, ReadingArguments};
use crate::files::PathArg;

/// A value as it is written: a number keeps its digits, wherever the job is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written(pub String);

impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let raw = Box::<RawValue>::deserialize(from)?;
        let raw = raw.get();
        if raw.starts_with('"') {
            return serde_json::from_str(raw).map(Self).map_err(serde::de::Error::custom);
        }
        if raw.starts_with('{') || raw == "null" {
            return Err(serde::de::Error::custom(format!(
                "{raw} is neither a number nor a text, a flag or a list"
            )));
        }
        Ok(Self(raw.to_owned()))
    }
}

impl Serialize for Written {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.0)
    }
}

/// What one job is made of. What it does not say, the machine file says.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobLine {
    /// The CL file.
    pub file: String,
    /// The machine, as `--machine` names it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Parameters and keys of the machine file, as `--set` has them.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub set: BTreeMap<String, Written>,
    /// `--mount`, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mount: Option<[Written; 3]>,
    /// `--turn`, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<Written>,
    /// `--tool-length`, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool_length: Option<Written>,
    /// `--tolerance`, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<Written>,
    /// `--tcp`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tcp: Option<Written>,
    /// `--dialect`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dialect: Option<Written>,
}

impl JobLine {
    /// Of a CL file alone.
    pub fn of_file(file: String) -> Self {
        Self { file, ..Self::default() }
    }

    /// The jobs of a text with one in each line; `name` is what messages call it.
    ///
    /// # Errors
    /// Every line that is none, up to twenty of them.
    pub fn read(name: &str, text: &str) -> Result<Vec<Self>, Vec<Diagnostic>> {
        let mut jobs = Vec::new();
        let mut faults = Vec::new();
        for (index, line) in text.lines().enumerate() {
            if line.trim().is_empty() || faults.len() >= MOST_FAULTS {
                continue;
            }
            let job = serde_json::from_str::<Self>(line)
                .map_err(|error| error.to_string())
                .and_then(|job| job.arguments(&ReadingArguments::default()).map(|_| job));
            match job {
                Ok(job) => jobs.push(job),
                Err(fault) => {
                    let message = format!("{name}, line {}: {fault}", index + 1);
                    faults.push(Diagnostic::error("job", message).help(
                        r#"a line is a job, {"file": "part.cls", "machine": "dmu50", "set": {"accuracy.tolerance": 0.01}, "mount": [0, 0, 100]}; it may have turn, tool_length, tolerance, tcp and dialect too"#,
                    ));
                }
            }
        }
        match faults.is_empty() {
            true => Ok(jobs),
            false => Err(faults),
        }
    }

    /// The job as the command line of `post` would have it.
    ///
    /// # Errors
    /// A value that is none of its kind.
    pub fn arguments(&self, reading: &ReadingArguments) -> Result<JobArguments, String> {
        let told = |name: &str, fault: String| format!("{name}: {fault}");
        let number =
            |name: &str, value: &Option<Written>, read: fn(&str) -> Result<f64, String>| {
                let value = value.as_ref();
                let number = value.map(|value| read(&value.0)).transpose();
                number.map_err(|fault| told(name, fault))
            };
        let mount = self.mount.as_ref().map(|mount| {
            let mut point = [0.0; 3];
            for (number, written) in point.iter_mut().zip(mount) {
                *number = finite(&written.0)?;
            }
            Ok(point)
        });
        let tcp = self.tcp.as_ref().map(|who| match who.0.as_str() {
            "control" => Ok(Tcp::Control),
            "post" => Ok(Tcp::Post),
            other => Err(format!("tcp: `{other}` is neither control nor post")),
        });
        let set = self.set.iter();
        Ok(JobArguments {
            machine: self.machine.clone(),
            input: Some(PathArg::from(PathBuf::from(&self.file))),
            reading: reading.clone(),
            mount: mount.transpose().map_err(|fault: String| told("mount", fault))?,
            turn: number("turn", &self.turn, finite)?,
            tool_length: number("tool_length", &self.tool_length, length)?,
            set: set.map(|(key, value)| Setting::Written(format!("{key}={}", value.0))).collect(),
            tolerance: number("tolerance", &self.tolerance, positive)?,
            tcp: tcp.transpose()?,
            dialect: self.dialect.as_ref().map(|name| name.0.clone()),
            machines: Vec::new(),
            plugins: Vec::new(),
        })
    }

    /// What the job says besides file and machine: names of columns, and values.
    pub fn parameters(&self) -> Vec<(String, &Written)> {
        let set = self.set.iter();
        let mut told: Vec<(String, &Written)> =
            set.map(|(key, value)| (key.clone(), value)).collect();
        if let Some(mount) = &self.mount {
            let parts = ["mount_x_mm", "mount_y_mm", "mount_z_mm"].into_iter();
            told.extend(parts.map(str::to_owned).zip(mount));
        }
        let others = [
            ("turn_deg", &self.turn),
            ("tool_length_mm", &self.tool_length),
            ("tolerance_mm", &self.tolerance),
            ("tcp", &self.tcp),
            ("dialect", &self.dialect),
        ];
        for (name, value) in others {
            told.extend(value.iter().map(|value| (name.to_owned(), value)));
        }
        told
    }
}

/// So many lines that are no job are told.
const MOST_FAULTS: usize = 20;
