//! What stands between two cuts: the way to another face of the part, and holes that begin in another direction.

use std::fs;

use crate::common::{Run, post, post_in};

/// Posts a CL file with these further arguments; the program, or what was said.
fn posted(cl: &str, more: &[&str]) -> (Run, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let [cl_file, nc] = ["part.cls", "part.nc"].map(path);
    fs::write(&cl_file, cl).unwrap();
    let run = post(&[&["-q", "--verify", "--tool-length=100", "-o", &nc, &cl_file], more].concat());
    let text = fs::read_to_string(&nc).unwrap_or_default();
    (run, text)
}

/// Two operations of one tool, the second from the side.
const SIDES: &str = "\
TOOL PATH/A,TOOL,T1
LOAD/TOOL,1,ADJUST,1
SPINDL/RPM,600,CLW
COOLNT/FLOOD
RAPID
GOTO/0,0,60,0,0,1
FEDRAT/MMPM,600
GOTO/0,0,20
GOTO/0,30,20
GOTO/0,0,60
END-OF-PATH
TOOL PATH/B,TOOL,T1
RAPID
GOTO/0,-100,10,0,-1,0
FEDRAT/MMPM,600
GOTO/0,-50,10
GOTO/0,-50,20
RAPID
GOTO/0,-100,10
END-OF-PATH
FINI
";

/// Under a kept tip the way from one side to the other would lead through the edge between them.
#[test]
fn the_tool_is_retracted_between_operations_on_two_sides() {
    for tcp in ["control", "post"] {
        let job = ["-m", "dmu50", "--set=control.planes=false", "--tcp", tcp];
        let (run, text) = posted(SIDES, &job);
        assert_eq!(run.code, 0, "{tcp}: {}", run.err);
        let second = text.split("* - B").nth(1).unwrap();
        let turn = second.find("B+90").unwrap();
        let retract = second.find("Z-100.000 R0 FMAX M91").unwrap();
        assert!(retract < turn, "{tcp}: {text}");
        // What runs stays on: it is the same tool.
        assert!(!second[..turn].contains("M5\n") && !second[..turn].contains("M9\n"), "{text}");
        // No farther apart than faces are: the way of the CAM system, if that turns the tool at all.
        let near = SIDES.replace("GOTO/0,-100,10,0,-1,0", "GOTO/0,-100,10,0,-0.5,0.8660254");
        let turns = near.replace("GOTO/0,30,20\n", "GOTO/0,30,20,0,-0.1,0.9949874\n");
        for (cl, retracted) in [(near, true), (turns, false)] {
            let (run, text) = posted(&cl, &job);
            assert_eq!(run.code, 0, "{tcp}: {}", run.err);
            let second = text.split("* - B").nth(1).unwrap();
            let before = second.find("M91").unwrap() < second.find("B+30").unwrap();
            assert_eq!(before, retracted, "{text}");
        }
    }
}

/// Behind an operation whose tool axis stands the tool is retracted before it comes to another axis, however near; behind one
/// that turns it the way is that of the CAM system up to 45°.
#[test]
fn the_tool_is_retracted_between_two_orientations() {
    let folder = tempfile::tempdir().unwrap();
    let operation = |[from, to]: [f64; 2]| {
        let at = |x: f64, out: f64, angle: f64| {
            let (sine, cosine) = libm::sincos(angle.to_radians());
            let (y, z) = (0.0, 40.0 + out * cosine);
            format!("GOTO/{:.4},{y},{z:.4},{sine:.7},0,{cosine:.7}\n", x + out * sine)
        };
        format!(
            "TOOL PATH/A,TOOL,M\nTLDATA/MILL,10,0,100,0,0\nLOAD/TOOL,3\nSPINDL/RPM,6000,CLW\nRAPID\n{}\
             RAPID\n{}FEDRAT/MMPM,800\n{}RAPID\n{}END-OF-PATH\n",
            at(-40.0, 30.0, from),
            at(-40.0, 2.0, from),
            at(40.0, 2.0, to),
            at(40.0, 30.0, to)
        )
    };
    for (first, second, retracted) in [
        ([0.0, 0.0], [0.0, 0.0], 2),
        ([0.0, 0.0], [1.0, 1.0], 3),
        ([0.0, 0.0], [35.0, 35.0], 3),
        ([20.0, 20.0], [20.0, 40.0], 2),
        ([10.0, 0.0], [35.0, 35.0], 2),
        ([10.0, 0.0], [50.0, 50.0], 3),
    ] {
        fs::write(folder.path().join("a.cls"), operation(first) + &operation(second)).unwrap();
        let words = ["-m", "xyzbc-trt", "a.cls", "-o", "a.ngc", "-q", "--verify"];
        let more = ["--tool-length", "40", "--mount", "0,0,-80"];
        let run = post_in(folder.path(), &[&words[..], &more].concat());
        assert_eq!(run.code, 0, "{}", run.err);
        let program = fs::read_to_string(folder.path().join("a.ngc")).unwrap();
        let found = program.matches("G53 G0 Z").count();
        assert_eq!(found, retracted, "{first:?} {second:?}: {program}");
    }
}

/// The first hole of each direction is the control's cycle like those behind it, a thread among them.
#[test]
fn a_cycle_goes_on_in_another_direction() {
    let holes = |cycle: &str| {
        format!(
            "TOOL PATH/A,TOOL,T1\nLOAD/TOOL,1,ADJUST,1\nSPINDL/RPM,600,CLW\nRAPID\n{cycle}\nGOTO/0,0,0,0,0,1\nGOTO/20,0,0,0,0,1\n\
             GOTO/0,-50,-20,0,-1,0\nGOTO/20,-50,-20,0,-1,0\nGOTO/50,0,-20,1,0,0\nCYCLE/OFF\nRAPID\nGOTO/100,0,60\nEND-OF-PATH\nFINI\n"
        )
    };
    let drill = holes("CYCLE/DRILL,RAPTO,3,FEDTO,-12,MMPM,120,RTRCTO,20");
    let tap = holes("CYCLE/TAP,RAPTO,3,FEDTO,-12,MMPM,600,RTRCTO,20");
    for (dialect, drills, taps) in [("fanuc", "G81", "G84"), ("heidenhain", "M99", "M99")] {
        for (cl, word, count) in [(&drill, drills, 3), (&tap, taps, 3)] {
            let job = ["-m", "ac-trunnion", "--dialect", dialect, "--tcp", "control"];
            let (run, text) = posted(cl, &job);
            assert_eq!(run.code, 0, "{dialect}: {}", run.err);
            let count = if dialect == "heidenhain" { 5 } else { count };
            assert_eq!(text.matches(word).count(), count, "{text}");
            assert!(!text.contains("G1 ") && !text.contains(" F120\n"), "{text}");
        }
    }
}

/// Facts of templates at the beginning of an operation: the tool that comes with it, and its feed whatever F counts.
#[test]
fn an_operation_is_told_its_tool_and_its_feed() {
    let folder = tempfile::tempdir().unwrap();
    let machine = folder.path().join("own.toml");
    fs::write(
        &machine,
        "extends = \"ac-trunnion\"\n[program]\nbefore_operation = \"(OP {{operation.number}} T{{tool.number}} F{{operation.feed|fixed(1)}})\"\n",
    )
    .unwrap();
    let machine = machine.to_str().unwrap();
    let cl = "TOOL PATH/A,TOOL,T1\nLOAD/TOOL,1,ADJUST,1\nSPINDL/RPM,600,CLW\nRAPID\nGOTO/0,0,60,0,0,1\nFEDRAT/MMPM,600\nGOTO/0,0,40,0,0,1\nGOTO/0,20,40,0,0.1,0.994987\nRAPID\nGOTO/0,20,60\nEND-OF-PATH\nTOOL PATH/B,TOOL,T2\nLOAD/TOOL,2,ADJUST,2\nSPINDL/RPM,600,CLW\nRAPID\nGOTO/0,0,60,0,0,1\nFEDRAT/MMPM,300\nGOTO/0,0,40\nGOTO/0,20,40\nRAPID\nGOTO/0,20,60\nEND-OF-PATH\nFINI\n";
    let (run, text) =
        posted(cl, &["-m", machine, "--tcp", "post", "--set=control.feed=inverse-time"]);
    assert_eq!(run.code, 0, "{}", run.err);
    for told in ["(OP 1 T1 F600.0)", "(OP 2 T2 F300.0)"] {
        assert!(text.contains(told), "{told}: {text}");
    }
}

/// Three rotary axes, of which only two point the tool: what the slides do under a kept tip is bounded for them too. At A-90
/// the slides of the table and of the head lie along each other, and go to their ends and beyond.
#[test]
fn slides_that_come_to_lie_in_one_plane_between_the_words_are_told() {
    let machine = "name = \"planer\"\nchain = \"[w Y' A' b Z X C B (S) t]\"\n\
        workpiece = { mount = [0, 0, 0] }\ntool = { gauge = [0, 0, 341] }\n\
        axis.Y = { linear = [0, 1, 0], travel = [-1000, 1000] }\n\
        axis.A = { rotary = [1, 0, 0], point = [0, 0, 0], travel = [-400, 400] }\n\
        axis.Z = { linear = [0, 0, 1], travel = [-1000, 1000] }\n\
        axis.X = { linear = [1, 0, 0], travel = [-1000, 1000] }\n\
        axis.C = { rotary = [0, 0, 1], point = [0, 0, 493], travel = [-400, 400] }\n\
        axis.B = { rotary = [0, 1, 0], point = [0, 0, 419], travel = [-400, 400], reversed = true }\n\
        control = { leave = { along = \"tool\", distance = 40.0 }, dialect = \"fanuc\", tcp = \"control\" }\n\
        accuracy = { tolerance = 0.005 }\n";
    let cl = "LOADTL/1\nSPINDL/5000,CLW\nFEDRAT/800,MMPM\n\
        GOTO/-41.254754140,-13.025890880,-4.003166520,0.573954443,0.711404006,-0.405562126\n\
        GOTO/-15.763069000,12.109624000,9.448606000,0.253667246,0.932692494,0.256393527\nFINI\n";
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("m.toml", machine), ("p.cls", cl)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let run = post_in(folder.path(), &["-q", "-m", "m.toml", "p.cls", "--tool-length=121.15"]);
    assert_eq!(run.code, 1, "{}", run.err);
    let told = "between the words the linear axes of planer cannot keep the tip on its line";
    assert!(run.err.contains("error[out-of-reach]") && run.err.contains(told), "{}", run.err);
    // A program of somebody else's that asks for it.
    let program = "%\nO1\nG21 G17 G40 G80 G90 G94\nG49\nT1 M6\nS5000 M3\nG54\nG0 A-93.656 B-26.667 C3.046\n\
        G43.4 H1 X-28.509 Y-0.458 Z2.723\nG1 X-25.322 Y2.684 Z4.404 A-88.565 B-23.916 C2.616 F800.\nM30\n%\n";
    fs::write(folder.path().join("p.nc"), program).unwrap();
    let words = ["verify", "p.nc", "-m", "m.toml", "--against", "p.cls", "--tool-length=121.15"];
    let run = post_in(folder.path(), &words);
    let told = "between the words the linear axes come to lie in one plane";
    assert!(run.err.contains("error[out-of-reach]") && run.err.contains(told), "{}", run.err);
}
