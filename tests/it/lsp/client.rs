//! An editor without a screen.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::common::{command, root};

/// So long an answer is waited for.
const PATIENCE: Duration = Duration::from_secs(60);

/// A server, and what it has said.
pub struct Client {
    child: Child,
    input: Option<ChildStdin>,
    said: Receiver<Value>,
    last: i64,
    /// What it said unasked.
    pub told: Vec<Value>,
    /// How long the last answer took.
    pub took: Duration,
}

impl Client {
    /// Started with `arguments`, with these options of the editor.
    pub fn new(arguments: &[&str], options: &Value) -> Self {
        Self::silent(root(), arguments).greeted(options)
    }

    /// Started in a folder that has no machines, and greeted.
    pub fn new_in(folder: &Path) -> Self {
        Self::silent(folder, &[]).greeted(&json!({}))
    }

    fn greeted(self, options: &Value) -> Self {
        let mut client = self;
        let about = client.ask(
            "initialize",
            json!({ "processId": null, "rootUri": null, "capabilities": {}, "initializationOptions": options }),
        );
        assert!(about["result"]["capabilities"]["hoverProvider"] == true, "{about}");
        client.tell("initialized", json!({}));
        client
    }

    /// Started in a folder, and not yet spoken to.
    pub fn silent(folder: &Path, arguments: &[&str]) -> Self {
        let mut child = command()
            .current_dir(folder)
            .arg("lsp")
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let output = child.stdout.take().unwrap();
        let (send, said) = mpsc::channel();
        thread::spawn(move || {
            let mut output = BufReader::new(output);
            while let Some(message) = read(&mut output) {
                if send.send(message).is_err() {
                    break;
                }
            }
        });
        Self {
            input: child.stdin.take(),
            child,
            said,
            last: 0,
            told: Vec::new(),
            took: Duration::ZERO,
        }
    }

    /// Sends bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        let input = self.input.as_mut().unwrap();
        input.write_all(bytes).unwrap();
        input.flush().unwrap();
    }

    fn send(&mut self, mut message: Value) {
        message["jsonrpc"] = json!("2.0");
        let text = message.to_string();
        self.raw(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    /// Tells it something.
    pub fn tell(&mut self, method: &str, params: Value) {
        self.send(json!({ "method": method, "params": params }));
    }

    /// Asks, and does not wait; the number of the question.
    pub fn put(&mut self, method: &str, params: Value) -> i64 {
        self.last += 1;
        self.send(json!({ "id": self.last, "method": method, "params": params }));
        self.last
    }

    /// The answer to a question.
    pub fn answer(&mut self, id: i64) -> Value {
        let begin = Instant::now();
        loop {
            let left = PATIENCE.saturating_sub(begin.elapsed());
            let message = self.said.recv_timeout(left).unwrap();
            if message["id"] == id && message.get("method").is_none() {
                self.took = begin.elapsed();
                return message;
            }
            self.told.push(message);
        }
    }

    /// Asks, and waits.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.put(method, params);
        self.answer(id)
    }

    /// What is asked of a place.
    pub fn at(&mut self, method: &str, uri: &str, line: usize, column: usize) -> Value {
        let answer = self.ask(
            &format!("textDocument/{method}"),
            json!({
                "textDocument": { "uri": uri },
                "position": { "line": line, "character": column },
                "context": { "includeDeclaration": true, "triggerKind": 1 },
            }),
        );
        assert!(answer.get("error").is_none(), "{answer}");
        answer["result"].clone()
    }

    /// What is said of a place.
    pub fn hover(&mut self, uri: &str, line: usize, column: usize) -> String {
        let said = self.at("hover", uri, line, column);
        said["contents"]["value"].as_str().unwrap_or_default().to_owned()
    }

    /// Opens a text.
    pub fn open(&mut self, uri: &str, language: &str, text: &str) {
        self.tell(
            "textDocument/didOpen",
            json!({ "textDocument": { "uri": uri, "languageId": language, "version": 1, "text": text } }),
        );
    }

    /// Replaces a part of a text: from line and column to line and column.
    pub fn edit(&mut self, uri: &str, version: i64, part: [usize; 4], text: &str) {
        let [line, column, to_line, to_column] = part;
        self.tell(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": uri, "version": version },
                "contentChanges": [{
                    "range": {
                        "start": { "line": line, "character": column },
                        "end": { "line": to_line, "character": to_column },
                    },
                    "text": text,
                }],
            }),
        );
    }

    /// The next findings on a text in this version.
    pub fn findings(&mut self, uri: &str, version: i64) -> Vec<Value> {
        self.findings_if(uri, version, |_| true)
    }

    /// The next findings on a text in this version that are as wanted.
    pub fn findings_if(
        &mut self,
        uri: &str,
        version: i64,
        wanted: impl Fn(&[Value]) -> bool,
    ) -> Vec<Value> {
        let mut told = std::mem::take(&mut self.told).into_iter();
        let begin = Instant::now();
        loop {
            let message = match told.next() {
                Some(message) => message,
                None => {
                    let left = PATIENCE.saturating_sub(begin.elapsed());
                    self.said.recv_timeout(left).unwrap()
                }
            };
            let params = &message["params"];
            if message["method"] == "textDocument/publishDiagnostics"
                && params["uri"] == uri
                && params["version"] == version
            {
                let found = params["diagnostics"].as_array().unwrap();
                if wanted(found) {
                    return found.clone();
                }
            }
        }
    }

    /// Says that it ends; its exit code and what stood on standard error.
    pub fn end(mut self) -> (i32, String) {
        let answer = self.ask("shutdown", Value::Null);
        assert_eq!(answer["result"], Value::Null);
        self.tell("exit", Value::Null);
        self.gone()
    }

    /// Waits until it has ended.
    pub fn gone(mut self) -> (i32, String) {
        self.input = None;
        let mut said = String::new();
        let mut stderr = self.child.stderr.take().unwrap();
        stderr.read_to_string(&mut said).unwrap();
        (self.child.wait().unwrap().code().unwrap(), said)
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // One that a failed test leaves behind; of one that has ended it is of no effect.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn read(output: &mut impl BufRead) -> Option<Value> {
    let mut length = 0;
    loop {
        let mut line = String::new();
        if output.read_line(&mut line).ok()? == 0 {
            return None;
        }
        let line = line.trim();
        if line.is_empty() {
            break;
        }
        if let Some(count) = line.strip_prefix("Content-Length: ") {
            length = count.parse().ok()?;
        }
    }
    let mut bytes = vec![0; length];
    output.read_exact(&mut bytes).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// The URI of a path without letters that it would escape.
pub fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

/// Line and column of what stands in a text, `behind` letters into it; ASCII alone before it on its line.
pub fn place(text: &str, part: &str, behind: usize) -> (usize, usize) {
    let at = text.find(part).unwrap_or_else(|| panic!("{part}"));
    let line = text[..at].matches('\n').count();
    let begin = text[..at].rfind('\n').map_or(0, |end| end + 1);
    (line, at - begin + behind)
}

/// `code line:column-column`, of findings.
pub fn told(findings: &[Value]) -> Vec<String> {
    let told = findings.iter().map(|finding| {
        let range = &finding["range"];
        format!(
            "{} {}:{}-{}",
            finding["code"].as_str().unwrap(),
            range["start"]["line"],
            range["start"]["character"],
            range["end"]["character"]
        )
    });
    told.collect()
}

/// Names of what is offered.
pub fn labels(items: &Value) -> Vec<String> {
    let items = items.as_array().unwrap().iter();
    items.map(|item| item["label"].as_str().unwrap().to_owned()).collect()
}
