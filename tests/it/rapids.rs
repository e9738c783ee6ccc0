//! Rapids as feed moves, where a control does not look at the joints behind the tip.

use std::fs;

use crate::common::{Run, command, run};

/// Posts the sample of a machine for LinuxCNC, which keeps the tip, and reads the program against it.
fn both(machine: &str, sample: &str, rapid: &[&str]) -> (String, Run) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("part.ngc");
    let sample = format!("tests/machines/{sample}");
    let set = "control.dialect=linuxcnc";
    let job = [
        "-m",
        machine,
        "--set",
        set,
        "--set",
        "control.tcp=control",
        "--tool-length",
        "80",
    ];
    let mut post = command();
    post.args(["-q", &sample]).args(job).args(rapid);
    let made = run(post.arg("-o").arg(&program), b"");
    assert_eq!(made.code, 0, "{}", made.err);
    let text = fs::read_to_string(&program).unwrap();
    let mut verify = command();
    verify
        .arg("verify")
        .arg(&program)
        .args(["--against", &sample]);
    (text, run(verify.args(job).args(rapid), b""))
}

/// Rapids under TCP that turn an axis.
fn turning(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    let (mut tcp, mut rapid) = (false, false);
    for block in text.lines() {
        for word in block.split_whitespace() {
            match word {
                "M428" | "M429" => tcp = word == "M428",
                "G0" | "G1" => rapid = word == "G0",
                _ => {}
            }
        }
        let turns = block
            .split_whitespace()
            .any(|word| word.starts_with(['A', 'B', 'C']));
        if tcp && rapid && turns {
            found.push(block);
        }
    }
    found
}

#[test]
fn linuxcnc_has_none_under_tcp_that_may_drive_a_joint_too_fast() {
    for (machine, sample) in [
        ("linuxcnc-5axis", "linuxcnc-5axis.cls"),
        ("nutating-head", "nutating-head.cls"),
        ("duoblock", "duoblock.apt"),
    ] {
        let (text, verified) = both(machine, sample, &[]);
        assert_eq!(turning(&text), Vec::<&str>::new(), "{machine}");
        assert_eq!(verified.code, 0, "{machine}: {}", verified.err);
        let (text, verified) = both(machine, sample, &["--set", "control.rapid=rapid"]);
        assert!(!turning(&text).is_empty(), "{machine}");
        assert_eq!(verified.code, 0, "{machine}: {}", verified.err);
    }
}
