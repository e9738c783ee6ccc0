//! Jobs that show what a control writes beyond straight moves: arcs and cycles, tilted planes, several tools.
//!
//! Numbers are those of the five words X Y Z A C; [`Bench::three_axes`](crate::Bench::three_axes) takes the first three
//! of them.

use post_plugin::{
    Capabilities, Compensation, Coolant, Cycle, Event, Feed, List, PlaneAngles, Spindle,
    SpindleSense,
};

use crate::{TOOL, TOP, at, cut, rapid, turn, turning};

/// Words of a point above the part.
pub const OVER: &[f64] = &[10.0, -20.0, 50.0, 0.0, 0.0];
/// Words of a point on the part's face.
pub const FACE: &[f64] = &[10.0, -20.0, -2.0, 0.0, 0.0];

const FEED: Feed = Feed::PerMinute(850.0);
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// An arc by its centre.
pub const fn arc(centre: [f64; 3], normal: [f64; 3], turn: f64, words: &[f64]) -> Event<'_> {
    Event::Arc { tool: None, feed: FEED, centre, normal, turn, radius: None, words }
}

/// An arc in inverse time, or by its radius.
const fn arc_by(feed: Feed, radius: Option<f64>, turn: f64, words: &[f64]) -> Event<'_> {
    Event::Arc { tool: None, feed, centre: [10.0, -20.0, -2.0], normal: UP, turn, radius, words }
}

/// A cycle 12.5 deep, from 2 above the point.
pub const fn cycle(cycle: Cycle, retract: f64) -> Event<'static> {
    Event::Cycle {
        cycle,
        feed: Feed::PerMinute(120.0),
        depth: 12.5,
        clearance: 2.0,
        retract,
        step: match cycle {
            Cycle::Deep | Cycle::BreakChip => Some(3.25),
            _ => None,
        },
        dwell: None,
        pitch: match cycle {
            Cycle::Tap | Cycle::TapLeft => Some(1.25),
            _ => None,
        },
    }
}

const fn point(words: &[f64]) -> Event<'_> {
    Event::CyclePoint { tool: None, words }
}

const HOLES: [&[f64]; 3] =
    [&[0.0, 0.0, -2.0, 0.0, 0.0], &[25.0, 0.0, -2.0, 0.0, 0.0], &[25.0, 30.0, -4.5, 0.0, 0.0]];
/// Above the first of them, 10 over its point; and above the last.
const FIRST: &[f64] = &[0.0, 0.0, 8.0, 0.0, 0.0];

/// Arcs in three planes, a helix, a whole circle, compensation after them; then holes of all kinds.
pub fn three_axes() -> Vec<Event<'static>> {
    let mut events = vec![
        Event::Start,
        TOP,
        Event::Operation { name: "Tasche Ø20" },
        TOOL,
        turning(3000.0),
        Event::Coolant(Coolant::Flood),
        turn(OVER),
        at(OVER),
        cut(FACE, 850.0),
        // A quarter to the left, back to the right by its radius, and the long way by a negative one.
        arc([10.0, -10.0, -2.0], UP, 90.0, &[20.0, -10.0, -2.0, 0.0, 0.0]),
        arc_by(FEED, Some(10.0), -90.0, FACE),
        arc_by(FEED, Some(-10.0), 270.0, &[0.0, -10.0, -2.0, 0.0, 0.0]),
        // A whole circle, and a helix down.
        arc([5.0, -10.0, -2.0], UP, -360.0, &[0.0, -10.0, -2.0, 0.0, 0.0]),
        arc([5.0, -10.0, -2.0], UP, 360.0, &[0.0, -10.0, -5.0, 0.0, 0.0]),
        // Half circles about Y and about -X.
        arc([5.0, -10.0, -5.0], [0.0, 1.0, 0.0], 180.0, &[10.0, -10.0, -5.0, 0.0, 0.0]),
        arc([10.0, 0.0, -5.0], [-1.0, 0.0, 0.0], 180.0, &[10.0, 10.0, -5.0, 0.0, 0.0]),
        Event::Compensate(Compensation::Left { register: 21 }),
        cut(&[20.0, 10.0, -5.0, 0.0, 0.0], 850.0),
        arc([20.0, 20.0, -5.0], UP, 90.0, &[30.0, 20.0, -5.0, 0.0, 0.0]),
        Event::Compensate(Compensation::Off),
        cut(&[30.0, 30.0, -5.0, 0.0, 0.0], 850.0),
        rapid(&[30.0, 30.0, 8.0, 0.0, 0.0]),
        Event::OperationEnd,
    ];
    for (kind, retract) in [
        (Cycle::Drill, 10.0),
        (Cycle::Deep, 10.0),
        (Cycle::BreakChip, 2.0),
        (Cycle::Ream, 10.0),
        (Cycle::Bore, 10.0),
        (Cycle::Tap, 10.0),
    ] {
        events.extend([rapid(FIRST), cycle(kind, retract)]);
        // The last one lies deeper: its retract level would be another.
        events.extend([point(HOLES[0]), point(HOLES[1]), Event::CycleOff]);
    }
    events.extend([
        rapid(FIRST),
        Event::Cycle {
            cycle: Cycle::Drill,
            feed: Feed::PerMinute(120.0),
            depth: 4.0,
            clearance: 1.0,
            retract: 10.0,
            step: None,
            dwell: Some(0.5),
            pitch: None,
        },
        point(HOLES[0]),
        point(HOLES[0]),
        Event::CycleOff,
        rapid(&[25.0, 30.0, 8.0, 0.0, 0.0]),
        cycle(Cycle::Drill, 12.5),
        point(HOLES[2]),
        Event::CycleOff,
        cut(&[25.0, 30.0, 6.0, 0.0, 0.0], 300.0),
        TOP,
        Event::Spindle(Spindle::Off),
        Event::Coolant(Coolant::Off),
        Event::End,
    ]);
    events
}

/// The plane of the first tilted operation: turned about Z, then X, then Z, degrees.
pub const ANGLES: [f64; 3] = [45.0, 30.0, -90.0];

/// A plane, with its frame by Euler angles.
pub fn plane<'a>(origin: [f64; 3], angles: [f64; 3], words: &'a [f64]) -> Event<'a> {
    let frame = frame(PlaneAngles::Zxz, angles);
    Event::Plane { origin, x: frame[0], z: frame[2], angles, words }
}

/// The axes of a plane's frame, by three turns one after the other, each about an axis of the frame before it.
pub fn frame(angles: PlaneAngles, degrees: [f64; 3]) -> [[f64; 3]; 3] {
    let mut frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for (axis, degrees) in angles.order().into_iter().flatten().zip(degrees) {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let (sine, cosine) = sine_and_cosine(degrees);
        let [one, other] = [frame[next], frame[last]];
        for part in 0..3 {
            frame[next][part] = cosine * one[part] + sine * other[part];
            frame[last][part] = cosine * other[part] - sine * one[part];
        }
    }
    frame
}

/// Sine and cosine by their series: this crate stands on no mathematics of a platform.
fn sine_and_cosine(degrees: f64) -> (f64, f64) {
    let angle = (degrees % 360.0).to_radians();
    let (mut sine, mut cosine) = (0.0, 0.0);
    let mut term = 1.0;
    for power in 0..40 {
        match power % 4 {
            0 => cosine += term,
            1 => sine += term,
            2 => cosine -= term,
            _ => sine -= term,
        }
        term *= angle / f64::from(power + 1);
    }
    (sine, cosine)
}

/// Two tilted planes, cuts, an arc and a hole in the first.
pub fn tilted() -> Vec<Event<'static>> {
    const FIRST: &[f64] = &[0.0, 0.0, 80.0, -30.0, 45.0];
    const DOWN: &[f64] = &[0.0, 0.0, 1.5, -30.0, 45.0];
    const OTHER: &[f64] = &[5.0, 6.0, 80.0, -90.0, 0.0];
    let origin = [0.0, 0.0, 0.0];
    vec![
        Event::Start,
        TOP,
        TOOL,
        turning(3000.0),
        turn(FIRST),
        plane(origin, ANGLES, FIRST),
        at(FIRST),
        cut(DOWN, 850.0),
        arc([5.0, 0.0, 1.5], UP, -180.0, &[10.0, 0.0, 1.5, -30.0, 45.0]),
        rapid(&[10.0, 0.0, 10.0, -30.0, 45.0]),
        cycle(Cycle::Drill, 8.5),
        point(&[10.0, 0.0, 1.5, -30.0, 45.0]),
        point(&[20.0, 0.0, 1.5, -30.0, 45.0]),
        Event::CycleOff,
        TOP,
        Event::PlaneOff,
        turn(OTHER),
        plane(origin, [0.0, 90.0, 0.0], OTHER),
        at(OTHER),
        cut(&[5.0, 6.0, -1.0, -90.0, 0.0], 300.0),
        TOP,
        Event::PlaneOff,
        Event::Spindle(Spindle::Off),
        Event::End,
    ]
}

/// Three tools with all that stands between cuts: work offsets, registers, smoothing, clamps, messages, calls, stops.
pub fn tools() -> Vec<Event<'static>> {
    vec![
        Event::Start,
        TOP,
        Event::Operation { name: "Schruppen" },
        TOOL,
        Event::Preselect { number: 2 },
        turning(3000.0),
        Event::Coolant(Coolant::Flood),
        Event::Smoothing { tolerance: 0.05, axis_tolerance: None },
        turn(OVER),
        Event::Clamp { word: 4, on: true },
        at(OVER),
        cut(FACE, 850.0),
        Event::Offsets { length: Some(31), radius: None },
        rapid(OVER),
        Event::Dwell { seconds: 0.75 },
        Event::OptionalStop,
        TOP,
        Event::SmoothingOff,
        Event::Clamp { word: 4, on: false },
        Event::OperationEnd,
        Event::WorkOffset { number: 2, name: "G55" },
        turn(OVER),
        at(OVER),
        cut(FACE, 850.0),
        TOP,
        Event::Spindle(Spindle::Off),
        Event::Coolant(Coolant::Off),
        Event::tool_change(2, 2, "Bohrer"),
        Event::Message { text: "Späne entfernen!" },
        Event::Stop,
        Event::SurfaceSpeed { speed: 120.0, most: Some(6000.0), sense: SpindleSense::Clockwise },
        turn(OVER),
        at(OVER),
        Event::Stop,
        Event::Probe { tool: None, feed: Feed::PerMinute(100.0), words: FACE },
        rapid(OVER),
        turning(900.0),
        Event::Subprogram { number: Some(1234), times: 3, name: "" },
        rapid(OVER),
        Event::Instead { text: "G91 G28 Z0.\nG90" },
        TOP,
        Event::tool_change(3, 3, "Gewinde"),
        turning(400.0),
        turn(OVER),
        at(OVER),
        TOP,
        Event::End,
    ]
}

/// A spline of degree 2 with even knots, from [`FACE`].
pub fn spline() -> Vec<Event<'static>> {
    vec![
        Event::Start,
        TOP,
        TOOL,
        turning(3000.0),
        turn(OVER),
        at(OVER),
        cut(FACE, 850.0),
        Event::Spline {
            feed: FEED,
            degree: 2,
            knots: List(&[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]),
            weights: List(&[1.0, 1.0, 2.0, 1.0]),
            points: List(&[
                10.0, -20.0, -2.0, 0.0, 0.0, //
                15.0, -10.0, -2.0, 0.0, 0.0, //
                25.0, -10.0, -2.0, 0.0, 0.0, //
                30.0, -20.0, -2.0, 0.0, 0.0,
            ]),
        },
        cut(&[30.0, -30.0, -2.0, 0.0, 0.0], 850.0),
        TOP,
        Event::End,
    ]
}

/// What a dialect must declare to be sent this event; none for those that every dialect is sent.
pub(crate) fn declared_by(event: &Event<'_>) -> Capabilities {
    use Capabilities as C;
    match *event {
        Event::Arc { radius, normal, .. } => {
            let along = normal.iter().position(|part| part.abs() > 0.999);
            let plane = [C::ARC_YZ, C::ARC_ZX, C::ARC_XY];
            let plane = along.map_or(C::ARC_ANY, |along| plane[along]);
            radius.map_or(plane, |_| plane | C::ARC_RADIUS)
        }
        Event::Cycle { cycle, .. } => cycle.capability(),
        _ => event.sent_under(),
    }
}
