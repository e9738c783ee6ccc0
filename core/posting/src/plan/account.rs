//! What a plan came to.

use std::collections::BTreeMap;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use serde::Serialize;

/// What a plan came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlanReport {
    /// Blocks whose feed was planned.
    pub blocks: u64,
    /// Blocks that were cut because the feed changes inside them.
    pub blocks_cut: u64,
    /// Blocks that were put in by that.
    pub blocks_added: u64,
    /// Blocks that have the feed of the CL file although a plan was asked for: too short, or not to be planned.
    pub blocks_unplanned: u64,
    /// Blocks among them whose plan was slower than standing still at both of their ends.
    pub blocks_too_slow: u64,
    /// Time of the planned blocks at the feed that the CL file asks for, s, as if the tool never had to slow down.
    pub asked_s: f64,
    /// Time by the plan, s.
    pub planned_s: f64,
    /// Time at the feeds that stand in the program, s: each block at the least that is planned on it.
    pub printed_s: f64,
    /// Samples of the path whose speed might have been higher with a longer look-ahead.
    pub look_ahead_short: u64,
    /// What the feed is limited by, the longest first.
    pub limits: Vec<LimitShare>,
}

/// Time for which a limit is the one that is used most.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LimitShare {
    /// Which limit.
    pub limit: String,
    /// The axis that it is of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<String>,
    /// s, by the plan.
    pub time_s: f64,
}

/// Sums of a plan.
#[derive(Debug, Default)]
pub(super) struct PlanTally {
    report: PlanReport,
    times: BTreeMap<(&'static str, Option<u16>), f64>,
    /// Shares of the block in hand.
    pending: Vec<((&'static str, Option<u16>), f64)>,
}

impl PlanTally {
    /// Counts the pieces that a block became.
    pub(super) fn block(&mut self, count: usize, asked: f64, planned: f64, printed: f64) {
        for (limit, seconds) in self.pending.drain(..) {
            *self.times.entry(limit).or_default() += seconds;
        }
        let report = &mut self.report;
        report.blocks += 1;
        report.blocks_cut += u64::from(count > 1);
        report.blocks_added += count.saturating_sub(1) as u64;
        report.asked_s += asked;
        report.planned_s += planned;
        report.printed_s += printed;
    }

    /// Counts blocks that go on without a plan.
    pub(super) fn give_up(&mut self, count: usize) {
        self.report.blocks_unplanned += count as u64;
        self.pending.clear();
    }

    /// A block goes on without its plan, which is slower than none.
    pub(super) fn too_slow(&mut self) {
        self.give_up(1);
        self.report.blocks_too_slow += 1;
    }

    /// The warning that blocks were planned slower than they are without a plan.
    pub(super) fn slower_than_none(&self) -> Option<Diagnostic> {
        let blocks = match self.report.blocks_too_slow {
            0 => return None,
            1 => "1 block".to_owned(),
            count => format!("{count} blocks"),
        };
        let message = format!(
            "the plan of {blocks} is slower than standing still at both ends, as where CL points lie closer together than \
             they are exact: the feed there is that of the CL file"
        );
        Some(
            Diagnostic::warning("plan", message)
                .help("[accuracy] reduce = true leaves needless points out"),
        )
    }

    /// Adds the time for which a limit is used most.
    pub(super) fn limited(&mut self, limit: &'static str, axis: Option<u16>, seconds: f64) {
        if seconds.is_finite() {
            self.pending.push(((limit, axis), seconds));
        }
    }

    /// Sets the number of samples of a path that might have been faster.
    pub(super) fn uncertain(&mut self, samples: usize) {
        self.report.look_ahead_short = samples as u64;
    }

    pub(super) fn report(&self, machine: &Machine) -> PlanReport {
        let mut limits: Vec<LimitShare> = self
            .times
            .iter()
            .map(|((limit, axis), time_s)| LimitShare {
                limit: (*limit).to_owned(),
                axis: axis.map(|axis| axis_name(machine, axis).to_owned()),
                time_s: *time_s,
            })
            .collect();
        limits.sort_by(|one, other| other.time_s.total_cmp(&one.time_s));
        PlanReport { limits, ..self.report.clone() }
    }
}

/// The name of an axis of `machine` by its place in the chain; after them stand X, Y and Z of the programmed tip.
pub fn axis_name(machine: &Machine, place: u16) -> &str {
    let place = usize::from(place);
    let programmed = || ["X", "Y", "Z"][(place - machine.axes.len()).min(2)];
    let axis = machine.axes.get(place);
    axis.map_or_else(programmed, |axis| axis.name.as_str())
}
