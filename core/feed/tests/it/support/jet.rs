//! Numbers with three derivatives: sums, products and functions of them by the rules for power series.

use std::ops::{Add, Mul, Neg, Sub};

/// Coefficients of a power series to third order.
#[derive(Clone, Copy, Debug)]
pub struct Jet([f64; 4]);

const FACTORIALS: [f64; 4] = [1.0, 1.0, 2.0, 6.0];

impl Jet {
    pub fn from_derivatives(values: [f64; 4]) -> Self {
        Self(std::array::from_fn(|order| values[order] / FACTORIALS[order]))
    }

    pub fn derivatives(self) -> [f64; 4] {
        std::array::from_fn(|order| self.0[order] * FACTORIALS[order])
    }

    pub fn sqrt(self) -> Self {
        let a = self.0;
        let mut r = [a[0].sqrt(), 0.0, 0.0, 0.0];
        for n in 1..4 {
            let cross: f64 = (1..n).map(|k| r[k] * r[n - k]).sum();
            r[n] = (a[n] - cross) / (2.0 * r[0]);
        }
        Self(r)
    }

    pub fn sin_cos(self) -> (Self, Self) {
        let a = self.0;
        let (sin, cos) = libm::sincos(a[0]);
        let (mut s, mut c) = ([sin, 0.0, 0.0, 0.0], [cos, 0.0, 0.0, 0.0]);
        for n in 1..4 {
            let sum =
                |r: &[f64; 4]| (1..=n).map(|k| k as f64 * a[k] * r[n - k]).sum::<f64>() / n as f64;
            (s[n], c[n]) = (sum(&c), -sum(&s));
        }
        (Self(s), Self(c))
    }

    /// The angle whose tangent is `self / x`: its slope is `(x y' - y x') / (x² + y²)`.
    pub fn atan2(self, x: Self) -> Self {
        let slope = |a: Jet| Jet([a.0[1], 2.0 * a.0[2], 3.0 * a.0[3], 0.0]);
        let top = x * slope(self) - self * slope(x);
        let bottom = x * x + self * self;
        let mut quotient = [0.0; 4];
        for n in 0..3 {
            let known: f64 = (0..n).map(|k| quotient[k] * bottom.0[n - k]).sum();
            quotient[n] = (top.0[n] - known) / bottom.0[0];
        }
        let angle = libm::atan2(self.0[0], x.0[0]);
        Self([angle, quotient[0], quotient[1] / 2.0, quotient[2] / 3.0])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|n| self.0[n] + other.0[n]))
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|n| (0..=n).map(|k| self.0[k] * other.0[n - k]).sum()))
    }
}
