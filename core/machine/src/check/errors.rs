//! What errors of axes that depend on where they stand do to the tip, so that their signs can be compared with the machine.

use serde::Serialize;

use super::number;
use super::pointing::AxisReadout;
use super::probe::Probe;
use crate::halton;
use crate::kinematics::orientation::angle;
use crate::kinematics::{AxisErrors, Joints};

/// Places in the travel of the axes at which the errors are looked at.
const PLACES: u32 = 4000;

/// The errors of a machine.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorsReport {
    /// Axis by axis.
    pub axes: Vec<AxisErrorsReport>,
    /// The largest displacement of the tip by all of them that was found, mm.
    pub tip_mm: f64,
    /// The same as a vector, mm, part frame.
    pub tip: [f64; 3],
    /// Axis values there.
    pub tip_at: Vec<AxisReadout>,
    /// The largest turn of the tool axis that was found, degrees: rotary words do not take it out.
    pub axis_deg: f64,
    /// Rotary axes are put as if there were no errors; else a search turns them too.
    pub axis_stays: bool,
}

/// The errors of one axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisErrorsReport {
    /// Address of the axis.
    pub axis: String,
    /// Where they are known: least and largest reading.
    pub known: [f64; 2],
    /// The largest of each, where it stands, and what the eye sees: `EYX +0.012 mm at 300: the head stands to +Y`.
    pub largest: Vec<String>,
}

/// The errors of a machine; none where it has none.
pub(super) fn told(probe: &Probe<'_>) -> Option<ErrorsReport> {
    let chain = probe.chain();
    if chain.errors().is_empty() {
        return None;
    }
    let exact = chain.clone().with_errors(&[].into());
    let mut report = ErrorsReport {
        axes: chain.errors().iter().map(|errors| axis_told(probe, errors)).collect(),
        tip_mm: 0.0,
        tip: [0.0; 3],
        tip_at: Vec::new(),
        axis_deg: 0.0,
        axis_stays: probe.closed_form() || probe.solver().planar(),
    };
    let machine = probe.machine();
    for joints in places(probe) {
        let [own, drawn] = [chain, &exact].map(|chain| chain.forward(&joints));
        report.axis_deg = report.axis_deg.max(angle(own.axis, drawn.axis).to_degrees());
        let off = own.tip - drawn.tip;
        if off.norm() > report.tip_mm {
            (report.tip_mm, report.tip) = (off.norm(), off.into());
            let readings = machine.axes.iter().zip(&joints);
            report.tip_at = readings
                .map(|(axis, value)| AxisReadout {
                    axis: axis.name.clone(),
                    value: axis.reading(*value),
                })
                .collect();
        }
    }
    Some(report)
}

/// Places spread over the travel of the axes, its corners first.
fn places<'a>(probe: &'a Probe<'_>) -> impl Iterator<Item = Joints> + use<'a> {
    let count = probe.machine().axes.len();
    let corners = 1u32 << count;
    (0..corners + PLACES).map(move |number| {
        let mut joints = *probe.home();
        let shares = halton::place(number.saturating_sub(corners) + 1);
        for (place, share) in (0..count).zip(shares) {
            let [least, most] = probe.span(place);
            let share = if number < corners { f64::from(number >> place & 1) } else { share };
            joints[place] = least + (most - least) * share;
        }
        joints
    })
}

fn axis_told(probe: &Probe<'_>, errors: &AxisErrors) -> AxisErrorsReport {
    let axis = &probe.machine().axes[errors.joint];
    let (body, way) = if axis.carries_part { ("table", -1.0) } else { ("head", 1.0) };
    let mut largest = Vec::new();
    for (part, letter) in ["X", "Y", "Z", "A", "B", "C"].into_iter().enumerate() {
        let line = ["X", "Y", "Z"][part % 3];
        let value = |index: usize| match part {
            0..3 => errors.motions[index].displacement[part],
            _ => errors.motions[index].turn[part - 3] * 1e3,
        };
        let indices = 0..errors.places.len();
        let most = indices.max_by(|a, b| libm::fabs(value(*a)).total_cmp(&libm::fabs(value(*b))));
        let Some(at) = most.filter(|at| value(*at) != 0.0) else {
            continue;
        };
        let plus = value(at) * way > 0.0;
        let seen = match (part, plus) {
            (0..3, true) => format!("stands to +{line}"),
            (0..3, false) => format!("stands to -{line}"),
            (_, true) => format!("is turned counter-clockwise seen from +{line}"),
            (_, false) => format!("is turned clockwise seen from +{line}"),
        };
        let sign = if value(at) > 0.0 { "+" } else { "" };
        largest.push(format!(
            "E{letter}{} {sign}{} {} at {}: the {body} {seen}",
            axis.name,
            number(value(at), 5),
            if part < 3 { "mm" } else { "mm/m" },
            number(axis.reading(errors.places[at]), 3),
        ));
    }
    let ends = [errors.places.first(), errors.places.last()];
    AxisErrorsReport {
        axis: axis.name.clone(),
        known: ends.map(|end| end.map_or(0.0, |end| axis.reading(*end))),
        largest,
    }
}
