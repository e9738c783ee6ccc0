//! Single moves, kept for a closer look.

use std::ops::Range;

use nalgebra::Vector3;
use post_plugin::{Curve, ModelSession};

use super::curve::{Peak, peak};
use super::placed::{each, split, strays};
use super::survey::placing;
use post_machine::description::{Machine, Placement};
use post_machine::kinematics::Joints;
use post_posting::Observer;
use post_posting::accuracy::{
    LineariseError, Lineariser, MoveTolerances, NodeMove, PathNode, Placer,
};

/// A move with all that it needs.
#[derive(Clone, Debug)]
pub struct KeptMove {
    /// Its number among the cuts of the file, counted from 0.
    pub number: usize,
    placer: Placer,
    from: PathNode,
    to: PathNode,
    tolerances: MoveTolerances,
    control_keeps_tip: bool,
    straight: Option<f64>,
}

/// The deviation over a piece of a move.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviationPiece {
    /// Shares of the move and deviation there, mm, part frame.
    pub samples: Vec<(f64, Vector3<f64>)>,
}

/// Keeps some moves, and the largest deviation of all.
#[derive(Debug)]
pub struct Keeper {
    wanted: Range<usize>,
    /// The moves, in order.
    pub kept: Vec<KeptMove>,
    /// The largest deviation of every move, mm.
    pub peaks: Vec<f64>,
}

impl Keeper {
    /// Keeps the moves with these numbers.
    pub fn new(wanted: Range<usize>) -> Self {
        Self { wanted, kept: Vec::new(), peaks: Vec::new() }
    }
}

impl Observer for Keeper {
    fn cut(&mut self, _: u64, cut: &NodeMove<'_>) {
        let number = self.peaks.len();
        self.peaks.push(peak(|t| strays(cut, t).norm()).size);
        if self.wanted.contains(&number) {
            self.kept.push(KeptMove {
                number,
                placer: cut.placer.clone(),
                from: *cut.from,
                to: *cut.to,
                tolerances: cut.tolerances,
                control_keeps_tip: cut.control_keeps_tip,
                straight: cut.straight,
            });
        }
    }
}

impl KeptMove {
    fn cut(&self) -> NodeMove<'_> {
        NodeMove {
            placer: &self.placer,
            from: &self.from,
            to: &self.to,
            tolerances: self.tolerances,
            control_keeps_tip: self.control_keeps_tip,
            straight: self.straight,
        }
    }

    /// Way along its chord, mm.
    pub fn length(&self) -> f64 {
        (self.to.target.tip - self.from.target.tip).norm()
    }

    /// Where the control point should be at the share `t`, mm, part frame.
    pub fn target(&self, t: f64) -> Vector3<f64> {
        self.cut().target(t).tip
    }

    /// Deviation at the share `t`, mm, part frame.
    pub fn deviation(&self, t: f64) -> Vector3<f64> {
        strays(&self.cut(), t)
    }

    /// The largest deviation, mm.
    pub fn peak(&self) -> Peak {
        peak(|t| self.deviation(t).norm())
    }

    /// Axis values at both ends, mm or radians.
    pub fn joints(&self) -> [&Joints; 2] {
        [&self.from.trace.joints, &self.to.trace.joints]
    }

    /// The chain that it is made on.
    pub fn chain(&self) -> &post_machine::kinematics::Chain {
        self.placer.solver().chain()
    }

    /// The curve that a model fits to it.
    ///
    /// # Errors
    /// Why it cannot.
    pub fn fit(&self, model: &mut dyn ModelSession) -> Result<Curve, String> {
        self.cut().fit(model)
    }

    /// The deviation with nothing done about it, in `pieces` even pieces.
    pub fn raw(&self, pieces: u32) -> DeviationPiece {
        DeviationPiece::of(&self.cut(), [0.0, 1.0], pieces)
    }

    /// The deviation of each piece after a placement, in `pieces` even pieces each.
    ///
    /// # Errors
    /// Why it cannot be done.
    pub fn placed(
        &self,
        machine: &Machine,
        placement: Placement,
        model: &mut dyn ModelSession,
        pieces: u32,
    ) -> Result<Vec<DeviationPiece>, LineariseError> {
        let accuracy = placing(&machine.accuracy, placement);
        self.split(Lineariser::new(&accuracy, false), model, pieces)
    }

    fn split(
        &self,
        mut linearise: Lineariser,
        model: &mut dyn ModelSession,
        pieces: u32,
    ) -> Result<Vec<DeviationPiece>, LineariseError> {
        let cut = self.cut();
        split(&cut, &[self.from, self.to], &mut linearise, model)?;
        let mut stretches = Vec::new();
        each(&cut, linearise.pieces(), |block, _| {
            let ends = [block.from.t, block.to.t];
            stretches.push(DeviationPiece::of(block, ends, pieces));
        });
        Ok(stretches)
    }
}

impl DeviationPiece {
    /// A block between two shares of its move.
    fn of(block: &NodeMove<'_>, [from, to]: [f64; 2], pieces: u32) -> Self {
        let samples = (0..=pieces).map(|step| {
            let t = f64::from(step) / f64::from(pieces);
            (from * (1.0 - t) + to * t, strays(block, t))
        });
        Self { samples: samples.collect() }
    }
}
