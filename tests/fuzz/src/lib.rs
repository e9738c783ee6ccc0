//! What is fuzzed: a file of a stranger's, and the command lines of `post` that read it (`targets.toml`).
//!
//! A command line is run within the process, as an editor or Python does; a panic, a sum beyond its number, a refusal that
//! says nothing, and a program that `post` itself finds wrong are faults, and libFuzzer adds what takes too long or too
//! much memory.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use post_cli::failure::CommandFault;
use post_job::session::Session;
use serde::Deserialize;

/// What is fuzzed, by its name.
pub type Targets = BTreeMap<String, Target>;

/// A file, and what reads it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the file that is made.
    pub file: String,
    /// Text that what is made stands in, at `INPUT`.
    around: Option<String>,
    /// Files that lie beside it: `FROM=TO`, from the root of the checkout.
    #[serde(default)]
    beside: Vec<String>,
    /// Command lines, each run where the one before it was good.
    runs: Vec<String>,
    /// Files of the checkout to begin with; `*` stands for any letters.
    #[serde(default)]
    pub seeds: Vec<String>,
    /// Texts to begin with.
    #[serde(default)]
    pub words: Vec<String>,
    /// Files to begin with that a command line makes.
    pub made: Option<Made>,
}

/// Files that a command line makes of others: `IN` and `OUT` stand for their names.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Made {
    /// The command line.
    pub run: String,
    /// The files that it is run on.
    pub of: Vec<String>,
}

/// The root of the checkout.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().and_then(Path::parent).expect("tests/fuzz")
}

/// All that is fuzzed.
pub fn targets() -> Targets {
    toml::from_str(include_str!("../targets.toml")).expect("targets.toml")
}

/// Runs a command line of `post`, without its name: what is told where it fails.
///
/// # Errors
/// What it says, one finding a line.
pub fn run(words: &str) -> Result<(), String> {
    let session = Session::quiet();
    let line: Vec<OsString> =
        std::iter::once("post").chain(words.split_whitespace()).map(Into::into).collect();
    post_command::run_words(&session, &line).map_err(|fault| match fault {
        CommandFault::Usage(fault) => panic!("the command line {words}: {fault}"),
        CommandFault::Job(fault) | CommandFault::NotLooked(fault) => {
            let findings = fault.findings();
            findings.iter().map(|found| format!("{}: {}\n", found.code, found.message)).collect()
        }
    })
}

/// A folder in which a target's command lines are run, and what lies there.
#[derive(Debug)]
pub struct Room {
    target: Target,
    folder: PathBuf,
}

impl Room {
    /// Makes it in `folder`, which becomes the folder of the process.
    pub fn new(target: &Target, folder: &Path) -> Self {
        for file in &target.beside {
            let (from, to) = file.split_once('=').expect("FROM=TO");
            fs::copy(root().join(from), folder.join(to)).expect(from);
        }
        std::env::set_current_dir(folder).expect("the folder");
        Self { target: target.clone(), folder: folder.to_owned() }
    }

    /// Runs the command lines on a file that is made of `bytes`: the last one's answer.
    ///
    /// # Panics
    /// A run is wrong.
    ///
    /// # Errors
    /// What it was refused for.
    pub fn take(&self, bytes: &[u8]) -> Result<(), String> {
        let made = match &self.target.around {
            None => bytes.to_vec(),
            Some(around) => {
                let (before, after) = around.split_once("INPUT").expect("INPUT");
                [before.as_bytes(), bytes, after.as_bytes()].concat()
            }
        };
        fs::write(self.folder.join(&self.target.file), made).expect("room on the disk");
        for (place, words) in self.target.runs.iter().enumerate() {
            if let Err(told) = run(words) {
                assert!(!told.trim().is_empty(), "post {words}: refused, and nothing is said");
                // A program of ours that is wrong by our own reading is none that may be written.
                let own = place > 0 && words.starts_with("verify");
                assert!(!own, "post {words}: {told}");
                return Err(told);
            }
        }
        Ok(())
    }
}
