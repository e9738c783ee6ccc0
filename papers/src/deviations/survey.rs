//! Every move of a file, one row each.

use nalgebra::Vector3;
use post_plugin::ModelSession;

use super::curve::{Peak, explained, peak};
use super::edge::Rim;
use super::placed::{Placed, place, strays};
use post_machine::description::{AccuracyRules, Machine, Method, Placement};
use post_posting::Observer;
use post_posting::accuracy::{Lineariser, NodeMove};

/// One move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MoveRow {
    /// Line of the CL file.
    pub line: u64,
    /// Way of the control point along its chord, mm.
    pub length: f64,
    /// Root of the sum of squares of the rotary moves, radians.
    pub turn: f64,
    /// Deviation of the control point with nothing done about it, mm, at the printed ends.
    pub raw: Peak,
    /// Largest deviation of any point of the cutting edge, mm; none if the machine file names no radius.
    pub edge: Option<f64>,
    /// Largest deviation of the tool axis, radians, likewise.
    pub axis: f64,
    /// What each model makes of it, in the order of [`CutSurvey::new`].
    pub models: Box<[Modelled]>,
    /// After each placement, in the order of [`CutSurvey::PLACEMENTS`]; none where it cannot be done.
    pub placed: Box<[Option<Placed>]>,
}

/// One move as a model sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Modelled {
    /// The peak that it predicts, mm, and where.
    pub peak: Peak,
    /// The largest distance between deviation and model curve, mm.
    pub residual: f64,
    /// R² of the curve's length; none where nothing deviates.
    pub explained: Option<f64>,
    /// After compensation with this model, if its predicted peak is over tolerance; none where it cannot be done.
    pub compensated: Option<Placed>,
}

/// Looks at every cut of a file.
pub struct CutSurvey<'a> {
    /// The machine's own model, which placements ask.
    own: &'a mut dyn ModelSession,
    models: Vec<&'a mut dyn ModelSession>,
    placements: [Lineariser; 3],
    compensate: Lineariser,
    rotary: Vec<usize>,
    /// Tool axis with all axes at zero, and radius of the cutting edge, mm.
    tool: (Vector3<f64>, f64),
    /// One row a move, in order.
    pub rows: Vec<MoveRow>,
    /// Largest deviation of every piece after each placement, mm.
    pub pieces: [Vec<f64>; 3],
    /// Largest deviation of every piece after compensation with each model, mm.
    pub compensated: Vec<Vec<f64>>,
    /// Why a model could not answer, the first time.
    pub fault: Option<String>,
}

impl<'a> CutSurvey<'a> {
    /// The placements that are compared, without leaving out CL points.
    pub const PLACEMENTS: [Placement; 3] = [Placement::Bisect, Placement::Even, Placement::Fewest];

    /// On a machine, with the machine's `own` error model and `models` to compare.
    pub fn new(
        machine: &Machine,
        own: &'a mut dyn ModelSession,
        models: Vec<&'a mut dyn ModelSession>,
    ) -> Self {
        let axes = machine.axes.iter().enumerate();
        Self {
            own,
            placements: Self::PLACEMENTS
                .map(|placement| Lineariser::new(&placing(&machine.accuracy, placement), false)),
            compensate: Lineariser::new(&compensating(&machine.accuracy), true),
            rotary: axes.filter(|(_, axis)| axis.joint.rotary).map(|(joint, _)| joint).collect(),
            tool: (machine.tool_axis, machine.control_point.radius),
            rows: Vec::new(),
            pieces: Default::default(),
            compensated: vec![Vec::new(); models.len()],
            models,
            fault: None,
        }
    }

    fn model(&mut self, index: usize, cut: &NodeMove<'_>) -> Result<Modelled, String> {
        let model = &mut *self.models[index];
        let curve = cut.fit(model)?;
        let value = |t: f64| Vector3::from(model.value(&curve, t).tip);
        let modelled = Modelled {
            peak: Peak { size: curve.tip_peak, at: curve.tip_at },
            residual: peak(|t| (strays(cut, t) - value(t)).norm()).size,
            explained: explained(|t| strays(cut, t).norm(), |t| value(t).norm()),
            compensated: None,
        };
        if let Some(fault) = model.fault() {
            return Err(fault);
        }
        let pieces = &mut self.compensated[index];
        let before = pieces.len();
        let compensated = place(cut, &mut self.compensate, model, pieces).ok();
        if compensated.is_none() {
            pieces.truncate(before);
        }
        Ok(Modelled { compensated, ..modelled })
    }
}

impl Observer for CutSurvey<'_> {
    fn cut(&mut self, line: u64, cut: &NodeMove<'_>) {
        let (first, last) = (&cut.from.trace.joints, &cut.to.trace.joints);
        let turns = self.rotary.iter().map(|joint| last[*joint] - first[*joint]);
        // A sum of nothing would be -0.
        let turn = libm::sqrt(turns.fold(0.0, |sum, turn| sum + turn * turn));
        let raw = peak(|t| strays(cut, t).norm());
        let axis = peak(|t| Vector3::from(cut.deviation(t).axis).norm().to_radians()).size;
        let (tool_axis, radius) = self.tool;
        let edge = (radius > 0.0).then(|| {
            let rim = Rim::new(cut.placer.solver().chain(), tool_axis);
            rim.strays(radius, (first, last), |t| strays(cut, t)).size
        });
        let mut models = Vec::with_capacity(self.models.len());
        for index in 0..self.models.len() {
            models.push(self.model(index, cut).unwrap_or_else(|fault| {
                self.fault.get_or_insert(fault);
                Modelled::default()
            }));
        }
        let (linearise, own) = (&mut self.placements, &mut *self.own);
        let placed = linearise
            .iter_mut()
            .zip(&mut self.pieces)
            .map(|(linearise, pieces)| place(cut, linearise, own, pieces).ok())
            .collect();
        self.rows.push(MoveRow {
            line,
            length: (cut.to.target.tip - cut.from.target.tip).norm(),
            turn,
            raw,
            edge,
            axis,
            models: models.into(),
            placed,
        });
    }
}

/// Points on the exact solution, and no CL point left out.
pub(super) fn placing(accuracy: &AccuracyRules, placement: Placement) -> AccuracyRules {
    AccuracyRules { method: Method::Linearise, placement, reduce: false, ..accuracy.clone() }
}

/// Points on the straight line of the axes, moved by minus the model's curve.
pub(super) fn compensating(accuracy: &AccuracyRules) -> AccuracyRules {
    AccuracyRules { method: Method::Compensate, reduce: false, ..accuracy.clone() }
}
