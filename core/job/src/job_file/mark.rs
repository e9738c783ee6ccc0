//! What names a job file in the head of a program, and how it is found by that.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Path, PathBuf};

use post_grammar::text::as_remark;
use post_machine::diagnostic::Diagnostic;

use super::{is_job_file, paths, reading};
use crate::failure::Failure;
use crate::files::PathArg;
use crate::session::Session;

/// What stands before the hash.
const WORD: &str = "JOB ";

/// Hexadecimal digits of the hash: 64 bits tell job files of one folder apart.
const DIGITS: usize = 16;

/// A head has its mark within so many bytes.
const HEAD: u64 = 1 << 16;

/// So many job files of a folder are looked into.
const MOST_FILES: usize = 1_000;

/// Names a job file: a program has it in its head.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JobMark {
    /// Name of the file, without its folder.
    pub name: String,
    /// First digits of the BLAKE3 hash of its text, hexadecimal.
    pub hash: String,
}

impl JobMark {
    /// Of a job file with this text.
    pub fn new(path: &Path, text: &str) -> Self {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut hash = blake3::hash(text.as_bytes()).to_hex().to_string();
        hash.truncate(DIGITS);
        Self { name, hash }
    }

    /// The remark that a program has in its head.
    pub fn remark(&self) -> String {
        as_remark(format!("{WORD}{} {}", self.hash, self.name))
    }

    /// The hash that the head of a program has; controls write remarks in capitals.
    fn in_head(text: &str) -> Option<String> {
        let text = text.to_ascii_lowercase();
        let word = WORD.to_ascii_lowercase();
        let mut marks = text.match_indices(&word).filter_map(|(at, _)| {
            let begin = at + word.len();
            let hash = text.get(begin..begin + DIGITS)?;
            // A long name may stand in a remark of its own.
            let ends = !text[begin + DIGITS..].starts_with(|next: char| next.is_alphanumeric());
            (ends && hash.bytes().all(|byte| byte.is_ascii_hexdigit())).then(|| hash.to_owned())
        });
        marks.next()
    }
}

/// The job file that the head of a program names, out of those that lie beside the program; none if it names none.
///
/// # Errors
/// It names one, and none beside it is that.
pub fn job_of_program(session: &Session, program: &PathArg) -> Result<Option<PathBuf>, Failure> {
    let Some(path) = program.path() else {
        return Ok(None);
    };
    let Some(hash) = head(path).as_deref().and_then(JobMark::in_head) else {
        return Ok(None);
    };
    let folder = paths::folder(path);
    let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
    names.retain(|name| is_job_file(Path::new(name)));
    names.sort();
    for name in names.into_iter().take(MOST_FILES) {
        let file = paths::joined(path.parent(), Path::new(&name));
        let found = reading::text_of(session, &file);
        if found.is_ok_and(|text| JobMark::new(&file, &text).hash == hash) {
            return Ok(Some(file));
        }
    }
    let message = format!(
        "{} was posted from the job file with the hash {hash}, and none in its folder is that one",
        path.display()
    );
    let help = "the job file may have been changed since: post it again, or name machine and CL file, or the job file by --machine";
    Err(Diagnostic::error("job-file", message).help(help).into())
}

/// Whether the head of a program names a job file: `post` has written it.
pub fn is_marked(program: &PathArg) -> bool {
    program.path().and_then(head).as_deref().and_then(JobMark::in_head).is_some()
}

/// The beginning of a program; none of what is no regular file.
fn head(path: &Path) -> Option<String> {
    if !path.metadata().ok()?.is_file() {
        return None;
    }
    let mut bytes = Vec::new();
    File::open(path).ok()?.take(HEAD).read_to_end(&mut bytes).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}
