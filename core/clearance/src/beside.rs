//! Rapids that begin or end nearer to the stock than is kept: which of them leave a cut or come to one.

use nalgebra::Vector3;
use post_motion::path::Stance;

/// A rapid that leads on by no more than this off the first one of its run is a part of it, as a cosine: 30°.
const ONWARD: f64 = 0.866_025;

/// Two rapids go along the same line by no more than this, as a sine.
const IN_LINE: f64 = 1e-6;

/// A tip that goes no farther stands, mm.
const STANDS: f64 = 1e-9;

/// Where a cutter has been since it was in a cut.
///
/// A rapid that begins or ends near may do what one that keeps its distance may not, and several of them what one may not
/// if each was judged by itself: down by a little, and across along the stock. So one rapid may leave a cut, and one may
/// come near from where the distance is kept; those that stay near behind it lead on with it, go back by what was gone last,
/// or out along the tool axis, or are held to the distance. None of these gets farther aside than it leads on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Beside {
    /// It stands where it has cut, or it is not known how it came here.
    #[default]
    Cut,
    /// It was farther away.
    Away,
    /// It left a cut, or came near, and is near since.
    Near(Run),
}

/// Rapids near the stock, from the first on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Where it leads, unit vector, part frame; zero behind a first rapid on which the tip stood.
    onward: Vector3<f64>,
    /// What was gone last, of all rapids along one line, mm, part frame.
    last: Vector3<f64>,
}

impl Run {
    /// The run behind a rapid that it allows, on which the tip goes along `way`, mm; none if it does not. `ends`: near.
    fn with(&self, way: Vector3<f64>, out: Vector3<f64>, ends: bool) -> Option<Self> {
        let along = way.try_normalize(STANDS)?;
        let in_line = along.cross(&self.last).norm() <= IN_LINE * self.last.norm();
        let last = if in_line { self.last + way } else { way };
        let goes_back = in_line && along.dot(&self.last) < 0.0;
        // Who goes back farther than it came is no longer near there, or is on another way.
        if goes_back && (!ends || way.norm() <= self.last.norm() + STANDS) {
            return Some(Self { last, ..*self });
        }
        if along.dot(&self.onward) >= ONWARD {
            return Some(Self { last, ..*self });
        }
        (along.dot(&out) >= ONWARD).then_some(Self { onward: out, last })
    }
}

impl Beside {
    /// Takes a rapid between two stances that begins and ends nearer than is kept, or not: whether all that it has to do is
    /// not to touch. `back`: it goes back along the cut that it has just made.
    pub fn rapid(
        &mut self,
        [begins, ends]: [bool; 2],
        [from, to]: [&Stance; 2],
        back: bool,
    ) -> bool {
        if !begins {
            *self = Self::Away;
        }
        if from.joints == to.joints {
            return true;
        }
        let way = to.pose.tip - from.pose.tip;
        let begun =
            || Run { onward: way.try_normalize(STANDS).unwrap_or_else(Vector3::zeros), last: way };
        let behind = match self {
            Self::Cut if back => Some(Self::Cut),
            Self::Cut => Some(Self::Near(begun())),
            Self::Away => ends.then(|| Self::Near(begun())),
            Self::Near(run) => run.with(way, from.pose.axis, ends).map(Self::Near),
        };
        let yields = behind.is_some();
        *self = match (behind, *self) {
            _ if !ends => Self::Away,
            (Some(behind), _) => behind,
            // Those behind one that is not allowed lead on with the same, and go back by nothing.
            (None, Self::Near(run)) => Self::Near(Run { last: Vector3::zeros(), ..run }),
            (None, before) => before,
        };
        yields
    }
}
