//! What `post` writes silently `post verify` finds right, and what that would refuse is not written.

use std::fmt::Write as _;
use std::fs;

use crate::common::{Run, command, run};

/// The ways in which a program is read back: as one that was posted for the machine file, and as one of another hand.
const HANDS: [&[&str]; 2] = [&["--posted"], &[]];

/// A job: a machine, and a CL file of the machines' own.
struct Job<'j> {
    machine: &'j str,
    cl: &'j str,
    with: &'j [&'j str],
}

impl Job<'_> {
    /// Posts it: the program, or what is said in place of it.
    fn posted(&self) -> Result<String, String> {
        let mut post = command();
        post.args(["-q", "-m", self.machine, "-o", "-", self.cl]).args(self.with);
        let made = run(&mut post, b"");
        match made.code {
            0 => Ok(made.out),
            _ => Err(made.err),
        }
    }

    fn verified(&self, program: &str, hand: &[&str]) -> Run {
        let mut verify = command();
        verify.args(["verify", "-", "-m", self.machine, "--against", self.cl]);
        run(verify.args(self.with).args(hand), program.as_bytes())
    }

    /// Posts it, and reads it back as a program of either hand: both find it right.
    fn right(&self) -> String {
        let program = self.posted().unwrap();
        for hand in HANDS {
            let verified = self.verified(&program, hand);
            assert_eq!(verified.code, 0, "{} {hand:?}: {}", self.machine, verified.err);
        }
        program
    }
}

const LONG: &[&str] = &["--tool-length", "60"];

fn sample<'j>(machine: &'j str, cl: &'j str) -> Job<'j> {
    Job { machine, cl, with: LONG }
}

/// A CL file of this text, right on a machine.
fn right_text(machine: &str, text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.apt");
    fs::write(&file, text).unwrap();
    sample(machine, file.to_str().unwrap()).right()
}

/// Joints that go evenly would lead the tool beside the axis of a hole: rapids in it get points, as cuts do.
#[test]
fn a_robot_goes_in_and_out_of_a_hole_along_its_axis() {
    for (machine, cl) in [
        ("kr6-r700", "tests/machines/vmc.ncl"),
        ("kr6-r700", "tests/machines/lathe-xzc-face.cls"),
        ("irb4600-rail", "tests/samples/lever.apt"),
    ] {
        sample(machine, cl).right();
    }
}

/// Without those points the program is refused once, with how far and how deep.
#[test]
fn a_rapid_beside_the_axis_of_a_hole_is_told_once_with_its_distance() {
    let wide = ["--tool-length", "60", "--set", "accuracy.tolerance=0.5"];
    let cl = "tests/machines/vmc.ncl";
    let program = Job { machine: "kr6-r700", cl, with: &wide }.posted().unwrap();
    let verified = sample("kr6-r700", cl).verified(&program, &["--posted"]);
    assert_eq!(verified.code, 1, "{}", verified.err);
    let told: Vec<&str> =
        verified.err.lines().filter(|line| line.contains("leaves the axis of a hole")).collect();
    assert_eq!(told.len(), 1, "{}", verified.err);
    assert!(told[0].contains("by 0.") && told[0].contains("so in "), "{}", told[0]);
}

/// From a hole in one side of the part to one in the opposite side the tool is retracted, whoever keeps the tip.
#[test]
fn between_holes_in_two_faces_the_tool_is_retracted() {
    for (machine, cl) in [
        ("duoblock", "tests/machines/bc-trunnion.ncl"),
        ("head-table-bc", "tests/machines/head-table-bc.apt"),
    ] {
        sample(machine, cl).right();
    }
    // Drawn back at a feed of its own, towards the next hole.
    let with = &["--tool-length", "60", "--mount", "0,0,141"];
    Job { machine: "bc-fork", cl: "tests/machines/head-table-sr.apt", with }.right();
    let job = sample("bc-trunnion", "tests/machines/duoblock.apt");
    let program = job.right();
    // Straight through the part it is no right way, whoever wrote it.
    let retracted = "G0 Y200.000\nG53 G0 Z0.000\nG49\nG0 B90.000 C270.000\nG68.2 X0.000 Y0.000 Z0.000 I0.000 J90.000 K-90.000\n\
        G53.1\nG0 X-40.000 Y0.000\nG43 H1 Z200.000\nG98 G81 X-40.000 Y0.000 Z138.000 R152.000 F250.\nG80\n";
    let through = "G0 Y200.000\nY0.000 C0.000\nY-200.000 C270.000\nY-152.000\nG1 Y-138.000 F250.\nG0 Y-200.000\n";
    let other = program.replace(retracted, through).replace("G69\n", "");
    assert_ne!(other.len(), program.len(), "{program}");
    for hand in HANDS {
        let verified = job.verified(&other, hand);
        assert_eq!(verified.code, 1, "{other}");
        assert!(verified.err.contains("comes to 0.0 mm of what is cut"), "{}", verified.err);
    }
}

/// Behind an index move of the CL file no way is given: on a machine without that axis the tool is retracted as well.
#[test]
fn behind_an_index_move_the_tool_is_retracted() {
    for machine in ["head-head", "ab-trunnion", "kr6-r700"] {
        sample(machine, "tests/machines/disc-cutter.ncl").right();
    }
}

/// A level to which a cycle returns lies across the plane in force: behind an arc in another that is said first.
#[test]
fn a_cycle_behind_an_arc_in_another_plane_returns_along_z() {
    let with = &["--tool-length", "60", "--mount", "0,0,103"];
    let program = Job { machine: "osp-mill", cl: "tests/samples/link.aptsource", with }.right();
    assert!(program.contains("G17 G71 Z3.000\n"), "{program}");
}

/// A knife turns on its line as it leaves the part: it stands in no hole.
#[test]
fn a_knife_turns_on_its_line() {
    let with = &["--tool-length", "60", "--mount", "0,0,111"];
    Job { machine: "ultrasonic-knife", cl: "tests/machines/quill-mill.cls", with }.right();
}

/// Up its own axis a tool touches nothing that it has not cut on its way down, however near to an earlier cut.
#[test]
fn a_retract_beside_an_earlier_cut_is_right() {
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/6000,CLW\nRAPID\nGOTO/0,0,60\nRAPID\nGOTO/0,0,12\nFEDRAT/400,MMPM\nGOTO/0,0,10\n\
        GOTO/50,0,10\nGOTO/50,0.3,5\nGOTO/25,0.3,5\nRAPID\nGOTO/25,0.3,7\nLOADTL/2\nSPINDL/6000,CLW\nRAPID\nGOTO/0,20,60\n\
        RAPID\nGOTO/0,20,12\nFEDRAT/400,MMPM\nGOTO/0,20,10\nGOTO/50,20,10\nRAPID\nGOTO/50,20,60\nFINI\n";
    let program = right_text("vmc", text);
    // Aside and up, over the earlier cut, it is no such way.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.apt");
    fs::write(&file, text).unwrap();
    let job = sample("vmc", file.to_str().unwrap());
    let aside = program.replace("G0 Z7.000\n", "G0 Z7.000\nY-1.000 Z20.000\n");
    assert_ne!(aside, program);
    let verified = job.verified(&aside, &["--posted"]);
    assert!(verified.err.contains("of what is cut"), "{}", verified.err);
}

/// The first point of the file is where the retract stands: nothing is left to move there.
#[test]
fn a_first_point_at_the_retract_is_passed() {
    let program = sample("xyzac-trt", "tests/machines/linear-delta.cls").right();
    assert!(program.contains("G53 G0 Z120.0000"), "{program}");
}

/// A tool that no record names is the one in the spindle, and G43 without H calls its length.
#[test]
fn the_length_of_an_unnamed_tool_is_called() {
    let text = "UNITS/MM\nSPINDL/2000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/300,MMPM\nGOTO/0,0,10\nGOTO/20,0,10\nRAPID\n\
        GOTO/20,0,50\nFINI\n";
    let program = right_text("ultrasonic-knife", text);
    assert!(program.contains("G43 Z"), "{program}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.apt");
    fs::write(&file, text).unwrap();
    let job = sample("ultrasonic-knife", file.to_str().unwrap());
    let without = job.verified(&program.replace("G43 Z", "Z"), &["--posted"]);
    assert!(without.err.contains("without length compensation"), "{}", without.err);
}

/// At a pole a vector says nothing of the axis that turns there.
#[test]
fn a_turn_that_no_vector_says_is_refused() {
    for machine in ["exechon", "tricept"] {
        let refused = sample(machine, "tests/it/wrong_programs/heads.cls").posted().unwrap_err();
        assert!(refused.contains("error[jump]"), "{machine}: {refused}");
        assert!(refused.contains("heads.cls:43"), "{machine}: {refused}");
    }
}

/// Through a pole and on on its other side a table that tilts one way alone turns round: no vector says it on the pole, and
/// beside it the vectors lead it round. One that tilts both ways goes on.
#[test]
fn a_table_is_led_round_a_pole_by_vectors_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pole.cls");
    let with = [
        "--tool-length",
        "100",
        "--set",
        "control.tcp=control",
        "--set",
        "control.orientation=vector",
        "--set",
        "control.dialect=siemens",
    ];
    for (machine, beside, posted) in
        [("dmu50", 0.0, false), ("dmu50", 0.5, true), ("head-head", 0.0, true)]
    {
        let mut text = "LOAD/TOOL,1\nSPINDL/RPM,6000,CLW\nFEDRAT/500,MMPM\nMULTAX/ON\nRAPID\n\
            GOTO/-30,0,60,-0.4472136,0,0.8944272\n"
            .to_owned();
        for step in -10..=10 {
            let x = 3.0 * f64::from(step);
            let length = libm::sqrt(x * x + beside * beside + 3600.0);
            let [i, j, k] = [x, beside, 60.0].map(|part| part / length);
            writeln!(text, "GOTO/{x:.6},{beside:.6},10,{i:.9},{j:.9},{k:.9}").unwrap();
        }
        text += "RAPID\nGOTO/40,0,60,0.4472136,0,0.8944272\nFINI\n";
        fs::write(&file, text).unwrap();
        let job = Job { machine, cl: file.to_str().unwrap(), with: &with };
        match posted {
            true => drop(job.right()),
            false => {
                let refused = job.posted().unwrap_err();
                let says = "the program has the tool's vector in their place";
                assert!(refused.contains(says), "{machine} {beside}: {refused}");
            }
        }
    }
}

/// A tip that hardly moves while the axes turn goes in bows about its way, within the tolerance: its feed is that of the way.
#[test]
fn the_feed_of_a_tip_that_hardly_moves_is_that_of_its_way() {
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/2500,CLW\nMULTAX/ON\nRAPID\nGOTO/4,0.5,3,0,0,1\nFEDRAT/20,MMPM\n\
        GOTO/4,0.5,1.25,0.0871557,0,0.9961947\nGOTO/4.125,0.5312,1.2401,0.1736482,-0.0303849,0.9843394\n\
        GOTO/4.25,0.5611,1.2213,0.258819,-0.0669873,0.9636005\nGOTO/4.375,0.589,1.1938,-0.0190379,-0.0091253,0.9997771\n\
        RAPID\nGOTO/4.375,0.589,3\nFINI\n";
    for machine in ["bc-fork", "head-head", "nutating-head-50"] {
        right_text(machine, text);
    }
}

/// Where two solutions lie side by side the choice may go over from one to the other in a cut. In a plane the tool points as
/// well as it stands: the cut goes on in the plane that it began in (it was left out, and the tool came down on its end).
#[test]
fn a_cut_goes_on_in_the_plane_that_it_began_in() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let machine = file(
        "m.toml",
        "name = \"skewed table\"\nchain = \"[w C' b Z X Y B (S) t]\"\n\
         [workpiece]\nmount = [-8.617, 17.44, -0.132]\n[tool]\ngauge = [0.832, 4.03, 401.158]\n\
         [axis.C]\nrotary = [0.007679, 0.735486, 0.68205]\npoint = [0.082833, 0.514399, 0.126855]\ntravel = [-400, 400]\n\
         [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-2000, 2000]\n\
         [axis.X]\nlinear = [1, 0, 0]\ntravel = [-2000, 2000]\n\
         [axis.Y]\nlinear = [0, 1, 0]\ntravel = [-2000, 2000]\n\
         [axis.B]\nrotary = [0, 1, 0]\npoint = [-88.606523, 40.53039, 577.911018]\ntravel = [-400, 400]\n\
         [control]\ndialect = \"fanuc\"\ntcp = \"control\"\n[accuracy]\ntolerance = 0.005\n[tools.2]\nlength = 179.6\n",
    );
    let cl = file(
        "p.cls",
        "UNITS/MM\nMULTAX/ON\nLOADTL/2\nSPINDL/RPM,7122,CLW\nRAPID\n\
         GOTO/-31.366014,-9.508959,-14.108354,0,0,1\nFEDRAT/2181,MMPM\n\
         GOTO/-31.366014,-9.508959,-25.728605,0,0,1\nGOTO/-20.704471,-2.153442,-6.851444,0,0,1\nRAPID\n\
         GOTO/-20.704471,-2.153442,18.148556,0,0,1\nFINI\n",
    );
    let job = Job { machine: &machine, cl: &cl, with: &[] };
    let program = job.right();
    assert_eq!(program.matches("G68.2").count(), 1, "{program}");
}
