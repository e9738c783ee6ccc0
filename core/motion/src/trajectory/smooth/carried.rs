//! How far a plan is carried out, and what that is block by block.

use super::{JerkStep, SmoothPlan};
use crate::trajectory::block::BlockPhase;
use crate::trajectory::envelope::VelocityEnvelope;
use crate::trajectory::profile::Phase;

impl SmoothPlan {
    /// How many steps are carried out where the control has seen enough of the first `done` blocks: to the last place in
    /// them where the plan can be left, else to the next.
    pub(super) fn leave(&mut self, ahead: &VelocityEnvelope, done: usize) -> usize {
        let wanted: f64 = (0..done).map(|place| ahead.left(place)).sum();
        let mut covered = 0.0;
        let mut best = 0;
        for place in 0..self.steps.len() {
            let step = self.steps[place];
            let phase = step.phase;
            let length = phase.length(phase.seconds);
            let level = phase.acceleration == 0.0 && phase.jerk == 0.0 && phase.velocity > 0.0;
            let ends = step.ends.unwrap_or(usize::MAX);
            if level && ends > done && covered + length > wanted {
                let seconds = (wanted - covered) / phase.velocity;
                if seconds > 0.0 && seconds < phase.seconds {
                    let part = |seconds: f64, ends: Option<usize>| JerkStep {
                        phase: Phase { seconds, ..phase },
                        ends,
                        ..step
                    };
                    self.steps[place] = part(phase.seconds - seconds, step.ends);
                    self.steps.insert(place, part(seconds, Some(done)));
                    return place + 1;
                }
            }
            covered += length;
            if covered > wanted && best > 0 && ends > done {
                return best;
            }
            if step.rests && covered > 0.0 {
                best = place + 1;
                if covered >= wanted {
                    return best;
                }
            }
        }
        self.steps.len()
    }

    /// Hands over the first `count` steps block by block; how many blocks are behind.
    pub(super) fn carry_out(
        &mut self,
        ahead: &mut VelocityEnvelope,
        count: usize,
        take: &mut dyn FnMut(BlockPhase),
    ) -> usize {
        let (mut place, mut begun) = (0, ahead.begun);
        for index in 0..count {
            let hill = self.steps[index..].iter().find_map(|step| step.ends);
            let last = hill.unwrap_or(ahead.blocks.len()) - 1;
            let mut step = self.steps[index];
            loop {
                let block = &ahead.blocks[place];
                let left = block.length - begun;
                let covered = step.phase.length(step.phase.seconds);
                let within = place >= last || covered <= left;
                let seconds = match within {
                    true => step.phase.seconds,
                    false => step.phase.time_at(left),
                };
                if seconds > 0.0 {
                    take(BlockPhase {
                        block: ahead.first + place as u64,
                        from: begun,
                        phase: Phase { seconds, ..step.phase },
                        why: step.why,
                    });
                }
                if within {
                    begun += covered;
                    break;
                }
                step.phase = step.phase.after(seconds);
                (place, begun) = (place + 1, 0.0);
            }
            ahead.velocity = step.phase.velocity(step.phase.seconds).max(0.0);
            if let Some(ends) = step.ends {
                (place, begun) = (ends, 0.0);
            }
        }
        ahead.begun = begun;
        ahead.first += place as u64;
        ahead.blocks.drain(..place);
        place
    }
}
