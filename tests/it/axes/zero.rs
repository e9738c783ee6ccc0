//! Zero, sense and range of a rotary axis.

use super::*;

/// `angle` on the turn nearest to `last`: where a control that takes the shorter way turns to.
fn shorter(angle: f64, last: f64) -> f64 {
    angle + 360.0 * libm::round((last - angle) / 360.0)
}

#[test]
fn a_shifted_rotary_zero_shifts_the_words_of_its_axis_alone() {
    // Turned whatever the axes show: the first position is come to from the same point over it.
    let cl = turning_cuts_from(lean(5.0, 40.0));
    for (axis, travel) in [("C", None), ("A", Some("[-30, 120]"))] {
        let base = on("ac-trunnion").with("control.tcp", "control");
        let base = base.made(&cl);
        let mut shifted = on("ac-trunnion")
            .with("control.tcp", "control")
            .with(&format!("axis.{axis}.zero"), "90");
        if let Some(travel) = travel {
            shifted = shifted.with(&format!("axis.{axis}.travel"), travel);
        }
        let shifted = shifted.made(&cl);
        let place = base.place(axis);
        for words in base.differences(&shifted) {
            for (other, by) in words.iter().enumerate() {
                let wanted = if other == place { 90.0 } else { 0.0 };
                assert!(near(*by, wanted, 1e-9), "{axis}: {words:?}");
            }
        }
    }
}

/// With the post keeping the tip, the work offset is taken where the rotary axes read zero. C turns about the
/// part origin, so nothing else changes. A reading 0 is the drawing's -90: the part is turned by +90° about the
/// line through (y 0.012, z 50.004), which brings its origin from (0, 0) to (0.012 + 50.004, 50.004 - 0.012).
#[test]
fn the_work_offset_is_taken_where_the_rotary_axes_read_zero() {
    let cl = turning_cuts();
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    for (axis, travel, y, z) in [("C", None, 0.0, 0.0), ("A", Some("[-30, 120]"), -50.016, -49.992)]
    {
        let mut shifted =
            on("ac-trunnion").with("control.tcp", "post").with(&format!("axis.{axis}.zero"), "90");
        if let Some(travel) = travel {
            shifted = shifted.with(&format!("axis.{axis}.travel"), travel);
        }
        let shifted = shifted.made(&cl);
        // Before all axes are told, the first words still hold the old values.
        for words in base.differences(&shifted) {
            for (name, by) in base.names.iter().zip(&words) {
                let wanted = match name.as_str() {
                    "Y" => y,
                    "Z" => z,
                    name if name == axis => 90.0,
                    _ => 0.0,
                };
                assert!(near(*by, wanted, 0.0011), "{axis}: {name} {by} {wanted}");
            }
        }
    }
}

#[test]
fn travel_is_given_in_what_the_control_shows() {
    let far = cl().line("GOTO / 250, 0, 60").end();
    let place = "[0, 0, 0]";
    let vmc = || on("vmc").with("axis.X.travel", "[-300, 300]").with("workpiece.mount", place);
    vmc().made(&far);
    let said = vmc().with("axis.X.zero", "90").refused(&far);
    assert!(
        said.contains("error[over-travel]: X would be 340.000 mm, its limit is 300.000 mm"),
        "{said}"
    );
    // The drawing's travel, as the control shows it: the same program, for linear words count from the offset.
    let cl = turning_cuts();
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    let shifted = on("ac-trunnion")
        .with("control.tcp", "post")
        .with("axis.X.zero", "90")
        .with("axis.X.travel", "[-210, 390]");
    assert_eq!(shifted.made(&cl).text, base.text);
    let tilted = turning_cuts();
    let said = on("ac-trunnion").with("axis.A.zero", "90").refused(&tilted);
    assert!(said.contains("its limit is 30.000°"), "{said}");
}

#[test]
fn a_reversed_axis_has_the_opposite_words() {
    let cl = turning_cuts();
    for (axis, travel) in [("C", None), ("A", Some("[-30, 120]"))] {
        for tcp in ["control", "post"] {
            let base = on("ac-trunnion").with("control.tcp", tcp).made(&cl);
            let mut other = on("ac-trunnion")
                .with("control.tcp", tcp)
                .with(&format!("axis.{axis}.reversed"), "true");
            if let Some(travel) = travel {
                other = other.with(&format!("axis.{axis}.travel"), travel);
            }
            let other = other.made(&cl);
            assert!(base.words(axis).iter().any(|word| word.abs() > 10.0));
            assert_eq!(base.blocks.len(), other.blocks.len());
            for (a, b) in base.blocks.iter().zip(&other.blocks) {
                for (name, (a, b)) in base.names.iter().zip(a.words.iter().zip(&b.words)) {
                    let wanted = if name == axis { -*a } else { *a };
                    assert!(near(*b, wanted, 1e-9), "{tcp} {axis}: {name} {a} {b}");
                }
            }
        }
    }
    // A linear axis: its words are axis positions.
    let base = on("ac-trunnion").with("control.tcp", "post").made(&cl);
    let other =
        on("ac-trunnion").with("control.tcp", "post").with("axis.Y.reversed", "true").made(&cl);
    for (a, b) in base.words("Y").iter().zip(other.words("Y")) {
        assert!(near(*a, -b, 1e-9), "{a} {b}");
    }
}

// ---------------------------------------------------------------------------------------------------------------
// Range of a cyclic axis
// ---------------------------------------------------------------------------------------------------------------

/// Two turns and a half of a tool that leans outwards, then rapids to all sides.
fn spiral() -> String {
    let mut cl = cl().rapid(V::new(90.0, 0.0, 90.0), lean(20.0, 0.0));
    for step in 0..=90 {
        let azimuth = 10.0 * f64::from(step);
        let (sine, cosine) = libm::sincos(azimuth.to_radians());
        let tip = V::new(60.0 * cosine, 60.0 * sine, 40.0 - 0.1 * f64::from(step));
        cl = cl.cut(tip, lean(20.0, azimuth));
    }
    for azimuth in [180.0, 30.0, 209.9, 0.0, 270.0, 90.0, 359.99997, 179.99997] {
        let (sine, cosine) = libm::sincos(f64::to_radians(azimuth));
        let high = V::new(90.0 * cosine, 90.0 * sine, 90.0);
        cl = cl.rapid(high, lean(20.0, azimuth));
        let tip = V::new(60.0 * cosine, 60.0 * sine, 40.0);
        cl = cl.cut(tip, lean(20.0, azimuth));
    }
    cl.rapid(V::new(90.0, 0.0, 90.0), lean(20.0, 180.0)).end()
}

#[test]
fn words_stay_in_the_range_that_the_control_shows() {
    // A leans one way only, so that C has to turn by half a turn.
    let narrow = || on("ac-trunnion").with("axis.A.travel", "[-120, 5]");
    let cl = spiral();
    for tcp in ["control", "post"] {
        let endless = narrow().with("control.tcp", tcp).made(&cl);
        let words = endless.words("C");
        assert!(words.iter().any(|word| word.abs() > 720.0), "{words:?}");
        for (range, least) in [("[0, 360]", 0.0), ("[-180, 180]", -180.0)] {
            let made = narrow().with("control.tcp", tcp).with("axis.C.range", range).made(&cl);
            let words = made.words("C");
            for word in &words {
                assert!((least..least + 360.0).contains(word), "{range}: C{word}");
            }
            // The control takes the shorter way: it must be the way that is meant, so never nearly half a turn.
            let mut stands = words[0];
            let mut ways = vec![stands];
            for word in &words[1..] {
                let next = shorter(*word, stands);
                assert!((next - stands).abs() < 179.0, "{range}: {stands} to {word}");
                stands = next;
                ways.push(stands);
            }
            // Each point of the path is met, in order, on the turn on which the endless axis stands there.
            let turns = ways[0] - endless.words("C")[0];
            let place = made.place("C");
            let mut at = 0;
            for block in &endless.blocks {
                let met = (at..made.blocks.len()).find(|at| {
                    let mut words = made.blocks[*at].words.clone();
                    words[place] = ways[*at] - turns;
                    let pairs = words.iter().zip(&block.words);
                    pairs.fold(true, |met, (a, b)| met && near(*a, *b, 2e-3))
                });
                at = met.unwrap_or_else(|| {
                    panic!("{tcp} {range}: line {}: {:?}", block.line, block.words)
                });
            }
            // Half way along every cut the tip is still on its line, for a control that takes the shorter way.
            let poses = made.poses();
            for at in (1..made.blocks.len()).filter(|at| !made.blocks[*at].rapid) {
                let (a, b) = (&made.blocks[at - 1].words, &made.blocks[at].words);
                let mut middle: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a + b) / 2.0).collect();
                middle[place] = (ways[at - 1] + ways[at]) / 2.0;
                let tip = made.model.pose(&middle, made.length).tip;
                let wanted = (poses[at - 1].tip + poses[at].tip) / 2.0;
                let line = made.blocks[at].line;
                assert!((tip - wanted).norm() < 0.005 + ROUNDING, "line {line}: {tip} {wanted}");
            }
        }
    }
}

/// A rapid that turns C by half a turn exactly is made in two pieces: the control could take either way.
#[test]
fn half_a_turn_is_made_in_pieces() {
    let cl = cl()
        .rapid(V::new(60.0, 0.0, 90.0), lean(60.0, 0.0))
        .rapid(V::new(-60.0, 0.0, 90.0), lean(60.0, 180.0))
        .end();
    let setup = || on("ac-trunnion").with("control.tcp", "control");
    let endless = setup().made(&cl).words("C");
    let [from, to] = [endless[endless.len() - 2], endless[endless.len() - 1]];
    assert_eq!((to - from).abs(), 180.0, "{endless:?}");
    let shown = setup().with("axis.C.range", "[0, 360]").made(&cl);
    let words = shown.words("C");
    let last = words.len() - 1;
    assert_eq!(shorter(words[last], to), to, "{words:?}");
    assert!(words.len() > 2, "{words:?}");
}

/// The range is of what the control shows, so the zero comes first.
#[test]
fn the_range_holds_what_a_shifted_zero_shows() {
    let narrow = || on("ac-trunnion").with("axis.A.travel", "[-120, 5]");
    let endless = narrow().made(&spiral()).words("C");
    let shown = narrow().with("axis.C.zero", "100").with("axis.C.range", "[0, 360]");
    let words = shown.made(&spiral()).words("C");
    assert!(words.iter().all(|word| (0.0..360.0).contains(word)));
    let last = |words: &[f64]| *words.last().unwrap();
    let off = (last(&words) - last(&endless) - 100.0).rem_euclid(360.0);
    assert!(off.min(360.0 - off) < 1e-6, "{off}");
}

/// Words that wrap are meant the shorter way, which on these controls is M126.
#[test]
fn a_range_switches_the_shorter_way_on() {
    let made = on("ac-trunnion")
        .with("control.dialect", "heidenhain")
        .with("axis.C.range", "[0, 360]")
        .made(&spiral());
    assert!(made.text.contains("M126"), "{}", &made.text[..200]);
    assert!(!made.text.contains("M127"), "{}", &made.text[..200]);
}

/// A rail that stands at 5 by what the control shows, 10 more by the drawing: its word is 5, and X counts from where it shows
/// zero, so that X goes 5 back for it.
#[test]
fn the_word_of_an_axis_that_stands_is_what_the_control_shows_of_it() {
    let machine = r#"name = "rail"
chain = "[w b U X Y Z (S) t]"
[tool]
gauge = [0, 0, 300]
axis = [0, 0, 1]
[axis]
U = { linear = [1, 0, 0], travel = [-100, 100], indexed = 5, zero = -10 }
X = { linear = [1, 0, 0], travel = [-200, 200] }
Y = { linear = [0, 1, 0], travel = [-200, 200] }
Z = { linear = [0, 0, 1], travel = [-500, 0] }
[control]
dialect = "linuxcnc"
"#;
    let folder = common::with_file("rail.toml", machine);
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/500,MMPM\nGOTO/0,0,0\nGOTO/20,0,0\nFINI\n";
    std::fs::write(folder.path().join("part.cls"), cl).unwrap();
    let words = ["-m", "rail.toml", "part.cls", "-o", "-", "-q", "--tool-length", "100"];
    let done = common::post_in(folder.path(), &words);
    assert_eq!(done.code, 0, "{}", done.err);
    post_testkit::assert_contains(&done.out, &["X-5.000", "X15.000", "U5.000"]);
    let words =
        ["verify", "part.nc", "-m", "rail.toml", "--against", "part.cls", "--tool-length", "100"];
    std::fs::write(folder.path().join("part.nc"), &done.out).unwrap();
    let read = common::post_in(folder.path(), &words);
    assert_eq!(read.code, 0, "{}{}", read.out, read.err);
}
