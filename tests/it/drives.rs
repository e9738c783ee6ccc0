//! Feeds of a parallel machine, seen from its program alone: by the formula of a linear delta no carriage goes faster than
//! its largest feed, and where a block is slower than asked one goes nearly as fast.

use crate::common;

use common::post;
use post_testkit::randomised;

/// Largest feed of a carriage of `machines/linear-delta.toml`, mm/min.
const CARRIAGE: f64 = 12_000.0;

/// What the CL file asks for, mm/min.
const ASKED: f64 = 15_000.0;

/// Tool length, mm.
const LENGTH: f64 = 40.0;

/// Heights of the carriages with the tip there: R = 130.25 and L = 269.
fn carriages([x, y, z]: [f64; 3]) -> [f64; 3] {
    let (far, rod, half) = (130.25, 269.0_f64, 3f64.sqrt() / 2.0);
    let towers = [(0.0, far), (-half * far, -far / 2.0), (half * far, -far / 2.0)];
    towers.map(|(a, b)| z + LENGTH + (rod * rod - (a - x) * (a - x) - (b - y) * (b - y)).sqrt())
}

/// The number behind a letter of a block.
fn word(block: &str, letter: char) -> Option<f64> {
    let word = block.split(' ').find(|word| word.starts_with(letter))?;
    word[1..].trim_end_matches('.').parse().ok()
}

/// The fastest carriage along a way of `length` mm that is gone along at `feed`, mm/min.
fn fastest(way: &dyn Fn(f64) -> [f64; 3], length: f64, feed: f64) -> f64 {
    let mut most: f64 = 0.0;
    for step in 0..400 {
        let share = f64::from(step) / 400.0;
        let [from, to] = [share, share + 1.0 / 400.0].map(|share| carriages(way(share)));
        for (from, to) in from.iter().zip(to) {
            most = most.max((to - from).abs() * 400.0 / length * feed);
        }
    }
    most
}

#[test]
fn no_carriage_passes_its_largest_feed_and_none_is_held_back_for_nothing() {
    let (rounds, mut rng) = randomised(12, 0xde17a);
    let (mut slowed, mut free) = (0, 0);
    for _ in rounds {
        let mut text = "TOOL PATH/WEB,TOOL,MILL\nTLDATA/MILL,6.0,3.0,40.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\nLOAD/TOOL,1\nSPINDL/RPM,8000,CLW\nRAPID\nGOTO/0,0,60,0,0,1\nFEDRAT/MMPM,600\nGOTO/0,0,20\n".to_owned();
        text += &format!("FEDRAT/MMPM,{ASKED}\n");
        for _ in 0..12 {
            let [x, y] = [0, 1].map(|_| rng.range(-50.0, 50.0));
            let z = rng.range(2.0, 40.0);
            text += &format!("GOTO/{x:.3},{y:.3},{z:.3}\n");
            let radius = rng.range(4.0, 15.0);
            // Half a circle beside the point.
            text += &format!(
                "CIRCLE/{:.3},{y:.3},{z:.3},0,0,1,{radius:.3}\nGOTO/{:.3},{y:.3},{z:.3}\n",
                x + radius,
                x + 2.0 * radius
            );
        }
        text += "RAPID\nGOTO/0,0,60\nSPINDL/OFF\nEND-OF-PATH\n";
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("web.cls");
        std::fs::write(&file, text).unwrap();
        let length = LENGTH.to_string();
        let run = post(&[
            "-q",
            "-m",
            "linear-delta",
            "--tool-length",
            &length,
            "--verify",
            "-o",
            "-",
            file.to_str().unwrap(),
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
        let (mut at, mut mode, mut feed) = ([0.0; 3], 0.0, 0.0);
        for block in run.out.lines() {
            let moves = ["X", "Y", "Z"].iter().any(|letter| block.contains(letter));
            if block.starts_with('(') || block.contains("G53") {
                continue;
            }
            if let Some(code) = block.split(' ').rev().find_map(|word| match word {
                "G0" => Some(0.0),
                "G1" => Some(1.0),
                "G2" => Some(2.0),
                "G3" => Some(3.0),
                _ => None,
            }) {
                mode = code;
            }
            feed = word(block, 'F').unwrap_or(feed);
            let from = at;
            for (place, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
                at[place] = word(block, letter).unwrap_or(at[place]);
            }
            if !moves || mode == 0.0 || feed < 1000.0 {
                continue;
            }
            let to = at;
            let straight = |share: f64| {
                std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]))
            };
            let ways = [0, 1, 2].map(|axis| to[axis] - from[axis]);
            let chord = ways.iter().map(|way| way * way).sum::<f64>().sqrt();
            let centre = [word(block, 'I'), word(block, 'J')].map(|by| by.unwrap_or(0.0));
            let (x, y) = (from[0] + centre[0], from[1] + centre[1]);
            let radius = libm::hypot(centre[0], centre[1]);
            let first = libm::atan2(from[1] - y, from[0] - x);
            let last = libm::atan2(to[1] - y, to[0] - x);
            let tau = std::f64::consts::TAU;
            let turn = match mode == 2.0 {
                true => -(first - last).rem_euclid(tau),
                false => (last - first).rem_euclid(tau),
            };
            let round = |share: f64| {
                let (sine, cosine) = libm::sincos(first + share * turn);
                [x + radius * cosine, y + radius * sine, from[2]]
            };
            let (way, length): (&dyn Fn(f64) -> [f64; 3], f64) = match mode == 1.0 {
                true => (&straight, chord),
                false => (&round, radius * turn.abs()),
            };
            let speed = fastest(way, length, feed);
            assert!(speed <= CARRIAGE * 1.0005, "{block}: {speed}");
            match feed < ASKED - 0.5 {
                true => {
                    slowed += 1;
                    assert!(speed > CARRIAGE * 0.98, "{block}: held back at {speed}");
                }
                false => free += 1,
            }
        }
    }
    assert!(slowed > 20 && free > 20, "{slowed} {free}");
}

/// Belts of a CoreXY are X + Y and X - Y: no block has one of them go faster, and none is slower for nothing.
#[test]
fn belts_that_axes_share_keep_their_largest_feed() {
    const BELT: f64 = 6000.0;
    let (rounds, mut rng) = randomised(12, 0xbe17);
    let mut held = 0;
    for _ in rounds {
        let folder = tempfile::tempdir().unwrap();
        let machine = format!(
            "extends = \"router\"\nname = \"core\"\n[[drive]]\nname = \"L1\"\nis = \"X + Y\"\nmax_feed = {BELT}\n[[drive]]\nname = \"L2\"\nis = \"X - Y\"\nmax_feed = {BELT}\n"
        );
        let mut text = "LOADTL/1\nSPINDL/8000,RPM,CLW\nRAPID\nGOTO/0,0,60\nFEDRAT/600,MMPM\nGOTO/0,0,20\nFEDRAT/9000,MMPM\n".to_owned();
        for _ in 0..8 {
            let [x, y] = [0, 1].map(|_| rng.range(-100.0, 100.0));
            text += &format!("GOTO/{x:.3},{y:.3},20\n");
        }
        text += "RAPID\nGOTO/0,0,60\nFINI\n";
        let file = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        std::fs::write(file("core.toml"), machine).unwrap();
        std::fs::write(file("part.apt"), text).unwrap();
        let (machine, part, program) = (file("core.toml"), file("part.apt"), file("part.nc"));
        let run = post(&[
            "-q",
            "-m",
            &machine,
            "--set=control.units=mm",
            "--tool-length=40",
            "--verify",
            &part,
            "-o",
            &program,
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
        let program = std::fs::read_to_string(&program).unwrap();
        let (mut at, mut feed): ([f64; 2], f64) = ([0.0; 2], 0.0);
        let begins = program.lines().position(|line| line.contains("Z20")).unwrap();
        for block in program.lines().skip(begins + 1) {
            if block.contains("G0") || block.contains("G53") {
                break;
            }
            feed = word(block, 'F').unwrap_or(feed);
            let to = [word(block, 'X').unwrap_or(at[0]), word(block, 'Y').unwrap_or(at[1])];
            let way = [to[0] - at[0], to[1] - at[1]];
            let belt = (way[0].abs() + way[1].abs()) / libm::hypot(way[0], way[1]) * feed;
            assert!(belt <= BELT * 1.0005, "{block}: {belt}");
            assert!(belt >= BELT * 0.995 || feed > 8999.0, "{block}: {belt}");
            held += usize::from(belt >= BELT * 0.995);
            at = to;
        }
    }
    assert!(held > 8, "{held}");
}

/// A drive that leaves its travel at both ends is told of at each by itself, and what is told of the farthest place is of one
/// place: where the axes stand, the drive with them, and by how much it is over.
#[test]
fn a_drive_beyond_both_ends_is_told_end_by_end() {
    let folder = tempfile::tempdir().unwrap();
    let post = |arguments: &[&str]| {
        common::run(common::command().current_dir(folder.path()).args(arguments), b"")
    };
    assert_eq!(post(&["new", "mill", "--class", "three-axis"]).code, 0);
    let file = folder.path().join("mill.toml");
    let machine = std::fs::read_to_string(&file).unwrap();
    let drive = "\n[[drive]]\nname = \"Q\"\nis = \"X + Y\"\ntravel = [-10, 20]\n";
    std::fs::write(&file, machine + drive).unwrap();
    let points = [[10, 15], [0, 0], [-10, -4], [0, 0], [20, 8], [0, 0], [-20, -3], [0, 0]];
    let cuts: String = points.into_iter().map(|[x, y]| format!("GOTO/{x},{y},10\n")).collect();
    let cl = format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,900,CLW\nRAPID\nGOTO/0,0,40\nFEDRAT/600,MMPM\nGOTO/0,0,10\n{cuts}RAPID\nGOTO/0,0,40\nSPINDL/OFF\nFINI\n"
    );
    std::fs::write(folder.path().join("part.cls"), cl).unwrap();
    let run = post(&["-q", "-m", "mill.toml", "--tool-length", "40", "-o", "-", "part.cls"]);
    assert_eq!(run.code, 1, "{}", run.err);
    let mut ends: Vec<f64> = Vec::new();
    for (_, told) in run
        .err
        .match_indices("the farthest with Q at ")
        .map(|(at, with)| (at, &run.err[at + with.len()..]))
    {
        // `28.000 mm (X 20.000 mm, Y 8.000 mm), passed by 8.000 mm, on line 12`
        let words = told.lines().next().unwrap().replace(['(', ')', ','], "");
        let numbers: Vec<f64> = words.split(' ').filter_map(|word| word.parse().ok()).collect();
        let [q, x, y, by, _] = numbers[..] else { panic!("{told}") };
        assert!((x + y - q).abs() < 0.0021, "{told}");
        assert!((by - (q - 20.0).max(-10.0 - q)).abs() < 0.0011, "{told}");
        ends.push(q);
    }
    ends.sort_by(f64::total_cmp);
    assert!(matches!(ends[..], [low, high] if low < -10.0 && high > 20.0), "{}", run.err);
}
