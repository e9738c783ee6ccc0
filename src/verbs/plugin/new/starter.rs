//! The files of a folder with a dialect: the smallest ones that are of use, which the guide shows and the tests build.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use post_host::examples;
use post_plugin::raw;

/// Files of each crate that a dialect is built with; none of them where the command was built from published crates.
type Sources = &'static [(&'static str, &'static [(&'static str, &'static str)])];

const SOURCES: Sources = include!(concat!(env!("OUT_DIR"), "/sources.rs"));

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What a dialect is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StarterLanguage {
    /// Rust, on the contract alone.
    Rust,
    /// Rust, a table of the G-code family.
    Iso,
    /// C.
    C,
}

/// A file of the folder.
#[derive(Debug)]
pub struct StarterFile {
    /// Where it stands in the folder.
    pub path: String,
    /// All of it.
    pub text: String,
}

fn file(path: &str, text: impl Into<String>) -> StarterFile {
    StarterFile { path: path.to_owned(), text: text.into() }
}

/// What builds the library, tests it and posts the sample, in the folder.
pub fn commands(form: StarterLanguage, name: &str) -> [String; 3] {
    let library = format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
    let (build, folder) = match form {
        StarterLanguage::Rust | StarterLanguage::Iso => ("cargo build --release", "target/release"),
        StarterLanguage::C => ("make", "."),
    };
    [
        build.to_owned(),
        format!("post plugin test {folder}/{library}"),
        format!("post --plugins {folder} --machine machine.toml sample.cls"),
    ]
}

/// All files of the folder.
pub fn files(form: StarterLanguage, name: &str) -> Vec<StarterFile> {
    let named = |text: &str| text.replace("NAME", name);
    let mut files = vec![
        file("README.md", read_me(form, name)),
        file("machine.toml", named(include_str!("templates/machine.toml"))),
        file("sample.cls", include_str!("templates/sample.cls")),
        file(".gitignore", "/target\n*.so\n*.dylib\n*.dll\nsample.nc\n"),
    ];
    if form == StarterLanguage::C {
        let source = examples::MINIMAL_C.replace("minimal", name);
        files.extend([
            file("dialect.c", source.replace(&format!("{name}.c"), "dialect.c")),
            file("post_plugin.h", raw::HEADER),
            file("Makefile", named(include_str!("templates/Makefile"))),
        ]);
        return files;
    }
    let (example, exported) = match form {
        StarterLanguage::Iso => (examples::GCODE, "gcode"),
        _ => (examples::TINY, "tiny"),
    };
    let source = example
        .replace(&format!("export_dialect!({exported}, "), &format!("export_dialect!({name}, "));
    files.extend([
        file("src/lib.rs", source),
        file("tests/job.rs", named(include_str!("templates/job.rs"))),
        file("Cargo.toml", manifest(form, name)),
    ]);
    for (krate, sources) in SOURCES {
        if used(form).contains(krate) || *krate == KIT {
            vendor(krate, sources, &mut files);
        }
    }
    files
}

const KIT: &str = "post-kit";

/// The crates that a dialect of this form depends on.
fn used(form: StarterLanguage) -> &'static [&'static str] {
    match form {
        StarterLanguage::Rust => &["post-plugin"],
        StarterLanguage::Iso => &["post-iso", "post-plugin"],
        StarterLanguage::C => &[],
    }
}

fn manifest(form: StarterLanguage, name: &str) -> String {
    let line = |krate: &str| match SOURCES {
        [] => format!("{krate} = \"{VERSION}\""),
        _ => format!("{krate} = {{ path = \"vendor/{krate}\" }}"),
    };
    let dependencies: Vec<String> = used(form).iter().map(|krate| line(krate)).collect();
    include_str!("templates/Cargo.toml")
        .replace("NAME", name)
        .replace("DEPENDENCIES", &dependencies.join("\n"))
        .replace("KIT", &line(KIT))
}

/// A crate beside the dialect.
fn vendor(krate: &str, sources: &[(&str, &str)], files: &mut Vec<StarterFile>) {
    let mut manifest = format!(
        "[package]\nname = \"{krate}\"\nversion = \"{VERSION}\"\nedition = \"2024\"\nrust-version = \"{}\"\n\
         license = \"{}\"\n",
        env!("CARGO_PKG_RUST_VERSION"),
        env!("CARGO_PKG_LICENSE"),
    );
    if krate != "post-plugin" {
        manifest.push_str("\n[dependencies]\npost-plugin = { path = \"../post-plugin\" }\n");
    }
    if krate == KIT {
        manifest.push_str("\n# Its cases are those of `post plugin test`: not here.\n[features]\nconformance = []\n");
    }
    let folder = format!("vendor/{krate}");
    files.extend([
        file(&format!("{folder}/Cargo.toml"), manifest),
        file(&format!("{folder}/LICENSE-MIT"), include_str!("../../../../LICENSE-MIT")),
        file(&format!("{folder}/LICENSE-APACHE"), include_str!("../../../../LICENSE-APACHE")),
    ]);
    let sources = sources.iter();
    files.extend(sources.map(|(path, text)| file(&format!("{folder}/{path}"), *text)));
}

fn read_me(form: StarterLanguage, name: &str) -> String {
    let [build, test, post] = commands(form, name);
    let own: &[[&str; 2]] = match form {
        StarterLanguage::C => &[
            ["`dialect.c`", "the dialect"],
            ["`post_plugin.h`", "the contract, with all events and what they carry"],
            ["`Makefile`", "builds the library; `make test` tries it"],
        ],
        StarterLanguage::Rust | StarterLanguage::Iso => &[
            ["`src/lib.rs`", "the dialect"],
            ["`tests/job.rs`", "a test of what it writes: `cargo test`"],
            [
                "`vendor/`",
                "the crates that it is built with, as this `post` has them; `cargo doc --open -p post-plugin` has \
                 all events and what they carry",
            ],
        ],
    };
    let rows = own.iter();
    let rows: String = rows.map(|[path, what]| format!("| {path} | {what} |\n")).collect();
    include_str!("templates/README.md")
        .replace("BUILD", &build)
        .replace("post plugin test LIBRARY", &test)
        .replace("post --plugins FOLDER --machine machine.toml sample.cls", &post)
        .replace("SOURCES", &rows)
        .replace("NAME", name)
}
