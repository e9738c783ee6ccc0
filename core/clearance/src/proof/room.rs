//! Boxes of axis values in which bodies are proven to be clear, so that motions inside of one cost a comparison.

use post_machine::kinematics::{Joints, MAX_AXES};

use crate::pair::View;
use crate::piece::Piece;
use crate::planes::Planes;
use crate::shape::Shape;

use super::Pair;

/// What each axis of a box has at least of the distance that is to spare, and the stray of the linear ones: the rest is
/// divided by how far the axes have gone lately.
const LEAST_SHARE: f64 = 1.0 / 16.0;

/// A box that does not hold so many motions like the last one is not worth its making.
const MOTIONS: f64 = 4.0;

/// How far an axis may go at most in a box between planes, as a multiple of how far it has gone lately: what it goes is added to
/// the arms of the rotary ones.
const WIDEST: f64 = 4.0;

/// Motions behind which it is looked anew how far the axes go.
const WINDOW: u32 = 64;

/// A box of axis values, wherever in which two bodies or more are apart by what they are to keep.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Least and largest values, mm and radians; infinite of axes that move no body against another.
    low: Joints,
    high: Joints,
    /// All linear axes together may stray from the line between two of its points by so much, mm.
    stray: f64,
    /// How far the bodies are apart, mm.
    pub left: f64,
}

/// How far a linear axis may go in a box between planes, mm, by how far it has gone lately.
fn widest(span: f64) -> f64 {
    WIDEST * (span + 1.0)
}

/// A distance, and what of it is to spare.
pub(super) struct Spare<'a> {
    /// Where it is known, mm and radians.
    pub joints: &'a Joints,
    /// How far any point of the body is from the axes there, mm.
    pub levers: &'a Joints,
    /// The distance, mm.
    pub at_least: f64,
    /// What is to be left of it, mm.
    pub least: f64,
}

impl Room {
    /// All axis values.
    pub fn everywhere() -> Self {
        let low = [f64::NEG_INFINITY; MAX_AXES];
        Self { low, high: low.map(|value| -value), stray: f64::INFINITY, left: f64::INFINITY }
    }

    /// The box about the end of a piece that a distance allows, long along axes of wide `spans` (mm and radians); none where
    /// it is used up soon by pieces like this one.
    ///
    /// By [`View::reach_by_levers`] each axis takes what its way uses, its arm longer by no more than all that is to spare.
    pub fn new(view: &View, spare: &Spare<'_>, piece: &Piece, spans: &Joints) -> Option<Self> {
        let most = spare.at_least - spare.least;
        let around = &piece.ends[1];
        let mut uses = [[0.0; 2]; MAX_AXES];
        let mut free = most;
        for (place, axis) in view.axes() {
            let arm = if view.is_rotary(place) { spare.levers[place] + most } else { 1.0 };
            uses[axis] = [arm; 2];
            free -= arm * libm::fabs(around[axis] - spare.joints[axis]);
        }
        let mut room = Self::shared(view, piece, (free, &uses), spans)?;
        let whole = Piece::between([room.low, room.high], room.stray);
        room.left = spare.at_least - view.reach_by_levers(spare.joints, spare.levers, &whole);
        (room.left >= spare.least).then_some(room)
    }

    /// The same by planes that hold the bodies apart where the piece ends: a linear axis uses of their gap what it takes the
    /// body along their direction, and nothing the other way. A rotary one takes no point farther than its angle times its
    /// distance from the axis, which those behind it may have lengthened.
    pub fn between(
        view: &View,
        (planes, moves): (&mut Planes, &Shape),
        least: f64,
        piece: &Piece,
        spans: &Joints,
    ) -> Option<Self> {
        let around = &piece.ends[1];
        let free = planes.gap(view, moves, around) - least;
        if free <= 0.0 {
            return None;
        }
        let (slopes, levers) = (view.slopes(around, planes.along()), view.levers(around));
        let mut uses = [[0.0; 2]; MAX_AXES];
        // How far the linear axes behind may take the body.
        let mut far = 0.0;
        for (place, axis) in view.axes().rev() {
            uses[axis] = match view.is_rotary(place) {
                true => [levers[place] + far + free; 2],
                false => [slopes[place].max(0.0), (-slopes[place]).max(0.0)],
            };
            far += if view.is_rotary(place) { 0.0 } else { widest(spans[axis]) };
        }
        let mut room = Self::shared(view, piece, (free, &uses), spans)?;
        for (_, axis) in view.axes().filter(|(place, _)| !view.is_rotary(*place)) {
            let wide = widest(spans[axis]);
            room.low[axis] = room.low[axis].max(around[axis] - wide);
            room.high[axis] = room.high[axis].min(around[axis] + wide);
        }
        room.left = least;
        Some(room)
    }

    /// The box about the end of a piece of which each axis uses up its share of what is `free`, mm; `uses`: how much its way
    /// uses, down and up, for a mm or a radian.
    fn shared(
        view: &View,
        piece: &Piece,
        (free, uses): (f64, &[[f64; 2]; MAX_AXES]),
        spans: &Joints,
    ) -> Option<Self> {
        let around = &piece.ends[1];
        let (mut step, mut all, mut count) = (piece.stray, 0.0, 1.0);
        for (_, axis) in view.axes() {
            let most = uses[axis][0].max(uses[axis][1]);
            step += most * libm::fabs(around[axis] - piece.ends[0][axis]);
            all += most * spans[axis];
            count += 1.0;
        }
        // What is no number is no room.
        if !(free > MOTIONS * step && all.is_finite()) {
            return None;
        }
        let rest = 1.0 - count * LEAST_SHARE;
        let mut room = Self { stray: LEAST_SHARE * free, ..Self::everywhere() };
        for (_, axis) in view.axes() {
            let [down, up] = uses[axis];
            let share = if all > 0.0 { down.max(up) * spans[axis] / all } else { 1.0 / count };
            let own = free * (LEAST_SHARE + rest * share);
            (room.low[axis], room.high[axis]) =
                (around[axis] - own / down, around[axis] + own / up);
        }
        Some(room)
    }

    /// A piece stays inside.
    pub fn holds(&self, piece: &Piece) -> bool {
        let [from, to] = &piece.ends;
        // All axes at once, without a branch: what is no number is within nothing.
        let within = |place: usize| {
            let (low, high) = (self.low[place], self.high[place]);
            (low <= from[place]) & (from[place] <= high) & (low <= to[place]) & (to[place] <= high)
        };
        (0..MAX_AXES).fold(piece.stray <= self.stray, |all, place| all & within(place))
    }

    /// What it has in common with another.
    pub fn meet(&mut self, other: &Self) {
        for place in 0..MAX_AXES {
            self.low[place] = self.low[place].max(other.low[place]);
            self.high[place] = self.high[place].min(other.high[place]);
        }
        self.stray = self.stray.min(other.stray);
        self.left = self.left.min(other.left);
    }

    /// It holds a piece, and as many more like it.
    fn outlasts(&self, piece: &Piece) -> bool {
        let [from, to] = &piece.ends;
        let ahead = std::array::from_fn(|place| to[place] + MOTIONS * (to[place] - from[place]));
        self.holds(&Piece::between([*to, ahead], piece.stray))
    }
}

/// Pairs that need not be looked at while the axes stay in a box that they have in common.
#[derive(Clone, Debug, Default)]
pub(super) struct Sleep {
    /// None where nobody sleeps.
    room: Option<Room>,
    /// Places of those that are looked at all the same.
    pub awake: Vec<usize>,
}

impl Sleep {
    /// Nobody sleeps.
    pub fn end(&mut self) {
        self.room = None;
    }

    /// Those pairs sleep whose rooms last, behind a motion on which all were looked at.
    pub fn begin(&mut self, pairs: &mut [Pair], piece: &Piece) {
        self.awake.clear();
        let mut common = Room::everywhere();
        for (place, pair) in pairs.iter_mut().enumerate() {
            match pair.room.as_ref().filter(|room| room.outlasts(piece)) {
                Some(room) => {
                    pair.result.clear_by = pair.result.clear_by.min(room.left);
                    common.meet(room);
                }
                None => self.awake.push(place),
            }
        }
        self.room = (self.awake.len() < pairs.len()).then_some(common);
    }

    /// Those that sleep need not be looked at on a piece.
    pub fn holds(&self, piece: &Piece) -> bool {
        self.room.as_ref().is_some_and(|room| room.holds(piece))
    }
}

/// How far the axes have gone in the last motions.
#[derive(Clone, Debug, Default)]
pub(super) struct Lately {
    /// Of each axis, mm and radians.
    pub spans: Joints,
    low: Joints,
    high: Joints,
    motions: u32,
}

impl Lately {
    /// Takes the end of a motion.
    pub fn take(&mut self, to: &Joints) {
        if self.motions.is_multiple_of(WINDOW) {
            self.spans = std::array::from_fn(|place| self.high[place] - self.low[place]);
            (self.low, self.high) = (*to, *to);
        }
        self.motions = self.motions.wrapping_add(1);
        for ((low, high), to) in self.low.iter_mut().zip(&mut self.high).zip(to) {
            (*low, *high) = (low.min(*to), high.max(*to));
        }
    }
}
