use nalgebra::Vector3;
use post_posting::preview::FixedAxisFinder;
use post_posting::program::{Command, MoveFeed, ProgramStep, StraightMove};

/// The lines of the stretches, from steps that are written as letters: `r` a rapid, `c` a cut, capitals with the tool
/// axis along X, `|` where the tool leaves.
fn stretches(steps: &str) -> Vec<(u64, u64)> {
    let mut axes = FixedAxisFinder::default();
    for (line, letter) in (1..).zip(steps.chars()) {
        let motion = |axis, pace| StraightMove {
            tip: Vector3::zeros(),
            axis,
            edge: Vector3::zeros(),
            pace,
            chord: 0.0,
        };
        let feed = MoveFeed::PerMinute(100.0);
        axes.step(
            line,
            &match letter {
                'r' => ProgramStep::Move(motion(Vector3::z(), MoveFeed::Rapid)),
                'c' => ProgramStep::Move(motion(Vector3::z(), feed)),
                'R' => ProgramStep::Move(motion(Vector3::x(), MoveFeed::Rapid)),
                'C' => ProgramStep::Move(motion(Vector3::x(), feed)),
                _ => ProgramStep::Command(Command::Home),
            },
        );
    }
    let found = axes.finish();
    found.iter().map(|still| (still.first, still.last)).collect()
}

#[test]
fn a_cut_that_turns_the_axis_leaves_no_plane_in_its_operation() {
    for (steps, expected) in [
        ("rcc", vec![(1, 3)]),
        ("rcCc", vec![]),
        ("rcRC", vec![(1, 2), (3, 4)]),
        ("rcRCrc", vec![(1, 2), (3, 4), (5, 6)]),
        // Turned in the cut, and all of that operation with it; not the one before.
        ("rc|RCcR|RC", vec![(1, 2), (9, 10)]),
        // Nothing is cut on the way to the first side.
        ("rRC", vec![(2, 3)]),
        ("|r|", vec![]),
        // The first point of an operation turns nothing, whatever came before.
        ("rc|C", vec![(1, 2), (4, 4)]),
    ] {
        assert_eq!(stretches(steps), expected, "{steps}");
    }
}
