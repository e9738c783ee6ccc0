//! Where the tests' files are: those of the repository, and those beside the checkout.

use std::path::{Path, PathBuf};

/// The repository's folder.
pub fn repository() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).expect("tests/testkit stands in it")
}

/// A file or folder of `../shared`, which is no part of the repository. Where it is missing the caller skips what
/// needs it, and this says so; with `CI` set that is a failure, so that no check is lost in silence.
#[track_caller]
pub fn shared(path: &str) -> Option<PathBuf> {
    let path = repository().join("../shared").join(path);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var_os("CI").is_none(), "{} is missing", path.display());
    eprintln!("skipped: {} is missing", path.display());
    None
}
