//! What a `CYCLE` of a CL file does at a point.

use post_grammar::{Argument, CycleDefinition};

use crate::{CycleCall, CycleKind};

/// A cycle, lengths in mm along the tool axis, heights counted from the programmed point, plus is off the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ClHole {
    pub(super) kind: CycleKind,
    /// Where the feed begins.
    pub(super) clearance: f64,
    /// How far below the point the hole ends, not below zero.
    pub(super) depth: f64,
    /// Where the tool stands between holes.
    pub(super) level: f64,
    pub(super) peck: f64,
    /// Of those behind the first.
    pub(super) later_peck: f64,
    /// At the bottom, s.
    pub(super) dwell: f64,
    /// At the bottom, turns of the spindle (`DWELL,REV,2`).
    pub(super) dwell_turns: f64,
    /// A thread's way a turn, mm, if its words say it; negative for a left-hand thread.
    pub(super) pitch: Option<f64>,
    /// Of Autodesk: its points are bottoms, and these heights along Z those of the level and of the clearance, mm.
    pub(super) planes: Option<[f64; 2]>,
}

/// A dwell in a hole lasts no longer: a day, s.
const LONGEST_DWELL: f64 = 86_400.0;

impl ClHole {
    /// Of a definition whose lengths are in units of `scale` mm.
    ///
    /// # Errors
    /// What it does not say or says wrongly, as a sentence.
    pub(super) fn new(cycle: &CycleDefinition, scale: f64) -> Result<Self, String> {
        let clearance =
            cycle.clearance.ok_or("the cycle does not say where its feed begins (RAPTO, CLEAR)")?
                * scale;
        if clearance < 0.0 {
            return Err(format!("the feed of the cycle begins {} mm below the point", -clearance));
        }
        let dwell = cycle.dwell.unwrap_or(0.0);
        if !(0.0..=LONGEST_DWELL).contains(&dwell) {
            return Err(format!("the cycle dwells for {dwell} s"));
        }
        let level = cycle.retract.map_or(clearance, |level| level * scale);
        let peck = libm::fabs(cycle.step.unwrap_or(0.0)) * scale;
        let kind = match kind(cycle)? {
            CycleKind::Drill | CycleKind::Deep if peck > 0.0 => CycleKind::Deep,
            CycleKind::Deep | CycleKind::BreakChip if peck == 0.0 => CycleKind::Drill,
            kind => kind,
        };
        let pitch = match (cycle.pitch, cycle.turns_per_inch) {
            (Some(pitch), _) => Some(pitch * scale),
            (None, Some(turns)) if turns != 0.0 => Some(25.4 / turns),
            _ => None,
        };
        Ok(Self {
            kind,
            clearance,
            depth: depth(cycle)? * scale,
            level: level.max(clearance),
            peck,
            later_peck: match cycle.later_step {
                Some(later) if later != 0.0 => libm::fabs(later) * scale,
                _ => peck,
            },
            dwell,
            dwell_turns: turns(cycle),
            pitch,
            planes: None,
        })
    }

    /// The kind of a cycle that goes in pecks and says none.
    pub(super) fn without_pecks(cycle: &CycleDefinition) -> Option<&str> {
        let pecked = |kind: &&String| {
            matches!(kind.as_str(), "DEEP" | "DEEP2" | "DEEPHL" | "BRKCHP" | "CHIP")
        };
        let kind = cycle.kinds.iter().find(pecked)?;
        cycle.step.is_none_or(|step| step == 0.0).then_some(kind.as_str())
    }

    /// It cuts a thread.
    pub(super) fn taps(&self) -> bool {
        matches!(self.kind, CycleKind::Tap | CycleKind::TapLeft)
    }

    /// It comes out at feed.
    pub(super) fn out_at_feed(&self) -> bool {
        self.taps() || self.kind == CycleKind::Ream
    }

    /// As it is told; `feed` in mm/min.
    pub(super) fn call(&self, feed: f64) -> CycleCall {
        CycleCall {
            kind: self.kind,
            depth: self.clearance + self.depth,
            clearance: self.clearance,
            peck: self.peck,
            later_peck: self.later_peck,
            dwell: self.dwell,
            feed: self.pitch.filter(|_| self.taps()).map_or(feed, libm::fabs),
            per_revolution: self.taps() && self.pitch.is_some(),
        }
    }
}

/// How deep below the point, in the file's units.
fn depth(cycle: &CycleDefinition) -> Result<f64, String> {
    let through = libm::fabs(cycle.break_through.unwrap_or(0.0));
    if let Some(depth) = cycle.depth {
        return Ok(libm::fabs(depth) + through);
    }
    let sinks = cycle.kinds.iter().any(|kind| kind == "CSINK");
    match (cycle.diameter.filter(|_| sinks), cycle.angle) {
        (Some(diameter), Some(angle)) if (1.0..179.0).contains(&angle) => {
            let slope = libm::tan(angle.to_radians() / 2.0);
            Ok(libm::fabs(diameter) / (2.0 * slope) + through)
        }
        (Some(_), _) => {
            Err("the diameter of a countersink says how deep only with the cutter's angle"
                .to_owned())
        }
        (None, _) => Err("the cycle does not say how deep".to_owned()),
    }
}

/// What its words name. Of several the one that says most holds: `DRILL,DEEP` is deep.
fn kind(cycle: &CycleDefinition) -> Result<CycleKind, String> {
    let mut found = CycleKind::Drill;
    let mut rank = 0;
    let mut bores = false;
    for word in &cycle.kinds {
        bores |= word == "BORE";
        let (place, kind) = match word.as_str() {
            "DRILL" | "FACE" | "CSINK" | "CBORE" | "CDRILL" | "SPOT" | "THRU" => {
                (0, CycleKind::Drill)
            }
            "DEEP" | "DEEP2" | "DEEPHL" | "PECKING" => (1, CycleKind::Deep),
            "BRKCHP" | "CHIP" => (2, CycleKind::BreakChip),
            "TAP" | "RTAP" | "TAPPING" | "THREAD" => (3, CycleKind::Tap),
            // Of NX and Creo BORE goes out at feed, the spindle turning, as reaming does.
            "REAM" | "BORE" => (4, CycleKind::Ream),
            "DRAG" => (5, CycleKind::Bore),
            "NODRAG" | "ORIENT" => (6, CycleKind::BoreFine),
            other => return Err(format!("CYCLE/{other} is not a cycle that is known")),
        };
        if place >= rank {
            (rank, found) = (place, kind);
        }
    }
    if matches!(found, CycleKind::Bore | CycleKind::BoreFine) && !bores {
        return Err("DRAG, NODRAG and ORIENT belong to CYCLE/BORE".to_owned());
    }
    Ok(found)
}

/// The turns of `DWELL,REV,2`.
fn turns(cycle: &CycleDefinition) -> f64 {
    let said = cycle.rest.windows(3).find_map(|three| match three {
        [Argument::Word(dwell), Argument::Word(turns), Argument::Number(count)]
            if dwell == "DWELL" && turns == "REV" =>
        {
            Some(*count)
        }
        _ => None,
    });
    said.unwrap_or(0.0)
}
