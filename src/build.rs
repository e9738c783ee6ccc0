//! Lists the sources that `post plugin new` writes beside a dialect, for the command to carry.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The crates that a plugin outside of this checkout is built with, and the error model that one begins with; and where
/// they lie.
const CRATES: [(&str, &str); 4] = [
    ("post-plugin", "plugins/api"),
    ("post-iso", "plugins/iso"),
    ("post-kit", "plugins/kit"),
    ("post-parabolic", "plugins/parabolic"),
];

/// The cases of the kit stand on the host: a dialect beside them would not be built with nothing but itself.
const LEFT_OUT: &str = "src/conformance";

fn main() -> io::Result<()> {
    let root = env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    let (root, out) = (Path::new(&root), Path::new(&out));
    fs::write(out.join("sources.rs"), sources(root)?)
}

/// Name and files of each crate. In a package of the command by itself they are not there: then they are published.
fn sources(root: &Path) -> io::Result<String> {
    let mut list = String::from("&[\n");
    for (name, folder) in CRATES {
        let folder = root.join(folder);
        if !folder.is_dir() {
            continue;
        }
        let mut paths = Vec::new();
        for part in ["src", "include"] {
            if folder.join(part).is_dir() {
                paths.extend(files_below(&folder.join(part))?);
            }
        }
        writeln!(list, "({name:?}, &[").map_err(io::Error::other)?;
        for path in paths {
            let inside = path.strip_prefix(&folder).map_err(io::Error::other)?;
            if inside.starts_with(LEFT_OUT) {
                continue;
            }
            let parts = inside.iter().map(|part| part.to_string_lossy());
            let inside: Vec<_> = parts.collect();
            row(&mut list, &inside.join("/"), &path)?;
        }
        list.push_str("]),\n");
    }
    list.push_str("]\n");
    Ok(list)
}

fn row(list: &mut String, name: &str, path: &Path) -> io::Result<()> {
    let path = path.to_string_lossy();
    writeln!(list, "    ({name:?}, include_str!({path:?})),").map_err(io::Error::other)
}

fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for path in files_in(folder)? {
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

/// What a folder holds, in the order of the names; the build runs again when that changes.
fn files_in(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut paths: Vec<_> = fs::read_dir(folder)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<_, _>>()?;
    paths.sort();
    Ok(paths)
}
