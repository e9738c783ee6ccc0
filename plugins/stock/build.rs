//! Lists the plugins among the dependencies of this crate: all `post-<name>` but the contract itself. Both ways in
//! which a manifest has a dependency are read, since packaging rewrites `name = { … }` as `[dependencies.name]`.

use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let folder = env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let manifest = Path::new(&folder).join("Cargo.toml");
    println!("cargo::rerun-if-changed={}", manifest.display());
    let text = fs::read_to_string(manifest)?;
    let mut list = String::from("&[\n");
    let mut inside = false;
    for line in text.lines().map(str::trim) {
        let header = line.strip_prefix('[');
        if let Some(header) = header {
            inside = header == "dependencies]";
        }
        let dependency = match header {
            Some(header) => {
                header.strip_prefix("dependencies.").and_then(|header| header.strip_suffix(']'))
            }
            None if inside => line.split([' ', '=', '.']).next(),
            None => None,
        };
        let plugin = dependency.and_then(|name| name.strip_prefix("post-"));
        if let Some(name) = plugin.filter(|name| *name != "plugin") {
            list.push_str(&format!("    post_{}::plugin(),\n", name.replace('-', "_")));
        }
    }
    list.push_str("]\n");
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    fs::write(Path::new(&out).join("plugins.rs"), list)
}
