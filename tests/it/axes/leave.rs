//! `[control] leave`: a tool that lies or hangs goes out of a bore along its own axis, then to positions of the machine, and
//! comes back the other way round.

use super::*;
use post_testkit::repository;

/// A machine with a way off the part that its linear axes do not have.
struct Lying {
    name: &'static str,
    /// The machine file; the keys that each case adds are laid over it.
    file: String,
    leave: &'static str,
    /// What is printed of `then`, in its order.
    then: &'static [&'static str],
    /// What it is refused with without `leave`.
    refused: &'static str,
    /// The axis of the bore, and how far the tip may be off its line, mm.
    axis: V,
    off: f64,
}

const DISTANCE: f64 = 80.0;

/// More digits than a control has, so that what is seen is no rounding.
const FINE: &str = "[control.fanuc]\ndecimals = 5\nrotary_decimals = 6\n";

fn chain(name: &str) -> String {
    fs::read_to_string(repository().join(format!("tests/chains/{name}.toml"))).unwrap()
}

fn lying() -> [Lying; 5] {
    let library = |name: &str, more: &str| format!("extends = {name:?}\n{more}");
    [
        Lying {
            name: "head that hangs the tool",
            file: library("head-head", "[control]\ntcp = \"post\"\n"),
            leave: "leave = { distance = 80, then = { Z = \"max\", X = -2500 } }",
            then: &["Z9000.", "X-2500."],
            refused: "is not proven to lead it away from the part",
            axis: lean(104.0, 30.0),
            off: 0.001,
        },
        Lying {
            name: "the same, the control keeps the tip",
            file: library("head-head", "[control]\ntcp = \"control\"\n"),
            leave: "leave = { distance = 80, then = { Y = \"min\", Z = \"max\" } }",
            then: &["Y-5000.", "Z9000."],
            refused: "is not proven to lead it away from the part",
            axis: lean(104.0, 30.0),
            off: 0.001,
        },
        Lying {
            name: "mill-turn without tool centre point control",
            file: library("mill-turn", "[control]\ntcp = \"post\"\n"),
            leave: "leave = { along = \"tool\", distance = 80, then = { X = \"max\", Z = 700 } }",
            then: &["X60.", "Z700."],
            refused: "error[length-axis]",
            axis: V::new(0.8, 0.0, 0.6),
            off: 0.001,
        },
        Lying {
            name: "swivel column",
            file: chain("swivel-column").replace("tolerance = 0.05", "tolerance = 0.001"),
            leave: "leave = { distance = 80, then = { X = \"min\", Z = \"max\" } }",
            then: &["X-700.", "Z400."],
            refused: "is not proven to lead it away from the part",
            axis: lean(100.0, 165.0),
            off: 0.001,
        },
        Lying {
            name: "arm",
            file: chain("six-axis-arm")
                .lines()
                .filter(|line| !line.starts_with("park"))
                .collect::<Vec<_>>()
                .join("\n"),
            leave: "leave = { distance = 80, then = { C = 30, B = -30 } }",
            then: &["C30.", "B-30."],
            refused: "has no linear axis to lead the tool off the part with",
            axis: lean(25.0, 200.0),
            off: 0.1,
        },
    ]
}

/// The mouth of the bore: the tip stands there at rapid, and bores 40 mm deep.
fn mouth(axis: V) -> V {
    V::new(15.0, -10.0, 60.0) + axis * 2.0
}

/// Two tools in one bore; both are still in it when they must leave.
fn bores(axis: V) -> String {
    let mut text = cl();
    for tool in [1, 2] {
        text = text
            .line(&format!("LOADTL / {tool}"))
            .line("SPINDL / RPM, 6000, CLW")
            .rapid(mouth(axis), axis)
            .cut(mouth(axis) - axis * 40.0, axis);
    }
    text.end()
}

impl Lying {
    /// The machine file with other lines under `[control]`.
    fn with(&self, line: &str) -> String {
        let at = self.file.find("[control]\n").unwrap() + "[control]\n".len();
        let (before, behind) = self.file.split_at(at);
        format!("{before}{line}\n{behind}\n{FINE}")
    }

    fn run(&self, line: &str) -> Run {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        fs::write(at("machine.toml"), self.with(line)).unwrap();
        fs::write(at("bore.ncl"), bores(self.axis)).unwrap();
        let planes = ["--set", "control.planes=false"];
        let arguments =
            ["-q", "--verify", "--tool-length", "100", planes[0], planes[1], "-o", "-", "-m"];
        let mut arguments = arguments.map(str::to_owned).to_vec();
        arguments.extend([at("machine.toml"), at("bore.ncl")]);
        post(&arguments)
    }

    fn model(&self) -> Model {
        let mut own: Table = self.with("").parse().unwrap();
        let table = match own.remove("extends") {
            Some(base) => {
                let mut table = table(base.as_str().unwrap());
                overlay(&mut table, own);
                table
            }
            None => own,
        };
        Model::from_table(table, None)
    }

    /// How far a tip is off the line of the bore, and how far out of its mouth it stands, mm.
    fn place(&self, tip: V) -> [f64; 2] {
        let way = tip - mouth(self.axis);
        [way.cross(&self.axis).norm(), way.dot(&self.axis)]
    }
}

/// The words half way between two blocks, and at other shares.
fn between(from: &Block, to: &Block, share: f64) -> Vec<f64> {
    let pairs = from.words.iter().zip(&to.words);
    pairs.map(|(from, to)| from + (to - from) * share).collect()
}

#[test]
fn a_tool_leaves_a_bore_along_it_and_comes_back_along_it() {
    for lying in lying() {
        let what = lying.name;
        let run = lying.run(lying.leave);
        assert_eq!(run.code, 0, "{what}:\n{}\n{}", run.err, run.out);
        let model = lying.model();
        let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
        let lines: Vec<&str> = run.out.lines().collect();
        let blocks = blocks(&run.out, &names, &[]);
        let pose = |words: &[f64]| model.pose(words, 100.0);
        let deep = |block: &Block| lying.place(pose(&block.words).tip)[1] < -39.9;
        let bottoms: Vec<usize> = (1..blocks.len()).filter(|at| deep(&blocks[*at])).collect();
        assert_eq!(bottoms.len(), 2, "{what}:\n{}", run.out);
        for bottom in bottoms {
            // In and out: one block each, or as many as it takes axes that turn, up to a line of the machine's.
            let machine = |line: usize| lines[line - 1].starts_with("G53");
            let apart = |a: &Block, b: &Block| (a.line..b.line).any(machine);
            let mut first = bottom;
            while first > 0 && !apart(&blocks[first - 1], &blocks[first]) {
                first -= 1;
            }
            let mut last = bottom;
            while last + 1 < blocks.len() && !apart(&blocks[last], &blocks[last + 1]) {
                last += 1;
            }
            // A control that keeps the tip goes to the place on the line with all its words in one block, behind a turn.
            let stands = |at: usize| lying.place(pose(&blocks[at].words).tip)[1];
            let on_line = (first..=bottom).find(|at| stands(*at) > DISTANCE - 0.1);
            let first = on_line.unwrap_or_else(|| panic!("{what}: no way in\n{}", run.out));
            for (at, wanted) in [(first, DISTANCE), (last, DISTANCE - 40.0)] {
                let [off, out] = lying.place(pose(&blocks[at].words).tip);
                let good = off <= lying.off && (out - wanted).abs() <= lying.off + 0.002;
                assert!(good, "{what}: {off} mm off, {out} mm out\n{}", run.out);
            }
            for at in first..last {
                for share in 0..=20 {
                    let words = between(&blocks[at], &blocks[at + 1], f64::from(share) / 20.0);
                    let [off, _] = lying.place(pose(&words).tip);
                    let line = lines[blocks[at + 1].line - 1];
                    assert!(off <= lying.off, "{what}: {off} mm off in {line}\n{}", run.out);
                    let leans = angle(pose(&words).axis, lying.axis);
                    assert!(leans < 0.06, "{what}: {leans}° in {line}");
                }
            }
            // Then the axes of the machine, one a line, in the order written.
            let behind = lines[blocks[last].line..].iter();
            let mut gone = behind.filter(|line| line.starts_with("G53"));
            for then in lying.then {
                let line = gone.next().copied().unwrap_or_default();
                assert!(
                    line.contains(then) && line.split_whitespace().count() <= 3,
                    "{what}: {line} is not {then}\n{}",
                    run.out
                );
            }
        }
    }
}

#[test]
fn without_leave_such_a_machine_is_refused() {
    for lying in lying() {
        let run = lying.run("");
        assert_eq!(run.code, 1, "{}:\n{}", lying.name, run.out);
        assert!(run.err.contains(lying.refused), "{}: {}", lying.name, run.err);
    }
}

/// The way that travel leaves is less than what is asked for: it is gone, and told.
#[test]
fn a_way_that_travel_ends_is_told() {
    let short = on("head-head").file(
        "[axis.Z]\ntravel = [-2000, 300]\n[control]\nleave = { distance = 500, then = { Z = \"max\" } }\n",
    );
    let cl = bores(V::z());
    let run = short.run(&cl);
    assert_eq!(run.code, 0, "{}", run.err);
    let told = run.err.contains("warning[retract]: the tool leaves the part by")
        && run.err.contains("[control] leave says 500");
    assert!(told, "{}", run.err);
    // Z stands 100 mm over the tip, which ends 22 mm over the origin; 300 mm is the end of its travel.
    assert!(run.err.contains("by 177.9"), "{}", run.err);
}

#[test]
fn the_check_says_how_the_tool_leaves() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("machine.toml");
    let [lying, ..] = lying();
    fs::write(&file, lying.with(lying.leave)).unwrap();
    let mut check = crate::common::command();
    let run = crate::common::run(check.args(["check", file.to_str().unwrap()]), b"");
    let told = "leaves the part   80 mm straight back along the tool, then Z to 9000 mm, then X to -2500 mm\n";
    assert!(run.out.contains(told), "{}{}", run.err, run.out);
}

#[test]
fn what_leave_says_is_checked_against_the_machine() {
    for (leave, said) in [
        ("leave = { distance = 0 }", "leave draws the tool back by 0 mm"),
        ("leave = { distance = 50, then = { Q = \"max\" } }", "the machine has no axis Q"),
        (
            "leave = { distance = 50, then = { Z = 10000 } }",
            "Z cannot stand at 10000: its travel is -2000 to 9000",
        ),
        (
            "leave = { distance = 50, then = { A = 0, Z = \"max\" } }",
            "the first of then is a rotary axis",
        ),
        (
            "leave = { distance = 50 }\nretract = { Z = 100 }",
            "retract and leave both say how the tool leaves the part",
        ),
        ("leave = { along = \"part\", distance = 50 }", "there is no value `part` here"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("machine.toml");
        fs::write(&file, format!("extends = \"head-head\"\n[control]\n{leave}\n")).unwrap();
        let run = crate::common::run(
            crate::common::command().args(["check", file.to_str().unwrap()]),
            b"",
        );
        assert_eq!(run.code, 1, "{leave}: {}", run.out);
        assert!(run.err.contains(said), "{leave}: {}", run.err);
    }
}

/// Two operations on two faces of a part.
const TWO_FACES: &str = "TOOL PATH/TOP,TOOL,MILL\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,6000,CLW\nRAPID\nGOTO/10,8,60,0,0,1\n\
    FEDRAT/400,MMPM\nGOTO/10,8,30,0,0,1\nGOTO/25,9,30,0,0,1\nRAPID\nGOTO/25,9,60,0,0,1\nEND-OF-PATH\n\
    TOOL PATH/SIDE,TOOL,MILL\nRAPID\nGOTO/-20,60,5,0,1,0\nFEDRAT/400,MMPM\nGOTO/-20,40,5,0,1,0\nGOTO/-10,40,7,0,1,0\n\
    RAPID\nGOTO/-10,60,7,0,1,0\nEND-OF-PATH\nFINI\n";

/// Drawn back along its own line and no more, as the machine file has it: the program is read back as good, a turn nearer to the
/// part is not, and that the first turn is made wherever the tool stands is told.
#[test]
fn a_tool_that_is_drawn_back_alone_is_read_back() {
    let leave = "control.leave={ along = \"tool\", distance = 100 }";
    let folder = crate::common::with_file("two.cls", TWO_FACES);
    let with = ["-q", "-m", "vmc-a", "--tool-length", "60", "--set", leave];
    let run = |more: &[&str]| crate::common::post_in(folder.path(), &[&with[..], more].concat());
    let posted = run(&["two.cls", "-o", "p.nc", "--verify"]);
    assert_eq!(posted.code, 0, "{}", posted.err);
    let told = "warning[retract]: rotary axes turn as the program begins, with the tool where the operator left it";
    assert!(posted.err.contains(told), "{}", posted.err);
    let program = fs::read_to_string(folder.path().join("p.nc")).unwrap();
    // Where A turns between the faces the tool stands 100 mm over the last point: 15 mm are too near.
    let drawn_back = "(SIDE)\nZ160.000\nG49\nA270.000\n";
    let near = program.replace(drawn_back, &drawn_back.replace("160", "75"));
    assert_ne!(near, program);
    fs::write(folder.path().join("near.nc"), near).unwrap();
    let verify = ["verify", "near.nc", "--against", "two.cls", "--posted"];
    let all = [&verify[..1], &with[..], &verify[1..]].concat();
    let read = crate::common::post_in(folder.path(), &all);
    assert!(read.code == 1 && read.err.contains("and the tool is not retracted"), "{}", read.err);
}
