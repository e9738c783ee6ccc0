//! Memory must not grow with the file. Linux alone: the peak is read from /proc while the command runs.

use crate::{common, generate};

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

/// Peak of the resident memory of a run, kB.
fn peak(folder: &Path, points: u64) -> u64 {
    let path = folder.join("wave.cls");
    let mut file = BufWriter::new(File::create(&path).unwrap());
    generate::write_file(&mut file, points).unwrap();
    file.into_inner().unwrap();
    let mut child = common::command()
        .args(["-q", "-m", "ac-trunnion", "--tcp", "control"])
        .arg(&path)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    let code = loop {
        if let Some(code) = child.try_wait().unwrap() {
            break code;
        }
        let now = fs::read_to_string(&status).unwrap_or_default();
        let high = now.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let high = high.and_then(|text| text.trim().strip_suffix(" kB"));
        peak = peak.max(high.map_or(0, |text| text.parse().unwrap()));
        std::thread::sleep(Duration::from_millis(2));
    };
    assert!(code.success());
    peak
}

#[test]
fn memory_does_not_grow_with_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let [small, large] = [100_000, 300_000].map(|points| peak(folder.path(), points));
    assert!(small > 0, "no look at the running command succeeded");
    assert!(
        large < small + small / 10 + 1024,
        "{small} kB for 100,000 points, {large} kB for 300,000"
    );
    assert!(large < 64 * 1024, "{large} kB");
}
