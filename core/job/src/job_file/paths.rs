//! Paths of a job file: they count from its folder.

use std::path::{Component, Path, PathBuf};

/// The folder that a file lies in.
pub(super) fn folder(file: &Path) -> PathBuf {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
        _ => PathBuf::from("."),
    }
}

/// A path that a file in `folder` names, as seen from here.
pub(super) fn joined(folder: Option<&Path>, named: &Path) -> PathBuf {
    folder.unwrap_or(Path::new("")).join(named)
}

/// The path leads to the folder that it counts from, or below.
pub(super) fn is_below(path: &Path) -> bool {
    let mut parts = path.components();
    parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// What stands at `path` of `folder` now lies there or below: no link on the way leads elsewhere.
pub(super) fn leads_below(folder: &Path, path: &Path) -> bool {
    let Ok(home) = folder.canonicalize() else {
        // What is not there yet has no links.
        return true;
    };
    let mut at = folder.to_owned();
    path.components().all(|part| {
        at.push(part);
        let link = at.symlink_metadata().is_ok_and(|found| found.is_symlink());
        !link || at.canonicalize().is_ok_and(|place| place.starts_with(&home))
    })
}

/// `path` as a file in `folder` names it, with slashes; both are absolute. What has no way there stays absolute.
pub(super) fn relative(path: &Path, folder: &Path) -> String {
    let (path, folder) = (plain(path), plain(folder));
    let (mut to, mut from) = (path.components().peekable(), folder.components().peekable());
    let mut common = 0;
    while to.peek().is_some() && to.peek() == from.peek() {
        to.next();
        from.next();
        common += 1;
    }
    if common == 0 {
        return path.to_string_lossy().into_owned();
    }
    let ups = from.map(|_| "..".to_owned());
    let rest = to.map(|part| part.as_os_str().to_string_lossy().into_owned());
    ups.chain(rest).collect::<Vec<_>>().join("/")
}

/// The path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            part => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_count_from_the_folder_of_the_job_file() {
        let named = |path, folder| relative(Path::new(path), Path::new(folder));
        assert_eq!(named("/a/b/part.cls", "/a/b"), "part.cls");
        assert_eq!(named("/a/cl/part.cls", "/a/jobs/x"), "../../cl/part.cls");
        assert_eq!(named("/a/b/../c/part.cls", "/a/./c"), "part.cls");
        assert!(is_below(Path::new("out/part.nc")));
        assert!(!is_below(Path::new("../part.nc")));
        assert!(!is_below(Path::new("/tmp/part.nc")));
    }
}
