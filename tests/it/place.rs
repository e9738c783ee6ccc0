//! `post place`: the mount that it prints is one that posting takes, on every machine of the library.

use crate::common;
use crate::library::LIBRARY;

use std::fs;
use std::path::Path;

use common::{Run, command, post, read_json, root, run};
use nalgebra::{Rotation3, Vector3};
use post_testkit::{all_drawn, drawn};
use post_testruns::read_back::{Model, blocks, table};
use serde_json::Value;

/// Rotary axes place the tip.
const ROBOTS: [&str; 2] = ["irb4600-rail", "kr6-r700"];

/// `post place` with these words on a CL file of that text.
fn place_text(arguments: &[&str], text: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, text).unwrap();
    run(command().arg("place").args(arguments).arg(&file), b"")
}

/// The command that a run of `post place` ends with, as words.
fn printed(out: &str) -> Vec<String> {
    let line = out.trim_end().lines().last().unwrap();
    let words = line.split(' ').map(str::to_owned);
    let words: Vec<String> = words.collect();
    assert_eq!(words[0], "post", "{out}");
    words[1..].to_vec()
}

/// The value behind a flag.
fn told(words: &[String], flag: &str) -> Option<Vec<f64>> {
    let at = words.iter().position(|word| word == flag)?;
    let numbers = words[at + 1].split(',');
    Some(numbers.map(|number| number.parse().unwrap()).collect())
}

/// Posts as a printed command says: the program and the summary.
fn obeyed(words: &[String]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let mut words = words.to_vec();
    words.extend(["-q", "-o", "-", "--summary"].map(str::to_owned));
    words.push(json.display().to_string());
    let done = post(&words);
    assert_eq!(done.code, 0, "{words:?}:\n{}", done.err);
    (done.out, read_json(&json))
}

/// What is least left of the travel of the axes of `names`, mm.
fn left(summary: &Value, names: &[&str]) -> f64 {
    let axes = summary["axes"].as_array().unwrap().iter();
    let axes = axes.filter(|axis| names.contains(&axis["name"].as_str().unwrap()));
    let number = |value: &Value| value.as_f64().unwrap();
    let left = axes.filter(|axis| !axis["travel"].is_null()).map(|axis| {
        let travel = &axis["travel"];
        let below = number(&axis["min"]) - number(&travel[0]);
        below.min(number(&travel[1]) - number(&axis["max"]))
    });
    left.fold(f64::INFINITY, f64::min)
}

#[test]
fn every_machine_of_the_library_is_placed_from_where_it_does_not_fit() {
    let mut moved = 0;
    // Where rotary axes place the tip, no mount follows from travel: that is refused, see below.
    for row in LIBRARY
        .iter()
        .filter(|row| !row.machine.starts_with("lathe-xz") && !ROBOTS.contains(&row.machine))
    {
        // What legs and drives reach is held where the program is made, and not known where a mount is looked for.
        let machine = root().join("machines").join(format!("{}.toml", row.machine));
        let text = fs::read_to_string(machine).unwrap();
        if ["[[leg]]", "[[drive]]"].iter().any(|table| text.contains(table)) {
            continue;
        }
        let file = format!("tests/machines/{}.{}", row.machine, row.ending);
        let length = row.length.to_string();
        // Its pole is passed where the control keeps the tip.
        let kept: &[&str] = match row.machine {
            "head-table-sr" => &["--tcp", "control", "--set", "control.hurco.tcp_on=M128"],
            _ => &[],
        };
        let arguments = [
            "place",
            "-m",
            row.machine,
            &file,
            "--tool-length",
            &length,
            "--mount",
            "350,-290,330",
            "--runs",
            "12",
        ];
        let found = post(&[&arguments, kept].concat());
        assert_eq!(found.code, 0, "{}:\n{}", row.machine, found.err);
        let words = printed(&found.out);
        let (program, summary) = obeyed(&words);
        let mount = told(&words, "--mount").unwrap();
        moved += u32::from(mount != [350.0, -290.0, 330.0]);
        // X, Y and Z of these machines go with the part; W and the like stand, or help out.
        let sliding: &[&str] = match row.machine {
            "boring-mill" | "quill-mill" => &["X", "Y"],
            _ => &["X", "Y", "Z"],
        };
        let least = left(&summary, sliding);
        assert!(least >= 0.997, "{}: {least} mm left", row.machine);
        // By a kinematics of the tests' own, with the part there.
        let mut machine = table(row.machine);
        if !kept.is_empty() {
            machine["control"]["tcp"] = "control".into();
        }
        let workpiece = toml::toml! { mount = [0.0, 0.0, 0.0] };
        let workpiece = machine.entry("workpiece").or_insert(workpiece.into());
        workpiece["mount"] = mount.into();
        let heads = machine.contains_key("head");
        let model = Model::from_table(machine, None);
        let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
        for block in blocks(&program, &names, &[]) {
            let over = model.over_travel(&block.words, row.length);
            assert!(over.is_none() || heads, "{}: {over:?}", row.machine);
        }
    }
    assert!(moved > 20, "{moved}");
}

const SQUARE: &str =
    "PARTNO/SQUARE\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/500,MMPM\nRAPID\n";

/// A plate that is cut from `-half` to `half`, mm along X and Y, each height on a line of its own.
fn plate([x, y]: [f64; 2]) -> String {
    let mut text = SQUARE.to_owned();
    for [sx, sy] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
        text.push_str(&format!("GOTO/{},{},0\n", sx * x, sy * y));
    }
    text.push_str("FINI\n");
    text
}

#[test]
fn a_part_that_is_too_large_is_told_by_how_much_and_a_turn_is_found() {
    // The mill goes 1020 mm along X and 510 mm along Y.
    let vmc = ["-m", "vmc", "--tool-length", "100"];
    let there = place_text(&vmc, &plate([400.0, 200.0]));
    assert_eq!(there.code, 0, "{}", there.err);
    let wide = place_text(&vmc, &plate([200.0, 300.0]));
    assert_eq!(wide.code, 1);
    // 600 of 510 mm: 45 at each end.
    for said in [
        "does not fit VMC",
        "short by 45.000 mm at each of Y at its least end on line 7 and Y at its largest end on line 9",
        "--search-turn",
    ] {
        assert!(wide.err.contains(said), "{said}: {}", wide.err);
    }
    // No mount of a grid posts.
    for step in 0..9 {
        let mount = format!("--mount=0,{},100", -200 + 50 * step);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("part.cls");
        fs::write(&file, plate([200.0, 300.0])).unwrap();
        let done = run(command().args(vmc).args([&mount, "-o", "-"]).arg(&file), b"");
        assert_eq!(done.code, 1, "{mount}");
        assert!(done.err.contains("passed by"), "{}", done.err);
    }
    let turned = place_text(&[&vmc[..], &["--search-turn"]].concat(), &plate([200.0, 300.0]));
    assert_eq!(turned.code, 0, "{}", turned.err);
    let words = printed(&turned.out);
    let turn = told(&words, "--turn").unwrap()[0];
    assert!(turn.abs() > 20.0, "{turn}");
}

#[test]
fn a_turn_that_is_found_is_one_that_posting_takes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, plate([200.0, 300.0])).unwrap();
    let file = file.to_str().unwrap();
    let arguments = ["-m", "vmc", "--tool-length", "100", file];
    let found = post(&[&["place", "--search-turn=30"][..], &arguments].concat());
    assert_eq!(found.code, 0, "{}", found.err);
    let words = printed(&found.out);
    let turn = told(&words, "--turn").unwrap()[0];
    let (program, summary) = obeyed(&words);
    assert!(left(&summary, &["X", "Y", "Z"]) >= 0.997);
    // Three axes: the words are the points, turned right-handed about Z.
    let about = Rotation3::from_axis_angle(&Vector3::z_axis(), turn.to_radians());
    let ends = blocks(&program, &["X", "Y", "Z"], &[]);
    for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let wanted = about * Vector3::new(sx * 200.0, sy * 300.0, 0.0);
        let met = ends.iter().any(|end| {
            let words = Vector3::from_column_slice(&end.words);
            (words - wanted).norm() < 0.002
        });
        assert!(met, "{turn}: {wanted}\n{program}");
    }
}

#[test]
fn least_time_is_no_more_than_where_the_part_sits() {
    for machine in ["ac-trunnion", "dmu50", "xyzbc-trt"] {
        let base = [
            "-m",
            machine,
            "tests/samples/blade.cls",
            "--tool-length",
            "0",
            "--mount",
            "40,30,-20",
        ];
        let found = post(&[&["place", "--runs", "30"][..], &base].concat());
        assert_eq!(found.code, 0, "{}", found.err);
        let here = base.map(str::to_owned);
        let time = |words: &[String]| obeyed(words).1["time_s"].as_f64().unwrap();
        let (before, after) = (time(&here), time(&printed(&found.out)));
        assert!(after <= before, "{machine}: {after} {before}");
    }
    // Where the part sits well it stays.
    let base = ["place", "-m", "vmc", "tests/samples/plate.ncl", "--tool-length", "80"];
    let stays = post(&base);
    assert!(stays.out.contains("--mount 0,0,0"), "{}", stays.out);
    assert!(stays.out.contains("time is the same wherever the part sits"));
}

#[test]
fn a_turn_of_the_part_turns_the_axes_less() {
    // The tool leans towards 45° between the axes of the tables: both turn, and turned by that one alone has to.
    let mut text = SQUARE.to_owned() + "MULTAX/ON\nGOTO/0,0,50,0,0,1\n";
    for lean in [10.0, 25.0, 5.0, 20.0f64] {
        let axis = Rotation3::from_axis_angle(&Vector3::y_axis(), lean.to_radians()) * Vector3::z();
        let (across, up) = (axis.x, axis.z);
        let part = across * 0.5f64.sqrt();
        text.push_str(&format!("GOTO/0,0,40,{part:.9},{part:.9},{up:.9}\n"));
    }
    text.push_str("RAPID\nGOTO/0,0,50,0,0,1\nFINI\n");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lean.cls");
    fs::write(&file, text).unwrap();
    let file = file.to_str().unwrap();
    let base = ["-m", "ab-trunnion", file, "--tool-length", "100"];
    let found = post(&[&["place", "--least", "rotary", "--search-turn=45"][..], &base].concat());
    assert_eq!(found.code, 0, "{}", found.err);
    let turns = |words: &[String]| {
        let summary = obeyed(words).1;
        let axes = summary["axes"].as_array().unwrap().iter();
        let axes = axes.filter(|axis| ["A", "B"].contains(&axis["name"].as_str().unwrap()));
        axes.map(|axis| axis["way"].as_f64().unwrap()).sum::<f64>()
    };
    let (before, after) = (turns(&base.map(str::to_owned)), turns(&printed(&found.out)));
    // The sum of both legs against the hypotenuse, nearly: angles add up on a sphere.
    assert!(after < 0.75 * before, "{after} {before}");
}

/// A tap goes by its moves while mounts are tried, whatever the dialect has for it; posted it is the control's cycle. Where
/// it is out of travel, that alone is said.
#[test]
fn a_file_with_a_thread_is_placed() {
    let base = ["tests/samples/flange.ncl", "-m", "vmc", "--tool-length", "110"];
    let low = ["--mount", "0,0,-300"];
    let refused = post(&[&base[..], &["-o", "-"], &low].concat());
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("error[over-travel]"), "{}", refused.err);
    assert!(refused.err.contains("1 error;"), "{}", refused.err);
    let found = post(&[&["place"][..], &base, &low].concat());
    assert_eq!(found.code, 0, "{}", found.err);
    let (program, _) = obeyed(&printed(&found.out));
    assert!(program.contains("G84 "), "{program}");
}

#[test]
fn what_no_mount_helps_is_refused_and_why() {
    let refused =
        post(&["place", "-m", "dmu50", "tests/machines/dmu50.refused.ncl", "--tool-length", "100"]);
    assert_eq!(refused.code, 1);
    for said in ["B would be", "no mount helps", "--search-turn"] {
        assert!(refused.err.contains(said), "{said}: {}", refused.err);
    }
    assert_eq!(refused.out, "");
    // A length that the axis positions depend on is asked for, as posting does.
    let lacks = post(&["place", "-m", "head-head", "tests/samples/blade.cls"]);
    assert_eq!(lacks.code, 1);
    assert!(lacks.err.contains("error[tool-length]"), "{}", lacks.err);
    // The file is read several times.
    let piped = run(command().args(["place", "-m", "vmc", "-"]), plate([1.0, 1.0]).as_bytes());
    assert_eq!(piped.code, 1);
    assert!(piped.err.contains("goes over the CL file several times"), "{}", piped.err);
    // A margin that nothing leaves is told with the one that something does.
    let margin = place_text(
        &["-m", "vmc", "--tool-length", "100", "--margin", "60"],
        &plate([400.0, 200.0]),
    );
    assert_eq!(margin.code, 1);
    assert!(
        margin.err.contains("--margin 54.99 is the most that fits")
            || margin.err.contains("--margin 55 is the most that fits"),
        "{}",
        margin.err
    );
}

#[test]
fn an_index_move_of_the_file_and_a_turned_part_do_not_go_together() {
    let text = "PARTNO/X\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/500,MMPM\nROTABL/BAXIS,ATANGL,90\nRAPID\nGOTO/0,0,10\nGOTO/0,0,5\nFINI\n";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, text).unwrap();
    let with = |turn: &str| {
        let arguments = ["-m", "hmc-b-pallet", "--tool-length", "100", "-o", "-", "--turn", turn];
        run(command().args(arguments).arg(&file), b"")
    };
    assert!(with("90").err.contains("angles of this index move"), "{}", with("90").err);
    assert!(!with("0").err.contains("angles of this index move"));
}

#[test]
fn the_picture_has_a_bar_for_each_axis() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("travel.svg");
    let arguments =
        ["place", "-m", "dmu50", "tests/samples/blade.cls", "--tool-length", "80", "--svg"];
    let found = post(&[&arguments[..], &[picture.to_str().unwrap()]].concat());
    assert_eq!(found.code, 0, "{}", found.err);
    let svg = fs::read_to_string(&picture).unwrap();
    assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"));
    for axis in ["X", "Y", "Z", "B", "C"] {
        assert!(svg.contains(&format!(">{axis}</text>")), "{axis}");
    }
    let ends = |unit: &str| svg.matches(&format!("{unit} left</text>")).count();
    assert_eq!((ends(" mm"), ends("°")), (2 * 3, 2));
    assert_eq!(svg.matches("endless</text>").count(), 1);
    assert!(!Path::new("travel.svg").exists());
}

#[test]
fn a_real_file_is_placed() {
    let Some(data) = post_testkit::shared("data/cl") else {
        return;
    };
    let file = data.join("creo5x_4r19415_finition.ncl");
    let file = file.to_str().unwrap();
    for machine in ["ac-trunnion", "dmu50"] {
        let base = ["place", "-m", machine, "--units", "mm", "--tool-length", "0", file];
        let far = ["--mount", "250,160,-90", "--runs", "12", "--margin", "5"];
        let found = post(&[&base[..], &far].concat());
        assert_eq!(found.code, 0, "{machine}:\n{}", found.err);
        let (_, summary) = obeyed(&printed(&found.out));
        assert!(left(&summary, &["X", "Y", "Z"]) >= 4.997, "{machine}");
    }
}

/// The first mount next to which a step of one axis costs more, whichever, is not the best.
#[test]
fn least_time_is_looked_for_all_over_the_room() {
    let text = "UNITS/MM\nMULTAX/ON\nLOADTL/3\nSPINDL/RPM,3000,CLW\nRAPID\n\
                GOTO/-108.0752,211.6026,149.3454,-0.3297370,0.6269734,0.7058171\nFEDRAT/MMPM,20000\n\
                GOTO/-185.2706,328.4001,200.3011,-0.2756915,0.1224466,0.9534155\nFINI\n";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("two.cls");
    fs::write(&file, text).unwrap();
    let base = ["-m", "ac-trunnion", file.to_str().unwrap()];
    let base = [&base[..], &["--tool-length", "60"]].concat();
    let time = |words: &[String]| obeyed(words).1["time_s"].as_f64().unwrap();
    let found = post(&[&["place"], &base[..]].concat());
    let found = time(&printed(&found.out));
    // Found by mounts drawn at random.
    let drawn = [&base[..], &["--mount", "376.8405,-109.2529,-38.2971"]].concat();
    let drawn: Vec<String> = drawn.into_iter().map(str::to_owned).collect();
    assert!(found <= 1.05 * time(&drawn), "{found}");
    let here: Vec<String> = base.into_iter().map(str::to_owned).collect();
    assert!(found < 0.8 * time(&here), "{found}");
}

/// A part that is clamped turned is posted turned, whatever the machine file says of another.
#[test]
fn a_turn_back_to_none_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let machine = folder.path().join("turned.toml");
    fs::write(&machine, "extends = \"vmc\"\n[workpiece]\nturn = -90\n").unwrap();
    let machine = machine.to_str().unwrap();
    let with = ["-m", machine, "--tool-length", "100"];
    let file = folder.path().join("-wide.cls");
    fs::write(&file, plate([400.0, 200.0])).unwrap();
    let searched = [&["place"], &with[..], &["--search-turn=90"]].concat();
    // A file whose name begins as a flag does stands behind `--`, and the seat before it.
    let mut command = command();
    let command = command.current_dir(&folder).args(&searched);
    let found = run(command.args(["--", "-wide.cls"]), b"");
    assert_eq!(found.code, 0, "{}", found.err);
    let words = printed(&found.out);
    assert_eq!(told(&words, "--turn"), Some(vec![0.0]), "{}", found.out);
    assert_eq!(words[words.len() - 2..], ["--", "-wide.cls"], "{}", found.out);
    let mut again = common::command();
    let again = run(again.current_dir(&folder).args(["-q", "-o", "x.nc"]).args(&words), b"");
    assert_eq!(again.code, 0, "{}", again.err);
}

/// Where rotary axes place the tip, no mount follows from travel, and none is said to help nowhere.
#[test]
fn a_chain_whose_rotary_axes_place_the_tip_is_not_searched() {
    let with = ["-m", "tests/chains/scara.toml", "--tool-length", "100"];
    let away = [&with[..], &["--mount", "5000,0,0"]].concat();
    let far = place_text(&away, &plate([20.0, 20.0]));
    assert_eq!(far.code, 1);
    for said in ["error[out-of-reach]", "no mount is searched for SCARA", "--mount X,Y,Z"] {
        assert!(far.err.contains(said), "{said}: {}", far.err);
    }
    let near = place_text(&with, &plate([20.0, 20.0]));
    assert_eq!(near.code, 0, "{}", near.err);
}

/// Wherever a part sits too far off, the mount that a message names brings that axis inside.
#[test]
fn a_mount_that_a_message_names_brings_the_axis_inside() {
    let mut named = 0;
    let mounts = ["9000,0,0", "0,9000,0", "0,0,9000", "0,0,-9000"];
    let cases = LIBRARY.iter().flat_map(|row| mounts.map(|mount| (row, mount)));
    for (row, mount) in drawn(cases.collect(), 17) {
        let file = format!("tests/machines/{}.{}", row.machine, row.ending);
        let length = row.length.to_string();
        let at = |mount: &str| {
            let base = ["-q", "-m", row.machine, &file, "--tool-length", &length];
            post(&[&base[..], &["-o", "-", "--mount", mount]].concat())
        };
        let refused = at(mount);
        let help = refused.err.split("help: --mount ").nth(1);
        let Some((mount, rest)) = help.and_then(|help| help.split_once(" brings ")) else {
            continue;
        };
        let axis = rest.split(' ').next().unwrap();
        let next = at(mount);
        let over = format!("]: {axis} would be");
        let said = next.err.lines().any(|line| line.starts_with("error") && line.contains(&over));
        assert!(!said, "{} at {mount}: {}", row.machine, next.err);
        named += 1;
    }
    let least = if all_drawn() { 20 } else { 2 };
    assert!(named > least, "{named}");
}
