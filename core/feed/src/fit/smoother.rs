//! Some coordinates of the spline: as smooth as their tolerance allows.

use super::basis::{Basis, BasisRow, ORDER};
use super::equations::{Equations, Pull};
use super::hull::{Hull, ResidualJet, norm};
use super::track::{FitTrack, Site};
use super::{FitPoint, OVERLAP};

/// Length over which the fit smooths at most, in distances of knots.
const WIDEST: f64 = 12.0;
/// And at least.
const NARROWEST: f64 = 0.2;
/// How fast that length may change along the path.
const SLOPE: f64 = 0.4;
/// Rounds of fitting for the amount of smoothing; the first may widen it too.
const ROUNDS: usize = 10;
const WIDENING: usize = 3;
/// And for the tolerance.
const HOLDING: usize = 24;
/// Shares that a length which smooths too much falls to, at least and at most.
const RATIOS: [f64; 2] = [0.4, 0.95];
/// The tenth root of what is less is below the least of them, 0.4^10 = 1.048576e-4.
const LEAST_SHARE: f64 = 1.048e-4;
/// Spans at the end of a window whose fit still lacks what comes after.
const BLURRED: usize = OVERLAP / 2;

/// A place between sites where the tolerance was in danger.
#[derive(Debug)]
struct Extra<const W: usize> {
    at: f64,
    span: usize,
    row: BasisRow,
    weight: f64,
    error: [f64; W],
}

/// `W` coordinates that share a tolerance.
#[derive(Debug)]
pub(super) struct Smoother<const W: usize> {
    /// First of the coordinates.
    first: usize,
    tolerance: f64,
    /// Root mean square that smoothing may cost.
    noise: f64,
    /// Length over which the fit smooths, by span; kept from window to window.
    lengths: Vec<f64>,
    /// Spans whose length was settled by the window before.
    settled: usize,
    /// Spans that are smoothed; of what comes after too little is known.
    active: usize,
    /// The lengths of the window before in distances of knots, in the mean.
    pace: f64,
    /// Factor on the weight of each site.
    factors: Vec<f64>,
    extras: Vec<Extra<W>>,
    /// The reference spline minus the polyline, at the sites.
    errors: Vec<[f64; W]>,
    /// The spline minus the polyline, at the sites.
    residuals: Vec<[f64; W]>,
    /// Third derivative of the reference spline times the rows of the spans: the right side.
    forces: Vec<[[f64; W]; ORDER]>,
    /// What is added to the control points of the reference.
    deltas: Vec<[f64; W]>,
    /// Values of `deltas` where the tolerance was missed by least.
    best: Vec<[f64; W]>,
    equations: Equations<W>,
}

impl<const W: usize> Smoother<W> {
    pub(super) fn new(first: usize, tolerance: f64, smoothing: f64) -> Self {
        Self {
            first,
            tolerance,
            noise: smoothing * tolerance,
            lengths: Vec::new(),
            settled: 0,
            active: 0,
            pace: WIDEST,
            factors: Vec::new(),
            extras: Vec::new(),
            errors: Vec::new(),
            residuals: Vec::new(),
            forces: Vec::new(),
            deltas: Vec::new(),
            best: Vec::new(),
            equations: Equations::default(),
        }
    }

    fn part(&self, point: &FitPoint) -> [f64; W] {
        std::array::from_fn(|axis| point[self.first + axis])
    }

    /// How sharply the slope changes, in tolerances.
    pub(super) fn bend(&self, before: &FitPoint, behind: &FitPoint) -> f64 {
        let [before, behind] = [before, behind].map(|slope| self.part(slope));
        let change: [f64; W] = std::array::from_fn(|axis| behind[axis] - before[axis]);
        norm(&change) / self.tolerance
    }

    /// A piece begins.
    pub(super) fn begin(&mut self) {
        self.forget();
        self.pace = WIDEST;
    }

    /// The window is fitted again, on other knots.
    pub(super) fn forget(&mut self) {
        self.lengths.clear();
        self.settled = 0;
    }

    /// Lets go of the first spans.
    pub(super) fn drop_before(&mut self, spans: usize) {
        self.lengths.truncate(self.active);
        self.lengths.drain(..spans);
        self.settled = self.lengths.len();
    }

    /// Fits; the control points `fixed` are given, as is the last one where the piece `ends`. Returns by how many
    /// tolerances the spline is off at most.
    pub(super) fn fit(&mut self, track: &FitTrack, fixed: &[FitPoint], ends: bool) -> f64 {
        self.active = track.spans.len() - if ends { 0 } else { BLURRED };
        self.widest(track, ends);
        self.refer(track, fixed);
        // What is straight needs no fit.
        let small = |value: &[f64; W]| norm(value) < 1e-9 * self.tolerance;
        if self.errors.iter().all(small) && self.deltas.iter().all(small) {
            return 0.0;
        }
        let held = [fixed.len(), usize::from(ends)];
        let sites = track.sites[..track.ready].iter();
        self.factors.clear();
        self.factors.extend(sites.map(|site| f64::from(u8::from(site.data))));
        self.extras.clear();
        self.weigh(track);
        for round in 0..ROUNDS {
            self.solve(track, held);
            if !self.adjust(track, round < WIDENING) {
                break;
            }
        }
        let count = self.lengths.len() as f64;
        let widths = track.spans.iter().map(|span| span.width);
        let each = self.lengths.iter().zip(widths);
        self.pace = each.map(|(length, width)| length / width).sum::<f64>() / count;
        let mut worst = self.hold(track);
        let mut least = f64::INFINITY;
        for _ in 0..HOLDING {
            if worst <= 1.0 {
                break;
            }
            if worst < least {
                least = worst;
                self.best.clone_from(&self.deltas);
            }
            self.even(track);
            self.weigh(track);
            self.solve(track, held);
            worst = self.hold(track);
        }
        if worst > least {
            self.deltas.clone_from(&self.best);
            return least;
        }
        worst
    }

    /// What the reference spline is, at sites and spans.
    fn refer(&mut self, track: &FitTrack, fixed: &[FitPoint]) {
        self.deltas.clear();
        self.deltas.resize(track.reference.len(), [0.0; W]);
        for (index, fixed) in fixed.iter().enumerate() {
            let [fixed, reference] = [fixed, &track.reference[index]].map(|point| self.part(point));
            self.deltas[index] = std::array::from_fn(|axis| fixed[axis] - reference[axis]);
        }
        self.errors.clear();
        for site in &track.sites[..track.ready] {
            let error = self.error(track, site.span, &site.rows[0], &site.target);
            self.errors.push(error);
        }
        self.forces.clear();
        for (index, span) in track.spans.iter().enumerate() {
            let mut force = [[0.0; W]; ORDER];
            let origin = &track.reference[index];
            for (row, weight) in span.thirds.iter().zip(span.weights) {
                let third = self.error(track, index, row, origin);
                for (force, share) in force.iter_mut().zip(row) {
                    for axis in 0..W {
                        force[axis] += weight * share * third[axis];
                    }
                }
            }
            self.forces.push(force);
        }
    }

    /// A row times the reference, from an origin that keeps numbers small.
    fn error(&self, track: &FitTrack, span: usize, row: &BasisRow, origin: &FitPoint) -> [f64; W] {
        let origin = self.part(origin);
        let mut error = [0.0; W];
        for (point, share) in track.reference[span..].iter().zip(row) {
            let point = self.part(point);
            for axis in 0..W {
                error[axis] += share * (point[axis] - origin[axis]);
            }
        }
        error
    }

    /// Mean width of the spans around one.
    fn width(track: &FitTrack, span: usize) -> f64 {
        let around = &track.spans[span.saturating_sub(3)..(span + 4).min(track.spans.len())];
        around.iter().map(|span| span.width).sum::<f64>() / around.len() as f64
    }

    /// Begins with much smoothing on spans that are new.
    fn widest(&mut self, track: &FitTrack, ends: bool) {
        let pace = (2.0 * self.pace).min(WIDEST);
        for span in self.lengths.len()..track.spans.len() {
            self.lengths.push(pace * Self::width(track, span));
        }
        // A false end would bend the curve straight as far as smoothing reaches.
        if !ends && let Some(last) = self.lengths.last_mut() {
            *last = last.min(track.spans[track.spans.len() - 1].width);
        }
        self.even(track);
    }

    /// Keeps the smoothing from changing faster than `SLOPE`.
    fn even(&mut self, track: &FitTrack) {
        let step =
            |index: usize| 0.5 * SLOPE * (track.spans[index].width + track.spans[index + 1].width);
        for index in 1..self.lengths.len() {
            let most = self.lengths[index - 1] + step(index - 1);
            self.lengths[index] = self.lengths[index].min(most);
        }
        for index in (1..self.lengths.len()).rev() {
            let most = self.lengths[index] + step(index - 1);
            self.lengths[index - 1] = self.lengths[index - 1].min(most);
        }
    }

    /// Tells the equations what weight each site has.
    fn weigh(&mut self, track: &FitTrack) {
        let sites = track.sites.iter().zip(&self.factors).zip(&self.errors);
        let sites = sites.map(|((site, factor), error)| Pull {
            span: site.span,
            row: &site.rows[0],
            weight: site.weight * factor,
            error: *error,
        });
        let extras = self.extras.iter().map(|extra| Pull {
            span: extra.span,
            row: &extra.row,
            weight: extra.weight,
            error: extra.error,
        });
        self.equations.weigh(track.reference.len(), sites.chain(extras));
    }

    fn solve(&mut self, track: &FitTrack, held: [usize; 2]) {
        self.equations.solve(&track.spans, &self.forces, &self.lengths, held, &mut self.deltas);
        // What cannot be solved in the numbers that there are stays on the reference.
        if !self.deltas.as_flattened().iter().all(|delta| delta.is_finite()) {
            self.deltas[held[0]..].fill([0.0; W]);
        }
        self.residuals.clear();
        for (site, error) in track.sites.iter().zip(&self.errors) {
            let mut residual = *error;
            for (share, delta) in site.rows[0].iter().zip(&self.deltas[site.span..]) {
                for axis in 0..W {
                    residual[axis] += share * delta[axis];
                }
            }
            self.residuals.push(residual);
        }
    }

    /// Smooths less where residuals are more than noise, and more where they are far less and that is allowed still;
    /// whether there was such a place.
    fn adjust(&mut self, track: &FitTrack, widen: bool) -> bool {
        let sites = &track.sites[..track.ready];
        let square = |site: &Site, residual: &[f64; W]| {
            let weight = if site.data { site.weight } else { 0.0 };
            let sizes = residual.iter().map(|value| value * value);
            [weight * sizes.sum::<f64>(), weight]
        };
        let mut changed = false;
        let (mut low, mut high) = (0, 0);
        let mut total = [0.0; 2];
        let mut from = sites.first().map_or(0.0, |site| site.at);
        for (index, span) in track.spans.iter().enumerate() {
            let middle = from + 0.5 * span.width;
            from += span.width;
            let reach = (1.5 * self.lengths[index]).max(2.0 * span.width);
            while high < sites.len() && sites[high].at <= middle + reach {
                let value = square(&sites[high], &self.residuals[high]);
                total = [total[0] + value[0], total[1] + value[1]];
                high += 1;
            }
            while low < high && sites[low].at < middle - reach {
                let value = square(&sites[low], &self.residuals[low]);
                total = [total[0] - value[0], total[1] - value[1]];
                low += 1;
            }
            let allowed = self.noise * self.noise * total[1].max(0.0);
            let length = self.lengths[index];
            let next = if total[0] > 1.2 * allowed {
                // Residuals grow with the sixth power, towards ends with the third.
                changed |= total[0] > 2.0 * allowed && index < self.active;
                let narrowest = NARROWEST * span.width;
                // Where the root is out of its range, or no root would leave more than the narrowest, none is drawn.
                let share = 0.7 * allowed / total[0];
                if RATIOS[1] * length <= narrowest {
                    narrowest.min(length)
                } else {
                    let ratio = match share < LEAST_SHARE {
                        true => RATIOS[0],
                        false => libm::pow(share, 0.1).clamp(RATIOS[0], RATIOS[1]),
                    };
                    (ratio * length).max(narrowest).min(length)
                }
            } else if widen
                && (self.settled..self.active).contains(&index)
                && total[0] < 0.1 * allowed
            {
                let next = (2.0 * length).min(WIDEST * Self::width(track, index));
                changed |= next > 1.2 * length;
                next
            } else {
                length
            };
            self.lengths[index] = next;
        }
        self.even(track);
        changed
    }

    /// Finds where the spline is off, gives weight there and smooths less; returns by how many tolerances at most.
    fn hold(&mut self, track: &FitTrack) -> f64 {
        let sites = &track.sites[..track.ready];
        let mut worst: f64 = 0.0;
        let mut before: Option<ResidualJet<W>> = None;
        for index in 0..sites.len() {
            if sites[index].span >= self.active {
                break;
            }
            let behind = self.jet(track, &sites[index], self.residuals[index]);
            let Some(before) = before.replace(behind) else {
                continue;
            };
            let width = sites[index].at - sites[index - 1].at;
            let slope = self.part(&track.legs[sites[index - 1].leg].slope);
            let hull = Hull::new(&before, &behind, &slope, width);
            let off = hull.bound(self.tolerance) / self.tolerance;
            worst = worst.max(off);
            if off > 1.0 {
                let (quarter, size) = hull.peak();
                self.press(track, index - 1, quarter, size / self.tolerance);
            }
        }
        worst
    }

    /// Presses the spline towards the polyline at a quarter after a site.
    fn press(&mut self, track: &FitTrack, site: usize, quarter: usize, off: f64) {
        let [start, end] = [&track.sites[site], &track.sites[site + 1]];
        let span = start.span;
        let narrowest = NARROWEST * track.spans[span].width;
        self.lengths[span] = (0.7 * self.lengths[span]).max(narrowest);
        let grown = 2.0 * off * off;
        if quarter.is_multiple_of(4) {
            let factor = &mut self.factors[site + quarter / 4];
            *factor = factor.max(0.05) * grown;
            return;
        }
        let width = end.at - start.at;
        let x = 0.25 * quarter as f64 * width;
        let at = start.at + x;
        let same = |extra: &&mut Extra<W>| (extra.at - at).abs() < 0.1 * width;
        if let Some(extra) = self.extras.iter_mut().find(same) {
            extra.weight *= grown;
            return;
        }
        let slope = &track.legs[start.leg].slope;
        let target: FitPoint = std::array::from_fn(|axis| start.target[axis] + slope[axis] * x);
        let row = Basis::new(&track.knots[span + 1..]).rows(at)[0];
        let error = self.error(track, span, &row, &target);
        self.extras.push(Extra { at, span, row, weight: 0.1 * width, error });
    }

    /// Residual, first and second derivative of the spline at a site.
    fn jet(&self, track: &FitTrack, site: &Site, residual: [f64; W]) -> ResidualJet<W> {
        let origin = self.part(&track.reference[site.span]);
        let mut jet = [residual, [0.0; W], [0.0; W]];
        for index in 0..ORDER {
            let point = self.part(&track.reference[site.span + index]);
            let delta = &self.deltas[site.span + index];
            for axis in 0..W {
                let value = point[axis] - origin[axis] + delta[axis];
                jet[1][axis] += site.rows[1][index] * value;
                jet[2][axis] += site.rows[2][index] * value;
            }
        }
        jet
    }

    /// Adds what was fitted to the reference.
    pub(super) fn store(&self, points: &mut [FitPoint]) {
        for (point, delta) in points.iter_mut().zip(&self.deltas) {
            for axis in 0..W {
                point[self.first + axis] += delta[axis];
            }
        }
    }
}
