//! Whatever a program says: no panic, no value that is not finite, no more than its count of blocks.

use std::borrow::Cow;
use std::fs;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use post_machine::description::Machine;
use post_plugin::{Capabilities, Language, Meaning, VocabularyWord};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::{BlockEffect, Offsets};
use post_testkit::{Rng, repository, rounds, seeded, shared};

use crate::interpret::machine;

/// Programs of others, a machine and a control for each.
pub const PROGRAMS: [(&str, &str, &str); 7] = [
    ("haas_umc750_dhanush_FinalToolPath.nc", "umc-750", "haas"),
    ("linuxcnc_boat-xyzac.ngc", "xyzac-trt", "linuxcnc"),
    ("linuxcnc_xyzac_switchkins_test_3.ngc", "xyzac-trt", "linuxcnc"),
    ("nxpost_dmc100_millplus_mm.ptp", "dmu50", "heidenhain"),
    ("nxpost_dmu70evo_840d_in.ptp", "nutating-head", "siemens"),
    ("nxpost_mori_nmv5000_out.txt", "bc-trunnion", "fanuc"),
    ("siemens_ElMoe_keychain.mpf", "bc-trunnion", "siemens"),
];

/// Blocks that a post seldom writes, put among those of a program.
const ODD: [&str; 40] = [
    "#1=1/0",
    "#1=#1+1",
    "GOTO 1",
    "M98 P1",
    "M99",
    "G68.2 X0 Y0 Z0 I0 J90. K0",
    "G53.1",
    "G69",
    "G43 H1",
    "G43.4 H1",
    "G49",
    "G91",
    "G2 X1. I1.",
    "G3 X1. Y1. R0.1",
    "G2 X0 Y0 Z5. R1e",
    "G93",
    "G1 F0",
    "G81 Z-5. R1. F1",
    "G83 Z-5. R1. Q1. F1",
    "G20",
    "G28 Z0",
    "G92 X0",
    "X1e308",
    "X999999999.",
    "TRAORI",
    "CYCLE800(1,\"\",0,57,0,0,0,0,90,0,0,0,0,-1)",
    "MCALL CYCLE81(5,0,1,-5)",
    "ROT Z45",
    "ATRANS X5",
    "A3=0 B3=0 C3=0",
    "R1=R1/0",
    "LOOP",
    "L X+1 R0 FMAX M91",
    "CC X+0 Y+0",
    "C X+1 Y+1 DR+",
    "CP IPA+99999 IZ-5 DR-",
    "PLANE SPATIAL SPA+0 SPB+90 SPC+0 TURN FMAX",
    "CALL LBL 1 REP 3",
    "CYCL DEF 200 X Q200=+2 Q201=-10 Q206=+100 Q202=+0 Q210=+0 Q203=+0 Q204=+5",
    "M128",
];

/// What a byte becomes.
const BYTES: &[u8] = b"0123456789.-+XYZABCGMFHIJKR=#[]()~;/QL %\"E";

/// The words of `tests/vocabularies`.
pub fn lexicon(dialect: &str) -> Lexicon {
    let path = repository().join(format!("tests/vocabularies/{dialect}.txt"));
    let text = fs::read_to_string(path).expect("the vocabulary is there");
    let mut words = Vec::new();
    for line in text.lines() {
        let mut columns = line.split("  ").map(str::trim).filter(|column| !column.is_empty());
        let (Some(word), Some(meaning), Some(_)) = (columns.next(), columns.next(), columns.next())
        else {
            continue;
        };
        let mut meanings = (0..1000).filter_map(Meaning::from_number);
        if let Some(meaning) = meanings.find(|known| known.name() == meaning) {
            let word = Cow::Owned(word.to_owned());
            words.push(VocabularyWord { word, meaning });
        }
    }
    assert!(words.len() > 50, "{dialect}");
    let (language, writes) = match dialect {
        "linuxcnc" | "grbl" => (Language::Rs274, Capabilities::NONE),
        "klipper" | "rrf" | "marlin" => (Language::Rs274, Capabilities::COMMAND_A_LINE),
        "siemens" => (Language::Names, Capabilities::TOOL_EDGES),
        "heidenhain" => (Language::Conversational, Capabilities::TOOL_TABLE),
        _ => (Language::Macro, Capabilities::NONE),
    };
    Lexicon::new(language, writes, &words)
}

/// Runs a text to its end.
fn run(machine: &Machine, lexicon: &Lexicon, text: &[u8]) {
    let limits = Limits { blocks: 3_000, depth: 8 };
    let offsets = Offsets { length: Some(100.0), ..Offsets::default() };
    let input = Cursor::new(text);
    let mut program = Interpreter::new(machine, lexicon, &offsets, limits, "p.nc", input)
        .expect("the machine is solved");
    let mut done = Vec::new();
    for _ in 0..2 * limits.blocks {
        done.clear();
        let more = program.next(&mut done);
        for each in &done {
            let BlockEffect::Motion(motion) = each else {
                continue;
            };
            let tip = motion.to.pose.tip;
            let finite = motion.to.joints.iter().chain(tip.iter()).all(|value| value.is_finite());
            assert!(finite, "line {}: {motion:?}", motion.line);
        }
        if matches!(more, Ok(false)) {
            return;
        }
    }
    panic!("the program does not end, though its count of blocks is passed");
}

/// Some lines of a program, with bytes changed, numbers made wild and odd blocks put in.
pub fn mutated(program: &[u8], random: &mut Rng) -> Vec<u8> {
    let lines: Vec<&[u8]> = program.split(|&byte| byte == b'\n').collect();
    let from = random.pick(lines.len());
    let mut text = Vec::new();
    for line in lines.iter().skip(from).take(60) {
        match random.pick(8) {
            0 => {
                let odd = ODD[random.pick(ODD.len())];
                text.extend(odd.as_bytes());
                text.push(b'\n');
                text.extend(*line);
            }
            1 if !line.is_empty() => {
                let mut line = line.to_vec();
                let at = random.pick(line.len());
                line[at] = BYTES[random.pick(BYTES.len())];
                text.extend(line);
            }
            2 => {}
            _ => text.extend(*line),
        }
        text.push(b'\n');
    }
    text
}

#[test]
fn no_mutation_of_a_real_program_brings_the_interpreter_down() {
    let Some(folder) = shared("data/nc") else {
        return;
    };
    for (file, machine_name, dialect) in PROGRAMS {
        let program = fs::read(folder.join(file)).unwrap();
        let machine = machine(machine_name);
        let lexicon = lexicon(dialect);
        for round in 0..rounds(60_u64) {
            let mut random = seeded(round);
            let text = mutated(&program, &mut random);
            let ran = catch_unwind(AssertUnwindSafe(|| run(&machine, &lexicon, &text)));
            assert!(ran.is_ok(), "{file}, round {round}:\n{}", String::from_utf8_lossy(&text));
        }
    }
}
