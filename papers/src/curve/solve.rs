//! Plans of the stretches of a path, by the solver that is asked for.

use post_feed::limits::Limit;
use post_feed::problem::LimitSource;
use post_feed::{
    EndSpeeds, FeedSpline, Infeasible, Problem, Samples, jerk, linear_program, profile, reach,
};
use post_machine::diagnostic::{Diagnostic, Short};
use post_posting::plan::axis_name;
use serde::Serialize;

use super::path::CurvePath;

/// Every stretch has so many steps at least: with limits of jerk fewer are none.
const LEAST_STEPS: usize = 8;

/// What plans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SolverChoice {
    /// Reachability analysis.
    Reach,
    /// The paper's linear program, by an interior point.
    Interior,
    /// With limits of jerk.
    Jerk,
}

/// How finely, and with which feeds at the ends, mm/s.
#[derive(Clone, Copy, Debug)]
pub struct SolverRequest {
    pub solver: SolverChoice,
    /// About so many samples.
    pub samples: usize,
    pub start_feed: f64,
    pub end_feed: f64,
}

/// A stretch with its plan.
pub struct StretchPlan {
    pub parameters: Vec<f64>,
    pub spline: FeedSpline,
}

/// What a solver came to.
#[derive(Clone, Debug, Serialize)]
pub struct SolverFound {
    pub solver: SolverChoice,
    /// `Σ f²` over the samples, mm²/s².
    pub sum_of_squared_feeds: f64,
    pub seconds: f64,
    /// By how much of itself `Σ f²` can be below the largest one at most, proven by multipliers; none: it is not the
    /// aim of this solver.
    pub proven_gap: Option<f64>,
    pub iterations: Option<usize>,
    /// The largest difference of a feed to that of reachability analysis, as a share of it.
    pub largest_difference: f64,
}

/// Plans of all stretches.
pub struct Plans {
    pub stretches: Vec<StretchPlan>,
    /// What each solver came to, the one that was asked for first.
    pub solvers: Vec<SolverFound>,
    /// No larger feed at a sample ever forbids a larger one at the next: then both optima are the same.
    pub monotone: bool,
    pub samples: usize,
}

/// One stretch by one solver.
struct Answer {
    q: Vec<f64>,
    spline: Option<FeedSpline>,
    seconds: f64,
    bound: Option<f64>,
    iterations: Option<usize>,
}

impl Answer {
    /// Of `q` alone.
    fn of(problem: &Problem, q: Vec<f64>) -> Self {
        Self {
            seconds: profile::duration(&problem.steps, &q),
            q,
            spline: None,
            bound: None,
            iterations: None,
        }
    }
}

/// The sums over the stretches, as they grow.
struct Sums {
    solver: SolverChoice,
    objective: f64,
    bound: Option<f64>,
    seconds: f64,
    iterations: Option<usize>,
    difference: f64,
}

impl Sums {
    /// Of no stretch yet.
    fn of(solver: SolverChoice) -> Self {
        Self {
            solver,
            objective: 0.0,
            bound: None,
            seconds: 0.0,
            iterations: None,
            difference: 0.0,
        }
    }

    /// Adds a stretch.
    fn add(&mut self, answer: &Answer, stretch: &StretchProblem<'_>) {
        let StretchProblem { problem, weights, fast, .. } = stretch;
        let objective: f64 = answer.q.iter().zip(weights).map(|(q, weight)| q * weight).sum();
        self.objective += objective;
        self.seconds += answer.seconds;
        // A stretch without a bound leaves the whole without.
        self.bound = answer.bound.map(|bound| self.bound.unwrap_or(0.0) + bound);
        self.iterations = answer.iterations.map(|more| self.iterations.unwrap_or(0) + more);
        for ((q, fast), upper) in answer.q.iter().zip(fast).zip(&problem.upper) {
            let size = fast.max(1e-6 * upper);
            if size > 0.0 {
                let difference = (q.sqrt() - fast.sqrt()).abs() / size.sqrt();
                self.difference = self.difference.max(difference);
            }
        }
    }

    /// What the solver came to.
    fn found(self) -> SolverFound {
        let gap = |bound: f64| ((bound - self.objective) / bound).max(0.0);
        SolverFound {
            solver: self.solver,
            sum_of_squared_feeds: self.objective,
            seconds: self.seconds,
            proven_gap: self.bound.map(gap),
            iterations: self.iterations,
            largest_difference: self.difference,
        }
    }
}

/// A stretch as a problem, and the plan of reachability analysis.
struct StretchProblem<'a> {
    parameters: &'a [f64],
    told: NoPlanContext<'a>,
    problem: Problem,
    /// Of the squared speeds in `Σ f²`.
    weights: Vec<f64>,
    fast: Vec<f64>,
}

impl<'a> StretchProblem<'a> {
    fn new(
        parameters: &'a [f64],
        told: NoPlanContext<'a>,
        ends: EndSpeeds,
    ) -> Result<Self, Box<Diagnostic>> {
        let mut problem = Problem::default();
        let made = problem.refill(told.samples, told.limits, ends);
        made.map_err(|fault| told.infeasible(&fault))?;
        let weights = told.samples.squared_feed_weights();
        let fast = reach::solve(&problem).map_err(|fault| told.infeasible(&fault))?;
        Ok(Self { parameters, told, problem, weights, fast })
    }

    /// Its plan by one solver.
    fn answer(&self, solver: SolverChoice) -> Result<Answer, Box<Diagnostic>> {
        let Self { parameters, told, problem, weights, fast } = self;
        Ok(match solver {
            SolverChoice::Reach => Answer::of(problem, fast.clone()),
            SolverChoice::Interior => {
                let best = linear_program::solve(problem, weights);
                let best = best.map_err(|fault| told.infeasible(&fault))?;
                Answer {
                    bound: Some(best.bound),
                    iterations: Some(best.iterations),
                    ..Answer::of(problem, best.q)
                }
            }
            SolverChoice::Jerk => {
                let settings = jerk::JerkSettings::default();
                let plan = jerk::solve(told.samples, told.limits, problem, settings);
                let plan = plan.map_err(|fault| told.infeasible(&fault))?;
                Answer {
                    q: plan.law.q(),
                    seconds: plan.seconds,
                    spline: Some(FeedSpline::of_law(parameters, &plan.law)),
                    bound: None,
                    iterations: Some(plan.iterations),
                }
            }
        })
    }
}

/// Plans every stretch of `path`, which stops between them, with the largest feed of the tip in mm/s.
///
/// # Errors
/// Which limit cannot be kept, and where; axes that cannot follow the path.
pub fn plan(
    path: &mut CurvePath<'_>,
    feed: f64,
    asked: SolverRequest,
    file: &str,
) -> Result<Plans, Box<Diagnostic>> {
    let owned = post_posting::plan::limits(path.machine, &path.machine.plan);
    let limits: Vec<&dyn Limit> = owned.iter().map(Box::as_ref).collect();
    let spans = path.stretches.iter().map(|stretch| stretch.tip.breaks().len() - 1);
    let steps = asked.samples.div_ceil(spans.sum::<usize>()).max(4);
    let last = path.stretches.len() - 1;
    let mut plans =
        Plans { stretches: Vec::new(), solvers: Vec::new(), monotone: true, samples: 0 };
    let solvers: &[SolverChoice] = match asked.solver {
        SolverChoice::Reach => &[SolverChoice::Reach],
        SolverChoice::Jerk => &[SolverChoice::Jerk, SolverChoice::Reach],
        SolverChoice::Interior => &[SolverChoice::Interior, SolverChoice::Reach],
    };
    let mut sums: Vec<Sums> = solvers.iter().copied().map(Sums::of).collect();
    let mut way = 0.0;
    for index in 0..=last {
        let parameters = parameters(path, index, steps);
        let guided = path.guide(index, &parameters);
        guided.map_err(|(at, why)| path.refused(file, at, &why).boxed())?;
        let samples = path.samples(index, &parameters, feed);
        let samples = samples.map_err(|(at, why)| path.refused(file, at, &why).boxed())?;
        let told = NoPlanContext { path, index, samples: &samples, limits: &limits, way, file };
        let ends = end_speeds(asked, &samples, [index == 0, index == last]);
        let stretch = StretchProblem::new(&parameters, told, ends)?;
        plans.monotone &= stretch.problem.rows.iter().all(|row| row.here * row.next <= 0.0);
        let mut spline = None;
        for sum in &mut sums {
            let answer = stretch.answer(sum.solver)?;
            sum.add(&answer, &stretch);
            if sum.solver == asked.solver {
                let rounded = || FeedSpline::rounded(&parameters, &answer.q);
                spline = Some(answer.spline.unwrap_or_else(rounded));
            }
        }
        way += length(&samples, samples.len() - 1);
        plans.samples += samples.len();
        plans.stretches.push(StretchPlan { parameters, spline: spline.unwrap_or_default() });
    }
    plans.solvers = sums.into_iter().map(Sums::found).collect();
    Ok(plans)
}

/// Squared speeds of the parameter at both ends of a stretch: at rest but for the ends of the path, where feeds are given.
fn end_speeds(asked: SolverRequest, samples: &Samples, [first, last]: [bool; 2]) -> EndSpeeds {
    let speed = |feed: f64, sample: usize| {
        let speed = feed / samples.stretch(sample);
        if feed > 0.0 { speed * speed } else { 0.0 }
    };
    EndSpeeds {
        start: if first { speed(asked.start_feed, 0) } else { 0.0 },
        end: if last { speed(asked.end_feed, samples.len() - 1) } else { 0.0 },
    }
}

/// The knots of a stretch, and so many even steps between each and the next: third derivatives jump at knots.
fn parameters(path: &CurvePath<'_>, index: usize, steps: usize) -> Vec<f64> {
    let breaks = path.stretches[index].tip.breaks();
    let steps = steps.max(LEAST_STEPS.div_ceil(breaks.len() - 1));
    let mut all = vec![breaks[0]];
    for pair in breaks.windows(2) {
        let at = |step: usize| match step == steps {
            true => pair[1],
            false => pair[0] + (pair[1] - pair[0]) * step as f64 / steps as f64,
        };
        all.extend((1..=steps).map(at));
    }
    all
}

/// Length of the tip's path up to a sample, mm.
fn length(samples: &Samples, last: usize) -> f64 {
    let each = (0..last).map(|interval| {
        let ends = samples.stretch(interval) + samples.stretch(interval + 1);
        0.5 * samples.step(interval) * ends
    });
    each.sum()
}

/// What is needed to tell why there is no plan.
struct NoPlanContext<'a> {
    path: &'a CurvePath<'a>,
    index: usize,
    samples: &'a Samples,
    limits: &'a [&'a dyn Limit],
    /// Of the tip up to the stretch, mm.
    way: f64,
    file: &'a str,
}

impl NoPlanContext<'_> {
    fn infeasible(&self, fault: &Infeasible) -> Box<Diagnostic> {
        let Some(sample) = fault.sample() else {
            let message = format!("{}: {fault}", self.file);
            return Diagnostic::error("infeasible", message).boxed();
        };
        let sample = sample.min(self.samples.len() - 1);
        let parameter = self.samples.parameter[sample];
        let tip = self.path.stretches[self.index].tip.derivatives(parameter)[0];
        let place = format!(
            "at parameter {}, {} mm along the path, at X {} Y {} Z {}",
            Short(parameter),
            Short(self.way + length(self.samples, sample)),
            Short(tip[0]),
            Short(tip[1]),
            Short(tip[2])
        );
        let feed = |q: f64| Short(60.0 * q.sqrt() * self.samples.stretch(sample));
        let by = |row: Option<LimitSource>| match row {
            Some(source) => format!(" ({} allows no more)", self.limit(source)),
            None => String::new(),
        };
        let (message, help) = match *fault {
            Infeasible::TooFastStart { source, needed, allowed, braking, .. } => (
                format!(
                    "the start is too fast: by the hardest braking{} the feed is still {} mm/min {place}, and {} allows {}",
                    by(braking),
                    feed(needed),
                    self.limit(source),
                    feed(allowed)
                ),
                "a smaller --start-feed",
            ),
            Infeasible::OutOfReach { source, needed, allowed, accelerating, .. } => (
                format!(
                    "the end is too fast: to reach its feed, that {place} would have to be {} mm/min{}, and {} allows {}",
                    feed(needed),
                    by(accelerating),
                    self.limit(source),
                    feed(allowed)
                ),
                "a smaller --end-feed",
            ),
            Infeasible::Contradiction { source, .. } => (
                format!(
                    "the limits contradict each other {place}, among them {}",
                    self.limit(source)
                ),
                "a larger limit, or a smaller --start-feed or --end-feed",
            ),
            Infeasible::NotANumber { source, .. } => (
                format!("{} is no limit {place}: not finite, or negative", self.limit(source)),
                "the path may have a cusp there",
            ),
            Infeasible::Unbounded { .. } => {
                (format!("no limit bounds the feed {place}"), "--feed is the largest feed")
            }
            Infeasible::TooShort { .. } => (
                format!("a plan with jerk needs four samples or more between two stops: {place}"),
                "more --samples",
            ),
            Infeasible::NoProgress { .. } => (
                format!("no plan with limits of jerk was found on the stretch that begins {place}"),
                "limits that are not so far apart, or more --samples",
            ),
            _ => (format!("{fault}: {place}"), ""),
        };
        let finding = Diagnostic::error("infeasible", format!("{}: {message}", self.file));
        match help {
            "" => finding.boxed(),
            help => finding.help(help).boxed(),
        }
    }

    /// `axis acceleration of Y`.
    fn limit(&self, source: LimitSource) -> String {
        let limit = self.limits.get(usize::from(source.limit));
        let name = limit.map_or("a limit", |limit| limit.name());
        match source.axis {
            Some(axis) => format!("{name} of {}", axis_name(self.path.machine, axis)),
            None => name.to_owned(),
        }
    }
}
