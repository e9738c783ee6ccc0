//! A motion of the machine, as its control makes it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Pose, Trace};
use post_motion::path::{Curve, Interpolation, Stance, between, chords, turns};

use crate::MachineState;

/// Bounds on second derivatives along a motion, by its parameter.
struct Bend {
    /// Of the tip against the part, mm.
    tip: f64,
    /// Of the difference of a direction of the tool and its great circle.
    axis: f64,
}

/// A piece is looked at in so many places.
const LOOKS: u64 = 8;

/// More pieces than this are made of no motion.
const MOST_PIECES: f64 = 1e6;

/// A motion between two stances.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Line of the program.
    pub line: u64,
    /// Number of the block.
    pub number: Option<u64>,
    /// Rapid or at feed.
    pub kind: MotionKind,
    /// How the control goes from one end to the other.
    pub way: Interpolation,
    /// Where it begins.
    pub from: Stance,
    /// Where it ends.
    pub to: Stance,
    /// Feed of the tip against the part, mm/min, as the program states it; of a thread the pitch times the speed; zero
    /// for a rapid and where the program states none.
    pub feed: f64,
    /// F at which a rapid goes where G0 goes at F, mm/min, or degrees where rotary axes alone turn; zero elsewhere and where
    /// the program states none.
    pub rapid_feed: f64,
    /// How long it takes at the feed that the program states, minutes, no limit of any axis regarded; of a rapid at the
    /// axes' largest feeds, zero where the machine file names none.
    pub minutes: f64,
    /// How long it would take as fast as it is anywhere on its way: less than `minutes` where its feed is one a revolution
    /// and the control changes the speed of the spindle.
    pub minutes_at_fastest: f64,
    /// F says its time, and no feed: inverse time.
    pub by_time: bool,
    /// The axes stand still at its end, whatever else holds: G9.
    pub stops: bool,
    /// It is part of a cycle's hole.
    pub hole: bool,
    /// It is asked for in positions of the machine, not of the part (G53, G28, G30, M91, SUPA): where it leads says
    /// something about this machine alone.
    pub machine: bool,
    /// Axes of which the program has said before this block where they go, a bit by place: the others are taken to stand at
    /// zero where they have not moved.
    pub led: u32,
    /// At feed, and as fast as a rapid of a machine whose rapids may stand so ([`crate::FedRapids`]).
    pub fast: bool,
    /// Whether the word that goes with the way of the tip in cuts (`[word.E]`) goes along at feed; none where the machine has
    /// no such word, and where the way is too short to tell.
    pub along: Option<bool>,
    /// What holds while it goes on.
    pub state: Arc<MachineState>,
}

/// Rapid or at feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// At rapid traverse.
    Rapid,
    /// At feed.
    Feed,
    /// At feed, the axis tied to the spindle.
    Thread,
}

impl Motion {
    /// Tip and tool axis at `t` from 0 to 1 of the motion's own parameter (time, at constant feed), as the control and the
    /// chain make them.
    pub fn at(&self, t: f64) -> Pose {
        self.way.at(self.state.solver.chain(), [&self.from, &self.to], t)
    }

    /// Some rotary axis turns on the way.
    pub fn turns(&self) -> bool {
        turns(self.state.solver.chain(), [&self.from, &self.to])
    }

    /// Pieces that the motion is cut into, evenly in `t`, so that straight lines of the tip and great circles of the tool
    /// axis between their ends stay within `chord` mm and `angle` radians of it; of arcs and splines, whose tip is on no
    /// straight line, the tool axis alone counts.
    ///
    /// What strays is zero at both ends of a piece. Between two places where it was looked at it is larger than there by no
    /// more than an eighth of its second derivative over the square of their distance, and that is bounded.
    pub fn pieces(&self, chord: f64, angle: f64) -> u64 {
        if self.way == Interpolation::TipAndAxis || !self.turns() {
            return 1;
        }
        if self.bends_little(chord, angle) {
            return 1;
        }
        let bend = match self.way {
            // Neither the axis nor its great circle bends more than the tool turns.
            Interpolation::TipAndFrame(turn) => Bend { tip: 0.0, axis: 2.0 * turn.norm_squared() },
            _ => self.bend(),
        };
        // The chord over the whole of a piece, looked at nowhere.
        let blind = libm::sqrt((bend.tip / (8.0 * chord)).max(bend.axis / (8.0 * angle)));
        let blind = libm::ceil(blind).clamp(1.0, MOST_PIECES) as u64;
        let mut count = 1;
        while count < blind {
            let between = (count * LOOKS) as f64;
            let unseen = |bend: f64| bend / (8.0 * between * between);
            let (tip, turn) = self.strays(count);
            let tip = (tip + unseen(bend.tip)) / chord;
            let turn = (turn + unseen(bend.axis)) / angle;
            let share = tip.max(turn);
            if share <= 1.0 {
                break;
            }
            let wanted = libm::ceil(count as f64 * libm::sqrt(share)).min(MOST_PIECES);
            count = (wanted as u64).max(count + 1).min(blind);
        }
        count
    }

    /// Whether one piece is enough, as turns and arms alone tell, with room for what is closer to them in
    /// [`Motion::bend`].
    fn bends_little(&self, chord: f64, angle: f64) -> bool {
        const ROOM: f64 = 0.9;
        const TURN: f64 = 0.1;
        let chain = self.state.solver.chain();
        let turn = |place: usize| libm::fabs(self.to.joints[place] - self.from.joints[place]);
        let axes = chain.joints().iter().enumerate().filter(|(_, axis)| axis.rotary);
        let all: f64 = axes.map(|(place, _)| turn(place)).sum();
        all < TURN
            && 2.0 * all * all <= ROOM * 8.0 * angle
            && (self.way != Interpolation::Axes
                || chain.bend_by_arms([&self.from.joints, &self.to.joints]) <= ROOM * 8.0 * chord)
    }

    /// How far the motion strays at most from straight lines and great circles of `count` pieces of it, where it is looked
    /// at: mm, and of unit vectors.
    fn strays(&self, count: u64) -> (f64, f64) {
        let straight = self.way == Interpolation::Axes;
        let mut worst: (f64, f64) = (0.0, 0.0);
        let mut from = self.at(0.0);
        for piece in 0..count {
            let at = |look: u64| self.at((piece * LOOKS + look) as f64 / (count * LOOKS) as f64);
            let to = at(LOOKS);
            for look in 1..LOOKS {
                let share = look as f64 / LOOKS as f64;
                let pose = at(look);
                if straight {
                    let chord = from.tip + (to.tip - from.tip) * share;
                    worst.0 = worst.0.max((pose.tip - chord).norm());
                }
                worst.1 = worst.1.max((pose.axis - between(from.axis, to.axis, share)).norm());
                if pose.edge != Vector3::zeros() {
                    worst.1 = worst.1.max((pose.edge - between(from.edge, to.edge, share)).norm());
                }
            }
            from = to;
        }
        worst
    }

    /// Bounds on how the tip and the directions of the tool bend on the way.
    fn bend(&self) -> Bend {
        let chain = self.state.solver.chain();
        let axes = chain.joints();
        let turn = |place: usize| libm::fabs(self.to.joints[place] - self.from.joints[place]);
        let ends = [&self.from.joints, &self.to.joints].map(|joints| {
            let mut trace =
                Trace { joints: *joints, turns: chain.turns(joints), ..Trace::default() };
            chain.trace(&mut trace);
            trace
        });
        let rotary = || (0..axes.len()).filter(|place| axes[*place].rotary);
        // An axis that turns about the tool leaves it pointing where it did; an edge turns all the same.
        let points = |place: usize| {
            let across = axes[place].direction.cross(&ends[0].axes[place]);
            turn(place) > 0.0 && (across.norm() > 1e-12 || chain.edge().is_some())
        };
        let all: f64 = rotary().map(turn).sum();
        let mut bend = Bend {
            tip: 0.0,
            // That of the axis is at most the square of all turns together, and that of the great circle no larger.
            axis: match rotary().any(points) {
                true => 2.0 * all * all,
                false => 0.0,
            },
        };
        if self.way == Interpolation::Axes {
            // Joint by joint from the tool to the part: a turn by w over an arm r of speed s and bend b makes the bend
            // w²·r + 2·w·s + b and the speed w·r + s; an arm is never longer than at its ends but for an eighth of its
            // bend.
            let mut speed = 0.0;
            for place in (0..axes.len()).rev() {
                let w = turn(place);
                if !axes[place].rotary {
                    speed += w;
                    continue;
                }
                let [first, last] = ends.each_ref().map(|trace| trace.tip_rates[place].norm());
                let arm = first.max(last) + bend.tip / 8.0;
                bend.tip += w * (w * arm + 2.0 * speed);
                speed += w * arm;
            }
        }
        bend
    }

    /// Pieces whose chords stay within `chord` mm of a spline, as far as points on it tell: doubled until the middles of
    /// all agree.
    pub(crate) fn spline_chords(&self, chord: f64) -> u64 {
        let Curve::Spline(way) = self.way.curve() else {
            return 1;
        };
        chords(2 * way.poles.len() as u64, MOST_PIECES as u64, chord, |t| way.at(t))
    }
}
