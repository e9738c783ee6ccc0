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
    let mut dialect = Fanuc::open(&Setup {
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
        timed(P3, 12.0),
        timed(P4, 12.0),
        cut(P3, 850.0),
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
        ("program_number", Value::Integer(7)),
        ("block_numbers", Value::Flag(true)),
        ("trailing_zeros", Value::Flag(false)),
        ("work_offset", Value::Text("G54.1 P12")),
        ("home", Value::Text("G91 G28 X0. Y0.")),
        ("length_register", Value::Integer(5)),
        ("coolant_through", Value::Text("M88")),
        ("coolant_off", Value::Text("M9 M89")),
    ];
    let events = [
        Event::Start,
        Event::Coolant(Coolant::Through),
        Event::Preselect { number: 3 },
        at(P1),
        cut(P3, 12.25),
        Event::Compensate(Compensation::Off),
        Event::End,
    ];
    insta::assert_snapshot!(program(Units::Inch, false, &given, &events).unwrap());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused =
        |events: &[Event<'_>]| program(Units::Millimetre, false, &[], events).unwrap_err();
    assert!(refused(&[Event::Start, at(P1)]).contains("length_register"));
    assert!(refused(&[Event::Coolant(Coolant::Air)]).contains("coolant_air"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
    let offset = [("work_offset", Value::Text("G60"))];
    assert!(program(Units::Millimetre, false, &offset, &[]).is_err());
}
