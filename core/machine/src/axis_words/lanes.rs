//! Words of many points: those of [`AxisWords`] point by point, a step of all points before the next.

use nalgebra::Vector3;

use super::{AxisWords, Word};
use crate::description::Tcp;
use crate::kinematics::MAX_AXES;
use crate::kinematics::batch::{AxisBatch, Column, Lanes, VectorLanes, groups, widely};

/// Values of the words of many blocks, by their places.
pub type WordLanes = [Lanes; MAX_AXES];

impl AxisWords {
    /// [`AxisWords::print_rotary`] of the first `count` points of a batch.
    pub fn print_rotary_all(&self, at: &mut AxisBatch, count: usize, values: &mut WordLanes) {
        widely(
            #[inline(always)]
            || {
                for word in &self.rotary {
                    let (joints, values) = (&mut at.joints[word.joint], &mut values[word.place]);
                    print_angles(*word, joints, count, values);
                    if let Some(from) = word.turn_from {
                        show_angles(*word, from, count, values);
                    }
                }
            },
        );
    }

    /// [`AxisWords::print_tip`] of the first `count` of `tips` (mm, part frame), which are put on the printed numbers; false,
    /// and nothing done, where the words are axis positions. None where a coordinate has not one word.
    pub fn print_tip_all(
        &self,
        tips: &mut VectorLanes,
        count: usize,
        values: &mut WordLanes,
    ) -> Option<bool> {
        if !self.one_each() || !self.standing.is_empty() {
            return None;
        }
        if self.plane.is_none() && self.tcp == Tcp::Post {
            return Some(false);
        }
        widely(
            #[inline(always)]
            || {
                if let Some(plane) = &self.plane {
                    each(tips, count, |tip| plane.into_plane(tip));
                }
                for word in &self.linear {
                    let (tips, values) = (&mut tips[word.coordinate], &mut values[word.place]);
                    print(*word, tips, count, values, 0.0);
                }
                if let Some(plane) = &self.plane {
                    each(tips, count, |tip| plane.into_part(tip));
                }
            },
        );
        Some(true)
    }

    /// Whether a linear word of the block of a `lane` differs from the one before it, by `most` mm at most; `words` begin
    /// with the block before the first.
    pub fn creeps(&self, words: &[Column; MAX_AXES], lane: usize, most: f64) -> bool {
        self.linear.iter().any(|word| {
            let column = &words[word.place];
            let step = libm::fabs((column[lane + 1] - column[lane]) * word.unit);
            step > 0.0 && step <= most
        })
    }

    /// Each coordinate has one linear word.
    fn one_each(&self) -> bool {
        let places = self.linear.iter().fold(0, |places, word| places | 1 << word.coordinate);
        self.linear.len() == 3 && places == 0b111
    }

    /// [`AxisWords::print_linear`] of the first `count` points of a batch.
    pub fn print_linear_all(&self, at: &mut AxisBatch, count: usize, values: &mut WordLanes) {
        widely(
            #[inline(always)]
            || {
                for word in &self.linear {
                    let (joints, values) = (&mut at.joints[word.joint], &mut values[word.place]);
                    print(*word, joints, count, values, self.zero[word.joint]);
                }
            },
        );
    }
}

/// Puts each of the first `count` points on another.
#[inline(always)]
fn each(points: &mut VectorLanes, count: usize, other: impl Fn(Vector3<f64>) -> Vector3<f64>) {
    for lane in 0..count {
        let point = other(Vector3::from_fn(|part, _| points[part][lane]));
        for (part, value) in points.iter_mut().zip(&point) {
            part[lane] = *value;
        }
    }
}

/// Puts angles on printed numbers.
#[inline(always)]
fn print_angles(word: Word, angles: &mut Lanes, count: usize, values: &mut Lanes) {
    for lane in 0..groups(count) {
        let value = word.printed((angles[lane] + word.reading) * word.per_unit);
        angles[lane] = value * word.unit - word.reading;
        values[lane] = value;
    }
}

/// Puts printed angles within the turn that begins at `from`, degrees.
#[inline(always)]
fn show_angles(word: Word, from: f64, count: usize, values: &mut Lanes) {
    for value in &mut values[..groups(count)] {
        *value = word.within_turn(*value, from);
    }
}

/// Puts lengths, counted from `zero` (mm), on printed numbers.
#[inline(always)]
fn print(word: Word, lengths: &mut Lanes, count: usize, values: &mut Lanes, zero: f64) {
    for lane in 0..groups(count) {
        let value = word.printed((lengths[lane] - zero) * word.per_unit);
        values[lane] = value;
        lengths[lane] = value * word.unit + zero;
    }
}
