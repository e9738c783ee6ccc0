//! An interior-point method for programs whose constraints tie neighbours only: Mehrotra's predictor-corrector with a
//! banded normal matrix, so that an iteration costs a time linear in the number of unknowns.
//!
//! Minimise a separable convex cost under `lower <= x <= upper` and rows `Σ a[k] * x[first + k] <= most` of `K`
//! neighbours. Each Newton step eliminates slacks and multipliers; what is left is a matrix of `2 K - 1` diagonals
//! (Mehrotra, *On the implementation of a primal-dual interior point method*, 1992; Wright, *Primal-Dual
//! Interior-Point Methods*, 1997).

pub(crate) mod band;

use band::Band;

/// Largest number of iterations; a program that is scaled well needs some twenty.
const ITERATIONS: usize = 120;

/// A step stays this much short of the boundary.
const SHORT: f64 = 0.995;

/// `Σ a[k] * x[first + k] <= most`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inequality<const K: usize> {
    pub(crate) a: [f64; K],
    pub(crate) most: f64,
}

/// What is to be small, unknown by unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cost {
    /// `-weight * x`.
    Linear,
    /// `weight / sqrt(x)`: the time over a length where `x` is the squared speed.
    Time,
}

impl Cost {
    /// Slope and second derivative at `x`.
    fn slope(self, weight: f64, x: f64) -> [f64; 2] {
        match self {
            Self::Linear => [-weight, 0.0],
            Self::Time => {
                let slope = 0.5 * weight / (x * x.sqrt());
                [-slope, 1.5 * slope / x]
            }
        }
    }
}

/// A program. All numbers are expected to be scaled: unknowns and coefficients of rows of the order of 1.
#[derive(Clone, Debug)]
pub(crate) struct ConvexProgram<const K: usize> {
    pub(crate) cost: Cost,
    pub(crate) weights: Vec<f64>,
    pub(crate) lower: Vec<f64>,
    /// Where it is not above `lower` the unknown is fixed; no row may have a coefficient for it.
    pub(crate) upper: Vec<f64>,
    /// The rows whose first unknown is `i` are `offsets[i]..offsets[i + 1]`.
    pub(crate) offsets: Vec<usize>,
    pub(crate) rows: Vec<Inequality<K>>,
}

/// What the iteration ended with.
#[derive(Clone, Debug, Default)]
pub(crate) struct IterationResult {
    pub(crate) x: Vec<f64>,
    /// Multipliers of the rows.
    pub(crate) multipliers: Vec<f64>,
    pub(crate) iterations: usize,
    /// Whether it ended because the tolerance was met.
    pub(crate) converged: bool,
}

/// Slack and multiplier of one constraint, and their steps.
#[derive(Clone, Copy, Debug, Default)]
struct SlackPair {
    s: f64,
    z: f64,
    ds: f64,
    dz: f64,
}

impl SlackPair {
    /// Steps for the target `s * z -> s * z - target`, after `slide`, the change of the slack.
    fn turn(&mut self, slide: f64, target: f64) {
        self.ds = slide;
        self.dz = -(target + self.z * slide) / self.s;
    }

    /// The target of the corrector.
    fn correction(self, centre: f64) -> f64 {
        self.s * self.z + self.ds * self.dz - centre
    }
}

/// How far a step may go until a slack or a multiplier is 0, and what products would be left.
#[derive(Clone, Copy)]
struct StepRoom {
    primal: f64,
    dual: f64,
}

impl StepRoom {
    fn meet(&mut self, pair: &SlackPair) {
        if pair.ds < 0.0 {
            self.primal = self.primal.min(-pair.s / pair.ds);
        }
        if pair.dz < 0.0 {
            self.dual = self.dual.min(-pair.z / pair.dz);
        }
    }
}

struct IterationState<'a, const K: usize> {
    program: &'a ConvexProgram<K>,
    x: Vec<f64>,
    dx: Vec<f64>,
    rows: Vec<SlackPair>,
    low: Vec<SlackPair>,
    high: Vec<SlackPair>,
    /// `a x + s - most` of each row.
    miss: Vec<f64>,
    /// Gradient of the Lagrangian.
    dual: Vec<f64>,
    band: Band<K>,
}

impl<const K: usize> ConvexProgram<K> {
    /// The best `x`, from a start between the bounds; it need not keep the rows. `tolerance` is that of the gap
    /// between cost and bound, as a share of the cost.
    pub(crate) fn minimise(&self, start: &[f64], tolerance: f64) -> IterationResult {
        let mut state = IterationState::new(self, start);
        let mut solution = IterationResult::default();
        while solution.iterations < ITERATIONS {
            let measure = state.measure();
            if measure.done(tolerance) {
                solution.converged = true;
                break;
            }
            if !measure.gap.is_finite() {
                break;
            }
            state.step(measure.gap);
            solution.iterations += 1;
        }
        solution.multipliers = state.rows.iter().map(|pair| pair.z).collect();
        solution.x = state.x;
        solution
    }

    /// A proven lower bound on a linear cost: whatever multipliers are given, every `x` between the bounds that keeps
    /// the rows costs at least this.
    pub(crate) fn bound(&self, multipliers: &[f64]) -> f64 {
        let mut slope: Vec<f64> = self.weights.iter().map(|weight| -weight).collect();
        let mut bound = 0.0;
        for (first, rows) in self.offsets.windows(2).enumerate() {
            let range = rows[0]..rows[1];
            for (row, multiplier) in self.rows[range.clone()].iter().zip(&multipliers[range]) {
                let multiplier = multiplier.max(0.0);
                bound -= multiplier * row.most;
                for (slope, a) in slope[first..].iter_mut().zip(row.a) {
                    *slope += multiplier * a;
                }
            }
        }
        let ends = self.lower.iter().zip(&self.upper);
        let each = slope.iter().zip(ends);
        bound + each.map(|(slope, (low, high))| (slope * low).min(slope * high)).sum::<f64>()
    }

    fn fixed(&self, unknown: usize) -> bool {
        self.upper[unknown] <= self.lower[unknown]
    }
}

/// How far from the optimum.
struct Measure {
    /// Sum of the products of slacks and multipliers.
    gap: f64,
    cost: f64,
    /// Largest amount by which a row is missed.
    primal: f64,
    /// Largest amount by which the cost could be off for want of a gradient that is 0.
    dual: f64,
}

impl Measure {
    fn done(&self, tolerance: f64) -> bool {
        let small = tolerance * self.cost.max(1e-3);
        // Far below the tolerance only rounding is left of the residuals.
        self.primal <= 1e-9 && self.gap <= small && (self.dual <= small || self.gap <= 1e-3 * small)
    }
}

impl<'a, const K: usize> IterationState<'a, K> {
    fn new(program: &'a ConvexProgram<K>, start: &[f64]) -> Self {
        let count = start.len();
        let centre = 0.1;
        let pair = |s: f64| SlackPair { s, z: centre / s, ..SlackPair::default() };
        let mut rows = Vec::with_capacity(program.rows.len());
        for (first, range) in program.offsets.windows(2).enumerate() {
            for row in &program.rows[range[0]..range[1]] {
                let value = combine(&row.a, &start[first..]);
                let floor = 1e-2 * row.most.abs().max(1e-6);
                rows.push(pair((row.most - value).max(floor)));
            }
        }
        let side = |bound: &[f64], sign: f64| -> Vec<SlackPair> {
            let ends = bound.iter().zip(start);
            ends.map(|(bound, x)| pair((sign * (bound - x)).max(1e-9))).collect()
        };
        Self {
            program,
            x: start.to_vec(),
            dx: vec![0.0; count],
            miss: vec![0.0; rows.len()],
            rows,
            low: side(&program.lower, -1.0),
            high: side(&program.upper, 1.0),
            dual: vec![0.0; count],
            band: Band::default(),
        }
    }

    /// Residuals, and the normal matrix of this point, factored.
    fn measure(&mut self) -> Measure {
        let program = self.program;
        let mut measure = Measure { gap: 0.0, cost: 0.0, primal: 0.0, dual: 0.0 };
        self.band.reset(self.x.len());
        for unknown in 0..self.x.len() {
            if program.fixed(unknown) {
                self.dual[unknown] = 0.0;
                self.band.rows[unknown][0] = 1.0;
                continue;
            }
            let x = self.x[unknown];
            let weight = program.weights[unknown];
            let [slope, bend] = program.cost.slope(weight, x);
            measure.cost += match program.cost {
                Cost::Linear => weight * x,
                Cost::Time => weight / x.sqrt(),
            };
            let (low, high) = (&mut self.low[unknown], &mut self.high[unknown]);
            low.s = x - program.lower[unknown];
            high.s = program.upper[unknown] - x;
            measure.gap += low.s * low.z + high.s * high.z;
            self.dual[unknown] = slope - low.z + high.z;
            self.band.rows[unknown][0] = bend + low.z / low.s + high.z / high.s;
        }
        for (first, range) in program.offsets.windows(2).enumerate() {
            for index in range[0]..range[1] {
                let Inequality { a, most } = program.rows[index];
                let pair = self.rows[index];
                let miss = combine(&a, &self.x[first..]) + pair.s - most;
                self.miss[index] = miss;
                measure.primal = measure.primal.max(miss.abs());
                measure.gap += pair.s * pair.z;
                let ratio = pair.z / pair.s;
                for k in 0..K {
                    self.dual[first + k] += a[k] * pair.z;
                    let scaled = ratio * a[k];
                    let entries = self.band.rows[first + k].iter_mut();
                    for (entry, a) in entries.zip(&a[k..]) {
                        *entry += scaled * a;
                    }
                }
            }
        }
        self.band.factor();
        let ends = program.lower.iter().zip(&program.upper);
        let each = self.dual.iter().zip(ends);
        measure.dual = each.map(|(slope, (low, high))| slope.abs() * (high - low)).sum();
        measure.cost = measure.cost.abs();
        measure
    }

    /// One predictor and corrector.
    fn step(&mut self, gap: f64) {
        let count = self.rows.len() + 2 * self.x.len();
        let mean = gap / count as f64;
        let affine = self.direction(None);
        let left = self.products(affine);
        let share = (left / gap).clamp(0.0, 1.0);
        let centre = share * share * share * mean;
        let mut room = self.direction(Some(centre));
        if self.program.cost != Cost::Linear {
            // A curved cost ties both steps together.
            let both = room.primal.min(room.dual);
            room = StepRoom { primal: both, dual: both };
        }
        let primal = (SHORT * room.primal).min(1.0);
        let dual = (SHORT * room.dual).min(1.0);
        for (x, dx) in self.x.iter_mut().zip(&self.dx) {
            *x += primal * dx;
        }
        let pairs = self.low.iter_mut().chain(&mut self.high);
        for pair in pairs.chain(&mut self.rows) {
            pair.s += primal * pair.ds;
            pair.z += dual * pair.dz;
        }
    }

    /// Solves for the steps towards `s * z = 0`, or with the correction of second order towards `centre`.
    fn direction(&mut self, centre: Option<f64>) -> StepRoom {
        let program = self.program;
        let target = |pair: SlackPair| match centre {
            Some(centre) => pair.correction(centre),
            None => pair.s * pair.z,
        };
        for unknown in 0..self.x.len() {
            let (low, high) = (self.low[unknown], self.high[unknown]);
            self.dx[unknown] = if program.fixed(unknown) {
                0.0
            } else {
                -self.dual[unknown] - target(low) / low.s + target(high) / high.s
            };
        }
        for (first, range) in program.offsets.windows(2).enumerate() {
            for index in range[0]..range[1] {
                let pair = self.rows[index];
                let push = (target(pair) - pair.z * self.miss[index]) / pair.s;
                for (dx, a) in self.dx[first..].iter_mut().zip(program.rows[index].a) {
                    *dx += a * push;
                }
            }
        }
        self.band.solve(&mut self.dx);
        let mut room = StepRoom { primal: f64::INFINITY, dual: f64::INFINITY };
        for unknown in 0..self.x.len() {
            let dx = self.dx[unknown];
            if program.fixed(unknown) {
                continue;
            }
            for (pair, slide) in [(&mut self.low[unknown], dx), (&mut self.high[unknown], -dx)] {
                let goal = target(*pair);
                pair.turn(slide, goal);
                room.meet(pair);
            }
        }
        for (first, range) in program.offsets.windows(2).enumerate() {
            for index in range[0]..range[1] {
                let pair = &mut self.rows[index];
                let goal = target(*pair);
                let slide = -self.miss[index] - combine(&program.rows[index].a, &self.dx[first..]);
                pair.turn(slide, goal);
                room.meet(pair);
            }
        }
        room
    }

    /// The sum of products after a step as far as it goes.
    fn products(&self, room: StepRoom) -> f64 {
        let (primal, dual) = (room.primal.min(1.0), room.dual.min(1.0));
        let product = |pair: &SlackPair| (pair.s + primal * pair.ds) * (pair.z + dual * pair.dz);
        let free = (0..self.x.len()).filter(|&unknown| !self.program.fixed(unknown));
        let bounds = free.map(|unknown| product(&self.low[unknown]) + product(&self.high[unknown]));
        bounds.sum::<f64>() + self.rows.iter().map(product).sum::<f64>()
    }
}

fn combine<const K: usize>(a: &[f64; K], x: &[f64]) -> f64 {
    a.iter().zip(x).map(|(a, x)| a * x).sum()
}
