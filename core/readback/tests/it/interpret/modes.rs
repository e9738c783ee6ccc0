//! What is modal, what is refused, what is only counted, and how long it takes.

use post_machine::description::{Machine, TcpFeedLength};
use post_motion::CornerMode;
use post_plugin::Language;
use post_readback::{Corners, MotionKind, Offsets, ProgramEvent, SpindleState};

use super::{LETTERS, NAMES, Ran, letters, machine, ran, ran_in};

#[test]
fn units_and_ways_are_modal() {
    let machine = machine("vmc");
    let done =
        letters(&machine, "G21 G0 X0 Y0 Z0\nG20 G1 X1. F10.\nG91 X1. Y-.5\nG21 X2.\nG90 X2.\n")
            .whole();
    let ways: Vec<[f64; 2]> = done
        .motions
        .iter()
        .skip(1)
        .map(|motion| {
            let tip = motion.to.pose.tip;
            [tip.x, tip.y].map(|value| (value * 1e9).round() / 1e9)
        })
        .collect();
    assert_eq!(ways, [[25.4, 0.0], [50.8, -12.7], [52.8, -12.7], [2.0, -12.7]]);
    // F10 is ten inches a minute.
    assert!((done.motions[1].minutes - 0.1).abs() < 1e-12);
    assert!((done.motions[1].feed - 254.0).abs() < 1e-9);
}

#[test]
fn time_is_what_the_feed_word_says() {
    let machine = machine("ac-trunnion");
    let minutes = |text: &str| letters(&machine, text).whole().last().minutes;
    let start = "G0 X0 Y0 Z0 A0 C0\n";
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    close(minutes(&format!("{start}G1 X30. Y40. F100.\n")), 0.5);
    // Linear axes alone count where one of them moves, rotary ones by their degrees where none does.
    close(minutes(&format!("{start}G1 X30. Y40. C90. F100.\n")), 0.5);
    close(minutes(&format!("{start}G1 C90. F100.\n")), 0.9);
    close(minutes(&format!("{start}G93 G1 X30. C90. F4.\n")), 0.25);
    close(minutes(&format!("{start}S1000 M3\nG95 G1 X30. F.1\n")), 0.3);
    // An arc by its length.
    close(
        minutes(&format!("{start}G1 F100.\nG3 X20. Y0 I10. J0\n")),
        10.0 * std::f64::consts::PI / 100.0,
    );
    // A rapid by its slowest axis.
    let max_feed = machine.axes.iter().find(|axis| axis.name == "C").unwrap().max_feed;
    close(minutes(&format!("{start}G0 C90.\n")), 90f64.to_radians() / max_feed);
    // Without F nothing is said.
    close(minutes(&format!("{start}G1 X30.\n")), 0.0);
}

#[test]
fn what_may_move_the_machine_is_refused_by_its_line() {
    let machine = machine("ac-trunnion");
    for (text, told) in [
        ("G0 X0 Y0 Z0\nG777 X5.\n", "G777"),
        ("G0 X0 Y0 Z0\nB5.\n", "B is no axis"),
        ("G0 X0 Y0 Z0\nG1 X5. I3. F100.\n", "I says nothing"),
        ("G0 X0 Y0 Z0\nG2 X5. F100.\n", "neither a centre nor a radius"),
        ("G0 X0 Y0 Z0\nG2 X5. I9. F100.\n", "from its centre"),
        ("G0 X0 Y0 Z0\nG2 X50. R5. F100.\n", "does not reach"),
        ("G0 X0 Y0 Z0\nG91 G53 Z5.\n", "machine coordinates are positions"),
        ("G0 X0 Y0 Z0\nG51 X5.\n", "G51"),
        ("G0 X0 Y0 Z0\nG31 Z-5. F100.\n", "G31"),
        ("G0 X0 Y0 Z0\nX5. X6.\n", "X stands twice"),
        ("G0 X0 Y0 Z0\nG43.44\n", "there is no G43.44"),
        ("( nothing )\nX5.\n", "how they move"),
    ] {
        let done = letters(&machine, text);
        assert_eq!(done.refused.len(), 1, "{text}: {:#?}", done.refused);
        let fault = &done.refused[0];
        assert!(fault.message.contains(told), "{text}: {}", fault.message);
        assert_eq!(fault.place.as_ref().unwrap().line, 2, "{text}");
    }
}

#[test]
fn reading_goes_on_behind_a_refused_block() {
    let machine = machine("ac-trunnion");
    let done = letters(&machine, "G0 X0 Y0 Z0\nG777\nG888\nX5.\n");
    assert_eq!(done.refused.len(), 2);
    assert!((done.last().to.pose.tip.x - 5.0).abs() < 1e-9);
}

#[test]
fn what_moves_nothing_is_counted_by_name() {
    let machine = machine("ac-trunnion");
    let done = letters(&machine, "M57\nG0 X0 Y0 Z0 Q5\nM57\nX1. M123\n").whole();
    let mut words: Vec<(&str, u64, u64)> = done
        .report
        .unknown
        .iter()
        .map(|(word, times, line)| (word.as_str(), *times, *line))
        .collect();
    words.sort_unstable();
    assert_eq!(words, [("M123", 1, 4), ("M57", 2, 1), ("Q", 1, 2)]);
}

#[test]
fn a_length_that_matters_must_be_known() {
    let [head, table] =
        ["head-head", "ac-trunnion"].map(|name| Machine { tools: Vec::new(), ..machine(name) });
    let text = "T7 M6\nG43 H7\nG0 X0 Y0 Z100.\n";
    let done = letters(&head, text);
    assert_eq!(done.refused.len(), 1, "{:#?}", done.refused);
    assert!(done.refused[0].message.contains("H7"));
    // On a table nothing of the tip hangs on it.
    let done = letters(&table, text).whole();
    assert!(done.report.notes.iter().any(|note| note.message.contains("H7")));
    assert!((done.last().to.pose.tip.z - 100.0).abs() < 1e-9);
    // By register, then by the tool of that number.
    let offsets =
        Offsets { lengths: vec![(7, 50.0)], tools: vec![(7, 60.0)], ..Offsets::default() };
    let done = ran(&head, LETTERS, &offsets, text).whole();
    assert_eq!(done.last().state.length, 50.0);
    assert_eq!((done.last().state.tool, done.last().state.length_register), (Some(7), Some(7)));
    let done =
        ran_in(Language::Names, &head, NAMES, &offsets, "T7\nM6\nD1\nG0 X0 Y0 Z100\n").whole();
    assert_eq!(done.last().state.length, 60.0);
    let done =
        ran_in(Language::Names, &head, NAMES, &offsets, "T7\nM6\nD1\nG0 X0 Y0 Z100\nSUPA D0 Z0\n")
            .whole();
    assert_eq!(done.last().state.length, 0.0);
}

#[test]
fn what_happens_besides_motion_is_told_in_order() {
    let machine = machine("vmc");
    let text = "T1 M6\n(OPERATION: ROUGH)\nS3000 M3\nM8\nT2\nG54\nG0 X0 Y0 Z50.\nG41 D1 X5.\nG1 Z0 F100. M9\nG4 P500\nG4 X1.5\nG40 X0 M5\nM1\nM30\nX99.\n";
    let done = letters(&machine, text).whole();
    let coolants = |flood| post_readback::Coolants { flood, ..Default::default() };
    assert_eq!(
        done.told,
        [
            ProgramEvent::ToolChange { number: Some(1), name: None },
            ProgramEvent::Operation("ROUGH".to_owned()),
            ProgramEvent::Spindle(SpindleState::Clockwise(3000.0)),
            ProgramEvent::Coolant(coolants(true)),
            ProgramEvent::Preselect(2),
            ProgramEvent::WorkOffset("G54".to_owned()),
            ProgramEvent::Compensation { side: -1, register: Some(1) },
            ProgramEvent::Coolant(coolants(false)),
            ProgramEvent::Dwell { time: 0.5, revolutions: false },
            ProgramEvent::Dwell { time: 1.5, revolutions: false },
            ProgramEvent::Compensation { side: 0, register: None },
            ProgramEvent::Spindle(SpindleState::Off),
            ProgramEvent::OptionalStop,
            ProgramEvent::End,
        ]
    );
    // What ends spindle or coolant does so behind the motion of its block.
    let down = done.motions.iter().find(|motion| motion.kind == MotionKind::Feed).unwrap();
    assert!(down.state.coolants.flood);
    assert_eq!(done.last().state.spindle, SpindleState::Clockwise(3000.0));
    // Nothing behind the end is run.
    assert!(done.last().to.pose.tip.x.abs() < 1e-9);
}

#[test]
fn words_beside_a_code_say_what_it_does() {
    let machine = machine("vmc");
    let done = letters(&machine, "G0 X0 Y0 Z0\nG187 P3 E0.02\nX1.\nG187\nX2.\n").whole();
    let smoothing: Vec<Option<f64>> =
        done.motions.iter().map(|motion| motion.state.smoothing).collect();
    assert_eq!(smoothing, [None, Some(0.02), None]);
    assert!(done.report.unknown.is_empty(), "{:?}", done.report.unknown);
}

/// What holds at the end of each motion, and whether the motion says so itself.
fn corners(done: &Ran) -> Vec<(Corners, bool)> {
    let motions = done.motions.iter();
    motions.map(|motion| (motion.state.corners, motion.stops)).collect()
}

#[test]
fn words_say_how_corners_are_passed() {
    let said = |corner: CornerMode| (Corners::Said(corner), false);
    let blend = |tolerance: Option<f64>| said(CornerMode::Blend { tolerance });
    let unsaid = (Corners::Unsaid, false);
    let machine = machine("vmc");
    // Fanuc's G61 is an exact stop, and G9 one for its block.
    let program = "G1 F500. X1.\nG61 X2.\nG64 X3.\nG9 X4.\nX5.\nG187 P3 E0.02\nX6.\nG187\nX7.\n";
    let once = (blend(None).0, true);
    assert_eq!(
        corners(&letters(&machine, program).whole()),
        [unsaid, said(CornerMode::Stop), blend(None), once, blend(None), blend(Some(0.02)), unsaid]
    );
    // An inch program states its tolerance in inches.
    let inch = letters(&machine, "G20 G1 F50. X1.\nG187 P3 E0.001\nX2.\n").whole();
    assert_eq!(corners(&inch)[1], blend(Some(0.0254)));
    // Siemens: G60, G64, and the compressor with and without its tolerance.
    let program = "G1 F500 X1\nG60 X2\nG64 X3\nG642 X4\nCTOL=0.03\nX5\nG64 X6\nG9 X7\n";
    assert_eq!(
        corners(&ran_in(Language::Names, &machine, NAMES, &Offsets::default(), program).whole()),
        [
            unsaid,
            said(CornerMode::Stop),
            blend(None),
            (Corners::Own, false),
            blend(Some(0.03)),
            blend(None),
            once
        ]
    );
    // G641 rounds within ADIS, and as G64 does where that is not said; CTOL is nothing to it, and G64 leaves a compressor on.
    let program =
        "G1 F500 X1 G641\nADIS=0.5 CTOL=0.1\nX2\nCOMPCAD X3\nG64 X4\nCOMPOF X5\nG644 X6\n";
    assert_eq!(
        corners(&ran_in(Language::Names, &machine, NAMES, &Offsets::default(), program).whole()),
        [
            blend(None),
            said(CornerMode::Within { distance: 0.5 }),
            blend(Some(0.1)),
            blend(Some(0.1)),
            blend(None),
            (Corners::Own, false),
        ]
    );
}

#[test]
fn reference_positions_are_approached_by_way_of_the_point() {
    let machine = machine("ac-trunnion");
    let z = machine.axes.iter().position(|axis| axis.name == "Z").unwrap();
    let done = letters(&machine, "G0 X0 Y0 Z10.\nG91 G28 Z5.\nG90\n").whole();
    let ends: Vec<f64> = done.motions.iter().map(|motion| motion.to.joints[z]).collect();
    assert!((ends[1] - ends[0] - 5.0).abs() < 1e-9);
    assert!((machine.axes[z].reading(ends[2])).abs() < 1e-9);
    assert!(done.motions[2].machine);
    assert!(done.report.notes.iter().any(|note| note.message.contains("reference positions")));
}

/// LinuxCNC's `@` and `^` are distance and angle about the origin of X and Y; what is not said stays.
#[test]
fn polar_words_lead_about_the_origin() {
    let machine = machine("vmc");
    let program = "G21 G90 G94 G1 F500 Z0\n@10 ^90\n^[45*4]\n@5\nG20 @1 ^0\n";
    let done = ran_in(Language::Rs274, &machine, NAMES, &Offsets::default(), program).whole();
    let ends: Vec<[f64; 2]> =
        done.motions.iter().map(|motion| [motion.to.pose.tip.x, motion.to.pose.tip.y]).collect();
    let due = [[0.0, 10.0], [-10.0, 0.0], [-5.0, 0.0], [25.4, 0.0]];
    let last = &ends[ends.len() - due.len()..];
    for (end, due) in last.iter().zip(due) {
        assert!(libm::hypot(end[0] - due[0], end[1] - due[1]) < 1e-9, "{ends:?}");
    }
    // Fanuc has no such words, and beside X they say two things.
    assert_eq!(letters(&machine, "G0 X0 Y0\nG1 @5 ^0 F100.\n").refused.len(), 1);
    let both = ran_in(Language::Rs274, &machine, NAMES, &Offsets::default(), "G1 F1 X1 @5\n");
    assert_eq!(both.refused.len(), 1);
}

#[test]
fn the_axes_of_other_machines_are_not_passed_over() {
    let machine = machine("vmc");
    let done = letters(&machine, "G0 X0 A5.\n");
    assert_eq!(done.refused.len(), 1);
    assert!(done.refused[0].message.contains("A is no axis"));
}

/// Where the control keeps the tip F counts its way; turns beside it where the machine file says so, in radians by a circle
/// of 2 mm (eqs. 4 and 5 of the prediction paper, Zhang, Chen 2025), and alone, in degrees, where the tip stands.
#[test]
fn the_length_that_a_control_counts_while_it_keeps_the_tip() {
    let mut machine = machine("ac-trunnion");
    let start = "G43.4 H1\nG1 X0 Y0 Z50. A-10. C0 F1000.\n";
    let close = |machine: &Machine, text: &str, wanted: f64| {
        let table = Offsets { lengths: vec![(1, 100.0)], ..Offsets::default() };
        let done = ran(machine, LETTERS, &table, &format!("{start}{text}")).whole();
        let minutes = done.last().minutes;
        assert!((minutes - wanted).abs() < 1e-9, "{text} {minutes} {wanted}");
    };
    close(&machine, "X30. Y40. A-20. C30. F100.\n", 0.5);
    // As LinuxCNC has it, by its own recording.
    close(&machine, "A-13. C4. F100.\n", 0.05);
    machine.control.tcp_feed_length = TcpFeedLength::Combined;
    for axis in &mut machine.axes {
        axis.feed_diameter = axis.joint.rotary.then_some(2.0);
    }
    let [a, c] = [10f64, 30.0].map(f64::to_radians);
    let counted = (0.3f64 * 0.3 + 0.4 * 0.4 + a * a + c * c).sqrt();
    close(&machine, "X.3 Y.4 A-20. C30. F100.\n", counted / 100.0);
    close(&machine, "C30. F100.\n", c / 100.0);
}
