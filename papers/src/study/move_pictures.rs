//! Pictures of the move that is looked at and of its neighbours.

use crate::deviations::{DeviationPiece, KeptMove, Rim};
use post_machine::description::Machine;
use post_plugin::{ModelSession, length};

use super::notation::{FINE, HUGE, MICRO, digits, focus, sampled, tolerance};
use super::{DeviationStudy, Models};
use post_job::files::chart::{Chart, DASHED, GREY, LOOKS, Marker, Series};

/// More points than this would run into one another.
const MOST_POINTS: usize = 60;

/// Radii of the cutting edge, mm.
const RADII: [f64; 3] = [10.0, 25.0, 50.0];

/// A model's curve over the move that is looked at.
pub struct Fit {
    name: String,
    /// R² of it.
    explained: Option<f64>,
    /// Length of the curve, µm.
    curve: Vec<[f64; 2]>,
    /// What it leaves, µm.
    left: Vec<[f64; 2]>,
}

/// The curves of all models that can answer.
pub fn fits(kept: &KeptMove, study: &DeviationStudy, models: &mut Models) -> Vec<Fit> {
    let row = &study.rows[study.focus];
    let opened = models.opened.iter_mut().zip(&study.models);
    let mut fits = Vec::new();
    for ((model, name), modelled) in opened.zip(&row.models) {
        let Ok(curve) = kept.fit(model) else {
            continue;
        };
        let value = |t: f64| model.value(&curve, t).tip;
        fits.push(Fit {
            name: name.clone(),
            explained: modelled.explained,
            curve: sampled(|t| length(&value(t))),
            left: sampled(|t| {
                let strays: [f64; 3] = kept.deviation(t).into();
                let fitted = value(t);
                length(&[0, 1, 2].map(|part| strays[part] - fitted[part]))
            }),
        });
    }
    fits
}

/// Deviation along one move and the curves that the models fit (parabolic fig. 5; harmonic fig. 3.2).
pub fn along(study: &DeviationStudy, kept: &KeptMove, fits: &[Fit]) -> Chart {
    let mut series = vec![Series::line("deviation", sampled(|t| kept.deviation(t).norm()), GREY)];
    series.extend(tolerance(study, [0.0, 1.0], kept.peak().size * MICRO));
    for (fit, look) in fits.iter().zip(&LOOKS[1..]) {
        let explained =
            fit.explained.map_or(String::new(), |share| format!(", R² {}", digits(share)));
        series.push(Series::line(format!("{}{explained}", fit.name), fit.curve.clone(), *look));
    }
    Chart {
        title: "Deviation along one move and the models' curves".to_owned(),
        note: focus(study),
        x: "share of the move".to_owned(),
        y: "deviation from the CL path, µm".to_owned(),
        logarithmic: false,
        series,
    }
}

/// What is left of one move when each model's curve is taken away (harmonic fig. 3.3b).
pub fn left(study: &DeviationStudy, kept: &KeptMove, fits: &[Fit]) -> Chart {
    let peak = kept.peak().size * MICRO;
    let series = fits.iter().zip(&LOOKS[1..]).map(|(fit, look)| {
        let most = fit.left.iter().map(|point| point[1]).fold(0.0, f64::max);
        let share = if peak > 0.0 { 100.0 * most / peak } else { 0.0 };
        Series::line(format!("{}, {share:.2} % of the peak", fit.name), fit.left.clone(), *look)
    });
    Chart {
        title: "What is left of the deviation when a model's curve is taken away".to_owned(),
        note: format!("{}; its peak is {peak:.3} µm", focus(study)),
        x: "share of the move".to_owned(),
        y: "distance from the model's curve, µm".to_owned(),
        logarithmic: false,
        series: series.collect(),
    }
}

/// Consecutive moves before and after points were put in (parabolic figs. 4 and 10a).
pub fn neighbours(study: &DeviationStudy, models: &mut Models) -> Chart {
    let placement = study.machine.accuracy.placement;
    let (mut before, mut after, mut points) = (Vec::new(), Vec::new(), Vec::new());
    for kept in &study.kept {
        let number = kept.number as f64 + 0.5;
        let place = |stretch: &DeviationPiece| -> Vec<[f64; 2]> {
            let samples = stretch.samples.iter();
            samples.map(|(t, strays)| [number + t, strays.norm() * MICRO]).collect()
        };
        before.extend(place(&kept.raw(FINE / 3)));
        let pieces = kept.placed(&study.machine, placement, &mut models.own, 24);
        let pieces: Vec<Vec<[f64; 2]>> = pieces.unwrap_or_default().iter().map(place).collect();
        let inner = pieces.len().saturating_sub(1);
        points.extend(pieces[..inner].iter().filter_map(|piece| piece.last()));
        after.extend(pieces.into_iter().flatten());
    }
    let largest = before.iter().map(|point| point[1]).fold(0.0, f64::max);
    let ends = [before.first(), before.last()].map(|point| point.map_or(0.0, |point| point[0]));
    let name = placement.name();
    let every = points.len().div_ceil(MOST_POINTS).max(1);
    let points = points.into_iter().step_by(every).collect();
    let told = match every {
        1 => "points put in".to_owned(),
        every => format!("points put in, one of {every}"),
    };
    let mut series = vec![
        Series::line("before", before, GREY),
        Series::line(format!("after {name}"), after, LOOKS[0]),
        Series::dots(told, points, Marker::Circle),
    ];
    series.extend(tolerance(study, ends, largest));
    Chart {
        title: "Deviation along neighbouring moves, before and after points were put in".to_owned(),
        note: format!("around {}", focus(study)),
        x: "move (number in moves.csv, its middle under the number)".to_owned(),
        y: "deviation from the CL path, µm".to_owned(),
        logarithmic: largest > HUGE * study.machine.accuracy.tolerance * MICRO,
        series,
    }
}

/// What the tool's turn adds at a cutting edge, against its radius and the rotary move (parabolic fig. 7, eq. 10).
pub fn edge(study: &DeviationStudy, kept: &KeptMove) -> Option<Chart> {
    let machine: &Machine = &study.machine;
    let [from, to] = kept.joints();
    let rotary = |joint: usize| machine.axes.get(joint).is_some_and(|axis| axis.joint.rotary);
    let turn = study.rows[study.focus].turn;
    if turn < 1e-9 {
        return None;
    }
    let most = (2.0 * turn).max(5f64.to_radians());
    let rim = Rim::new(kept.chain(), machine.tool_axis);
    let share = |joint: usize| {
        if rotary(joint) { (to[joint] - from[joint]) / turn } else { 0.0 }
    };
    // Axis values so far from the middle of the move, as a turn of all rotary axes together.
    let at = |away: f64| {
        std::array::from_fn(|joint| (from[joint] + to[joint]) / 2.0 + share(joint) * away)
    };
    let mut series = Vec::new();
    let mut formula = Vec::new();
    for (radius, look) in RADII.iter().zip([LOOKS[0], DASHED, GREY]) {
        let mut chain = Vec::new();
        for step in 0..=20 {
            let turn = most * f64::from(step) / 20.0;
            let bow = rim.bow(&at(-turn / 2.0), &at(turn / 2.0)).size;
            chain.push([turn.to_degrees(), radius * bow * MICRO]);
            if step % 2 == 0 {
                let turns = (0..from.len()).map(|joint| share(joint) * turn);
                formula.push([turn.to_degrees(), radius * Rim::formula(turns) * MICRO]);
            }
        }
        series.push(Series::line(format!("R = {radius} mm, chain"), chain, look));
    }
    series.push(Series::dots("eq. 10", formula, Marker::Cross));
    Some(Chart {
        title: "Deviation of a cutting edge of radius R that the tool's turn makes".to_owned(),
        note: format!(
            "about the middle of move {}, turns shared between the axes as there",
            study.focus + 1
        ),
        x: "rotary move, degrees (root of the sum of squares over the axes)".to_owned(),
        y: "deviation from the edge's chord, µm".to_owned(),
        logarithmic: false,
        series,
    })
}
