//! The tool axis: it turns about the tip, and it leans.

use nalgebra::Rotation3;

use super::{Point, joints, machine, run_axes};

/// The tool turns about its tip: it lags, and its axis is on its way all the same.
#[test]
fn a_tool_that_turns_about_its_tip_has_no_contour_error() {
    let turn = |n: i32| 0.001 * f64::from(n.clamp(0, 1000));
    let place = |n: i32| Point::new(0.05 * f64::from(n.min(0) + (n - 1000).max(0)), 0.0, 0.0);
    let way: Vec<_> = (-200..1300)
        .map(|n| {
            let late = n - 40;
            // Rounding of a control: the tip does not quite stand.
            let shake = Point::new(0.0, 1e-7 * libm::sin(f64::from(n)), 0.0);
            [joints(place(n) + shake, turn(n)), joints(place(late), turn(late))]
        })
        .collect();
    let (told, report) = run_axes(0.001, machine(&Rotation3::identity(), true), &way);
    for point in &told[50..1450] {
        assert!(point.distance < 2e-6, "{}: {}", point.time, point.distance);
        assert!(point.axis < 2e-5, "{}: {}", point.time, point.axis);
    }
    assert!(report.axes[3].following.value > 0.039);
    assert!((report.axes[3].velocity.value - 1.0).abs() < 1e-9);
}

/// A tool axis that leans off the one that is commanded, in closed form.
#[test]
fn the_tool_axis_is_held_against_the_nearest_point() {
    let way: Vec<_> = (0..500)
        .map(|n| {
            let time = 0.01 * f64::from(n);
            let late = time - 0.05;
            let lean = |time: f64| 0.4 * libm::sin(time);
            [
                joints(Point::new(10.0 * time, 0.0, 0.0), lean(time)),
                joints(Point::new(10.0 * late, 0.0, 0.0), lean(late) + 0.003),
            ]
        })
        .collect();
    let (told, _) = run_axes(0.001, machine(&Rotation3::identity(), true), &way);
    for point in &told[20..480] {
        assert!(point.distance < 1e-9);
        assert!((point.axis - 0.003).abs() < 1e-8, "{}", point.axis);
    }
}
