//! What blocks do together is what each of them does alone.

use std::fs;
use std::io::Cursor;

use post_machine::description::Machine;
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
    const MACHINES: [(&str, &[&str]); 6] = [
        ("ac-trunnion", &["X", "Y", "Z", "A", "C"]),
        ("bc-trunnion", &["X", "Y", "Z", "B", "C"]),
        ("head-head", &["X", "Y", "Z", "B", "C"]),
        ("nutating-head", &["X", "Y", "Z", "B", "C"]),
        ("umc-750", &["X", "Y", "Z", "B", "C"]),
        ("vmc", &["X", "Y", "Z"]),
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
