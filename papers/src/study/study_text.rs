//! What a study prints: what was compared, how deviations are spread, and the moves that stray farthest.

use std::fmt::Write as _;
use std::path::Path;

use crate::deviations::{CutSurvey, MoveRow};
use post_machine::description::Tcp;

use super::notation::{MICRO, count_of_moves, digits};
use super::{DeviationStudy, NamedText};

/// Moves that are printed.
const MOST: usize = 10;

/// Fits of moves that stray by less are not told, mm: much of those is rounding.
const LEAST: f64 = 1e-3;

/// The text.
pub fn text(study: &DeviationStudy, folder: &Path, files: &[NamedText]) -> String {
    let mut text = String::new();
    head(&mut text, study);
    spreads(&mut text, study);
    fits(&mut text, study);
    moves(&mut text, study);
    programs(&mut text, study);
    sweep(&mut text, study);
    let names: Vec<&str> = files.iter().map(|(name, _)| *name).collect();
    let _ = writeln!(text, "\nin {}: {}", folder.display(), names.join(", "));
    text
}

fn head(text: &mut String, study: &DeviationStudy) {
    let machine = &study.machine;
    let _ = writeln!(
        text,
        "{} on {}: {}, tolerance {} µm, words {}",
        study.file,
        machine.name,
        count_of_moves(study.rows.len()),
        machine.accuracy.tolerance * MICRO,
        if study.exact { "not rounded" } else { "as the dialect rounds them" }
    );
    let axes = study.rows.iter().map(|row| row.axis.to_degrees());
    let _ = writeln!(
        text,
        "with nothing done the tool axis strays by {:.4}° on average, {:.4}° at most, tolerance {:.4}°",
        axes.clone().sum::<f64>() / study.rows.len() as f64,
        axes.fold(0.0, f64::max),
        machine.accuracy.axis_tolerance.to_degrees()
    );
    if machine.control.tcp == Tcp::Control {
        text.push_str(
            "the control keeps the tip, so that only the tool axis deviates; --tcp post studies the tip\n",
        );
    }
}

fn spreads(text: &mut String, study: &DeviationStudy) {
    let _ = writeln!(
        text,
        "\n{:<24} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "deviation, µm",
        "count",
        "mean",
        "st. dev.",
        "50 %",
        "90 %",
        "95 %",
        "99 %",
        "max",
        "points in"
    );
    for spread in &study.spreads {
        let distribution = &spread.distribution;
        let _ = write!(
            text,
            "{:<24} {:>7} {:>9.3} {:>9.3}",
            spread.name,
            distribution.count,
            distribution.mean * MICRO,
            distribution.deviation * MICRO
        );
        for value in distribution.percentiles {
            let _ = write!(text, " {:>9.3}", value * MICRO);
        }
        let points = spread.points.map(|points| points.to_string());
        let _ = writeln!(
            text,
            " {:>9.3} {:>9}",
            distribution.max * MICRO,
            points.as_deref().unwrap_or("-")
        );
    }
}

/// How well the models' curves explain the deviation.
fn fits(text: &mut String, study: &DeviationStudy) {
    let _ = writeln!(
        text,
        "\n{:<24} {:>12} {:>12} {:>12} {:>16}",
        "R² of the length", "this move", "mean", "least", "left, % of peak"
    );
    let row = &study.rows[study.focus];
    for (index, name) in study.models.iter().enumerate() {
        let model = &row.models[index];
        let strays = study.rows.iter().filter(|row| row.raw.size >= LEAST);
        let shares: Vec<f64> = strays.filter_map(|row| row.models[index].explained).collect();
        let none = "-".to_owned();
        let (mean, least) = if shares.is_empty() {
            (none.clone(), none.clone())
        } else {
            (
                digits(shares.iter().sum::<f64>() / shares.len() as f64),
                digits(shares.iter().copied().fold(f64::INFINITY, f64::min)),
            )
        };
        let left = percent(model.residual, row.raw.size);
        let _ = writeln!(
            text,
            "{name:<24} {:>12} {mean:>12} {least:>12} {left:>16}",
            model.explained.map_or(none, digits),
        );
    }
    let _ = writeln!(
        text,
        "  this move is {}; mean and least are of moves that stray by 1 µm or more; what is left is of the vector",
        study.focus + 1
    );
}

fn percent(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{:.2}", 100.0 * part / whole) } else { "-".to_owned() }
}

/// The moves that stray farthest, and the one that is looked at.
fn moves(text: &mut String, study: &DeviationStudy) {
    let mut order: Vec<usize> = (0..study.rows.len()).collect();
    order.sort_by(|a, b| {
        let size = |index: &usize| study.rows[*index].raw.size;
        size(b).total_cmp(&size(a)).then(a.cmp(b))
    });
    order.truncate(MOST);
    if !order.contains(&study.focus) {
        order.push(study.focus);
    }
    let _ = write!(
        text,
        "\n{:>6} {:>7} {:>9} {:>9} {:>9} {:>6}",
        "move", "CL line", "mm", "degrees", "peak µm", "at"
    );
    for name in &study.models {
        let _ = write!(text, " | {name:>9.9} {:>7}", "left");
    }
    text.push_str(" |");
    for placement in CutSurvey::PLACEMENTS {
        let _ = write!(text, " {:>12}", placement.name());
    }
    text.push('\n');
    for index in order {
        one_move(text, index + 1, &study.rows[index]);
    }
    text.push_str("  for each model its peak and what it leaves, µm; for each placement points put in and largest deviation, µm\n");
}

fn one_move(text: &mut String, number: usize, row: &MoveRow) {
    let _ = write!(
        text,
        "{number:>6} {:>7} {:>9.3} {:>9.4} {:>9.3} {:>6.3}",
        row.line,
        row.length,
        row.turn.to_degrees(),
        row.raw.size * MICRO,
        row.raw.at
    );
    for model in &row.models {
        let _ = write!(text, " | {:>9.3} {:>7.3}", model.peak.size * MICRO, model.residual * MICRO);
    }
    text.push_str(" |");
    for placed in &row.placed {
        let told = placed.map_or("refused".to_owned(), |placed| {
            format!("{} {:>8.3}", placed.points, placed.peak * MICRO)
        });
        let _ = write!(text, " {told:>12}");
    }
    text.push('\n');
}

fn programs(text: &mut String, study: &DeviationStudy) {
    let _ = writeln!(
        text,
        "\n{:<24} {:>7} {:>9} {:>9} {:>9} {:>13}",
        "the whole program", "reduce", "blocks", "put in", "left out", "certified µm"
    );
    for program in &study.programs {
        let reduce = if program.reduce { "yes" } else { "no" };
        let _ = write!(text, "{:<24} {reduce:>7}", program.name);
        let _ = match &program.report {
            Ok(report) => writeln!(
                text,
                " {:>9} {:>9} {:>9} {:>13.3}",
                report.blocks,
                report.points_added,
                report.points_dropped,
                report.tip_deviation_mm.value * MICRO
            ),
            Err(why) => writeln!(text, " refused: {why}"),
        };
    }
}

fn sweep(text: &mut String, study: &DeviationStudy) {
    let Some((name, swept)) = &study.sweep else {
        return;
    };
    let _ = writeln!(
        text,
        "\n{name:<24} {:>9} {:>9} {:>9} {:>9}",
        "mean",
        "st. dev.",
        "max",
        format!("move {}", study.focus + 1)
    );
    for step in swept {
        let kept = step.kept.as_ref().map(|kept| kept.peak().size * MICRO);
        let _ = writeln!(
            text,
            "{:<24} {:>9.3} {:>9.3} {:>9.3} {:>9}",
            step.value,
            step.distribution.mean * MICRO,
            step.distribution.deviation * MICRO,
            step.distribution.max * MICRO,
            kept.map_or("-".to_owned(), |size| format!("{size:.3}"))
        );
    }
}
