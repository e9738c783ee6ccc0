use post_plugin::raw::*;
use post_plugin::{
    Batch, Compensation, Coolant, EVENTS, Event, Feed, List, Spindle, SpindleSense, ToolPose, Units,
};

/// What becomes of events that go into a batch, into their raw form, and back.
fn round(given: &[Event<'_>], check: impl Fn(usize, Event<'_>)) {
    let mut batch = Batch::default();
    for (line, event) in (7..).zip(given) {
        batch.push(line, *event);
    }
    let (mut raw, mut texts) = (Vec::new(), Vec::new());
    events(&batch, batch.len(), &mut raw, &mut texts);
    assert_eq!(raw.len(), given.len());
    for (index, raw) in raw.iter().enumerate() {
        assert_eq!(raw.line, index as u64 + 7);
        check(index, batch.event(index));
        // SAFETY: what the raw event points to outlives it.
        check(index, unsafe { raw.get() }.unwrap());
    }
}

#[test]
fn every_event_comes_back_as_it_went() {
    let mut given = Event::samples();
    assert_eq!(given.len(), EVENTS.len());
    let words = [1.0, -2.5];
    for feed in [Feed::PerMinute(100.0), Feed::InverseTime(2.5), Feed::PerRevolution(0.1)] {
        given.push(Event::linear(&words, feed));
        given.push(Event::position(&words, Some(feed)));
    }
    for coolant in [Coolant::Off, Coolant::Flood, Coolant::Mist, Coolant::Through, Coolant::Air] {
        given.push(Event::Coolant(coolant));
    }
    for register in [0, u32::MAX] {
        given.push(Event::Compensate(Compensation::Right { register }));
    }
    let sense = SpindleSense::CounterClockwise;
    given.extend([
        Event::Compensate(Compensation::Off),
        Event::Spindle(Spindle::Off),
        Event::Spindle(Spindle::Orient),
        Event::Spindle(Spindle::On { rpm: 0.0, sense }),
        Event::Units(Units::Inch),
        Event::position(&words, None),
        Event::rapid(&[]),
        Event::Comment { text: "a µ" },
        Event::Literal { text: "" },
        Event::tool_change(3, 4, "ball 10"),
        Event::Spline {
            feed: Feed::PerMinute(1.0),
            degree: 3,
            knots: List(&[]),
            weights: List(&[1.0]),
            points: List(&words),
        },
        Event::Unknown { kind: 4711 },
    ]);
    round(&given, |index, event| assert_eq!(event, given[index]));
}

/// Reads an event of `kind` with these numbers.
fn read(kind: u32, numbers: &[f64]) -> Event<'_> {
    let raw = PostEvent {
        kind,
        texts_len: 0,
        line: 1,
        numbers: numbers.as_ptr(),
        numbers_len: numbers.len(),
        texts: std::ptr::null(),
    };
    // SAFETY: it has these numbers and no texts.
    unsafe { raw.get() }.unwrap()
}

#[test]
fn an_event_may_have_more_numbers_than_are_known_and_fewer() {
    let dwell = Event::Dwell { seconds: 2.0 }.kind();
    assert_eq!(read(dwell, &[2.0, 9.0, 9.0]), Event::Dwell { seconds: 2.0 });
    assert_eq!(read(dwell, &[]), Event::Dwell { seconds: 0.0 });
    let rapid = Event::rapid(&[]).kind();
    let numbers = [1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 2.0, 10.0, 20.0, 99.0];
    let tool = Some(ToolPose { tip: [1.0, 2.0, 3.0], axis: [0.0, 0.0, 1.0] });
    let words = &[10.0, 20.0];
    assert_eq!(read(rapid, &numbers), Event::Rapid { tool, words });
    assert_eq!(read(Event::tool_change(0, 0, "").kind(), &[5.0]), Event::tool_change(5, 0, ""));
}

#[test]
fn a_number_that_is_not_known_makes_the_event_unknown() {
    for (kind, numbers) in [
        (Event::Coolant(Coolant::Off).kind(), &[99.0] as &[f64]),
        (Event::Preselect { number: 1 }.kind(), &[1.5]),
        (Event::Preselect { number: 1 }.kind(), &[-1.0]),
        (Event::Preselect { number: 1 }.kind(), &[f64::NAN]),
        // A list that says it is longer than it is, and a feed that is none.
        (Event::rapid(&[]).kind(), &[f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, 1e9, 1.0]),
        (Event::rapid(&[]).kind(), &[f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0, f64::INFINITY]),
        (Event::linear(&[], Feed::PerMinute(1.0)).kind(), &[]),
    ] {
        assert_eq!(read(kind, numbers), Event::Unknown { kind });
    }
}
