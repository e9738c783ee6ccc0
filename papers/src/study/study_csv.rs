//! The tables of a study, for programs to read. Deviations in µm, lengths in mm, turns in degrees; a field is empty
//! where there is nothing to tell.

use std::fmt::Write as _;

use crate::deviations::{CutSurvey, MoveRow, Placed};

use super::notation::MICRO;
use super::{DeviationStudy, NamedText};

/// The files that there can be.
pub const NAMES: [&str; 4] = ["moves.csv", "summary.csv", "blocks.csv", "sweep.csv"];

/// What the table of moves begins with.
pub const BEGIN: &str = "move,cl_line,length_mm,turn_deg,peak_um,peak_at,edge_um,axis_deg";

/// All tables.
pub fn files(study: &DeviationStudy) -> Vec<NamedText> {
    let mut files = vec![
        ("moves.csv", moves(study)),
        ("summary.csv", summary(study)),
        ("blocks.csv", blocks(study)),
    ];
    if let Some(sweep) = sweep(study) {
        files.push(("sweep.csv", sweep));
    }
    files
}

/// Every move.
fn moves(study: &DeviationStudy) -> String {
    let mut text = BEGIN.to_owned();
    for name in &study.models {
        for column in
            ["peak_um", "peak_at", "left_um", "r2", "compensated_um", "compensated_points"]
        {
            let _ = write!(text, ",{name}_{column}");
        }
    }
    for placement in CutSurvey::PLACEMENTS {
        let name = placement.name();
        let _ = write!(text, ",{name}_points,{name}_certified_um,{name}_peak_um");
    }
    text.push('\n');
    for (index, row) in study.rows.iter().enumerate() {
        one_move(&mut text, index + 1, row);
    }
    text
}

fn one_move(text: &mut String, number: usize, row: &MoveRow) {
    let _ = write!(
        text,
        "{number},{},{:.6},{:.6},{:.6},{:.6},{},{:.9}",
        row.line,
        row.length,
        row.turn.to_degrees(),
        row.raw.size * MICRO,
        row.raw.at,
        row.edge.map(|size| format!("{:.6}", size * MICRO)).unwrap_or_default(),
        row.axis.to_degrees()
    );
    for model in &row.models {
        let explained = model.explained.map(|share| format!("{share:.9}"));
        let _ = write!(
            text,
            ",{:.6},{:.6},{:.6},{},{}",
            model.peak.size * MICRO,
            model.peak.at,
            model.residual * MICRO,
            explained.unwrap_or_default(),
            or_empty(
                model.compensated,
                |placed| format!("{:.6},{}", placed.peak * MICRO, placed.points),
                2
            ),
        );
    }
    for placed in &row.placed {
        let fields = or_empty(
            *placed,
            |placed| {
                format!(
                    "{},{:.6},{:.6}",
                    placed.points,
                    placed.certified * MICRO,
                    placed.peak * MICRO
                )
            },
            3,
        );
        let _ = write!(text, ",{fields}");
    }
    text.push('\n');
}

/// Fields of what there may not be.
fn or_empty(placed: Option<Placed>, write: impl Fn(Placed) -> String, fields: usize) -> String {
    placed.map_or_else(|| ",".repeat(fields - 1), write)
}

/// Distributions.
fn summary(study: &DeviationStudy) -> String {
    let mut text =
        "what,count,mean_um,deviation_um,p50_um,p90_um,p95_um,p99_um,max_um,points_put_in\n"
            .to_owned();
    for spread in &study.spreads {
        let distribution = &spread.distribution;
        let _ = write!(
            text,
            "\"{}\",{},{:.6},{:.6}",
            spread.name,
            distribution.count,
            distribution.mean * MICRO,
            distribution.deviation * MICRO
        );
        for value in distribution.percentiles {
            let _ = write!(text, ",{:.6}", value * MICRO);
        }
        let points = spread.points.map(|points| points.to_string());
        let _ = writeln!(text, ",{:.6},{}", distribution.max * MICRO, points.unwrap_or_default());
    }
    text
}

/// The whole program by each way.
fn blocks(study: &DeviationStudy) -> String {
    let mut text =
        "way,reduce,blocks,points_put_in,points_dropped,certified_um,overruled,refused\n"
            .to_owned();
    for program in &study.programs {
        let _ = write!(text, "\"{}\",{}", program.name, program.reduce);
        let _ = match &program.report {
            Ok(report) => writeln!(
                text,
                ",{},{},{},{:.6},{},",
                report.blocks,
                report.points_added,
                report.points_dropped,
                report.tip_deviation_mm.value * MICRO,
                report.model_overruled
            ),
            Err(why) => writeln!(text, ",,,,,,\"{}\"", why.replace('"', "\"\"")),
        };
    }
    text
}

fn sweep(study: &DeviationStudy) -> Option<String> {
    let (name, swept) = study.sweep.as_ref()?;
    let mut text = format!("{name},mean_um,deviation_um,max_um,move_um\n");
    for step in swept {
        let kept = step.kept.as_ref().map(|kept| kept.peak().size * MICRO);
        let _ = writeln!(
            text,
            "{:?},{:.6},{:.6},{:.6},{}",
            step.value,
            step.distribution.mean * MICRO,
            step.distribution.deviation * MICRO,
            step.distribution.max * MICRO,
            kept.map(|size| format!("{size:.6}")).unwrap_or_default()
        );
    }
    Some(text)
}
