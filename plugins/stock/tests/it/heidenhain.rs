use post_host::Plugin;
use post_kit::{
    Bench, P1, P2, P3, P4, TOOL, TOP, at, conformance, cut, jobs, rapid, timed, turn, turning,
};
use post_plugin::{
    Ahead, AxisWord, Batch, Coolant, Cycle, Event, Feed, PlaneAngles, Promise, Setup, Spindle,
    SpindleSense, Tool, ToolPose, Units, Value,
};

fn bench() -> Bench {
    Bench::of(post_heidenhain::plugin())
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
fn options_change_what_they_say() {
    let bench = bench()
        .inch()
        .tcp()
        .with("preset", Value::Integer(-1))
        .with("rotary_way", Value::Text("M126"))
        .with("retract", Value::Text("L Z-1 R0 FMAX M91"))
        .with("tcp_on", Value::Text("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"))
        .with("tcp_off", Value::Text("FUNCTION RESET TCPM"));
    let events = [
        Event::Start,
        TOOL,
        Event::Comment { text: "rough ~" },
        turning(3000.0),
        at(P1),
        cut(P3, 12.3),
        turning(4000.0),
        cut(P4, 12.3),
        post_kit::TOP,
        Event::End,
    ];
    insta::assert_snapshot!(bench.write(&events).unwrap());
}

/// Lines of the machine file in the place of a tool call keep their oversizes: no call of ours stands behind them.
#[test]
fn own_tool_calls_get_the_speed_and_nothing_behind_them() {
    let own = |text| {
        let events = [
            Event::Start,
            Event::Instead { text },
            TOOL,
            Event::Word { text: "; measured" },
            turning(3000.0),
            at(P1),
            TOP,
            Event::End,
        ];
        bench().write(&events)
    };
    let written = own("TOOL CALL 1 Z DL+0.1 DR-0.05 ; worn").unwrap();
    assert!(written.contains(" TOOL CALL 1 Z S3000 DL+0.1 DR-0.05 ; worn\n"), "{written}");
    assert_eq!(written.matches("TOOL CALL").count(), 1, "{written}");
    let written = own("TOOL CALL 1 Z S3000").unwrap();
    assert_eq!(written.matches("TOOL CALL").count(), 1, "{written}");
    assert!(own("TOOL CALL 1 Z S2000").unwrap_err().contains("S3000"));
    let written = own("CALL PGM CHANGE").unwrap();
    assert!(
        written.contains("CALL PGM CHANGE\n") && written.contains("TOOL CALL S3000\n"),
        "{written}"
    );
}

/// `M140` knows the tool's axis from a TOOL CALL alone.
#[test]
fn nothing_retracts_along_a_tool_that_was_not_called() {
    let bench = bench().with("retract", Value::Text("L M140 MB MAX"));
    let events = [Event::Start, TOP, TOOL, turning(1000.0), at(P1), TOP, Event::End];
    let text = bench.write(&events).unwrap();
    let (before, _) = text.split_once("TOOL CALL").unwrap();
    assert!(!before.contains("M140"), "{text}");
    assert!(text.contains("M140"), "{text}");
    let uncalled = bench.write(&[Event::Start, TOP, at(P1)]).unwrap_err();
    assert!(uncalled.contains("no TOOL CALL"), "{uncalled}");
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |events: &[Event<'_>]| bench().write(events).unwrap_err();
    assert!(refused(&[timed(P1, 2.0)]).contains("in inverse time"));
    assert!(refused(&[Event::Coolant(Coolant::Mist)]).contains("coolant_mist"));
    assert!(refused(&[Event::Spindle(Spindle::Orient)]).contains("cycle"));
    assert!(refused(&[Event::Unknown { kind: 99 }]).contains("99"));
    assert!(refused(&[Event::Units(Units::Inch)]).contains("first line"));
    assert!(refused(&[hole(P1)]).contains("without its cycle"));
    assert!(refused(&[cycle(Cycle::Tap, None, None), hole(P1)]).contains("no spindle turns"));
    assert!(refused(&[cycle(Cycle::BoreBack, None, None), hole(P1)]).contains("back boring"));
    assert!(refused(&[arc([0.0; 3], [0.0, 1.0, 0.0], 90.0, P1)]).contains("X Y"));
    let speed = Event::SurfaceSpeed { speed: 100.0, most: None, sense: SpindleSense::Clockwise };
    assert!(refused(&[speed]).contains("constant cutting speed"));
    let named = bench().with("tool_names", Value::Flag(true));
    let long = Event::tool_change(1, 1, "a name of more than thirty-two characters");
    assert!(named.write(&[long, turning(1.0)]).unwrap_err().contains("tool_names"));
    let text = named.write(&[TOOL, turning(1.0)]).unwrap();
    assert!(text.contains("TOOL CALL \"BALL_D10__R5_\" Z S1"), "{text}");
}

#[test]
fn the_kit_finds_nothing_wrong() {
    let plugin = Plugin::linked(post_heidenhain::plugin()).unwrap();
    let report = conformance::test(&plugin, &[]).unwrap();
    assert!(report.is_good(), "{report}");
}

/// Above the part, upright.
const Q0: &[f64] = &[0.0, 0.0, 50.0, 0.0, 0.0];

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

const fn cycle(cycle: Cycle, step: Option<f64>, dwell: Option<f64>) -> Event<'static> {
    Event::Cycle {
        cycle,
        feed: Feed::PerMinute(120.0),
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
fn arcs_and_cycles() {
    let z = [0.0, 0.0, 1.0];
    let events = [
        Event::Start,
        TOP,
        TOOL,
        Event::Operation { name: "Tasche ~ links" },
        Event::Smoothing { tolerance: 0.02, axis_tolerance: None },
        turning(3000.0),
        TOP,
        turn(Q0),
        at(Q0),
        rapid(&[0.0, 0.0, 2.0, 0.0, 0.0]),
        cut(&[0.0, 0.0, -1.0, 0.0, 0.0], 300.0),
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
        cycle(Cycle::Drill, None, Some(0.5)),
        hole(&[10.0, 20.0, 0.0, 0.0, 0.0]),
        hole(&[30.0, 20.0, 0.0, 0.0, 0.0]),
        hole(&[30.0, 40.0, -5.0, 0.0, 0.0]),
        cycle(Cycle::Deep, Some(4.0), None),
        hole(&[60.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::BreakChip, Some(4.0), None),
        hole(&[70.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Ream, None, None),
        hole(&[80.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Bore, None, None),
        hole(&[90.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::BoreFine, None, None),
        hole(&[95.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::Tap, None, None),
        hole(&[100.0, 40.0, 0.0, 0.0, 0.0]),
        cycle(Cycle::TapLeft, None, None),
        hole(&[110.0, 40.0, 0.0, 0.0, 0.0]),
        Event::CycleOff,
        rapid(&[110.0, 40.0, 50.0, 0.0, 0.0]),
        TOP,
        Event::End,
    ];
    let bench = bench().with("bore_direction", Value::Integer(1));
    insta::assert_snapshot!(bench.write(&events).unwrap());
    let other = bench
        .with("tapping", Value::Text("floating"))
        .with("control", Value::Text("iTNC530"))
        .with("language", Value::Text("German"));
    let text = other.write(&events).unwrap();
    assert!(!text.contains("Q395"));
    for line in [
        "CYCL DEF 206 GEWINDEBOHREN ~\n    Q200=+2 ;",
        "CYCL DEF 7.0 NULLPUNKT",
        "CYCL DEF 247 BEZUGSPUNKT SETZEN ~",
        "CYCL DEF 32.0 TOLERANZ",
    ] {
        assert!(text.contains(line), "{line}\n{text}");
    }
}

#[test]
fn a_tilted_plane_and_other_datums() {
    let plane = Event::Plane {
        origin: [10.0, -20.0, 5.5],
        x: [1.0, 0.0, 0.0],
        z: [0.0, 0.5, 0.866_025],
        angles: [45.0, 12.3456, -30.0],
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
        cycle(Cycle::Drill, None, None),
        hole(&[10.0, -20.5, 0.0, -30.0, 45.0]),
        Event::CycleOff,
        turning(4000.0),
        TOP,
        Event::PlaneOff,
        Event::WorkOffset { number: 3, name: "" },
        turn(P3),
        at(P3),
        TOP,
        Event::Subprogram { number: Some(5), times: 2, name: "" },
        Event::Subprogram { number: None, times: 1, name: "wenden.h" },
        Event::End,
    ];
    insta::assert_snapshot!(bench().tcp().write(&events).unwrap());
    let other = bench()
        .with("plane", Value::Text("STAY SEQ- TABLE ROT"))
        .with("datum_shift", Value::Text("TRANS DATUM"));
    let text = other.write(&[plane, Event::PlaneOff]).unwrap();
    assert_eq!(
        text,
        "0 TRANS DATUM AXIS X+10.0000 Y-20.0000 Z+5.5000\n\
         1 PLANE SPATIAL SPA-30 SPB+12.3456 SPC+45 STAY SEQ- TABLE ROT\n\
         2 PLANE RESET STAY\n\
         3 TRANS DATUM AXIS X+0.0000 Y+0.0000 Z+0.0000\n"
    );
}

/// SPA, then SPB, then SPC about the fixed axes X, Y, Z: the frame is that of the turns about the moving Z, Y, X.
#[test]
fn spatial_angles_lead_back_to_the_plane() {
    for angles in
        [[12.5, 33.25, -140.125], [0.0, 90.0, 45.0], [179.5, -90.0, 0.0], [-90.0, 0.0, 30.0]]
    {
        let wanted = jobs::frame(PlaneAngles::Zyx, angles);
        let plane =
            Event::Plane { origin: [0.0; 3], x: wanted[0], z: wanted[2], angles, words: P1 };
        let text = bench().write(&[plane]).unwrap();
        let angle = |word: &str| -> f64 {
            let mut found = text.split_whitespace().filter_map(|found| found.strip_prefix(word));
            found.find_map(|angle| angle.parse().ok()).unwrap()
        };
        let printed = ["SPA", "SPB", "SPC"].map(angle);
        for (axis, wanted) in wanted.iter().enumerate() {
            let mut found: [f64; 3] = std::array::from_fn(|part| f64::from(u8::from(part == axis)));
            for (about, degrees) in printed.into_iter().enumerate() {
                let (sine, cosine) = libm::sincos(degrees.to_radians());
                let (next, last) = ((about + 1) % 3, (about + 2) % 3);
                let before = found;
                found[next] = cosine * before[next] - sine * before[last];
                found[last] = sine * before[next] + cosine * before[last];
            }
            for (found, wanted) in found.iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-9, "{angles:?}\n{text}");
            }
        }
    }
}

#[test]
fn the_jobs_of_every_dialect() {
    let bench = bench();
    insta::assert_snapshot!("three_axes", bench.write_declared(&jobs::three_axes()).unwrap());
    insta::assert_snapshot!("tilted", bench.write_declared(&jobs::tilted()).unwrap());
    insta::assert_snapshot!("tools", bench.write_declared(&jobs::tools()).unwrap());
}

#[test]
fn vectors_of_tool_and_surface() {
    let tool = |axis| {
        let tip = [0.0; 3];
        Some(ToolPose { tip, axis })
    };
    let feed = Feed::PerMinute(500.0);
    let to = |words, axis| Event::Linear { tool: tool(axis), feed, words };
    let surface =
        |words, axis| Event::Surface { tool: tool(axis), feed, normal: [0.0, 0.0, 1.0], words };
    let events = [
        turning(3000.0),
        turn(P1),
        at(P1),
        to(P3, [0.0, 0.6, 0.8]),
        to(P4, [0.0, 0.6, 0.8]),
        to(P4, [0.0, 0.6, 0.8]),
        surface(P3, [0.0, 0.0, 1.0]),
        cut(P1, 500.0),
        TOP,
    ];
    let kept = bench().tcp();
    let vectors = kept.clone().with("tool_vectors", Value::Flag(true));
    insta::assert_snapshot!(vectors.write(&events).unwrap());
    // By rotary words where vectors are not asked for.
    let text = kept.write(&[at(P1), surface(P3, [0.0, 0.6, 0.8])]).unwrap();
    let wanted =
        "LN X+12.500 Y-20.500 Z+2.000 A-30.125 NX+0.0000000 NY+0.0000000 NZ+1.0000000 F500\n";
    assert!(text.ends_with(wanted), "{text}");
    let refused = bench().write(&[at(P1), surface(P3, [0.0, 0.6, 0.8])]);
    assert!(refused.unwrap_err().contains("M128"));
}

/// Lines in the place of a retract stand for its way alone: TCP is off ahead of them.
#[test]
fn lines_in_the_place_of_an_event_are_numbered_like_any_other() {
    let events =
        [turning(3000.0), at(P1), Event::Instead { text: "L M140 MB MAX" }, TOP, TOP, at(P1)];
    let text = bench().tcp().write(&events).unwrap();
    let tail: Vec<&str> = text.lines().skip(8).collect();
    assert_eq!(
        tail,
        [
            "8 M129",
            "9 L M140 MB MAX",
            "10 L Z+500.000 R0 FMAX M91",
            "11 L A-30.000 C+45.000 R0 FMAX",
            "12 M128",
            "13 L X+10.000 Y-20.500 FMAX",
            "14 L Z+100.000 FMAX"
        ],
        "{text}"
    );
}

/// A machine without rotary axes, with what a first pass over the file knows.
#[test]
fn three_axes_with_a_stock_and_tools_by_name() {
    let words =
        ["X", "Y", "Z"].map(|name| AxisWord { name, depth: name == "Z", ..AxisWord::default() });
    let declared = post_heidenhain::plugin().options();
    let mut options: Vec<_> = declared.iter().map(|spec| (spec.key, spec.default)).collect();
    for (key, value) in &mut options {
        if ["blk_form", "tool_names"].contains(key) {
            *value = Value::Flag(true);
        }
    }
    let tools =
        [Tool { number: 4, name: "BOHRER_8.5", length: None, diameter: None, corner_radius: None }];
    let setup = Setup {
        program: "platte",
        words: &words,
        options: &options,
        ahead: Some(Ahead {
            tools: &tools,
            extents: Some([[-10.0, -20.0, -5.0], [110.0, 60.5, 0.0]]),
            time: None,
        }),
        ..Setup::default()
    };
    let mut dialect = post_heidenhain::plugin().open(&setup).unwrap().unwrap();
    let mut batch = Batch::default();
    let events = [
        Event::Start,
        Event::tool_change(3, 3, "FRAESER"),
        Event::Preselect { number: 4 },
        turning(3000.0),
        at(&[1.0, 2.0, 50.0]),
        cut(&[1.0, 2.0, -5.0], 300.0),
        Event::End,
    ];
    for (line, event) in (1..).zip(events) {
        batch.push(line, event);
    }
    let promise = Promise { words: 3, inverse_time: true };
    let (mut out, mut ends) = (String::new(), Vec::new());
    dialect.write(&batch, &promise, &mut out, &mut ends).unwrap();
    insta::assert_snapshot!(out);
}
