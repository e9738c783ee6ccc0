//! The texts that jobs read: CL files and machine files, each read once, by the name that the user gave.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

use post_machine::description::{Machine, Setting, Source, load};
use post_machine::diagnostic::{Diagnostic, FurtherFile};
use serde::{Deserialize, Serialize};

use crate::disk;
use crate::failure::Failure;
use crate::files::{FileFault, JoinedFiles, PathArg};
use crate::machine_files;
use crate::session::Session;
use crate::settings::JobSettings;

/// A CL file as it was when it was read.
#[derive(Debug)]
pub struct ClText {
    /// Its bytes.
    pub bytes: Arc<[u8]>,
    /// Hash of its bytes.
    pub hash: blake3::Hash,
    /// Where the files behind the first begin, of several that are joined.
    pub further: Arc<[FurtherFile]>,
}

impl ClText {
    fn new(bytes: Vec<u8>) -> Arc<Self> {
        Self::joined(bytes, Arc::default())
    }

    fn joined(bytes: Vec<u8>, further: Arc<[FurtherFile]>) -> Arc<Self> {
        Arc::new(Self { hash: blake3::hash(&bytes), bytes: bytes.into(), further })
    }
}

/// A machine file and all that it extends, or why there is none.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum MachineTexts {
    Found {
        /// What messages call it.
        name: String,
        text: String,
        /// By the names that `extends` has: what messages call it, and its text; or why it is not there.
        parents: BTreeMap<String, Result<(String, String), String>>,
    },
    /// Each message with what would help.
    Missing(Vec<(String, Option<String>)>),
}

impl MachineTexts {
    fn find(session: &Session, machine: &str, folders: &[PathBuf]) -> Self {
        let read = |path: &Path| machine_files::read(session, path);
        let source = match machine_files::source(machine, folders, &read) {
            Ok(source) => source,
            Err(failure) => {
                let findings = failure.findings().into_iter();
                return Self::Missing(findings.map(|told| (told.message, told.help)).collect());
            }
        };
        let mut parents = BTreeMap::new();
        let (name, text) = (source.name.clone(), source.text.clone());
        // What is wrong with it, each job says of its own settings.
        let _ = load(source, &[], &mut |parent| {
            let found = machine_files::parent(&name, parent, folders, &read);
            let kept = found.clone().map(|source| (source.name, source.text));
            parents.insert(parent.to_owned(), kept);
            found
        });
        Self::Found { name, text, parents }
    }

    /// The machine with settings over it.
    ///
    /// # Errors
    /// There is none, or what is wrong with its file.
    pub fn load(&self, settings: &[Setting]) -> Result<Machine, Vec<Diagnostic>> {
        let (name, text, parents) = match self {
            Self::Found { name, text, parents } => (name.clone(), text.clone(), parents),
            Self::Missing(told) => {
                let told = told.iter().map(|(message, help)| Diagnostic {
                    help: help.clone(),
                    ..Diagnostic::error("machine", message.as_str())
                });
                return Err(told.collect());
            }
        };
        load(Source { name, text }, settings, &mut |parent| match parents.get(parent) {
            Some(Ok((name, text))) => Ok(Source { name: name.clone(), text: text.clone() }),
            Some(Err(why)) => Err(why.clone()),
            None => Err(format!("there is no machine {parent}")),
        })
    }
}

/// Where jobs have their texts from.
#[derive(Debug, Default)]
pub struct Inputs {
    /// Handed over: no disk is asked for these.
    given: BTreeMap<String, Arc<ClText>>,
    /// Read from the disk, kept while a job works with it.
    read: Mutex<BTreeMap<String, Weak<ClText>>>,
    machines: BTreeMap<String, Arc<MachineTexts>>,
}

impl Inputs {
    /// Those of the machines with these names are read at once: what they are does not change under the study.
    pub fn new<'m>(
        session: &Session,
        machines: impl Iterator<Item = &'m str>,
        folders: &[PathBuf],
    ) -> Self {
        let mut inputs = Self::default();
        for machine in machines {
            if !inputs.machines.contains_key(machine) {
                let texts = MachineTexts::find(session, machine, folders);
                inputs.machines.insert(machine.to_owned(), Arc::new(texts));
            }
        }
        inputs
    }

    /// All from elsewhere: CL files by their names, and what [`Inputs::machines_json`] wrote.
    ///
    /// # Errors
    /// That is none.
    pub fn handed_over(
        files: impl Iterator<Item = (String, Vec<u8>)>,
        machines: &str,
    ) -> Result<Self, String> {
        let machines: BTreeMap<String, MachineTexts> =
            serde_json::from_str(machines).map_err(|error| error.to_string())?;
        let machines = machines.into_iter();
        Ok(Self {
            given: files.map(|(name, bytes)| (name, ClText::new(bytes))).collect(),
            read: Mutex::default(),
            machines: machines.map(|(name, texts)| (name, Arc::new(texts))).collect(),
        })
    }

    /// The texts of all machines, to be handed over.
    pub fn machines_json(&self) -> String {
        let machines: BTreeMap<&str, &MachineTexts> =
            self.machines.iter().map(|(name, texts)| (name.as_str(), texts.as_ref())).collect();
        crate::files::json_line(&machines)
    }

    /// The machine of that name.
    pub fn machine(&self, name: &str) -> Arc<MachineTexts> {
        let known = self.machines.get(name).cloned();
        known.unwrap_or_else(|| {
            let message = format!("the text of the machine {name} was not handed over");
            Arc::new(MachineTexts::Missing(vec![(message, None)]))
        })
    }

    /// The CL files of a job as one text.
    ///
    /// # Errors
    /// One of them cannot be read.
    pub fn all_cl(&self, session: &Session, job: &JobSettings) -> Result<Arc<ClText>, Failure> {
        let input = JoinedFiles::new(session, job.files().cloned().collect())?.open(session)?;
        let (name, mut from, mut bytes) = (input.name, input.bytes, Vec::new());
        from.read_to_end(&mut bytes).map_err(|error| FileFault::Read { name, error })?;
        Ok(ClText::joined(bytes, input.further))
    }

    /// The CL file.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn cl(&self, session: &Session, file: &str) -> Result<Arc<ClText>, Failure> {
        if let Some(text) = self.given.get(file) {
            return Ok(Arc::clone(text));
        }
        // Others wait while one reads: most often they want the same file.
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(text) = read.get(file).and_then(Weak::upgrade) {
            return Ok(text);
        }
        let argument = PathArg::from(PathBuf::from(file));
        let (Some(path), named) = (argument.absolute(), Path::new(file)) else {
            let message = "a batch goes over its CL files several times";
            return Err(Diagnostic::error("batch", message)
                .help("give a file, not standard input")
                .into());
        };
        if disk::is_dir(path) {
            return Err(FileFault::ReadFolder(named.to_owned()).into());
        }
        let bytes = disk::read(path).map_err(|error| FileFault::read(named, error))?;
        session.read_files().note("the CL file", path);
        let text = ClText::new(bytes);
        read.insert(file.to_owned(), Arc::downgrade(&text));
        Ok(text)
    }
}
