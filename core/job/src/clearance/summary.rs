//! What was proven, for summaries.

use serde::Serialize;

use super::{ClearanceFound, LongestAt, ToolCut};
use crate::text::{at_least, number};

/// What was proven of a program, as its summary tells it.
#[derive(Clone, Debug, Serialize)]
pub struct ClearanceSummary {
    /// Motions that were looked at.
    pub motions: u64,
    /// What is known of each pair of bodies.
    pub pairs: Vec<PairSummary>,
    /// What has no body, and was not looked at.
    pub without_body: Vec<String>,
    /// What each tool takes of a stock that is cut.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<CutSummary>,
}

/// What a tool takes of the stock.
#[derive(Clone, Debug, Serialize)]
pub struct CutSummary {
    /// Its number.
    pub tool: u32,
    /// How much of the stock it takes, mm³: no less and no more than this.
    pub volume_mm3: [f64; 2],
    /// Its straight cuts are no deeper, mm up from the tip.
    pub depth_mm: Option<f64>,
    /// Where they are deepest, a line of the program.
    pub depth_line: Option<u64>,
    /// Its straight cuts are no wider, mm across way and tool axis.
    pub width_mm: Option<f64>,
    /// Where they are widest.
    pub width_line: Option<u64>,
}

impl CutSummary {
    fn new(cut: &ToolCut) -> Self {
        let known = |longest: &LongestAt| {
            let known = Some(*longest).filter(|longest| longest.line > 0);
            (known.map(|longest| longest.at_most), known.map(|longest| longest.line))
        };
        let ((depth_mm, depth_line), (width_mm, width_line)) =
            (known(&cut.depth), known(&cut.width));
        let volume_mm3 = [cut.volume.at_least, cut.volume.at_most];
        Self { tool: cut.tool, volume_mm3, depth_mm, depth_line, width_mm, width_line }
    }
}

/// What is known of two bodies along a program.
#[derive(Clone, Debug, Serialize)]
pub struct PairSummary {
    /// Their names.
    pub bodies: [String; 2],
    /// They are never nearer on motions that are proven to be clear, mm; none where there is no such motion.
    pub clear_by_mm: Option<f64>,
    /// The nearest that was found at a pose, mm.
    pub nearest_mm: Option<f64>,
    /// Where that is, a line of the program.
    pub nearest_line: Option<u64>,
    /// Motions on which they are not clear.
    pub not_clear: u64,
}

impl ClearanceFound {
    /// What a summary tells of it.
    pub fn summary(&self) -> ClearanceSummary {
        let known = |value: f64| value.is_finite().then_some(value);
        let pairs = self.pairs.iter().map(|pair| PairSummary {
            bodies: pair.names.clone(),
            clear_by_mm: known(pair.clear_by),
            nearest_mm: known(pair.nearest.0),
            nearest_line: (pair.nearest.1 > 0).then_some(pair.nearest.1),
            not_clear: pair.faults,
        });
        ClearanceSummary {
            motions: self.motions,
            pairs: pairs.collect(),
            without_body: self.lacks.clone(),
            cuts: self.left.iter().flat_map(|left| left.cuts.iter().map(CutSummary::new)).collect(),
        }
    }
}

impl ClearanceSummary {
    /// The pair that comes nearest.
    pub fn nearest(&self) -> Option<&PairSummary> {
        let distance = |pair: &PairSummary| pair.nearest_mm.unwrap_or(f64::INFINITY);
        self.pairs.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)))
    }

    /// The least distance that all pairs are proven to keep, mm; none where none is.
    pub fn clear_by_mm(&self) -> Option<f64> {
        self.pairs.iter().filter_map(|pair| pair.clear_by_mm).min_by(f64::total_cmp)
    }

    /// All of it in a sentence.
    pub fn fact(&self) -> String {
        let mut fact = match self.pairs.len() {
            1 => "1 pair of bodies".to_owned(),
            count => format!("{count} pairs of bodies"),
        };
        if let Some(by) = self.clear_by_mm() {
            fact.push_str(&format!(" proven to stay apart by {} mm", at_least(by, 3)));
        }
        if let Some(PairSummary {
            bodies: [one, other],
            nearest_mm: Some(nearest),
            nearest_line: Some(line),
            ..
        }) = self.nearest()
        {
            fact.push_str(&format!(
                "; nearest are {one} and {other}, {} mm in line {line} of the program",
                number(*nearest, 3)
            ));
        }
        fact
    }
}
