//! How many of a log's errors are worth one that is independent.

/// Samples by which errors are compared with earlier ones.
const LONGEST_LAG: usize = 1_000;

/// How many errors that follow one another say no more than one that is independent: the sum of their autocorrelation
/// over all lags up to the first that is not above zero, 1 where they are independent. Right for errors that hang
/// together over times in which the derivatives hardly change.
pub(super) fn hanging_together(errors: &[f64]) -> f64 {
    let products = |lag: usize| -> f64 {
        let pairs = errors.iter().zip(&errors[lag..]);
        pairs.map(|(one, other)| one * other).sum()
    };
    let squares = products(0);
    let lags = 1..LONGEST_LAG.min(errors.len());
    let correlations = lags.map(|lag| products(lag) / squares);
    let positive = correlations.take_while(|correlation| *correlation > 0.0);
    1.0 + 2.0 * positive.sum::<f64>()
}
