//! What these tests share: libraries as cargo or the C compiler built them, and a program to write.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::Command;

use post_host::{GivenValue, ProgramSetup, ProgramWord};
use post_plugin::Linked;

/// The folder of this test's executable, where cargo also puts the libraries of its dependencies.
pub fn deps() -> PathBuf {
    let this = std::env::current_exe().unwrap();
    this.parent().unwrap().to_owned()
}

/// A plugin that is part of the product.
pub fn stock(name: &str) -> Linked {
    post_stock::plugin(name).unwrap()
}

pub fn library(folder: &Path, name: &str) -> PathBuf {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    folder.join(format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}"))
}

/// An example of this crate, built by `cargo test -p post-host`.
pub fn example(name: &str) -> PathBuf {
    library(&deps().parent().unwrap().join("examples"), name)
}

/// Compiles a C file of `tests/c` to a plugin in `folder`.
pub fn compile(folder: &Path, source: &str, name: &str, flags: &[&str]) -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = library(folder, name);
    let output = Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror"])
        .args([
            "-Wno-unused-function",
            "-Wno-unused-const-variable",
            "-Wno-unused-variable",
            "-Wno-unused-but-set-variable",
        ])
        .args(flags)
        .arg("-I")
        .arg(here.join("../api/include"))
        .arg(here.join("tests/c").join(source))
        .arg("-o")
        .arg(&target)
        .args(["-lm", "-pthread"])
        .output()
        .expect("a C compiler called cc");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    target
}

pub fn setup(words: &[&str]) -> ProgramSetup {
    ProgramSetup {
        program: "bracket".to_owned(),
        machine: "test".to_owned(),
        words: words
            .iter()
            .map(|name| ProgramWord {
                name: (*name).to_owned(),
                rotary: matches!(*name, "A" | "B" | "C"),
                depth: *name == "Z",
                ..ProgramWord::default()
            })
            .collect(),
        ..ProgramSetup::default()
    }
}

/// What a stock dialect must be told before it writes a program of five axes.
pub fn needed(name: &str) -> Vec<(String, GivenValue)> {
    let needed = match name {
        // GRBL 1.1 has three.
        "grbl" => ("hal", GivenValue::Flag(true)),
        // Printers have no spindle.
        "klipper" | "rrf" | "marlin" => ("mill", GivenValue::Flag(true)),
        // Nothing is written in a unit that nobody has named.
        "okuma" => ("unit_system", GivenValue::Text("1 mm".to_owned())),
        "brother" => ("unit_system", GivenValue::Text("mm".to_owned())),
        _ => return Vec::new(),
    };
    let mut needed = vec![(needed.0.to_owned(), needed.1)];
    if matches!(name, "klipper" | "marlin") {
        // Nor have these machine coordinates.
        needed.push(("retract".to_owned(), GivenValue::Text("G0 Z100 F6000".to_owned())));
    }
    needed
}
