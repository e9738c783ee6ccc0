//! `post lint`: each rule on a program that breaks it and on one that does not, the forms of what is found, programs of
//! other posts, and how many of random mistakes are seen.

mod examined;
mod mistakes;
mod strangers;

use std::fs;
use std::path::Path;

use post_testkit::assert_contains;
use serde_json::Value;
use tempfile::TempDir;

use crate::common::{post_in, root};

/// A contour, and a slot inside of it: nothing is wrong.
const GOOD: &str = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS1000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z50.\nM8\nG0 Z2.\n\
    G1 Z-5. F500.\nX60.\nG3 X70. Y10. I0. J10.\nG1 Y40.\nX0.\nY0.\nG0 Z50.\nT2 M6\nS2000 M3\nM8\nG0 X30. Y20.\nG43 H2 Z50.\nZ2.\n\
    G1 Z-5. F300.\nX40.\nZ-8.\nX30.\nG0 Z50.\nM9\nM5\nG49\nG53 G0 Z0.\nM30\n%\n";

/// A folder with a program, and what is found of it as JSON on a machine that `more` is added to.
fn linted(program: &str, more: &str, words: &[&str]) -> (TempDir, i32, Value) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.nc"), program).unwrap();
    let machine = format!(
        "extends = \"vmc\"\nname = \"mine\"\n[workpiece]\nmount = [0, 0, -50]\n[tools.1]\nlength = 100\n[tools.2]\nlength = 120\n[tools.3]\nlength = 120\n{more}"
    );
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    let mut all = vec![
        "lint",
        "part.nc",
        "-m",
        "mine.toml",
        "--json",
        "found.json",
        "--sarif",
        "found.sarif",
    ];
    all.extend(words);
    let run = post_in(folder.path(), &all);
    let found = fs::read_to_string(folder.path().join("found.json"));
    let found = found.unwrap_or_else(|_| panic!("{}", run.err));
    (folder, run.code, serde_json::from_str(&found).unwrap())
}

/// Code and line of each finding.
fn told(found: &Value) -> Vec<(String, u64)> {
    let findings = found["findings"].as_array().unwrap().iter();
    findings
        .map(|one| (one["code"].as_str().unwrap().to_owned(), one["line"].as_u64().unwrap_or(0)))
        .collect()
}

#[test]
fn each_rule_is_told_at_its_line_and_a_good_program_breaks_none() {
    let (_folder, code, found) = linted(GOOD, "", &["--strict"]);
    assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}");
    for (from, to, code, line) in [
        ("X60.\n", "X900.\n", "over-travel", 13),
        ("G1 Z-5. F500.", "G1 Z-5. F90000.", "max-feed", 12),
        ("G1 Z-5. F500.", "G1 Z-5. F0", "feed", 12),
        ("S1000 M3", "S1000", "spindle", 12),
        ("S2000 M3\n", "\n", "spindle", 25),
        ("S1000 M3", "S0 M3", "spindle-speed", 12),
        ("X40.\nZ-8.", "X40. M9\nZ-8.", "coolant", 27),
        ("S2000 M3\nM8\n", "S2000 M3\n", "coolant", 24),
        ("G0 Z50.\nT2 M6\nS2000 M3\nM8\n", "G0 Z50. M9\nT2 M6\nS2000 M3\n", "coolant", 24),
        ("G43 H2 Z50.", "G0 Z50.", "length", 25),
        ("G43 H1 Z50.", "G0 Z50.", "length", 9),
        ("X60.\n", "G49 X60.\n", "length", 13),
        ("G43 H2", "G43 H1", "length", 25),
        ("G43 H2", "G43 H3", "register", 25),
        ("G43 H1", "G43 H2", "register", 12),
        ("Z2.\nG1 Z-5. F300.\nX40.", "Z2.\nG0 Z-5.\nG1 X40. F300.", "rapid", 25),
        ("Z2.\nG1 Z-5. F300.", "Z-7.\nG1 Z-5. F300.", "rapid", 24),
        ("I0. J10.", "I0. J12.", "nc-arc", 14),
        ("G3 X70. Y10. I0. J10.", "G3 X59.996 Y0. I0. J10.", "full-circle", 14),
        ("G3 X70. Y10. I0. J10.", "G65 P9810 X70.", "nc-subprogram", 14),
        ("G21 ", "", "nc-modes", 4),
        ("G49\n", "G41 D1\n", "nc-modes", 34),
        ("T2 M6", "G41 D1\nT2 M6", "nc-modes", 20),
        ("M30\n", "", "missing", 34),
        // Down at rapid: the first time on the contour, the second where a cut came down before.
        ("G1 Z-5. F500.", "F500.\nG0 Z-5.\nG1", "rapid", 13),
        ("Z-8.\n", "G0 Z-8.\nG1\n", "rapid", 27),
        ("M30\n", "G92 Z0.\nM30\n", "nc-modes", 35),
        ("G54\n", "G54\nG52 X10.\n", "nc-modes", 35),
        ("T2 M6", "T2", "tool", 19),
    ] {
        let program = GOOD.replacen(from, to, 1);
        assert_ne!(program, GOOD, "{from}");
        let (_folder, exit, found) = linted(&program, "", &["--strict"]);
        let told = told(&found);
        assert!(told.contains(&(code.to_owned(), line)), "{from:?} as {to:?}: {told:?}\n{found:#}");
        assert_eq!(exit, 1);
    }
}

/// What no program can do without is an error where its own words say that it is meant, else a warning: somebody may switch
/// the spindle on by hand, or measure the offset with the one tool.
#[test]
fn what_is_left_out_everywhere_is_an_error_where_other_words_ask_for_it() {
    // One tool, as it comes from a CAM system.
    let one = GOOD.split_once("G0 Z50.\nT2 M6").unwrap().0.to_owned()
        + "G0 Z50.\nM9\nM5\nG49\nG53 G0 Z0.\nM30\n%\n";
    let bare = one.replacen("T1 M6\nS1000 M3\n", "", 1);
    let no_length = one.replacen("G43 H1 Z50.", "Z50.", 1);
    let two = GOOD.replacen("G43 H1 Z50.", "Z50.", 1).replacen("G43 H2 Z50.", "Z50.", 1);
    // Each of two tools by its own work offset, measured with it.
    let own = two.replacen("T2 M6\n", "T2 M6\nG55\n", 1);
    for (program, code, severity) in [
        (one.replacen(" M3\n", "\n", 1), "spindle", "error"),
        (one.replacen("S1000 M3\n", "", 1), "spindle", "error"),
        (bare, "spindle", "warning"),
        (one.replacen("G43 H1", "H1", 1), "length", "error"),
        (no_length.clone(), "length", "warning"),
        (two, "length", "error"),
        (own, "length", "warning"),
        (one.replacen("T1 M6", "T1", 1), "tool", "warning"),
        (GOOD.replacen("T2 M6", "T2", 1), "tool", "error"),
    ] {
        let (_folder, _, found) = linted(&program, "", &[]);
        let findings = found["findings"].as_array().unwrap();
        let of_code = findings.iter().find(|one| one["code"] == code);
        let found_severity = of_code.map(|one| one["severity"].as_str().unwrap());
        assert_eq!(found_severity, Some(severity), "{code}: {found:#}\n{program}");
    }
    // The next tool, and at the end the first of the next part, may be made ready while one cuts.
    let ready = GOOD.replacen("G1 Z-5. F500.", "T2\nG1 Z-5. F500.", 1);
    let ready = ready.replacen("G1 Z-5. F300.", "T1\nG1 Z-5. F300.", 1);
    let (_folder, code, found) = linted(&ready, "", &["--strict"]);
    assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}");
}

/// Rapids at the depth of cuts, each on a program that is right without it.
#[test]
fn rapids_in_the_place_of_cuts_are_told() {
    let begin = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS1000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z50.\nZ2.\n";
    let end = "G0 Z50.\nM5\nG49\nG53 G0 Z0.\nM30\n%\n";
    // A pocket in two depths, in rows from its corner.
    let rows = |z: f64| {
        let row =
            |at: u32| format!("Y{}.\nX{}.\n", 5 * at, if at.is_multiple_of(2) { 0 } else { 40 });
        let rows: String = (1..7).map(row).collect();
        format!("G1 Z{z:.1} F300.\nX40.\nX0.\n{rows}G0 Z2.\nX0. Y0.\n")
    };
    let pocket = format!("{begin}{}G0 Z-2.\n{}{end}", rows(-2.5), rows(-5.0));
    // A wave.
    let wave = |at: i32| {
        let x = f64::from(at);
        format!("X{x:.3} Y{:.3} Z{:.3}\n", 5.0 * libm::sin(x / 8.0), -3.0 + libm::cos(x / 8.0))
    };
    let waves: String = (0..60).map(wave).collect();
    let waves = format!("{begin}G1 Z-2. F300.\n{waves}{end}");
    for (good, from, to) in [
        (&pocket, "G0 Z-2.\nG1 Z-5.0 F300.", "F300.\nG0 Z-5.0\nG1"),
        (&waves, &*wave(30), &*format!("G0 {}G1\n", wave(30))),
    ] {
        let (_folder, code, found) = linted(good, "", &["--strict"]);
        assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}\n{good}");
        let bad = good.replacen(from, to, 1);
        assert_ne!(&bad, good);
        let (_folder, _, found) = linted(&bad, "", &[]);
        assert!(told(&found).iter().any(|(code, _)| code == "rapid"), "{from}: {found:#}\n{bad}");
    }
    // Straight down on a contour that is cut all around from there; and all of a tool's cuts at rapid, as G0 is modal.
    let around = begin.replace("Z2.\n", "") + "Z-5.\nG1 X40. F300.\nY40.\nX0.\nY0.\n" + end;
    let (_folder, _, found) = linted(&around, "", &[]);
    assert_eq!(told(&found), [("rapid".to_owned(), 10)], "{found:#}");
    let (_folder, _, found) = linted(&waves.replacen("G1 Z-2. F300.", "Z-2.", 1), "", &[]);
    assert_eq!(told(&found), [("rapid".to_owned(), 9)], "{found:#}");
    // One digit of a dense path: out and back again.
    let (_folder, _, found) = linted(&waves.replacen("X30.000", "X39.000", 1), "", &[]);
    assert!(told(&found).contains(&("stray-point".to_owned(), 42)), "{found:#}");
    // On the border of what is cut, beside others that are cuts; and beside the part, where a facing goes from row to row so.
    let across = GOOD.replacen("G1 Y40.\nX0.", "G1 Y40.\nG0 X0.\nG1", 1);
    let (_folder, _, found) = linted(&across, "", &[]);
    assert_eq!(told(&found), [("rapid".to_owned(), 16)], "{found:#}");
    let face = |at: u32| {
        format!("G0 Y{}.\nG1 X{}. F300.\n", 10 * at, if at.is_multiple_of(2) { 60 } else { -10 })
    };
    let faces: String = (0..5).map(face).collect();
    let facing = format!("{begin}G0 X-10.\nZ-0.5\n{faces}{end}");
    let (_folder, code, found) = linted(&facing, "", &["--strict"]);
    assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}");
    // Beside the part the tool comes down at rapid, and in on a straight way that it goes out on again.
    let beside = format!(
        "{begin}G0 X-10. Y20.\nZ-5.\nG1 X0. F300.\nY40.\nX60.\nY0.\nX0.\nY20.\nX-10.\n{end}"
    );
    let (_folder, code, found) = linted(&beside, "", &["--strict"]);
    assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}");
}

/// A way from cut to cut at their depth in two blocks, on each of which alone nothing need be wrong, and in two halves.
#[test]
fn a_rapid_across_in_several_blocks_is_told_as_one_is() {
    let begin = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS1000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z50.\nZ2.\n";
    let end = "G0 Z50.\nM5\nG49\nG53 G0 Z0.\nM30\n%\n";
    // Slots side by side, the tool raised in between.
    let slots: String =
        (0..6).map(|at| format!("G0 Z2.\nX0. Y{0}.\nG1 Z-5. F300.\nX60.\n", 20 * at)).collect();
    let good = format!("{begin}{slots}{end}");
    let (_folder, code, found) = linted(&good, "", &["--strict"]);
    assert_eq!((told(&found), code), (Vec::new(), 0), "{found:#}");
    let raised = "G0 Z2.\nX0. Y40.\nG1 Z-5. F300.\nX60.\n";
    for across in [
        "G0 X0. Y40.\nG1 X60. F300.\n",
        "G0 Y40.\nX0.\nG1 X60. F300.\n",
        "G0 X30.\nX30. Y40.\nX0.\nG1 X60. F300.\n",
        "G0 X30. Y30.\nX0. Y40.\nG1 X60. F300.\n",
    ] {
        let bad = good.replacen(raised, across, 1);
        assert_ne!(bad, good);
        let (_folder, _, found) = linted(&bad, "", &[]);
        let rapids: Vec<_> = told(&found).into_iter().filter(|(code, _)| code == "rapid").collect();
        assert!(!rapids.is_empty(), "{across}: {found:#}");
        assert!((19..=21).contains(&rapids[0].1), "{across}: {found:#}");
    }
    // Up in between, or back on what is cut: nothing is wrong.
    for across in [
        "G0 X30.\nZ2.\nX0. Y40.\nG1 Z-5. F300.\nX60.\n",
        "G0 X30.\nX0.\nZ2.\nY40.\nG1 Z-5. F300.\nX60.\n",
    ] {
        let (_folder, code, found) = linted(&good.replacen(raised, across, 1), "", &["--strict"]);
        assert_eq!((told(&found), code), (Vec::new(), 0), "{across}: {found:#}");
    }
}

/// Coolant of one tool is that of the next as well, unless tools without it are meant.
#[test]
fn a_tool_without_the_coolant_of_those_before_it_is_told_once() {
    let tool = |number: u32, coolant: &str| {
        format!(
            "G53 G0 Z0.\nT{number} M6\nS1000 M3\nG54\nG0 X0. Y{0}.\nG43 H{number} Z50.\n{coolant}Z2.\nG1 Z-5. F300.\nX40.\nG0 Z50.\nM9\n",
            10 * number
        )
    };
    let program = |coolants: [&str; 3]| {
        let tools: String =
            (1..4).zip(coolants).map(|(number, coolant)| tool(number, coolant)).collect();
        format!("%\nO1\nG21 G17 G40 G80 G90 G94\n{tools}M5\nG49\nG53 G0 Z0.\nM30\n%\n")
    };
    for (coolants, lines) in [
        (["M8\n", "M8\n", "M8\n"], &[][..]),
        (["M8\n", "", "M8\n"], &[23]),
        (["M8\n", "", ""], &[23]),
        (["M8\n", "M7\n", ""], &[35]),
        (["", "M8\n", ""], &[]),
        (["", "", ""], &[]),
    ] {
        let (_folder, _, found) = linted(&program(coolants), "", &[]);
        let dry = told(&found).into_iter().filter(|(code, _)| code == "coolant");
        let dry: Vec<u64> = dry.map(|(_, line)| line).collect();
        assert_eq!(dry, lines, "{coolants:?}: {found:#}");
    }
    // One that the spindle does not turn, such as a probe.
    let probe = program(["M8\n", "", "M8\n"]).replacen("T2 M6\nS1000 M3\n", "T2 M6\nM5\n", 1);
    let (_folder, _, found) = linted(&probe, "", &[]);
    assert!(told(&found).iter().all(|(code, _)| code != "coolant"), "{found:#}");
}

/// Where one work offset or tool lies from another nobody says: no way from one to the other is known.
#[test]
fn ways_across_work_offsets_that_nobody_states_are_not_known() {
    let program = |more: &str| GOOD.replacen("G0 Z50.\nT2 M6", &format!("G0 Z50.\n{more}T2 M6"), 1);
    let folder = tempfile::tempdir().unwrap();
    let travel = |text: &str, words: &[&str]| {
        fs::write(folder.path().join("part.nc"), text).unwrap();
        let mut all = vec!["lint", "part.nc", "-m", "vmc", "--json", "found.json"];
        all.extend(words);
        post_in(folder.path(), &all);
        let found = fs::read_to_string(folder.path().join("found.json")).unwrap();
        let found: Value = serde_json::from_str(&found).unwrap();
        let codes = told(&found).into_iter().map(|(code, _)| code);
        codes
            .filter(|code| ["over-travel", "part-place"].contains(&code.as_str()))
            .collect::<Vec<_>>()
    };
    // 60 mm on from X 0 by G54, and 400 mm by G55, a metre apart if they are the same.
    let apart = program("G55\nG0 X-700. Y0.\nZ2.\nG1 Z-5.\nX-1100.\nG0 Z50.\nG54\n");
    let long = ["--tool-length", "100"];
    assert_eq!(travel(&apart, &long), ["part-place"]);
    fs::write(
        folder.path().join("same.toml"),
        "[work.G54]\nX = 0\nY = 0\nZ = 0\n[work.G55]\nX = 0\nY = 0\nZ = 0\n",
    )
    .unwrap();
    assert_eq!(travel(&apart, &[&long[..], &["--offsets", "same.toml"]].concat()), ["over-travel"]);
    // Of one offset it is known.
    let one = program("G0 X-700. Y0.\nZ2.\nG1 Z-5.\nX-1100.\nG0 Z50.\n");
    assert_eq!(travel(&one, &long), ["over-travel"]);
    // High up with the one tool, deep down with the other: how much longer that is nobody says.
    let deep = GOOD.replacen("G43 H1 Z50.", "G43 H1 Z400.", 1).replacen("Z-8.", "Z-300.", 1);
    assert_eq!(travel(&deep, &long), ["over-travel"]);
    assert_eq!(travel(&deep, &[]), ["part-place"]);
    // Positions of the machine are known wherever the part sits.
    let machine = GOOD.replacen("M30", "G53 X900.\nM30", 1);
    assert!(travel(&machine, &long).contains(&"over-travel".to_owned()));
}

/// A file without a block is no program: an error, not a program in which nothing is wrong.
#[test]
fn a_file_without_a_block_is_refused() {
    for text in [String::new(), "\0".repeat(100_000), "%\n\n%\n".to_owned()] {
        let (_folder, code, found) = linted(&text, "", &[]);
        assert_eq!((told(&found), code), (vec![("missing".to_owned(), 1)], 1), "{found:#}");
    }
    // Nor is it one where what tells so is left out; with lines that read as blocks by chance it is none either.
    let binary: String = (0..400).map(|at| format!("\u{1}\u{7f}\0X{at}\n")).collect();
    for text in [String::new(), "\0\u{1}".repeat(1000), binary.clone(), binary + "G0 X1\n"] {
        let ignored = ["--ignore", "syntax", "--ignore", "missing", "--ignore", "nc-refused"];
        let (_folder, code, found) = linted(&text, "", &ignored);
        assert_eq!(code, 1, "{found:#}");
        assert!(!told(&found).is_empty());
    }
}

/// Where the part sits nobody says: the line is that of the axis that goes farthest.
#[test]
fn how_much_travel_is_needed_is_told_at_the_line_that_needs_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.nc"), GOOD.replace("X40.\nZ-8.", "X590.\nZ-8.")).unwrap();
    post_in(
        folder.path(),
        &["lint", "part.nc", "-m", "vmc", "--json", "found.json", "--tool-length", "100"],
    );
    let found = fs::read_to_string(folder.path().join("found.json")).unwrap();
    let found: Value = serde_json::from_str(&found).unwrap();
    let places = told(&found);
    assert!(places.contains(&("part-place".to_owned(), 26)), "{found:#}");
}

#[test]
fn smoothing_beyond_the_tolerance_is_told() {
    let program = GOOD.replacen("%\nO1\n", "", 1).replacen("G54\n", "G54\nG64 P1\n", 1);
    let (_folder, _, found) = linted(&program, "[control]\ndialect = \"linuxcnc\"\n", &[]);
    assert!(told(&found).contains(&("smoothing".to_owned(), 11)), "{found:#}");
}

/// Where the stock is known it is proven what a rapid hits, and not guessed.
#[test]
fn with_bodies_what_is_proven_stands_in_the_place_of_what_is_guessed() {
    // The tool that has a body.
    let deep = GOOD.replace("T2 M6", "T3 M6").replace("G43 H2", "G43 H3");
    let deep = deep.replace("Z2.\nG1 Z-5. F300.\nX40.", "Z2.\nG0 Z-5.\nG1 X40. F300.");
    let bodies = "cutter = [[0, 3], [60, 3]]\n[stock]\nblock = [[3, 3, -20], [57, 37, 0]]\n";
    let (_folder, code, found) = linted(&deep, bodies, &[]);
    assert_eq!(code, 1);
    assert!(told(&found).contains(&("clearance".to_owned(), 25)), "{found:#}");
    assert!(told(&found).iter().all(|(code, _)| code != "rapid"), "{found:#}");
}

#[test]
fn what_is_ignored_is_counted_and_what_no_message_has_is_refused() {
    let wet = GOOD.replace("X40.\nZ-8.", "X40. M9\nZ-8.").replace("G43 H2", "G43 H3");
    let (_folder, code, found) = linted(&wet, "", &[]);
    assert_eq!((told(&found).len(), code), (2, 0), "warnings alone: {found:#}");
    let ours = "[lint]\nignore = [\"coolant\"]\n";
    let (folder, code, found) = linted(&wet, ours, &["--ignore", "register", "--strict"]);
    assert_eq!((told(&found).len(), code), (0, 0), "{found:#}");
    assert_eq!(found["ignored"].as_array().unwrap().len(), 2);
    for words in [&["--ignore", "colant"][..], &["--set", "lint.ignore=[\"colant\"]"][..]] {
        let mut all = vec!["lint", "part.nc", "-m", "mine.toml"];
        all.extend(words);
        let run = post_in(folder.path(), &all);
        assert_eq!(run.code, 2, "{}", run.out);
        assert_contains(&run.err, &["no message has the code colant", "coolant"]);
    }
}

/// As the schema of SARIF 2.1.0 asks: each result has its rule, a level and a region that is in the file.
#[test]
fn sarif_names_rule_level_and_region_of_each_finding() {
    let program = GOOD.replace("G43 H2", "G43 H3").replace("X60.\n", "X900.\n");
    let (folder, _, found) = linted(&program, "", &[]);
    let text = fs::read_to_string(folder.path().join("found.sarif")).unwrap();
    let log: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(log["version"], "2.1.0");
    let run = &log["runs"][0];
    let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
    let results = run["results"].as_array().unwrap();
    assert_eq!(results.len(), told(&found).len());
    assert!(results.len() > 1);
    for (result, (code, line)) in results.iter().zip(told(&found)) {
        assert_eq!(result["ruleId"], code.as_str());
        let rule = &rules[usize::try_from(result["ruleIndex"].as_u64().unwrap()).unwrap()];
        assert_eq!(rule["id"], code.as_str());
        assert!(rule["shortDescription"]["text"].as_str().unwrap().len() > 10, "{rule}");
        assert!(["error", "warning"].contains(&result["level"].as_str().unwrap()));
        let place = &result["locations"][0]["physicalLocation"];
        assert_eq!(place["artifactLocation"]["uri"], "part.nc");
        assert_eq!(place["region"]["startLine"], line);
        let text = program.lines().nth(usize::try_from(line).unwrap() - 1).unwrap();
        assert_eq!(place["region"]["endColumn"].as_u64().unwrap(), text.len() as u64 + 1);
    }
}

/// The hook's own line, as pre-commit runs it: with the names of files behind it, and no length of a tool said.
#[test]
fn the_hook_for_pre_commit_lets_good_programs_pass_alone() {
    let hook = root().join("editors/pre-commit/pre-commit-config.yaml");
    let hook = fs::read_to_string(hook).unwrap();
    let entry = hook.lines().find_map(|line| line.trim().strip_prefix("entry: post ")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let blade = root().join("tests/samples/blade.cls");
    let blade = blade.to_str().unwrap();
    let made = post_in(
        folder.path(),
        &[blade, "-m", "ac-trunnion", "-o", "good.nc", "-q", "--tool-length", "100"],
    );
    assert_eq!(made.code, 0, "{}", made.err);
    let good = fs::read_to_string(folder.path().join("good.nc")).unwrap();
    fs::write(folder.path().join("bad.nc"), good.replacen("M3", "M5", 1)).unwrap();
    // By hand, with a word that nobody knows.
    fs::write(folder.path().join("hand.nc"), GOOD.replacen("M8", "M8 M77", 1)).unwrap();
    // Headers of C, and a program of Heidenhain.
    let header = "/* 2. Redistributions */\n#ifndef PART_H\n#define PART_H\nstatic const int at[] = {\n1, 2,\n0x00, 3 };\n#endif\n";
    fs::write(folder.path().join("part.h"), header).unwrap();
    fs::write(folder.path().join("empty.h"), "").unwrap();
    // A program for another control.
    let klartext = "0  BEGIN PGM A MM\n1  L  X+900\n2  END PGM A MM\n";
    fs::write(folder.path().join("klartext.h"), klartext).unwrap();
    let alone = post_in(folder.path(), &["lint", "part.h", "-m", "dmu50"]);
    assert_eq!(alone.code, 1, "named by hand it is a program: {}", alone.out);
    for (files, code) in [
        (&["good.nc", "hand.nc"][..], 0),
        (&["good.nc", "bad.nc"][..], 1),
        (&["good.nc", "part.h", "empty.h"][..], 0),
        (&["part.h"][..], 0),
        (&["klartext.h"][..], 2),
        (&["part.h", "gone.h"][..], 2),
    ] {
        let mut words: Vec<&str> = entry.split_whitespace().collect();
        words.extend(files);
        let run = post_in(folder.path(), &words);
        assert_eq!(run.code, code, "{files:?}: {}{}", run.out, run.err);
    }
    let pattern = hook.lines().find_map(|line| line.trim().strip_prefix("files: ")).unwrap();
    for ending in post_lsp_endings() {
        assert!(pattern.contains(&ending), "{ending} is not in {pattern}");
    }
}

/// VS Code knows programs by the endings of the language server, but for `.h`, which is C's there.
#[test]
fn vs_code_knows_the_endings_of_programs() {
    let extension = fs::read_to_string(root().join("editors/vscode/package.json")).unwrap();
    let extension: Value = serde_json::from_str(&extension).unwrap();
    let languages = extension["contributes"]["languages"].as_array().unwrap();
    let nc = languages.iter().find(|language| language["id"] == "post-nc").unwrap();
    let known = nc["extensions"].as_array().unwrap().iter();
    let mut known: Vec<&str> =
        known.map(|ending| ending.as_str().unwrap().trim_start_matches('.')).collect();
    known.push("h");
    known.sort_unstable();
    let mut ours = post_lsp_endings();
    ours.sort_unstable();
    assert_eq!(known, ours);
}

/// The endings by which the language server knows programs.
fn post_lsp_endings() -> Vec<String> {
    let text = fs::read_to_string(root().join(Path::new("lsp/src/nc/mod.rs"))).unwrap();
    let list = text.split_once("ENDINGS").unwrap().1;
    let list = list.split_once("= &[").unwrap().1.split_once(']').unwrap().0;
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}
