//! What names a job file in the head of a program, and how it is found by that.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use post_grammar::text::as_remark;
use post_machine::diagnostic::Diagnostic;

use super::{is_job_file, paths, reading};
use crate::disk;
use crate::failure::Failure;
use crate::files::PathArg;
use crate::session::Session;

/// What stands before the hash.
const WORD: &str = "JOB ";

/// Hexadecimal digits of the hash: 64 bits tell job files of one folder apart.
const DIGITS: usize = 16;

/// A head has its mark within so many bytes.
const HEAD: u64 = 1 << 16;

/// So many folders above that of a program are looked into.
const ABOVE: usize = 3;

/// A program says its name within so many lines.
const TITLE_LINES: usize = 3;

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

/// The job file that the head of a program names, out of those that lie beside the program, in the folders above it or in
/// the working directory: a program is moved to where the machine reads it. None if it names none.
///
/// # Errors
/// It names one, and none of these is that.
pub fn job_of_program(session: &Session, program: &PathArg) -> Result<Option<PathBuf>, Failure> {
    let Some(path) = program.path() else {
        return Ok(None);
    };
    let Some(hash) = head(path).as_deref().and_then(JobMark::in_head) else {
        return Ok(None);
    };
    let beside = path.parent().map(Path::to_owned);
    let whole = disk::canonicalize(paths::folder(path)).unwrap_or_default();
    let above = whole.ancestors().skip(1).take(ABOVE).map(|folder| Some(folder.to_owned()));
    for folder in [beside, None].into_iter().chain(above) {
        let found = in_folder(session, folder.as_deref(), &hash);
        if found.is_some() {
            return Ok(found);
        }
    }
    let message = format!(
        "{} was posted from the job file with the hash {hash}, and none in its folder is that one",
        path.display()
    );
    let help = "the job file may have been changed since: post it again, or name machine and CL file, or the job file by --machine";
    Err(Diagnostic::error("job-file", message).help(help).into())
}

/// The job file of a folder, none: the working directory, that has this hash.
fn in_folder(session: &Session, folder: Option<&Path>, hash: &str) -> Option<PathBuf> {
    let listed = folder.filter(|folder| !folder.as_os_str().is_empty());
    let entries = disk::read_dir(listed.unwrap_or(Path::new("."))).into_iter().flatten().flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name()).collect();
    names.retain(|name| is_job_file(Path::new(name)));
    names.sort();
    let files = names.into_iter().take(MOST_FILES);
    let mut files = files.map(|name| paths::joined(folder, Path::new(&name)));
    files.find(|file| {
        let found = reading::text_of(session, file);
        found.is_ok_and(|text| JobMark::new(file, &text).hash == hash)
    })
}

/// Whether the head of a program has this name in a remark or a word of its own: that under which it was posted.
pub fn is_titled(program: &Path, name: &str) -> bool {
    let name = as_remark(name.to_owned()).to_ascii_lowercase();
    let text = head(program).unwrap_or_default().to_ascii_lowercase();
    let lines = text.lines().take(TITLE_LINES).filter(|line| !line.contains(&WORD.to_lowercase()));
    let is_part = |next: char| next.is_alphanumeric() || "-_".contains(next);
    let mut words = lines.flat_map(|line| line.split(|next| !is_part(next)));
    !name.is_empty() && words.any(|word| word == name)
}

/// Whether the head of a program names a job file: `post` has written it.
pub fn is_marked(program: &PathArg) -> bool {
    program.path().and_then(head).as_deref().and_then(JobMark::in_head).is_some()
}

/// The beginning of a program; none of what is no regular file.
fn head(path: &Path) -> Option<String> {
    if !disk::metadata(path).ok()?.is_file() {
        return None;
    }
    let mut bytes = Vec::new();
    disk::open(path).ok()?.take(HEAD).read_to_end(&mut bytes).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}
