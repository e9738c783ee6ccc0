use post_plugin::{AxisWord, Compensation, Feed, Value};

use super::*;

const WORDS: &[AxisWord<'_>] = &[
    word("X", false, false),
    word("Y", false, false),
    word("Z", false, true),
    word("A", true, false),
    word("C", true, false),
];

const fn word(name: &str, rotary: bool, depth: bool) -> AxisWord<'_> {
    AxisWord {
        name,
        rotary,
        depth,
        wrapped: false,
        carries_part: false,
        travel: None,
    }
}

/// Writes `events` with `given` options over the defaults.
fn program(
    units: Units,
    tcp: bool,
    given: &[(&'static str, Value<'static>)],
    events: &[Event<'_>],
) -> Result<String, String> {
    let options = OPTIONS.iter().map(|spec| {
        let value = given.iter().find(|(key, _)| *key == spec.key);
        (spec.key, value.map_or(spec.default, |(_, value)| *value))
    });
    let options: Vec<_> = options.collect();
    let mut dialect = Heidenhain::open(&Setup {
        program: "bracket",
        machine: "AC trunnion",
        units,
        tcp,
        words: WORDS,
        options: &options,
        ..Setup::default()
    })?;
    let mut out = String::new();
    for event in events {
        dialect.write(event, &mut out)?;
    }
    Ok(out)
}

fn cut(words: &[f64], feed: f64) -> Event<'_> {
    Event::linear(words, Feed::PerMinute(feed))
}

fn timed(words: &[f64], feed: f64) -> Event<'_> {
    Event::linear(words, Feed::InverseTime(feed))
}

fn rapid(words: &[f64]) -> Event<'_> {
    Event::rapid(words)
}

fn turning(rpm: f64) -> Event<'static> {
    Event::Spindle(Spindle::On {
        rpm,
        sense: SpindleSense::Clockwise,
    })
}

const TOOL: Event<'_> = Event::tool_change(1, 1, "Ball Ø10 (R5)");

fn at(words: &[f64]) -> Event<'_> {
    Event::position(words, None)
}

const P1: &[f64] = &[10.0, -20.5, 100.0, -30.0, 45.0];
const P2: &[f64] = &[10.0, -20.5, 2.0, -30.0, 45.0];
const P3: &[f64] = &[12.5, -20.5, 2.0, -30.125, 45.0];
const P4: &[f64] = &[15.0, -20.5, 2.0, -30.125, 46.0];

/// What a five-axis job does, with axis positions or with TCP.
fn job() -> Vec<Event<'static>> {
    vec![
        Event::Start,
        Event::Comment {
            text: "Schlichten (fein) 100%",
        },
        TOOL,
        turning(3000.0),
        Event::Coolant(Coolant::Flood),
        at(P1),
        rapid(P2),
        rapid(P2),
        cut(P3, 850.0),
        cut(P4, 850.0),
        rapid(P1),
        Event::Dwell { seconds: 2.5 },
        Event::OptionalStop,
        Event::Release,
        Event::Home,
        Event::tool_change(2, 12, ""),
        turning(1200.0),
        Event::position(P1, Some(Feed::PerMinute(2000.5))),
        Event::Compensate(Compensation::Left { register: 32 }),
        cut(P2, 300.0),
        cut(P3, 300.0),
        Event::Compensate(Compensation::Off),
        rapid(P1),
        Event::Literal { text: "M77" },
        Event::Word { text: "M78" },
        rapid(P1),
        Event::Release,
        Event::Spindle(Spindle::Off),
        Event::Coolant(Coolant::Off),
        Event::End,
    ]
}

#[test]
fn a_job_with_axis_positions() {
    insta::assert_snapshot!(program(Units::Millimetre, false, &[], &job()).unwrap());
}

#[test]
fn a_job_with_tcp() {
    insta::assert_snapshot!(program(Units::Millimetre, true, &[], &job()).unwrap());
}

#[test]
fn options_change_what_they_say() {
    let given = [
        ("preset", Value::Integer(-1)),
        ("rotary_way", Value::Text("M126")),
        ("retract", Value::Text("L Z-1 R0 FMAX M91")),
        (
            "tcp_on",
            Value::Text("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"),
        ),
        ("tcp_off", Value::Text("FUNCTION RESET TCPM")),
    ];
    let events = [
        Event::Start,
        TOOL,
        Event::Comment { text: "rough ~" },
        turning(3000.0),
        at(P1),
        cut(P3, 12.3),
        turning(4000.0),
        cut(P4, 12.3),
        Event::Release,
        Event::End,
    ];
    insta::assert_snapshot!(program(Units::Inch, true, &given, &events).unwrap());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused =
        |events: &[Event<'_>]| program(Units::Millimetre, false, &[], events).unwrap_err();
    assert!(refused(&[timed(P1, 2.0)]).contains("InverseTime"));
    assert!(refused(&[Event::Coolant(Coolant::Mist)]).contains("coolant_mist"));
    assert!(refused(&[Event::Spindle(Spindle::Orient)]).contains("cycle"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
}
