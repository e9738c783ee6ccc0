//! Records of cycles, spindles, splines and work offsets.

use std::fmt::Write;

use super::number::{self, LENGTH};
use crate::BSpline;
use crate::{CycleCall, CycleKind, SpindleState};

/// The record of a cycle.
pub(super) fn definition(
    call: &CycleCall,
    depth: f64,
    clearance: f64,
    level: f64,
) -> Result<String, &'static str> {
    let kind = match call.kind {
        CycleKind::Drill => "DRILL",
        CycleKind::Deep => "DEEP",
        CycleKind::BreakChip => "BRKCHP",
        CycleKind::Tap | CycleKind::TapLeft => "TAP",
        CycleKind::Ream => "REAM",
        CycleKind::Bore => "BORE,DRAG",
        CycleKind::BoreFine => {
            return Err("fine boring: how far the tool goes off the wall is not known");
        }
        CycleKind::BoreBack => return Err("boring from behind has no cycle in a CL file"),
    };
    let mut out = format!("CYCLE/{kind},FEDTO,");
    number::write(&mut out, depth, LENGTH);
    let threads = matches!(call.kind, CycleKind::Tap | CycleKind::TapLeft);
    match (call.per_revolution, threads) {
        (true, true) => out.push_str(",PITCH,"),
        (true, false) => out.push_str(",MMPR,"),
        (false, _) => out.push_str(",MMPM,"),
    }
    let left = call.kind == CycleKind::TapLeft && call.per_revolution;
    number::write(&mut out, if left { -call.feed } else { call.feed }, LENGTH);
    out.push_str(",RAPTO,");
    number::write(&mut out, clearance, LENGTH);
    if level > clearance {
        out.push_str(",RTRCTO,");
        number::write(&mut out, level, LENGTH);
    }
    if call.peck > 0.0 {
        out.push_str(",STEP,");
        number::write(&mut out, call.peck, LENGTH);
        if call.later_peck > 0.0 && call.later_peck != call.peck {
            out.push(',');
            number::write(&mut out, call.later_peck, LENGTH);
        }
    }
    if call.dwell > 0.0 {
        out.push_str(",DWELL,");
        number::write(&mut out, call.dwell, LENGTH);
    }
    out.push('\n');
    Ok(out)
}

/// The record of a spindle.
pub(super) fn spindle_record(spindle: SpindleState, out: &mut String) {
    let side = |clockwise| if clockwise { "CLW" } else { "CCLW" };
    match spindle {
        SpindleState::Off => out.push_str("SPINDL/OFF\n"),
        SpindleState::Oriented => out.push_str("SPINDL/ORIENT\n"),
        SpindleState::Clockwise(rpm) | SpindleState::CounterClockwise(rpm) => {
            out.push_str("SPINDL/RPM,");
            number::write(out, rpm, LENGTH);
            let clockwise = matches!(spindle, SpindleState::Clockwise(_));
            let _ = writeln!(out, ",{}", side(clockwise));
        }
        SpindleState::Surface { speed, most, clockwise } => {
            out.push_str("SPINDL/SMM,");
            number::write(out, speed, LENGTH);
            if let Some(most) = most {
                out.push_str(",MAXRPM,");
                number::write(out, most, LENGTH);
            }
            let _ = writeln!(out, ",{}", side(clockwise));
        }
    }
}

/// NX's splines: cubic, clamped at both ends, all weights one, no knot more than twice.
pub(super) fn is_nurbs(way: &BSpline) -> bool {
    if way.degree != 3 || !way.is_sound() {
        return false;
    }
    let [first, last] = way.range();
    let clamped = way.knots[..4].iter().all(|knot| *knot == first)
        && way.knots[way.poles.len()..].iter().all(|knot| *knot == last);
    let inner = &way.knots[4..way.poles.len()];
    let rises = inner.windows(3).all(|three| three[0] < three[2])
        && inner.iter().all(|knot| first < *knot && *knot < last);
    clamped && rises && way.poles.iter().all(|(_, weight)| *weight == 1.0)
}

/// The number of a work offset: G54 is 1, G54.1 P1 is 7, a bare number itself.
pub(super) fn offset_number(name: &str) -> Option<u32> {
    if let Ok(number) = name.parse() {
        return Some(number);
    }
    let code = name.strip_prefix('G')?;
    if let Some((_, further)) = code.split_once('P') {
        return further.trim().parse::<u32>().ok().map(|number| number + 6);
    }
    match code.parse::<u32>().ok()? {
        code @ 54..=59 => Some(code - 53),
        _ => None,
    }
}
