//! Looks for the largest deviation along a move without an opinion on its shape.
//!
//! The move is cut in halves wherever more than the largest deviation so far could hide. How much could
//! is judged from how far the middle of a piece lies off its chord: a smooth curve leaves the chords of
//! the two halves by a quarter of that, and twice as much is allowed for.

use post_plugin::{
    Curve, Deviation, ErrorModel, OptionSpec, Tolerance, Value, ask, export_error_model, length,
};

/// Chebyshev-Lobatto places on 0 to 1, ends included: interpolation through them is well-behaved.
const NODES: [f64; 10] = [
    0.0,
    0.030153689607045786,
    0.116977778440511,
    0.25,
    0.4131759111665348,
    0.5868240888334652,
    0.75,
    0.883022221559489,
    0.9698463103929542,
    1.0,
];

/// A move that needs more than this is not smooth; what could still hide is then added to the peak.
const MOST: usize = 4096;

/// Shorter pieces are not cut either: the move jumps there.
const LEAST: f64 = 1e-9;

/// The model, as it is opened: how densely it looks, how closely, and its answers.
pub struct Sampled {
    samples: u32,
    accuracy: f64,
    places: Vec<PathSample>,
    asked: Vec<f64>,
    answers: Vec<Deviation>,
}

#[derive(Clone, Copy)]
struct PathSample {
    t: f64,
    deviation: Deviation,
    /// The piece that begins here is not settled.
    open: bool,
    /// Whether the place halves a piece that has not been judged since.
    fresh: bool,
}

/// The largest length seen, where, and the bound on what was not looked at.
#[derive(Clone, Copy, Default)]
struct DeviationPeak {
    size: f64,
    at: f64,
    hidden: f64,
}

impl ErrorModel for Sampled {
    fn options() -> &'static [OptionSpec] {
        const OPTIONS: &[OptionSpec] = &[
            OptionSpec::number(
                "accuracy",
                (1e-6, 0.5),
                0.01,
                "Relative accuracy of the peak; below this share of the tolerance, absolute.",
            ),
            OptionSpec::integer(
                "samples",
                (1, 1000),
                1,
                "Even pieces that are looked at beside the ten fixed places.",
            ),
        ];
        OPTIONS
    }

    fn open(options: &[(&str, Value<'_>)]) -> Result<Self, String> {
        let mut model = Sampled {
            samples: 1,
            accuracy: 0.01,
            places: Vec::new(),
            asked: Vec::new(),
            answers: Vec::new(),
        };
        for option in options {
            match *option {
                ("accuracy", Value::Number(accuracy)) => model.accuracy = accuracy,
                ("samples", Value::Integer(samples)) => model.samples = samples as u32,
                (key, value) => return Err(format!("option `{key}` cannot be {value}")),
            }
        }
        Ok(model)
    }

    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let mut terms = [0.0; 60];
        self.places.clear();
        self.asked.clear();
        self.asked.extend(NODES);
        self.asked
            .extend((1..self.samples).map(|index| f64::from(index) / f64::from(self.samples)));
        self.ask(deviation)?;
        for (chunk, place) in terms.chunks_exact_mut(6).zip(&self.places) {
            chunk.copy_from_slice(&place.deviation.to_terms());
        }
        self.sort();
        for place in &mut self.places {
            place.fresh = false;
        }

        let (mut tip, mut axis) = (DeviationPeak::default(), DeviationPeak::default());
        for place in &self.places {
            tip.see(length(&place.deviation.tip), place.t);
            axis.see(length(&place.deviation.axis), place.t);
        }
        while self.halve(deviation)? {
            for (answer, t) in self.answers.iter().zip(&self.asked) {
                tip.see(length(&answer.tip), *t);
                axis.see(length(&answer.axis), *t);
            }
            let many = self.places.len() >= MOST;
            for index in 1..self.places.len() - 1 {
                let [before, middle, after] =
                    [index - 1, index, index + 1].map(|index| self.places[index]);
                if !std::mem::take(&mut self.places[index].fresh) {
                    continue;
                }
                let tip_bound = tip.bound([before, middle, after].map(|p| p.deviation.tip));
                let axis_bound = axis.bound([before, middle, after].map(|p| p.deviation.axis));
                let settled = tip_bound <= self.limit(tip.size, tolerance.tip)
                    && axis_bound <= self.limit(axis.size, tolerance.axis);
                let given_up = many || after.t - before.t < LEAST;
                if settled || given_up {
                    self.places[index - 1].open = false;
                    self.places[index].open = false;
                }
                if !settled && given_up {
                    tip.hidden = tip.hidden.max(tip_bound);
                    axis.hidden = axis.hidden.max(axis_bound);
                }
            }
        }
        Ok(Curve {
            tip_peak: tip.size.max(tip.hidden),
            tip_at: tip.at,
            axis_peak: axis.size.max(axis.hidden),
            axis_at: axis.at,
            terms,
        })
    }

    /// Barycentric interpolation through the deviations at the nodes.
    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        let mut sum = [0.0; 6];
        let mut weights = 0.0;
        for (index, (node, terms)) in NODES.iter().zip(curve.terms.chunks_exact(6)).enumerate() {
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            let end = index == 0 || index == NODES.len() - 1;
            let share = if end { 0.5 } else { 1.0 };
            let weight = sign * share / (t - node);
            if !weight.is_finite() {
                return Deviation::from_terms(terms);
            }
            weights += weight;
            for (sum, term) in sum.iter_mut().zip(terms) {
                *sum += weight * term;
            }
        }
        Deviation::from_terms(&sum.map(|sum| sum / weights))
    }
}

impl Sampled {
    /// A bound below this hides nothing of interest.
    fn limit(&self, peak: f64, tolerance: f64) -> f64 {
        peak + self.accuracy * peak.max(tolerance)
    }

    /// Asks for the deviations at `self.asked` and adds them to the places, at their end.
    fn ask(&mut self, deviation: &mut dyn FnMut(&[f64], &mut [Deviation])) -> Result<(), String> {
        ask(deviation, &self.asked, &mut self.answers)?;
        for (&t, &deviation) in self.asked.iter().zip(&self.answers) {
            self.places.push(PathSample { t, deviation, open: true, fresh: true });
        }
        Ok(())
    }

    /// Puts a place in the middle of every open piece; says whether there was one.
    fn halve(
        &mut self,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<bool, String> {
        self.asked.clear();
        let open = self.places.windows(2).filter(|pair| pair[0].open);
        self.asked.extend(open.map(|pair| (pair[0].t + pair[1].t) / 2.0));
        if self.asked.is_empty() {
            return Ok(false);
        }
        self.ask(deviation)?;
        self.sort();
        Ok(true)
    }

    fn sort(&mut self) {
        self.places.sort_by(|a, b| a.t.total_cmp(&b.t));
        self.places.dedup_by(|a, b| a.t == b.t);
    }
}

impl DeviationPeak {
    fn see(&mut self, size: f64, at: f64) {
        if size > self.size {
            self.size = size;
            self.at = at;
        }
    }

    /// What the length may reach between three places, of which the second is the middle.
    fn bound(&self, [before, middle, after]: [[f64; 3]; 3]) -> f64 {
        let off = [0, 1, 2].map(|i| middle[i] - (before[i] + after[i]) / 2.0);
        let seen = length(&before).max(length(&middle)).max(length(&after));
        seen + length(&off) / 2.0
    }
}

export_error_model!(sampled, Sampled);
