//! Controls with instructions: Fagor's cycles, machine coordinates, planes, D, work offsets by a number.

use post_plugin::{Language, Meaning as M};
use post_readback::{MotionKind, Offsets, ProgramEvent};

use super::{Ran, machine, ran_in};

/// Words as ISG and Fagor have them; D names a register.
const WORDS: &[(&str, M)] = &[
    (";", M::Remark),
    ("(", M::RemarkOpen),
    (")", M::RemarkClose),
    ("N", M::BlockNumber),
    ("I", M::CentreX),
    ("J", M::CentreY),
    ("K", M::CentreZ),
    ("R", M::Radius),
    ("F", M::Feed),
    ("T", M::Tool),
    ("S", M::SpindleSpeed),
    ("D", M::LengthRegister),
    ("G4 X", M::DwellSeconds),
    ("G4 K", M::DwellSeconds),
    ("G80", M::CycleOff),
    ("G81", M::CycleDrill),
    ("G82", M::CycleDeep),
    ("G83", M::CycleDeep),
    ("G98", M::ReturnStart),
    ("G99", M::ReturnClearance),
    ("#MCS", M::MachineCoordinates),
    ("#HSC ON", M::Smoothing),
    ("#HSC OFF", M::SmoothingOff),
];

fn lengths() -> Offsets {
    Offsets { lengths: vec![(1, 100.0), (7, 60.0)], ..Offsets::default() }
}

fn run(chain: &str, text: &str) -> Ran {
    ran_in(Language::Instructions, &machine(chain), WORDS, &lengths(), text)
}

/// Heights of the tip at the ends of the cuts.
fn bottoms(done: &Ran) -> Vec<f64> {
    let cuts = done.motions.iter().filter(|motion| motion.kind == MotionKind::Feed);
    cuts.map(|cut| (cut.to.pose.tip.z * 1e6).round() / 1e6).collect()
}

#[test]
fn cycles_have_z_where_the_feed_begins_and_i_at_the_bottom() {
    let start = "G90 G94\nG0 X0 Y0 Z20 F300\n";
    let done = run("vmc", &format!("{start}G99 G81 X10 Y5 Z2 I-8.5 K.5\nX20\nG80\nG0 Z20\n"));
    let done = done.whole();
    assert_eq!(bottoms(&done), [-8.5, -8.5]);
    let drawn = done.motions.iter().filter(|motion| motion.kind == MotionKind::Rapid);
    assert!(drawn.skip(1).all(|rapid| rapid.to.pose.tip.z >= 2.0 - 1e-9));
    // In pecks of 6, and of G83 three of 6, however deep that leads.
    let pecks = run("vmc", &format!("{start}G99 G82 X10 Y5 Z2 I-16 B6 J1\nG80\n")).whole();
    assert_eq!(bottoms(&pecks).last(), Some(&-16.0));
    assert_eq!(bottoms(&pecks).len(), 3, "{:?}", bottoms(&pecks));
    let constant = run("vmc", &format!("{start}G98 G83 X10 Y5 Z2 I-6 J3\nG80\n")).whole();
    assert_eq!(bottoms(&constant), [-4.0, -10.0, -16.0]);
    // Back to where the cycle began.
    assert!((constant.last().to.pose.tip.z - 20.0).abs() < 1e-9);
    let said = run("vmc", &format!("{start}G91\nG81 X10 Y5 Z2 I-8\n"));
    assert!(said.refused[0].message.contains("under G91"), "{:?}", said.refused);
}

#[test]
fn machine_coordinates_hold_for_a_block_or_between_two() {
    let start = "G90\nG54\nT1 D1\nG0 X10 Y20 Z50\n";
    let between = run("vmc", &format!("{start}#MCS ON\nG0 Z20\nX5\n#MCS OFF\nG0 Z10\n")).whole();
    let block = run("vmc", &format!("{start}#MCS G0 Z20\n#MCS X5\nG0 Z10\n")).whole();
    let axes =
        |done: &Ran| -> Vec<_> { done.motions.iter().map(|motion| motion.to.joints).collect() };
    assert_eq!(axes(&between), axes(&block));
    let machine: Vec<bool> = between.motions.iter().map(|motion| motion.machine).collect();
    assert_eq!(machine, [false, true, true, false]);
}

#[test]
fn d_alone_puts_a_length_in_force() {
    let tips = |d: &str| {
        let done = run("vmc", &format!("G90\nG54\nT1\nM6\n{d}G0 X0 Y0 Z50\n#MCS G0 Z0\n")).whole();
        done.last().state.length
    };
    assert_eq!([tips("D1\n"), tips("D7\n"), tips("D7\nD0\n"), tips("")], [100.0, 60.0, 0.0, 0.0]);
}

/// The same plane by the turns of both controls: about Z, the new Y and the new X; about X, the new Y and the new Z.
#[test]
fn planes_are_told_in_two_ways() {
    let start = "G90\nG54\nT1 D1\nG0 A-45. C-90.\n#RTCP ON\n";
    let tip = |plane: &str| {
        let done = run("ac-trunnion", &format!("{start}{plane}\nG0 X3 Y-4 Z50\n#CS OFF\n")).whole();
        done.last().to.pose.tip
    };
    let isg = tip("#CS ON [1, 2, 3, -45, 0, -90]");
    let kept = tip("#CS ON [2] [1, 2, 3, -45, 0, -90]");
    let fagor = tip("#CS ON [1] [MODE 1, 1, 2, 3, 0, 45, -90]");
    assert!((isg - fagor).norm() < 1e-9 && (isg - kept).norm() < 1e-9, "{isg} {fagor}");
    for form in ["#CS ON [1]", "#CS ON", "#CS ON [1] [MODE 2, 0, 0, 0, 1, 2, 3]"] {
        let said = run("ac-trunnion", &format!("{start}{form}\nG0 X3\n"));
        assert!(!said.refused.is_empty(), "{form}");
    }
}

#[test]
fn what_is_not_followed_is_refused() {
    for text in [
        "G93 G1 X5 F2\n",
        "G54 G159=9 X1\nG53 X0\n",
        "L 100\n",
        "L100\n",
        "#CALL [1]\n",
        "#TOOL ORI\n",
        "P1=5\n",
        "%L POCKET\n",
    ] {
        let said = run("vmc", &format!("G90\nG0 X0 Y0 Z50\n{text}"));
        assert!(!said.refused.is_empty(), "{text}");
    }
    let offsets = run("vmc", "%1000 (PART)\nG90\nG159=9\nG0 X0 Y0 Z50\nG4 X2.5\nG4 K1\n").whole();
    let told = |event: &ProgramEvent| offsets.told.iter().any(|told| told == event);
    assert!(told(&ProgramEvent::WorkOffset("G159=9".to_owned())), "{:?}", offsets.told);
    assert!(told(&ProgramEvent::Dwell { time: 2.5, revolutions: false }));
    assert!(told(&ProgramEvent::Dwell { time: 1.0, revolutions: false }));
    run("vmc", "G0 X0 Y0 Z50\n#HSC ON [CONTERROR 0.01]\nG1 X5 F100\n#HSC OFF\n").whole();
}
