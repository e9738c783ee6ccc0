//! A plan gone along from its beginning to its end, finely.

use post_job::plan::gauges::{Gauges, PlanPoint};

use super::path::{CurvePath, NoStation};
use super::solve::StretchPlan;

/// Parts of a piece of the feed spline that are gone along one by one.
const PARTS: u32 = 3;

/// As near as this to its ends a piece is looked at: at rest a plan with jerk has a bend that is infinite.
const END: f64 = 1e-6;

/// A step of the walk, from the point before it to this one.
pub struct Step<'a> {
    /// Of the path.
    pub stretch: usize,
    pub point: &'a PlanPoint,
    /// The piece of the feed spline that it lies on, and how far along it, 0 to 1.
    pub piece: usize,
    pub share: f64,
    /// It is where two pieces of the spline meet, or an end.
    pub knot: bool,
    /// Way of the tip from the point before, mm; none at the beginning of a stretch.
    pub way: Option<f64>,
    /// Time from the point before, s.
    pub time: f64,
}

/// Goes along all stretches.
///
/// # Errors
/// The axes cannot follow somewhere between the samples.
pub fn walk(
    path: &CurvePath<'_>,
    plans: &[StretchPlan],
    gauges: &Gauges<'_>,
    sink: &mut dyn FnMut(&Step<'_>),
) -> Result<(), (f64, NoStation)> {
    let (mut way, mut time) = (0.0, 0.0);
    for (stretch, plan) in plans.iter().enumerate() {
        let spline = &plan.spline;
        let mut before: Option<(f64, f64)> = None;
        for piece in 0..spline.pieces.len() {
            let [from, to] = [spline.knots[piece], spline.knots[piece + 1]];
            // Where it begins is where the last one ended.
            let first = u32::from(piece > 0);
            for part in first..=PARTS {
                let share = f64::from(part) / f64::from(PARTS);
                let looked = share.clamp(END, 1.0 - END);
                // From inside: third derivatives jump at knots of the path.
                let inside = from + looked * (to - from);
                let station = path.at(stretch, inside).map_err(|why| (inside, why))?;
                let mut point = gauges.measure(&station, spline.within(piece, looked));
                point.parameter = from + share * (to - from);
                let tip = station.tip[1];
                let rate = libm::sqrt(tip.iter().map(|value| value * value).sum());
                let (mut went, mut took) = (None, 0.0);
                if let Some((at, last_rate)) = before {
                    let gone = 0.5 * (last_rate + rate) * (point.parameter - at);
                    let last_share = f64::from(part - 1) / f64::from(PARTS);
                    took = spline.time_within(piece, [last_share, share]);
                    way += gone;
                    time += took;
                    went = Some(gone);
                }
                before = Some((point.parameter, rate));
                (point.way, point.time) = (way, time);
                sink(&Step {
                    stretch,
                    point: &point,
                    piece,
                    share,
                    knot: part == 0 || part == PARTS,
                    way: went,
                    time: took,
                });
            }
        }
    }
    Ok(())
}
