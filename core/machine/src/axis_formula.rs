//! Quantities that follow from the values of axes by formulas of the machine file.

use post_grammar::{Bounds, Expression, Slope};

use crate::dependent_limit::Named;
use crate::kinematics::{AxisBits, Joints, MAX_AXES};

/// What the names in a formula stand for.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FormulaNames {
    /// Axes and parameters.
    pub named: Vec<(String, Named)>,
    /// Other formulas, each behind those that it is written with.
    pub formulas: Vec<(String, Expression)>,
}

/// How formulas are worked out: as numbers, bounds or slopes.
trait Working: Copy {
    fn of(expression: &Expression, name: &dyn Fn(&str) -> Option<Self>) -> Option<Self>;
}

impl Working for f64 {
    fn of(expression: &Expression, name: &dyn Fn(&str) -> Option<Self>) -> Option<Self> {
        expression.evaluate(name).ok()
    }
}

impl Working for Bounds {
    fn of(expression: &Expression, name: &dyn Fn(&str) -> Option<Self>) -> Option<Self> {
        Some(expression.bounds(name))
    }
}

impl Working for Slope<MAX_AXES> {
    fn of(expression: &Expression, name: &dyn Fn(&str) -> Option<Self>) -> Option<Self> {
        Some(expression.slope(name))
    }
}

/// The names of a formula, each with what it stands for somewhere.
pub(crate) struct WorkedOut<'a, T> {
    names: &'a FormulaNames,
    named: Vec<T>,
    /// As many as have a value, in their order.
    formulas: Vec<T>,
}

impl<T: Copy> WorkedOut<'_, T> {
    /// What a name stands for.
    pub fn of(&self, name: &str) -> Option<T> {
        let is = |known: &String| known == name;
        let formula = self.names.formulas.iter().position(|(known, _)| is(known));
        match formula {
            Some(place) => self.formulas.get(place).copied(),
            None => {
                let place = self.names.named.iter().position(|(known, _)| is(known))?;
                self.named.get(place).copied()
            }
        }
    }
}

impl FormulaNames {
    /// Places in the chain of the axes that are named, with axis units (mm, radians) in one unit of what the control shows.
    pub fn axes(&self) -> impl Iterator<Item = (usize, f64)> {
        self.named.iter().filter_map(|(_, named)| match named {
            Named::Axis { joint, unit, .. } => Some((*joint, *unit)),
            Named::Parameter(_) => None,
        })
    }

    fn worked_out<T: Working>(&self, of: impl Fn(Named) -> T) -> WorkedOut<'_, T> {
        let named = self.named.iter().map(|(_, named)| of(*named)).collect();
        let mut done = WorkedOut { names: self, named, formulas: Vec::new() };
        for (_, expression) in &self.formulas {
            // One without a value ends it: those behind have none to be told either.
            let Some(value) = T::of(expression, &|name| done.of(name)) else {
                break;
            };
            done.formulas.push(value);
        }
        done
    }

    /// Values at `joints`.
    pub fn at(&self, joints: &Joints) -> WorkedOut<'_, f64> {
        self.worked_out(|named| named.value(joints))
    }

    /// Bounds while each axis stays between its values in `ends`.
    pub fn between(&self, [least, most]: [&Joints; 2]) -> WorkedOut<'_, Bounds> {
        self.worked_out(|named| [named.value(least), named.value(most)])
    }

    /// Bounds on values and rates while each axis stays between its values in `ends`.
    fn slopes(&self, [least, most]: [&Joints; 2]) -> WorkedOut<'_, Slope<MAX_AXES>> {
        self.worked_out(|named| match named {
            Named::Parameter(value) => Slope::constant(value),
            Named::Axis { joint, unit, .. } => {
                let value = [named.value(least), named.value(most)];
                let mut slope = Slope { value, rates: [[0.0; 2]; MAX_AXES] };
                slope.rates[joint] = [1.0 / unit; 2];
                slope
            }
        })
    }
}

/// A formula of axis values.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisFormula {
    names: FormulaNames,
    is: Expression,
}

impl AxisFormula {
    /// What `is` makes of its names.
    pub(crate) fn new(names: FormulaNames, is: Expression) -> Self {
        Self { names, is }
    }

    /// Places in the chain of the axes that it names, one bit each.
    pub fn axes(&self) -> AxisBits {
        self.names.axes().fold(0, |bits, (joint, _)| bits | 1 << joint)
    }

    /// Axis units in one unit of what the control shows of the axis at a place in the chain; 1 of one that it does not name.
    pub fn unit(&self, place: usize) -> f64 {
        let mut named = self.names.axes();
        named.find(|(joint, _)| *joint == place).map_or(1.0, |(_, unit)| unit)
    }

    /// The value at `joints`; none where it has none.
    pub fn value(&self, joints: &Joints) -> Option<f64> {
        let known = self.names.at(joints);
        self.is.evaluate(&|name| known.of(name)).ok()
    }

    /// Bounds on value and rates by axis (in units of the value a mm or a radian) while each axis stays between its values in
    /// `ends`.
    pub fn slope(&self, ends: [&Joints; 2]) -> Slope<MAX_AXES> {
        let known = self.names.slopes(ends);
        self.is.slope(&|name| known.of(name))
    }

    /// Bounds on the value while each axis stays between its values in `ends`: what the operations give, and what the rates do
    /// from the middle. None where it is not proven to have one all over.
    pub fn range(&self, ends: [&Joints; 2]) -> Option<Bounds> {
        let [least, most] = ends;
        let slope = self.slope(ends);
        let middle: Joints = std::array::from_fn(|place| 0.5 * (least[place] + most[place]));
        let value = self.value(&middle)?;
        let strays = slope
            .rates
            .iter()
            .enumerate()
            .map(|(place, rate)| largest(*rate) * 0.5 * libm::fabs(most[place] - least[place]));
        // A rate that is not known matters where its axis moves.
        let stray: f64 = strays.filter(|stray| !stray.is_nan()).sum();
        let range = [slope.value[0].max(value - stray), slope.value[1].min(value + stray)];
        range.iter().all(|end| end.is_finite()).then_some(range)
    }
}

/// The largest size of what lies within bounds.
pub(crate) fn largest([least, most]: Bounds) -> f64 {
    libm::fabs(least).max(libm::fabs(most))
}
