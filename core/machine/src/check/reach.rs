//! Which directions the tool can take inside the travel of the rotary axes, seen from the part.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use serde::Serialize;

use super::pointing::direction;
use super::probe::Probe;
use crate::kinematics::orientation::angle;

/// Cells of the map: azimuths around, tilts from +Z to -Z.
const AZIMUTHS: usize = 144;
const TILTS: usize = 72;

/// Steps of a tilt that is followed from +Z to -Z, before the border is narrowed down.
const STEPS: usize = 180;

/// Points of a curve of directions.
const CURVE: usize = 361;

/// The reachable cone.
#[derive(Clone, Debug, Serialize)]
pub struct Reach {
    /// In how many independent ways the tool axis can move in a cut: 0, 1 (along a curve), 2 (over an area).
    pub freedom: usize,
    /// Share of the sphere of directions that can be made, 0 to 1.
    pub share_of_sphere: f64,
    /// For each number of solutions inside travel (place in the list), the share of the sphere that has as many.
    pub shares_by_solutions: Vec<f64>,
    /// Tilt from +Z up to which every azimuth can be made, degrees; none if not even +Z can.
    pub tilt_in_all_azimuths_deg: Option<f64>,
    /// Largest tilt from +Z that can be made in some azimuth, degrees; none if no direction can.
    pub tilt_in_some_azimuth_deg: Option<f64>,
    /// Such an azimuth, from +X towards +Y, degrees.
    pub azimuth_of_largest_tilt_deg: Option<f64>,
    /// Solutions for the tool upright in the part; an axis that may stand anywhere counts once.
    pub ways_upright: usize,
    /// For a picture.
    #[serde(skip)]
    pub map: Map,
}

/// The numbers of solutions over the sphere of directions.
#[derive(Clone, Debug, Default)]
pub struct Map {
    /// A row a band of tilt, from +Z to -Z, and in it a cell an azimuth, from +X towards +Y: solutions in its middle.
    pub cells: Vec<Vec<usize>>,
    /// Where fewer than two axes turn the tool, the directions that it can take instead: tilt and azimuth, radians.
    pub curve: Vec<[f64; 2]>,
}

impl Reach {
    pub(super) fn of(probe: &Probe<'_>) -> Self {
        let ways_upright = probe.ways(Vector3::z());
        if probe.freedom() < 2 {
            return Self::along_a_curve(probe, ways_upright);
        }
        let mut cells = Vec::with_capacity(TILTS);
        let mut shares = Vec::new();
        for band in 0..TILTS {
            let [upper, lower] = [band, band + 1].map(|edge| PI * edge as f64 / TILTS as f64);
            let area = (libm::cos(upper) - libm::cos(lower)) / 2.0 / AZIMUTHS as f64;
            let row: Vec<usize> = (0..AZIMUTHS)
                .map(|cell| {
                    let azimuth = TAU * (cell as f64 + 0.5) / AZIMUTHS as f64;
                    probe.ways(direction((upper + lower) / 2.0, azimuth))
                })
                .collect();
            for ways in &row {
                if shares.len() <= *ways {
                    shares.resize(ways + 1, 0.0);
                }
                shares[*ways] += area;
            }
            cells.push(row);
        }
        let share_of_sphere = shares.iter().skip(1).sum();
        let mut all = f64::INFINITY;
        let mut some: Option<(f64, f64)> = None;
        for cell in 0..AZIMUTHS {
            let azimuth = TAU * cell as f64 / AZIMUTHS as f64;
            let (first_gap, largest) = tilts(probe, azimuth);
            all = all.min(first_gap.unwrap_or(-1.0));
            if let Some(largest) = largest
                && some.is_none_or(|(tilt, _)| largest > tilt + 1e-6)
            {
                some = Some((largest, azimuth));
            }
        }
        Self {
            freedom: probe.freedom(),
            share_of_sphere,
            shares_by_solutions: shares,
            tilt_in_all_azimuths_deg: (all >= 0.0).then(|| all.to_degrees()),
            tilt_in_some_azimuth_deg: some.map(|(tilt, _)| tilt.to_degrees()),
            azimuth_of_largest_tilt_deg: some.map(|(_, azimuth)| azimuth.to_degrees()),
            ways_upright,
            map: Map {
                cells,
                curve: Vec::new(),
            },
        }
    }

    /// One free axis draws a circle of directions, none leaves a single one: no share of the sphere.
    fn along_a_curve(probe: &Probe<'_>, ways_upright: usize) -> Self {
        let mut curve = Vec::new();
        let steps = if probe.freedom() == 0 { 1 } else { CURVE };
        for step in 0..steps {
            let mut joints = *probe.home();
            if steps > 1 {
                for place in probe.free() {
                    let [least, most] = probe.span(place);
                    joints[place] = least + (most - least) * step as f64 / (steps - 1) as f64;
                }
            }
            let axis = probe.chain().forward(&joints).axis;
            curve.push([angle(axis, Vector3::z()), libm::atan2(axis.y, axis.x)]);
        }
        let largest = curve.iter().copied().max_by(|a, b| a[0].total_cmp(&b[0]));
        let upright = curve.iter().any(|[tilt, _]| *tilt < 1e-9) || ways_upright > 0;
        Self {
            freedom: probe.freedom(),
            share_of_sphere: 0.0,
            shares_by_solutions: vec![1.0],
            tilt_in_all_azimuths_deg: upright.then_some(0.0),
            tilt_in_some_azimuth_deg: largest.map(|[tilt, _]| tilt.to_degrees()),
            azimuth_of_largest_tilt_deg: largest
                .filter(|[tilt, _]| *tilt > 1e-6)
                .map(|[_, azimuth]| azimuth.to_degrees()),
            ways_upright,
            map: Map {
                cells: Vec::new(),
                curve,
            },
        }
    }
}

/// Along one azimuth: the tilt up to which all can be made (none if not even +Z), and the largest of all.
fn tilts(probe: &Probe<'_>, azimuth: f64) -> (Option<f64>, Option<f64>) {
    let made = |tilt: f64| probe.ways(direction(tilt, azimuth)) > 0;
    let at = |step: usize| PI * step as f64 / STEPS as f64;
    let states: Vec<bool> = (0..=STEPS).map(|step| made(at(step))).collect();
    // The border between two tilts of which the first can be made and the second cannot.
    let border = |step: usize| {
        let (mut inside, mut outside) = (at(step), at(step + 1));
        for _ in 0..40 {
            let middle = (inside + outside) / 2.0;
            if made(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    let end_of = |step: usize| if step == STEPS { PI } else { border(step) };
    let first_gap = states[0].then(|| {
        let run = states.iter().take_while(|state| **state).count();
        end_of(run - 1)
    });
    let largest = states.iter().rposition(|state| *state).map(end_of);
    (first_gap, largest)
}
