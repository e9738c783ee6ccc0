//! The page: what it looks like, and its scripts.

use crate::{base64, sha256};

/// What stands in the body ahead of the parts.
pub const BODY: &str = include_str!("../page/page.html");

/// What it looks like.
pub const STYLE: &str = include_str!("../page/page.css");

/// The scripts, in the order of their inclusion.
const SCRIPTS: &[&str] = include!(concat!(env!("OUT_DIR"), "/scripts.rs"));

/// All scripts as one, without their comments and indentation, which are for those who read the sources.
pub fn script() -> String {
    let mut script = String::new();
    for line in SCRIPTS.iter().flat_map(|text| text.lines()) {
        let line = line.trim_start();
        if !line.is_empty() && !line.starts_with("//") {
            script.push_str(line);
            script.push('\n');
        }
    }
    script
}

/// How a policy names a text: nothing but it may run.
pub fn source(text: &str) -> String {
    let mut source = b"'sha256-".to_vec();
    base64::encode(&sha256::hash(text.as_bytes()), &mut source);
    source.push(b'\'');
    String::from_utf8_lossy(&source).into_owned()
}
