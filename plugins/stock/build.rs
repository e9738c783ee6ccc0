//! Lists the plugins among the dependencies of this crate: those that are called `post-<name>` and have a path.

use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let manifest = Path::new(&folder).join("Cargo.toml");
    println!("cargo::rerun-if-changed={}", manifest.display());
    let text = fs::read_to_string(manifest)?;
    let plugins = text.lines().filter_map(|line| {
        let (name, _) = line.trim().strip_prefix("post-")?.split_once(".path")?;
        Some(format!("    post_{}::plugin(),\n", name.replace('-', "_")))
    });
    let list = format!("&[\n{}]\n", plugins.collect::<String>());
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    fs::write(Path::new(&out).join("plugins.rs"), list)
}
