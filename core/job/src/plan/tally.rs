//! What a plan uses of each limit, and where.

use serde::Serialize;

use super::gauges::{Gauge, Gauges, PlanPoint};

/// A limit counts as reached from this share on: a bound between two samples is that of the stricter one.
const REACHED: f64 = 0.99;

/// What is used of a limit.
#[derive(Clone, Debug, Serialize)]
pub struct LimitFound {
    /// `acceleration of A`.
    pub limit: String,
    /// Of the numbers.
    pub unit: &'static str,
    /// None where there is none.
    pub most: Option<f64>,
    /// The solver keeps it.
    pub kept: bool,
    /// The largest value, without its sign.
    pub largest: f64,
    /// Of the limit, between samples too.
    pub largest_share: Option<f64>,
    /// Where it is largest.
    pub at_parameter: f64,
    /// Where it is largest, mm along the path.
    pub at_mm: f64,
    /// Of the way on which no other limit is used more, while it is reached.
    pub share_of_way: f64,
    /// Of the time likewise.
    pub share_of_time: f64,
}

/// How much of each limit a walk uses.
pub struct Tally<'a> {
    gauges: &'a Gauges<'a>,
    found: Vec<PlanPeak>,
    way: f64,
    time: f64,
    last: Option<usize>,
}

#[derive(Clone, Copy, Debug, Default)]
struct PlanPeak {
    value: f64,
    parameter: f64,
    at: f64,
    way: f64,
    time: f64,
}

impl<'a> Tally<'a> {
    /// Nothing is used yet.
    pub fn new(gauges: &'a Gauges<'a>) -> Self {
        Self {
            gauges,
            found: vec![PlanPeak::default(); gauges.all.len()],
            way: 0.0,
            time: 0.0,
            last: None,
        }
    }

    /// Takes the next point, and way (mm; none at the beginning of a stretch) and time (s) from the one before; tells which
    /// limit is active there, by its place among the gauges.
    pub fn take(&mut self, point: &PlanPoint, way: Option<f64>, time: f64) -> Option<usize> {
        let mut active = (None, REACHED);
        for (place, (gauge, largest)) in self.gauges.all.iter().zip(&mut self.found).enumerate() {
            let value = self.gauges.value(gauge, point).abs();
            if value > largest.value {
                (largest.value, largest.parameter) = (value, point.parameter);
                largest.at = point.way;
            }
            let share = value / gauge.limit;
            if gauge.kept && share > active.1 {
                active = (Some(place), share);
            }
        }
        if let Some(way) = way {
            self.way += way;
            self.time += time;
            for place in [self.last, active.0].into_iter().flatten() {
                self.found[place].way += 0.5 * way;
                self.found[place].time += 0.5 * time;
            }
        }
        self.last = active.0;
        active.0
    }

    /// The share of the speed at which everything that the solver keeps is kept; 1 where it is.
    pub fn slower(&self) -> f64 {
        let each = self.gauges.all.iter().zip(&self.found);
        let kept = each.filter(|(gauge, largest)| gauge.kept && largest.value > gauge.limit);
        kept.map(|(gauge, largest)| {
            Gauges::speed_at_limit(gauge.quantity, largest.value / gauge.limit)
        })
        .fold(1.0, f64::min)
    }

    /// Way of the tip so far, mm.
    pub fn way(&self) -> f64 {
        self.way
    }

    /// Time so far, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What is used of each limit, in the order of the gauges.
    pub fn limits(&self) -> Vec<LimitFound> {
        let each = self.gauges.all.iter().zip(&self.found);
        each.map(|(gauge, largest)| self.limit(gauge, largest)).collect()
    }

    fn limit(&self, gauge: &Gauge, largest: &PlanPeak) -> LimitFound {
        let limited = gauge.limit.is_finite();
        LimitFound {
            limit: gauge.name.clone(),
            unit: gauge.unit,
            most: limited.then_some(gauge.limit * gauge.scale),
            kept: gauge.kept,
            largest: largest.value * gauge.scale,
            largest_share: limited.then_some(largest.value / gauge.limit),
            at_parameter: largest.parameter,
            at_mm: largest.at,
            share_of_way: largest.way / self.way,
            share_of_time: largest.time / self.time,
        }
    }
}
