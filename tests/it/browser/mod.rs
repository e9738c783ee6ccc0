//! A real browser without a window, driven over a pipe: messages in JSON, each ended by a zero byte.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};
use tempfile::TempDir;

/// The name of the program, that of Debian's package.
const PROGRAM: &str = "chromium-headless-shell";

/// The browser's pipe is its third and fourth descriptor; it ends by itself should a test hang.
const START: &str = "exec timeout 300 \"$0\" \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1";

/// A browser with one page.
pub struct Browser {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    next: u64,
    session: Option<String>,
    /// What the page has told unasked.
    events: Vec<Value>,
    _profile: TempDir,
}

impl Browser {
    /// Starts one with a window of 1440 × 900; none, said aloud, where there is no browser and CI does not ask for it.
    pub fn start() -> Option<Self> {
        let there = Command::new(PROGRAM).arg("--version").output().is_ok();
        if !there {
            assert!(std::env::var_os("CI").is_none(), "{PROGRAM} is not there");
            eprintln!("skipped: {PROGRAM} is not there");
            return None;
        }
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new("sh")
            .args(["-c", START, PROGRAM, "--headless", "--no-sandbox"])
            .args(["--remote-debugging-pipe", "--window-size=1440,900"])
            // No graphics card is asked: the same pixels everywhere.
            .args(["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut browser = Self {
            to: child.stdin.take().unwrap(),
            from: BufReader::new(child.stdout.take().unwrap()),
            child,
            next: 0,
            session: None,
            events: Vec::new(),
            _profile: profile,
        };
        let target = browser.send("Target.createTarget", &json!({"url": "about:blank"}));
        let attach = json!({"targetId": target["targetId"], "flatten": true});
        let session = browser.send("Target.attachToTarget", &attach);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.send(&format!("{domain}.enable"), &json!({}));
        }
        Some(browser)
    }

    /// Sends a command and waits for what it answers.
    pub fn send(&mut self, method: &str, parameters: &Value) -> Value {
        self.next += 1;
        let mut message = json!({"id": self.next, "method": method, "params": parameters});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = serde_json::to_vec(&message).unwrap();
        bytes.push(0);
        self.to.write_all(&bytes).unwrap();
        loop {
            let mut bytes = Vec::new();
            self.from.read_until(0, &mut bytes).unwrap();
            assert_eq!(bytes.pop(), Some(0), "the browser has ended at {method}");
            let message: Value = serde_json::from_slice(&bytes).unwrap();
            if message["id"] != self.next {
                self.events.push(message);
                continue;
            }
            assert!(message["error"].is_null(), "{method}: {}", message["error"]);
            return message["result"].clone();
        }
    }

    /// What an expression of the page comes to.
    pub fn ask(&mut self, expression: &str) -> Value {
        let parameters =
            json!({"expression": expression, "awaitPromise": true, "returnByValue": true});
        let answer = self.send("Runtime.evaluate", &parameters);
        let fault = &answer["exceptionDetails"];
        assert!(fault.is_null(), "{expression}: {fault}");
        answer["result"]["value"].clone()
    }

    /// Opens a report and waits until it can be used.
    pub fn open(&mut self, file: &Path) {
        let url = format!("file://{}", file.display());
        self.send("Page.navigate", &json!({"url": url}));
        let look = "[document.querySelector('[role=alert]')?.textContent ?? null, document.documentElement?.dataset.ready ?? null]";
        for _ in 0..3000 {
            let seen = self.ask(look);
            assert!(seen[0].is_null(), "{url}: {seen}");
            if !seen[1].is_null() {
                self.frames();
                return;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        panic!("{url} is not ready after a minute");
    }

    /// Lets the page draw what it has to.
    pub fn frames(&mut self) {
        self.ask("new Promise(done => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(() => done(0))), 250))");
    }

    /// Presses a key and lets it go, with shift where `key` begins with it.
    pub fn press(&mut self, key: &str) {
        let (key, shift) = match key.strip_prefix("Shift+") {
            Some(key) => (key, 8),
            None => (key, 0),
        };
        let mut event = json!({"type": "keyDown", "key": key, "modifiers": shift});
        if key.chars().count() == 1 {
            event["text"] = json!(key);
        }
        self.send("Input.dispatchKeyEvent", &event);
        event["type"] = json!("keyUp");
        self.send("Input.dispatchKeyEvent", &event);
    }

    /// Clicks at a place of the page, pixels from its upper left corner.
    pub fn click(&mut self, x: f64, y: f64) {
        for kind in ["mousePressed", "mouseReleased"] {
            let event = json!({"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1});
            self.send("Input.dispatchMouseEvent", &event);
        }
    }

    /// The page as it looks, PNG in base64.
    pub fn picture(&mut self) -> String {
        let picture = self.send("Page.captureScreenshot", &json!({"format": "png"}));
        picture["data"].as_str().unwrap().to_owned()
    }

    /// Panics where the page has complained or asked for anything but itself.
    pub fn assert_quiet(&mut self) {
        self.ask("0");
        for event in &self.events {
            let parameters = &event["params"];
            let loud = match event["method"].as_str().unwrap_or_default() {
                "Runtime.exceptionThrown" => true,
                "Runtime.consoleAPICalled" => {
                    ["error", "warning"].iter().any(|kind| parameters["type"] == *kind)
                }
                "Log.entryAdded" => parameters["entry"]["level"] == "error",
                "Network.requestWillBeSent" => {
                    let url = parameters["request"]["url"].as_str().unwrap_or_default();
                    parameters["type"] != "Document" && !url.starts_with("data:")
                }
                "Page.javascriptDialogOpening" => true,
                _ => false,
            };
            assert!(!loud, "{event}");
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
