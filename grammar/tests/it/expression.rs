//! Expressions of a machine file.

use post_grammar::{Slope, parse_expression, parse_inequality};
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

/// Formulas of two names, each with its own trap: kinks, poles, waves, whole and broken powers, a name that stands twice.
const OF_TWO: [&str; 16] = [
    "a + 2 * b - 3",
    "a * b",
    "a / (b + 20)",
    "a - a * b",
    "-abs(a) + abs(b - 3)",
    "min(a, b, 1) - max(b, 2, -a)",
    "sin(20 * a) + cos(33 * b)",
    "tan(4 * a)",
    "a^2 - b^3 + a^0",
    "(a + 11)^b",
    "2^(a / 10)",
    "sqrt(a + b + 20)",
    "asin(a / 10) - acos(b / 10)",
    "atan(a) * atan2(b, a)",
    "atan2(a + 10.5, b)",
    "(a - b)^4",
];

#[test]
fn bounds_hold_for_all_values_between_those_of_the_names_and_close_in_on_them() {
    let (rounds, mut random) = randomised(4000, 2);
    'boxes: for _ in rounds {
        let text = OF_TWO[random.pick(OF_TWO.len())];
        let expression = parse_expression(text).expect("it can be read");
        let width = random.order(-7.0, 1.0);
        let boxes = [0, 1].map(|_| {
            let least = random.range(-10.0, 10.0 - width);
            [least, least + width]
        });
        let [least, most] =
            expression.bounds(&|name| Some(if name == "a" { boxes[0] } else { boxes[1] }));
        let mut values = Vec::new();
        for _ in 0..20 {
            let [a, b] = boxes.map(|[least, most]| match random.pick(4) {
                0 => least,
                1 => most,
                _ => random.range(least, most),
            });
            let value = expression.evaluate(&|name| Some(if name == "a" { a } else { b }));
            let Ok(value) = value else {
                // Somewhere it has no value: nothing is known.
                assert!(least == f64::NEG_INFINITY && most == f64::INFINITY, "{text} {boxes:?}");
                continue 'boxes;
            };
            values.push(value);
            let rounding = 1e-9 * (1.0 + value.abs());
            let held = least - rounding <= value && value <= most + rounding;
            assert!(held, "{text} of {a}, {b} in {boxes:?}: {value} outside {least} to {most}");
        }
        // Of small boxes bounds are small: on a pole, or where the angle jumps, they are not.
        if width < 1e-6 && least.is_finite() && !text.starts_with("atan") {
            let steep = values.iter().fold(1.0, |most: f64, value| most.max(value.abs()));
            assert!(most - least < 1e-2 * steep * steep, "{text} in {boxes:?}: {least} to {most}");
        }
    }
}

#[test]
fn slopes_hold_for_all_secants_between_the_bounds_of_the_names() {
    let (rounds, mut random) = randomised(4000, 0x510e);
    let mut told = 0;
    for _ in rounds {
        let text = OF_TWO[random.pick(OF_TWO.len())];
        let expression = parse_expression(text).expect("it can be read");
        let width = random.order(-4.0, 1.0);
        let boxes = [0, 1].map(|_| {
            let least = random.range(-10.0, 10.0 - width);
            [least, least + width]
        });
        let place = |name: &str| usize::from(name == "b");
        let slope = expression.slope(&|name| {
            let mut rates = [[0.0; 2]; 2];
            rates[place(name)] = [1.0; 2];
            Some(Slope { value: boxes[place(name)], rates })
        });
        let value = |at: [f64; 2]| expression.evaluate(&|name| Some(at[place(name)]));
        assert_eq!(slope.value, expression.bounds(&|name| Some(boxes[place(name)])), "{text}");
        for quantity in 0..2 {
            let [least, most] = slope.rates[quantity];
            let from = boxes.map(|[least, most]| random.range(least, most));
            let mut to = from;
            to[quantity] = random.range(boxes[quantity][0], boxes[quantity][1]);
            let way = to[quantity] - from[quantity];
            let (Ok(first), Ok(last)) = (value(from), value(to)) else {
                continue;
            };
            // Rates that are not known hold for all; secants that are too short are rounding.
            if !(least.is_finite() && most.is_finite() && way.abs() > 1e-3 * width) {
                continue;
            }
            let secant = (last - first) / way;
            let rounding = 1e-12 * (1.0 + first.abs()) / way.abs() + 1e-9 * (1.0 + secant.abs());
            let held = least - rounding <= secant && secant <= most + rounding;
            assert!(held, "{text} in {boxes:?} by {quantity}: {secant} outside {least} to {most}");
            told += 1;
        }
    }
    assert!(told > 400, "{told}");
}

#[test]
fn an_inequality_is_two_expressions_and_one_sign() {
    let name = |name: &str| (name == "B").then_some(30.0);
    for (text, sides, margin, sign) in [
        ("-240 > -300 + 2 * abs(B)", [-240.0, -240.0], 0.0, "≥"),
        ("B <= 20", [30.0, 20.0], -10.0, "≤"),
        ("10<B", [10.0, 30.0], 20.0, "≤"),
        (" B >= 29 ", [30.0, 29.0], 1.0, "≥"),
    ] {
        let inequality = parse_inequality(text).expect(text);
        assert_eq!(inequality.sides(&name), Ok(sides), "{text}");
        assert_eq!(inequality.margin(sides), margin, "{text}");
        assert_eq!(inequality.sign(), sign, "{text}");
    }
    for (text, span, message) in [
        ("Z + 1", 5..5, "one of > >= < <= is missing"),
        ("1 < B < 2", 6..7, "one comparison is possible"),
        ("Z > 2 +", 7..7, "a number or a name is missing at the end"),
        ("Z) > 2", 1..2, "this `)` closes nothing"),
        ("Z > foo(2)", 4..7, "there is no function `foo`"),
    ] {
        let fault = parse_inequality(text).expect_err(text);
        assert_eq!((fault.span, fault.message.as_str()), (span, message), "{text}");
        assert_eq!(fault.text, text);
    }
    let text = "Z > zero + 2 * abs(B)";
    let inequality = parse_inequality(text).expect(text);
    let names = inequality.references().into_iter();
    let names: Vec<_> =
        names.map(|(span, name)| (text[span].to_owned(), name.to_owned())).collect();
    let both = |name: &str| (name.to_owned(), name.to_owned());
    assert_eq!(names, ["Z", "zero", "B"].map(both));
}
