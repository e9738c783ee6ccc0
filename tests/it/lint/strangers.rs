//! Programs of other posts and hands: nothing is told of them that cannot be left out by its code, and the reading ends.

use std::fs;
use std::path::{Path, PathBuf};

use post_testkit::shared;
use serde_json::Value;

use crate::common::post_in;

/// A program, the machine that comes near to that it is for, and further words.
struct Stranger {
    file: &'static str,
    words: &'static [&'static str],
}

const fn stranger(file: &'static str, words: &'static [&'static str]) -> Stranger {
    Stranger { file, words }
}

/// Those that stand beside the project.
const SHARED: [Stranger; 7] = [
    stranger(
        "data/nc/haas_umc750_dhanush_FinalToolPath.nc",
        &["-m", "umc-750", "--tool-length", "100"],
    ),
    stranger("data/nc/linuxcnc_boat-xyzac.ngc", &["-m", "xyzac-trt", "--tool-length", "50"]),
    stranger("data/nc/linuxcnc_xyzac_switchkins_test_3.ngc", &["-m", "xyzac-trt"]),
    stranger("data/nc/nxpost_dmc100_millplus_mm.ptp", &["-m", "dmu50", "--tool-length", "100"]),
    stranger(
        "data/nc/nxpost_dmu70evo_840d_in.ptp",
        &["-m", "nutating-head", "--dialect", "siemens", "--tool-length", "100"],
    ),
    stranger("data/nc/nxpost_mori_nmv5000_out.txt", &["-m", "bc-trunnion", "--tool-length", "100"]),
    stranger("data/nc/siemens_ElMoe_keychain.mpf", &["-m", "vmc", "--dialect", "siemens"]),
];

/// Three axes and the language of LinuxCNC.
const MILL: &[&str] = &["-m", "vmc", "--dialect", "linuxcnc"];

/// Those that come with LinuxCNC.
const LINUXCNC: [&str; 20] = [
    "3D_Chips",
    "3dtest",
    "arcspiral",
    "b-index",
    "cds",
    "comp",
    "comp-g1",
    "cone",
    "daisy",
    "flowsnake",
    "g881",
    "gmoccapy_2_tools_with_cutter_radius_compensation",
    "hole-circle",
    "polar",
    "skeleton",
    "spiral",
    "tort",
    "m6demo",
    "plasmac/metric_circles",
    "plasmac/metric_wrench",
];

/// The programs that are there.
fn programs() -> Vec<(PathBuf, &'static [&'static str])> {
    let ours = SHARED.iter().filter_map(|stranger| Some((shared(stranger.file)?, stranger.words)));
    let folder = Path::new("/usr/share/linuxcnc/ncfiles");
    let theirs = LINUXCNC.iter().map(|name| (folder.join(format!("{name}.ngc")), MILL));
    ours.chain(theirs.filter(|(path, _)| path.is_file())).collect()
}

#[test]
fn of_programs_of_others_nothing_is_told_that_cannot_be_left_out() {
    let programs = programs();
    println!("{} programs of others", programs.len());
    for (path, words) in programs {
        let folder = tempfile::tempdir().unwrap();
        let lint = |more: &[String]| {
            let mut all = vec!["lint".to_owned(), path.to_str().unwrap().to_owned()];
            all.extend(words.iter().map(|word| (*word).to_owned()));
            all.extend(["--json", "found.json"].map(str::to_owned));
            all.extend_from_slice(more);
            let all: Vec<&str> = all.iter().map(String::as_str).collect();
            let run = post_in(folder.path(), &all);
            assert!(run.code < 2, "{}: {}", path.display(), run.err);
            let text = fs::read_to_string(folder.path().join("found.json"));
            let text = text.unwrap_or_else(|_| panic!("{}: {}", path.display(), run.err));
            (run.code, serde_json::from_str::<Value>(&text).unwrap())
        };
        let (_, found) = lint(&[]);
        let mut codes: Vec<&str> = Vec::new();
        for one in found["findings"].as_array().unwrap() {
            codes.push(one["code"].as_str().unwrap());
            assert!(!one["message"].as_str().unwrap().is_empty());
        }
        codes.sort_unstable();
        codes.dedup();
        println!("{}: {}", path.display(), codes.join(" "));
        let mut ignored = vec!["--strict".to_owned()];
        ignored.extend(codes.iter().flat_map(|code| ["--ignore".to_owned(), (*code).to_owned()]));
        let (code, found) = lint(&ignored);
        assert_eq!(
            (code, found["findings"].as_array().unwrap().len()),
            (0, 0),
            "{}",
            path.display()
        );
    }
}
