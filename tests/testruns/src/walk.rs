//! Programs held against the path of their CL file: printed words taken apart, sampled, and walked along that path
//! from its start to its end, never back.

use nalgebra::{Unit, UnitQuaternion, Vector3};
use post_machine::description::Tcp;
use post_machine::kinematics::Joints;
use post_plugin::{Curve, Deviation, Feed, ModelSession, Tolerance};

use crate::posted::{Bench, Point, Run, peaks, point};
use post_testmachines::{angle, between, distance, slerp, turned, within};

type V = Vector3<f64>;

/// A point of a CL file with what stands before it.
#[derive(Clone, Debug)]
pub struct Stop {
    pub tip: V,
    pub axis: V,
    /// mm/min; none is a rapid.
    pub feed: Option<f64>,
    /// Lines of the CL file before it.
    pub before: String,
}

/// A stop whose numbers are those that are written.
pub fn stop(tip: V, axis: V, feed: Option<f64>) -> Stop {
    let Point { tip, axis, .. } = point(tip, axis, feed.is_none());
    Stop { tip, axis, feed, before: String::new() }
}

/// The CL file, and the line of each stop.
pub fn text(stops: &[Stop]) -> (String, Vec<u64>) {
    let mut text = "UNITS/MM\nMULTAX/ON\nSPINDL/3000,RPM,CLW\n".to_owned();
    let mut lines = Vec::new();
    let mut modal = None;
    for stop in stops {
        text += &stop.before;
        match stop.feed {
            None => text += "RAPID\n",
            Some(feed) if modal != Some(feed) => {
                modal = Some(feed);
                text += &format!("FEDRAT/{feed},MMPM\n");
            }
            Some(_) => {}
        }
        let Stop { tip, axis, .. } = stop;
        text += &format!(
            "GOTO/{:.4},{:.4},{:.4},{:.9},{:.9},{:.9}\n",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        );
        lines.push(text.lines().count() as u64);
    }
    (text + "FINI\n", lines)
}

/// Where the control point must go: `along` above the tips, and the tool axes.
pub fn wanted(stops: &[Stop], along: f64) -> Vec<(V, V)> {
    stops
        .iter()
        .map(|stop| {
            let axis = stop.axis.normalize();
            (stop.tip + axis * along, axis)
        })
        .collect()
}

/// One block of a program.
#[derive(Clone, Debug)]
pub struct Block {
    pub from: Joints,
    pub to: Joints,
    /// Printed tips, where the control keeps the tip.
    tips: Option<[V; 2]>,
    /// Lines of the CL file that it begins and ends in.
    pub lines: [u64; 2],
    pub rapid: bool,
    pub feed: Option<Feed>,
}

impl Block {
    /// Control point and tool axis at the share `t`.
    pub fn at(&self, bench: &Bench, t: f64) -> (V, V) {
        let along = bench.machine.control_point.along;
        let (mut tip, axis) = bench.reference.forward(&between(&self.from, &self.to, t));
        if let Some([from, to]) = self.tips {
            tip = from * (1.0 - t) + to * t;
        }
        (tip + axis * along, axis)
    }

    /// What the tool has been turned by.
    pub fn rotation(&self, bench: &Bench, t: f64) -> UnitQuaternion<f64> {
        bench.reference.rotation(&between(&self.from, &self.to, t))
    }
}

/// Every block, from one set of words to the next; axes that are shown over one turn go the shorter way.
pub fn blocks(bench: &Bench, run: &Run) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut last: Option<(Joints, V, u64)> = None;
    let keeps = bench.machine.control.tcp == Tcp::Control;
    for asked in run.motions() {
        let mut joints = bench.joints(&asked.words);
        let tip = Vector3::new(asked.words[0], asked.words[1], asked.words[2]);
        if let Some((from, from_tip, line)) = last
            && asked.kind != "Position"
        {
            for (joint, axis) in bench.machine.axes.iter().enumerate() {
                if axis.range.is_some() {
                    joints[joint] = from[joint] + turned(from[joint], joints[joint]);
                }
            }
            blocks.push(Block {
                from,
                to: joints,
                tips: keeps.then_some([from_tip, tip]),
                lines: [line, asked.line],
                rapid: asked.kind == "Rapid",
                feed: asked.feed,
            });
        }
        last = Some((joints, tip, asked.line));
    }
    blocks
}

/// A walk along a path that never goes back.
pub struct Walk<'a> {
    path: &'a [(V, V)],
    leg: usize,
    t: f64,
}

impl<'a> Walk<'a> {
    pub fn new(path: &'a [(V, V)]) -> Self {
        Self { path, leg: 0, t: 0.0 }
    }

    pub fn at(&self) -> (usize, f64) {
        (self.leg, self.t)
    }

    pub fn leave(&mut self, leg: usize) {
        (self.leg, self.t) = (leg, 0.0);
    }

    /// Goes on no farther than it must to be within `bound` of `tip` and `axis_bound` of `axis`, in leg `last` at the
    /// latest. The error is the nearest that it comes.
    pub fn reach(
        &mut self,
        (tip, axis): (V, V),
        last: usize,
        bound: f64,
        axis_bound: f64,
    ) -> Result<(), [f64; 2]> {
        let mut nearest = [f64::INFINITY; 2];
        for leg in self.leg..=last.min(self.path.len() - 2) {
            let least = if leg == self.leg { self.t } else { 0.0 };
            let [(a, u), (b, v)] = [self.path[leg], self.path[leg + 1]];
            let off = distance(tip, a + (b - a) * least, b);
            let [low, high] = match within(tip, a, b, bound) {
                Some([low, high]) if high >= least => [low.max(least), high],
                _ => {
                    if off < nearest[0] {
                        nearest = [off, f64::NAN];
                    }
                    continue;
                }
            };
            let apart = |t: f64| angle(axis, slerp(u, v, t));
            if apart(low) <= axis_bound {
                (self.leg, self.t) = (leg, low);
                return Ok(());
            }
            let (mut from, mut to) = (low, high);
            for _ in 0..50 {
                let third = (to - from) / 3.0;
                if apart(from + third) < apart(to - third) {
                    to -= third;
                } else {
                    from += third;
                }
            }
            if apart(to) > axis_bound {
                nearest = [off, apart(to)];
                continue;
            }
            let mut from = low;
            for _ in 0..50 {
                let middle = (from + to) / 2.0;
                if apart(middle) <= axis_bound {
                    to = middle;
                } else {
                    from = middle;
                }
            }
            (self.leg, self.t) = (leg, to);
            return Ok(());
        }
        Err(nearest)
    }
}

/// How far a point is from a program: the blocks `among`, looked at in `count` places first.
pub fn from_program(
    bench: &Bench,
    blocks: &[Block],
    among: std::ops::Range<usize>,
    count: u32,
    point: V,
) -> f64 {
    let mut least = f64::INFINITY;
    for block in &blocks[among] {
        let off = |t: f64| (block.at(bench, t).0 - point).norm();
        let even = |step: u32| f64::from(step) / f64::from(count);
        let mut nearest = (f64::INFINITY, 0.0);
        for step in 0..=count {
            let far = off(even(step));
            if far < nearest.0 {
                nearest = (far, even(step));
            }
        }
        least = least.min(nearest.0);
        // No more than a step away it may be nearer still.
        let step = 1.0 / f64::from(count);
        let (mut low, mut high) = ((nearest.1 - step).max(0.0), (nearest.1 + step).min(1.0));
        for _ in 0..30 {
            let third = (high - low) / 3.0;
            if off(low + third) < off(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        least = least.min(off((low + high) / 2.0));
    }
    least
}

/// An error model with a shape: what it says is the shape put through samples of the true deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `d(1/2)·sin(πt)`, eq. 3.3 of the harmonic paper.
    Sine,
    /// `d(1/2)·4t(1-t)`.
    Parabola,
    /// A polynomial through 17 Chebyshev points.
    Fine,
}

const PLACES: usize = 17;

fn place(index: usize) -> f64 {
    let turn = std::f64::consts::PI * index as f64 / (PLACES - 1) as f64;
    (1.0 - libm::cos(turn)) / 2.0
}

impl ModelSession for Shape {
    fn fit(
        &mut self,
        _: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        let mut terms = [0.0; 60];
        let looks: Vec<f64> = (0..=64).map(|step| f64::from(step) / 64.0).collect();
        let mut out = vec![Deviation::default(); looks.len()];
        deviation(&looks, &mut out);
        let [mut tip_peak, axis_peak] = peaks(&out);
        if *self == Self::Fine {
            let places: Vec<f64> = (0..PLACES).map(place).collect();
            let mut out = [Deviation::default(); PLACES];
            deviation(&places, &mut out);
            for (index, at) in out.iter().enumerate() {
                terms[3 * index..3 * index + 3].copy_from_slice(&at.tip);
            }
        } else {
            terms[..3].copy_from_slice(&out[32].tip);
            tip_peak = Vector3::from(out[32].tip).norm();
        }
        Ok(Curve { tip_peak, tip_at: 0.5, axis_peak, axis_at: 0.5, terms })
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        let at = |index: usize| {
            V::new(curve.terms[3 * index], curve.terms[3 * index + 1], curve.terms[3 * index + 2])
        };
        let tip = match self {
            Self::Sine => at(0) * libm::sin(std::f64::consts::PI * t),
            Self::Parabola => at(0) * (4.0 * t * (1.0 - t)),
            Self::Fine => {
                // Lagrange by barycentric weights of Chebyshev points.
                let (mut sum, mut weights) = (V::zeros(), 0.0);
                for index in 0..PLACES {
                    let apart = t - place(index);
                    if apart == 0.0 {
                        return Deviation { tip: at(index).into(), axis: [0.0; 3] };
                    }
                    let end = index == 0 || index == PLACES - 1;
                    let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
                    let weight = sign * if end { 0.5 } else { 1.0 } / apart;
                    sum += at(index) * weight;
                    weights += weight;
                }
                sum / weights
            }
        };
        Deviation { tip: tip.into(), axis: [0.0; 3] }
    }
}

/// `v` turned by `by` radians about a direction across it.
pub fn leaned(v: V, about: V, by: f64) -> V {
    UnitQuaternion::from_axis_angle(&Unit::new_normalize(about), by) * v
}
