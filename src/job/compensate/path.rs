//! The points of a program's path, by how much each is moved, and how far the tool is off beside it.
//!
//! A point takes 120 bytes while this goes on: a file of a million points 120 MB.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;
use post_motion::At;
use post_motion::contour::{Leg, Reference};
use post_motion::path::Way;
use post_posting::{PathPoint, PathShift};

/// Over so much of the path, mm, a move fades towards the ends of a cut, where the tool comes to the part and leaves it.
const FADE: f64 = 1.0;

/// Records the points of a path, and moves none.
#[derive(Default)]
pub struct Recorded {
    points: Vec<PathPoint>,
}

impl PathShift for Recorded {
    fn next(&mut self, point: &PathPoint) -> Vector3<f64> {
        self.points.push(*point);
        Vector3::zeros()
    }
}

/// By how much each point of a path is moved, mm.
pub type Moves = Vec<[f32; 3]>;

/// Moves the points of a path.
pub struct Moved<'m> {
    moves: std::slice::Iter<'m, [f32; 3]>,
}

impl<'m> Moved<'m> {
    pub fn new(moves: &'m Moves) -> Self {
        Self {
            moves: moves.iter(),
        }
    }
}

impl PathShift for Moved<'_> {
    fn next(&mut self, _: &PathPoint) -> Vector3<f64> {
        let by = self.moves.next().copied().unwrap_or_default();
        Vector3::from(by.map(f64::from))
    }
}

/// How far the tool is off beside the points of a path: sums of vectors, mm, and of the weights that they count with.
#[derive(Clone)]
pub struct Errors {
    sums: Vec<([f32; 3], f32)>,
}

impl Errors {
    pub fn of(path: &Recorded) -> Self {
        Self {
            sums: vec![Default::default(); path.points.len()],
        }
    }

    /// Beside the leg to the point `number` the tool is off by `error` where it should stand at `asked`.
    pub fn take(
        &mut self,
        path: &Recorded,
        number: u64,
        asked: &Vector3<f64>,
        error: &Vector3<f64>,
    ) {
        let number = number as usize;
        let (Some(to), Some(from)) = (
            path.points.get(number),
            number.checked_sub(1).and_then(|last| path.points.get(last)),
        ) else {
            return;
        };
        let length = (to.tip - from.tip).norm();
        let share = match length > 0.0 {
            true => ((asked - from.tip).norm() / length).min(1.0),
            false => 1.0,
        };
        for (place, weight) in [(number - 1, 1.0 - share), (number, share)] {
            let (sum, weights) = &mut self.sums[place];
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum += (error[axis] * weight) as f32;
            }
            *weights += weight as f32;
        }
    }

    /// The mean at a point, if the tool has been there.
    fn at(&self, place: usize) -> Option<[f32; 3]> {
        let (sum, weight) = self.sums[place];
        (weight > 0.05).then(|| sum.map(|sum| sum / weight))
    }
}

impl Recorded {
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// What has been recorded as the path that a tool is held against; the number of a leg is that of the point at its
    /// end.
    pub fn legs(&self, along: f64) -> Legs<'_> {
        Legs {
            path: self,
            next: 1,
            along,
        }
    }

    /// Moves points further by minus `gain` of the errors beside them, none by more than `bound` mm in all.
    pub fn step(&self, moves: &mut Moves, errors: &Errors, gain: f64, bound: f64) {
        let mut start = 0;
        while start < self.points.len() {
            let end = self.end_of_cut(start);
            self.step_cut(moves, errors, start..end, gain, bound);
            start = end.max(start + 1);
        }
    }

    /// The point behind those of the cut that a point may belong to.
    fn end_of_cut(&self, start: usize) -> usize {
        let rest = &self.points[start..];
        let count = rest
            .iter()
            .enumerate()
            .take_while(|(place, point)| point.moves && (*place == 0 || !point.begins))
            .count();
        start + count
    }

    /// Moves the points of a cut; it begins at the point before its first, which stands.
    fn step_cut(
        &self,
        moves: &mut Moves,
        errors: &Errors,
        cut: std::ops::Range<usize>,
        gain: f64,
        bound: f64,
    ) {
        let mut ways = Vec::with_capacity(cut.len());
        let mut way = 0.0;
        for place in cut.clone() {
            let last = place.checked_sub(1).filter(|_| !self.points[place].begins);
            way += last.map_or(0.0, |last| {
                (self.points[place].tip - self.points[last].tip).norm()
            });
            ways.push(way);
        }
        let errors = filled(&cut, errors);
        for (place, (error, along)) in cut.zip(errors.iter().zip(&ways)) {
            let inside = (along.min(way - along) / FADE).clamp(0.0, 1.0);
            let fade = inside * inside * (3.0 - 2.0 * inside);
            let last = Vector3::from(moves[place].map(f64::from));
            let next = last - error * gain;
            let length = next.norm();
            let most = bound * fade * (1.0 - 1e-6);
            let next = match length > most {
                true => next * (most / length),
                false => next,
            };
            moves[place] = [next.x as f32, next.y as f32, next.z as f32];
        }
    }
}

/// The errors at the points of a cut: where the tool passed none, between those beside it; each a little of its
/// neighbours'.
fn filled(cut: &std::ops::Range<usize>, errors: &Errors) -> Vec<Vector3<f64>> {
    let known: Vec<_> = cut
        .clone()
        .map(|place| {
            errors
                .at(place)
                .map(|error| Vector3::from(error.map(f64::from)))
        })
        .collect();
    let mut all = vec![Vector3::zeros(); known.len()];
    let mut last: Option<usize> = None;
    for (place, error) in known.iter().enumerate() {
        let Some(error) = error else {
            continue;
        };
        if let Some(last) = last {
            let before = all[last];
            for (step, between) in all[last..place].iter_mut().enumerate() {
                *between = before + (error - before) * (step as f64 / (place - last) as f64);
            }
        } else {
            all[..place].fill(*error);
        }
        all[place] = *error;
        last = Some(place);
    }
    if let Some(last) = last {
        let error = all[last];
        all[last + 1..].fill(error);
    }
    let beside = |place: usize| all[place.min(all.len() - 1)];
    (0..all.len())
        .map(|place| {
            (beside(place.saturating_sub(1)) + all[place] * 2.0 + beside(place + 1)) * 0.25
        })
        .collect()
}

/// The cuts of a recorded path.
pub struct Legs<'p> {
    path: &'p Recorded,
    next: usize,
    along: f64,
}

impl Reference for Legs<'_> {
    fn next(&mut self) -> Option<Leg> {
        loop {
            let number = self.next;
            self.next += 1;
            let to = self.path.points.get(number)?;
            if !to.cuts || to.begins {
                continue;
            }
            let pose = |point: &PathPoint| Pose {
                tip: point.tip,
                axis: point.axis,
                ..Pose::default()
            };
            return Some(Leg {
                at: At {
                    task: number as u64,
                    line: to.line,
                    cuts: true,
                },
                way: Way::TipAndAxis,
                from: pose(&self.path.points[number - 1]),
                to: pose(to),
                along: self.along,
            });
        }
    }
}
