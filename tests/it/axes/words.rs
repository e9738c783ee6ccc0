//! `[word.X]`: words that are no axis values. The axis values of each program are worked out here from its words, by the
//! sums that the machine file states, and put through the tests' own kinematics.

use post_testkit::randomised;

use super::*;

/// A lathe's face, turned by C; the same with X as a diameter.
const FACE: &str = "TOOL PATH/FACE,TOOL,MILL\nTLDATA/MILL,10.0,0.0,40.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\nLOAD/TOOL,1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/30,0,20,0,0,1\nFEDRAT/MMPM,400\nGOTO/30,0,-2\nGOTO/30,15,-2\nGOTO/10,28,-2\nGOTO/-12,-20,-3\nRAPID\nGOTO/-12,-20,30\nEND-OF-PATH\n";

fn lathe(more: &[(&str, &str)]) -> Setup {
    let mut setup = on("lathe-xzc-face").long(120.0);
    setup.ending = "cls";
    for (key, value) in more {
        setup = setup.with(key, value);
    }
    setup
}

#[test]
fn a_diameter_is_a_multiple_of_the_axis_wherever_the_tip_goes() {
    for (is, factor) in [("2 * X", 2.0), ("X / 4", 0.25), ("X", 1.0)] {
        let made = lathe(&[("word.X.is", &format!("{is:?}"))]).made(FACE);
        let x = made.place("X");
        let reached = made.blocks.iter().map(|block| {
            let mut words = block.words.clone();
            words[x] /= factor;
            made.model.pose(&words, made.length).tip
        });
        let reached: Vec<V> = reached.collect();
        for wanted in
            [[30.0, 0.0, -2.0], [30.0, 15.0, -2.0], [10.0, 28.0, -2.0], [-12.0, -20.0, -3.0]]
        {
            let hit = |tip: &V| (tip - V::from(wanted)).norm() < 0.015;
            assert!(reached.iter().any(hit), "{is} {wanted:?}\n{}", made.text);
        }
    }
    // In coordinates of the machine too.
    let park = |setup: Setup| setup.with("control.park.X", "-100").made(FACE).text;
    assert!(park(lathe(&[])).contains("G53 G0 X-100.000"));
    assert!(park(lathe(&[("word.X.is", "\"2 * X\"")])).contains("G53 G0 X-200.000"));
}

/// Read back, verified and held to the travel of the word.
#[test]
fn a_diameter_is_read_back_and_keeps_the_travel_of_its_word() {
    let folder = tempfile::tempdir().unwrap();
    let [part, nc] = ["part.cls", "part.nc"].map(|name| folder.path().join(name));
    let [part, nc] = [&part, &nc].map(|path| path.to_str().unwrap().to_owned());
    fs::write(&part, FACE).unwrap();
    let machine = ["-m", "lathe-xzc-face", "--tool-length", "120"];
    let diameter = ["--set", "word.X.is=2 * X"];
    let made = post(&[&machine[..], &diameter, &["-q", "-o", &nc, &part]].concat());
    assert_eq!(made.code, 0, "{}", made.err);
    let verify = ["verify", nc.as_str(), "--against", part.as_str()];
    let same = post(&[&verify[..], &machine, &diameter].concat());
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);
    let other = post(&[&verify[..], &machine].concat());
    assert_eq!(other.code, 1, "a diameter is no radius: {}{}", other.out, other.err);
    // X stands at -250 and farther in at the machine: twice that in the word.
    let out = ["--set", "word.X.travel=[-700, 40]"];
    let refused = post(&[&machine[..], &diameter, &out, &["-q", "-o", "-", &part]].concat());
    assert_eq!(refused.code, 1, "{}", refused.out);
    assert!(refused.err.contains("[[limit]] `2 * X >= -700` does not hold"), "{}", refused.err);
}

/// C of the wrist counts against the bed: its word has B in it, as of two arms on one drive.
#[test]
fn coupled_words_say_what_their_axes_do() {
    let (rounds, mut rng) = randomised(24, 32);
    for round in rounds {
        let tcp = if round % 2 == 0 { "post" } else { "control" };
        let share = rng.range(-1.5, 1.5);
        let both = rng.pick(2) == 0;
        let mut setup = on("bc-fork")
            .with("control.tcp", tcp)
            .with("workpiece.mount", "[0, 0, 300]")
            .with("word.B.is", &format!("\"B + {share} * C\""));
        if both {
            setup = setup.with("word.C.is", "\"2 * C - 0.25 * B\"");
        }
        let mut cl = cl().rapid(V::new(0.0, 0.0, 120.0), lean(20.0, 10.0));
        let mut wanted = Vec::new();
        for step in 0..5 {
            let tip = V::new(10.0 * f64::from(step), 4.0, rng.range(0.0, 30.0));
            let axis = lean(rng.range(10.0, 45.0), 10.0 + rng.range(-40.0, 40.0));
            cl = cl.cut(tip, axis);
            wanted.push((tip, axis));
        }
        let text = cl.rapid(V::new(0.0, 0.0, 150.0), wanted[4].1).end();
        let made = setup.made(&text);
        let [b, c] = ["B", "C"].map(|name| made.place(name));
        let reached: Vec<Pose> = made
            .blocks
            .iter()
            .map(|block| {
                let mut words = block.words.clone();
                // B + s·C = wb and C = wc, or 2·C - B/4 = wc.
                let (wb, wc) = (words[b], words[c]);
                words[c] = if both { (wc + 0.25 * wb) / (2.0 + 0.25 * share) } else { wc };
                words[b] = wb - share * words[c];
                made.model.pose(&words, made.length)
            })
            .collect();
        for (tip, axis) in wanted {
            let hit = |pose: &Pose| (pose.tip - tip).norm() < 0.02 && angle(pose.axis, axis) < 1e-3;
            assert!(reached.iter().any(hit), "round {round}: {tip} {axis}\n{}", made.text);
        }
        verified(&setup, &text, &made.text);
    }
}

/// The program holds what its CL file asks for, as `post verify` reads it.
fn verified(setup: &Setup, text: &str, program: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [part, nc] = ["part.ncl", "part.nc"].map(|name| folder.path().join(name));
    fs::write(&part, text).unwrap();
    fs::write(&nc, program).unwrap();
    let mut arguments: Vec<String> = ["verify", nc.to_str().unwrap(), "--against"]
        .into_iter()
        .chain([part.to_str().unwrap(), "-m", setup.machine, "--tool-length", "100"])
        .map(str::to_owned)
        .collect();
    for (key, value) in &setup.set {
        arguments.extend(["--set".to_owned(), format!("{key}={value}")]);
    }
    let run = post(&arguments);
    assert_eq!(run.code, 0, "{}{}\n{program}", run.out, run.err);
}

#[test]
fn check_tells_what_words_do() {
    let told = |sets: &[&str]| {
        let mut all = vec!["check", "bc-fork"];
        sets.iter().for_each(|set| all.extend(["--set", set]));
        post(&all)
    };
    let run = told(&["word.B.is=B - C", "word.X.is=2 * X"]);
    for row in ["X +10 by itself: X +20", "C +10 by itself: C +10, B -10", "B +10 by itself: B +10"]
    {
        assert!(run.out.contains(row), "{row}\n{}{}", run.out, run.err);
    }
    for (set, message) in [
        ("word.X.is=X + Y", "X and Y do not both turn"),
        ("word.B.is=C", "B does not stand in its own word"),
        ("word.X.is=-2 * X", "[axis.X] reversed = true says so"),
        ("word.B.is=B * C", "no sum of multiples of axes"),
        ("word.B.is=B + 90", "90 is added; [axis.B] zero says"),
        ("word.Q.is=2 * Q", "[word.Q] is the word of no axis"),
        ("word.B.is=B +", "a number or a name is missing"),
    ] {
        let run = told(&[set]);
        assert_eq!(run.code, 1, "{set}: {}", run.out);
        assert!(
            run.err.contains("machine-axis-word") && run.err.contains(message),
            "{set}: {}",
            run.err
        );
    }
    let circle = told(&["word.B.is=B + C", "word.C.is=C + B"]);
    assert!(circle.err.contains("do not tell where the axes stand"), "{}", circle.err);
}

/// A word along the way: what it goes by in each block is its share of the way of the tip, which is measured here by the
/// tests' own kinematics; nothing adds up over the blocks, and a block that says another is refused.
#[test]
fn a_word_goes_with_the_way_of_the_tip() {
    let per_mm = 0.0333;
    let setup = || {
        on("xyzac-trt")
            .long(50.0)
            .file(format!("[control]\nrapid = \"rapid\"\n[word.U]\nis = \"{per_mm} * s\"\n"))
    };
    let text = turning_cuts();
    let made = setup().made(&text);
    let word = |line: &str| {
        let word = line.split_whitespace().find(|word| word.starts_with('U'))?;
        Some(word[1..].parse::<f64>().unwrap())
    };
    let lines: Vec<&str> = made.text.lines().collect();
    let (mut way, mut last, mut cuts) = (0.0, None::<V>, 0);
    for block in &made.blocks {
        let tip = made.model.pose(&block.words, made.length).tip;
        if let (Some(last), false) = (last, block.rapid) {
            way += (tip - last).norm();
            cuts += 1;
            let said = word(lines[block.line - 1]).expect("a word in each cut");
            assert!((said - per_mm * way).abs() < 0.002, "{said} {}\n{}", per_mm * way, made.text);
        }
        last = Some(tip);
    }
    assert!(cuts > 4 && way > 10.0, "{cuts} {way}");
    // The same path without it.
    let plain = on("xyzac-trt").long(50.0).with("control.rapid", "rapid").made(&text);
    assert_eq!(plain.blocks.len(), made.blocks.len());
    // Read back, and with one word spoilt.
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let part = write("part.ncl", &text);
    let machine = write(
        "m.toml",
        &format!(
            "extends = \"xyzac-trt\"\n[control]\nrapid = \"rapid\"\n[word.U]\nis = \"{per_mm} * s\"\n"
        ),
    );
    let verify = |nc: &str| {
        post(&[
            "verify",
            nc,
            "-m",
            &machine,
            "--against",
            &part,
            "--tool-length",
            "50",
            "--set",
            "control.planes=false",
        ])
    };
    let same = verify(&write("part.ngc", &made.text));
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);
    let spoilt =
        lines.iter().rposition(|line| word(line).is_some_and(|value| value > 0.0)).unwrap();
    let other: Vec<String> = lines
        .iter()
        .enumerate()
        .map(|(place, line)| match word(line).filter(|_| place == spoilt) {
            Some(value) => line.replace(&format!("U{value:.4}"), &format!("U{:.4}", value + 0.5)),
            None => (*line).to_owned(),
        })
        .collect();
    let other = verify(&write("other.ngc", &other.join("\n")));
    assert!(other.code == 1 && other.err.contains("nc-along"), "{}{}", other.out, other.err);
}

#[test]
fn a_word_along_the_way_has_a_letter_of_its_own() {
    let said = |file: &str| on("xyzac-trt").file(file).refused(&turning_cuts());
    for (file, wanted) in [
        ("[word.C]\nis = \"2 * s\"\n", "it is the word of an axis"),
        ("[word.F]\nis = \"2 * s\"\n", "E, U, V, W, A, B or C can be such a word"),
        ("[word.E]\nis = \"s\"\ntravel = [0, 1]\n", "it has no travel"),
        ("[word.E]\nis = \"s\"\n[word.U]\nis = \"s\"\n", "one word alone"),
        ("[word.E]\nis = \"s + X\"\n", "is the word of no axis"),
    ] {
        let told = said(file);
        assert!(told.contains(wanted), "{file}: {told}");
    }
}
