//! What the command can fail with, and the exit code of each way to fail.

use post_job::failure::Failure;
use post_job::files::FileFault;

/// Why the command did not do what it was asked to.
#[derive(Debug)]
pub enum CommandFault {
    /// The command line is wrong. Help and version, which end the program too, come this way and are no fault.
    Usage(clap::Error),
    /// The job was not done.
    Job(Failure),
    /// A verb whose findings end it with 1 could not look for them.
    NotLooked(Failure),
}

impl CommandFault {
    /// What the program ends with, as `--help` documents it: 1 refused, or different, 2 the command line is wrong, or what
    /// `post lint` looks over cannot be read, 141 the reader of a pipe went away.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(error) if error.use_stderr() => 2,
            Self::Usage(_) => 0,
            // What shells say of a command whose reader went away.
            Self::Job(Failure::File(FileFault::ReaderGone(_)))
            | Self::NotLooked(Failure::File(FileFault::ReaderGone(_))) => 141,
            Self::NotLooked(_) => 2,
            Self::Job(_) => 1,
        }
    }
}

impl From<Failure> for CommandFault {
    fn from(failure: Failure) -> Self {
        Self::Job(failure)
    }
}
