//! The polyline of a smooth piece with the knots and sites of the spline that is to follow it.

use super::basis::{Basis, BasisRow, DEGREE, GAUSS, ORDER};
use super::knots::place;
use super::{FitPoint, MOST};

/// A point of the polyline.
#[derive(Clone, Debug)]
pub(super) struct PolylineVertex {
    pub(super) point: FitPoint,
    /// The parameter there.
    pub(super) at: f64,
    /// How sharply the polyline bends here, in tolerances a unit of the parameter: the largest over all groups.
    pub(super) bend: f64,
    /// Legs without length that stand here.
    pub(super) zeros: usize,
}

/// A straight piece of the polyline.
#[derive(Clone, Debug)]
pub(super) struct PolylineLeg {
    /// First and last site.
    pub(super) sites: [usize; 2],
    /// Derivative by the parameter.
    pub(super) slope: FitPoint,
    /// Weight that the first site has of the leg before.
    carried: f64,
}

/// A place where the spline is compared with the polyline.
#[derive(Clone, Debug)]
pub(super) struct Site {
    pub(super) at: f64,
    /// The span that it lies on, and its leg; between two of them, those after.
    pub(super) span: usize,
    pub(super) leg: usize,
    /// Where the polyline is.
    pub(super) target: FitPoint,
    /// Weight in the fit: the length that it stands for.
    pub(super) weight: f64,
    /// Whether that is data; else the site counts where the tolerance is in danger alone.
    pub(super) data: bool,
    pub(super) rows: [BasisRow; 4],
}

/// What a span adds to the integral of the squared third derivative.
#[derive(Clone, Debug)]
pub(super) struct SplineSpan {
    pub(super) width: f64,
    /// Third derivative at the Gauss points, and their weights.
    pub(super) thirds: [BasisRow; GAUSS],
    pub(super) weights: [f64; GAUSS],
    /// The product of the control points `index` and `index + k` in row `index`, entry `k`.
    pub(super) gram: [[f64; ORDER]; ORDER],
}

/// Nodes and weights of Gauss's rule on (-1, 1).
const RULE: [[f64; 2]; GAUSS] =
    [[-0.774_596_669_241_483_4, 5.0 / 9.0], [0.0, 8.0 / 9.0], [0.774_596_669_241_483_4, 5.0 / 9.0]];

/// A piece from where it is settled to as far as it is known.
#[derive(Debug, Default)]
pub(super) struct FitTrack {
    pub(super) vertices: Vec<PolylineVertex>,
    /// Legs that have knots.
    pub(super) legs: Vec<PolylineLeg>,
    /// Knot `DEGREE` is where the first span begins.
    pub(super) knots: Vec<f64>,
    pub(super) sites: Vec<Site>,
    /// Spans whose B-splines are known.
    pub(super) spans: Vec<SplineSpan>,
    /// Sites with rows.
    pub(super) ready: usize,
    /// Control points on the polyline, at the means of their knots.
    pub(super) reference: Vec<FitPoint>,
    /// How much closer than usual knots are at bends.
    fineness: f64,
    inside: Vec<f64>,
}

impl FitTrack {
    /// Begins a piece at a point.
    pub(super) fn begin(&mut self, point: FitPoint) {
        self.vertices.clear();
        self.legs.clear();
        self.knots.clear();
        self.sites.clear();
        self.spans.clear();
        self.ready = 0;
        self.fineness = 1.0;
        self.vertices.push(PolylineVertex { point, at: 0.0, bend: 0.0, zeros: 0 });
        self.knots.resize(ORDER, 0.0);
    }

    /// Length of a leg.
    pub(super) fn length(&self, leg: usize) -> f64 {
        self.vertices[leg + 1].at - self.vertices[leg].at
    }

    /// How far apart knots may be at a vertex.
    fn near(&self, vertex: usize) -> f64 {
        let before = vertex.checked_sub(1).map(|leg| self.length(leg));
        let behind = (vertex + 1 < self.vertices.len()).then(|| self.length(vertex));
        let both = [before, behind];
        let each = || both.iter().flatten();
        let near = each().fold(f64::INFINITY, |least, &length| least.min(length));
        let far = each().fold(0.0, |most: f64, &length| most.max(length));
        let bend = self.vertices[vertex].bend;
        // A curve through the points would leave the longer leg by more than the tolerance.
        if bend * far > 8.0 / self.fineness { near.min(2.0 / (bend * self.fineness)) } else { near }
    }

    /// Whether a leg is straight, and no chord of a curve: a curve would leave it by far more than the tolerance, or
    /// by more than that where shorter chords follow.
    fn is_line(&self, leg: usize) -> bool {
        let length = self.length(leg);
        let legs = self.vertices.len() - 1;
        let ends = [(leg, leg.checked_sub(1)), (leg + 1, Some(leg + 1))];
        ends.into_iter().any(|(vertex, neighbour)| {
            let neighbour = neighbour.filter(|&neighbour| neighbour < legs);
            let short = neighbour.is_some_and(|leg| 3.0 * self.length(leg) < length);
            self.vertices[vertex].bend * length > if short { 8.0 } else { 40.0 }
        })
    }

    /// Puts knots and sites into the next leg, whose neighbours are known.
    pub(super) fn place(&mut self, most: f64, ends: bool) {
        let leg = self.legs.len();
        let length = self.length(leg);
        let [start, end] = [&self.vertices[leg], &self.vertices[leg + 1]];
        let line = self.is_line(leg);
        let (from, first, last) = (start.at, start.point, end.point);
        let mut slope = [0.0; MOST];
        for (slope, (first, last)) in slope.iter_mut().zip(first.iter().zip(&last)) {
            *slope = (last - first) / length;
        }
        let mut inside = std::mem::take(&mut self.inside);
        place(length, [self.near(leg), self.near(leg + 1)], most, &mut inside);
        let site = |x: f64, span: usize, weight: f64, data: bool| Site {
            at: from + x,
            span,
            leg,
            target: std::array::from_fn(|axis| first[axis] + slope[axis] * x),
            weight,
            data,
            rows: [[0.0; ORDER]; 4],
        };
        let mut span = self.knots.len() - ORDER;
        if leg == 0 && self.sites.is_empty() {
            self.sites.push(site(0.0, span, 0.0, true));
        }
        let begin = self.sites.len() - 1;
        self.sites[begin].leg = leg;
        let carried = self.sites[begin].weight;
        inside.push(length);
        let mut passed = 0.0;
        for &x in &inside {
            let width = x - passed;
            // Ends of chords carry the weight of the whole; a line has weight all along.
            let share = if line { 0.5 * width } else { 0.0 };
            if let Some(site) = self.sites.last_mut() {
                site.weight += share;
            }
            span += 1;
            self.knots.push(from + x);
            let data = line || x == length;
            let weight = if data { share } else { 0.5 * width };
            self.sites.push(site(x, span, weight, data));
            passed = x;
        }
        let end = self.sites.len() - 1;
        if !line {
            for site in [begin, end] {
                self.sites[site].weight += 0.5 * length;
            }
        }
        self.sites[end].target = last;
        inside.pop();
        self.inside = inside;
        self.legs.push(PolylineLeg { sites: [begin, end], slope, carried });
        if ends {
            let last = from + length;
            self.knots.extend([last; DEGREE - 1]);
            self.sites[end].span = span - 1;
        }
    }

    /// Puts knots in again, closer at bends: where the tolerance could not be kept. Legs that settled control points
    /// depend on stay as they are.
    pub(super) fn refine(&mut self, fineness: f64, most: f64, begun: bool, ends: bool) {
        let free = if begun { 2 * DEGREE } else { 0 };
        let span_of = |leg: &PolylineLeg| self.sites[leg.sites[0]].span;
        let count = self.legs.len();
        let Some(first) = self.legs.iter().position(|leg| span_of(leg) >= free) else {
            return;
        };
        let leg = &self.legs[first];
        let (site, span, carried) = (leg.sites[0], span_of(leg), leg.carried);
        self.knots.truncate(ORDER + span);
        self.spans.truncate(self.knots.len().saturating_sub(2 * DEGREE));
        self.legs.truncate(first);
        if first == 0 {
            self.sites.clear();
        } else {
            self.sites.truncate(site + 1);
            self.sites[site].weight = carried;
        }
        let known = self.spans.len();
        self.ready = self.sites.iter().take_while(|site| site.span < known).count();
        self.fineness = fineness;
        while self.legs.len() < count {
            self.place(most, ends && self.legs.len() + 1 == count);
        }
        self.fineness = 1.0;
    }

    /// B-splines of the spans that can be known by now.
    pub(super) fn prepare(&mut self) {
        let count = self.knots.len().saturating_sub(2 * DEGREE);
        for index in self.spans.len()..count {
            let basis = Basis::new(&self.knots[index + 1..]);
            let [first, last] = basis.span();
            let half = 0.5 * (last - first);
            let thirds = RULE.map(|[node, _]| basis.third(first + half * (1.0 + node)));
            let weights = RULE.map(|[_, weight]| half * weight);
            let mut gram = [[0.0; ORDER]; ORDER];
            for (row, weight) in thirds.iter().zip(weights) {
                for (index, gram) in gram.iter_mut().enumerate() {
                    for (gram, value) in gram.iter_mut().zip(&row[index..]) {
                        *gram += weight * row[index] * value;
                    }
                }
            }
            self.spans.push(SplineSpan { width: last - first, thirds, weights, gram });
            while let Some(site) = self.sites.get_mut(self.ready)
                && site.span == index
            {
                site.rows = basis.rows(site.at);
                self.ready += 1;
            }
        }
        self.refer();
    }

    /// Control points on the polyline: with them the spline never turns more than it (Schoenberg).
    fn refer(&mut self) {
        self.reference.clear();
        let mut leg = 0;
        for index in 0..self.spans.len() + DEGREE {
            let sum: f64 = self.knots[index + 1..=index + DEGREE].iter().sum();
            let mean = sum / DEGREE as f64;
            while leg + 1 < self.legs.len() && self.vertices[leg + 1].at <= mean {
                leg += 1;
            }
            let vertex = &self.vertices[leg];
            let slope = &self.legs[leg].slope;
            let x = mean - vertex.at;
            self.reference.push(std::array::from_fn(|axis| vertex.point[axis] + slope[axis] * x));
        }
    }

    /// Lets go of what lies before a vertex, and returns how many spans that were.
    pub(super) fn drop_before(&mut self, vertex: usize) -> usize {
        let site = self.legs[vertex].sites[0];
        let spans = self.sites[site].span;
        self.vertices.drain(..vertex);
        self.legs.drain(..vertex);
        self.knots.drain(..spans);
        self.sites.drain(..site);
        self.spans.drain(..spans);
        self.ready -= site;
        for site in &mut self.sites {
            site.span -= spans;
            site.leg = site.leg.saturating_sub(vertex);
        }
        for leg in &mut self.legs {
            leg.sites = leg.sites.map(|index| index - site);
        }
        spans
    }
}
