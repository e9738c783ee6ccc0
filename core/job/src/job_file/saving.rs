//! A job as it was typed becomes a job file: what was said, and nothing that holds by default.

use std::fmt::Write as _;
use std::path::Path;

use post_machine::diagnostic::Diagnostic;
use serde_json::json;
use toml::de::{DeTable, DeValue};

use super::{ENDING, JobKeys, is_job_file, paths};
use crate::disk;
use crate::files::PathArg;
use crate::machine_files;
use crate::settings::{About, SettingForm, SettingValue};

/// What was typed.
#[derive(Clone, Copy, Debug)]
pub struct SavedJob<'a> {
    /// The machine as it was named.
    pub machine: &'a str,
    /// The CL file.
    pub cl: &'a PathArg,
    /// Settings in the order of their groups.
    pub said: &'a [(&'static About, SettingValue)],
}

/// The text of the job file `target`: paths count from its folder.
///
/// # Errors
/// It cannot be found again by its name, or the CL file has none.
pub fn text(job: &SavedJob<'_>, target: &PathArg) -> Result<String, Box<Diagnostic>> {
    let Some(path) = target.absolute().filter(|path| is_job_file(path)) else {
        let message = format!("a job file has a name that ends in {ENDING}");
        return Err(Diagnostic::error("job-file", message).boxed());
    };
    let folder = paths::folder(path);
    let Some(cl) = job.cl.absolute() else {
        let message = "a job file names its CL file, and standard input has no name";
        return Err(Diagnostic::error("job-file", message).help("name the CL file").boxed());
    };
    let mut text = String::new();
    let machine = match machine_files::is_file(job.machine) && disk::exists(Path::new(job.machine))
    {
        true => relative(Path::new(job.machine), &folder),
        false => job.machine.to_owned(),
    };
    line(&mut text, "machine", &json!(machine).to_string());
    let first = paths::relative(cl, &folder);
    let further = job.said.iter().find(|(about, _)| about.name == "then");
    let cl = match further.map(|(_, value)| value) {
        Some(SettingValue::List(further)) => {
            let further =
                further.iter().map(|file| relative(Path::new(&file.to_string()), &folder));
            json!(std::iter::once(first).chain(further).collect::<Vec<_>>())
        }
        _ => json!(first),
    };
    line(&mut text, "cl", &cl.to_string());
    let mut set = Vec::new();
    for (about, value) in job.said {
        match (about.name, written(about, value, &folder)) {
            ("then", _) => {}
            ("set", _) => set.extend(texts(value)),
            ("plugins", _) => {
                text.push_str(
                    "# --plugins stays on the command line: opening a library runs its code\n",
                );
            }
            (_, Some(written)) => line(&mut text, about.name, &written),
            (_, None) => {
                let flag = about.flag();
                let _ = writeln!(
                    text,
                    "# --{flag} stays on the command line: it leads out of this folder"
                );
            }
        }
    }
    if !set.is_empty() {
        text.push_str("\n[set]\n");
    }
    // Of one key the last wins, and a table has it once.
    let mut keys: Vec<(String, String)> = Vec::new();
    for setting in &set {
        let (name, value) = setting.split_once('=').unwrap_or((setting, ""));
        let (name, value) = (name.trim().to_owned(), bare(value.trim()));
        keys.retain(|(known, _)| *known != name);
        keys.push((name, value));
    }
    for (name, value) in keys {
        line(&mut text, &json!(name).to_string(), &value);
    }
    Ok(text)
}

fn line(text: &mut String, key: &str, value: &str) {
    let _ = writeln!(text, "{key} = {value}");
}

/// A path as the job file names it.
fn relative(path: &Path, folder: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    paths::relative(&absolute, folder)
}

/// The value as TOML has it; none of a place to write that a job file does not name.
fn written(about: &About, value: &SettingValue, folder: &Path) -> Option<String> {
    Some(match value {
        SettingValue::Path(path) => {
            let path = relative(path, folder);
            if JobKeys::is_output(about) && !paths::is_below(Path::new(&path)) {
                return None;
            }
            json!(path).to_string()
        }
        SettingValue::Yes(_) | SettingValue::Whole(_) | SettingValue::Number(_) => {
            value.to_string()
        }
        SettingValue::List(values) => {
            let values = values.iter().map(|value| written(about, value, folder));
            format!("[{}]", values.collect::<Option<Vec<_>>>()?.join(", "))
        }
        SettingValue::Text(text) => match about.form {
            SettingForm::Text => number_or_text(text),
            _ => json!(text).to_string(),
        },
    })
}

/// A number, a list of numbers (`0,0,120`), or a text.
fn number_or_text(text: &str) -> String {
    let numbers: Option<Vec<String>> = text.split(',').map(|part| number(part.trim())).collect();
    match numbers.as_deref() {
        Some([number]) => number.clone(),
        Some(numbers) => format!("[{}]", numbers.join(", ")),
        None => json!(text).to_string(),
    }
}

/// A number as TOML has it, with the digits that were typed wherever TOML takes them.
fn number(text: &str) -> Option<String> {
    let number: f64 = text.parse().ok().filter(|number: &f64| number.is_finite())?;
    let line = format!("v = {text}");
    let table = DeTable::parse(&line).ok();
    let value = table.as_ref().and_then(|table| table.get_ref().get("v"));
    let is_number = value
        .is_some_and(|value| matches!(value.get_ref(), DeValue::Integer(_) | DeValue::Float(_)));
    Some(if is_number { text.to_owned() } else { format!("{number:?}") })
}

/// A value of `--set`: what is no TOML is text.
fn bare(value: &str) -> String {
    match DeTable::parse(&format!("v = {value}")) {
        Ok(_) => value.to_owned(),
        Err(_) => json!(value).to_string(),
    }
}

fn texts(value: &SettingValue) -> Vec<String> {
    match value {
        SettingValue::List(values) => values.iter().map(SettingValue::to_string).collect(),
        value => vec![value.to_string()],
    }
}
