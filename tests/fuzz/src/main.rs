//! libFuzzer on the target that `FUZZ_TARGET` names.

#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use post_fuzz::{Room, targets};

static ROOM: OnceLock<Room> = OnceLock::new();

fuzz_target!(|bytes: &[u8]| {
    let room = ROOM.get_or_init(|| {
        let name = std::env::var("FUZZ_TARGET").expect("FUZZ_TARGET names what is fuzzed");
        let target = targets().remove(&name).unwrap_or_else(|| panic!("no target {name}"));
        let folder = tempfile::Builder::new().prefix("fuzz-").tempdir().expect("a folder");
        Room::new(&target, &folder.keep())
    });
    // What is refused is no fault.
    let _ = room.take(bytes);
});
