//! `[control] orientation`: what it asks for is what the dialect's own option writes, and is read back.

use crate::common::post;

/// A machine of the library, the dialect's own option, and what its vectors look like.
const CASES: [[&str; 3]; 3] = [
    ["bc-trunnion", "control.fanuc.tool_vector=true", " K"],
    ["ac-trunnion-840d", "control.siemens.tool_vectors=true", " A3="],
    ["dmu50", "control.heidenhain.tool_vectors=true", " TZ"],
];

/// A cut in which the tool leans further.
const CL: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,0,60,0.1,0.2,0.9747\nFEDRAT/800,MMPM\nGOTO/0,0,20,0.1,0.2,0.9747\nGOTO/10,5,21,0.12,0.22,0.9681\nGOTO/20,9,22,0.15,0.24,0.9591\nRAPID\nGOTO/20,9,60,0.15,0.24,0.9591\nSPINDL/OFF\nFINI\n";

#[test]
fn vectors_are_asked_for_by_one_name_in_every_dialect() {
    let folder = tempfile::tempdir().unwrap();
    let part = folder.path().join("part.cls");
    std::fs::write(&part, CL).unwrap();
    let part = part.to_str().unwrap();
    for [machine, own, word] in CASES {
        let written = |set: &[&str]| {
            let arguments = ["-q", "--verify", "-m", machine, "--tool-length", "120", "-o", "-"];
            let sets = set.iter().flat_map(|set| ["--set", set]);
            let all: Vec<&str> = arguments.into_iter().chain(sets).chain([part]).collect();
            post(&all)
        };
        let vector = "control.orientation=\"vector\"";
        let [plain, own_key, named] = [&[][..], &[own], &[vector]].map(written);
        assert_eq!((own_key.code, named.code), (0, 0), "{machine}: {}{}", own_key.err, named.err);
        assert_eq!(own_key.out, named.out, "{machine}");
        assert!(named.out.contains(word), "{machine}: {}", named.out);
        let axes = "control.orientation=\"axes\"";
        assert_eq!(written(&[axes]).out, plain.out, "{machine}");
        let both = written(&[own, axes]);
        assert_eq!(both.code, 1, "{machine}");
        assert!(both.err.contains("says otherwise"), "{}", both.err);
        let strange = written(&["control.orientation=\"quaternion\""]);
        assert_eq!(strange.code, 1, "{machine}");
        assert!(strange.err.contains("it has \"axes\", \"vector\""), "{}", strange.err);
    }
}

#[test]
fn a_vector_is_told_a_control_that_keeps_the_tip() {
    let part = "tests/machines/bc-trunnion.ncl";
    let sets = ["--set", "control.orientation=\"vector\"", "--set", "control.tcp=\"post\""];
    let run = post(&[&["-q", "-m", "bc-trunnion", "-o", "-", part][..], &sets].concat());
    assert_eq!(run.code, 1);
    assert!(run.err.contains("is told a control that keeps the tip"), "{}", run.err);
}
