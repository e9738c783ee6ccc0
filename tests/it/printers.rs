//! Programs of printers, run by a small model of each firmware's motion that shares nothing with the reader: one command in
//! a line, F of G0 and G1 the same and modal, E by positions, the length that F counts along as the firmware's source has
//! it, and the place of the nozzle by matrices of the machine's drawing.

use std::collections::BTreeMap;
use std::fs;

use nalgebra::{Rotation3, Vector3};

use crate::common::{command, root, run};

/// A bead that winds up a dome, the nozzle leaning half as much.
const LIST: &str = "tests/printing/dome.csv";

/// Filament for a millimetre of the bead, as the machine file has it.
const FILAMENT: f64 = 0.0333;

/// Height of the line of U, mm, and the largest feeds of the axes, mm or degrees a minute.
const U_LINE: f64 = -25.0;
const MOST: [(&str, f64); 5] =
    [("X", 12_000.0), ("Y", 12_000.0), ("Z", 750.0), ("U", 5000.0), ("V", 12_000.0)];

/// F of G0.
const TRAVEL: f64 = 5000.0;

/// What a firmware makes of a line.
struct Firmware {
    name: &'static str,
    /// Commands beside G0 and G1.
    reads: &'static [&'static str],
    /// The least speed of a move, mm/min.
    least: f64,
    /// The length of F where X, Y and Z stand: of U, V and E.
    turned: fn([f64; 3]) -> f64,
}

const FIRMWARE: [Firmware; 3] = [
    Firmware {
        name: "klipper",
        reads: &["G21", "G90", "G92", "M82", "M104", "M109", "M140", "M190"],
        least: 0.0,
        turned: |others| others.into_iter().map(f64::abs).fold(0.0, f64::max),
    },
    Firmware {
        name: "rrf",
        reads: &["G21", "G90", "G92", "G54", "M82", "M104", "M109", "M140", "M190"],
        // What config.g must have: M203 I0.6.
        least: 0.6,
        turned: |[u, v, _]| libm::hypot(u, v),
    },
    Firmware {
        name: "marlin",
        reads: &["G21", "G90", "G92", "M82", "M104", "M109", "M140", "M190"],
        least: 0.0,
        turned: |[u, v, _]| libm::hypot(u, v),
    },
];

/// A move as the firmware makes it.
struct Move {
    line: usize,
    rapid: bool,
    feed: f64,
    minutes: f64,
    /// Places of the nozzle on the part along it.
    tips: Vec<Vector3<f64>>,
    /// Direction of the nozzle at its end.
    axis: Vector3<f64>,
    /// The share of its largest feed that the fastest axis has.
    busiest: f64,
    pushed: f64,
}

/// The nozzle against the part: the head goes along X and Z; the bed goes against Y, is tilted against U about a line along
/// Y and turned against V about Z.
fn nozzle(at: &BTreeMap<&str, f64>) -> (Vector3<f64>, Vector3<f64>) {
    let [u, v] = ["U", "V"].map(|name| at[name].to_radians());
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), v);
    let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), u);
    let line = Vector3::new(0.0, 0.0, U_LINE);
    let place = Vector3::new(at["X"], at["Y"], at["Z"]);
    (turn * (line + tilt * (place - line)), turn * (tilt * Vector3::z()))
}

fn runs(firmware: &Firmware, text: &str) -> Vec<Move> {
    let mut at: BTreeMap<&str, f64> =
        ["X", "Y", "Z", "U", "V", "E"].into_iter().map(|name| (name, 0.0)).collect();
    let mut feed = 25.0 * 60.0;
    let mut moves = Vec::new();
    for (line, text) in text.lines().enumerate() {
        let block = text.split(';').next().unwrap().trim();
        let mut words = block.split_whitespace();
        let Some(command) = words.next() else {
            continue;
        };
        let rapid = command == "G0";
        if !rapid && command != "G1" {
            assert!(firmware.reads.contains(&command), "{}: `{text}`", firmware.name);
            let said = words.map(|word| word.split_at(1));
            for (letter, number) in said.filter(|_| command == "G92") {
                *at.get_mut(letter).unwrap() = number.parse().unwrap();
            }
            continue;
        }
        let from = at.clone();
        let mut own_feed = false;
        for (letter, number) in words.map(|word| word.split_at(1)) {
            let number: f64 = number.parse().unwrap();
            match letter {
                "F" => {
                    feed = number;
                    own_feed = true;
                }
                _ => *at.get_mut(letter).expect(text) = number,
            }
        }
        assert!(own_feed || !rapid, "{}: a rapid at the feed of cuts: `{text}`", firmware.name);
        let way = |name: &str| at[name] - from[name];
        let linear = ["X", "Y", "Z"].map(way).iter().map(|way| way * way).sum::<f64>().sqrt();
        let length =
            if linear > 1e-9 { linear } else { (firmware.turned)(["U", "V", "E"].map(way)) };
        let minutes = length / feed.max(firmware.least);
        let between = |share: f64| {
            let part = |(name, start): (&&'static str, &f64)| (*name, start + share * way(name));
            nozzle(&from.iter().map(part).collect())
        };
        let speed = |(name, most): &(&str, f64)| way(name).abs() / minutes / most;
        moves.push(Move {
            line: line + 1,
            rapid,
            feed,
            minutes,
            tips: (0..=32).map(|step| between(f64::from(step) / 32.0).0).collect(),
            axis: between(1.0).1,
            busiest: MOST.iter().map(speed).fold(0.0, f64::max),
            pushed: way("E"),
        });
    }
    moves
}

/// Points of the list: the tip, the direction of the nozzle, whether it is come to at rapid.
fn points(text: &str) -> Vec<(Vector3<f64>, Vector3<f64>, bool)> {
    let rows = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip_while(|line| !line.starts_with("x,"));
    let rows = rows.skip(1).map(|row| {
        let values: Vec<f64> = row.split(',').map(|value| value.parse().unwrap_or(0.0)).collect();
        let [x, y, z, i, j, k, rapid] = values[..] else { panic!("{row}") };
        (Vector3::new(x, y, z), Vector3::new(i, j, k).normalize(), rapid == 1.0)
    });
    rows.collect()
}

fn to_segment(point: &Vector3<f64>, ends: [&Vector3<f64>; 2]) -> f64 {
    let way = ends[1] - ends[0];
    let share = ((point - ends[0]).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (ends[0] + way * share - point).norm()
}

fn posted(dialect: &str) -> String {
    let arguments = [
        "-q",
        "-m",
        "printer-open5x",
        "--tool-length",
        "0",
        "--dialect",
        dialect,
        "-o",
        "-",
        "--verify",
        LIST,
    ];
    let done = run(command().args(arguments), b"");
    assert_eq!(done.code, 0, "{dialect}: {}", done.err);
    done.out
}

#[test]
fn a_bead_round_a_dome_is_laid_as_the_list_has_it() {
    let list = points(&fs::read_to_string(root().join(LIST)).unwrap());
    let beads: Vec<_> = list.windows(2).filter(|pair| !pair[1].2).collect();
    let asked: f64 = beads.iter().map(|pair| (pair[1].0 - pair[0].0).norm()).sum();
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let moves = runs(firmware, &posted(name));
        let mut laid = 0.0;
        let mut at_feed = 0;
        for one in &moves {
            let length: f64 = one.tips.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
            let place = format!("{name}, line {}", one.line);
            if one.rapid {
                assert_eq!((one.feed, one.pushed), (TRAVEL, 0.0), "{place}");
                continue;
            }
            assert!(one.busiest < 1.01, "{place}: an axis has {} of its feed", one.busiest);
            if one.pushed == 0.0 {
                // A rapid that turns an axis is as fast as the axes are.
                assert!(one.busiest > 0.97, "{place}: {}", one.busiest);
                continue;
            }
            let speed = length / one.minutes;
            assert!(speed < 1.01 * 600.0, "{place}: {speed} mm/min");
            assert!(speed > 0.97 * 600.0 || one.busiest > 0.97, "{place}: {speed} mm/min");
            at_feed += usize::from(speed > 0.97 * 600.0);
            assert!((one.pushed - FILAMENT * length).abs() < 2e-3, "{place}: {}", one.pushed);
            laid += one.pushed;
            let off = one.tips.iter().map(|tip| {
                let near = beads.iter().map(|pair| to_segment(tip, [&pair[0].0, &pair[1].0]));
                near.fold(f64::INFINITY, f64::min)
            });
            let off = off.fold(0.0, f64::max);
            assert!(off < 0.023, "{place}: {off} mm beside the bead");
        }
        assert!(at_feed > 40, "{name}: {at_feed} blocks at the feed of the list");
        assert!((laid / (FILAMENT * asked) - 1.0).abs() < 2e-3, "{name}: E{laid} for {asked} mm");
        // Each point of the list is come to, in order, by a nozzle that points as it says.
        let mut ends = moves.iter();
        for (tip, axis, _) in &list {
            let there = |one: &&Move| {
                (one.tips.last().unwrap() - tip).norm() < 0.003 && one.axis.angle(axis) < 1e-3
            };
            assert!(ends.any(|one| there(&one)), "{name}: nothing comes to {tip:?}");
        }
    }
}

/// What the firmware has no words for is refused, not left out.
#[test]
fn what_a_printer_cannot_do_is_refused() {
    let told = |dialect: &str, with: &[&str]| {
        let arguments =
            ["-q", "-m", "printer-open5x", "--tool-length", "0", "--dialect", dialect, "-o", "-"];
        run(command().args(arguments).args(with).arg(LIST), b"").err
    };
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let spindle = told(name, &["--spindle", "6000"]);
        assert!(spindle.contains("no words for a spindle"), "{name}: {spindle}");
        let inch = told(name, &["--set", "control.units=inch"]);
        assert!(inch.contains("inches are not sure"), "{name}: {inch}");
    }
    for name in ["klipper", "marlin"] {
        let up = told(name, &["--set", "control.retract={Z=100}"]);
        assert!(up.contains("no words for positions in machine coordinates"), "{name}: {up}");
    }
}
