//! Every event through the engine: what is modal, what is refused, and in which order things are switched.

use post_iso::{Control, Iso, Plane, Rigid, SplineForm, Table, Tcp, iso_options, options};
use post_kit::jobs::{FACE, OVER, arc, cycle, frame, plane};
use post_kit::{Bench, TOOL, TOP, at, cut, rapid, turn, turning};
use post_plugin::export::Exported;
use post_plugin::{
    Capabilities, Cycle, Event, Feed, Linked, OptionSpec, PlaneAngles, Setup, Spindle,
    SpindleSense, ToolPose, Units, Value,
};

/// A control that has everything.
struct Whole;

const OPTIONS: &[OptionSpec] = iso_options![
    options::SPACES,
    options::INVERSE_TIME,
    options::TOOL_VECTOR,
    options::SPLINES,
    options::BORE_SHIFT,
    options::tapping("rigid"),
    options::cycles_in_plane(true),
    options::smoothing(""),
    options::smoothing_off("G5.1 Q0"),
];

impl Control for Whole {
    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        percent: false,
        tcp: Tcp::Length("G43.4"),
        vector: "G43.5",
        plane: Plane::Euler { on: "G68.2", turn: "G53.1", off: "G69" },
        rigid: Rigid::Ahead("M29"),
        splines: SplineForm::Knots { code: "G6.2", begin: "G5 P10000", end: "G5 P0" },
        units_inside: true,
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Whole)
    }
}

fn linked() -> Linked {
    static WHOLE: Exported = Exported::dialect::<Iso<Whole>>("whole", "1", "");
    Linked::dialect::<Iso<Whole>>(&WHOLE, "test")
}

fn whole() -> Bench {
    Bench::of(linked())
}

/// The lines of `events` behind a tool that stands on the face of the part.
fn behind(bench: &Bench, events: &[Event<'_>]) -> Result<String, String> {
    let ahead = [Event::Start, TOP, TOOL, turning(3000.0), turn(OVER), at(OVER), cut(FACE, 850.0)];
    let before = bench.write(&ahead)?;
    let all = bench.write(&[&ahead[..], events].concat())?;
    Ok(all.strip_prefix(&before).unwrap().to_owned())
}

fn written(events: &[Event<'_>]) -> String {
    behind(&whole(), events).unwrap()
}

fn refused(events: &[Event<'_>]) -> String {
    behind(&whole(), events).unwrap_err()
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const CENTRE: [f64; 3] = [10.0, -10.0, -2.0];
const QUARTER: &[f64] = &[20.0, -10.0, -2.0, 0.0, 0.0];

#[test]
fn arcs_that_the_control_would_read_otherwise_are_refused() {
    assert_eq!(written(&[arc(CENTRE, UP, 90.0, QUARTER)]), "G3 X20.000 Y-10.000 I0.000 J10.000\n");
    // The same arc, told by the other side of its plane.
    assert_eq!(
        written(&[arc(CENTRE, [0.0, 0.0, -1.0], -90.0, QUARTER)]),
        "G3 X20.000 Y-10.000 I0.000 J10.000\n"
    );
    for (wrong, why) in [
        (arc(CENTRE, [0.0, 0.6, 0.8], 90.0, QUARTER), "about X, Y and Z alone"),
        (arc(CENTRE, UP, 450.0, QUARTER), "one turn in a block at most"),
        (arc(CENTRE, UP, 0.01, FACE), "a whole circle of it"),
    ] {
        assert!(refused(&[wrong]).contains(why), "{why}");
    }
    let there = refused(&[TOP, arc(CENTRE, UP, 90.0, QUARTER)]);
    assert!(there.contains("nobody knows where the arc starts"), "{there}");
    let left = Event::Compensate(post_plugin::Compensation::Left { register: 1 });
    let led = refused(&[left, arc(CENTRE, UP, 90.0, QUARTER)]);
    assert!(led.contains("begins and ends with a straight move"), "{led}");
}

#[test]
fn every_arc_under_inverse_time_has_its_feed() {
    let timed = |words| Event::Arc {
        tool: None,
        feed: Feed::InverseTime(12.5),
        centre: CENTRE,
        normal: UP,
        turn: if words == FACE { -90.0 } else { 90.0 },
        radius: None,
        words,
    };
    let bench = whole().with("inverse_time", Value::Flag(true));
    assert_eq!(
        behind(&bench, &[timed(QUARTER), timed(FACE)]).unwrap(),
        "G93 G3 X20.000 Y-10.000 I0.000 J10.000 F12.5\nG2 X10.000 Y-20.000 I-10.000 J0.000 F12.5\n"
    );
    assert!(refused(&[timed(QUARTER)]).contains("no feed like"));
}

const HOLE: &[f64] = &[0.0, 0.0, -2.0, 0.0, 0.0];
const ABOVE: &[f64] = &[0.0, 0.0, 8.0, 0.0, 0.0];
const POINT: Event<'_> = Event::CyclePoint { tool: None, words: HOLE };

#[test]
fn a_cycle_must_begin_where_it_returns_to() {
    let text = written(&[rapid(ABOVE), cycle(Cycle::Drill, 10.0), POINT, Event::CycleOff]);
    assert_eq!(text, "G0 X0.000 Y0.000 Z8.000\nG98 G81 X0.000 Y0.000 Z-14.500 R0.000 F120.\nG80\n");
    let low = refused(&[cycle(Cycle::Drill, 10.0), POINT]);
    assert!(low.contains("begins at Z -2"), "{low}");
    assert!(refused(&[POINT]).contains("none is in force"));
    let mut bottomless = cycle(Cycle::Drill, 10.0);
    if let Event::Cycle { depth, .. } = &mut bottomless {
        *depth = -3.0;
    }
    assert!(refused(&[bottomless]).contains("to the bottom"));
    let mut stepless = cycle(Cycle::Deep, 10.0);
    if let Event::Cycle { step, .. } = &mut stepless {
        *step = None;
    }
    assert!(refused(&[stepless]).contains("without a step"));
    let mut waiting = cycle(Cycle::Deep, 10.0);
    if let Event::Cycle { dwell, .. } = &mut waiting {
        *dwell = Some(1.0);
    }
    assert!(refused(&[waiting]).contains("Deep with a dwell"));
    assert!(refused(&[cycle(Cycle::BoreFine, 10.0)]).contains("BoreFine"));
}

#[test]
fn a_cycle_of_another_kind_behind_a_line_of_the_users_own_is_whole() {
    let text = written(&[
        rapid(ABOVE),
        cycle(Cycle::Drill, 10.0),
        POINT,
        Event::Literal { text: "M77" },
        POINT,
        Event::CycleOff,
    ]);
    let block = "G98 G81 X0.000 Y0.000 Z-14.500 R0.000 F120.";
    assert!(text.contains(&format!("\n{block}\nM77\nG94 {block}\nG80\n")), "{text}");
}

#[test]
fn a_thread_is_told_by_its_pitch() {
    let mut tap = cycle(Cycle::Tap, 10.0);
    // Of a turn of the spindle: 20 threads an inch.
    let set = |tap: &mut Event<'_>, as_feed| {
        if let Event::Cycle { feed, pitch, .. } = tap {
            *feed = as_feed;
            *pitch = Some(1.27);
        }
    };
    set(&mut tap, Feed::PerMinute(422.9));
    let slow = Event::Spindle(Spindle::On { rpm: 333.0, sense: SpindleSense::Clockwise });
    let text = written(&[slow, rapid(ABOVE), tap, POINT, Event::CycleOff, cut(FACE, 850.0)]);
    assert_eq!(
        text,
        "S333 M3\nG0 X0.000 Y0.000 Z8.000\nM29 S333\n\
         G98 G84 X0.000 Y0.000 Z-14.500 R0.000 F422.91\nG80\nS333 M3\n\
         G1 X10.000 Y-20.000 Z-2.000 F850.\n"
    );
    set(&mut tap, Feed::PerRevolution(1.27));
    let text = written(&[slow, rapid(ABOVE), tap, POINT, Event::CycleOff]);
    assert!(text.contains("G95 G98 G84 X0.000 Y0.000 Z-14.500 R0.000 F1.27\n"), "{text}");
    let floating = whole().with("tapping", Value::Text("floating"));
    let text = behind(&floating, &[slow, rapid(ABOVE), tap, POINT, Event::CycleOff]);
    assert!(!text.unwrap().contains("M29"));
}

#[test]
fn nothing_changes_inside_a_tilted_plane() {
    let tilted = plane([0.0; 3], [0.0, 30.0, 0.0], OVER);
    for (event, what) in [
        (TOOL, "a tool change"),
        (Event::WorkOffset { number: 2, name: "" }, "another work offset"),
        (tilted, "a tilted plane"),
    ] {
        let why = refused(&[TOP, turn(OVER), tilted, event]);
        assert!(why.starts_with(what), "{why}");
    }
    let off = refused(&[TOP, plane([0.000_25, 0.0, 0.0], [0.0; 3], OVER)]);
    assert!(off.contains("3 decimals are written"), "{off}");
}

#[test]
fn a_plane_has_the_plain_length_also_where_the_control_keeps_the_tip() {
    let bench = whole().tcp();
    let text = behind(
        &bench,
        &[
            TOP,
            turn(OVER),
            plane([1.0, 2.0, 3.0], [0.0, 30.0, 0.0], OVER),
            at(OVER),
            cut(FACE, 850.0),
            TOP,
            Event::PlaneOff,
            turn(OVER),
            at(OVER),
        ],
    );
    assert_eq!(
        text.unwrap(),
        "G53 G0 Z500.000\nG49\nG0 A0.000 C0.000\n\
         G68.2 X1.000 Y2.000 Z3.000 I0.000 J30.000 K0.000\nG53.1\n\
         G0 X10.000 Y-20.000\nG43 H1 Z50.000\nG1 Z-2.000\nG53 G0 Z500.000\nG49\nG69\n\
         G0 A0.000 C0.000\nX10.000 Y-20.000\nG43.4 H1 Z50.000\n"
    );
}

/// I J K of the program, turned back by a product of matrices of its own.
#[test]
fn the_printed_angles_turn_the_part_into_the_tool_axis() {
    let turned = |axis: usize, degrees: f64, v: [f64; 3]| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
        let mut out = v;
        out[a] = cosine * v[a] - sine * v[b];
        out[b] = sine * v[a] + cosine * v[b];
        out
    };
    let mut state = 7_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 12) / f64::from(1_u32 << 20)
    };
    for case in 0..300 {
        let tilt = match case % 4 {
            // The pole, upright and over head.
            0 => 0.0,
            1 => 180.0,
            _ => 180.0 * next(),
        };
        let round = |angle: f64| (angle * 1000.0).round() / 1000.0;
        let angles = [360.0 * next() - 180.0, tilt, 360.0 * next() - 180.0].map(round);
        let text = written(&[TOP, turn(OVER), plane([0.0; 3], angles, OVER)]);
        let line = text.lines().find(|line| line.starts_with("G68.2")).unwrap();
        let word = |address: char| -> f64 {
            let mut words = line.split(' ');
            let word = words.find(|word| word.starts_with(address)).unwrap();
            word[1..].parse().unwrap()
        };
        let [i, j, k] = ['I', 'J', 'K'].map(word);
        // Intrinsic turns: the last one is nearest the vector.
        let wanted = frame(PlaneAngles::Zxz, angles);
        for (axis, wanted) in [([1.0, 0.0, 0.0], wanted[0]), ([0.0, 0.0, 1.0], wanted[2])] {
            let got = turned(2, i, turned(0, j, turned(2, k, axis)));
            let off = got.iter().zip(wanted).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "{line}");
        }
    }
}

#[test]
fn smoothing_waits_until_the_length_is_off_and_keeps_the_tolerance() {
    let bench =
        whole().with("smoothing", Value::Text("0.02 G5.1 Q1 R5\n0 G5.1 Q1 R1\n0.5 G5.1 Q1 R9"));
    let smoothing = |tolerance| Event::Smoothing { tolerance, axis_tolerance: None };
    let text = behind(
        &bench,
        &[
            smoothing(0.05),
            cut(QUARTER, 850.0),
            TOP,
            turn(OVER),
            at(OVER),
            smoothing(0.01),
            TOP,
            Event::SmoothingOff,
            smoothing(0.01),
            Event::End,
        ],
    );
    assert_eq!(
        text.unwrap(),
        "X20.000 Y-10.000\nG53 G0 Z500.000\nG49\nG0 A0.000 C0.000\nG5.1 Q1 R5\nX10.000 Y-20.000\n\
         G43 H1 Z50.000\nG5.1 Q0\nG53 G0 Z500.000\nG49\nG5.1 Q0\nG5.1 Q1 R1\nG5.1 Q0\nM5\nM9\nM30\n"
    );
    let coarse = whole().with("smoothing", Value::Text("0.1 G5.1 Q1"));
    assert!(behind(&coarse, &[smoothing(0.01)]).unwrap_err().contains("within 0.01 mm"));
    let slip = whole().with("smoothing", Value::Text("G5.1 Q1"));
    assert!(slip.write(&[]).unwrap_err().contains("smoothing has the line"));
}

#[test]
fn clamps_registers_and_units() {
    let bench = whole().with("clamps", Value::Text("A M20 M21\nC M10 M11"));
    let clamp = |word, on| Event::Clamp { word, on };
    assert_eq!(behind(&bench, &[clamp(4, true), clamp(3, false)]).unwrap(), "M10\nM21\n");
    // An axis without a line has no clamp.
    assert_eq!(behind(&bench, &[clamp(0, true)]).unwrap(), "");
    let stranger = whole().with("clamps", Value::Text("Q M10 M11"));
    assert!(stranger.write(&[]).unwrap_err().contains("no rotary axis Q"));
    let slip = whole().with("clamps", Value::Text("C M10"));
    assert!(slip.write(&[]).unwrap_err().contains("clamps has the line"));

    let registers = |length, radius| Event::Offsets { length, radius };
    assert_eq!(
        written(&[registers(Some(31), Some(7)), cut(QUARTER, 850.0)]),
        "G43 H31 X20.000 Y-10.000\n"
    );
    let left = Event::Compensate(post_plugin::Compensation::Left { register: 1 });
    assert_eq!(
        written(&[left, cut(OVER, 850.0), registers(None, Some(7)), cut(QUARTER, 850.0)]),
        "G41 D1 Z50.000\nD7 X20.000 Y-10.000 Z-2.000\n"
    );
    let kept = behind(&whole().tcp(), &[registers(Some(31), None)]);
    assert!(kept.unwrap_err().contains("retract before"));
    assert_eq!(
        written(&[Event::Units(Units::Inch), cut(QUARTER, 40.0)]),
        "G20\nG94 G1 X20.000 Y-10.000 Z-2.000 A0.000 C0.000 F40.\n"
    );
}

#[test]
fn the_tool_vector_takes_the_place_of_rotary_words() {
    let bench = whole().tcp().with("tool_vector", Value::Flag(true));
    let leaning = |axis| Some(ToolPose { tip: [0.0; 3], axis });
    let to = |words, axis, feed| match feed {
        Some(feed) => Event::Linear { tool: leaning(axis), feed: Feed::PerMinute(feed), words },
        None => Event::Rapid { tool: leaning(axis), words },
    };
    const LEANING: &[f64] = &[10.0, -20.0, -2.0, 0.0, 90.0];
    let text = bench.write(&[
        Event::Start,
        TOP,
        TOOL,
        turn(OVER),
        Event::Position {
            tool: leaning([0.0, 0.0, 1.0]),
            feed: None,
            plane_first: true,
            words: OVER,
        },
        to(FACE, [0.0, 0.0, 1.0], Some(850.0)),
        to(LEANING, [0.0, 0.6, 0.8], Some(850.0)),
        to(OVER, [0.0, 0.0, 1.0], None),
        TOP,
        turn(LEANING),
    ]);
    let text = text.unwrap();
    let tail = &text[text.find("G54").unwrap()..];
    assert_eq!(
        tail,
        "G54\nG0 A0.000 C0.000\nX10.000 Y-20.000\nG43.5 H1 Z50.000 I0.000000 J0.000000 K1.000000\n\
         G94 G1 Z-2.000 F850.\nI0.000000 J0.600000 K0.800000\n\
         G0 Z50.000 I0.000000 J0.000000 K1.000000\nG53 G0 Z500.000\nG49\nG0 A0.000 C90.000\n"
    );
    let blind = bench.write(&[Event::Start, TOOL, at(OVER)]);
    assert!(blind.unwrap_err().contains("nobody knows the direction"));
}

#[test]
fn lines_of_the_users_own_stand_for_an_event() {
    let text = written(&[
        Event::Instead { text: "G28 G91 Z0.\nG90" },
        TOP,
        Event::Instead { text: "M6 T7" },
        Event::tool_change(7, 17, "Drill"),
        turn(OVER),
        at(OVER),
    ]);
    assert_eq!(
        text,
        "G28 G91 Z0.\nG90\nG49\nM6 T7\nG54\nG0 A0.000 C0.000\nX10.000 Y-20.000\nG43 H17 Z50.000\n"
    );
    let numbered = whole().with("block_numbers", Value::Text("all"));
    let text = numbered.write(&[Event::Start, Event::Instead { text: "M77" }, TOP, TOOL]);
    let text = text.unwrap();
    assert!(
        text.contains("N30 M77\n") && text.contains("N40 G49\n") && text.contains("N50 T1 M6\n"),
        "{text}"
    );
}

#[test]
fn blocks_look_as_the_options_say() {
    let tools =
        whole().with("block_numbers", Value::Text("tools")).with("block_step", Value::Integer(100));
    let text = tools.write(&[Event::Start, TOOL, turning(9.0), Event::tool_change(2, 2, "")]);
    let text = text.unwrap();
    assert!(text.contains("\nN100 T1 M6\nS9 M3\nN200 T2 M6\n"), "{text}");

    let dense = whole()
        .with("spaces", Value::Flag(false))
        .with("leading_zeros", Value::Flag(true))
        .with("word_decimals", Value::Text("X=1 A=4"));
    let own = Event::Literal { text: "G1 X 5" };
    assert_eq!(
        behind(&dense, &[own, rapid(OVER)]).unwrap(),
        "G1 X 5\nG00X10.0Y-20.000Z50.000A0.0000C0.000\n"
    );
    let slip = whole().with("word_decimals", Value::Text("Q=4"));
    assert!(slip.write(&[]).unwrap_err().contains("word_decimals has `Q=4`"));
}

#[test]
fn a_program_can_be_started_behind_each_tool_change() {
    let bench = whole().with("restart", Value::Flag(true));
    let text = behind(
        &bench,
        &[TOP, Event::tool_change(2, 2, ""), turning(9.0), turn(OVER), at(OVER), cut(FACE, 850.0)],
    );
    assert_eq!(
        text.unwrap(),
        "G53 G0 Z500.000\nG49\nT2 M6\nG17 G40 G80 G90 G94\nS9 M3\nG54\nG0 A0.000 C0.000\n\
         X10.000 Y-20.000\nG43 H2 Z50.000\nG1 Z-2.000 F850.\n"
    );
}

#[test]
fn what_it_declares_follows_from_table_and_options() {
    let writes = |options: &[(&str, Value<'_>)]| {
        let words = ["X", "Y", "Z", "C"].map(|name| post_plugin::AxisWord {
            name,
            rotary: name == "C",
            depth: name == "Z",
            ..post_plugin::AxisWord::default()
        });
        let setup = Setup { words: &words, options, ..Setup::default() };
        let mut opened = linked().open(&setup).unwrap().unwrap();
        opened.format().unwrap().1
    };
    let plain = writes(&[]);
    assert!(plain.has(Capabilities::ARC_ZX | Capabilities::HELIX | Capabilities::PLANE));
    for (option, value, capability) in [
        ("splines", Value::Flag(true), Capabilities::SPLINE),
        ("tool_vector", Value::Flag(true), Capabilities::TOOL_VECTOR),
        ("bore_shift", Value::Number(0.3), Capabilities::CYCLE_BORE_FINE),
        ("clamps", Value::Text("C M10 M11"), Capabilities::CLAMP),
        ("smoothing", Value::Text("0 G61.1"), Capabilities::SMOOTHING),
    ] {
        assert!(!plain.has(capability), "{option}");
        assert!(writes(&[(option, value)]).has(capability), "{option}");
    }
}
