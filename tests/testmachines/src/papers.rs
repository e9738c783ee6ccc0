//! What the papers print.

use std::fs;

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use post_testkit::shared;

/// Table 3.2 of Li 2024 (nonlinear error of a dual rotary table AC machine): 20 points of a blade, from the
/// paper's text.
pub fn blade() -> Option<Vec<Pose>> {
    let path = shared("papers/000_d91ffc0ea4534a10.txt")?;
    let text = fs::read_to_string(path).expect("a readable file");
    let points = text
        .lines()
        .skip_while(|line| !line.starts_with("Table 3.2"))
        .map(|line| {
            line.split_whitespace().filter_map(|field| field.parse().ok()).collect::<Vec<f64>>()
        })
        .filter(|numbers| numbers.len() == 7)
        .take(20)
        .map(|numbers| Pose {
            tip: Vector3::new(numbers[1], numbers[2], numbers[3]),
            axis: Vector3::new(numbers[4], numbers[5], numbers[6]).normalize(),
            ..Pose::default()
        })
        .collect::<Vec<_>>();
    assert_eq!(points.len(), 20);
    Some(points)
}
