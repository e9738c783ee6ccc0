//! Places spread evenly over a box, whatever their number (Halton's sequence).

use crate::kinematics::MAX_AXES;

/// Bases of the sequence, one an axis.
const PRIMES: [u32; MAX_AXES] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// The `number`th place, counted from 1: for each axis a share of its travel.
pub(crate) fn place(number: u32) -> [f64; MAX_AXES] {
    PRIMES.map(|base| share(number, base))
}

/// Digits of `number` in `base` behind the point, in reverse: spread evenly over 0 to 1.
fn share(mut number: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while number > 0 {
        digit /= f64::from(base);
        value += digit * f64::from(number % base);
        number /= base;
    }
    value
}
