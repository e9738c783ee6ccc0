//! What was proven, for summaries.

use post_removal::field::Volume;
use serde::Serialize;

use super::{ClearanceFound, LongestAt, StockLeft, ToolCut};
use crate::text::{at_least, number};

/// No less and no more.
pub(super) fn between([low, high]: [f64; 2], decimals: u8) -> String {
    format!("{} to {}", number(low, decimals), number(high, decimals))
}

/// What was proven of a program, as its summary tells it.
#[derive(Clone, Debug, Serialize)]
pub struct ClearanceSummary {
    /// Motions that were looked at.
    pub motions: u64,
    /// What is known of each pair of bodies.
    pub pairs: Vec<PairSummary>,
    /// What has no body, and was not looked at.
    pub without_body: Vec<String>,
    /// What is left of each stock that is cut.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stocks: Vec<StockSummary>,
    /// What each tool takes of each of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cuts: Vec<CutSummary>,
}

/// What is left of a stock: of volumes no less and no more than this, mm³.
#[derive(Clone, Debug, Serialize)]
pub struct StockSummary {
    /// What tables call it: `stock`, or `stock NAME`.
    pub name: String,
    /// Before the first cut.
    pub before_mm3: [f64; 2],
    /// Behind the last.
    pub left_mm3: [f64; 2],
    /// What is cut of it.
    pub cut_mm3: [f64; 2],
    /// Edge of a cell, mm: to within that its surface is known.
    pub cell_mm: f64,
}

impl StockSummary {
    pub(super) fn new(stock: &StockLeft) -> Self {
        let StockLeft { name, before, left, cell, .. } = stock;
        let cut = [before.at_least - left.at_most, before.at_most - left.at_least];
        Self {
            name: name.clone(),
            before_mm3: [before.at_least, before.at_most],
            left_mm3: [left.at_least, left.at_most],
            cut_mm3: cut.map(|volume| volume.max(0.0)),
            cell_mm: cell.max(),
        }
    }

    /// All of it in a sentence.
    pub fn fact(&self) -> String {
        let between = |volume: [f64; 2]| between(volume, 0);
        format!(
            "{} mm³, {} mm³ cut of it, known to within {} mm",
            between(self.left_mm3),
            between(self.cut_mm3),
            number(self.cell_mm, 3)
        )
    }
}

/// What a tool takes of a stock.
#[derive(Clone, Debug, Serialize)]
pub struct CutSummary {
    /// Its number.
    pub tool: u32,
    /// What tables call the stock.
    pub stock: String,
    /// How much of the stock it takes, mm³: no less and no more than this.
    pub volume_mm3: [f64; 2],
    /// How deep its deepest cut is, mm up from the tip.
    pub depth_mm: Option<[f64; 2]>,
    /// Where it may be deepest, a line of the program.
    pub depth_line: Option<u64>,
    /// How wide its widest cut is, mm across way and tool axis.
    pub width_mm: Option<[f64; 2]>,
    /// Where it may be widest.
    pub width_line: Option<u64>,
    /// What it takes on the line of the program on which it may take most, mm³.
    pub most_mm3: Option<[f64; 2]>,
    /// That line.
    pub most_line: Option<u64>,
}

impl CutSummary {
    fn new(cut: &ToolCut, stock: &str) -> Self {
        let known = |longest: &LongestAt| {
            let known = Some(*longest).filter(|longest| longest.line > 0);
            let extent = known.map(|LongestAt { extent, .. }| [extent.at_least, extent.at_most]);
            (extent, known.map(|longest| longest.line))
        };
        let ((depth_mm, depth_line), (width_mm, width_line)) =
            (known(&cut.depth), known(&cut.width));
        let volume = |volume: Volume| [volume.at_least, volume.at_most];
        let most = Some(cut.most).filter(|most| most.line > 0);
        Self {
            tool: cut.tool,
            stock: stock.to_owned(),
            volume_mm3: volume(cut.volume),
            depth_mm,
            depth_line,
            width_mm,
            width_line,
            most_mm3: most.map(|most| volume(most.volume)),
            most_line: most.map(|most| most.line),
        }
    }

    /// What it takes, in a sentence.
    pub fn fact(&self) -> String {
        let part = |what: &str, unit: &str, range: Option<[f64; 2]>, line: Option<u64>| {
            let (range, line) = (range?, line?);
            Some(format!(", {what} {} {unit} in line {line}", between(range, 1)))
        };
        let parts = [
            part("as deep as", "mm", self.depth_mm, self.depth_line),
            part("as wide as", "mm", self.width_mm, self.width_line),
            part("most", "mm³", self.most_mm3, self.most_line),
        ];
        let cut = format!("{} mm³ cut", between(self.volume_mm3, 0));
        parts.into_iter().flatten().fold(cut, |told, part| told + &part)
    }
}

impl StockLeft {
    fn cut_summaries(&self) -> impl Iterator<Item = CutSummary> {
        self.cuts.iter().map(|cut| CutSummary::new(cut, &self.name))
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
            stocks: self.left.iter().map(StockSummary::new).collect(),
            cuts: self.left.iter().flat_map(StockLeft::cut_summaries).collect(),
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

    /// What is left of stocks that are cut, and what each tool takes of them: names and sentences.
    pub fn stock_rows(&self) -> Vec<[String; 2]> {
        let several = self.stocks.len() > 1;
        let left = self.stocks.iter().map(|stock| [format!("{} left", stock.name), stock.fact()]);
        let takes = |cut: &CutSummary| {
            let of = if several { format!(" of {}", cut.stock) } else { String::new() };
            [format!("tool {} takes{of}", cut.tool), cut.fact()]
        };
        left.chain(self.cuts.iter().map(takes)).collect()
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
