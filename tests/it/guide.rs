//! The two dialects of the guide, made as it says: each posts the sample of the README.

#![cfg(unix)]

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{check_numbers, post, root};

const GUIDE: &str = include_str!("../../plugins/README.md");

/// The first block of code behind `mark`.
fn code(mark: &str) -> &'static str {
    let (_, rest) = GUIDE.split_once(mark).unwrap();
    let (_, rest) = rest.split_once("```").unwrap();
    let (_, rest) = rest.split_once('\n').unwrap();
    rest.split_once("```").unwrap().0
}

fn library(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}"))
}

/// Does as the guide says; the folder of the library.
fn build_rust(folder: &Path) -> PathBuf {
    let manifest = code("A library crate called `post_<name>`");
    let api = root().join("plugins/api").display().to_string();
    let package = "[package]\nname = \"post_tiny\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n";
    let manifest = manifest.replace("../post/plugins/api", &api);
    assert!(manifest.contains(&api), "{manifest}");
    fs::write(folder.join("Cargo.toml"), format!("{package}{manifest}")).unwrap();
    fs::create_dir(folder.join("src")).unwrap();
    let source = code("and this (it is `host/examples/post_tiny.rs`");
    fs::write(folder.join("src/lib.rs"), source).unwrap();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guide");
    let output = Command::new(env!("CARGO"))
        .args(["build", "--offline", "--quiet", "--target-dir"])
        .arg(&target)
        .current_dir(folder)
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    target.join("debug")
}

fn build_c(folder: &Path) -> PathBuf {
    let command = code("`host/tests/c/minimal.c` is a dialect");
    let command = command.trim().replace(
        "minimal.c -o libpost_minimal.so",
        &format!(
            "plugins/host/tests/c/minimal.c -o {}",
            library(folder, "minimal").display()
        ),
    );
    let mut words = command.split_whitespace();
    let output = Command::new(words.next().unwrap())
        .args(words)
        .current_dir(root())
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    folder.to_owned()
}

#[test]
fn the_dialects_of_the_guide_post_the_sample_of_the_readme() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.contains("--machine ac-trunnion tests/samples/blade.cls"));
    let folders = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let libraries = [
        ("tiny", build_rust(folders[0].path())),
        ("minimal", build_c(folders[1].path())),
    ];
    for (name, folder) in libraries {
        let folder = folder.to_str().unwrap();
        let setting = format!("control.dialect={name}");
        let arguments = ["--machine", "ac-trunnion", "tests/samples/blade.cls"];
        let more = ["--plugins", folder, "--set", &setting, "-o", "-"];
        let run = post(&[arguments.as_slice(), &more].concat());
        assert_eq!(run.code, 0, "{name}\n{}", run.err);
        check_numbers(&run.out);
        assert!(run.out.lines().count() > 100, "{}", run.out);
        for part in [" M6\n", " M3\n", " G43 H", "\nM30\n"] {
            assert!(run.out.contains(part), "{name}: {part}\n{}", run.out);
        }
        // It is no worse than the kit says, as the guide has it.
        let path = library(Path::new(folder), name);
        let run = post(&["plugin", "test", path.to_str().unwrap()]);
        assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    }
}
