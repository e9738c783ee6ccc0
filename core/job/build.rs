//! Lists what the jobs carry: the machines of the folder `machines`, where the file name is the name, and what journals of
//! batches know this version by.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let own = env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?;
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    let (own, out) = (Path::new(&own), Path::new(&out));
    println!("cargo::rustc-env=POST_SOURCES={:016x}", hash_of_sources(own)?);
    // A link in the checkout, the folder itself in a package; not every system has links.
    let machines = own.join("machines");
    let machines = if machines.is_dir() { machines } else { own.join("../../machines") };
    fs::write(out.join("machines.rs"), self::machines(&machines)?)
}

/// Changes with whatever `post` is made of (FNV-1a), so that a journal of other sources is not taken for one of these.
fn hash_of_sources(own: &Path) -> io::Result<u64> {
    let mut paths = files_below(&own.join("src"))?;
    let root = own.join("../..");
    for room in ["core", "plugins", "grammar"] {
        let room = root.join(room);
        // In a package by itself they are not there: then its version says what they are.
        if !room.is_dir() {
            continue;
        }
        let mut crates = files_in(&room)?;
        crates.push(room);
        for sources in crates.iter().flat_map(|one| [one.join("src"), one.join("page")]) {
            if sources.is_dir() {
                paths.extend(files_below(&sources)?);
            }
        }
    }
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for path in paths {
        for byte in fs::read(path)? {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    Ok(hash)
}

fn machines(folder: &Path) -> io::Result<String> {
    let mut paths = files_in(folder)?;
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let mut list = String::from("&[\n");
    for path in paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        row(&mut list, &name, &path)?;
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
