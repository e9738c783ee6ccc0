use post_host::{GivenValue, OptionFault, check_options};
use post_plugin::{OptionKind, OptionSpec, Value};

const SPECS: &[OptionSpec] = &[
    OptionSpec {
        key: "step",
        kind: OptionKind::Integer { min: 1, max: 100 },
        default: Value::Integer(10),
        help: "",
    },
    OptionSpec {
        key: "ratio",
        kind: OptionKind::Number { min: 0.0, max: 1.0 },
        default: Value::Number(0.5),
        help: "",
    },
    OptionSpec {
        key: "way",
        kind: OptionKind::Choice(&["long", "short"]),
        default: Value::Text("short"),
        help: "",
    },
    OptionSpec::text("note", "", ""),
    OptionSpec::lines("block", "", ""),
];

fn fault(key: &str, value: GivenValue) -> OptionFault {
    check_options(SPECS, &[(key.to_owned(), value)]).unwrap_err()
}

#[test]
fn what_is_not_given_has_its_default() {
    let given = [("ratio".to_owned(), GivenValue::Integer(1))];
    assert_eq!(
        check_options(SPECS, &given).unwrap(),
        [
            ("step".to_owned(), GivenValue::Integer(10)),
            ("ratio".to_owned(), GivenValue::Number(1.0)),
            ("way".to_owned(), GivenValue::Text("short".to_owned())),
            ("note".to_owned(), GivenValue::Text(String::new())),
            ("block".to_owned(), GivenValue::Text(String::new())),
        ]
    );
}

#[test]
fn what_does_not_fit_is_refused() {
    let unknown = fault("stepp", GivenValue::Integer(1));
    assert_eq!(unknown.allowed, ["step", "ratio", "way", "note", "block"]);
    assert_eq!(
        fault("step", GivenValue::Integer(0)).to_string(),
        "option `step`: 0 is not between 1 and 100"
    );
    assert_eq!(fault("step", GivenValue::Number(2.0)).message, "must be a whole number");
    assert_eq!(fault("ratio", GivenValue::Number(f64::NAN)).message, "NaN is not between 0 and 1");
    let text = |text: &str| GivenValue::Text(text.to_owned());
    assert_eq!(fault("note", text("A\nB")).message, "must be one line of text");
    assert_eq!(fault("note", text("A\u{2028}B")).message, "must be one line of text");
    assert_eq!(fault("block", text("G0\rX")).message, "holds a character that no line has");
    let lines = [("block".to_owned(), text("G91 G28 Z0.\nG90"))];
    assert_eq!(check_options(SPECS, &lines).unwrap()[4].1, text("G91 G28 Z0.\nG90"));
    let choice = fault("way", GivenValue::Text("round".to_owned()));
    assert_eq!(choice.allowed, ["long", "short"]);
    let twice =
        [("step".to_owned(), GivenValue::Integer(1)), ("step".to_owned(), GivenValue::Integer(2))];
    assert_eq!(check_options(SPECS, &twice).unwrap_err().message, "given twice");
}
