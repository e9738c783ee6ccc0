//! Expressions that are sums of multiples of names.

use super::{Expression, Operator, Term};

/// A sum of multiples of names, and a number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearForm {
    /// Each name once, with what it is multiplied by.
    pub terms: Vec<(String, f64)>,
    /// What is added.
    pub constant: f64,
}

impl LinearForm {
    fn number(constant: f64) -> Self {
        Self { terms: Vec::new(), constant }
    }

    /// The number that it is; none if it has terms.
    fn alone(&self) -> Option<f64> {
        self.terms.is_empty().then_some(self.constant)
    }

    fn times(mut self, factor: f64) -> Self {
        self.terms.iter_mut().for_each(|(_, multiple)| *multiple *= factor);
        self.constant *= factor;
        self
    }

    fn plus(mut self, other: Self) -> Self {
        for (name, multiple) in other.terms {
            match self.terms.iter_mut().find(|(known, _)| *known == name) {
                Some((_, own)) => *own += multiple,
                None => self.terms.push((name, multiple)),
            }
        }
        self.constant += other.constant;
        self
    }
}

impl Expression {
    /// The expression as a sum of multiples of names, with `value` giving that of each name which is a number; none where
    /// it is no such sum.
    pub fn linear_form(&self, value: &dyn Fn(&str) -> Option<f64>) -> Option<LinearForm> {
        let number = |expression: &Self| expression.evaluate(value).ok().map(LinearForm::number);
        match &self.term {
            Term::Name(name) if name != "pi" && value(name).is_none() => {
                Some(LinearForm { terms: vec![(name.clone(), 1.0)], constant: 0.0 })
            }
            Term::Number(_) | Term::Name(_) | Term::Call(..) => number(self),
            Term::Negative(operand) => Some(operand.linear_form(value)?.times(-1.0)),
            Term::Binary(left, operator, right) => {
                let (left, right) = (left.linear_form(value)?, right.linear_form(value)?);
                match operator {
                    Operator::Add => Some(left.plus(right)),
                    Operator::Subtract => Some(left.plus(right.times(-1.0))),
                    Operator::Multiply => match (left.alone(), right.alone()) {
                        (Some(factor), _) => Some(right.times(factor)),
                        (_, Some(factor)) => Some(left.times(factor)),
                        _ => None,
                    },
                    Operator::Divide => {
                        let divisor = right.alone().filter(|divisor| *divisor != 0.0)?;
                        Some(left.times(1.0 / divisor))
                    }
                    Operator::Power => number(self),
                }
            }
        }
    }
}
