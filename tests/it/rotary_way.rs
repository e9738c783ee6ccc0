//! `[axis] way`: words whose sign is the way, followed here one by one as such a control follows them, turn the axis as
//! words that count whole turns do.

use std::fmt::Write as _;
use std::fs;

use post_testkit::randomised;

use crate::common::{Run, assert_contains, post_in};

/// Cuts round a cone whose axis is Z: the part turns about Z from point to point by these angles, degrees.
fn cone(turns: &[f64]) -> String {
    let mut text = "LOADTL/1\nSPINDL/3000,RPM,CLW\nMULTAX/ON\nFEDRAT/800,MMPM\n".to_owned();
    let mut angle: f64 = 0.0;
    for turn in turns {
        angle += turn;
        let (sine, cosine) = libm::sincos(angle.to_radians());
        let (tilted, upright) = libm::sincos(20f64.to_radians());
        writeln!(
            text,
            "GOTO/{:.5},{:.5},{:.5},{:.9},{:.9},{:.9}",
            30.0 * cosine,
            30.0 * sine,
            5.0,
            tilted * cosine,
            tilted * sine,
            upright
        )
        .unwrap();
    }
    text + "FINI\n"
}

fn run(folder: &std::path::Path, way: &str, dialect: &str) -> (Run, String) {
    let name = format!("{way}.nc");
    let settings = [format!("axis.C.way={way}"), format!("control.dialect={dialect}")];
    let made = post_in(
        folder,
        &[
            "-m",
            "ac-trunnion",
            "--mount=0,0,20",
            "--tool-length=100",
            "--verify",
            "-q",
            "--set",
            &settings[0],
            "--set",
            &settings[1],
            "part.apt",
            "-o",
            &name,
        ],
    );
    let program = fs::read_to_string(folder.join(&name)).unwrap_or_default();
    (made, program)
}

/// The words of C in their order, and whether each stands in machine coordinates.
fn words(program: &str) -> Vec<(String, bool)> {
    let of = |line: &str| {
        let word = line.split(' ').find_map(|word| word.strip_prefix('C'))?;
        word.parse::<f64>().is_ok().then(|| (word.to_owned(), line.contains("G53")))
    };
    program.lines().filter(|line| !line.starts_with('(')).filter_map(of).collect()
}

#[test]
fn a_sign_turns_the_axis_as_counted_turns_do() {
    let (rounds, mut rng) = randomised(12, 12);
    let mut down = 0;
    for round in rounds {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let mut turns = Vec::new();
        for _ in 0..4 + rng.pick(4) {
            let step = [-30.0, 30.0][rng.pick(2)];
            turns.extend(std::iter::repeat_n(step, 4 + rng.pick(14)));
        }
        fs::write(folder.join("part.apt"), cone(&turns)).unwrap();
        let (signed, signed_text) = run(folder, "sign", "fanuc");
        let (counted, counted_text) = run(folder, "counted", "fanuc");
        assert_eq!((signed.code, counted.code), (0, 0), "{round}: {}{}", signed.err, counted.err);
        let pairs = (words(&signed_text), words(&counted_text));
        assert_eq!(pairs.0.len(), pairs.1.len());
        let mut stands: Option<f64> = None;
        for ((word, parks), (wanted, _)) in pairs.0.iter().zip(&pairs.1) {
            if *parks {
                break;
            }
            let (value, wanted): (f64, f64) = (word.parse().unwrap(), wanted.parse().unwrap());
            assert!(value.abs() <= 360.0 && !word.starts_with("-0.000"), "{word}");
            let place = value.abs() % 360.0;
            let at = match stands {
                // The first, from wherever it stands.
                None => wanted,
                Some(at) if word.starts_with('-') => at - (at - place).rem_euclid(360.0),
                Some(at) => at + (place - at).rem_euclid(360.0),
            };
            down += usize::from(word.starts_with('-'));
            assert!((at - wanted).abs() < 1e-6, "{round}: {word} leads to {at}, not {wanted}");
            stands = Some(at);
        }
        // The other way round in a cut is another path.
        let mut cuts =
            signed_text.lines().filter(|line| line.contains(" C-") && line.contains('X'));
        if let Some(line) = cuts.next_back() {
            let other = signed_text.replacen(line, &line.replace(" C-", " C"), 1);
            fs::write(folder.join("other.nc"), other).unwrap();
            let read = post_in(
                folder,
                &[
                    "verify",
                    "other.nc",
                    "-m",
                    "ac-trunnion",
                    "--mount=0,0,20",
                    "--tool-length=100",
                    "--set",
                    "axis.C.way=sign",
                    "--against",
                    "part.apt",
                ],
            );
            assert_eq!(read.code, 1, "{line}\n{}{}", read.out, read.err);
        }
    }
    assert!(down > 0);
}

#[test]
fn a_way_that_cannot_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("part.apt"), cone(&[0.0, 30.0])).unwrap();
    let (refused, text) = run(folder, "sign", "siemens");
    assert_eq!((refused.code, text.as_str()), (1, ""));
    assert_contains(&refused.err, &["the dialect siemens has no words whose sign is the way"]);
    let cases = [
        ("axis.A.way=\"sign\"", "way of A: it is for a cyclic axis"),
        ("axis.C={range=[0,360],way=\"counted\"}", "shows no whole turns"),
        ("axis.C={range=[-180,180],way=\"sign\"}", "goes from 0 to 360"),
        ("axis.C={zero=90,way=\"sign\"}", "shows zero in the drawing"),
    ];
    for (set, says) in cases {
        let run = post_in(
            folder,
            &["-m", "ac-trunnion", "--tool-length=100", "--set", set, "part.apt", "-o", "x.nc"],
        );
        assert_eq!(run.code, 1, "{set}\n{}", run.out);
        assert_contains(&run.err, &[says]);
    }
    // A place within one turn, by the shorter way, without the turn being named.
    let (shorter, text) = run(folder, "shorter", "fanuc");
    assert_eq!(shorter.code, 0, "{}", shorter.err);
    assert!(words(&text).iter().all(|(word, _)| !word.starts_with('-')), "{text}");
}

/// Where no linear axis moves, a feed above what is asked is found all the same.
#[test]
fn a_feed_above_that_of_the_cl_file_is_found_where_rotary_axes_turn_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mut cl = "UNITS/MM\nLOADTL/1\nSPINDL/3000,RPM,CLW\nMULTAX/ON\nRAPID\nGOTO/60,0,-20,1,0,0\nFEDRAT/100,MMPM\n".to_owned();
    for step in 0..10 {
        let (sine, cosine) = libm::sincos(f64::from(12 * step).to_radians());
        let (x, y) = (30.0 * cosine, 30.0 * sine);
        writeln!(cl, "GOTO/{x:.5},{y:.5},-20,{cosine:.9},{sine:.9},0").unwrap();
    }
    fs::write(folder.path().join("part.cls"), cl + "FINI\n").unwrap();
    // The part turns about the line of its own middle: of each chord the axis makes an arc.
    let with =
        ["-m", "lathe-xzc-radial", "--tool-length", "100", "--set", "accuracy.tolerance=0.2"];
    let made = post_in(folder.path(), &[&["-q", "-o", "part.nc", "part.cls"][..], &with].concat());
    assert_eq!(made.code, 0, "{}", made.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    // The word of the feed of a block that turns C alone.
    let turns = |line: &&str| {
        let letters = line.split(' ').filter_map(|word| word.chars().next());
        letters.filter(|letter| matches!(letter, 'X' | 'Z' | 'C')).eq(['C']) && line.contains(" F")
    };
    let line = program.lines().find(turns).unwrap_or_else(|| panic!("{program}"));
    let word = line.split(' ').find(|word| word.starts_with('F')).unwrap();
    let feed: f64 = word[1..].parse().unwrap();
    for factor in [1.0, 0.5, 1.1, 1.2, 1.5, 1.9] {
        let other = line.replace(word, &format!("F{:.4}", feed * factor));
        fs::write(folder.path().join("other.nc"), program.replacen(line, &other, 1)).unwrap();
        let against = ["verify", "-q", "other.nc", "--against", "part.cls"];
        let read = post_in(folder.path(), &[&against[..], &with].concat());
        let says = match factor {
            1.0 => "",
            0.5 => "feed is below",
            _ => "feed is above",
        };
        let code = i32::from(!says.is_empty());
        assert!(read.code == code && read.err.contains(says), "{factor}: {}\n{other}", read.err);
    }
}
