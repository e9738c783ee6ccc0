//! The axis along which the control puts a tool's length is that along which the tool lies, or there is no program.

use std::fs;
use std::path::Path;

use crate::common::{Run, command, post_in, run};

/// A cut with the tool along `axis`, from 50 mm above.
fn cut(axis: &str) -> String {
    format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,10,50,{axis}\nFEDRAT/600,MMPM\n\
         GOTO/20,10,15,{axis}\nGOTO/30,10,15,{axis}\nRAPID\nGOTO/20,10,50,{axis}\nEND\nFINI\n"
    )
}

/// A machine whose tool lies along Y, on a control.
fn lying(dialect: &str, more: &str) -> String {
    format!(
        "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n[tool]\naxis = [0, 1, 0]\ngauge = [0, 100, 0]\n{more}\n\
         [control]\ndialect = \"{dialect}\"\ntcp = \"post\"\n"
    )
}

/// Posts `cl` on `machine`, and reads the program against it.
fn both(folder: &Path, machine: &str, cl: &str, arguments: &[&str]) -> (Run, String, Option<Run>) {
    fs::write(folder.join("m.toml"), machine).unwrap();
    fs::write(folder.join("part.cls"), cl).unwrap();
    let program = folder.join("part.nc");
    let _ = fs::remove_file(&program);
    let mut post = command();
    post.current_dir(folder)
        .args(["-q", "-m", "m.toml", "-o", "part.nc", "part.cls"])
        .args(arguments);
    let made = run(&mut post, b"");
    let Ok(text) = fs::read_to_string(&program) else {
        return (made, String::new(), None);
    };
    let verified = read_back(folder, arguments);
    (made, text, Some(verified))
}

/// `part.nc` read against the job.
fn read_back(folder: &Path, arguments: &[&str]) -> Run {
    let job = ["--machine", "m.toml", "--against", "part.cls"];
    let mut verify = command();
    verify.current_dir(folder).args(["verify", "part.nc"]);
    run(verify.args(job).args(arguments), b"")
}

/// The program, which `verify` finds good.
#[track_caller]
fn good(machine: &str, cl: &str, arguments: &[&str]) -> (Run, String) {
    let folder = tempfile::tempdir().unwrap();
    let (made, text, verified) = both(folder.path(), machine, cl, arguments);
    assert_eq!(made.code, 0, "{}", made.err);
    let verified = verified.unwrap();
    assert_eq!(verified.code, 0, "{text}\n{}", verified.err);
    (made, text)
}

/// What is said of a job that has no program.
#[track_caller]
fn refused(machine: &str, cl: &str, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (made, text, _) = both(folder.path(), machine, cl, arguments);
    assert_eq!(made.code, 1, "{text}");
    assert!(made.err.contains("error[length-axis]"), "{}", made.err);
    made.err
}

const LONG: [&str; 2] = ["--tool-length", "100"];

#[test]
fn controls_that_turn_the_plane_put_the_length_along_the_tool() {
    let (_, siemens) = good(&lying("siemens", ""), &cut("0,1,0"), &LONG);
    let plane = siemens.find("G18\n").expect(&siemens);
    assert!(siemens.find(" D1\n").unwrap() > plane, "{siemens}");
    let (_, tnc) = good(&lying("heidenhain", ""), &cut("0,1,0"), &LONG);
    assert!(tnc.contains("TOOL CALL 1 Y S3000"), "{tnc}");
    // Nothing is put on: it is in the work offset.
    let retract = ["--tool-length", "100", "--set", "control.retract={Y=250}"];
    good(&lying("grbl", ""), &cut("0,1,0"), &retract);
}

#[test]
fn others_have_no_program_for_a_tool_that_lies_down_unless_the_machine_file_answers_for_it() {
    for dialect in ["fanuc", "haas", "linuxcnc", "mazak", "mitsubishi", "hurco"] {
        // Whether the length is known or not: the control has one.
        for length in [&LONG[..], &[]] {
            let said = refused(&lying(dialect, ""), &cut("0,1,0"), length);
            assert!(said.contains("lies along Y where the rotary axes show 0"), "{said}");
            assert!(said.contains("[tool] length_axis = \"Y\""), "{said}");
        }
        let (made, text) = good(&lying(dialect, "length_axis = \"Y\""), &cut("0,1,0"), &LONG);
        assert!(text.contains("G43 H1 Y10."), "{text}");
        assert!(!made.err.contains("length-axis"), "{}", made.err);
    }
    let wrong = refused_key("length_axis = \"Q\"");
    assert!(wrong.contains("the machine has no linear axis Q"), "{wrong}");
}

fn refused_key(more: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (made, ..) = both(folder.path(), &lying("fanuc", more), &cut("0,1,0"), &LONG);
    assert_eq!(made.code, 1);
    made.err
}

/// The words count with the length along Z, and G43 would stand in a block of X.
#[test]
fn a_tool_that_is_drawn_at_another_angle_than_zero_is_refused() {
    let machine =
        "extends = \"mill-turn\"\n[workpiece]\nmount = [100, 0, 0]\n[control]\ntcp = \"post\"\n";
    let said = refused(machine, &cut("0,1,0"), &LONG);
    assert!(said.contains("in a block of X"), "{said}");
}

#[test]
fn a_tool_that_leans_is_measured_in_the_spindle() {
    let machine = |more: &str| {
        format!(
            "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n[tool]\naxis = [0.6, 0, 0.8]\n{more}\n[control]\ntcp = \"post\"\n"
        )
    };
    refused(&machine(""), &cut("0.6,0,0.8"), &LONG);
    let none = machine("length_axis = \"none\"");
    let (made, _) = good(&none, &cut("0.6,0,0.8"), &LONG);
    assert!(made.err.contains("warning[length-axis]: the control must have 0"), "{}", made.err);
    // One work offset is measured with one tool.
    let two = cut("0.6,0,0.8").replace("END\n", "LOADTL/2\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,10,50\nFEDRAT/600,MMPM\nGOTO/20,20,15\nEND\n");
    let said = refused(&format!("{none}[tools]\n1 = 100\n2 = 120\n"), &two, &[]);
    assert!(said.contains("a tool of 120 mm, and one of 100 mm before"), "{said}");
    let own = two.replace("LOADTL/2\n", "SET/OFSETL,2\nLOADTL/2\n");
    let folder = tempfile::tempdir().unwrap();
    let (made, ..) = both(folder.path(), &format!("{none}[tools]\n1 = 100\n2 = 120\n"), &own, &[]);
    assert_eq!(made.code, 0, "{}", made.err);
}

/// A cut with the straight head, and one with the other, whose tool has another length.
fn swapped(head: &str) -> String {
    format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,10,50,0,0,1\nFEDRAT/600,MMPM\n\
         GOTO/20,10,15\nRAPID\nGOTO/20,10,50\nHEAD/{head}\nLOADTL/2\nSPINDL/RPM,3000,CLW\nRAPID\n\
         GOTO/120,10,10,1,0,0\nFEDRAT/600,MMPM\nGOTO/30,10,10\nRAPID\nGOTO/120,10,10\nEND\nFINI\n"
    )
}

const HEADS: &str = "extends = \"head-change\"\n[tools]\n1 = 100\n2 = 200\n";

/// The tool comes behind its head, and its length from the machine file.
#[test]
fn a_head_whose_tool_lies_across_the_compensated_axis_answers_for_it_or_is_refused() {
    let side = "[head.SIDE]\nword = \"M63\"\noffset = 2\n[head.SIDE.tool]\ngauge = [180, 0, 1050]\naxis = [-1, 0, 0]\n";
    let said = refused(&format!("{HEADS}{side}"), &swapped("SIDE"), &[]);
    assert!(said.contains("the tool of head SIDE lies along"), "{said}");
    good(&format!("{HEADS}{side}length_axis = \"none\"\n"), &swapped("SIDE"), &[]);
    let (made, text) = good(HEADS, &swapped("ANGLE"), &[]);
    assert!(made.err.contains("the words count with 200 mm of it"), "{}", made.err);
    assert!(text.contains("M62"), "{text}");
    // Who sets the machine up is told what to enter.
    let folder = tempfile::tempdir().unwrap();
    let sheet = ["--setup-sheet", "sheet.md"];
    both(folder.path(), HEADS, &swapped("ANGLE"), &sheet);
    let sheet = fs::read_to_string(folder.path().join("sheet.md")).unwrap();
    assert!(
        sheet.contains("Length registers with head ANGLE")
            && sheet.contains("| 0, not the length below"),
        "{sheet}"
    );
    // The control has one length of a tool.
    let same = swapped("ANGLE").replace("LOADTL/2\n", "");
    let said = refused(HEADS, &same, &[]);
    assert!(said.contains("the length of tool 1 with one head"), "{said}");
}

/// The stop at which the operator swaps it is none that the CL file asks for.
#[test]
fn a_head_that_the_operator_swaps_is_read_back() {
    let side = "[head.SIDE]\noffset = 2\n[head.SIDE.tool]\ngauge = [180, 0, 1050]\naxis = [-1, 0, 0]\nlength_axis = \"none\"\n";
    let (_, text) = good(&format!("{HEADS}{side}"), &swapped("SIDE"), &[]);
    assert!(text.contains("(CHANGE TO HEAD SIDE)\nM0\n"), "{text}");
}

/// Its words have the whole tool in them, and G43 shifts none of them.
#[test]
fn an_arm_is_read_back_from_its_first_position_on() {
    let arm = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/chains/six-axis-arm.toml");
    let machine = format!("extends = {arm:?}\n");
    let cl = cut("0,0,1").replace(",10,50,", ",10,40,");
    good(&machine, &cl, &LONG);
}

/// Two tools; between the second and its speed the next is made ready.
const TWO: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,15000,CLW\nRAPID\nGOTO/20,10,50\nFEDRAT/600,MMPM\nGOTO/20,10,15\nRAPID\n\
    GOTO/20,10,50\nLOADTL/2\nSELECT/TOOL,3\nSPINDL/RPM,800,CLW\nRAPID\nGOTO/-20,10,50\nFEDRAT/600,MMPM\nGOTO/-20,10,15\n\
    RAPID\nGOTO/-20,10,50\nEND\nFINI\n";

#[test]
fn a_tool_of_its_own_program_begins_with_its_own_speed() {
    for dialect in ["fanuc", "siemens", "heidenhain", "haas", "linuxcnc", "mazak"] {
        let folder = tempfile::tempdir().unwrap();
        let machine = format!(
            "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n[control]\ndialect = \"{dialect}\"\n"
        );
        fs::write(folder.path().join("m.toml"), machine).unwrap();
        fs::write(folder.path().join("part.cls"), TWO).unwrap();
        let mut split = command();
        split.current_dir(folder.path()).args([
            "-q",
            "-m",
            "m.toml",
            "--split",
            "tools",
            "--tool-length",
            "100",
            "-o",
            "part.nc",
            "part.cls",
        ]);
        let made = run(&mut split, b"");
        assert_eq!(made.code, 0, "{}", made.err);
        let second = fs::read_dir(folder.path()).unwrap().find_map(|entry| {
            let text = fs::read_to_string(entry.unwrap().path()).unwrap();
            (text.contains("S800") && !text.contains("SPINDL")).then_some(text)
        });
        let second = second.unwrap();
        assert!(!second.contains("S15000"), "{dialect}: {second}");
    }
}

#[test]
fn a_spindle_with_the_speed_of_the_tool_before_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n";
    let (made, text, verified) = both(folder.path(), machine, TWO, &LONG);
    assert_eq!((made.code, verified.unwrap().code), (0, 0), "{}", made.err);
    let wrong = text.replace("S800 M3\n", "S15000 M3\nS800 M3\n");
    assert_ne!(wrong, text);
    fs::write(folder.path().join("part.nc"), wrong).unwrap();
    let found = read_back(folder.path(), &LONG);
    assert_eq!(found.code, 1);
    assert!(
        found.err.contains(
            "error[spindle]: the spindle turns clockwise at 15000/min with this tool before it cuts"
        ),
        "{}",
        found.err
    );
}

/// The linear words of a block.
fn linear(block: &str) -> Vec<char> {
    let first = |word: &str| word.chars().next().filter(|letter| "XYZ".contains(*letter));
    block.split_whitespace().filter_map(first).collect()
}

/// The mill-turn's depth is X, and with B at 0 its tool lies along Z: nothing comes in along X while Z is short of the
/// tool's length, up where the tool is retracted.
#[test]
fn the_length_stands_before_another_axis_brings_the_tool_in() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nRAPID\nGOTO/0,0,150,0,0,1\nRAPID\nGOTO/0,0,82\n\
              FEDRAT/200,MMPM\nGOTO/0,0,75\nGOTO/20,0,75\nRAPID\nGOTO/20,0,150\nFINI\n";
    for dialect in ["fanuc", "haas", "mazak", "mitsubishi", "linuxcnc"] {
        let machine = format!("extends = \"mill-turn\"\n[control]\ndialect = \"{dialect}\"\n");
        let (_, text) = good(&machine, cl, &["--tool-length", "120"]);
        let mut blocks =
            text.lines().skip_while(|block| !block.contains("G43") && !block.contains("G234"));
        // Where the length comes on X goes from 60 to 50 mm below the end of its travel.
        let first = blocks.find(|block| !linear(block).is_empty()).expect(&text);
        assert_eq!(linear(first), ['X', 'Y', 'Z'], "{text}");
        let x = first.split_whitespace().find_map(|word| word.strip_prefix('X'));
        assert_eq!(x.and_then(|x| x.parse().ok()), Some(610.0), "{text}");
        // Then X alone, outside, and in along the tool.
        let mut words = blocks.map(linear).filter(|words| !words.is_empty());
        assert_eq!(words.next(), Some(vec!['X']), "{text}");
        assert_eq!(words.next(), Some(vec!['Z']), "{text}");
    }
}

/// In a plane the depth is Z, whichever axis of the machine that is.
#[test]
fn a_tilted_plane_comes_near_by_its_own_z() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nRAPID\nGOTO/150,5,40,1,0,0\nRAPID\nGOTO/82,5,40\n\
              FEDRAT/200,MMPM\nGOTO/75,5,40\nGOTO/75,20,40\nRAPID\nGOTO/150,20,40\nFINI\n";
    for (dialect, plane) in
        [("fanuc", "G53.1"), ("mazak", "G53.1"), ("heidenhain", "PLANE SPATIAL")]
    {
        let machine =
            format!("extends = \"mill-turn\"\n[control]\ndialect = \"{dialect}\"\nplanes = true\n");
        let (_, text) = good(&machine, cl, &["--tool-length", "120"]);
        // Another such word switches planes off at the start.
        let behind = text.split("B90.").last().unwrap();
        let (_, behind) = behind.split_once(plane).expect(&text);
        let mut blocks = behind.lines().map(linear).filter(|words| !words.is_empty());
        assert_eq!(blocks.next(), Some(vec!['X', 'Y', 'Z']), "{text}");
        assert_eq!(blocks.next(), Some(vec!['Z']), "{text}");
    }
}

/// A trunnion whose tool lies along Y where its axes show 0.
fn lying_trunnion(dialect: &str, more: &str) -> String {
    format!(
        "extends = \"ac-trunnion\"\n[tool]\naxis = [0, 1, 0]\ngauge = [0, 100, 400]\n{more}\n\
         [control]\ndialect = \"{dialect}\"\ntcp = \"control\"\n"
    )
}

/// Their plane or tool call names the axis of the length, whoever keeps the tip.
#[test]
fn a_control_that_keeps_the_tip_is_not_told_another_axis_of_the_length() {
    for dialect in ["siemens", "heidenhain"] {
        let said = refused(&lying_trunnion(dialect, ""), &cut("0,1,0"), &LONG);
        assert!(said.contains("lies across Z where the rotary axes show 0"), "{said}");
        let answered = lying_trunnion(dialect, "length_axis = \"Y\"");
        good(&answered, &cut("0,1,0"), &LONG);
    }
    // Its parameters say how the tool lies.
    let no_planes = ["--set", "control.planes=false"];
    let arguments = [&LONG[..], &no_planes].concat();
    let (_, text) = good(&lying_trunnion("fanuc", ""), &cut("0,1,0"), &arguments);
    assert!(text.contains("G43.4 H1 Y"), "{text}");
    // Drawn along X, shown along Z.
    let mill_turn =
        "extends = \"mill-turn\"\n[workpiece]\nmount = [100, 0, 0]\n[control]\ndialect = ";
    let (_, tnc) = good(&format!("{mill_turn}\"heidenhain\"\n"), &cut("0,0,1"), &LONG);
    assert!(tnc.contains("TOOL CALL 1 Z S3000"), "{tnc}");
    good(&format!("{mill_turn}\"siemens\"\n"), &cut("0,0,1"), &LONG);
}

/// G43.4 turns a tool about the length and the direction that the control has of it.
#[test]
fn a_right_angle_head_under_tool_centre_point_control_is_answered_for_or_refused() {
    let kept = "[control]\ntcp = \"control\"\n";
    let said = refused(&format!("{HEADS}{kept}"), &swapped("ANGLE"), &[]);
    assert!(said.contains("the tool of head ANGLE lies otherwise than that of"), "{said}");
    let side = |more: &str| {
        format!(
            "{HEADS}[head.SIDE]\nword = \"M63\"\noffset = 2\n[head.SIDE.tool]\ngauge = [180, 0, 1050]\naxis = [-1, 0, 0]\n{more}\n{kept}"
        )
    };
    for dialect in ["fanuc", "haas", "mazak", "mitsubishi", "siemens", "heidenhain"] {
        let machine =
            |more: &str| side(more).replace(kept, &format!("{kept}dialect = \"{dialect}\"\n"));
        let said = refused(&machine(""), &swapped("SIDE"), &[]);
        assert!(said.contains("the tool of head SIDE"), "{said}");
        let (_, text) = good(&machine("length_axis = \"X\""), &swapped("SIDE"), &[]);
        assert!(text.contains("M63"), "{text}");
    }
}

/// Two tools; the second comes to its first position before its speed is said.
const LATE: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,15000,CLW\nCOOLNT/ON\nRAPID\nGOTO/20,10,50\nFEDRAT/600,MMPM\n\
    GOTO/20,10,15\nRAPID\nGOTO/20,10,50\nLOADTL/2\nRAPID\nGOTO/-20,10,50\nSPINDL/RPM,800,CLW\nFEDRAT/600,MMPM\n\
    GOTO/-20,10,15\nRAPID\nGOTO/-20,10,50\nEND\nFINI\n";

#[test]
fn a_tool_begins_with_its_own_speed_though_that_stands_behind_its_first_position() {
    for dialect in crate::dialects::dialects() {
        let machine = format!(
            "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n[control]\ndialect = \"{dialect}\"\n"
        );
        let named = [&LONG[..], crate::dialects::named(&dialect)].concat();
        let (made, text) = good(&machine, LATE, &named);
        assert!(!made.err.contains("no SPINDL"), "{}", made.err);
        assert_eq!(text.matches("15000").count(), 1, "{dialect}:\n{text}");
        let speed = text.find("S800").or_else(|| text.find("S+800")).expect(&text);
        // The coolant flows again with it, and the spindle turns before the tool goes down.
        let coolant = text.rfind("M8").expect(&text);
        let down = text.rfind("15.").expect(&text);
        assert!(speed < down && coolant < down, "{dialect}:\n{text}");
        // A tool without a speed of its own turns as the one before, and that is told.
        let (made, text) = good(&machine, &LATE.replace("SPINDL/RPM,800,CLW\n", ""), &named);
        assert!(made.err.contains("no SPINDL since the tool change"), "{}", made.err);
        let again = text.rfind("15000").expect(&text);
        assert!(again < text.rfind("15.").expect(&text), "{dialect}:\n{text}");
    }
}

/// Where it is drilled, and where an arc comes first.
#[test]
fn a_spindle_that_waits_turns_before_whatever_cuts() {
    let tail = LATE.find("SPINDL/RPM,800").unwrap();
    let drilled = format!(
        "{}CYCLE/DRILL,10,MMPM,100,2\nGOTO/-20,10,15\nCYCLE/OFF\nRAPID\nGOTO/-20,10,50\nEND\nFINI\n",
        &LATE[..tail]
    );
    let (_, text) = good("extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n", &drilled, &LONG);
    let again = text.rfind("S15000 M3").expect(&text);
    assert!(again < text.find("G81").expect(&text), "{text}");
    let round = format!(
        "{}FEDRAT/600,MMPM\nCIRCLE/0,10,50,0,0,1,20\nGOTO/20,10,50\nEND\nFINI\n",
        &LATE[..tail]
    );
    let (_, text) = good("extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n", &round, &LONG);
    let again = text.rfind("S15000 M3").expect(&text);
    assert!(again < text.find("G3 ").expect(&text), "{text}");
}

/// At rapid into a slot, and where lines of the user's own run, the spindle of a tool without a speed of its own turns.
#[test]
fn a_spindle_that_waits_turns_before_the_tool_goes_in() {
    let tail = LATE.find("SPINDL/RPM,800").unwrap();
    let dive = format!(
        "{}RAPID\nGOTO/-20,10,40\nFEDRAT/600,MMPM\nGOTO/20,10,40\nRAPID\nGOTO/20,10,50\nEND\nFINI\n",
        &LATE[..tail]
    );
    let machine = "extends = \"vmc\"\n[workpiece]\nmount = [0, 0, -100]\n";
    let (_, text) = good(machine, &dive, &LONG);
    let again = text.rfind("S15000 M3").expect(&text);
    assert!(again < text.find("Z40.").expect(&text), "{text}");
    let called = format!("{}MYCYC\nEND\nFINI\n", &LATE[..tail]);
    let machine = format!("{machine}[cl.words]\nMYCYC = \"M98 P7000\"\n");
    let named = [&LONG[..], &["--allow", "MYCYC"]].concat();
    let folder = tempfile::tempdir().unwrap();
    let (made, text, _) = both(folder.path(), &machine, &called, &named);
    assert_eq!(made.code, 0, "{}", made.err);
    let again = text.rfind("S15000 M3").expect(&text);
    assert!(again < text.find("M98 P7000").expect(&text), "{text}");
}

/// Where the work offset has the length in it, it is measured after each change of the tool: words count with that which is
/// in the spindle, on a head too, where they hang on how long it is.
#[test]
fn a_length_in_the_work_offset_is_that_of_the_tool_in_the_spindle() {
    let machine = "extends = \"head-head\"\n[tools.1]\nlength = 174.8\n[tools.2]\nlength = 127.419\n\
         [control]\ndialect = \"grbl\"\ntcp = \"post\"\nretract = { Z = 400 }\n[control.grbl]\nhal = true\n";
    let operation = |tool: u32| {
        format!(
            "LOADTL/{tool}\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/10,0,60,0.3,0,0.9539392\nFEDRAT/300,MMPM\nGOTO/0,0,20\n\
             GOTO/10,5,20,0,0,1\nRAPID\nGOTO/10,5,80\n"
        )
    };
    let job = |tools: &[u32]| {
        let operations: String = tools.iter().map(|tool| operation(*tool)).collect();
        format!("UNITS/MM\nMULTAX/ON\n{operations}FINI\n")
    };
    let words = |tools: &[u32]| good(machine, &job(tools), &[]).1;
    let [one, two] = [&[1][..], &[2]].map(words);
    assert_ne!(one.replace("T1", "T"), two.replace("T2", "T"));
    words(&[2, 1]);
}

/// What keeps the tip, or turns a plane, takes the tool's direction from the plane of the tool too.
#[test]
fn a_plane_that_lays_the_tool_along_another_axis_is_refused_where_the_control_keeps_the_tip() {
    let folder = tempfile::tempdir().unwrap();
    for (machine, sample, [from, to]) in [
        ("dmu50", "blade.cls", ["TOOL CALL 3 Z", "TOOL CALL 3 Y"]),
        ("dmu50", "facets.apt", ["TOOL CALL 6 Z", "TOOL CALL 6 X"]),
        ("ac-trunnion-840d", "blade.cls", ["G17", "G18"]),
        ("ac-trunnion-840d", "facets.apt", ["G17", "G19"]),
    ] {
        let sample = crate::common::root().join(crate::common::sample(sample));
        let words = ["-q", "-m", machine, "--tool-length", "80", "-o", "part.nc"];
        let run = post_in(folder.path(), &[&words[..], &[sample.to_str().unwrap()]].concat());
        assert_eq!(run.code, 0, "{}", run.err);
        let path = folder.path().join("part.nc");
        let text = fs::read_to_string(&path).unwrap();
        for (changed, code) in [(text.clone(), 0), (text.replace(from, to), 1)] {
            assert!(code == 0 || changed != text, "{machine}: {text}");
            fs::write(&path, changed).unwrap();
            let words = ["verify", "part.nc", "-m", machine, "--tool-length", "80", "--against"];
            let run = post_in(folder.path(), &[&words[..], &[sample.to_str().unwrap()]].concat());
            assert_eq!(run.code, code, "{machine} {to}: {}", run.err);
            assert!(
                code == 0 || run.err.contains("the length of the tool comes on along"),
                "{}",
                run.err
            );
        }
    }
}
