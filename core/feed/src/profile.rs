//! The feed between samples, and the time that a plan takes.

/// Time from each sample to the next by the law that a [`Problem`](crate::Problem) is made for: `q` linear in the
/// parameter between samples, so that its acceleration is constant.
///
/// Infinite where both speeds are 0.
pub fn times<'a>(steps: &'a [f64], q: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
    let pairs = q.windows(2);
    pairs.zip(steps).map(|(pair, step)| 2.0 * step / (pair[0].sqrt() + pair[1].sqrt()))
}

/// Time of the whole plan, s.
#[must_use]
pub fn duration(steps: &[f64], q: &[f64]) -> f64 {
    times(steps, q).sum()
}

/// `q` at a share of an interval, 0 to 1.
#[must_use]
pub fn between(here: f64, next: f64, share: f64) -> f64 {
    here + (next - here) * share
}
