//! What a verb can fail with, and the exit code of each way to fail.

use post_machine::diagnostic::Diagnostic;

use crate::files::FileFault;

/// Why a verb did not do what it was asked to.
#[derive(Debug)]
pub enum Failure {
    /// The command line is wrong. Help and version, which end the program too, come this way and are no fault.
    Usage(clap::Error),
    /// A file cannot be read or written.
    File(FileFault),
    /// Something that was read is refused: findings, each with its file and line, an error among them.
    Refused(Vec<Diagnostic>),
    /// What was compared is not the same: all is told.
    Different,
}

impl Failure {
    /// What the program ends with, as `--help` documents it: 1 refused, or different, 2 the command line is wrong, 141 the reader of a
    /// pipe went away.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(error) if error.use_stderr() => 2,
            Self::Usage(_) => 0,
            // What shells say of a command whose reader went away.
            Self::File(FileFault::ReaderGone(_)) => 141,
            Self::File(_) | Self::Refused(_) | Self::Different => 1,
        }
    }

    /// What is said to the user; a wrong command line is clap's to explain.
    pub fn findings(self) -> Vec<Diagnostic> {
        match self {
            Self::Usage(_) | Self::Different => Vec::new(),
            Self::File(fault) => vec![fault.into()],
            Self::Refused(findings) => findings,
        }
    }
}

impl From<FileFault> for Failure {
    fn from(fault: FileFault) -> Self {
        Self::File(fault)
    }
}

impl From<Diagnostic> for Failure {
    fn from(finding: Diagnostic) -> Self {
        Self::Refused(vec![finding])
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(finding: Box<Diagnostic>) -> Self {
        Self::Refused(vec![*finding])
    }
}

impl From<Vec<Diagnostic>> for Failure {
    fn from(findings: Vec<Diagnostic>) -> Self {
        Self::Refused(findings)
    }
}
