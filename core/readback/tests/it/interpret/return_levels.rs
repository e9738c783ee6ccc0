//! Cycles that return to a level of their own: G71 and M53 of Okuma.

use post_plugin::{Language, Meaning as M};
use post_readback::{MotionKind, Offsets};

use super::{LETTERS, Ran, machine, ran_in};

const WORDS: &[(&str, M)] = &[
    ("G71", M::ReturnLevel),
    ("M52", M::Retract),
    ("M53", M::ReturnLevel),
    ("M54", M::ReturnClearance),
    ("NCYL", M::CycleOther),
];

fn run(cycle: &str) -> Ran {
    let words: Vec<(&str, M)> = [LETTERS, WORDS].concat();
    let text = format!("G90 G94\nG0 X0 Y0 Z30. F300\n{cycle}\nX20.\nG0 Z30.\n");
    ran_in(Language::Macro, &machine("vmc"), &words, &Offsets::default(), &text)
}

/// Heights at which the tool goes from the first hole to the second.
fn across(done: &Ran) -> Vec<f64> {
    let rapids = done.motions.iter().filter(|motion| motion.kind == MotionKind::Rapid);
    let over = rapids.filter(|motion| (motion.to.pose.tip.x - 20.0).abs() < 1e-9);
    over.map(|motion| (motion.to.pose.tip.z * 1e6).round() / 1e6).take(1).collect()
}

#[test]
fn the_level_of_g71_holds_from_m53_on_and_moves_nothing() {
    let done = run("G71 Z12.\nG81 X10. Y5. Z-8. R2. M53").whole();
    assert_eq!(across(&done), [12.0]);
    // To where the feed begins, whatever level was named.
    assert_eq!(across(&run("G71 Z12.\nG81 X10. Y5. Z-8. R2. M54").whole()), [2.0]);
    let heights = done.motions.iter().map(|motion| motion.to.pose.tip.z);
    assert_eq!(heights.fold(f64::INFINITY, f64::min), -8.0);
}

#[test]
fn a_cycle_that_does_not_say_where_it_returns_to_is_refused() {
    for cycle in [
        "G81 X10. Y5. Z-8. R2.",
        "G81 X10. Y5. Z-8. R2. M53",
        "G71 Z1.\nG81 X10. Y5. Z-8. R2. M53",
        "G71\nG81 X10. Y5. Z-8. R2. M53",
        "G71 Z12.\nG81 X10. Y5. Z-8. R2. M52",
        "G71 Z12.\nG81 X10. Y5. Z-8. R2. M53\nNCYL X15.",
    ] {
        let done = run(cycle);
        assert!(!done.refused.is_empty(), "{cycle}");
    }
}
