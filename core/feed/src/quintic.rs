//! A quintic between two places by value and derivatives to the third at both.

/// Value, first, second and third derivative of each coordinate at a place.
pub type Jet<const N: usize> = [[f64; N]; 4];

/// The quintic from `from` to `to`, `step` after it, at a share of the way. Where the two are of one quintic it is that
/// one; else its third derivative is theirs at both ends, and so are all others.
#[must_use]
pub fn between<const N: usize>(from: &Jet<N>, to: &Jet<N>, step: f64, share: f64) -> Jet<N> {
    let mut found = [[0.0; N]; 4];
    for coordinate in 0..N {
        let [value, f0, c0, t0] = from.map(|order| order[coordinate]);
        let [end, f1, c1, t1] = to.map(|order| order[coordinate]);
        let third = third([c0, c1], [t0, t1], step);
        let second = second([c0, c1], third, step);
        let first = first([f0, f1], second, step);
        let [_, low, _, high, _] = first;
        let (up, down) = (value + 0.2 * step * f0, end - 0.2 * step * f1);
        let (higher, lower) = (up + 0.2 * step * low, down - 0.2 * step * high);
        found[0][coordinate] = bernstein([value, up, higher, lower, down, end], share);
        found[1][coordinate] = bernstein(first, share);
        found[2][coordinate] = bernstein(second, share);
        found[3][coordinate] = bernstein(third, share);
    }
    found
}

/// Bernstein coefficients of the third derivative, from it and the second one at both ends.
pub(crate) fn third([c0, c1]: [f64; 2], [t0, t1]: [f64; 2], step: f64) -> [f64; 3] {
    let mean = (c1 - c0) / step;
    [t0, 3.0 * mean - t0 - t1, t1]
}

/// Bernstein coefficients of the second derivative, a cubic whose derivative is the third.
pub(crate) fn second([c0, c1]: [f64; 2], [t0, _, t1]: [f64; 3], step: f64) -> [f64; 4] {
    [c0, c0 + step * t0 / 3.0, c1 - step * t1 / 3.0, c1]
}

/// Bernstein coefficients of the first derivative, a quartic whose derivative is the second; where its ends ask for two
/// middles, the one between them.
pub(crate) fn first([f0, f1]: [f64; 2], [c0, up, down, c1]: [f64; 4], step: f64) -> [f64; 5] {
    let quarter = 0.25 * step;
    let (low, high) = (f0 + quarter * c0, f1 - quarter * c1);
    let middle = (low + quarter * up).midpoint(high - quarter * down);
    [f0, low, middle, high, f1]
}

/// A polynomial of these coefficients at a share of its interval, by de Casteljau's scheme.
pub(crate) fn bernstein<const N: usize>(mut coefficients: [f64; N], share: f64) -> f64 {
    for last in (1..N).rev() {
        for at in 0..last {
            coefficients[at] += share * (coefficients[at + 1] - coefficients[at]);
        }
    }
    coefficients[0]
}
