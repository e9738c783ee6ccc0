//! The frame of the linear words while the rotary axes stand: where a control lays arcs and splines.

use nalgebra::{Matrix3, Vector3};

use super::node::{PathNode, Placer};
use post_machine::kinematics::Joints;

/// How far the places are apart by which the frame is found, mm.
const APART: f64 = 1024.0;

/// Axes are square on one another that are so but for rounding.
const SQUARE: f64 = 1e-9;

/// How the words X, Y, Z and the linear axes follow from the control point while the rotary axes stand: an affine map,
/// and of the words a rotation and a shift.
#[derive(Clone, Debug)]
pub(crate) struct WordFrame<'p> {
    /// What solves its points.
    pub placer: &'p Placer,
    /// The control point that the map is known at, mm, part frame.
    at: Vector3<f64>,
    /// Words there, mm.
    words: Vector3<f64>,
    /// Directions of the part frame in that of the words.
    turn: Matrix3<f64>,
    /// Axis values there.
    joints: Joints,
    /// Linear joints, each with how it goes with the words, mm a mm.
    slides: Vec<(usize, Vector3<f64>)>,
}

impl<'p> WordFrame<'p> {
    /// Where the axes stand as at `node`. None where the linear words are not X, Y and Z, where they are not square on
    /// one another and right-handed, or where they do not place the tip alone.
    pub(crate) fn new(placer: &'p Placer, node: &PathNode) -> Option<Self> {
        let solver = placer.solver();
        let chain = solver.chain();
        let sliding = (0..chain.joints().len()).filter(|joint| !chain.joints()[*joint].rotary);
        let sliding: Vec<usize> = sliding.collect();
        if !solver.closed_form() || chain.edge().is_some() || sliding.len() != 3 {
            return None;
        }
        let along = placer.control_point().along;
        let lift = node.trace.pose.axis * along;
        let place = |point: Vector3<f64>| {
            let mut joints = node.trace.joints;
            solver.place(point, &mut joints, &node.trace.turns).ok()?;
            Some((placer.words.place(point - lift, &joints)?, joints))
        };
        let (words, joints) = place(node.tip)?;
        let mut turn = Matrix3::zeros();
        let mut rows = [Vector3::zeros(); 3];
        for axis in 0..3 {
            let mut aside = node.tip;
            aside[axis] += APART;
            let (there, slid) = place(aside)?;
            turn.set_column(axis, &((there - words) / APART));
            for (row, joint) in rows.iter_mut().zip(&sliding) {
                row[axis] = (slid[*joint] - joints[*joint]) / APART;
            }
        }
        let square = (turn.transpose() * turn - Matrix3::identity()).amax() < SQUARE;
        if !square || turn.determinant() < 0.0 {
            return None;
        }
        let slides = sliding.into_iter().zip(rows);
        Some(Self {
            placer,
            at: node.tip,
            words,
            slides: slides.map(|(joint, row)| (joint, turn * row)).collect(),
            turn,
            joints,
        })
    }

    /// A control point (mm, part frame) in the frame of the words, mm.
    pub(crate) fn point(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.words + self.turn * (point - self.at)
    }

    /// A direction of the part frame in that of the words.
    pub(crate) fn direction(&self, direction: Vector3<f64>) -> Vector3<f64> {
        self.turn * direction
    }

    /// The control point at a place in the frame of the words, mm, part frame.
    pub(crate) fn in_part(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.at + self.turn.transpose() * (place - self.words)
    }

    /// Linear joints, each with how it goes with the words, mm a mm.
    pub(crate) fn slides(&self) -> &[(usize, Vector3<f64>)] {
        &self.slides
    }

    /// Axis values at a place in the frame of the words, mm.
    pub(crate) fn joints(&self, place: Vector3<f64>) -> Joints {
        let mut joints = self.joints;
        for (joint, slide) in &self.slides {
            joints[*joint] += slide.dot(&(place - self.words));
        }
        joints
    }
}
