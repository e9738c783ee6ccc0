//! Words that an operator puts into a program, or leaves in it: what `post verify` cannot follow it refuses, each in the
//! language of its control.

use std::fs;

use tempfile::TempDir;

use crate::common::{Run, post_in};

const PART: &str = "UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nRAPID\nGOTO/-40,-30,50\nRAPID\nGOTO/-40,-30,2\nFEDRAT/300,MMPM\n\
    GOTO/-40,-30,-3\nFEDRAT/900,MMPM\nGOTO/40,-30,-3\nGOTO/40,30,-3\nRAPID\nGOTO/40,30,50\n\
    CYCLE/DRILL,FEDTO,-12,MMPM,200,RAPTO,2\nGOTO/10,0,0\nGOTO/-10,0,0\nCYCLE/OFF\nRAPID\nGOTO/-10,0,50\nFINI\n";

/// Where a line is put in.
#[derive(Clone, Copy, Debug)]
enum Ahead {
    /// Of the first block that names X.
    Approach,
    /// Of the cut's last way.
    Corner,
    /// Of the definition of the cycle, or its first block.
    Cycle,
}

impl Ahead {
    fn is_it(self, block: &str) -> bool {
        let has = |words: [&str; 2]| words.iter().any(|word| block.contains(word));
        match self {
            Self::Approach => has(["X-40.000", "X=-40"]),
            Self::Corner => has([" Y+30.000", "Y30.000"]),
            Self::Cycle => has(["CYCL DEF 200", "G81"]),
        }
    }
}

/// What `verify` says of a CL file's program, posted in a dialect, after `change`.
fn rewritten(machine: &str, dialect: &str, cl: &str, change: impl Fn(&str) -> String) -> Run {
    let folder: TempDir = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let own = ["-m", machine, "--tool-length", "100", "--dialect", dialect];
    let run = post_in(folder.path(), &[&own[..], &["part.cls", "-o", "part.nc"]].concat());
    assert_eq!(run.code, 0, "{dialect}: {}", run.err);
    let right = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    fs::write(folder.path().join("part.nc"), change(&right)).unwrap();
    let verify = [&["verify", "part.nc", "--against", "part.cls", "--posted"][..], &own].concat();
    post_in(folder.path(), &verify)
}

/// The part posted in a dialect on a mill, judged with `lines` put in.
fn judged(machine: &str, dialect: &str, ahead: Ahead, lines: &str) -> Run {
    rewritten(machine, dialect, PART, |right| {
        let (mut wrong, mut put) = (String::new(), false);
        for block in right.lines() {
            if !put && ahead.is_it(block) {
                wrong.push_str(lines);
                put = true;
            }
            wrong.push_str(block);
            wrong.push('\n');
        }
        assert!(put, "{dialect}: {right}");
        wrong
    })
}

/// A program without the last `word` in it.
fn without(right: &str, word: &str) -> String {
    let (ahead, behind) = right.split_at(right.rfind(word).unwrap());
    format!("{ahead}{}", &behind[word.trim_end().len()..])
}

#[test]
fn what_is_not_followed_is_refused() {
    use Ahead::{Approach, Corner, Cycle};
    for (machine, dialect, ahead, lines, said) in [
        (
            "vmc",
            "heidenhain",
            Corner,
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 #1\n",
            "CYCL DEF 7 without an axis",
        ),
        (
            "vmc",
            "heidenhain",
            Corner,
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1\n",
            "error[nc-frame]",
        ),
        ("vmc", "heidenhain", Approach, "TOOL CALL DL-5\n", "error[length]"),
        ("vmc", "heidenhain", Approach, "TOOL CALL S3000 DL+1\n", "error[length]"),
        ("vmc", "heidenhain", Corner, "CHF 2\n", "`CHF` is not run"),
        ("vmc", "heidenhain", Corner, "RND 2\n", "`RND` is not run"),
        ("vmc", "heidenhain", Corner, "FOO 5\n", "`FOO` is not run"),
        ("vmc", "heidenhain", Corner, "G91\n", "G91 in a program of the dialogue"),
        ("vmc", "heidenhain", Cycle, "M136\n", "under M136"),
        ("vmc", "heidenhain", Corner, "M103 F20\n", "M103 F is not run"),
        ("vmc", "heidenhain", Approach, "FUNCTION MODE TURN\n", "`TURN` is not known"),
        (
            "vmc",
            "heidenhain",
            Corner,
            "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0 X+5\n",
            "X is no",
        ),
        ("vmc", "heidenhain", Corner, "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0 FOO\n", "`FOO`"),
        ("vmc", "heidenhain", Corner, "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 5\n", "the number 5"),
        ("vmc", "heidenhain", Corner, "CC X+10 Y+5 FMAX\n", "`FMAX` is not known"),
        ("vmc", "heidenhain", Corner, "CC X+10 Y+5 M5\n", "M5 is not run in this block"),
        ("vmc", "heidenhain", Corner, "L Y+30 MB MAX\n", "`MB MAX` is not known"),
        ("vmc", "heidenhain", Corner, "L Y+30 DR+\n", "`DR+` is not known"),
        ("vmc", "heidenhain", Corner, "FUNCTION RESET TCPM X+5\n", "X is no"),
        ("vmc", "heidenhain", Corner, "PLANE RESET STAY SPA+30\n", "`SPA` is not known"),
        ("vmc", "heidenhain", Corner, "PLANE RESET STAY MOVE\n", "two of TURN, MOVE and STAY"),
        ("vmc", "heidenhain", Corner, "TOOL DEF 5 L+10 R+3\n", "TOOL DEF with L and R"),
        ("vmc", "heidenhain", Corner, "PLANE RESET STAY \"D10\"\n", "the text \"D10\""),
        ("vmc", "heidenhain", Approach, "TOOL CALL S3000 M4\n", "M4 is not run in this block"),
        ("vmc", "heidenhain", Corner, "CC X+40 Y-20\nCP IPA+36000000 DR+\n", "CP by 100000 turns"),
        (
            "vmc",
            "fanuc",
            Corner,
            "IF [1 EQ 0] THEN\nG0 Z50.\nG1\n",
            "what begins here does not end",
        ),
        ("vmc", "fanuc", Corner, "ENDIF\n", "a branch ends here, and none has begun"),
        ("vmc", "fanuc", Corner, "O2000\n", "O2000 begins another program here"),
        ("vmc", "haas", Corner, "G90;G91\n", "`;` ends a block"),
        ("vmc", "siemens", Corner, "FOR R1=1 TO 3\n", "what begins here does not end"),
        ("vmc", "siemens", Corner, "LOOP\n", "what begins here does not end"),
        ("vmc", "siemens", Corner, "IF TRUE\n", "what begins here does not end"),
        ("osp-mill", "okuma", Corner, "G55 H1\n", "G55"),
        ("osp-mill", "okuma", Corner, "G54 H1\n", "G54"),
        ("osp-mill", "okuma", Corner, "G57 H1\n", "G57"),
        ("osp-mill", "okuma", Corner, "G16 H1 G0 Z0.\n", "G16 is not run"),
        ("osp-mill", "okuma", Corner, "G80\n", "error[spindle]"),
        ("osp-mill", "okuma", Approach, "G92 X0\n", "G92 says where the part lies"),
        ("vmc", "mitsubishi", Corner, "G1 X40. ,R5.\n", ",R= is not run"),
        ("vmc", "mitsubishi", Corner, "G92 S2000\n", "a limit of 2000"),
        ("vmc", "siemens", Corner, "LIMS=2000\n", "a limit of 2000"),
        ("vmc", "siemens", Corner, "X40 Y-29 M5\nS3000 M3\n", "error[spindle]"),
        ("vmc", "siemens", Corner, "SPOS[1]=0\n", "no field that the program declares"),
        ("vmc", "siemens", Corner, "FXS[Z]=1\n", "no field that the program declares"),
        ("vmc", "siemens", Corner, "M70\n", "error[spindle]"),
        ("vmc", "siemens", Corner, "M1=70\n", "error[spindle]"),
        ("vmc", "siemens", Corner, "M5\nSETMS(2)\nS3000 M3\n", "spindle 2 becomes the master"),
        // Blocks that are run together behind it.
        (
            "vmc",
            "siemens",
            Corner,
            "TRAORI\nX41\nX42\nX43\n",
            "a transformation has begun or ended",
        ),
        ("vmc", "siemens", Corner, "G18\n", "the plane is another than when the tool's length"),
        ("vmc", "fagor", Corner, "G18\n", "the plane is another than when the tool's length"),
        ("vmc", "isg", Corner, "G19\n", "the plane is another than when the tool's length"),
        ("vmc", "siemens", Corner, "TRAORI(2)\n", "this is data set 2 of the control"),
        ("vmc", "siemens", Corner, "TRAORI(1,0,1,0)\n", "the direction of the tool in its"),
        ("vmc", "siemens", Corner, "TRAORI\n", "a transformation has begun or ended"),
        ("vmc", "isg", Corner, "#KIN ID [3]\n", "which kinematics of the control"),
        ("vmc", "siemens", Corner, "CYCLE86(50,0,2,-12)\n", "which way the spindle turns (SDIR)"),
        ("osp-mill", "okuma", Corner, "M16\n", "is not run"),
        ("vmc", "siemens", Corner, "G961\n", "error[spindle]"),
        ("vmc", "siemens", Corner, "CYCLE81(50,0,2,-12,,5)\n", "a dwell of 5 s"),
        ("vmc", "siemens", Corner, "D2\nG0 Z50\nD1\nG1 Z-3\n", "with length register 2"),
        ("vmc", "fanuc", Corner, "G55\nG0 Z50.\nG54\nG1 Z-3.\n", "goes at rapid in G55"),
        ("vmc", "fanuc", Corner, "G43 H2\nG0 Z50.\nG43 H1\nG1 Z-3.\n", "with length register 2"),
    ] {
        let run = judged(machine, dialect, ahead, lines);
        assert_eq!(run.code, 1, "{dialect} {lines}: {}{}", run.out, run.err);
        assert!(run.err.contains(said), "{dialect} {lines}: {}", run.err);
    }
}

/// A cut in a branch that does not hold is not cut, whatever stands between its words.
#[test]
fn a_branch_that_does_not_hold_is_left_out() {
    for dialect in ["fanuc", "mitsubishi"] {
        // The corner's block comes behind the end of the branch, and is cut; before it, what is put in is not.
        let empty = "IF [1 EQ 0] THEN\nG1 Z-20. F5.\nENDIF\n";
        let run = judged("vmc", dialect, Ahead::Corner, empty);
        assert_eq!(run.code, 0, "{dialect}: {}", run.err);
        let other = "IF [1 EQ 0] THEN\nG1 Z-20.\nELSE\nG1 X41.\nENDIF\n";
        let run = judged("vmc", dialect, Ahead::Corner, other);
        assert!(run.err.contains("error[deviation]"), "{dialect}: {}", run.err);
    }
}

#[test]
fn what_is_right_stays_so() {
    use Ahead::{Approach, Corner};
    for (machine, dialect, ahead, lines) in [
        (
            "vmc",
            "heidenhain",
            Approach,
            "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+0\nCYCL DEF 7.2 Y+0\n",
        ),
        ("vmc", "heidenhain", Approach, "TOOL CALL S3000\n"),
        ("vmc", "heidenhain", Approach, "FUNCTION MODE MILL\n"),
        ("vmc", "heidenhain", Approach, "TOOL DEF 5\nTOOL DEF \"D10\"\n"),
        (
            "vmc",
            "heidenhain",
            Approach,
            "BLK FORM 0.1 Z X-50 Y-50 Z-20\nBLK FORM 0.2 X+50 Y+50 Z+0\n",
        ),
        ("vmc", "heidenhain", Corner, "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+0\n"),
        ("vmc", "fanuc", Corner, "; the corner\n"),
        ("vmc", "fanuc", Corner, "(CORNER);\n"),
        ("vmc", "siemens", Corner, "DEF REAL A[5]\nA[1]=2\nR[3]=1\n_ZSD[0]=1\n"),
        ("osp-mill", "okuma", Approach, "G80\nS3000 M3\n"),
        ("vmc", "siemens", Corner, "IF TRUE\nENDIF\nFOR R1=1 TO 3\nENDFOR\n"),
    ] {
        let run = judged(machine, dialect, ahead, lines);
        assert_eq!(run.code, 0, "{dialect} {lines}: {}", run.err);
    }
}

/// In a block of a cycle M5 stops the spindle where the tool comes to the hole.
#[test]
fn a_hole_is_not_drilled_by_a_spindle_that_stops() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), PART).unwrap();
    let own = ["-m", "vmc", "--tool-length", "100"];
    for dialect in ["fanuc", "mitsubishi", "haas"] {
        let own = [&own[..], &["--dialect", dialect]].concat();
        let run = post_in(folder.path(), &[&own[..], &["part.cls", "-o", "part.nc"]].concat());
        assert_eq!(run.code, 0, "{dialect}: {}", run.err);
        let right = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        let mut lines: Vec<String> = right.lines().map(str::to_owned).collect();
        let cycle = lines.iter().position(|line| line.contains("G81")).unwrap();
        lines[cycle + 1].push_str(" M5");
        fs::write(folder.path().join("part.nc"), lines.join("\n") + "\n").unwrap();
        let verify = ["verify", "part.nc", "--against", "part.cls", "--posted"];
        let run = post_in(folder.path(), &[&verify[..], &own].concat());
        assert!(run.err.contains("error[spindle]"), "{dialect}: {}", run.err);
    }
}

/// Smoothing whose rule no program names: a machine file that has no tolerance for it leaves unsaid what it costs.
#[test]
fn smoothing_by_the_control_is_warned_of() {
    for (dialect, lines) in [
        ("fanuc", "G5.1 Q2\n"),
        ("fanuc", "G5 P10000\n"),
        ("mazak", "G5 P2\n"),
        ("mitsubishi", "G5.1 Q1\n"),
        ("siemens", "COMPCAD\n"),
        ("fagor", "G50\n"),
    ] {
        let run = judged("vmc", dialect, Ahead::Corner, lines);
        assert!(run.err.contains("warning[smoothing]"), "{dialect} {lines}: {}", run.err);
        let run = judged("vmc", dialect, Ahead::Corner, "");
        assert!(!run.err.contains("smoothing"), "{dialect}: {}", run.err);
    }
}

/// A builder's parameter says whether the length counts there (MD 10760).
#[test]
fn a_position_of_the_machine_with_a_length_is_warned_of() {
    for (line, told) in [("G0 SUPA Z20\nD1\n", true), ("G0 SUPA D0 Z20\nD1\n", false)] {
        let run = judged("vmc", "siemens", Ahead::Corner, line);
        assert_eq!(run.err.contains("warning[nc-machine]"), told, "{line}: {}", run.err);
    }
}

/// An operation in polar interpolation, and the next: the offset is named again where the transformation has ended.
#[test]
fn the_work_offset_is_named_again_behind_polar_interpolation() {
    const FACE: &str = "TLDATA/MILL,10.0,0,60.0,0,0\nLOAD/TOOL,1\nSPINDL/RPM,3000,CLW\nPPRINT OPERATION NAME: A\nRAPID\n\
        GOTO/34.64102,0.00000,50.00000,0.00000,0.00000,1.00000\nRAPID\nGOTO/34.64102,0.00000,2.00000\nFEDRAT/300.0,MMPM\nGOTO/34.64102,0.00000,-4.00000\n\
        GOTO/34.64102,20.00000,-4.00000\nGOTO/0.00000,40.00000,-4.00000\nGOTO/0.00000,40.00000,2.00000\nRAPID\nGOTO/0.00000,40.00000,50.00000\n\
        GOHOME\nPPRINT OPERATION NAME: B\nRAPID\nGOTO/0.00000,0.00000,50.00000\nRAPID\n\
        GOTO/0.00000,0.00000,2.00000\nFEDRAT/200.0,MMPM\nGOTO/0.00000,0.00000,-2.00000\nGOTO/0.00000,0.00000,2.00000\nRAPID\n\
        GOTO/0.00000,0.00000,50.00000\nFINI\n";
    let folder: TempDir = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), FACE).unwrap();
    let own = ["-m", "lathe-xzc-polar", "--dialect", "siemens", "--tool-length", "0"];
    let modes = ["mode.face.on=TRANSMIT", "mode.face.off=TRAFOOF", "mode.face.letter=Y"];
    let modes: Vec<&str> = modes.iter().flat_map(|mode| ["--set", *mode]).collect();
    let files = ["part.cls", "-o", "part.mpf", "--verify"];
    let run = post_in(folder.path(), &[&own[..], &modes, &files].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.mpf")).unwrap();
    assert!(program.matches("G54").count() > program.matches(" M6").count(), "{program}");
}

/// Numbers of levels and centres without a point, which a parameter of the control makes thousandths.
#[test]
fn levels_without_a_point_are_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    for block in
        ["G81 X10. Y0. Z-12 R2. F200.", "G81 X10. Y0. Z-12. R2 F200.", "G2 X10. Y0. I-10 J0. F200."]
    {
        let program = format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nT1 M6\nS3000 M3\nG54\nG0 X10. Y0.\nG43 H1 Z5.\n{block}\nG80\nG53 G0 Z20.\nM30\n%\n"
        );
        fs::write(folder.path().join("part.nc"), program).unwrap();
        let run = post_in(folder.path(), &["read", "part.nc", "-m", "vmc", "--tool-length", "100"]);
        assert!(run.err.contains("warning[nc-number]"), "{block}: {}", run.err);
    }
}

/// Three hundred thousand circles beside the path: minutes, and the same answer as for twenty thousand.
#[test]
fn a_loop_beside_the_path_is_given_up() {
    let loops = "#1=0\nWHILE [#1 LT 300000] DO1\n#1=#1+1\nG3 I-10. J0\nEND1\n";
    let run = judged("vmc", "fanuc", Ahead::Corner, loops);
    assert!(
        run.err.contains("error[lost]: verify has lost the program's place: 20000"),
        "{}",
        run.err
    );
}

/// Two sides of a box on an index table, which is not let go between them.
#[test]
fn an_axis_that_turns_in_its_clamp_is_told() {
    const SIDES: &str = "UNITS/MM\nLOADTL/1\nSPINDL/3000,CLW\nMULTAX/ON\nFEDRAT/300,MMPM\n\
        RAPID\nGOTO/0,120,150,0,0,1\nGOTO/0,120,100,0,0,1\nGOTO/20,120,100,0,0,1\nRAPID\nGOTO/20,120,150,0,0,1\n\
        RAPID\nGOTO/150,120,0,1,0,0\nGOTO/100,120,0,1,0,0\nGOTO/100,120,-20,1,0,0\nRAPID\nGOTO/150,120,-20,1,0,0\nFINI\n";
    for dialect in ["fanuc", "heidenhain"] {
        let run = rewritten("hmc-b-pallet", dialect, SIDES, str::to_owned);
        assert_eq!(run.code, 0, "{dialect}: {}", run.err);
        let run = rewritten("hmc-b-pallet", dialect, SIDES, |right| without(right, "M11"));
        assert_eq!(run.code, 1, "{dialect}: {}{}", run.out, run.err);
        assert!(run.err.contains("error[nc-clamp]: B moves"), "{dialect}: {}", run.err);
    }
}

/// CYCLE86 ends each hole with the spindle oriented: what cuts behind it has it turn again.
#[test]
fn boring_leaves_the_spindle_oriented() {
    const BORED: &str = "UNITS/MM\nLOADTL/1\nSPINDL/800,CLW\nRAPID\nGOTO/0,0,20\n\
        CYCLE/BORE,DRAG,FEDTO,-12,MMPM,100,RAPTO,5\nGOTO/10,10,0\nGOTO/20,10,0\nCYCLE/OFF\n\
        FEDRAT/200,MMPM\nGOTO/30,0,5\nGOTO/30,0,-1\nGOTO/40,0,-1\nRAPID\nGOTO/40,0,20\nFINI\n";
    let run = rewritten("vmc", "siemens", BORED, str::to_owned);
    assert_eq!(run.code, 0, "{}", run.err);
    let run = rewritten("vmc", "siemens", BORED, |right| {
        let wrong = without(right, "M3\n");
        assert!(wrong.contains("MCALL CYCLE86"), "{right}");
        wrong
    });
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.err.contains("error[spindle]"), "{}", run.err);
}

/// With the tool upright the table's axis is free: it stays where it stands, and does not go to zero.
#[test]
fn a_free_axis_of_the_table_stays_in_a_plane() {
    const TURNED: &str = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/3000,CLW\nRAPID\n\
        GOTO/10,10,60,0,-0.5,0.8660254\nFEDRAT/300,MMPM\nGOTO/10,10,10\nGOTO/10,30,10\nRAPID\nGOTO/10,10,60\n\
        RAPID\nGOTO/10,10,60,0,0,1\nGOTO/10,10,10\nGOTO/10,30,10\n\
        CYCLE/DRILL,FEDTO,-5,MMPM,100,RAPTO,2\nGOTO/10,10,10\nGOTO/20,20,10\nCYCLE/OFF\nFINI\n";
    let folder: TempDir = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.cls"), TURNED).unwrap();
    let own = ["-m", "dmu50", "--tool-length", "100", "part.cls", "-o", "part.h", "--verify"];
    let run = post_in(folder.path(), &own);
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.h")).unwrap();
    assert!(program.contains("SPA+0 SPB+0 SPC-90 TURN FMAX TABLE ROT"), "{program}");
    assert!(program.contains("SPA+0 SPB+30 SPC-90 TURN FMAX\n"), "{program}");
}
