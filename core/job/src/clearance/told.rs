//! What is said of two bodies that are not clear.

use post_clearance::proof::{Fault, MOST_PIECES, Verdict};
use post_machine::description::Machine;
use post_machine::diagnostic::Short;

use super::pair_row::PairRow;

/// A distance to keep that is no longer need not be said, mm: there is none.
const LEAST_SAID: f64 = 1e-3;

/// What helps where the first place is not clear. `by_cells`: of a stock that is known by its cells.
pub(super) fn help(row: &PairRow, fault: &Fault, by_cells: bool) -> &'static str {
    match fault.verdict {
        Verdict::Unfinished => {
            "rapid_axes = \"together\" under [clearance], if the control interpolates rapids; else a rapid in shorter pieces, or with the tool retracted before axes turn"
        }
        _ if row.is_cut() && fault.keep > LEAST_SAID => {
            "rapids near the stock lead straight on from a cut or to one, within 30°, or out along the tool axis; else a smaller `rapid` of this pair ([clearance] pairs), or a feed"
        }
        Verdict::Unproven if by_cells => {
            "another path or tool; a finer `resolution` of the stock tells what is near to a wall from it"
        }
        _ if row.is_cut() && !by_cells => {
            "another path or tool, or a stock that is drawn true to size; at rapid a cutter goes back along its cuts and out on the line on which it came; `cut = true` under [stock] takes from it what drawn cutters remove"
        }
        _ => {
            "another fixture, tool or path; what is only drawn too large is drawn again, a pair that may touch is left out by [clearance] ignore"
        }
    }
}

/// What is wrong with a pair of bodies: the first place, and the worst where that is on another line.
pub(super) fn told(machine: &Machine, row: &PairRow, fault: &Fault) -> String {
    let mut message = told_at(machine, row, fault);
    if row.faults > 1 {
        message.push_str(&format!("; not clear in {} motions", row.faults));
    }
    if let Some(worst) = row.worst.as_ref().filter(|worst| worst.line != fault.line) {
        let what = told_at(machine, row, worst);
        message.push_str(&format!(", the worst in line {}: {what}", worst.line));
    }
    message
}

/// What is wrong with a pair of bodies at a place.
fn told_at(machine: &Machine, row: &PairRow, fault: &Fault) -> String {
    let [one, other] = &row.names;
    let kept = match fault.keep > LEAST_SAID {
        true => format!(", and {} mm are to be kept", Short(fault.keep)),
        false => String::new(),
    };
    let mut message = match fault.verdict {
        Verdict::Hits => format!("{one} hits {other}"),
        Verdict::Near => format!(
            "{one} comes within {} mm of {other}; {} mm are to be kept",
            Short(fault.at_most),
            Short(fault.keep)
        ),
        Verdict::Unfinished => {
            format!(
                "that {one} stays clear of {other} is not proven: the work ran out after {MOST_PIECES} pieces of the way; where it was looked at it is clear"
            )
        }
        Verdict::Unproven if fault.at_most.is_finite() => {
            format!(
                "that {one} stays clear of {other} is not proven: where it was looked at last they are no more than {} mm apart",
                Short(fault.at_most)
            ) + &kept
        }
        Verdict::Unproven => format!(
            "that {one} stays clear of {other} is not proven: how the axes go on the way is not known"
        ),
    };
    if fault.verdict != Verdict::Unfinished {
        message.push_str(&format!(" at {}", machine.shown(&fault.joints)));
    }
    if fault.at_most.is_finite() && fault.verdict != Verdict::Unfinished {
        let [x, y, z] = fault.point.into();
        message.push_str(&format!(", on {one} at [{x:.3}, {y:.3}, {z:.3}]"));
    }
    message
}
