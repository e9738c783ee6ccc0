//! What finds the fastest feed along samples: with jerk limits or without.

use post_feed::jerk::{self, PathBatch};
use post_feed::problem::LimitSource;
use post_feed::reach::{self, stream::Settled};
use post_feed::{Infeasible, Problem};
use post_machine::description::PlanSolver;

/// Samples that are looked ahead at least.
const LOOK_AHEAD: usize = 1024;

/// Look-ahead for jerk, whose windows cost far more.
const LOOK_AHEAD_FOR_JERK: usize = 256;

/// A sample whose speed is settled.
#[derive(Clone, Copy, Debug)]
pub(super) struct SettledSample {
    /// Squared speed of the parameter.
    pub q: f64,
    /// Squared speed halfway from the sample before, where that is not halfway between the two.
    pub halfway: Option<f64>,
    /// Time from the sample before, s; none where the squared speed is linear.
    pub seconds: Option<f64>,
    /// The limit that is used most.
    pub source: LimitSource,
}

/// The solver of a line.
#[derive(Debug)]
pub(super) enum SampleSolver {
    /// Velocity, acceleration and errors.
    Reach(Box<reach::ReachStream>),
    /// Jerk too.
    Jerk {
        stream: Box<jerk::JerkStream>,
        /// The first sample of the path was handed on.
        begun: bool,
    },
}

impl SampleSolver {
    /// Makes the solver for problems of `stride` rows an interval.
    pub(super) fn new(asked: PlanSolver, stride: usize) -> Self {
        match asked {
            PlanSolver::Reach => Self::Reach(Box::new(reach::ReachStream::new(stride, LOOK_AHEAD))),
            PlanSolver::Jerk => Self::Jerk {
                stream: Box::new(jerk::JerkStream::new(
                    LOOK_AHEAD_FOR_JERK,
                    jerk::JerkSettings::default(),
                )),
                begun: false,
            },
        }
    }

    /// The path goes on.
    pub(super) fn push(
        &mut self,
        batch: PathBatch<'_>,
        sink: &mut dyn FnMut(SettledSample),
    ) -> Result<(), Infeasible> {
        match self {
            Self::Reach(stream) => push(stream, batch.problem, sink),
            Self::Jerk { stream, begun } => {
                stream.push(batch, &mut |passed| handed_on(&passed, begun, sink))
            }
        }
    }

    /// The path ends at rest.
    pub(super) fn finish(&mut self, sink: &mut dyn FnMut(SettledSample)) -> Result<(), Infeasible> {
        match self {
            Self::Reach(stream) => stream.finish(0.0, &mut |settled| sink(step(&settled))),
            Self::Jerk { stream, begun } => {
                let found = stream.finish(0.0, &mut |passed| handed_on(&passed, begun, sink));
                *begun = false;
                found
            }
        }
    }

    /// Forgets the path.
    pub(super) fn clear(&mut self) {
        match self {
            Self::Reach(stream) => stream.clear(),
            Self::Jerk { stream, begun } => {
                stream.clear();
                *begun = false;
            }
        }
    }

    /// Samples whose speed might have been higher with a longer look-ahead.
    pub(super) fn uncertain(&self) -> usize {
        match self {
            Self::Reach(stream) => stream.uncertain(),
            Self::Jerk { .. } => 0,
        }
    }
}

fn push(
    stream: &mut reach::ReachStream,
    problem: &Problem,
    sink: &mut dyn FnMut(SettledSample),
) -> Result<(), Infeasible> {
    stream.push(problem, &mut |settled| sink(step(&settled)))
}

fn step(settled: &Settled<'_>) -> SettledSample {
    SettledSample { q: settled.q, halfway: None, seconds: None, source: settled.active().source }
}

fn handed_on(
    passed: &jerk::SettledInterval<'_>,
    begun: &mut bool,
    sink: &mut dyn FnMut(SettledSample),
) {
    let at = |share: f64| passed.piece.at(share, passed.step)[0].max(0.0);
    let source = passed.active().source;
    if !std::mem::replace(begun, true) {
        sink(SettledSample { q: at(0.0), halfway: None, seconds: None, source });
    }
    sink(SettledSample {
        q: at(1.0),
        halfway: Some(at(0.5)),
        seconds: Some(passed.piece.duration(passed.step)),
        source,
    });
}
