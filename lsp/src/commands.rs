//! `post check` of a file, asked for by a click.
//!
//! The command runs as it would in a terminal, in a process of its own: what it says is what a terminal would show.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

use super::background::Token;

/// Prints what was derived from a machine file.
pub const CHECK: &str = "post.check";

/// Prints a program that moves one axis after the other.
pub const COMMISSION: &str = "post.commission";

/// All commands.
pub const NAMES: [&str; 2] = [CHECK, COMMISSION];

/// How often a command that runs is looked after.
const LOOK: Duration = Duration::from_millis(20);

/// Runs a command on a file: what it prints, and its exit code; none if it is given up.
pub fn run(name: &str, file: &Path, token: &Token) -> Result<Option<Value>, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut command = Command::new(own);
    command.arg("check").arg(file);
    if name == COMMISSION {
        command.args(["--commission", "-o", "-"]);
    }
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    let printed = child.stdout.take().map(reader);
    let said = child.stderr.take().map(reader);
    let code = loop {
        match child.try_wait().map_err(|error| error.to_string())? {
            Some(status) => break status.code(),
            None if token.is_given_up() => {
                // One that has just ended cannot be ended.
                let _ = child.kill();
                let _ = child.wait();
                return Ok(None);
            }
            None => thread::sleep(LOOK),
        }
    };
    let text = |thread: Option<thread::JoinHandle<String>>| {
        thread.and_then(|thread| thread.join().ok()).unwrap_or_default()
    };
    Ok(Some(json!({
        "command": name,
        "code": code,
        "printed": text(printed),
        "said": text(said),
    })))
}

/// Reads a pipe to its end while the other one is read too.
fn reader(mut pipe: impl Read + Send + 'static) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What came before a fault is shown.
        let _ = pipe.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
