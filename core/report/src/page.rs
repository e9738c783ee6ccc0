//! The page: what it looks like, and its scripts.

use crate::{base64, sha256};

/// What stands in the body ahead of the parts.
pub const BODY: &str = include_str!("../page/page.html");

/// What it looks like.
pub const STYLE: &str = include_str!(concat!(env!("OUT_DIR"), "/page.css"));

/// All scripts as one.
pub const SCRIPT: &str = include_str!(concat!(env!("OUT_DIR"), "/page.js"));

/// How a policy names a text: nothing but it may run.
pub fn source(text: &str) -> String {
    let mut source = b"'sha256-".to_vec();
    base64::encode(&sha256::hash(text.as_bytes()), &mut source);
    source.push(b'\'');
    String::from_utf8_lossy(&source).into_owned()
}
