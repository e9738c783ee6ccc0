//! What a plan has to keep: upper bounds at the samples and linear rows between neighbours.

use crate::infeasible::Infeasible;
use crate::limits::Limit;
use crate::samples::Samples;

pub use crate::table::{LimitRow, LimitSource, LimitTable};

/// The speed of the path parameter squared that the plan begins and ends with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndSpeeds {
    /// `q` at the first sample; 0 is at rest.
    pub start: f64,
    /// `q` at the last sample; 0 is at rest.
    pub end: f64,
}

/// The limits of a path, sampled at `n + 1` values of its parameter, for the unknowns `q = (ds/dt)^2` there.
///
/// Between two samples `q` is linear in the parameter, so that the second derivative of the parameter by time,
/// `(q[i + 1] - q[i]) / (2 * step)`, is constant: the law of eq. 21 of the feedrate paper and of reachability analysis.
///
/// Every interval has the same number of rows, in the order of [`Problem::sources`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// Names of the limits, for reports.
    pub names: Vec<String>,
    /// Increase of the path parameter from each sample to the next: one fewer than samples.
    pub steps: Vec<f64>,
    /// Largest `q` at each sample.
    pub upper: Vec<f64>,
    /// Where each upper bound comes from.
    pub causes: Vec<LimitSource>,
    /// Where the rows of an interval come from.
    pub sources: Vec<LimitSource>,
    /// Rows, interval by interval.
    pub rows: Vec<LimitRow>,
    /// What the plan begins and ends with.
    pub ends: EndSpeeds,
}

impl Problem {
    /// The limits of `samples`, each asked in turn.
    ///
    /// # Errors
    /// Where a number is not finite, where no limit bounds the speed, where the parameter does not grow.
    pub fn new(
        samples: &Samples,
        limits: &[&dyn Limit],
        ends: EndSpeeds,
    ) -> Result<Self, Infeasible> {
        let mut problem = Self::default();
        problem.refill(samples, limits, ends)?;
        Ok(problem)
    }

    /// As [`Problem::new`], in the memory of an earlier problem: a stream of batches allocates nothing.
    ///
    /// # Errors
    /// As [`Problem::new`].
    pub fn refill(
        &mut self,
        samples: &Samples,
        limits: &[&dyn Limit],
        ends: EndSpeeds,
    ) -> Result<(), Infeasible> {
        if !samples.is_whole() {
            return Err(Infeasible::Shape);
        }
        let count = samples.len();
        self.ends = ends;
        self.steps.clear();
        self.steps.extend(samples.parameter.windows(2).map(|pair| pair[1] - pair[0]));
        self.upper.clear();
        self.upper.resize(count, f64::INFINITY);
        self.causes.clear();
        self.causes.resize(count, LimitSource::default());
        self.sources.clear();
        self.names.clear();
        for (index, limit) in limits.iter().enumerate() {
            self.names.push(limit.name().to_owned());
            let limit_index = index as u16;
            let axes = limit.rows(samples);
            self.sources
                .extend(axes.into_iter().map(|axis| LimitSource { limit: limit_index, axis }));
        }
        self.rows.clear();
        self.rows.resize(self.sources.len() * count.saturating_sub(1), LimitRow::default());
        let mut first = 0;
        for (index, limit) in limits.iter().enumerate() {
            let rows = self.sources[first..]
                .iter()
                .take_while(|source| usize::from(source.limit) == index)
                .count();
            limit.apply(
                samples,
                &mut LimitTable {
                    limit: index as u16,
                    first,
                    stride: self.sources.len(),
                    upper: &mut self.upper,
                    causes: &mut self.causes,
                    rows: &mut self.rows,
                },
            );
            first += rows;
        }
        self.check()
    }

    /// A problem from numbers alone, at rest at both ends: one limit, called `bound`, makes all bounds, another,
    /// called `row`, all rows.
    #[must_use]
    pub fn from_rows(steps: Vec<f64>, upper: Vec<f64>, stride: usize, rows: Vec<LimitRow>) -> Self {
        let row = LimitSource { limit: 1, axis: None };
        Self {
            names: vec!["bound".to_owned(), "row".to_owned()],
            causes: vec![LimitSource::default(); upper.len()],
            sources: vec![row; stride],
            steps,
            upper,
            rows,
            ends: EndSpeeds::default(),
        }
    }

    /// The part from sample `first` to sample `last`, with the ends of the whole: a batch for a stream.
    #[must_use]
    pub fn part(&self, first: usize, last: usize) -> Self {
        let stride = self.stride();
        Self {
            names: self.names.clone(),
            steps: self.steps[first..last].to_vec(),
            upper: self.upper[first..=last].to_vec(),
            causes: self.causes[first..=last].to_vec(),
            sources: self.sources.clone(),
            rows: self.rows[first * stride..last * stride].to_vec(),
            ends: self.ends,
        }
    }

    /// Lowers the upper bound of `q` at a sample for a reason that no [`Limit`] knows, as a corner where two batches
    /// meet, with a name for reports.
    pub fn lower(&mut self, sample: usize, bound: f64, name: &str) {
        let limit = self.number_of(name);
        // What is not a number must not get lost in a comparison.
        if bound < self.upper[sample] || bound.is_nan() {
            self.upper[sample] = bound;
            self.causes[sample] = LimitSource { limit, axis: None };
        }
    }

    /// The number of a name, which is appended if it is new.
    pub(crate) fn number_of(&mut self, name: &str) -> u16 {
        let known = self.names.iter().position(|known| known == name);
        let number = known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        });
        number as u16
    }

    /// Number of rows of each interval.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.sources.len()
    }

    /// Rows between sample `interval` and the next.
    #[must_use]
    pub fn rows_of(&self, interval: usize) -> &[LimitRow] {
        let stride = self.stride();
        &self.rows[interval * stride..(interval + 1) * stride]
    }

    /// The name of where a bound or row comes from, as reports print it.
    #[must_use]
    pub fn name(&self, source: LimitSource) -> String {
        let name = self.names.get(usize::from(source.limit)).map_or("limit", String::as_str);
        match source.axis {
            Some(axis) => format!("{name} of axis {axis}"),
            None => name.to_owned(),
        }
    }

    /// A fault of this problem as a sentence, with the limit by its name.
    #[must_use]
    pub fn describe(&self, fault: &Infeasible) -> String {
        let by = |row: Option<LimitSource>| match row {
            Some(source) => format!(" ({} allows no more)", self.name(source)),
            None => String::new(),
        };
        match *fault {
            Infeasible::TooFastStart { sample, source, needed, allowed, braking } => format!(
                "the start is too fast: at sample {sample} the squared parameter speed is still {needed:.6} after the \
                 hardest braking{}, and {} allows {allowed:.6}",
                by(braking),
                self.name(source)
            ),
            Infeasible::OutOfReach { sample, source, needed, allowed, accelerating } => format!(
                "the end is too fast: at sample {sample} the squared parameter speed would have to be {needed:.6} \
                 already{}, and {} allows {allowed:.6}",
                by(accelerating),
                self.name(source)
            ),
            Infeasible::NotANumber { sample, source } => format!(
                "{} is no limit at sample {sample}: not finite, or negative",
                self.name(source)
            ),
            Infeasible::Contradiction { sample, source } => format!(
                "behind sample {sample} the limits contradict each other, among them {}",
                self.name(source)
            ),
            _ => fault.to_string(),
        }
    }

    /// Whether the numbers describe a problem at all.
    ///
    /// # Errors
    /// The first sample where a number is not finite or negative, no limit bounds the speed, the parameter does not
    /// grow, or the arrays differ in length.
    pub fn check(&self) -> Result<(), Infeasible> {
        let count = self.upper.len();
        let lengths = self.causes.len() == count
            && self.steps.len() + 1 == count
            && self.rows.len() == self.steps.len() * self.stride();
        if count < 2 || !lengths {
            return Err(Infeasible::Shape);
        }
        for (sample, &upper) in self.upper.iter().enumerate() {
            if upper == f64::INFINITY {
                return Err(Infeasible::Unbounded { sample });
            }
            if upper.is_nan() || upper < 0.0 {
                let source = self.causes[sample];
                return Err(Infeasible::NotANumber { sample, source });
            }
        }
        // What is not a number does not grow.
        let grows = |step: f64| step > 0.0;
        if let Some(sample) = self.steps.iter().position(|&step| !grows(step)) {
            return Err(Infeasible::Standstill { sample });
        }
        let bad = |row: &LimitRow| !(row.here.is_finite() && row.next.is_finite());
        if let Some(place) = self.rows.iter().position(bad) {
            return Err(Infeasible::NotANumber {
                sample: place / self.stride(),
                source: self.sources[place % self.stride()],
            });
        }
        let EndSpeeds { start, end } = self.ends;
        if !(start >= 0.0 && end >= 0.0 && start.is_finite() && end.is_finite()) {
            return Err(Infeasible::Shape);
        }
        Ok(())
    }

    /// The largest share of a limit that `q` uses, bounds and rows alike, and where: at most 1 where it keeps all.
    ///
    /// A bound counts as `q / upper`, a negative `q` as infinite.
    #[must_use]
    pub fn worst(&self, q: &[f64]) -> LimitUsage {
        let mut worst = LimitUsage::default();
        for (sample, (&q, &upper)) in q.iter().zip(&self.upper).enumerate() {
            let share = if q < 0.0 {
                f64::INFINITY
            } else if q <= upper {
                if upper > 0.0 { q / upper } else { 0.0 }
            } else {
                // A bound of 0 that is not kept.
                (q / upper).max(1.0 + q)
            };
            worst.raise(share, sample, self.causes[sample]);
        }
        for (interval, pair) in q.windows(2).enumerate() {
            let usage = self.used_between(interval, pair[0], pair[1]);
            worst.raise(usage.share, interval, usage.source);
        }
        worst
    }

    /// The limit that is used most at a sample: its bound, and the rows of both intervals that it ends.
    #[must_use]
    pub fn active(&self, q: &[f64], sample: usize) -> LimitUsage {
        let before = sample.checked_sub(1).map(|before| q[before]);
        self.used(sample, q[sample], before, q.get(sample + 1).copied())
    }

    /// As [`Problem::active`], by `q` of the sample and its neighbours.
    pub(crate) fn used(
        &self,
        sample: usize,
        q: f64,
        before: Option<f64>,
        behind: Option<f64>,
    ) -> LimitUsage {
        let mut worst = LimitUsage::default();
        if self.upper[sample] > 0.0 {
            worst.raise(q / self.upper[sample], sample, self.causes[sample]);
        }
        let arriving = before.map(|before| self.used_between(sample - 1, before, q));
        let leaving = behind.map(|behind| self.used_between(sample, q, behind));
        for usage in [arriving, leaving].into_iter().flatten() {
            worst.raise(usage.share, sample, usage.source);
        }
        worst
    }

    /// The row that is used most between two samples.
    pub(crate) fn used_between(&self, interval: usize, here: f64, next: f64) -> LimitUsage {
        let mut worst = LimitUsage::default();
        for (row, &source) in self.rows_of(interval).iter().zip(&self.sources) {
            worst.raise(row.value(here, next).abs(), interval, source);
        }
        worst
    }
}

/// How much of a limit is used, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitUsage {
    /// Value over limit.
    pub share: f64,
    /// Sample, or the first of the two that it lies between.
    pub sample: usize,
    /// Which limit.
    pub source: LimitSource,
}

impl LimitUsage {
    pub(crate) fn raise(&mut self, share: f64, sample: usize, source: LimitSource) {
        // What is not a number breaks every limit.
        if share > self.share || share.is_nan() {
            *self =
                Self { share: if share.is_nan() { f64::INFINITY } else { share }, sample, source };
        }
    }
}
