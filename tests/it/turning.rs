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
            // The most revolutions are reached nowhere, or everywhere: on a way with both the time is near to it alone.
            0 => Speed::Surface(180.0, [4000.0, 300.0][rng.pick(2)]),
            _ => Speed::Fixed(900.0),
        };
        let feed = [0.1, 0.25, 0.333][rng.pick(3)];
        let dialect = match speed {
            // G961 of Siemens goes with a feed a minute, and the limit of LinuxCNC's `G96 D` is not read back.
            Speed::Surface(..) => ["fanuc", "mitsubishi"][rng.pick(2)],
            Speed::Fixed(_) => ["fanuc", "siemens", "linuxcnc", "mitsubishi"][rng.pick(4)],
        };
        let set = [format!("control.dialect={dialect}")];
        let made = run(folder.path(), &turned(&path, speed, feed), &[&set[0]]);
        assert_eq!(made.code, 0, "round {round}, {dialect}: {}", made.err);
        let program = &made.out;
        let lines: Vec<&str> = program.lines().collect();
        let first = lines.iter().position(|line| line.contains("G95")).expect(program);
        assert!(lines[first].contains("G1"), "{program}");
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
                assert!(program.contains("G96"), "{program}");
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
        assert!((told - wanted).abs() < 0.02 * wanted, "{told} {wanted}\n{program}");
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
        let part = folder.path().join("part.cls");
        let told = post(&[
            "verify",
            nc.to_str().unwrap(),
            "-m",
            "lathe-xz",
            "--tool-length",
            "40",
            "--against",
            part.to_str().unwrap(),
        ]);
        assert_eq!(told.code, 1, "{from}: {}{}", told.out, told.err);
        assert!(told.err.contains(says), "{from}: {says}\n{}", told.err);
    };
    wrong("F0.25", "F0.3", "feed is above");
    wrong("F0.25", "F0.2", "feed is below");
    wrong("G95 ", "G94 ", "feed is below");
    wrong("S200 M", "S250 M", "cutting speed");
    wrong("X44.000", "X44.500", "off the CL path");
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
