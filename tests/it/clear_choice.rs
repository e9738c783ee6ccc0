//! What chooses minds bodies: the cut that hits something with one solution is made with the other, and is said to be;
//! mounts where something hits are not offered.

use std::fs;

use post_testkit::assert_contains;
use tempfile::TempDir;

use crate::common::{post_in, root, sample};

/// A table with a round plate, a tool setter that stands in front of it, and a tool.
const MACHINE: &str = "extends = \"ac-trunnion\"
name = \"with a setter\"
[fixture.plate]
cylinder = [[0, 0, 0], [0, 0, 20]]
radius = 140
[fixture.setter]
block = [[-30, -200, -60], [30, -146, 90]]
on = \"b\"
[fixture.head]
cylinder = [[0, 0, 402], [0, 0, 520]]
radius = 60
on = \"t\"
[tools.3]
length = 100
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 5], [40, 5]]
[clearance]
keep = 1
rapid_axes = \"together\"
";

/// A facet that leans by `lean` degrees to the side of Y that `sign` has.
fn facet(lean: f64, sign: f64) -> String {
    let (sine, cosine) = (libm::sin(lean.to_radians()) * sign, libm::cos(lean.to_radians()));
    let at = |x: f64, out: f64| {
        let (y, z) = (20.0 * sign + out * sine, 52.0 + out * cosine);
        format!("GOTO/{x:.4},{y:.4},{z:.4},0,{sine:.7},{cosine:.7}\n")
    };
    let moves = [
        "RAPID\n".to_owned() + &at(-60.0, 60.0),
        "RAPID\n".to_owned() + &at(-60.0, 0.0),
        "FEDRAT/MMPM,800\n".to_owned() + &at(60.0, 0.0),
        "RAPID\n".to_owned() + &at(60.0, 60.0),
    ];
    moves.concat()
}

fn job(machine: &str, moves: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let tool = "TLDATA/MILL,10,0,100,0,0\nLOAD/TOOL,3\nSPINDL/RPM,6000,CLW\n";
    fs::write(folder.path().join("setter.toml"), machine).unwrap();
    fs::write(folder.path().join("facet.cls"), format!("{tool}{moves}FINI\n")).unwrap();
    folder
}

/// The program and what is said while it is made, and what is said of its clearance if it is not clear.
fn made(folder: &TempDir, more: &[&str]) -> (String, String, Option<String>) {
    let words = ["-m", "setter.toml", "facet.cls", "-o", "facet.nc", "-q"];
    let run = post_in(folder.path(), &[&words, more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("facet.nc")).unwrap();
    let proof = post_in(folder.path(), &["clearance", "facet.nc", "-m", "setter.toml"]);
    assert!(proof.code < 2, "{}", proof.err);
    (program, run.err, (proof.code != 0).then_some(proof.err))
}

const CHOOSE: [&str; 2] = ["--set", "clearance.choose=true"];

#[test]
fn a_cut_that_hits_with_one_solution_is_made_with_the_other() {
    let folder = job(MACHINE, &facet(20.0, -1.0));
    let (program, _, hits) = made(&folder, &[]);
    assert_contains(&program, &["G0 A20.000 C0.000"]);
    assert_contains(&hits.unwrap(), &["plate hits setter"]);
    let (program, said, hits) = made(&folder, &CHOOSE);
    assert_eq!(hits, None);
    assert_contains(&program, &["G0 A-20.000 C180.000"]);
    assert_contains(
        &said,
        &["with the cheapest solutions plate would not stay clear of setter", "facet.cls:5"],
    );
}

/// Two facets that lean to either side: each is cut with the solution that is clear, the axes turned between them.
#[test]
fn each_pass_is_chosen_by_itself() {
    let folder = job(MACHINE, &(facet(20.0, 1.0) + &facet(20.0, -1.0)));
    let (_, _, hits) = made(&folder, &[]);
    assert!(hits.is_some());
    let (program, _, hits) = made(&folder, &CHOOSE);
    assert_eq!(hits, None, "{program}");
}

#[test]
fn what_hits_nothing_is_chosen_as_without_bodies() {
    let folder = job(MACHINE, &(facet(20.0, 1.0) + &facet(5.0, 1.0)));
    let (program, _, hits) = made(&folder, &[]);
    assert_eq!(hits, None);
    let (other, said, _) = made(&folder, &CHOOSE);
    assert_eq!(program, other);
    assert_eq!(said, "");
}

#[test]
fn where_every_solution_hits_that_is_said() {
    let behind = "[fixture.wall]\nblock = [[-30, 146, -60], [30, 200, 90]]\non = \"b\"\n";
    let folder = job(&format!("{MACHINE}{behind}"), &facet(20.0, -1.0));
    let (_, said, hits) = made(&folder, &CHOOSE);
    assert!(hits.is_some());
    assert_contains(&said, &["no solution was found with which plate stays clear of"]);
}

/// The other solution is beyond travel, which is said, and not that none stays clear.
#[test]
fn another_solution_that_travel_forbids_is_told_so() {
    let at = |lean: f64, x: f64, out: f64| {
        let (sine, cosine) = libm::sincos(-f64::to_radians(lean));
        let (y, z) = (-20.0 + out * sine, 52.0 + out * cosine);
        format!("GOTO/{x:.4},{y:.4},{z:.4},0,{sine:.7},{cosine:.7}\n")
    };
    let mut moves =
        format!("RAPID\n{}RAPID\n{}FEDRAT/MMPM,800\n", at(5.0, -60.0, 60.0), at(5.0, -60.0, 0.0));
    (6..=20).for_each(|lean| moves.push_str(&at(f64::from(lean), f64::from(lean) * 3.0, 0.0)));
    let said = |least: f64| {
        let folder = job(&format!("{MACHINE}[axis.A]\ntravel = [{least}, 30]\n"), &moves);
        let (_, said, hits) = made(&folder, &CHOOSE);
        assert!(hits.is_some());
        assert_contains(&said, &["plate does not stay clear of setter (at "]);
        assert!(!said.contains("no solution was found"), "{said}");
        said
    };
    let there = ["the other solution is beyond travel: A -", "and it ends at -6.5"];
    assert_contains(&said(-6.5), &there);
    let later = ["with another solution it does (C", "but the path does not come through with it"];
    assert_contains(&said(-10.0), &later);
}

/// An arm on the table, what stands in front of it and beside it, and a cut all around that hits the one with one solution at
/// one end, and the other with the other at the other end.
fn between_two() -> (String, String) {
    let machine = MACHINE.replace(
        "cylinder = [[0, 0, 0], [0, 0, 20]]\nradius = 140",
        "block = [[-30, -140, 0], [30, 0, 20]]",
    );
    let beside = "[fixture.beside]\nblock = [[138, -60, -60], [200, 60, 90]]\non = \"b\"\n";
    let lean = 20f64.to_radians();
    let at = |turn: f64, out: f64| {
        let (sine, cosine) = libm::sincos(turn.to_radians());
        let axis = [-libm::sin(lean) * sine, -libm::sin(lean) * cosine, libm::cos(lean)];
        let tip = [-20.0 * sine, -20.0 * cosine, 52.0];
        let [x, y, z] = [0, 1, 2].map(|place: usize| tip[place] + out * axis[place]);
        format!("GOTO/{x:.4},{y:.4},{z:.4},{:.7},{:.7},{:.7}\n", axis[0], axis[1], axis[2])
    };
    let mut moves = format!("RAPID\n{}RAPID\n{}FEDRAT/MMPM,800\n", at(0.0, 60.0), at(0.0, 0.0));
    (1..=90).for_each(|turn| moves.push_str(&at(f64::from(turn), 0.0)));
    moves.push_str(&format!("RAPID\n{}", at(90.0, 60.0)));
    (machine + beside, moves)
}

/// The tool is drawn back between them.
#[test]
fn a_cut_that_hits_with_either_solution_is_divided() {
    let (machine, moves) = between_two();
    let folder = job(&format!("{machine}[rewind]\ndistance = 100\n"), &moves);
    let (_, _, hits) = made(&folder, &[]);
    assert!(hits.is_some());
    let (program, said, hits) = made(&folder, &CHOOSE);
    assert_eq!(hits, None, "{program}{said}");
}

/// Where it cannot be, a solution that stays clear there is told with what it hits elsewhere.
#[test]
fn another_solution_that_hits_elsewhere_is_told_so() {
    let (machine, moves) = between_two();
    let machine =
        machine.replace("[[138, -60, -60], [200, 60, 90]]", "[[-200, -60, -60], [-138, 60, 90]]");
    let folder = job(&machine, &moves);
    let (_, said, hits) = made(&folder, &CHOOSE);
    assert!(hits.is_some());
    assert_contains(
        &said,
        &["does not stay clear of", "with another solution it does (C", " A -20.000", "in line "],
    );
    assert!(!said.contains("no solution was found"), "{said}");
}

/// `low_retracts` and `link` choose as `--clearance` does.
#[test]
fn ways_between_passes_choose_solutions_too() {
    let stock = "[stock]\nblock = [[-50, -18, 20], [50, 18, 48]]\n";
    let folder = job(&format!("{MACHINE}{stock}"), &facet(20.0, -1.0));
    let (asked, _, _) = made(&folder, &["--clearance"]);
    for way in ["clearance.low_retracts=true", "clearance.link=true"] {
        let (program, said, hits) = made(&folder, &["--set", way]);
        assert_eq!(hits, None);
        assert_contains(&program, &["G0 A-20.000 C180.000"]);
        assert_contains(&said, &["others are taken"]);
        let turns = |program: &str| -> Vec<String> {
            program.lines().filter(|line| line.contains("G0 A")).map(str::to_owned).collect()
        };
        assert_eq!(turns(&asked), turns(&program));
    }
}

/// `--clearance` chooses and proves.
#[test]
fn a_program_that_is_to_be_clear_is_chosen_so() {
    let folder = job(MACHINE, &facet(20.0, -1.0));
    let (program, said, hits) = made(&folder, &["--clearance"]);
    assert_eq!(hits, None);
    assert_contains(&program, &["G0 A-20.000 C180.000"]);
    assert_contains(&said, &["others are taken"]);
}

#[test]
fn a_mount_where_something_hits_is_not_offered() {
    let post = "[fixture.post]\ncylinder = [[60, 0, 0], [60, 0, 100]]\nradius = 10\n";
    let bare = MACHINE.find("[fixture.plate]").unwrap()..MACHINE.find("[tools.3]").unwrap();
    let mut machine = MACHINE.to_owned();
    machine.replace_range(bare, post);
    let folder = job(&machine, "");
    let blade = root().join(sample("blade.cls"));
    let blade = blade.to_str().unwrap();
    let words = ["-m", "setter.toml", blade, "-o", "blade.nc", "-q", "--clearance"];
    let here = post_in(folder.path(), &words);
    assert_eq!(here.code, 1);
    assert_contains(&here.err, &["post", "holder T3"]);
    let found = post_in(folder.path(), &["place", blade, "-m", "setter.toml", "--runs", "40"]);
    assert_eq!(found.code, 0, "{}", found.err);
    assert_contains(&found.out, &["it is not proven that nothing hits anything", "clearance  "]);
    let mount = found.out.lines().last().unwrap().split(' ').next_back().unwrap();
    let there = post_in(folder.path(), &[&words[..], &["--mount", mount]].concat());
    assert_eq!(there.code, 0, "{}", there.err);
}
