//! What a control carries out, from what a program did: where it stands still, and how long it waits.

use std::io::Cursor;

use post_machine::description::{Machine, Source, load};
use post_motion::{CornerMode, MovePace, Task, WaitReason};
use post_plugin::{Capabilities, Language, VocabularyWord};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::tasks::{ProgramTask, ProgramTasks};
use post_readback::{Interpolation, Offsets};
use post_testkit::repository;

use crate::interpret::LETTERS;

/// A machine of the library with a table of its own.
fn machine(motion: &str) -> Machine {
    let vmc = std::fs::read_to_string(repository().join("machines/vmc.toml")).unwrap();
    let source = |name: &str, text: String| Source { name: name.to_owned(), text };
    let own = format!("extends = \"vmc\"\n{motion}");
    load(source("own.toml", own), &[], &mut |_| Ok(source("vmc.toml", vmc.clone()))).unwrap()
}

/// The tasks of a program, and what was taken for granted.
fn tasks(machine: &Machine, program: &str) -> (Vec<ProgramTask>, Vec<String>) {
    let words: Vec<VocabularyWord> =
        LETTERS.iter().map(|(word, meaning)| VocabularyWord::new(word, *meaning)).collect();
    let mut interpreter = Interpreter::new(
        machine,
        &Lexicon::new(Language::Macro, Capabilities::NONE, &words),
        &Offsets::default(),
        Limits::default(),
        "part.nc",
        Cursor::new(program.as_bytes().to_vec()),
    )
    .unwrap();
    let mut tasks = ProgramTasks::new(machine);
    let (mut done, mut out) = (Vec::new(), Vec::new());
    while interpreter.next(&mut done).unwrap() {
        tasks.take(&mut done, &mut out);
        assert!(done.is_empty());
    }
    tasks.end(&mut out);
    let notes = tasks.notes().into_iter().map(|note| note.message);
    (out, notes.collect())
}

/// Line and corner of each move, or line and seconds of each wait.
fn outline(planned: &[ProgramTask]) -> Vec<(u64, Result<CornerMode, f64>)> {
    let each = planned.iter().map(|planned| match &planned.task {
        Task::Move(step) => (step.line, Ok(step.corner)),
        Task::Wait { line, seconds, .. } => (*line, Err(*seconds)),
    });
    each.collect()
}

const BLEND: Result<CornerMode, f64> = Ok(CornerMode::Blend { tolerance: None });
const STOP: Result<CornerMode, f64> = Ok(CornerMode::Stop);

#[test]
fn a_control_stands_still_where_it_waits_and_at_rapids() {
    let program = "G0 X0 Y0 Z-10.\nX10.\nG1 X20. F600.\nX30.\nM8\nX40.\nX50.\nG4 X0.5\nX60.\nG9 X70.\nX80.\n\
                   G0 X90.\nM0\nG1 X100.\nX110.\n";
    let (planned, notes) = tasks(&machine(""), program);
    assert_eq!(
        outline(&planned),
        [
            (1, STOP),
            (2, STOP),
            (3, BLEND),
            (4, BLEND),
            (5, Err(0.0)),
            (6, BLEND),
            (7, BLEND),
            (8, Err(0.5)),
            (9, BLEND),
            (10, STOP),
            // A rapid is next.
            (11, STOP),
            (12, STOP),
            (13, Err(0.0)),
            (14, BLEND),
            (15, BLEND),
        ]
    );
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].starts_with("line 13 of the program: the program stops"));
    let Task::Move(cut) = &planned[2].task else {
        panic!("a cut");
    };
    assert_eq!((cut.pace, &cut.way), (MovePace::Minutes(10.0 / 600.0), &Interpolation::Axes));
    assert_eq!((planned[2].feed, planned[2].rapid), (600.0, false));
    assert_eq!((planned[1].feed, planned[1].rapid), (0.0, true));
}

#[test]
fn the_machine_file_says_what_a_program_leaves_open() {
    let program =
        "T1 M6\nM3 S600\nG0 X0 Y0 Z-10.\nX10.\nG1 X20. F600.\nX30.\nG61 X40.\nG64 X50.\nX60.\n";
    let motion = "[motion]\ncorner = \"path\"\ncorner_tolerance = 0.01\nrapids = \"blend\"\ntool_change = 6\nspindle = 1.5";
    let (planned, notes) = tasks(&machine(motion), program);
    let path = Ok(CornerMode::Path);
    let within = Ok(CornerMode::Blend { tolerance: Some(0.01) });
    let outline = outline(&planned);
    assert_eq!(
        outline,
        [
            (1, Err(6.0)),
            (2, Err(1.5)),
            (3, path),
            (4, path),
            (5, path),
            (6, path),
            // Fanuc's G61.
            (7, STOP),
            (8, within),
            (9, within),
        ]
    );
    let waits: Vec<WaitReason> = planned
        .iter()
        .filter_map(|planned| match planned.task {
            Task::Wait { why, .. } => Some(why),
            Task::Move(_) => None,
        })
        .collect();
    assert_eq!(waits, [WaitReason::ToolChange, WaitReason::Spindle]);
    assert!(notes.is_empty(), "{notes:?}");
}
