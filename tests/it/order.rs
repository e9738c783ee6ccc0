//! Events come in the order that the guide promises to authors of dialects.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;

use crate::common::{CASES, post, root};
use crate::plugins::built;

#[test]
fn every_sample_comes_in_the_promised_order() {
    let folder = tempfile::tempdir().unwrap();
    let library = format!("{DLL_PREFIX}post_watch{DLL_SUFFIX}");
    fs::copy(built("watch"), folder.path().join(library)).unwrap();
    let plugins = folder.path().to_str().unwrap();
    let watched = ["--plugins", plugins, "--dialect", "watch"];
    for case in CASES {
        case.post(&watched);
    }
    // What every machine of the library makes.
    let jobs = fs::read_dir(root().join("tests/machines")).unwrap();
    let mut done = 0;
    for job in jobs {
        let path = job.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        let machine = name.split_once('.').unwrap().0;
        if name.contains(".refused.") {
            continue;
        }
        let arguments =
            ["--machine", machine, path.to_str().unwrap(), "-o", "-", "--tool-length", "100"];
        let run = post(&[&arguments[..], &watched].concat());
        // Some need another length: what is looked for is the order alone.
        assert!(!run.err.contains("dialect `watch`"), "{name}: {}", run.err);
        done += i32::from(run.code == 0);
    }
    assert!(done > 25, "only {done} machines made a program");
}
