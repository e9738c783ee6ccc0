//! Cycles: what is done at a hole, as the control's own cycle and as moves that do the same (approach, peck, dwell,
//! retract, along the tool axis).

use nalgebra::Vector3;
use post_grammar::{Argument, CycleDefinition};
use post_machine::diagnostic::Short;
use post_plugin::Cycle;

use super::limits::{LONGEST_DWELL, MOST_COORDINATE, MOST_PECKS};

/// How a cycle drills, lengths in mm along the tool axis from the programmed point, plus is away from the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrillCycle {
    /// The control's cycle for it; of a thread the right-hand one.
    kind: Cycle,
    /// Where the feed begins.
    clearance: f64,
    /// The bottom, not above zero.
    bottom: f64,
    /// Where the tool goes between the holes.
    retract: f64,
    /// Depth of one peck.
    peck: Option<Peck>,
    /// Dwell at the bottom, s.
    dwell: f64,
    /// A thread's way a turn, negative for a left-hand thread.
    pitch: Option<f64>,
    /// Way off the wall before the tool goes out (fine boring).
    shift: Option<f64>,
    /// The point is the bottom of the hole, and these heights are the part's: where the tool goes between the holes, and
    /// where the feed begins.
    planes: Option<[f64; 2]>,
}

/// One peck after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Peck {
    step: f64,
    /// Depth of the pecks after the first.
    later: f64,
    /// Retracts out of the hole after each (`DEEP`), or back by a little to break the chip (`BRKCHP`, `CHIP`).
    full: bool,
}

/// A cycle at one hole as the control gets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleCycle {
    /// The control's cycle.
    pub kind: Cycle,
    /// Distance from the point down to the bottom, mm.
    pub depth: f64,
    /// Distance from the point up to where the feed begins, mm.
    pub clearance: f64,
    /// Distance from the point up to where the tool goes between the holes, mm.
    pub retract: f64,
    /// Way into the part in one go, mm; of fine boring the way off the wall.
    pub step: Option<f64>,
    /// Dwell at the bottom, s.
    pub dwell: Option<f64>,
    /// A thread's way a turn, mm, above zero.
    pub pitch: Option<f64>,
    /// No moves do the same: the control's cycle or nothing.
    pub alone: bool,
}

impl HoleCycle {
    /// The tool waits at the bottom.
    pub fn waits(&self) -> bool {
        self.dwell.is_some_and(|dwell| dwell > 0.0)
    }
}

/// One leg of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleLeg {
    /// Goes at rapid traverse to this height.
    Rapid(f64),
    /// Goes at the cycle's feed to this height.
    Feed(f64),
    /// Wait, s.
    Dwell(f64),
}

/// Words of kinds, and the control's cycle that does it. Of several words the last row that holds one of them says.
const KINDS: [(&str, Cycle); 22] = [
    ("DRILL", Cycle::Drill),
    ("FACE", Cycle::Drill),
    ("CSINK", Cycle::Drill),
    ("CBORE", Cycle::Drill),
    ("CDRILL", Cycle::Drill),
    ("SPOT", Cycle::Drill),
    ("THRU", Cycle::Drill),
    ("DEEP", Cycle::Deep),
    ("DEEP2", Cycle::Deep),
    ("DEEPHL", Cycle::Deep),
    ("PECKING", Cycle::Deep),
    ("BRKCHP", Cycle::BreakChip),
    ("CHIP", Cycle::BreakChip),
    ("TAP", Cycle::Tap),
    ("RTAP", Cycle::Tap),
    ("TAPPING", Cycle::Tap),
    ("THREAD", Cycle::Tap),
    ("REAM", Cycle::Ream),
    // As NX and Creo mean it: out at feed, the spindle turning.
    ("BORE", Cycle::Ream),
    // Out at rapid, the spindle stopped: it drags along the wall.
    ("DRAG", Cycle::Bore),
    ("NODRAG", Cycle::BoreFine),
    ("ORIENT", Cycle::BoreFine),
];

/// Kinds that go in pecks.
const PECKED: [&str; 5] = ["DEEP", "DEEP2", "DEEPHL", "BRKCHP", "CHIP"];

/// What is left behind a peck, mm, for which there is none of its own: a depth that the steps divide is hardly ever divided by
/// their printed digits, and words of a program do not tell such depths apart.
const REST: f64 = 0.005;

/// Distance above the last depth at which a peck begins at feed, and by which a chip is broken: mm.
const GAP: f64 = 0.5;

impl DrillCycle {
    /// Reads a definition; `scale` takes the file's lengths to mm.
    ///
    /// # Errors
    /// What cannot be made as moves, as a sentence.
    pub fn new(cycle: &CycleDefinition, scale: f64) -> Result<Self, String> {
        let kind = kind(cycle)?;
        let depth = depth(cycle, scale)?;
        let clearance = cycle
            .clearance
            .ok_or("the cycle has no clearance (RAPTO, CLEAR): the rapid would end on the part")?
            * scale;
        if clearance < 0.0 {
            return Err(format!(
                "a clearance of {} mm lies below the point: the rapid would end in the part",
                Short(clearance)
            ));
        }
        check_sizes(cycle, depth, scale)?;
        let bottom = -depth;
        let retract = cycle.retract.map_or(clearance, |level| level * scale).max(clearance);
        let length = |step: Option<f64>| {
            let step = libm::fabs(step?) * scale;
            (step > 0.0).then_some(step)
        };
        let peck = length(cycle.step).map(|step| Peck {
            step,
            later: length(cycle.later_step).unwrap_or(step),
            full: kind != Cycle::BreakChip,
        });
        if kind == Cycle::Tap && peck.is_some() {
            return Err("a thread in pecks has no moves, and no words for it are known".to_owned());
        }
        let shift = length(cycle.shift);
        if kind == Cycle::BoreFine && shift.is_none() {
            return Err(
                "CYCLE/BORE,NODRAG needs the way off the wall, a number behind NODRAG or ORIENT: the control \
                 would take the one that it used last"
                    .to_owned(),
            );
        }
        check_pecks(peck, clearance - bottom, depth)?;
        let kind = match (kind, peck) {
            // The step makes the pecks, whatever the kind is called; without it there are none.
            (Cycle::Drill | Cycle::Deep, Some(_)) => Cycle::Deep,
            (Cycle::Deep | Cycle::BreakChip, None) => Cycle::Drill,
            (kind, _) => kind,
        };
        Ok(Self {
            kind,
            clearance,
            bottom,
            retract,
            peck,
            dwell: cycle.dwell.unwrap_or(0.0),
            pitch: pitch(cycle, scale)?,
            shift,
            planes: None,
        })
    }

    /// The kind that goes in pecks, if no peck is said.
    pub(crate) fn lacks_pecks(cycle: &CycleDefinition) -> Option<&str> {
        if cycle.step.is_some_and(|step| step != 0.0) {
            return None;
        }
        let mut kinds = cycle.kinds.iter().map(String::as_str);
        kinds.find(|kind| PECKED.contains(kind))
    }

    /// The cycle where its points are the bottoms of holes: `plane` is the height of the part that the tool goes to between
    /// them, `feed_from` that where its feed begins, mm.
    pub(crate) fn by_planes(self, plane: f64, feed_from: f64) -> Self {
        Self { planes: Some([plane, feed_from]), ..self }
    }

    /// The cycle at a hole whose bottom is `point`, and the point above it that its heights count from; none if its points
    /// are no bottoms.
    ///
    /// # Errors
    /// The planes do not lie above the hole, as a sentence.
    pub(crate) fn on_bottom(
        &self,
        point: Vector3<f64>,
        axis: Vector3<f64>,
    ) -> Result<Option<(Self, Vector3<f64>)>, String> {
        let Some([plane, feed_from]) = self.planes else {
            return Ok(None);
        };
        if (axis - Vector3::z()).norm() > 1e-6 {
            return Err(
                "the clearance plane of this cycle is a height along Z, and the tool leans"
                    .to_owned(),
            );
        }
        let top = point - axis * self.bottom;
        let [retract, clearance] = [plane, feed_from].map(|height| height - top.z);
        if clearance < 0.0 || retract < clearance {
            return Err(format!(
                "the hole begins at Z{}, its feed at Z{}, and its clearance plane is Z{}: none may lie below the one before",
                Short(top.z),
                Short(feed_from),
                Short(plane)
            ));
        }
        let cycle = Self { clearance, retract, planes: None, ..*self };
        Ok(Some((cycle, top)))
    }

    /// Whether it cuts a thread: the feed follows from the spindle.
    pub(crate) fn taps(&self) -> bool {
        self.kind == Cycle::Tap
    }

    /// A thread's way a turn, mm, negative for a left-hand thread, if the cycle's words say it.
    pub(crate) fn pitch(&self) -> Option<f64> {
        self.pitch
    }

    /// The cycle with a thread of this pitch, mm, cut by a spindle that turns left if `left`.
    pub(crate) fn threaded(self, pitch: f64, left: bool) -> Self {
        Self {
            kind: if left { Cycle::TapLeft } else { Cycle::Tap },
            pitch: Some(libm::fabs(pitch)),
            ..self
        }
    }

    /// The cycle as the control gets it; none if it has no words for it: pecks of two depths, or a first peck that differs.
    pub fn native(&self) -> Option<HoleCycle> {
        let step = match self.peck {
            // In one go all the same.
            Some(peck) if peck.step >= -self.bottom => None,
            Some(peck) if peck.step != peck.later => return None,
            Some(peck) => Some(peck.step),
            None => self.shift,
        };
        Some(HoleCycle {
            kind: match self.kind {
                Cycle::Deep | Cycle::BreakChip if step.is_none() => Cycle::Drill,
                kind => kind,
            },
            depth: -self.bottom,
            clearance: self.clearance,
            retract: self.retract,
            step,
            dwell: (self.dwell > 0.0).then_some(self.dwell),
            pitch: self.pitch.filter(|_| !self.expands()),
            alone: !self.expands(),
        })
    }

    /// Moves do the same.
    fn expands(&self) -> bool {
        matches!(self.kind, Cycle::Drill | Cycle::Deep | Cycle::BreakChip | Cycle::Ream)
    }

    /// Level between the holes.
    pub fn retract(&self) -> f64 {
        self.retract
    }

    /// Words of a definition that have no effect here.
    pub fn left_out(cycle: &CycleDefinition) -> impl Iterator<Item = String> {
        let is = |kind: &str| cycle.kinds.iter().any(|word| word == kind);
        let angles = (cycle.diameter.or(cycle.angle).is_some() && !is("CSINK"))
            .then(|| "the diameter and the angle, which are those of CSINK".to_owned());
        angles.into_iter().chain(cycle.rest.iter().filter_map(|argument| match argument {
            // CAMWorks states the level twice.
            Argument::Word(word) if word == "G98" => None,
            Argument::Word(word) => Some(word.clone()),
            Argument::Number(_) => None,
        }))
    }

    /// Calls `emit` with the legs at one point, in order.
    pub fn legs(&self, emit: &mut dyn FnMut(CycleLeg)) {
        emit(CycleLeg::Rapid(self.retract));
        emit(CycleLeg::Rapid(self.clearance));
        if let Some(peck) = self.peck {
            let mut depth = 0.0 - peck.step;
            while depth > self.bottom + REST {
                emit(CycleLeg::Feed(depth));
                if peck.full {
                    emit(CycleLeg::Rapid(self.clearance));
                    emit(CycleLeg::Rapid((depth + GAP).min(self.clearance)));
                } else {
                    emit(CycleLeg::Rapid((depth + GAP).min(self.clearance)));
                }
                depth -= peck.later;
            }
        }
        emit(CycleLeg::Feed(self.bottom));
        if self.dwell > 0.0 {
            emit(CycleLeg::Dwell(self.dwell));
        }
        if matches!(self.kind, Cycle::Ream | Cycle::Tap | Cycle::TapLeft) {
            emit(CycleLeg::Feed(self.clearance));
        }
        emit(CycleLeg::Rapid(self.retract));
    }
}

/// Refuses lengths and dwells that no machine has.
fn check_sizes(cycle: &CycleDefinition, depth: f64, scale: f64) -> Result<(), String> {
    let lengths =
        [cycle.clearance, cycle.retract, cycle.step, cycle.later_step, cycle.pitch, cycle.shift]
            .map(|length| length.unwrap_or(0.0) * scale);
    for height in lengths.into_iter().chain([depth]) {
        if libm::fabs(height) > MOST_COORDINATE {
            return Err(format!(
                "a height of {} mm: none is larger than {MOST_COORDINATE:e} mm",
                Short(height)
            ));
        }
    }
    let dwell = cycle.dwell.unwrap_or(0.0);
    if !(0.0..=LONGEST_DWELL).contains(&dwell) {
        return Err(format!(
            "a dwell of {} s: from 0 to {LONGEST_DWELL} s is possible",
            Short(dwell)
        ));
    }
    Ok(())
}

/// Refuses pecks without end over a way at feed.
fn check_pecks(peck: Option<Peck>, way: f64, depth: f64) -> Result<(), String> {
    if let Some(peck) = peck
        && let least = peck.step.min(peck.later)
        && way / least > MOST_PECKS
    {
        return Err(format!(
            "a peck of {} mm over a depth of {} mm is more than {MOST_PECKS} pecks",
            Short(least),
            Short(depth)
        ));
    }
    Ok(())
}

/// The control's cycle of a definition.
fn kind(cycle: &CycleDefinition) -> Result<Cycle, String> {
    let mut last = 0;
    for word in &cycle.kinds {
        let Some(row) = KINDS.iter().position(|(kind, _)| kind == word) else {
            return Err(format!(
                "CYCLE/{word} is not a cycle that post can make as moves or has words for"
            ));
        };
        last = last.max(row);
    }
    let kind = KINDS[last].1;
    let bores = cycle.kinds.iter().any(|word| word == "BORE");
    if matches!(kind, Cycle::Bore | Cycle::BoreFine) && !bores {
        return Err(format!("{} belongs to CYCLE/BORE", KINDS[last].0));
    }
    Ok(kind)
}

/// How deep below the point, mm.
fn depth(cycle: &CycleDefinition, scale: f64) -> Result<f64, String> {
    let through = libm::fabs(cycle.break_through.unwrap_or(0.0));
    let sinks = cycle.kinds.iter().any(|word| word == "CSINK");
    let depth = match (cycle.depth, cycle.diameter.filter(|_| sinks), cycle.angle) {
        (Some(depth), ..) => libm::fabs(depth),
        (None, Some(diameter), Some(angle)) if (1.0..179.0).contains(&angle) => {
            let half = libm::tan((angle / 2.0).to_radians());
            libm::fabs(diameter) / 2.0 / half
        }
        (None, Some(_), angle) => {
            return Err(match angle {
                None => "the diameter of a countersink says how deep only with the cutter's angle (ANGLE)".to_owned(),
                Some(angle) => format!(
                    "a countersink with an angle of {}°: from 1° to 179° is possible",
                    Short(angle)
                ),
            });
        }
        (None, None, _) => return Err("the cycle has no depth".to_owned()),
    };
    Ok((depth + through) * scale)
}

/// A thread's way a turn, mm.
fn pitch(cycle: &CycleDefinition, scale: f64) -> Result<Option<f64>, String> {
    let pitch = match (cycle.pitch, cycle.turns_per_inch) {
        (Some(pitch), _) => pitch * scale,
        (None, Some(turns)) => 25.4 / turns,
        (None, None) => return Ok(None),
    };
    let [least, most] = super::limits::FEEDS_A_TURN;
    if (least..=most).contains(&libm::fabs(pitch)) {
        return Ok(Some(pitch));
    }
    Err(format!(
        "a pitch of {} mm: from {} to {} mm is possible",
        Short(pitch),
        Short(least),
        Short(most)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legs(definition: &CycleDefinition, scale: f64) -> Vec<CycleLeg> {
        let mut legs = Vec::new();
        DrillCycle::new(definition, scale).unwrap().legs(&mut |leg| legs.push(leg));
        legs
    }

    #[test]
    fn deep_drilling_leaves_the_hole_between_pecks() {
        let definition = CycleDefinition {
            kinds: vec!["DEEP".to_owned()],
            depth: Some(3.5),
            clearance: Some(1.0),
            step: Some(2.0),
            ..CycleDefinition::default()
        };
        assert_eq!(
            legs(&definition, 1.0),
            [
                CycleLeg::Rapid(1.0),
                CycleLeg::Rapid(1.0),
                CycleLeg::Feed(-2.0),
                CycleLeg::Rapid(1.0),
                CycleLeg::Rapid(-1.5),
                CycleLeg::Feed(-3.5),
                CycleLeg::Rapid(1.0),
            ]
        );
    }

    #[test]
    fn a_depth_that_the_steps_divide_but_for_rounding_has_no_peck_of_nothing() {
        for (depth, pecks) in [(20.902, 3), (20.9, 3), (20.9065, 3), (20.92, 4)] {
            let definition = CycleDefinition {
                kinds: vec!["DEEP".to_owned()],
                depth: Some(depth),
                clearance: Some(1.0),
                step: Some(6.967_333_33),
                ..CycleDefinition::default()
            };
            let legs = legs(&definition, 1.0);
            let down: Vec<f64> = legs
                .iter()
                .filter_map(|leg| match leg {
                    CycleLeg::Feed(down) => Some(*down),
                    _ => None,
                })
                .collect();
            assert_eq!((down.len(), down.last()), (pecks, Some(&-depth)));
        }
    }

    #[test]
    fn the_pecks_behind_the_first_may_be_others() {
        let definition = CycleDefinition {
            kinds: vec!["CHIP".to_owned()],
            depth: Some(8.0),
            clearance: Some(1.0),
            step: Some(5.0),
            later_step: Some(2.0),
            ..CycleDefinition::default()
        };
        let down: Vec<CycleLeg> = legs(&definition, 1.0)
            .into_iter()
            .filter(|leg| matches!(leg, CycleLeg::Feed(_)))
            .collect();
        assert_eq!(down, [CycleLeg::Feed(-5.0), CycleLeg::Feed(-7.0), CycleLeg::Feed(-8.0)]);
    }

    #[test]
    fn depths_of_either_sign_go_down_and_inches_are_scaled() {
        let definition = CycleDefinition {
            kinds: vec!["DRILL".to_owned()],
            depth: Some(-1.0),
            clearance: Some(0.1),
            retract: Some(1.0),
            dwell: Some(0.5),
            ..CycleDefinition::default()
        };
        assert_eq!(
            legs(&definition, 25.4),
            [
                CycleLeg::Rapid(25.4),
                CycleLeg::Rapid(2.54),
                CycleLeg::Feed(-25.4),
                CycleLeg::Dwell(0.5),
                CycleLeg::Rapid(25.4),
            ]
        );
    }

    #[test]
    fn a_countersink_goes_as_deep_as_its_diameter_asks() {
        let definition = CycleDefinition {
            kinds: vec!["CSINK".to_owned()],
            diameter: Some(8.0),
            angle: Some(90.0),
            clearance: Some(1.0),
            ..CycleDefinition::default()
        };
        let sunk = legs(&definition, 1.0);
        let Some(CycleLeg::Feed(bottom)) = sunk.iter().find(|leg| matches!(leg, CycleLeg::Feed(_)))
        else {
            panic!("{sunk:?}");
        };
        // With 90° as deep as half the diameter.
        assert!((bottom + 4.0).abs() < 1e-12, "{sunk:?}");
    }
}
