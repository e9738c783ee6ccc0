//! What the control of a machine can read: names of axes, long lines, lines of the user's own, compensation.

use crate::common;

use std::fs;

use common::{Run, root, run};

/// A CL file from standard input, posted to standard output.
fn text(arguments: &[&str], cl: &str) -> Run {
    let mut command = common::command();
    command.args(arguments).args(["-o", "-", "-"]);
    run(&mut command, cl.as_bytes())
}

const MOVES: &str =
    "UNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nFEDRAT/MMPM,200\nGOTO/0,0,50\nGOTO/1,0,0\nFINI\n";

/// `vmc` with its Y called otherwise, in a folder of its own.
fn renamed(name: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let vmc = fs::read_to_string(root().join("machines/vmc.toml")).unwrap();
    let vmc = vmc
        .replace(" Y' ", &format!(" {name}' "))
        .replace(" Y ", &format!(" {name} "))
        .replace("[axis.Y]", &format!("[axis.{name}]"));
    assert!(vmc.contains(&format!("[axis.{name}]")));
    fs::write(folder.path().join("renamed.toml"), vmc).unwrap();
    folder
}

#[test]
fn an_axis_that_the_control_cannot_name_is_refused_where_it_is_described() {
    for (name, why) in
        [("Y1", "it would read Y1450. as Y at 1450."), ("Q", "Q means something else to it")]
    {
        let folder = renamed(name);
        let machine = folder.path().join("renamed.toml");
        let machine = machine.to_str().unwrap();
        for dialect in ["fanuc", "linuxcnc", "heidenhain"] {
            let setting = format!("control.dialect={dialect}");
            let run = text(&["-m", machine, "--set", &setting], MOVES);
            assert_eq!((run.code, run.out.as_str()), (1, ""), "{name}, {dialect}");
            let line = format!("[axis.{name}]");
            for part in [why, "rename the axis", &line, "renamed.toml:"] {
                assert!(run.err.contains(part), "{part}\n{}", run.err);
            }
        }
    }
}

#[test]
fn every_machine_of_the_library_has_axes_that_every_dialect_writes() {
    let files = fs::read_dir(root().join("machines")).unwrap().flatten();
    let names = files.map(|file| file.file_name().into_string().unwrap());
    let mut opened = 0;
    // E of a printer is a word of its firmware alone.
    let mills = names.filter(|name| name.ends_with(".toml") && !name.starts_with("printer"));
    for name in mills {
        for dialect in ["fanuc", "linuxcnc", "heidenhain"] {
            let setting = format!("control.dialect={dialect}");
            let machine = format!("machines/{name}");
            let run = text(&["-m", &machine, "--set", &setting], "FINI\n");
            // Nothing is in the file; the dialect was opened before anyone could tell.
            let found = run.err.contains("error[plugin]");
            let wrapped = dialect == "linuxcnc" && run.err.contains("it has a range");
            assert!(!found || wrapped, "{name}, {dialect}\n{}", run.err);
            opened += usize::from(!found);
        }
    }
    assert!(opened > 90, "{opened}");
}

/// An upright tool on a machine that turns: the one plane in which the control could offset.
const COMPENSATED: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nFEDRAT/MMPM,200\nGOTO/0,0,50\nGOTO/0,0,10\nCUTCOM/LEFT,4\nGOTO/9,0,10\nGOTO/9,20,10\nCUTCOM/OFF\nGOTO/0,0,50\nFINI\n";

#[test]
fn compensation_under_tcp_is_written_where_the_control_has_it() {
    for (dialect, tcp, written) in [
        ("fanuc", "control", None),
        ("fanuc", "post", Some("G41 D4")),
        ("heidenhain", "control", None),
        ("heidenhain", "post", Some(" RL")),
        ("linuxcnc", "control", Some("G41 D4")),
    ] {
        let setting = format!("control.dialect={dialect}");
        let planes = "control.planes=false";
        let arguments = ["-m", "ac-trunnion", "--tcp", tcp, "--set", &setting, "--set", planes];
        let run = text(&arguments, COMPENSATED);
        let Some(word) = written else {
            assert_eq!((run.code, run.out.as_str()), (1, ""), "{dialect}");
            for part in [
                "cutter radius compensation (CUTCOM) under tool centre point control",
                "standard input:7:1",
                "--tcp post",
            ] {
                assert!(run.err.contains(part), "{part}\n{}", run.err);
            }
            continue;
        };
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(run.out.contains(word), "{dialect}, {tcp}\n{}", run.out);
    }
}

/// The head of a real file of Creo, with compensation in its path.
#[test]
fn the_option_for_compensation_on_the_tools_centre_is_named() {
    let cl = format!("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER\n{COMPENSATED}");
    let run = text(&["-m", "vmc"], &cl);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert!(run.err.contains("compensation_on_centre = \"wear\""), "{}", run.err);
    let arguments = ["-m", "vmc", "--set", "control.compensation_on_centre=wear"];
    let run = text(&arguments, &cl);
    assert!(run.out.contains("G41 D4"), "{}", run.err);
    assert!(run.err.contains("register 4 must hold the tool's wear alone"), "{}", run.err);
}

/// A remark of 300 letters, of `post` or of the CAM system.
#[test]
fn long_remarks_are_as_many_lines_as_the_control_needs() {
    let long = "CHECK THE CLAMPS ON BOTH SIDES ".repeat(10);
    let cl = MOVES.replacen("UNITS/MM\n", &format!("UNITS/MM\nPPRINT {long}\n"), 1);
    for (dialect, most) in [("fanuc", 80), ("linuxcnc", 252), ("heidenhain", 90)] {
        let setting = format!("control.dialect={dialect}");
        let run = text(&["-m", "vmc", "--set", &setting], &cl);
        assert_eq!(run.code, 0, "{}", run.err);
        for line in run.out.lines() {
            assert!(line.len() <= most, "{dialect}: {} characters", line.len());
        }
        assert_eq!(run.out.matches("CLAMPS").count(), 10, "{dialect}\n{}", run.out);
    }
}

#[test]
fn the_name_of_a_program_is_as_long_as_the_control_shows() {
    let folder = tempfile::tempdir().unwrap();
    let name = "a_name_of_much_more_than_twenty-four_letters";
    let path = folder.path().join(format!("{name}.cls"));
    fs::write(&path, MOVES).unwrap();
    let run = common::post(&[
        "-m",
        "vmc",
        "--set",
        "control.dialect=heidenhain",
        "-o",
        "-",
        path.to_str().unwrap(),
    ]);
    assert!(run.out.starts_with("0 BEGIN PGM A_NAME_OF_MUCH_MORE_THAN MM\n"), "{}", run.out);
    assert!(run.out.ends_with(" END PGM A_NAME_OF_MUCH_MORE_THAN MM\n"));
}

/// Lines of the user's own: from options, which may be several, and from `INSERT`.
#[test]
fn lines_of_the_users_own_are_numbered_and_may_be_several() {
    let folder = tempfile::tempdir().unwrap();
    let machine = folder.path().join("own.toml");
    let options = |retract: &str| {
        format!(
            "extends = \"vmc\"\n[control]\ninsert = \"literal\"\n[control.fanuc]\nblock_numbers = \"all\"\nretract = {retract}\n"
        )
    };
    let cl = MOVES.replacen("GOTO/1", "INSERT M77\nINSERT (AS IT IS)\nINSERT N5 M78\nGOTO/1", 1);
    let machines = ["-m", machine.to_str().unwrap(), "--machines", "machines"];
    fs::write(&machine, options("[\"G91 G28 Z0.\", \"G91 G28 Y0.\"]")).unwrap();
    let run = text(&machines, &cl);
    assert_eq!(run.code, 0, "{}", run.err);
    let numbered = |words: &str| {
        run.out
            .lines()
            .filter_map(|line| line.split_once(' '))
            .any(|(number, rest)| number.starts_with('N') && rest == words)
    };
    for words in ["M77", "G91 G28 Z0.", "G91 G28 Y0."] {
        assert!(numbered(words), "{words}\n{}", run.out);
    }
    for line in ["(AS IT IS)", "N5 M78"] {
        assert!(run.out.lines().any(|found| found == line), "{line}\n{}", run.out);
    }
    // Lines are lines; other options take one text.
    fs::write(&machine, options("[\"G91 G28 Z0.\", 7]")).unwrap();
    let run = text(&machines, &cl);
    assert!(run.err.contains("a flag, a number, a text or an array of lines"), "{}", run.err);
    let offset = options("\"\"").replace("retract = \"\"", "work_offset = [\"G54\", \"G55\"]");
    fs::write(&machine, offset).unwrap();
    let run = text(&machines, &cl);
    assert!(run.err.contains("option `work_offset`: must be one line of text"), "{}", run.err);
}
