//! Words that change where or whether metal is cut: carried out by a rule, taken upon oneself, or refused.

use crate::common::{Run, command, post, run};

use std::fs;

/// Words that a program without them would cut otherwise, as CAM systems write them.
const CHANGING: [&str; 15] = [
    "MIRROR/XYPLAN",
    "CALSUB/SUB1",
    "PREFUN/54",
    "AUXFUN/8",
    "OPSKIP/ON",
    "CLAMP/BAXIS",
    "UNLOAD/TOOL",
    "ARCSLP/ON",
    "ZERO/X",
    "TRACUT/1,0,0,5,0,1,0,0,0,0,1,0",
    "TRANS/0,0,1",
    "ORIGIN/0,0,1",
    "COUPLE/1",
    "SYN/G,GOTO",
    "REFSYS/MAT1",
];

fn file(lines: &str) -> String {
    format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\n{lines}\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/20,0,10\nFINI\n"
    )
}

/// Posts a text for `vmc`, to standard output.
fn posted(with: &[&str], text: &str) -> Run {
    let mut all = vec!["-q", "-m", "vmc", "--tool-length", "100", "-o", "-"];
    all.extend(with);
    all.push("-");
    run(command().args(all), text.as_bytes())
}

/// Posts for a machine that extends `vmc` by these lines.
fn on(machine: &str, with: &[&str], text: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, format!("extends = \"vmc\"\n{machine}")).unwrap();
    let mut all = vec!["-q", "-m", path.to_str().unwrap(), "--tool-length", "100"];
    all.extend(["-o", "-"]);
    all.extend(with);
    all.push("-");
    run(command().args(all), text.as_bytes())
}

#[track_caller]
fn told(run: &Run, code: i32, parts: &[&str]) {
    assert_eq!(run.code, code, "{}", run.err);
    for part in parts {
        assert!(run.err.contains(part), "`{part}` is not in:\n{}", run.err);
    }
}

#[test]
fn a_word_that_changes_the_cut_is_refused_unless_it_is_allowed() {
    let plain = posted(&[], &file("")).out;
    for line in CHANGING {
        let word = line.split('/').next().unwrap();
        let text = file(&format!("{line}\n{line}"));
        let refused = posted(&[], &text);
        let allow = format!("--allow {word}");
        told(&refused, 1, &["error[refused-word]", word, "<stdin>", &allow, "[cl.words]"][..2]);
        told(&refused, 1, &[&allow, "[cl.words]", "input:4", "one more like it, on line 5"]);
        assert_eq!(refused.out, "", "{line}");
        let allowed = posted(&["--allow", word], &text);
        told(&allowed, 0, &["warning[allowed-word]", &format!("{word}, met twice, is left out")]);
        assert_eq!(allowed.out, plain, "{line}");
    }
}

/// Moves, and what says which are made: nobody can take it upon himself to leave them out.
#[test]
fn a_word_that_moves_the_tool_is_refused_whatever_is_allowed() {
    for line in [
        "PROBE/POINT",
        "INCLUD/PART2",
        "JUMPTO/L1",
        "LOOPST",
        "IF/A,1,2,3",
        "GOLFT/L1,TO,L2",
        "DNTCUT",
        "TLLFT,GOLFT/L1,PAST,L2",
    ] {
        let word: String = line.chars().take_while(char::is_ascii_alphanumeric).collect();
        let run = posted(&["--allow", &word, "--unknown", "warn"], &file(line));
        told(&run, 1, &["error[refused-word]", &word, "cannot be left out"]);
        assert_eq!(run.out, "", "{line}");
    }
}

/// A program of the control, and Mastercam's NCI, in place of a CL file: one message, not one a line.
#[test]
fn a_file_that_is_none_of_ours_is_named() {
    let program = "%\nO0001\nN10 G21 G90\nN20 T1 M6\nN30 G0 X1. Y2.\nN40 M30\n%\n";
    let nci = "1050\n0 0 8. 25. 1 2024\n1053\n(MACHINE)\n1011\n0. 0. 0.\n0\n0 1. 2. 3. -2. 0\n";
    for (text, kind) in [(program, "an NC program"), (nci, "Mastercam's NCI")] {
        let run = posted(&[], text);
        told(&run, 1, &[&format!("this is {kind}, no cutter-location file"), "CLSF"]);
        assert_eq!(run.err.matches("error[").count(), 1, "{}", run.err);
    }
}

#[test]
fn words_that_a_program_can_do_without_are_left_out_with_a_warning() {
    for line in ["BREAK/1", "CHECK/XAXIS,0,100", "SLOWDN/ON"] {
        told(&posted(&[], &file(line)), 0, &["warning[unknown-word]", "left out"]);
    }
}

/// All that nobody knows is refused, but for one word.
#[test]
fn a_word_that_nobody_knows_can_be_allowed_too() {
    let text = file("FROBN/1");
    let strict = ["--unknown", "known"];
    told(&posted(&strict, &text), 1, &["error[unknown-word]", "FROBN", "--allow"]);
    let allowed = posted(&[&strict[..], &["--allow", "frobn"]].concat(), &text);
    told(&allowed, 0, &["FROBN, met once, is left out, as --allow says"]);
}

#[test]
fn a_rule_of_the_machine_file_writes_the_line() {
    let machine = r#"
[cl.words]
OFSETL = "G{n+53}"
"SET/OFSETL" = "G54.1 P{1}"
AUXFUN = "M{n}"
CALSUB = ["M98 P{n}", "G54"]
PROBE = "G65 P9811 Z{n2}"
"COOLNT/SUPER" = "M88"
"#;
    for (line, written) in [
        ("OFSETL/1", &["G54"][..]),
        ("OFSETL/2", &["G55"]),
        ("SET/OFSETL,7", &["G54.1 P7"]),
        ("AUXFUN/8.0", &["M8"]),
        ("CALSUB/1000", &["M98 P1000", "G54"]),
        ("PROBE/1,10", &["G65 P9811 Z10"]),
        ("COOLNT/SUPER", &["M88"]),
    ] {
        let done = on(machine, &[], &file(line));
        told(&done, 0, &[]);
        for code in written {
            let found = done.out.lines().any(|line| line.ends_with(code));
            assert!(found, "{line}: {code} is not in\n{}", done.out);
        }
    }
    for (line, why) in [
        ("OFSETL/1.5", "is 54.5, and a code is a whole number"),
        ("OFSETL/-60", "codes go from 0 up"),
        ("OFSETL", "the record has no number 1"),
        ("OFSETL/1,2", "uses 1 of its 2 numbers"),
        ("AUXFUN/8,NEXT", "knows nothing of NEXT"),
        // A rule for one form is for no other.
        ("SET/MODE,INCR", "post does not know how"),
    ] {
        let done = on(machine, &[], &file(line));
        told(&done, 1, &[why, "input:4"]);
        assert_eq!(done.out, "");
    }
}

/// A probing line takes the numbers of its record as they are, and a file in other units is not taken for one in the
/// program's.
#[test]
fn a_rule_prints_decimals_in_the_units_of_the_program() {
    let machine =
        "[cl.words]\nTOUCH = \"G65 P9811 Z{n*unit:.3} S{n2:1}\"\nPROBE = \"G65 P9811 Z{n:.3}\"\n";
    let told_line = |text: &str, line: &str| {
        let done = on(machine, &[], text);
        told(&done, 0, &[]);
        assert!(done.out.lines().any(|written| written.ends_with(line)), "{line}\n{}", done.out);
    };
    told_line(&file("TOUCH/-5.2,1"), "G65 P9811 Z-5.200 S1");
    told_line(&file("PROBE/-5.2"), "G65 P9811 Z-5.200");
    let inches = |line: &str| file(line).replace("UNITS/MM", "UNITS/INCH");
    assert_ne!(inches(""), file(""));
    let done = on(machine, &[], &inches("PROBE/-0.2"));
    told(&done, 1, &["units of 25.4 mm", "{n:.3} in the rule for PROBE", "{n*unit:.3}"]);
    let done = on(machine, &[], &inches("TOUCH/-0.2,1"));
    told(&done, 1, &["{n2:1} in the rule for TOUCH"]);
}

/// One switch makes codes of the words that APT has for them; a rule of one's own goes before it.
#[test]
fn functions_by_their_numbers_are_codes_where_the_machine_file_says_so() {
    let codes = "[cl]\nfunctions = true\n";
    let ruled = "[cl]\nfunctions = true\n[cl.words]\nAUXFUN = \"M{n+100}\"\n";
    for (machine, line, code) in [
        (codes, "AUXFUN/88", "M88"),
        (codes, "PREFUN/54", "G54"),
        (codes, "PREFUN/54.1", "G54.1"),
        (ruled, "AUXFUN/8", "M108"),
    ] {
        let done = on(machine, &[], &file(line));
        told(&done, 0, &[]);
        assert!(done.out.lines().any(|line| line.ends_with(code)), "{code}\n{}", done.out);
    }
    told(&on(codes, &[], &file("AUXFUN/8.5")), 1, &["is 8.5, and a code is a whole number"]);
    told(&on("", &[], &file("AUXFUN/8")), 1, &["post does not know how"]);
}

#[test]
fn a_rule_that_says_nothing_is_refused_with_its_line() {
    for (rule, why) in [
        ("AUXFUN = \"M{}\"", "a number or a name is missing"),
        ("AUXFUN = \"M{8+1}\"", "holds no number of the record"),
        ("AUXFUN = \"M{x}\"", "x is no number of the record"),
        ("AUXFUN = \"M{n\"", "a `}` is missing"),
        ("AUXFUN = \"M}\"", "a `}` closes nothing"),
        ("AUXFUN = \"\"", "a line of the program is empty"),
        ("AUXFUN = \"M1\\nM2\"", "several lines are a list"),
        ("AUXFUN = []", "a rule without a line"),
        ("AUXFUN = 8", "a line of the program or a list of lines"),
        ("INSERT = \"M{n}\"", "INSERT has a meaning to post"),
        ("GOTO = \"X{n}\"", "GOTO has a meaning to post"),
        ("\"\" = \"M{n}\"", "which is no word"),
        ("auxfun = \"M1\"\nAUXFUN = \"M2\"", "AUXFUN twice"),
    ] {
        let done = on(&format!("[cl.words]\n{rule}\n"), &[], &file(""));
        told(&done, 1, &[why, "mine.toml:3"][..1]);
        assert!(done.err.contains("mine.toml:"), "{rule}: {}", done.err);
    }
}

#[test]
fn an_insert_with_a_code_is_no_remark() {
    for code in ["M8", "G54", "G04 X2.", "N10 G55 (SECOND)", "#100=5"] {
        let text = file(&format!("INSERT {code}"));
        told(
            &posted(&[], &text),
            1,
            &["error[insert]", code, "control.insert=literal", "--allow INSERT"],
        );
        let line = posted(&["--set", "control.insert=literal"], &text);
        told(&line, 0, &[]);
        assert!(line.out.lines().any(|line| line.ends_with(code)), "{}", line.out);
        let remark = posted(&["--allow", "INSERT"], &text);
        told(&remark, 0, &["INSERT, met once, is written as a remark"]);
    }
    // What SolidWorks CAM writes describes tools and stock.
    for remark in ["14MM CRB 4FL 32 LOC", "Stock Size X85. Y38. Z48.", "STOP  change fixture"] {
        let done = posted(&[], &file(&format!("INSERT/{remark}")));
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{remark}");
    }
    told(&posted(&[], &file("INSERT/M8 TAP")), 0, &["warning[insert]", "holds a G or M word"]);
}

/// Behind a cycle that is refused, nothing is said of the points that it would act at; what is found often is told once.
#[test]
fn one_fault_is_told_once() {
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nCYCLE/WINDOW,5,MMPM,100\n");
    text.push_str(&"GOTO/1,2,3\n".repeat(5));
    text.push_str("CYCLE/OFF\nFINI\n");
    let done = posted(&[], &text);
    told(&done, 1, &["error[cycle]", "1 error; nothing"]);
    assert!(!done.err.contains("no-feed"), "{}", done.err);
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nRAPID\nGOTO/0,0,50\n");
    for step in 0..40 {
        text.push_str(&format!("GOTO/{step},0,50\n"));
    }
    text.push_str("FINI\n");
    let done = posted(&[], &text);
    told(
        &done,
        1,
        &[
            "error[no-feed]",
            "input:6",
            "39 more like it, the last on line 45",
            "1 error;",
            "--feed",
        ],
    );
    let fed = posted(&["--feed", "800"], &text);
    told(&fed, 0, &[]);
    assert!(fed.out.contains("F800."), "{}", fed.out);
    // Forty arcs whose ends miss their centre a little: one warning, in the summary too.
    let mut text =
        String::from("UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nFEDRAT/100,MMPM\nGOTO/10,0,0\n");
    for arc in 0..40 {
        let radius = 10.0 + 0.01 * f64::from(arc + 1);
        text.push_str(&format!(
            "CIRCLE/0,0,0,0,0,1\nGOTO/{},{},0\n",
            [0.0, radius][arc as usize % 2],
            [radius, 0.0][arc as usize % 2]
        ));
    }
    text.push_str("FINI\n");
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let done = posted(&["--summary", json.to_str().unwrap()], &text);
    told(&done, 0, &["39 more like it, the last on line 85"]);
    assert_eq!(done.err.matches("warning[").count(), 1, "{}", done.err);
    let warnings = crate::common::read_json(&json)["warnings"].clone();
    assert_eq!(warnings.as_array().unwrap().len(), 1);
    assert!(warnings[0].as_str().unwrap().ends_with("39 more like it, the last on line 85"));
}

#[test]
fn cycles_of_other_systems_are_read() {
    for kind in ["DEEP2", "DEEPHL", "CHIP", "DRILL,DEEP"] {
        let text = file(&format!(
            "FEDRAT/100,MMPM\nCYCLE/{kind},FEDTO,5,MMPM,80,STEP,2,RAPTO,3\nGOTO/5,5,0\nCYCLE/OFF"
        ));
        let native = posted(&[], &text);
        told(&native, 0, &[]);
        let code = if kind == "CHIP" { "G99 G73" } else { "G99 G83" };
        let cycle = format!("{code} X5.000 Y5.000 Z-5.000 R3.000 Q2.000 F80.");
        assert!(native.out.contains(&cycle), "{kind}\n{}", native.out);
        let done = posted(&["--set", "control.cycles=moves"], &text);
        told(&done, 0, &[]);
        for depth in ["Z-2.", "Z-4.", "Z-5."] {
            assert!(done.out.contains(depth), "{kind}: {depth}\n{}", done.out);
        }
        // Breaking the chip, the tool stays in the hole.
        let leaves = done.out.matches("Z3.").count() > 2;
        assert_eq!(leaves, kind != "CHIP", "{kind}\n{}", done.out);
    }
}

#[test]
fn an_option_for_a_word_takes_words_alone() {
    let bad = post(&["-m", "vmc", "x.cls", "--allow", "SET/OFSETL"]);
    assert_eq!(bad.code, 2, "{}", bad.err);
    assert!(bad.err.contains("no word of a CL file"), "{}", bad.err);
}
