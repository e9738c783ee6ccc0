//! What a stretch has to keep, in coefficients of its spline: rows that do not change from round to round.

use super::forms::{self, LinearForm};
use super::spline::Spline;
use crate::infeasible::Infeasible;
use crate::limits::{Channel, Order};
use crate::problem::LimitSource;

/// What rounding may leave of a row that was kept.
pub(super) const ROUNDING: f64 = 1e-7;

/// Hands on the channels of an interval, each with the number of its limit.
pub(super) type Channels<'a> = dyn Fn(usize, &mut dyn FnMut(u16, Channel)) + 'a;

/// A Bernstein coefficient of what is limited, divided by its limit.
pub(super) struct IntervalRule {
    form: LinearForm,
    /// Coefficients of `q` at the same place, for jerk.
    q: Option<LinearForm>,
    source: LimitSource,
}

impl IntervalRule {
    /// As a row of a round, `form <= most`: what is limited in one direction, by the tangent at `q = tangent`.
    pub(super) fn linear(&self, side: f64, tangent: f64) -> (LinearForm, f64) {
        match self.q {
            None => (self.form.map(|value| side * value), 1.0),
            Some(q) => {
                let root = tangent.sqrt();
                let mix = |k: usize| side * root * self.form[k] + 0.5 * q[k] / tangent;
                (std::array::from_fn(mix), 1.5)
            }
        }
    }
}

/// The rules of every interval.
pub(super) struct IntervalRules {
    all: Vec<IntervalRule>,
    offsets: Vec<usize>,
}

impl IntervalRules {
    /// Makes the rules of every interval of the spline.
    pub(super) fn new(spline: &Spline, steps: &[f64], channels: &Channels<'_>) -> Self {
        let mut all = Vec::new();
        let mut offsets = vec![0];
        for (interval, &step) in steps.iter().enumerate() {
            if spline.is_spline(interval) {
                let into = spline.bernstein(interval);
                channels(interval, &mut |limit, channel| {
                    let share = 1.0 / channel.limit;
                    let axis = channel.axis;
                    let source = LimitSource { limit, axis };
                    let rule = |form: LinearForm, q: Option<LinearForm>| IntervalRule {
                        form: composed(form, into).map(|value| value * share),
                        q: q.map(|q| composed(q, into)),
                        source,
                    };
                    match channel.order {
                        Order::Acceleration => {
                            let forms = forms::acceleration(&channel, step).into_iter();
                            all.extend(forms.map(|form| rule(form, None)));
                        }
                        Order::Jerk => {
                            let rows = forms::jerk(&channel, step).into_iter().zip(forms::Q);
                            all.extend(rows.map(|(form, q)| rule(form, Some(q))));
                        }
                    }
                });
            }
            offsets.push(all.len());
        }
        Self { all, offsets }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// Rules of an interval.
    pub(super) fn of(&self, interval: usize) -> &[IntervalRule] {
        &self.all[self.offsets[interval]..self.offsets[interval + 1]]
    }

    /// What is used most of its limit, if a row is broken: possible only beside what is given in motion.
    pub(super) fn broken(
        &self,
        spline: &Spline,
        tangents: &[f64],
        unknowns: &[f64],
    ) -> Option<Infeasible> {
        let mut broken = false;
        let mut worst = 0.0;
        let mut fault = Infeasible::NoProgress { sample: 0 };
        for (interval, &tangent) in tangents.iter().enumerate() {
            for rule in self.of(interval) {
                for side in [1.0, -1.0] {
                    let (form, most) = rule.linear(side, tangent);
                    let share = spline.value(interval, form, unknowns) / most;
                    // What is not a number is broken.
                    broken |= share.is_nan() || share > 1.0 + ROUNDING;
                }
                // The limited value itself: a row may be broken for want of speed in its tangent alone.
                let speed = rule.q.map_or(1.0, |_| tangent.sqrt());
                let value = spline.value(interval, rule.form, unknowns).abs() * speed;
                if value > worst {
                    worst = value;
                    fault = Infeasible::Contradiction { sample: interval, source: rule.source };
                }
            }
        }
        broken.then_some(fault)
    }
}

/// A form in Bernstein coefficients as one in those of the spline.
fn composed(form: LinearForm, into: [LinearForm; 3]) -> LinearForm {
    std::array::from_fn(|k| (0..3).map(|b| form[b] * into[b][k]).sum())
}
