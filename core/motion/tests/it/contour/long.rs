//! Very many set-points.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Rotation3;
use post_motion::contour::{Contour, ContourPoint};
use post_motion::{ProgramPlace, SetPoints};

use super::{Point, joints, machine};

/// Ten million set-points on one circle, the tool late and off it: every turn is like the second one.
#[test]
fn a_circle_many_times_is_off_by_the_same() {
    const TURN: usize = 1000;
    const TURNS: usize = 10_000;
    let solver = machine(&Rotation3::identity(), false);
    let at = |place: usize, late: f64, radius: f64| {
        let angle = TAU * (place as f64 - late) / TURN as f64;
        let tip = Point::new(libm::cos(angle), libm::sin(angle), 0.0) * radius;
        joints(tip, 0.0)
    };
    let commanded: Vec<_> = (0..TURN).map(|place| at(place, 0.0, 16.0)).collect();
    let actual: Vec<_> = (0..TURN).map(|place| at(place, 7.3, 16.0 - 0.003)).collect();
    let mut points = SetPoints::new(Arc::clone(&solver), 1e-3);
    let mut contour = Contour::new();
    let (mut told, mut turn, mut apart) = (0_usize, Vec::new(), 0.0_f64);
    let mut listen = |point: &ContourPoint| {
        // The beginning and the end of the path are other places than those on it.
        match told {
            _ if !(TURN..=TURN * TURNS - 100).contains(&told) => {}
            _ if told < 2 * TURN => turn.push(point.distance),
            _ => apart = apart.max((point.distance - turn[told % TURN]).abs()),
        }
        told += 1;
    };
    for _ in 0..TURNS {
        points.joints.clone_from(&commanded);
        points.poses.clear();
        let poses = commanded.iter().map(|joints| solver.chain().forward(joints));
        points.poses.extend(poses);
        points.at = vec![ProgramPlace { task: 0, line: 1, cuts: true }; TURN];
        contour.take(&points, &actual, &mut listen);
        points.clear();
    }
    let report = contour.finish(&mut listen);
    assert_eq!(told, TURN * TURNS);
    assert!(turn.iter().all(|distance| (distance - 0.003).abs() < 1e-7));
    assert!(apart < 1e-9, "{apart}");
    let half = report.cuts.percentile(0.5) / 0.003;
    assert!((1.0 - 1e-4..1.0 + 1.0 / 16.0 + 1e-4).contains(&half), "{half}");
    // Chords of so many set-points, by differences: v = 2·r·sin(π/N)/T at most.
    let speed = 2.0 * 16.0 * libm::sin(TAU / 2.0 / TURN as f64) / 1e-3;
    assert!((report.axes[0].velocity.value / speed - 1.0).abs() < 1e-5);
}
