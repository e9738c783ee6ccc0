//! The frame around the moves: first lines, retracts, the way to the part, tool changes, stops, the end.

use std::fs;

use crate::common::{Run, command, run};

/// Two tools upright, a stop in the second's cut.
const UPRIGHT: &str = "UNITS/MM
LOADTL/1
SPINDL/RPM,3000,CLW
COOLNT/FLOOD
RAPID
GOTO/ 20, 10, 50
FEDRAT/600,MMPM
GOTO/ 20, 10, 15
RAPID
GOTO/ 20, 10, 50
LOADTL/2
SPINDL/RPM,2000,CLW
RAPID
GOTO/ -20, 10, 50
FEDRAT/600,MMPM
GOTO/ -20, 10, 15
STOP
GOTO/ -30, 10, 15
RAPID
GOTO/ -30, 10, 50
END
FINI
";

/// A cut that ends in the part, the tool leaning by so much from Z to X.
fn leaning(degrees: f64) -> String {
    let (sine, cosine) = libm::sincos(degrees.to_radians());
    format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/ 0, 0, 50, {sine:.7}, 0, {cosine:.7}\n\
         FEDRAT/600,MMPM\nGOTO/ 0, 0, 15, {sine:.7}, 0, {cosine:.7}\nGOTO/ 0, 20, 15, {sine:.7}, 0, {cosine:.7}\nEND\nFINI\n"
    )
}

/// Posts on a machine that is refined by `more`.
fn post(machine: &str, more: &str, arguments: &[&str], cl: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("machine.toml");
    fs::write(&file, format!("extends = {machine:?}\n{more}")).unwrap();
    let mut all = vec!["-q", "-m", file.to_str().unwrap(), "--tool-length", "100"];
    all.extend(arguments);
    all.extend(["-o", "-", "-"]);
    run(command().args(all), cl.as_bytes())
}

fn lines(machine: &str, more: &str, arguments: &[&str], cl: &str) -> Vec<String> {
    let done = post(machine, more, arguments, cl);
    assert_eq!(done.code, 0, "{machine}: {}", done.err);
    // Block numbers of the TNC say nothing here.
    let plain =
        |line: &str| line.trim_start_matches(|c: char| c.is_ascii_digit()).trim().to_owned();
    done.out.lines().map(plain).collect()
}

/// `wanted` stand in `lines` one behind the other, without a gap.
#[track_caller]
fn assert_run(lines: &[String], wanted: &[&str]) {
    let found = lines.windows(wanted.len()).any(|window| window == wanted);
    assert!(found, "{wanted:#?} is not in:\n{}", lines.join("\n"));
}

const FANUC: &str = "[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n";
const TNC: &str = "[control]\ndialect = \"heidenhain\"\ntcp = \"control\"\n";
const LINUXCNC: &str = "[control]\ndialect = \"linuxcnc\"\ntcp = \"control\"\n";

/// Z goes from -120 to 120: zero would lead through the part.
#[test]
fn the_tool_retracts_to_the_end_of_travel() {
    for (control, retract) in [
        (FANUC, "G53 G0 Z120.000"),
        (TNC, "L Z+120.000 R0 FMAX M91"),
        (LINUXCNC, "G53 G0 Z120.0000"),
    ] {
        let lines = lines("xyzac-trt", control, &["--mount", "0,0,-60"], UPRIGHT);
        // At the start, ahead of the second tool, at the end; not again behind a tool change.
        let count = lines.iter().filter(|line| *line == retract).count();
        assert_eq!(count, 3, "{}", lines.join("\n"));
        assert!(!lines.iter().any(|line| line.contains("Z0.") || line.contains("G28")));
    }
    // A knee: the table carries the part, and goes down to lead it away.
    let knee = "chain = \"[w Z' b X Y (S) t]\"\n[control]\ntcp = \"post\"\n";
    let down = post(
        "vmc",
        &format!("{knee}[axis.Z]\nreversed = true\ntravel = [-20, 500]\n"),
        &[],
        UPRIGHT,
    );
    assert!(down.err.contains("error[machine-depth]: Z of"), "{}", down.err);
    let lines = lines("vmc", knee, &[], UPRIGHT);
    assert!(lines.contains(&"G53 G0 Z20.000".to_owned()), "{}", lines.join("\n"));
}

#[test]
fn what_was_in_force_before_is_cancelled_first() {
    assert_run(
        &lines("xyzac-trt", FANUC, &["--mount", "0,0,-60"], UPRIGHT),
        &["G21", "G17 G40 G80 G90 G94", "G53 G0 Z120.000", "G49", "G69", "T1 M6"],
    );
    assert_run(
        &lines("xyzac-trt", LINUXCNC, &["--mount", "0,0,-60"], UPRIGHT),
        &[
            "G8 G17 G40 G80 G90 G91.1 G94 G97 G54",
            "G92.2",
            "G61",
            "M429",
            "G53 G0 Z120.0000",
            "G49",
            "T1 M6",
        ],
    );
    assert_run(
        &lines("xyzac-trt", TNC, &["--mount", "0,0,-60"], UPRIGHT),
        &["M129", "PLANE RESET STAY", "CYCL DEF 7.0 DATUM SHIFT"],
    );
    // A control with three axes knows neither M429 nor M129.
    for dialect in ["linuxcnc", "heidenhain"] {
        let more = format!("[control]\ndialect = {dialect:?}\n");
        let lines = lines("vmc", &more, &[], UPRIGHT);
        assert!(!lines.iter().any(|line| line == "M429" || line == "M129"));
    }
}

/// Under TCP the length is on ahead of it, and off behind it, in the air.
#[test]
fn length_and_tcp_are_switched_in_the_order_of_the_control() {
    let tilted = leaning(20.0);
    let linuxcnc = lines("xyzbc-trt", LINUXCNC, &["--mount", "0,0,-60"], &tilted);
    let at =
        |lines: &[String], word: &str| lines.iter().rposition(|line| line.contains(word)).unwrap();
    let on = at(&linuxcnc, "M428");
    assert_eq!(linuxcnc[on - 1], "G43 H1");
    assert!(linuxcnc[on + 1].contains('X') && linuxcnc[on + 1].contains('Z'));
    // From above the first position down to it.
    assert!(linuxcnc[on + 2].ends_with("Z50.0000"), "{}", linuxcnc[on + 2]);
    let across = |line: &String| line.starts_with("G53") && line.contains(['X', 'Y']);
    assert!(!linuxcnc.iter().any(across), "{}", linuxcnc.join("\n"));
    assert!(
        at(&linuxcnc, "M429") < at(&linuxcnc, "G53") && at(&linuxcnc, "G53") < at(&linuxcnc, "G49")
    );
    let control = format!("{}planes = false\n", FANUC.replace("post", "control"));
    let fanuc = lines("xyzbc-trt", &control, &["--mount", "0,0,-60"], &tilted);
    assert!(!fanuc.iter().any(across), "{}", fanuc.join("\n"));
    let on = at(&fanuc, "G43.4 H1 X");
    assert!(fanuc[on].contains('Z') && fanuc[on + 1].ends_with("Z50.000"));
    assert!(at(&fanuc, "G53") < at(&fanuc, "G49"));
    // With nothing turned words are positions: first across, then down.
    let upright = lines("xyzbc-trt", &control, &["--mount", "0,0,-60"], UPRIGHT);
    assert_run(&upright, &["G0 B0.000 C0.000", "X20.000 Y10.000", "G43.4 H1 Z50.000"]);
}

/// Axis positions of a table that turns hold for a part on one place alone: the program's head says it, and the sheet.
#[test]
fn what_stands_or_falls_with_the_mount_says_so() {
    let control = FANUC.replace("post", "control");
    for (machine, control, alone) in
        [("xyzac-trt", FANUC, true), ("xyzac-trt", &control, false), ("head-head", FANUC, false)]
    {
        let folder = tempfile::tempdir().unwrap();
        let sheet = folder.path().join("sheet.md");
        let arguments = ["--mount", "0,0,-60", "--setup-sheet", sheet.to_str().unwrap()];
        let lines = lines(machine, control, &arguments, UPRIGHT);
        let head = lines.iter().any(|line| line.ends_with(", FOR THE PART AT X0 Y0 Z-60 ALONE)"));
        assert_eq!(head, alone, "{machine}: {}", lines.join("\n"));
        let sheet = fs::read_to_string(sheet).unwrap();
        let says = |text: &str| sheet.contains(text);
        assert!(says("Z -60.000 mm in the machine frame"), "{machine}: {sheet}");
        assert!(says("mm, without a tool"), "{machine}: {sheet}");
        assert_eq!(says("for the part origin there alone"), alone, "{machine}: {sheet}");
        assert_eq!(says("wherever the work offset is measured"), !alone, "{machine}: {sheet}");
    }
}

#[test]
fn positions_of_the_machine_file_are_gone_to() {
    let more = format!(
        "{FANUC}retract = {{ Z = 110 }}\npark = {{ X = -150, A = -30, C = 0 }}\nchange = {{ Y = 90 }}\n"
    );
    let lines = lines("xyzac-trt", &more, &["--mount", "0,0,-60"], UPRIGHT);
    assert_run(&lines, &["G53 G0 Z110.000", "G49", "M5", "M9", "G53 G0 Y90.000", "T2 M6"]);
    assert_run(&lines, &["G53 G0 A-30.000 C0.000", "G53 G0 X-150.000", "M30"]);
    // The rotary axes of park hold for a tool change too.
    let more = format!("{FANUC}park = {{ X = -150, A = -30 }}\n");
    let lines = self::lines("xyzac-trt", &more, &["--mount", "0,0,-60"], UPRIGHT);
    assert_run(&lines, &["M5", "M9", "G53 G0 A-30.000", "T2 M6"]);
    // GOHOME parks.
    let home = UPRIGHT.replace("LOADTL/2\n", "GOHOME\nLOADTL/2\n");
    let lines = self::lines("xyzac-trt", &more, &["--mount", "0,0,-60"], &home);
    assert_run(&lines, &["G53 G0 Z120.000", "G49", "G53 G0 A-30.000", "G53 G0 X-150.000"]);

    for (wrong, said) in [
        ("retract = { Z = 130 }", "Z cannot stand at 130: its travel is -120 to 120"),
        ("retract = { A = 10 }", "retract turns A: the tool leaves the part by its linear axes"),
        ("park = { B = 10 }", "the machine has no axis B"),
    ] {
        let done = post("xyzac-trt", &format!("{FANUC}{wrong}\n"), &[], UPRIGHT);
        assert_eq!(done.code, 1);
        assert!(done.err.contains(said) && done.err.contains(wrong), "{}", done.err);
    }
    // Lower than the tool stands, a retract would come down.
    let done = post("xyzac-trt", &format!("{FANUC}retract = {{ Z = 10 }}\n"), &[], UPRIGHT);
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("would bring the tool down"), "{}", done.err);
}

/// 100 mm along the tool, then up; where travel ends sooner, less.
#[test]
fn a_head_that_leans_leaves_along_the_tool() {
    for tcp in ["post", "control"] {
        let arguments = ["--tcp", tcp, "--set", "control.planes=false"];
        let lines = lines("head-head", "", &arguments, &leaning(30.0));
        let up = lines.iter().rposition(|line| line.contains("G53 G0 Z")).unwrap();
        let value = |line: &str, name: char| {
            let word = line.split(' ').find(|word| word.starts_with(name));
            word.map(|word| word[1..].parse::<f64>().unwrap())
        };
        let leave = &lines[up - 1];
        let before =
            |name| lines[..up - 1].iter().rev().find_map(|line| value(line, name)).unwrap();
        let way = ['X', 'Z'].map(|name| value(leave, name).unwrap() - before(name));
        assert!((way[0] - 50.0).abs() < 0.01 && (way[1] - 86.603).abs() < 0.01, "{tcp}: {leave}");
        assert!(leave.starts_with("G0") || leave.starts_with('X'), "{leave}");
    }
}

/// A tool that points up from below the part would be driven into it.
#[test]
fn a_retract_that_does_not_lead_away_is_refused() {
    let below = leaning(120.0);
    let done = post("head-head-360", "", &[], &below);
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(
        done.err.contains("error[retract]: the tool leans by 120.0°")
            && done.err.contains("[control] retract"),
        "{}",
        done.err
    );
    let answered = post("head-head-360", "[control]\nretract = { Z = 9000 }\n", &[], &below);
    assert_eq!(answered.code, 0, "{}", answered.err);
    // Level, it has left along its axis, and the way up is free.
    assert_eq!(post("head-head-360", "", &[], &leaning(90.0)).code, 0);
}

/// The TNC's M0 stops both; the tool does not move on before they are on again.
#[test]
fn after_a_stop_spindle_and_coolant_are_on_again() {
    assert_run(
        &lines("vmc", "[control]\ndialect = \"heidenhain\"\n", &[], UPRIGHT),
        &["M0", "M3", "M8"],
    );
    assert_run(
        &lines("vmc", "[control]\ndialect = \"fanuc\"\n", &[], UPRIGHT),
        &["M0", "S2000 M3", "M8"],
    );
    // LinuxCNC leaves both as they are.
    let lines = lines("vmc", "[control]\ndialect = \"linuxcnc\"\n", &[], UPRIGHT);
    let stop = lines.iter().position(|line| line == "M0").unwrap();
    assert!(lines[stop + 1].starts_with('X'), "{}", lines[stop + 1]);
}

/// Behind a stop off the part nothing turns until the next cut: not for a tool change, nor before it turns the other way.
#[test]
fn after_a_stop_nothing_turns_before_the_next_cut() {
    let stopped = |behind: &str| {
        let cl = UPRIGHT.replace("STOP\n", "");
        cl.replace("LOADTL/2\nSPINDL/RPM,2000,CLW\n", &format!("STOP\n{behind}"))
    };
    for (dialect, change) in [("fanuc", "T2 M6"), ("heidenhain", "TOOL CALL 2 Z S2000")] {
        let more = format!("[control]\ndialect = \"{dialect}\"\n");
        let changed = lines("vmc", &more, &[], &stopped("LOADTL/2\nSPINDL/RPM,2000,CLW\n"));
        let stop = changed.iter().position(|line| line == "M0").unwrap();
        let until = changed.iter().position(|line| line == change).unwrap();
        let between = &changed[stop..until];
        let turns = |line: &String| line.contains("M3") || line == "M8";
        assert!(!between.iter().any(turns), "{dialect}: {between:?}");
    }
    let fanuc = "[control]\ndialect = \"fanuc\"\n";
    let reversed = lines("vmc", fanuc, &[], &stopped("SPINDL/RPM,500,CCLW\n"));
    assert_run(&reversed, &["M0", "S500 M4", "X-20.000"]);
    // The next cut is a way down.
    let goes_on = lines("vmc", fanuc, &[], &stopped(""));
    assert_run(&goes_on, &["M0", "X-20.000", "S3000 M3", "M8"]);
}

#[test]
fn coolant_rests_in_a_tool_change_and_each_kind_has_its_end() {
    let through = UPRIGHT.replace("COOLNT/FLOOD", "COOLNT/THRU");
    let more = "[control.fanuc]\ncoolant_through = \"M88\"\ncoolant_through_off = \"M89\"\n";
    let lines = lines("vmc", more, &[], &through);
    assert_run(&lines, &["G49", "M5", "M89", "T2 M6", "S2000 M3", "M88"]);
    assert_run(&lines, &["G49", "M5", "M89", "M30"]);
    assert!(!lines.contains(&"M9".to_owned()));
    let more = "[control]\ndialect = \"heidenhain\"\n[control.heidenhain]\ncoolant_through = \"M88\"\ncoolant_through_off = \"M89\"\n";
    let lines = self::lines("vmc", more, &[], &through);
    assert_run(&lines, &["M5", "M89", "TOOL CALL 2 Z S2000"]);
    assert_run(&lines, &["M5", "M89", "M30"]);
}

/// A spiral of ten turns.
#[test]
fn an_axis_is_not_left_wound_in_silence() {
    let mut cl = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/ 50, 0, 60, 0.5, 0, 0.8660254\nFEDRAT/600,MMPM\n".to_owned();
    for step in 0..=120 {
        let (sine, cosine) = libm::sincos(f64::from(step) * std::f64::consts::FRAC_PI_6);
        cl += &format!(
            "GOTO/ {:.6}, {:.6}, {:.4}, {:.7}, {:.7}, 0.8660254\n",
            50.0 * cosine,
            50.0 * sine,
            40.0 - 0.1 * f64::from(step),
            0.5 * cosine,
            0.5 * sine
        );
    }
    cl += "RAPID\nGOTO/ 80, 0, 80\nEND\nFINI\n";
    let wound = post("ac-trunnion", "", &[], &cl);
    assert_eq!(wound.code, 0, "{}", wound.err);
    assert!(wound.err.contains("warning[unwinding]: at the end C stands at"), "{}", wound.err);
    let parked = post("ac-trunnion", "[control]\npark = { C = 0 }\n", &[], &cl);
    assert_eq!(parked.code, 0, "{}", parked.err);
    assert!(parked.err.contains("turns back from"), "{}", parked.err);
    let lines: Vec<&str> = parked.out.lines().collect();
    let at = lines.iter().position(|line| *line == "G53 G0 C0.000").unwrap();
    assert!(lines[..at].iter().rposition(|line| line.starts_with("G53 G0 Z")).unwrap() + 4 >= at);
}

/// A control with a ceiling for F under G93 has no block above it.
#[test]
fn blocks_by_time_end_where_the_control_does() {
    let cl = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/3000,MMPM\n\
              GOTO/0,0,10,0,0,1\nGOTO/0.01,0,10,0.0001745,0,1\nGOTO/20,0,10,0.01,0,1\nRAPID\nGOTO/20,0,50,0.01,0,1\nEND\nFINI\n";
    let feeds = |more: &str| -> Vec<f64> {
        let lines = lines("ac-trunnion", more, &["--mount", "0,0,60"], cl);
        let timed = lines.iter().skip_while(|line| !line.starts_with("G93"));
        let words = timed.filter_map(|line| line.rsplit(' ').next()?.strip_prefix('F'));
        words.map(|word| word.parse().unwrap()).collect()
    };
    let open = feeds("[control.fanuc]\nmost_inverse_time = 0\n");
    assert!(open.iter().any(|feed| *feed > 12_000.0), "{open:?}");
    let closed = feeds("");
    assert!(closed.iter().all(|feed| *feed <= 9999.999), "{closed:?}");
    assert_eq!(open.len(), closed.len());
}

/// What a line of the user's own says of work offsets holds; what turned and flowed before it does so behind a stop.
#[test]
fn lines_of_the_users_own_are_not_undone() {
    let own = UPRIGHT.replacen("RAPID\nGOTO/ 20", "INSERT/G55\nRAPID\nGOTO/ 20", 1);
    let lines =
        lines("vmc", "[control]\ninsert = \"literal\"\n", &[], &own.replace("INSERT/", "INSERT "));
    assert!(lines.contains(&"G55".to_owned()) && !lines.contains(&"G54".to_owned()), "{lines:#?}");
    let own = UPRIGHT.replace("STOP\n", "INSERT G05.1 Q1\nSTOP\n");
    for (dialect, again) in
        [("fanuc", &["M0", "S2000 M3", "M8"]), ("heidenhain", &["M0", "M3", "M8"])]
    {
        let more = format!("[control]\ninsert = \"literal\"\ndialect = {dialect:?}\n");
        assert_run(&self::lines("vmc", &more, &[], &own), again);
    }
    // G91 of an own retract does not stay.
    let more = "[control.fanuc]\nretract = \"G91 G28 Z0.\"\n";
    assert_run(
        &self::lines("vmc", more, &[], UPRIGHT),
        &["G91 G28 Z0.", "G90", "G49", "G69", "T1 M6"],
    );
}

/// The depth goes first, whatever else the retract names.
#[test]
fn a_retract_goes_up_before_it_goes_aside() {
    let more = "[control]\nretract = { X = 300 }\n";
    assert_run(
        &lines("vmc", more, &[], UPRIGHT),
        &["G53 G0 Z20.000", "G49", "G69", "G53 G0 X300.000", "T1 M6"],
    );
    let more = "[control]\nretract = { X = 300, Z = -10 }\n";
    assert_run(
        &lines("vmc", more, &[], UPRIGHT),
        &["G53 G0 Z-10.000", "G49", "G69", "G53 G0 X300.000", "T1 M6"],
    );
    // A quill comes in with the axis beside it.
    let lines = lines("quill-mill", "[control]\nretract = { Z = 0 }\n", &[], UPRIGHT);
    assert!(lines.iter().any(|line| line.starts_with("G53 G0 Z0.000 W")), "{lines:#?}");
}

/// A change position that is low, or a line that nobody can judge: the tool goes up again before it goes across.
#[test]
fn the_tool_goes_up_again_behind_what_may_have_lowered_it() {
    let more = "[control]\nchange = { X = 300, Z = -200 }\n";
    let lines = lines("vmc", more, &[], UPRIGHT);
    assert_run(
        &lines,
        &[
            "G53 G0 X300.000",
            "G53 G0 Z-200.000",
            "T2 M6",
            "S2000 M3",
            "G53 G0 Z20.000",
            "M8",
            "G54",
        ],
    );
}

/// A head that leans comes across in machine coordinates where TCP comes with the last block: its length is needed.
#[test]
fn a_way_that_depends_on_the_length_needs_it() {
    let leaning = leaning(30.0);
    let mut with = command();
    with.args(["-q", "-m", "head-head", "--tcp", "post", "-o", "-", "-"]);
    let done = run(&mut with, leaning.as_bytes());
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("error[tool-length]"), "{}", done.err);
    // Where the control keeps the tip, no word of the approach depends on it.
    for machine in ["head-head", "gantry"] {
        with = command();
        with.args(["-q", "-m", machine, "--tcp", "control", "-o", "-", "-"]);
        let done = run(&mut with, leaning.as_bytes());
        assert_eq!(done.code, 0, "{}", done.err);
    }
}

/// Where the control keeps the tip no linear axis is placed in machine coordinates: the way leads to a point above the
/// first one, below the end of travel, and down by the depth axis alone.
#[test]
fn the_first_position_is_come_to_from_above_under_the_control_s_own_frame() {
    let tilted = leaning(20.0);
    for (machine, dialect) in [
        ("bc-trunnion", "fanuc"),
        ("bc-trunnion", "haas"),
        ("bc-trunnion", "mazak"),
        ("bc-trunnion", "mitsubishi"),
        ("bc-trunnion", "heidenhain"),
        ("bc-trunnion", "siemens"),
        ("nutating-head-45", "fanuc"),
        ("nutating-head-45", "mazak"),
        ("head-table-bc", "haas"),
    ] {
        let control = format!("[control]\ndialect = {dialect:?}\ntcp = \"control\"\n");
        let lines = lines(machine, &control, &[], &tilted);
        let placed = |line: &&String| {
            let machine = ["G53 ", "SUPA", "M91"].iter().any(|word| line.contains(word));
            machine && line.split(' ').any(|word| word.starts_with(['X', 'Y']))
        };
        let found = lines.iter().find(placed);
        assert_eq!(found, None, "{machine} {dialect}");
    }
}

/// A head's work offset is the one that was measured with it.
#[test]
fn swapped_heads_have_an_offset_each() {
    let cl = "UNITS/MM\nMULTAX/ON\nHEAD/STRAIGHT\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/ 0,0,50,0,0,1\nFEDRAT/600,MMPM\nGOTO/ 0,0,15,0,0,1\n\
              RAPID\nGOTO/ 0,0,50,0,0,1\nHEAD/ANGLE\nLOADTL/2\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/ -80,0,20,-1,0,0\nFEDRAT/600,MMPM\nGOTO/ -50,0,20,-1,0,0\n\
              RAPID\nGOTO/ -80,0,20,-1,0,0\nEND\nFINI\n";
    let program = lines("head-change", "", &[], cl);
    let at = |word: &str| program.iter().position(|line| line == word);
    let [first, swapped, second] = ["G54", "M62", "G55"].map(at);
    assert!(first < swapped && swapped < second, "{}", program.join("\n"));
    // Without one the tip would be elsewhere.
    let file = fs::read_to_string(crate::common::root().join("machines/head-change.toml")).unwrap();
    let shared: String = file
        .lines()
        .filter(|line| !line.starts_with("offset"))
        .map(|line| format!("{line}\n"))
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shared.toml");
    fs::write(&path, shared).unwrap();
    let mut with = command();
    with.args(["-q", "-m", path.to_str().unwrap(), "--tool-length", "100", "-o", "-", "-"]);
    let done = run(&mut with, cl.as_bytes());
    assert_eq!(done.code, 1, "{}", done.out);
    assert!(done.err.contains("error[work-offset]: head ANGLE"), "{}", done.err);
}

/// Where the zero of the machine is the builder's own, or a switch, the end of travel is no retract.
#[test]
fn a_retract_is_said_where_the_control_s_zero_is_not_known_to_be_clear() {
    for dialect in ["okuma", "grbl"] {
        let system =
            if dialect == "okuma" { "[control.okuma]\nunit_system = \"1 mm\"\n" } else { "" };
        let control = format!("[control]\ndialect = {dialect:?}\n");
        let refused = post("vmc", &format!("{control}{system}"), &[], UPRIGHT);
        assert!(refused.err.contains("error[retract]: no retract is said"), "{}", refused.err);
        let said =
            lines("vmc", &format!("{control}retract = {{ Z = -3 }}\n{system}"), &[], UPRIGHT);
        assert!(said.iter().any(|line| line.ends_with("G0 Z-3.000")), "{}", said.join("\n"));
    }
}

/// An offset that turns with the part knows nothing of a head, and G49 may lower the axis.
#[test]
fn what_a_control_does_not_do_by_itself_is_not_left_to_it() {
    let planes = "[control]\ndialect = \"haas\"\ntcp = \"post\"\nplanes = true\n";
    let tilted = leaning(20.0);
    for (machine, written) in
        [("bc-trunnion", true), ("head-table-bc", false), ("head-head", false)]
    {
        let program = lines(machine, planes, &[], &tilted);
        assert_eq!(program.iter().any(|line| line.contains("G254")), written, "{machine}");
    }
    for dialect in ["mazak", "mitsubishi"] {
        let program = lines("vmc", &format!("[control]\ndialect = {dialect:?}\n"), &[], UPRIGHT);
        assert_run(&program, &["G53 G0 Z20.000", "G49", "G53 G0 Z20.000"]);
    }
    let hurco = post("bc-trunnion", "[control]\ndialect = \"hurco\"\n", &[], &tilted);
    assert_eq!(hurco.code, 1);
    assert!(hurco.err.contains("tcp_on"), "{}", hurco.err);
}
