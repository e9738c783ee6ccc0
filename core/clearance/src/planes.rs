//! Two parallel planes that hold two bodies apart while one moves.

use nalgebra::Vector3;
use post_machine::kinematics::Joints;

use crate::ALLOWANCE;
use crate::around::Face;
use crate::convex::Support;
use crate::pair::View;
use crate::piece::Piece;
use crate::shape::Shape;

/// A direction across which two bodies are apart, held in the frame of one of them: the other moves.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    /// Unit vector towards the one that moves.
    along: Vector3<f64>,
    /// The one that stands reaches so far along it, mm.
    far: f64,
    /// How far they are apart along it where this was asked for last, mm.
    last: Option<(Joints, f64)>,
    /// The point of the one that moves that was nearest then, frame of its link.
    nearest: Option<Vector3<f64>>,
}

impl Planes {
    pub(crate) fn new(along: Vector3<f64>, stands: &Shape) -> Self {
        Self { along, far: along.dot(&stands.support(along)), last: None, nearest: None }
    }

    /// The side of the body that stands.
    pub(crate) fn face(&self) -> Face {
        Face { along: self.along, far: self.far }
    }

    /// Unit vector towards the body that moves, frame of the other.
    pub(crate) fn along(&self) -> Vector3<f64> {
        self.along
    }

    /// How far they are apart along it where the axes stand on `joints`, mm: no nearer are they to one another.
    pub(crate) fn gap(&mut self, view: &View, moves: &Shape, joints: &Joints) -> f64 {
        if let Some((_, gap)) = self.last.filter(|(last, _)| last == joints) {
            return gap;
        }
        let at = view.placement(joints);
        let beside = at.rotation.tr_mul(&self.along);
        let nearest = moves.support_or(-beside, self.nearest);
        let near = self.along.dot(&at.shift) + beside.dot(&nearest);
        self.nearest = Some(nearest);
        let gap = near - self.far - ALLOWANCE;
        // What is no number proves nothing.
        let gap = if gap.is_finite() { gap } else { f64::NEG_INFINITY };
        self.last = Some((*joints, gap));
        gap
    }

    /// How far they are apart along it on all of a piece, and at its end, mm. None if it is less than `enough`, or not known.
    ///
    /// Along one direction a point that goes straight is nearest at an end of its way; from straight it strays by no more
    /// than an eighth of the bound on its second derivative.
    pub(crate) fn gaps(
        &mut self,
        view: &View,
        moves: &Shape,
        piece: &Piece,
        enough: f64,
    ) -> Option<[f64; 2]> {
        let [from, to] = &piece.ends;
        if piece.independent && view.turns(piece) {
            return None;
        }
        let start = self.gap(view, moves, from);
        let short = piece.stray + if piece.independent { 0.0 } else { view.bend(piece) / 8.0 };
        if start - short < enough {
            return None;
        }
        let least = match piece.independent {
            // Each axis by itself takes all points the same way.
            true => {
                start + view.slides(piece).map(|way| self.along.dot(&way).min(0.0)).sum::<f64>()
            }
            false => start.min(self.gap(view, moves, to)) - short,
        };
        if least >= enough { Some([least, self.gap(view, moves, to)]) } else { None }
    }
}
