//! Cuts a run of CL points into blocks within tolerance.
//!
//! The model proposes, the certificate disposes: where it finds more than the model promised, further points go in,
//! unless the user trusts the model.

use post_plugin::{Curve, ModelSession};

use super::bound::DeviationBound;
use super::certificate::DerivativeBound;
use super::deviation::{MoveTolerances, NodeMove};
use super::node::{PathNode, PlacementError};
use super::run::NodeRun;
use post_machine::description::{AccuracyRules, Method, Placement};

/// A block within tolerance.
#[derive(Clone, Copy, Debug)]
pub struct LinearPiece {
    /// Where it ends; it begins where the one before it ends. Its `t` is the share of its leg.
    pub to: PathNode,
    /// The leg of the run that it ends in.
    pub leg: usize,
    /// Bounds on its deviation.
    pub bound: DeviationBound,
}

/// Why a move cannot be brought within tolerance.
#[derive(Clone, Debug, PartialEq)]
pub enum LineariseError {
    /// A point put in has no node.
    Refused(PlacementError),
    /// The words' decimals alone are too coarse.
    Rounding {
        /// Error of the tip that rounding makes, mm.
        tip: f64,
        /// Error of the tool axis, radians.
        axis: f64,
        /// What the move must keep, which a plan or an error model may have made less.
        allowed: MoveTolerances,
    },
    /// The axes jump: pieces of a millionth of the move are still over.
    Jump {
        /// The joint that turns farthest.
        joint: usize,
        /// Value that it turns from, radians.
        from: f64,
        /// Value that it turns to, radians.
        to: f64,
    },
    /// The model cannot answer.
    Model(String),
}

/// Cuts runs into blocks.
#[derive(Debug, Default)]
pub struct Lineariser {
    pub(super) method: Method,
    pub(super) points: u32,
    placement: Placement,
    pub(super) trust_model: bool,
    pub(super) overruled: u64,
    asked: u64,
    pieces: Vec<LinearPiece>,
    /// The leg that is being cut.
    leg: usize,
    /// Nodes yet to be reached, the next on top.
    pub(super) stack: Vec<PathNode>,
    /// Way of the tip from the start of the run to each of its nodes, mm.
    pub(super) way: Vec<f64>,
}

/// What model and certificate say of a piece.
pub(super) struct PieceAssessment {
    /// Both are content, or the certificate needs no model.
    pub good: bool,
    /// What is proven.
    pub bound: DeviationBound,
    /// The model's answer, if it was asked.
    pub curve: Option<Curve>,
    /// The peaks of the model's curve, the cutting edge's own share added.
    pub peak: DeviationBound,
}

impl Lineariser {
    /// Works as the machine file says. With `trust_model` the certificate only reports.
    pub fn new(accuracy: &AccuracyRules, trust_model: bool) -> Self {
        let mut linearise = Self { trust_model, ..Self::default() };
        linearise.set(accuracy);
        linearise
    }

    /// Works as another head's part of the machine file says.
    pub(crate) fn set(&mut self, accuracy: &AccuracyRules) {
        self.method = accuracy.method;
        self.points = accuracy.points;
        self.placement = accuracy.placement;
    }

    /// How often the certificate found more than the model promised, and points went in for it.
    pub fn overruled(&self) -> u64 {
        self.overruled
    }

    /// How often the model was asked for the deviation of a piece.
    pub fn asked(&self) -> u64 {
        self.asked
    }

    /// The blocks of the last run that was split, in order.
    pub fn pieces(&self) -> &[LinearPiece] {
        &self.pieces
    }

    /// Cuts a run into blocks: see [`Lineariser::pieces`].
    ///
    /// # Errors
    /// Why it cannot be done, and in which leg.
    pub fn split(
        &mut self,
        run: &NodeRun<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(), (usize, LineariseError)> {
        self.pieces.clear();
        run.measure(&mut self.way);
        let fewest = self.method == Method::Linearise && self.placement == Placement::Fewest;
        if fewest && run.legs() > 1 {
            // Points that were put in as far off as they could be may have left no way on (through a pole).
            let across = self.stride(run, 0, run.legs(), model).is_ok();
            let pieces = std::mem::take(&mut self.pieces);
            let kept = self.point_to_point(run, model);
            if across && (kept.is_err() || self.pieces.len() > pieces.len()) {
                self.pieces = pieces;
                return Ok(());
            }
            return kept;
        }
        self.point_to_point(run, model)
    }

    /// Blocks from CL point to CL point, as long as they can be; points go into the legs that need them.
    fn point_to_point(
        &mut self,
        run: &NodeRun<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(), (usize, LineariseError)> {
        let mut at = 0;
        while at < run.legs() {
            if let Some((reach, bound)) = run.farthest(at, run.legs(), &self.way) {
                self.leg = reach - 1;
                self.keep(run.end(reach), bound);
                at = reach;
                continue;
            }
            self.leg = at;
            self.cut_leg(run, at, model).map_err(|stuck| (at, stuck))?;
            at += 1;
        }
        Ok(())
    }

    /// Puts points into a leg, as method and placement say; where they do not serve, by bisection, which knows what
    /// to do close to a pole.
    fn cut_leg(
        &mut self,
        run: &NodeRun<'_>,
        at: usize,
        model: &mut dyn ModelSession,
    ) -> Result<(), LineariseError> {
        let start = run.start(at);
        let leg = run.leg(&start, at);
        let before = self.count();
        let done = match (self.method, self.placement) {
            (Method::Linearise, Placement::Bisect) => false,
            (Method::Linearise, Placement::Fewest) => self.stride(run, at, at + 1, model).is_ok(),
            _ => {
                let judged = self.judge(&leg, model)?;
                if judged.good {
                    self.keep(*leg.to, judged.bound);
                    return Ok(());
                }
                match self.method {
                    Method::Compensate => self.compensate(&leg, &judged, model),
                    Method::Linearise => self.even(&leg, &judged),
                }
            }
        };
        if done {
            return Ok(());
        }
        self.take_back(before);
        self.leg = at;
        self.halve(&leg, model)
    }

    /// Sets the leg that pieces end in from here on.
    pub(super) fn enter(&mut self, leg: usize) {
        self.leg = leg;
    }

    /// A piece is good.
    pub(super) fn keep(&mut self, to: PathNode, bound: DeviationBound) {
        self.pieces.push(LinearPiece { to, leg: self.leg, bound });
    }

    /// Keeps the first `count` pieces, and takes the others back.
    pub(super) fn take_back(&mut self, count: usize) {
        self.pieces.truncate(count);
    }

    /// Pieces so far.
    pub(super) fn count(&self) -> usize {
        self.pieces.len()
    }

    /// Is a piece within tolerance?
    pub(super) fn judge(
        &mut self,
        piece: &NodeMove<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<PieceAssessment, LineariseError> {
        self.judge_measured(piece, piece.course(piece.quick()), model)
    }

    /// [`Lineariser::judge`] with the tightest bound that needs no samples, and its bend, at hand.
    pub(super) fn judge_measured(
        &mut self,
        piece: &NodeMove<'_>,
        (bound, bend): (DeviationBound, DerivativeBound),
        model: &mut dyn ModelSession,
    ) -> Result<PieceAssessment, LineariseError> {
        let tolerances = piece.tolerances;
        if tolerances.hold(bound) {
            return Ok(PieceAssessment {
                good: true,
                bound,
                curve: None,
                peak: DeviationBound::default(),
            });
        }
        self.asked += 1;
        let curve = piece.fit(model).map_err(LineariseError::Model)?;
        let peak = DeviationBound {
            tip: curve.tip_peak + piece.edge_bow(bend),
            axis: curve.axis_peak.to_radians(),
        };
        let content = tolerances.hold(peak);
        let bound = piece.looked_at((bound, bend));
        let sure = tolerances.hold(bound);
        if content && !sure && !self.trust_model {
            self.overruled += 1;
        }
        // A model that sees more than the certificate proves is wrong on the safe side: points go in.
        Ok(PieceAssessment {
            good: content && (sure || (self.trust_model && !piece.goes_another_way())),
            bound,
            curve: Some(curve),
            peak,
        })
    }
}
