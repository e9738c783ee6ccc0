//! Who may read and write what is written: owner, group, rights, access list, umask.

use crate::common;
use crate::files::{JOB, refused, workshop};

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown};
use std::path::Path;

use common::{assert_contains, names, post_in, run};

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().mode() & 0o7777
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
}

#[track_caller]
fn posted(folder: &Path, arguments: &[&str]) {
    let done = post_in(folder, &[JOB, arguments].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""));
}

#[test]
fn a_new_file_has_what_the_umask_leaves() {
    for (mask, wanted) in [("000", 0o666), ("022", 0o644), ("027", 0o640), ("077", 0o600)] {
        let folder = workshop();
        let script = format!("umask {mask}; exec \"$@\"");
        let mut shell = std::process::Command::new("sh");
        shell
            .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_post")])
            .args(JOB)
            .args(["-o", "p.nc", "--summary", "s.json"])
            .current_dir(folder.path());
        let done = run(&mut shell, b"");
        assert_eq!((done.code, done.err.as_str()), (0, ""));
        for name in ["p.nc", "s.json"] {
            assert_eq!(mode(&folder.path().join(name)), wanted, "{mask}, {name}");
        }
    }
}

#[test]
fn a_file_that_is_replaced_keeps_its_rights_but_no_setuid() {
    let folder = workshop();
    let target = folder.path().join("p.nc");
    for (before, after) in [(0o640, 0o640), (0o600, 0o600), (0o4755, 0o755), (0o6771, 0o771)] {
        fs::write(&target, "old").unwrap();
        set_mode(&target, before);
        posted(folder.path(), &["-o", "p.nc"]);
        assert_eq!(mode(&target), after, "{before:o}");
    }
}

#[test]
fn a_file_that_is_replaced_keeps_its_owner_and_group() {
    let folder = workshop();
    let target = folder.path().join("p.nc");
    fs::write(&target, "old").unwrap();
    if chown(&target, Some(12_345), Some(23_456)).is_err() {
        println!("skipped: only root gives files to other users");
        return;
    }
    set_mode(&target, 0o660);
    posted(folder.path(), &["-o", "p.nc", "--summary", "s.json"]);
    let found = fs::metadata(&target).unwrap();
    assert_eq!((found.uid(), found.gid()), (12_345, 23_456));
    assert_eq!(mode(&target), 0o660);
}

#[test]
fn a_file_whose_owner_cannot_be_kept_is_not_replaced() {
    let folder = workshop();
    let target = folder.path().join("p.nc");
    fs::write(&target, "old").unwrap();
    set_mode(&target, 0o666);
    set_mode(folder.path(), 0o777);
    let nobody = ["--reuid", "65534", "--regid", "65534", "--clear-groups"];
    let mut other = std::process::Command::new("setpriv");
    other
        .args(nobody)
        .arg(env!("CARGO_BIN_EXE_post"))
        .args(JOB)
        .args(["-o", "p.nc"])
        .current_dir(folder.path());
    if chown(&target, Some(12_345), None).is_err() || other.output().is_err() {
        println!("skipped: only root runs as other users");
        return;
    }
    let done = run(&mut other, b"");
    assert_eq!(done.code, 1, "{}", done.err);
    assert_contains(
        &done.err,
        &[
            "p.nc: it belongs to user 12345 and group",
            "delete it first, or name another file with -o",
            "nothing was written; p.nc is as it was",
        ],
    );
    assert_eq!(fs::read_to_string(&target).unwrap(), "old");
    assert!(names(folder.path()).iter().all(|name| !name.ends_with("tmp")));
}

#[test]
fn a_file_that_is_protected_against_writing_is_not_replaced() {
    let folder = workshop();
    let target = folder.path().join("p.nc");
    fs::write(&target, "released").unwrap();
    set_mode(&target, 0o444);
    if fs::OpenOptions::new().write(true).open(&target).is_ok() {
        println!("skipped: root writes to every file");
        return;
    }
    let arguments = [JOB, &["-o", "p.nc"]].concat();
    refused(folder.path(), &arguments, &["p.nc: Permission denied"]);
}

#[test]
fn a_folder_that_is_protected_against_writing_is_named() {
    let folder = workshop();
    let nc = folder.path().join("nc");
    fs::create_dir(&nc).unwrap();
    set_mode(&nc, 0o555);
    if fs::write(nc.join("try"), "").is_ok() {
        println!("skipped: root writes to every folder");
        return;
    }
    let arguments = [JOB, &["-o", "nc/p.nc"]].concat();
    refused(folder.path(), &arguments, &["nc/p.nc: permission denied"]);
}

/// `user::rw- user:12345:rw- group::--- mask::rw- other::---`: without the list the group could write.
#[cfg(target_os = "linux")]
#[test]
fn a_file_that_is_replaced_keeps_its_access_list() {
    use rustix::fs::{XattrFlags, getxattr, setxattr};
    const NAME: &str = "system.posix_acl_access";
    let folder = workshop();
    let target = folder.path().join("p.nc");
    fs::write(&target, "old").unwrap();
    let mut list = 2_u32.to_le_bytes().to_vec();
    for (tag, rights, id) in [
        (0x01_u16, 6_u16, u32::MAX),
        (0x02, 6, 12_345),
        (0x04, 0, u32::MAX),
        (0x10, 6, u32::MAX),
        (0x20, 0, u32::MAX),
    ] {
        list.extend(tag.to_le_bytes());
        list.extend(rights.to_le_bytes());
        list.extend(id.to_le_bytes());
    }
    if setxattr(&target, NAME, &list, XattrFlags::empty()).is_err() {
        println!("skipped: this file system has no access lists");
        return;
    }
    assert_eq!(mode(&target), 0o660);
    posted(folder.path(), &["-o", "p.nc"]);
    let mut found = vec![0; 1024];
    let length = getxattr(&target, NAME, &mut found[..]).unwrap();
    assert_eq!(&found[..length], list);
    assert_eq!(mode(&target), 0o660);
}
