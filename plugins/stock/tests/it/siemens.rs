use post_host::Plugin;
use post_kit::{
    Bench, P1, P2, P3, P4, TOOL, TOP, at, conformance, cut, jobs, rapid, turn, turning,
};
use post_plugin::{
    AxisWord, Batch, Cycle, Event, Feed, PlaneAngles, Promise, Setup, Spindle, SpindleSense,
    ToolPose, Units, Value,
};

fn bench() -> Bench {
    Bench::of(post_siemens::plugin())
}

/// Above the part, upright.
const Q0: &[f64] = &[0.0, 0.0, 50.0, 0.0, 0.0];

const fn down(words: &[f64]) -> Event<'_> {
    cut(words, 300.0)
}

const fn arc(centre: [f64; 3], normal: [f64; 3], turn: f64, words: &[f64]) -> Event<'_> {
    Event::Arc {
        tool: None,
        feed: Feed::PerMinute(300.0),
        centre,
        normal,
        turn,
        radius: None,
        words,
    }
}

const fn cycle(cycle: Cycle, feed: f64, step: Option<f64>, dwell: Option<f64>) -> Event<'static> {
    Event::Cycle {
        cycle,
        feed: Feed::PerMinute(feed),
        depth: 12.5,
        clearance: 2.0,
        retract: 10.0,
        step,
        dwell,
        pitch: None,
    }
}

const fn hole(words: &[f64]) -> Event<'_> {
    Event::CyclePoint { tool: None, words }
}

#[test]
fn the_kit_finds_nothing_wrong() {
    let plugin = Plugin::linked(post_siemens::plugin()).unwrap();
    let report = conformance::test(&plugin, &[]).unwrap();
    assert!(report.is_good(), "{report}");
}

#[test]
fn a_job_with_axis_positions() {
    insta::assert_snapshot!(bench().write_job().unwrap());
}

#[test]
fn a_job_with_tcp() {
    insta::assert_snapshot!(bench().tcp().write_job().unwrap());
}

#[test]
fn arcs_and_cycles() {
    let z = [0.0, 0.0, 1.0];
    let events = [
        Event::Start,
        TOP,
        Event::Operation { name: "Tasche" },
        TOOL,
        turning(3000.0),
        Event::Smoothing { tolerance: 0.02, axis_tolerance: None },
        TOP,
        turn(Q0),
        at(Q0),
        rapid(&[0.0, 0.0, 2.0, 0.0, 0.0]),
        down(&[0.0, 0.0, -1.0, 0.0, 0.0]),
        arc([10.0, 0.0, -1.0], z, 180.0, &[20.0, 0.0, -1.0, 0.0, 0.0]),
        arc([10.0, 0.0, -1.0], z, -360.0, &[20.0, 0.0, -1.0, 0.0, 0.0]),
        // Two turns and a half down.
        arc([10.0, 0.0, -1.0], z, 900.0, &[0.0, 0.0, -6.0, 0.0, 0.0]),
        Event::Arc {
            tool: None,
            feed: Feed::PerMinute(300.0),
            centre: [0.0, 5.0, -6.0],
            normal: [0.0, 0.0, -1.0],
            turn: 90.0,
            radius: Some(5.0),
            words: &[-5.0, 5.0, -6.0, 0.0, 0.0],
        },
        Event::SmoothingOff,
        Event::OperationEnd,
        rapid(&[10.0, 20.0, 10.0, 0.0, 0.0]),
        cycle(Cycle::Drill, 120.0, None, None),
        hole(&[10.0, 20.0, 0.0, 0.0, 0.0]),
        hole(&[30.0, 20.0, 0.0, 0.0, 0.0]),
        hole(&[30.0, 40.0, -5.0, 0.0, 0.0]),
        cycle(Cycle::Drill, 120.0, None, Some(0.5)),
        hole(&[50.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Deep, 120.0, Some(4.0), None),
        hole(&[60.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::BreakChip, 100.0, Some(4.0), Some(0.5)),
        hole(&[70.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Ream, 80.0, None, None),
        hole(&[80.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Bore, 80.0, None, None),
        hole(&[90.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::BoreFine, 80.0, None, None),
        hole(&[95.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Tap, 3750.0, None, None),
        hole(&[100.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::TapLeft, 3750.0, None, None),
        hole(&[110.0, 40.0, 0.0, 0.0, 0.0]),
        Event::CycleOff,
        rapid(&[110.0, 40.0, 50.0, 0.0, 0.0]),
        TOP,
        Event::End,
    ];
    let bench =
        bench().with("bore_lift_x", Value::Number(-0.2)).with("messages", Value::Flag(true));
    insta::assert_snapshot!(bench.write(&events).unwrap());
    let floating = bench.with("tapping", Value::Text("floating"));
    let text = floating.write(&events).unwrap();
    assert!(text.contains("MCALL CYCLE840(10,0,2,-12.5,,0,0,3,0,,1.25)"), "{text}");
}

#[test]
fn arcs_off_the_plane_of_the_length_are_an_option() {
    let events = [
        at(Q0),
        down(&[0.0, 0.0, 0.0, 0.0, 0.0]),
        // From X to Z about -Y: clockwise, seen against +Y.
        arc([-5.0, 0.0, 0.0], [0.0, -1.0, 0.0], 90.0, &[-5.0, 0.0, 5.0, 0.0, 0.0]),
        // From Y to Z about X.
        arc([-5.0, -5.0, 5.0], [1.0, 0.0, 0.0], 90.0, &[-5.0, -5.0, 10.0, 0.0, 0.0]),
        TOP,
        at(Q0),
    ];
    let text = bench().with("arcs_off_xy", Value::Flag(true)).write(&events).unwrap();
    assert!(text.contains("G18 G2 X-5.000 Z5.000 I-5.000 K0.000\n"), "{text}");
    assert!(text.contains("G19 G3 Y-5.000 Z10.000 J-5.000 K0.000\n"), "{text}");
    assert!(text.contains("G17\n"), "{text}");
}

#[test]
fn a_tilted_plane() {
    let plane = Event::Plane {
        origin: [10.0, -20.0, 5.5],
        x: [1.0, 0.0, 0.0],
        z: [0.0, 0.5, 0.866_025],
        angles: [-30.0, 12.345_67, 45.0],
        words: P1,
    };
    let events = [
        Event::Start,
        TOP,
        TOOL,
        turning(3000.0),
        TOP,
        turn(P1),
        plane,
        at(P1),
        rapid(P2),
        cycle(Cycle::Drill, 120.0, None, None),
        hole(&[10.0, -20.5, 0.0, -30.0, 45.0]),
        Event::CycleOff,
        TOP,
        Event::PlaneOff,
        turn(P3),
        at(P3),
        TOP,
        Event::End,
    ];
    let swivel = bench().tcp().with("swivel", Value::Flag(true));
    let named = swivel
        .clone()
        .with("swivel_record", Value::Text("TISCH"))
        .with("swivel_reference", Value::Text("A"));
    insta::assert_snapshot!(named.write(&events).unwrap());
    let line = |bench: &Bench| {
        let text = bench.write(&[plane]).unwrap();
        let line = text.lines().last().unwrap();
        line.split_once(' ').unwrap().1.to_owned()
    };
    assert_eq!(
        line(
            &swivel
                .clone()
                .with("software", Value::Text("2"))
                .with("swivel_mode", Value::Text("ZYX"))
        ),
        "CYCLE800(0,\"\",0,27,10,-20,5.5,-30,12.34567,45,0,0,0,-1,0)"
    );
    let direct = swivel.clone().with("swivel_mode", Value::Text("direct"));
    assert!(direct.write(&[plane]).unwrap_err().contains("swivel_axes"));
    assert_eq!(
        line(&direct.with("swivel_axes", Value::Text("A C"))),
        "CYCLE800(0,\"\",0,192,10,-20,5.5,-30,45,0,0,0,0,-1,0,0)"
    );
    assert!(line(&swivel.inch()).contains(",0.3937,-0.7874,0.21654,"));
}

/// The printed angles, turned one after the other about the axes that the mode's bits name (1 is X, from the lowest
/// two up), lead back to the plane that they came from, in every mode.
#[test]
fn angles_of_every_mode_lead_back_to_the_plane() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % 100_000) as f64 / 100_000.0
    };
    for (name, angles_of) in [
        ("XYZ", PlaneAngles::Xyz),
        ("XZY", PlaneAngles::Xzy),
        ("YXZ", PlaneAngles::Yxz),
        ("YZX", PlaneAngles::Yzx),
        ("ZXY", PlaneAngles::Zxy),
        ("ZYX", PlaneAngles::Zyx),
    ] {
        let bench =
            bench().with("swivel", Value::Flag(true)).with("swivel_mode", Value::Text(name));
        for round in 0..200 {
            // The middle turn at a right angle is the pole of every order.
            let middle = if round == 0 { 90.0 } else { 180.0 * random() - 90.0 };
            let rounded = |angle: f64| (angle * 1e5).round() / 1e5;
            let angles = [360.0 * random() - 180.0, middle, 360.0 * random() - 180.0].map(rounded);
            let wanted = jobs::frame(angles_of, angles);
            let text = bench
                .write(&[Event::Plane {
                    origin: [0.0; 3],
                    x: wanted[0],
                    z: wanted[2],
                    angles,
                    words: P1,
                }])
                .unwrap();
            let inside = text.split(['(', ')']).nth(1).unwrap();
            let arguments: Vec<&str> = inside.split(',').collect();
            assert_eq!(arguments.len(), 16);
            let mode: usize = arguments[3].parse().unwrap();
            for (axis, wanted) in wanted.iter().enumerate() {
                let mut found = std::array::from_fn(|part| if part == axis { 1.0 } else { 0.0 });
                // The last turn is about the frame's own axis: it comes first on a vector of the frame.
                for turn in [2, 1, 0] {
                    let about = (mode >> (2 * turn) & 3) - 1;
                    found = turned(found, about, arguments[7 + turn].parse().unwrap());
                }
                for (found, wanted) in found.iter().zip(wanted) {
                    assert!((found - wanted).abs() < 1e-9, "{name} {angles:?} {text}");
                }
            }
        }
    }
}

/// A vector turned about a fixed axis, degrees.
fn turned(vector: [f64; 3], about: usize, degrees: f64) -> [f64; 3] {
    let (sine, cosine) = libm::sincos(degrees.to_radians());
    let (next, last) = ((about + 1) % 3, (about + 2) % 3);
    let mut turned = vector;
    turned[next] = cosine * vector[next] - sine * vector[last];
    turned[last] = sine * vector[next] + cosine * vector[last];
    turned
}

#[test]
fn the_jobs_of_every_dialect() {
    let bench = bench().with("swivel", Value::Flag(true)).with("arcs_off_xy", Value::Flag(true));
    insta::assert_snapshot!("three_axes", bench.write_declared(&jobs::three_axes()).unwrap());
    insta::assert_snapshot!("tilted", bench.write_declared(&jobs::tilted()).unwrap());
    insta::assert_snapshot!("tools", bench.write_declared(&jobs::tools()).unwrap());
}

#[test]
fn tool_vectors_in_the_place_of_rotary_words() {
    let to = |words, axis| Event::Linear {
        tool: Some(ToolPose { tip: [0.0; 3], axis }),
        feed: Feed::PerMinute(500.0),
        words,
    };
    let events = [
        Event::Start,
        TOOL,
        turning(3000.0),
        turn(P1),
        at(P1),
        to(P3, [0.0, 0.6, 0.8]),
        to(P4, [0.0, 0.6, 0.8]),
        to(P4, [0.6, 0.0, 0.8]),
        to(P4, [0.6, 0.0, 0.8]),
        cut(P1, 500.0),
        TOP,
        Event::End,
    ];
    let vectors = bench().tcp().with("tool_vectors", Value::Flag(true));
    insta::assert_snapshot!(vectors.write(&events).unwrap());
}

#[test]
fn tools_offsets_messages_calls_and_stops() {
    let events = [
        Event::Start,
        TOP,
        Event::tool_change(3, 3, "Fräser \"D10\""),
        Event::SurfaceSpeed { speed: 120.0, most: Some(8000.0), sense: SpindleSense::Clockwise },
        TOP,
        turn(P1),
        at(P1),
        cut(P3, 850.0),
        turning(2000.0),
        Event::Stop,
        Event::Message { text: "Spannen \"links\"" },
        Event::Message { text: "" },
        TOP,
        Event::WorkOffset { number: 2, name: "" },
        turn(P1),
        at(P1),
        TOP,
        Event::WorkOffset { number: 12, name: "" },
        turn(P1),
        at(P1),
        Event::Smoothing { tolerance: 0.01, axis_tolerance: Some(0.1) },
        Event::Probe { tool: None, feed: Feed::PerMinute(100.0), words: P3 },
        rapid(P3),
        TOP,
        Event::Subprogram { number: Some(123), times: 2, name: "" },
        Event::Subprogram { number: None, times: 1, name: "WENDEN_2" },
        TOP,
        Event::Spindle(Spindle::Orient),
        Event::End,
    ];
    let bench = bench()
        .tcp()
        .with("tool_names", Value::Flag(true))
        .with("transfer_header", Value::Flag(true))
        .with("parameters", Value::Flag(true));
    insta::assert_snapshot!(bench.write(&events).unwrap());
}

#[test]
fn smoothing_as_the_software_has_it() {
    let smooth = |bench: Bench, tolerance, axis_tolerance| {
        let events = [Event::Smoothing { tolerance, axis_tolerance }, Event::SmoothingOff];
        bench.with("block_numbers", Value::Text("none")).write(&events).unwrap()
    };
    assert_eq!(smooth(bench(), 0.01, None), "CYCLE832(0.01,1,1)\nCYCLE832()\n");
    assert_eq!(smooth(bench(), 0.05, Some(0.5)), "CYCLE832(0.05,13,0.5)\nCYCLE832()\n");
    assert_eq!(smooth(bench().inch(), 0.0254, None), "CYCLE832(0.001,2,1)\nCYCLE832()\n");
    let compressor = bench().with("smoothing_by", Value::Text("COMPCAD"));
    assert_eq!(
        smooth(compressor, 0.01, Some(0.1)),
        "COMPCAD CTOL=0.01 OTOL=0.1\nCOMPOF CTOL=-1 OTOL=-1\n"
    );
    let old =
        bench().with("software", Value::Text("2")).with("smoothing_code", Value::Integer(112_101));
    assert_eq!(smooth(old, 0.01, Some(0.1)), "CYCLE832(0.01,112101)\nCYCLE832()\n");
}

/// The control would go from 350 to 10 degrees through 180 without it.
#[test]
fn wrapped_axes_take_the_shorter_way() {
    let words = ["X", "Z", "C"].map(|name| AxisWord {
        name,
        rotary: name == "C",
        wrapped: name == "C",
        depth: name == "Z",
        ..AxisWord::default()
    });
    let declared = post_siemens::plugin().options();
    let options: Vec<_> = declared.iter().map(|spec| (spec.key, spec.default)).collect();
    let setup =
        Setup { units: Units::Millimetre, words: &words, options: &options, ..Setup::default() };
    let mut dialect = post_siemens::plugin().open(&setup).unwrap().unwrap();
    let mut batch = Batch::default();
    batch.push(1, Event::Start);
    batch.push(2, turn(&[0.0, 0.0, 350.0]));
    batch.push(3, turn(&[0.0, 0.0, 10.0]));
    // A machine that shows -180 to 180: the words of a modulo axis lie from 0 to 359.999 all the same.
    batch.push(4, turn(&[0.0, 0.0, -100.0]));
    let promise = Promise { words: 3, inverse_time: true };
    let (mut out, mut ends) = (String::new(), Vec::new());
    dialect.write(&batch, &promise, &mut out, &mut ends).unwrap();
    assert!(
        out.contains("G0 C=DC(350.000)\n")
            && out.contains(" C=DC(10.000)\n")
            && out.contains(" C=DC(260.000)\n"),
        "{out}"
    );
}

/// A modulo axis takes 0 to 359.999 alone, and each move goes the way that was certified.
#[test]
fn endless_axes_stay_within_a_turn() {
    let words = ["X", "Z", "C"].map(|name| AxisWord {
        name,
        rotary: name == "C",
        depth: name == "Z",
        travel: (name != "C").then_some([-500.0, 500.0]),
        ..AxisWord::default()
    });
    let written = |endless: &'static str, angles: &[f64], cut: bool| {
        let declared = post_siemens::plugin().options();
        let mut options: Vec<_> = declared.iter().map(|spec| (spec.key, spec.default)).collect();
        for (key, value) in &mut options {
            if *key == "endless" {
                *value = Value::Text(endless);
            }
        }
        let setup = Setup {
            units: Units::Millimetre,
            words: &words,
            options: &options,
            ..Setup::default()
        };
        let mut dialect = post_siemens::plugin().open(&setup).unwrap().unwrap();
        let mut batch = Batch::default();
        batch.push(1, Event::Start);
        let places: Vec<[f64; 3]> = angles.iter().map(|angle| [0.0, 0.0, *angle]).collect();
        for place in &places {
            batch.push(
                2,
                match cut {
                    true => Event::linear(place, Feed::PerMinute(100.0)),
                    false => turn(place),
                },
            );
        }
        let promise = Promise { words: 3, inverse_time: true };
        let (mut out, mut ends) = (String::new(), Vec::new());
        let done = dialect.write(&batch, &promise, &mut out, &mut ends);
        done.map(|()| out)
    };
    let angles = [-80.0, 10.0, 200.0, 10.0, 170.0, 359.9999];
    let out = written("modulo", &angles, false).unwrap();
    let found: Vec<&str> = out.split_whitespace().filter(|word| word.starts_with("C=")).collect();
    assert_eq!(
        found,
        [
            "C=DC(280.000)",
            "C=DC(10.000)",
            "C=ACP(200.000)",
            "C=ACN(10.000)",
            "C=DC(170.000)",
            "C=ACP(0.000)"
        ],
        "{out}"
    );
    assert!(written("counted", &angles, false).unwrap().contains("C-80.000"));
    assert!(written("modulo", &[0.0, 400.0], true).is_err());
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |events: &[Event<'_>]| bench().write(events).unwrap_err();
    assert!(
        refused(&[cycle(Cycle::Tap, 100.0, None, None), hole(P1)]).contains("no spindle turns")
    );
    assert!(refused(&[hole(P1)]).contains("without its cycle"));
    let offset = Event::WorkOffset { number: 100, name: "" };
    assert!(refused(&[offset]).contains("G505 to G599"));
    let call = Event::Subprogram { number: None, times: 1, name: "1; M30" };
    assert!(refused(&[call]).contains("two letters first"));
    assert!(refused(&[arc([0.0; 3], [0.6, 0.0, 0.8], 90.0, P1)]).contains("G17, G18, G19"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
}
