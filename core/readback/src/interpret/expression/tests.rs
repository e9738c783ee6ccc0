//! Expressions against a second evaluation, over random values, and what is refused.

use post_grammar::nc::{BinaryOperator as B, NcExpression as E, UnaryOperator};
use post_testkit::{Rng, seeded};

use super::*;

fn variables(language: Language) -> Variables {
    let mut variables = Variables::new(language);
    for (name, value) in [("R1", 2.5), ("R2", -4.0), ("Q7", 0.25), ("#100", 12.0)] {
        variables.put(name, VariableValue::Number(value)).unwrap();
    }
    variables
}

fn of(name: &str, arguments: &[f64]) -> E {
    E::Function {
        name: name.to_owned(),
        arguments: arguments.iter().map(|value| E::Number(*value)).collect(),
    }
}

fn binary(operator: B, left: f64, right: f64) -> E {
    E::Binary(operator, Box::new(E::Number(left)), Box::new(E::Number(right)))
}

/// A random expression, and its value by a stack machine of its own: the tree is never asked.
fn random(random: &mut Rng, depth: u32, program: &mut Vec<Step>) -> E {
    if depth == 0 || random.range(0.0, 1.0) < 0.2 {
        let value = (random.range(-50.0, 50.0) * 8.0).round() / 8.0;
        program.push(Step::Push(value));
        return E::Number(value);
    }
    match (random.range(0.0, 7.0)) as u32 {
        0 => {
            let inner = self::random(random, depth - 1, program);
            program.push(Step::Negate);
            E::Unary(UnaryOperator::Minus, Box::new(inner))
        }
        1 => {
            let inner = self::random(random, depth - 1, program);
            program.push(Step::Sine);
            E::Function { name: "SIN".to_owned(), arguments: vec![inner] }
        }
        which => {
            let operator =
                [B::Add, B::Subtract, B::Multiply, B::Less, B::Divide][(which as usize - 2) % 5];
            let left = self::random(random, depth - 1, program);
            let right = self::random(random, depth - 1, program);
            program.push(Step::Two(operator));
            E::Binary(operator, Box::new(left), Box::new(right))
        }
    }
}

#[derive(Clone, Copy)]
enum Step {
    Push(f64),
    Negate,
    Sine,
    Two(B),
}

/// None where a control would stop.
fn stacked(program: &[Step]) -> Option<f64> {
    let mut stack: Vec<f64> = Vec::new();
    for step in program {
        let value = match step {
            Step::Push(value) => *value,
            Step::Negate => -stack.pop()?,
            Step::Sine => libm::sin(stack.pop()?.to_radians()),
            Step::Two(operator) => {
                let (right, left) = (stack.pop()?, stack.pop()?);
                match operator {
                    B::Add => left + right,
                    B::Subtract => left - right,
                    B::Multiply => left * right,
                    B::Divide if right == 0.0 => return None,
                    B::Divide => left / right,
                    _ => f64::from(u8::from(left < right)),
                }
            }
        };
        if !value.is_finite() {
            return None;
        }
        stack.push(value);
    }
    stack.pop()
}

#[test]
fn random_expressions_agree_with_a_stack_machine() {
    let mut dice = seeded(11);
    let variables = variables(Language::Rs274);
    let mut worked = 0;
    for _ in 0..20_000 {
        let mut program = Vec::new();
        let expression = random(&mut dice, 6, &mut program);
        let expected = stacked(&program);
        let found = variables.number(&expression).ok();
        match (found, expected) {
            (Some(found), Some(expected)) => {
                worked += 1;
                let close = (found - expected).abs() <= 1e-9 * expected.abs().max(1.0);
                assert!(close, "{found} for {expected}: {expression:?}");
            }
            (None, None) => {}
            other => panic!("{other:?}: {expression:?}"),
        }
    }
    assert!(worked > 15_000, "{worked}");
}

#[test]
fn functions_answer_in_degrees() {
    let cases = [
        (Language::Macro, "SIN", &[30.0][..], 0.5),
        (Language::Names, "ATAN2", &[30.5, 80.1], 20.8455),
        (Language::Names, "ATAN2", &[-1.0, -1.0], -135.0),
        (Language::Rs274, "ATAN", &[-1.0, -1.0], -135.0),
        (Language::Conversational, "ANG", &[-1.0, -1.0], 225.0),
        (Language::Conversational, "LEN", &[3.0, 4.0], 5.0),
        (Language::Names, "POT", &[3.0], 9.0),
        (Language::Conversational, "FRAC", &[-2.25], -0.25),
        (Language::Rs274, "FIX", &[-2.25], -3.0),
        (Language::Rs274, "FUP", &[-2.25], -2.0),
        (Language::Macro, "FIX", &[-2.25], -2.0),
        (Language::Macro, "FUP", &[-2.25], -3.0),
        (Language::Macro, "ROUND", &[2.5], 3.0),
        (Language::Names, "BOUND", &[-1.0, 1.0, 5.0], 1.0),
        (Language::Names, "ACOS", &[0.5], 60.0),
    ];
    for (language, name, arguments, expected) in cases {
        let found = variables(language).number(&of(name, arguments)).unwrap();
        assert!((found - expected).abs() < 1e-4, "{name} of {arguments:?}: {found}");
    }
}

#[test]
fn what_controls_answer_differently_is_refused() {
    let refused =
        |language: Language, expression: &E| variables(language).number(expression).is_err();
    assert!(refused(Language::Macro, &of("ATAN", &[-1.0, 2.0])), "0 to 360 or -180 to 180");
    assert!(refused(Language::Names, &binary(B::Remainder, -5.0, 3.0)));
    assert!(!refused(Language::Names, &binary(B::Remainder, 5.0, 3.0)));
    // 0.1 + 0.2 against 0.3: equal on a control with twelve digits, not in doubles.
    let sum = E::Binary(B::Equal, Box::new(binary(B::Add, 0.1, 0.2)), Box::new(E::Number(0.3)));
    assert!(refused(Language::Macro, &sum));
    assert_eq!(variables(Language::Rs274).number(&sum).ok(), Some(1.0), "within 0.0001 there");
    assert!(
        refused(Language::Macro, &of("ROUND", &[-2.5]))
            || variables(Language::Macro).number(&of("ROUND", &[-2.5])).is_ok()
    );
}

#[test]
fn what_is_no_number_is_refused() {
    let refused = |expression: &E| variables(Language::Names).number(expression).is_err();
    for expression in [
        binary(B::Divide, 1.0, 0.0),
        binary(B::Remainder, 1.0, 0.0),
        binary(B::WholeQuotient, 1.0, 0.0),
        binary(B::Power, -2.0, 0.5),
        binary(B::Power, 1e300, 2.0),
        of("SQRT", &[-1.0]),
        of("ASIN", &[1.5]),
        of("TAN", &[90.0]),
        of("LN", &[0.0]),
        of("NOBODY", &[1.0]),
        E::Text("D10".to_owned()),
        E::Variable("$P_TOOLNO".to_owned()),
        E::Variable("R99".to_owned()),
    ] {
        assert!(refused(&expression), "{expression:?}");
    }
}

#[test]
fn nesting_has_a_bound() {
    let mut expression = E::Number(1.0);
    for _ in 0..5000 {
        expression = E::Unary(UnaryOperator::Minus, Box::new(expression));
    }
    assert!(variables(Language::Macro).number(&expression).is_err());
    // Taken apart without recursion.
    while let E::Unary(_, inner) = expression {
        expression = *inner;
    }
}

#[test]
fn variables_are_found_by_number_too() {
    let names = variables(Language::Names);
    let indexed = E::Indexed { name: "R".to_owned(), index: Box::new(E::Number(2.0)) };
    assert_eq!(names.number(&indexed).ok(), Some(-4.0));
    assert_eq!(names.number(&E::Variable("R01".to_owned())).ok(), Some(2.5));
    let broken = E::Indexed { name: "R".to_owned(), index: Box::new(E::Number(1.5)) };
    assert!(names.number(&broken).is_err());
    let hash = variables(Language::Macro);
    let indexed =
        E::Indexed { name: "#".to_owned(), index: Box::new(binary(B::Multiply, 50.0, 2.0)) };
    assert_eq!(hash.number(&indexed).ok(), Some(12.0));
}

#[test]
fn logic_is_of_bits_with_fanuc_alone() {
    let worth = |language, operator, left, right| {
        variables(language).number(&binary(operator, left, right)).ok()
    };
    assert_eq!(worth(Language::Macro, B::And, 6.0, 3.0), Some(2.0));
    assert_eq!(worth(Language::Rs274, B::And, 6.0, 3.0), Some(1.0));
    assert_eq!(worth(Language::Macro, B::Xor, 1.0, 1.0), Some(0.0));
    assert_eq!(worth(Language::Macro, B::Or, -1.0, 4.0), None);
}
