//! Rapids as feed moves, where a control does not look at the joints behind the tip.

use std::fs;

use crate::common::{Run, command, run};

/// Posts the sample of a machine for LinuxCNC, which keeps the tip, and reads the program against it.
fn both(machine: &str, sample: &str, rapid: &[&str]) -> (String, Run) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("part.ngc");
    let sample = format!("tests/machines/{sample}");
    let set = "control.dialect=linuxcnc";
    let job = ["-m", machine, "--set", set, "--set", "control.tcp=control", "--tool-length", "80"];
    let mut post = command();
    post.args(["-q", &sample]).args(job).args(rapid);
    let made = run(post.arg("-o").arg(&program), b"");
    assert_eq!(made.code, 0, "{}", made.err);
    let text = fs::read_to_string(&program).unwrap();
    let mut verify = command();
    verify.arg("verify").arg(&program).args(["--against", &sample]);
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
        let turns = block.split_whitespace().any(|word| word.starts_with(['A', 'B', 'C']));
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

/// Whether a word of the axes stands in the block.
fn turns(block: &str) -> bool {
    let mut words = block.split_whitespace();
    words.any(|word| word.starts_with(['A', 'B', 'C']))
}

#[test]
fn a_fed_rapid_at_half_speed_is_found() {
    let (machine, sample) = ("linuxcnc-5axis", "linuxcnc-5axis.cls");
    let (text, verified) = both(machine, sample, &[]);
    assert_eq!(verified.code, 0, "{}", verified.err);
    let (plain, _) = both(machine, sample, &["--set", "control.rapid=rapid"]);
    // Blocks that are rapids if they may be.
    let rapids: Vec<&str> = turning(&plain).into_iter().map(words_of_axes).collect();
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("slow.ngc");
    let mut found = 0;
    let lines: Vec<&str> = text.lines().collect();
    for (place, line) in lines.iter().enumerate() {
        let Some((words, feed)) = line.split_once(" F").filter(|(words, _)| turns(words)) else {
            continue;
        };
        if !rapids.contains(&words_of_axes(words)) {
            continue;
        }
        // What comes behind has its own feed again.
        let number: f64 = feed.parse().unwrap();
        let half = format!("{words} F{:.0}.", 0.5 * number);
        let mut changed: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        changed[place] = half;
        if let Some(next) = changed.get_mut(place + 1)
            && !next.contains('F')
            && !next.starts_with("G0")
        {
            next.push_str(&format!(" F{feed}"));
        }
        fs::write(&program, changed.join("\n") + "\n").unwrap();
        let mut verify = command();
        verify.arg("verify").arg(&program);
        verify.args(["--against", &format!("tests/machines/{sample}")]);
        verify.args(["-m", machine, "--set", "control.dialect=linuxcnc"]);
        verify.args(["--set", "control.tcp=control", "--tool-length", "80"]);
        let run = run(&mut verify, b"");
        assert_eq!(run.code, 1, "{line}\n{}", run.out);
        assert!(run.err.contains("error[rapid]"), "{line}\n{}", run.err);
        found += 1;
    }
    assert!(found >= 1, "{found} fed rapids in\n{text}");
}

/// A block from its first word of an axis on.
fn words_of_axes(block: &str) -> &str {
    let axis = |(_, word): &(usize, &str)| word.starts_with(['X', 'Y', 'Z', 'A', 'B', 'C']);
    let mut words = block.match_indices(' ').map(|(at, _)| (at + 1, &block[at + 1..]));
    let whole = (0, block);
    match axis(&whole) {
        true => block,
        false => words.find(axis).map_or("", |(at, _)| &block[at..]),
    }
}

/// The CL file has no way from a hole in one side of the part to one in the other but through where its holes are: the
/// program is retracted there, with the post keeping the tip, too.
#[test]
fn between_holes_in_two_sides_no_rapid_touches_them() {
    for machine in ["duoblock", "head-table-bc", "head-table-sr"] {
        let sample = format!("tests/machines/{machine}.apt");
        let run = crate::common::post(&[
            "-q",
            "-m",
            machine,
            "--tcp",
            "post",
            "--tool-length",
            "100",
            "--verify",
            &sample,
            "-o",
            "-",
        ]);
        assert_eq!(run.code, 0, "{machine}\n{}", run.err);
    }
}
