//! The paths of `../shared/data/geometry`, as samples.

use post_feed::Samples;
use post_testkit::shared;
use serde_json::Value;

use super::jet::Jet;
use crate::spline::BSpline;

fn json(name: &str) -> Option<Value> {
    let path = shared(&format!("data/geometry/{name}"))?;
    Some(serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn points<const D: usize>(value: &Value) -> Vec<[f64; D]> {
    let each = value.as_array().unwrap().iter();
    each.map(|point| numbers(point).try_into().unwrap()).collect()
}

/// The butterfly curve, its size times `scale`.
pub fn butterfly(scale: f64) -> Option<BSpline<2>> {
    let value = json("butterfly_nurbs.json")?;
    let mut points: Vec<[f64; 2]> = points(&value["control_points_mm"]);
    for point in &mut points {
        *point = point.map(|value| value * scale);
    }
    let degree = value["degree"].as_u64().unwrap() as usize;
    let mut curve = BSpline::unweighted(degree, numbers(&value["knots"]), points);
    for ((_, weight), told) in curve.poles.iter_mut().zip(numbers(&value["weights"])) {
        *weight = told;
    }
    assert!(curve.is_sound());
    Some(curve)
}

/// A plane curve at these parameters, its two coordinates being axes.
pub fn plane(curve: &BSpline<2>, parameters: &[f64]) -> Samples {
    let mut samples = Samples::default();
    for &parameter in parameters {
        let [_, first, second, third] = curve.derivatives(parameter);
        let tip = [first, second, third].map(|way| [way.x, way.y, 0.0]);
        let axis = |axis: usize| [first[axis], second[axis], third[axis]];
        samples.push(parameter, tip, &[axis(0), axis(1)]);
    }
    samples
}

/// Evenly spaced between two ends.
pub fn even(first: f64, last: f64, count: usize) -> Vec<f64> {
    let at = |index: usize| first + (last - first) * index as f64 / (count - 1) as f64;
    (0..count).map(at).collect()
}

/// The knots of a curve, and so many even steps between each and the next.
pub fn spans(curve: &BSpline<2>, steps: usize) -> Vec<f64> {
    let breaks: Vec<f64> = curve.breaks().collect();
    let mut all: Vec<f64> = Vec::new();
    for pair in breaks.windows(2) {
        all.pop();
        all.extend(even(pair[0], pair[1], steps + 1));
    }
    all
}

/// Arc length by Gauss' rule of five points on each of many pieces.
pub fn length(curve: &BSpline<2>, pieces: usize) -> f64 {
    let nodes = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let mut sum = 0.0;
    let breaks: Vec<f64> = curve.breaks().collect();
    for pair in breaks.windows(2) {
        let half = 0.5 * (pair[1] - pair[0]) / pieces as f64;
        for piece in 0..pieces {
            let middle = pair[0] + half * (2.0 * piece as f64 + 1.0);
            for (node, weight) in nodes {
                for side in [-1.0, 1.0] {
                    let [_, first, ..] = curve.derivatives(middle + side * half * node);
                    let weight = if node == 0.0 { 0.5 * weight } else { weight };
                    sum += half * weight * libm::hypot(first[0], first[1]);
                }
            }
        }
    }
    sum
}

/// The five-axis path of two B-splines, with the machine and the limits of its file.
pub struct Dual {
    tip: BSpline<3>,
    top: BSpline<3>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub jerk: Vec<f64>,
}

pub fn dual() -> Option<Dual> {
    let value = json("dual_bspline_jcde2022.json")?;
    let curve = |name: &str| BSpline::unweighted(3, numbers(&value["knots"]), points(&value[name]));
    let limits = |kind: &str| -> Vec<f64> {
        let of = |axis: &str| value["limits"][axis][kind].as_f64().unwrap();
        vec![of("XYZ"), of("XYZ"), of("XYZ"), of("A"), of("C")]
    };
    Some(Dual {
        tip: curve("P_tool_tip"),
        top: curve("H_second_point_on_axis"),
        velocity: limits("v"),
        acceleration: limits("a"),
        jerk: limits("j"),
    })
}

impl Dual {
    /// Values and derivatives of X, Y, Z, A, C by the curves' parameter: the kinematics that stand in the file.
    pub fn axes(&self, parameter: f64) -> [Jet; 5] {
        let jets = |curve: &BSpline<3>| -> [Jet; 3] {
            let all = curve.derivatives(parameter);
            std::array::from_fn(|axis| Jet::from_derivatives(all.map(|values| values[axis])))
        };
        let [px, py, pz] = jets(&self.tip);
        let [hx, hy, hz] = jets(&self.top);
        let [i, j, k] = [hx - px, hy - py, hz - pz];
        // A lean towards Y and its opposite are the same tool axis, so signs are free: those of the file.
        let lean = (i * i + j * j).sqrt();
        let a = lean.atan2(k);
        let c = i.atan2(j);
        let ((sa, ca), (sc, cc)) = (a.sin_cos(), c.sin_cos());
        let across = sc * px + cc * py;
        let x = cc * px - sc * py;
        let y = ca * across - sa * pz;
        let z = sa * across + ca * pz;
        [x, y, z, a, c]
    }

    pub fn samples(&self, parameters: &[f64]) -> Samples {
        let mut samples = Samples::default();
        for &parameter in parameters {
            let [_, first, second, third] = self.tip.derivatives(parameter);
            let axes = self.axes(parameter).map(|jet| {
                let [_, first, second, third] = jet.derivatives();
                [first, second, third]
            });
            samples.push(parameter, [first, second, third].map(Into::into), &axes);
        }
        samples
    }
}
