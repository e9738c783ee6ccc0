//! The convex-concave procedure over one stretch between two stops.

use super::forms::{self, Form};
use super::{Law, Piece, Plan, Settings};
use crate::infeasible::Infeasible;
use crate::interior::{Cost, Inequality, Program};
use crate::limits::{Channel, Limit, Order};
use crate::problem::Problem;
use crate::samples::Samples;

/// Gap to which each round goes.
const TOLERANCE: f64 = 1e-7;

/// A coefficient may be this often what reachability analysis has there: above the bounds of every plan, and small
/// enough that the unknowns are of the order of 1.
const ABOVE: f64 = 2.0;

/// A part of a path without a stop on the way.
pub(super) struct Stretch<'a> {
    pub(super) samples: &'a Samples,
    pub(super) limits: &'a [&'a dyn Limit],
    pub(super) problem: &'a Problem,
    /// The plan without jerk limits.
    pub(super) fast: &'a [f64],
    pub(super) first: usize,
    pub(super) last: usize,
}

/// A row that does not change from round to round, in coefficients of the spline, and of which the sense does.
struct Rule {
    form: Form,
    /// Coefficients of `q` at the same place, for jerk.
    q: Option<Form>,
}

impl Stretch<'_> {
    /// Appends the stretch's feed to a plan.
    pub(super) fn plan(&self, settings: Settings, plan: &mut Plan) -> Result<(), Infeasible> {
        let spline = Spline::new(self);
        let (rules, offsets) = self.rules(&spline);
        let scale = spline.scale(self);
        let mut bounds = spline.bounds(self, &scale);
        self.cap_ends(&spline, &scale, &mut bounds);
        // The first tangents are those at the plan without jerk limits.
        let mut coefficients: Vec<f64> = scale.clone();
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..settings.rounds {
            let program = program(&spline, &scale, &bounds, &rules, &offsets, &coefficients);
            let half = |(x, scale): (&f64, &f64)| 0.5 * x / scale;
            let ends = program.lower.iter().zip(&program.upper);
            let start: Vec<f64> = (coefficients.iter().zip(&scale).map(half).zip(ends))
                .map(|(x, (low, high))| {
                    x.clamp(low + 1e-3 * (high - low), high - 1e-3 * (high - low))
                })
                .collect();
            let solution = program.minimise(&start, TOLERANCE);
            plan.iterations += solution.iterations;
            plan.rounds += 1;
            let mut x = solution.x;
            keep(&program, &mut x);
            coefficients = x.iter().zip(&scale).map(|(x, scale)| x * scale).collect();
            let seconds = spline.law(self, &coefficients).duration();
            // What is not a number is no progress.
            let better = best.as_ref().is_none_or(|(least, _)| seconds < *least);
            if !better || !seconds.is_finite() {
                break;
            }
            let before = best.replace((seconds, coefficients.clone()));
            if before.is_some_and(|(before, _)| seconds > before * (1.0 - settings.progress)) {
                break;
            }
        }
        let Some((_, coefficients)) = best else {
            return Err(Infeasible::NoProgress { sample: self.first });
        };
        plan.law
            .pieces
            .extend(spline.law(self, &coefficients).pieces);
        Ok(())
    }

    fn channels(&self, interval: usize, mut each: impl FnMut(Channel)) {
        for limit in self.limits {
            limit.channels(self.samples, self.first + interval, &mut each);
        }
    }

    /// The rows of every interval of the spline, divided by their limits.
    fn rules(&self, spline: &Spline) -> (Vec<Rule>, Vec<usize>) {
        let mut rules = Vec::new();
        let mut offsets = vec![0];
        for interval in 0..spline.intervals() {
            if spline.is_spline(interval) {
                let step = self.problem.steps[self.first + interval];
                let into = spline.bernstein(interval);
                self.channels(interval, |channel| {
                    let share = 1.0 / channel.limit;
                    match channel.order {
                        Order::Acceleration => {
                            rules.extend(forms::acceleration(&channel, step).map(|form| Rule {
                                form: composed(form, into).map(|value| value * share),
                                q: None,
                            }));
                        }
                        Order::Jerk => {
                            let rows = forms::jerk(&channel, step).into_iter().zip(forms::Q);
                            rules.extend(rows.map(|(form, q)| Rule {
                                form: composed(form, into).map(|value| value * share),
                                q: Some(composed(q, into)),
                            }));
                        }
                    }
                });
            }
            offsets.push(rules.len());
        }
        (rules, offsets)
    }

    /// Bounds `q` behind the first interval and before the last, where they are at rest.
    fn cap_ends(&self, spline: &Spline, scale: &[f64], bounds: &mut [[f64; 2]]) {
        let last = spline.intervals() - 1;
        for (interval, neighbour) in [(0, 2), (last, last)] {
            if spline.is_spline(interval) {
                continue;
            }
            let step = self.problem.steps[self.first + interval];
            let mut most = f64::INFINITY;
            self.channels(interval, |channel| {
                let channel = if interval == 0 {
                    channel
                } else {
                    forms::reversed(&channel)
                };
                most = most.min(match channel.order {
                    Order::Acceleration => {
                        channel.limit / forms::leaving_acceleration(&channel, step)
                    }
                    Order::Jerk => {
                        let root = libm::cbrt(channel.limit / forms::leaving_jerk(&channel, step));
                        root * root
                    }
                });
            });
            // `q` there is this part of the one coefficient beside it.
            let [here, next] = [spline.widths[interval + 1], spline.widths[neighbour]];
            let most = most * (here + next) / here;
            bounds[neighbour][1] = bounds[neighbour][1].min(most / scale[neighbour]);
        }
    }
}

/// The program of one round.
fn program(
    spline: &Spline,
    scale: &[f64],
    bounds: &[[f64; 2]],
    rules: &[Rule],
    offsets: &[usize],
    tangents: &[f64],
) -> Program<3> {
    let mut program = Program {
        cost: Cost::Time,
        weights: spline.weights(scale),
        lower: bounds.iter().map(|bound| bound[0]).collect(),
        upper: bounds.iter().map(|bound| bound[1]).collect(),
        offsets: vec![0],
        rows: Vec::with_capacity(2 * rules.len()),
    };
    for interval in 0..spline.intervals() {
        let tangent = tangents[interval + 1];
        for rule in &rules[offsets[interval]..offsets[interval + 1]] {
            for side in [1.0, -1.0] {
                let (a, most): (Form, f64) = match rule.q {
                    None => (rule.form.map(|value| side * value), 1.0),
                    Some(q) => {
                        let root = tangent.sqrt();
                        let mix = |k: usize| side * root * rule.form[k] + 0.5 * q[k] / tangent;
                        (std::array::from_fn(mix), 1.5)
                    }
                };
                push(&mut program, interval, a, most, scale);
            }
        }
        program.offsets.push(program.rows.len());
    }
    program
}

/// Scales a row, takes what is fixed out of it, and leaves it away if nothing is left.
fn push(program: &mut Program<3>, first: usize, mut a: Form, mut most: f64, scale: &[f64]) {
    for (k, a) in a.iter_mut().enumerate() {
        *a *= scale[first + k];
        if program.upper[first + k] <= program.lower[first + k] {
            most -= *a * program.lower[first + k];
            *a = 0.0;
        }
    }
    let size = a.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    if size > 0.0 {
        program.rows.push(Inequality {
            a: a.map(|value| value / size),
            most: most / size,
        });
    }
}

/// Makes everything slower by so much as an iteration's tolerance may have left a row broken.
fn keep(program: &Program<3>, x: &mut [f64]) {
    let mut share: f64 = 1.0;
    for (first, range) in program.offsets.windows(2).enumerate() {
        for row in &program.rows[range[0]..range[1]] {
            let value: f64 = row.a.iter().zip(&x[first..]).map(|(a, x)| a * x).sum();
            if value > row.most && row.most > 0.0 {
                share = share.min(row.most / value);
            }
        }
    }
    if share < 1.0 {
        for (unknown, x) in x.iter_mut().enumerate() {
            if program.upper[unknown] > program.lower[unknown] {
                *x *= share * (1.0 - 1e-15);
            }
        }
    }
}

/// A form in Bernstein coefficients as one in those of the spline.
fn composed(form: Form, into: [Form; 3]) -> Form {
    std::array::from_fn(|k| (0..3).map(|b| form[b] * into[b][k]).sum())
}

/// The spline's coefficients: one an interval, and one fixed before and behind them.
struct Spline {
    /// Lengths of the intervals, as far as the spline is concerned; those before and behind have none.
    widths: Vec<f64>,
    /// Whether the stretch begins and ends at rest.
    rest: [bool; 2],
    /// The speeds that it begins and ends with.
    ends: [f64; 2],
}

impl Spline {
    fn new(stretch: &Stretch<'_>) -> Self {
        let problem = stretch.problem;
        let mut widths = vec![0.0];
        widths.extend_from_slice(&problem.steps[stretch.first..stretch.last]);
        widths.push(0.0);
        let whole = [stretch.first == 0, stretch.last == problem.steps.len()];
        let ends = [
            if whole[0] { problem.ends.start } else { 0.0 },
            if whole[1] { problem.ends.end } else { 0.0 },
        ];
        let rest = ends.map(|q| q == 0.0);
        let last = widths.len() - 2;
        for (at, rest) in [(1, rest[0]), (last, rest[1])] {
            if rest {
                // Joins `share^(4/3)` with value and slope.
                widths[at] *= 1.5;
            }
        }
        Self { widths, rest, ends }
    }

    fn intervals(&self) -> usize {
        self.widths.len() - 2
    }

    /// Whether an interval is part of the spline, or leaves rest or goes to it.
    fn is_spline(&self, interval: usize) -> bool {
        let first = interval == 0 && self.rest[0];
        let last = interval + 1 == self.intervals() && self.rest[1];
        !first && !last
    }

    /// The Bernstein coefficients of an interval in the three coefficients that begin with the one of its number.
    fn bernstein(&self, interval: usize) -> [Form; 3] {
        let [before, here, next] = [0, 1, 2].map(|k| self.widths[interval + k]);
        [
            [here / (before + here), before / (before + here), 0.0],
            [0.0, 1.0, 0.0],
            [0.0, next / (here + next), here / (here + next)],
        ]
    }

    /// Of each coefficient: what reachability analysis has there.
    fn scale(&self, stretch: &Stretch<'_>) -> Vec<f64> {
        let fast = &stretch.fast[stretch.first..=stretch.last];
        let most = fast.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut scale = vec![most];
        scale.extend(
            fast.windows(2)
                .map(|pair| (0.5 * (pair[0] + pair[1])).max(1e-9 * most)),
        );
        scale.push(most);
        scale
    }

    /// Least and largest value of each scaled coefficient. Below the bounds of both its samples a coefficient keeps
    /// the spline below the line from bound to bound, between samples too.
    fn bounds(&self, stretch: &Stretch<'_>, scale: &[f64]) -> Vec<[f64; 2]> {
        let upper = &stretch.problem.upper[stretch.first..=stretch.last];
        let fixed = |q: f64, at: usize| [q / scale[at]; 2];
        let mut bounds = vec![fixed(self.ends[0], 0)];
        for (interval, pair) in upper.windows(2).enumerate() {
            let at = interval + 1;
            let most = (pair[0].min(pair[1]) / scale[at]).min(ABOVE);
            bounds.push([0.0, most]);
        }
        let last = self.intervals();
        bounds.push(fixed(self.ends[1], last + 1));
        // At rest, or with the given speed and no acceleration.
        bounds[1] = fixed(self.ends[0], 1);
        bounds[last] = fixed(self.ends[1], last);
        bounds
    }

    /// The integral of each coefficient's basis function, for `1 / sqrt(scaled coefficient)`.
    fn weights(&self, scale: &[f64]) -> Vec<f64> {
        let count = self.widths.len();
        let weight = |at: usize| {
            let around = at.saturating_sub(1)..(at + 2).min(count);
            self.widths[around].iter().sum::<f64>() / 3.0 / scale[at].sqrt()
        };
        let mut weights: Vec<f64> = (0..count).map(weight).collect();
        let most = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        weights.iter_mut().for_each(|weight| *weight /= most);
        weights
    }

    fn law(&self, stretch: &Stretch<'_>, coefficients: &[f64]) -> Law {
        let value = |form: Form, interval: usize| -> f64 {
            form.iter()
                .zip(&coefficients[interval..])
                .map(|(a, x)| a * x)
                .sum()
        };
        let last = self.intervals() - 1;
        let piece = |interval: usize| {
            if self.is_spline(interval) {
                Piece::Quadratic(self.bernstein(interval).map(|form| value(form, interval)))
            } else if interval == 0 {
                Piece::Leave(value(self.bernstein(0)[2], 0))
            } else {
                Piece::Arrive(value(self.bernstein(last)[0], last))
            }
        };
        Law {
            steps: stretch.problem.steps[stretch.first..stretch.last].to_vec(),
            pieces: (0..=last).map(piece).collect(),
        }
    }
}
