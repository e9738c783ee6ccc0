//! The summary of an old run: the settings that it tells of.

use std::io::Read as _;

use post_machine::diagnostic::Diagnostic;
use serde_json::Value;

use crate::disk::{self, File};
use crate::failure::Failure;
use crate::files::{FileFault, PathArg};
use crate::session::Session;
use crate::settings::SettingValue;

/// Longest summary that is read, bytes: those of many programs are lists.
const MOST_BYTES: u64 = 1 << 26;

/// What a summary tells of how its program was made.
#[derive(Clone, Debug)]
pub struct OldSummary {
    /// What messages call it.
    pub name: String,
    /// Name of its machine.
    pub machine: String,
    /// Settings by the names of their rows.
    pub told: Vec<(&'static str, SettingValue)>,
}

impl OldSummary {
    /// Reads the summary of a run; of a list of programs the first.
    ///
    /// # Errors
    /// It cannot be read, or is none.
    pub fn read(session: &Session, file: &PathArg) -> Result<Self, Failure> {
        let (Some(path), Some(named)) = (file.absolute(), file.path()) else {
            let message = "the summary of an old run is a file";
            return Err(Diagnostic::error("like", message).into());
        };
        let fault = |error| FileFault::read(named, error);
        let name = named.display().to_string();
        if !disk::metadata(path).map_err(fault)?.is_file() {
            let message = format!("{name}: no regular file");
            return Err(Diagnostic::error("like", message).into());
        }
        session.read_files().note("the summary", path);
        let mut bytes = Vec::new();
        let open = File::open(path).map_err(fault)?;
        open.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(fault)?;
        let all: Option<Value> = serde_json::from_slice(&bytes).ok();
        let first = all.as_ref().and_then(|all| all.get(0).or(Some(all)));
        let told = first.and_then(|summary| Self::of(&name, summary));
        Ok(told.ok_or_else(|| {
            let message = format!("{name} is no summary of a run");
            let help = "the JSON that --summary has written is meant";
            Diagnostic::error("like", message).help(help)
        })?)
    }

    /// The machine and the settings of a summary; none of what is no summary.
    fn of(name: &str, summary: &Value) -> Option<Self> {
        let text = |key: &str| summary.get(key)?.as_str().map(str::to_owned);
        let number = |key: &str| summary.get(key)?.as_f64();
        let (machine, dialect, tcp) = (text("machine")?, text("dialect")?, text("tcp")?);
        let (model, tip) = (text("model")?, number("tolerance_mm")?);
        let axis = number("axis_tolerance_deg")?;
        let set = vec![
            SettingValue::Text(format!("accuracy.model={model}")),
            SettingValue::Text(format!("accuracy.axis_tolerance={axis:?}")),
        ];
        let mut told = vec![
            ("set", SettingValue::List(set)),
            ("dialect", SettingValue::Text(dialect)),
            ("tcp", SettingValue::Text(tcp)),
            ("tolerance", SettingValue::Number(tip)),
        ];
        let point = summary.get("mount_mm").and_then(Value::as_array).map(|point| {
            let numbers =
                point.iter().filter_map(Value::as_f64).map(|number| format!("{number:?}"));
            numbers.collect::<Vec<_>>().join(",")
        });
        told.extend(point.map(|point| ("mount", SettingValue::Text(point))));
        told.extend(number("turn_deg").map(|turn| ("turn", SettingValue::Number(turn))));
        let tools = summary.get("tools").and_then(Value::as_array);
        let mut lengths = tools.into_iter().flatten().filter_map(|tool| {
            let said = tool.get("source").and_then(Value::as_str) == Some("option");
            tool.get("length_mm")?.as_f64().filter(|_| said)
        });
        // One length was said for all tools.
        told.extend(lengths.next().map(|length| ("tool_length", SettingValue::Number(length))));
        Some(Self { name: name.to_owned(), machine, told })
    }

    /// The warning that the old run was on another machine; none if it was on this one.
    pub fn other_machine(&self, machine: &str) -> Option<Diagnostic> {
        if self.machine == machine {
            return None;
        }
        let message = format!(
            "{} tells of a program for {}, and this one is for {machine}",
            self.name, self.machine
        );
        let help = "what belongs to a machine alone, its dialect, its tolerances and where the part sits, was taken all the same";
        Some(Diagnostic::warning("like", message).help(help))
    }
}
