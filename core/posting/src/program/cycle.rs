//! Cycles become moves: approach, peck, dwell, retract, along the tool axis.

use post_grammar::{Argument, CycleDefinition};

use post_machine::diagnostic::Short;

use super::limits::{LONGEST_DWELL, MOST_COORDINATE, MOST_PECKS};

/// How a cycle drills, lengths in mm along the tool axis from the programmed point, plus is away from the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrillCycle {
    /// Where the feed begins.
    clearance: f64,
    /// The bottom, not above zero.
    bottom: f64,
    /// Where the tool goes between the holes.
    retract: f64,
    /// Depth of one peck.
    peck: Option<Peck>,
    /// At the bottom, s.
    dwell: f64,
    /// The tool leaves the hole at feed.
    feed_out: bool,
}

/// One peck after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Peck {
    step: f64,
    /// Of those behind the first.
    later: f64,
    /// Out of the hole after each (`DEEP`), or back by a little to break the chip (`BRKCHP`, `CHIP`).
    full: bool,
}

/// One leg of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// At rapid traverse to this height.
    Rapid(f64),
    /// At the cycle's feed to this height.
    Feed(f64),
    /// Wait, s.
    Dwell(f64),
}

/// Kinds that rapid, feed, dwell and feed or rapid back make.
const KINDS: [&str; 15] = [
    "DRILL", "DEEP", "DEEP2", "DEEPHL", "BRKCHP", "CHIP", "BORE", "REAM", "FACE", "CSINK", "CBORE",
    "CDRILL", "SPOT", "THRU", "PECKING",
];

/// Kinds that go in pecks.
const PECKED: [&str; 5] = ["DEEP", "DEEP2", "DEEPHL", "BRKCHP", "CHIP"];

/// Above the last depth a peck begins at feed, and a chip is broken by going back so far: mm.
const GAP: f64 = 0.5;

impl DrillCycle {
    /// Reads a definition; `scale` takes the file's lengths to mm.
    ///
    /// # Errors
    /// What cannot be made as moves, as a sentence.
    pub fn new(cycle: &CycleDefinition, scale: f64) -> Result<Self, String> {
        let is = |kind: &str| cycle.kinds.iter().any(|word| word == kind);
        for kind in &cycle.kinds {
            match kind.as_str() {
                "TAP" | "THREAD" | "RTAP" | "TAPPING" => {
                    return Err(format!(
                        "CYCLE/{kind} ties the feed to the spindle's turns, which moves cannot do"
                    ));
                }
                kind if KINDS.contains(&kind) => {}
                kind => {
                    return Err(format!(
                        "CYCLE/{kind} is not a cycle that post can make as moves"
                    ));
                }
            }
        }
        let depth = cycle.depth.ok_or("the cycle has no depth")?;
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
        for height in [
            Some(depth),
            cycle.clearance,
            cycle.retract,
            cycle.step,
            cycle.later_step,
        ] {
            let height = height.unwrap_or(0.0) * scale;
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
        let bottom = -libm::fabs(depth) * scale;
        let retract = cycle
            .retract
            .map_or(clearance, |level| level * scale)
            .max(clearance);
        let length = |step: Option<f64>| {
            let step = libm::fabs(step?) * scale;
            (step > 0.0).then_some(step)
        };
        let peck = length(cycle.step).map(|step| Peck {
            step,
            later: length(cycle.later_step).unwrap_or(step),
            full: !is("BRKCHP") && !is("CHIP"),
        });
        if let Some(peck) = peck
            && let least = peck.step.min(peck.later)
            && (clearance - bottom) / least > MOST_PECKS
        {
            return Err(format!(
                "a peck of {} mm over a depth of {} mm is more than {MOST_PECKS} pecks",
                Short(least),
                Short(-bottom)
            ));
        }
        Ok(Self {
            clearance,
            bottom,
            retract,
            peck,
            dwell,
            feed_out: is("BORE") || is("REAM"),
        })
    }

    /// Level between the holes.
    pub fn retract(&self) -> f64 {
        self.retract
    }

    /// Words of a definition that have no effect here.
    pub fn left_out(cycle: &CycleDefinition) -> impl Iterator<Item = String> {
        let pecks = cycle.step.is_none()
            && cycle
                .kinds
                .iter()
                .any(|kind| PECKED.contains(&kind.as_str()));
        let pecks = pecks.then(|| "the pecks, since there is no STEP".to_owned());
        pecks
            .into_iter()
            .chain(cycle.rest.iter().filter_map(|argument| match argument {
                // CAMWorks states the level twice.
                Argument::Word(word) if word == "G98" => None,
                Argument::Word(word) => Some(word.clone()),
                Argument::Number(_) => None,
            }))
    }

    /// Calls `emit` with the legs at one point, in order.
    pub fn legs(&self, emit: &mut dyn FnMut(Leg)) {
        emit(Leg::Rapid(self.retract));
        emit(Leg::Rapid(self.clearance));
        if let Some(peck) = self.peck {
            let mut depth = 0.0 - peck.step;
            while depth > self.bottom {
                emit(Leg::Feed(depth));
                if peck.full {
                    emit(Leg::Rapid(self.clearance));
                    emit(Leg::Rapid((depth + GAP).min(self.clearance)));
                } else {
                    emit(Leg::Rapid((depth + GAP).min(self.clearance)));
                }
                depth -= peck.later;
            }
        }
        emit(Leg::Feed(self.bottom));
        if self.dwell > 0.0 {
            emit(Leg::Dwell(self.dwell));
        }
        if self.feed_out {
            emit(Leg::Feed(self.clearance));
        }
        emit(Leg::Rapid(self.retract));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn legs(definition: &CycleDefinition, scale: f64) -> Vec<Leg> {
        let mut legs = Vec::new();
        DrillCycle::new(definition, scale)
            .unwrap()
            .legs(&mut |leg| legs.push(leg));
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
                Leg::Rapid(1.0),
                Leg::Rapid(1.0),
                Leg::Feed(-2.0),
                Leg::Rapid(1.0),
                Leg::Rapid(-1.5),
                Leg::Feed(-3.5),
                Leg::Rapid(1.0),
            ]
        );
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
        let down: Vec<Leg> = legs(&definition, 1.0)
            .into_iter()
            .filter(|leg| matches!(leg, Leg::Feed(_)))
            .collect();
        assert_eq!(down, [Leg::Feed(-5.0), Leg::Feed(-7.0), Leg::Feed(-8.0)]);
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
                Leg::Rapid(25.4),
                Leg::Rapid(2.54),
                Leg::Feed(-25.4),
                Leg::Dwell(0.5),
                Leg::Rapid(25.4),
            ]
        );
    }

    #[test]
    fn tapping_is_refused() {
        let definition = CycleDefinition {
            kinds: vec!["TAP".to_owned()],
            depth: Some(10.0),
            ..CycleDefinition::default()
        };
        assert!(DrillCycle::new(&definition, 1.0).is_err());
    }
}
