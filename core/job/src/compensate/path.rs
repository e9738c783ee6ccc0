//! The points of a program's path, by how much each is moved, and how far the tool is off beside it.

use nalgebra::Vector3;
use post_motion::path::nearest_share;
use post_posting::{PathPoint, PathShift};

/// Over so much of the path, mm, a move fades towards the ends of a cut, where the tool comes to the part and leaves it.
const FADE: f64 = 1.0;

/// A point that is moved by less than this share of the error beside it is let be.
const LEAST_GAIN: f32 = 0.1;

/// Records the points of a path, and moves none.
#[derive(Default)]
pub struct PathRecorder {
    points: Vec<PathPoint>,
}

impl PathShift for PathRecorder {
    fn next(&mut self, point: &PathPoint) -> Vector3<f64> {
        self.points.push(*point);
        Vector3::zeros()
    }
}

/// By how much each point of a path is moved, mm.
pub type PointShifts = Vec<[f32; 3]>;

/// Moves the points of a path.
pub struct ShiftedPath<'m> {
    moves: std::slice::Iter<'m, [f32; 3]>,
}

impl<'m> ShiftedPath<'m> {
    /// From the first point on.
    pub fn new(moves: &'m PointShifts) -> Self {
        Self { moves: moves.iter() }
    }
}

impl PathShift for ShiftedPath<'_> {
    fn next(&mut self, _: &PathPoint) -> Vector3<f64> {
        let by = self.moves.next().copied().unwrap_or_default();
        Vector3::from(by.map(f64::from))
    }
}

/// Legs ahead of the last one that the next is looked for on, and back.
const AHEAD: usize = 4096;
const BACK: usize = 16;

/// So many points beside one that a run has made worse are held back with it: moving one moves the tool at those beside
/// it, and a corner is rounded over some.
const BESIDE: usize = 2;

/// How far the tool is off beside a point of a path.
#[derive(Clone, Copy, Default)]
struct PointErrors {
    /// Sum of the errors, mm, of their squares, and of the weights that they count with.
    sum: [f32; 3],
    squares: f32,
    weight: f32,
    /// The largest, mm.
    largest: f32,
}

/// How far the tool is off beside the points of a path.
#[derive(Clone)]
pub struct Errors {
    points: Vec<PointErrors>,
    /// The end of the leg that the tool was on last.
    cursor: usize,
}

impl Errors {
    pub fn of(path: &PathRecorder) -> Self {
        Self { points: vec![PointErrors::default(); path.points.len()], cursor: 0 }
    }

    /// Where the CL path asks for `asked` the tool is off by `error`. The points stand no more than `off` mm beside that
    /// path.
    pub fn take(
        &mut self,
        path: &PathRecorder,
        asked: &Vector3<f64>,
        off: f64,
        error: &Vector3<f64>,
    ) {
        let Some((number, share)) = path.leg_at(asked, self.cursor, off) else {
            return;
        };
        self.cursor = number;
        let square = error.norm_squared();
        for (place, weight) in [(number - 1, 1.0 - share), (number, share)] {
            let beside = &mut self.points[place];
            for (axis, sum) in beside.sum.iter_mut().enumerate() {
                *sum += (error[axis] * weight) as f32;
            }
            beside.squares += (square * weight) as f32;
            beside.weight += weight as f32;
            beside.largest = beside.largest.max(square.sqrt() as f32);
        }
    }

    /// The mean at a point, if the tool has been there.
    fn at(&self, place: usize) -> Option<[f32; 3]> {
        let PointErrors { sum, weight, .. } = self.points[place];
        (weight > 0.05).then(|| sum.map(|sum| sum / weight))
    }

    /// The largest error beside a point that is moved, mm.
    pub fn largest_at(&self, moves: &PointShifts) -> f64 {
        let beside = self.points.iter().zip(moves);
        let moved = beside.filter(|(_, by)| **by != [0.0; 3]);
        moved.fold(0.0, |most, (beside, _)| most.max(f64::from(beside.largest)))
    }

    /// Holds the points back beside which these errors are worse than the `last`, by half; and entirely where one is
    /// larger than `most` mm. Whether there are any that were not held back before.
    pub fn damp(&self, last: &Self, most: f64, gains: &mut [f32]) -> bool {
        let square = |beside: &PointErrors| beside.squares / beside.weight.max(f32::MIN_POSITIVE);
        let mut damped = false;
        let mut held = vec![1.0_f32; gains.len()];
        for (place, (now, last)) in self.points.iter().zip(&last.points).enumerate() {
            let by = match now {
                now if f64::from(now.largest) > most => 0.0,
                now if square(now) > square(last) => 0.5,
                _ => continue,
            };
            let end = (place + BESIDE + 1).min(held.len());
            for held in &mut held[place.saturating_sub(BESIDE)..end] {
                *held = held.min(by);
            }
        }
        for (gain, held) in gains.iter_mut().zip(held) {
            damped |= held < 1.0 && *gain > LEAST_GAIN;
            *gain *= held;
        }
        damped
    }
}

impl PathRecorder {
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The leg that a place of the CL path lies on, within `off` mm: its end, and the share of it that lies before the
    /// place. It is looked for from the leg of the point `cursor` on, the nearer ones first.
    fn leg_at(&self, place: &Vector3<f64>, cursor: usize, off: f64) -> Option<(usize, f64)> {
        let ends = (0..AHEAD).flat_map(|step| {
            let back = cursor.checked_sub(step).filter(|_| (1..BACK).contains(&step));
            std::iter::once(cursor + step).chain(back)
        });
        let mut found = ends
            .filter_map(|end| Some((end, self.near(end, place)?)))
            .find(|(_, (distance, _))| *distance <= off)?;
        while let Some(next) = self.near(found.0 + 1, place)
            && next.0 < found.1.0
        {
            found = (found.0 + 1, next);
        }
        while let Some(last) = self.near(found.0 - 1, place)
            && last.0 < found.1.0
        {
            found = (found.0 - 1, last);
        }
        Some((found.0, found.1.1))
    }

    /// How far a place is from the leg to a point, mm, and the share of the leg before it; none where no cut leads there.
    fn near(&self, end: usize, place: &Vector3<f64>) -> Option<(f64, f64)> {
        let to = self.points.get(end).filter(|to| to.cuts && !to.begins)?;
        let from = self.points.get(end.checked_sub(1)?)?;
        let share = match from.tip == to.tip {
            true => 1.0,
            false => nearest_share([&from.tip, &to.tip], place),
        };
        Some(((from.tip + (to.tip - from.tip) * share - place).norm(), share))
    }

    /// Moves points further by minus the errors beside them, each by its share of `gains`, none by more than `bound` mm in
    /// all.
    pub fn step(&self, moves: &mut PointShifts, errors: &Errors, gains: &[f32], bound: f64) {
        let mut start = 0;
        while start < self.points.len() {
            let end = self.end_of_cut(start);
            self.step_cut(moves, errors, start..end, gains, bound);
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
        moves: &mut PointShifts,
        errors: &Errors,
        cut: std::ops::Range<usize>,
        gains: &[f32],
        bound: f64,
    ) {
        let mut ways = Vec::with_capacity(cut.len());
        let mut way = 0.0;
        for place in cut.clone() {
            let last = place.checked_sub(1).filter(|_| !self.points[place].begins);
            way += last.map_or(0.0, |last| (self.points[place].tip - self.points[last].tip).norm());
            ways.push(way);
        }
        let errors = filled(&cut, errors);
        for (place, (error, along)) in cut.zip(errors.iter().zip(&ways)) {
            let inside = (along.min(way - along) / FADE).clamp(0.0, 1.0);
            let fade = inside * inside * (3.0 - 2.0 * inside);
            let last = Vector3::from(moves[place].map(f64::from));
            let next = last - error * f64::from(gains[place]);
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
        .map(|place| errors.at(place).map(|error| Vector3::from(error.map(f64::from))))
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
