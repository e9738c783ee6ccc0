//! The path of the tool as it should be, as it is, and compensated (harmonic figs. 3.3a and 4.1).

use crate::deviations::KeptMove;
use post_plugin::ModelSession;

use super::notation::{FINE, focus};
use super::{DeviationStudy, Models};
use post_job::files::chart::{Chart, GREY, LOOKS, Marker, Series};

/// Moves to each side of the one that is looked at.
const SIDE: usize = 1;

/// How much of the way along the path the magnified deviation shall be.
const SHARE: f64 = 0.12;

/// The three paths in the plane of the move's chord and its largest deviation; none if there is no such plane.
pub fn chart(study: &DeviationStudy, middle: &KeptMove, models: &mut Models) -> Option<Chart> {
    let peak = middle.peak();
    let origin = middle.target(0.0);
    let along = (middle.target(1.0) - origin).try_normalize(1e-9)?;
    let strays = middle.deviation(peak.at);
    let aside = (strays - along * along.dot(&strays)).try_normalize(1e-9)?;
    let near = |kept: &&KeptMove| kept.number.abs_diff(study.focus) <= SIDE;
    let moves: Vec<&KeptMove> = study.kept.iter().filter(near).collect();
    let way: f64 = moves.iter().map(|kept| kept.length()).sum();
    let times = round(SHARE * way / peak.size);
    let name = study.models.first()?;
    let model = models.opened.first_mut()?;
    let place = |point: [f64; 3]| {
        let from = minus(point, origin.into());
        [dot(from, along.into()), dot(from, aside.into())]
    };
    let (mut ideal, mut points) = (Vec::new(), Vec::new());
    let (mut actual, mut compensated) = (Vec::new(), Vec::new());
    for kept in &moves {
        let curve = kept.fit(model).ok()?;
        points.extend([0.0, 1.0].map(|t| place(kept.target(t).into())));
        for step in 0..=FINE {
            let t = f64::from(step) / f64::from(FINE);
            let (target, strays): ([f64; 3], [f64; 3]) =
                (kept.target(t).into(), kept.deviation(t).into());
            let fitted = model.value(&curve, t).tip;
            let moved =
                |strays: [f64; 3]| place([0, 1, 2].map(|part| target[part] + times * strays[part]));
            ideal.push(place(target));
            actual.push(moved(strays));
            compensated.push(moved([0, 1, 2].map(|part| strays[part] - fitted[part])));
        }
    }
    Some(Chart {
        title: format!("Path of the control point, deviation magnified {times} times"),
        note: format!("around {}", focus(study)),
        x: "along the chord of the move, mm".to_owned(),
        y: format!("across it, mm (deviation × {times})"),
        logarithmic: false,
        series: vec![
            Series::line("ideal", ideal, GREY),
            Series::line("uncompensated", actual, LOOKS[1]),
            Series::line(format!("compensated by {name} (eq. 3.4)"), compensated, LOOKS[0]),
            Series::dots("CL points", points, Marker::Diamond),
        ],
    })
}

/// 1, 2 or 5 times a power of ten, not above `value`, and 1 at least.
fn round(value: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(value.max(1.0))));
    let steps = [5.0, 2.0, 1.0].map(|step| step * power);
    let fits = steps.into_iter().find(|step| *step <= value);
    fits.unwrap_or(1.0)
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|part| a[part] - b[part])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
