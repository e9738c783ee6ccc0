//! The map of the directions that a chain without a closed form makes: a bounded search goes from each direction that
//! was made to its neighbours.

use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::pointing::direction;
use super::probe::{EXACT, Probe, STARTS};
use crate::kinematics::orientation::angle;
use crate::kinematics::{Joints, Pose};

/// Steps of all searches for the map together, and of the one from a neighbour: from so near it takes a handful.
const MAP_STEPS: usize = 200_000;
const NEIGHBOUR: usize = 25;

/// Times that the way over the border of what is made is halved.
const HALVINGS: usize = 16;

/// Cells of the map: azimuths around, tilts from +Z to -Z.
pub(super) const AZIMUTHS: usize = 72;
pub(super) const TILTS: usize = 36;

/// Which directions were found to be made inside the travel of the rotary axes, the tip on the part origin.
pub(super) struct ReachableDirections {
    /// 1 for each that is made, 0 for the others: a row a band of tilt, in it a cell an azimuth.
    pub cells: Vec<Vec<usize>>,
    /// Tilt at each azimuth up to which all are made, and the largest that is, radians; none if not even the first.
    pub borders: Vec<[Option<f64>; 2]>,
}

/// See [`ReachableDirections`].
pub(super) fn directions(probe: &Probe<'_>) -> ReachableDirections {
    let mut flood = Flood {
        probe,
        left: MAP_STEPS,
        cells: vec![vec![None; AZIMUTHS]; TILTS],
        queue: VecDeque::new(),
    };
    let at_rest = probe.chain().forward(probe.home()).axis;
    for axis in [Vector3::z(), at_rest, Vector3::x(), -Vector3::z()] {
        for stand in probe.stands(axis) {
            flood.reach(cell_of(axis), &stand);
        }
    }
    flood.spread();
    // What lies apart from all of that.
    for number in 0..STARTS {
        let from = probe.start(number);
        flood.reach(cell_of(probe.chain().forward(&from).axis), &from);
        flood.spread();
    }
    let borders = (0..AZIMUTHS).map(|cell| flood.borders(cell)).collect();
    probe.count(0, MAP_STEPS - flood.left);
    let made = |cell: &Option<Joints>| usize::from(cell.is_some());
    let row = |row: &Vec<Option<Joints>>| row.iter().map(made).collect();
    ReachableDirections { cells: flood.cells.iter().map(row).collect(), borders }
}

struct Flood<'a> {
    probe: &'a Probe<'a>,
    left: usize,
    /// Axis values with which a cell was made.
    cells: Vec<Vec<Option<Joints>>>,
    queue: VecDeque<[usize; 2]>,
}

impl Flood<'_> {
    /// Tries to make the middle of a cell from axis values near by.
    fn reach(&mut self, [band, cell]: [usize; 2], from: &Joints) {
        if self.cells[band][cell].is_some() {
            return;
        }
        if let Some(joints) = self.make(tilt(band), cell, from) {
            self.cells[band][cell] = Some(joints);
            self.queue.push_back([band, cell]);
        }
    }

    /// The axis values next to `from` that make a direction, the rotary ones inside travel.
    fn make(&mut self, tilt: f64, cell: usize, from: &Joints) -> Option<Joints> {
        let pose = Pose {
            axis: direction(tilt, TAU * (cell as f64 + 0.5) / AZIMUTHS as f64),
            ..Pose::default()
        };
        let mut steps = NEIGHBOUR.min(self.left);
        self.left -= steps;
        let solver = self.probe.solver();
        let found = solver.search_within(&pose, from, EXACT, &mut steps);
        self.left += steps;
        self.probe.count(1, 0);
        found.ok().and_then(|joints| self.probe.inside(&joints))
    }

    /// See [`ReachableDirections::borders`].
    fn borders(&mut self, cell: usize) -> [Option<f64>; 2] {
        let made = |band: usize| self.cells[band][cell].is_some();
        let first = (0..TILTS).take_while(|band| made(*band)).last();
        let last = (0..TILTS).rev().find(|band| made(*band));
        let border = self.border(first, cell);
        if last == first {
            return [border, border];
        }
        [border, self.border(last, cell)]
    }

    /// The tilt beyond the middle of this band from which nothing is made.
    fn border(&mut self, band: Option<usize>, cell: usize) -> Option<f64> {
        let band = band?;
        let mut from = self.cells[band][cell]?;
        let mut inside = tilt(band);
        let mut outside = (tilt(band) + PI / TILTS as f64).min(PI);
        if outside == PI && self.make(PI, cell, &from).is_some() {
            return Some(PI);
        }
        for _ in 0..HALVINGS {
            let middle = (inside + outside) / 2.0;
            match self.make(middle, cell, &from) {
                Some(joints) => (inside, from) = (middle, joints),
                None => outside = middle,
            }
        }
        Some(inside)
    }

    /// Searches on from each cell that was made to its neighbours.
    fn spread(&mut self) {
        while let Some([band, cell]) = self.queue.pop_front() {
            let Some(from) = self.cells[band][cell] else {
                continue;
            };
            let around = [
                [band, (cell + 1) % AZIMUTHS],
                [band, (cell + AZIMUTHS - 1) % AZIMUTHS],
                [(band + 1).min(TILTS - 1), cell],
                [band.saturating_sub(1), cell],
            ];
            for neighbour in around {
                self.reach(neighbour, &from);
            }
        }
    }
}

/// Tilt in the middle of a band.
fn tilt(band: usize) -> f64 {
    PI * (band as f64 + 0.5) / TILTS as f64
}

fn cell_of(axis: Vector3<f64>) -> [usize; 2] {
    let band = angle(axis, Vector3::z()) / PI * TILTS as f64;
    let azimuth = libm::atan2(axis.y, axis.x);
    let turned = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
    let cell = turned / TAU * AZIMUTHS as f64;
    [(band as usize).min(TILTS - 1), (cell as usize).min(AZIMUTHS - 1)]
}
