//! Turning: the part turns, X is a diameter, feeds are a revolution, and the control keeps the cutting speed. How long a cut
//! takes is added up here from how fast the spindle turns on the way.

use crate::common;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

use common::{Run, post, read_json};
use post_testkit::randomised;

/// A point of a contour: radius and Z, mm.
type Place = [f64; 2];

/// How the spindle turns: m/min and the most revolutions a minute, or revolutions a minute.
#[derive(Clone, Copy)]
enum Speed {
    Surface(f64, f64),
    Fixed(f64),
}

impl Speed {
    fn words(self) -> String {
        match self {
            Self::Surface(speed, most) => format!("SPINDL/{speed},SMM,MAXRPM,{most},CLW"),
            Self::Fixed(rpm) => format!("SPINDL/{rpm},RPM,CLW"),
        }
    }

    fn rpm(self, radius: f64) -> f64 {
        match self {
            Self::Surface(speed, most) => (speed * 1000.0 / (TAU * radius)).min(most),
            Self::Fixed(rpm) => rpm,
        }
    }
}

fn turned(path: &[Place], speed: Speed, feed: f64) -> String {
    let mut text = format!("MODE/TURN\nUNITS/MM\nLOADTL/1\n{}\nCOOLNT/ON\n", speed.words());
    let [x, z] = path[0];
    writeln!(text, "RAPID\nGOTO/{:.4},0,{:.4}\nFEDRAT/{feed},MMPR", x + 5.0, z + 2.0).unwrap();
    path.iter().for_each(|[x, z]| writeln!(text, "GOTO/{x:.4},0,{z:.4}").unwrap());
    text + "RAPID\nGOTO/60,0,10\nFINI\n"
}

fn run(folder: &std::path::Path, cl: &str, set: &[&str]) -> Run {
    let part = folder.join("part.cls");
    fs::write(&part, cl).unwrap();
    let nc = folder.join("part.nc");
    let _ = fs::remove_file(&nc);
    let json = folder.join("part.json");
    let mut all = vec!["-q", "-m", "lathe-xz", "--tool-length", "40", "--verify"];
    set.iter().for_each(|set| all.extend(["--set", set]));
    all.extend(["--summary", json.to_str().unwrap()]);
    all.extend(["-o", nc.to_str().unwrap(), part.to_str().unwrap()]);
    let mut run = post(&all);
    run.out = fs::read_to_string(&nc).unwrap_or_default();
    run
}

/// A program read back against the CL file of [`run`].
fn verified(folder: &std::path::Path, nc: &std::path::Path, set: &[&str]) -> Run {
    let part = folder.join("part.cls");
    let mut all = vec!["verify", nc.to_str().unwrap(), "-m", "lathe-xz", "--tool-length", "40"];
    set.iter().for_each(|set| all.extend(["--set", set]));
    all.extend(["--against", part.to_str().unwrap()]);
    post(&all)
}

/// Minutes of the ways of a contour at a feed a revolution.
fn minutes(path: &[Place], speed: Speed, feed: f64) -> f64 {
    let of = |pair: &[Place]| {
        let [from, to] = [pair[0], pair[1]];
        let way = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let pieces = 2000;
        let at =
            |piece: i32| from[0] + (to[0] - from[0]) * (f64::from(piece) + 0.5) / f64::from(pieces);
        (0..pieces)
            .map(|piece| way / f64::from(pieces) / (feed * speed.rpm(at(piece))))
            .sum::<f64>()
    };
    path.windows(2).map(of).sum()
}

#[test]
fn a_contour_is_turned_in_diameters_at_a_feed_a_revolution() {
    let (rounds, mut rng) = randomised(12, 17);
    for round in rounds {
        let folder = tempfile::tempdir().unwrap();
        let mut path: Vec<Place> = vec![[rng.range(10.0, 20.0), 0.0]];
        for _ in 0..6 {
            let [x, z] = path[path.len() - 1];
            path.push([x + rng.range(0.0, 4.0), z - rng.range(1.0, 8.0)]);
        }
        path.iter_mut().flatten().for_each(|value| *value = (*value * 1e4).round() / 1e4);
        let speed = match rng.pick(2) {
            // The most revolutions are reached nowhere, somewhere, or everywhere.
            0 => Speed::Surface(180.0, [4000.0, 1900.0, 300.0][rng.pick(3)]),
            _ => Speed::Fixed(900.0),
        };
        let feed = [0.1, 0.25, 0.333][rng.pick(3)];
        let dialect = ["fanuc", "siemens", "linuxcnc", "mitsubishi"][rng.pick(4)];
        let set = [format!("control.dialect={dialect}")];
        let made = run(folder.path(), &turned(&path, speed, feed), &[&set[0]]);
        assert_eq!(made.code, 0, "round {round}, {dialect}: {}", made.err);
        let program = &made.out;
        let lines: Vec<&str> = program.lines().collect();
        // The feed of G96 is one a revolution on the 840D.
        let kept = dialect == "siemens" && matches!(speed, Speed::Surface(..));
        let code = if kept { "G1" } else { "G95" };
        let has = |line: &str, code: &str| line.split_whitespace().any(|word| word == code);
        let first = lines.iter().position(|line| has(line, code)).expect(program);
        assert!(has(lines[first], "G1"), "{program}");
        let said = format!("F{feed}");
        assert!(lines[first].split_whitespace().any(|word| word == said), "{said}\n{program}");
        // The contour is behind the way down to its first point.
        let mut stands = [f64::NAN; 2];
        let mut met = Vec::new();
        for line in &lines[first..first + path.len()] {
            for word in line.split_whitespace() {
                let number = |name: char| {
                    word.strip_prefix(name)?.trim_start_matches('=').parse::<f64>().ok()
                };
                stands[0] = number('X').map_or(stands[0], |word| word / 2.0);
                stands[1] = number('Z').unwrap_or(stands[1]);
            }
            met.push(stands);
        }
        for (met, wanted) in met.iter().zip(&path) {
            let off = [0, 1].map(|part| (met[part] - wanted[part]).abs());
            assert!(off[0] < 5.1e-4 && off[1] < 5.1e-4, "{met:?} {wanted:?}\n{program}");
        }
        match speed {
            Speed::Surface(speed, most) => {
                assert!(program.contains(&format!("S{speed} M")), "{program}");
                assert!(program.contains("G96 "), "{program}");
                let limit = format!("{most}");
                assert!(program.contains(&limit), "{program}");
            }
            Speed::Fixed(rpm) => {
                assert!(!program.contains("G96"), "{program}");
                assert!(program.contains(&format!("S{rpm} M")), "{program}");
            }
        }
        let summary = read_json(&folder.path().join("part.json"));
        let [x, z] = path[0];
        let whole = [&[[x + 5.0, z + 2.0]], path.as_slice()].concat();
        let wanted = minutes(&whole, speed, feed) * 60.0;
        let told = summary["cutting_time_s"].as_f64().unwrap();
        assert!((told - wanted).abs() < 0.003 * wanted, "{told} {wanted}\n{program}");
    }
}

const DIALECTS: [&str; 4] = ["fanuc", "siemens", "linuxcnc", "mitsubishi"];

/// Faced over the centre, where the spindle is fastest and X would go faster than its largest feed: F is lower all the way,
/// and that is right. A larger F is told.
#[test]
fn a_face_is_slowed_for_the_axis_that_would_be_too_fast_at_its_centre() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[30.0, 0.0], [-0.5, 0.0]];
    for dialect in DIALECTS {
        let speed = Speed::Surface(180.0, 4000.0);
        let set = [format!("control.dialect={dialect}"), "axis.X.max_feed=300".to_owned()];
        let set = [set[0].as_str(), set[1].as_str()];
        let made = run(folder.path(), &turned(&path, speed, 0.25), &set);
        assert_eq!(made.code, 0, "{dialect}: {}", made.err);
        // 300 mm/min at 4000 turns a minute.
        let program = &made.out;
        assert!(program.contains(" F0.075"), "{dialect}: {program}");
        let nc = folder.path().join("quick.nc");
        fs::write(&nc, program.replace(" F0.075", " F0.08")).unwrap();
        let told = verified(folder.path(), &nc, &set);
        assert_eq!(told.code, 1, "{dialect}: {}{}", told.out, told.err);
        assert!(told.err.contains("320.0 mm/min, and its max_feed is 300"), "{}", told.err);
    }
}

/// A feed a minute at a constant cutting speed: on the 840D a code of its own, which keeps the cutting speed.
#[test]
fn feeds_a_minute_and_a_revolution_change_at_a_constant_cutting_speed() {
    let folder = tempfile::tempdir().unwrap();
    let cl = turned(&[[30.0, 0.0], [30.0, -20.0]], Speed::Surface(180.0, 4000.0), 0.25);
    let cl = cl.replace("RAPID\nGOTO/60", "FEDRAT/200,MMPM\nGOTO/35,0,-25\nFEDRAT/0.1,MMPR\nGOTO/35,0,-40\nSPINDL/600,RPM,CLW\nGOTO/36,0,-45\nRAPID\nGOTO/60");
    for dialect in DIALECTS {
        let set = format!("control.dialect={dialect}");
        let made = run(folder.path(), &cl, &[&set]);
        assert_eq!(made.code, 0, "{dialect}: {}", made.err);
        let of_feed: Vec<&str> = made
            .out
            .split_whitespace()
            .filter(|word| matches!(*word, "G94" | "G95" | "G96" | "G961" | "G97" | "G971"))
            .collect();
        let wanted: &[&str] = match dialect {
            "siemens" => &["G94", "G96", "G961", "G96", "G97"],
            _ => &["G94", "G96", "G95", "G94", "G95", "G97"],
        };
        // LinuxCNC's first block ends a cutting speed that was left on.
        let own = usize::from(dialect == "linuxcnc");
        let met = [&of_feed[..1], &of_feed[1 + own..wanted.len() + own]].concat();
        assert_eq!(met, wanted, "{dialect}: {}", made.out);
        // The 840D drops the cutting speed at a G95.
        if dialect == "siemens" {
            let nc = folder.path().join("dropped.nc");
            let dropped = made.out.replacen("G961 ", "G94 ", 1);
            assert_ne!(dropped, made.out);
            fs::write(&nc, dropped).unwrap();
            let told = verified(folder.path(), &nc, &[&set]);
            assert_eq!(told.code, 1, "{}{}", told.out, told.err);
            assert!(told.err.contains("the spindle turns clockwise at"), "{}", told.err);
        }
    }
}

#[test]
fn what_is_wrong_in_a_program_that_turns_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0], [25.0, -31.0]];
    let made = run(folder.path(), &turned(&path, Speed::Surface(200.0, 3000.0), 0.25), &[]);
    assert_eq!(made.code, 0, "{}", made.err);
    let wrong = |from: &str, to: &str, says: &str| {
        let text = made.out.replacen(from, to, 1);
        assert_ne!(text, made.out, "{from}\n{}", made.out);
        let nc = folder.path().join("other.nc");
        fs::write(&nc, text).unwrap();
        let told = verified(folder.path(), &nc, &[]);
        assert_eq!(told.code, 1, "{from}: {}{}", told.out, told.err);
        assert!(told.err.contains(says), "{from}: {says}\n{}", told.err);
    };
    wrong("F0.25", "F0.3", "feed is above");
    wrong("F0.25", "F0.2", "feed is below");
    wrong("G95 ", "G94 ", "feed is below");
    wrong("S200 M", "S250 M", "cutting speed");
    let limits = "200 m/min of cutting speed, at most 3500/min in a cut, and the CL file asks that it turns clockwise at 200 m/min of cutting speed, at most 3000/min";
    wrong("S3000", "S3500", limits);
    wrong("X44.000", "X44.500", "off the CL path");
}

/// Words of X count as the control is told: diameters under G7, DIAMON, radii under G8, DIAMOF. A program says it ahead of
/// its first word; the other one doubles or halves the part, and is found.
#[test]
fn a_program_says_whether_its_words_are_diameters() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let cl = turned(&path, Speed::Surface(200.0, 3000.0), 0.25);
    for (dialect, words) in [("linuxcnc", ["G7", "G8"]), ("siemens", ["DIAMON", "DIAMOF"])] {
        for (is, has) in [("2 * X", 0), ("X", 1)] {
            let (word, other) = (words[has], words[1 - has]);
            let set = [format!("control.dialect={dialect}"), format!("word.X.is=\"{is}\"")];
            let set = [set[0].as_str(), set[1].as_str()];
            let made = run(folder.path(), &cl, &set);
            assert_eq!(made.code, 0, "{dialect} {is}: {}", made.err);
            let said = |line: &&str| line.split(' ').any(|own| own == word);
            let line = made.out.lines().find(said).unwrap_or_else(|| panic!("{}", made.out));
            let first = made.out.lines().position(|own| own == line).unwrap();
            let words_of_x = |line: &str| {
                !line.starts_with(['(', ';']) && line.split(' ').any(|own| own.starts_with('X'))
            };
            assert!(!made.out.lines().take(first).any(words_of_x), "{}", made.out);
            let told = |to: &str| {
                let own: Vec<&str> =
                    line.split(' ').map(|own| if own == word { to } else { own }).collect();
                let nc = folder.path().join("other.nc");
                fs::write(&nc, made.out.replacen(line, &own.join(" "), 1)).unwrap();
                verified(folder.path(), &nc, &set)
            };
            let right = told(word);
            assert_eq!((right.code, right.err.as_str()), (0, ""), "{dialect} {is}");
            let wrong = told(other);
            assert!(wrong.code == 1 && wrong.err.contains("off the CL path"), "{}", wrong.err);
            let unsaid = told("");
            let says = "the program does not set diameters or radii (";
            assert!(unsaid.err.contains(says), "{dialect} {is}: {}", unsaid.err);
        }
    }
}

/// Under DIAM90 a way is a radius and a position a diameter, under DIAMON both are diameters.
#[test]
fn ways_are_radii_under_diam90() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let set = ["control.dialect=siemens"];
    let made = run(folder.path(), &turned(&path, Speed::Fixed(900.0), 0.25), &set);
    assert_eq!(made.code, 0, "{}", made.err);
    // From a diameter of 30 mm to 44 mm.
    for (mode, way, code) in
        [("DIAM90", 7, 0), ("DIAMON", 14, 0), ("DIAMON", 7, 1), ("DIAM90", 14, 1), ("DIAMOF", 7, 1)]
    {
        let words = |word: &str| match word.starts_with("X44.") {
            true => format!("X=IC({way}.)"),
            false => word.replace("DIAMON", mode),
        };
        let lines = made.out.lines().map(|line| line.split(' ').map(words).collect::<Vec<_>>());
        let text: Vec<String> = lines.map(|words| words.join(" ")).collect();
        let text = text.join("\n") + "\n";
        assert!(text.contains("=IC("), "{text}");
        let nc = folder.path().join("other.nc");
        fs::write(&nc, text).unwrap();
        let told = verified(folder.path(), &nc, &set);
        assert_eq!(told.code, code, "{mode} {way}: {}{}", told.out, told.err);
    }
}

/// The lengths of a turning tool act in X and Z under G18 alone on the 840D.
#[test]
fn the_840d_turns_in_g18() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let set = ["control.dialect=siemens"];
    let made = run(folder.path(), &turned(&path, Speed::Fixed(900.0), 0.25), &set);
    assert_eq!(made.code, 0, "{}", made.err);
    assert!(made.out.contains("G18 ") && !made.out.contains("G17"), "{}", made.out);
    let told = |to: &str| {
        let nc = folder.path().join("other.nc");
        // Wherever it stands, alone too.
        fs::write(&nc, made.out.replace("G18", to)).unwrap();
        verified(folder.path(), &nc, &set)
    };
    let right = told("G18");
    assert_eq!((right.code, right.err.as_str()), (0, ""));
    for plane in ["G17", "G19"] {
        let wrong = told(plane);
        let says =
            format!("the plane is {plane}, and the lengths of a turning tool act in X and Z");
        assert!(wrong.code == 1 && wrong.err.contains(&says), "{}", wrong.err);
    }
    let unsaid = told("");
    assert!(unsaid.err.contains("the program does not set plane (G1"), "{}", unsaid.err);
}

#[test]
fn what_is_no_turning_is_refused_with_what_helps() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0]];
    let refused = |cl: &str, set: &[&str], says: [&str; 2]| {
        let made = run(folder.path(), cl, set);
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{cl}\n{}", made.err);
        for says in says {
            assert!(made.err.contains(says), "{says}\n{}", made.err);
        }
    };
    let good = turned(&path, Speed::Surface(200.0, 3000.0), 0.25);
    let with = |word: &str| good.replacen("COOLNT/ON", &format!("{word}\nCOOLNT/ON"), 1);
    let still = ["spindle.surface_speed=false"];
    refused(&good, &still, ["MODE/TURN", "surface_speed = true"]);
    refused(&with("THREAD/TURN"), &[], ["THREAD moves the tool", "angle of the spindle"]);
    refused(&with("LATHE/ROUGH,2"), &[], ["LATHE moves the tool", "GOTO and CIRCLE"]);
    refused(&with("SWITCH/9"), &[], ["SWITCH changes where", "[cl.words]"]);
    refused(&with("TLDATA/THREAD,1,0,0,1"), &[], ["TLDATA/THREAD", "[cl.words]"]);
    refused(&with("CUTCOM/RIGHT"), &[], ["CUTCOM", "CUTCOM/OFF"]);
    refused(&good.replace("GOTO/15.0000,0,-20", "GOTO/15,1,-20"), &[], ["out-of-reach", ""]);
}

/// Words of the three systems of Fanuc's lathes, written and read back; what is a cycle there, or a way, is refused by name.
#[test]
fn a_fanuc_of_lathes_has_the_words_of_its_system() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let cl = turned(&path, Speed::Surface(200.0, 3000.0), 0.25);
    let cl = cl.replace("RAPID\nGOTO/60", "FEDRAT/200,MMPM\nGOTO/25,0,-31\nRAPID\nGOTO/60");
    let systems: [(&str, &[&str]); 3] = [
        ("A", &["G21", "G18 G40 G80 G98", "T0101", "G50 S3000", "G99 G1", "G98 X50.000"]),
        ("B", &["G21", "G18 G40 G80 G90 G94", "T0101", "G92 S3000", "G95 G1", "G94 X50.000"]),
        ("C", &["G71", "G18 G40 G80 G90 G94", "T0101", "G92 S3000", "G95 G1", "G94 X50.000"]),
    ];
    for (system, words) in systems {
        let set = format!("control.fanuc.system=\"{system}\"");
        let made = run(folder.path(), &cl, &[&set]);
        assert_eq!(made.code, 0, "{system}: {}", made.err);
        let mut rest = made.out.as_str();
        for word in words {
            let found = rest.find(word).unwrap_or_else(|| panic!("{system} {word}: {}", made.out));
            rest = &rest[found + word.len()..];
        }
        for none in ["M6", "G43", "G49", "G69", "G91", "H1"] {
            assert!(!made.out.contains(none), "{system} {none}: {}", made.out);
        }
        assert_eq!(made.out.contains("G90"), system != "A", "{}", made.out);
        let told = |from: &str, to: &str| {
            let text = made.out.replacen(from, to, 1);
            assert_ne!(text, made.out, "{from}\n{}", made.out);
            let nc = folder.path().join("other.nc");
            fs::write(&nc, text).unwrap();
            let told = verified(folder.path(), &nc, &[&set]);
            assert_eq!(told.code, 1, "{system} {from} {to}: {}{}", told.out, told.err);
            told.err
        };
        let wrong = |from: &str, to: &str, says: &str| {
            let err = told(from, to);
            assert!(err.contains(says), "{system} {from} {to}: {says}\n{err}");
        };
        wrong("T0101", "T0201", "cuts with tool 2");
        wrong("T0101", "T0102", "register 2");
        wrong("T0101", "T0100", "without length compensation");
        wrong("S3000", "S3500", "the spindle turns");
        // The limit of another system is a cycle here, or scaling.
        let [limit, other] = if system == "A" { ["G50", "G92"] } else { ["G92", "G50"] };
        wrong(&format!("{limit} S"), &format!("{other} S"), &format!("{other} is not run"));
        let cycle =
            ["G90", "G77", "G20"][["A", "B", "C"].iter().position(|s| *s == system).unwrap()];
        wrong("X44.000", &format!("{cycle} X44.000"), &format!("{cycle} is not run"));
        wrong("X44.000", "G42 X44.000", "G42 is not run");
        wrong("Z-20.000", "W-20.000", "W is no axis");
    }
}

/// Where the imaginary tip lies from the centre of the nose, X and Z in radii, by the quadrant from 1: Haas' operator's manual.
const QUADRANTS: [[f64; 2]; 9] = [
    [1.0, 1.0],
    [1.0, -1.0],
    [-1.0, -1.0],
    [-1.0, 1.0],
    [0.0, 1.0],
    [1.0, 0.0],
    [0.0, -1.0],
    [-1.0, 0.0],
    [0.0, 0.0],
];

/// The quadrants count as the words do: a turret on the other side of the part, whose X counts up away from the line too, has
/// the same program.
#[test]
fn a_turret_on_the_other_side_has_the_same_quadrants() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let near = turned(&path, Speed::Fixed(900.0), 0.25);
    let far = turned(&path.map(|[x, z]| [-x, z]), Speed::Fixed(900.0), 0.25);
    let far = far.replace("GOTO/-10.0000", "GOTO/-20.0000").replace("GOTO/60,", "GOTO/-60,");
    let words = |made: Run| {
        assert_eq!(made.code, 0, "{}", made.err);
        let lines = made.out.lines().filter(|line| line.contains('X'));
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    for quadrant in 1..=9 {
        let quadrant = format!("tools.1.quadrant={quadrant}");
        let nose = ["cl.points=\"centre\"", "tools.1.nose=0.8", quadrant.as_str()];
        let other = ["axis.X.linear=[-1, 0, 0]", "tool.gauge=[-320, 0, 470]"];
        let here = words(run(folder.path(), &near, &nose));
        let there = words(run(folder.path(), &far, &[&nose[..], &other].concat()));
        assert_eq!(here, there, "{quadrant}");
    }
}

/// C that leads the part to positions cannot be led while its spindle turns the part.
#[test]
fn on_a_chain_with_c_nothing_is_turned() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0]];
    let part = folder.path().join("part.cls");
    for speed in [Speed::Fixed(900.0), Speed::Surface(200.0, 3000.0)] {
        fs::write(&part, turned(&path, speed, 0.25)).unwrap();
        let part = part.to_str().unwrap();
        let set = ["--set", "spindle.surface_speed=true", "--set", "spindle.max_speed=4000"];
        let all = ["-m", "lathe-xzc-face", "--tool-length", "40", "-o", "-", part];
        let made = post(&[&all[..], &set].concat());
        assert_eq!((made.code, made.out.as_str()), (1, ""));
        assert!(made.err.contains("C of the chain leads it to positions"), "{}", made.err);
    }
}

#[test]
fn points_of_the_centre_of_a_nose_are_written_as_those_of_its_tip_and_the_other_way_round() {
    let folder = tempfile::tempdir().unwrap();
    let path = [[15.0, 0.0], [15.0, -20.0], [22.0, -31.0]];
    let cl = turned(&path, Speed::Fixed(900.0), 0.25);
    let words = |program: &str| -> Vec<Place> {
        let mut at = [f64::NAN; 2];
        let mut places = Vec::new();
        for line in program.lines().filter(|line| !line.contains("G53")) {
            let number = |name: char| {
                line.split_whitespace()
                    .find_map(|word| word.strip_prefix(name)?.parse::<f64>().ok())
            };
            if let (None, None) = (number('X'), number('Z')) {
                continue;
            }
            at = [number('X').map_or(at[0], |x| x / 2.0), number('Z').unwrap_or(at[1])];
            if at[0].is_finite() && at[1].is_finite() {
                places.push(at);
            }
        }
        places
    };
    let plain = words(&run(folder.path(), &cl, &[]).out);
    for (points, sign) in [("centre", 1.0), ("tip", -1.0)] {
        for (place, [x, z]) in QUADRANTS.into_iter().enumerate() {
            let said = [
                format!("cl.points=\"{points}\""),
                "tools.1.nose=0.8".to_owned(),
                format!("tools.1.quadrant={}", place + 1),
            ];
            let said: Vec<&str> = said.iter().map(String::as_str).collect();
            let made = run(folder.path(), &cl, &said);
            assert_eq!(made.code, 0, "{said:?}: {}", made.err);
            let shifted = words(&made.out);
            assert_eq!(plain.len(), shifted.len(), "{}", made.out);
            for (plain, shifted) in plain.iter().zip(&shifted) {
                let wanted = [plain[0] + 0.8 * sign * x, plain[1] + 0.8 * sign * z];
                let off = [0, 1].map(|part| (shifted[part] - wanted[part]).abs());
                assert!(off[0] < 5.1e-4 && off[1] < 5.1e-4, "{shifted:?} {wanted:?}\n{}", made.out);
            }
            // Another radius is another path.
            if place < 8 {
                let nc = folder.path().join("part.nc");
                let told = verified(folder.path(), &nc, &[said[0], "tools.1.nose=0.4", said[2]]);
                assert_eq!(told.code, 1, "{said:?}: {}", told.err);
                assert!(told.err.contains("off the CL path"), "{}", told.err);
            }
        }
    }
    let refused = |set: &[&str], says: &str| {
        let made = run(folder.path(), &cl, set);
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{set:?}\n{}", made.err);
        assert!(made.err.contains(says), "{says}\n{}", made.err);
    };
    refused(&["cl.points=\"centre\""], "nothing is said of its nose");
    refused(&["cl.points=\"centre\"", "tools.1.nose=0.8"], "a number from 1 to 9");
    refused(&["cl.points=\"centre\"", "tools.1.nose=0.8", "tools.1.quadrant=10"], "from 1 to 9");
    refused(&["tools.1.nose=0.8", "tools.1.quadrant=3"], "[cl] points");
    let still = ["cl.points=\"centre\"", "spindle.surface_speed=false"];
    refused(&still, "whose spindle turns the part");
}
