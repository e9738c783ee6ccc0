//! Volumes that have a closed form lie between both bounds, and finer grids bring these together.

use std::f64::consts::PI;

use nalgebra::Vector3;
use post_removal::chip::{Engagement, Extent};
use post_removal::field::{Cutter, Field};
use post_removal::profile::ToolPose;

use crate::upright;

/// A quarter of a circle from the axis to the side, points [z, r] inside of it.
fn rounding(from: f64, radius: f64) -> Vec<[f64; 2]> {
    let steps = 400;
    let point = |step: i32| {
        let angle = 0.5 * PI * f64::from(step) / f64::from(steps);
        [radius * (1.0 - libm::cos(angle)), from + radius * libm::sin(angle)]
    };
    (0..=steps).map(point).collect()
}

/// Holds what a cutter takes along ways against the volume that it takes.
fn judge(profile: &[[f64; 2]], ways: &[[ToolPose; 2]], truth: f64) {
    let size = Vector3::new(40.0, 30.0, 20.0);
    let cutter = Cutter::new(profile);
    let mut last = f64::INFINITY;
    for resolution in [1.6, 0.8, 0.4, 0.2] {
        let mut field = Field::block(size, resolution);
        let whole = size.product();
        for [from, to] in ways {
            field.remove_straight(&cutter, [*from, *to]);
            let way = to.tip - from.tip;
            let steps = (way.norm() / (2.0 * resolution)).ceil().max(1.0);
            for step in 0..steps as u32 {
                let share = (f64::from(step) + 0.5) / steps;
                let pose = ToolPose { tip: from.tip + way * share, ..*from };
                field.doubt(&cutter, &pose, 0.5 * way.norm() / steps);
            }
        }
        let volume = field.volume();
        let [least, most] = [whole - volume.at_most, whole - volume.at_least];
        assert!(least <= truth + 1e-2 && truth <= most + 1e-2, "{least} {truth} {most}");
        assert!(most - least < 0.75 * last, "{} after {last} at {resolution}", most - least);
        last = most - least;
    }
    assert!(last < 0.3 * truth, "{last} of {truth}");
}

#[test]
fn a_slot_is_a_box_and_two_half_cylinders() {
    let profile = [[0.0, 4.0], [30.0, 4.0]];
    let floor = 12.0;
    let ways = [[upright(10.0, 15.0, floor), upright(28.0, 15.0, floor)]];
    judge(&profile, &ways, (18.0 * 8.0 + PI * 16.0) * 8.0);
    // The same with the slot across the directions of the grid.
    let ways = [[upright(10.0, 8.0, floor), upright(28.0, 20.0, floor)]];
    judge(&profile, &ways, (468.0f64.sqrt() * 8.0 + PI * 16.0) * 8.0);
}

#[test]
fn a_ball_leaves_a_dimple_and_a_round_groove() {
    let mut profile = rounding(0.0, 6.0);
    profile.push([40.0, 6.0]);
    let ways = [[upright(20.0, 15.0, 30.0), upright(20.0, 15.0, 16.0)]];
    judge(&profile, &ways, PI * 16.0 * (6.0 - 4.0 / 3.0));
    let ways = [[upright(10.0, 15.0, 14.0), upright(30.0, 15.0, 14.0)]];
    judge(&profile, &ways, 20.0 * 0.5 * PI * 36.0 + 2.0 / 3.0 * PI * 216.0);
}

#[test]
fn a_drill_leaves_its_cone() {
    let profile = [[0.0, 0.0], [3.0, 5.0], [40.0, 5.0]];
    let ways = [[upright(20.0, 15.0, 22.0), upright(20.0, 15.0, 6.0)]];
    judge(&profile, &ways, PI * 25.0 * (1.0 + 11.0));
}

/// A bull nose that is swept sideways: the section is that of the profile.
#[test]
fn a_swept_bull_nose_leaves_its_section() {
    let mut profile = rounding(4.0, 3.0);
    profile.push([40.0, 7.0]);
    let ways = [[upright(-20.0, 15.0, 10.0), upright(60.0, 15.0, 10.0)]];
    judge(&profile, &ways, 40.0 * (14.0 * 10.0 - 2.0 * (9.0 - 0.25 * PI * 9.0)));
    // A ramp of a flat end: a parallelogram along the whole block, and nothing of the round ends.
    let flat = [[0.0, 5.0], [40.0, 5.0]];
    let ways = [[upright(-20.0, 15.0, 8.0), upright(60.0, 15.0, 16.0)]];
    // It goes up: a place is cut lowest when the rim ahead comes.
    let rim = |y: f64| 0.1 * (25.0 - y * y).sqrt();
    let steps = 20_000;
    let area: f64 = (0..steps)
        .map(|step| {
            let y = -5.0 + 10.0 * (f64::from(step) + 0.5) / f64::from(steps);
            (20.0 - (10.0 + 0.1 * 20.0) + rim(y)) * 10.0 / f64::from(steps)
        })
        .sum();
    judge(&flat, &ways, 40.0 * area);
}

/// What is across the axes of the stock is exact, however coarse the grid.
#[test]
fn faces_across_the_axes_are_exact() {
    let mut field = Field::block(Vector3::new(40.0, 30.0, 20.0), 1.0);
    let cutter = Cutter::new(&[[0.0, 4.0], [30.0, 4.0]]);
    let floor = 20.0 - 3.37;
    field.remove_straight(&cutter, [upright(-10.0, 15.21, floor), upright(50.0, 15.21, floor)]);
    for (point, left) in [
        ([20.0, 15.21, floor + 1e-3], false),
        ([20.0, 15.21, floor - 1e-3], true),
        ([20.0, 19.209, 19.0], false),
        ([20.0, 19.211, 19.0], true),
        ([20.0, 11.211, 19.0], false),
        ([20.0, 11.209, 19.0], true),
    ] {
        assert_eq!(field.may_hold(Vector3::from(point)), left, "{point:?}");
    }
    // And so is the distance from them.
    let body = |y: f64, z: f64| {
        let point = Vector3::new(20.0, y, z);
        [post_clearance::convex::Convex::ball(point, 0.5)]
    };
    let apart = field.apart(&body(15.21, floor + 1.5));
    assert!((apart.at_least - 1.0).abs() < 0.02 && apart.at_most >= 1.0 - 1e-4, "{apart:?}");
    let apart = field.apart(&body(17.5, floor + 2.9));
    assert!((apart.at_least - 1.21).abs() < 0.03, "{apart:?}");
    assert_eq!(field.apart(&body(19.0, floor + 1.0)).at_least, 0.0);
}

/// How far a cut goes into what is left: the true depth and width lie between both bounds.
#[test]
fn a_cut_engages_by_its_width_and_its_depth() {
    let cell = 0.4;
    for turn in [0.0, 0.3, 1.2] {
        for [wide, deep] in [[8.0, 3.0], [1.5, 6.0], [4.0, 0.7]] {
            let mut field = Field::block(Vector3::new(40.0, 40.0, 20.0), cell);
            let cutter = Cutter::new(&[[0.0, 4.0], [30.0, 4.0]]);
            let (sine, cosine) = libm::sincos(turn);
            let along = Vector3::new(cosine, sine, 0.0);
            let aside = Vector3::new(-sine, cosine, 0.0);
            let line = |off: f64, floor: f64| {
                let middle = Vector3::new(20.0, 20.0, floor) + aside * off;
                [-12.0, 12.0].map(|share| {
                    let [x, y, z] = (middle + along * share).into();
                    upright(x, y, z)
                })
            };
            // What is beside is cut before.
            if wide < 8.0 {
                field.cut_straight(&cutter, line(-wide, 20.0 - deep), 0.0);
            }
            let before = field.volume();
            let chip = field.cut_straight(&cutter, line(0.0, 20.0 - deep), 0.0);
            let after = field.volume();
            let Engagement { depth, width } = chip.engagement.unwrap();
            let (width, more) = (width.unwrap(), 5.0 * cell);
            let told = format!("{turn} {wide} {deep} {chip:?}");
            assert!(depth.at_least <= deep && depth.at_most >= deep - 1e-4, "{told}");
            assert!(depth.at_most - depth.at_least < more, "{told}");
            // The round end of the cut before leaves some beside it.
            assert!(width.at_least <= 8.0 && width.at_most >= wide - 1e-4, "{told}");
            assert!(width.at_least > wide - more && width.at_most <= 8.0, "{told}");
            // Each place that may be taken is counted once, what is not taken for certain among it.
            let [least, most] = [before.at_most - after.at_most, before.at_most - after.at_least];
            assert!(chip.volume.at_most >= least && chip.volume.at_most < most + 1.0, "{told}");
            let again = field.cut_straight(&cutter, line(0.0, 20.0 - deep), 0.0);
            assert_eq!(again.volume.at_least, 0.0);
            let nothing = |extent: Extent| extent.at_least == 0.0;
            let Engagement { depth, width } = again.engagement.unwrap_or_default();
            assert!(nothing(depth) && width.is_none_or(nothing), "{again:?}");
        }
    }
}
