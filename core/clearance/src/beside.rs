//! Rapids that begin or end nearer to the stock than is kept: which of them leave a cut or come to one.

use nalgebra::Vector3;
use post_motion::path::Stance;

/// A rapid that leads on by no more than this off the way by which the cutter came near is a part of it, as a cosine: 30°.
const ONWARD: f64 = 0.866_025;

/// A rapid back along the way by which it came near is one by no more than this, as a sine.
const BACK: f64 = 1e-6;

/// A tip that goes no farther stands, mm.
const STANDS: f64 = 1e-9;

/// Where a cutter has been since it was in a cut.
///
/// A rapid that begins or ends near may do what one that keeps its distance may not, and several of them what one may not
/// if each was judged by itself: down by a little, and across along the stock. So it is measured from the last cut. Until
/// the cutter was farther away the rapids leave that cut. From then on one may come near, straight on in as many pieces
/// as it likes and back the same way, and the next one that begins near otherwise has to begin at a cut again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Beside {
    /// It was no farther away since then, or it is not known how it came here.
    #[default]
    Cut,
    /// It was farther away.
    Away,
    /// It came near this way, unit vector, part frame.
    Came(Vector3<f64>),
}

impl Beside {
    /// Takes a rapid between two stances that begins and ends nearer than is kept, or not: whether all that it has to do is
    /// not to touch.
    pub fn rapid(&mut self, [begins, ends]: [bool; 2], way: [&Stance; 2]) -> bool {
        if !begins {
            *self = Self::Away;
        }
        let [from, to] = way;
        let goes = to.pose.tip - from.pose.tip;
        let onward = goes.try_normalize(STANDS);
        let yields = match *self {
            Self::Cut => true,
            Self::Away => !begins && ends,
            Self::Came(_) if from.joints == to.joints => true,
            Self::Came(before) => onward
                .is_some_and(|way| way.dot(&before) >= ONWARD || (way + before).norm() <= BACK),
        };
        *self = match (*self, ends) {
            (_, false) => Self::Away,
            (Self::Away, true) if yields => onward.map_or(Self::Away, Self::Came),
            (before, true) => before,
        };
        yields
    }
}
