//! The disk in memory: what is written is read, and it is found as on a disk of the system.

use std::fs;
use std::io::{Read, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use post_testkit::randomised;

use super::disk_in_memory as disk;

fn names(folder: impl AsRef<Path>) -> Vec<String> {
    let entries = disk::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Writes, reads and seeks at random, beside a file of the system: the same comes of each.
#[test]
fn it_reads_and_writes_as_a_file_of_the_system() {
    let (rounds, mut random) = randomised(12, 61);
    for _ in rounds {
        let mut ours = disk::unnamed().unwrap();
        let mut theirs = tempfile::tempfile().unwrap();
        for _ in 0..40 {
            let size = random.pick(700_000);
            match random.pick(4) {
                0 | 1 => {
                    let bytes: Vec<u8> = (0..size).map(|at| (at * 31 + size) as u8).collect();
                    ours.write_all(&bytes).unwrap();
                    theirs.write_all(&bytes).unwrap();
                }
                2 => {
                    let to = SeekFrom::Start(size as u64);
                    assert_eq!(ours.seek(to).unwrap(), theirs.seek(to).unwrap());
                }
                _ => {
                    let mut read = [Vec::new(), Vec::new()];
                    let [mine, other] = &mut read;
                    (&mut ours as &mut dyn Read).take(size as u64).read_to_end(mine).unwrap();
                    (&mut theirs as &mut dyn Read).take(size as u64).read_to_end(other).unwrap();
                    assert!(read[0] == read[1]);
                }
            }
            assert_eq!(ours.metadata().unwrap().len(), theirs.metadata().unwrap().len());
            let at = SeekFrom::Current(0);
            assert_eq!(ours.seek(at).unwrap(), theirs.seek(at).unwrap());
        }
    }
}

/// The same steps on both: what is there, what a folder lists, what is refused.
#[test]
fn names_lead_where_they_lead_on_a_disk_of_the_system() {
    let folder = tempfile::tempdir().unwrap();
    let there = |name: &str| folder.path().join(name);
    fs::create_dir_all(there("a/b")).unwrap();
    for name in ["a/one.toml", "a/b/two.toml", "three"] {
        fs::write(there(name), name).unwrap();
        let path = Path::new("/room").join(name);
        let mut file = disk::OpenOptions::new().create(true).append(true).open(&path).unwrap();
        file.write_all(name.as_bytes()).unwrap();
    }
    for name in ["a", "a/b", "a/b/two.toml", "a/../three", "./a//one.toml", "a/four", "three/x", ""]
    {
        let (ours, theirs) = (Path::new("/room").join(name), there(name));
        assert_eq!(disk::is_file(&ours), theirs.is_file(), "{name}");
        assert_eq!(disk::is_dir(&ours), theirs.is_dir(), "{name}");
        assert_eq!(disk::exists(&ours), theirs.exists(), "{name}");
        assert_eq!(disk::read(&ours).ok(), fs::read(&theirs).ok(), "{name}");
        assert_eq!(disk::File::open(&ours).is_ok(), theirs.is_file(), "{name}");
    }
    assert_eq!(names("/room/a"), ["b", "one.toml"]);
    assert_eq!(names("room"), ["a", "three"]);
    assert_eq!(
        disk::canonicalize("room/./a/b/../one.toml").unwrap(),
        PathBuf::from("/room/a/one.toml")
    );
    assert_eq!(disk::metadata("/room/a/five").unwrap_err().kind(), std::io::ErrorKind::NotFound);
    assert!(disk::read_dir("/nowhere").is_err());
    // A file in the making takes the place of another, which stays with whoever has it open.
    let mut old = disk::File::open("/room/three").unwrap();
    let mut new = disk::unnamed().unwrap();
    new.write_all(b"new").unwrap();
    new.name(Path::new("/room/three")).unwrap();
    assert!(new.name(Path::new("/room/a")).is_err());
    let mut text = String::new();
    old.read_to_string(&mut text).unwrap();
    assert_eq!([text, disk::read_to_string("/room/three").unwrap()], ["three", "new"]);
    disk::remove_file("/room/three").unwrap();
    assert!(!disk::exists(Path::new("/room/three")) && disk::remove_file("/room/three").is_err());
    disk::create_dir_all("/room/empty").unwrap();
    assert!(disk::is_dir(Path::new("/room/empty")) && names("/room/empty").is_empty());
    assert!(disk::files().iter().any(|(name, length)| name == "room/a/one.toml" && *length == 10));
}
