//! Bounds on how the value of an expression changes with quantities that its names depend on, while these stay within bounds
//! of their own: the rules of differentiation, each operation bounded by itself as in `bounds`.

use super::bounds::{ANY, Bounds, corners, holds};
use super::{Expression, Function, Operator, Term};

/// Degrees in a radian: functions count in degrees.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Bounds on a value, and on its rates by `N` quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope<const N: usize> {
    /// Least and largest value.
    pub value: Bounds,
    /// Least and largest change of the value for one unit of each quantity.
    pub rates: [Bounds; N],
}

impl<const N: usize> Slope<N> {
    /// Nothing is known.
    const ANY: Self = Self { value: ANY, rates: [ANY; N] };

    /// A value that hangs on no quantity.
    pub fn constant(value: f64) -> Self {
        Self { value: [value; 2], rates: [[0.0; 2]; N] }
    }

    /// A value that changes by `partials` with others.
    fn chained<const M: usize>(value: Bounds, partials: [(Bounds, &Self); M]) -> Self {
        let rates = std::array::from_fn(|quantity| {
            let sum = partials.iter().fold([0.0; 2], |sum: Bounds, (partial, of)| {
                let rate = of.rates[quantity];
                // What nothing is known of, times nothing, is nothing.
                let part = match rate == [0.0; 2] {
                    true => rate,
                    false => corners(*partial, rate, |a, b| a * b),
                };
                [sum[0] + part[0], sum[1] + part[1]]
            });
            if sum[0] <= sum[1] { sum } else { ANY }
        });
        Self { value, rates }
    }

    fn is_constant(&self) -> bool {
        self.rates == [[0.0; 2]; N]
    }
}

impl Expression {
    /// Bounds on value and rates, with `name` giving those of each name but `pi`; infinite where the expression has no value,
    /// or no rate, somewhere between them.
    pub fn slope<const N: usize>(&self, name: &dyn Fn(&str) -> Option<Slope<N>>) -> Slope<N> {
        let slope = match &self.term {
            Term::Number(value) => Slope::constant(*value),
            Term::Name(pi) if pi == "pi" => Slope::constant(std::f64::consts::PI),
            Term::Name(other) => name(other).unwrap_or(Slope::ANY),
            Term::Negative(operand) => {
                let operand = operand.slope(name);
                let [least, most] = operand.value;
                Slope::chained([-most, -least], [([-1.0; 2], &operand)])
            }
            Term::Binary(left, operator, right) => {
                operator.slope(&left.slope(name), &right.slope(name))
            }
            Term::Call(function, arguments) => {
                let arguments: Vec<Slope<N>> =
                    arguments.iter().map(|argument| argument.slope(name)).collect();
                function.slope(&arguments)
            }
        };
        let [least, most] = slope.value;
        if least <= most { slope } else { Slope::ANY }
    }
}

impl Operator {
    fn slope<const N: usize>(self, left: &Slope<N>, right: &Slope<N>) -> Slope<N> {
        let (a, b) = (left.value, right.value);
        let value = self.bounds(a, b);
        let [by_left, by_right] = match self {
            Self::Add => [[1.0; 2]; 2],
            Self::Subtract => [[1.0; 2], [-1.0; 2]],
            Self::Multiply => [b, a],
            Self::Divide if holds(b, 0.0) => [ANY; 2],
            Self::Divide => {
                let by_right = corners(value, b, |quotient, b| -quotient / b);
                [corners([1.0; 2], b, |one, b| one / b), by_right]
            }
            Self::Power if right.is_constant() => {
                let less = self.bounds(a, [b[0] - 1.0, b[1] - 1.0]);
                [corners(b, less, |b, less| b * less), ANY]
            }
            Self::Power => [ANY; 2],
        };
        Slope::chained(value, [(by_left, left), (by_right, right)])
    }
}

impl Function {
    fn slope<const N: usize>(self, arguments: &[Slope<N>]) -> Slope<N> {
        let values: Vec<Bounds> = arguments.iter().map(|argument| argument.value).collect();
        let value = self.bounds(&values);
        let x = values[0];
        let falling = |of: &dyn Fn(f64) -> f64| corners(x, x, |x, _| of(x));
        let wave = |function: Self, sign: f64| {
            let [least, most] = function.bounds(&[x]);
            corners([least, most], [sign / DEGREES; 2], |a, b| a * b)
        };
        // Of a function whose rate is largest in the middle of its range.
        let squares = Operator::Power.bounds(x, [2.0; 2]);
        let by = match self {
            Self::Atan2 => return turning(value, &arguments[0], &arguments[1]),
            Self::Min | Self::Max => return one_of(value, arguments),
            Self::Sqrt if x[0] <= 0.0 => ANY,
            Self::Sqrt => falling(&|x| 0.5 / x.sqrt()),
            Self::Sin => wave(Self::Cos, 1.0),
            Self::Cos => wave(Self::Sin, -1.0),
            Self::Tan => {
                let squares = Operator::Power.bounds(value, [2.0; 2]);
                squares.map(|square| (1.0 + square) / DEGREES)
            }
            Self::Asin | Self::Acos if squares[1] >= 1.0 => ANY,
            Self::Asin => squares.map(|square| DEGREES / (1.0 - square).sqrt()),
            Self::Acos => {
                let [least, most] = squares.map(|square| -DEGREES / (1.0 - square).sqrt());
                [most, least]
            }
            Self::Atan => {
                let [least, most] = squares.map(|square| DEGREES / (1.0 + square));
                [most, least]
            }
            Self::Abs if x[0] >= 0.0 => [1.0; 2],
            Self::Abs if x[1] <= 0.0 => [-1.0; 2],
            Self::Abs => [-1.0, 1.0],
        };
        Slope::chained(value, [(by, &arguments[0])])
    }
}

/// The direction of (`x`, `y`).
fn turning<const N: usize>(value: Bounds, y: &Slope<N>, x: &Slope<N>) -> Slope<N> {
    let square = |of: Bounds| Operator::Power.bounds(of, [2.0; 2]);
    let far = Operator::Add.bounds(square(x.value), square(y.value));
    let [by_y, by_x] = match x.value[0] > 0.0 || !holds(y.value, 0.0) {
        true => [(x.value, DEGREES), (y.value, -DEGREES)]
            .map(|(part, unit)| corners(part, far, |part, far| unit * part / far)),
        // The value jumps where the turn ends.
        false => [ANY; 2],
    };
    Slope::chained(value, [(by_y, y), (by_x, x)])
}

/// The least or the largest of some: it changes as one of them does.
fn one_of<const N: usize>(value: Bounds, arguments: &[Slope<N>]) -> Slope<N> {
    let rates = std::array::from_fn(|quantity| {
        let rates = arguments.iter().map(|argument| argument.rates[quantity]);
        rates.fold([f64::INFINITY, f64::NEG_INFINITY], |all: Bounds, rate| {
            [all[0].min(rate[0]), all[1].max(rate[1])]
        })
    });
    Slope { value, rates }
}
