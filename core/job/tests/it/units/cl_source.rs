//! A CL file is read more than once, and is the same each time.

use std::fs;
use std::path::Path;

use post_job::files::{ClSource, PathArg};
use post_job::session::Session;

/// A source of `part.cls` in `folder` that was opened once.
fn opened(folder: &Path) -> ClSource {
    let path = folder.join("part.cls");
    fs::write(&path, "GOTO/1,0,0\n").unwrap();
    let mut source = ClSource::new(&Session::quiet(), &PathArg::from(path), true).unwrap();
    source.open().unwrap();
    source.refuse_written().unwrap();
    source
}

#[test]
fn a_file_that_is_another_one_by_now_is_refused_when_it_is_opened_again() {
    let folder = tempfile::tempdir().unwrap();
    let (path, other) = (folder.path().join("part.cls"), folder.path().join("other.cls"));
    let mut source = opened(folder.path());
    source.open_beside().unwrap();
    fs::write(&other, "GOTO/2,0,0\n").unwrap();
    fs::rename(&other, &path).unwrap();
    // What was read of it so far is of one file.
    source.refuse_written().unwrap();
    for told in [source.open().err(), source.open_beside().err()] {
        let told = told.unwrap().to_string();
        assert!(told.ends_with("part.cls was changed while it was read"), "{told}");
    }
}

#[test]
fn a_file_that_is_written_to_is_refused_at_the_end_too() {
    let folder = tempfile::tempdir().unwrap();
    let source = opened(folder.path());
    fs::write(folder.path().join("part.cls"), "GOTO/1,0,0\nGOTO/2,0,0\n").unwrap();
    assert!(source.refuse_written().is_err() && source.open_beside().is_err());
}
