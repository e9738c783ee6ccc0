//! Which directions the tool can take inside the travel of the rotary axes, seen from the part.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use serde::Serialize;

use super::pointing::direction;
use super::probe::Probe;
use super::{search, settings};
use crate::kinematics::orientation::angle;

/// Cells of the map: azimuths around, tilts from +Z to -Z.
const AZIMUTHS: usize = 144;
const TILTS: usize = 72;

/// Steps of a tilt that is followed from +Z to -Z, before the border is narrowed down.
const STEPS: usize = 180;

/// Points of a curve of directions.
const CURVE: usize = 361;

/// The reachable cone.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ReachableCone {
    /// Number of independent ways in which the tool axis can move in a cut: 0, 1 (along a curve), 2 (over an area).
    pub freedom: usize,
    /// Share of the sphere of directions that can be made, 0 to 1.
    pub share_of_sphere: f64,
    /// The chain has no closed form: each direction was searched with the tip on the part origin, on a grid of so many
    /// degrees; what was not found counts as not made.
    pub searched_every_deg: Option<f64>,
    /// Rotary axes place the tip too, and there are too few of them for the tool axis to go over an area while the tip
    /// stays: which directions can be made depends on the point.
    pub tied_to_the_tip: bool,
    /// Axes that stand at positions alone: of the directions only those are made that one of them gives.
    pub at_positions_alone: Vec<String>,
    /// Single directions that an axis at its positions gives, if it alone turns the tool.
    pub single_directions: Option<usize>,
    /// For each number of solutions inside travel (place in the list), the share of the sphere that has as many. Where
    /// the chain was searched, one counts for all.
    pub shares_by_solutions: Vec<f64>,
    /// Tilt from +Z up to which every azimuth can be made, degrees; none if not even +Z can.
    pub tilt_in_all_azimuths_deg: Option<f64>,
    /// Largest tilt from +Z that can be made in some azimuth, degrees; none if no direction can.
    pub tilt_in_some_azimuth_deg: Option<f64>,
    /// Azimuth of the largest tilt, from +X towards +Y, degrees.
    pub azimuth_of_largest_tilt_deg: Option<f64>,
    /// Solutions for the tool upright in the part, within `axis_tolerance` and at the positions of index axes, as posting
    /// takes them; an axis that may stand anywhere counts once, and so does one on every full turn.
    pub ways_upright: usize,
    /// Limits between rotary axes that are kept, as they are written. Those that name linear axes too depend on where the tip
    /// is: [`super::LimitReport`].
    pub within: Vec<String>,
    /// Cells of the sphere for a picture.
    #[serde(skip)]
    pub map: DirectionMap,
}

/// The numbers of solutions over the sphere of directions.
#[derive(Clone, Debug, Default)]
pub struct DirectionMap {
    /// A row a band of tilt, from +Z to -Z, and in it a cell an azimuth, from +X towards +Y: solutions in its middle.
    pub cells: Vec<Vec<usize>>,
    /// Where fewer than two axes turn the tool, the directions that it can take instead: tilt and azimuth, radians.
    pub curve: Vec<[f64; 2]>,
}

impl ReachableCone {
    pub(super) fn of(probe: &Probe<'_>) -> Self {
        let mut reach = if probe.freedom() < 2 {
            Self::along_a_curve(probe)
        } else if probe.closed_form() {
            Self::over_the_sphere(probe)
        } else if probe.ways_by_search().is_some_and(|[_, ways]| ways < 2) {
            Self { freedom: probe.freedom(), tied_to_the_tip: true, ..Self::default() }
        } else {
            Self::by_search(probe)
        };
        reach.ways_upright = probe.stands(Vector3::z()).len();
        if reach.freedom < 2 && reach.ways_upright > 0 {
            reach.tilt_in_all_azimuths_deg = Some(0.0);
        }
        reach.within = probe.rotary_limits().map(|limit| limit.text().to_owned()).collect();
        let name = |place: usize| probe.machine().axes[place].name.clone();
        reach.at_positions_alone = probe.at_positions_alone().into_iter().map(name).collect();
        reach
    }

    fn over_the_sphere(probe: &Probe<'_>) -> Self {
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
        let borders = (0..AZIMUTHS).map(|cell| {
            let azimuth = TAU * cell as f64 / AZIMUTHS as f64;
            (azimuth, tilts(probe, azimuth))
        });
        Self::over_an_area(probe, cells, shares, borders)
    }

    /// `borders` has for azimuths the tilt up to which all can be made (none if not even +Z), and the largest of all.
    fn over_an_area(
        probe: &Probe<'_>,
        cells: Vec<Vec<usize>>,
        shares: Vec<f64>,
        borders: impl Iterator<Item = (f64, [Option<f64>; 2])>,
    ) -> Self {
        let mut all = Some(PI);
        let mut some: Option<(f64, f64)> = None;
        for (azimuth, [first_gap, largest]) in borders {
            all = all.and_then(|all| Some(all.min(first_gap?)));
            if let Some(largest) = largest
                && some.is_none_or(|(tilt, _)| largest > tilt + 1e-6)
            {
                some = Some((largest, azimuth));
            }
        }
        Self {
            freedom: probe.freedom(),
            share_of_sphere: shares.iter().skip(1).sum(),
            shares_by_solutions: shares,
            tilt_in_all_azimuths_deg: all.map(f64::to_degrees),
            tilt_in_some_azimuth_deg: some.map(|(tilt, _)| tilt.to_degrees()),
            azimuth_of_largest_tilt_deg: some.map(|(_, azimuth)| azimuth.to_degrees()),
            map: DirectionMap { cells, curve: Vec::new() },
            ..Self::default()
        }
    }

    /// Finds the reach of a chain without a closed form by a search over a coarse map.
    fn by_search(probe: &Probe<'_>) -> Self {
        let search::ReachableDirections { cells, borders } = search::directions(probe);
        let band = |edge: usize| PI * edge as f64 / search::TILTS as f64;
        let mut share = 0.0;
        for (row, cells) in cells.iter().enumerate() {
            let area = (libm::cos(band(row)) - libm::cos(band(row + 1))) / 2.0;
            share += area * cells.iter().sum::<usize>() as f64 / search::AZIMUTHS as f64;
        }
        let azimuth = |cell: usize| TAU * (cell as f64 + 0.5) / search::AZIMUTHS as f64;
        let borders = borders.into_iter().enumerate();
        let borders = borders.map(|(cell, border)| (azimuth(cell), border));
        Self {
            searched_every_deg: Some(band(1).to_degrees()),
            ..Self::over_an_area(probe, cells, vec![1.0 - share, share], borders)
        }
    }

    /// One free axis draws a circle of directions, or gives one at each of its positions; none leaves a single one: no
    /// share of the sphere.
    fn along_a_curve(probe: &Probe<'_>) -> Self {
        let free = probe.free();
        let positions = match (free.as_slice(), probe.freedom()) {
            ([place], 1) => settings::positions(probe.machine(), *place),
            _ => Vec::new(),
        };
        let steps = if probe.freedom() == 0 { 1 } else { CURVE };
        let axis_at = |value: &dyn Fn(usize) -> f64| {
            let mut joints = *probe.home();
            for place in &free {
                joints[*place] = value(*place);
            }
            let axis = probe.chain().forward(&joints).axis;
            [angle(axis, Vector3::z()), libm::atan2(axis.y, axis.x)]
        };
        let curve: Vec<[f64; 2]> = if !positions.is_empty() {
            let each = positions.iter();
            each.map(|position| axis_at(&|_| *position)).collect()
        } else if steps == 1 {
            vec![axis_at(&|place| probe.home()[place])]
        } else {
            let share = |step: usize| step as f64 / (steps - 1) as f64;
            let value = |place: usize, share: f64| {
                let [least, most] = probe.span(place);
                least + (most - least) * share
            };
            (0..steps).map(|step| axis_at(&|place| value(place, share(step)))).collect()
        };
        let largest = curve.iter().copied().max_by(|a, b| a[0].total_cmp(&b[0]));
        let upright = curve.iter().any(|[tilt, _]| *tilt < 1e-9);
        Self {
            freedom: probe.freedom(),
            single_directions: (!positions.is_empty()).then_some(positions.len()),
            shares_by_solutions: vec![1.0],
            tilt_in_all_azimuths_deg: upright.then_some(0.0),
            tilt_in_some_azimuth_deg: largest.map(|[tilt, _]| tilt.to_degrees()),
            azimuth_of_largest_tilt_deg: largest
                .filter(|[tilt, _]| *tilt > 1e-6)
                .map(|[_, azimuth]| azimuth.to_degrees()),
            map: DirectionMap { cells: Vec::new(), curve },
            ..Self::default()
        }
    }
}

/// Tilt along one azimuth up to which all can be made (none if not even +Z), and the largest of all.
fn tilts(probe: &Probe<'_>, azimuth: f64) -> [Option<f64>; 2] {
    let made = |tilt: f64| probe.makes(direction(tilt, azimuth));
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
    [first_gap, largest]
}
