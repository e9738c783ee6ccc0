//! A request as it comes, and its answer: a line of JSON each, and bytes behind it.

use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};

use post_job::disk::{self, File, OpenOptions};
use post_lsp::Embedded;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::{command, editor};

/// Bytes of a file in one answer at most.
const MOST_BYTES: usize = 1 << 20;

/// What is asked.
#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "lowercase")]
enum Request {
    /// The bytes behind it are added at the end of a file, which is made if it is not there.
    Add { file: String },
    /// Bytes of a file from a place on; no more than an answer has.
    Read { file: String, at: u64 },
    /// A file is taken away, if it is there.
    Remove { file: String },
    /// Names of all files, and their lengths, bytes.
    Files,
    /// A message of an editor, in the Language Server Protocol.
    Edit { message: Value },
    /// The slow work that such messages have left is done.
    Work,
    /// A command line is run, `post` itself not among its words.
    Run { words: Vec<String> },
}

/// The answer to a request.
pub fn answer(request: &[u8]) -> Vec<u8> {
    let end = request.iter().position(|byte| *byte == b'\n').unwrap_or(request.len());
    let (head, behind) = request.split_at(end);
    let bytes = behind.strip_prefix(b"\n").unwrap_or_default();
    let done = match serde_json::from_slice(head) {
        Ok(request) => done(request, bytes).map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    };
    let (told, mut bytes) = done.unwrap_or_else(|fault| (json!({ "fault": fault }), Vec::new()));
    let mut answer = told.to_string().into_bytes();
    answer.push(b'\n');
    answer.append(&mut bytes);
    answer
}

/// What comes of it.
fn done(request: Request, bytes: &[u8]) -> io::Result<(Value, Vec<u8>)> {
    let told = match request {
        Request::Add { file } => {
            OpenOptions::new().create(true).append(true).open(file)?.write_all(bytes)?;
            json!({})
        }
        Request::Read { file, at } => {
            let mut file = File::open(file)?;
            let length = file.metadata()?.len();
            file.seek(SeekFrom::Start(at))?;
            let mut bytes = Vec::new();
            file.take(MOST_BYTES as u64).read_to_end(&mut bytes)?;
            return Ok((json!({ "length": length }), bytes));
        }
        Request::Remove { file } => {
            // There may be none.
            let _ = disk::remove_file(file);
            json!({})
        }
        Request::Files => json!({ "files": files() }),
        Request::Edit { message } => editor::told(|server| server.take(message)),
        Request::Work => editor::told(Embedded::work),
        Request::Run { words } => json!(command::run(&words)),
    };
    Ok((told, Vec::new()))
}

#[cfg(target_family = "wasm")]
fn files() -> Vec<(String, u64)> {
    disk::memory::files()
}

/// The disk of a system is nobody's to list.
#[cfg(not(target_family = "wasm"))]
fn files() -> Vec<(String, u64)> {
    Vec::new()
}
