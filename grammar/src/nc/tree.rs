//! Operands and operators in a row become a tree, without recursion.

use super::expression::{BinaryOperator, NcExpression};
use super::fault::Unreadable;

/// Operators of one expression: more are no program's.
const MOST_OPERATORS: usize = 256;

/// Whose rules say which operator binds first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Precedence {
    /// Comparisons before `AND`, `OR`, `XOR`, as LinuxCNC has them. Fanuc lets `AND` bind like `*`, and `OR` like `+`:
    /// where the two would differ, brackets are asked for.
    Hash,
    /// `AND` before `XOR` before `OR` before comparisons, as Siemens has them: where one who knows other languages
    /// would expect the contrary, parentheses are asked for.
    Names,
    /// Arithmetic only.
    Conversational,
}

/// What an operand is made of, its brackets aside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OperandForm {
    /// One thing, or one in brackets.
    Whole,
    /// One thing with a sign in front.
    Signed,
    Arithmetic,
    Comparison,
    Logic(BinaryOperator),
}

/// An expression that is being put together: operand, operator, operand …
#[derive(Debug)]
pub(super) struct ExpressionTree {
    rules: Precedence,
    operands: Vec<(NcExpression, OperandForm)>,
    operators: Vec<BinaryOperator>,
    count: usize,
}

impl ExpressionTree {
    pub(super) fn new(rules: Precedence) -> Self {
        Self { rules, operands: Vec::new(), operators: Vec::new(), count: 0 }
    }

    /// The next operand; `signed` where a sign stands in front of it.
    pub(super) fn operand(&mut self, operand: NcExpression, signed: bool) {
        let made = if signed { OperandForm::Signed } else { OperandForm::Whole };
        self.operands.push((operand, made));
    }

    /// Takes the operator after it.
    pub(super) fn operator(&mut self, spelling: &str) -> Result<(), Unreadable> {
        let Some(operator) = operator(spelling) else {
            return Err(Unreadable::new(format!("`{spelling}` is no operator")));
        };
        self.count += 1;
        if self.count > MOST_OPERATORS {
            let message = format!("an expression of more than {MOST_OPERATORS} operators");
            return Err(Unreadable::new(message));
        }
        while let Some(&before) = self.operators.last()
            && self.binds(before) >= self.binds(operator)
        {
            self.join()?;
        }
        self.operators.push(operator);
        Ok(())
    }

    /// The whole.
    pub(super) fn finish(mut self) -> Result<NcExpression, Unreadable> {
        while !self.operators.is_empty() {
            self.join()?;
        }
        match self.operands.pop() {
            Some((whole, _)) => Ok(whole),
            None => Err(Unreadable::new("a value is missing")),
        }
    }

    /// The last operator takes its two operands.
    fn join(&mut self) -> Result<(), Unreadable> {
        let (Some(operator), Some(right), Some(left)) =
            (self.operators.pop(), self.operands.pop(), self.operands.pop())
        else {
            return Err(Unreadable::new("an operator lacks a value"));
        };
        self.allow(operator, left.1, right.1)?;
        let made = match operator {
            _ if is_comparison(operator) => OperandForm::Comparison,
            _ if is_logic(operator) => OperandForm::Logic(operator),
            _ => OperandForm::Arithmetic,
        };
        let whole = NcExpression::Binary(operator, Box::new(left.0), Box::new(right.0));
        self.operands.push((whole, made));
        Ok(())
    }

    /// Refuses what controls read differently.
    fn allow(
        &self,
        operator: BinaryOperator,
        left: OperandForm,
        right: OperandForm,
    ) -> Result<(), Unreadable> {
        let both = [left, right];
        let doubtful = if operator == BinaryOperator::Power {
            left == OperandForm::Signed
        } else if is_comparison(operator) {
            both.iter().any(|made| matches!(made, OperandForm::Comparison | OperandForm::Logic(_)))
        } else if is_logic(operator) && self.rules == Precedence::Hash {
            both.iter().any(|made| match made {
                OperandForm::Arithmetic => true,
                OperandForm::Logic(other) => *other != operator,
                _ => false,
            }) || both.contains(&OperandForm::Comparison) && both.contains(&OperandForm::Whole)
        } else {
            false
        };
        if doubtful {
            return Err(Unreadable::new(
                "controls do not agree which of these operators binds first",
            )
            .help("brackets around what belongs together"));
        }
        Ok(())
    }

    /// How tightly an operator binds.
    fn binds(&self, operator: BinaryOperator) -> u8 {
        use BinaryOperator as B;
        match operator {
            B::Power => 9,
            B::Multiply | B::Divide | B::Remainder | B::WholeQuotient => 8,
            B::Add | B::Subtract => 7,
            B::And | B::Or | B::Xor if self.rules == Precedence::Hash => 1,
            B::And => 6,
            B::Xor => 5,
            B::Or => 4,
            B::Join => 3,
            B::Equal | B::NotEqual | B::Less | B::LessOrEqual | B::Greater | B::GreaterOrEqual => 2,
        }
    }
}

fn is_comparison(operator: BinaryOperator) -> bool {
    use BinaryOperator as B;
    matches!(
        operator,
        B::Equal | B::NotEqual | B::Less | B::LessOrEqual | B::Greater | B::GreaterOrEqual
    )
}

fn is_logic(operator: BinaryOperator) -> bool {
    use BinaryOperator as B;
    matches!(operator, B::And | B::Or | B::Xor)
}

/// The operator of any family.
fn operator(spelling: &str) -> Option<BinaryOperator> {
    use BinaryOperator as B;
    Some(match spelling {
        "**" | "^" => B::Power,
        "*" => B::Multiply,
        "/" => B::Divide,
        "MOD" | "%" => B::Remainder,
        "DIV" => B::WholeQuotient,
        "+" => B::Add,
        "-" => B::Subtract,
        "<<" => B::Join,
        "==" | "EQ" | "EQU" => B::Equal,
        "<>" | "NE" => B::NotEqual,
        "<" | "LT" => B::Less,
        "<=" | "LE" => B::LessOrEqual,
        ">" | "GT" => B::Greater,
        ">=" | "GE" => B::GreaterOrEqual,
        "AND" => B::And,
        "OR" => B::Or,
        "XOR" => B::Xor,
        _ => return None,
    })
}
