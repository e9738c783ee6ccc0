//! `[mode.face]`: polar interpolation by the control. What the real axes do between the words is worked out here in polar
//! coordinates, and put through the tests' own kinematics.

use crate::common;

use std::fmt::Write as _;
use std::fs;

use common::{Run, post};
use post_testkit::randomised;
use post_testruns::read_back::{Model, V, blocks, unrolled};

const LENGTH: f64 = 60.0;

/// Largest deviation of the machine, mm.
const TOLERANCE: f64 = 0.01;

/// A CL file that mills a closed path on the face, at feed, from above its first point.
fn milled(path: &[V], feed: f64) -> String {
    let mut text = format!("LOAD/TOOL,1\nSPINDL/RPM,3000,CLW\nFEDRAT/{feed:.1},MMPM\n");
    let first = path[0];
    let mut goto = |at: V, rapid: bool| {
        let word = if rapid { "RAPID\n" } else { "" };
        writeln!(text, "{word}GOTO/{:.5},{:.5},{:.5},0,0,1", at.x, at.y, at.z).unwrap();
    };
    goto(V::new(first.x, first.y, 20.0), true);
    path.iter().for_each(|at| goto(*at, false));
    goto(first, false);
    goto(V::new(first.x, first.y, 20.0), true);
    text + "FINI\n"
}

fn run(folder: &std::path::Path, cl: &str, set: &[&str]) -> Run {
    let part = folder.join("part.cls");
    fs::write(&part, cl).unwrap();
    let length = LENGTH.to_string();
    let mut all = vec!["-q", "-m", "lathe-xzc-polar", "--tool-length", &length];
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

/// A path about the centre or beside it, no nearer to it than 4 mm.
fn path(rng: &mut post_testkit::Rng) -> Vec<V> {
    let depth = rng.range(-4.0, -1.0);
    let beside = rng.pick(2) == 0;
    let count = 3 + rng.pick(6);
    let centre = if beside { V::new(rng.range(-20.0, 20.0), 30.0, 0.0) } else { V::zeros() };
    let most = if beside { 20.0 } else { 40.0 };
    let turn = |place: usize| std::f64::consts::TAU * place as f64 / count as f64;
    let corner = |place: usize| {
        let (sine, cosine) = libm::sincos(turn(place) + 0.3);
        let radius = if beside { most } else { rng.range(12.0, most) };
        let at = centre + V::new(cosine, sine, 0.0) * radius;
        V::new(at.x, at.y, depth)
    };
    (0..count).map(corner).collect()
}

/// Dense places of the real axes lie on the path, and C and X keep their largest feeds.
#[test]
fn the_control_leads_the_tip_along_the_path_of_the_cl_file() {
    let (rounds, mut rng) = randomised(12, 12);
    let mut modes = 0;
    for round in rounds {
        let folder = tempfile::tempdir().unwrap();
        let path = path(&mut rng);
        let feed = [150.0, 900.0, 6000.0][rng.pick(3)];
        let (word, factor) = [("X", 1.0), ("2 * X", 2.0)][rng.pick(2)];
        let radius = rng.pick(2) == 0;
        let letter = "C";
        let set = [
            format!("word.X.is={word}"),
            format!("mode.face.radius={radius}"),
            format!("mode.face.letter={letter}"),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let made = run(folder.path(), &milled(&path, feed), &set);
        assert_eq!(made.code, 0, "round {round}: {}", made.err);
        let program = &made.out;
        let nearest = path.iter().map(|at| at.xy().norm()).fold(f64::INFINITY, f64::min);
        let inside = if radius { 1.0 } else { factor };
        if !program.contains("G12.1") {
            assert!(made.err.contains("[mode.face] goes no nearer"), "{nearest}\n{program}");
            continue;
        }
        modes += 1;
        let whole: Vec<V> = path.iter().chain(&path[..1]).copied().collect();
        assert_eq!(cuts(program), path.len() + 1, "a cut is a block\n{program}");
        look(program, (letter, inside), &whole);
    }
    assert!(modes > 0);
}

/// Blocks at feed on the depth of the path, and into it.
fn cuts(program: &str) -> usize {
    let inside = program.lines().skip_while(|line| *line != "G12.1");
    let inside = inside.take_while(|line| *line != "G13.1").skip_while(|line| !line.contains("Z-"));
    inside.take_while(|line| !line.contains("Z20")).count()
}

fn look(program: &str, (letter, inside): (&str, f64), path: &[V]) {
    let model = Model::new("lathe-xzc-face", None);
    let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let (x, z, c) = (place("X"), place("Z"), place("C"));
    // Words of X inside the mode are made radii, those outside are not looked at.
    let begins = program.lines().position(|line| line == "G12.1").unwrap();
    let before = program.lines().nth(begins - 1).unwrap();
    assert!(program.contains("G0 C0.000"), "{program}");
    let radii = unrolled(program, letter, inside);
    let real = blocks(&radii, &names, &[]);
    let plain = blocks(&program.replace(letter, "C"), &names, &[]);
    assert_eq!(real.len(), plain.len(), "{before}");
    let depth = path[0].z;
    let mut looked = 0;
    for pair in real.windows(2).zip(plain.windows(2)) {
        let ([from, to], [plain_from, plain_to]) = (pair.0, pair.1) else { unreachable!() };
        if to.line <= begins + 2 || (to.words[z] - depth).abs() > 1e-3 || to.rapid {
            continue;
        }
        let feed = feed_at(program, to.line);
        let ends = [plain_from, plain_to].map(|block| [block.words[x] / inside, block.words[c]]);
        let way =
            V::new(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1], to.words[z] - from.words[z]);
        let minutes = way.norm() / feed;
        let mut last: Option<[f64; 2]> = None;
        for step in 0..=200 {
            let t = f64::from(step) / 200.0;
            let at = [0, 1].map(|part| ends[0][part] + (ends[1][part] - ends[0][part]) * t);
            let mut words = to.words.clone();
            words[z] = from.words[z] + (to.words[z] - from.words[z]) * t;
            words[x] = libm::hypot(at[0], at[1]);
            words[c] = libm::atan2(at[1], at[0]).to_degrees();
            let tip = model.pose(&words, LENGTH).tip;
            if (from.words[z] - depth).abs() < 1e-3 {
                assert!(apart(tip, path) < TOLERANCE, "{tip} line {}\n{program}", to.line);
            }
            if let Some(last) = last {
                let turn = (words[c] - last[1] + 540.0).rem_euclid(360.0) - 180.0;
                let fastest = [turn.abs() / 36_000.0, (words[x] - last[0]).abs() / 24_000.0];
                let most = fastest[0].max(fastest[1]) * 200.0;
                assert!(most <= minutes * 1.02 + 1e-9, "line {}: {most}\n{program}", to.line);
            }
            last = Some([words[x], words[c]]);
        }
        looked += 1;
    }
    assert!(looked >= path.len() - 1, "{looked}\n{program}");
}

/// The feed in force on a line, counted from 1.
fn feed_at(program: &str, line: usize) -> f64 {
    let words = program.lines().take(line).flat_map(str::split_whitespace);
    let feeds = words.filter_map(|word| word.strip_prefix('F')?.trim_end_matches('.').parse().ok());
    feeds.last().unwrap()
}

const SQUARE: [V; 4] = [
    V::new(12.0, 12.0, -2.0),
    V::new(-12.0, 12.0, -2.0),
    V::new(-12.0, -12.0, -2.0),
    V::new(12.0, -12.0, -2.0),
];

#[test]
fn the_mode_is_read_by_the_word_of_the_control_and_what_is_wrong_in_it_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let made = run(folder.path(), &milled(&SQUARE, 300.0), &[]);
    assert_eq!(made.code, 0, "{}", made.err);
    let verify = |program: &str| {
        let nc = folder.path().join("other.nc");
        fs::write(&nc, program).unwrap();
        let part = folder.path().join("part.cls");
        post(&[
            "verify",
            nc.to_str().unwrap(),
            "-m",
            "lathe-xzc-polar",
            "--tool-length",
            "60",
            "--against",
            part.to_str().unwrap(),
        ])
    };
    let good = verify(&made.out);
    assert_eq!(good.code, 0, "{}{}", good.out, good.err);
    let wrong = |from: &str, to: &str, says: &str| {
        let text = made.out.replacen(from, to, 1);
        assert_ne!(text, made.out, "{from}\n{}", made.out);
        let told = verify(&text);
        assert_eq!(told.code, 1, "{from}: {}{}", told.out, told.err);
        assert!(told.err.contains(says), "{from}: {says}\n{}", told.err);
    };
    wrong("X-12.000", "X-12.500", "off the CL path");
    wrong("C-12.000", "C-11.000", "off the CL path");
    wrong("\nG0 C0.000", "\nG0 C10.000", "C stands at 10.000°");
    wrong("G13.1\n", "", "polar interpolation is in force");
}

#[test]
fn what_the_mode_cannot_is_refused_or_written_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let near = [V::new(12.0, 1.0, -2.0), V::new(-12.0, 1.0, -2.0), V::new(0.0, 20.0, -2.0)];
    let made = run(folder.path(), &milled(&near, 300.0), &[]);
    assert_eq!(made.code, 0, "{}", made.err);
    assert!(!made.out.contains("G12.1"), "{}", made.out);
    assert!(made.err.contains("come to 1 mm from the line"), "{}", made.err);
    let refused = |set: &[&str], says: &str| {
        let made = run(folder.path(), &milled(&SQUARE, 300.0), set);
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{set:?}");
        assert!(made.err.contains(says), "{says}\n{}", made.err);
    };
    refused(&["axis.C.zero=10"], "show zero in the drawing");
    refused(&["workpiece.mount=[0, 3, 120]"], "3 mm beside the line of C");
    refused(&["tool.gauge=[400, 2, 520]"], "2 mm beside it");
    refused(&["mode.face.letter=Z"], "letter of another axis");
    refused(&["axis.X.travel=[-420, -390]"], "X would be");
    refused(&["control.dialect=heidenhain"], "no word of it that begins polar interpolation");
    let cutcom =
        milled(&SQUARE, 300.0).replace("GOTO/-12.00000,12", "CUTCOM/LEFT\nGOTO/-12.00000,12");
    let made = run(folder.path(), &cutcom, &[]);
    assert_eq!(made.code, 1, "{}", made.out);
    assert!(made.err.contains("polar coordinates ([mode.face])"), "{}", made.err);
}

#[test]
fn a_mode_whose_words_the_control_does_not_have_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let square = [V::new(10.0, 10.0, -2.0), V::new(-10.0, 10.0, -2.0), V::new(-10.0, -12.0, -2.0)];
    let cl = milled(&square, 300.0);
    for (dialect, on, known) in [
        ("haas", "G12.1", "haas has G112"),
        ("siemens", "G12.1", "TRANSMIT"),
        ("fanuc", "G999", "G12.1, G112"),
    ] {
        let letter = "mode.face.letter=Y".to_owned();
        let set = [format!("control.dialect={dialect}"), format!("mode.face.on={on}"), letter];
        let made = run(folder.path(), &cl, &set.each_ref().map(String::as_str));
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{dialect} {on}");
        let message = format!("[mode.face] on = \"{on}\": dialect {dialect} knows no word of it");
        assert!(made.err.contains(&message) && made.err.contains(known), "{}", made.err);
    }
    assert_eq!(run(folder.path(), &cl, &["mode.face.on=G012.1"]).code, 0);
}

/// Behind other words than Fanuc's the coordinate has a letter of its own, which nobody guesses.
#[test]
fn the_letter_of_the_coordinate_is_said_behind_other_words_than_g12_1() {
    let folder = tempfile::tempdir().unwrap();
    let cl = milled(&SQUARE, 300.0);
    for (dialect, on) in [("haas", "G112"), ("siemens", "TRANSMIT"), ("fanuc", "G112")] {
        let set = [format!("control.dialect={dialect}"), format!("mode.face.on={on}")];
        let made = run(folder.path(), &cl, &set.each_ref().map(String::as_str));
        assert_eq!((made.code, made.out.as_str()), (1, ""), "{dialect} {on}");
        let says = format!("which letter the coordinate across has behind {on} is not said");
        assert!(made.err.contains(&says) && made.err.contains("letter = \"Y\""), "{}", made.err);
    }
}

/// DIAMOF ahead of TRANSMIT makes other words of X than the machine file tells of, and TRANSMIT(2) is another machine.
#[test]
fn transmit_is_read_as_the_machine_file_describes_it_alone() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "control.dialect=siemens",
        "mode.face.on=TRANSMIT",
        "mode.face.off=TRAFOOF",
        "mode.face.letter=Y",
        "word.X.is=2 * X",
    ];
    // The letter is that of the control.
    let other =
        run(folder.path(), &milled(&SQUARE, 300.0), &[&set[..3], &["mode.face.letter=C"]].concat());
    assert_eq!((other.code, other.out.as_str()), (1, ""));
    assert!(other.err.contains("the word of dialect siemens is Y, a length"), "{}", other.err);
    let made = run(folder.path(), &milled(&SQUARE, 300.0), &set);
    assert_eq!(made.code, 0, "{}", made.err);
    let verify = |program: &str, set: &[&str]| {
        let nc = folder.path().join("other.mpf");
        fs::write(&nc, program).unwrap();
        let part = folder.path().join("part.cls");
        let [nc, part] = [&nc, &part].map(|path| path.to_str().unwrap());
        let mut all = vec!["verify", nc, "-m", "lathe-xzc-polar", "--tool-length", "60"];
        all.extend(["--against", part]);
        set.iter().for_each(|set| all.extend(["--set", set]));
        post(&all)
    };
    let told = |from: &str, to: &str| {
        let text = made.out.replacen(from, to, 1);
        assert_ne!(text, made.out, "{from}\n{}", made.out);
        verify(&text, &set)
    };
    assert_eq!(told("TRANSMIT", "TRANSMIT(1)").code, 0);
    let refused = |from: &str, to: &str, says: &str| {
        let told = told(from, to);
        assert_eq!(told.code, 1, "{from}: {}{}", told.out, told.err);
        assert!(told.err.contains(says), "{says}\n{}", told.err);
    };
    refused("DIAMON", "DIAMOF", "diameters or radii of the words of X, against the machine file");
    refused("TRANSMIT", "TRANSMIT(2)", "this is data set 2 of the control");
    refused("TRANSMIT", "TRANSMIT\nAROT Z90", "the frame is turned in polar interpolation");
    // The second data set is what a machine file of it describes, and the first is not.
    let second = made.out.replace("TRANSMIT", "TRANSMIT(2)");
    let mut of_second = set;
    of_second[1] = "mode.face.on=TRANSMIT(2)";
    let good = verify(&second, &of_second);
    assert_eq!(good.code, 0, "{}{}", good.out, good.err);
    let other = verify(&made.out, &of_second);
    assert!(other.code == 1 && other.err.contains("this is data set 1"), "{}", other.err);
}
