//! Plugins linked into the command against the same plugins opened as shared libraries: one program.

use crate::common;

use std::collections::BTreeMap;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use common::{CASES, Run, command, run, sample};
use post_testkit::drawn;
use serde_json::Value;
use tempfile::TempDir;

/// Every plugin that is built in.
fn stock() -> Vec<String> {
    let list = common::post(&["plugin", "list"]).out;
    let rows = list.lines().filter(|row| row.ends_with(" built in"));
    let names = rows.filter_map(|row| row.split_whitespace().next());
    names.map(str::to_owned).collect()
}

/// Settings that make the models work that no machine file names.
const MODELS: [&[&str]; 3] = [
    &["--set", "accuracy.model=\"harmonic\""],
    &["--set", "accuracy.model=\"harmonic\"", "--set", "accuracy.harmonic.order=3"],
    &["--set", "accuracy.model=\"parabolic\""],
];

/// The library that cargo built for a plugin: beside this test, or one folder up; with a hash in its name
/// if cargo gave it one.
pub fn built(name: &str) -> PathBuf {
    let this = std::env::current_exe().unwrap();
    let deps = this.parent().unwrap();
    let plain = format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
    let hashed = format!("{DLL_PREFIX}post_{name}-");
    for folder in [deps, deps.parent().unwrap()] {
        let path = folder.join(&plain);
        if path.is_file() {
            return path;
        }
        let newest = fs::read_dir(folder)
            .unwrap()
            .flatten()
            .filter(|entry| {
                let file = entry.file_name().into_string().unwrap_or_default();
                file.starts_with(&hashed) && file.ends_with(DLL_SUFFIX)
            })
            .max_by_key(|entry| entry.metadata().and_then(|data| data.modified()).ok());
        if let Some(entry) = newest {
            return entry.path();
        }
    }
    panic!("{plain} is not beside {}: does crate-type have cdylib?", this.display())
}

/// A folder that holds the stock libraries and nothing else.
pub fn libraries() -> &'static Path {
    static FOLDER: OnceLock<TempDir> = OnceLock::new();
    FOLDER
        .get_or_init(|| {
            let folder = tempfile::tempdir().unwrap();
            for name in stock() {
                let plain = format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
                fs::copy(built(&name), folder.path().join(plain)).unwrap();
            }
            folder
        })
        .path()
}

#[test]
fn both_forms_write_the_same_bytes() {
    let folder = libraries();
    let mut hashes: BTreeMap<String, String> = BTreeMap::new();
    let plain = CASES.iter().map(|case| (case, [].as_slice()));
    let runs = plain.chain(MODELS.map(|model| (&CASES[0], model)));
    for (case, model) in runs {
        let (linked, linked_summary) = case.post(model);
        let from = ["--plugins", folder.to_str().unwrap()];
        let (opened, opened_summary) = case.post(&[model, &from].concat());
        assert!(linked.out == opened.out, "{}: the programs differ", case.name());
        assert_eq!(without_plugins(&linked_summary), without_plugins(&opened_summary));
        for plugin in linked_summary["plugins"].as_array().unwrap() {
            assert!(plugin["path"].is_null() && plugin["hash"].is_null());
        }
        for plugin in opened_summary["plugins"].as_array().unwrap() {
            let name = plugin["name"].as_str().unwrap();
            let file = format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
            let path = folder.join(file).display().to_string();
            assert_eq!(plugin["path"], path);
            let hash = plugin["hash"].as_str().unwrap();
            assert_eq!(hash.len(), 64);
            assert!(hash.bytes().all(|byte| byte.is_ascii_hexdigit()));
            assert_eq!(hashes.entry(name.to_owned()).or_insert(hash.to_owned()), hash);
            // The summary for people names them too.
            assert!(opened.err.contains(&path) && opened.err.contains(hash), "{}", opened.err);
        }
    }
    // The other dialects are held to this in `dialects`.
    let opened: Vec<&str> = hashes.keys().map(String::as_str).collect();
    let wanted = ["fanuc", "harmonic", "heidenhain", "linuxcnc", "parabolic", "sampled"];
    assert!(wanted.iter().all(|name| opened.contains(name)), "{opened:?}");
}

fn without_plugins(summary: &Value) -> Value {
    let mut summary = summary.clone();
    summary.as_object_mut().unwrap().remove("plugins");
    summary
}

#[test]
fn the_environment_names_folders_too() {
    let arguments = ["-m", "ac-trunnion", "tests/samples/blade.cls", "-o", "-"];
    let from_environment = run(command().args(arguments).env("POST_PLUGINS", libraries()), b"");
    assert_eq!(from_environment.code, 0, "{}", from_environment.err);
    assert!(from_environment.err.contains(&libraries().display().to_string()));
    assert!(!from_environment.err.contains("built in"));
}

#[test]
fn no_library_is_opened_unasked() {
    // A library that stands in the working folder, beside the CL file and beside the program.
    let folder = tempfile::tempdir().unwrap();
    let file = format!("{DLL_PREFIX}post_fanuc{DLL_SUFFIX}");
    fs::copy(built("fanuc"), folder.path().join(&file)).unwrap();
    fs::copy(common::root().join(sample("blade.cls")), folder.path().join("blade.cls")).unwrap();
    let done: Run =
        run(command().current_dir(folder.path()).args(["-m", "ac-trunnion", "blade.cls"]), b"");
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(!done.out.contains(DLL_SUFFIX), "{}", done.out);
    assert!(done.out.contains("built in"));
}

#[test]
fn a_folder_that_is_not_there_is_refused() {
    let path = sample("blade.cls");
    let path = path.to_str().unwrap();
    let done = common::post(&["-m", "ac-trunnion", path, "-o", "-", "--plugins", "no/such"]);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert!(done.err.contains("no/such: no such folder"), "{}", done.err);
}

#[test]
fn a_broken_library_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join(format!("{DLL_PREFIX}post_fanuc{DLL_SUFFIX}"));
    fs::write(&broken, b"this is no library").unwrap();
    let path = sample("blade.cls");
    let done = common::post(&[
        "-m",
        "ac-trunnion",
        path.to_str().unwrap(),
        "-o",
        "-",
        "--plugins",
        folder.path().to_str().unwrap(),
    ]);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert!(done.err.contains("error[plugin]"), "{}", done.err);
    assert!(done.err.contains(&broken.display().to_string()), "{}", done.err);
}

/// A library that was cut off on its way here would kill the process that maps it.
#[test]
fn a_library_that_is_cut_off_is_refused() {
    let whole = fs::read(libraries().join(format!("{DLL_PREFIX}post_fanuc{DLL_SUFFIX}"))).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let cut_off = folder.path().join(format!("{DLL_PREFIX}post_fanuc{DLL_SUFFIX}"));
    for length in [0, 100, 5000, whole.len() / 2, whole.len() - 2000] {
        fs::write(&cut_off, &whole[..length]).unwrap();
        let done = common::post(&["plugin", "test", cut_off.to_str().unwrap()]);
        assert_eq!(done.code, 1, "{length} bytes: {}", done.err);
        assert!(done.err.contains("error[plugin]"), "{}", done.err);
    }
}

#[test]
fn the_kit_finds_nothing_wrong_with_the_stock_plugins() {
    for name in drawn(stock(), 3) {
        let file = libraries().join(format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}"));
        // What a machine file must name.
        let named: &[&str] = match name.as_str() {
            "grbl" => &["--option", "hal=true"],
            "okuma" => &["--option", "unit_system=1 mm"],
            "brother" => &["--option", "unit_system=mm"],
            "mitsubishi" => &["--option", "tapping=rigid"],
            _ => &[],
        };
        let test = |plugin: &str| {
            let all = ["plugin", "test", plugin, "--events", "4000"];
            common::post(&[&all, named].concat())
        };
        let opened = test(file.to_str().unwrap());
        assert_eq!((opened.code, opened.err.as_str()), (0, ""), "{name}");
        assert!(opened.out.contains("Nothing is wrong in "), "{}", opened.out);
        let linked = test(&name);
        // What was measured apart.
        let cases = |out: &str| {
            let out = out.replace(&format!(" ({})", file.display()), "");
            let lines = out.lines().skip(1);
            let lines = lines.filter(|line| !line.starts_with("two threads: "));
            lines.map(str::to_owned).collect::<Vec<_>>().join("\n")
        };
        assert_eq!(cases(&linked.out), cases(&opened.out));
        assert!(linked.out.contains("(built in)"), "{}", linked.out);
    }
    let third = common::post(&["plugin", "test", "harmonic", "--option", "order=3"]);
    assert_eq!(third.code, 0, "{}", third.err);
    // Ends and three places between them.
    assert!(third.out.contains("parabola             5 "), "{}", third.out);
}

#[test]
fn the_kit_says_what_is_wrong_with_a_model() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("{DLL_PREFIX}post_faulty{DLL_SUFFIX}"));
    fs::copy(built("faulty"), &file).unwrap();
    let file = file.to_str().unwrap();
    for (fault, message) in [
        (
            "shrinks",
            "parabola: it says 16.0000 µm for the tip, the deviation reaches 20.0000 µm at t = 0.5",
        ),
        ("remembers", "`value` must read nothing but the curve's terms"),
        (
            "panics",
            "not a number: it does not refuse in words: error model `faulty`: the plugin panicked",
        ),
    ] {
        let option = format!("fault={fault}");
        let done = common::post(&["plugin", "test", file, "--option", &option]);
        assert_eq!(done.code, 1, "{fault}: {}", done.out);
        assert!(done.out.contains("WRONG"), "{fault}: {}", done.out);
        assert!(!done.out.contains("Nothing is wrong"));
        assert!(done.err.contains("error[plugin-test]: "), "{}", done.err);
        assert!(done.err.contains(message), "{fault}: {}", done.err);
    }
    let good = common::post(&["plugin", "test", file]);
    assert_eq!((good.code, good.err.as_str()), (0, ""));
}

#[test]
fn the_kit_refuses_what_is_no_plugin() {
    for (arguments, message) in [
        (["--option", "order=9", "harmonic"], "9 is not between 1 and 8"),
        (["--option", "orders=2", "harmonic"], "option `orders`: not known"),
        (["--plugins", "tests", "cubic"], "there is no such plugin"),
        (["--plugins", "tests", "tests/it/plugins.rs"], "the file of a plugin is called"),
    ] {
        let done = common::post(&[&["plugin", "test"], arguments.as_slice()].concat());
        assert_eq!((done.code, done.out.as_str()), (1, ""));
        assert!(done.err.contains("error[plugin]"), "{}", done.err);
        assert!(done.err.contains(message), "{}", done.err);
    }
    assert_eq!(common::post(&["plugin", "test", "harmonic", "--option", "order"]).code, 2);
}
