//! What a program does, for programs to read.

use std::collections::BTreeMap;

use post_machine::description::Machine;
use serde::Serialize;

use super::ReadProgram;

/// What a program does.
#[derive(Clone, Debug, Serialize)]
pub struct ReadSummary {
    /// The program, as it was named.
    pub program: String,
    /// The machine.
    pub machine: String,
    /// Blocks that were run.
    pub blocks: u64,
    /// Motions at rapid.
    pub rapids: u64,
    /// Motions at feed.
    pub feeds: u64,
    /// Motions that are tied to the spindle.
    pub threads: u64,
    /// Motions in positions of the machine.
    pub in_machine: u64,
    /// Motions along which the control keeps the tip.
    pub kept: u64,
    /// Time at the feeds that the program states, s.
    pub feed_s: f64,
    /// Time of rapids, each axis at its largest feed, s.
    pub rapid_s: f64,
    /// Waits, s.
    pub waits_s: f64,
    /// Largest feed of the tip that is stated, mm/min.
    pub largest_feed_mm_min: f64,
    /// What each axis shows least and most, mm or degrees.
    pub axes: BTreeMap<String, [f64; 2]>,
    /// Least and largest coordinates of the tip at feed, mm, part frame; none where nothing is cut.
    pub tip_mm: Option<[[f64; 3]; 2]>,
    /// Tools in the order in which they come.
    pub tools: Vec<ToolUseSummary>,
    /// Words that are not known: each, how often, and the line of the first.
    pub unknown: Vec<(String, u64, u64)>,
}

/// What a tool does.
#[derive(Clone, Debug, Serialize)]
pub struct ToolUseSummary {
    /// Its number or name; none before the first change.
    pub name: Option<String>,
    /// Length that is compensated, mm.
    pub length_mm: f64,
    /// Motions at feed.
    pub cuts: u64,
    /// Time at feed, s.
    pub time_s: f64,
}

impl ReadSummary {
    /// Of the program `name` on `machine`.
    pub fn new(name: &str, machine: &Machine, done: &ReadProgram<'_>) -> Self {
        let ReadProgram { survey, report, .. } = done;
        let [rapids, feeds, threads] = survey.motions;
        let [rapid_s, feed_s] = survey.minutes.map(|minutes| 60.0 * minutes);
        let tools = survey.tools.iter().map(|tool| ToolUseSummary {
            name: tool.name.clone(),
            length_mm: tool.length,
            cuts: tool.cuts,
            time_s: 60.0 * tool.minutes,
        });
        let unknown = report.unknown.iter();
        Self {
            program: name.to_owned(),
            machine: machine.name.clone(),
            blocks: report.blocks,
            rapids,
            feeds,
            threads,
            in_machine: survey.in_machine,
            kept: survey.kept,
            feed_s,
            rapid_s,
            waits_s: survey.waits,
            largest_feed_mm_min: survey.feed,
            axes: survey.axes.iter().cloned().collect(),
            tip_mm: survey.tip,
            tools: tools.collect(),
            unknown: unknown.map(|(word, count, line)| (word.clone(), *count, *line)).collect(),
        }
    }
}
