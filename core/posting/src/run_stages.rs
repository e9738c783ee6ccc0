//! Runs of cuts go through the stages as columns: each stage takes all points of a run, or says that it is in doubt,
//! and then they go one by one. Nothing is changed before the last stage has said how far the run goes.

use nalgebra::Vector3;
use post_grammar::GotoRun;
use post_machine::kinematics::batch::{LANES, set_vector, vector};

use crate::accuracy::RunColumns;
use crate::findings::Findings;
use crate::post::PostStages;
use crate::program::{MoveFeed, ProgramStep, StraightMove};
use crate::timing::TimedRun;

/// Fewer points are not worth columns.
const LEAST: usize = 16;

/// After a run that was not worth it so many steps go one by one before another is tried; after each further one twice as
/// many.
const SHORTEST_PAUSE: usize = 2;

/// The most of them.
const LONGEST_PAUSE: usize = 256;

/// What is kept from run to run.
#[derive(Debug)]
pub(crate) struct RunBuffers {
    columns: Box<RunColumns>,
    timed: Box<TimedRun>,
    /// Steps that go one by one after the next doubt.
    pause: usize,
    /// Steps left of the pause in hand.
    paused: usize,
    /// Longest run.
    most: usize,
}

impl RunBuffers {
    /// Runs are of at most so many points; with none there are no runs.
    pub(crate) fn new(most: usize) -> Self {
        Self {
            columns: Box::default(),
            timed: Box::default(),
            pause: SHORTEST_PAUSE,
            paused: 0,
            most: most.min(RunColumns::MOST),
        }
    }
}

/// The feed of a plain cut, mm/min.
fn plain_feed(step: &ProgramStep) -> Option<(f64, &StraightMove)> {
    match step {
        ProgramStep::Move(motion) if motion.chord == 0.0 && motion.edge == Vector3::zeros() => {
            match motion.pace {
                MoveFeed::PerMinute(feed) => Some((feed, motion)),
                MoveFeed::Rapid | MoveFeed::InverseTime(_) | MoveFeed::PerRevolution(_) => None,
            }
        }
        _ => None,
    }
}

/// Number of steps at the front that are plain cuts, up to `most`.
fn length(steps: &[(u64, ProgramStep)], most: usize) -> usize {
    steps.iter().take(most).take_while(|(_, step)| plain_feed(step).is_some()).count()
}

impl PostStages<'_> {
    /// Takes steps, runs of cuts as columns.
    pub(crate) fn take_steps(&mut self, mut steps: &[(u64, ProgramStep)], findings: &Findings) {
        if !self.passes_runs() {
            return self.take_alone(steps);
        }
        while !steps.is_empty() {
            let taken = self.take_run(steps, findings);
            steps = &steps[taken..];
            if taken == 0 {
                let alone = self.steps_alone(steps);
                self.take_alone(&steps[..alone]);
                steps = &steps[alone..];
            }
        }
    }

    /// No stage needs every point by itself, and nobody looks on.
    fn passes_runs(&self) -> bool {
        self.runs.most > 0 && self.shift.is_none() && self.plan.is_none() && !self.emit.is_watched()
    }

    /// Number of steps at the front that go one by one.
    fn steps_alone(&mut self, steps: &[(u64, ProgramStep)]) -> usize {
        let runs = &mut self.runs;
        if runs.paused > 0 {
            let alone = runs.paused.min(steps.len());
            runs.paused -= alone;
            return alone;
        }
        let least = LEAST.min(runs.most).max(1);
        let mut alone = length(steps, runs.most).max(1).min(steps.len());
        while alone < steps.len() {
            let next = length(&steps[alone..], runs.most);
            if next >= least {
                break;
            }
            alone += next.max(1);
        }
        alone.min(steps.len())
    }

    /// So many plain cuts, the last from `line`, may go as columns.
    pub(crate) fn takes_columns(&self, count: usize, line: u64, findings: &Findings) -> bool {
        let runs = &self.runs;
        runs.paused == 0
            && self.expand.passes_moves(line)
            && count.min(runs.most) >= LEAST.min(runs.most).max(1)
            && self.passes_runs()
            && self.emit.takes_runs()
            && !findings.failed()
    }

    /// Takes the steps at the front as columns: how many; none on any doubt.
    fn take_run(&mut self, steps: &[(u64, ProgramStep)], findings: &Findings) -> usize {
        let count = length(steps, self.runs.most);
        let last_line = count.checked_sub(1).map_or(0, |last| steps[last].0);
        if !self.takes_columns(count, last_line, findings) {
            return 0;
        }
        let run = &mut *self.runs.columns;
        run.count = count;
        for (lane, (line, step)) in steps[..count].iter().enumerate() {
            if let Some((feed, motion)) = plain_feed(step) {
                run.feeds[lane] = feed;
                run.lines[lane] = *line;
                set_vector(&mut run.tip, lane + 1, motion.tip);
                set_vector(&mut run.axis, lane + 1, motion.axis);
            }
        }
        self.take_filled()
    }

    /// Takes the first records of a run as columns: how many; none on any doubt. `fill` puts wanted tips and tool axes into
    /// the columns; false, if it cannot.
    pub(crate) fn take_gotos(
        &mut self,
        gotos: &GotoRun,
        feed: f64,
        findings: &Findings,
        fill: impl FnOnce(&mut RunColumns) -> bool,
    ) -> usize {
        if !self.takes_columns(gotos.count(), gotos.last_line(), findings) {
            return 0;
        }
        let run = &mut *self.runs.columns;
        if !fill(run) {
            return 0;
        }
        run.count = gotos.count().min(self.runs.most);
        run.feeds = [feed; LANES];
        for (lane, line) in run.lines.iter_mut().enumerate() {
            *line = gotos.line(lane);
        }
        self.take_filled()
    }

    /// Takes the points that the columns were filled with: how many; none on any doubt.
    fn take_filled(&mut self) -> usize {
        let runs = &mut self.runs;
        let (run, timed) = (&mut *runs.columns, &mut *runs.timed);
        let count = run.count;
        let certain = self.configuration.carries_on(run) && self.blocks.certifies(run);
        if certain {
            self.timing.times(run, timed);
        }
        let taken = certain && run.count > 0 && self.configuration.carry_on(run);
        if taken && (run.count == count || run.count >= LEAST) {
            runs.pause = SHORTEST_PAUSE;
            // What has ended the run goes by itself.
            runs.paused = usize::from(run.count < count);
        } else {
            runs.paused = runs.pause.min(count);
            runs.pause = (2 * runs.pause).min(LONGEST_PAUSE);
        }
        if !taken {
            return 0;
        }
        self.expand.passed(vector(&run.tip, run.count));
        self.blocks.certify(run);
        self.timing.take_run(run, timed);
        self.emit.take_run(run, timed);
        run.count
    }
}
