//! Two bodies, and how far one can come nearer to the other on a piece of a way.

use nalgebra::Vector3;
use post_machine::kinematics::chain::turn;
use post_machine::kinematics::{Chain, Joint, Joints, Trace};

use crate::piece::Piece;
use crate::placement::Placement;

/// One body seen from the link of another: the axes between them, with the middle of the body as what these carry.
#[derive(Clone, Debug)]
pub struct View {
    pub(crate) chain: Chain,
    /// Place in the machine's chain of each of its axes.
    axes: Vec<usize>,
    /// All of the body is within this of its middle, mm.
    radius: f64,
}

impl View {
    /// The body on link `of` with all of it within `radius` of `centre` (mm, machine frame, all axes at zero), seen from
    /// link `from`.
    pub fn new(
        joints: &[Joint],
        from: usize,
        of: usize,
        centre: Vector3<f64>,
        radius: f64,
    ) -> Self {
        let axes: Vec<usize> =
            if from <= of { (from..of).collect() } else { (of..from).rev().collect() };
        // Towards the part every axis goes the other way.
        let sense = if from <= of { 1.0 } else { -1.0 };
        let between = axes.iter().map(|place| {
            let joint = joints[*place];
            Joint { direction: joint.direction * sense, ..joint }
        });
        let chain = Chain::new(between.collect(), Vector3::zeros(), centre, Vector3::z());
        Self { chain, axes, radius }
    }

    /// Values of its own axes.
    pub(crate) fn of(&self, joints: &Joints) -> Joints {
        let mut own = Joints::default();
        for (value, place) in own.iter_mut().zip(&self.axes) {
            *value = joints[*place];
        }
        own
    }

    /// Places of its axes in its own chain, and in the machine's.
    pub(crate) fn axes(&self) -> impl DoubleEndedIterator<Item = (usize, usize)> {
        self.axes.iter().copied().enumerate()
    }

    /// Whether an axis turns, by its place in the own chain.
    pub(crate) fn is_rotary(&self, place: usize) -> bool {
        self.chain.joints()[place].rotary
    }

    /// All of the body is within this of its middle, mm.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// How much farther along a direction each linear axis takes the body for a mm of its way, by its place in the own chain;
    /// rotary axes stand as in `joints`.
    pub(crate) fn slopes(&self, joints: &Joints, along: Vector3<f64>) -> Joints {
        let turns = self.chain.turns(&self.of(joints));
        let all = self.chain.joints();
        let mut slopes = Joints::default();
        for (place, joint) in all.iter().enumerate().filter(|(_, joint)| !joint.rotary) {
            let front = all[..place].iter().enumerate().rev().filter(|(_, joint)| joint.rotary);
            let way = front.fold(joint.direction, |way, (place, joint)| {
                let (sine, cosine) = turns.of(place);
                turn(way, joint.direction, sine, cosine)
            });
            slopes[place] = along.dot(&way);
        }
        slopes
    }

    /// Where the middle of the body is, mm, frame of the other's link.
    pub fn centre(&self, joints: &Joints) -> Vector3<f64> {
        self.chain.forward(&self.of(joints)).tip
    }

    /// Where its link stands in the frame of the other's.
    pub fn placement(&self, joints: &Joints) -> Placement {
        let own = self.of(joints);
        let turns = self.chain.turns(&own);
        let mut at = Placement::identity();
        for (place, joint) in self.chain.joints().iter().enumerate().rev() {
            if !joint.rotary {
                at.shift += joint.direction * own[place];
                continue;
            }
            let (sine, cosine) = turns.of(place);
            let turned = |vector| turn(vector, joint.direction, sine, cosine);
            for column in 0..3 {
                let axis: Vector3<f64> = at.rotation.column(column).into();
                at.rotation.set_column(column, &turned(axis));
            }
            at.shift = joint.point + turned(at.shift - joint.point);
        }
        at
    }

    /// No point of the body is farther from where it is at `known` on any of `piece`, mm.
    ///
    /// Where the axes go linearly, the middle strays from the line between its ends by no more than an eighth of the bound
    /// on its second derivative, and no point of that line is farther away than an end of it. A point of the body goes
    /// besides as far as the turn of its frame takes it about the middle; turns of several axes add up at most. Of axes that
    /// go for themselves it says nothing.
    pub fn reach(&self, known: &Joints, piece: &Piece) -> f64 {
        let centre = self.centre(known);
        let ends = piece.ends.each_ref().map(|joints| self.of(joints));
        let known = self.of(known);
        let far = |place: usize| {
            let [from, to] = [0, 1].map(|end: usize| libm::fabs(ends[end][place] - known[place]));
            from.max(to)
        };
        let joints = self.chain.joints();
        let turned: f64 = (0..joints.len()).filter(|place| joints[*place].rotary).map(far).sum();
        let [from, to] = ends.each_ref().map(|ends| (self.chain.forward(ends).tip - centre).norm());
        let bend = self.chain.bend_by_arms([&ends[0], &ends[1]]);
        from.max(to) + bend / 8.0 + piece.stray + chord(turned) * self.radius
    }

    /// Some rotary axis between the two turns on `piece`.
    pub fn turns(&self, piece: &Piece) -> bool {
        let [from, to] = &piece.ends;
        let mut axes = self.chain.joints().iter().zip(&self.axes);
        axes.any(|(joint, axis)| joint.rotary && from[*axis] != to[*axis])
    }

    /// A bound on the second derivative of any point of the body where the axes go linearly over `piece`, mm, by the share
    /// of it.
    pub(crate) fn bend(&self, piece: &Piece) -> f64 {
        let [from, to] = piece.ends.each_ref().map(|joints| self.of(joints));
        self.bend_between(&from, &to)
    }

    /// The same between two sets of values of its own axes.
    pub(crate) fn bend_between(&self, from: &Joints, to: &Joints) -> f64 {
        self.chain.bend_by_arms_within(self.radius, [from, to])
    }

    /// How far each linear axis takes the body on `piece`, mm, frame of the other's link, rotary axes as they stand where it
    /// begins.
    pub fn slides(&self, piece: &Piece) -> impl Iterator<Item = Vector3<f64>> {
        let [from, to] = &piece.ends;
        let start = self.centre(from);
        let moved = self.axes.iter().filter(|axis| from[**axis] != to[**axis]);
        moved.map(move |axis| {
            let mut joints = *from;
            joints[*axis] = to[*axis];
            self.centre(&joints) - start
        })
    }

    /// Sum of the distances from the lines of rotary axes that [`View::levers`] tells with all axes at zero, mm.
    pub(crate) fn arms(&self) -> f64 {
        let levers = self.levers(&Joints::default());
        let joints = self.chain.joints().iter().zip(levers);
        joints.filter(|(joint, _)| joint.rotary).map(|(_, lever)| lever).sum()
    }

    /// How far any point of the body is from the line of each axis where the axes stand on `known`, mm, at most.
    pub fn levers(&self, known: &Joints) -> Joints {
        let known = self.of(known);
        let mut trace =
            Trace { joints: known, turns: self.chain.turns(&known), ..Trace::default() };
        self.chain.trace(&mut trace);
        trace.tip_rates.map(|rate| rate.norm() + self.radius)
    }

    /// As [`View::reach`], from `levers` alone and without a sine, wherever each axis stands between its values at the ends
    /// of `piece`: axis by axis from the body on, each turns no point farther than its own distance from the line, which
    /// those behind it may have lengthened.
    pub fn reach_by_levers(&self, known: &Joints, levers: &Joints, piece: &Piece) -> f64 {
        let mut moved = piece.stray;
        for (place, joint) in self.chain.joints().iter().enumerate().rev() {
            let axis = self.axes[place];
            let [from, to] = piece.ends.each_ref().map(|ends| libm::fabs(ends[axis] - known[axis]));
            let far = from.max(to);
            moved += match joint.rotary {
                true => far.min(2.0) * (levers[place] + moved),
                false => far,
            };
        }
        moved
    }

    /// The axis of the machine whose way over `piece` moves the body most.
    pub fn widest(&self, piece: &Piece) -> Option<(usize, f64)> {
        let levers = self.levers(&piece.ends[0]);
        let way = |place: usize| {
            let axis = self.axes[place];
            let way = libm::fabs(piece.ends[1][axis] - piece.ends[0][axis]);
            match self.chain.joints()[place].rotary {
                true => way * levers[place],
                false => way,
            }
        };
        let ways = (0..self.axes.len()).map(|place| (self.axes[place], way(place)));
        ways.max_by(|one, other| one.1.total_cmp(&other.1))
    }
}

/// How far a point goes that is turned by `angle` about a line at the distance 1, and on the way: no farther.
fn chord(angle: f64) -> f64 {
    2.0 * libm::sin(0.5 * angle.min(std::f64::consts::PI))
}
