use std::f64::consts::TAU;

use post_motion::fourier::*;

#[test]
fn the_transform_is_the_sum_that_defines_it() {
    let count = 16;
    let turns = turns(count);
    let signal: Vec<[f64; 2]> = (0..count)
        .map(|place| [libm::sin(0.7 * place as f64 * place as f64), 0.1 * place as f64])
        .collect();
    let mut fast = signal.clone();
    transform(&mut fast, &turns);
    for (frequency, [re, im]) in fast.iter().enumerate() {
        let mut sum = [0.0, 0.0];
        for (place, [a, b]) in signal.iter().enumerate() {
            let turn = TAU * (frequency * place) as f64 / count as f64;
            let [cos, sin] = [libm::cos(turn), -libm::sin(turn)];
            sum = [sum[0] + a * cos - b * sin, sum[1] + a * sin + b * cos];
        }
        assert!((re - sum[0]).abs() < 1e-12 && (im - sum[1]).abs() < 1e-12);
    }
}
