//! What a job can fail with.

use post_machine::diagnostic::Diagnostic;

use crate::files::FileFault;

/// Why a job was not done.
#[derive(Debug)]
pub enum Failure {
    /// A file cannot be read or written.
    File(FileFault),
    /// Something that was read is refused: findings, each with its file and line, an error among them.
    Refused(Vec<Diagnostic>),
    /// What was compared is not the same: all is told.
    Different,
}

impl Failure {
    /// What is said to the user.
    pub fn findings(self) -> Vec<Diagnostic> {
        match self {
            Self::Different => Vec::new(),
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
