//! G73 to G89: levels by words that stay in force, R and Z along the tool axis; of controls with instructions Z and I.

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Language, Meaning};

use super::super::spindle_request::SpindleRequest;
use super::hole::{CycleHole, HoleDwell, Pecking, Withdrawal};
use super::{drill, feed_a_minute};
use crate::g_code::GCode;
use crate::interpret::block_words::{BlockWords, bit};
use crate::interpret::go::MotionTarget;
use crate::interpret::state::{ControlState, ReturnTo};
use crate::{Curve, CycleKind, MotionKind};

/// Distance above the depth that was reached to which the tool comes at rapid, and by which it is drawn back to break a
/// chip, mm: LinuxCNC's ten thousandths of an inch; of other controls it is a parameter.
const BACK: f64 = 0.254;

/// mm in an inch, for threads an inch.
const INCH: f64 = 25.4;

/// Holes that one block may ask for.
const MOST: i64 = 100_000;

/// A cycle in force; lengths in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct IsoCycle {
    /// Its G code.
    code: GCode,
    meaning: Meaning,
    /// The level where it began.
    start: f64,
    /// R, as a level or a way from the start.
    clearance: f64,
    /// Z, as a level or a way from R.
    bottom: f64,
    /// Q.
    step: f64,
    /// P, seconds.
    dwell: f64,
    /// The pitch of a thread, where the dialect has a letter for it.
    pitch: Option<f64>,
}

/// A block that begins a cycle or says a further hole of it.
pub(super) fn hole(
    control: &mut ControlState,
    code: Option<GCode>,
    meaning: Option<Meaning>,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    let [first, second, axis] = control.modal.plane.coordinates();
    let letter = |row: usize| [b'X', b'Y', b'Z'][row];
    let before = words.present;
    let running = match control.lexicon.language() {
        Language::Instructions => named_levels(control, code, meaning, words)?,
        _ => levels_said(control, code, meaning, words)?,
    };
    // They were no places, and are none of a motion.
    let hidden = before & !words.present;
    let count = match (words.take(b'L'), words.take(b'K')) {
        (Some(count), _) | (None, Some(count)) => {
            crate::interpret::expression::whole(count, "a count of holes")
                .map_err(|finding| control.placed(*finding).boxed())?
        }
        (None, None) => 1,
    };
    if running.clearance.is_nan() || running.bottom.is_nan() {
        return Err(control.refuse("nc-cycle", "a cycle without its levels R and Z"));
    }
    control.cycles.iso = Some(running);
    if count > MOST {
        return Err(control.refuse(
            "nc-limit",
            format!("{count} holes by one block: no more than {MOST} are made"),
        ));
    }
    let own = hidden | words.present & bit(letter(axis));
    let positioned = words.present & control.axes.mask & !bit(letter(axis)) != 0;
    if !positioned && meaning.is_none() && own == 0 && words.present & bit(b'R') == 0 {
        return Ok(());
    }
    // Its own axis is no place.
    words.present &= !bit(letter(axis));
    if count == 0 && positioned {
        stays_there(control, words)?;
    }
    let incremental = control.modal.incremental;
    let made = (0..count).try_for_each(|turn| {
        let mut target =
            if turn == 0 || incremental { control.target(words)? } else { MotionTarget::default() };
        let hole = levels(control, &running)?;
        if control.lexicon.language() == Language::Rs274 {
            // Straight to R where the cycles began under it; else from under it on the way to the hole to the level of
            // return.
            if running.start < hole.clearance {
                to_level(control, axis, hole.clearance)?;
            } else if control.point()[axis] < hole.clearance {
                target.point[axis] = Some(hole.away);
            }
        }
        if target.point[first].is_some() || target.point[second].is_some() || target.said != 0 {
            control.go(MotionKind::Rapid, &Curve::Straight, &target)?;
        }
        make(control, &running, &hole)
    });
    words.present |= own;
    made
}

/// A cycle of no holes (K0, L0) that names the place where the tool stands.
fn stays_there(control: &mut ControlState, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
    let target = control.target(words)?;
    let here = control.point();
    let goes = (0..3)
        .any(|row| target.point[row].is_some_and(|to| libm::fabs(to - here[row]) > SAME_PLACE));
    if goes || target.said != 0 {
        let message = "a cycle of no holes (K0, L0) names a place: whether the tool goes there differs from control to control, and is not followed";
        return Err(control.refuse("nc-cycle", message));
    }
    Ok(())
}

/// [`levels_said`] of controls with instructions (Fagor): Z is where the feed begins and I the bottom, B a peck, of
/// which J are made ahead of each way out, K a wait in seconds, R1 a tap without a compensating chuck. These words are
/// taken out of the block.
fn named_levels(
    control: &mut ControlState,
    code: Option<GCode>,
    meaning: Option<Meaning>,
    words: &mut BlockWords,
) -> Result<IsoCycle, Box<Diagnostic>> {
    let axis = control.modal.plane.coordinates()[2];
    let letter = [b'X', b'Y', b'Z'][axis];
    let code = code.unwrap_or_default();
    if control.modal.incremental {
        return Err(control.refuse("nc-cycle", "a cycle under G91 is not run on this control"));
    }
    let mut running = begun(control, code, meaning, axis)?;
    let unit = control.modal.unit;
    if let Some(level) = words.take(letter) {
        running.clearance = level * unit;
    }
    match (words.take(b'I'), meaning) {
        // Of G83 it is the way of one peck, and J says how many there are.
        (Some(peck), Some(Meaning::CycleDeep)) if code == GCode::whole(83) => {
            running.step = libm::fabs(peck) * unit;
            let pecks = words.take(b'J').unwrap_or(1.0);
            running.bottom = running.clearance + peck * unit * pecks;
            let _ = words.take(b'B');
            words.present &= !(bit(b'J') | bit(b'B'));
        }
        (Some(level), _) => running.bottom = level * unit,
        (None, _) => {}
    }
    if let Some(time) = words.take(b'K') {
        running.dwell = time;
    }
    words.present &= !(bit(letter) | bit(b'I') | bit(b'K'));
    if running.meaning == Meaning::CycleDeep && meaning.is_some() && code != GCode::whole(83) {
        let (peck, pecks) = (words.take(b'B'), words.take(b'J'));
        // The first approach, the next ones, how far back, the least peck and the part of each: they change no bottom.
        for beside in [b'C', b'D', b'H', b'L', b'R'] {
            let _ = words.take(beside);
        }
        running.step = peck.unwrap_or_default() * unit;
        if pecks.is_some_and(|pecks| pecks != 1.0) {
            running.meaning = Meaning::CycleBreakChip;
        }
        words.present &= !(bit(b'B') | bit(b'J') | bit(b'C') | bit(b'D') | bit(b'H'));
        words.present &= !(bit(b'L') | bit(b'R'));
    }
    if running.meaning == Meaning::CycleTap && meaning.is_some() {
        control.modal.rigid_taps = words.take(b'R') == Some(1.0);
        words.present &= !bit(b'R');
    }
    Ok(running)
}

/// The cycle that a block begins, or the one in force.
fn begun(
    control: &ControlState,
    code: GCode,
    meaning: Option<Meaning>,
    axis: usize,
) -> Result<IsoCycle, Box<Diagnostic>> {
    let scaled = |place: usize| control.axes.scale[place] != 1.0;
    if control.axes.cartesian[axis].is_some_and(scaled) {
        let message = "a cycle along an axis whose word is no axis value ([word]) is not run";
        return Err(control.refuse("nc-cycle", message));
    }
    match (meaning, control.cycles.iso) {
        (Some(meaning), Some(before)) => Ok(IsoCycle { code, meaning, ..before }),
        (Some(meaning), None) => Ok(IsoCycle {
            code,
            meaning,
            start: control.point()[axis],
            clearance: f64::NAN,
            bottom: f64::NAN,
            step: 0.0,
            dwell: 0.0,
            pitch: None,
        }),
        (None, Some(before)) => Ok(before),
        (None, None) => Err(control.refuse("nc-cycle", "a further hole, and no cycle is in force")),
    }
}

/// The cycle in force, with the levels, pecks and wait that the words of a block say.
fn levels_said(
    control: &mut ControlState,
    code: Option<GCode>,
    meaning: Option<Meaning>,
    words: &mut BlockWords,
) -> Result<IsoCycle, Box<Diagnostic>> {
    let unit = control.modal.unit;
    let axis = control.modal.plane.coordinates()[2];
    let letter = [b'X', b'Y', b'Z'][axis];
    let code = code.unwrap_or_default();
    let levels = bit(letter) | bit(b'R');
    if words.pointless & levels != 0 {
        control.least_increments(words, levels)?;
    }
    let mut running = begun(control, code, meaning, axis)?;
    let incremental = control.modal.incremental;
    let refused = words.incremental & levels;
    if refused != 0 {
        return Err(
            control.refuse("nc-cycle", "a level of this cycle is incremental by a word of its own")
        );
    }
    if let Some(level) = words.take(b'R') {
        running.clearance = level * unit + if incremental { running.start } else { 0.0 };
    }
    if let Some(level) = words.take(letter) {
        let from = if incremental { running.clearance } else { 0.0 };
        running.bottom = level * unit + from;
    }
    if let Some(step) = words.take(b'Q') {
        running.step = step * least_increment(control, words, b'Q');
        let counts = control.modal.unit * step > running.step;
        let pecks = matches!(running.meaning, Meaning::CycleDeep | Meaning::CycleBreakChip);
        if pecks && counts && running.step < TINY_PECK {
            let message = format!(
                "Q{step} of {} counts in least increments: the hole is made in pecks of {:.4} mm",
                running.code, running.step
            );
            let help = "a point behind the number, or thousandths of a millimetre, if longer ones are meant";
            control.note(Diagnostic::warning("nc-peck", message).help(help));
        }
    }
    if let Some(time) = words.take(b'P') {
        let seconds =
            control.lexicon.language() == Language::Rs274 || words.pointed & bit(b'P') != 0;
        running.dwell = if seconds { time } else { time / 1000.0 };
    }
    running.pitch = thread_pitch(control, &running, words).or(running.pitch);
    Ok(running)
}

/// Pecks that are shorter, mm, are hardly meant.
const TINY_PECK: f64 = 0.05;

/// A place no farther away is where the tool stands, mm.
const SAME_PLACE: f64 = 1e-6;

/// The pitch of a thread, mm, by a letter that the dialect names beside the cycle: J threads an inch, any other mm.
fn thread_pitch(control: &ControlState, running: &IsoCycle, words: &mut BlockWords) -> Option<f64> {
    let named =
        |letter: &u8| control.lexicon.letter_beside(running.code, *letter) == Some(running.meaning);
    let letter = [b'I', b'J']
        .into_iter()
        .find(|letter| words.present & bit(*letter) != 0 && named(letter))?;
    let value = words.take(letter).filter(|value| *value > 0.0)?;
    Some(if letter == b'J' { INCH / value } else { value })
}

/// Makes one hole, with the tool over it. A rigid tap turns the spindle.
fn make(
    control: &mut ControlState,
    running: &IsoCycle,
    hole: &CycleHole,
) -> Result<(), Box<Diagnostic>> {
    let sense = match running.meaning {
        Meaning::CycleTap => SpindleRequest::Clockwise,
        Meaning::CycleTapLeft => SpindleRequest::CounterClockwise,
        _ => return drill(control, hole),
    };
    let by_code = matches!(running.code.parts(), (84, 2 | 3) | (274 | 284, 0));
    if !control.modal.rigid_taps && !by_code {
        let line = control.line;
        control.report.bare_taps.get_or_insert((line, 0)).1 += 1;
        return drill(control, hole);
    }
    // The cycle turns the spindle itself, whatever was said before.
    control.turn_spindle(sense);
    let made = drill(control, hole);
    control.modal.tapped = true;
    made
}

/// Straight up or down to a level.
fn to_level(control: &mut ControlState, axis: usize, level: f64) -> Result<(), Box<Diagnostic>> {
    let mut point: Vector3<f64> = control.point();
    point[axis] = level;
    control.straight(MotionKind::Rapid, point)
}

/// mm in a unit of a length without a point: the least increment, where the control counts so.
fn least_increment(control: &ControlState, words: &BlockWords, letter: u8) -> f64 {
    let unit = control.modal.unit;
    let counts = control.lexicon.counts_by_point() && words.pointed & bit(letter) == 0;
    match counts {
        true if unit == 1.0 => 0.001,
        true => 0.0001 * unit,
        false => unit,
    }
}

/// Refuses a hole that goes up, and a boring from below that goes down.
fn goes_its_way(control: &ControlState, running: &IsoCycle) -> Result<(), Box<Diagnostic>> {
    let up = running.bottom > running.clearance;
    let back = running.meaning == Meaning::CycleBoreBack;
    if up != back {
        let message = format!(
            "{} goes from the level {:.4} to {:.4}: {}",
            running.code,
            running.clearance,
            running.bottom,
            match back {
                true =>
                    "boring from below begins at the lower one, and another sense of this word is not known",
                false => "a hole goes down",
            }
        );
        return Err(control.refuse("nc-cycle", message));
    }
    Ok(())
}

/// The level to which the cycle returns.
fn away(control: &ControlState, running: &IsoCycle) -> Result<f64, Box<Diagnostic>> {
    match (control.modal.return_to, control.modal.return_level) {
        (ReturnTo::Clearance, _) => Ok(running.clearance),
        (ReturnTo::Start, _) if !control.lexicon.returns_to_levels() => {
            Ok(libm::fmax(running.start, running.clearance))
        }
        (ReturnTo::Level, Some(level)) if level >= running.clearance => Ok(level),
        (ReturnTo::Level, Some(level)) => Err(control.refuse(
            "nc-cycle",
            format!(
                "a cycle returns to the level {level:.4}, and its feed begins at {:.4} above it",
                running.clearance
            ),
        )),
        (ReturnTo::Start | ReturnTo::Level, _) => {
            Err(control
                .refuse("nc-cycle", "a cycle, and no word has said to which level it returns"))
        }
    }
}

/// The hole that the cycle makes.
fn levels(control: &mut ControlState, running: &IsoCycle) -> Result<CycleHole, Box<Diagnostic>> {
    use Meaning as M;
    goes_its_way(control, running)?;
    let by_pitch = running.pitch.map(|pitch| pitch * control.modal.speed);
    let feed = by_pitch.unwrap_or_else(|| feed_a_minute(control));
    let named = control.lexicon.language() == Language::Instructions;
    let away = away(control, running)?;
    let hole = CycleHole {
        clearance: running.clearance,
        bottom: running.bottom,
        away,
        feed,
        // G81 has no wait: a P beside it says nothing. Of Fagor's it is the cycle with a wait too.
        wait: HoleDwell::seconds(if running.code == GCode::whole(81) && !named {
            0.0
        } else {
            running.dwell
        }),
        // LinuxCNC feeds all the way out, but for G85.
        out_all: control.lexicon.language() == Language::Rs274 && running.code != GCode::whole(85),
        ..CycleHole::default()
    };
    let pecks = |out_after: u32| Pecking {
        first: running.step,
        least: running.step,
        out_after,
        back: BACK,
        ahead: BACK,
        ..Pecking::default()
    };
    let lifted =
        matches!(running.meaning, M::CycleBoreFine | M::CycleBoreBack) && running.step > 0.0;
    if lifted {
        let code = running.code;
        control.note(Diagnostic::warning(
            "nc-cycle",
            format!("{code} goes off the wall by Q in a direction that is a parameter of the control: this way aside is left out"),
        ));
    }
    let thread = |kind: CycleKind, hole: CycleHole| {
        if feed <= 0.0 {
            return Err(control.refuse("nc-cycle", "a thread without a feed"));
        }
        Ok(CycleHole { kind, out: Withdrawal::Thread(feed), ..hole })
    };
    Ok(match running.meaning {
        M::CycleDrill => hole,
        M::CycleDeep | M::CycleBreakChip if running.step <= 0.0 => {
            return Err(control.refuse("nc-cycle", "a cycle in pecks without Q"));
        }
        M::CycleDeep => CycleHole { kind: CycleKind::Deep, pecks: Some(pecks(1)), ..hole },
        M::CycleBreakChip => {
            CycleHole { kind: CycleKind::BreakChip, pecks: Some(pecks(0)), ..hole }
        }
        M::CycleTap => thread(CycleKind::Tap, hole)?,
        M::CycleTapLeft => thread(CycleKind::TapLeft, hole)?,
        M::CycleReam => CycleHole { kind: CycleKind::Ream, out: Withdrawal::Feed(feed), ..hole },
        M::CycleBore => CycleHole { kind: CycleKind::Bore, ..hole },
        // G88, and G87 of some: the operator draws it out.
        M::CycleOther => CycleHole { kind: CycleKind::Bore, stop: true, ..hole },
        M::CycleBoreFine => CycleHole { kind: CycleKind::BoreFine, ..hole },
        M::CycleBoreBack => CycleHole {
            kind: CycleKind::BoreBack,
            away: libm::fmax(running.start, running.bottom),
            ..hole
        },
        _ => {
            let code = running.code;
            return Err(control.refuse("nc-cycle", format!("{code} is no cycle that is made here")));
        }
    })
}
