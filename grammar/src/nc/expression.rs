//! Expressions of the controls' languages, as written: who runs the program works them out.

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub enum NcExpression {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// A variable, in capitals: `#1`, `#<NAME>`, `R1`, `Q120`, `_Z_HOME`, `$P_UIFR`.
    Variable(String),
    /// `#[#1+2]`, `R[R1]`, `FIELD[2]`: a variable by a number that is worked out.
    Indexed {
        /// `#`, `R`, or the field's name.
        name: String,
        /// Which.
        index: Box<NcExpression>,
    },
    /// `-x`, `NOT x`.
    Unary(UnaryOperator, Box<NcExpression>),
    /// `x + y`.
    Binary(BinaryOperator, Box<NcExpression>, Box<NcExpression>),
    /// `SIN[x]`, `ATAN[y]/[x]` with two arguments, `MOD`.
    Function {
        /// Name in capitals.
        name: String,
        /// Arguments of the function.
        arguments: Vec<NcExpression>,
    },
}

/// An operator of one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryOperator {
    /// `-`.
    Minus,
    /// `NOT`.
    Not,
}

/// An operator of two sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum BinaryOperator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    WholeQuotient,
    Power,
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    And,
    Or,
    Xor,
    /// `<<` of Siemens: texts one after the other.
    Join,
}
