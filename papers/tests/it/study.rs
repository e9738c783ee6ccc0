//! `papers study`: its figures against those of the papers (Li 2024, harmonic; Sha et al. 2022, parabolic), its tables
//! and its pictures.

use crate::common;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use common::{Run, papers};
use tempfile::TempDir;

/// A study and the folder that it wrote.
struct Study {
    run: Run,
    folder: TempDir,
}

/// One line of a table: its fields by the names of their columns.
type Line = BTreeMap<String, String>;

fn study(arguments: &[&str]) -> Study {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    let mut all = vec!["study", "-o", path.to_str().unwrap()];
    all.extend(arguments);
    let run = papers(&all);
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
    Study { run, folder }
}

impl Study {
    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join("out").join(name)).unwrap()
    }

    /// A table; every line has as many fields as the first.
    fn table(&self, name: &str) -> Vec<Line> {
        let text = self.read(name);
        let mut lines = text.lines();
        let names = fields(lines.next().unwrap());
        lines
            .map(|line| {
                let fields = fields(line);
                assert_eq!(fields.len(), names.len(), "{name}: {line}");
                names.iter().cloned().zip(fields).collect()
            })
            .collect()
    }

    /// The pictures and their names.
    fn pictures(&self) -> Vec<(String, String)> {
        let entries = fs::read_dir(self.folder.path().join("out")).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.filter(|name| name.ends_with(".svg")).collect();
        names.sort();
        names.into_iter().map(|name| (name.clone(), self.read(&name))).collect()
    }
}

fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for letter in line.chars() {
        match letter {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            letter => fields.last_mut().unwrap().push(letter),
        }
    }
    fields
}

fn number(line: &Line, name: &str) -> f64 {
    let value: f64 = line[name].parse().unwrap();
    assert!(value.is_finite(), "{name}");
    value
}

fn largest(lines: &[Line], name: &str) -> f64 {
    lines.iter().map(|line| number(line, name)).fold(0.0, f64::max)
}

fn close(value: f64, wanted: f64, within: f64) {
    assert!((value - wanted).abs() <= within, "{value} is not {wanted}");
}

const IMPELLER: [&str; 4] =
    ["papers/samples/impeller.cls", "--machine", "papers/samples/impeller.toml", "--exact"];

const MOVE: [&str; 4] = ["papers/samples/disc-move.cls", "--machine", "disc-cutter", "--exact"];

/// Table 3.2 of the harmonic paper: 4.62 µm ("exceeds 4.5"), after compensation 0.26 µm ("does not exceed 0.5"),
/// which is 5.6 % of the peak; a parabola leaves 0.12 %.
#[test]
fn the_impeller_of_the_harmonic_paper() {
    let study = study(&IMPELLER);
    let moves = study.table("moves.csv");
    assert_eq!(moves.len(), 19);
    let peak = largest(&moves, "peak_um");
    close(peak, 4.62, 0.005);
    let harmonic = largest(&moves, "harmonic_left_um");
    close(harmonic, 0.26, 0.005);
    close(harmonic / peak, 0.056, 0.0005);
    let parabolic = largest(&moves, "parabolic_left_um");
    close(parabolic, 0.006, 0.0005);
    close(parabolic / peak, 0.0012, 0.00005);
    for one in &moves {
        close(number(one, "harmonic_r2"), 0.9862, 0.0001);
        assert!(number(one, "parabolic_r2") > 0.999_999);
        close(number(one, "peak_at"), 0.5, 0.001);
    }
}

/// With the rotary axes meeting in the part origin the peak is half as large.
#[test]
fn the_impeller_about_the_part_origin() {
    let mut arguments = IMPELLER.to_vec();
    arguments.push("--mount=0,0,-200");
    let moves = study(&arguments).table("moves.csv");
    close(largest(&moves, "peak_um"), 2.30, 0.005);
}

/// The move of section 2.2 of the parabolic paper: Lm·Δ²/8, linear in the swing length.
#[test]
fn the_move_of_the_parabolic_paper_over_its_swing_length() {
    let mut arguments = MOVE.to_vec();
    arguments.extend(["--sweep", "Lm=100:400:100"]);
    let study = study(&arguments);
    let moves = study.table("moves.csv");
    close(number(&moves[0], "peak_um"), 17.184, 0.0005);
    close(number(&moves[0], "turn_deg"), 1.2027, 1e-6);
    close(number(&moves[0], "harmonic_r2"), 0.9862, 0.00005);
    assert!(number(&moves[0], "parabolic_r2") > 0.999_999);
    let sweep = study.table("sweep.csv");
    let wanted = [(100.0, 5.508), (200.0, 11.016), (300.0, 16.523), (400.0, 22.031)];
    assert_eq!(sweep.len(), wanted.len());
    for (line, (length, peak)) in sweep.iter().zip(wanted) {
        assert_eq!(number(line, "Lm"), length);
        close(number(line, "max_um"), peak, 0.0005);
        close(number(line, "move_um"), peak, 0.0005);
    }
}

/// 24 moves a row with a mean of 17.15 and a standard deviation of 1.348 µm, tolerance 5 µm (section 3.2 of the
/// parabolic paper). One bisection leaves a quarter of each: 4.29 µm, where the paper tells 2.27.
#[test]
fn the_blade_of_the_parabolic_paper() {
    let study = study(&["tests/samples/disc-blade.cls", "--machine", "disc-cutter", "--exact"]);
    let summary = study.table("summary.csv");
    let spread = |name: &str| summary.iter().find(|line| line["what"] == name).unwrap();
    let before = spread("uncompensated");
    assert_eq!(before["count"], "96");
    close(number(before, "mean_um"), 17.15, 0.001);
    close(number(before, "deviation_um"), 1.348, 0.001);
    let bisected = spread("bisect");
    assert_eq!(bisected["count"], "192");
    assert_eq!(bisected["points_put_in"], "96");
    close(number(bisected, "mean_um"), 17.15 / 4.0, 0.001);
    let falls = 1.0 - number(bisected, "deviation_um") / number(before, "deviation_um");
    close(falls, 0.75, 0.001);
    for name in ["bisect", "even", "fewest"] {
        assert!(number(spread(name), "max_um") < 5.0, "{name}");
    }
    for line in study.table("blocks.csv") {
        assert_eq!(line["refused"], "");
        assert!(number(&line, "certified_um") <= 5.0);
    }
}

/// `fewest` with `reduce` needs at most three quarters of the blocks of `bisect`, and both keep 5 µm.
#[test]
fn the_blade_in_three_quarters_of_the_blocks() {
    let study = study(&["tests/samples/disc-blade.cls", "-m", "disc-cutter"]);
    let blocks = study.table("blocks.csv");
    let of = |way: &str, reduce: &str| {
        let line =
            blocks.iter().find(|line| line["way"] == way && line["reduce"] == reduce).unwrap();
        assert!(number(line, "certified_um") <= 5.0, "{line:?}");
        number(line, "blocks")
    };
    let share = of("fewest", "true") / of("bisect", "false");
    assert!(share <= 0.75, "{share}");
}

/// A second study into the same folder leaves nothing of the first that it does not write itself.
#[test]
fn a_folder_holds_one_study() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let common = ["study", "papers/samples/disc-move.cls", "-m", "disc-cutter", "-o", path];
    let mut swept = common.to_vec();
    swept.extend(["--sweep", "Lm=100:200:100"]);
    assert_eq!(papers(&swept).code, 0);
    assert!(folder.path().join("sweep.csv").exists());
    fs::write(folder.path().join("notes.txt"), "kept").unwrap();
    assert_eq!(papers(&common).code, 0);
    for (name, there) in
        [("sweep.csv", false), ("sweep.svg", false), ("moves.csv", true), ("notes.txt", true)]
    {
        assert_eq!(folder.path().join(name).exists(), there, "{name}");
    }
}

/// Eq. 10 of the parabolic paper: what the edge adds to the control point is R·ΔA²/8 at most.
#[test]
fn a_cutting_edge_strays_by_its_radius() {
    let mut arguments = MOVE.to_vec();
    arguments.extend(["--set", "tool.control_point.radius=50"]);
    let moves = study(&arguments).table("moves.csv");
    let turn = number(&moves[0], "turn_deg").to_radians();
    let adds = number(&moves[0], "edge_um") - number(&moves[0], "peak_um");
    let formula = 50.0 * turn * turn / 8.0 * 1e3;
    assert!(adds > 0.0 && adds <= formula, "{adds} {formula}");
    // Without a radius there is no such deviation.
    assert_eq!(study(&MOVE).table("moves.csv")[0]["edge_um"], "");
}

/// On the printed numbers of a real dialect, with commands, rapids and 3-axis moves among the cuts.
#[test]
fn a_blade_on_a_trunnion() {
    let study = study(&["tests/samples/blade.cls", "--machine", "ac-trunnion"]);
    let moves = study.table("moves.csv");
    assert_eq!(moves.len(), 80);
    for (index, one) in moves.iter().enumerate() {
        assert_eq!(one["move"], (index + 1).to_string());
        let peak = number(one, "peak_um");
        // What is bounded is never less than what samples find.
        for placement in ["bisect", "even", "fewest"] {
            let certified = number(one, &format!("{placement}_certified_um"));
            let found = number(one, &format!("{placement}_peak_um"));
            assert!(found <= certified + 1e-6 && certified <= 5.0, "{one:?}");
        }
        close(number(one, "sampled_peak_um"), peak, 0.05);
    }
    let distribution = &study.table("summary.csv")[0];
    let sum: f64 = moves.iter().map(|one| number(one, "peak_um")).sum();
    close(number(distribution, "mean_um"), sum / 80.0, 1e-5);
    close(number(distribution, "max_um"), largest(&moves, "peak_um"), 1e-5);
}

/// A small parser: tags are balanced, attributes quoted, nothing is unnamed, and only grey is used.
#[test]
fn pictures_are_well_formed_and_grey() {
    let mut arguments = MOVE.to_vec();
    arguments.extend(["--sweep", "Lm=100:400:50"]);
    let pictures = study(&arguments).pictures();
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "before-after.svg",
            "edge.svg",
            "histogram.svg",
            "left.svg",
            "move.svg",
            "neighbours.svg",
            "path.svg",
            "sweep-curves.svg",
            "sweep.svg",
        ]
    );
    for (name, text) in &pictures {
        well_formed(name, text);
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
        assert!(!text.contains("-0.00\"") && !text.contains(">-0<"), "{name}");
        for color in text.split('#').skip(1) {
            let color = &color[..6];
            assert!(color[..2] == color[2..4] && color[..2] == color[4..], "{name}: #{color}");
        }
        assert!(text.contains("µm") || text.contains(" mm"), "{name} names no unit");
    }
}

fn well_formed(name: &str, text: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in text.split('<').skip(1) {
        let (inside, after) = tag.split_once('>').expect(name);
        assert!(inside.matches('"').count().is_multiple_of(2), "{name}: {tag}");
        assert!(!after.contains('&') || after.contains(';'), "{name}: {tag}");
        if let Some(closed) = inside.strip_prefix('/') {
            assert_eq!(open.pop(), Some(closed), "{name}");
        } else if !inside.ends_with('/') {
            open.push(inside.split(' ').next().unwrap());
        }
    }
    assert!(open.is_empty(), "{name}: {open:?}");
}

#[test]
fn what_is_printed_and_drawn() {
    let mut arguments = MOVE.to_vec();
    arguments.extend(["--sweep", "Lm=100:400:100"]);
    let study = study(&arguments);
    let printed: Vec<&str> =
        study.run.out.lines().filter(|line| !line.starts_with("in ")).collect();
    insta::with_settings!({ snapshot_path => "../snapshots/study" }, {
        insta::assert_snapshot!("printed", printed.join("\n"));
        insta::assert_snapshot!("picture", study.read("sweep.svg"));
    });
}

/// The folder is beside the CL file if none is named, and nothing else is written there.
#[test]
fn the_folder_is_beside_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::copy(common::root().join(MOVE[0]), &file).unwrap();
    let run = papers(&["study", file.to_str().unwrap(), "--machine", "disc-cutter"]);
    assert_eq!(run.code, 0, "{}", run.err);
    let mut names: Vec<String> = fs::read_dir(folder.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["part-study", "part.cls"]);
    assert!(Path::new(&folder.path().join("part-study/moves.csv")).is_file());
}

#[test]
fn refusals_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.cls");
    fs::write(&empty, "UNITS/MM\nRAPID\nGOTO/0,0,0,0,0,1\nEND-OF-PATH\n").unwrap();
    let empty = empty.to_str().unwrap();
    let with = |more: &[&'static str]| {
        let mut all = MOVE.to_vec();
        all.extend(more);
        all
    };
    let cases: [(Vec<&str>, i32, &str); 7] = [
        (with(&["--sweep", "Lm=100"]), 2, "NAME=FROM:TO:STEP"),
        (with(&["--sweep", "Lm=400:100:50"]), 2, "TO above FROM"),
        (with(&["--sweep", "Ln=100:200:50"]), 1, "Ln"),
        (with(&["--move", "2"]), 1, "the file has 1 cuts"),
        (with(&["--move", "0"]), 2, "--move"),
        (vec!["-", "--machine", "disc-cutter"], 1, "several times"),
        (
            vec![empty, "--machine", "disc-cutter", "--tool-length", "0"],
            1,
            "no cut between two positions",
        ),
    ];
    for (arguments, code, says) in cases {
        let out = folder.path().join("out");
        let mut all = vec!["study", "-o", out.to_str().unwrap()];
        all.extend(&arguments);
        let run = papers(&all);
        assert_eq!(run.code, code, "{arguments:?}: {}", run.err);
        assert!(run.err.contains(says), "{arguments:?}: {}", run.err);
        assert!(!out.exists(), "{arguments:?}");
    }
}

#[test]
fn a_study_takes_no_file_of_another_for_its_own() {
    for name in ["moves.csv", "sweep.csv", "left.svg"] {
        let folder = tempfile::tempdir().unwrap();
        fs::copy(common::root().join(MOVE[0]), folder.path().join("part.cls")).unwrap();
        fs::write(folder.path().join(name), "mine").unwrap();
        let told = format!("the study would overwrite ./{name}, which is of no study");
        for (into, parts) in [
            ("part.cls", &["part.cls is no folder"][..]),
            (".", &[&told, "name another folder with -o"]),
        ] {
            let arguments = ["study", "part.cls", "-m", "disc-cutter", "-o", into];
            let before = common::names(folder.path());
            let run = common::run(common::command().current_dir(&folder).args(arguments), b"");
            assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
            common::assert_contains(&run.err, parts);
            assert_eq!(common::names(folder.path()), before);
        }
        assert_eq!(fs::read_to_string(folder.path().join(name)).unwrap(), "mine");
    }
}
