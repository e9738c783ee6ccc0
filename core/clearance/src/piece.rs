//! A part of a way, and between which axis values all axes stay on it.

use nalgebra::{Matrix3, Vector3};
use post_machine::kinematics::{Joints, MAX_AXES, Solver, TcpBlock, Trace};
use post_motion::path::{BSpline, Curve, Interpolation, Stance, turns};

/// Of a piece as short as this of a way it is known how its axes go, or never will be.
const SHORTEST: f64 = 1.0 / 1024.0;

/// Spans of a spline that a piece is looked at in; of one with more their hull counts.
const MOST_SPANS: usize = 8;

/// How a machine goes from one stance to another.
#[derive(Clone, Copy, Debug)]
pub struct Way<'a> {
    /// The machine with the tool that the way is of.
    pub solver: &'a Solver,
    /// How the control leads it.
    pub interpolation: &'a Interpolation,
    /// Where it begins and ends.
    pub ends: [&'a Stance; 2],
    /// Each axis goes for itself, from where it stands to where it shall: they need not arrive together.
    pub independent: bool,
}

/// Part of a way.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Axis values at its ends, mm and radians.
    pub ends: [Joints; 2],
    /// How far all axes together stray at most from the straight line between the ends, mm: they are linear ones.
    pub stray: f64,
    /// The axes go for themselves between the ends, anywhere in the box that these span.
    pub independent: bool,
    /// Shares of the way, 0 to 1.
    share: [f64; 2],
}

impl Piece {
    /// A machine that stands.
    pub fn at(joints: &Joints) -> Self {
        Self { ends: [*joints; 2], stray: 0.0, independent: false, share: [0.0, 1.0] }
    }

    /// All axes go for themselves between these ends, the linear ones farther by `stray` mm together.
    pub(crate) fn between(ends: [Joints; 2], stray: f64) -> Self {
        Self { ends, stray, independent: true, share: [0.0, 1.0] }
    }

    /// The halves of a piece of `way` on both sides of its `middle`; of a box those across the axis `widest`. None where
    /// nothing is proven of one.
    pub fn halves(&self, way: &Way<'_>, middle: &Joints, widest: usize) -> Option<[Self; 2]> {
        let [from, to] = self.ends;
        if self.independent {
            let (mut first, mut last) = (to, from);
            first[widest] = middle[widest];
            last[widest] = middle[widest];
            return Some([[from, first], [last, to]].map(|ends| Self { ends, ..self.clone() }));
        }
        let [start, end] = self.share;
        let cut = 0.5 * (start + end);
        let half = |share, ends| way.piece(Self { ends, share, ..self.clone() });
        Some([half([start, cut], [from, *middle])?, half([cut, end], [*middle, to])?])
    }
}

impl Way<'_> {
    /// All of it. None where nothing is proven of how its axes go.
    pub fn whole(&self) -> Option<Piece> {
        let ends = self.ends.map(|stance| stance.joints);
        let moving = (0..MAX_AXES).filter(|place| ends[0][*place] != ends[1][*place]).count();
        // One axis alone comes by all that is between its ends, whenever.
        if self.independent && moving > 1 {
            return Some(Piece { ends, independent: true, ..Piece::at(&ends[0]) });
        }
        self.piece(Piece { ends, ..Piece::at(&ends[0]) })
    }

    /// Axis values in the middle of a piece of it, mm and radians. None where the axes do not come by.
    pub fn middle(&self, piece: &Piece) -> Option<Joints> {
        let [from, to] = &piece.ends;
        if piece.independent || *self.interpolation == Interpolation::Axes {
            return Some(std::array::from_fn(|place| 0.5 * (from[place] + to[place])));
        }
        let share = 0.5 * (piece.share[0] + piece.share[1]);
        self.interpolation.joints_at(self.solver, self.ends, share, from).ok()
    }

    /// A piece of it of which its ends are known, with how far its axes stray. None where nothing is proven of that.
    fn piece(&self, mut piece: Piece) -> Option<Piece> {
        if *self.interpolation == Interpolation::Axes {
            return Some(piece);
        }
        let turning = turns(self.solver.chain(), self.ends);
        let led =
            matches!(self.interpolation, Interpolation::TipAndAxis | Interpolation::TipAndFrame(_));
        if turning && led {
            return None;
        }
        let share = piece.share;
        let curved = self.curved(share)?;
        let reach = match turning {
            true => self.solver.linear_reach(),
            false => self.reach(&piece.ends[0]),
        };
        // What is no number is told from zero: it proves nothing.
        let mut stray = if curved == 0.0 { 0.0 } else { reach * curved };
        if turning {
            let tip = self.interpolation.curve().at(self.ends.map(|end| end.pose.tip), share[1]);
            stray += {
                let [from, to] = &piece.ends;
                TcpBlock::bend_by_arms(self.solver, [from, to], tip)
            } / 8.0;
        }
        let sliding = self.solver.chain().joints().iter().filter(|joint| !joint.rotary).count();
        piece.stray = stray * sliding as f64;
        if !piece.stray.is_finite() {
            piece = self.boxed(piece)?;
        }
        // Of a piece that turns too far nothing is known, but of its halves; of one that turns little nothing ever will be.
        (piece.stray.is_finite() || share[1] - share[0] > SHORTEST).then_some(piece)
    }

    /// No linear axis goes farther than this times the way of the tip, where the rotary axes stand as in `joints`, between the
    /// linear ones too; infinite where the linear axes are not three that span a volume.
    fn reach(&self, joints: &Joints) -> f64 {
        let reach = self.solver.linear_reach();
        let chain = self.solver.chain();
        let all = chain.joints().iter().enumerate();
        let linear: Vec<usize> =
            all.filter(|(_, joint)| !joint.rotary).map(|(place, _)| place).collect();
        let ([x, y, z], true) = (linear.as_slice(), reach.is_infinite()) else { return reach };
        let ways = [x, y, z].map(|place| chain.way_of(*place, joints));
        let Some(inverse) = Matrix3::from_columns(&ways).try_inverse() else { return reach };
        inverse.row_iter().map(|row| row.norm()).fold(0.0, f64::max)
    }

    /// A piece whose tip goes straight, by the ranges of its linear axes: where rotary axes stand between these. A piece
    /// that turns far is none, and is halved.
    fn boxed(&self, piece: Piece) -> Option<Piece> {
        let unknown = Piece { stray: f64::INFINITY, ..piece.clone() };
        if self.interpolation.is_curved() {
            return Some(unknown);
        }
        let chain = self.solver.chain();
        let [from, to] = piece.ends.map(|joints| {
            let mut trace = Trace { joints, turns: chain.turns(&joints), ..Trace::default() };
            chain.trace(&mut trace);
            trace
        });
        let Some(block) = TcpBlock::new(self.solver, 0.0, &from, &to) else {
            return Some(unknown);
        };
        let Some(range) = block.slides(&[0.0; MAX_AXES], 0.0) else {
            return Some(unknown);
        };
        // The axis and the line between its ends are both within its range.
        let stray = block.sliding().map(|place| range.most[place] - range.least[place]);
        Some(Piece { stray: stray.iter().sum(), ..piece })
    }

    /// How far the tip strays from the straight line between two shares, mm: none where that is not known.
    fn curved(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let tips = self.ends.map(|stance| stance.pose.tip);
        match self.interpolation.curve() {
            Curve::Straight => Some(0.0),
            Curve::Arc { centre, normal, sweep } => {
                let arms = tips.map(|tip| {
                    let arm = tip - centre;
                    (arm - normal * normal.dot(&arm)).norm()
                });
                let [first, last] = arms;
                // Radius and turn go evenly: r'' of the arm is r·sweep² towards the axis and twice dr·sweep across it.
                let bend = first.max(last) * sweep * sweep
                    + 2.0 * libm::fabs(last - first) * libm::fabs(*sweep);
                Some(bend * (to - from) * (to - from) / 8.0)
            }
            Curve::Spline(spline) => {
                let stray = spline_stray(spline, [from, to]);
                stray.is_finite().then_some(stray)
            }
        }
    }
}

/// No point of a spline between two shares is farther from where the line between its ends is at the same share, mm.
fn spline_stray(spline: &BSpline, share: [f64; 2]) -> f64 {
    let [first, last] = spline.range();
    let [from, to] = share.map(|share| (first + (last - first) * share).clamp(first, last));
    let knots = &spline.knots[spline.degree..=spline.poles.len()];
    let begins = knots.partition_point(|knot| *knot <= from).max(1) - 1;
    let ends = knots.partition_point(|knot| *knot < to);
    if ends - begins > MOST_SPANS {
        return hull(&spline.poles[begins..(ends + spline.degree).min(spline.poles.len())]);
    }
    let (start, way) = (spline.point(from), spline.point(to) - spline.point(from));
    let on_line = |at: f64| start + way * ((at - from) / (to - from));
    let mut most = 0.0f64;
    for place in begins..ends {
        let [low, high] = [knots[place].max(from), knots[place + 1].min(to)];
        if low >= high {
            continue;
        }
        let part = spline.part(spline.degree + place, [low, high]);
        let weights = part.iter().map(|(_, weight)| *weight);
        let (least, largest) = weights.fold((f64::INFINITY, 0.0f64), |(least, most), weight| {
            (least.min(weight), most.max(weight))
        });
        let off = part.iter().enumerate().map(|(index, (pole, _))| {
            let at = low + (high - low) * index as f64 / spline.degree as f64;
            (pole - on_line(at)).norm()
        });
        // With weights that differ the poles count otherwise than on the line, which is no farther than its middle is from an end.
        let uneven = 0.5 * (on_line(high) - on_line(low)).norm() * (largest / least - 1.0);
        most = most.max(off.fold(0.0, f64::max) + uneven);
    }
    most
}

/// Diameter of a box of poles, mm: a spline stays within their hull, as its weights lie above zero, and so does the line
/// between its ends.
fn hull(poles: &[(Vector3<f64>, f64)]) -> f64 {
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for (pole, _) in poles {
        (low, high) = (low.inf(pole), high.sup(pole));
    }
    (high - low).norm()
}
