//! A path as the planner sees it: where tip and axes are at a parameter, and their derivatives by it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_feed::Samples;
use post_job::plan::gauges::Station;
use post_machine::axis_words;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::kinematics::choose::{RotaryAxes, RotaryTravel};
use post_machine::kinematics::{
    JointDerivatives, Joints, Pose, Solver, Unreachable, direction, travel,
};
use post_motion::path::BSpline;
use post_posting::plan::SampledAxes;

use super::file::{Pointing, Splines};
use super::parts::{SplinePart, smooth_parts};
use super::track::{self, SmoothPiece, Track};

/// A path on a machine: stretches whose first and second derivatives are continuous; between two of them it stops.
pub struct CurvePath<'m> {
    pub machine: &'m Machine,
    /// The chain with the tool.
    pub solver: Arc<Solver>,
    /// The axes that are limited.
    sampled: SampledAxes,
    /// Joints that point the tool.
    rotary: Vec<usize>,
    turning: RotaryAxes,
    /// Places in the chain of the axes that are planned, in the order of their words.
    pub axes: Vec<usize>,
    pub stretches: Vec<CurveStretch>,
}

/// A stretch between two stops.
pub struct CurveStretch {
    pub tip: Track<3>,
    /// The ends of the blocks that a control would have: knots, or the points that the file gives.
    blocks: Vec<f64>,
    pointing: CurvePointing,
    /// Rotary angles at parameters along it: between them they are the nearest.
    guides: Vec<(f64, Joints)>,
}

impl CurveStretch {
    /// Length of the block at a parameter.
    fn block(&self, parameter: f64) -> f64 {
        let last = self.blocks.len() - 1;
        let before = self.blocks[1..last].partition_point(|end| *end <= parameter);
        self.blocks[before + 1] - self.blocks[before]
    }
}

/// How the tool points along a stretch.
enum CurvePointing {
    Fixed,
    Second(BSpline<3>),
    Axis(BSpline<3>),
    Rotary(Vec<(usize, Track<1>)>),
}

/// Why the axes are nowhere at a parameter.
#[derive(Debug)]
pub enum NoStation {
    /// The tool axis is null.
    NoAxis,
    /// The axes cannot follow.
    Unreachable(Unreachable),
    /// An axis is outside its travel.
    Over(travel::OverTravel),
}

impl<'m> CurvePath<'m> {
    /// The axes of `machine` with a tool of `length` mm, and no path yet; `plane`: it will stay in one parallel to XY.
    fn on(machine: &'m Machine, length: f64, plane: bool) -> Result<Self, Box<Diagnostic>> {
        let solver = machine.solver(length);
        let solver = solver.map_err(|lack| machine.unsolvable(&lack).boxed())?;
        let rotary = machine.pointing();
        let mut turning = RotaryAxes::default();
        for joint in &rotary {
            match machine.axes[*joint].travel {
                Some(travel) => turning.limits.push(RotaryTravel { joint: *joint, travel }),
                None => turning.cyclic.push(*joint),
            }
        }
        if rotary.len() > 2 {
            let message =
                format!("{} rotary axes of {} point the tool", rotary.len(), machine.name);
            let help = "a curve is planned on machines with up to two; indexed = 0 holds one";
            return Err(Diagnostic::error("curve", message).help(help).boxed());
        }
        let mut axes = axis_words::order(machine);
        axes.retain(|place| {
            let axis = &machine.axes[*place];
            // What never moves is not told of.
            let across = plane && rotary.is_empty() && axis.joint.direction.z.abs() > 1e-9;
            axis.indexed.is_none() && !across && (!axis.joint.rotary || rotary.contains(place))
        });
        let (solver, sampled) = (Arc::new(solver), SampledAxes::new(machine));
        Ok(Self { machine, solver, sampled, rotary, turning, axes, stretches: Vec::new() })
    }

    /// The path of `splines` on `machine` with a tool of `length` mm.
    ///
    /// # Errors
    /// The machine has not the axes that the path needs.
    pub fn new(
        machine: &'m Machine,
        length: f64,
        splines: &Splines,
    ) -> Result<Self, Box<Diagnostic>> {
        let mut path = Self::on(machine, length, splines.plane)?;
        for part in smooth_parts(splines) {
            let stretch = path.stretch(splines, part)?;
            path.stretches.push(stretch);
        }
        Ok(path)
    }

    /// The path through points, with a tool axis at each or none, on `machine` with a tool of `length` mm; `file` is its
    /// name in messages.
    ///
    /// # Errors
    /// Where the axes cannot go, or there is no way at all.
    pub fn through(
        machine: &'m Machine,
        length: f64,
        points: &[[f64; 3]],
        axes: Option<&[[f64; 3]]>,
        file: &str,
    ) -> Result<Self, Box<Diagnostic>> {
        let plane = points.iter().all(|point| point[2] == points[0][2]);
        let mut path = Self::on(machine, length, plane)?;
        let mut last = machine.solution.start;
        let mut given = Vec::with_capacity(points.len());
        for (place, tip) in points.iter().enumerate() {
            let axis = axes.map_or(Vector3::z(), |axes| axes[place].into());
            let turned = path.turned((*tip).into(), axis, &last);
            let joints = turned.map_err(|why| {
                let finding = path.refused(file, place as f64, &why);
                let message = finding.message.replace("at parameter", "at point");
                Diagnostic { message, ..finding }.boxed()
            })?;
            let mut point = [0.0; post_feed::fit::MOST];
            point[..3].copy_from_slice(tip);
            for (value, place) in point[3..].iter_mut().zip(&path.rotary) {
                *value = joints[*place];
            }
            given.push(point);
            last = joints;
        }
        let pieces = track::through(&given, path.rotary.len(), machine.plan.smoothing);
        if pieces.is_empty() {
            let message = format!("{file}: all points are the same");
            return Err(Diagnostic::error("curve", message).boxed());
        }
        for SmoothPiece { tip, rotary, points } in pieces {
            let rotary = path.rotary.iter().copied().zip(rotary);
            let curves = rotary.map(|(place, pieces)| (place, Track::Pieces(pieces)));
            path.stretches.push(CurveStretch {
                tip: Track::Pieces(tip),
                blocks: points,
                pointing: CurvePointing::Rotary(curves.collect()),
                guides: Vec::new(),
            });
        }
        Ok(path)
    }

    /// The control points of `part`.
    fn stretch(
        &self,
        splines: &Splines,
        part: SplinePart,
    ) -> Result<CurveStretch, Box<Diagnostic>> {
        let pointing = match &splines.pointing {
            Pointing::Fixed => CurvePointing::Fixed,
            Pointing::Second(points) => CurvePointing::Second(part.curve(splines, points)),
            Pointing::Axis(vectors) => CurvePointing::Axis(part.curve(splines, vectors)),
            Pointing::Rotary(axes) => {
                let mut curves = Vec::new();
                for (name, values) in axes {
                    let axis = self.machine.axes.iter().position(|axis| axis.name == *name);
                    let axis = axis.filter(|place| self.rotary.contains(place));
                    let Some(place) = axis else {
                        let message = format!(
                            "{} has no rotary axis {name} that moves in cuts",
                            self.machine.name
                        );
                        return Err(Diagnostic::error("curve", message).boxed());
                    };
                    let values: Vec<[f64; 1]> = values.iter().map(|value| [*value]).collect();
                    curves.push((place, Track::Spline(part.unweighted(splines, &values))));
                }
                CurvePointing::Rotary(curves)
            }
        };
        let tip = Track::Spline(part.curve(splines, &splines.tip));
        Ok(CurveStretch { blocks: tip.breaks(), tip, pointing, guides: Vec::new() })
    }

    /// Finds the rotary angles along a stretch at these parameters, each near the last.
    ///
    /// # Errors
    /// Where the axes cannot go.
    pub fn guide(&mut self, index: usize, parameters: &[f64]) -> Result<(), (f64, NoStation)> {
        let mut last = match index {
            0 => self.machine.solution.start,
            _ => {
                let before = self.stretches[index - 1].guides.last();
                before.map_or(self.machine.solution.start, |(_, joints)| *joints)
            }
        };
        self.stretches[index].guides.clear();
        let mut guides = Vec::with_capacity(parameters.len());
        for &parameter in parameters {
            let found = self.near(&self.stretches[index], parameter, &last);
            let station = found.map_err(|why| (parameter, why))?;
            last = station.course.joints[0];
            for (place, axis) in self.machine.axes.iter().enumerate() {
                if let Some(limit) = travel::passed(axis.travel, last[place], travel::AT_END) {
                    let over = travel::OverTravel { joint: place, value: last[place], limit };
                    return Err((parameter, NoStation::Over(over)));
                }
            }
            guides.push((parameter, last));
        }
        self.stretches[index].guides = guides;
        Ok(())
    }

    /// Where the path is at a parameter of a stretch that [`CurvePath::guide`] has been along.
    ///
    /// # Errors
    /// The axes cannot follow there.
    pub fn at(&self, index: usize, parameter: f64) -> Result<Station, NoStation> {
        let stretch = &self.stretches[index];
        let after = stretch.guides.partition_point(|(at, _)| *at <= parameter);
        let guide = stretch.guides.get(after.saturating_sub(1));
        let last = guide.map_or(self.machine.solution.start, |(_, joints)| *joints);
        self.near(stretch, parameter, &last)
    }

    /// The rotary angles that point the tool along `axis`, nearest to `last`.
    fn turned(
        &self,
        tip: Vector3<f64>,
        axis: Vector3<f64>,
        last: &Joints,
    ) -> Result<Joints, NoStation> {
        let pose = Pose { tip, axis, edge: Vector3::zeros() };
        let tolerance = self.machine.accuracy.axis_tolerance;
        let branches = self.solver.orient(&pose, tolerance);
        let branches = branches.map_err(NoStation::Unreachable)?;
        let choice = self.turning.nearest(&self.solver, &branches, last, 0);
        choice.joints.map_err(NoStation::Over)
    }

    fn near(
        &self,
        stretch: &CurveStretch,
        parameter: f64,
        last: &Joints,
    ) -> Result<Station, NoStation> {
        let tip = stretch.tip.derivatives(parameter);
        let vectors = tip.map(Vector3::from);
        let mut course = JointDerivatives::default();
        course.joints[0] = *self.solver.held();
        match &stretch.pointing {
            CurvePointing::Rotary(curves) => {
                for (place, curve) in curves {
                    for (order, [value]) in curve.derivatives(parameter).into_iter().enumerate() {
                        course.joints[order][*place] = value;
                    }
                }
            }
            pointing => {
                let along = match pointing {
                    CurvePointing::Second(curve) => {
                        let second = curve.derivatives(parameter);
                        std::array::from_fn(|order| second[order] - vectors[order])
                    }
                    CurvePointing::Axis(curve) => curve.derivatives(parameter),
                    _ => [Vector3::z(), Vector3::zeros(), Vector3::zeros(), Vector3::zeros()],
                };
                let axis = direction(&along).ok_or(NoStation::NoAxis)?;
                let joints = self.turned(vectors[0], axis[0], last)?;
                for place in &self.rotary {
                    course.joints[0][*place] = joints[*place];
                }
                let moves = axis[1..].iter().any(|vector| vector.norm() > 0.0);
                if moves {
                    let followed = self.solver.turn_along(&self.rotary, &axis, &mut course);
                    followed.map_err(NoStation::Unreachable)?;
                }
            }
        }
        let placed = self.solver.course(&vectors, &mut course);
        placed.map_err(NoStation::Unreachable)?;
        Ok(Station { parameter, tip, course, block: stretch.block(parameter) })
    }

    /// The samples of a stretch at these parameters, with the largest feed of the tip, mm/s.
    ///
    /// # Errors
    /// Where the axes cannot follow.
    pub fn samples(
        &self,
        index: usize,
        parameters: &[f64],
        feed: f64,
    ) -> Result<Samples, (f64, NoStation)> {
        let mut samples = Samples {
            // Curves through points are quintics; a spline may be of any degree.
            smooth: matches!(self.stretches[index].tip, Track::Pieces(_)),
            ..Samples::default()
        };
        for &parameter in parameters {
            let station = self.at(index, parameter).map_err(|why| (parameter, why))?;
            self.sampled.push(&mut samples, parameter, &station.tip, &station.course);
            samples.feeds.push(feed);
            samples.blocks.push(station.block);
        }
        Ok(samples)
    }

    /// What is said where the axes are nowhere.
    pub fn refused(&self, file: &str, parameter: f64, why: &NoStation) -> Diagnostic {
        let at = format!("{file}: at parameter {}", Short(parameter));
        let (message, help) = match why {
            NoStation::NoAxis => (
                format!("{at} the tool axis is null"),
                "the second point of the axis must not lie on the tip".to_owned(),
            ),
            NoStation::Unreachable(Unreachable::Axis { miss }) => (
                format!(
                    "{at} the rotary axes of {} cannot follow the tool axis ({}° are missing)",
                    self.machine.name,
                    Short(miss.to_degrees())
                ),
                "two rotary axes follow any tool axis, but not on the pole, along the axis of the first of them; another mount of the part or another machine may".to_owned(),
            ),
            NoStation::Unreachable(_) => (
                format!("{at} the linear axes of {} do not reach the tip", self.machine.name),
                "three linear axes that span the space are needed".to_owned(),
            ),
            NoStation::Over(over) => {
                let axis = &self.machine.axes[over.joint];
                let unit = if axis.joint.rotary { "°" } else { " mm" };
                (
                    format!(
                        "{at} {} would be {}{unit}, its travel ends at {}{unit}",
                        axis.name,
                        Short(axis.reading(over.value)),
                        Short(axis.reading(over.limit))
                    ),
                    "--mount puts the part elsewhere, --tool-length says how long the tool is".to_owned(),
                )
            }
        };
        Diagnostic::error("curve", message).help(help)
    }
}
