//! The table of what was read.

use post_machine::description::{Axis, Machine};
use post_readback::interpret::ReadReport;

use post_job::nc_program::NcControl;
use post_job::read::ProgramSurvey;
use post_job::text::{clock, number};
use post_job::text_table::{NamedValues, TextTable};

/// So many words that are not known are listed.
const LISTED: usize = 40;

/// What was read, as lines.
pub fn text(
    control: &NcControl,
    survey: &ProgramSurvey<'_>,
    report: &ReadReport,
    refused: usize,
) -> String {
    let machine = &control.machine;
    let mut rows = NamedValues::default();
    rows.row("machine", format_args!("{} ({})", machine.name, machine.control.dialect));
    if report.header > 0 {
        let lines = report.header;
        rows.row(
            "in front of the program",
            format_args!("{lines} lines of a listing, passed over"),
        );
    }
    rows.row("blocks run", report.blocks);
    if refused > 0 {
        rows.row("blocks refused", refused);
    }
    let [rapids, feeds, threads] = survey.motions;
    let threads = match threads {
        0 => String::new(),
        _ => format!(", {threads} of threads"),
    };
    rows.row("motions", format_args!("{rapids} rapid, {feeds} at feed{threads}"));
    if survey.in_machine > 0 {
        rows.row("in machine coordinates", survey.in_machine);
    }
    if survey.kept > 0 {
        rows.row("the control keeps the tip", format_args!("in {} motions", survey.kept));
    }
    let [rapid, feed] = survey.minutes;
    rows.row("time at the stated feeds", clock(feed * 60.0));
    if rapid > 0.0 {
        let how = match control.lexicon.rapids_at_feed() {
            true => "at their F, no axis above its max_feed",
            false => "each axis at its max_feed",
        };
        rows.row("time of rapids", format_args!("{}, {how}", clock(rapid * 60.0)));
    }
    if survey.waits > 0.0 {
        rows.row("waits", clock(survey.waits));
    }
    if survey.feed > 0.0 {
        rows.row("largest feed of the tip", format_args!("{} mm/min", number(survey.feed, 0)));
    }
    let mut text = rows.table();
    axes(machine, survey, &mut text);
    tools(survey, &mut text);
    words(report, &mut text);
    text
}

fn axes(machine: &Machine, survey: &ProgramSurvey<'_>, text: &mut String) {
    if survey.axes.is_empty() {
        return;
    }
    let mut table = TextTable::headed(1, ["", "least", "most", "travel"]);
    for (name, [least, most]) in &survey.axes {
        let axis = machine.with_axis(name).map(|(_, axis)| axis);
        let unit = axis.map_or("mm", Axis::unit_name);
        let travel = axis.and_then(|axis| Some(axis.travel?.map(|end| axis.reading(end))));
        table.row([
            format!("{name} {unit}"),
            number(*least, 3),
            number(*most, 3),
            travel.map_or_else(String::new, |[from, to]| {
                format!("{} to {}", number(from, 3), number(to, 3))
            }),
        ]);
    }
    if let Some([least, most]) = survey.tip {
        for (row, name) in ["tip X mm", "tip Y mm", "tip Z mm"].into_iter().enumerate() {
            table.row([
                name.to_owned(),
                number(least[row], 3),
                number(most[row], 3),
                "at feed, part frame".to_owned(),
            ]);
        }
    }
    table.below(text);
}

fn tools(survey: &ProgramSurvey<'_>, text: &mut String) {
    if survey.tools.is_empty() {
        return;
    }
    let mut table = TextTable::headed(1, ["tool", "length mm", "cuts", "time"]);
    for tool in &survey.tools {
        table.row([
            tool.name.clone().unwrap_or_else(|| "none changed".to_owned()),
            number(tool.length, 3),
            tool.cuts.to_string(),
            clock(tool.minutes * 60.0),
        ]);
    }
    table.below(text);
}

fn words(report: &ReadReport, text: &mut String) {
    if report.unknown.is_empty() {
        return;
    }
    let heads = ["words not known, that move nothing", "times", "first in line"];
    let mut table = TextTable::headed(1, heads);
    for (word, times, line) in report.unknown.iter().take(LISTED) {
        table.row([word.clone(), times.to_string(), line.to_string()]);
    }
    if report.unknown.len() > LISTED {
        table.row([format!("and {} more", report.unknown.len() - LISTED)]);
    }
    table.below(text);
}
