//! The way in to a first position under a head that leans: along the tool's own line, from as high as the retract. The places
//! are worked out by hand from the fork: its A axis stands 250 mm over the gauge line, the tool is 100 mm long.

use super::*;

/// Of the tip from the A axis, mm.
const ARM: f64 = 350.0;

fn first() -> V {
    V::new(100.0, 50.0, 20.0)
}

fn fork(more: &[(&str, &str)]) -> Setup {
    let mut fork =
        on("head-head").with("control.tcp", "control").with("axis.Z.travel", "[-2000, 600]");
    for (key, value) in more {
        fork = fork.with(key, value);
    }
    fork
}

/// Where the tip comes by until it stands on its first position.
fn ways_in(setup: &Setup, axis: V) -> Vec<V> {
    let cl = cl().rapid(first(), axis).cut(first() - axis * 10.0, axis).rapid(first(), axis).end();
    let made = setup.made(&cl);
    let tips = made.poses().into_iter().map(|pose| pose.tip);
    let mut ways: Vec<V> = tips.collect();
    let arrives = ways.iter().position(|tip| (tip - first()).norm() < ROUNDING);
    ways.truncate(arrives.unwrap_or_else(|| panic!("{}", made.text)));
    ways
}

#[track_caller]
fn assert_ways(found: &[V], wanted: &[V]) {
    let near = found.len() == wanted.len()
        && (found.iter().zip(wanted)).all(|(found, wanted)| (found - wanted).norm() < 0.01);
    assert!(near, "{found:?}\n{wanted:?}");
}

/// Where X and Z stand with the tip on a place.
fn x_and_z(tip: V, axis: V) -> [f64; 2] {
    [tip.x + ARM * axis.x, tip.z - 250.0 + ARM * axis.z]
}

#[test]
fn a_leaning_tool_comes_in_along_its_own_line() {
    for azimuth in [40.0, 130.0, -75.0] {
        let axis = lean(30.0, azimuth);
        let [_, z] = x_and_z(first(), axis);
        // 50 mm below the end of Z, or as the file has it.
        for (room, more) in [
            (50.0, &[][..]),
            (120.0, &[("control.approach_room", "120")][..]),
            (0.0, &[("control.approach_room", "0")][..]),
        ] {
            let out = axis * ((600.0 - room - z) / axis.z);
            assert_ways(&ways_in(&fork(more), axis), &[first() + out]);
        }
        // The retract is lower than that.
        let low = fork(&[("control.retract.Z", "400")]);
        let out = axis * ((400.0 - z) / axis.z);
        assert_ways(&ways_in(&low, axis), &[first() + out]);
    }
}

/// X ends its travel before Z is up: from straight above to the place that it reaches, and in from there.
#[test]
fn another_axis_that_ends_its_travel_cuts_the_line_short() {
    let axis = lean(30.0, 40.0);
    let [x, z] = x_and_z(first(), axis);
    let way = (400.0 - 50.0 - x) / axis.x;
    let up = V::z() * (600.0 - 50.0 - (z + way * axis.z));
    let out = first() + axis * way;
    let narrow = fork(&[("axis.X.travel", "[-3000, 400]")]);
    assert_ways(&ways_in(&narrow, axis), &[out + up, out]);
}

/// Its line wins a tool no height that lies across Z, or hangs: it comes down 100 mm out, where it goes to when it leaves.
#[test]
fn a_tool_that_lies_or_hangs_comes_down_outside_and_in_along_its_line() {
    for tilt in [90.0, 104.0] {
        let axis = lean(tilt, 25.0);
        let out = first() + axis * 100.0;
        let [_, z] = x_and_z(out, axis);
        let up = V::z() * (550.0 - z);
        // Its retract is the builder's to answer for.
        let fork = fork(&[("control.retract.Z", "600")]);
        assert_ways(&ways_in(&fork, axis), &[out + up, out]);
    }
}

#[test]
fn the_room_over_a_first_position_is_a_length() {
    let said = fork(&[("control.approach_room", "-1")]).refused(&cl().end());
    assert!(said.contains("error[machine-frame]: approach_room is -1 mm"), "{said}");
}
