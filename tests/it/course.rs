//! What reading back takes a CL file to mean, against what posting does: two readings of the same records that share no
//! code must agree, point by point, feed by feed and word by word.

mod renamed;
mod writers;

use std::fs;
use std::io::Cursor;
use std::path::PathBuf;

use nalgebra::Vector3;
use post_grammar::{ClReader, ReadError, Units};
use post_plugin::{Compensation, Coolant, Spindle, SpindleSense};
use post_posting::program::{
    ClInterpreter, Command, CycleLeg, DefaultSpindle, MoveFeed, ProgramStep, ReadingOptions,
};
use post_readback::convert::{ClWriter, MountedTool};
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::{Course, CourseItem, CoursePiece, Curve};
use post_readback::{MotionKind, ProgramEvent};
use post_testkit::{repository, shared};

/// Both compute in doubles, in another order.
const SAME: f64 = 1e-8;

/// How a file is read, for both sides.
#[derive(Clone, Debug, Default)]
struct How {
    units: Option<Units>,
    apply_msys: bool,
    turn: f64,
    tool: Option<u32>,
    from_cutter: bool,
    feed: Option<f64>,
    spindle: Option<f64>,
    allowed: Vec<String>,
}

/// Where the tool goes or what is said, so that both sides can be held against each other.
#[derive(Clone, Debug)]
enum Beat {
    /// A straight way, or what ends another.
    To {
        line: u64,
        rapid: bool,
        feed: Option<f64>,
        tip: Vector3<f64>,
        axis: Vector3<f64>,
        edge: Vector3<f64>,
    },
    /// Points on the way there, in order.
    Through(Vec<Vector3<f64>>),
    Said(String),
}

fn files() -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in
        [shared("data/cl"), Some(repository().join("tests/samples"))].into_iter().flatten()
    {
        files.extend(fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    }
    files.sort();
    files
}

/// As posting reads it, with what it refuses.
fn posted(text: &[u8], how: &How) -> (Vec<Beat>, Vec<String>) {
    let mut interpreter = ClInterpreter::new(ReadingOptions {
        file: "part.cls".to_owned(),
        units: how.units,
        apply_msys: how.apply_msys,
        turn: how.turn,
        tool: how.tool,
        tool_from_cutter: how.from_cutter,
        feed: how.feed,
        spindle: how.spindle.map_or(DefaultSpindle::Still, DefaultSpindle::On),
        chord_tolerance: 0.0005,
        allowed: how.allowed.clone(),
        ..ReadingOptions::default()
    });
    let mut reader = ClReader::new(text);
    let mut beats = Vec::new();
    let mut faults = Vec::new();
    loop {
        match reader.next_record() {
            Ok(None) => break,
            Ok(Some(record)) => {
                let line = record.line;
                interpreter.record(&record, &mut |step| posted_step(line, step, &mut beats));
            }
            Err(ReadError::Syntax(fault)) => faults.push(fault.message.clone()),
            Err(ReadError::Io(error)) => panic!("{error}"),
        }
    }
    interpreter.finish();
    let errors = interpreter.take_findings().into_iter();
    faults.extend(
        errors
            .filter(|finding| finding.severity == post_machine::diagnostic::Severity::Error)
            .map(|finding| finding.message),
    );
    (beats, faults)
}

fn posted_step(line: u64, step: ProgramStep, beats: &mut Vec<Beat>) {
    let to = |motion: &post_posting::program::StraightMove| Beat::To {
        line,
        rapid: motion.pace == MoveFeed::Rapid,
        feed: match motion.pace {
            MoveFeed::PerMinute(feed) => Some(feed),
            MoveFeed::Rapid | MoveFeed::InverseTime(_) | MoveFeed::PerRevolution(_) => None,
        },
        tip: motion.tip,
        axis: motion.axis,
        edge: motion.edge,
    };
    match step {
        ProgramStep::Move(motion) => beats.push(to(&motion)),
        ProgramStep::Arc(step) => {
            let points = (1..8).map(|place| step.arc.at(f64::from(place) / 8.0));
            beats.push(Beat::Through(points.collect()));
            beats.push(to(&step.end));
        }
        ProgramStep::Spline(step) => {
            let points = (1..500).map(|place| step.spline.at(f64::from(place) / 500.0));
            beats.push(Beat::Through(points.collect()));
            beats.push(to(&step.end));
        }
        ProgramStep::Cycle(step) => {
            let mut legs = Vec::new();
            step.cycle.legs(&mut |leg| legs.push(leg));
            // Pecks are the control's: of the ways at feed the deepest counts, and what comes behind it.
            let deepest = |leg: &CycleLeg| matches!(leg, CycleLeg::Feed(height) if *height < 0.0);
            let last = legs.iter().rposition(deepest).unwrap_or(0);
            // Between holes: up, then aside, then down, by the rapids of what `Expand` makes of the step.
            let stands = beats.iter().rev().find_map(|beat| match beat {
                Beat::To { tip, .. } => Some(Some(*tip)),
                Beat::Said(said) => {
                    LEAVES.iter().any(|word| said.starts_with(word)).then_some(None)
                }
                Beat::Through(_) => None,
            });
            if let Some(tip) = stands.flatten() {
                let (foot, axis) = (step.point.tip, step.point.axis);
                let height = axis.dot(&(tip - foot));
                let aside = tip - foot - axis * height;
                let level = step.cycle.retract();
                let mut motion = step.point;
                motion.pace = MoveFeed::Rapid;
                if aside.norm() > 1e-6 && height < level {
                    motion.tip = foot + aside + axis * level;
                    beats.push(to(&motion));
                } else if aside.norm() > 1e-6 && height > level {
                    motion.tip = foot + axis * height;
                    beats.push(to(&motion));
                }
            }
            let at = |height: f64, pace: MoveFeed| {
                let mut motion = step.point;
                motion.tip += motion.axis * height;
                motion.pace = pace;
                to(&motion)
            };
            for (place, leg) in legs.iter().enumerate() {
                match *leg {
                    CycleLeg::Rapid(height) if place < 2 || place > last => {
                        beats.push(at(height, MoveFeed::Rapid));
                    }
                    CycleLeg::Feed(height) if place >= last => {
                        beats.push(at(height, step.point.pace))
                    }
                    CycleLeg::Dwell(seconds) => {
                        beats.push(Beat::Said(format!("dwell {seconds:.4}")))
                    }
                    CycleLeg::Rapid(_) | CycleLeg::Feed(_) => {}
                }
            }
        }
        ProgramStep::EndCycle | ProgramStep::Plane(_) => {}
        ProgramStep::Command(command) => beats.extend(said(command).map(Beat::Said)),
    }
}

/// Behind these nobody knows where the tool stands.
const LEAVES: [&str; 6] = ["tool", "away", "index", "head", "offset", "subprogram"];

/// A command in the words of [`heard`].
fn said(command: Command) -> Option<String> {
    Some(match command {
        Command::Tool(tool) => format!("tool {} {:?}", tool.number, tool.name),
        Command::Preselect(number) => format!("preselect {number}"),
        Command::Spindle(Spindle::Off) => "spindle off".to_owned(),
        Command::Spindle(Spindle::Orient) => "spindle oriented".to_owned(),
        Command::Spindle(Spindle::On { rpm, sense }) => {
            let left = sense == SpindleSense::CounterClockwise;
            format!("spindle {rpm:.6} left {left}")
        }
        Command::Coolant(coolant) => {
            let all = [
                coolant == Coolant::Flood,
                coolant == Coolant::Mist,
                matches!(coolant, Coolant::Through | Coolant::Air),
            ];
            format!("coolant {all:?}")
        }
        Command::Compensate(Compensation::Off) => "compensation 0 None".to_owned(),
        Command::Compensate(Compensation::Left { register }) => {
            format!("compensation -1 {:?}", Some(register))
        }
        Command::Compensate(Compensation::Right { register }) => {
            format!("compensation 1 {:?}", Some(register))
        }
        Command::Operation(name) => format!("operation {name}"),
        Command::Message(text) => format!("message {text}"),
        Command::WorkOffset(number) => format!("offset {number}"),
        Command::Subprogram(number) => format!("subprogram {number}"),
        Command::Dwell(seconds) => format!("dwell {seconds:.4}"),
        Command::Stop => "stop".to_owned(),
        Command::OptionalStop => "optional stop".to_owned(),
        Command::Index { .. } => "index".to_owned(),
        Command::Home => "away".to_owned(),
        Command::Head(name) => format!("head {name}"),
        _ => return None,
    })
}

/// How reading back takes a file.
fn settings(how: &How) -> ClSettings {
    ClSettings {
        file: "part.cls".to_owned(),
        units: how.units,
        apply_msys: how.apply_msys,
        turn: how.turn,
        tool: how.tool,
        tool_from_cutter: how.from_cutter,
        feed: how.feed,
        spindle: how.spindle,
        allowed: how.allowed.clone(),
        ..ClSettings::default()
    }
}

/// As reading back takes it, with what it refuses.
fn course(text: &[u8], how: &How) -> (Vec<Beat>, Vec<String>) {
    let mut course = ClCourse::new(settings(how), Cursor::new(text));
    let (mut beats, mut faults) = (Vec::new(), Vec::new());
    loop {
        match course.next() {
            Ok(None) => return (beats, faults),
            Ok(Some(item)) => course_item(item, &mut beats),
            Err(fault) => faults.push(fault.message),
        }
    }
}

fn course_item(item: CourseItem, beats: &mut Vec<Beat>) {
    match item {
        CourseItem::Piece(piece) => {
            if let Some(points) = points_on(&piece) {
                beats.push(Beat::Through(points));
            }
            beats.push(Beat::To {
                line: piece.line,
                rapid: piece.kind == MotionKind::Rapid,
                feed: piece.feed,
                tip: piece.to.tip,
                axis: piece.to.axis,
                edge: piece.to.edge,
            });
        }
        CourseItem::Reach(reach) => beats.push(Beat::To {
            line: reach.line,
            rapid: reach.kind == MotionKind::Rapid,
            feed: reach.feed,
            tip: reach.to.tip,
            axis: reach.to.axis,
            edge: reach.to.edge,
        }),
        CourseItem::Away { .. } => beats.push(Beat::Said("away".to_owned())),
        CourseItem::Event { event: told, .. } => beats.extend(heard(told).map(Beat::Said)),
    }
}

fn points_on(piece: &CoursePiece) -> Option<Vec<Vector3<f64>>> {
    let shares = |count: u32| (1..count).map(move |place| f64::from(place) / f64::from(count));
    match &piece.curve {
        Curve::Straight => None,
        Curve::Arc { .. } => Some(shares(8).map(|t| piece.at(t, 0.0).tip).collect()),
        Curve::Spline(_) => Some(shares(4000).map(|t| piece.at(t, 0.0).tip).collect()),
    }
}

fn heard(told: ProgramEvent) -> Option<String> {
    use post_readback::SpindleState as Turns;
    Some(match told {
        ProgramEvent::ToolChange { number, name } => {
            format!("tool {} {:?}", number?, name.unwrap_or_default())
        }
        ProgramEvent::Preselect(number) => format!("preselect {number}"),
        ProgramEvent::Spindle(Turns::Off) => "spindle off".to_owned(),
        ProgramEvent::Spindle(Turns::Oriented) => "spindle oriented".to_owned(),
        ProgramEvent::Spindle(Turns::Clockwise(rpm)) => format!("spindle {rpm:.6} left false"),
        ProgramEvent::Spindle(Turns::CounterClockwise(rpm)) => {
            format!("spindle {rpm:.6} left true")
        }
        ProgramEvent::Coolant(coolants) => {
            format!("coolant {:?}", [coolants.flood, coolants.mist, coolants.other])
        }
        ProgramEvent::Compensation { side, register } => {
            format!("compensation {side} {register:?}")
        }
        ProgramEvent::Operation(name) => format!("operation {name}"),
        ProgramEvent::Message(text) => format!("message {text}"),
        ProgramEvent::WorkOffset(number) => format!("offset {number}"),
        ProgramEvent::Subprogram(number) => format!("subprogram {number}"),
        ProgramEvent::Dwell { time, .. } => format!("dwell {time:.4}"),
        ProgramEvent::Stop => "stop".to_owned(),
        ProgramEvent::OptionalStop => "optional stop".to_owned(),
        ProgramEvent::Head(name) => format!("head {name}"),
        _ => return None,
    })
}

/// Where the two differ first; none if nowhere.
fn difference(ours: &[Beat], theirs: &[Beat]) -> Option<String> {
    let mut theirs = theirs.to_vec();
    theirs.retain(|beat| !matches!(beat, Beat::Said(said) if said == "index"));
    let theirs = &theirs;
    let still = |beats: &[Beat]| {
        // A way of no length is none: between holes, above them.
        let mut kept: Vec<Beat> = Vec::new();
        for beat in beats {
            if let (Beat::To { tip, axis, .. }, Some(Beat::To { tip: last, axis: before, .. })) =
                (beat, kept.iter().rev().find(|beat| matches!(beat, Beat::To { .. })))
                && (tip - last).norm() < SAME
                && (axis - before).norm() < SAME
                && !matches!(kept.last(), Some(Beat::Through(_)))
            {
                continue;
            }
            kept.push(beat.clone());
        }
        kept
    };
    let (ours, theirs) = (still(ours), still(theirs));
    for place in 0..ours.len().max(theirs.len()) {
        let (Some(a), Some(b)) = (ours.get(place), theirs.get(place)) else {
            return Some(format!(
                "beat {place}: {:?} against {:?}",
                ours.get(place),
                theirs.get(place)
            ));
        };
        if !same(a, b) {
            return Some(format!("beat {place}: {a:?} against {b:?}"));
        }
    }
    None
}

fn same(ours: &Beat, theirs: &Beat) -> bool {
    match (ours, theirs) {
        (
            Beat::To { line, rapid, feed, tip, axis, edge },
            Beat::To { line: l, rapid: r, feed: f, tip: t, axis: a, edge: e },
        ) => {
            let feeds = match (feed, f) {
                (Some(feed), Some(f)) => (feed - f).abs() <= 1e-9 * feed.abs(),
                // A feed by time has no feed a minute where posting settles it.
                _ => true,
            };
            line == l
                && rapid == r
                && feeds
                && (tip - t).norm() < SAME
                && (axis - a).norm() < 1e-12
                && (edge - e).norm() < 1e-12
        }
        (Beat::Through(points), Beat::Through(others)) if points.len() == others.len() => {
            points.iter().zip(others).all(|(a, b)| (a - b).norm() < SAME)
        }
        // A spline at places of its own: each of theirs lies on our chords.
        (Beat::Through(points), Beat::Through(others)) => others.iter().all(|other| {
            points.windows(2).any(|pair| {
                let (a, way) = (pair[0], pair[1] - pair[0]);
                let share =
                    ((other - a).dot(&way) / way.norm_squared().max(1e-30)).clamp(-1.0, 2.0);
                (a + way * share - other).norm() < 1e-5 * other.norm().max(100.0)
            })
        }),
        (Beat::Said(a), Beat::Said(b)) => a == b,
        _ => false,
    }
}

#[test]
fn two_readings_of_every_file_agree() {
    // One of the files goes in pecks and says none.
    let allowed = vec!["DEEP".to_owned()];
    let hows = [
        How { allowed: allowed.clone(), ..How::default() },
        How {
            units: Some(Units::Inch),
            apply_msys: true,
            tool: Some(7),
            feed: Some(321.0),
            spindle: Some(4321.0),
            allowed: allowed.clone(),
            ..How::default()
        },
        How { turn: 0.3, apply_msys: true, from_cutter: true, allowed, ..How::default() },
    ];
    let mut compared = 0;
    let mut differences = Vec::new();
    for path in files() {
        let text = fs::read(&path).unwrap();
        for (place, how) in hows.iter().enumerate() {
            let (theirs, refused) = posted(&text, how);
            let (ours, faults) = course(&text, how);
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if let Some(difference) = difference(&ours, &theirs) {
                differences.push(format!(
                    "{name} {place}: {difference}\n  refused {:?}\n  faults {:?}",
                    refused.first(),
                    faults.first()
                ));
            }
            compared += theirs.len();
        }
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
    assert!(compared > 10_000, "{compared}");
}

/// Points that stand behind `GOTO` and `GOHOME` in a file, arcs, splines, and the least and largest coordinates of these points in mm:
/// counted by a program apart from this project (thirty lines of Python that know `$`, `$$` and UNITS). Files that turn
/// the part (`ROTABL`) have no extents here, for they are written in frames that turn.
type Figures = (&'static str, u64, u64, u64, Option<[f64; 6]>);

const FIGURES: [Figures; 18] = [
    ("camworks_neMoguta_UniSource.clt", 360, 72, 0, None),
    (
        "creo3x_MichaHofft_bohren_1.ncl",
        4,
        0,
        0,
        Some([-16.780, -23.000, 0.500, -7.229, -23.000, 2.000]),
    ),
    (
        "creo3x_MichaHofft_profilfraesen_2.ncl",
        52,
        20,
        0,
        Some([-25.500, -34.500, -7.000, 1.500, 1.500, 2.000]),
    ),
    (
        "creo3x_MichaHofft_schruppen_1.ncl",
        5590,
        419,
        0,
        Some([-17.625, -23.834, -6.840, -6.384, -2.974, 2.000]),
    ),
    (
        "creo5x_4r19415_finition.ncl",
        35418,
        0,
        0,
        Some([869.200, -3080.543, 1021.402, 6226.291, 1999.456, 5111.149]),
    ),
    (
        "nx_HumMan__10_KONTUR_125_N2_162.cls",
        11,
        6,
        0,
        Some([650.000, -397.500, 413.000, 1378.000, -188.500, 964.000]),
    ),
    (
        "nx_HumMan__3_PAZ_125_N2.cls",
        640,
        300,
        0,
        Some([1398.849, -980.940, 408.000, 2173.000, 124.940, 481.000]),
    ),
    (
        "nx_HumMan__8_SVERL_63_N2.cls",
        6,
        0,
        0,
        Some([1287.500, -293.000, 231.000, 1287.500, -293.000, 483.000]),
    ),
    (
        "nx_HumMan_cutcom.clsf",
        566,
        140,
        0,
        Some([-14.312, -232.329, 0.000, 268.947, 25.462, 82.000]),
    ),
    (
        "nx_HumMan_deep_drill.clsf",
        2,
        0,
        0,
        Some([-255.000, 0.000, 240.000, 66.000, 0.000, 240.000]),
    ),
    (
        "nx_HumMan_nurbs.clsf",
        78,
        0,
        70,
        Some([-254.982, -9.213, 206.843, 65.993, 468.379, 272.676]),
    ),
    (
        "nx_HumMan_standart_drill.clsf",
        2,
        0,
        0,
        Some([-255.000, 0.000, 240.000, 66.000, 0.000, 240.000]),
    ),
    ("nx_HumMan_ust_a.cls", 546, 0, 0, Some([0.000, -69.511, -177.500, 803.215, 251.125, 8.593])),
    (
        "nx_HumMan_ust_a2.cls",
        20057,
        0,
        0,
        Some([0.000, -19.106, -177.500, 784.000, 253.984, 11.884]),
    ),
    ("own_ncl_form.as", 6, 0, 0, Some([4.000, 0.500, 1.194, 4.375, 0.589, 3.000])),
    ("swcam_aamorim_Interface-glue.clt", 2036, 30, 0, None),
    (
        "swcam_aamorim_Teste-Metrologia.apt",
        454,
        65,
        0,
        Some([-8.856, -17.500, -51.438, 250.000, 55.500, 25.000]),
    ),
    (
        "swcam_aamorim_basemach.apt",
        2090,
        369,
        0,
        Some([12.500, 12.500, -10.500, 335.500, 133.500, 25.000]),
    ),
];

#[test]
fn counts_and_extents_are_those_of_the_files() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for (name, points, arcs, splines, extents) in FIGURES {
        let text = fs::read(folder.join(name)).unwrap();
        let settings = ClSettings {
            file: name.to_owned(),
            allowed: vec!["DEEP".to_owned()],
            ..ClSettings::default()
        };
        let mut course = ClCourse::new(settings, Cursor::new(&text));
        let (mut ends, mut found_arcs, mut found_splines) = (0, 0, 0);
        let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut reach = |tip: Vector3<f64>| {
            for place in 0..3 {
                least[place] = least[place].min(tip[place]);
                most[place] = most[place].max(tip[place]);
            }
        };
        let mut drills = false;
        while let Some(item) = course.next().unwrap() {
            match item {
                CourseItem::Piece(CoursePiece { hole: false, curve, to, .. }) => {
                    found_arcs += u64::from(matches!(curve, Curve::Arc { .. }));
                    let spline = matches!(curve, Curve::Spline(_));
                    found_splines += u64::from(spline);
                    if !spline {
                        ends += 1;
                        reach(to.tip);
                    }
                }
                CourseItem::Reach(at) if !at.hole => {
                    ends += 1;
                    reach(at.to.tip);
                }
                CourseItem::Event { event: ProgramEvent::CycleEnd, .. } => {
                    ends += 1;
                    drills = true;
                }
                _ => {}
            }
        }
        assert_eq!([ends, found_arcs, found_splines], [points, arcs, splines], "{name}");
        let Some(wanted) = extents else { continue };
        // Of a hole the course has the levels above its point, and the bottom.
        for place in (0..3).filter(|_| !drills) {
            assert!((least[place] - wanted[place]).abs() < 6e-4, "{name} {least:?}");
            assert!((most[place] - wanted[3 + place]).abs() < 6e-4, "{name} {most:?}");
        }
    }
}

/// The CL file that is written from the course of another.
fn written_anew(text: &[u8], how: &How) -> String {
    let mut first = ClCourse::new(settings(how), Cursor::new(text));
    while first.next().map_or(true, |item| item.is_some()) {}
    let tools = first.tools().to_vec();
    let mut course = ClCourse::new(settings(how), Cursor::new(text));
    let mut writer = ClWriter::new(0.0005);
    let mut out = String::new();
    writer.begin("anew", &mut out);
    let mut tool = MountedTool::default();
    loop {
        match course.next() {
            Ok(Some(item)) => {
                if let CourseItem::Event {
                    event: ProgramEvent::ToolChange { number, .. }, ..
                } = &item
                {
                    let known = tools.iter().find(|known| Some(known.number) == *number);
                    tool = known.map_or(MountedTool::default(), |known| MountedTool {
                        register: Some(known.register),
                        length: known.length,
                    });
                }
                writer.item(&item, tool, &mut out).unwrap();
            }
            Ok(None) => break,
            Err(_) => {}
        }
    }
    writer.end(&mut out);
    out
}

#[test]
fn what_is_written_from_a_course_reads_back_as_it() {
    // One of the files goes in pecks and says none.
    let allowed = vec!["DEEP".to_owned()];
    let hows = [
        How { allowed: allowed.clone(), ..How::default() },
        How {
            units: Some(Units::Inch),
            apply_msys: true,
            tool: Some(7),
            turn: 0.3,
            feed: Some(321.0),
            allowed,
            ..How::default()
        },
    ];
    let mut differences = Vec::new();
    for path in files() {
        let text = fs::read(&path).unwrap();
        for (place, how) in hows.iter().enumerate() {
            let (theirs, _) = course(&text, how);
            let anew = written_anew(&text, how);
            let (ours, faults) = course(anew.as_bytes(), &How::default());
            assert_eq!(faults, Vec::<String>::new(), "{path:?}");
            let at_home =
                |beats: Vec<Beat>| -> Vec<Beat> { beats.into_iter().map(without_line).collect() };
            if let Some(difference) = difference(&at_home(ours), &at_home(theirs)) {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                differences.push(format!("{name} {place}: {difference}"));
            }
        }
    }
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

/// Lines are others in another file.
fn without_line(beat: Beat) -> Beat {
    match beat {
        Beat::To { rapid, feed, tip, axis, edge, .. } => {
            Beat::To { line: 0, rapid, feed, tip, axis, edge }
        }
        other => other,
    }
}

#[test]
fn a_curve_from_where_the_tool_was_only_said_to_stand_is_cut_from_its_start() {
    let folder = tempfile::tempdir().unwrap();
    let curves = [
        "CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0",
        "NURBS\nKNOT/1\nCNTRL/10,5,0\nCNTRL/5,10,0\nCNTRL/0,10,0",
    ];
    for curve in curves {
        let file = folder.path().join("from.cls");
        let text = format!(
            "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/100\nFROM/10,0,0\n{curve}\nRAPID\nGOTO/0,10,50\nFINI\n"
        );
        fs::write(&file, text).unwrap();
        let file = file.to_str().unwrap();
        for machine in ["vmc", "ac-trunnion"] {
            let arguments =
                ["-q", "-m", machine, "--tool-length", "50", "--verify", file, "-o", "-"];
            let run = crate::common::post(&arguments);
            assert_eq!(run.code, 0, "{machine} {curve}\n{}", run.err);
        }
    }
}
