//! What is left of a stock, held against closed forms and brute force.
#![allow(clippy::unwrap_used, reason = "tests")]

mod closed_forms;
mod random_moves;
mod solids;
mod ways;

use nalgebra::Vector3;
use post_removal::profile::ToolPose;

/// A tool that stands upright.
fn upright(x: f64, y: f64, z: f64) -> ToolPose {
    ToolPose { tip: Vector3::new(x, y, z), axis: Vector3::z() }
}

/// How deep a point is inside of a profile of revolution, mm: below zero outside, no farther than that from it where its
/// slopes are less than one.
fn depth(profile: &[[f64; 2]], pose: &ToolPose, point: Vector3<f64>) -> f64 {
    let arm = point - pose.tip;
    let z = arm.dot(&pose.axis);
    let r = (arm - pose.axis * z).norm();
    let parts = profile.windows(2).filter(|pair| pair[0][0] < pair[1][0]).map(|pair| {
        let share = (z - pair[0][0]) / (pair[1][0] - pair[0][0]);
        let radius = pair[0][1] + (pair[1][1] - pair[0][1]) * share.clamp(0.0, 1.0);
        let ends = (z - pair[0][0]).min(pair[1][0] - z);
        // Beside a side the nearest point of it is nearer than what is level with it.
        let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        ((radius - r) / libm::hypot(slope, 1.0)).min(ends)
    });
    parts.fold(f64::NEG_INFINITY, f64::max)
}
