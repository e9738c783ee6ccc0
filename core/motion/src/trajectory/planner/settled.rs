//! What the look-ahead has settled becomes sections of the law, time of tasks, and jumps.

use post_machine::kinematics::Joints;

use super::Planner;
use crate::VelocityJump;
use crate::trajectory::TimeLimit;
use crate::trajectory::block::{BlockPhase, VelocityLimit};
use crate::trajectory::law::{LawSection, PieceSpan};

impl Planner {
    /// What the look-ahead has settled goes into the law.
    pub(super) fn take(&mut self, part: BlockPhase) {
        let BlockPhase { phase, from, .. } = part;
        let piece = *self.law.piece(part.block);
        let reached = |kink: &mut (u64, [Joints; 2])| kink.0 <= part.block;
        while let Some((number, [change, bend])) = self.kinks.pop_front_if(reached) {
            if number == part.block {
                let (velocity, along) = (phase.velocity, phase.acceleration);
                self.jumps.push_back(VelocityJump {
                    time: self.clock,
                    change: change.map(|change| change * velocity),
                    bend: std::array::from_fn(|place| {
                        bend[place] * velocity * velocity + change[place] * along
                    }),
                });
            }
        }
        let covered = phase.length(phase.seconds);
        let reason = match part.why {
            VelocityLimit::Velocity => piece.by[0],
            VelocityLimit::Corner if piece.at.cuts => TimeLimit::Corner,
            VelocityLimit::Corner | VelocityLimit::Change => match phase.jerk == 0.0 {
                true => piece.by[1],
                false => piece.by[2],
            },
        };
        let share = covered / piece.length;
        let (task, whole) = match piece.span {
            PieceSpan::Along { from, to } => (piece.at.task, to - from),
            PieceSpan::Corner { shares, .. } => match from + 0.5 * covered < 0.5 * piece.length {
                true => (piece.at.task, 2.0 * shares[0]),
                false => (piece.second, 2.0 * shares[1]),
            },
        };
        self.pass_borders(part.block);
        self.accounts.spend(task, phase.seconds, share * whole, reason);
        if let Some(border) = piece.border.filter(|_| self.bordered < Some(part.block)) {
            let place = border * piece.length;
            if border == 0.0 || from + covered >= place {
                let time = self.clock + phase.time_at(place - from);
                self.accounts.border(time);
                self.bordered = Some(part.block);
            }
        }
        self.law.push(LawSection {
            run: self.run,
            piece: part.block,
            from,
            begins: self.clock,
            phase,
        });
        self.clock += phase.seconds;
    }

    /// Tasks end where pieces before `end` have a border that no phase has come to: so short that rounding leaves no time for
    /// it.
    pub(super) fn pass_borders(&mut self, end: u64) {
        let last = self.law.sections.back().map_or(0, |section| section.piece);
        for number in last..end {
            if self.bordered < Some(number) && self.law.piece(number).border.is_some() {
                self.accounts.border(self.clock);
                self.bordered = Some(number);
            }
        }
    }
}
