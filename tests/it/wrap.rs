//! `[mode.wrap]`: cylinder interpolation by the control. What its words make of the turning axis is worked out here, and the
//! places between them are put through the tests' own kinematics.

use crate::common;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;

use common::{Run, post};
use post_testkit::randomised;
use post_testruns::read_back::{Model, V, angle, blocks};

const LENGTH: f64 = 60.0;

/// Largest deviation of the machine, mm.
const TOLERANCE: f64 = 0.01;

/// Points on a mantle: angle about Z (radians), radius, Z.
type Place = [f64; 3];

fn at([turn, radius, z]: Place) -> V {
    let (sine, cosine) = libm::sincos(turn);
    V::new(radius * cosine, radius * sine, z)
}

/// A CL file that goes down to the first place from above, along all of them at `feed`, and up from the last.
fn milled(path: &[Place], feed: f64) -> String {
    let mut text = format!("LOAD/TOOL,1\nSPINDL/RPM,3000,CLW\nMULTAX/ON\nFEDRAT/{feed:.1},MMPM\n");
    let mut goto = |place: Place, rapid: bool| {
        let word = if rapid { "RAPID\n" } else { "" };
        let (tip, axis) = (at(place), at([place[0], 1.0, 0.0]));
        let [x, y, z, i, j, k] = [tip.x, tip.y, tip.z, axis.x, axis.y, axis.z];
        writeln!(text, "{word}GOTO/{x:.5},{y:.5},{z:.5},{i:.8},{j:.8},{k:.8}").unwrap();
    };
    let above = |[turn, _, z]: Place| [turn, 50.0, z];
    goto(above(path[0]), true);
    path.iter().for_each(|place| goto(*place, false));
    goto(above(path[path.len() - 1]), true);
    text + "FINI\n"
}

fn run(folder: &std::path::Path, cl: &str, set: &[&str]) -> Run {
    let part = folder.join("part.cls");
    fs::write(&part, cl).unwrap();
    let length = LENGTH.to_string();
    let mut all = vec!["-q", "-m", "lathe-xzc-mantle", "--tool-length", &length];
    set.iter().for_each(|set| all.extend(["--set", set]));
    let nc = folder.join("part.nc");
    let _ = fs::remove_file(&nc);
    all.extend(["--verify", "-o", nc.to_str().unwrap(), part.to_str().unwrap()]);
    let mut run = post(&all);
    run.out = fs::read_to_string(&nc).unwrap_or_default();
    run
}

/// Distance of a point from a path of straight pieces.
fn apart(at: V, path: &[V]) -> f64 {
    let of = |pair: &[V]| {
        let way = pair[1] - pair[0];
        let along = ((at - pair[0]).dot(&way) / way.norm_squared().max(1e-12)).clamp(0.0, 1.0);
        (at - pair[0] - way * along).norm()
    };
    path.windows(2).map(of).fold(f64::INFINITY, f64::min)
}

/// A line without the number of its block.
fn unnumbered(line: &str) -> &str {
    match line.split_once(' ') {
        Some((first, rest)) if first.starts_with('N') => rest,
        _ => line,
    }
}

/// The lines between those that begin and end the mode, the words of C as degrees; `length`: they are lengths on that radius.
fn unwrapped(program: &str, on: &str, off: &str, letter: &str, length: Option<f64>) -> String {
    let mut inside = false;
    let lines = program.lines().map(|line| {
        let line = unnumbered(line);
        if line == on || line == off {
            inside = line == on;
            return String::new();
        }
        let words = line.split_whitespace().map(|word| {
            let value = word.strip_prefix(letter).and_then(|value| value.parse::<f64>().ok());
            match (value, inside) {
                (Some(value), true) => {
                    let degrees = length.map_or(value, |radius| (value / radius).to_degrees());
                    format!("C{degrees:.9}")
                }
                _ => word.to_owned(),
            }
        });
        words.collect::<Vec<_>>().join(" ")
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn between_the_words_the_tool_keeps_to_the_chords_and_the_feed_is_that_of_the_mantle() {
    let (rounds, mut rng) = randomised(9, 31);
    let model = Model::new("lathe-xzc-radial", None);
    let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let (x, z, c) = (place("X"), place("Z"), place("C"));
    let mut put_in = 0;
    for round in rounds {
        let folder = tempfile::tempdir().unwrap();
        let radius = rng.range(15.0, 40.0);
        // On longer steps a machine without Y is off the chord by more than the tolerance, since the axis turns evenly.
        let (step, pitch) = (rng.range(-0.3, 0.3), rng.range(-4.0, 4.0));
        let first = rng.range(-TAU / 2.0, TAU / 2.0);
        let path: Vec<Place> = (0..12)
            .map(|count| {
                let count = f64::from(count);
                let deep = radius - 0.05 * count;
                [first + step * count, deep, -30.0 + pitch * count]
            })
            .collect();
        let feed = [100.0, 800.0][rng.pick(2)];
        let lengths = rng.pick(2) == 0;
        let cylinder = (radius * 1000.0).round() / 1000.0;
        let (on, off, letter) = match lengths {
            true => (format!("TRACYL({})", 2.0 * cylinder), "TRAFOOF", "Y"),
            false => (format!("G7.1 C{cylinder}"), "G7.1 C0", "C"),
        };
        let mut set = vec![format!("mode.wrap.radius={cylinder}")];
        if lengths {
            let more = [
                "control.dialect=siemens",
                "mode.wrap.on=TRACYL({d})",
                "mode.wrap.off=TRAFOOF",
                "mode.wrap.letter=Y",
                "mode.wrap.lengths=true",
            ];
            set.extend(more.map(str::to_owned));
        }
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let made = run(folder.path(), &milled(&path, feed), &set);
        assert_eq!(made.code, 0, "round {round}: {}", made.err);
        let program = &made.out;
        let plain = unwrapped(program, &on, off, letter, lengths.then_some(cylinder));
        assert_ne!(&plain, program, "{on}\n{program}");
        let stands = blocks(&plain, &names, &[]);
        let wanted: Vec<V> = path.iter().map(|place| at(*place)).collect();
        let begins = program.lines().position(|line| unnumbered(line) == on).unwrap();
        let inside = program.lines().skip(begins).position(|line| unnumbered(line) == off);
        let ends = begins + inside.unwrap();
        let depth = |block: &post_testruns::read_back::Block| {
            model.pose(&block.words, LENGTH).tip.xy().norm()
        };
        let mut looked = 0;
        for pair in stands.windows(2) {
            let [from, to] = pair else { unreachable!() };
            if !(begins..ends).contains(&(to.line - 1))
                || depth(from) > radius + 0.01
                || depth(to) > radius + 0.01
            {
                continue;
            }
            looked += 1;
            let mut way = 0.0;
            let mut last = model.pose(&from.words, LENGTH).tip;
            for share in 1..=50 {
                let t = f64::from(share) / 50.0;
                let ends = from.words.iter().zip(&to.words);
                let words: Vec<f64> = ends.map(|(from, to)| from + (to - from) * t).collect();
                let pose = model.pose(&words, LENGTH);
                assert!(apart(pose.tip, &wanted) < TOLERANCE, "line {}\n{program}", to.line);
                let radial = V::new(pose.tip.x, pose.tip.y, 0.0);
                assert!(angle(pose.axis, radial) < 1e-3, "line {}\n{program}", to.line);
                way += (pose.tip - last).norm();
                last = pose.tip;
            }
            let turned = (to.words[c] - from.words[c]).to_radians() * cylinder;
            let counted = libm::hypot(
                turned,
                libm::hypot(to.words[x] - from.words[x], to.words[z] - from.words[z]),
            );
            let pace = feed_at(program, to.line) * way / counted;
            // A short block has rounded words, and F no decimals.
            let rounded = 1.0 + 0.004 / way;
            assert!(pace < (feed + 1.0) * rounded, "line {}: {pace}\n{program}", to.line);
            assert!(pace * rounded > feed * 0.98 - 2.0, "line {}: {pace}\n{program}", to.line);
        }
        assert!(looked >= path.len() - 1, "{looked}\n{program}");
        put_in += looked - (path.len() - 1);
        assert!(!program.contains("G93"), "{program}");
    }
    assert!(put_in > 0);
}

/// The feed in force on a line, counted from 1.
fn feed_at(program: &str, line: usize) -> f64 {
    let words = program.lines().take(line).flat_map(str::split_whitespace);
    let feeds = words.filter_map(|word| word.strip_prefix('F')?.trim_end_matches('.').parse().ok());
    feeds.last().unwrap()
}

fn groove() -> String {
    let path: Vec<Place> =
        (0..8).map(|count| [f64::from(count) * 0.2, 38.0, -30.0 - f64::from(count)]).collect();
    milled(&path, 300.0)
}

#[test]
fn the_mode_is_read_by_the_word_of_the_control_and_what_is_wrong_in_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let made = run(folder.path(), &groove(), &[]);
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
            "lathe-xzc-mantle",
            "--tool-length",
            "60",
            "--against",
            part.to_str().unwrap(),
        ]);
        assert_eq!(told.code, 1, "{from}: {}{}", told.out, told.err);
        assert!(told.err.contains(says), "{from}: {says}\n{}", told.err);
    };
    wrong("F300.", "F330.", "feed is above");
    wrong("G7.1 C38", "G7.1 C39", "its radius is 39 mm, that of [mode.wrap] 38 mm");
    wrong("G7.1 C0\n", "", "cylinder interpolation is in force");
    wrong("C34.377", "C35.377", "off the CL path");
}

#[test]
fn what_the_mode_cannot_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |set: &[&str], says: &str| {
        let made = run(folder.path(), &groove(), set);
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{set:?}");
        assert!(made.err.contains(says), "{says}\n{}", made.err);
    };
    refused(&["axis.C.zero=10"], "show zero in the drawing");
    refused(&["mode.wrap.letter=Z"], "letter of another axis");
    refused(&["mode.wrap.radius=0"], "radius");
    refused(&["mode.wrap.lengths=true"], "the word of dialect fanuc is C, an angle");
    refused(&["mode.wrap.letter=Y"], "the word of dialect fanuc is C, an angle");
    let tracyl = ["control.dialect=siemens", "mode.wrap.on=TRACYL({d})", "mode.wrap.off=TRAFOOF"];
    refused(&tracyl, "the word of dialect siemens is Y, a length");
    refused(&["control.units=inch", "mode.wrap.lengths=true"], "in mm alone");
    refused(&["control.dialect=heidenhain"], "no word of it that begins cylinder interpolation");
    let check = post(&["check", "lathe-xzc-mantle", "--tool-length", "60"]);
    let line = "mantle           G7.1 C38 to G7.1 C0: C is an angle of radius 38 mm";
    assert!(check.out.contains(line), "{}", check.out);
}

/// Haas lays the words of a linear axis along the cylinder: beside G107 stand its letter, that of the axis that turns, and the
/// radius behind R or the diameter behind Q.
#[test]
fn haas_lays_the_words_of_a_linear_axis_along_the_cylinder() {
    let folder = tempfile::tempdir().unwrap();
    let set = |on: &'static str| {
        let more = ["mode.wrap.off=G107", "mode.wrap.letter=Y", "mode.wrap.lengths=true"];
        [&["control.dialect=haas", on], &more[..]].concat()
    };
    let wrong = run(folder.path(), &groove(), &set("mode.wrap.on=G107 C{r}"));
    assert_eq!((wrong.code, wrong.out.as_str()), (1, ""));
    assert!(wrong.err.contains("dialect haas reads R or Q beside G107"), "{}", wrong.err);
    let made = run(folder.path(), &groove(), &set("mode.wrap.on=G107 Y0 C0 R{r}"));
    assert_eq!(made.code, 0, "{}", made.err);
    let by_diameter = run(folder.path(), &groove(), &set("mode.wrap.on=G107 Y0 C0 Q{d}"));
    assert_eq!(by_diameter.code, 0, "{}", by_diameter.err);
    assert_eq!(by_diameter.out.replace("Q76", "R38"), made.out);
    let set = set("mode.wrap.on=G107 Y0 C0 R{r}");
    for (line, says) in [
        ("G107 Y0 C0 R39", "its radius is 39 mm"),
        ("G107 Y0 C0 Q38", "its radius is 19 mm"),
        ("G107 Y0 C0", "not its radius"),
        ("G107 Y0 R38", "not which axis turns it"),
        ("G107 Z0 C0 R38", "lengths of Z along the cylinder"),
        ("G107 C0 R38", "begins no mode"),
    ] {
        let text = made.out.replacen("G107 Y0 C0 R38", line, 1);
        assert_ne!(text, made.out, "{line}");
        let nc = folder.path().join("other.nc");
        fs::write(&nc, text).unwrap();
        let mut read = vec!["read", nc.to_str().unwrap(), "-m", "lathe-xzc-mantle"];
        set.iter().for_each(|set| read.extend(["--set", *set]));
        let told = post(&read);
        assert!(told.code == 1 && told.err.contains(says), "{line}: {}{}", told.out, told.err);
    }
}
