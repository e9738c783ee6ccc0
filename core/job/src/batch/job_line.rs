//! One job as a line of JSON.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use post_machine::description::Setting;
use post_machine::diagnostic::Diagnostic;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::ser::SerializeMap as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::RawValue;

use crate::files::PathArg;
use crate::settings::{
    About, JobSettings, MachineSettings, ReadingSettings, SettingValue, SettingsGroup as _,
};

/// How a setting is put where it belongs.
type SettingSetter = fn(&mut MachineSettings, &SettingValue) -> Result<(), String>;

/// A value as it is written: a number keeps its digits, wherever the job is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ValueText(pub String);

impl<'de> Deserialize<'de> for ValueText {
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

impl Serialize for ValueText {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.0)
    }
}

/// What one job is made of. What it does not say, the machine file says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct JobLine {
    /// The CL file.
    pub file: String,
    /// The machine, as `--machine` names it.
    pub machine: Option<String>,
    /// Further CL files of the same program.
    pub then: Vec<String>,
    /// The operations that it is made of; none: all.
    pub operations: Vec<String>,
    /// Parameters and keys of the machine file, as `--set` has them.
    pub set: BTreeMap<String, ValueText>,
    /// Settings of [`JobLine::rows`], by their places there: one value, or a list where the row has several columns.
    pub settings: BTreeMap<usize, Vec<ValueText>>,
}

impl Serialize for JobLine {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut line = to.serialize_map(None)?;
        line.serialize_entry("file", &self.file)?;
        if let Some(machine) = &self.machine {
            line.serialize_entry("machine", machine)?;
        }
        for (name, values) in [("then", &self.then), ("operations", &self.operations)] {
            if !values.is_empty() {
                line.serialize_entry(name, values)?;
            }
        }
        if !self.set.is_empty() {
            line.serialize_entry("set", &self.set)?;
        }
        for (row, (about, _)) in Self::rows().enumerate() {
            match self.settings.get(&row).map(Vec::as_slice) {
                None => {}
                Some([value]) => line.serialize_entry(about.name, value)?,
                Some(values) => line.serialize_entry(about.name, values)?,
            }
        }
        line.end()
    }
}

impl<'de> Deserialize<'de> for JobLine {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(JobLineVisitor)
    }
}

struct JobLineVisitor;

impl<'de> Visitor<'de> for JobLineVisitor {
    type Value = JobLine;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("struct JobLine")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<JobLine, A::Error> {
        let mut line = JobLine::default();
        let mut met: Vec<String> = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            if met.contains(&key) {
                return Err(A::Error::custom(format!("duplicate field `{key}`")));
            }
            match key.as_str() {
                "file" => line.file = map.next_value()?,
                "machine" => line.machine = map.next_value()?,
                "then" => line.then = map.next_value()?,
                "operations" => line.operations = map.next_value()?,
                "set" => line.set = map.next_value()?,
                name => {
                    let Some(row) = JobLine::place(name) else {
                        let names = JobLine::rows().map(|(about, _)| format!("`{}`", about.name));
                        let names: Vec<String> = names.collect();
                        let names = names.join(", ");
                        return Err(A::Error::custom(format!(
                            "unknown field `{name}`, expected one of `file`, `machine`, `then`, `operations`, `set`, {names}"
                        )));
                    };
                    let told = match JobLine::rows().nth(row).map(|(about, _)| about.columns.len())
                    {
                        Some(3) => map.next_value::<Option<[ValueText; 3]>>()?.map(Vec::from),
                        _ => map.next_value::<Option<ValueText>>()?.map(|value| vec![value]),
                    };
                    line.settings.extend(told.map(|told| (row, told)));
                }
            }
            met.push(key);
        }
        match met.iter().any(|key| key == "file") {
            true => Ok(line),
            false => Err(A::Error::missing_field("file")),
        }
    }
}

impl JobLine {
    /// The settings that each job may have.
    pub fn rows() -> impl Iterator<Item = (&'static About, SettingSetter)> {
        let rows = MachineSettings::ROWS.iter().map(|row| (&row.about, row.put));
        rows.filter(|(about, _)| !about.columns.is_empty())
    }

    /// The place of a setting among them.
    pub fn place(name: &str) -> Option<usize> {
        Self::rows().position(|(about, _)| about.name == name)
    }

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
                .and_then(|job| job.settings(&ReadingSettings::default()).map(|_| job));
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

    /// The job that it means.
    ///
    /// # Errors
    /// A value that is none of its kind.
    pub fn settings(&self, reading: &ReadingSettings) -> Result<JobSettings, String> {
        let mut over = MachineSettings::default();
        let set = self.set.iter();
        over.set.extend(set.map(|(key, value)| Setting::Written(format!("{key}={}", value.0))));
        for (row, (about, put)) in Self::rows().enumerate() {
            let value = match self.settings.get(&row).map(Vec::as_slice) {
                None => continue,
                Some([value]) => SettingValue::from(value.0.as_str()),
                Some(values) => SettingValue::List(
                    values.iter().map(|value| SettingValue::from(value.0.as_str())).collect(),
                ),
            };
            put(&mut over, &value).map_err(|fault| format!("{}: {fault}", about.name))?;
        }
        let mut reading = reading.clone();
        let then = self.then.iter().map(|file| PathArg::from(PathBuf::from(file)));
        reading.then.extend(then);
        reading.operations.extend_from_slice(&self.operations);
        Ok(JobSettings {
            machine: self.machine.clone().unwrap_or_default(),
            input: PathArg::from(PathBuf::from(&self.file)),
            reading,
            over,
            mark: None,
        })
    }

    /// What the job says besides file and machine: names of columns, and values.
    pub fn parameters(&self) -> Vec<(String, &ValueText)> {
        let set = self.set.iter();
        let mut told: Vec<(String, &ValueText)> =
            set.map(|(key, value)| (key.clone(), value)).collect();
        for (row, (about, _)) in Self::rows().enumerate() {
            let values = self.settings.get(&row).into_iter().flatten();
            told.extend(about.columns.iter().map(|name| (*name).to_owned()).zip(values));
        }
        told
    }
}

/// So many lines that are no job are told.
const MOST_FAULTS: usize = 20;
