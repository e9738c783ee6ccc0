//! Sines, cosines and angles of many numbers: the operations of `libm` in its order, so its bits, with a choice of two
//! values in the place of each branch, so that the compiler makes vectors of the loops.
//!
//! Lanes for which `libm` goes another way (close to the seams of its ranges and to multiples of a quarter turn, very
//! large, zero or no number) are told apart by the same pass and left to it.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, PI};

use super::batch::{LANES, Lanes, groups, widely};

/// Coefficients of the sine on an eighth of a turn.
const SINE: [f64; 6] = [
    -0.16666666666666632,
    0.00833333333332249,
    -0.0001984126982985795,
    2.7557313707070068e-06,
    -2.5050760253406863e-08,
    1.58969099521155e-10,
];

/// Those of the cosine.
const COSINE: [f64; 6] = [
    0.0416666666666666,
    -0.001388888888887411,
    2.480158728947673e-05,
    -2.7557314351390663e-07,
    2.087572321298175e-09,
    -1.1359647557788195e-11,
];

/// Those of the arctangent.
const ARCTANGENT: [f64; 11] = [
    0.3333333333333293,
    -0.19999999999876483,
    0.14285714272503466,
    -0.11111110405462356,
    0.09090887133436507,
    -0.0769187620504483,
    0.06661073137387531,
    -0.058335701337905735,
    0.049768779946159324,
    -0.036531572744216916,
    0.016285820115365782,
];

/// Angles that the arctangent is taken from, and what a double lacks of them.
const PIVOTS: [[f64; 2]; 4] = [
    [0.4636476090008061, 2.2698777452961687e-17],
    [FRAC_PI_4, 3.061616997868383e-17],
    [0.982793723247329, 1.3903311031230998e-17],
    [FRAC_PI_2, 6.123233995736766e-17],
];

/// Added and taken away, it rounds to a whole number.
const TO_WHOLE: f64 = 1.5 / f64::EPSILON;

/// A quarter turn in two parts, and one over it.
const QUARTER: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];
const PER_QUARTER: f64 = FRAC_2_PI;

/// What a double lacks of half a turn.
const HALF_TURN_REST: f64 = 1.2246467991473532e-16;

/// Fills in sines and cosines of the first `count` angles, radians.
pub fn sincos_all(angles: &Lanes, count: usize, sines: &mut Lanes, cosines: &mut Lanes) {
    let doubts = widely(
        #[inline(always)]
        || sincos_lanes(angles, groups(count), sines, cosines),
    );
    if doubts > 0 {
        for lane in 0..count.min(LANES) {
            if sincos(angles[lane]).doubt {
                (sines[lane], cosines[lane]) = libm::sincos(angles[lane]);
            }
        }
    }
}

/// Fills in sines and cosines; gives the number of those that `libm` has to say.
#[inline(always)]
fn sincos_lanes(angles: &Lanes, count: usize, sines: &mut Lanes, cosines: &mut Lanes) -> u64 {
    let mut doubts = 0_u64;
    for lane in 0..count {
        let found = sincos(angles[lane]);
        (sines[lane], cosines[lane]) = (found.sine, found.cosine);
        doubts += u64::from(found.doubt);
    }
    doubts
}

/// Fills in the angles of the first `count` directions, radians, as `libm::atan2` has them.
pub fn atan2_all(y: &Lanes, x: &Lanes, count: usize, angles: &mut Lanes) {
    let doubts = widely(
        #[inline(always)]
        || atan2_lanes(y, x, groups(count), angles),
    );
    if doubts > 0 {
        for lane in 0..count.min(LANES) {
            if atan2(y[lane], x[lane]).1 {
                angles[lane] = libm::atan2(y[lane], x[lane]);
            }
        }
    }
}

/// Fills in angles; gives the number of those that `libm` has to say.
#[inline(always)]
fn atan2_lanes(y: &Lanes, x: &Lanes, count: usize, angles: &mut Lanes) -> u64 {
    let mut doubts = 0_u64;
    for lane in 0..count {
        let (angle, doubt) = atan2(y[lane], x[lane]);
        angles[lane] = angle;
        doubts += u64::from(doubt);
    }
    doubts
}

/// Sine and cosine, and whether `libm` has to say them.
struct SineCosine {
    sine: f64,
    cosine: f64,
    doubt: bool,
}

#[inline(always)]
fn sincos(x: f64) -> SineCosine {
    let shifted = x * PER_QUARTER + TO_WHOLE;
    let quarters = shifted.to_bits();
    let count = shifted - TO_WHOLE;
    // Without a whole quarter turn: the angle itself, by the same operations.
    let long = x - count * QUARTER[0];
    let short = count * QUARTER[1];
    let y = long - short;
    let rest = (long - y) - short;
    let z = y * y;
    let square = z * z;
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let odd = s2 + z * (s3 + z * s4) + z * square * (s5 + z * s6);
    let cube = z * y;
    // The shorter form where nothing was taken away.
    let unreduced = y + cube * (s1 + z * odd);
    let reduced = y - ((z * (0.5 * rest - cube * odd) - rest) - cube * s1);
    let sine = if count == 0.0 { unreduced } else { reduced };
    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let even = z * (c1 + z * (c2 + z * c3)) + square * square * (c4 + z * (c5 + z * c6));
    let half = 0.5 * z;
    let whole = 1.0 - half;
    let cosine = whole + (((1.0 - whole) - half) + (z * even - y * rest));
    let (a, b) = if quarters & 1 != 0 { (cosine, sine) } else { (sine, cosine) };
    let signs = [(quarters & 2) << 62, ((quarters & 1) ^ (quarters >> 1 & 1)) << 63];
    let near_a_seam = (y.abs() < 1e-4) | (y.abs() < x.abs() * 3.1e-5) | (y.abs() > 0.785_38);
    SineCosine {
        sine: f64::from_bits(a.to_bits() ^ signs[0]),
        cosine: f64::from_bits(b.to_bits() ^ signs[1]),
        doubt: near_a_seam | (x.abs() > 1000.0) | x.is_nan(),
    }
}

/// The angle, and whether `libm` has to say it.
#[inline(always)]
fn atan2(y: f64, x: f64) -> (f64, bool) {
    let choose = |test: bool, one: f64, other: f64| if test { one } else { other };
    let t = (y / x).abs();
    let (b0, b1, b2, b3) = (t < 0.4375, t < 0.6875, t < 1.1875, t < 2.4375);
    let (from_half, from_one) = (2.0 * t - 1.0, t - 1.0);
    let over = choose(b2, from_one, choose(b3, t - 1.5, -1.0));
    let over = choose(b0, t, choose(b1, from_half, over));
    let under = choose(b2, t + 1.0, choose(b3, 1.0 + 1.5 * t, t));
    let under = choose(b0, 1.0, choose(b1, 2.0 + t, under));
    let [p0, p1, p2, p3] = PIVOTS;
    let pivot = |part: usize| {
        let far = choose(b2, p1[part], choose(b3, p2[part], p3[part]));
        choose(b1, p0[part], far)
    };
    let u = over / under;
    let z = u * u;
    let w = z * z;
    let a = ARCTANGENT;
    let even = z * (a[0] + w * (a[2] + w * (a[4] + w * (a[6] + w * (a[8] + w * a[10])))));
    let odd = w * (a[1] + w * (a[3] + w * (a[5] + w * (a[7] + w * a[9]))));
    let turned = u * (even + odd);
    let angle = choose(b0, u - turned, pivot(0) - (turned - pivot(1) - u));
    let beyond = PI - (angle - HALF_TURN_REST);
    let angle = choose(x < 0.0, beyond, angle);
    let signed = f64::from_bits(angle.to_bits() | (y.to_bits() & (1 << 63)));
    // Zeros, what is not finite or tiny; and where nothing is divided.
    (signed, (t <= 1e-8) | (t >= 1e15) | t.is_nan() | (x == 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_testkit::randomised;

    #[test]
    fn sines_cosines_and_angles_are_those_of_libm() {
        let (rounds, mut rng) = randomised(4000, 1);
        for round in rounds {
            let mut lanes = [[0.0; LANES]; 2];
            for lane in 0..LANES {
                let x = match round % 5 {
                    0 => rng.range(-4.0, 4.0),
                    1 => rng.range(-7.0, 7.0),
                    2 => rng.range(-2000.0, 2000.0),
                    // Printed angles, quarter turns among them.
                    3 => libm::rint(rng.range(-720.0, 720.0) * 1e3) * 1e-3 * 1f64.to_radians(),
                    _ => libm::rint(rng.range(-8.0, 8.0)) * std::f64::consts::FRAC_PI_4,
                };
                lanes[0][lane] = x;
                lanes[1][lane] = match round % 4 {
                    0 => rng.range(-0.5, 0.5),
                    1 => rng.range(-1e-3, 1e-3),
                    2 => rng.range(-1.0, 1.0) * x,
                    _ => *rng.choose(&[0.0, -0.0, 1.0, -1.0, x, f64::NAN, 1e300, 1e-300]),
                };
            }
            let [x, y] = &lanes;
            let [mut sines, mut cosines, mut angles] = [[0.0; LANES]; 3];
            let count = 1 + rng.pick(LANES);
            sincos_all(x, count, &mut sines, &mut cosines);
            atan2_all(y, x, count, &mut angles);
            for lane in 0..count {
                let (sine, cosine) = libm::sincos(x[lane]);
                assert_eq!(sines[lane].to_bits(), sine.to_bits(), "sin {:e}", x[lane]);
                assert_eq!(cosines[lane].to_bits(), cosine.to_bits(), "cos {:e}", x[lane]);
                let angle = libm::atan2(y[lane], x[lane]);
                let same = angles[lane].to_bits() == angle.to_bits();
                assert!(
                    same || angle.is_nan() && angles[lane].is_nan(),
                    "{:e} {:e}",
                    y[lane],
                    x[lane]
                );
            }
        }
    }
}
