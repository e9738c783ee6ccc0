//! The time law that is settled, and where the machine stands by it.

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::kinematics::{Joints, Pose, Solver, Unreachable};

use super::TimeLimit;
use super::profile::Phase;
use super::round::CornerCurve;
use crate::path::{Interpolation, Stance};
use crate::{Move, ProgramPlace};

/// A stretch of path.
#[derive(Clone, Copy, Debug)]
pub(super) struct LawPiece {
    /// Number of the move.
    pub entry: u64,
    pub span: PieceSpan,
    /// Length in the coordinate of the law.
    pub length: f64,
    pub at: ProgramPlace,
    /// The task of the second move, where it takes part of two.
    pub second: u64,
    /// What bounds velocity, acceleration and jerk on it.
    pub by: [TimeLimit; 3],
    /// The share of it from which on its time is that of the next task.
    pub border: Option<f64>,
}

/// Part of a move, or of two.
#[derive(Clone, Copy, Debug)]
pub(super) enum PieceSpan {
    /// A move from one place of its parameter to another.
    Along { from: f64, to: f64 },
    /// Shares of the move and of the next one, added.
    Corner { shares: [f64; 2], curve: CornerCurve },
}

/// Constant jerk on one piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct LawSection {
    /// Number of the run that it belongs to: within one, each begins where the last one ends.
    pub run: u64,
    /// Number of the piece.
    pub piece: u64,
    /// Where in the piece it begins.
    pub from: f64,
    /// Time at which it begins, s.
    pub begins: f64,
    pub phase: Phase,
}

impl LawSection {
    /// When it ends, s.
    pub fn ends(&self) -> f64 {
        self.begins + self.phase.seconds
    }
}

/// Pieces and their sections, from the one that is in progress on.
#[derive(Debug, Default)]
pub(super) struct TimeLaw {
    /// Ways that lead the tip add up as tip and rotary axes: what is limited are the programmed coordinates.
    programmed: bool,
    pub sections: VecDeque<LawSection>,
    /// Sections of each run.
    counts: VecDeque<usize>,
    pieces: VecDeque<LawPiece>,
    /// Number of the first piece.
    first_piece: u64,
    moves: VecDeque<Move>,
    /// Number of the first move.
    first_move: u64,
}

impl TimeLaw {
    /// A law without pieces; `programmed`: the programmed coordinates are limited, not the axes.
    pub fn new(programmed: bool) -> Self {
        Self { programmed, ..Self::default() }
    }

    /// Takes a move and says its number.
    pub fn push_move(&mut self, task: Move) -> u64 {
        self.moves.push_back(task);
        self.first_move + self.moves.len() as u64 - 1
    }

    /// The number of the last one.
    pub fn last_move(&self) -> Option<u64> {
        (self.first_move + self.moves.len() as u64).checked_sub(1)
    }

    /// A move.
    pub fn task(&self, number: u64) -> &Move {
        &self.moves[(number - self.first_move) as usize]
    }

    pub fn push_piece(&mut self, piece: LawPiece) -> u64 {
        self.pieces.push_back(piece);
        self.pieces_end() - 1
    }

    /// The number of the piece that is pushed next.
    pub fn pieces_end(&self) -> u64 {
        self.first_piece + self.pieces.len() as u64
    }

    pub fn piece(&self, number: u64) -> &LawPiece {
        &self.pieces[(number - self.first_piece) as usize]
    }

    pub fn push(&mut self, section: LawSection) {
        match self.sections.back() {
            Some(last) if last.run == section.run => {
                if let Some(count) = self.counts.back_mut() {
                    *count += 1;
                }
            }
            _ => self.counts.push_back(1),
        }
        self.sections.push_back(section);
    }

    /// Forgets what is over at `time`; the last section stays, as the machine stands where it ends.
    pub fn advance(&mut self, time: f64) {
        while self.sections.len() > 1 && time >= self.sections[0].ends() {
            self.sections.pop_front();
            self.counts[0] -= 1;
            if self.counts[0] == 0 {
                self.counts.pop_front();
            }
        }
        let Some(section) = self.sections.front() else {
            return;
        };
        let gone = section.piece - self.first_piece;
        self.pieces.drain(..gone as usize);
        self.first_piece = section.piece;
        if let Some(piece) = self.pieces.front() {
            let gone = piece.entry - self.first_move;
            self.moves.drain(..gone as usize);
            self.first_move = piece.entry;
        }
    }

    /// The chain that is in use.
    pub fn solver(&self) -> Option<&Arc<Solver>> {
        let section = self.sections.front()?;
        Some(&self.task(self.piece(section.piece).entry).solver)
    }

    /// Where the machine stands at `time`, which nothing that is over precedes, and in which piece; `near`: the axis
    /// values a little before.
    pub fn at(&self, time: f64, near: &Joints) -> Result<(LawStance, ProgramPlace), Unreachable> {
        let section = &self.sections[0];
        let at = self.piece(section.piece).at;
        let count = self.counts.front().copied().unwrap_or_default();
        let Some(second) = self.sections.get(count).filter(|next| next.begins < time) else {
            return Ok((self.place(section, time, near)?, at));
        };
        let stance = self.stance(section, time, near)?;
        // The next run has begun while this one ends.
        let run = second.run;
        let second = self
            .sections
            .range(count..)
            .take_while(|section| section.run == run && section.begins <= time)
            .last()
            .unwrap_or(second);
        let last = self.piece(self.sections[count - 1].piece).entry;
        let [first, other] = [last, self.piece(second.piece).entry].map(|entry| self.task(entry));
        let next = self.stance(second, time, &less(near, &stance.joints, &first.to))?;
        let tip_led = self.adds_tips([first, other]);
        let joints = added(&first.solver, [&stance, &next], &first.to, tip_led)?;
        Ok((LawStance { joints, pose: None }, at))
    }

    fn adds_tips(&self, moves: [&Move; 2]) -> bool {
        self.programmed && moves.iter().all(|task| task.way != Interpolation::Axes)
    }

    /// Where one section has the machine, its pose with it.
    fn stance(
        &self,
        section: &LawSection,
        time: f64,
        near: &Joints,
    ) -> Result<Stance, Unreachable> {
        let LawStance { joints, pose } = self.place(section, time, near)?;
        let chain = self.task(self.piece(section.piece).entry).solver.chain();
        Ok(Stance { joints, pose: pose.unwrap_or_else(|| chain.forward(&joints)) })
    }

    /// Where one section has the machine.
    fn place(
        &self,
        section: &LawSection,
        time: f64,
        near: &Joints,
    ) -> Result<LawStance, Unreachable> {
        let piece = self.piece(section.piece);
        let within = (time - section.begins).clamp(0.0, section.phase.seconds);
        let covered = section.from + section.phase.length(within);
        let share = (covered / piece.length).clamp(0.0, 1.0);
        let task = self.task(piece.entry);
        let (shares, curve) = match piece.span {
            PieceSpan::Along { from, to } => {
                return along(task, from + (to - from) * share, near);
            }
            PieceSpan::Corner { shares, curve } => (shares, curve),
        };
        let next = self.task(piece.entry + 1);
        let [out, into] = curve.places(share);
        let places = [1.0 - shares[0] * (1.0 - out), shares[1] * into];
        let joints = if self.adds_tips([task, next]) {
            let first = stance(task, places[0], near)?;
            let second = stance(next, places[1], &less(near, &first.joints, &task.to))?;
            added(&task.solver, [&first, &second], &task.to, true)?
        } else {
            let first = joints(task, places[0], near)?;
            let second = joints(next, places[1], &less(near, &first, &task.to))?;
            sum([&first, &second], &task.to)
        };
        Ok(LawStance { joints, pose: None })
    }
}

/// Where the machine stands at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct LawStance {
    /// Axis values, mm and radians.
    pub joints: Joints,
    /// Tip and tool axis where the control leads both by vectors or as a whole; else they are what the axis values make.
    pub pose: Option<Pose>,
}

/// Where the machine stands at a place of a move.
fn along(task: &Move, t: f64, near: &Joints) -> Result<LawStance, Unreachable> {
    if matches!(task.way, Interpolation::TipAndAxis | Interpolation::TipAndFrame(_)) {
        let Stance { joints, pose } = stance(task, t, near)?;
        return Ok(LawStance { joints, pose: Some(pose) });
    }
    joints(task, t, near).map(|joints| LawStance { joints, pose: None })
}

fn stance(task: &Move, t: f64, near: &Joints) -> Result<Stance, Unreachable> {
    task.way.stance_at(&task.solver, [&task.from, &task.to], t, near)
}

fn joints(task: &Move, t: f64, near: &Joints) -> Result<Joints, Unreachable> {
    task.way.joints_at(&task.solver, [&task.from, &task.to], t, near)
}

/// The axis values without what the first of two ways that meet at `corner` has yet to go.
fn less(joints: &Joints, first: &Joints, corner: &Stance) -> Joints {
    std::array::from_fn(|place| joints[place] - (first[place] - corner.joints[place]))
}

/// The axis values where two ways lead together that meet at `corner`, added axis by axis.
fn sum([first, second]: [&Joints; 2], corner: &Stance) -> Joints {
    std::array::from_fn(|place| first[place] + (second[place] - corner.joints[place]))
}

/// The axis values where two ways lead together that meet at `corner`: what is limited is added, the tip and the rotary
/// axes (`tip_led`) or all axes, so that velocities and accelerations add up as they were shared out.
fn added(
    solver: &Solver,
    [first, second]: [&Stance; 2],
    corner: &Stance,
    tip_led: bool,
) -> Result<Joints, Unreachable> {
    let mut joints = sum([&first.joints, &second.joints], corner);
    if tip_led {
        let turns = solver.chain().turns(&joints);
        let tip = first.pose.tip + (second.pose.tip - corner.pose.tip);
        solver.place(tip, &mut joints, &turns)?;
    }
    Ok(joints)
}
