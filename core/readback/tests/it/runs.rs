//! What blocks do together is what each of them does alone.

use std::fs;
use std::io::Cursor;

use post_machine::description::Machine;
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::{Course, CourseItem, CutRun};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::{BlockEffect, Offsets};
use post_testkit::{Rng, randomised, shared};

use crate::interpret::machine;
use crate::robust::{PROGRAMS, lexicon, mutated};

/// What each call of the interpreter tells, numbers to their last digit.
fn told(machine: &Machine, lexicon: &Lexicon, text: &[u8], longest: Option<usize>) -> Vec<String> {
    let limits = Limits { blocks: 500, depth: 8 };
    let offsets = Offsets { length: Some(100.0), ..Offsets::default() };
    let input = Cursor::new(text);
    let mut program = Interpreter::new(machine, lexicon, &offsets, limits, "p.nc", input)
        .expect("the machine is solved");
    if let Some(longest) = longest {
        program = program.with_longest_run(longest);
    }
    let mut told = Vec::new();
    let mut done = Vec::new();
    for _ in 0..5_000 {
        done.clear();
        let more = program.next(&mut done);
        let effects: Vec<String> = done.iter().map(effect).collect();
        let (line, state) = program.stand();
        told.push(format!("{more:?} {effects:?} {line} {:?}", state.spindle));
        if matches!(more, Ok(false)) {
            break;
        }
    }
    told.push(format!("{:?}", program.report()));
    told
}

fn effect(done: &BlockEffect) -> String {
    match done {
        BlockEffect::Motion(motion) => format!(
            "{} {:?} {:?} {:?} {:?} {:?} {} {} {:?} {} {:?}",
            motion.line,
            motion.number,
            motion.kind,
            motion.way,
            motion.from,
            motion.to,
            motion.feed,
            motion.minutes,
            [motion.stops, motion.hole, motion.machine, motion.fast],
            motion.state.length,
            motion.state.tool,
        ),
        BlockEffect::Event { line, event } => format!("{line} {event:?}"),
        BlockEffect::State(state) => format!("tcp {} length {}", state.tcp, state.length),
    }
}

fn assert_same(machine: &Machine, lexicon: &Lexicon, text: &[u8], rng: &mut Rng) {
    let plain = told(machine, lexicon, text, Some(0));
    for longest in [None, Some(2 + rng.pick(9))] {
        let together = told(machine, lexicon, text, longest);
        for (place, (one, other)) in plain.iter().zip(&together).enumerate() {
            let text = String::from_utf8_lossy(text);
            assert!(one == other, "{}: {place}, {longest:?}\n{one}\n{other}\n{text}", machine.name);
        }
        assert_eq!(plain.len(), together.len(), "{}", machine.name);
    }
}

/// Cuts of many forms, and what comes between them.
fn program(rng: &mut Rng, axes: &[&str]) -> String {
    const BETWEEN: [&str; 22] = [
        "G43.4 H1",
        "G49",
        "G91",
        "G90",
        "G93",
        "G94",
        "G0 Z50.",
        "G1 Z10. F200.",
        "(A REMARK)",
        "",
        "G2 X1. Y2. R50.",
        "M8",
        "F150.",
        "S500 M3",
        "G4 P1.",
        "G54",
        "#1=5",
        "X#1",
        "G81 Z-5. R1. F100.",
        "G80",
        "G1 X1 Y2",
        "G20",
    ];
    let end = *rng.choose(&["\n", "\r\n"]);
    let mut text = format!("G21 G90 G94{end}G0 X0. Y0. Z10.{end}G1 X1. Y1. Z1. F500.{end}");
    let (numbered, code) = (rng.pick(2) == 0, rng.pick(4));
    let decimals = 1 + rng.pick(4);
    let mut at = [0.0; 6];
    for block in 0..20 + rng.pick(200) {
        if rng.pick(25) == 0 {
            text += BETWEEN[rng.pick(BETWEEN.len())];
            text += end;
            continue;
        }
        if numbered {
            text += &format!("N{} ", 10 * block);
        }
        if code == 0 || rng.pick(40) == 0 {
            text += "G1 ";
        }
        for (place, axis) in axes.iter().enumerate() {
            let far = *rng.choose(&[0.0, 0.1, 0.1, 3.0]);
            at[place] += rng.range(-far, far);
            if rng.pick(5) > 0 {
                text += &format!("{axis}{:.decimals$} ", at[place]);
            }
        }
        if rng.pick(4) == 0 {
            let least = if rng.pick(30) == 0 { -1.0 } else { 1.0 };
            text += &format!("F{:.1}", rng.range(least, 900.0));
        }
        text += end;
    }
    text
}

#[test]
fn runs_do_what_their_blocks_do() {
    const MACHINES: [(&str, &[&str]); 8] = [
        ("ac-trunnion", &["X", "Y", "Z", "A", "C"]),
        ("bc-trunnion", &["X", "Y", "Z", "B", "C"]),
        ("head-head", &["X", "Y", "Z", "B", "C"]),
        ("nutating-head", &["X", "Y", "Z", "B", "C"]),
        ("umc-750", &["X", "Y", "Z", "B", "C"]),
        ("vmc", &["X", "Y", "Z"]),
        ("quill-mill", &["X", "Y", "Z", "W"]),
        ("boring-mill", &["X", "Y", "Z", "W", "B"]),
    ];
    let (rounds, mut rng) = randomised(40, 281);
    for _ in rounds {
        let (name, axes) = *rng.choose(&MACHINES);
        let dialect = *rng.choose(&["fanuc", "haas", "linuxcnc", "siemens"]);
        let text = program(&mut rng, axes);
        assert_same(&machine(name), &lexicon(dialect), text.as_bytes(), &mut rng);
    }
}

#[test]
fn runs_of_programs_of_others_do_what_their_blocks_do() {
    let Some(folder) = shared("data/nc") else {
        return;
    };
    let (rounds, mut rng) = randomised(20, 282);
    for (file, machine_name, dialect) in PROGRAMS {
        let program = fs::read(folder.join(file)).unwrap();
        let (machine, lexicon) = (machine(machine_name), lexicon(dialect));
        for _ in rounds.clone() {
            let text = mutated(&program, &mut rng);
            assert_same(&machine, &lexicon, &text, &mut rng);
        }
        let most = program.len().min(100_000);
        assert_same(&machine, &lexicon, &program[..most], &mut rng);
    }
}

/// What a CL file asks for, item by item, numbers to their last digit; with cuts as they are told together, or without.
fn asked(machine: &Machine, text: &[u8], together: bool, feed: Option<f64>) -> Vec<String> {
    let settings = ClSettings { feed, unknown_left_out: true, ..ClSettings::of(machine, "p.cls") };
    let mut course = ClCourse::new(settings, text);
    if !together {
        course = course.one_by_one();
    }
    let (mut asked, mut cuts) = (Vec::new(), CutRun::default());
    loop {
        if course.next_cuts(&mut cuts) {
            assert!(together && cuts.count() > 0);
            asked.extend((0..cuts.count()).map(|place| {
                let piece = CourseItem::Piece(cuts.piece(place));
                format!("{:?}", Ok::<_, ()>(Some(piece)))
            }));
            continue;
        }
        let item = course.next();
        asked.push(format!("{item:?}"));
        if matches!(item, Ok(None)) || asked.len() > 20_000 {
            return asked;
        }
    }
}

fn assert_asked_alike(machine: &Machine, text: &[u8], feed: Option<f64>) -> bool {
    let plain = asked(machine, text, false, feed);
    let told = asked(machine, text, true, feed);
    for (one, other) in plain.iter().zip(&told) {
        assert!(one == other, "{one}\n{other}\n{}", String::from_utf8_lossy(text));
    }
    assert_eq!(plain.len(), told.len());
    plain.len() > 100
}

/// Points of many forms, and words between them.
fn cl_file(rng: &mut Rng) -> String {
    const BETWEEN: [&str; 24] = [
        "RAPID",
        "FEDRAT/MMPM,500.0",
        "FEDRAT/0.2,MMPR",
        "FEDRAT/INVERSE,20.",
        "FEDRAT/RAPID",
        "SPINDL/1000,RPM,CLW",
        "LOAD/TOOL,3",
        "COOLNT/ON",
        "CIRCLE/0.0,0.0,0.0,0.0,0.0,1.0,5.0",
        "CYCLE/DRILL,RAPTO,1.0,FEDTO,-5.0,MMPM,100.0",
        "CYCLE/OFF",
        "ROTABL/BAXIS,30.0",
        "MULTAX/OFF",
        "MSYS/1.0,2.0,3.0,1.0,0.0,0.0,0.0,1.0,0.0",
        "UNITS/INCHES",
        "TLAXIS/0.0,0.6,0.8",
        "GOHOME",
        "DELAY/2.0",
        "GODLTA/0.0,0.0,1.0",
        "GOTO/1.0,2.0,3.0,0.0,0.0,0.0",
        "GOTO/1.0,2.0,99999999.0,0.0,0.0,1.0",
        "FROM/0.0,0.0,50.0",
        "MYSTERY/1,2,3",
        "INDIRV/1.0,0.0,0.0",
    ];
    let axis = rng.pick(2) == 0;
    let mut text = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/900,RPM,CLW\nFEDRAT/MMPM,300.0\n".to_owned();
    for _ in 0..20 + rng.pick(150) {
        if rng.pick(15) == 0 {
            text += BETWEEN[rng.pick(BETWEEN.len())];
        } else {
            let [x, y, z] = rng.point(40.0).into();
            text += &format!("GOTO/{x:.4},{y:.4},{z:.4}");
            if axis || rng.pick(30) == 0 {
                let [i, j, k] = rng.direction().into();
                text += &format!(",{i:.6},{j:.6},{k:.6}");
            }
        }
        text.push('\n');
    }
    text
}

#[test]
fn cuts_that_are_told_together_are_those_that_are_told_one_by_one() {
    let (rounds, mut rng) = randomised(200, 283);
    let mut turned = machine("ac-trunnion");
    turned.turn = 0.4;
    let machines = [machine("ac-trunnion"), turned];
    let mut long = 0;
    for round in rounds {
        let text = cl_file(&mut rng);
        let feed = (rng.pick(3) == 0).then_some(250.0);
        long += u32::from(assert_asked_alike(&machines[round % 2], text.as_bytes(), feed));
    }
    assert!(long > 0);
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for file in fs::read_dir(folder).unwrap() {
        let text = fs::read(file.unwrap().path()).unwrap();
        assert_asked_alike(&machines[0], &text[..text.len().min(200_000)], None);
    }
}
