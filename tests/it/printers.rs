//! Programs of printers, run by a small model of each firmware's motion that shares nothing with the reader: one command in
//! a line, F of G0 and G1 the same and modal, E by positions, the length that F counts along as the firmware's source has
//! it, and the place of the nozzle by matrices of the machine's drawing.

use std::collections::BTreeMap;
use std::fs;

use nalgebra::{Rotation3, Vector3};

use crate::common::{Run, command, root, run};

/// A bead that winds up a dome, the nozzle leaning half as much.
const LIST: &str = "tests/printing/dome.csv";

/// Filament for a millimetre of the bead, as the machine file has it.
const FILAMENT: f64 = 0.0333;

/// Height of the line of U, mm, and the largest feeds of the axes, mm or degrees a minute.
const U_LINE: f64 = -25.0;
const MOST: [(&str, f64); 5] =
    [("X", 12_000.0), ("Y", 12_000.0), ("Z", 750.0), ("U", 5000.0), ("V", 12_000.0)];

/// Filament for the way of the first rapid at feed, 12.74 mm, had it been a bead.
const RAPID: f64 = 0.424;

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
    /// Axes that move, and Z at its end.
    axes: String,
    height: f64,
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
        // Of RepRapFirmware, in whose zero the program counts: the part origin is the machine's.
        let block = block.strip_prefix("G53 ").filter(|_| firmware.name == "rrf").unwrap_or(block);
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
        let mut words_of_axes = String::new();
        for (letter, number) in words.map(|word| word.split_at(1)) {
            let number: f64 = number.parse().unwrap();
            match letter {
                "F" => {
                    feed = number;
                    own_feed = true;
                }
                _ => *at.get_mut(letter).expect(text) = number,
            }
            words_of_axes.extend(letter.chars().filter(|letter| !"FE".contains(*letter)));
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
            axes: words_of_axes,
            height: at["Z"],
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
        // Up, whatever stands there, before the bed turns; then across, and down last.
        let ways = moves.iter().take(4).map(|one| one.axes.as_str());
        assert_eq!(ways.collect::<Vec<_>>(), ["Z", "UV", "XY", "Z"], "{name}");
        assert_eq!([moves[0].height, moves.last().unwrap().height], [120.0; 2], "{name}");
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

/// What `post VERB` says of a program for the list.
fn judged(dialect: &str, verb: &str, program: &str) -> Run {
    let machine = ["-m", "printer-open5x", "--tool-length", "0", "--dialect", dialect];
    let against: &[&str] = match verb {
        "verify" => &["--against", LIST],
        _ => &[],
    };
    let done = run(command().arg(verb).args(machine).args(against).arg("-"), program.as_bytes());
    Run { err: format!("{}{}", done.out, done.err), ..done }
}

/// The program without the words of a letter in the lines that `of` chooses.
fn without(program: &str, letter: char, of: impl Fn(usize) -> bool) -> String {
    let lines = program.lines().enumerate().map(|(index, line)| {
        let words = line.split(' ').filter(|word| !(of(index) && word.starts_with(letter)));
        words.collect::<Vec<_>>().join(" ") + "\n"
    });
    lines.collect()
}

/// A bead without its E, and E in a rapid: however rapids are written, and in blocks so short that E alone tells nothing.
#[test]
fn what_is_not_pushed_out_along_a_bead_is_told() {
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let program = posted(name);
        let right = judged(name, "verify", &program);
        assert_eq!(right.code, 0, "{name}: {}{}", right.out, right.err);
        let beads = program.lines().enumerate();
        let beads = beads.filter(|(_, line)| line.starts_with("G1 ") && line.contains(" E"));
        let beads: Vec<usize> = beads.map(|(index, _)| index).collect();
        let middle = beads[beads.len() / 2];
        let last = beads[beads.len() - 1];
        for changed in [
            without(&program, 'E', |index| beads.contains(&index)),
            without(&program, 'E', |index| index >= middle && beads.contains(&index)),
            without(&program, 'E', |index| index == last),
        ] {
            let done = judged(name, "verify", &changed);
            assert_eq!(done.code, 1, "{name}: {}", done.out);
            assert!(done.err.contains("E stands still in a cut of the CL file"), "{}", done.err);
        }
        // A rapid at feed, and all E words behind it moved on by as much.
        let rapid = program.lines().position(|line| {
            line.starts_with("G1 ") && !line.contains(" E") && line.contains(" U")
        });
        let rapid = rapid.unwrap();
        let on = |(index, line): (usize, &str)| {
            let words = line.split(' ').map(|word| match word.strip_prefix('E') {
                Some(pushed) if index > rapid => {
                    format!("E{:.3}", pushed.parse::<f64>().unwrap() + RAPID)
                }
                _ => word.to_owned(),
            });
            let line = words.collect::<Vec<_>>().join(" ");
            if index == rapid {
                line.replace(" F", &format!(" E{RAPID} F")) + "\n"
            } else {
                line + "\n"
            }
        };
        let pushed: String = program.lines().enumerate().map(on).collect();
        let done = judged(name, "verify", &pushed);
        assert_eq!(done.code, 1, "{name}");
        assert!(done.err.contains("E goes along a rapid of the CL file"), "{name}: {}", done.err);
    }
}

/// Rounding alone lets each of these blocks pass without its E, and not all of them.
#[test]
fn what_short_blocks_push_out_is_told_together() {
    let folder = tempfile::tempdir().unwrap();
    let list = folder.path().join("short.csv");
    let rows = (0..=100).map(|step| format!("{:.3},0,10,\n", 0.02 * f64::from(step)));
    let rows: String = rows.collect();
    let text = format!("feed,600\nx,y,z,rapid\n20,20,60,1\n0,0,60,1\n0,0,10,1\n{rows}2,0,60,1\n");
    fs::write(&list, text).unwrap();
    let machine = ["-m", "printer-open5x", "--tool-length", "0"];
    let made = run(command().args(["-q", "-o", "-"]).args(machine).arg(&list), b"");
    assert_eq!(made.code, 0, "{}", made.err);
    let verify = |program: &str| {
        let list = list.to_str().unwrap();
        run(
            command().arg("verify").args(machine).args(["--against", list, "-"]),
            program.as_bytes(),
        )
    };
    let right = verify(&made.out);
    assert_eq!(right.code, 0, "{}{}", right.out, right.err);
    let bead =
        |line: &str| line.contains(" E") && !line.starts_with("G0") && !line.starts_with("G92");
    let beads: Vec<bool> = made.out.lines().map(bead).collect();
    assert!(beads.iter().filter(|bead| **bead).count() > 50, "{}", made.out);
    let none = verify(&without(&made.out, 'E', |index| beads[index]));
    assert!(none.code == 1 && none.err.contains("E stands still in a cut"), "{}", none.err);
    // Half of it.
    let half = |word: &str| match word.strip_prefix('E') {
        Some(pushed) => format!("E{:.3}", pushed.parse::<f64>().unwrap() / 2.0),
        None => word.to_owned(),
    };
    let lines = made.out.lines().map(|line| {
        let words: Vec<String> = line.split(' ').map(half).collect();
        words.join(" ") + "\n"
    });
    let half = verify(&lines.collect::<String>());
    assert!(half.code == 1 && half.err.contains("nc-along"), "{}", half.err);
}

/// A line is one command and its parameters there: what the firmware would drop is no move, and what it would do otherwise is
/// not followed.
#[test]
fn what_a_firmware_makes_otherwise_of_a_line_is_told() {
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let program = posted(name);
        let lines: Vec<&str> = program.lines().collect();
        let bead = lines.iter().rposition(|line| line.contains(" E")).unwrap();
        let with = |changed: &dyn Fn(&str) -> String| -> String {
            let line = |(index, line): (usize, &&str)| match index == bead {
                true => changed(line) + "\n",
                false => format!("{line}\n"),
            };
            lines.iter().enumerate().map(line).collect()
        };
        let ahead = |word: &str| with(&|line| format!("{word}\n{line}"));
        for (what, changed) in [
            ("begins a line", with(&|line| line.replacen("G1 ", "", 1))),
            ("begins a line", with(&|line| line.replacen("G1 ", "S5 G1 ", 1))),
            ("stands behind the command", with(&|line| format!("G90 {line}"))),
            ("stands behind the command", with(&|line| format!("{line} M400"))),
            ("begins a line", ahead("F600")),
            ("M30", ahead("M30 x.gcode")),
            ("is not run", ahead("M30")),
            ("is not run", ahead("M83")),
            ("is not run", ahead("M220 S50")),
            ("no word that is known", ahead("G81 X0 Y0 Z0 R5 F100")),
        ] {
            for verb in ["verify", "read", "lint"] {
                let done = judged(name, verb, &changed);
                assert_eq!(done.code, 1, "{name} {verb} {what}: {}{}", done.out, done.err);
                assert!(done.err.contains(what), "{name} {verb}: {}", done.err);
            }
        }
        let shifted = judged(name, "verify", &ahead("G92 Z0"));
        assert_eq!(shifted.code, 1, "{name}: {}", shifted.err);
    }
}

/// What E counts, and from where, holds from the print before unless a program says it.
#[test]
fn what_the_extruder_counts_from_is_told_where_a_program_does_not_say_it() {
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let program = posted(name);
        for (line, says) in [
            ("M82", "does not set positions of the extruder (M82)"),
            ("G92 E0", "does not set where the extruder counts from (G92 E0)"),
        ] {
            let other = program.replacen(&format!("{line}\n"), "", 1);
            assert_ne!(other, program);
            let done = judged(name, "verify", &other);
            assert!(done.err.contains(says), "{name}: {}", done.err);
            assert!(!judged(name, "verify", &program).err.contains(says), "{name}");
        }
    }
}

/// G0 goes at F: another is another travel, and none is that of the beads.
#[test]
fn a_rapid_at_another_feed_is_told() {
    for firmware in &FIRMWARE {
        let name = firmware.name;
        let program = posted(name);
        let rapid = program.lines().rfind(|line| line.starts_with("G0 ")).unwrap();
        for feed in ["", " F50.", " F9000."] {
            let other = rapid.replace(" F5000.", feed);
            assert_ne!(other, rapid);
            let done = judged(name, "verify", &program.replace(rapid, &other));
            assert!(done.code == 1 && done.err.contains("G0 goes at F"), "{name}: {}", done.err);
        }
    }
}

/// Beads from one side of a pole to another, at their own height: while the bed turns between them the nozzle stays where
/// it is, and what it goes without pushing is no bead. Rapids had stood 0.2 mm aside there.
#[test]
fn a_turn_at_a_pole_at_the_height_of_beads_keeps_still() {
    for list in [POLE_TRAVEL, POLE_STANDS] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pole.csv");
        fs::write(&file, list).unwrap();
        let beads = points(list);
        for firmware in &FIRMWARE {
            let name = firmware.name;
            let machine = ["-m", "printer-open5x", "--tool-length", "0", "--dialect", name];
            let made =
                run(command().args(["-q", "-o", "-", "--verify"]).args(machine).arg(&file), b"");
            assert_eq!(made.code, 0, "{name}: {}", made.err);
            // Where no bead is pushed out, at the height of the beads: on the straight ways of the list.
            let low = |one: &&Move| one.pushed == 0.0 && one.tips.iter().all(|tip| tip.z < 2.5);
            let moves = runs(firmware, &made.out);
            let travels: Vec<_> = moves.iter().filter(low).collect();
            assert!(!travels.is_empty(), "{name}: {}", made.out);
            for travel in travels {
                let off = travel.tips.iter().map(|tip| {
                    let ways = beads.windows(2);
                    let near = ways.map(|pair| to_segment(tip, [&pair[0].0, &pair[1].0]));
                    near.fold(f64::INFINITY, f64::min)
                });
                let off = off.fold(0.0, f64::max);
                assert!(off < 0.023, "{name}, line {}: {off} mm", travel.line);
            }
        }
    }
}

/// A rapid to where the nozzle stands along the line of V, which turns there for the next bead.
const POLE_STANDS: &str = "feed,600\nx,y,z,i,j,k,rapid\n60,-40,40,0,0,1,1\n18.548,1.121,14,-0.01853,-0.00752,1,1\n\
    18.548,1.121,2,-0.01853,-0.00752,1,1\n26.983,-1.134,2,-0.06601,0.07512,1,\n26.983,-1.134,14,-0.06601,0.07512,1,1\n\
    26.461,-5.196,2,0.00775,-0.01844,1,1\n-9.235,2.309,2,-0.07138,-0.07004,1,\n-2.511,-28.322,2,0,0,1,1\n\
    3.045,-19.153,2,0.08389,0.05443,1,\n3.045,-19.153,14,0.08389,0.05443,1,1\n";

/// One to a nozzle that leans a little.
const POLE_TRAVEL: &str = "feed,600\nx,y,z,i,j,k,rapid\n60,-40,40,0,0,1,1\n19.802,10.218,14,-0.03291,0.09443,1,1\n\
    19.802,10.218,2,-0.03291,0.09443,1,1\n28.407,-0.038,2,0.01864,-0.00726,1,\n21.197,-1.186,2,-0.00079,-0.01998,1,1\n\
    -5.141,-19.620,2,-0.38134,-0.12073,1,\n-5.141,-19.620,14,-0.38134,-0.12073,1,1\n";

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
        assert!(!spindle.contains("loads no tool"), "{name}: {spindle}");
        let inch = told(name, &["--set", "control.units=inch"]);
        assert!(inch.contains("inches are not sure"), "{name}: {inch}");
    }
    for name in ["klipper", "marlin"] {
        let no_line = format!("control.{name}.retract=[]");
        let up = told(name, &["--set", "control.retract={Z=100}", "--set", &no_line]);
        assert!(up.contains("no words for positions in machine coordinates"), "{name}: {up}");
        assert!(!up.contains("loads no tool") && !up.contains("csv:0"), "{name}: {up}");
    }
}
