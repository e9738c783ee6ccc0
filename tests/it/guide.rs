//! `post plugin new`, followed as an author outside of this checkout would: what it writes builds with nothing but
//! itself, passes the kit, and posts its sample.

#![cfg(unix)]

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::TempDir;

use crate::common::{Run, check_numbers, command, post, root, run};

const GUIDE: &str = include_str!("../../docs/src/plugin-author/dialect-in-rust.md");

fn in_folder(folder: &Path, arguments: &[&str]) -> Run {
    run(command().current_dir(folder).args(arguments), b"")
}

/// A plugin of this form, in a folder of its own.
fn new(name: &str, forms: &[&str]) -> (TempDir, PathBuf) {
    let parent = tempfile::tempdir().unwrap();
    let made = in_folder(parent.path(), &[&["plugin", "new", name], forms].concat());
    assert_eq!((made.code, made.err.as_str()), (0, ""), "{forms:?}");
    let folder = parent.path().join(name);
    // The commands that it prints are those of the folder's own guide.
    let read_me = fs::read_to_string(folder.join("README.md")).unwrap();
    for line in made.out.lines().skip(1) {
        assert!(read_me.contains(line.trim()), "{line}\n{read_me}");
    }
    (parent, folder)
}

/// Runs a tool of the author's, which must not fetch anything.
fn tool(folder: &Path, words: &[&str]) -> String {
    let output = Command::new(words[0])
        .args(&words[1..])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .env("CARGO_NET_OFFLINE", "true")
        .env_remove("RUSTFLAGS")
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{words:?}\n{out}{err}");
    assert!(!err.contains("warning"), "{words:?}\n{err}");
    out
}

/// The kit finds nothing, and the sample is posted as the README says.
fn is_good(folder: &Path, name: &str, libraries: &str) {
    let library = format!("{libraries}/{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
    let tested = in_folder(folder, &["plugin", "test", &library, "--events", "20000"]);
    assert_eq!((tested.code, tested.err.as_str()), (0, ""), "{}", tested.out);
    let arguments = ["--plugins", libraries, "--machine", "machine.toml", "sample.cls"];
    let posted = in_folder(folder, &arguments);
    assert_eq!((posted.code, posted.err.as_str()), (0, ""), "{name}");
    let program = fs::read_to_string(folder.join("sample.nc")).unwrap();
    check_numbers(&program);
    assert!(program.lines().count() > 100, "{program}");
    for part in ["M6\n", " M3\n", "G43 H1", "\nM30\n"] {
        assert!(program.contains(part), "{name}: {part}\n{program}");
    }
}

fn rust(name: &str, forms: &[&str], passed: &str) {
    let (_parent, folder) = new(name, forms);
    let tests = tool(&folder, &[env!("CARGO"), "test", "--quiet"]);
    assert!(tests.contains(passed), "{tests}");
    tool(&folder, &[env!("CARGO"), "build", "--quiet"]);
    is_good(&folder, name, "target/debug");
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    assert!(!manifest.contains(root().to_str().unwrap()), "{manifest}");
}

#[test]
fn a_dialect_in_rust_builds_as_it_stands_and_posts_the_sample() {
    rust("mine", &["--rust"], "2 passed");
}

#[test]
fn a_table_of_the_g_code_family_builds_as_it_stands_and_posts_the_sample() {
    rust("table_1", &["--iso"], "2 passed");
}

#[test]
fn a_dialect_in_c_builds_as_it_stands_and_posts_the_sample() {
    let (_parent, folder) = new("in_c", &["--c"]);
    tool(&folder, &["make", "CFLAGS=-O2 -Wall -Wextra -Werror"]);
    is_good(&folder, "in_c", ".");
}

#[test]
fn an_error_model_builds_as_it_stands_and_is_asked() {
    rust("arch", &["--model", "--rust"], "1 passed");
    let (_parent, folder) = new("arch_c", &["--model", "--c"]);
    tool(&folder, &["make", "CFLAGS=-O2 -Wall -Wextra -Werror"]);
    is_good(&folder, "arch_c", ".");
    let arguments = ["--plugins", ".", "--machine", "machine.toml", "sample.cls"];
    let asked = in_folder(&folder, &arguments).out;
    let model = asked.lines().find(|line| line.starts_with("error model")).unwrap();
    assert!(
        model.contains("arch_c 1.0 (./libpost_arch_c") && model.contains("), asked "),
        "{asked}"
    );
    // A slip in C: the bow is half of what it is.
    let source = fs::read_to_string(folder.join("model.c")).unwrap();
    let slip = source.replace("bow * 4 * t", "bow * 2 * t");
    assert_ne!(slip, source);
    fs::write(folder.join("model.c"), slip).unwrap();
    tool(&folder, &["make"]);
    let library = format!("./{DLL_PREFIX}post_arch_c{DLL_SUFFIX}");
    let tested = in_folder(&folder, &["plugin", "test", &library]);
    let wrong = "parabola: it says 10.0000 µm for the tip, the deviation reaches 20.0000 µm";
    assert_eq!(tested.code, 1, "{}", tested.out);
    assert!(tested.err.contains(wrong), "{}", tested.err);
}

/// The guide shows what `post plugin new tiny --rust` writes.
#[test]
fn the_guide_shows_the_folder_as_it_is_written() {
    let (_parent, folder) = new("mine", &["--rust"]);
    let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
    let dependencies = manifest.split_once("[dependencies]\n").unwrap().1;
    let line = dependencies.lines().next().unwrap();
    assert!(GUIDE.contains(line), "{line} is not in the guide");
    let source = fs::read_to_string(folder.join("src/lib.rs")).unwrap();
    let shown = source.replace("export_dialect!(mine, ", "export_dialect!(tiny, ");
    assert!(GUIDE.contains(&shown), "the guide must show src/lib.rs");
    // And it is published with the licences that its text is under.
    for krate in ["post-plugin", "post-kit"] {
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let own = folder.join("vendor").join(krate).join(licence);
            let ours = fs::read_to_string(root().join(licence)).unwrap();
            assert_eq!(fs::read_to_string(own).unwrap(), ours);
        }
    }
}

#[test]
fn a_name_that_cannot_be_is_refused_and_nothing_is_replaced() {
    let parent = tempfile::tempdir().unwrap();
    fs::create_dir(parent.path().join("there")).unwrap();
    fs::write(parent.path().join("a_file"), "mine\n").unwrap();
    let long = "x".repeat(41);
    for (name, message) in [
        ("fanuc", "`fanuc` is built in"),
        ("sampled", "`sampled` is built in"),
        ("kit", "post_kit is a crate that plugins are built with"),
        ("9axes", "`9axes` cannot be the name of a plugin"),
        ("Mine", "`Mine` cannot be"),
        ("mi-ne", "`mi-ne` cannot be"),
        ("mi ne", "`mi ne` cannot be"),
        ("naïve", "`naïve` cannot be"),
        (&long, "cannot be the name"),
        ("..", ".. is no name"),
        ("there", "there is there already"),
        ("a_file", "a_file is there already"),
        ("no/such", "there is no folder no"),
        ("a_file/mine", "cannot be made"),
    ] {
        for form in ["--rust", "--iso", "--c"] {
            let run = in_folder(parent.path(), &["plugin", "new", name, form]);
            assert_eq!((run.code, run.out.as_str()), (1, ""), "{name}");
            assert!(run.err.contains(message), "{name}: {}", run.err);
        }
    }
    assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 2);
    assert_eq!(fs::read_dir(parent.path().join("there")).unwrap().count(), 0);
    let file = fs::read_to_string(parent.path().join("a_file")).unwrap();
    assert_eq!(file, "mine\n");
    assert_eq!(post(&["plugin", "new", "mine"]).code, 2);
    assert_eq!(post(&["plugin", "new", "mine", "--c", "--iso"]).code, 2);
    assert_eq!(post(&["plugin", "new", "mine", "--model"]).code, 2);
    assert_eq!(post(&["plugin", "new", "mine", "--model", "--iso"]).code, 2);
}
