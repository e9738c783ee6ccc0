//! Smooth curves through sequences of points, as a stream: what feeds are planned along.
//!
//! The blocks of a program are chords of a path that was smooth. Their ends carry the rounding of the printed words and
//! the noise of the CAM system, so curvature taken from differences of points is noise. [`PathFit`] cuts the path at
//! corners and lays a spline of degree five with four continuous derivatives along each piece: the smoothest
//! (the integral of the squared third derivative) that strays from the points by a share of the tolerance in the mean,
//! and nowhere from the polyline by more than the tolerance.
//!
//! It looks ahead some hundred points, whatever the length of the path; what was handed on does not change.

mod basis;
mod equations;
mod hull;
mod knots;
mod smoother;
mod track;

use basis::DEGREE;
use hull::norm;
use smoother::Smoother;
use track::{FitTrack, PolylineVertex};

/// Coordinates of a point at most.
pub const MOST: usize = 12;

/// Tip in mm, then the rotary axes in rad, then zeros.
pub type FitPoint = [f64; MOST];

/// Spans that are kept back, so that what comes after them no longer moves what is handed on.
const OVERLAP: usize = 96;
/// Spans that are fitted at once.
const WINDOW: usize = 352;

/// How much closer knots are put at bends where the tolerance cannot be kept otherwise.
const FINER: [f64; 3] = [2.0, 4.0, 8.0];

/// What the curve has to keep.
#[derive(Clone, Debug, PartialEq)]
pub struct FitRules {
    /// Number of coordinates, 3 to [`MOST`].
    pub dimensions: usize,
    /// The curve stays this close to the polyline: Euclidean over the first three coordinates, mm.
    pub tolerance: f64,
    /// Tolerance of each of the others, rad.
    pub turn_tolerance: f64,
    /// Legs whose directions differ by more, rad, meet in a corner; the path is cut there.
    pub corner: f64,
    /// How the parameter, a length, counts turns, mm a rad: so that moves of rotary axes alone have length.
    pub turn_weight: f64,
    /// Largest distance of samples, mm of the parameter; where legs are longer, samples are put in, at most 511 a leg.
    pub spacing: Option<f64>,
    /// The share of the tolerances that smoothing may take, as the root mean square of the distances from the points.
    pub smoothing: f64,
}

impl Default for FitRules {
    /// Three coordinates within 0.01 mm, corners from 30°.
    fn default() -> Self {
        Self {
            dimensions: 3,
            tolerance: 0.01,
            turn_tolerance: 0.0002,
            corner: std::f64::consts::FRAC_PI_6,
            turn_weight: 10.0,
            spacing: None,
            smoothing: 0.125,
        }
    }
}

/// One leg of the polyline as the curve goes along it.
#[derive(Clone, Copy, Debug)]
pub struct FittedLeg<'a> {
    /// Length of the parameter. Zero where the point is the one before.
    pub length: f64,
    /// The smooth piece begins here: the samples at its start are one-sided.
    pub begins: bool,
    /// The smooth piece ends with it.
    pub ends: bool,
    /// First at the start, last at the end of the leg, which is the first of the next leg unless the piece ends; every
    /// knot of the spline is one. None where the leg has no length.
    pub samples: &'a [CurveSample],
}

/// The curve at one value of its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveSample {
    /// The parameter from the start of the leg.
    pub at: f64,
    /// Value, first, second and third derivative by the parameter.
    pub values: [FitPoint; 4],
}

/// A path on its way to smooth pieces.
#[derive(Debug)]
pub struct PathFit {
    rules: FitRules,
    track: FitTrack,
    tip: Smoother<3>,
    turns: Vec<Smoother<1>>,
    /// Control points that are settled and still bear on the first spans.
    fixed: Vec<FitPoint>,
    points: Vec<FitPoint>,
    /// The last point as it was given: its vertex may be a hair from it.
    last: Option<FitPoint>,
    /// Where the path led last, over a tolerance at least, each coordinate in mm.
    direction: Option<FitPoint>,
    /// The point from where it leads on.
    base: FitPoint,
    /// Whether a leg of the piece was handed on.
    begun: bool,
    samples: Vec<CurveSample>,
    off: f64,
}

impl PathFit {
    /// # Panics
    /// Where the number of coordinates is not 3 to [`MOST`], or a tolerance, the weight of turns, the share of
    /// smoothing or the largest distance of samples is not positive.
    #[must_use]
    pub fn new(rules: FitRules) -> Self {
        assert!((3..=MOST).contains(&rules.dimensions), "a point has 3 to {MOST} coordinates");
        for positive in [
            rules.tolerance,
            rules.turn_tolerance,
            rules.turn_weight,
            rules.smoothing,
            rules.spacing.unwrap_or(1.0),
        ] {
            assert!(
                positive > 0.0 && positive.is_finite(),
                "tolerances, weights and distances of a fit are positive"
            );
        }
        let turns = 3..rules.dimensions;
        Self {
            tip: Smoother::new(0, rules.tolerance, rules.smoothing),
            turns: turns
                .map(|axis| Smoother::new(axis, rules.turn_tolerance, rules.smoothing))
                .collect(),
            rules,
            track: FitTrack::default(),
            fixed: Vec::new(),
            points: Vec::new(),
            last: None,
            direction: None,
            base: [0.0; MOST],
            begun: false,
            samples: Vec::new(),
            off: 0.0,
        }
    }

    /// Largest distance of the curve from the polyline in tolerances, as a bound. It is at or below 1; more would say
    /// that even eight times as many knots at bends did not do, and by how much.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.off
    }

    /// The path begins at, or goes straight on to, this point. `sink` gets each leg, in order, as soon as it is
    /// settled. A point with a coordinate that is not finite is refused: nothing happens, and the answer is `false`.
    pub fn push(&mut self, point: &FitPoint, sink: &mut dyn FnMut(&FittedLeg<'_>)) -> bool {
        let mut given = [0.0; MOST];
        given[..self.rules.dimensions].copy_from_slice(&point[..self.rules.dimensions]);
        if !given.iter().all(|value| value.abs() < 1e12) {
            return false;
        }
        let Some(last) = self.last.replace(given) else {
            self.begin(given);
            return true;
        };
        let end = self.track.vertices.len() - 1;
        let length = norm(&self.way(&self.track.vertices[end].point, &given));
        // Shorter than a thousandth of what is kept: it stands.
        let shortest = 1e-3 * self.rules.tolerance;
        if length < shortest {
            self.track.vertices[end].zeros += 1;
            return true;
        }
        if self.turned(&given) {
            self.finish(last, sink);
            self.begin(last);
            self.turned(&given);
        }
        let end = self.track.vertices.len() - 1;
        let length = norm(&self.way(&self.track.vertices[end].point, &given));
        if length < shortest {
            self.track.vertices[end].zeros += 1;
            return true;
        }
        self.extend(given, length);
        if self.track.vertices.len() > 2 {
            self.track.place(self.most(), false);
            self.advance(sink);
        }
        true
    }

    /// The path has a corner at the last point whatever the angle, or ends: the rest is handed on.
    pub fn cut(&mut self, sink: &mut dyn FnMut(&FittedLeg<'_>)) {
        if let Some(last) = self.last {
            self.finish(last, sink);
            self.begin(last);
        }
    }

    /// Forgets where the path stands, and what was not handed on: the next point begins another path.
    pub fn clear(&mut self) {
        self.last = None;
    }

    fn most(&self) -> f64 {
        self.rules.spacing.unwrap_or(f64::INFINITY)
    }

    fn begin(&mut self, point: FitPoint) {
        self.track.begin(point);
        self.tip.begin();
        for turn in &mut self.turns {
            turn.begin();
        }
        self.fixed.clear();
        self.fixed.push(point);
        self.begun = false;
        self.direction = None;
        self.base = point;
    }

    /// Whether the path turns by more than a corner on its way to this point. Directions are those over a tolerance at
    /// least: the directions of shorter legs are those of their rounding.
    fn turned(&mut self, point: &FitPoint) -> bool {
        let way = self.way(&self.base, point);
        let far = norm(&way);
        if far < self.rules.tolerance {
            return false;
        }
        let direction = way.map(|value| value / far);
        self.base = *point;
        let Some(before) = self.direction.replace(direction) else {
            return false;
        };
        let cosine: f64 = before.iter().zip(&direction).map(|(a, b)| a * b).sum();
        libm::acos(cosine.clamp(-1.0, 1.0)) > self.rules.corner
    }

    /// Way from one point to another, each coordinate in mm.
    fn way(&self, from: &FitPoint, to: &FitPoint) -> FitPoint {
        std::array::from_fn(|axis| {
            let way = to[axis] - from[axis];
            if axis < 3 { way } else { way * self.rules.turn_weight }
        })
    }

    /// Adds a vertex, and tells the one before how sharp it is.
    fn extend(&mut self, point: FitPoint, length: f64) {
        let end = self.track.vertices.len() - 1;
        let at = self.track.vertices[end].at + length;
        self.track.vertices.push(PolylineVertex { point, at, bend: 0.0, zeros: 0 });
        if end > 0 {
            let slope = |leg: usize| -> FitPoint {
                let [a, b] = [leg, leg + 1].map(|vertex| &self.track.vertices[vertex]);
                std::array::from_fn(|axis| (b.point[axis] - a.point[axis]) / (b.at - a.at))
            };
            let (before, behind) = (slope(end - 1), slope(end));
            let mut bend = self.tip.bend(&before, &behind);
            for turn in &self.turns {
                bend = bend.max(turn.bend(&before, &behind));
            }
            self.track.vertices[end].bend = bend;
        }
    }

    /// Fits and hands on what no longer depends on points to come.
    fn advance(&mut self, sink: &mut dyn FnMut(&FittedLeg<'_>)) {
        let track = &self.track;
        let count = track.knots.len().saturating_sub(2 * DEGREE);
        if count < WINDOW {
            return;
        }
        let settled = track
            .legs
            .iter()
            .rposition(|leg| track.sites[leg.sites[0]].span + OVERLAP <= count && leg.sites[0] > 0);
        let Some(vertex) = settled else {
            return;
        };
        self.fit(false);
        self.hand_on(vertex, false, sink);
        let spans = self.track.drop_before(vertex);
        self.tip.drop_before(spans);
        for turn in &mut self.turns {
            turn.drop_before(spans);
        }
        self.fixed.clear();
        self.fixed.extend_from_slice(&self.points[spans..spans + DEGREE]);
    }

    /// Ends the piece at its last point, which its last vertex may be a hair from, and hands on what is left of it.
    fn finish(&mut self, last: FitPoint, sink: &mut dyn FnMut(&FittedLeg<'_>)) {
        let legs = self.track.vertices.len() - 1;
        if legs > 0 {
            self.track.vertices[legs].point = last;
            self.track.place(self.most(), true);
            self.fit(true);
        }
        self.hand_on(legs, true, sink);
    }

    /// Fits the window, with more knots where the tolerance asks for them.
    fn fit(&mut self, ends: bool) {
        let mut off = self.fit_once(ends);
        for fineness in FINER {
            if off <= 1.0 {
                break;
            }
            let most = self.most();
            self.track.refine(fineness, most, self.begun, ends);
            self.tip.forget();
            self.turns.iter_mut().for_each(Smoother::forget);
            off = self.fit_once(ends);
        }
        self.off = self.off.max(off);
    }

    fn fit_once(&mut self, ends: bool) -> f64 {
        self.track.prepare();
        self.points.clone_from(&self.track.reference);
        let mut off = self.tip.fit(&self.track, &self.fixed, ends);
        self.tip.store(&mut self.points);
        for turn in &mut self.turns {
            off = off.max(turn.fit(&self.track, &self.fixed, ends));
            turn.store(&mut self.points);
        }
        off
    }

    /// Hands on the legs before a vertex; where the piece ends, what stands there too.
    fn hand_on(&mut self, vertex: usize, ends: bool, sink: &mut dyn FnMut(&FittedLeg<'_>)) {
        for leg in 0..vertex {
            self.stand(leg, sink);
            let [first, last] = self.track.legs[leg].sites;
            let start = self.track.vertices[leg].at;
            self.samples.clear();
            for site in &self.track.sites[first..=last] {
                let points = &self.points[site.span..];
                let origin = points[0];
                let mut values = [[0.0; MOST]; 4];
                for (row, values) in site.rows.iter().zip(&mut values) {
                    for (share, point) in row.iter().zip(points) {
                        for axis in 0..self.rules.dimensions {
                            values[axis] += share * (point[axis] - origin[axis]);
                        }
                    }
                }
                for (value, origin) in values[0].iter_mut().zip(origin) {
                    *value += origin;
                }
                let at = site.at - start;
                self.samples.push(CurveSample { at, values });
            }
            sink(&FittedLeg {
                length: self.track.length(leg),
                begins: !self.begun,
                ends: ends && leg + 1 == vertex,
                samples: &self.samples,
            });
            self.begun = true;
        }
        if ends {
            self.stand(vertex, sink);
        }
    }

    /// Hands on the legs without length at a vertex.
    fn stand(&mut self, vertex: usize, sink: &mut dyn FnMut(&FittedLeg<'_>)) {
        for _ in 0..std::mem::take(&mut self.track.vertices[vertex].zeros) {
            sink(&FittedLeg { length: 0.0, begins: false, ends: false, samples: &[] });
        }
    }
}
