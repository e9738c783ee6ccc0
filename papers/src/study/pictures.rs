//! The pictures of a study. Which figure of which paper each follows is in its docstring: parabolic is Sha et al.
//! 2022, harmonic is Li 2024.

use crate::deviations::{CutSurvey, histogram};

use super::notation::{HUGE, MICRO, count_of_moves, focus, sampled, tolerance};
use super::{DeviationStudy, Models, NamedText, move_pictures, path_picture};
use post_job::files::chart::{Chart, DASHED, Draw, GREY, LOOKS, Series};

/// More moves than this are drawn as the largest of every few.
const MOST_MOVES: usize = 300;

const BINS: usize = 24;

/// Curves of a sweep in one picture.
const MOST_CURVES: usize = 7;

/// The files that there can be.
pub const NAMES: [&str; 9] = [
    "before-after.svg",
    "histogram.svg",
    "move.svg",
    "left.svg",
    "neighbours.svg",
    "path.svg",
    "edge.svg",
    "sweep.svg",
    "sweep-curves.svg",
];

/// All pictures that there is something to show in.
pub fn files(study: &DeviationStudy, models: &mut Models) -> Vec<NamedText> {
    let mut files = vec![
        ("before-after.svg", before_after(study).svg()),
        ("histogram.svg", spread(study).svg()),
    ];
    let focus = study.kept.iter().find(|kept| kept.number == study.focus);
    if let Some(kept) = focus {
        let fits = move_pictures::fits(kept, study, models);
        files.push(("move.svg", move_pictures::along(study, kept, &fits).svg()));
        files.push(("left.svg", move_pictures::left(study, kept, &fits).svg()));
        files.push(("neighbours.svg", move_pictures::neighbours(study, models).svg()));
        if let Some(chart) = path_picture::chart(study, kept, models) {
            files.push(("path.svg", chart.svg()));
        }
        if let Some(chart) = move_pictures::edge(study, kept) {
            files.push(("edge.svg", chart.svg()));
        }
    }
    if study.sweep.is_some() {
        files.push(("sweep.svg", swept(study).svg()));
        files.push(("sweep-curves.svg", swept_curves(study).svg()));
    }
    files
}

/// The largest deviation of every move, before and after (parabolic figs. 9 and 10b; harmonic fig. 3.3b).
fn before_after(study: &DeviationStudy) -> Chart {
    let rows = &study.rows;
    let every = rows.len().div_ceil(MOST_MOVES).max(1);
    let largest = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
        (0..rows.len())
            .step_by(every)
            .map(|first| {
                let last = (first + every).min(rows.len());
                let most = (first..last).map(value).fold(0.0, f64::max);
                [(first + last + 1) as f64 / 2.0, most * MICRO]
            })
            .collect()
    };
    let mut series = vec![Series::line("uncompensated", largest(&|row| rows[row].raw.size), GREY)];
    let most = rows.iter().map(|row| row.raw.size).fold(0.0, f64::max);
    let ends = [1.0, rows.len() as f64];
    series.extend(tolerance(study, ends, most * MICRO));
    let mut looks = [LOOKS[1], LOOKS[2], LOOKS[0], LOOKS[4], LOOKS[5]].into_iter();
    for (index, placement) in CutSurvey::PLACEMENTS.iter().enumerate() {
        let peak = |row: usize| rows[row].placed[index].map_or(0.0, |placed| placed.peak);
        if let Some(look) = looks.next() {
            let name = format!("after {}", placement.name());
            series.push(Series::line(name, largest(&peak), look));
        }
    }
    for (index, name) in study.models.iter().enumerate().take(2) {
        if let Some(look) = looks.next() {
            let left = |row: usize| rows[row].models[index].residual;
            series.push(Series::line(format!("left by {name}"), largest(&left), look));
        }
    }
    Chart {
        title: "Largest deviation of every move, before and after".to_owned(),
        note: match every {
            1 => format!("{}, {}", study.part(), count_of_moves(rows.len())),
            every => format!(
                "{}, {} moves; the largest of every {every} is drawn",
                study.part(),
                rows.len()
            ),
        },
        x: "move (number in moves.csv)".to_owned(),
        y: "largest deviation from the CL path, µm".to_owned(),
        logarithmic: most > HUGE * study.machine.accuracy.tolerance,
        series,
    }
}

/// How the deviations of moves and of pieces are spread.
fn spread(study: &DeviationStudy) -> Chart {
    let index = CutSurvey::PLACEMENTS
        .iter()
        .position(|placement| *placement == study.machine.accuracy.placement)
        .unwrap_or(0);
    let before: Vec<f64> = study.rows.iter().map(|row| row.raw.size).collect();
    let after = &study.pieces[index];
    // A few moves far off would leave all others in one bin.
    let [.., most] = study.spreads[0].distribution.percentiles;
    let end = after.iter().copied().fold(most.max(1e-6), f64::max) * 1.02;
    let beyond = before.iter().filter(|size| **size > end).count();
    let width = end * MICRO / BINS as f64;
    let bars = |values: &[f64], side: f64| -> Vec<[f64; 3]> {
        let counts = histogram(values, end, BINS);
        let count = values.len().max(1) as f64;
        let places = counts.iter().enumerate();
        places
            .map(|(bin, number)| {
                let left = (bin as f64 + side) * width;
                [left, left + 0.45 * width, 100.0 * *number as f64 / count]
            })
            .collect()
    };
    let name = study.machine.accuracy.placement.name();
    Chart {
        title: "How the largest deviations are spread, before and after".to_owned(),
        note: match beyond {
            0 => format!("{}; a bin is {width:.3} µm wide", study.part()),
            beyond => format!(
                "{}; a bin is {width:.3} µm wide, the last holds {beyond} moves beyond it",
                study.part()
            ),
        },
        x: "largest deviation, µm".to_owned(),
        y: "share, %".to_owned(),
        logarithmic: false,
        series: vec![
            Series {
                name: format!("before, {}", count_of_moves(before.len())),
                draw: Draw::Bars(bars(&before, 0.05), "#707070"),
            },
            Series {
                name: format!("after {name}, {} pieces", after.len()),
                draw: Draw::Bars(bars(after, 0.5), "#ffffff"),
            },
        ],
    }
}

/// The largest deviation over a swept number (parabolic fig. 8a).
fn swept(study: &DeviationStudy) -> Chart {
    let (name, swept) = match &study.sweep {
        Some((name, swept)) => (name.as_str(), swept.as_slice()),
        None => ("", [].as_slice()),
    };
    let of = |value: &dyn Fn(&super::Swept) -> f64| -> Vec<[f64; 2]> {
        swept.iter().map(|step| [step.value, value(step) * MICRO]).collect()
    };
    Chart {
        title: format!("Deviation over {name}"),
        note: format!("{}, {}", study.part(), count_of_moves(study.rows.len())),
        x: format!("{name} (unit of the machine file)"),
        y: "deviation from the CL path, µm".to_owned(),
        logarithmic: false,
        series: vec![
            Series::line("largest of all moves", of(&|step| step.distribution.max), LOOKS[0]),
            Series::line("mean of all moves", of(&|step| step.distribution.mean), DASHED),
            Series::line(
                format!("move {}", study.focus + 1),
                of(&|step| step.kept.as_ref().map_or(0.0, |kept| kept.peak().size)),
                LOOKS[2],
            ),
        ],
    }
}

/// Deviation along one move for values of a swept number (parabolic fig. 8b).
fn swept_curves(study: &DeviationStudy) -> Chart {
    let (name, swept) = match &study.sweep {
        Some((name, swept)) => (name.as_str(), swept.as_slice()),
        None => ("", [].as_slice()),
    };
    let every = swept.len().div_ceil(MOST_CURVES).max(1);
    let drawn = swept.iter().step_by(every).zip(LOOKS);
    let series = drawn.filter_map(|(step, look)| {
        let kept = step.kept.as_ref()?;
        Some(Series::line(
            format!("{name} = {}", step.value),
            sampled(|t| kept.deviation(t).norm()),
            look,
        ))
    });
    Chart {
        title: format!("Deviation along one move for values of {name}"),
        note: focus(study),
        x: "share of the move".to_owned(),
        y: "deviation from the CL path, µm".to_owned(),
        logarithmic: false,
        series: series.collect(),
    }
}
