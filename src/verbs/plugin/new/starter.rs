//! The files of a folder with a plugin: the smallest ones that are of use, which the guide shows and the tests build.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use post_host::examples;
use post_plugin::raw;

/// Files of each crate that a plugin is built with, and of the model that one begins with; none of them where the command was built from published crates.
type Sources = &'static [(&'static str, &'static [(&'static str, &'static str)])];

const SOURCES: Sources = include!(concat!(env!("OUT_DIR"), "/sources.rs"));

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What a plugin is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StarterLanguage {
    /// Rust, on the contract alone.
    Rust,
    /// Rust, a table of the G-code family.
    Iso,
    /// C.
    C,
}

/// What is begun with.
#[derive(Clone, Copy, Debug)]
pub struct Starter {
    /// What it is written in.
    pub language: StarterLanguage,
    /// An error model, else a dialect.
    pub model: bool,
}

impl Starter {
    /// What it is, with its article.
    pub fn what(self) -> &'static str {
        if self.model { "an error model" } else { "a dialect" }
    }
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
pub fn commands(form: Starter, name: &str) -> [String; 3] {
    let library = format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}");
    let (build, folder) = match form.language {
        StarterLanguage::Rust | StarterLanguage::Iso => ("cargo build --release", "target/release"),
        StarterLanguage::C => ("make", "."),
    };
    [
        build.to_owned(),
        format!("post plugin test {folder}/{library}"),
        format!("post --plugins {folder} --machine machine.toml sample.cls"),
    ]
}

/// All files of the folder; none where the source that they begin with is not part of this command.
pub fn files(form: Starter, name: &str) -> Option<Vec<StarterFile>> {
    let named = |text: &str| text.replace("NAME", name);
    let machine = match form.model {
        true => include_str!("templates/machine_of_model.toml"),
        false => include_str!("templates/machine.toml"),
    };
    let mut files = vec![
        file("README.md", read_me(form, name)),
        file("machine.toml", named(machine)),
        file("sample.cls", include_str!("templates/sample.cls")),
        file(".gitignore", "/target\n*.so\n*.dylib\n*.dll\nsample.nc\n"),
    ];
    files.extend(match form.language {
        StarterLanguage::C => c_files(form, name),
        StarterLanguage::Rust | StarterLanguage::Iso => rust_files(form, name)?,
    });
    Some(files)
}

/// The source in C, the header and what builds it.
fn c_files(form: Starter, name: &str) -> Vec<StarterFile> {
    let (example, old) = match form.model {
        true => (examples::BOW_C, "bow"),
        false => (examples::MINIMAL_C, "minimal"),
    };
    let path = c_source(form);
    let source = example
        .replace(&format!("post_plugin_{old}"), &format!("post_plugin_{name}"))
        .replace(&format!("post_{old}"), &format!("post_{name}"))
        .replace(&format!("TEXT(\"{old}\")"), &format!("TEXT(\"{name}\")"))
        .replace(&format!("plugins/api/include {old}.c"), &format!(". {path}"));
    let makefile = include_str!("templates/Makefile").replace("SOURCE", path);
    vec![
        file(path, source),
        file("post_plugin.h", raw::HEADER),
        file("post_plugin_tables.h", raw::TABLES_HEADER),
        file("Makefile", makefile.replace("NAME", name)),
    ]
}

fn c_source(form: Starter) -> &'static str {
    if form.model { "model.c" } else { "dialect.c" }
}

/// A crate with a test, and the crates that it is built with beside it.
fn rust_files(form: Starter, name: &str) -> Option<Vec<StarterFile>> {
    let (example, exported) = match (form.model, form.language) {
        (true, _) => (parabolic()?, "model!(parabolic"),
        (_, StarterLanguage::Iso) => (examples::GCODE, "dialect!(gcode"),
        _ => (examples::TINY, "dialect!(tiny"),
    };
    let kind = exported.split('(').next().unwrap_or_default();
    let source = example.replace(&format!("{exported}, "), &format!("{kind}({name}, "));
    let (test, text) = match form.model {
        true => ("tests/bow.rs", include_str!("templates/bow.rs")),
        false => ("tests/job.rs", include_str!("templates/job.rs")),
    };
    let mut files = vec![
        file("src/lib.rs", source),
        file(test, text.replace("NAME", name)),
        file("Cargo.toml", manifest(form, name)),
    ];
    for (krate, sources) in SOURCES {
        if used(form.language).contains(krate) || *krate == KIT && !form.model {
            vendor(krate, sources, &mut files);
        }
    }
    Some(files)
}

const KIT: &str = "post-kit";

/// The error model that one in Rust begins with.
fn parabolic() -> Option<&'static str> {
    let (_, files) = SOURCES.iter().find(|(krate, _)| *krate == "post-parabolic")?;
    files.iter().find(|(path, _)| *path == "src/lib.rs").map(|(_, text)| *text)
}

/// The crates that a plugin in this language depends on.
fn used(language: StarterLanguage) -> &'static [&'static str] {
    match language {
        StarterLanguage::Rust => &["post-plugin"],
        StarterLanguage::Iso => &["post-iso", "post-plugin"],
        StarterLanguage::C => &[],
    }
}

fn manifest(form: Starter, name: &str) -> String {
    let line = |krate: &str| match SOURCES {
        [] => format!("{krate} = \"{VERSION}\""),
        _ => format!("{krate} = {{ path = \"vendor/{krate}\" }}"),
    };
    let dependencies: Vec<String> = used(form.language).iter().map(|krate| line(krate)).collect();
    let text = include_str!("templates/Cargo.toml");
    // A model is held against numbers, and needs no bench that writes programs.
    let (own, kit) = text.split_once("\n[dev-dependencies]\nKIT\n").unwrap_or((text, ""));
    let text = match form.model {
        true => format!("{own}{kit}").replace("A control of my own.", "A model of my own."),
        false => text.to_owned(),
    };
    text.replace("NAME", name)
        .replace("DEPENDENCIES", &dependencies.join("\n"))
        .replace("KIT", &line(KIT))
}

/// A crate beside the plugin.
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

fn read_me(form: Starter, name: &str) -> String {
    let [build, test, post] = commands(form, name);
    let the_plugin = if form.model { "the model" } else { "the dialect" };
    let source = format!("`{}`", c_source(form));
    let own: &[[&str; 2]] = match (form.language, form.model) {
        (StarterLanguage::C, _) => &[
            [&source, the_plugin],
            [
                "`post_plugin.h`",
                "the contract, with all events and what they carry, and helpers that read them",
            ],
            ["`post_plugin_tables.h`", "what words of a control can mean; included by the header"],
            ["`Makefile`", "builds the library; `make test` tries it"],
        ],
        (_, true) => &[
            ["`src/lib.rs`", the_plugin],
            ["`tests/bow.rs`", "a test of what it finds: `cargo test`"],
            ["`vendor/`", "the crate that it is built with, as this `post` has it"],
        ],
        (_, false) => &[
            ["`src/lib.rs`", the_plugin],
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
    let text = match form.model {
        true => include_str!("templates/README_of_model.md"),
        false => include_str!("templates/README.md"),
    };
    text.replace("BUILD", &build)
        .replace("post plugin test LIBRARY", &test)
        .replace("post --plugins FOLDER --machine machine.toml sample.cls", &post)
        .replace("SOURCES", &rows)
        .replace("NAME", name)
}
