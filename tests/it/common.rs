//! What the tests of the command share: running it, and which machine makes which sample.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

pub use post_testkit::{Run, assert_contains, names, run};
use serde_json::Value;
use tempfile::TempDir;

/// The package, and the command that it makes.
pub const PACKAGE: &str = "nc-post";
pub const BINARY: &str = env!("CARGO_BIN_EXE_post");

/// A sample on a machine that can make it.
pub struct Case {
    pub machine: &'static str,
    pub sample: &'static str,
    /// Further arguments.
    pub with: &'static [&'static str],
}

const fn case(machine: &'static str, sample: &'static str, with: &'static [&'static str]) -> Case {
    Case { machine, sample, with }
}

const LENGTH: &[&str] = &["--tool-length", "120"];

/// The first machines, each with every sample that it can make, and both ways of keeping the tip for every
/// dialect; `disc-blade.cls` and `s-piece.cls` each on the machine that it is made for. `tests/it/library.rs` has a
/// program for every machine.
pub const CASES: &[Case] = &[
    case("ac-trunnion", "blade.cls", &[]),
    case("ac-trunnion", "blade.cls", &["--tcp", "control"]),
    case("ac-trunnion", "facets.apt", &[]),
    case("ac-trunnion", "plate.ncl", &[]),
    case("ac-trunnion", "s-piece.cls", &["--tcp", "control"]),
    case("disc-cutter", "blade.cls", LENGTH),
    case("disc-cutter", "disc-blade.cls", &[]),
    case("disc-cutter", "facets.apt", LENGTH),
    case("disc-cutter", "knife.ncl", &[]),
    case("disc-cutter", "knife.ncl", &["--tcp", "control"]),
    case("disc-cutter", "plate.ncl", LENGTH),
    case("dmu50", "blade.cls", &[]),
    case("dmu50", "blade.cls", &["--tcp", "post"]),
    case("dmu50", "facets.apt", &[]),
    case("dmu50", "knife.ncl", &[]),
    case("dmu50", "plate.ncl", &["--tcp", "post", "--mount", "0,0,40"]),
    case("head-head", "blade.cls", LENGTH),
    case("head-head", "facets.apt", LENGTH),
    case("head-head", "knife.ncl", LENGTH),
    case("head-head", "plate.ncl", LENGTH),
    case("head-head-360", "blade.cls", LENGTH),
    case("head-head-360", "facets.apt", LENGTH),
    case("head-head-360", "knife.ncl", LENGTH),
    case("head-head-360", "plate.ncl", LENGTH),
    case("nutating-head", "blade.cls", &[]),
    case("nutating-head", "blade.cls", &["--tcp", "post", "--tool-length", "120"]),
    case("nutating-head", "facets.apt", &[]),
    case("nutating-head", "knife.ncl", &[]),
    case("nutating-head", "plate.ncl", &["--tcp", "post", "--tool-length", "120"]),
    case("vmc", "lever.apt", &[]),
    case("vmc", "link.aptsource", &["--units", "mm"]),
    case("vmc", "plate.ncl", &[]),
];

impl Case {
    /// `blade_ac-trunnion`, and `_post` or `_control` where the machine file is overruled.
    pub fn name(&self) -> String {
        let sample = Path::new(self.sample).file_stem().unwrap();
        let mut name = format!("{}_{}", sample.display(), self.machine);
        if let Some(at) = self.with.iter().position(|word| *word == "--tcp") {
            name.push('_');
            name.push_str(self.with[at + 1]);
        }
        name
    }

    /// Posts it to standard output, with more arguments; must succeed. The program and the summary.
    pub fn post(&self, more: &[&str]) -> (Run, Value) {
        let folder = tempfile::tempdir().unwrap();
        let json = folder.path().join("summary.json");
        let mut arguments = vec!["--machine", self.machine, "-o", "-", "--summary"];
        arguments.push(json.to_str().unwrap());
        arguments.extend(self.with);
        // The samples do not say how long their tools are.
        if !self.with.contains(&"--tool-length") {
            arguments.extend(["--tool-length", "0"]);
        }
        arguments.extend(more);
        let sample = sample(self.sample);
        arguments.push(sample.to_str().unwrap());
        let run = post(&arguments);
        assert_eq!(run.code, 0, "{}:\n{}", self.name(), run.err);
        (run, read_json(&json))
    }
}

/// The project's folder.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

pub fn sample(name: &str) -> PathBuf {
    Path::new("tests/samples").join(name)
}

/// The command, run in the project's folder without the user's settings.
pub fn command() -> Command {
    command_as(BINARY)
}

/// Another program that runs the command, as [`command`] does.
pub fn command_as(program: &str) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).env_remove("POST_MACHINES").env_remove("POST_PLUGINS");
    command
}

pub fn post<S: AsRef<OsStr>>(arguments: &[S]) -> Run {
    run(command().args(arguments), b"")
}

/// A small good file.
pub const GOOD: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/20,0,10,0,0.1736482,0.9848078\nEND\nFINI\n";

/// A folder with a CL file in it.
pub fn with_file(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), text).unwrap();
    folder
}

/// Runs in a folder that has no machine files of its own.
pub fn post_in(folder: &Path, arguments: &[&str]) -> Run {
    run(command().current_dir(folder).args(arguments), b"")
}

/// Posts a text to standard output.
pub fn post_text(arguments: &[&str], text: &str) -> Run {
    let mut all = vec!["-o", "-"];
    all.extend(arguments);
    all.push("-");
    run(command().args(all), text.as_bytes())
}

pub fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Numbers that no control reads.
pub fn check_numbers(program: &str) {
    for (index, line) in program.lines().enumerate() {
        let code = line.split(['(', ';']).next().unwrap();
        for word in code.split_whitespace() {
            let number = word.trim_start_matches(|c: char| c.is_ascii_alphabetic());
            let zero = number.starts_with('-')
                && number.bytes().any(|byte| byte == b'0')
                && number.bytes().all(|byte| b"-0.".contains(&byte));
            let lower = word.to_ascii_lowercase();
            let odd = lower.ends_with("nan") || lower.ends_with("inf");
            assert!(!zero && !odd, "line {}: {line}", index + 1);
        }
    }
}
