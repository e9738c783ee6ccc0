//! Expressions of a machine file.

use post_grammar::parse_expression;
use post_testkit::randomised;

fn name(name: &str) -> Option<f64> {
    match name {
        "Zc" => Some(50.004),
        "a_1" => Some(3.0),
        "b" => Some(4.0),
        "huge" => Some(f64::INFINITY),
        _ => None,
    }
}

fn value(text: &str) -> f64 {
    let expression = parse_expression(text).unwrap_or_else(|fault| panic!("{text}: {fault}"));
    expression.evaluate(&name).unwrap_or_else(|fault| panic!("{text}: {fault}"))
}

#[test]
fn values() {
    for (text, expected) in [
        ("50.004", 50.004),
        (" 1. + .5 ", 1.5),
        ("1.5e-3", 0.0015),
        ("2E2", 200.0),
        ("Zc", 50.004),
        ("-Zc", -50.004),
        ("2 + 3 * 4", 14.0),
        ("(2 + 3) * 4", 20.0),
        ("10 - 4 - 3", 3.0),
        ("24 / 4 / 2", 3.0),
        ("2 * -3", -6.0),
        ("1 - -1", 2.0),
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("2*3^2", 18.0),
        ("-a_1*b", -12.0),
        ("sqrt(a_1^2 + b ^ 2)", 5.0),
        ("abs(-3)", 3.0),
        ("min(3, 1, 2)", 1.0),
        ("max(3,1,2)", 3.0),
        ("max(7)", 7.0),
        ("sin(90)", 1.0),
        ("cos(90)", 0.0),
        ("sin(-180)", 0.0),
        ("cos(540)", -1.0),
        ("tan( 45 )", 1.0),
        ("asin(1)", 90.0),
        ("acos(0)", 90.0),
        ("atan(1)", 45.0),
        ("atan2(1, -1)", 135.0),
        ("pi", std::f64::consts::PI),
    ] {
        let found = value(text);
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{text} = {found}");
    }
    assert_eq!(value("cos(90)").to_bits(), 0.0_f64.to_bits());
}

#[test]
fn names_come_once_in_order() {
    let expression = parse_expression("b + sin(Zc) * pi - b / min(c1, _d)").unwrap();
    assert_eq!(expression.names(), ["b", "Zc", "c1", "_d"]);
}

#[test]
fn texts_that_are_no_expression() {
    for (text, at, marked, message) in [
        ("", 0, "", "a number or a name is missing at the end"),
        ("1 +", 3, "", "a number or a name is missing at the end"),
        ("(1 + 2", 6, "", "a `)` is missing"),
        ("1 + 2)", 5, ")", "this `)` closes nothing"),
        ("1 2", 2, "2", "an operator is expected, not `2`"),
        ("1..2", 2, ".", "an operator is expected, not `.`"),
        ("2 * / 3", 4, "/", "a number or a name is expected, not `/`"),
        ("--1", 1, "-", "a number or a name is expected, not `-`"),
        (
            "50,004",
            2,
            ",",
            "a `,` belongs between the arguments of a function; decimals have a point",
        ),
        ("1 + é", 4, "é", "a number or a name is expected, not `é`"),
        ("1e999", 0, "1e999", "this number is too large"),
        ("1 + sinh(2)", 4, "sinh", "there is no function `sinh`"),
        ("sqrt()", 0, "sqrt()", "sqrt takes one argument, 0 given"),
        ("2 * atan2(1)", 4, "atan2(1)", "atan2 takes two arguments, y and x, 1 given"),
        ("min()", 0, "min()", "min takes at least one argument, 0 given"),
    ] {
        let fault = parse_expression(text).expect_err(text);
        let found = (fault.span.start, &text[fault.span.clone()], fault.message.as_str());
        assert_eq!(found, (at, marked, message), "{text}");
    }
}

#[test]
fn depth_and_length_are_bounded() {
    let nested = |depth: usize| format!("{}1{}", "(".repeat(depth), ")".repeat(depth));
    assert_eq!(value(&nested(64)), 1.0);
    assert!(parse_expression(&nested(65)).unwrap_err().message.contains("parentheses"));
    assert_eq!(value(&"1^".repeat(2047)[..4093]), 1.0);
    assert_eq!(value(&"1+".repeat(2047)[..4093]), 2047.0);
    assert!(parse_expression(&"1+".repeat(3000)).unwrap_err().message.contains("bytes"));
}

#[test]
fn expressions_without_a_value() {
    for (text, marked, message) in [
        ("1 + Zd * 2", "Zd", "`Zd` is not known"),
        ("1 + 2 / (1 - 1)", "2 / (1 - 1", "division by zero"),
        ("sqrt(-1)", "sqrt(-1)", "this has no finite value"),
        ("1 + asin(2)", "asin(2)", "this has no finite value"),
        ("tan(90)", "tan(90)", "this has no finite value"),
        ("(-8)^(1/3)", "-8)^(1/3", "this has no finite value"),
        ("10^400", "10^400", "this has no finite value"),
        ("1e300 * 1e300", "1e300 * 1e300", "this has no finite value"),
        ("huge", "huge", "this has no finite value"),
    ] {
        let fault = parse_expression(text).unwrap().evaluate(&name).expect_err(text);
        assert_eq!((&text[fault.span], fault.message.as_str()), (marked, message), "{text}");
    }
}

#[test]
fn any_text_is_read_or_refused() {
    let (rounds, mut rng) = randomised(256, 1);
    for _ in rounds {
        let text = rng.text("([0-9.]{1,4}|[a-z]{1,3}|[\\-+*/^(), ]|sin|atan2\\(|é){0,40}");
        match parse_expression(&text) {
            Ok(expression) => {
                let _ = expression.evaluate(&|_| Some(0.5));
            }
            Err(fault) => assert!(text.get(fault.span).is_some(), "{text:?}"),
        }
    }
}
