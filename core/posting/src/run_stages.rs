//! Runs of cuts go through the stages as columns: each stage takes all points of a run, or says that it is in doubt,
//! and then they go one by one. Nothing is changed before the last stage has said how far the run goes.

use nalgebra::Vector3;
use post_machine::kinematics::batch::{set_vector, vector};

use crate::accuracy::RunColumns;
use crate::findings::Findings;
use crate::post::PostStages;
use crate::program::{MoveFeed, ProgramStep, StraightMove};
use crate::timing::TimedRun;

/// Fewer points are not worth columns.
const LEAST: usize = 16;

/// After a doubt so many steps go one by one, at most, before another run is tried.
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
            pause: LEAST,
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
                MoveFeed::Rapid | MoveFeed::InverseTime(_) => None,
            }
        }
        _ => None,
    }
}

/// Number of steps at the front that are cuts at one feed, up to `most`.
fn length(steps: &[(u64, ProgramStep)], most: usize) -> usize {
    let Some((_, first)) = steps.first() else {
        return 0;
    };
    let Some((feed, _)) = plain_feed(first) else {
        return 0;
    };
    let same = |step: &&(u64, ProgramStep)| plain_feed(&step.1).is_some_and(|(it, _)| it == feed);
    steps.iter().take(most).take_while(same).count()
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
        self.runs.most > 0
            && self.expand.passes_moves()
            && self.shift.is_none()
            && self.plan.is_none()
            && !self.emit.is_watched()
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

    /// Takes the steps at the front as columns: how many; none on any doubt.
    fn take_run(&mut self, steps: &[(u64, ProgramStep)], findings: &Findings) -> usize {
        let runs = &mut self.runs;
        let count = length(steps, runs.most);
        let ready = runs.paused == 0
            && count >= LEAST.min(runs.most).max(1)
            && self.emit.takes_runs()
            && !findings.failed();
        if !ready {
            return 0;
        }
        let (run, timed) = (&mut *runs.columns, &mut *runs.timed);
        run.count = count;
        for (lane, (line, step)) in steps[..count].iter().enumerate() {
            if let Some((feed, motion)) = plain_feed(step) {
                run.feed = feed;
                run.lines[lane] = *line;
                set_vector(&mut run.tip, lane + 1, motion.tip);
                set_vector(&mut run.axis, lane + 1, motion.axis);
            }
        }
        let certain = self.configuration.carries_on(run) && self.blocks.certifies(run);
        if certain {
            self.timing.times(run, timed);
        }
        if !certain || run.count == 0 || !self.configuration.carry_on(run) {
            runs.paused = runs.pause.min(count);
            runs.pause = (2 * runs.pause).min(LONGEST_PAUSE);
            return 0;
        }
        if run.count == count {
            runs.pause = LEAST;
        } else {
            // What has ended the run goes by itself.
            runs.paused = 1;
        }
        self.expand.passed(vector(&run.tip, run.count));
        self.blocks.certify(run);
        self.timing.take_run(run, timed);
        self.emit.take_run(run, timed);
        run.count
    }
}
