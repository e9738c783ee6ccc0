//! A job file is read: its keys, their values, and what is wrong with them, each with its line.

use std::io::Read as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use post_grammar::text::is_unprintable;
use post_machine::description::MOST_BYTES;
use post_machine::diagnostic::{Diagnostic, SourcePlace, meant};
use post_machine::wait_rule::MOST_CHANNELS;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::job_keys::BESIDE;
use super::{JobFile, JobKeys, JobMark, JobProgram, MOST_PROGRAMS, ToldSetting, paths};
use crate::disk;
use crate::failure::Failure;
use crate::files::FileFault;
use crate::machine_files;
use crate::session::Session;
use crate::settings::{About, SettingForm, SettingValue};

/// Faults of one file that are told.
const MOST_FAULTS: usize = 50;

/// Reads a job file.
///
/// # Errors
/// It cannot be read, or all that is wrong with it.
pub fn read(session: &Session, path: &Path) -> Result<JobFile, Failure> {
    let text = text_of(session, path)?;
    let name = path.display().to_string();
    let mut reading =
        JobReading { name: &name, text: &text, path, channels: false, faults: Vec::new() };
    let programs = reading.programs();
    let channels = reading.channels;
    match reading.faults.is_empty() {
        true => Ok(JobFile { mark: JobMark::new(path, &text), name, channels, programs }),
        false => Err(reading.faults.into()),
    }
}

/// The text of a job file: a regular file, of no more than a machine file may have.
pub(super) fn text_of(session: &Session, path: &Path) -> Result<String, Failure> {
    let fault = |error| FileFault::read(path, error);
    let metadata = disk::metadata(path).map_err(fault)?;
    let refused = |why: String| Diagnostic::error("job-file", format!("{}: {why}", path.display()));
    if !metadata.is_file() {
        return Err(refused("no regular file".to_owned()).into());
    }
    session.read_files().note("the job file", path);
    let mut bytes = Vec::new();
    let most = u64::try_from(MOST_BYTES).unwrap_or(u64::MAX);
    disk::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes)).map_err(fault)?;
    if bytes.len() > MOST_BYTES {
        let why = format!("longer than {MOST_BYTES} bytes, which no job file is");
        return Err(refused(why).into());
    }
    let text = String::from_utf8(bytes);
    Ok(text.map_err(|_| refused("a job file is UTF-8 text, this is not".to_owned()))?)
}

/// What a table of the file says: all of it, or one of its programs.
#[derive(Clone, Default)]
struct SaidKeys {
    machine: Option<String>,
    /// CL files in their order, at least one.
    cl: Option<Vec<PathBuf>>,
    told: Vec<ToldSetting>,
}

impl SaidKeys {
    /// What `own` says goes before it.
    fn with(&self, own: Self) -> Self {
        let mut all = self.clone();
        all.machine = own.machine.or(all.machine);
        all.cl = own.cl.or(all.cl);
        for setting in own.told {
            let name = setting.about.name;
            let known = all.told.iter_mut().find(|known| known.about.name == name);
            match (known, setting.value) {
                // Of keys of the machine file the last wins.
                (Some(known), SettingValue::List(more)) if name == "set" => {
                    let before = std::mem::replace(&mut known.value, SettingValue::Yes(false));
                    let mut values = list(before);
                    values.extend(more);
                    known.value = SettingValue::List(values);
                }
                (Some(known), value) => *known = ToldSetting { value, ..setting },
                (None, value) => all.told.push(ToldSetting { value, ..setting }),
            }
        }
        all
    }
}

fn list(value: SettingValue) -> Vec<SettingValue> {
    match value {
        SettingValue::List(values) => values,
        value => vec![value],
    }
}

/// A job file that is being read.
struct JobReading<'t> {
    name: &'t str,
    text: &'t str,
    path: &'t Path,
    /// Its programs are those of channels.
    channels: bool,
    faults: Vec<Diagnostic>,
}

impl JobReading<'_> {
    fn programs(&mut self) -> Vec<JobProgram> {
        let table = match DeTable::parse(self.text) {
            Ok(table) => table.into_inner(),
            Err(fault) => {
                let message = fault.message().to_owned();
                self.fault(fault.span().unwrap_or(0..0), message, "");
                return Vec::new();
            }
        };
        let (mut rest, mut programs) = (DeTable::new(), None);
        for (key, value) in table {
            match key.get_ref().as_ref() {
                name @ ("program" | "channel") => {
                    if programs.is_some() {
                        let message = "a job has [[program]] or [[channel]] tables".to_owned();
                        self.fault(key.span(), message, "a job file for each kind");
                        return Vec::new();
                    }
                    self.channels = name == "channel";
                    programs = Some(value);
                }
                _ => {
                    rest.insert(key, value);
                }
            }
        }
        let above = self.said(&rest);
        let Some(programs) = programs else {
            return self.program(above, None).into_iter().collect();
        };
        let DeValue::Array(items) = programs.get_ref() else {
            self.fault(programs.span(), "programs are tables, [[program]]".to_owned(), "");
            return Vec::new();
        };
        if items.len() > MOST_PROGRAMS {
            let message = format!("more than {MOST_PROGRAMS} programs");
            self.fault(programs.span(), message, "several job files take more");
            return Vec::new();
        }
        let channels = 2..=MOST_CHANNELS as usize;
        if self.channels && !channels.contains(&items.len()) {
            let message =
                format!("{} channels: from 2 to {MOST_CHANNELS} are possible", items.len());
            self.fault(programs.span(), message, "[[program]] is a program by itself");
            return Vec::new();
        }
        let mut all = Vec::new();
        for (index, item) in items.iter().enumerate() {
            let Some(table) = item.get_ref().as_table() else {
                self.fault(item.span(), "a program is a table, [[program]]".to_owned(), "");
                continue;
            };
            let mut own = self.said(table);
            if self.channels {
                own = own.with(self.channel(index + 1, items.len(), item.span()));
            }
            all.extend(self.program(above.with(own), Some(item.span())));
        }
        if all.is_empty() && self.faults.is_empty() {
            self.fault(programs.span(), "there is no program".to_owned(), "");
        }
        self.refuse_twice(&all);
        all
    }

    /// What the machine is told of a channel's number among all.
    fn channel(&self, number: usize, all: usize, span: Range<usize>) -> SaidKeys {
        let keys = [format!("wait.channel={number}"), format!("wait.channels={all}")];
        let value = SettingValue::List(keys.map(SettingValue::Text).to_vec());
        let place = self.place(span);
        let told = JobKeys::named("set").map(|about| ToldSetting { about, value, place });
        SaidKeys { told: told.into_iter().collect(), ..SaidKeys::default() }
    }

    /// Two programs of one name would take each other's place.
    fn refuse_twice(&mut self, programs: &[JobProgram]) {
        let output = |program: &JobProgram| {
            let told = program.told.iter().find(|setting| setting.about.name == "output").cloned();
            told.map(|told| (told.value.to_string(), told.place))
        };
        let mut met: Vec<String> = Vec::new();
        for (name, place) in programs.iter().filter_map(output) {
            if met.contains(&name) {
                let message = format!("another program of this job is {name} as well");
                let help = "give each program an output of its own";
                self.faults.push(Diagnostic::error("job-file", message).help(help).at(place));
            }
            met.push(name);
        }
    }

    /// The program that these keys mean, at `span`; none with a fault where one is missing.
    fn program(&mut self, said: SaidKeys, span: Option<Range<usize>>) -> Option<JobProgram> {
        let place = span.and_then(|span| self.place(span));
        let SaidKeys { machine, cl, mut told } = said;
        let mut missing = |what: &str, help: &str| {
            if self.faults.is_empty() {
                let message = format!("{} names no {what}", self.name);
                let fault = Diagnostic::error("job-file", message).help(help);
                self.faults.push(fault.at(place.clone()));
            }
        };
        let Some(machine) = machine else {
            missing(
                "machine",
                "machine = \"dmu50\" (`post machines` lists them), or a file that ends in .toml",
            );
            return None;
        };
        let mut cl = cl.into_iter().flatten();
        let Some(first) = cl.next() else {
            missing("CL file", "cl = \"part.cls\", as seen from the folder of the job file");
            return None;
        };
        for setting in &told {
            let other = |name: Option<&'static str>| {
                let other = name.and_then(|name| told.iter().find(|told| told.about.name == name));
                other.is_some_and(|other| other.value != SettingValue::Yes(false))
            };
            let name = setting.about.name;
            if let Some(with) = setting.about.conflicts.filter(|_| other(setting.about.conflicts)) {
                self.faults.push(setting.fault(&format!("it cannot go with {with}")));
            }
            if let Some(needed) = setting.about.requires.filter(|_| !other(setting.about.requires))
            {
                self.faults.push(setting.fault(&format!("{name} needs {needed}")));
            }
        }
        let further: Vec<_> = cl.map(SettingValue::Path).collect();
        if let Some(about) = JobKeys::named("then").filter(|_| !further.is_empty()) {
            told.push(ToldSetting { about, value: SettingValue::List(further), place });
        }
        Some(JobProgram { machine, cl: first, told })
    }

    /// What a table says.
    fn said(&mut self, table: &DeTable<'_>) -> SaidKeys {
        let mut said = SaidKeys::default();
        // In the order of the file, which the table has lost.
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in entries {
            if self.faults.len() >= MOST_FAULTS {
                break;
            }
            match key.get_ref().as_ref() {
                "machine" => said.machine = self.one_line(value).map(|name| self.machine(name)),
                "cl" => said.cl = self.cl_files(value),
                "then" => {
                    let help = "cl = [\"first.cls\", \"second.cls\"]";
                    self.fault(key.span(), "cl has all CL files of a program".to_owned(), help);
                }
                name => match JobKeys::named(name) {
                    Some(about) => said.told.extend(self.setting(about, key.span(), value)),
                    None => self.unknown(name, key.span()),
                },
            }
        }
        said
    }

    fn unknown(&mut self, name: &str, span: Range<usize>) {
        let settings = JobKeys::about().map(|about| about.name);
        let known: Vec<&str> = BESIDE.iter().map(|(name, _)| *name).chain(settings).collect();
        let help = meant(name, "its keys are", &known);
        self.fault(span, format!("a job file has no key `{name}`"), &help);
    }

    fn machine(&self, name: String) -> String {
        match machine_files::is_file(&name) {
            true => self.path(&name).to_string_lossy().into_owned(),
            false => name,
        }
    }

    /// A path as seen from here.
    fn path(&self, named: &str) -> PathBuf {
        paths::joined(self.path.parent(), Path::new(named))
    }

    /// A CL file, or several in their order; none with a fault.
    fn cl_files(&mut self, value: &Spanned<DeValue<'_>>) -> Option<Vec<PathBuf>> {
        let names = match value.get_ref() {
            DeValue::Array(items) if !items.is_empty() => {
                items.iter().map(|item| self.one_line(item)).collect::<Option<Vec<_>>>()?
            }
            _ => vec![self.one_line(value)?],
        };
        Some(names.iter().map(|name| self.path(name)).collect())
    }

    /// A text that stays in its line.
    fn one_line(&mut self, value: &Spanned<DeValue<'_>>) -> Option<String> {
        let text = value.get_ref().as_str().unwrap_or_default();
        if text.is_empty() || text.contains(is_unprintable) {
            self.fault(value.span(), "one line of text is meant".to_owned(), "");
            return None;
        }
        Some(text.to_owned())
    }

    /// A setting; none with a fault.
    fn setting(
        &mut self,
        about: &'static About,
        key: Range<usize>,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<ToldSetting> {
        if about.name == "plugins" {
            let message = "a job file names no folder of plugins".to_owned();
            let help = "opening a library runs its code: name the folder with --plugins on the command line";
            self.fault(key, message, help);
            return None;
        }
        let told = match about.name {
            "set" => self.set(value)?,
            _ => self.value(about, value)?,
        };
        if JobKeys::is_output(about) && !self.stays_below(about, value) {
            return None;
        }
        let place = self.place(value.span());
        let setting = ToldSetting { about, value: told, place };
        if setting.value == SettingValue::Yes(false) {
            return Some(setting);
        }
        let mut keys = JobKeys::default();
        let put = keys.groups().into_iter().find_map(|group| group.put(about.name, &setting.value));
        match put.unwrap_or(Ok(())) {
            Ok(()) => Some(setting),
            Err(why) => {
                self.faults.push(setting.fault(&why));
                None
            }
        }
    }

    /// What is written stands in the folder of the job file or below: a stranger's names no other file of the user's.
    fn stays_below(&mut self, about: &About, value: &Spanned<DeValue<'_>>) -> bool {
        let is_path = matches!(about.form, SettingForm::Path | SettingForm::PathIfAny);
        let Some(path) = value.get_ref().as_str().filter(|_| is_path) else {
            return true;
        };
        let folder = paths::folder(self.path);
        if paths::is_below(Path::new(path))
            && path != "-"
            && paths::leads_below(&folder, Path::new(path))
        {
            return true;
        }
        let message =
            format!("{}: what a job file has written stands in its folder or below", about.name);
        let help = format!("--{} on the command line names any other place", about.flag());
        self.fault(value.span(), message, &help);
        false
    }

    /// A value as its setting takes it; none with a fault.
    fn value(&mut self, about: &About, value: &Spanned<DeValue<'_>>) -> Option<SettingValue> {
        let is_path = matches!(about.form, SettingForm::Path | SettingForm::PathIfAny);
        let may_be_flag = matches!(about.form, SettingForm::Flag | SettingForm::PathIfAny);
        let told = match value.get_ref() {
            DeValue::String(_) if is_path => {
                self.one_line(value).map(|path| SettingValue::Path(self.path(&path)))
            }
            DeValue::String(_) => self.one_line(value).map(SettingValue::Text),
            DeValue::Boolean(yes) if may_be_flag => Some(SettingValue::Yes(*yes)),
            DeValue::Integer(_) if matches!(about.form, SettingForm::Whole { .. }) => {
                self.written(value).parse().ok().map(SettingValue::Whole)
            }
            // With the digits that it is written with.
            DeValue::Integer(_) | DeValue::Float(_) if matches!(about.form, SettingForm::Text) => {
                Some(SettingValue::Text(self.written(value)))
            }
            DeValue::Array(items) if !may_be_flag => {
                let values = items.iter().map(|item| self.value(about, item));
                return values.collect::<Option<_>>().map(SettingValue::List);
            }
            _ => None,
        };
        if told.is_none() && self.faults.len() < MOST_FAULTS {
            let kind = match about.form {
                SettingForm::Flag => "true or false",
                SettingForm::PathIfAny => "true, or a file",
                SettingForm::Path => "a file or a folder, as text",
                SettingForm::Whole { .. } => "a whole number",
                SettingForm::Text | SettingForm::Words(_) => "a number or a text",
            };
            self.fault(value.span(), format!("{} is {kind}", about.name), &about.text());
        }
        told
    }

    /// A number as the file has it, without what only parts its digits.
    fn written(&self, value: &Spanned<DeValue<'_>>) -> String {
        self.text.get(value.span()).unwrap_or_default().replace('_', "")
    }

    /// Keys of the machine file, a table: `--set` has them as `NAME=VALUE`.
    fn set(&mut self, value: &Spanned<DeValue<'_>>) -> Option<SettingValue> {
        let Some(table) = value.get_ref().as_table() else {
            let help = "[set] has parameters and keys of the machine file: Lm = 312, accuracy.tolerance = 0.01";
            self.fault(value.span(), "set is a table".to_owned(), help);
            return None;
        };
        let mut told = Vec::new();
        self.set_below("", table, &mut told);
        Some(SettingValue::List(told.into_iter().map(SettingValue::Text).collect()))
    }

    fn set_below(&mut self, above: &str, table: &DeTable<'_>, told: &mut Vec<String>) {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in entries {
            let name = match above {
                "" => key.get_ref().to_string(),
                above => format!("{above}.{}", key.get_ref()),
            };
            if let Some(below) = value.get_ref().as_table() {
                self.set_below(&name, below, told);
                continue;
            }
            if name == "tools.file" {
                let help = "tools = \"tool.tbl\" above the tables, as seen from the folder of the job file";
                self.fault(key.span(), "the file of tools is a key of its own".to_owned(), help);
                continue;
            }
            let written = self.text.get(value.span()).unwrap_or_default();
            if name.contains(['=', '\n']) || written.contains(is_unprintable) {
                let message = format!("{name}: one line of what can be read is meant");
                self.fault(value.span(), message, "");
                continue;
            }
            told.push(format!("{name}={written}"));
        }
    }

    fn fault(&mut self, span: Range<usize>, message: String, help: &str) {
        if self.faults.len() >= MOST_FAULTS {
            return;
        }
        let fault = Diagnostic::error("job-file", message).at(self.place(span));
        self.faults.push(if help.is_empty() { fault } else { fault.help(help) });
    }

    /// The line that a span begins in.
    fn place(&self, span: Range<usize>) -> Option<SourcePlace> {
        let before = self.text.get(..span.start)?;
        let begin = before.rfind('\n').map_or(0, |end| end + 1);
        let number = 1 + before.bytes().filter(|byte| *byte == b'\n').count();
        let line = self.text[begin..].lines().next().unwrap_or_default();
        let span = span.start - begin..span.end.saturating_sub(begin).min(line.len());
        Some(SourcePlace::new(self.name, number as u64, line, span))
    }
}

impl ToldSetting {
    /// What is wrong with its value.
    pub(super) fn fault(&self, why: &str) -> Diagnostic {
        let message = format!("{}: {why}", self.about.name);
        let help = format!("as --{} of the command: {}", self.about.flag(), self.about.text());
        Diagnostic::error("job-file", message).help(help).at(self.place.clone())
    }
}
