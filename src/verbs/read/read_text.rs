//! The table of what was read.

use std::fmt::Write as _;

use post_machine::description::{Axis, Machine};
use post_readback::interpret::ReadReport;

use post_job::read::Survey;
use post_job::text::{clock, number, table};

/// So many words that are not known are listed.
const LISTED: usize = 40;

/// What was read, as lines.
pub fn text(machine: &Machine, survey: &Survey<'_>, report: &ReadReport, refused: usize) -> String {
    let mut rows: Vec<[String; 2]> = Vec::new();
    let mut row = |name: &str, value: String| rows.push([name.to_owned(), value]);
    row("machine", format!("{} ({})", machine.name, machine.control.dialect));
    if report.header > 0 {
        row(
            "in front of the program",
            format!("{} lines of a listing, passed over", report.header),
        );
    }
    row("blocks run", report.blocks.to_string());
    if refused > 0 {
        row("blocks refused", refused.to_string());
    }
    let [rapids, feeds, threads] = survey.motions;
    let mut motions = format!("{rapids} rapid, {feeds} at feed");
    if threads > 0 {
        let _ = write!(motions, ", {threads} of threads");
    }
    row("motions", motions);
    if survey.in_machine > 0 {
        row("in machine coordinates", survey.in_machine.to_string());
    }
    if survey.kept > 0 {
        row("the control keeps the tip", format!("in {} motions", survey.kept));
    }
    let [rapid, feed] = survey.minutes;
    row("time at the stated feeds", clock(feed * 60.0));
    if rapid > 0.0 {
        row("time of rapids", format!("{}, each axis at its max_feed", clock(rapid * 60.0)));
    }
    if survey.waits > 0.0 {
        row("waits", clock(survey.waits));
    }
    if survey.feed > 0.0 {
        row("largest feed of the tip", format!("{} mm/min", number(survey.feed, 0)));
    }
    let mut text = table(&rows, 2);
    axes(machine, survey, &mut text);
    tools(survey, &mut text);
    words(report, &mut text);
    text
}

fn axes(machine: &Machine, survey: &Survey<'_>, text: &mut String) {
    if survey.axes.is_empty() {
        return;
    }
    let mut rows =
        vec![["".to_owned(), "least".to_owned(), "most".to_owned(), "travel".to_owned()]];
    for (name, [least, most]) in &survey.axes {
        let axis = machine.with_axis(name).map(|(_, axis)| axis);
        let unit = axis.map_or("mm", Axis::unit_name);
        let travel = axis.and_then(|axis| Some(axis.travel?.map(|end| axis.reading(end))));
        rows.push([
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
            rows.push([
                name.to_owned(),
                number(least[row], 3),
                number(most[row], 3),
                "at feed, part frame".to_owned(),
            ]);
        }
    }
    text.push('\n');
    text.push_str(&table(&rows, 1));
}

fn tools(survey: &Survey<'_>, text: &mut String) {
    if survey.tools.is_empty() {
        return;
    }
    let head = ["tool", "length mm", "cuts", "time"];
    let mut rows = vec![head.map(str::to_owned)];
    for tool in &survey.tools {
        rows.push([
            tool.name.clone().unwrap_or_else(|| "none changed".to_owned()),
            number(tool.length, 3),
            tool.cuts.to_string(),
            clock(tool.minutes * 60.0),
        ]);
    }
    text.push('\n');
    text.push_str(&table(&rows, 1));
}

fn words(report: &ReadReport, text: &mut String) {
    if report.unknown.is_empty() {
        return;
    }
    let head = ["words not known, that move nothing", "times", "first in line"];
    let mut rows = vec![head.map(str::to_owned)];
    for (word, times, line) in report.unknown.iter().take(LISTED) {
        rows.push([word.clone(), times.to_string(), line.to_string()]);
    }
    if report.unknown.len() > LISTED {
        rows.push([
            format!("and {} more", report.unknown.len() - LISTED),
            String::new(),
            String::new(),
        ]);
    }
    text.push('\n');
    text.push_str(&table(&rows, 1));
}
