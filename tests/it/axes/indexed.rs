//! Positions and clamps of index tables, and the sixth axis.

use super::*;

// ---------------------------------------------------------------------------------------------------------------
// Index tables
// ---------------------------------------------------------------------------------------------------------------

/// What an operator at the machine sees, line by line: an index axis moves alone, at the reference, let go; it
/// is clamped in cuts, and nothing is clamped or let go between two cuts. The places where it stood.
fn watch(program: &str, axis: char, clamp: &str, unclamp: &str, reference: &str) -> Vec<f64> {
    let conversational = program.starts_with("0 BEGIN");
    let (mut clamped, mut away, mut modal_rapid) = (None, true, true);
    let (mut cutting, mut handled) = (false, false);
    let mut stood: Vec<f64> = Vec::new();
    for line in program.lines() {
        let code = line.split(['(', ';']).next().unwrap();
        let words: Vec<&str> = code.split_whitespace().skip(usize::from(conversational)).collect();
        if code.contains(reference) {
            away = true;
            continue;
        }
        if ["G28", "G53", "CYCL", "TOOL", "BLK"].iter().any(|other| words.contains(other)) {
            continue;
        }
        for word in &words {
            match *word {
                "G0" => modal_rapid = true,
                "G1" => modal_rapid = false,
                word if word == clamp => (clamped, handled) = (Some(true), true),
                word if word == unclamp => (clamped, handled) = (Some(false), true),
                _ => {}
            }
        }
        let rapid = if conversational { words.contains(&"FMAX") } else { modal_rapid };
        let value = |name: char| {
            let word = words.iter().find(|word| word.starts_with(name))?;
            word[1..].parse::<f64>().ok()
        };
        let slides = "XYZW".chars().any(|name| value(name).is_some());
        if let Some(value) = value(axis)
            && stood.last() != Some(&value)
        {
            assert!(rapid && !slides, "{axis} does not turn alone: {line}");
            assert_eq!(clamped, Some(false), "{axis} turns and was not let go: {line}");
            assert!(away, "{axis} turns, and the tool is not at the reference: {line}");
            stood.push(value);
        }
        if slides {
            away = false;
            if !rapid {
                assert_eq!(clamped, Some(true), "a cut with {axis} loose: {line}");
                assert!(!(cutting && handled), "a clamp within a cut: {line}");
            }
            (cutting, handled) = (!rapid, false);
        }
    }
    stood
}

/// Two cuts on each of some sides of a box; the tool leans by these angles from Z to X.
fn sides(angles: &[f64]) -> String {
    let mut cl = cl();
    for side in angles {
        let out = lean(*side, 0.0);
        let along = V::new(out.z, 0.0, -out.x);
        let foot = out * 100.0 + V::y() * 120.0;
        cl = cl.rapid(foot + out * 50.0, out);
        cl = cl.cut(foot, out).cut(foot + along * 20.0, out);
        cl = cl.rapid(foot + along * 20.0 + out * 50.0, out);
    }
    cl.end()
}

#[test]
fn an_index_table_turns_at_the_reference_let_go_and_is_clamped_in_cuts() {
    let cl = sides(&[0.0, 90.0, 35.0, 270.0, 271.0]);
    for (dialect, reference) in [("fanuc", "G53 G0 "), ("heidenhain", "M91")] {
        let made = on("hmc-b-pallet").with("control.dialect", dialect).made(&cl);
        let stood = watch(&made.text, 'B', "M10", "M11", reference);
        assert_eq!(stood, [0.0, 90.0, 35.0, 270.0, 271.0], "{dialect}");
        // The tip is where the CL file has it: on each side, both ends of the cut.
        let poses = made.poses();
        for point in post_testruns::read_back::points(&cl) {
            let met = poses.iter().any(|pose| {
                (pose.tip - point.tip).norm() < ROUNDING && angle(pose.axis, point.axis) < 0.002
            });
            assert!(met, "{dialect}: CL line {}", point.line);
        }
    }
    let stood = on("vmc-b")
        .with("axis.B.indexed", "0")
        .with("axis.B.step", "15")
        .with("axis.B.clamp", "M20")
        .with("axis.B.unclamp", "M21");
    let made = stood.made(&sides(&[0.0, 30.0, -45.0]).replace("120.0", "20.0"));
    let stood = watch(&made.text, 'B', "M20", "M21", "M91");
    assert_eq!(stood, [0.0, 30.0, -45.0]);
}

/// Two quills: the spindle is drawn back, and the column stays where it is.
#[test]
fn a_boring_mill_indexes_with_column_and_spindle_at_the_reference() {
    let cl = sides(&[0.0, 90.0, 180.0]).replace("120.0", "300.0");
    let made = on("boring-mill").made(&cl);
    watch(&made.text, 'B', "M12", "M13", "G53 G0 ");
}

#[test]
fn a_list_of_positions_is_kept_to() {
    let cl = sides(&[0.0, 90.0, 270.0, 180.0]).replace("120.0", "300.0");
    let made = on("boring-mill").long(150.0).made(&cl);
    let stood = watch(&made.text, 'B', "M12", "M13", "G53 G0 ");
    assert_eq!(stood, [0.0, 90.0, 270.0, 180.0]);
}

/// Positions, travel and where it starts are all as the control shows them.
#[test]
fn positions_are_given_in_what_the_control_shows() {
    let cl = sides(&[0.0, 90.0, 270.0, 180.0]).replace("120.0", "300.0");
    let made = on("boring-mill")
        .long(150.0)
        .with("axis.B.zero", "45")
        .with("axis.B.indexed", "45")
        .with("axis.B.positions", "[45, 135, 225, 315]")
        .with("axis.B.travel", "[45, 315]")
        .made(&cl);
    let stood = watch(&made.text, 'B', "M12", "M13", "G53 G0 ");
    assert_eq!(stood, [45.0, 135.0, 315.0, 225.0]);
}

#[test]
fn an_orientation_between_positions_names_the_nearest() {
    for (machine, side, nearest) in [
        ("hmc-b-pallet", 30.3, "30.000°"),
        ("hmc-b-pallet", 30.7, "31.000°"),
        ("boring-mill", 80.0, "90.000°"),
        ("boring-mill", 20.0, "0.000°"),
    ] {
        let cl = sides(&[0.0, side]).replace("120.0", "300.0");
        let said = on(machine).long(150.0).refused(&cl);
        let wanted = format!(
            "error[out-of-reach]: B would have to stand at {side:.3}°, and the nearest of its positions is {nearest}"
        );
        assert!(said.contains(&wanted), "{said}");
    }
}

/// Both axes stand in cuts: 3+2.
fn three_plus_two() -> Setup {
    on("ac-trunnion")
        .with("axis.A.indexed", "0")
        .with("axis.A.clamp", "M10")
        .with("axis.A.unclamp", "M11")
        .with("axis.C.indexed", "0")
        .with("axis.C.clamp", "M12")
        .with("axis.C.unclamp", "M13")
}

#[test]
fn two_indexed_axes_make_facets_and_refuse_simultaneous_cuts() {
    let mut cl = cl();
    for azimuth in [0.0, 72.0, 144.0, 216.0] {
        let out = lean(35.0, azimuth);
        cl = cl.rapid(out * 90.0, out).cut(out * 40.0, out);
        let along = V::new(-out.y, out.x, 0.0).normalize();
        cl = cl.cut(out * 40.0 + along * 15.0, out);
        cl = cl.rapid(out * 90.0 + along * 15.0, out);
    }
    let cl = cl.end();
    let made = three_plus_two().made(&cl);
    for (axis, clamp, unclamp) in [('A', "M10", "M11"), ('C', "M12", "M13")] {
        let place = made.place(&axis.to_string());
        for pair in made.blocks.windows(2).filter(|pair| !pair[1].rapid) {
            assert_eq!(pair[0].words[place], pair[1].words[place], "{axis}");
        }
        // The other may turn in the same block; neither in a cut, nor clamped, nor over the part.
        let stood = watch(&made.text, axis, clamp, unclamp, "G53 G0 ");
        assert!(!stood.is_empty());
    }
    let poses = made.poses();
    for point in post_testruns::read_back::points(&cl) {
        let met = poses.iter().any(|pose| {
            (pose.tip - point.tip).norm() < ROUNDING && angle(pose.axis, point.axis) < 0.002
        });
        assert!(met, "CL line {}", point.line);
    }
    let said = three_plus_two().refused(&turning_cuts());
    assert!(said.contains("GOTO / 14.000000, 4.000000"), "{said}");
}

/// A cut that would turn an index table says which axis would have to turn.
#[test]
fn a_cut_that_turns_an_index_table_is_refused_by_name() {
    let simultaneous = three_plus_two().refused(&turning_cuts());
    assert!(!simultaneous.contains("from :"), "{simultaneous}");
    let text = cl()
        .rapid(V::new(0.0, 120.0, 150.0), V::z())
        .cut(V::new(0.0, 120.0, 100.0), V::z())
        .cut(V::new(100.0, 120.0, 0.0), V::x())
        .end();
    let said = on("hmc-b-pallet").refused(&text);
    assert!(said.contains("B 0.000°") || said.contains("B would"), "{said}");
}

/// A first position without RAPID before it is a move with a feed.
#[test]
fn a_first_position_at_feed_is_made_with_the_table_clamped() {
    let text =
        cl().cut(V::new(0.0, 120.0, 150.0), V::z()).cut(V::new(0.0, 120.0, 100.0), V::z()).end();
    let made = on("hmc-b-pallet").made(&text);
    watch(&made.text, 'B', "M10", "M11", "G53 G0 ");
}

// ---------------------------------------------------------------------------------------------------------------
// A sixth axis, set between cuts
// ---------------------------------------------------------------------------------------------------------------

/// A cut before and one behind an index move of B.
fn indexed_cuts(angle: f64) -> String {
    let mut cl = cl().rapid(V::new(0.0, 0.0, 90.0), lean(10.0, 80.0));
    for step in 0..4 {
        let step = f64::from(step);
        cl = cl.cut(V::new(20.0 * step, 5.0, 30.0), lean(10.0 + 3.0 * step, 80.0));
    }
    cl = cl.rapid(V::new(60.0, 5.0, 90.0), lean(19.0, 80.0));
    cl = cl.line(&format!("ROTABL / BAXIS, {angle}"));
    cl = cl.rapid(V::new(-60.0, 60.0, 90.0), lean(15.0, 70.0));
    for step in 0..4 {
        let step = f64::from(step);
        cl = cl.cut(V::new(20.0 * step, 40.0, 25.0), lean(15.0 + 3.0 * step, 70.0));
    }
    cl.rapid(V::new(60.0, 40.0, 90.0), lean(24.0, 70.0)).end()
}

/// The block in a line turns axes: right before it the tool was retracted, and its length cancelled.
fn assert_retracted(made: &Made, line: usize) {
    let lines: Vec<&str> = made.text.lines().collect();
    let before = &lines[line - 3..line - 1];
    assert!(before[0].starts_with("G53 G0 Z") && before[1] == "G49", "{before:?}");
}

#[test]
fn an_index_move_of_the_file_sets_the_sixth_axis() {
    let cl = indexed_cuts(25.0);
    let made = on("disc-cutter").long(0.0).made(&cl);
    let words = made.words("B");
    let turned = words.iter().position(|word| *word != 0.0).unwrap();
    assert!(turned > 0 && words[turned..].iter().all(|word| *word == 25.0), "{words:?}");
    let poses = made.poses();
    let index_line = 1 + cl.lines().position(|line| line.starts_with("ROTABL")).unwrap();
    let mut at = 0;
    for point in post_testruns::read_back::points(&cl) {
        let met = (at..poses.len()).find(|at| {
            (poses[*at].tip - point.tip).norm() < 4e-4 && angle(poses[*at].axis, point.axis) < 2e-4
        });
        at = met.unwrap_or_else(|| panic!("CL line {}\n{}", point.line, made.text));
        assert_eq!(at >= turned, point.line > index_line, "CL line {}", point.line);
    }
    // It turns at the reference, alone or with the other rotary axes.
    let line = made.line(&made.blocks[turned]);
    assert!(line.contains("B25.0000") && !line.contains('X'), "{line}");
    assert_retracted(&made, made.blocks[turned].line);
}

#[test]
fn an_index_move_that_cannot_be_is_refused_by_name() {
    let said = on("disc-cutter").long(0.0).refused(&indexed_cuts(200.0));
    assert!(said.contains("error[index]: B cannot stand at 200.000°"), "{said}");
    let said = on("disc-cutter").long(0.0).with("axis.B.step", "15").refused(&indexed_cuts(25.0));
    assert!(said.contains("error[index]: B cannot stand at 25.000°"), "{said}");
    assert!(said.contains("ROTABL / BAXIS, 25"), "{said}");
}

/// A ends at 30°, the second cut asks for 40°: with B at 15° towards it, 25° are left.
#[test]
fn the_sixth_axis_is_set_so_that_the_others_stay_in_travel() {
    let mut cl = cl();
    for tilt in [20.0, 40.0, 15.0] {
        let out = lean(tilt, 0.0);
        cl = cl.rapid(out * 150.0, out).cut(out * 60.0, out);
        cl = cl.cut(out * 60.0 + V::y() * 40.0, out);
        cl = cl.rapid(out * 150.0 + V::y() * 40.0, out);
    }
    let cl = cl.end();
    let narrow = || on("disc-cutter").long(0.0).with("axis.A.travel", "[-30, 30]");
    let said = narrow().refused(&cl);
    assert!(said.contains("error[over-travel]: A would be"), "{said}");
    let made = narrow().with("axis.B.step", "15").made(&cl);
    let words = made.words("B");
    assert!(words.contains(&0.0) && words.contains(&15.0), "{words:?}");
    for word in &words {
        assert!([0.0, 15.0].contains(word), "{words:?}");
    }
    for word in made.words("A") {
        assert!(word.abs() <= 30.0);
    }
    let place = made.place("B");
    for pair in made.blocks.windows(2) {
        if pair[0].words[place] != pair[1].words[place] {
            assert!(pair[1].rapid && !made.line(&pair[1]).contains('X'));
            assert_retracted(&made, pair[1].line);
        }
    }
    let poses = made.poses();
    for point in post_testruns::read_back::points(&cl) {
        let met = poses.iter().any(|pose| {
            (pose.tip - point.tip).norm() < 4e-4 && angle(pose.axis, point.axis) < 2e-4
        });
        assert!(met, "CL line {}", point.line);
    }
}
