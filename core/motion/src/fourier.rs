//! The discrete Fourier transform.

use std::f64::consts::TAU;

/// Cosine and minus sine of the turns that the transform of `count` values takes, half as many.
pub fn turns(count: usize) -> Vec<[f64; 2]> {
    let angle = |place: usize| TAU * place as f64 / count as f64;
    (0..count / 2).map(|place| [libm::cos(angle(place)), -libm::sin(angle(place))]).collect()
}

/// The transform in place, by halves (J. W. Cooley, J. W. Tukey, 1965): each value becomes the sum of all `x[k]`, real and
/// imaginary part, times `exp(-2πi·k·place/count)`. There is a power of two of them; `turns` are [`turns`] of their number.
pub fn transform(values: &mut [[f64; 2]], turns: &[[f64; 2]]) {
    let count = values.len();
    if count < 2 {
        return;
    }
    let bits = count.trailing_zeros();
    for place in 0..count {
        let other = place.reverse_bits() >> (usize::BITS - bits);
        if other > place {
            values.swap(place, other);
        }
    }
    let mut half = 1;
    while half < count {
        for first in (0..count).step_by(2 * half) {
            for step in 0..half {
                let [cos, sin] = turns[step * (count / (2 * half))];
                let [low, high] = [first + step, first + step + half];
                let [re, im] = values[high];
                let turned = [re * cos - im * sin, re * sin + im * cos];
                let [a, b] = values[low];
                values[low] = [a + turned[0], b + turned[1]];
                values[high] = [a - turned[0], b - turned[1]];
            }
        }
        half *= 2;
    }
}
