//! Moves become pieces of path, and these runs: what happens at each move's end.

use post_machine::description::BlendRule;
use post_machine::kinematics::{Joints, Unreachable};

use super::Planner;
use super::entry::OpenMove;
use crate::CornerMode;
use crate::limits::KINK;
use crate::trajectory::TimeLimit;
use crate::trajectory::block::{BlockPhase, LookAheadBlock, VelocityLimit};
use crate::trajectory::corner::Junction;
use crate::trajectory::kink;
use crate::trajectory::law::{LawPiece, PieceSpan};
use crate::trajectory::look_ahead::LookAhead;
use crate::trajectory::profile::Phase;
use crate::trajectory::round::RoundedCorner;

impl Planner {
    /// The last move leads to a standstill.
    pub(super) fn stop(&mut self) {
        if let Some(last) = self.last.take() {
            self.along(&last, 0.0, Junction::Stop);
            self.stand(&last);
        }
    }

    /// Waits at an exact stop until the axes are in position.
    fn stand(&mut self, last: &OpenMove) {
        self.finish();
        if self.in_position > 0.0 {
            let seconds = self.in_position;
            self.rest(last.number, 1.0, seconds, last.at, TimeLimit::Corner);
        }
        self.accounts.border(self.clock);
    }

    /// Goes from the last move into the next one.
    pub(super) fn pass(
        &mut self,
        last: OpenMove,
        junction: Junction,
        next: &mut OpenMove,
    ) -> Result<(), Unreachable> {
        let [out, into] = match &junction {
            Junction::Round(round) => round.shares,
            _ => [0.0, 0.0],
        };
        self.along(&last, out, junction);
        match junction {
            Junction::Stop => self.stand(&last),
            Junction::Overlap { rate, change } => {
                let earliest = self.clock.max(self.before);
                self.finish();
                let ends = self.clock;
                let (begins, change) = match self.jerk {
                    false => (self.overlap_from(rate * last.scale), change),
                    true => {
                        // Half of either ramp: what is left of the one and what there is of the other are one at most.
                        let reached = next.half.reached();
                        let begins = self.overlap_from(0.5 * rate * last.scale);
                        let begins = begins.max(ends - 1.0 / reached).max(earliest);
                        (begins, change.min(0.5 * reached / (ends - begins)))
                    }
                };
                self.clock = begins.max(earliest);
                next.entrance = Some([change, ends - self.clock]);
                self.accounts.border(0.5 * (self.clock + ends));
            }
            Junction::Join { ratio, jumps, .. } => {
                next.begins = false;
                next.scale = last.scale / ratio;
                if jumps {
                    next.kink = Some(self.kink([&last, next], ratio)?);
                }
                self.settle(false);
            }
            Junction::Round(round) => {
                next.begins = false;
                next.scale = last.scale / round.ratio;
                next.taken = into;
                self.corner(&last, next, &round);
                self.settle(false);
            }
        }
        Ok(())
    }

    /// How the axes' derivatives change between two moves that are joined, over the coordinate of the law.
    fn kink(&self, entries: [&OpenMove; 2], ratio: f64) -> Result<[Joints; 2], Unreachable> {
        let moves = entries.map(|entry| self.law.task(entry.number));
        let found = entries.map(|entry| &entry.found);
        let [change, bend] = kink::of_axes(moves, found, &self.limits, ratio)?;
        let scale = entries[0].scale;
        Ok([change.map(|change| change / scale), bend.map(|bend| bend / (scale * scale))])
    }

    /// The last move up to its corner, which takes the share `out`.
    fn along(&mut self, last: &OpenMove, out: f64, junction: Junction) {
        let blends = matches!(
            self.law.task(last.number).corner,
            CornerMode::Blend { .. } | CornerMode::Within { .. }
        );
        let shared = match junction {
            Junction::Overlap { .. } => true,
            Junction::Stop => blends && self.blend == BlendRule::Overlap,
            _ => false,
        };
        let smooth = last.whole.jerk.is_finite();
        let bounds = match shared || smooth && last.entrance.is_some() {
            true => &last.half,
            false => &last.whole,
        };
        let joined = !last.begins || matches!(junction, Junction::Join { .. } | Junction::Round(_));
        let share = match joined && self.blend == BlendRule::Overlap {
            true => 1.0 - KINK,
            false => 1.0,
        };
        let scale = last.scale;
        let exit = match junction {
            Junction::Join { rate, .. } => rate * scale,
            Junction::Round(_) => f64::INFINITY,
            Junction::Stop | Junction::Overlap { .. } => 0.0,
        };
        let mut block = LookAheadBlock {
            length: (1.0 - out - last.taken) * scale,
            velocity: bounds.rate * scale,
            acceleration: bounds.acceleration * share * scale,
            jerk: bounds.jerk * scale,
            exit,
        };
        let joined = !last.begins && last.taken == 0.0;
        let piece = LawPiece {
            entry: last.number,
            span: PieceSpan::Along { from: last.taken, to: 1.0 - out },
            length: block.length,
            at: last.at,
            second: last.at.task,
            by: bounds.by,
            border: joined.then_some(0.0),
        };
        let number = self.law.push_piece(piece);
        if let Some(kink) = last.kink.filter(|_| joined) {
            self.kinks.push_back((number, kink));
        }
        if last.begins {
            self.run += 1;
            let mut begun = [0.0; 2];
            if let Some([change, seconds]) = last.entrance {
                let change = change * scale;
                if self.jerk {
                    block.acceleration = block.acceleration.min(change);
                } else if change < block.acceleration * (1.0 - 1e-9) && seconds > 0.0 {
                    let phase = Phase { seconds, velocity: 0.0, acceleration: change, jerk: 0.0 };
                    begun = [phase.velocity(seconds), phase.length(seconds)];
                    self.take(BlockPhase {
                        block: number,
                        from: 0.0,
                        phase,
                        why: VelocityLimit::Corner,
                    });
                }
            }
            self.ahead.begin(number, begun[0], begun[1]);
        }
        self.ahead.push(block);
    }

    /// The curve that takes shares of two moves.
    fn corner(&mut self, last: &OpenMove, next: &OpenMove, round: &RoundedCorner) {
        let mut bounds = round.bounds;
        let length = round.length * last.scale;
        let velocities = [last, next].map(|entry| entry.whole.rate * entry.scale);
        let slower = usize::from(velocities[1] < velocities[0]);
        if bounds.by[0] == TimeLimit::Feed {
            bounds.by[0] = [last, next][slower].whole.by[0];
        } else {
            bounds.by[0] = TimeLimit::Corner;
        }
        self.law.push_piece(LawPiece {
            entry: last.number,
            span: PieceSpan::Corner { shares: round.shares, curve: round.curve },
            length,
            at: last.at,
            second: next.at.task,
            by: bounds.by,
            border: Some(0.5),
        });
        self.ahead.push(LookAheadBlock {
            length,
            velocity: bounds.rate * length,
            acceleration: bounds.acceleration * length,
            jerk: bounds.jerk * length,
            exit: f64::INFINITY,
        });
    }

    /// When the run in progress has come down to `velocity` on its way to rest, s.
    fn overlap_from(&self, velocity: f64) -> f64 {
        let mut begins = self.clock;
        let own = self.law.sections.iter().rev();
        for section in own.take_while(|section| section.run == self.run) {
            let phase = &section.phase;
            let last = phase.acceleration(phase.seconds);
            if phase.velocity <= phase.velocity(phase.seconds) || phase.acceleration.max(last) > 0.0
            {
                break;
            }
            if phase.velocity > velocity {
                return section.begins + phase.time_of(velocity);
            }
            begins = section.begins;
        }
        begins
    }

    /// The run ends where the last piece does.
    fn finish(&mut self) {
        self.settle(true);
        self.pass_borders(self.law.pieces_end());
        self.before = self.clock;
    }

    fn settle(&mut self, ended: bool) {
        let mut ahead = std::mem::replace(&mut self.ahead, LookAhead::new(1, false));
        ahead.settle(ended, &mut |part| self.take(part));
        self.ahead = ahead;
    }
}
