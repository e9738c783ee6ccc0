//! All pairs of bodies along a program.
//!
//! A distance that was found at one pose holds, less what one body can come nearer to the other, for every pose that
//! follows: it is a budget that motions use up, and it is computed again where it is spent. Where that is not enough the
//! way is halved. Planes that held two bodies apart are tried before that: they show it at once while one goes by the other.

mod body;
mod closest;
mod fault;
mod room;

use nalgebra::Vector3;
use post_machine::kinematics::{Joint, Joints};

use crate::ALLOWANCE;
use crate::beside::Beside;
use crate::distance::{self, Apart};
use crate::pair::View;
use crate::piece::{Piece, Way};
use crate::placement::Placement;
use crate::planes::Planes;
use crate::shape::Shape;
use room::{Lately, Room, Sleep, Spare};

use body::may_touch;
pub use body::{Body, BodyKind, Look, Rules};
pub use fault::{Fault, Verdict};

/// Pieces of one motion that a pair is looked at on; what is not proven then is not.
pub const MOST_PIECES: u64 = 1 << 13;

/// Pieces after which the nearest approach is not looked for any more, but only whether what is to be kept is: of axes that go
/// for themselves, and of others.
const MOST_CLOSE: [u64; 2] = [1 << 6, 1 << 12];

/// The nearest approach is known to this share of it: where the rest cannot be nearer, no distance is computed.
const CLOSE: f64 = 0.95;

/// A motion that is to be proven.
#[derive(Clone, Copy, Debug)]
pub struct Move<'a> {
    /// How it goes.
    pub way: Way<'a>,
    /// At rapid traverse.
    pub rapid: bool,
    /// Line of the program.
    pub line: u64,
    /// Of a way that might as well be another one: it keeps so much more than the rules ask for, mm, a cutter from the stock
    /// among it, however near to it the way begins and ends.
    pub beyond: Option<f64>,
    /// It is another way by which the motion that was taken last may go.
    pub instead: bool,
}

/// What is known of two bodies along the program.
#[derive(Clone, Debug)]
pub struct PairResult {
    /// Places of both bodies in [`Proof::bodies`].
    pub bodies: [usize; 2],
    /// They are never nearer than this where they are proven to be clear, mm; infinite before any motion.
    pub clear_by: f64,
    /// The nearest that was found, mm, and the line; not looked for closer than by five in a hundred.
    pub nearest: (f64, u64),
    /// The first place where they are not clear.
    pub fault: Option<Fault>,
    /// The worst: see [`Fault::is_worse`].
    pub worst: Option<Fault>,
    /// Motions on which they are not clear.
    pub faults: u64,
}

impl PairResult {
    /// Nothing is known yet.
    fn new(bodies: [usize; 2]) -> Self {
        Self {
            bodies,
            clear_by: f64::INFINITY,
            nearest: (f64::INFINITY, 0),
            fault: None,
            worst: None,
            faults: 0,
        }
    }
}

#[derive(Clone, Debug)]
struct Pair {
    /// Each sees the other body from the first or the second.
    views: [View; 2],
    /// Which of them sees the body go less far by turns.
    nearer: usize,
    known: Option<Known>,
    /// Wherever in it the axes stand they are apart by what is to be kept, at feed and at rapid.
    room: Option<Room>,
    /// In the frame of the body that `nearer` looks from.
    planes: Option<Planes>,
    guess: [usize; 2],
    /// Of a cutter and the stock, and ahead of the rapid that was taken last.
    beside: Beside,
    before: Beside,
    /// Other rules than those of all pairs.
    rules: Option<Rules>,
    result: PairResult,
}

/// A distance at a pose.
#[derive(Clone, Debug)]
struct Known {
    joints: Joints,
    /// How far any point of the body that [`Pair::nearer`] sees is from the axes there, mm.
    levers: Joints,
    at_least: f64,
}

/// The proof for all pairs, motion by motion.
#[derive(Clone, Debug)]
pub struct Proof {
    axes: Vec<Joint>,
    rules: Rules,
    bodies: Vec<Body>,
    pairs: Vec<Pair>,
    sleep: Sleep,
    lately: Lately,
    last: Option<Joints>,
    /// What the last motion kept more than the rules ask for, mm.
    beyond: f64,
    distances: u64,
}

impl Proof {
    /// `counts` tells of two bodies on different links whether they are looked at.
    pub fn new(
        axes: &[Joint],
        bodies: Vec<Body>,
        rules: Rules,
        counts: impl Fn(&Body, &Body) -> bool,
    ) -> Self {
        let mut pairs = Vec::new();
        for (first, one) in bodies.iter().enumerate() {
            for (second, other) in bodies.iter().enumerate().skip(first + 1) {
                if one.link != other.link && counts(one, other) {
                    pairs.push(Pair::new(axes, [first, second], [one, other]));
                }
            }
        }
        let (sleep, lately) = (Sleep::default(), Lately::default());
        let axes = axes.to_vec();
        Self { axes, rules, bodies, pairs, sleep, lately, last: None, beyond: 0.0, distances: 0 }
    }

    /// The same with other rules for some pairs.
    pub fn with_rules(mut self, of: impl Fn(&Body, &Body) -> Option<Rules>) -> Self {
        for pair in &mut self.pairs {
            let [one, other] = pair.result.bodies.map(|place| &self.bodies[place]);
            pair.rules = of(one, other);
        }
        self
    }

    /// The same, distances told apart no closer than by `within`, mm: what comes as near to what is to be kept counts as not
    /// proven.
    pub fn known_within(mut self, within: f64) -> Self {
        let own = self.pairs.iter_mut().filter_map(|pair| pair.rules.as_mut());
        own.chain([&mut self.rules]).for_each(|rules| rules.within = within);
        self
    }

    /// What the first pair of bodies keeps that `are` meant, in either order; none where there is none.
    pub fn rules_of(&self, are: impl Fn(&Body, &Body) -> bool) -> Option<Rules> {
        let pair = self.pairs.iter().find(|pair| {
            let [one, other] = pair.result.bodies.map(|place| &self.bodies[place]);
            are(one, other) || are(other, one)
        })?;
        Some(pair.rules.unwrap_or(self.rules))
    }

    /// What two bodies keep, by their places; none of a pair that is not looked at.
    pub fn rules_between(&self, bodies: [usize; 2]) -> Option<Rules> {
        let pair = self.pairs.iter().find(|pair| pair.result.bodies == bodies)?;
        Some(pair.rules.unwrap_or(self.rules))
    }

    /// The bodies.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// What is known of each pair, in the same order whatever was taken.
    pub fn results(&self) -> impl Iterator<Item = &PairResult> {
        self.pairs.iter().map(|pair| &pair.result)
    }

    /// Distances that were computed.
    pub fn distances(&self) -> u64 {
        self.distances
    }

    /// Another tool is in the spindle: what was known of distances does not hold any more.
    pub fn forget(&mut self) {
        for pair in &mut self.pairs {
            pair.forget();
            pair.beside = Beside::default();
        }
        self.sleep.end();
    }

    /// The distance of each pair where the axes stand on `joints`, what meshes enclose among it.
    pub fn at(&mut self, joints: &Joints) -> Vec<([usize; 2], Apart)> {
        let Self { bodies, pairs, distances, .. } = self;
        let found = pairs.iter_mut().map(|pair| {
            let apart = pair.distance(bodies, joints, true, Enough::OF_PIECES);
            (pair.result.bodies, apart)
        });
        let found: Vec<_> = found.collect();
        *distances += found.len() as u64;
        found
    }

    /// Proves a motion, for all pairs that `looks` wants of it.
    pub fn take(&mut self, motion: &Move<'_>, looks: impl Fn(&Body, &Body) -> Look) {
        let [from, to] = motion.way.ends.map(|stance| stance.joints);
        if !motion.instead && self.last.is_some_and(|last| last != from) {
            // Nothing is known of how it came here.
            self.forget();
        }
        if motion.instead {
            // It comes from where the other way began.
            self.pairs.iter_mut().for_each(Pair::begin_anew);
            self.sleep.end();
        } else if motion.rapid {
            self.pairs.iter_mut().for_each(|pair| pair.before = pair.beside);
        }
        self.last = Some(to);
        self.lately.take(&to);
        let whole = motion.way.whole();
        let beyond = motion.beyond.unwrap_or(0.0);
        if beyond != std::mem::replace(&mut self.beyond, beyond) {
            // Who sleeps is apart by what was to be kept then.
            self.sleep.end();
        }
        let sleeps = whole.as_ref().is_some_and(|whole| self.sleep.holds(whole));
        let Self { bodies, pairs, rules, distances, sleep, lately, .. } = self;
        let count = if sleeps { sleep.awake.len() } else { pairs.len() };
        for place in 0..count {
            let pair = &mut pairs[if sleeps { sleep.awake[place] } else { place }];
            let [one, other] = pair.result.bodies.map(|place| &bodies[place]);
            if !motion.rapid {
                pair.beside = Beside::default();
            }
            let look = looks(one, other);
            if look == Look::LeaveOut {
                pair.forget();
                pair.beside = Beside::default();
                continue;
            }
            let rules = pair.rules.as_ref().unwrap_or(rules);
            let kinds = [one.kind, other.kind];
            let keeps = rules.keeps(kinds).map(|keep| keep + beyond);
            let keep = keeps[usize::from(motion.rapid)];
            let (within, spans) = (rules.within, &lately.spans);
            let most = keeps[0].max(keeps[1]);
            let yields = motion.beyond.is_none() && may_touch(kinds) && keep > ALLOWANCE;
            let trial = Trial { bodies, motion, keep, yields, most, within, closely: true, spans };
            *distances += match look {
                Look::Spare { back } => pair.spare(&trial, whole.as_ref(), back),
                _ => pair.take(&trial, whole.as_ref()),
            };
        }
        if let Some(whole) = whole.as_ref().filter(|_| !sleeps) {
            sleep.begin(pairs, whole);
        }
    }

    /// The axes of the chain.
    pub fn axes(&self) -> &[Joint] {
        &self.axes
    }
}

/// How closely a distance is to be known, mm.
#[derive(Clone, Copy)]
struct Enough {
    /// If what the bodies are wrapped in is apart by so much, that will do.
    wrapped: f64,
    /// Pieces that are apart by so much need not be looked at closely.
    closely: f64,
}

impl Enough {
    /// The pieces themselves are looked at.
    const OF_PIECES: Self = Self { wrapped: f64::INFINITY, closely: 0.0 };
}

/// What came of looking at a piece.
enum Looked {
    /// They are apart by so much on all of it, mm.
    Clear(f64),
    /// Each of its halves is to be looked at.
    Halved,
    /// They are not proven to be clear.
    Refused,
}

/// A motion that a pair is held against.
#[derive(Clone, Copy)]
struct Trial<'a> {
    bodies: &'a [Body],
    motion: &'a Move<'a>,
    keep: f64,
    /// The distance is not kept where the motion leaves a cut or comes to one: the bodies do not touch, and no more.
    yields: bool,
    /// What is to be kept at most, at feed or at rapid, mm.
    most: f64,
    within: f64,
    /// The nearest approach is looked for, not only whether what is to be kept is.
    closely: bool,
    /// How far each axis has gone lately, mm and radians.
    spans: &'a Joints,
}

impl Pair {
    fn new(axes: &[Joint], bodies: [usize; 2], [one, other]: [&Body; 2]) -> Self {
        let view = |from: &Body, of: &Body| {
            let (centre, radius) = of.shape.sphere();
            View::new(axes, from.link, of.link, centre, radius)
        };
        let result = PairResult::new(bodies);
        let views = [view(one, other), view(other, one)];
        let nearer = usize::from(views[1].arms() < views[0].arms());
        Self {
            views,
            nearer,
            known: None,
            room: None,
            planes: None,
            guess: [0; 2],
            beside: Beside::default(),
            before: Beside::default(),
            rules: None,
            result,
        }
    }

    /// How far they are apart: no closer than that it is as much as [`Enough`] says. `fresh`: what meshes enclose is looked
    /// at too.
    fn distance(&mut self, bodies: &[Body], joints: &Joints, fresh: bool, enough: Enough) -> Apart {
        let shapes = self.result.bodies.map(|place| &bodies[place].shape);
        let [one, other] = shapes;
        let at = self.views[0].placement(joints);
        if !at.shift.iter().chain(&at.rotation).all(|value| value.is_finite()) {
            let unknown = Apart::touching(Vector3::zeros(), self.guess);
            return Apart { at_most: f64::INFINITY, ..unknown };
        }
        let convex = one.pieces() == 1 && other.pieces() == 1;
        let hulls = match convex {
            true => distance::of_shapes(one, other, &at, self.guess, enough.closely),
            false => distance::of_hulls(one, other, &at, None),
        };
        let along = match self.nearer {
            0 => hulls.along,
            _ => -at.rotation.tr_mul(&hulls.along),
        };
        let apart = hulls.at_least > 0.0;
        self.planes = apart.then(|| Planes::new(along, shapes[self.nearer]));
        if convex {
            return self.placed(hulls, shapes, &at);
        }
        // What they are wrapped in is apart by as much.
        if hulls.at_least >= enough.wrapped {
            return Apart { at_most: f64::INFINITY, nearest: self.guess, ..hulls };
        }
        let mut apart = distance::of_shapes(one, other, &at, self.guess, enough.closely);
        self.guess = apart.nearest;
        apart.at_least = apart.at_least.max(hulls.at_least.min(apart.at_most));
        if fresh
            && hulls.at_least <= 0.0
            && apart.at_most > 0.0
            && let Some(point) = distance::encloses(one, other, &at)
        {
            return Apart { at_least: 0.0, at_most: 0.0, points: [point; 2], ..apart };
        }
        self.placed(apart, shapes, &at)
    }

    /// With the place where they overlap, unless that was told of them before.
    fn placed(&self, mut apart: Apart, [one, other]: [&Shape; 2], at: &Placement) -> Apart {
        let told = self.result.worst.as_ref().is_some_and(|fault| fault.verdict == Verdict::Hits);
        if apart.at_most <= 0.0 && !told {
            apart.points = distance::meeting_of(one, other, at, &apart);
        }
        apart
    }

    /// What is known where the axes stand on `joints`.
    fn knows(&self, joints: &Joints, at_least: f64) -> Known {
        Known { joints: *joints, levers: self.views[self.nearer].levers(joints), at_least }
    }

    /// Proves a motion; how many distances were computed.
    fn take(&mut self, trial: &Trial<'_>, whole: Option<&Piece>) -> u64 {
        let Some(whole) = whole else {
            let joints = trial.motion.way.ends[0].joints;
            self.refuse(trial, Verdict::Unproven, &joints, None);
            return 0;
        };
        let room = self.room.as_ref();
        let room = room.filter(|room| room.left >= self.least(trial) && room.holds(whole));
        let beside = self.beside;
        if trial.yields || trial.motion.beyond.is_some() {
            // As it is where the distance is kept.
            self.beside = Beside::Away;
        }
        if let Some(left) = room.map(|room| room.left) {
            self.result.clear_by = self.result.clear_by.min(left);
            return 0;
        }
        if let Some(left) = self.left(trial, whole) {
            self.result.clear_by = self.result.clear_by.min(left);
            self.make_room(trial, whole);
            return 0;
        }
        let mut computed = 0;
        let mut trial = *trial;
        if trial.yields {
            computed += 2;
            let near = self.near_ends(&trial, whole, false);
            self.beside = beside;
            if self.beside.rapid(near, trial.motion.way.ends, false) {
                trial.keep = ALLOWANCE;
            }
        }
        let close = computed + MOST_CLOSE[usize::from(!whole.independent)];
        let mut clear_by = f64::INFINITY;
        let mut waiting = vec![whole.clone()];
        while let Some(piece) = waiting.pop() {
            trial.closely &= computed < close;
            if let Some(left) = self.left(&trial, &piece) {
                clear_by = clear_by.min(left);
                continue;
            }
            computed += 1;
            match self.look(&trial, &piece, computed > MOST_PIECES, &mut waiting) {
                Looked::Clear(left) => clear_by = clear_by.min(left),
                Looked::Halved => {}
                Looked::Refused => return computed,
            }
        }
        self.result.clear_by = self.result.clear_by.min(clear_by);
        self.make_room(&trial, whole);
        computed
    }

    /// Takes a motion on which a cutter goes where it has been: it is near behind it, or away; how many distances were computed.
    fn spare(&mut self, trial: &Trial<'_>, whole: Option<&Piece>, back: bool) -> u64 {
        let computed = self.tell(trial, whole);
        self.forget();
        let (true, Some(whole)) = (trial.yields, whole) else { return computed };
        let near = self.near_ends(trial, whole, true);
        self.beside.rapid(near, trial.motion.way.ends, back);
        computed + 2
    }

    /// How near they come on a motion on which nothing need be kept is told with the others, but where they touch.
    fn tell(&mut self, trial: &Trial<'_>, whole: Option<&Piece>) -> u64 {
        let nearest = self.result.nearest;
        let fresh = PairResult { nearest, ..PairResult::new(self.result.bodies) };
        let told = std::mem::replace(&mut self.result, fresh);
        let beside = self.beside;
        let free = Trial { keep: ALLOWANCE, most: ALLOWANCE, yields: false, ..*trial };
        let computed = self.take(&free, whole);
        self.beside = beside;
        let found = std::mem::replace(&mut self.result, told);
        if found.faults == 0 {
            self.result.clear_by = self.result.clear_by.min(found.clear_by);
            self.result.nearest = found.nearest;
        }
        computed
    }

    /// Whether they are not proven to be apart by more than is to be kept where a motion begins and where it ends; `fresh`: what
    /// a mesh encloses is near.
    fn near_ends(&mut self, trial: &Trial<'_>, whole: &Piece, fresh: bool) -> [bool; 2] {
        let far = trial.keep + trial.within;
        let enough = Enough { wrapped: far, closely: far };
        let ends = whole.ends.each_ref();
        ends.map(|joints| self.distance(trial.bodies, joints, fresh, enough).at_least < far)
    }

    /// Nothing is known of their distance any more.
    fn forget(&mut self) {
        (self.known, self.room) = (None, None);
    }

    /// The motion that was taken last may go another way.
    fn begin_anew(&mut self) {
        self.forget();
        self.beside = self.before;
    }

    /// Finds a box about the end of a motion in which they are apart by all that is ever to be kept.
    fn make_room(&mut self, trial: &Trial<'_>, whole: &Piece) {
        let least = trial.most.max(self.closely(trial));
        let view = &self.views[self.nearer];
        let moves = &trial.bodies[self.result.bodies[1 - self.nearer]].shape;
        let planes = self.planes.as_mut();
        let room = planes
            .and_then(|planes| Room::between(view, (planes, moves), least, whole, trial.spans));
        self.room = room.or_else(|| {
            let Known { joints, levers, at_least } = self.known.as_ref()?;
            let spare = Spare { joints, levers, at_least: *at_least, least };
            Room::new(view, &spare, whole, trial.spans)
        });
    }

    /// Finds how far they are apart in the middle of a piece, whose halves go to those that are `waiting`; it is not halved if it
    /// is the `last` that is looked at.
    fn look(
        &mut self,
        trial: &Trial<'_>,
        piece: &Piece,
        last: bool,
        waiting: &mut Vec<Piece>,
    ) -> Looked {
        let Some(joints) = trial.motion.way.middle(piece) else {
            self.refuse(trial, Verdict::Unproven, &piece.ends[0], None);
            return Looked::Refused;
        };
        let mut known = self.knows(&joints, 0.0);
        let reach = self.reach(&known, piece, 0.0);
        let closely = trial.keep + trial.within;
        let enough = Enough { wrapped: self.least(trial) + reach, closely };
        let fresh = self.known.is_none();
        let mut apart = self.distance(trial.bodies, &joints, fresh, enough);
        if apart.at_most < trial.keep && !fresh {
            // Their surfaces are near: one may be inside of the other.
            apart = self.distance(trial.bodies, &joints, true, enough);
        }
        if apart.at_most < self.result.nearest.0 {
            self.result.nearest = (apart.at_most, trial.motion.line);
        }
        if apart.at_most < trial.keep {
            let verdict = match apart.at_most <= 0.0 {
                // Whether the axes come by there hangs on how fast each of them is.
                _ if piece.independent => Verdict::Unproven,
                true => Verdict::Hits,
                false => Verdict::Near,
            };
            self.refuse(trial, verdict, &joints, Some(&apart));
            return Looked::Refused;
        }
        known.at_least = apart.at_least;
        self.known = Some(known);
        if let Some(left) = self.left(trial, piece) {
            return Looked::Clear(left);
        }
        if reach > trial.within && !last {
            let widest = match piece.independent {
                true => self.dearest(&joints, piece),
                false => 0,
            };
            if let Some([first, last]) = piece.halves(&trial.motion.way, &joints, widest) {
                waiting.extend([last, first]);
                return Looked::Halved;
            }
        }
        // What is to be kept may be, though the nearest approach is not known as closely as elsewhere.
        if apart.at_least - reach >= trial.keep {
            return Looked::Clear(apart.at_least - reach);
        }
        let apart = match apart.at_most.is_finite() {
            true => apart,
            false => self.distance(trial.bodies, &joints, false, Enough::OF_PIECES),
        };
        let unfinished = last && reach > trial.within;
        let verdict = if unfinished { Verdict::Unfinished } else { Verdict::Unproven };
        self.refuse(trial, verdict, &joints, Some(&apart));
        Looked::Refused
    }

    /// The axis that a box of axis values is best halved along, by the planes that hold the bodies apart in the middle of it.
    fn dearest(&self, middle: &Joints, piece: &Piece) -> usize {
        let along = self.planes.as_ref().map(Planes::along);
        self.views[self.nearer].around(middle, piece).dearest(along)
    }

    /// They are apart by so much along the direction of the planes in all of a box about `middle`, mm; none if that is less than
    /// `least`.
    fn apart_around(
        &self,
        trial: &Trial<'_>,
        middle: &Joints,
        piece: &Piece,
        least: f64,
    ) -> Option<f64> {
        let face = self.planes.as_ref()?.face();
        let moves = &trial.bodies[self.result.bodies[1 - self.nearer]].shape;
        self.views[self.nearer].around(middle, piece).gap(&face, moves, least)
    }

    /// What a piece is to leave of the distance, mm: what is to be kept, and no less than the nearest approach by much.
    fn least(&self, trial: &Trial<'_>) -> f64 {
        if trial.closely { trial.keep.max(self.closely(trial)) } else { trial.keep }
    }

    /// The least that need not be looked at for the nearest approach, mm.
    fn closely(&self, trial: &Trial<'_>) -> f64 {
        CLOSE * self.result.nearest.0 - trial.within
    }

    /// They are apart by so much on a piece, mm, if that is enough: by the distance that is known less what one can come nearer
    /// to the other, or by the planes between them. The cheapest first.
    fn left(&mut self, trial: &Trial<'_>, piece: &Piece) -> Option<f64> {
        let least = self.least(trial);
        let view = &self.views[self.nearer];
        if let Some(known) = &self.known {
            let left = known.at_least - view.reach_by_levers(&known.joints, &known.levers, piece);
            if left >= least {
                return Some(left);
            }
        }
        let moves = &trial.bodies[self.result.bodies[1 - self.nearer]].shape;
        let planes = self.planes.as_mut();
        if let Some([left, end]) = planes.and_then(|planes| planes.gaps(view, moves, piece, least))
        {
            self.known = Some(self.knows(&piece.ends[1], end));
            return Some(left);
        }
        if let Some(known) = &self.known {
            let left = known.at_least - self.reach(known, piece, known.at_least - least);
            if left >= least {
                return Some(left);
            }
        }
        if !piece.independent {
            return None;
        }
        let middle = trial.motion.way.middle(piece)?;
        self.apart_around(trial, &middle, piece, least)
    }

    /// They come nearer to one another by no more than this on a piece, mm, from where they stand at `known`: the least of
    /// several bounds, of which the dearer ones are looked at only if the others are more than `enough`.
    fn reach(&self, known: &Known, piece: &Piece, enough: f64) -> f64 {
        let mut least =
            self.views[self.nearer].reach_by_levers(&known.joints, &known.levers, piece);
        for view in [self.nearer, 1 - self.nearer].map(|view| &self.views[view]) {
            if least <= enough {
                break;
            }
            least = least.min(match piece.independent {
                true => view.around(&known.joints, piece).reach(),
                false => view.reach(&known.joints, piece),
            });
        }
        least
    }

    fn refuse(
        &mut self,
        trial: &Trial<'_>,
        verdict: Verdict,
        joints: &Joints,
        apart: Option<&Apart>,
    ) {
        self.forget();
        self.result.faults += 1;
        let fault = Fault {
            verdict,
            line: trial.motion.line,
            joints: *joints,
            at_most: apart.map_or(f64::INFINITY, |apart| apart.at_most),
            keep: trial.keep,
            point: apart.map_or_else(Vector3::zeros, |apart| apart.points[0]),
        };
        let PairResult { fault: first, worst, .. } = &mut self.result;
        fault.note([first, worst]);
    }
}
