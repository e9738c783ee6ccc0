//! Bounds on the value of an expression while its names stay within bounds of their own.
//!
//! Each operation is bounded by itself (interval arithmetic): bounds hold, but where a name stands twice they need not
//! be close. Rounding in the last bits is not in them.

use super::{Expression, Function, Operator, Term};

/// Least and largest value.
pub type Bounds = [f64; 2];

/// Nothing is known.
pub(super) const ANY: Bounds = [f64::NEG_INFINITY, f64::INFINITY];

impl Expression {
    /// Bounds on the value, with `name` giving those of each name but `pi`; infinite where the expression has no value
    /// somewhere between them.
    pub fn bounds(&self, name: &dyn Fn(&str) -> Option<Bounds>) -> Bounds {
        let [least, most] = match &self.term {
            Term::Number(value) => [*value; 2],
            Term::Name(pi) if pi == "pi" => [std::f64::consts::PI; 2],
            Term::Name(other) => name(other).unwrap_or(ANY),
            Term::Negative(operand) => negative(operand.bounds(name)),
            Term::Binary(left, operator, right) => {
                operator.bounds(left.bounds(name), right.bounds(name))
            }
            Term::Call(function, arguments) => {
                let arguments: Vec<Bounds> =
                    arguments.iter().map(|argument| argument.bounds(name)).collect();
                function.bounds(&arguments)
            }
        };
        // Of infinite bounds some sums and products are none.
        if least <= most { [least, most] } else { ANY }
    }
}

impl Operator {
    pub(super) fn bounds(self, left: Bounds, right: Bounds) -> Bounds {
        match self {
            Self::Add => [left[0] + right[0], left[1] + right[1]],
            Self::Subtract => [left[0] - right[1], left[1] - right[0]],
            Self::Multiply => corners(left, right, |a, b| a * b),
            Self::Divide if holds(right, 0.0) => ANY,
            Self::Divide => corners(left, right, |a, b| a / b),
            Self::Power => power(left, right),
        }
    }
}

impl Function {
    pub(super) fn bounds(self, arguments: &[Bounds]) -> Bounds {
        let x = arguments[0];
        let whole = |function: Self| corners(x, x, |a, _| function.value(&[a]));
        match self {
            Self::Sqrt if x[0] < 0.0 => ANY,
            Self::Asin | Self::Acos if x[0] < -1.0 || x[1] > 1.0 => ANY,
            // Poles of the tangent.
            Self::Tan if passes(x, 90.0, 180.0) => ANY,
            Self::Sqrt | Self::Asin | Self::Acos | Self::Atan | Self::Tan => whole(self),
            Self::Sin => wave(x, 90.0),
            Self::Cos => wave(x, 0.0),
            Self::Atan2 => {
                let (y, x) = (x, arguments[1]);
                match x[0] > 0.0 || !holds(y, 0.0) {
                    true => corners(y, x, |y, x| Self::Atan2.value(&[y, x])),
                    false => [-180.0, 180.0],
                }
            }
            Self::Abs if holds(x, 0.0) => [0.0, x[1].max(-x[0])],
            Self::Abs => whole(self),
            Self::Min => arguments.iter().fold(x, |m, a| [m[0].min(a[0]), m[1].min(a[1])]),
            Self::Max => arguments.iter().fold(x, |m, a| [m[0].max(a[0]), m[1].max(a[1])]),
        }
    }
}

fn negative([least, most]: Bounds) -> Bounds {
    [-most, -least]
}

pub(super) fn holds([least, most]: Bounds, value: f64) -> bool {
    least <= value && value <= most
}

/// Least and largest of what a function of two values has at their ends: all that it has between them, where it only
/// rises or only falls along each.
pub(super) fn corners(a: Bounds, b: Bounds, of: impl Fn(f64, f64) -> f64) -> Bounds {
    let values = [of(a[0], b[0]), of(a[0], b[1]), of(a[1], b[0]), of(a[1], b[1])];
    if values.iter().any(|value| value.is_nan()) {
        return ANY;
    }
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

fn power(base: Bounds, exponent: Bounds) -> Bounds {
    let of = |a: f64, b: f64| libm::pow(a, b);
    let [first, last] = exponent;
    let whole = first == last && first == libm::rint(first) && first >= 0.0;
    if base[0] > 0.0 || whole && (base[0] == 0.0 || first % 2.0 == 1.0) {
        return corners(base, exponent, of);
    }
    if whole && first > 0.0 {
        return match holds(base, 0.0) {
            true => [0.0, of(base[0], first).max(of(base[1], first))],
            false => corners(base, exponent, of),
        };
    }
    match whole {
        true => [1.0, 1.0],
        false => ANY,
    }
}

/// Whether one of `place`, `place` ± `period`, … lies within bounds.
fn passes([least, most]: Bounds, place: f64, period: f64) -> bool {
    place + period * libm::ceil((least - place) / period) <= most
}

/// Bounds of a wave that is 1 at `crest` degrees and every 360 from there, and -1 halfway between.
fn wave(x: Bounds, crest: f64) -> Bounds {
    let at = |degrees: f64| super::sine_cosine(degrees - crest).1;
    let ends = [at(x[0]), at(x[1])];
    [
        if passes(x, crest + 180.0, 360.0) { -1.0 } else { ends[0].min(ends[1]) },
        if passes(x, crest, 360.0) { 1.0 } else { ends[0].max(ends[1]) },
    ]
}
