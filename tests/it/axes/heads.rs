//! Heads that are swapped, and their swing length.

use super::*;

// ---------------------------------------------------------------------------------------------------------------
// Heads
// ---------------------------------------------------------------------------------------------------------------

/// A cut with the straight head, one with the other, and one with the straight head again.
fn heads(other: &str) -> String {
    let mut text = cl();
    for (head, axis) in [(None, V::z()), (Some(other), V::y()), (Some("STRAIGHT"), V::z())] {
        if let Some(head) = head {
            // Of a tool that lies down the control's length is 0: it has a number of its own.
            let tool = if head == "STRAIGHT" { 1 } else { 2 };
            text = text.line(&format!("HEAD / {head}"));
            text = text.line(&format!("LOADTL / {tool}"));
        }
        text = text.rapid(axis * 200.0, axis).cut(axis * 150.0, axis);
        text = text.cut(axis * 150.0 + V::x() * 20.0, axis);
        text = text.rapid(axis * 200.0 + V::x() * 20.0, axis);
    }
    text.end()
}

#[test]
fn a_head_is_swapped_between_retract_and_next_position() {
    let text = heads("ANGLE");
    let setup = on("head-change");
    let made = setup.made(&text);
    let swaps = ["M61".to_owned(), "M62".to_owned()];
    let names: Vec<&str> = made.names.iter().map(String::as_str).collect();
    let blocks = blocks(&made.text, &names, &swaps);
    let models = [None, Some("ANGLE"), Some("STRAIGHT")].map(|head| setup.model(head));
    let mut at = 0;
    for point in post_testruns::read_back::points(&text) {
        let model = match point.head.as_deref() {
            None => 0,
            Some("ANGLE") => 1,
            _ => 2,
        };
        let met = (at..blocks.len()).find(|at| {
            let pose = models[model].pose(&blocks[*at].words, 100.0);
            blocks[*at].swaps == model
                && (pose.tip - point.tip).norm() < ROUNDING
                && angle(pose.axis, point.axis) < 0.002
        });
        at = met.unwrap_or_else(|| panic!("CL line {}:\n{}", point.line, made.text));
    }
    let lines: Vec<&str> = made.text.lines().collect();
    for swap in ["M62", "M61"] {
        let place = lines.iter().position(|line| *line == swap).unwrap();
        let before = lines[..place].iter().rposition(|line| line.starts_with("G53 G0 Z")).unwrap();
        let between = &lines[before + 1..place];
        assert!(between.iter().all(|line| !line.contains(['X', 'Y', 'Z', 'C'])), "{between:?}");
    }
}

/// The operator swaps a head that has no word.
#[test]
fn a_head_without_a_word_stops_the_program() {
    let setup = on("head-change").file(
        "[head.SIDE]\noffset = 2\n[head.SIDE.tool]\ngauge = [180, 0, 1050]\naxis = [-1, 0, 0]\nlength_axis = \"none\"\n",
    );
    let made = setup.made(&heads("SIDE"));
    let lines: Vec<&str> = made.text.lines().collect();
    let told = lines.iter().position(|line| *line == "(CHANGE TO HEAD SIDE)").unwrap();
    assert_eq!(lines[told + 1], "M0");
    let moved = |line: &&str| line.contains(['X', 'Y', 'C']) && line.starts_with("G0");
    let next = lines[told + 2..].iter().find(|line| moved(line)).unwrap();
    assert_eq!(*next, "G0 C-90.000");
    assert!(lines[..told].iter().rev().take(4).any(|line| line.starts_with("G53 G0 Z")));
}

#[test]
fn the_spindle_stands_while_a_head_is_swapped() {
    let made = on("head-change").made(&heads("ANGLE"));
    let swap = made.text.find("M62").unwrap();
    let spindle = made.text[..swap].rfind("M3").unwrap();
    assert!(made.text[spindle..swap].contains("M5"), "{}", made.text);
}

#[test]
fn a_head_that_is_not_there_is_refused() {
    let said = on("head-change").refused(&heads("BENT"));
    assert!(said.contains("error[head]: head change has no head BENT"), "{said}");
    assert!(said.contains("its heads are: ANGLE, STRAIGHT"), "{said}");
    let said = on("gantry").refused(&heads("ANGLE"));
    assert!(said.contains("error[head]"), "{said}");
}

#[test]
fn where_there_are_no_heads_the_help_says_so() {
    let said = on("gantry").refused(&heads("ANGLE"));
    assert!(!said.contains("its heads are: \n"), "{said}");
}

// ---------------------------------------------------------------------------------------------------------------
// The swing length
// ---------------------------------------------------------------------------------------------------------------

/// The A axis lies Lm behind the tip along the tool, and the work offset takes Lm out along Z: so the linear
/// words differ by the difference of Lm times (u - z).
#[test]
fn the_swing_length_moves_the_linear_words_along_the_tool() {
    let text = fs::read_to_string(root().join("tests/samples/blade.cls")).unwrap();
    let with = |length: &str| {
        let mut setup = on("disc-cutter").long(0.0).with("parameters.Lm", length);
        setup.ending = "cls";
        for key in ["tolerance", "axis_tolerance", "rapid_tolerance"] {
            setup = setup.with(&format!("accuracy.{key}"), "1000");
        }
        setup.made(&text)
    };
    let (short, long) = (with("250"), with("312"));
    assert!(short.blocks.len() > 60);
    let [a, c] = [short.place("A"), short.place("C")];
    for (block, by) in short.blocks.iter().zip(short.differences(&long)) {
        let (sa, ca) = libm::sincos(block.words[a].to_radians());
        let (sc, cc) = libm::sincos(block.words[c].to_radians());
        let u = V::new(sa * sc, -sa * cc, ca);
        let wanted = (u - V::z()) * 62.0;
        for (name, by) in short.names.iter().zip(&by) {
            let wanted = match name.as_str() {
                "X" => wanted.x,
                "Y" => wanted.y,
                "Z" => wanted.z,
                _ => 0.0,
            };
            assert!(near(*by, wanted, 2e-4), "line {}: {name} {by} {wanted}", block.line);
        }
    }
}
