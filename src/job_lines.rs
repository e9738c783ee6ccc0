//! A job file on the command line: each of its programs is a command line of its own, with the words that the file has.
//!
//! What the user says besides goes before the file's.

use std::ffi::{OsStr, OsString};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use post_machine::diagnostic::Diagnostic;

use post_job::disk;
use post_job::failure::Failure;
use post_job::files::{FileFault, PathArg};
use post_job::job_file::{
    self, JobFile, JobKeys, JobMark, JobProgram, is_job_file, job_of_program,
};
use post_job::old_summary::OldSummary;
use post_job::session::Session;
use post_job::settings::{
    About, MachineSettings, ProgramSettings, ReadingSettings, SettingValue, SettingsGroup,
};

/// A command line of one program of a job.
#[derive(Debug)]
pub struct ProgramWords {
    /// Its words, the name of the command first.
    pub words: Vec<OsString>,
    /// What the job file alone says: where a program is made as it says.
    pub plain: Option<PlainWords>,
    /// It is made with those of the other channels.
    pub channel: bool,
}

/// The words of a job file, without what the user says besides.
#[derive(Debug)]
pub struct PlainWords {
    /// The words, the name of the command first.
    pub words: Vec<OsString>,
    /// What names the job file.
    pub mark: JobMark,
}

/// What a verb takes of a job.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Takes {
    /// CL file, machine and all settings; no verb is named.
    All,
    /// CL file and machine, and how the one is meant on the other.
    Cl,
    /// The CL file.
    ClAlone,
    /// The program, and the CL file that it is held against.
    Against,
    /// The program, and the machine that runs it.
    Program,
    /// The program, and the machine that it was made for.
    From,
}

const VERBS: [(&str, Takes); 8] = [
    ("place", Takes::Cl),
    ("words", Takes::ClAlone),
    ("verify", Takes::Against),
    ("predict", Takes::Against),
    ("read", Takes::Program),
    ("lint", Takes::Program),
    ("diff", Takes::Program),
    ("convert", Takes::From),
];

/// Flags of one place each: they cannot be those of several programs.
const PLACES: [&str; 13] = [
    "output",
    "summary",
    "setup-sheet",
    "report",
    "save-job",
    "map",
    "csv",
    "svg",
    "pictures",
    "plan-pictures",
    "json",
    "sarif",
    "cl",
];

/// A job file that the words name.
struct NamedJob {
    place: JobPlace,
    file: PathBuf,
}

/// Where the words name the job.
enum JobPlace {
    /// In place of the first argument, at this word.
    Argument(usize),
    /// In place of the machine: from this word, so many.
    Machine(usize, usize),
    /// By the head of this program.
    Head(PathBuf),
}

/// The command lines of the programs of the job that `words` name; none if they name no job. `verbs` gives the names
/// of all that there are.
///
/// # Errors
/// The job file is refused, or what is said besides cannot go with it.
pub fn lines(
    session: &Session,
    words: &[OsString],
    verbs: &dyn Fn() -> Vec<String>,
) -> Result<Option<Vec<ProgramWords>>, Failure> {
    let verb = words.get(1).and_then(|word| word.to_str()).unwrap_or_default();
    let known = VERBS.iter().find(|(name, _)| *name == verb);
    let takes = known.map_or(Takes::All, |(_, takes)| *takes);
    let mut found = job_words(words);
    // Most command lines name no job, and need not know all verbs.
    let names_any = !found.is_empty() || words.iter().any(|word| is_like(word));
    if known.is_none() && names_any && verbs().iter().any(|other| other == verb) {
        return Ok(None);
    }
    if found.len() > 1 {
        let message = "two job files are named, and a job is one of them";
        return Err(Diagnostic::error("job-file", message).into());
    }
    let found = match found.pop() {
        Some(found) => Some(found),
        None => job_of_head(session, words, takes)?,
    };
    let like = match takes {
        Takes::All => like(session, words)?,
        _ => Vec::new(),
    };
    let Some(NamedJob { place, file }) = found else {
        if like.is_empty() {
            return Ok(None);
        }
        let mut all = words[..1].to_vec();
        all.extend(like);
        all.extend_from_slice(&words[1..]);
        return Ok(Some(vec![ProgramWords { words: all, plain: None, channel: false }]));
    };
    let job = job_file::read(session, &file)?;
    let words = JobWords { session, words, takes, job: &job, like };
    words.lines(&place).map(Some)
}

fn is_like(word: &OsStr) -> bool {
    word.to_string_lossy().starts_with("--like")
}

/// The flags that `--like` stands for; none without it.
fn like(session: &Session, words: &[OsString]) -> Result<Vec<OsString>, Failure> {
    let mut files = words.iter().enumerate().filter_map(|(index, word)| {
        let text = word.to_str()?;
        match text.strip_prefix("--like") {
            Some("") => words.get(index + 1).map(PathBuf::from),
            Some(rest) => rest.strip_prefix('=').map(PathBuf::from),
            None => None,
        }
    });
    let Some(file) = files.next() else {
        return Ok(Vec::new());
    };
    let old = OldSummary::read(session, &PathArg::from(file))?;
    let named = old.told.iter().filter_map(|(name, value)| {
        let about = JobKeys::named(name)?;
        Some(flags(about, &about.flag(), value))
    });
    Ok(named.flatten().collect())
}

/// Where the words name job files, and which.
fn job_words(words: &[OsString]) -> Vec<NamedJob> {
    let mut found = Vec::new();
    for (index, word) in words.iter().enumerate().skip(1) {
        let before = words[index - 1].to_str().unwrap_or_default();
        let text = word.to_str().unwrap_or_default();
        let given = ["--machine=", "-m"].iter().find_map(|flag| text.strip_prefix(flag));
        if before == "--save-job" {
            continue;
        }
        match given {
            Some(file) if is_job_file(Path::new(file)) => {
                let place = JobPlace::Machine(index, 1);
                found.push(NamedJob { place, file: PathBuf::from(file) });
            }
            _ if text.starts_with('-') || !is_job_file(Path::new(word)) => {}
            _ if ["-m", "--machine"].contains(&before) => {
                let place = JobPlace::Machine(index - 1, 2);
                found.push(NamedJob { place, file: PathBuf::from(word) });
            }
            _ => {
                let place = JobPlace::Argument(index);
                found.push(NamedJob { place, file: PathBuf::from(word) });
            }
        }
    }
    found
}

/// The job that the head of a program names, where the words name no machine.
fn job_of_head(
    session: &Session,
    words: &[OsString],
    takes: Takes,
) -> Result<Option<NamedJob>, Failure> {
    let machines = ["-m", "--machine", "--from", "-h", "--help"];
    let names_one = |word: &OsString| {
        let text = word.to_string_lossy();
        machines.iter().any(|flag| text.starts_with(flag))
    };
    let reads = matches!(takes, Takes::Against | Takes::Program | Takes::From);
    if !reads || words.iter().any(names_one) {
        return Ok(None);
    }
    // Before what is missing besides: a name that was mistyped.
    if let Some(program) = words.get(2).map(PathBuf::from)
        && !program.as_os_str().as_encoded_bytes().starts_with(b"-")
        && let Err(error) = disk::metadata(&program)
        && error.kind() == ErrorKind::NotFound
    {
        return Err(FileFault::read(&program, error).into());
    }
    // Of two programs the new one is mostly that of the job.
    for word in words.iter().skip(2).rev() {
        if word.as_encoded_bytes().starts_with(b"-") {
            continue;
        }
        if let Some(file) = job_of_program(session, &PathArg::from(PathBuf::from(word)))? {
            let place = JobPlace::Head(PathBuf::from(word));
            return Ok(Some(NamedJob { place, file }));
        }
    }
    Ok(None)
}

/// The words of a command line that names a job, and the job.
struct JobWords<'a> {
    session: &'a Session,
    words: &'a [OsString],
    takes: Takes,
    job: &'a JobFile,
    /// What an old run's summary says, before what the user says.
    like: Vec<OsString>,
}

impl JobWords<'_> {
    fn lines(&self, named: &JobPlace) -> Result<Vec<ProgramWords>, Failure> {
        let programs = self.programs(named)?;
        if programs.len() > 1 {
            self.refuse_one_place(programs.len())?;
        }
        if self.takes == Takes::ClAlone {
            let files = programs.into_iter().flat_map(JobProgram::each_cl);
            return files.map(|program| self.line(&program, named)).collect();
        }
        programs.into_iter().map(|program| self.line(program, named)).collect()
    }

    /// The programs that are meant.
    fn programs(&self, named: &JobPlace) -> Result<Vec<&JobProgram>, Failure> {
        let all = &self.job.programs;
        let is_named = |program: &&JobProgram| match named {
            JobPlace::Argument(_) => true,
            JobPlace::Head(path) => program.is_named(path),
            JobPlace::Machine(..) => {
                self.words.iter().any(|word| program.is_named(Path::new(word)))
            }
        };
        let mut meant: Vec<&JobProgram> = all.iter().filter(is_named).collect();
        if let (true, JobPlace::Head(path)) = (meant.is_empty(), named) {
            meant.extend(all.iter().filter(|program| program.is_titled(path)));
        }
        match (meant.as_slice(), all.as_slice()) {
            ([], [one]) => Ok(vec![one]),
            ([], _) => {
                let message = format!(
                    "{} has {} programs, and none of them is called as what is named here",
                    self.job.name,
                    all.len()
                );
                let help = "the name of a program is its output, or that of its CL file";
                Err(Diagnostic::error("job-file", message).help(help).into())
            }
            _ => Ok(meant),
        }
    }

    /// Refuses a place to write that several programs would share.
    fn refuse_one_place(&self, count: usize) -> Result<(), Failure> {
        let said = self.words.iter().find_map(|word| {
            let text = word.to_str()?;
            let flag = match text {
                "-o" => "output",
                text => text.strip_prefix("--")?.split('=').next()?,
            };
            PLACES.contains(&flag).then(|| flag.to_owned())
        });
        let pair = self.words.get(1).is_some_and(|verb| verb == "diff" || verb == "convert");
        let what = match said {
            Some(flag) => format!("--{flag}"),
            None if pair => "this verb".to_owned(),
            None => return Ok(()),
        };
        let message = format!("{} has {count} programs, and {what} takes one", self.job.name);
        let help = "let the job file say what each program writes, or name a program and the job file by --machine";
        Err(Diagnostic::error("job-file", message).help(help).into())
    }

    fn line(&self, program: &JobProgram, named: &JobPlace) -> Result<ProgramWords, Failure> {
        let verb = usize::from(self.takes != Takes::All);
        let mut words: Vec<OsString> = self.words[..=verb].to_vec();
        words.extend(self.flags(program));
        let stands_for = self.argument(program, named)?;
        let mut plain = words.clone();
        plain.extend(stands_for.clone());
        words.extend(self.like.iter().cloned());
        for (index, word) in self.words.iter().enumerate().skip(verb + 1) {
            match named {
                JobPlace::Argument(at) if *at == index => words.extend(stands_for.clone()),
                JobPlace::Machine(at, count) if (*at..at + count).contains(&index) => {}
                _ => words.push(word.clone()),
            }
        }
        let is_job = self.takes == Takes::All && matches!(named, JobPlace::Argument(_));
        let plain = is_job.then(|| PlainWords { words: plain, mark: self.job.mark.clone() });
        Ok(ProgramWords { words, plain, channel: is_job && self.job.channels })
    }

    /// What stands in place of the job file; none where it stands for the machine.
    fn argument(
        &self,
        program: &JobProgram,
        named: &JobPlace,
    ) -> Result<Option<OsString>, Failure> {
        if !matches!(named, JobPlace::Argument(_)) {
            return Ok(None);
        }
        let path = match self.takes {
            Takes::All | Takes::Cl | Takes::ClAlone => program.cl.clone(),
            Takes::Against | Takes::Program | Takes::From => {
                let target = program.target(self.session)?;
                target.path().map(Path::to_owned).unwrap_or_default()
            }
        };
        Ok(Some(argument(&path)))
    }

    /// The flags of a program.
    fn flags(&self, program: &JobProgram) -> Vec<OsString> {
        let mut flags = Vec::new();
        let machine = OsStr::new(&program.machine);
        match self.takes {
            Takes::ClAlone => return flags,
            Takes::From => flags.push(valued("from", machine)),
            _ => flags.push(valued("machine", machine)),
        }
        if self.takes == Takes::Against {
            flags.push(valued("against", program.cl.as_os_str()));
        }
        for setting in &program.told {
            let plans = setting.about.name == "plan" && setting.value == SettingValue::Yes(true);
            if plans && self.words.get(1).is_some_and(|verb| verb == "verify") {
                flags.push("--planned".into());
            }
            let Some(flag) = self.flag(setting.about) else {
                continue;
            };
            flags.extend(self::flags(setting.about, &flag, &setting.value));
        }
        flags
    }

    /// The flag that a setting is to the verb; none if the verb does without it.
    fn flag(&self, about: &About) -> Option<String> {
        let name = about.name;
        let reads = || ReadingSettings::row(name).is_some() || MachineSettings::row(name).is_some();
        let is_output = JobKeys::is_output(about);
        let of_program = !is_output && ProgramSettings::row(name).is_some();
        let read_back = of_program && MachineSettings::row(name).is_none();
        match self.takes {
            Takes::All => (!read_back).then(|| about.flag()),
            Takes::Cl => reads().then(|| about.flag()),
            Takes::Against => (reads() || read_back).then(|| about.flag()),
            Takes::Program => of_program.then(|| about.flag()),
            Takes::From => match name {
                "mount" | "set" | "dialect" => Some(format!("from-{}", about.flag())),
                "offsets" | "tool_length" | "most_blocks" | "machines" => Some(about.flag()),
                _ => None,
            },
            Takes::ClAlone => None,
        }
    }
}

/// A setting as the command line says it: several values by several flags, but for the numbers of one point.
fn flags(about: &About, flag: &str, value: &SettingValue) -> Vec<OsString> {
    let values = match value {
        SettingValue::List(values) if about.many => values.as_slice(),
        value => std::slice::from_ref(value),
    };
    let words = values.iter().filter_map(|value| match value {
        SettingValue::Yes(false) => None,
        SettingValue::Yes(true) => Some(format!("--{flag}").into()),
        SettingValue::Path(path) => Some(valued(flag, path.as_os_str())),
        value => Some(valued(flag, OsStr::new(&value.to_string()))),
    });
    words.collect()
}

/// `--FLAG=VALUE`: a value may begin with a hyphen.
fn valued(flag: &str, value: &OsStr) -> OsString {
    let mut word = OsString::from(format!("--{flag}="));
    word.push(value);
    word
}

/// A path that no command line takes for a flag.
fn argument(path: &Path) -> OsString {
    match path.as_os_str().as_encoded_bytes().starts_with(b"-") {
        true => Path::new(".").join(path).into(),
        false => path.into(),
    }
}
