//! Where the axes start, and the choice between solutions.

use super::*;

// ---------------------------------------------------------------------------------------------------------------
// The choice
// ---------------------------------------------------------------------------------------------------------------

#[test]
fn axes_start_where_the_file_says() {
    let upright =
        cl().rapid(V::new(0.0, 0.0, 60.0), V::z()).cut(V::new(5.0, 0.0, 30.0), V::z()).end();
    for (start, wanted) in [(None, 0.0), (Some("170"), 170.0), (Some("-400"), -400.0)] {
        let mut setup = on("ac-trunnion").with("control.tcp", "control");
        if let Some(start) = start {
            setup = setup.with("solution.start.C", start);
        }
        let words = setup.made(&upright).words("C");
        assert!(words.iter().all(|word| *word == wanted), "{words:?}");
    }
    // The nearest solution is that next to the start: 20° towards -Y are A -20 C 0 or A 20 C 180.
    let tilted = cl().rapid(V::new(0.0, 0.0, 60.0), lean(20.0, 90.0)).end();
    let chosen = |c: &str| {
        let setup = on("ac-trunnion").with("control.tcp", "control").with("solution.start.C", c);
        let made = setup.made(&tilted);
        (made.words("A")[0], made.words("C")[0])
    };
    let (near_zero, near_half) = (chosen("10"), chosen("170"));
    assert_eq!(near_zero.1, 0.0);
    assert_eq!(near_half.1, 180.0);
    assert_eq!(near_zero.0, -near_half.0);
    assert_eq!(near_zero.0.abs(), 20.0);
    let said = on("ac-trunnion").with("solution.start.A", "31").refused(&tilted);
    assert!(said.contains("error[machine-travel]: A cannot start there"), "{said}");
}

#[test]
fn a_side_is_preferred_or_required() {
    let mut text = cl();
    for (azimuth, tilt) in [(10.0, 20.0), (100.0, 25.0), (190.0, 60.0), (280.0, 15.0)] {
        let out = lean(tilt, azimuth);
        text = text.rapid(out * 120.0, out).cut(out * 70.0, out).rapid(out * 120.0, out);
    }
    let text = text.end();
    let signs = |setup: Setup| {
        let made = setup.with("control.tcp", "control").made(&text);
        (made.words("A"), made.poses())
    };
    let (negative, _) = signs(on("ac-trunnion").with("solution.prefer.A", "negative"));
    assert!(negative.iter().all(|word| *word <= 0.0), "{negative:?}");
    // 60° are beyond the travel on the other side: preferred is not required.
    let (positive, poses) = signs(on("ac-trunnion").with("solution.prefer.A", "positive"));
    for (word, pose) in positive.iter().zip(&poses) {
        let tilt = angle(pose.axis, V::z());
        assert_eq!(*word < 0.0, tilt > 31.0, "{tilt}: A{word}");
    }
    let (required, _) = signs(on("ac-trunnion").with("solution.require.A", "negative"));
    assert!(required.iter().all(|word| *word <= 0.0), "{required:?}");
    let said = on("ac-trunnion").with("solution.require.A", "positive").refused(&text);
    assert!(said.contains("error["), "{said}");
    assert!(said.contains("A would be"), "{said}");
}

/// The value lies inside the travel: it is the side that forbids it.
#[test]
fn a_required_side_that_forbids_a_cut_is_named() {
    let tip = V::new(10.0, 7.0, 20.0);
    let text = cl().rapid(tip, V::z()).cut(tip, lean(60.0, -90.0)).end();
    let said = on("ac-trunnion").with("solution.require.A", "positive").refused(&text);
    assert!(said.contains("require"), "{said}");
}

#[test]
fn no_look_ahead_is_refused() {
    let said = on("ac-trunnion").with("solution.look_ahead", "0").refused(&turning_cuts());
    assert!(said.contains("error[machine-solution]: look_ahead is a number of points"), "{said}");
    // One takes the nearest each time.
    on("ac-trunnion").with("solution.look_ahead", "1").made(&turning_cuts());
}

/// The table of solutions in the manual of the iTNC 530 (PLANE SPATIAL, SEQ): the spatial angle B+45 on a machine whose
/// table turns about A and carries C, from A0 C0. SEQ+ and SEQ- ask for a side of A.
#[test]
fn the_choice_is_that_of_the_itnc_530_for_a_plane_at_b_45() {
    let tilted = cl().rapid(V::new(0.0, 0.0, 60.0), lean(45.0, 0.0)).end();
    for (travel, side, wanted) in [
        ("[-120, 120]", None, Some([45.0, 90.0])),
        ("[-120, 120]", Some("positive"), Some([45.0, 90.0])),
        ("[-120, 120]", Some("negative"), Some([-45.0, -90.0])),
        ("[-90, 10]", None, Some([-45.0, -90.0])),
        ("[-90, 10]", Some("positive"), None),
    ] {
        let mut setup =
            on("ac-trunnion").with("control.tcp", "control").with("axis.A.travel", travel);
        if let Some(side) = side {
            setup = setup.with("solution.require.A", &format!("\"{side}\""));
        }
        let Some(wanted) = wanted else {
            let said = setup.refused(&tilted);
            assert!(said.contains('A'), "{said}");
            continue;
        };
        let made = setup.made(&tilted);
        let found = ["A", "C"].map(|name| made.words(name)[0]);
        assert_eq!(found, wanted, "{travel} {side:?}");
    }
}
