//! What is said of machine files: each fault once, and how to come by what is missing.

use std::fs;

use crate::common::{assert_contains, post, post_in, with_file};

/// The errors of a run, by their first lines.
fn errors(err: &str) -> Vec<&str> {
    err.lines().filter(|line| line.starts_with("error[")).collect()
}

#[test]
fn a_direction_that_is_a_letter_is_one_error_in_every_layer() {
    let folder = with_file("ours.toml", "extends = \"ac-trunnion\"\n[axis.C]\nrotary = \"X\"\n");
    let said = "expected three numbers, such as [1, 0, 0] for X";
    for arguments in [
        &["check", "ours.toml"][..],
        &["check", "ac-trunnion", "--set", "axis.C.rotary=\"X\""],
        &["check", "ac-trunnion", "--set", "axis.C.point=\"X\""],
    ] {
        let run = post_in(folder.path(), arguments);
        assert_eq!((run.code, errors(&run.err).len()), (1, 1), "{}", run.err);
        assert_contains(&run.err, &[said]);
    }
    // Another table's fault is another.
    let text =
        "extends = \"ac-trunnion\"\n[axis.C]\nrotary = \"X\"\n[axis.A]\nrotary = [0, 0, 0]\n";
    fs::write(folder.path().join("ours.toml"), text).unwrap();
    let run = post_in(folder.path(), &["check", "ours.toml"]);
    assert_eq!(errors(&run.err).len(), 2, "{}", run.err);
}

#[test]
fn plugins_of_the_source_are_told_how_they_are_made() {
    for name in ["krl", "rapid", "urscript"] {
        let run = post(&["check", "kr6-r700", "--set", &format!("control.dialect={name:?}")]);
        let made = format!("cargo build --release -p post-{name}");
        assert_eq!(run.code, 1);
        assert_contains(&run.err, &[&made, "--plugins target/release"]);
    }
    let run = post(&["check", "kr6-r700", "--set", "control.dialect=\"karel\""]);
    assert!(run.code == 1 && !run.err.contains("cargo build"), "{}", run.err);
}

#[test]
fn an_orientation_that_no_dialect_has_is_no_value() {
    let run = post(&["check", "kr6-r700", "--set", "control.orientation=\"wpr\""]);
    let known = "known are axes, vector, abc-zyx, quaternion, rotation-vector";
    assert!(run.code == 1 && run.err.contains(known), "{}", run.err);
}

/// Errors that are all zero move the tip nowhere, and no place is told.
#[test]
fn errors_of_nothing_are_told_without_a_place() {
    let rows = "[error.X]\ncolumns = [\"X\", \"EXX\"]\nrows = [[0, 0], [100, 0]]\n";
    let folder = with_file("ours.toml", &format!("extends = \"vmc\"\n{rows}"));
    let run = post_in(folder.path(), &["check", "ours.toml"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(&run.out, &["errors together   the tip stands nowhere off\n"]);
}

#[test]
fn a_part_beside_the_line_of_a_lathe_is_warned_of() {
    let sample = crate::common::root().join("tests/machines/lathe-xzc-face.cls");
    let sample = sample.to_str().unwrap();
    let run = |mount: &str| {
        let mount = format!("--mount={mount}");
        post(&["-q", "-m", "lathe-xzc-face", "--tool-length", "60", &mount, sample, "-o", "-"])
    };
    assert_eq!(run("0,0,130").err, "");
    let beside = run("3,4,130");
    let said = "warning[part-place]: the part origin sits 5.000 mm beside the line of C";
    assert_contains(&beside.err, &[said, "--mount 0,0,130 puts it there"]);
    let check = post(&["check", "lathe-xzc-face", "--set", "workpiece.mount=[3, 4, 130]"]);
    assert_contains(&check.err, &["5.000 mm beside the line of C"]);
    // A rotary table is no spindle, wherever the part sits on it.
    let table = post(&["check", "ac-trunnion", "--set", "workpiece.mount=[3, 4, 50]"]);
    assert!(!table.err.contains("beside the line"), "{}", table.err);
}

/// The words X, Y and Z are those of the tip that the control keeps, whatever the slides are called.
#[test]
fn slides_of_any_name_have_the_words_of_the_tip() {
    let machine = |names: [&str; 3]| {
        let [x, y, z] = names;
        format!(
            "name = \"trunnion\"\nchain = \"[w C' A' b {y} {x} {z} (S) t]\"\ntool.gauge = [0, 0, 400]\n\
             [axis]\nC = {{ rotary = [0, 0, 1], point = [0, 0, 0], cyclic = true, max_feed = 6000 }}\n\
             A = {{ rotary = [1, 0, 0], point = [0, 0, 50], travel = [-120, 120], max_feed = 6000 }}\n\
             {x} = {{ linear = [1, 0.001, 0], travel = [-900, 900], max_feed = 20000 }}\n\
             {y} = {{ linear = [0, 1, 0], travel = [-900, 900], max_feed = 20000 }}\n\
             {z} = {{ linear = [0, 0, 1], travel = [-900, 900], max_feed = 20000 }}\n\
             [control]\ntcp = \"control\"\nretract = {{ {z} = 880 }}\ndialect = "
        )
    };
    let sample = crate::common::root().join("tests/machines/ac-trunnion.cls");
    let sample = sample.to_str().unwrap();
    let folder = tempfile::tempdir().unwrap();
    for dialect in ["fanuc", "siemens", "heidenhain", "linuxcnc"] {
        let program = |names: [&str; 3]| {
            let text = format!("{}{dialect:?}\n", machine(names));
            fs::write(folder.path().join("m.toml"), text).unwrap();
            let with = ["-q", "-m", "m.toml", "--tool-length", "60", "--verify", sample, "-o", "-"];
            let run = post_in(folder.path(), &with);
            assert_eq!(run.code, 0, "{dialect} {names:?}: {}", run.err);
            run.out
        };
        let plain = program(["X", "Y", "Z"]);
        for names in [["U", "V", "W"], ["W", "U", "V"], ["X", "Y", "W"], ["X1", "Y1", "Z1"]] {
            assert_eq!(program(names), plain, "{dialect} {names:?}");
        }
    }
    let check = post_in(folder.path(), &["check", "m.toml"]);
    assert_contains(
        &check.out,
        &["X is the word of the slide X1 and, while the control keeps it, of the tip"],
    );
    // Two slides are no three, and a rotary axis may not have the word.
    let text = machine(["U", "V", "W"]).replace(" C' ", " Z' ").replace("\nC = ", "\nZ = ");
    fs::write(folder.path().join("m.toml"), format!("{text}\"fanuc\"\n")).unwrap();
    let run = post_in(folder.path(), &["check", "m.toml"]);
    assert!(run.code == 1 && run.err.contains("the linear axes are called U, V, W"), "{}", run.err);
}
