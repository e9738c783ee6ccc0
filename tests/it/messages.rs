//! What the command says: messages, tables of words, help.

use crate::common;

use common::{GOOD, assert_contains, command, post, post_text, run};

#[test]
fn a_message_says_where_what_how_much_and_what_helps() {
    let head = "UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/0,0,50\n";
    for (machine, line, parts) in [
        (
            "ac-trunnion",
            "GOTO/412.5,0,10",
            &[
                "over-travel",
                "X would be 412.500 mm",
                "300.000 mm, passed by 112.500 mm",
                "--mount",
            ][..],
        ),
        (
            "ac-trunnion",
            "GOTO/0,0,10,0,0.7071068,-0.7071068",
            &["over-travel", "A would be", "135.000°", "-120.000°", "help: "],
        ),
        (
            "vmc",
            "GOTO/0,0,10,0,0.1736482,0.9848078",
            &["out-of-reach", "VMC", "10.0000°", "0.0500°", "help: "],
        ),
        ("vmc", "GOTO/0,0", &["syntax", "help: expected GOTO/x,y,z"]),
        ("vmc", "FEDRAT/-5,MMPM", &["feed", "-5"]),
        ("vmc", "TRACUT/ON", &["refused-word", "TRACUT", "help: "]),
        ("vmc", "GOTO/0,0,10,0,0,0", &["axis", "null", "help: "]),
    ] {
        let with = ["-m", machine, "--spindle", "3000"];
        let done = post_text(&with, &format!("{head}{line}\nFINI\n"));
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{line}\n{}", done.err);
        assert_contains(&done.err, parts);
        assert_contains(&done.err, &["standard input:5", line, "1 error"]);
    }
}

#[test]
fn a_cut_without_a_feed_is_refused() {
    let done = post_text(&["-m", "vmc"], "UNITS/MM\nLOADTL/1\nGOTO/0,0,50\nGOTO/0,0,10\n");
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(&done.err, &["no-feed", "standard input:4", "GOTO/0,0,10", "FEDRAT"]);
}

#[test]
fn several_faults_are_told_in_one_run() {
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nGOTO/0,0,50\nGOTO/0,0,10\nFEDRAT/100,MMPM\nGOTO/1,2,x\nGOTO/900,0,10\nGOTO/950,0,10\nGOTO/0,0,10,0,0,-1\nCIRCLE/1,2\nFINI\n";
    let done = post_text(&["-m", "ac-trunnion"], text);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    for (line, code) in
        [(5, "no-feed"), (7, "syntax"), (8, "over-travel"), (10, "over-travel"), (11, "syntax")]
    {
        let at = format!("standard input:{line}:");
        let told = done
            .err
            .split("\n\n")
            .any(|told| told.contains(&at) && told.contains(&format!("error[{code}]")));
        assert!(told, "{code} on line {line}:\n{}", done.err);
    }
    // A limit that is passed again is told once, with the farthest.
    assert_contains(&done.err, &["2 points pass it", "X 950.000", "5 errors"]);
}

#[test]
fn an_unknown_word_is_refused_told_or_passed_on() {
    let text = GOOD.replace("RAPID\n", "WIGGLE/4,5\nRAPID\n");
    let known = post_text(&["-q", "-m", "ac-trunnion"], GOOD);
    let refused = post_text(&["-m", "ac-trunnion", "--unknown=error"], &text);
    assert_eq!((refused.code, refused.out.as_str()), (1, ""));
    let told = ["WIGGLE", ":4:1"];
    assert_contains(&refused.err, &["error[unknown-word]", "--unknown=warn"]);
    assert_contains(&refused.err, &told);
    let strange = post_text(&["-q", "-m", "ac-trunnion"], &text);
    assert_eq!((strange.code, strange.out.as_str()), (1, ""));
    let warned = post_text(&["-q", "-m", "ac-trunnion", "--unknown=warn"], &text);
    assert_eq!((warned.code, &warned.out), (0, &known.out));
    assert_contains(&warned.err, &["warning[unknown-word]", "left out"]);
    assert_contains(&warned.err, &told);
    let explicit = post_text(&["-q", "-m", "ac-trunnion", "--unknown", "warn"], &text);
    assert_eq!(explicit, warned);
    let passed = post_text(&["-q", "-m", "ac-trunnion", "--unknown=pass"], &text);
    assert_eq!(passed.code, 0);
    assert_contains(&passed.out, &["(WIGGLE/4,5)"]);
    assert_contains(&passed.err, &["warning[unknown-word]", "comment"]);
    assert_eq!(passed.out.replace("(WIGGLE/4,5)\n", ""), known.out);
}

#[test]
fn words_lists_what_becomes_of_each_word() {
    let text = GOOD.replace("RAPID\n", "WIGGLE/4\nPAINT/COLOR,3\nTRACUT/ON\nRAPID\n");
    let listed = run(command().args(["words", "-"]), text.as_bytes());
    assert_eq!((listed.code, listed.err.as_str()), (0, ""));
    let row = |word: &str| -> Vec<String> {
        let line = listed.out.lines().find(|line| line.starts_with(word));
        line.unwrap().split_whitespace().map(str::to_owned).collect()
    };
    assert_eq!(row("GOTO"), ["GOTO", "3", "used", "8"]);
    assert_eq!(row("WIGGLE"), ["WIGGLE", "1", "unknown", "4"]);
    assert_eq!(row("PAINT"), ["PAINT", "1", "ignored", "5"]);
    assert_eq!(row("TRACUT"), ["TRACUT", "1", "refused", "6"]);
    let unknown = run(command().args(["words", "--unknown-only", "-"]), text.as_bytes());
    assert_eq!(unknown.out.lines().count(), 3, "{}", unknown.out);
}

#[test]
fn words_without_a_file_lists_those_that_are_known() {
    let listed = run(command().arg("words"), b"");
    assert_eq!((listed.code, listed.err.as_str()), (0, ""));
    let words = post_grammar::MajorWord::all();
    assert_eq!(listed.out.lines().count(), 1 + words.len());
    assert_contains(
        &listed.out,
        &["LOADTL = LOAD = TURRET = TOOLNO", "FEDRAT", "refused    repeats moves"],
    );
}

#[test]
fn help_names_every_option() {
    let help = post(&["--help"]);
    assert_eq!((help.code, help.err.as_str()), (0, ""));
    assert_contains(
        &help.out,
        &[
            "--machine",
            "--output",
            "--summary",
            "--quiet",
            "--units",
            "--msys",
            "--unknown",
            "--tool ",
            "--mount",
            "--tool-length",
            "--set",
            "--tolerance",
            "--tcp",
            "--machines",
            "--plugins",
            "--trust-model",
            "--version",
            "POST_PLUGINS",
            "POST_MACHINES",
            "Exit codes",
            "words",
            "machines",
            "Examples",
        ],
    );
    assert_eq!(post(&["--version"]).code, 0);
}
