//! Work offsets in which the tool goes at rapid and never cuts: the way counts from another zero than all cuts.

use super::Verifier;
use super::report::BlockPlace;
use crate::course::Course;
use crate::{Motion, MotionKind};

/// Most work offsets that are told apart.
const MOST: usize = 1000;

/// The work offsets that a program moves in.
#[derive(Debug, Default)]
pub(super) struct OffsetUse {
    /// Those of rapids, each with the line of the first.
    rapids: Vec<(String, u64)>,
    cuts: Vec<String>,
}

impl OffsetUse {
    /// The tool moves.
    pub(super) fn moves(&mut self, motion: &Motion) {
        let Some(name) = motion.state.work_offset.as_ref().filter(|_| !motion.machine) else {
            return;
        };
        let rapid = motion.kind == MotionKind::Rapid;
        if rapid && !self.rapids.iter().any(|(known, _)| known == name) && self.rapids.len() < MOST
        {
            self.rapids.push((name.clone(), motion.line));
        }
        if !rapid && !self.cuts.contains(name) && self.cuts.len() < MOST {
            self.cuts.push(name.clone());
        }
    }
}

impl<C: Course> Verifier<'_, C> {
    /// The program is over: tells of rapids in work offsets that nothing is cut in, unless it is said where they all lie.
    pub(super) fn tell_offset_use(&mut self) {
        let OffsetUse { rapids, cuts } = std::mem::take(&mut self.offset_use);
        if self.rules.work_offsets || cuts.is_empty() || cuts.len() == MOST {
            return;
        }
        for (name, line) in rapids.into_iter().filter(|(name, _)| !cuts.contains(name)) {
            let message = format!(
                "goes at rapid in {name}, in which nothing is cut: cuts are in {}",
                cuts.join(", ")
            );
            match self.rules.own {
                true => {
                    self.fault_at(
                        "work-offset",
                        message,
                        Some(BlockPlace::of_line(line)),
                        None,
                        None,
                    );
                }
                false => self.left_on(line, "work-offset", message),
            }
        }
    }
}
